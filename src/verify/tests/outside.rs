//! Calls of programs that stand in both machines.

use super::*;
use crate::verify::beside;

const HAAS: &str = "dialect = \"haas\"\nprograms = [\"O9800-O9899\", \"O9500 as O8500\"]\n";

/// Verifies the first program of a pair of files beside the programs that the target's profile names.
fn standing(source: &str, target: &str, variables: &[(&str, u32)]) -> ProgramCertificate {
    let controls = [Control::plain("fanuc").unwrap(), Control::from_profile(HAAS).unwrap()];
    let execute = ["fanuc", "haas"].map(|name| registry::find(name).unwrap().execute.unwrap());
    let parsed = [(source, &controls[0]), (target, &controls[1])]
        .map(|(text, control)| parse_file(text.as_bytes(), control.entry().parse));
    let ours = [LoadedFile { name: "a.nc", parsed: &parsed[0] }];
    let theirs = [LoadedFile { name: "a.nc", parsed: &parsed[1] }];
    let variables = variables.iter().map(|(name, number)| ((*name).to_owned(), *number)).collect();
    let names = SymbolMap { variables, ..SymbolMap::default() };
    let source = Side::new(&controls[0], execute[0], &ours);
    let target = Side::new(&controls[1], execute[1], &theirs);
    let (source, target) = beside(source, target, &names);
    verified([&source, &target], &names, &Assumptions::new()).remove(0)
}

#[track_caller]
fn apart(source: &str, target: &str, what: &str) {
    let found = standing(source, target, &[]);
    assert_eq!(found.outcome, Outcome::Different, "{source}\nagainst\n{target}\n{found:#?}");
    let witness = found.witness.unwrap();
    assert!(witness.what.contains(what), "{}", witness.what);
}

const CALLS: &str = "O1\nG21G90G17G54G0X0Y0\n#101=4.\nG65P9810X1.Y2.\nX#135\nIF[#136EQ#0]GOTO5\nG91X3.\nN5G90Y1.\nM98P9811L2\nM30\n";

#[test]
fn runs_are_compared_up_to_the_end_of_the_caller() {
    let same = standing(CALLS, CALLS, &[]);
    assert_ne!(same.outcome, Outcome::Different, "{:?}", same.witness);
    assert!(!same.reasons.iter().any(|reason| reason.why == Why::NothingCompared), "{:?}", same.reasons);
    assert_eq!((same.branches_covered, same.branches_total), (2, 2));
}

#[test]
fn what_such_a_program_is_given_must_be_the_same() {
    apart(CALLS, &CALLS.replace("X1.Y2.", "X1.Y3."), "gets other arguments");
    apart(CALLS, &CALLS.replace("X1.Y2.", "X1."), "gets other arguments");
    apart(CALLS, &CALLS.replace("P9810", "P9812"), "another program that stands in the machine");
    apart(CALLS, &CALLS.replace("L2", "L3"), "another number of times");
    apart(CALLS, &CALLS.replace("#101=4.", "#101=5."), "other common variables");
    apart(
        CALLS,
        &CALLS.replace("G65P9810", "G91\nG65P9810"),
        "where O9810 is called, the machine is in distance",
    );
    apart(CALLS, &CALLS.replace("N5G90Y1.\n", "N5G90Y1.\n#5=1.\n"), "gets other arguments");
    apart(CALLS, &CALLS.replace("G65P9810X1.Y2.\n", ""), "");
}

#[test]
fn what_such_a_program_leaves_is_not_what_was_there_before() {
    // Who takes #101 for 4, or the place for the one before, is wrong.
    let program = "O1\nG21G90G17G54G0X5.Y0\n#101=4.\nG65P9810X1.\nX#101\nG91X1.\nM30\n";
    let same = standing(program, program, &[]);
    assert_eq!(same.outcome, Outcome::Same, "{:?}", same.reasons);
    apart(program, &program.replace("X#101", "X4."), "elsewhere");
    let place = "O1\nG21G90G17G54G0X5.Y0\nG65P9810X1.\nG91X1.\nM30\n";
    apart(place, &place.replace("G91X1.", "G90X6."), "elsewhere");
}

#[test]
fn a_program_with_another_number_is_called_by_it() {
    let source = "O1\nG21G90G0X0\nG65P9500A1.\nX1.\nM30\n";
    let same = standing(source, &source.replace("P9500", "P8500"), &[]);
    assert_eq!(same.outcome, Outcome::Same, "{:?} {:?}", same.witness, same.reasons);
    let wrong = standing(source, source, &[]);
    assert_ne!(wrong.outcome, Outcome::Same);
    // What the target calls so is O9500 of the source, and O8500 stands on no source.
    let other = source.replace("P9500", "P8500");
    assert_ne!(standing(&other, &other, &[]).outcome, Outcome::Same);
}

#[test]
fn modal_calls_and_computed_ones_run_such_programs() {
    let modal = "O1\nG21G90G0X0\nG66P9811A1.\nX1.\nX2.Y1.\nG67\nX3.\nM30\n";
    // A Haas has no such call.
    let each = "O1\nG21G90G0X0\nX1.\nG65P9811A1.\nX2.Y1.\nG65P9811A1.\nX3.\nM30\n";
    assert_eq!(standing(modal, each, &[]).outcome, Outcome::Same);
    apart(modal, &each.replace("X2.Y1.\nG65P9811A1.", "X2.Y1."), "");
    let computed = "O1\nG21G90G0X0\n#1=9810\nM98P#1\nX1.\nM30\n";
    assert_eq!(standing(computed, computed, &[]).outcome, Outcome::Same);
    // A program of the library comes first.
    let both = "O1\nG21G90G0X0\nG65P9820A1.\nX1.\nM30\nO9820\nG0X#1\nM99\n";
    assert_eq!(standing(both, both, &[]).outcome, Outcome::Same);
    apart(both, &both.replace("G0X#1", "G0X2."), "elsewhere");
}

#[test]
fn variables_with_another_number_are_not_shared() {
    let source = "O1\nG21G90G0X0\n#110=4.\nG65P9810X1.\nX#110\nM30\n";
    let moved = standing(source, &source.replace("#110", "#120"), &[("#110", 120)]);
    assert_eq!(moved.outcome, Outcome::Same, "{:?} {:?}", moved.witness, moved.reasons);
}
