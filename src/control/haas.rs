//! The control that runs Haas macros.

use super::library::{Library, ProgramRef};
use super::macro_b::{self, Alarms, Style};
use super::{Run, Scenario};
use crate::dialect::Control;

/// No source numbers the control's own alarms.
static STYLE: Style = Style {
    alarms: Alarms {
        overflow: "",
        division: "",
        domain: "",
        brackets: "",
        loops: "",
        loop_number: "",
        call_not_alone: "",
        no_sequence: "",
        atan: "",
        digits: "",
        point: "",
        no_such_code: "",
        no_variable: "",
        too_deep: "",
        no_modal_call: "",
    },
    numbers_lathe_alarms: false,
    lathe_signs: &[],
};

/// Runs a program. See [`super::Execute`].
pub fn execute(library: &Library<'_>, main: ProgramRef, control: &Control, scenario: &Scenario) -> Run {
    macro_b::execute(&STYLE, library, main, control, scenario)
}
