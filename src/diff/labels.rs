//! The blocks of a program that its jumps and calls name.

use super::normal::whole;
use crate::canon::{Op, Role};
use crate::dialect::{CodeMeaning, Control};
use crate::syntax::{Block, ExprKind, ItemKind, Label, Target, for_each_item};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// The blocks of a program that its own jumps and calls go to, by what they are in its text: the first, the second.
pub struct Labels {
    /// The number of each, by its own.
    pub names: BTreeMap<u32, usize>,
    /// Where they are named.
    pub places: Vec<(Span, usize)>,
}

impl Labels {
    /// Reads a program.
    pub fn of(blocks: &[Block], control: &Control) -> Self {
        let mut named: Vec<(Span, u32)> = Vec::new();
        let mut order = Vec::new();
        // Where a program has labels, calls name those.
        let items = blocks.iter().flat_map(|block| &block.items);
        let labels = items.filter_map(|item| match item.kind {
            ItemKind::Label(Label::Number(number)) => Some(number),
            _ => None,
        });
        let marks: BTreeSet<u32> = labels.collect();
        for block in blocks {
            let code = code_of(block, control);
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Sequence { number, .. } => order.push(*number),
                ItemKind::Goto(Target::Sequence(number))
                | ItemKind::Branch { target: Target::Sequence(number), .. } => {
                    named.push((item.span, *number))
                }
                ItemKind::Word(word) => {
                    let role = control.role(word.letter, word.comma, code);
                    if let Some(value) = word.value.as_ref().filter(|_| role == Some(Role::Sequence)) {
                        let number = whole(value).filter(|number| !marks.contains(number));
                        named.extend(number.map(|number| (value.span, number)));
                    }
                }
                _ => {}
            });
        }
        let wanted: BTreeSet<u32> = named.iter().map(|(_, number)| *number).collect();
        let mut names = BTreeMap::new();
        for number in order.into_iter().filter(|number| wanted.contains(number)) {
            let next = names.len() + 1;
            names.entry(number).or_insert(next);
        }
        // A jump to a block that is not there keeps its number.
        let places = named.iter().filter_map(|(span, number)| Some((*span, *names.get(number)?)));
        Self { places: places.collect(), names }
    }
}

/// The code of a block that calls or returns, of those that it has.
pub fn code_of<'c>(block: &Block, control: &'c Control) -> Option<&'c CodeMeaning> {
    let calls = |op: Op| {
        matches!(
            op,
            Op::CallMacro
                | Op::CallModal
                | Op::CallModalEach
                | Op::CallProgram
                | Op::CallLocal
                | Op::Return
                | Op::SubEnd
        )
    };
    let words = words(block);
    let all = words.iter().filter(|(letter, _)| matches!(letter, 'G' | 'M'));
    all.filter_map(|(letter, number)| control.code(*letter, (*number)?, &words)).find(|row| calls(row.op))
}

/// The words of a block with the numbers that are written.
pub fn words(block: &Block) -> Vec<(char, Option<f64>)> {
    let mut out = Vec::new();
    for_each_item(&block.items, &mut |item| {
        if let ItemKind::Word(word) = &item.kind {
            let number = word.value.as_ref().and_then(|value| match &value.kind {
                ExprKind::Number(number) => Some(number.value),
                _ => None,
            });
            out.push((word.letter, number));
        }
    });
    out
}
