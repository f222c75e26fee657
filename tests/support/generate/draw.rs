//! Draws abstract programs by policy.

use super::{Binary, Kind, Offset, Policy, Program, Relation, Source, Step, Test, Unary, Value};

/// Variables that a program sets as it likes.
pub const SLOTS: usize = 10;
/// The first variable that counts a loop.
pub const COUNTERS: usize = 20;

struct Draw<'s, 'b> {
    source: &'s mut Source<'b>,
    policy: Policy,
    macro_b: bool,
    /// Steps that may still be drawn.
    fuel: usize,
    counters: usize,
    /// How many times the innermost place runs by the loops around it.
    rounds: u32,
    /// Counters of the loops around, outermost first.
    around: Vec<usize>,
    /// The first subprogram that may be called here, and how many there are.
    callable: (usize, usize),
}

pub fn program(dialect: &'static str, policy: Policy, source: &mut Source<'_>) -> Program {
    let salt = source.below(1 << 16) as u64;
    let few = if policy == Policy::Arguments { 1 + source.below(3) } else { source.below(3) };
    let mut draw = Draw {
        policy,
        macro_b: matches!(dialect, "fanuc" | "haas"),
        fuel: 0,
        counters: COUNTERS,
        rounds: 1,
        around: Vec::new(),
        callable: (0, few),
        source,
    };
    draw.fuel = 8 + draw.source.below(12);
    let mut main = draw.head();
    let body = draw.steps(6);
    main.extend(body);
    let mut subs = Vec::new();
    for at in 0..few {
        draw.callable = (at + 1, few);
        draw.fuel = 4 + draw.source.below(6);
        subs.push(draw.steps(3));
    }
    Program { dialect, policy, main, subs, salt }
}

impl Draw<'_, '_> {
    fn step(&mut self, kind: Kind) -> Step {
        Step { salt: self.source.below(1 << 16) as u64, kind }
    }

    /// Values that an operator edits, and where the tool stands.
    fn head(&mut self) -> Vec<Step> {
        let mut out = Vec::new();
        let set = if self.policy == Policy::Vacancy { 2 } else { 4 };
        for slot in 0..set {
            let value = self.number();
            out.push(self.step(Kind::Set { slot, value }));
        }
        let axes = [0.0, 0.0, 20.0].map(|axis| Some(Value::Number(axis)));
        out.push(self.step(Kind::Move { rapid: true, axes, feed: None }));
        out
    }

    /// Some steps, as many as there is fuel for.
    fn steps(&mut self, most: usize) -> Vec<Step> {
        let mut out = Vec::new();
        for _ in 0..1 + self.source.below(most) {
            if self.fuel == 0 {
                break;
            }
            self.fuel -= 1;
            let kind = self.kind();
            out.push(self.step(kind));
        }
        out
    }

    fn kind(&mut self) -> Kind {
        // How often: set, cell, mode, move, arc, dwell, if, repeat, leave, switch, call, cycle, offset, machine, own.
        let weights: [usize; 15] = match self.policy {
            Policy::Goto => [5, 1, 1, 5, 1, 0, 8, 1, 2, 3, 1, 0, 0, 0, 1],
            Policy::DeepDo => [4, 2, 1, 4, 1, 0, 2, 9, 3, 0, 1, 0, 0, 0, 1],
            Policy::Arguments => [4, 0, 1, 4, 0, 0, 2, 1, 1, 1, 8, 0, 0, 0, 1],
            Policy::NearRounding => [9, 1, 1, 6, 1, 1, 4, 1, 1, 1, 1, 0, 1, 0, 1],
            Policy::Vacancy => [6, 1, 1, 6, 1, 0, 5, 1, 1, 1, 3, 1, 1, 0, 1],
            Policy::Cycles => [3, 0, 2, 3, 0, 0, 1, 2, 0, 0, 2, 8, 1, 1, 1],
            Policy::Offsets => [3, 0, 2, 5, 1, 0, 1, 1, 0, 0, 1, 1, 9, 2, 1],
        };
        let mut drawn = self.source.below(weights.iter().sum());
        let mut which = 0;
        while drawn >= weights[which] {
            drawn -= weights[which];
            which += 1;
        }
        match which {
            1 if !self.around.is_empty() => {
                Kind::SetCell { counter: self.source.pick(&self.around.clone()), value: self.value(2) }
            }
            2 => Kind::Absolute(self.source.one_in(2)),
            3 => self.motion(),
            4 => {
                let radius = if self.source.one_in(3) { self.some_slot() } else { Value::Number(2.5) };
                let radius = Value::Binary(
                    Binary::Add,
                    Box::new(Value::Unary(Unary::Abs, Box::new(radius))),
                    Box::new(Value::Number(1.0)),
                );
                Kind::Arc { clockwise: self.source.one_in(2), radius }
            }
            5 => Kind::Dwell(100 + 50 * self.source.below(20) as u32),
            6 => {
                let test = self.test(1);
                let then = self.steps(3);
                let otherwise = if self.source.one_in(2) { self.steps(2) } else { Vec::new() };
                Kind::If { test, then, otherwise }
            }
            7 if self.rounds <= 12 => self.repeat(),
            8 if !self.around.is_empty() => Kind::Leave(self.test(0)),
            9 => {
                let on = self.source.below(SLOTS);
                let arms = (0..2 + self.source.below(2)).map(|_| self.steps(2)).collect();
                Kind::Switch { on, arms }
            }
            10 if self.callable.0 < self.callable.1 => {
                let sub = self.callable.0 + self.source.below(self.callable.1 - self.callable.0);
                let many = self.source.below(5);
                let values = (0..many).map(|_| (self.source.below(SLOTS), self.value(1))).collect();
                Kind::Call { sub, values, times: 1 + self.source.below(5) as u32 / 4 }
            }
            11 => self.cycle(),
            12 => Kind::Offset(self.offset()),
            13 => Kind::Machine(self.source.below(8)),
            14 => Kind::Own(self.source.below(16), self.value(1)),
            _ => Kind::Set { slot: self.source.below(SLOTS), value: self.value(3) },
        }
    }

    fn repeat(&mut self) -> Kind {
        let (counter, times) = (self.counters, 1 + self.source.below(3) as u32);
        self.counters += 1;
        self.rounds *= times;
        self.around.push(counter);
        let body = self.steps(3);
        self.around.pop();
        self.rounds /= times;
        Kind::Repeat { counter, times, body }
    }

    fn motion(&mut self) -> Kind {
        let mut axes = [None, None, None];
        let first = self.source.below(3);
        axes[first] = Some(self.value(1));
        if self.source.one_in(2) {
            let second = self.source.below(3);
            axes[second] = Some(self.value(1));
        }
        let feed = self.source.one_in(4).then(|| 100.0 + 10.0 * self.source.below(9) as f64);
        Kind::Move { rapid: self.source.one_in(2), axes, feed }
    }

    fn cycle(&mut self) -> Kind {
        let depth = self.source.below(2000);
        let depth = if depth < 1000 { Value::Number(-3.0 - depth as f64 / 100.0) } else { self.some_slot() };
        let plane = if self.source.one_in(4) { self.some_slot() } else { Value::Number(2.0) };
        let place = |draw: &mut Self| {
            let x = draw.source.below(4);
            [(x != 1).then(|| draw.value(1)), (x != 2).then(|| draw.value(1))]
        };
        let places = (0..self.source.below(4)).map(|_| place(self)).collect();
        Kind::Cycle { kind: self.source.below(12), depth, plane, initial: self.source.one_in(2), places }
    }

    fn offset(&mut self) -> Offset {
        let row = 1 + self.source.below(6) as u32;
        let tool = 1 + self.source.below(9) as u32;
        let (axis, slot) = (self.source.below(3), self.source.below(SLOTS));
        match self.source.below(12) {
            0 | 1 => Offset::Select(row),
            2 => Offset::Write { row, axis, value: self.value(1) },
            3 => Offset::Read { row, axis, slot },
            4 => Offset::Shift([self.value(0), self.value(0)]),
            5 => Offset::Position([self.value(0), self.value(0)]),
            6 => Offset::Length(tool),
            7 => Offset::NoLength,
            8 => Offset::WriteTool { tool, value: self.value(1) },
            9 => Offset::ReadTool { tool, slot },
            10 => Offset::ReadPosition { axis, slot },
            _ if self.source.one_in(2) => Offset::ReadModal(slot),
            _ => Offset::Home,
        }
    }

    fn some_slot(&mut self) -> Value {
        if !self.around.is_empty() && self.source.one_in(3) {
            return Value::Slot(self.source.pick(&self.around.clone()));
        }
        // Most reads are of what the head set, unless it is vacancy that is wanted.
        let from = if self.policy == Policy::Vacancy || self.source.one_in(6) { SLOTS } else { 4 };
        Value::Slot(self.source.below(from))
    }

    fn number(&mut self) -> Value {
        const NEAR: [f64; 20] = [
            0.0005, 1.0005, 0.00049, -0.0005, 2.5, -2.5, 0.4999999, 0.5, -0.5, 1.5, 0.0015, 2.0025, 3.9999,
            0.99995, 0.1, 0.2, 0.3, 1.00005, 12.34565, -7.9995,
        ];
        let near = self.policy == Policy::NearRounding;
        Value::Number(match self.source.below(if near { 8 } else { 5 }) {
            0 => self.source.below(10) as f64,
            1 => self.source.below(41) as f64 / 2.0 - 10.0,
            2 => self.source.below(2000) as f64 / 100.0 - 10.0,
            3 => self.source.pick(&[0.0, 1.0, -1.0, 2.0]),
            4 => 1.0 + self.source.below(20) as f64,
            _ => self.source.pick(&NEAR),
        })
    }

    fn value(&mut self, depth: usize) -> Value {
        let leaf = depth == 0 || self.source.one_in(2);
        if leaf {
            let empty = self.macro_b && self.policy == Policy::Vacancy && self.source.one_in(8);
            return match self.source.below(3) {
                _ if empty => Value::Empty,
                0 => self.number(),
                _ => self.some_slot(),
            };
        }
        if self.source.one_in(3) {
            const COMMON: [Unary; 6] =
                [Unary::Negate, Unary::Abs, Unary::Sine, Unary::Cosine, Unary::ArcTangent, Unary::Root];
            const WHOLE: [Unary; 3] = [Unary::Fix, Unary::Up, Unary::Round];
            let whole = self.source.one_in(if self.policy == Policy::NearRounding { 2 } else { 4 });
            let function = if whole { self.source.pick(&WHOLE) } else { self.source.pick(&COMMON) };
            return Value::Unary(function, Box::new(self.value(depth - 1)));
        }
        let operation = match self.source.below(16) {
            0..5 => Binary::Add,
            5..9 => Binary::Subtract,
            9..12 => Binary::Multiply,
            12..14 => Binary::Divide,
            _ => self.source.pick(&[
                Binary::Remainder,
                Binary::And,
                Binary::Or,
                Binary::Xor,
                Binary::ArcTangent,
            ]),
        };
        let left = Box::new(self.value(depth - 1));
        let right = match operation {
            Binary::Divide | Binary::Remainder | Binary::ArcTangent => {
                Value::Number(self.source.pick(&[2.0, 3.0, 4.0, 7.0, 10.0]))
            }
            // A product of two variables grows without bound in a loop.
            Binary::Multiply => Value::Number(self.source.pick(&[0.5, 2.0, -1.0, 0.1, 1.5, 3.0])),
            _ => self.value(depth - 1),
        };
        Value::Binary(operation, left, Box::new(right))
    }

    fn test(&mut self, depth: usize) -> Test {
        if depth > 0 && self.source.one_in(5) {
            let (a, b) = (Box::new(self.test(depth - 1)), Box::new(self.test(depth - 1)));
            return if self.source.one_in(2) { Test::Both(a, b) } else { Test::Either(a, b) };
        }
        let empty = self.source.one_in(if self.policy == Policy::Vacancy { 3 } else { 20 });
        if self.macro_b && empty {
            return Test::Empty(self.source.below(SLOTS), self.source.one_in(2));
        }
        let near = self.policy == Policy::NearRounding;
        let left = if near { self.value(2) } else { self.some_slot() };
        let right = if self.source.one_in(3) { self.value(1) } else { self.number() };
        Test::Compare(self.source.pick(&Relation::ALL), left, right)
    }
}
