//! Programs that an alarm of the control stops.

use super::{Outcome, programs, within};
use crate::verify::Why;

/// The root of -1 stops both, and nobody saw that the moves after it are not the same.
#[test]
fn what_stands_after_an_alarm_is_not_compared() {
    let program = |x: &str| format!("O1\nG20G90G17G40G80G94G54\nG0X1.\n#1=SQRT[-1.]\nG0X{x}\nM30\n");
    let found = within("fanuc", &program("5."), &program("9."));
    assert_eq!(found.outcome, Outcome::Undecided, "{found:#?}");
    assert!(found.reasons.iter().any(|reason| reason.why == Why::SourceAlarms), "{found:#?}");
    // Where another run comes to its end, the one that stops is a run like any other.
    let program =
        |x: &str| format!("O1\nG20G90G17G40G80G94G54\nIF[#500EQ1.]GOTO5\n#1=SQRT[-1.]\nN5G0X{x}\nM30\n");
    assert_eq!(within("fanuc", &program("5."), &program("5.")).outcome, Outcome::Same);
    assert_eq!(within("fanuc", &program("5."), &program("9.")).outcome, Outcome::Different);
}

/// The root of a negative number stops the source alone. Its caller gives none, and others went the same ways alike.
#[test]
fn values_that_the_old_machine_refuses_are_told_of_what_is_called() {
    let library = |root: &str, x: &str| {
        format!(
            "O1\nG20G90G17G40G80G94G54\nG65P2A16.\nM30\nO2\n#2=SQRT[{root}]\nIF[#2GT3.]GOTO5\nG1X1.F9.\nN5G0X{x}\nM99\n"
        )
    };
    let of_called = |source: &str, target: &str| {
        let mut found = programs(("fanuc", source), ("fanuc", target), &[]);
        assert_eq!(found.len(), 2);
        found.remove(1)
    };
    let found = of_called(&library("#1", "2."), &library("ABS[#1]", "2."));
    assert!(!found.source_stops.is_empty() && found.reasons.is_empty(), "{found:#?}");
    assert_eq!(found.outcome, Outcome::Same, "{found:#?}");
    assert_eq!(of_called(&library("#1", "2."), &library("ABS[#1]", "3.")).outcome, Outcome::Different);
}
