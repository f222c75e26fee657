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
