//! Ways to an alarm that no run of a library goes, and what the texts say there.

use super::{Outcome, ProgramCertificate, Why, programs};

/// A subprogram that checks the work offset that its caller selects.
const CHECKED: &str = "\
O1
G21G90G17G40G49G80G94G98G54
M98P2
G0X1.
M30
O2
IF[#4014NE54]GOTO91
IF[#4006EQ21]GOTO10
#3000=20(WORKS IN MM ONLY)
N10G0X5.
M99
N91#3000=91(WRONG OFFSET)
M99
";

fn subprogram(to: &str, target: &str) -> ProgramCertificate {
    programs(("fanuc", CHECKED), (to, target), &[]).remove(1)
}

#[test]
fn alarms_that_both_texts_write_alike_are_compared_by_reading() {
    // The target may have other sequence numbers, and more brackets.
    let other = CHECKED.replace("#4014NE54]GOTO91", "[#4014]NE54.]GOTO9").replace("N91", "N9");
    for target in [CHECKED, &other] {
        let found = subprogram("fanuc", target);
        assert_eq!(found.outcome, Outcome::Same, "{found:#?}");
        let ways: Vec<_> = found.by_text.iter().map(|way| (way.line, way.way)).collect();
        // In inches, which no caller gives, it is run.
        assert_eq!(ways, [(7, "true")], "{found:#?}");
        assert_eq!((found.branches_covered, found.branches_total), (3, 3));
    }
}

#[test]
fn alarms_that_read_otherwise_are_not_compared() {
    for (from, to) in [
        ("#3000=91", "#3000=92"),
        ("WRONG OFFSET", "WRONG TOOL"),
        ("#4014NE54", "#4014NE55"),
        ("#4014NE54", "#4014GT54"),
        ("#4014NE54", "#4012NE54"),
        // Something is done before the alarm.
        ("N91#3000", "N91M5\n#3000"),
        ("N91#3000", "N91#500=1\n#3000"),
        ("N91#3000", "/N91#3000"),
        ("#4006EQ21]GOTO10\n#3000=20", "#4006EQ21]GOTO10\n#3000=21"),
    ] {
        assert_eq!(CHECKED.matches(from).count(), 1, "{from}");
        let found = subprogram("fanuc", &CHECKED.replace(from, to));
        assert_ne!(found.outcome, Outcome::Same, "{to}: {found:#?}");
        let why: Vec<Why> = found.reasons.iter().map(|reason| reason.why).collect();
        assert!(found.witness.is_some() || why.contains(&Why::NotReached), "{to}: {why:?}");
    }
}

#[test]
fn a_way_to_more_than_an_alarm_is_not_compared_by_reading() {
    let text = CHECKED.replace("N91#3000", "N91G0Z5.\n#3000");
    let found = subprogram("fanuc", &text);
    assert!(found.by_text.iter().all(|way| way.line != 7), "{found:#?}");
    let both = programs(("fanuc", &text), ("fanuc", &text), &[]).remove(1);
    assert_eq!(both.outcome, Outcome::Undecided, "{both:#?}");
}

/// A macro that stops with its own alarm whatever its argument is, but for one that no run gives it.
const TOO_BIG: &str = "\
O1
G21G90G17G40G49G80G94G98G54
G65P2A5.
G0X1.
M30
O2
IF[#1LT8.]GOTO91
G1X#1F100.
M99
N91#3000=35(CUTTER TOO BIG)
";

#[test]
fn a_call_that_every_run_stops_in_leaves_open_what_stands_after_it() {
    let main = |target: &str| programs(("fanuc", TOO_BIG), ("haas", target), &[]).remove(0);
    // No run comes to the move after the call, so it makes no difference where that goes.
    for target in [TOO_BIG.to_owned(), TOO_BIG.replace("G0X1.", "G0X2.")] {
        let found = main(&target);
        assert_eq!(found.outcome, Outcome::Undecided, "{found:#?}");
        let text = "every run that comes to line 3 stops in what it calls";
        assert!(found.reasons.iter().any(|reason| reason.text.contains(text)), "{found:#?}");
    }
    let fits = TOO_BIG.replace("A5.", "A9.");
    let found = programs(("fanuc", &fits), ("haas", &fits.replace("G0X1.", "G0X2.")), &[]).remove(0);
    assert_eq!(found.outcome, Outcome::Different);
}
