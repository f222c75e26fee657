//! A run that is killed, or whose disk is full, at each change that it makes.

use super::library::{CONVERT, Draw, changed};
use super::{Files, Shop, leavings, parted};
use rayon::prelude::*;

/// What one library's run does undisturbed.
struct Case {
    line: String,
    before: Files,
    after: Files,
    code: Option<i32>,
}

impl Case {
    /// `more` are arguments over and above those of every run.
    fn of(before: Files, more: &str) -> Self {
        let line = format!("{CONVERT} {more}");
        let shop = Shop::with(&before);
        let run = shop.run(&line, "");
        let after = shop.files();
        assert!(leavings(&after).is_empty(), "{:?}", leavings(&after));
        assert_ne!(before, after);
        let again = shop.run(&line, "");
        // What is told of a folder is told once; the report says so too.
        let told = |mut files: Files| {
            files.remove("told/report.json");
            files
        };
        assert_eq!(
            (again.code, told(shop.files())),
            (run.code, told(after.clone())),
            "a second run writes the same"
        );
        Self { line, before, after, code: run.code }
    }

    /// Tries one point; false if the run made fewer changes.
    fn point(&self, fault: &str) -> bool {
        let shop = Shop::with(&self.before);
        let run = shop.run(&self.line, fault);
        let found = shop.files();
        let pending = !leavings(&found).is_empty();
        match run.code {
            // A fault in what comes after the set is published is none of the set's.
            code if code == self.code && found == self.after => {
                return fault.starts_with("full") && run.err.contains("cannot be written");
            }
            None => assert!(fault.starts_with("kill"), "{fault}: {}", run.err),
            Some(code) => {
                assert!(code == 2 && fault.starts_with("full"), "{fault}: {code}: {}", run.err);
                assert!(run.err.contains("written"), "{fault}: {}", run.err);
                assert_eq!(run.out, "", "{fault}: a summary of what is not written");
            }
        }
        if pending {
            // Nobody takes for whole what is not.
            let looked = shop.run("verify in out --from fanuc --to haas", "");
            assert_eq!(looked.code, Some(2), "{fault}: {}", looked.err);
            assert!(looked.err.contains("interrupted"), "{fault}: {}", looked.err);
        } else {
            let whole = [&self.before, &self.after].contains(&&found);
            assert!(whole, "{fault}: {:?}, {:?}", parted(&found, &self.before), parted(&found, &self.after));
        }
        let next = shop.run(&self.line, "");
        let mut ended = shop.files();
        assert_eq!(next.code, self.code, "{fault}: {}", next.err);
        let mut after = self.after.clone();
        if next.err.contains("in place now") {
            // The set was published by then: what it took away is told no more.
            assert!(ended.remove("told/report.json").is_some());
            after.remove("told/report.json");
        }
        assert!(ended == after, "{fault}: {:?}", parted(&ended, &after));
        true
    }
}

#[test]
fn at_each_change() {
    // Certificates of the run before go where nothing is verified.
    let case = Case::of(changed(&mut Draw(1), 5), "--no-verify");
    ["kill", "full"].into_par_iter().for_each(|kind| {
        let points = (1..10_000).take_while(|at| case.point(&format!("{kind}:{at}"))).count();
        assert!(points > 20, "{kind}: {points}");
        println!("{kind}: {points} points");
    });
}

/// The next run may spell the folder in another way, and the report's place in it.
#[test]
fn at_each_change_by_another_path() {
    const NEXT: &str = "convert in --from fanuc --to haas --out out --report out/r.json";
    let before = changed(&mut Draw(2), 3);
    let shop = Shop::with(&before);
    let code = shop.run(NEXT, "").code;
    let mut after = shop.files();
    after.remove("out/r.json");
    for at in 1.. {
        let shop = Shop::with(&before);
        let whole = shop.path("").join("out").display().to_string();
        let run = shop.run(
            &NEXT.replace("--out out", &format!("--out {whole}")).replace("out/r", &format!("{whole}/r")),
            &format!("kill:{at}"),
        );
        let next = shop.run(NEXT, "");
        assert_eq!(next.code, code, "{at}: {}", next.err);
        let mut ended = shop.files();
        assert!(ended.remove("out/r.json").is_some());
        assert!(ended == after, "{at}: {:?}", parted(&ended, &after));
        if run.code.is_some() {
            assert!(at > 15, "{at} points");
            break;
        }
    }
}

#[test]
fn at_random_points_of_random_libraries() {
    let wanted: usize =
        std::env::var("MACROGLOT_FAULT_POINTS").ok().and_then(|n| n.parse().ok()).unwrap_or(12);
    let seed = std::env::var("MACROGLOT_SEED").ok().and_then(|n| n.parse().ok()).unwrap_or(20_261_122);
    println!("seed {seed}, {wanted} points");
    let mut draw = Draw(seed);
    let mut done = 0;
    while done < wanted {
        let files = 4 + draw.below(8);
        let case =
            Case::of(changed(&mut draw, files), ["", "--no-verify", "--prune", "--draft"][draw.below(4)]);
        for _ in 0..6.min(wanted - done) {
            let kind = ["kill", "full"][draw.below(2)];
            case.point(&format!("{kind}:{}", 1 + draw.below(12 * files)));
            done += 1;
        }
    }
}
