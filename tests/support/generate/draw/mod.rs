//! Draws abstract programs by policy.

mod reach;
mod values;
mod weights;

use super::shrink::is_called;
use super::{Binary, Frame, Kind, Offset, Policy, Program, Source, Step, Unary, Value};

/// Variables that a program sets as it likes.
pub const SLOTS: usize = 10;
/// The first variable that a program reads and never writes: the circumstances give it, and how many there are.
pub const GIVEN: usize = 10;
const GIVENS: usize = 6;
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
    /// Given variables that the conditions around look at.
    tested: Vec<usize>,
    /// True in what a modal call or a frame holds, where there is no other.
    framed: bool,
}

pub fn program(dialect: &'static str, policy: Policy, source: &mut Source<'_>) -> Program {
    let salt = source.below(1 << 16) as u64;
    let few = match policy {
        Policy::Arguments | Policy::Calls => 1 + source.below(3),
        Policy::Missing => 2 + source.below(2),
        _ => source.below(3),
    };
    let mut draw = Draw {
        policy,
        macro_b: matches!(dialect, "fanuc" | "haas"),
        fuel: 0,
        counters: COUNTERS,
        rounds: 1,
        around: Vec::new(),
        callable: (0, few),
        tested: Vec::new(),
        framed: false,
        source,
    };
    draw.fuel = 6 + draw.source.below(if policy == Policy::Goto { 7 } else { 12 });
    let mut main = draw.head();
    let body = draw.steps(6);
    main.extend(body);
    let mut subs = Vec::new();
    for at in 0..few {
        draw.callable = (at + 1, few);
        draw.fuel = 4 + draw.source.below(6);
        subs.push(draw.steps(3));
    }
    // What nobody calls shows nothing.
    let lonely: Vec<usize> = (0..few).filter(|sub| !is_called(&main, &subs, *sub)).collect();
    for sub in lonely {
        let values = vec![(0, draw.number()), (1, draw.number())];
        main.push(draw.step(Kind::Call { sub, values, times: 1 }));
    }
    if policy == Policy::Missing {
        draw.spoil(&mut subs);
    }
    // The machines of the project file at the root, unless it is units that are wanted.
    let metric = match policy {
        Policy::Units => [draw.source.one_in(2), draw.source.one_in(2)],
        _ => [dialect == "cc100", false],
    };
    Program { dialect, policy, main, subs, salt, metric }
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
        let which = weights::drawn(self.policy, self.source);
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
                let known = self.tested.len();
                self.tested.extend(test.given());
                let then = self.steps(3);
                let otherwise = if self.source.one_in(2) { self.steps(2) } else { Vec::new() };
                self.tested.truncate(known);
                Kind::If { test, then, otherwise }
            }
            7 if self.rounds <= 12 => self.repeat(),
            8 if !self.around.is_empty() => Kind::Leave(self.test(0)),
            9 => {
                let given = self.given().filter(|_| !self.source.one_in(10));
                let on = given.unwrap_or_else(|| self.source.below(SLOTS));
                self.tested.push(on);
                let arms = (0..2 + self.source.below(2)).map(|_| self.steps(2)).collect();
                self.tested.pop();
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
            15 => Kind::Figure(self.source.below(16), [self.value(1), self.value(1)]),
            16 if !self.framed => self.frame(),
            17 if self.callable.0 < self.callable.1 => self.modal(),
            18 => Kind::Talk(self.source.below(20), self.value(1)),
            19 => Kind::Words(self.source.below(24), self.value(1)),
            20 => self.beside(),
            21 => Kind::Cells(self.source.below(16), self.value(1)),
            22 => self.jump(),
            23 if self.callable.0 < self.callable.1 => self.far(),
            24 => Kind::Unit(self.source.one_in(2)),
            _ => Kind::Set { slot: self.source.below(SLOTS), value: self.value(3) },
        }
    }

    fn repeat(&mut self) -> Kind {
        let (counter, times) = (self.counters, 2 + self.source.below(2) as u32);
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

    /// A mode, and the moves in it.
    fn frame(&mut self) -> Kind {
        const FRAMES: [Frame; 8] = [
            Frame::Rotated,
            Frame::Mirrored,
            Frame::Scaled,
            Frame::Left,
            Frame::Right,
            Frame::Long,
            Frame::Shifted,
            Frame::Incremental,
        ];
        let frame = self.source.pick(&FRAMES);
        let values = [self.value(1), self.value(1)];
        let body = self.moves();
        Kind::Within { frame, values, body }
    }

    /// Moves alone, with a figure or a hole among them.
    fn moves(&mut self) -> Vec<Step> {
        let mut out = Vec::new();
        for _ in 0..1 + self.source.below(3) {
            let kind = match self.source.below(8) {
                0 => Kind::Figure(self.source.below(16), [self.value(1), self.value(1)]),
                1 => self.cycle(),
                2 if self.policy == Policy::Calls => {
                    Kind::Set { slot: self.source.below(SLOTS), value: self.value(1) }
                }
                _ => self.motion(),
            };
            out.push(self.step(kind));
        }
        out
    }

    /// A subprogram that runs after each of some moves, and now and then another one in it.
    fn modal(&mut self) -> Kind {
        let sub = self.callable.0 + self.source.below(self.callable.1 - self.callable.0);
        let many = self.source.below(4);
        let values = (0..many).map(|_| (self.source.below(SLOTS), self.value(1))).collect();
        let mut body = self.moves();
        if !self.framed && self.source.one_in(4) {
            self.framed = true;
            let inner = self.modal();
            self.framed = false;
            body.push(self.step(inner));
        }
        Kind::Modal { sub, values, body }
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
}
