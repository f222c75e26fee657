//! What a program takes from outside: read off its text.

mod both;
mod reader;
mod solve;

pub use both::inputs_of_both;

use super::side::Side;
use crate::canon::{Op, Sys};
use crate::control::ProgramRef;
use crate::syntax::{ExprKind, Index, Item, ItemKind, Label, VarRef};
use reader::Reader;
use std::collections::{BTreeMap, BTreeSet};

/// What a program takes from outside.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    /// The variables that are read before the text writes them.
    pub variables: Vec<Input>,
    /// Variables that conditions hold against each other, by place in `variables`.
    pub pairs: Vec<(usize, usize)>,
    /// Numbers that the program's conditions name, and their neighbours.
    pub numbers: Vec<f64>,
    /// State of the machine that the program reads, and the numbers that it is compared with.
    pub cells: BTreeMap<(Sys, Vec<u32>), Vec<f64>>,
    /// The switches that skip blocks, `/` alone as 1.
    pub skips: BTreeSet<u8>,
    /// True where the operator is asked.
    pub asks: bool,
    /// True for each of A, B and C that a program of the library moves.
    pub rotary: [bool; 3],
    /// True if the control has tool offsets past 99.
    pub many_tools: bool,
    /// The unit that the machine must be set to, where the program checks it: true for inch.
    pub inch: Option<bool>,
}

/// Numbers that are tried in each variable besides its own, at the most.
const MORE: usize = 24;

impl Inputs {
    /// Has these numbers tried too: any variable may be what they are computed from.
    pub fn try_also(&mut self, numbers: &[f64]) {
        for input in &mut self.variables {
            let new: Vec<f64> = numbers.iter().copied().filter(|n| !input.values.contains(n)).collect();
            input.values.extend(new.into_iter().take(MORE));
        }
        self.numbers.extend(numbers);
    }
}

/// A variable that a run is started with.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// True where it may be vacant.
    pub nullable: bool,
    /// The numbers that it is compared with, and their neighbours; those are the values worth trying.
    pub values: Vec<f64>,
    /// True for a register of the target that no variable of the source has: the name is the target's.
    pub theirs: bool,
}

/// Reads a program.
pub fn inputs(side: &Side<'_>, program: ProgramRef) -> Inputs {
    inputs_by(side, program, &labels(side, program).into_iter().take(LABELS).collect::<Vec<_>>())
}

/// Labels that a computed jump is sent to, at the most, where one side is looked at.
const LABELS: usize = 20;

/// The numbers that jumps in a program can find.
fn labels(side: &Side<'_>, program: ProgramRef) -> BTreeSet<u32> {
    let items = side.text(program).iter().flat_map(|block| &block.items);
    let number = |item: &Item| match &item.kind {
        ItemKind::Sequence { number, .. } | ItemKind::Label(Label::Number(number)) => Some(*number),
        _ => None,
    };
    items.filter_map(number).collect()
}

/// Reads a program whose computed jumps are sent to these labels.
fn inputs_by(side: &Side<'_>, program: ProgramRef, order: &[u32]) -> Inputs {
    let mut reader = Reader::new(side.control);
    for (at, one) in side.links().called_from(program, |_| true).into_iter().enumerate() {
        reader.own = at == 0;
        reader.labels =
            if at == 0 { order.to_vec() } else { labels(side, one).into_iter().take(LABELS).collect() };
        side.text(one).iter().for_each(|block| reader.items(&block.items, at == 0));
    }
    Inputs { rotary: side.links().rotary(), many_tools: has_many_tools(side), ..reader.finish() }
}

/// True if a table of tool offsets has more rows than two digits count.
fn has_many_tools(side: &Side<'_>) -> bool {
    let rows = side.control.dialect().system.iter().filter(|row| row.state.is_tool_offset());
    rows.filter_map(|row| row.subscripts.first()).any(|subscript| subscript.count > 99)
}

/// The programs that a block may call: those whose numbers stand in its P words, and cycles that a code of theirs calls.
pub(super) fn calls<'s>(side: &'s Side<'_>, items: &'s [Item]) -> impl Iterator<Item = ProgramRef> + 's {
    items.iter().filter_map(|item| {
        let ItemKind::Word(word) = &item.kind else { return None };
        let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else {
            return None;
        };
        if word.letter == 'G' {
            let row = side.control.code('G', number.value, &[]).filter(|row| row.op == Op::CallCycle);
            return row.and_then(|_| side.library.cycle((number.value % 100.0) as u32));
        }
        let is_number = word.letter == 'P' && number.value >= 1.0 && number.value.fract() == 0.0;
        // A float outside the range becomes its nearest end.
        is_number.then(|| side.numbered(number.value as u32)).flatten()
    })
}

/// The whole name of a variable whose subscript is written: `#100`, `VX`.
pub(super) fn name_of(variable: &VarRef) -> Option<String> {
    match &variable.index {
        Index::Number(number) => Some(format!("{}{number}", variable.name)),
        Index::Letter(letter) => Some(format!("{}{letter}", variable.name)),
        _ => None,
    }
}
