//! Codes beside moves, and variables, jumps and calls by computed numbers.

use super::Writer;
use super::spelling::{name, text};
use crate::generate::beside::{Codes, Part, apart};
use crate::generate::draw::GIVEN;
use crate::generate::{Source, Step, Value};

const CODES: &Codes = &[
    ("M3 S900", Part::Spindle),
    ("M4 S700", Part::Spindle),
    ("M3", Part::Spindle),
    ("M5", Part::Spindle),
    ("M5", Part::Spindle),
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
    ("S800.2", Part::Word),
];

/// Where computed variables begin.
const BASES: [u32; 8] = [1, 7, 40, 50, 60, 70, 80, 95];

impl Writer {
    /// A block that does something, and codes in it; what may not stand there has its own blocks behind.
    pub(super) fn beside(&mut self, block: usize, value: &Value, drawn: &[usize], choices: &mut Source<'_>) {
        let w = self.word(value);
        let (words, then) = match block {
            0 | 1 => (format!("G0 X{w}"), ""),
            2 | 3 => (format!("G1 X{w} F150."), ""),
            4 => (format!("G1 Z-1. Y{w} F90."), ""),
            5 => (format!("Y{w}"), ""),
            6 => ("G2 I4. F90.".into(), "G1"),
            7 => ("G4 P500".into(), ""),
            8 => ("E0 G0 X0 Y0".into(), "E1"),
            9 => ("G28 X0 Y0".into(), ""),
            10 => (format!("G99 G81 X{w} Z-3. R0+2. F120."), "G80"),
            11 => ("H2 G0 Z20.".into(), ""),
            12 => ("E2 X2.".into(), "E1 X1."),
            13 => (format!("G41 D3 G1 X{w} F100."), "G40 G1 X0 Y0"),
            14 => ("G1 F200.".into(), ""),
            _ => (String::new(), ""),
        };
        let [mut here, mut behind] = apart(drawn, CODES, choices.pick(&[1, 2, 2, 3]));
        // Only what the spindle does may stand beside a tool change (facts/fadal-target.md).
        if here.contains(&"T2 M6") {
            behind.extend(here.extract_if(.., |code| matches!(*code, "M7" | "M8" | "M9")));
        }
        let here = here.join(" ");
        let line = match choices.below(6) {
            0 => format!("{here} {words}"),
            1 => format!("/{words} {here}"),
            _ => format!("{words} {here}"),
        };
        self.line(line.trim());
        behind.iter().for_each(|code| self.line(code));
        if !then.is_empty() {
            self.line(then);
        }
    }

    pub(super) fn cells(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let given = name(GIVEN + which % 4);
        let base = choices.pick(&BASES);
        let text = if text(value, 0).len() < 30 { text(value, 0) } else { "V1".into() };
        let write = format!("#V({base}+{given})={text}");
        let lines = match which {
            0 | 1 => {
                let past = self.labels(1);
                self.line(&format!("#IF ({given}<0) OR ({given}>9) THEN {}", Self::to(past)));
                self.line(&format!("#V({base}+INT({given}))={text}"));
                return self.place(past);
            }
            2 => vec![
                "#V5=2".into(),
                format!("#IF {given}>3 THEN V5=4"),
                format!("#V({base}+V5)={text}"),
                "#R3=V5".into(),
                "X+R3".into(),
            ],
            3 => {
                let again = self.labels(1);
                self.line("#V6=0");
                self.place(again);
                self.line(&format!("#V({base}+V6)={text}"));
                self.line("#V6=V6+1");
                return self.line(&format!("#IF V6<5 THEN {}", Self::to(again)));
            }
            4 | 5 => vec![format!("#V({given})={text}"), format!("#V6=V({base})")],
            6 => vec![format!("#V6=V({base}+{given})"), "#R3=V6".into(), "X+R3".into()],
            7 => vec!["#INPUT V5".into(), format!("#V(V5)={text}")],
            8 => vec!["#INPUT V5".into(), format!("#V6=V({base}+V5)"), "#R3=V6".into(), "Y+R3".into()],
            9 => vec![format!("#V5=AX*2"), format!("#V({base}+V5)={text}")],
            10 => vec![format!("#H({given})={text}")],
            11 => vec![format!("#V6=D({given})"), "#V6=0".into()],
            12 => vec!["#V5=2".into(), format!("#FX(V5)={text}"), "#V6=FX(V5)".into()],
            13 => vec![format!("#V5={given}"), "#V(V5)=V(V5)+1".into()],
            _ => vec![write],
        };
        lines.iter().for_each(|line| self.line(line));
    }

    /// A computed jump is taken three times at most, wherever it goes. In a subprogram one place of two follows.
    pub(super) fn jump(&mut self, given: usize, form: usize, arms: &[Vec<Step>]) {
        let name = name(given);
        let first = self.labels(arms.len() as u32 + 1);
        let end = first + arms.len() as u32;
        self.count(end);
        if self.part > 0 {
            self.line(&format!("#IF {name}>3 THEN GOTO N{}", first + 1));
        } else {
            match form {
                0 | 1 => self.line(&format!("#R2={name}")),
                2 => self.line(&format!("#R2={name}*3")),
                _ => {
                    self.line(&format!("#R2={first}"));
                    self.line(&format!("#IF {name}>4 THEN R2={}", first + 1));
                }
            }
            self.line("M99 P+R2");
        }
        for (at, arm) in arms.iter().enumerate() {
            self.line(&format!("N{} (PLACE", first + at as u32));
            self.steps(arm);
            self.line(&format!("#{}", Self::to(end)));
        }
        self.place(end);
    }

    /// A computed call: of one of two subprograms, or of what circumstances name.
    pub(super) fn far(&mut self, [one, other]: [usize; 2], given: usize, form: usize) {
        let name = name(given);
        let apart = (one < self.split) != (other < self.split);
        let other = if apart { one } else { other };
        if form < 6 {
            let local = one < self.split;
            let [one, other] = [one, other].map(|sub| if local { 100 * (sub + 1) + 1 } else { 1001 + sub });
            self.line(&format!("#R3={one}"));
            self.line(&format!("#IF {name}>4 THEN R3={other}"));
            return self.line(if local { "L+R3" } else { "M98 P+R3" });
        }
        let end = self.labels(1);
        self.count(end);
        self.line(&format!("#R3={}{name}", if form == 6 { "" } else { "1000+" }));
        self.line("M98 P+R3");
        self.place(end);
    }

    /// Goes on at a label where what nothing else bounds has come by three times.
    fn count(&mut self, end: u32) {
        let counter = format!("V{}", 86 + self.part);
        self.line(&format!("#{counter}={counter}+1"));
        self.line(&format!("#IF {counter}>3 THEN {}", Self::to(end)));
    }
}
