//! Random programs: small ones that mean something, and come to an end whatever is drawn.
//!
//! A program is drawn in an abstract form ([`Program`]) and spelled by the writer of a dialect. Loops are
//! counted by variables that nothing else writes, other jumps go forward, and a subprogram
//! calls only those behind it; so every program ends. Each step carries its own salt for the writer's
//! choices: where steps are left out, the others stay spelled as they were.

mod beside;
mod cc100;
mod draw;
mod fadal;
mod macro_b;
mod shrink;
pub mod trial;
mod value;

pub use shrink::smaller;
pub use value::{Binary, Relation, Test, Unary, Value};

/// The dialects that programs are spelled in.
pub const DIALECTS: [&str; 4] = ["fadal", "fanuc", "haas", "cc100"];

/// What a program has most of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Policy {
    /// Jumps and what is behind them.
    Goto,
    /// Loops in loops.
    DeepDo,
    /// Calls that pass values.
    Arguments,
    /// Numbers that lie beside where rounding turns.
    NearRounding,
    /// Variables that nothing set.
    Vacancy,
    /// Drilling cycles.
    Cycles,
    /// Work offsets, tool offsets, positions read back.
    Offsets,
    /// Arcs in all planes, and what turns, mirrors, shifts or compensates moves.
    Figures,
    /// Calls of all forms, modal ones and repeats too.
    Calls,
    /// What the operator sees, is asked and switches.
    Operator,
    /// Words by variables, numbers in all forms, spacing, tools and spindle.
    Words,
    /// Codes of spindle, coolant, tool and stops in the blocks of moves.
    Beside,
    /// Variables, jumps and calls by computed numbers, which may meet what a compiler invents.
    Reach,
    /// Calls of programs that cannot be converted.
    Missing,
    /// Machines of either unit, programs that name theirs and programs that do not, and changes from one to the other.
    Units,
}

impl Policy {
    /// All of them.
    pub const ALL: [Policy; 15] = [
        Policy::Goto,
        Policy::DeepDo,
        Policy::Arguments,
        Policy::NearRounding,
        Policy::Vacancy,
        Policy::Cycles,
        Policy::Offsets,
        Policy::Figures,
        Policy::Calls,
        Policy::Operator,
        Policy::Words,
        Policy::Beside,
        Policy::Reach,
        Policy::Missing,
        Policy::Units,
    ];
}

/// Where choices come from: a seed, or the bytes of a fuzzer.
#[derive(Clone, Debug)]
pub enum Source<'b> {
    /// The state of a generator (splitmix64).
    Seed(u64),
    /// What is left of the bytes; behind the last one all choices are the first.
    Bytes(&'b [u8]),
}

impl Source<'_> {
    /// A number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        let drawn = match self {
            Source::Seed(state) => {
                *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let mixed = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                (mixed ^ (mixed >> 31)) >> 8
            }
            Source::Bytes(bytes) => {
                let (now, rest) = bytes.split_at(bytes.len().min(if end > 256 { 2 } else { 1 }));
                *bytes = rest;
                now.iter().fold(0, |sum, byte| sum << 8 | u64::from(*byte))
            }
        };
        (drawn % end.max(1) as u64) as usize
    }

    /// True once in so many times.
    pub fn one_in(&mut self, times: usize) -> bool {
        self.below(times) + 1 == times
    }

    /// One of several.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}

/// A program and the subprograms that it calls.
#[derive(Clone, Debug)]
pub struct Program {
    pub dialect: &'static str,
    pub policy: Policy,
    pub main: Vec<Step>,
    pub subs: Vec<Vec<Step>>,
    /// The writer's choices that belong to no step.
    pub salt: u64,
    /// Whether its own machine is set to millimetres, and whether the target's is.
    pub metric: [bool; 2],
}

/// A file of a program's library.
pub struct File {
    pub name: String,
    pub text: String,
}

/// A step, and the writer's choices in it.
#[derive(Clone, Debug)]
pub struct Step {
    pub salt: u64,
    pub kind: Kind,
}

impl Step {
    /// Where the choices in spelling it come from.
    pub fn choices(&self) -> Source<'static> {
        Source::Seed(self.salt)
    }
}

/// What a step does. Slots are variables of the program; each dialect has its own names for them.
#[derive(Clone, Debug)]
pub enum Kind {
    Set {
        slot: usize,
        value: Value,
    },
    /// A cell of an array, by a counter.
    SetCell {
        counter: usize,
        value: Value,
    },
    Absolute(bool),
    Move {
        rapid: bool,
        axes: [Option<Value>; 3],
        feed: Option<f64>,
    },
    /// A quarter or three quarters of a circle, from where the tool stands.
    Arc {
        clockwise: bool,
        radius: Value,
    },
    Dwell(u32),
    If {
        test: Test,
        then: Vec<Step>,
        otherwise: Vec<Step>,
    },
    /// A counted loop; `counter` belongs to it alone.
    Repeat {
        counter: usize,
        times: u32,
        body: Vec<Step>,
    },
    /// Leaves the innermost loop.
    Leave(Test),
    /// Goes on at one of several places; the first where the value names none.
    Switch {
        on: usize,
        arms: Vec<Vec<Step>>,
    },
    Call {
        sub: usize,
        values: Vec<(usize, Value)>,
        times: u32,
    },
    Cycle {
        kind: usize,
        depth: Value,
        plane: Value,
        initial: bool,
        places: Vec<[Option<Value>; 2]>,
    },
    Offset(Offset),
    /// Spindle, coolant, tool.
    Machine(usize),
    /// What only this dialect has, by number.
    Own(usize, Value),
    /// A move that is more than a line, by number.
    Figure(usize, [Value; 2]),
    /// Moves in a mode that ends behind them.
    Within {
        frame: Frame,
        values: [Value; 2],
        body: Vec<Step>,
    },
    /// A subprogram that runs after each of some moves.
    Modal {
        sub: usize,
        values: Vec<(usize, Value)>,
        body: Vec<Step>,
    },
    /// What the operator or the machine beside the program takes part in, by number.
    Talk(usize, Value),
    /// Words in one of their spellings, by number.
    Words(usize, Value),
    /// Codes of the machine in a block that does something else, both by number.
    Beside {
        block: usize,
        value: Value,
        codes: Vec<usize>,
    },
    /// Variables by computed numbers, by number.
    Cells(usize, Value),
    /// Goes on at a number that nothing bounds, or that is bounded so that one of the arms follows.
    Jump {
        given: usize,
        form: usize,
        arms: Vec<Vec<Step>>,
    },
    /// Calls by a computed number: one of two subprograms, or whichever circumstances name.
    Far {
        subs: [usize; 2],
        given: usize,
        form: usize,
    },
    /// What comes is in millimetres, or in inches.
    Unit(bool),
    /// What no control has: its program cannot be converted.
    Unknown,
}

/// A mode that holds moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    Rotated,
    Mirrored,
    Scaled,
    /// Cutter compensation to the left.
    Left,
    Right,
    /// A length offset.
    Long,
    Shifted,
    Incremental,
}

/// A step about offsets.
#[derive(Clone, Debug)]
pub enum Offset {
    Select(u32),
    Write { row: u32, axis: usize, value: Value },
    Read { row: u32, axis: usize, slot: usize },
    Shift([Value; 2]),
    Position([Value; 2]),
    Length(u32),
    NoLength,
    WriteTool { tool: u32, value: Value },
    ReadTool { tool: u32, slot: usize },
    ReadPosition { axis: usize, slot: usize },
    ReadModal(usize),
    Home,
}

/// Draws a program; a seed gives the same one at all times and everywhere.
pub fn program(dialect: &'static str, policy: Policy, source: &mut Source<'_>) -> Program {
    draw::program(dialect, policy, source)
}

/// A program from the bytes of a fuzzer, which choose its dialect and policy too.
pub fn fuzzed(bytes: &[u8]) -> Program {
    let mut source = Source::Bytes(bytes);
    let (dialect, policy) = (source.pick(&DIALECTS), source.pick(&Policy::ALL));
    program(dialect, policy, &mut source)
}

impl Program {
    /// The subprograms that anything calls, by number: the others show nothing.
    fn called(&self) -> impl Iterator<Item = (usize, &Vec<Step>)> {
        let called = |(at, _): &(usize, &Vec<Step>)| shrink::is_called(&self.main, &self.subs, *at);
        self.subs.iter().enumerate().filter(called)
    }

    /// The files of the program and its subprograms in its dialect; the first one is run.
    pub fn files(&self) -> Vec<File> {
        let one = |text| vec![File { name: "random.nc".into(), text }];
        match self.dialect {
            "fadal" => one(fadal::write(self)),
            "cc100" => cc100::write(self),
            _ => one(macro_b::write(self)),
        }
    }

    /// Its text, to be looked at: that of all files.
    pub fn text(&self) -> String {
        self.files().into_iter().map(|file| file.text).collect()
    }
}

/// Codes that no control has.
const UNKNOWN: &[&str] = &["G777", "M777"];

/// A number with up to six decimals, without a point where it is whole.
fn plain(number: f64) -> String {
    let text = format!("{number:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// A number with a point.
fn pointed(number: f64) -> String {
    let text = plain(number);
    if text.contains('.') { text } else { text + "." }
}
