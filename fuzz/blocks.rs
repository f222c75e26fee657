//! Changes programs by what programs are made of: blocks, words and numbers.
//!
//! Bytes that are changed at random hardly ever make a program that comes as far as emission; blocks that change their
//! places, and words their numbers, mostly do.

/// Numbers at which programs change what they do.
#[rustfmt::skip]
const NUMBERS: &[&str] = &[
    "0", "1", "2", "3", "-1", "10", "28", "40", "43", "49", "53", "54", "65", "66", "67", "68", "69", "81", "83", "90", "91",
    "98", "99", "100", "500", "999", "1000", "2001", "3000", "5041", "9999", ".5", "-.001", "1.", "99999.9999", "#0", "#1",
    "#[#1]", "[#1+1]", "V1", "R1", "<>",
];

/// Words and statements of all dialects, so that one can come where no program of the corpus has it.
#[rustfmt::skip]
const BLOCKS: &[&str] = &[
    "G90", "G91", "G20", "G21", "G17", "G18", "G40", "G41 D1", "G43 H1", "G49", "G54", "G80", "G52 X1.", "G92 X0", "G28 Z0",
    "G53 Z0", "G68 X0 Y0 R30.", "G69", "G51 X0 Y0 P2.", "G50", "G10 L2 P1 X1.", "G10 L10 P1 R1.", "G31 Z-1. F10.",
    "G81 X1. Z-1. R.1 F5.", "G83 Z-2. Q.1 R.1 F5.", "G65 P9000 A1. B#0", "G66 P9000 A1.", "G67", "M98 P9000 L2", "M99", "M99 P10",
    "M97 P10", "M30", "M2", "M0", "M1", "M3 S1000", "M5", "M8", "M9", "T1 M6", "#1=#0", "#500=#500+1", "#[#1+100]=#3",
    "IF [#1 EQ #0] GOTO 10", "IF [#1 GT 3] THEN #2=1", "WHILE [#1 LT 3] DO 1", "END 1", "GOTO 10", "GOTO #1", "N10",
    "#3000=1 (STOP)", "#3006=1 (GO)", "#3003=1", "DPRNT[X#1[44]]", "/M8", "/2 G0 X1.", "O9000", "%", "#V1=1", "#IF V1 GT 3 THEN GOTO :A",
    "#:A", "#GOTO :A", "#R1=V1", "#CLEAR", "#PRINT \"A\",V1", "#INPUT \"A\",V1", "L101", "M17", "G0 X+R1 Y-R2", "#FX(V1)=1",
    "V1=1", "[V1=V2+3]", "BEQ V1 N10", "BRA N10", "CMP V1 V2", "G22 P1", "G24", "G=V1", "X=V1 Y=V2",
];

struct Draw(u64);

impl Draw {
    fn below(&mut self, end: usize) -> usize {
        // Steele, Lea and Flood: SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }

    fn of<'t>(&mut self, all: &[&'t str]) -> &'t str {
        all[self.below(all.len())]
    }
}

/// The program after one to four changes; never longer than `most` bytes.
pub fn mutate(program: &[u8], most: usize, seed: u32) -> Vec<u8> {
    let mut draw = Draw(u64::from(seed));
    let mut blocks: Vec<Vec<u8>> = program.split(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
    for _ in 0..=draw.below(4) {
        let (at, other) = (draw.below(blocks.len()), draw.below(blocks.len()));
        match draw.below(8) {
            0 if blocks.len() > 1 => drop(blocks.remove(at)),
            1 => blocks.insert(at, blocks[other].clone()),
            2 => blocks.swap(at, other),
            3 => blocks.insert(at, draw.of(BLOCKS).into()),
            4 => {
                blocks[at].push(b' ');
                let word = draw.of(BLOCKS).as_bytes();
                blocks[at].extend_from_slice(word);
            }
            5 => blocks[at] = [b"/", blocks[at].as_slice()].concat(),
            _ => number(&mut blocks[at], &mut draw),
        }
    }
    let mut program = blocks.join(&b'\n');
    program.truncate(most);
    program
}

/// Gives one of a block's numbers another value.
fn number(block: &mut Vec<u8>, draw: &mut Draw) {
    let is_part = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
    let starts: Vec<usize> = (0..block.len())
        .filter(|at| is_part(&block[*at]) && (*at == 0 || !is_part(&block[*at - 1])))
        .collect();
    if starts.is_empty() {
        return;
    }
    let start = starts[draw.below(starts.len())];
    let end = block[start..].iter().position(|byte| !is_part(byte)).map_or(block.len(), |end| start + end);
    block.splice(start..end, draw.of(NUMBERS).bytes());
}

#[cfg(test)]
mod tests {
    use super::mutate;

    #[test]
    fn a_seed_makes_the_same_change_and_none_is_too_long() {
        let program = b"%\nO1\nG0 X1.\nM30\n%";
        let all: Vec<Vec<u8>> = (0..1000).map(|seed| mutate(program, 60, seed)).collect();
        assert!(all.iter().all(|made| made.len() <= 60));
        assert!(all.iter().filter(|made| made.as_slice() != program).count() > 900);
        assert_eq!(all[7], mutate(program, 60, 7));
        assert!(mutate(b"", 60, 3).len() <= 60);
    }
}
