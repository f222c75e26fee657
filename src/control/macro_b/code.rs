//! Programs prepared to be run: variables and codes looked up once, loops and labels matched.

use crate::canon::{Func, Role, Sys};
use crate::control::by_need::Stretch;
use crate::control::outcome::Stop;
use crate::dialect::{Alias, CodePlace};
use crate::syntax::BinaryOp;
use crate::text::Span;
use std::collections::HashMap;
use std::sync::Arc;

/// A program.
#[derive(Default)]
pub struct Program {
    pub parts: Vec<CodePart>,
    /// How many blocks it has.
    pub count: usize,
    /// Blocks of each sequence number, in order.
    pub labels: HashMap<u32, Vec<usize>>,
    /// The innermost loop that each block stands in, as a place in `loops`; empty where there are none.
    pub loop_of: Vec<Option<usize>>,
    pub loops: Vec<Loop>,
    /// Where the heads and ends of loops lead, by block.
    pub ends: HashMap<usize, Ends>,
    /// Where its branches stand.
    pub branches: Vec<Span>,
}

/// Some blocks of a program.
pub struct CodePart {
    pub stretch: Stretch,
    /// The first of their branches.
    pub branches: usize,
    /// They, where they are held; else they are made anew where a run comes to them.
    pub held: Option<Vec<Block>>,
}

/// Where the head or the end of a loop leads.
#[derive(Default)]
pub struct Ends {
    pub tail: Option<usize>,
    pub head: Option<usize>,
    /// Why it is an alarm.
    pub fault: Option<&'static str>,
    /// The switch that leaves the other end out and not this one, and why it is an alarm while that is on.
    pub alone: Option<(u8, &'static str)>,
}

/// Where a block of a program is.
pub enum At<'c> {
    Held(&'c Block),
    /// At this place of this part, which is not held.
    Made(usize, usize),
}

impl Program {
    /// Finds a block; none after the last.
    pub fn find(&self, at: usize) -> Option<At<'_>> {
        let index = self.parts.partition_point(|part| part.stretch.first + part.stretch.count <= at);
        let part = self.parts.get(index)?;
        let place = at - part.stretch.first;
        match &part.held {
            Some(blocks) => blocks.get(place).map(At::Held),
            None => Some(At::Made(index, place)),
        }
    }
}

/// A loop that has its end.
pub struct Loop {
    pub head: usize,
    pub tail: usize,
    pub outer: Option<usize>,
}

/// A block.
pub struct Block {
    pub span: Span,
    /// Its sequence number.
    pub sequence: Option<u32>,
    pub steps: Vec<Step>,
    /// Facts that it rests on whatever the values are.
    pub facts: Vec<String>,
}

/// What a block does, one after the other.
pub enum Step {
    /// If this switch is on, the block ends here, with the words before the sign; else they act with those after it.
    Skip {
        level: u8,
        before: Vec<Step>,
    },
    Assign {
        target: Var,
        value: Ex,
    },
    /// `#3000=..` and `#3006=..` with the text beside them.
    Signal {
        alarm: bool,
        value: Ex,
        text: String,
    },
    If {
        condition: Ex,
        branch: usize,
        body: Vec<Step>,
    },
    /// The head of a loop: where it ends, and its condition.
    While {
        condition: Option<(Ex, usize)>,
        tail: usize,
    },
    /// The end of a loop: where it begins.
    Repeat {
        head: usize,
    },
    Goto {
        target: Goto,
        branch: usize,
    },
    Words(Words),
    Names {
        first: u32,
        names: Vec<String>,
    },
    /// The port for output is opened, or closed.
    Port {
        open: bool,
    },
    Output {
        binary: bool,
        parts: Vec<Part>,
    },
    /// What the control answers with an alarm.
    Alarm(Stop),
    /// What cannot be run.
    Unreadable(String),
}

/// Where a jump goes.
pub enum Goto {
    Number(u32),
    Computed(Ex),
}

/// A piece of output.
pub enum Part {
    Text(String),
    Value { value: Ex, whole: u32, fraction: u32 },
}

/// An expression.
pub enum Ex {
    Number(f64),
    Read(Box<Var>),
    Group(Box<Ex>),
    Negate(Box<Ex>),
    Plus(Box<Ex>),
    Binary(BinaryOp, Box<Ex>, Box<Ex>),
    Call(Func, Box<Ex>),
    Call2(Func, Box<Ex>, Box<Ex>),
}

/// A variable.
pub enum Var {
    Local(usize),
    /// A variable by its number that is no local and no system variable.
    Shared(u32),
    System(Box<System>),
    /// The bit of a system variable.
    Bit(Box<System>, u32),
    Named(String),
    Computed(Box<Ex>),
    /// A family with a fixed name: `#_ABSIO[1]`.
    Family(String, Box<Ex>),
    /// No such variable.
    Missing(u32),
}

/// A system variable.
#[derive(Clone, Debug)]
pub struct System {
    pub number: u32,
    pub state: Sys,
    pub subscripts: Vec<u32>,
    pub readable: bool,
    pub writable: bool,
    /// The largest number that it is known to take.
    pub most: Option<f64>,
    /// Its fact, where no source confirms it.
    pub unsure: Option<String>,
}

/// The words of a block.
pub struct Words {
    pub words: Vec<Word>,
    /// What they mean; absent where a code is computed.
    pub meaning: Option<Arc<Meaning>>,
    /// The text that a stop among them shows.
    pub shown: Option<String>,
}

/// A word.
pub struct Word {
    pub letter: char,
    pub comma: bool,
    pub value: Ex,
    /// How it is written.
    pub form: Form,
}

/// How a word's value is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Digits without a decimal point.
    Bare,
    /// Digits with a decimal point.
    Point,
    /// A variable.
    Variable,
    /// Brackets round one variable, or a sign before it.
    Wrapped,
    /// Anything else.
    Computed,
}

impl Form {
    pub fn is_literal(self) -> bool {
        matches!(self, Form::Bare | Form::Point)
    }
}

/// What the words of a block mean together.
#[derive(Clone, Debug, Default)]
pub struct Meaning {
    pub codes: Vec<Coded>,
    /// The role of each word beside the codes, where one reads it.
    pub beside: Vec<Option<(Role, CodePlace)>>,
    /// The role of each word by itself.
    pub alone: Vec<Option<Role>>,
    /// Facts that it rests on.
    pub facts: Vec<String>,
    pub fault: Option<Stop>,
}

/// A code of a block.
#[derive(Clone, Copy, Debug)]
pub struct Coded {
    /// Its place among the words.
    pub word: usize,
    pub letter: char,
    pub number: f64,
    pub row: Option<CodePlace>,
    pub alias: Option<Alias>,
}
