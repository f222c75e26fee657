//! Codes beside moves, and rows, jumps and calls by computed numbers.

use super::{Writer, name};
use crate::generate::beside::{Codes, Part, apart};
use crate::generate::draw::GIVEN;
use crate::generate::{Source, Step, Value};

const CODES: &Codes = &[
    ("M8", Part::Coolant),
    ("M9", Part::Coolant),
    ("M8", Part::Coolant),
    ("M9", Part::Coolant),
    ("T01", Part::Word),
    ("T02", Part::Word),
    ("S800", Part::Word),
    ("S1500", Part::Word),
    ("M0", Part::Stop),
];

impl Writer {
    /// A block that does something, and codes in it; what may not stand there has its own blocks behind.
    pub(super) fn beside(&mut self, block: usize, value: &Value, drawn: &[usize], choices: &mut Source<'_>) {
        let words = match block {
            0 | 1 => "G0 X10 Y5",
            2 | 3 => "G1 X4 F600",
            4 => "G1 Z-1 Y3",
            5 => "Y7",
            6 => "G0 Z30",
            7 => "G3 X0 Y10 R-10",
            8 => "G53 G0 Z0",
            9 => "G92 X0",
            10 => "G55",
            11 => "G41 T03",
            12 | 13 => {
                let w = self.variable(value);
                self.line("G1");
                return self.line(&format!("X={w}"));
            }
            14 => "G1 F500",
            _ => "",
        };
        if block == 7 {
            self.line("G0 X10 Y0");
        }
        let [here, behind] = apart(drawn, CODES, choices.pick(&[1, 1, 2]));
        let here = here.join(" ");
        let line = if choices.one_in(6) { format!("{here} {words}") } else { format!("{words} {here}") };
        self.line(line.trim());
        behind.iter().for_each(|code| self.line(code));
        match block {
            7 => self.line("G1"),
            8..=10 => self.line("G54"),
            11 => self.line("G40"),
            _ => {}
        }
    }

    /// No variable is found by a number here; rows of tables and codes are.
    pub(super) fn cells(&mut self, which: usize, value: &Value) {
        let (given, w) = (name(GIVEN + which % 4), self.variable(value));
        match which {
            0..4 => {
                let past = self.labels(1);
                self.line("V77=55");
                self.line(&format!("V79={given}-3 BLE P{past}"));
                self.line("V77=57");
                self.place(past);
                self.line(&format!("TRF=V77 X={w}"));
                self.line("TRF=V77 V31=X");
            }
            4 | 5 => self.line(&format!("TRF={given} X={w}")),
            6 | 7 => {
                self.line(&format!("V77={given}+54"));
                self.line("TRF=V77 V31=Y");
            }
            8 | 9 => self.line(&format!("COR={given} R={w}")),
            10 => {
                self.line(&format!("V77={given}+1"));
                self.line("COR=V77 V31=R");
            }
            11 => self.line(&format!("G={given}")),
            12 => {
                self.line(&format!("V77={given}+54"));
                self.line("G=V77");
            }
            13 => self.line(&format!("T={given}")),
            _ => self.line(&format!("M={given}")),
        }
    }

    /// A computed jump is taken three times at most, wherever it goes.
    pub(super) fn jump(&mut self, given: usize, form: usize, arms: &[Vec<Step>]) {
        let name = name(given);
        let first = self.labels(arms.len() as u32 + 1);
        let end = first + arms.len() as u32;
        self.count(end);
        match form {
            0 | 1 => {
                self.line("V79=0");
                self.line("TST V79");
                self.line(&format!("BEQ {name}"));
            }
            2 => {
                self.line(&format!("V78={name}+1"));
                self.line(&format!("TST {name}"));
                self.line("BGT V78");
            }
            3 => {
                self.line(&format!("TST {name}"));
                self.line(&format!("BGE {name}"));
            }
            _ => {
                let past = self.labels(1);
                self.line(&format!("V78={first}"));
                self.line(&format!("V79={name}-4 BLE P{past}"));
                self.line(&format!("V78={}", first + 1));
                self.place(past);
                self.line("V79=0");
                self.line("TST V79");
                self.line("BEQ V78");
            }
        }
        for (at, arm) in arms.iter().enumerate() {
            self.place(first + at as u32);
            self.steps(arm);
            self.line(&format!("G24 P{end}"));
        }
        self.place(end);
    }

    /// A computed call: of one of two subprograms, or of the label that circumstances name.
    pub(super) fn far(&mut self, [one, other]: [usize; 2], given: usize, form: usize) {
        let name = name(given);
        let end = self.labels(1);
        self.line("V76=22");
        if form < 6 {
            self.line(&format!("V77={}", 1 + one));
            self.line(&format!("V79={name}-4 BLE P{end}"));
            self.line(&format!("V77={}", 1 + other));
            self.place(end);
            return self.line("G=V76 P=V77");
        }
        self.count(end);
        self.line(&format!("G=V76 P={name}"));
        self.place(end);
    }

    /// Goes on at a label where what nothing else bounds has come by three times.
    fn count(&mut self, end: u32) {
        let counter = ["VD", "VE", "VF", "VG"][self.part % 4];
        self.line(&format!("INC {counter}"));
        self.line(&format!("V79={counter}-3 BGT P{end}"));
    }
}
