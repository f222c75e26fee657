//! Libraries to convert, and what stands in their output folder from before.

use super::{Files, Shop};

/// A command that publishes in a folder and writes a report elsewhere.
pub const CONVERT: &str = "convert in --from fanuc --to haas --out out --quiet --report told/report.json";

/// A program of this number, to this X; a refused one has a code that no table has.
fn program(number: usize, x: usize, refused: bool) -> Vec<u8> {
    let odd = if refused { "M38\n" } else { "" };
    format!("%\nO{number:04}\nG20 G17 G90 G40 G80 G94\nG0 X{x}.\n{odd}#101=#100+{x}\nG1 X#101 F10.\nM30\n%\n")
        .into_bytes()
}

/// Numbers that look as if drawn, the same for a seed.
pub struct Draw(pub u64);

impl Draw {
    pub fn below(&mut self, end: usize) -> usize {
        // Steele, Lea and Flood: SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end as u64) as usize
    }
}

/// A shop whose library was converted once, and changed since: a program is as it was, others move elsewhere, are refused
/// now, are new, or are gone, and somebody edited a conversion.
pub fn changed(draw: &mut Draw, files: usize) -> Files {
    let name = |at: usize| match at % 3 {
        2 => format!("in/sub/p{at}.nc"),
        _ => format!("in/p{at}.nc"),
    };
    let old: Files = (0..files).map(|at| (name(at), program(at + 1, draw.below(9) + 1, false))).collect();
    let shop = Shop::with(&old);
    let run = shop.run(CONVERT, "");
    assert_eq!(run.code, Some(0), "{}", run.err);
    let mut all = shop.files();
    for at in 0..files {
        match (at + draw.below(2)) % 6 {
            0 => {}
            1 => drop(all.insert(name(at), program(at + 1, draw.below(9) + 11, false))),
            2 => drop(all.insert(name(at), program(at + 1, 1, true))),
            3 => drop(all.remove(&name(at))),
            4 => {
                let place = name(at).replacen("in/", "out/", 1);
                all.insert(place, b"%\nO0001\n(BY HAND)\nM30\n%\n".to_vec());
                all.insert(name(at), program(at + 1, draw.below(9) + 11, false));
            }
            _ => drop(all.insert(name(at + files), program(at + files + 1, 3, false))),
        }
    }
    all
}
