//! Called programs that find a machine which their callers have started: a spindle that runs, coolant, a tool length.

use super::programs;
use crate::verify::{Outcome, Why};

/// What becomes of O2, which the callers of each side come to so; and what it rests on, if it is for review.
fn called(from: &str, callers: [&str; 2], source: &str, target: &str) -> (Outcome, String) {
    let to = if from == "haas" { "fanuc" } else { "haas" };
    let library = |callers: &str, text: &str| format!("{callers}O2\n{text}M99\n");
    let (ours, theirs) = (library(callers[0], source), library(callers[1], target));
    let found = programs((from, &ours), (to, &theirs), &[]);
    let program = found.into_iter().find(|found| found.program.as_deref() == Some("O0002"));
    let program = program.expect("O2 is verified");
    let reasons = program.reasons.iter().filter(|reason| reason.why == Why::NotByItself);
    (program.outcome, reasons.map(|reason| reason.text.clone()).collect())
}

/// A main program that does this, calls O2, and ends as both controls do.
fn main(number: u32, head: &str) -> String {
    format!("O{number}\nG21G90G17G40G49G54\n{head}G65P2A5.\nM5\nM9\nM30\n")
}

/// What becomes of O2 where one caller starts the machine; where another one does not; where that one calls it a second
/// time on a machine that stands; and where its one caller does not.
fn by_callers(from: &str, (head, off): (&str, &str), source: &str, target: &str) -> [Outcome; 4] {
    let both = main(1, head) + &main(3, "");
    let twice = main(1, &format!("{head}G65P2A7.\n{off}"));
    let callers = [main(1, head), both, twice, main(1, "")];
    callers.map(|callers| called(from, [&callers; 2], source, target).0)
}

/// The length that a caller's word named, and that the conversion names again.
#[test]
fn a_called_program_finds_the_length_of_its_callers() {
    use Outcome::{Different, Same, Undecided};
    let source = "Z#2\n";
    // A move in machine coordinates keeps it: manual of 2017, p. 281, p. 341.
    for (head, one) in [("G43H6Z30.\n", Undecided), ("G43H6Z30.\nG53G0Z0.\n", Same)] {
        let found = |target: &str| by_callers("haas", (head, "G49\n"), source, target);
        assert_eq!(found("G43Z#2H6\n"), [one, Different, Different, Different], "{head}");
        for target in ["G43Z#2H7\n", "G44Z#2H6\n", "G49Z#2\n"] {
            assert_eq!(found(target)[0], Different, "{head}{target}");
        }
    }
    let callers = main(1, "G43H6Z30.\n");
    let (_, why) = called("haas", [&callers; 2], source, "G43Z#2H6\n");
    assert!(why.contains("with a tool length in force, as its callers run it, it does the same"), "{why}");
    // Its own axis was not moved: the length stays on both controls, and the next word must not end it.
    let across = main(1, "G43H6Z30.\nG53G0X0.\n");
    assert_ne!(called("haas", [&across; 2], source, source).0, Different);
}

/// M3 acts when the move of its block is done on one control, and with its start on the other: beside a cut that is one
/// and the same where it turns already.
#[test]
fn a_called_program_finds_the_spindle_of_its_callers() {
    use Outcome::{Different, Undecided};
    let source = "M3G1X#1F150.\n";
    let found = |head: &str| by_callers("haas", (head, "M5\n"), source, source);
    assert_eq!(found("S800M3\n"), [Undecided, Different, Different, Different]);
    assert_eq!(found("S800M4\n")[0], Different);
    assert_eq!(found("M3\n")[0], Undecided);
    let callers = main(1, "S800M3\n");
    for target in ["M4G1X#1F150.\n", "M5\nG1X#1F150.\n", "S900M3\nG1X#1F150.\n"] {
        assert_eq!(called("haas", [&callers; 2], source, target).0, Different, "{target}");
    }
    let (_, why) = called("haas", [&callers; 2], source, source);
    assert!(why.contains("the spindle running, as its callers run it, it does the same"), "{why}");
}

#[test]
fn a_called_program_finds_the_coolant_of_its_callers() {
    use Outcome::{Different, Undecided};
    let source = "G91G2X10.Y10.I10.J0.F100.M8\nG90G1\n";
    let found = |head: &str| by_callers("fanuc", (head, "M9\n"), source, source);
    assert_eq!(found("M8\n"), [Undecided, Different, Different, Different]);
    assert_eq!(found("M7\n")[0], Different);
    let callers = main(1, "M8\n");
    for target in [source.replace("M8", "M7"), source.replace("M8", "").replace("G91", "G91M9\n")] {
        assert_eq!(called("fanuc", [&callers; 2], source, &target).0, Different, "{target}");
    }
}

#[test]
fn a_called_program_finds_the_feed_and_the_compensation_of_its_callers() {
    use Outcome::{Different, Same, Undecided};
    let feed = |target: &str| by_callers("haas", ("F200.\n", "F50.\n"), "G1X#1\n", target);
    assert_eq!(feed("G1X#1F200.\n")[..3], [Same, Undecided, Different]);
    assert_eq!(feed("G1X#1F150.\n")[0], Different);
    let head = ("G1F200.\nG42D5X1.\n", "G40X0.\n");
    let compensated = |target: &str| by_callers("haas", head, "X#1\n", target);
    assert_eq!(compensated("G42D5X#1\n"), [Undecided, Different, Different, Different]);
    assert_eq!(compensated("G41D5X#1\n")[0], Different);
    assert_eq!(compensated("G42D6X#1\n")[0], Different);
}

/// A message stops the spindle on one control by itself, and on the other by a word: nobody saw it turn before.
#[test]
fn a_spindle_that_is_found_and_stopped_is_none() {
    use Outcome::Different;
    let callers = main(1, "S800M3\n");
    let found = |target: &str| called("haas", [&callers; 2], "#3006=1(LOOK)\n", target).0;
    assert_ne!(found("M5M9\n#3006=1(LOOK)\n"), Different);
    assert_eq!(found("M5M9\n#3006=1(LOOK)\nM3\n"), Different);
    assert_eq!(found("#3006=1(LOOK)\nM5M9\n"), Different);
}

/// The target has flood alone, which its callers switch on in place of mist: each side is begun as its own callers do.
#[test]
fn each_side_finds_what_its_own_callers_started() {
    use Outcome::{Different, Undecided};
    let callers = [main(1, "M7\n"), main(1, "M8\n")];
    let found = |code: &str| {
        let [source, target] = ["M7", code].map(|code| format!("G1X#1F100.\n{code}\nX9.\n"));
        called("fanuc", [&callers[0], &callers[1]], &source, &target)
    };
    let (outcome, why) = found("M8");
    assert_eq!(outcome, Undecided, "{why}");
    assert!(why.contains("as the callers of each run it, it does the same"), "{why}");
    assert_eq!(found("M9").0, Different);
}

/// The Fadal ends coolant at M0 by itself. A reset and power-on switch it off, so a main program finds none; of one that returns nobody
/// knows what its callers left on, and a person is told so.
#[test]
fn a_stop_that_ends_what_was_found_on_rests_on_the_start() {
    let source = "O1\nL100\nM9\nM17\nM30\nG0G90G17G40G49G80E1\nS800M3\nG1F300.\nM0\nG0X5.\nM2\n";
    let target = "O1\nGOTO10\nM9\nM99\nN10G0G90G17G40G49G80G54\nS800M3\nG1F300.\nM5\nM0\nG0X5.\nM2\n";
    let found = programs(("fadal", source), ("fanuc", target), &[]).remove(0);
    assert_eq!(found.outcome, Outcome::Same, "{:?}", found.reasons);

    let stops = "G0G90G17G40G49G80G54\nS800M3\nG1F300.\n";
    let source = format!("O1\n{stops}M0\nM9\nG0X5.\nM99\n");
    let target = format!("O1\n{stops}M5\nM0\nM9\nG0X5.\nM99\n");
    let found = programs(("haas", &source), ("fanuc", &target), &[]).remove(0);
    assert_eq!(found.outcome, Outcome::Undecided, "{:?}", found.witness);
    assert!(found.reasons.iter().any(|reason| reason.why == Why::EntryState), "{:?}", found.reasons);
}
