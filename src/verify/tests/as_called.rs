//! A program that takes arguments, and a target whose calls give none: its callers write them into registers.

use super::{Outcome, named};
use crate::verify::{ProgramCertificate, SymbolMap, Why};
use std::collections::{BTreeMap, BTreeSet};

const SOURCE: &str = "O1\nG20G90G17G40G80G94G54\nG0X1.\nG65P2A#500\nM30\nO2\n#2=#1+1\nIF[#2GT3]GOTO5\nG1X#2F10.\nN5G0Y1.\nM99\n";

const TARGET: &str = "\
N1 O1
N4 G20 G90 G17 G40 G80 G94 E1
N5 G0 X1.
N6 #V2=V1
N7 M98 P2
N8 M2
N1 O2
N4 #V2=V2+1.
N5 #IF V2 GT 3. THEN GOTO :N5
N6 #R5=V2
N7 G1 X+R5 F10.
N8 #:N5
N9 G0 Y1.
N10 M99
";

/// What becomes of O2.
fn called(source: &str, target: &str) -> ProgramCertificate {
    let names = SymbolMap {
        variables: BTreeMap::from([("#500".to_owned(), 1)]),
        scratch: BTreeSet::from([2]),
        of_words: BTreeSet::from(["R5".to_owned()]),
        ..SymbolMap::default()
    };
    named(("fanuc", source), ("fadal", target), names).remove(1)
}

#[test]
fn it_is_run_through_its_callers() {
    let found = called(SOURCE, TARGET);
    assert_eq!((found.branches_covered, found.branches_total), (2, 2), "{found:#?}");
    let others: Vec<_> = found.reasons.iter().filter(|reason| reason.why != Why::Unconfirmed).collect();
    assert!(others.is_empty(), "{others:#?}");
}

#[test]
fn what_the_callers_runs_show_is_different() {
    for (from, to) in [
        ("V2=V2+1.", "V2=V2+2."),
        ("GT 3.", "GE 3."),
        ("G0 Y1.", "G0 Y2."),
        ("F10.", "F11."),
        ("#V2=V1\n", "#V2=V1+1.\n"),
    ] {
        assert_eq!(TARGET.matches(from).count(), 1, "{from}");
        let found = called(SOURCE, &TARGET.replace(from, to));
        assert_ne!(found.outcome, Outcome::Same, "{from} made {to}");
        assert!(found.outcome == Outcome::Different || !found.reasons.is_empty());
    }
}

/// A caller that gives one number shows one way: the other is not reached.
#[test]
fn a_way_that_no_caller_goes_is_missing() {
    let (source, target) = (SOURCE.replace("A#500", "A1."), TARGET.replace("V2=V1", "V2=1."));
    // Run by itself it goes the way of an argument that nobody gives; above 3 it never comes.
    let found = called(&source, &target);
    assert_eq!(found.outcome, Outcome::Undecided);
    let missing: Vec<&str> = found.not_reached.iter().map(|way| way.way).collect();
    assert_eq!(missing, ["true"]);
}

/// A caller that has no conversion, and a macro that takes arguments in registers.
fn alone(source: &str, target: &str) -> ProgramCertificate {
    named(("fanuc", source), ("fadal", target), SymbolMap::default()).remove(1)
}

const TAKES: &str = "O1\nG65P2A1.B2.\nM30\nO2\nG90G17\nG1Y5.F10.\nG0X#1\n#500=#2\nM99\n";

#[test]
fn what_no_caller_can_give_is_no_difference() {
    let target = "N1 O2\nN2 G90 G17\nN3 G1 Y5. F10.\nN4 #R5=V2\nN5 G0 X+R5\nN6 #V1=V3\nN7 M99\n";
    let found = alone(TAKES, target);
    assert_eq!(found.outcome, Outcome::Undecided, "{found:#?}");
    let why = |found: &ProgramCertificate| found.reasons.iter().map(|reason| reason.why).collect::<Vec<_>>();
    assert!(why(&found).contains(&Why::NotByItself), "{found:#?}");
    assert!(found.reasons.iter().any(|reason| reason.text.contains("O0001, which calls it")), "{found:#?}");
    // What it does before, whatever it is given, is its own.
    for (from, to) in [("Y5.", "Y6."), ("F10.", "F11."), ("G1 Y5.", "G0 Y5.")] {
        assert_eq!(target.matches(from).count(), 1, "{from}");
        assert_eq!(alone(TAKES, &target.replace(from, to)).outcome, Outcome::Different, "{from} made {to}");
    }
    // And so is what it does where it takes nothing.
    let takes_nothing = TAKES.replace("G0X#1\n#500=#2\n", "G0X#500\n");
    assert_eq!(alone(&takes_nothing, target).outcome, Outcome::Different);
}

const ASKS: &str =
    "O2\nG90G94\nIF[#1EQ#0]GOTO8\nIF[#2EQ#0]GOTO8\n#3=#1+#2\nIF[#3GT3]GOTO5\nG1X#3F10.\nN5G0Y1.\nN8M99\n";

const BY_REGISTERS: &str = "\
N1 O2
N2 G90 G94
N4 #IF V3 LE 0. THEN GOTO :N8
N5 #V4=V1+V2
N6 #IF V4 GT 3. THEN GOTO :N5
N7 #R5=V4
N8 G1 X+R5 F10.
N9 #:N5
N10 G0 Y1.
N11 #:N8
N12 M99
";

/// A macro that nothing calls, where the conversion says in which registers its arguments stand.
fn by_itself(target: &str, always: &[&str]) -> ProgramCertificate {
    let arguments = [("#1 of O2", 1), ("#2 of O2", 2), ("flag of #1 of O2", 3)];
    let names = SymbolMap {
        arguments: arguments.into_iter().map(|(name, register)| (name.to_owned(), register)).collect(),
        always: always.iter().map(|name| (*name).to_owned()).collect(),
        scratch: BTreeSet::from([4]),
        of_words: BTreeSet::from(["R5".to_owned()]),
        ..SymbolMap::default()
    };
    named(("fanuc", ASKS), ("fadal", target), names).remove(0)
}

#[test]
fn registers_that_are_known_are_set_as_a_call_does() {
    let found = by_itself(BY_REGISTERS, &["#2 of O2"]);
    let others: Vec<_> = found.reasons.iter().filter(|reason| reason.why != Why::Unconfirmed).collect();
    assert!(others.is_empty() && found.witness.is_none(), "{found:#?}");
    // That #2 is missing is one way of three conditions, and no call goes it.
    assert_eq!((found.branches_covered, found.branches_total), (5, 5), "{found:#?}");
}

#[test]
fn what_it_does_otherwise_with_its_arguments_shows() {
    for (from, to) in [
        ("V4=V1+V2", "V4=V1-V2"),
        ("V4=V1+V2", "V4=V2+V2"),
        ("GT 3.", "GE 3."),
        ("V3 LE 0.", "V3 LE 1."),
        ("V3 LE 0.", "V3 LE -1."),
        ("G0 Y1.", "G0 Y2."),
    ] {
        assert_eq!(BY_REGISTERS.matches(from).count(), 1, "{from}");
        let found = by_itself(&BY_REGISTERS.replace(from, to), &["#2 of O2"]);
        assert_ne!(found.outcome, Outcome::Same, "{from} made {to}");
        assert!(found.outcome == Outcome::Different || !found.reasons.is_empty());
    }
}

/// Where a call may leave it out, the way that it goes then is not the target's.
#[test]
fn what_not_every_call_gives_is_tried_without_a_value() {
    let found = by_itself(BY_REGISTERS, &[]);
    assert!(found.outcome != Outcome::Same && !found.reasons.is_empty(), "{found:#?}");
}
