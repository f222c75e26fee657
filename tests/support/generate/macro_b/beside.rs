//! Codes of the machine in the blocks of moves.

use super::Writer;
use crate::generate::beside::{Codes, Part, apart};
use crate::generate::{Source, Value};

const FANUC: &Codes = &[
    ("M3 S900", Part::Spindle),
    ("M4 S700", Part::Spindle),
    ("M3", Part::Spindle),
    ("M5", Part::Spindle),
    ("M19", Part::Spindle),
    ("M8", Part::Coolant),
    ("M8", Part::Coolant),
    ("M7", Part::Coolant),
    ("M9", Part::Coolant),
    ("M9", Part::Coolant),
    ("T2 M6", Part::Tool),
    ("T3", Part::Word),
    ("S1500", Part::Word),
    ("M0", Part::Stop),
    ("M1", Part::Stop),
    ("S[#1*10+600]", Part::Word),
];

const HAAS: &Codes = &[
    ("M3 S900", Part::Spindle),
    ("M4 S700", Part::Spindle),
    ("M3", Part::Spindle),
    ("M5", Part::Spindle),
    ("M19", Part::Spindle),
    ("M8", Part::Coolant),
    ("M8", Part::Coolant),
    ("M88", Part::Coolant),
    ("M89", Part::Coolant),
    ("M9", Part::Coolant),
    ("T2 M6", Part::Tool),
    ("T3", Part::Word),
    ("S1500", Part::Word),
    ("M0", Part::Stop),
    ("M1", Part::Stop),
    ("S[#1*10+600]", Part::Word),
];

impl Writer<'_> {
    /// A block that does something, and codes in it; what may not stand there has its own blocks behind.
    pub(super) fn beside(&mut self, block: usize, value: &Value, drawn: &[usize], choices: &mut Source<'_>) {
        let w = |letter| self.word(letter, value, false);
        let r = |letter| self.size(letter, value);
        let (words, then) = match block {
            0 | 1 => (format!("G0 {}", w('X')), ""),
            2 | 3 => (format!("G1 {} F150.", w('X')), ""),
            4 => (format!("G1 Z-1. {} F90.", w('Y')), ""),
            5 => (w('Y'), ""),
            6 => (format!("G91 G2 {} {} {} J0.", r('X'), r('Y'), r('I')), "G90 G1"),
            7 => ("G4 P500".into(), ""),
            8 => ("G53 G0 Z0.".into(), ""),
            9 => ("G91 G28 Z0.".into(), "G90"),
            10 => (format!("G99 G81 {} Z-3. R2. F120.", w('X')), "G80"),
            11 => ("G43 H2 G0 Z20.".into(), ""),
            12 => ("G55 G0 X2.".into(), "G54"),
            13 => (format!("G41 D3 G1 {} F100.", w('X')), "G40 G1 X0. Y0."),
            14 => ("G1 F200.".into(), ""),
            _ => (String::new(), ""),
        };
        // How many a Fanuc takes depends on the model: one, or three by parameter (facts/ambiguities.md 8).
        let (codes, most) = if self.haas { (HAAS, 1) } else { (FANUC, choices.pick(&[1, 1, 2, 3])) };
        let [here, behind] = apart(drawn, codes, most);
        let here = here.join(" ");
        let line = match choices.below(8) {
            0 => format!("{here} {words}"),
            1 => format!("/{words} {here}"),
            2 if !words.is_empty() => format!("{words} /{here}"),
            _ => format!("{words} {here}"),
        };
        self.line(line.trim());
        for code in behind {
            self.line(code);
        }
        if !then.is_empty() {
            self.line(then);
        }
    }
}
