//! Offsets, positions read back.

use super::Writer;
use super::spelling::name;
use crate::generate::{Offset, Source};

impl Writer {
    pub(super) fn offset(&mut self, offset: &Offset, choices: &mut Source<'_>) {
        let axis = |axis: usize| ['X', 'Y', 'Z'][axis];
        match offset {
            Offset::Select(row) => self.line(&format!("E{} X0 Y0", row + 3 * choices.below(2) as u32)),
            Offset::Write { row, axis: which, value } if choices.one_in(2) => {
                self.assign(&format!("F{}{row}", axis(*which)), value);
            }
            Offset::Write { row, axis: which, value } => {
                let word = self.word(value);
                self.line(&format!("G10 L2 P{row} {}{word}", axis(*which)));
            }
            Offset::Read { row, axis: which, slot } => {
                self.line(&format!("#{}=F{}{row}", name(*slot), axis(*which)));
            }
            Offset::Shift([x, y]) | Offset::Position([x, y]) => {
                let (x, y) = (self.word(x), self.word(y));
                self.line(&format!("G92 X{x} Y{y}"));
            }
            Offset::Length(tool) => self.line(&format!("H{tool} Z30.")),
            Offset::NoLength => self.line(choices.pick(&["H0", "G49"])),
            Offset::WriteTool { tool, value } => {
                let table = choices.pick(&["H", "D"]);
                self.assign(&format!("{table}{tool}"), value);
            }
            Offset::ReadTool { tool, slot } => {
                let table = choices.pick(&["H", "H", "D"]);
                self.line(&format!("#{}={table}{tool}", name(*slot)));
            }
            Offset::ReadPosition { axis: which, slot } => {
                self.line(&format!("#{}=A{}", name(*slot), axis(*which)));
            }
            Offset::ReadModal(slot) => self.line(&format!("#{}=G({})", name(*slot), choices.pick(&[1, 5]))),
            Offset::Home => self.line(choices.pick(&["E0 X0 Y0", "H0 Z0", "G28 X0 Y0 Z0"])),
        }
    }
}
