//! Spells programs as Custom Macro B: what two of the dialects share, and where they part.

use super::{Binary, Kind, Offset, Policy, Program, Source, Step, Test, Unary, Value, plain, pointed};
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
        ends: Vec::new(),
        local: Vec::new(),
        gap: if choices.one_in(2) { " " } else { "" },
        locals_count: choices.one_in(2),
    };
    let units = choices.pick(&["G21 ", "G21 ", "G20 ", ""]);
    writer.line("O1000");
    writer.line(&format!("{units}G90 G17 G40 G49 G80 G94 G54"));
    writer.line("S800 M3");
    writer.line("G1 F300.");
    writer.steps(&program.main);
    writer.line(choices.pick(&["M30", "M30", "M2"]));
    writer.local_subs();
    for (at, sub) in program.subs.iter().enumerate() {
        writer.line(&format!("O{}", 1001 + at));
        (writer.label, writer.loops) = (10, 0);
        writer.steps(sub);
        writer.line("M99");
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
    /// Where the loops around end.
    ends: Vec<u32>,
    /// Subprograms to be written behind the end of this program, and their numbers.
    local: Vec<(usize, u32)>,
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

    fn local_subs(&mut self) {
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
                for place in places {
                    let place = self.place(place);
                    self.line(place.trim());
                }
                self.line(choices.pick(&["G80", "G80", "G0 G80"]));
            }
            Kind::Offset(offset) => self.offset(offset, &mut choices),
            Kind::Machine(which) => {
                let lines = ["S1200 M3", "M5", "M8", "M9", "T2 M6", "M1", "M0", "S500"];
                self.line(lines[*which % lines.len()]);
            }
            Kind::Own(which, value) => self.own(*which, value, &mut choices),
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

    fn branch(&mut self, test: &Test, then: &[Step], otherwise: &[Step], choices: &mut Source<'_>) {
        let gap = self.gap;
        if let ([Step { kind: Kind::Set { slot, value }, .. }], [], true) =
            (then, otherwise, choices.one_in(2))
        {
            let (test, value) = (self.test(test), self.value(value, 0));
            let name = self.name(*slot);
            let word = if self.haas && choices.one_in(3) { "" } else { "THEN" };
            return self.line(&format!("IF{gap}{test}{gap}{word} {name}{gap}={gap}{value}"));
        }
        let word = if self.haas && choices.one_in(4) { "" } else { "IF" };
        let end = self.labels(2);
        if otherwise.is_empty() && choices.one_in(2) {
            let line = format!("{word}{gap}{}{gap}GOTO{gap}{end}", self.test(&test.opposite()));
            self.line(&line);
            self.steps(then);
        } else {
            let line = format!("{word}{gap}{}{gap}GOTO{gap}{}", self.test(test), end + 10);
            self.line(&line);
            self.steps(otherwise);
            self.line(&format!("GOTO{gap}{end}"));
            self.line(&format!("N{}", end + 10));
            self.steps(then);
        }
        self.line(&format!("N{end}"));
    }

    fn repeat(&mut self, counter: usize, times: u32, body: &[Step], choices: &mut Source<'_>) {
        let (gap, name) = (self.gap, self.name(counter));
        let label = self.labels(2);
        let end = label + 10;
        self.ends.push(end);
        match choices.below(4) {
            0 => {
                self.line(&format!("{name}={times}"));
                self.line(&format!("N{label}"));
                self.steps(body);
                self.line(&format!("{name}={name}-1"));
                self.line(&format!("IF{gap}[{name}{gap}GT{gap}0]{gap}GOTO{gap}{label}"));
            }
            1 if self.loops < 3 => {
                self.loops += 1;
                let number = self.loops;
                self.line(&format!("{name}=0"));
                self.line(&format!("DO{number}"));
                self.line(&format!("IF{gap}[{name}{gap}GE{gap}{times}]{gap}GOTO{gap}{end}"));
                self.steps(body);
                self.line(&format!("{name}={name}+1"));
                self.line(&format!("END{number}"));
                self.loops -= 1;
            }
            _ if self.loops < 3 => {
                self.loops += 1;
                let number = self.loops;
                self.line(&format!("{name}=0"));
                self.line(&format!("WHILE{gap}[{name}{gap}LT{gap}{times}]{gap}DO{number}"));
                self.steps(body);
                self.line(&format!("{name}={name}+1"));
                self.line(&format!("END{number}"));
                self.loops -= 1;
            }
            _ => {
                self.line(&format!("{name}=0"));
                self.line(&format!("N{label} IF{gap}[{name}{gap}GE{gap}{times}]{gap}GOTO{gap}{end}"));
                self.steps(body);
                self.line(&format!("{name}={name}+1"));
                self.line(&format!("GOTO{gap}{label}"));
            }
        }
        self.ends.pop();
        self.line(&format!("N{end}"));
    }

    fn switch(&mut self, on: usize, arms: &[Vec<Step>], choices: &mut Source<'_>) {
        let (gap, name) = (self.gap, self.name(on));
        let many = arms.len() as u32;
        let first = self.labels(many + 1);
        let end = first + 10 * many;
        let computed = choices.below(3);
        if computed == 0 {
            for at in 1..many {
                self.line(&format!("IF{gap}[{name}{gap}EQ{gap}{at}]{gap}GOTO{gap}{}", first + 10 * at));
            }
        } else {
            self.line(&format!("#119={gap}ROUND[{name}]"));
            self.line(&format!("IF{gap}[#119{gap}LT{gap}0]{gap}GOTO{gap}{first}"));
            self.line(&format!("IF{gap}[#119{gap}GE{gap}{many}]{gap}GOTO{gap}{first}"));
            if computed == 1 {
                self.line(&format!("GOTO[{first}+#119*10]"));
            } else {
                self.line(&format!("#119={first}+#119*10"));
                self.line("GOTO#119");
            }
        }
        for (at, arm) in arms.iter().enumerate() {
            self.line(&format!("N{}", first + 10 * at as u32));
            self.steps(arm);
            if at + 1 < arms.len() {
                self.line(&format!("GOTO{gap}{end}"));
            }
        }
        self.line(&format!("N{end}"));
    }

    fn call(&mut self, sub: usize, values: &[(usize, Value)], times: u32, choices: &mut Source<'_>) {
        let number = 1001 + sub;
        let again = if times > 1 { format!(" L{times}") } else { String::new() };
        match choices.below(8) {
            0 | 1 => {
                for (slot, value) in values {
                    self.set(self.name(*slot), value);
                }
                if self.haas && choices.one_in(3) && self.local.len() < 4 {
                    let label = self.labels(1);
                    self.local.push((sub, label));
                    self.line(&format!("M97 P{label}{again}"));
                } else if !self.haas && times > 1 && choices.one_in(3) {
                    self.line(&format!("M98 P{times:04}{number:04}"));
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
                self.line(&format!("G65 P{number}{again}{arguments}"));
            }
        }
    }

    /// Arguments by specification I, by II, or of both.
    fn arguments(&self, values: &[(usize, Value)], choices: &mut Source<'_>) -> String {
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

    fn offset(&mut self, offset: &Offset, choices: &mut Source<'_>) {
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

    fn own(&mut self, which: usize, value: &Value, choices: &mut Source<'_>) {
        let gap = self.gap;
        let text = self.value(value, 0);
        match which {
            0 => {
                // What stands behind a jump is never run.
                let end = self.labels(1);
                self.line(&format!("GOTO{gap}{end}"));
                self.line(&format!("G1 X[{text}]"));
                self.line(&format!("N{end}"));
            }
            1 => {
                let end = self.labels(1);
                self.line(&format!("IF{gap}[{}{gap}LE{gap}60]{gap}GOTO{gap}{end}", self.name(1)));
                self.line("#3000=12(TOO FAR)");
                self.line(&format!("N{end}"));
            }
            2 => self.line("#3006=1(LOOK)"),
            3 => {
                let name = self.name(choices.below(super::draw::SLOTS));
                self.line(&format!("{name}=#0"));
            }
            4 => {
                self.line("POPEN");
                let line = format!("DPRNT[X{}[43]]", self.name(2));
                self.line(&line);
                self.line("PCLOS");
            }
            5 => self.line(&format!("/G0 X[{text}]")),
            6 => self.line(&format!("G1 X[ROUND[{text}]]")),
            7 => {
                self.line(&format!("#118=[{text}]*10+200"));
                self.line("F#118");
            }
            8 => self.line("G61"),
            9 => self.line("G64"),
            10 => self.line("G9 G1 X3."),
            11 => {
                let name = self.name(3);
                self.line(&format!("#[151]={name}+1"));
                self.line("#105=#[150+1]");
            }
            12 => self.line(&format!("G1 X#0 Z[{text}]")),
            13 => self.line("G18"),
            14 => self.line("G17"),
            _ => self.line("(A COMMENT)"),
        }
    }

    fn name(&self, slot: usize) -> String {
        let all_local = self.program.policy == Policy::Arguments;
        let number = match slot {
            0..=5 => slot + 1,
            9 if all_local => 11,
            6..=9 if all_local => slot + 1,
            6 | 7 => slot + 100,
            8 | 9 => slot + 500,
            _ if self.locals_count && slot < 33 => slot,
            _ => slot + 100,
        };
        format!("#{number}")
    }

    fn word(&self, letter: char, value: &Value, bare: bool) -> String {
        match value {
            Value::Number(number) if bare && number.fract() == 0.0 => format!("{letter}{}", plain(*number)),
            Value::Number(number) => format!("{letter}{}", pointed(*number)),
            Value::Slot(slot) => format!("{letter}{}", self.name(*slot)),
            Value::Empty => format!("{letter}#0"),
            Value::Unary(Unary::Negate, inner) if matches!(**inner, Value::Slot(_)) => {
                format!("{letter}-{}", self.value(inner, 9))
            }
            value => format!("{letter}[{}]", self.value(value, 0)),
        }
    }

    /// A value beside operators of a rank.
    fn value(&self, value: &Value, rank: u32) -> String {
        match value {
            Value::Number(number) if *number < 0.0 && rank > 0 => format!("[{}]", plain(*number)),
            Value::Number(number) => plain(*number),
            Value::Slot(slot) => self.name(*slot),
            Value::Empty => "#0".into(),
            Value::Unary(Unary::Negate, a) if rank > 0 => format!("[-{}]", self.value(a, 9)),
            Value::Unary(Unary::Negate, a) => format!("-{}", self.value(a, 9)),
            Value::Unary(function, a) => {
                let name = match function {
                    Unary::Abs | Unary::Negate => "ABS",
                    Unary::Sine => "SIN",
                    Unary::Cosine => "COS",
                    // Behind it a slash would begin the divisor of the form with two arguments.
                    Unary::ArcTangent if rank > 0 => return format!("[ATAN[{}]]", self.value(a, 0)),
                    Unary::ArcTangent => "ATAN",
                    // Two brackets each: some controls take five.
                    Unary::Root if holds_root(a) => "ABS",
                    Unary::Root => return format!("SQRT[ABS[{}]]", self.value(a, 0)),
                    Unary::Fix => "FIX",
                    Unary::Up if self.haas => "FIX",
                    Unary::Up => "FUP",
                    Unary::Round => "ROUND",
                };
                format!("{name}[{}]", self.value(a, 0))
            }
            Value::Binary(Binary::ArcTangent, a, b) => {
                format!("ATAN[{}]/[{}]", self.value(a, 0), self.value(b, 0))
            }
            Value::Binary(operation, a, b) => {
                let (name, own) = match operation {
                    Binary::Add => ("+", 5),
                    Binary::Subtract => ("-", 5),
                    Binary::Multiply => ("*", 6),
                    Binary::Divide => ("/", 6),
                    Binary::Remainder => (" MOD ", 6),
                    Binary::And => (" AND ", 6),
                    Binary::Or => (" OR ", 5),
                    Binary::Xor | Binary::ArcTangent => (" XOR ", 5),
                };
                // Where bit operations stand in the order one of the controls does not say.
                let own = if name.starts_with(' ') { 4 } else { own };
                let text = format!("{}{name}{}", self.value(a, own), self.value(b, own + 1));
                if own < rank || (own == 4 && rank > 0) { format!("[{text}]") } else { text }
            }
        }
    }

    fn test(&self, test: &Test) -> String {
        match test {
            Test::Compare(relation, a, b) => {
                format!("[{} {} {}]", self.value(a, 5), relation.letters(), self.value(b, 5))
            }
            Test::Empty(slot, empty) => {
                format!("[{} {} #0]", self.name(*slot), if *empty { "EQ" } else { "NE" })
            }
            Test::Both(a, b) => format!("[{} AND {}]", self.test(a), self.test(b)),
            Test::Either(a, b) => format!("[{} OR {}]", self.test(a), self.test(b)),
        }
    }
}

fn holds_root(value: &Value) -> bool {
    match value {
        Value::Unary(function, a) => *function == Unary::Root || holds_root(a),
        Value::Binary(_, a, b) => holds_root(a) || holds_root(b),
        _ => false,
    }
}
