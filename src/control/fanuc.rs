//! The control that runs Fanuc Custom Macro B.

use super::library::{Library, ProgramRef};
use super::macro_b::{self, Alarms, Style};
use super::{Run, Scenario};
use crate::dialect::Control;

/// Alarms of the 0i; those that seed 001 names, and by recollection the others of the same list.
static STYLE: Style = Style {
    alarms: Alarms {
        overflow: "PS0111",
        division: "PS0112",
        domain: "PS0119",
        brackets: "PS0118",
        loops: "PS0124",
        loop_number: "PS0126",
        call_not_alone: "PS0127",
        no_sequence: "PS0128",
        atan: "PS1131",
        digits: "TOO MANY DIGITS",
        point: "PS0007",
        no_such_code: "PS0010",
        no_variable: "PS0115",
        too_deep: "PS0077",
        no_modal_call: "PS1100",
    },
    numbers_lathe_alarms: true,
    // The end of G68, and the watch over the spindle's speed.
    lathe_signs: &["G69", "G25", "G26"],
};

/// Runs a program. See [`super::Execute`].
pub fn execute(library: &Library<'_>, main: ProgramRef, control: &Control, scenario: &Scenario) -> Run {
    macro_b::execute(&STYLE, library, main, control, scenario)
}
