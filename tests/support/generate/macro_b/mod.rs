//! Spells programs as Custom Macro B: what two of the dialects share, and where they part.

mod beside;
mod calls;
mod figures;
mod flow;
mod offsets;
mod own;
mod reach;
mod spelling;
mod talk;
mod words;

use super::{Kind, Policy, Program, Source, Step, UNKNOWN, Value, pointed};
use std::fmt::Write;

pub fn write(program: &Program) -> String {
    let haas = program.dialect == "haas";
    let mut choices = Source::Seed(program.salt);
    let mut writer = Writer {
        program,
        haas,
        out: String::new(),
        label: 10,
        loops: 0,
        part: 0,
        ends: Vec::new(),
        local: Vec::new(),
        entries: Vec::new(),
        gap: if choices.one_in(2) { " " } else { "" },
        locals_count: choices.one_in(2),
    };
    let named: &[&str] = if program.policy == Policy::Units {
        &["", "", "G20 ", "G21 "]
    } else {
        &["G21 ", "G21 ", "G20 ", ""]
    };
    let units = choices.pick(named);
    writer.line("O1000");
    writer.line(&format!("{units}G90 G17 G40 G49 G80 G94 G54"));
    writer.line("S800 M3");
    writer.line("G1 F300.");
    if program.policy == Policy::Reach {
        (0..=program.subs.len()).for_each(|part| writer.line(&format!("#{}=0", 110 + part)));
    }
    writer.steps(&program.main);
    writer.line(choices.pick(&["M30", "M30", "M2"]));
    writer.local_subs();
    for (at, sub) in program.called() {
        // Blocks behind the end of their callers stand for it.
        let copied = haas && program.policy != Policy::Reach;
        if copied && !writer.out.contains(&format!("P{}", writer.number(at))) {
            continue;
        }
        writer.line(&format!("O{}", writer.number(at)));
        (writer.label, writer.loops, writer.part) = (10, 0, at + 1);
        writer.entries.clear();
        if program.policy == Policy::Units && choices.one_in(4) {
            writer.line(choices.pick(&["G20", "G21"]));
        }
        writer.steps(sub);
        let last = if writer.goes_on(at) { format!("M99 P{}", writer.entry(at)) } else { "M99".into() };
        writer.line(&last);
        writer.local_subs();
    }
    writer.out
}

struct Writer<'p> {
    program: &'p Program,
    haas: bool,
    out: String,
    /// The next free sequence number.
    label: u32,
    /// How many DO stand around.
    loops: u32,
    /// Which program is written: the main one, or a subprogram, counted from 1.
    part: usize,
    /// Where the loops around end.
    ends: Vec<u32>,
    /// Subprograms to be written behind the end of this program, and their numbers.
    local: Vec<(usize, u32)>,
    /// Subprograms that come back to a number in this program.
    entries: Vec<usize>,
    /// Between the parts of a statement.
    gap: &'static str,
    /// Loops are counted in local variables.
    locals_count: bool,
}

impl Writer<'_> {
    fn line(&mut self, text: &str) {
        self.out.push_str(text);
        self.out.push('\n');
    }

    fn labels(&mut self, many: u32) -> u32 {
        let first = self.label;
        self.label += 10 * many;
        first
    }

    fn steps(&mut self, steps: &[Step]) {
        for step in steps {
            self.step(step);
        }
    }

    fn step(&mut self, step: &Step) {
        let mut choices = step.choices();
        let gap = self.gap;
        match &step.kind {
            Kind::Set { slot, value } => self.set(self.name(*slot), value),
            Kind::SetCell { counter, value } => {
                let counter = self.name(*counter);
                self.set(format!("#[150+{counter}]"), value);
            }
            Kind::Absolute(absolute) => self.line(if *absolute { "G90" } else { "G91" }),
            Kind::Move { rapid, axes, feed } => {
                let mut line = String::from(match (rapid, choices.one_in(5)) {
                    (_, true) => "",
                    (true, _) => "G0 ",
                    (false, _) => "G1 ",
                });
                for (axis, value) in ['X', 'Y', 'Z'].iter().zip(axes) {
                    if let Some(value) = value {
                        let _ = write!(line, "{} ", self.word(*axis, value, choices.one_in(12)));
                    }
                }
                if let Some(feed) = feed {
                    let _ = write!(line, "F{} ", pointed(*feed));
                }
                if line.is_empty() { self.line("G0") } else { self.line(line.trim_end()) }
            }
            Kind::Arc { clockwise, radius } => {
                let code = if *clockwise { "G2" } else { "G3" };
                let r = |letter| self.word(letter, radius, false);
                let line = match choices.below(3) {
                    0 => format!("G91 {code} {} {} {} J0.", r('X'), r('Y'), r('I')),
                    1 => format!("G91 {code} {} {} {}", r('X'), r('Y'), r('R')),
                    _ => format!("{code} {}", r('I')),
                };
                self.line(&line);
                self.line("G90 G1");
            }
            Kind::Dwell(ms) => match choices.below(3) {
                0 if !self.haas => self.line(&format!("G4 X{}", pointed(f64::from(*ms) / 1000.0))),
                0 => self.line(&format!("G4 P{}", pointed(f64::from(*ms) / 1000.0))),
                _ => self.line(&format!("G4 P{ms}")),
            },
            Kind::If { test, then, otherwise } => self.branch(test, then, otherwise, &mut choices),
            Kind::Repeat { counter, times, body } => self.repeat(*counter, *times, body, &mut choices),
            Kind::Leave(test) => {
                if let Some(end) = self.ends.last() {
                    let line = format!("IF{gap}{}{gap}GOTO{gap}{end}", self.test(test));
                    self.line(&line);
                }
            }
            Kind::Switch { on, arms } => self.switch(*on, arms, &mut choices),
            Kind::Call { sub, values, times } => self.call(*sub, values, *times, &mut choices),
            Kind::Cycle { kind, depth, plane, initial, places } => {
                let code = [81, 82, 83, 73, 84, 85, 86, 89, 76, 74, 81, 83][*kind % 12];
                let back = if *initial { "G98" } else { "G99" };
                let mut line = format!("{back} G{code}");
                let mut places = places.iter();
                if choices.one_in(2)
                    && let Some(place) = places.next()
                {
                    line += &self.place(place);
                } else if choices.one_in(2) {
                    line += " L0";
                }
                let _ = write!(line, " {} {}", self.word('Z', depth, false), self.word('R', plane, false));
                match code {
                    82 | 89 => line += " P250",
                    83 | 73 => line += " Q1.5",
                    76 => line += " Q0.2",
                    _ => {}
                }
                self.line(&(line + " F120."));
                // Another cycle may follow without an end between: what it does with the words of before is its own.
                let other = [82, 83, 89, 88, 85, 73][choices.below(6)];
                let turns = choices.below(8);
                for (at, place) in places.enumerate() {
                    let place = self.place(place);
                    if at == turns {
                        let step = if matches!(other, 83 | 73) { " Q1.25" } else { "" };
                        self.line(&format!("G{other}{place}{step}"));
                    } else {
                        self.line(place.trim());
                    }
                }
                self.line(choices.pick(&["G80", "G80", "G0 G80"]));
            }
            Kind::Offset(offset) => self.offset(offset, &mut choices),
            Kind::Machine(which) => {
                let lines = ["S1200 M3", "M5", "M8", "M9", "T2 M6", "M1", "M0", "S500"];
                self.line(lines[*which % lines.len()]);
            }
            Kind::Own(which, value) => self.own(*which, value, &mut choices),
            Kind::Figure(which, values) => self.figure(*which, values),
            Kind::Within { frame, values, body } => self.within(*frame, values, body),
            Kind::Modal { sub, values, body } => self.modal(*sub, values, body, &mut choices),
            Kind::Talk(which, value) => self.talk(*which, value, &mut choices),
            Kind::Words(which, value) => self.spelled(*which, value, &mut choices),
            Kind::Beside { block, value, codes } => self.beside(*block, value, codes, &mut choices),
            Kind::Cells(which, value) => self.cells(*which, value, &mut choices),
            Kind::Jump { given, form, arms } => self.jump(*given, *form, arms, &mut choices),
            Kind::Far { subs, given, form } => self.far(*subs, *given, *form),
            Kind::Unit(metric) => self.line(if *metric { "G21" } else { "G20" }),
            Kind::Unknown => self.line(choices.pick(UNKNOWN)),
        }
    }

    fn set(&mut self, name: String, value: &Value) {
        let gap = self.gap;
        let line = format!("{name}{gap}={gap}{}", self.value(value, 0));
        self.line(&line);
    }

    fn place(&self, place: &[Option<Value>; 2]) -> String {
        let mut line = String::new();
        for (axis, value) in ['X', 'Y'].iter().zip(place) {
            if let Some(value) = value {
                let _ = write!(line, " {}", self.word(*axis, value, false));
            }
        }
        line
    }
}
