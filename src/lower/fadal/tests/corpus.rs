//! The programs of the manual, and damage.

use super::{control, lower};
use crate::diag::Severity;
use crate::ir::Module;
use crate::syntax::{fadal::parse_line, parse_file};

/// The programs of the corpus, with their file names.
fn corpus() -> Vec<(String, Vec<u8>)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/corpus/fadal");
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> = paths.filter(|path| path.extension().is_some_and(|end| end == "nc")).collect();
    paths.sort();
    let name = |path: &std::path::Path| path.file_name().unwrap().to_string_lossy().into_owned();
    paths.iter().map(|path| (name(path), std::fs::read(path).unwrap())).collect()
}

#[test]
fn whole_programs_of_the_manual_are_understood() {
    let control = control("");
    for (name, source) in corpus() {
        let parsed = parse_file(&source, parse_line);
        let mut module = Module::default();
        let mut errors = Vec::new();
        for (program, findings) in lower(&parsed, 0, &name, &control).programs {
            errors.extend(findings.iter().filter(|f| f.severity() == Severity::Error).map(|f| f.code));
            module.programs.push(program);
        }
        assert_eq!(errors, [], "{name}");
        assert!(crate::ir::validate::validate(&module).is_ok(), "{name}");
        assert_eq!(module.programs.len(), 1, "{name}");
    }
}

#[test]
fn every_span_lies_in_its_file_and_damage_stops_nothing() {
    let control = control("");
    // A fixed generator: xorshift, seed 7.
    let mut random = 7u64;
    let mut next = move |below: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % below.max(1) as u64) as usize
    };
    let scraps: &[&[u8]] = &[
        b"L100", b"L101", b"M17", b"M30", b"G66", b"R0+", b"#", b"GOTO :A", b"/", b"G2", b"(", b"\n",
        b"M99 P1", b"N1",
    ];
    for (name, source) in corpus() {
        for _ in 0..40 {
            let mut damaged = source.clone();
            for _ in 0..1 + next(4) {
                let at = next(damaged.len());
                let to = (at + next(6)).min(damaged.len());
                damaged.splice(at..to, scraps[next(scraps.len())].iter().copied());
            }
            let parsed = parse_file(&damaged, parse_line);
            let mut module = Module::default();
            for (program, findings) in lower(&parsed, 0, &name, &control).programs {
                for finding in &findings {
                    assert!(finding.span.end as usize <= damaged.len(), "{name}");
                }
                module.programs.push(program);
            }
            let text = String::from_utf8_lossy(&damaged).into_owned();
            crate::ir::validate::validate(&module).unwrap_or_else(|faults| panic!("{text}: {faults:?}"));
        }
    }
}
