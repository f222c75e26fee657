//! Offsets, positions read back.

use super::{Writer, name};
use crate::generate::{Offset, Source};

impl Writer {
    pub(super) fn offset(&mut self, offset: &Offset, choices: &mut Source<'_>) {
        let axis = |axis: usize| ['X', 'Y', 'Z'][axis];
        match offset {
            Offset::Select(row) => self.line(&format!("G{}", 53 + row)),
            Offset::Write { row, axis: which, value } => {
                let variable = self.variable(value);
                self.line(&format!("TRF=G{} {}={variable}", 53 + row, axis(*which)));
            }
            Offset::Read { row, axis: which, slot } => {
                self.line(&format!("TRF=G{} {}={}", 53 + row, name(*slot), axis(*which)));
            }
            Offset::Shift(_) | Offset::Position(_) => self.line(choices.pick(&["G92 X0 Y0", "G92 X5"])),
            Offset::Length(tool) => self.line(&format!("G0 Z30 T{tool:02}")),
            Offset::NoLength => self.line("T00"),
            Offset::WriteTool { tool, value } => {
                let variable = self.variable(value);
                self.line(&format!("COR=T{tool} {}={variable}", choices.pick(&['L', 'R'])));
            }
            Offset::ReadTool { tool, slot } => {
                self.line(&format!("COR=T{tool} {}={}", name(*slot), choices.pick(&['L', 'R'])));
            }
            Offset::ReadPosition { axis: which, slot } => {
                self.line(&format!("{}={}", name(*slot), axis(*which)));
            }
            Offset::ReadModal(slot) => {
                let past = self.labels(1);
                self.line(&format!("TST G{}", choices.pick(&[90, 0, 54, 1])));
                self.line(&format!("BEQ P{past}"));
                self.line(&format!("{}=1", name(*slot)));
                self.place(past);
            }
            Offset::Home => {
                self.line("G53");
                self.line("G0 Z0 T00");
                self.line("G54");
            }
        }
    }
}
