//! Offsets, positions read back.

use super::Writer;
use crate::generate::{Offset, Source};

impl Writer<'_> {
    pub(super) fn offset(&mut self, offset: &Offset, choices: &mut Source<'_>) {
        let axis = |axis: usize| ['X', 'Y', 'Z'][axis];
        match offset {
            Offset::Select(row) => match choices.below(6) {
                0 if self.haas => self.line(&format!("G{}", 109 + row)),
                0 => self.line(&format!("G54.1 P{row}")),
                1 if self.haas => self.line(&format!("G154 P{row}")),
                _ => self.line(&format!("G{}", 53 + row)),
            },
            Offset::Write { row, axis: which, value } => {
                if choices.one_in(2) {
                    self.set(format!("#{}", 5201 + 20 * *row as usize + which), value);
                } else {
                    let word = self.word(axis(*which), value, false);
                    self.line(&format!("G90 G10 L2 P{row} {word}"));
                }
            }
            Offset::Read { row, axis, slot } => {
                let line = format!("{}=#{}", self.name(*slot), 5201 + 20 * *row as usize + axis);
                self.line(&line);
            }
            Offset::Shift([x, y]) => {
                let line = format!("G52 {} {}", self.word('X', x, false), self.word('Y', y, false));
                self.line(&line);
                self.line("G0 X1. Y1.");
                if choices.one_in(2) {
                    self.line("G52 X0. Y0.");
                }
            }
            Offset::Position([x, y]) => {
                let line = format!("G92 {} {}", self.word('X', x, false), self.word('Y', y, false));
                self.line(&line);
            }
            Offset::Length(tool) => self.line(&format!("G43 H{tool} Z30.")),
            Offset::NoLength => self.line("G49"),
            Offset::WriteTool { tool, value } => {
                let (code, first) = if choices.one_in(2) { ("L10", 2000) } else { ("L12", 2400) };
                if self.haas && choices.one_in(2) {
                    self.set(format!("#{}", first + tool), value);
                } else {
                    let word = self.word('R', value, false);
                    self.line(&format!("G90 G10 {code} P{tool} {word}"));
                }
            }
            Offset::ReadTool { tool, slot } => {
                let first = match (self.haas, choices.below(3)) {
                    (true, 0) => 2000,
                    (true, 1) => 2200,
                    (true, _) => 2400,
                    (false, 0) => 11000,
                    (false, 1) => 10000,
                    (false, _) => 13000,
                };
                let line = format!("{}=#{}", self.name(*slot), first + tool);
                self.line(&line);
            }
            Offset::ReadPosition { axis, slot } => {
                let line = format!("{}=#{}", self.name(*slot), choices.pick(&[5001, 5021, 5041]) + axis);
                self.line(&line);
            }
            Offset::ReadModal(slot) => {
                let group = choices.pick(&[4001, 4003, 4002, 4006]);
                let line = format!("{}=#{group}", self.name(*slot));
                self.line(&line);
                if group == 4003 && choices.one_in(2) {
                    self.line("G91 G0 X2.");
                    let line = format!("G{}", self.name(*slot));
                    self.line(&line);
                }
            }
            Offset::Home if choices.one_in(2) => self.line("G53 G0 Z0."),
            Offset::Home => {
                self.line("G91 G28 Z0.");
                self.line("G90");
            }
        }
    }
}
