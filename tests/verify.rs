//! Pairs of programs by hand, handed to the verifier as if one were the conversion of the other: those that
//! differ in one place must be told apart there, those that are only written otherwise must not.

#[path = "support/cases.rs"]
mod cases;
#[path = "support/machine.rs"]
mod machine;

use cases::{Case, Change, cases};
use machine::machine;
use macroglot::control::LoadedFile;
use macroglot::dialect::registry;
use macroglot::syntax::parse_file;
use macroglot::verify::{Assumptions, Certificate, Effort, Job, Outcome, Side, Spent, SymbolMap, verify};
use std::collections::BTreeMap;

/// Verifies a target of a pair.
fn judge(pair: &Case, target: &str) -> Certificate {
    let controls = [&pair.from, &pair.to].map(|spec| machine(spec).unwrap());
    let execute = [0, 1].map(|at: usize| registry::find(controls[at].name()).unwrap().execute.unwrap());
    let parsed = [(&*pair.source, &controls[0]), (target, &controls[1])]
        .map(|(text, control)| parse_file(text.as_bytes(), control.entry().parse));
    let ours = [LoadedFile { name: "a.nc", parsed: &parsed[0] }];
    let theirs = [LoadedFile { name: "a.nc", parsed: &parsed[1] }];
    let source = Side::new(&controls[0], execute[0], &ours);
    let target = Side::new(&controls[1], execute[1], &theirs);
    let names = SymbolMap { variables: pair.lock.clone(), ..SymbolMap::default() };
    let (assumptions, effort) = (Assumptions::new(), Effort::default());
    verify(
        &Job {
            source: &source,
            target: &target,
            names: &names,
            assumptions: &assumptions,
            effort,
            spent: &Spent::default(),
        },
        &[],
    )
}

/// The pairs of all files.
fn pairs() -> Vec<Case> {
    cases("tests/verify")
}

#[test]
fn what_is_written_otherwise_is_the_same() {
    let pairs = pairs();
    assert!(pairs.len() >= 15, "{}", pairs.len());
    for pair in &pairs {
        let found = judge(pair, &pair.target);
        let witness = found.programs.iter().find_map(|program| program.witness.as_ref());
        assert_ne!(found.outcome, Outcome::Different, "{}: {witness:#?}", pair.name);
        for program in &found.programs {
            let reasons: Vec<_> = program.reasons.iter().map(|reason| reason.why).collect();
            let unconfirmed = |why: &macroglot::verify::Why| *why == macroglot::verify::Why::Unconfirmed;
            assert!(reasons.iter().all(unconfirmed), "{}: {:?}", pair.name, program.reasons);
        }
    }
}

#[test]
fn what_differs_in_one_place_is_told_apart() {
    let (mut count, mut missed) = (0, Vec::new());
    for pair in pairs() {
        for change in &pair.changes {
            count += 1;
            let (place, found) = changed(&pair, change);
            let mut witnesses = found.programs.iter().filter_map(|program| program.witness.as_ref());
            if found.outcome != Outcome::Different {
                let reasons = found.programs.iter().flat_map(|program| &program.reasons);
                let reasons: Vec<_> = reasons.map(|reason| (reason.why, &reason.text)).collect();
                missed.push(format!("{place} is {:?}: {reasons:?}", found.outcome));
            } else if !witnesses.any(|witness| witness.what.contains(&change.says)) {
                missed.push(format!("{place}: not {}", change.says));
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
    assert!(count >= 180, "{count} changes");
}

#[test]
fn what_cannot_be_told_is_not_called_the_same() {
    let mut same = Vec::new();
    for pair in pairs() {
        for change in &pair.doubts {
            let (place, found) = changed(&pair, change);
            // A fact that no source confirms would hide what this is about.
            let reasons = found.programs.iter().flat_map(|program| &program.reasons);
            let mut others = reasons.filter(|reason| reason.why != macroglot::verify::Why::Unconfirmed);
            if found.outcome != Outcome::Different && others.next().is_none() {
                same.push(place);
            }
        }
    }
    assert!(same.is_empty(), "{}", same.join("\n"));
}

/// A pair with one place of the target changed: which, and what is found.
fn changed(pair: &Case, change: &Change) -> (String, Certificate) {
    let Change { of: old, with: new, .. } = change;
    assert_eq!(pair.target.matches(old).count(), 1, "{}: {old:?} stands once", pair.name);
    (format!("{}: {old:?} made {new:?}", pair.name), judge(pair, &pair.target.replace(old, new)))
}

/// What is found of a pair without any changes, and why it is not decided.
fn found(from: &str, to: &str, source: &str, target: &str) -> (Outcome, Vec<macroglot::verify::Why>) {
    let pair = Case { from: from.into(), to: to.into(), source: source.into(), ..Case::default() };
    let found = judge(&pair, target);
    (found.outcome, found.programs.iter().flat_map(|p| &p.reasons).map(|reason| reason.why).collect())
}

#[test]
fn what_the_target_lacks_is_neither_the_same_nor_a_fault() {
    use macroglot::verify::Why::Substituted;
    let mist = "O1\nM7\nG0 X1.\nM2\n";
    let (outcome, why) = found("fadal", "haas", mist, "O00001\nM8\nG0 X1.\nM2\n");
    assert_eq!((outcome, why.contains(&Substituted)), (Outcome::Undecided, true));
    // Left out, or where the target has it, it is a fault.
    assert_eq!(found("fadal", "haas", mist, "O00001\nG0 X1.\nM2\n").0, Outcome::Different);
    assert_eq!(found("fadal", "fanuc", mist, "O0001\nM8\nG0 X1.\nM2\n").0, Outcome::Different);
    let ramps = "O1\nG8\nG0 X1.\nM2\n";
    let (outcome, why) = found("fadal", "fanuc", ramps, "O0001\nG0 X1.\nM2\n");
    assert_eq!((outcome, why.contains(&Substituted)), (Outcome::Undecided, true));
    assert_eq!(found("fadal", "fanuc", ramps, "O0001\nG0 X2.\nM2\n").0, Outcome::Different);
    // A code that only the builder knows says nothing on either side.
    let builders = "O1\nM77\nG0X1.\nM30\n";
    assert_ne!(found("fanuc", "haas", builders, "O1\nM77\nG0X1.\nM30\n").0, Outcome::Same);
    assert_eq!(found("fanuc", "haas", builders, "O1\nM78\nG0X1.\nM30\n").0, Outcome::Different);
}

/// Run by itself with the spindle that its caller leaves, the source says nothing of it and the target says it again.
#[test]
fn a_speed_that_is_said_again_as_it_was_found_is_nothing_new() {
    let (from, to) = (r#"fanuc[units="metric"]"#, r#"fadal[units="metric";settings.format="1"]"#);
    let source = "O1\nG21G90G80G54G17G40G49G94\nG0X0Y0S500M3\nZ20.\nM98P2\nM30\n\
        O2\nG98G84X10.Y5.Z-10.R5.F400.\nG80\nM99\n";
    let target = "N1 O1\nN2 G21 G90 G80 E1 G17 G40 G49 G94\nN3 G0 X0. Y0. S500 M3\nN4 Z20.\nN5 M98 P2\nN6 M2\n\
        N1 O2\nN2 G98 G84 X10. Y5. Z-10. R0+5. Q0.8 F500\nN3 G80 F400.\nN4 M99\n";
    let pair = Case { from: from.into(), to: to.into(), source: source.into(), ..Case::default() };
    let by_itself = judge(&pair, target);
    assert_eq!(by_itself.outcome, Outcome::Undecided, "no manual confirms the codes");
    let reasons: Vec<&str> = by_itself.programs.iter().flat_map(|p| &p.reasons).map(|r| &*r.text).collect();
    assert!(!reasons.iter().any(|text| text.contains("it differs")), "{reasons:?}");
    // At another speed it is news.
    assert_eq!(judge(&pair, &target.replace("Q0.8 F500", "Q0.8 F501")).outcome, Outcome::Different);
}

#[test]
fn small_moves_do_not_add_up_unseen() {
    let source = format!("O1\nG90 G0 X1.\nG91\nG1 F10.\n{}G90\nM2\n", "X.0004\n".repeat(10));
    assert_eq!(found("fadal", "fanuc", &source, "O0001\nG90 G0 X1.\nM2\n").0, Outcome::Different);
}

#[test]
fn scratch_registers_hold_nothing_and_others_do() {
    let source = "O1\n#101=1\nG0X#101\nM30\n";
    let target = "O1\n#101=1\n#140=#101\nG0X#140\nM30\n";
    assert_eq!(found("fanuc", "haas", source, target).0, Outcome::Different);
}

/// A loop that adds a step until a limit, by dialect; it moves one millimetre or inch each time.
fn counting(dialect: &str, step: &str, limit: &str) -> String {
    match dialect {
        "fadal" => {
            format!("O1\n#V1=0\n#:A\n#V1=V1+{step}\nG91 G1 X1. F100.\n#IF V1<{limit} THEN GOTO :A\nG90\nM2\n")
        }
        "cc100" => format!("V31=0\n$1\nV31=V31+{step}\nG91 G1 X1 F100\nV32=V31-{limit}\nBLT P1\nG90\nM30\n"),
        _ => {
            format!("O1\n#501=0\nWHILE[#501LT{limit}]DO1\n#501=#501+{step}\nG91G1X1.F100.\nEND1\nG90\nM30\n")
        }
    }
}

/// By `rounding.tsv`, which `rounding.py` works out: the last digit decides where binary and decimal counts differ, and where
/// other errors than those of doubles would count otherwise.
#[test]
fn what_the_last_digit_decides_is_marked_and_nothing_else() {
    let table = include_str!("verify/rounding.tsv");
    for (from, to) in [
        ("fadal", "fanuc"),
        ("fadal", "haas"),
        ("cc100", "fanuc"),
        ("cc100", "haas"),
        ("fanuc", "haas"),
        ("haas", "fanuc"),
    ] {
        let mut marked = 0;
        for row in table.lines() {
            let [step, limit, binary, decimal, decides] = row.split('\t').collect::<Vec<_>>()[..] else {
                panic!("{row}")
            };
            let source = counting(from, step, limit);
            let lock = match from {
                "fadal" => [("V1".to_owned(), 501)].into(),
                "cc100" => [("V31".to_owned(), 501), ("V32".to_owned(), 502)].into(),
                _ => BTreeMap::new(),
            };
            let mut target = counting(to, step, limit);
            if from == "cc100" {
                target = target.replace("END1", &format!("#502=#501-{limit}\nEND1"));
            }
            let pair = Case {
                name: row.into(),
                from: from.into(),
                to: to.into(),
                lock,
                source: source.clone(),
                ..Case::default()
            };
            let found = judge(&pair, &target);
            let [program] = &found.programs[..] else { panic!("one program") };
            assert!(program.witness.is_none(), "{from} {to} {row}: {:#?}", program.witness);
            assert!(decides == "yes" || binary == decimal, "{row}");
            assert_eq!(program.rounding_sensitive, Some(decides == "yes"), "{from} {to} {row}");
            marked += usize::from(decides == "yes");
        }
        assert!(marked > 3 && marked < table.lines().count() - 3, "{marked} rows are marked");
    }
}
