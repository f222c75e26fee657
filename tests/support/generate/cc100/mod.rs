//! Spells programs for the control that takes one operation an assignment and branches on what
//! the last one gave.

mod figures;
mod flow;
mod offsets;
mod own;
mod reach;
mod words;

use super::{Binary, File, Kind, Policy, Program, Relation, Source, Step, UNKNOWN, Value, plain};
use std::fmt::Write;

pub fn write(program: &Program) -> Vec<File> {
    let mut choices = Source::Seed(program.salt);
    let label = 10 + program.subs.len() as u32;
    let numbers = choices.one_in(2);
    // A part of a program shares what becomes of it; a cycle is a program of its own.
    let cycles = program.policy == Policy::Missing;
    let block = numbers.then_some(1);
    let mut writer = Writer { out: String::new(), block, label, part: 0, cycles, ends: Vec::new(), used: 0 };
    writer.line("G90");
    writer.line("G53");
    writer.line("G0 Z0 T00");
    writer.line("G54");
    writer.line("G1 F800");
    if program.policy == Policy::Reach {
        ["VD=0", "VE=0", "VF=0", "VG=0"].iter().for_each(|line| writer.line(line));
    }
    writer.steps(&program.main);
    writer.line("M30");
    let mut files = Vec::new();
    for (at, sub) in program.called() {
        if cycles {
            files.push(std::mem::take(&mut writer.out));
            writer.block = block;
        } else {
            writer.line(&format!("${}", 1 + at));
        }
        writer.part = at + 1;
        writer.steps(sub);
        writer.line(if cycles { "M2" } else { "G99" });
    }
    files.push(writer.out);
    let named = files.into_iter().enumerate().map(|(at, text)| {
        let name = if at == 0 { "random.nc".into() } else { format!("cycle{}.nc", CYCLE + at - 1) };
        File { name, text }
    });
    named.collect()
}

/// The first subprogram, where they are cycles; `G8` calls it before the number.
const CYCLE: usize = 20;

struct Writer {
    out: String,
    /// The number of the next block; none where blocks have none.
    block: Option<u32>,
    /// The next free label.
    label: u32,
    /// What is written: the main program, or a subprogram, counted from 1.
    part: usize,
    /// Subprograms are cycles, in files of their own.
    cycles: bool,
    /// Where the loops around end.
    ends: Vec<u32>,
    /// Variables in use for parts of a value.
    used: usize,
}

impl Writer {
    fn line(&mut self, text: &str) {
        if let Some(number) = &mut self.block {
            let _ = write!(self.out, "N{number} ");
            *number += 1;
        }
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn labels(&mut self, many: u32) -> u32 {
        let first = self.label;
        self.label += many;
        first
    }

    fn place(&mut self, label: u32) {
        self.line(&format!("${label}"));
    }

    fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            self.used = 0;
            self.step(step);
        }
    }

    fn step(&mut self, step: &Step) {
        let mut choices = step.choices();
        match &step.kind {
            Kind::Set { slot, value } => self.assign(&name(*slot), value),
            // No variable is found by a number here; the counter itself is as good.
            Kind::SetCell { counter, value } => {
                let value =
                    Value::Binary(Binary::Add, Box::new(Value::Slot(*counter)), Box::new(value.clone()));
                self.assign("VC", &value);
            }
            Kind::Absolute(absolute) => self.line(if *absolute { "G90" } else { "G91" }),
            Kind::Move { rapid, axes, feed } => {
                let code = if *rapid { "G0" } else { "G1" };
                let line = self.words(['X', 'Y', 'Z'].into_iter().zip(axes));
                match feed {
                    Some(feed) => self.line(&format!("{code} F{}", plain(*feed))),
                    None if choices.one_in(5) => {}
                    None => self.line(code),
                }
                if !line.is_empty() {
                    self.line(&line);
                }
            }
            Kind::Arc { clockwise, radius } => {
                let side = self.variable(radius);
                // A negative radius is the short arc.
                let minus = self.temporary();
                self.line(&format!("{minus}={side}* -1"));
                self.line("G91");
                self.line(if *clockwise { "G2" } else { "G3" });
                self.line(&format!("X={side} Y={side} R={minus}"));
                self.line("G90 G1");
            }
            Kind::Dwell(_) => self.line("G61"),
            Kind::If { test, then, otherwise } => {
                let end = self.labels(2);
                if otherwise.is_empty() && choices.one_in(2) {
                    self.unless(test, end);
                    self.steps(then);
                } else {
                    self.when(test, end + 1);
                    self.steps(otherwise);
                    self.line(&format!("G24 P{end}"));
                    self.place(end + 1);
                    self.steps(then);
                }
                self.place(end);
            }
            Kind::Repeat { counter, times, body } => {
                let name = name(*counter);
                let label = self.labels(2);
                self.ends.push(label + 1);
                if choices.one_in(2) {
                    self.line(&format!("{name}={times}"));
                    self.place(label);
                    self.steps(body);
                    self.line(&format!("DEC {name}"));
                    self.line(&format!("BGT P{label}"));
                } else {
                    self.line(&format!("{name}=0"));
                    self.place(label);
                    self.line(&format!("V79={name}-{times} BGE P{}", label + 1));
                    self.steps(body);
                    self.line(&format!("INC {name}"));
                    self.line(&format!("G24 P{label}"));
                }
                self.ends.pop();
                self.place(label + 1);
            }
            Kind::Leave(test) => {
                if let Some(end) = self.ends.last() {
                    self.when(test, *end);
                }
            }
            Kind::Switch { on, arms } => {
                let first = self.labels(arms.len() as u32 + 1);
                let end = first + arms.len() as u32;
                let computed = choices.one_in(3);
                for at in 1..arms.len() as u32 {
                    self.line(&format!("V79={}-{at}", name(*on)));
                    if computed {
                        self.line(&format!("V78={}", first + at));
                        self.line("TST V79");
                        self.line("BEQ V78");
                    } else {
                        self.line(&format!("BEQ P{}", first + at));
                    }
                }
                for (at, arm) in arms.iter().enumerate() {
                    self.place(first + at as u32);
                    self.steps(arm);
                    self.line(&format!("G24 P{end}"));
                }
                self.place(end);
            }
            Kind::Call { sub, values, times } => {
                for (slot, value) in values {
                    self.assign(&name(*slot), value);
                }
                self.call(*sub, *times);
            }
            Kind::Cycle { places, .. } => {
                self.line("G81 V1=5 V2=-10");
                for place in places {
                    let line = self.words(['X', 'Y'].into_iter().zip(place));
                    if !line.is_empty() {
                        self.line("G0");
                        self.line(&line);
                    }
                }
                self.line("G80");
            }
            Kind::Offset(offset) => self.offset(offset, &mut choices),
            Kind::Machine(which) => {
                let lines = ["M8", "M9", "T01", "M8", "M9", "T02", "M0", "G0 Z5"];
                self.line(lines[*which % lines.len()]);
            }
            Kind::Own(which, value) => self.own(*which, value),
            Kind::Figure(which, values) => self.figure(*which, values),
            Kind::Within { frame, values, body } => self.within(*frame, values, body),
            Kind::Modal { sub, values, .. } => {
                for (slot, value) in values {
                    self.assign(&name(*slot), value);
                }
                self.call(*sub, 1);
            }
            Kind::Talk(which, value) => self.talk(*which, value),
            Kind::Words(which, value) => self.spelled(*which, value),
            Kind::Beside { block, value, codes } => self.beside(*block, value, codes, &mut choices),
            Kind::Cells(which, value) => self.cells(*which, value),
            Kind::Jump { given, form, arms } => self.jump(*given, *form, arms),
            Kind::Far { subs, given, form } => self.far(*subs, *given, *form),
            // The unit is switched at the control.
            Kind::Unit(metric) => self.line(if *metric { "(MILLIMETRES)" } else { "(INCHES)" }),
            Kind::Unknown => self.line(choices.pick(UNKNOWN)),
        }
    }

    fn call(&mut self, sub: usize, times: u32) {
        if self.cycles {
            return self.line(&format!("G8{}", CYCLE + sub));
        }
        let again = if times > 1 { format!(" L{}", times - 1) } else { String::new() };
        self.line(&format!("G22 P{}{again}", 1 + sub));
    }

    /// Axis words: all numbers, or all variables, for a block holds one kind.
    fn words<'v>(&mut self, words: impl Iterator<Item = (char, &'v Option<Value>)>) -> String {
        let words: Vec<(char, &Value)> = words.filter_map(|(axis, v)| Some((axis, v.as_ref()?))).collect();
        let constant = words.iter().all(|(_, value)| matches!(value, Value::Number(_)));
        let mut line = String::new();
        for (axis, value) in words {
            let _ = match value {
                Value::Number(number) if constant => write!(line, " {axis}{}", plain(*number)),
                value => write!(line, " {axis}={}", self.variable(value)),
            };
        }
        line.trim_start().to_owned()
    }
}

fn name(slot: usize) -> String {
    match slot {
        0..=7 => format!("V{}", 30 + slot),
        8 => "VA".into(),
        9 => "VB".into(),
        // What circumstances give: VK to VP.
        10..=15 => format!("V{}", char::from(b'A' + slot as u8)),
        _ => format!("V{}", 20 + slot),
    }
}

fn branch(relation: Relation) -> &'static str {
    ["BEQ", "BNE", "BLT", "BLE", "BGT", "BGE"][relation as usize]
}
