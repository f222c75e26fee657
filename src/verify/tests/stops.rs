//! Programs that an alarm of the control stops.

use super::{Outcome, within};
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

/// The root of a negative number stops the source alone. Others went the same ways, and both sides did the same.
#[test]
fn values_that_the_old_machine_refuses_are_told() {
    let program = |root: &str, x: &str| {
        format!("O1\nG20G90G17G40G80G94G54\n#1=SQRT[{root}]\nIF[#1GT3.]GOTO5\nG1X1.F9.\nN5G0X{x}\nM30\n")
    };
    let found = within("fanuc", &program("#501", "2."), &program("ABS[#501]", "2."));
    assert!(!found.source_stops.is_empty() && found.reasons.is_empty(), "{found:#?}");
    assert_eq!(found.outcome, Outcome::Same, "{found:#?}");
    // What only such runs come to was never compared.
    let stops = program("#501", "2.").replace("N5G0", "N5#2=SQRT[-ABS[#1]]\nG0");
    let goes_on = stops.replace("-ABS[#1]", "ABS[#1]");
    let found = within("fanuc", &stops, &goes_on);
    assert!(found.source_stops.is_empty(), "{found:#?}");
    assert!(found.reasons.iter().any(|reason| reason.why == Why::SourceAlarms), "{found:#?}");
    let found = within("fanuc", &program("#501", "2."), &program("ABS[#501]", "3."));
    assert_eq!(found.outcome, Outcome::Different);
}
