//! Constants at a program's head that decide a branch, edited on both sides.

use super::{named, run};
use crate::verify::{Outcome, ProgramCertificate, SymbolMap, Why};

const SOURCE: &str = "O1\n#500=1(SIDE)\nG90 G0 X0.\nIF[#500EQ1]GOTO10\nX2.5\nGOTO20\nN10 X7.\nN20 M30\n";

/// The source above on another control, where this stands for its X2.5.
fn target(other: &str) -> String {
    format!("O1\n#500=1. (SIDE)\nG90 G0 X0.\nIF [#500 EQ 1] GOTO 10\n{other}\nGOTO 20\nN10 X7.\nN20 M30\n")
}

fn has(found: &ProgramCertificate, why: Why) -> bool {
    found.reasons.iter().any(|reason| reason.why == why)
}

#[test]
fn a_way_that_a_constant_decides_is_gone_with_another_one() {
    let found = run("fanuc", SOURCE, "haas", &target("X2.5"), &[]);
    assert!(!has(&found, Why::NotReached) && !has(&found, Why::Edited), "{found:#?}");
    assert_eq!((found.branches_covered, found.branches_total), (2, 2));
    let [edit] = found.edits.as_slice() else { panic!("{:?}", found.edits) };
    assert_eq!((&*edit.variable, edit.line, &*edit.register, edit.target_line), ("#500", 2, "#500", 2));
    assert!(edit.value != 1.0);
}

#[test]
fn a_fault_behind_the_constant_shows() {
    let found = run("fanuc", SOURCE, "haas", &target("X2.25"), &[]);
    assert_eq!(found.outcome, Outcome::Undecided);
    assert!(has(&found, Why::Edited) && has(&found, Why::NotReached), "{found:#?}");
    assert!(found.edits.is_empty() && found.branches_covered == 1);
}

/// The register of a local is none that the lock names. The first one with its value decides nothing.
#[test]
fn a_local_is_any_register_with_its_value_for_which_both_do_the_same() {
    let source = SOURCE.replace("#500", "#1");
    let target = |other: &str| {
        format!(
            "N1 O1\nN2 #V9=1.\nN3 #V1=1.\nN4 G90 G0 X0.\nN5 #IF V1 EQ 1. THEN GOTO :N10\nN6 {other}\nN7 #GOTO :N20\nN8 #:N10\nN9 X7.\n\
             N10 #:N20\nN11 M2\n"
        )
    };
    let run = |target: &str| {
        let names = SymbolMap { scratch: [1, 9].into(), ..SymbolMap::default() };
        named(("fanuc", &source), ("fadal", target), names).remove(0)
    };
    let found = run(&target("X2.5"));
    assert!(!has(&found, Why::NotReached) && !has(&found, Why::Edited), "{found:#?}");
    let [edit] = found.edits.as_slice() else { panic!("{:?}", found.edits) };
    assert_eq!((&*edit.variable, edit.line, &*edit.register, edit.target_line), ("#1", 2, "V1", 3));
    let found = run(&target("X2.25"));
    assert!(
        found.edits.is_empty() && has(&found, Why::NotReached) && !has(&found, Why::Edited),
        "{found:#?}"
    );
}

#[test]
fn what_is_not_the_same_literal_is_left_alone() {
    // The register gets another value first, or by an expression, or under a block skip; or it has another name.
    for first in ["#500=2.\n#500=1.", "#500=#501\n#500=1.", "#500=[1.]", "/#500=1."] {
        let found = run("fanuc", SOURCE, "haas", &target("X2.5").replacen("#500=1. (SIDE)", first, 1), &[]);
        assert!(found.edits.is_empty() && !has(&found, Why::Edited), "{first}: {found:#?}");
    }
    let found = run("fanuc", SOURCE, "haas", &target("X2.5"), &[("#500", 520)]);
    assert!(found.edits.is_empty(), "{found:#?}");
}

#[test]
fn only_a_head_is_edited() {
    // After a branch the constant is no operator's: the program never goes the other way.
    let source = SOURCE.replacen("#500=1(SIDE)", "IF[#501EQ1]GOTO5\nN5 #500=1", 1);
    let target = target("X2.5").replacen("#500=1. (SIDE)", "IF [#501 EQ 1] GOTO 5\nN5 #500=1.", 1);
    let found = run("fanuc", &source, "haas", &target, &[]);
    assert!(found.edits.is_empty() && !has(&found, Why::NotReached), "{found:#?}");
    assert_eq!(found.not_reached, [], "{found:#?}");
}

/// Past a switch at the head stand questions about what the program finds: they are searched with the switch set.
#[test]
fn past_a_switch_the_search_goes_on() {
    let text = |last: &str| {
        format!(
            "O1\n#1=0\nG0 X1.\nIF [#1 EQ 0] GOTO 9\nIF [#500 GT 512.5] GOTO 8\nG0 X2.\nN8\n\
             IF [[#501 - 3 * #502] EQ 77] GOTO 9\n{last}\nN9 M30\n"
        )
    };
    let found = run("fanuc", &text("G0 X4."), "haas", &text("G0 X4."), &[]);
    assert_eq!(found.not_reached, [], "{found:#?}");
    assert_eq!(found.outcome, Outcome::Same, "{found:#?}");
    // What differs only there is seen: no lock names the register of a local.
    let found = run("fanuc", &text("G0 X4."), "haas", &text("IF [#502 EQ 9] GOTO 9\nG0 X4."), &[]);
    assert_ne!(found.outcome, Outcome::Same, "{found:#?}");
}

#[test]
fn steps_that_a_loop_goes_by_are_tried_as_values() {
    // From 0 by .25 to the square of .5: other counts pass it by.
    let source = "O1\n#1=0\nN5#1=#1+.25\nIF[#1EQ#500]GOTO9\nIF[#1LT3.]GOTO5\nG0X1.\nN9M30\n";
    let target = "O1\n#1=0\nN5 #1=#1+.25\nIF [#1 EQ #500] GOTO 9\nIF [#1 LT 3.] GOTO 5\nG0 X1.\nN9 M30\n";
    let found = run("fanuc", source, "haas", target, &[]);
    assert!(!has(&found, Why::NotReached), "{found:#?}");
}

/// An operator's list of numbers may be long: here the last of twenty decides.
#[test]
fn the_last_of_many_constants_is_edited_too() {
    let many: String = (501..520).map(|number| format!("#{number}={number}.\n")).collect();
    let with = |text: &str| text.replacen("O1\n", &format!("O1\n{many}"), 1);
    let found = run("fanuc", &with(SOURCE), "haas", &with(&target("X2.5")), &[]);
    assert!(!has(&found, Why::NotReached) && !has(&found, Why::Edited), "{found:#?}");
}

/// A pocket whose step is left over only for some sizes, and only if its first literal says that it is one.
const SOLVED: &str = "O1\n#1=1\n#2=2.5\n#3=.5\nG20G90G17\nG0X0Y0\nIF[#1EQ1]GOTO10\n#4=#2-FIX[#2/#3]*#3\nIF[#4LT.05]THEN#4=#4+#3\n\
                      IF[#2GT[#3*9+7.123]]GOTO20\nG1X#4F10.\nGOTO10\nN20 G1 Y1. F10.\nN10 M30\n";

#[test]
fn literals_are_solved_for_together() {
    let found = run("fanuc", SOLVED, "fanuc", SOLVED, &[]);
    assert_eq!((&found.not_reached, &found.by_own_numbers), (&vec![], &vec![]), "{found:#?}");
    assert_eq!(found.outcome, Outcome::Same, "{found:#?}");
    // Two at once: their edits have one number.
    let two = found.edits.windows(2).any(|two| two[0].together == two[1].together);
    assert!(two, "{:?}", found.edits);
    let found = run("fanuc", SOLVED, "fanuc", &SOLVED.replace("Y1.", "Y1.1"), &[]);
    assert!(has(&found, Why::Edited) && found.outcome == Outcome::Undecided, "{found:#?}");
}
