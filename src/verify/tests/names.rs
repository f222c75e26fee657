//! What variables are called on the two sides.

use super::run;
use crate::verify::Outcome;

#[test]
fn registers_have_the_names_that_the_lock_gives_them() {
    let source = "O1\nG0X#101\n#101=#101+1\nM30\n";
    let target = "O1\nG0X#117\n#117=#117+1\nM30\n";
    let found = run("fanuc", source, "fanuc", target, &[("#101", 117)]);
    assert_ne!(found.outcome, Outcome::Different, "{found:#?}");
    let found = run("fanuc", source, "fanuc", target, &[("#101", 118)]);
    assert_eq!(found.outcome, Outcome::Different);
}

/// The operator who reads the name of a variable at a stop enters a value there, on either machine.
#[test]
fn a_stop_that_names_a_variable_asks_for_it_on_both_sides() {
    let source = "N1 G90\nN2 V10=5 V11=5\nN3 M0\nN4 (ENTER NEW VALUE OF V10)\nN5 G0 X=V10\nN6 M30\n";
    let target = |named: &str, read: &str| {
        format!("O1\nG90\n#525=5\n#526=5\nM0 (ENTER NEW VALUE OF {named})\nG0X{read}\nM30\n")
    };
    let found = |named: &str, read: &str| {
        run("cc100", source, "fanuc", &target(named, read), &[("V10", 525), ("V11", 526)]).outcome
    };
    assert_ne!(found("#525", "#525"), Outcome::Different);
    assert_eq!(found("#526", "#525"), Outcome::Different);
    assert_eq!(found("#525", "#526"), Outcome::Different);
    assert_eq!(found("V10", "#525"), Outcome::Different);
}

/// A local is set in the level that runs: 7 comes from the operator, or 5 from the program.
#[test]
fn a_local_is_set_by_hand() {
    let program = |x: &str| format!("O1\nG90\n#1=5.\n#3006=1 (SET #1)\n#2=5.\nG0X{x}\nM30\n");
    assert_eq!(run("fanuc", &program("#1"), "fanuc", &program("#2"), &[]).outcome, Outcome::Different);
    assert_ne!(run("fanuc", &program("#1"), "fanuc", &program("#1"), &[]).outcome, Outcome::Different);
}
