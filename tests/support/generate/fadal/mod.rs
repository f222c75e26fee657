//! Spells programs for the control with `#` lines for macros, and R words in its NC lines.

mod figures;
mod flow;
mod offsets;
mod own;
mod reach;
mod spelling;
mod talk;
mod words;

use super::{Kind, Policy, Program, Source, Step, UNKNOWN, Unary, Value, pointed};
use spelling::{name, text};
use std::fmt::Write;

/// The longest macro line.
const LINE: usize = 63;

pub fn write(program: &Program) -> String {
    let mut choices = Source::Seed(program.salt);
    // Subroutines of the main program share what becomes of it.
    let split = choices.below(program.subs.len() + 1);
    let split = if program.policy == Policy::Missing { 0 } else { split };
    let mut writer =
        Writer { out: String::new(), label: 10, part: 0, ends: Vec::new(), split, temporaries: 0 };
    writer.line("O1000 (MAIN");
    for (at, sub) in program.subs.iter().enumerate().take(split) {
        writer.line(&format!("L{}00", at + 1));
        writer.part = at + 1;
        writer.steps(sub);
        if at + 1 == split || choices.one_in(2) {
            writer.line("M17");
        }
    }
    if split > 0 {
        writer.line("M30");
    }
    if choices.one_in(3) {
        writer.line("#CLEAR");
    }
    if choices.one_in(2) {
        writer.line("#SET RND3");
    }
    writer.line("G0 G90 G17 G40 G49 G80 E1");
    writer.line("S800 M3");
    writer.line("G1 F300.");
    writer.part = 0;
    if program.policy == Policy::Reach {
        (0..=program.subs.len()).for_each(|part| writer.line(&format!("#V{}=0", 86 + part)));
    }
    writer.steps(&program.main);
    writer.line("M2");
    for (at, sub) in program.called().filter(|(at, _)| *at >= split) {
        writer.line(&format!("O{}", 1001 + at));
        (writer.label, writer.part) = (10, at + 1);
        writer.steps(sub);
        writer.line("M99");
    }
    writer.out
}

struct Writer {
    out: String,
    /// The next free label.
    label: u32,
    /// What is written: the main program, or a subprogram, counted from 1.
    part: usize,
    /// Where the loops around end.
    ends: Vec<u32>,
    /// Subprograms below it are L subroutines, the others programs.
    split: usize,
    /// Variables in use for parts of a line.
    temporaries: usize,
}

impl Writer {
    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
        self.temporaries = 0;
    }

    fn labels(&mut self, many: u32) -> u32 {
        let first = self.label;
        self.label += many;
        first
    }

    fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            self.step(step);
        }
    }

    fn step(&mut self, step: &Step) {
        let mut choices = step.choices();
        match &step.kind {
            Kind::Set { slot, value } => match (name(*slot), value) {
                (name, Value::Number(number)) if name.starts_with('R') && choices.one_in(2) => {
                    self.line(&format!("{name}{}", signed(*number)));
                }
                (name, value) => self.assign(&name, value),
            },
            Kind::SetCell { counter, value } => self.assign(&format!("V(60+{})", name(*counter)), value),
            Kind::Absolute(absolute) => self.line(if *absolute { "G90" } else { "G91" }),
            Kind::Move { rapid, axes, feed } => {
                let words: Vec<Option<String>> = axes.iter().map(|v| Some(self.word(v.as_ref()?))).collect();
                let mut line = String::from(if choices.one_in(5) {
                    ""
                } else if *rapid {
                    "G0 "
                } else {
                    "G1 "
                });
                for (axis, word) in ['X', 'Y', 'Z'].iter().zip(words) {
                    if let Some(word) = word {
                        let _ = write!(line, "{axis}{word} ");
                    }
                }
                if let Some(feed) = feed {
                    let _ = write!(line, "F{} ", pointed(*feed));
                }
                if line.is_empty() { self.line("G0") } else { self.line(line.trim_end()) }
            }
            Kind::Arc { clockwise, radius } => {
                let code = if *clockwise { "G2" } else { "G3" };
                let r = self.word(radius);
                let line = match choices.below(3) {
                    0 => format!("G91 {code} X{r} Y{r} I{r} J0"),
                    1 if r.starts_with('+') => format!("G91 {code} X{r} Y{r} R0{r}"),
                    _ => format!("{code} I{r}"),
                };
                self.line(&line);
                self.line("G90 G1");
            }
            Kind::Dwell(ms) => self.line(&format!("G4 P{ms}")),
            Kind::If { test, then, otherwise } => self.branch(test, then, otherwise, &mut choices),
            Kind::Repeat { counter, times, body } => {
                let name = name(*counter);
                let label = self.labels(2);
                self.ends.push(label + 1);
                if choices.one_in(2) {
                    self.line(&format!("#{name}=0"));
                    self.place(label);
                    self.line(&format!("#IF {name}>={times} THEN {}", Self::to(label + 1)));
                    self.steps(body);
                    self.line(&format!("#{name}={name}+1"));
                    self.line(&format!("#{}", Self::to(label)));
                } else {
                    self.line(&format!("#{name}={times}"));
                    self.place(label);
                    self.steps(body);
                    self.line(&format!("#{name}={name}-1"));
                    self.line(&format!("#IF {name}>0 THEN {}", Self::to(label)));
                }
                self.ends.pop();
                self.place(label + 1);
            }
            Kind::Leave(test) => {
                if let Some(end) = self.ends.last() {
                    let to = Self::to(*end);
                    self.when(test, &to);
                }
            }
            Kind::Switch { on, arms } => {
                let first = self.labels(arms.len() as u32 + 1);
                let end = first + arms.len() as u32;
                for at in 1..arms.len() as u32 {
                    self.line(&format!("#IF {} = {at} THEN {}", name(*on), Self::to(first + at)));
                }
                for (at, arm) in arms.iter().enumerate() {
                    self.place(first + at as u32);
                    self.steps(arm);
                    self.line(&format!("#{}", Self::to(end)));
                }
                self.place(end);
            }
            Kind::Call { sub, values, times } => {
                for (slot, value) in values {
                    self.assign(&name(*slot), value);
                }
                self.call(*sub, *times, &mut choices);
            }
            Kind::Cycle { kind, depth, plane, initial, places } => {
                let code = [81, 82, 83, 73, 84, 85, 86, 89, 76, 81, 83, 82][*kind % 12];
                let mut line = format!("G{code} {}", if *initial { "G98" } else { "G99" });
                let mut places = places.iter();
                if choices.one_in(2)
                    && let Some(place) = places.next()
                {
                    line += &self.at(place);
                }
                let depth = self.word(depth);
                let plane = match plane {
                    Value::Number(number) => signed(*number),
                    slot => self.word(slot),
                };
                let _ = write!(line, " Z{depth} R0{plane}");
                line += match code {
                    82 | 89 => " P250 F120.",
                    83 | 73 => " Q1.5 F120.",
                    84 => " Q1. F400.",
                    _ => " F120.",
                };
                self.line(&line);
                for place in places {
                    let line = self.at(place);
                    self.line(line.trim());
                }
                if choices.one_in(5) {
                    self.line("M45");
                }
                self.line("G80");
            }
            Kind::Offset(offset) => self.offset(offset, &mut choices),
            Kind::Machine(which) => {
                let lines = ["S1200 M3", "M5", "M8", "M9", "T2 M6", "M1", "M0", "S500"];
                self.line(lines[*which % lines.len()]);
            }
            Kind::Own(which, value) => self.own(*which, value),
            Kind::Figure(which, values) => self.figure(*which, values),
            Kind::Within { frame, values, body } => self.within(*frame, values, body),
            Kind::Modal { sub, values, body } => self.modal(*sub, values, body),
            Kind::Talk(which, value) => self.talk(*which, value, &mut choices),
            Kind::Words(which, value) => self.spelled(*which, value),
            Kind::Beside { block, value, codes } => self.beside(*block, value, codes, &mut choices),
            Kind::Cells(which, value) => self.cells(*which, value, &mut choices),
            Kind::Jump { given, form, arms } => self.jump(*given, *form, arms),
            Kind::Far { subs, given, form } => self.far(*subs, *given, *form),
            // Checks the machine's unit.
            Kind::Unit(metric) => self.line(if *metric { "G21" } else { "G20" }),
            Kind::Unknown => self.line(choices.pick(UNKNOWN)),
        }
    }

    fn at(&mut self, place: &[Option<Value>; 2]) -> String {
        let mut line = String::new();
        for (axis, value) in ['X', 'Y'].iter().zip(place) {
            if let Some(value) = value {
                let word = self.word(value);
                let _ = write!(line, " {axis}{word}");
            }
        }
        line
    }

    fn call(&mut self, sub: usize, times: u32, choices: &mut Source<'_>) {
        if sub >= self.split {
            let again = if times > 1 { format!(" L{times}") } else { String::new() };
            return self.line(&format!("M98 P{}{again}", 1001 + sub));
        }
        let code = 100 * (sub + 1) + times as usize;
        match choices.below(8) {
            0 => {
                self.line(&format!("R2+{code}."));
                self.line("L+R2");
            }
            1 => {
                self.line(&format!("L{code} G66"));
                self.line("X4.");
                self.line("G67");
            }
            _ => self.line(&format!("L{code}")),
        }
    }

    /// A value behind a letter: a number, or a signed R.
    fn word(&mut self, value: &Value) -> String {
        match value {
            Value::Number(number) => pointed(*number),
            Value::Slot(slot @ 0..=3) => format!("+{}", name(*slot)),
            Value::Unary(Unary::Negate, inner) if matches!(**inner, Value::Slot(0..=3)) => {
                format!("-{}", text(inner, 9))
            }
            other => {
                // Each word of a block has its own.
                let at = self.temporaries;
                let name = ["R9", "R4", "R3"][at % 3];
                self.assign(name, other);
                self.temporaries = at + 1;
                format!("+{name}")
            }
        }
    }
}

fn signed(number: f64) -> String {
    if number < 0.0 { pointed(number) } else { format!("+{}", pointed(number)) }
}
