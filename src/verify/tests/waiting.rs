//! Programs that wait for inputs.

use super::*;

const HEAD: &str = "O1\nG21G90G17G94G54G80\n";
/// Waits for a part, and then for its removal.
const WAITS: &str = "N1IF[#1005EQ0]GOTO1\nG0X10.\nN2IF[#1005EQ1]GOTO2\n";

fn found(source: &str, target: &str) -> Outcome {
    let text = |body: &str| format!("{HEAD}{body}M30\n");
    run("fanuc", &text(source), "haas", &text(target), &[]).outcome
}

/// No value of the input leads through both loops: it changes while the program waits.
#[test]
fn what_comes_after_two_waits_is_compared() {
    let both = |source: &str, target: &str| found(&format!("{WAITS}{source}"), &format!("{WAITS}{target}"));
    assert_eq!(both("G0X20.\n", "G0X20.\n"), Outcome::Same);
    assert_eq!(both("G0X20.\n", "G0X21.\n"), Outcome::Different);
}

/// A wait with dwells lasts as many of them on both sides, whatever else stands in the loop.
#[test]
fn waits_with_dwells_are_compared() {
    let source = "N1IF[#1005EQ0]GOTO1\nWHILE[#1005EQ1]DO1\nG4P100\nEND1\nG0X20.\n";
    let target = |dwell: &str, x: &str| {
        format!("N1IF[#1005EQ0]GOTO1\nN2IF[#1005NE1]GOTO3\n#1=#1+1\n{dwell}\nGOTO2\nN3G0X{x}.\n")
    };
    assert_eq!(found(source, &target("G4P100", "20")), Outcome::Same);
    assert_eq!(found(source, &target("G4P200", "20")), Outcome::Different);
    assert_eq!(found(source, &target("G4P100", "21")), Outcome::Different);
}

/// How often the program went round counts too.
#[test]
fn turns_of_a_wait_are_counted_alike() {
    let source = "N1IF[#1005EQ0]GOTO1\n#100=0\nWHILE[#1005EQ1]DO1\n#100=#100+1\nEND1\n";
    let target = |first: u32, step: u32| {
        format!(
            "N1IF[#1005EQ0]GOTO1\n#100={first}\nN2IF[#1005NE1]GOTO3\n#1=1\n#100=#100+{step}\nGOTO2\nN3G0X20.\n"
        )
    };
    let source = format!("{source}G0X20.\n");
    assert_eq!(found(&source, &target(0, 1)), Outcome::Same);
    assert_eq!(found(&source, &target(1, 1)), Outcome::Different);
    assert_eq!(found(&source, &target(0, 2)), Outcome::Different);
}

/// A conversion that waits for another input ends where its source does not.
#[test]
fn a_wait_for_another_input_differs() {
    assert_eq!(
        found(&format!("{WAITS}G0X20.\n"), &format!("{}G0X20.\n", WAITS.replace("#1005EQ1", "#1006EQ1"))),
        Outcome::Different
    );
}

/// How long a program waits counts for nothing where it ends by itself: a limit of time is reached as before.
#[test]
fn a_limit_of_a_wait_is_reached() {
    let text =
        "#100=0\nN1IF[#1005EQ1]GOTO2\nG4P100\n#100=#100+1\nIF[#100LT50]GOTO1\n#3000=1(NO PART)\nN2G0X20.\n";
    assert_eq!(found(text, text), Outcome::Same);
    assert_eq!(found(text, &text.replace("NO PART", "PART")), Outcome::Different);
}

/// A way that an input must change for between two looks, in the midst of the program: what is alike there is compared, and
/// what differs leaves the way open.
#[test]
fn an_input_that_comes_on_after_something_was_done() {
    let text = "IF[#1005EQ1]GOTO2\nM8\nG4P500\nIF[#1005EQ1]GOTO3\n#3000=1(NO PART)\nN3G0X30.\nN2G0X20.\n";
    assert_eq!(found(text, text), Outcome::Same);
    assert_eq!(found(text, &text.replace("X30.", "X31.")), Outcome::Undecided);
}

/// A mode that the program asks for, and that its only caller never leaves in force.
#[test]
fn a_mode_that_no_caller_gives() {
    let text = |x: &str| {
        format!("O1\nG21G90G17G94G54G80\nM98P2\nM30\nO2\nIF[#4003EQ90]GOTO5\nG0X{x}.\nM99\nN5G0X1.\nM99\n")
    };
    let outcome = |x: &str| {
        let found = programs(("fanuc", &text("5")), ("fanuc", &text(x)), &[]).remove(1);
        (found.outcome, found.not_reached.len())
    };
    assert_eq!(outcome("5"), (Outcome::Same, 0));
    assert_eq!(outcome("6"), (Outcome::Undecided, 1));
}
