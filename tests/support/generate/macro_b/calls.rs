//! Calls of all forms.

use super::Writer;
use crate::generate::{Policy, Source, Step, Value};
use std::fmt::Write;

impl Writer<'_> {
    /// The number of a subprogram: some are called by a code of the machine.
    pub(super) fn number(&self, sub: usize) -> usize {
        if self.by_code() { [9018, 9001, 9020][sub % 3] } else { 1001 + sub }
    }

    /// True where the profile's codes call the subprograms.
    fn by_code(&self) -> bool {
        let calls = matches!(self.program.policy, Policy::Calls | Policy::Arguments);
        !self.haas && calls && self.program.salt.is_multiple_of(4) && self.program.subs.len() <= 3
    }

    /// True where a subprogram comes back to a sequence number of its caller: it is called by M98 alone.
    pub(super) fn goes_on(&self, sub: usize) -> bool {
        let salted = (self.program.salt as usize / 8 + sub).is_multiple_of(5);
        self.program.policy == Policy::Calls && !self.haas && salted
    }

    /// The number that such a one comes back to.
    pub(super) fn entry(&self, sub: usize) -> usize {
        8000 + sub
    }

    pub(super) fn call(
        &mut self,
        sub: usize,
        values: &[(usize, Value)],
        times: u32,
        choices: &mut Source<'_>,
    ) {
        let number = self.number(sub);
        let again = if times > 1 { format!(" L{times}") } else { String::new() };
        if self.goes_on(sub) {
            // Called once in a program, so that its number stands there once, behind the call.
            if !self.entries.contains(&sub) {
                self.entries.push(sub);
                self.line(&format!("M98 P{number}"));
                self.line("G0 X77.");
                self.line(&format!("N{}", self.entry(sub)));
            }
            return;
        }
        match choices.below(8) {
            0 | 1 => {
                for (slot, value) in values {
                    self.set(self.name(*slot), value);
                }
                // A copy of what cannot be converted would stand in the caller.
                let apart = self.program.policy == Policy::Missing;
                if self.haas && !apart && choices.one_in(3) && self.local.len() < 4 {
                    let label = self.labels(1);
                    self.local.push((sub, label));
                    self.line(&format!("M97 P{label}{again}"));
                } else if !self.haas && times > 1 && choices.one_in(3) {
                    self.line(&format!("M98 P{times:04}{number:04}"));
                } else if self.by_code() && sub % 3 == 1 {
                    self.line("M201");
                } else {
                    self.line(&format!("M98 P{number}{again}"));
                }
            }
            2 if !self.haas => {
                let arguments = self.arguments(values, choices);
                self.line(&format!("G66 P{number}{arguments}"));
                self.line(choices.pick(&["X5.", "Y-3. Z1.", "G0 X1.", "M8"]));
                self.line("G67");
            }
            _ => {
                let arguments = self.arguments(values, choices);
                let again = if choices.one_in(2) { again } else { String::new() };
                let line = match sub % 3 {
                    0 if self.by_code() => format!("G383{again}{arguments}"),
                    2 if self.by_code() => format!("M910{arguments}"),
                    _ => format!("G65 P{number}{again}{arguments}"),
                };
                if choices.one_in(4) { self.line(&line.replace(' ', "")) } else { self.line(&line) }
            }
        }
    }

    /// A modal call around moves; where there is none, the subprogram is called behind them.
    pub(super) fn modal(
        &mut self,
        sub: usize,
        values: &[(usize, Value)],
        body: &[Step],
        choices: &mut Source<'_>,
    ) {
        if self.haas || self.goes_on(sub) {
            self.steps(body);
            return self.call(sub, values, 1, choices);
        }
        let (number, arguments) = (self.number(sub), self.arguments(values, choices));
        let again = if choices.one_in(4) { " L2" } else { "" };
        self.line(&format!("G66 P{number}{again}{arguments}"));
        self.steps(body);
        self.line("G67");
    }

    /// Arguments by specification I, by II, or of both.
    pub(super) fn arguments(&self, values: &[(usize, Value)], choices: &mut Source<'_>) -> String {
        const ONE: [char; 10] = ['A', 'B', 'C', 'I', 'J', 'K', 'D', 'E', 'F', 'H'];
        const REST: [char; 12] = ['A', 'B', 'C', 'I', 'J', 'K', 'D', 'M', 'Q', 'R', 'S', 'X'];
        let way = choices.below(6);
        let mut out = String::new();
        let mut used = Vec::new();
        for (slot, value) in values {
            let letter = match way {
                0..=2 => ONE[*slot % 10],
                3 => choices.pick(&REST),
                _ => choices.pick(&REST[..6]),
            };
            if used.contains(&letter) && (way < 4 || !('I'..='K').contains(&letter)) {
                continue;
            }
            used.push(letter);
            let _ = write!(out, " {}", self.word(letter, value, choices.one_in(12)));
        }
        out
    }

    pub(super) fn local_subs(&mut self) {
        let mut at = 0;
        while at < self.local.len() {
            let (sub, label) = self.local[at];
            self.line(&format!("N{label}"));
            let body = self.program.subs[sub].clone();
            (self.loops, at) = (0, at + 1);
            self.steps(&body);
            self.line("M99");
        }
        self.local.clear();
    }
}
