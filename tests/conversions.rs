//! Small programs and what they become on another control.
//!
//! Each file of `tests/conversions/` holds cases: `== title: source target` (a machine's profile in brackets behind
//! its dialect), the program, `--`, the conversion without
//! its tape frame (or `refused`), and a line `!` with the codes that are reported. What is expected was written from the
//! controls' manuals, not from what the compiler printed.

#[path = "support/machine.rs"]
mod machine;

use macroglot::library::{Input, Lock, Options, convert};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

struct Case<'t> {
    title: &'t str,
    source: &'t str,
    target: &'t str,
    program: &'t str,
    wanted: &'t str,
    codes: BTreeSet<&'t str>,
}

impl<'t> Case<'t> {
    fn read(text: &'t str) -> Option<Self> {
        let (head, rest) = text.split_once('\n')?;
        let (title, pair) = head.rsplit_once(": ")?;
        let (source, target) = pair.trim().split_once(' ')?;
        let (program, rest) = rest.split_once("\n--\n")?;
        let (wanted, codes) = rest.split_once("\n!")?;
        Some(Self { title, source, target, program, wanted, codes: codes.split_whitespace().collect() })
    }

    /// What is wrong with the conversion, if anything is.
    fn fault(&self) -> Option<String> {
        let control = |spec: &str| machine::machine(spec).unwrap_or_else(|error| panic!("{error}"));
        let (source, target) = (control(self.source), control(self.target));
        let bytes = format!("{}\n", self.program).into_bytes();
        let inputs = [Input { path: PathBuf::from("case.nc"), name: "case.nc".into(), bytes }];
        let lock = Lock::new(source.name(), target.name());
        let made = convert(&inputs, &source, &target, lock, Options::default());
        let codes: BTreeSet<&str> =
            made.programs.iter().flat_map(|p| &p.diagnostics).map(|d| d.code.number()).collect();
        let text = match made.texts.first() {
            Some(Some(text)) => text.trim().trim_matches('%').trim().to_owned(),
            _ => "refused".into(),
        };
        let same = text == self.wanted && codes == self.codes;
        (!same).then(|| {
            let Self { title, source, target, program, wanted, codes: expected } = self;
            format!("{title} ({source} to {target})\n{program}\nwanted {expected:?}\n{wanted}\ngot {codes:?}\n{text}\n")
        })
    }
}

#[test]
fn programs_become_what_the_manuals_make_of_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/conversions");
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let mut faults = Vec::new();
    let mut count = 0;
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        for case in format!("\n{text}").split("\n== ").skip(1) {
            let case = Case::read(case).unwrap_or_else(|| panic!("{}: not a case:\n{case}", file.display()));
            count += 1;
            faults.extend(case.fault());
        }
    }
    assert!(count >= 30, "only {count} cases were found");
    assert!(faults.is_empty(), "{} of {count} cases\n\n{}", faults.len(), faults.join("\n"));
}
