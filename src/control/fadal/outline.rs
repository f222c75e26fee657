//! Where a program's labels, sequence numbers and subroutines stand.

use crate::syntax::{Block, Expr, ExprKind, ItemKind, Label, Word};
use std::collections::{HashMap, HashSet};

/// The places of a program that calls and jumps go to, as block numbers.
#[derive(Debug, Default)]
pub(super) struct Outline {
    labels: HashMap<String, usize>,
    sequences: HashMap<u32, usize>,
    /// Sequence numbers that stand more than once.
    repeated: HashSet<u32>,
    subroutines: HashMap<u32, usize>,
    definitions: HashSet<usize>,
    /// The first block that does something.
    first_work: usize,
    /// Where the main part begins: after the M30 that closes the subroutines.
    pub main: usize,
}

impl Outline {
    /// Reads the blocks of a program.
    ///
    /// Subroutines are what stands before an M30 that has a definition (`L100`) before it;
    /// a program without one has none.
    pub fn new(blocks: &[&Block]) -> Self {
        let mut outline = Outline { first_work: blocks.len(), ..Outline::default() };
        for (at, block) in blocks.iter().enumerate() {
            for item in &block.items {
                match &item.kind {
                    ItemKind::Sequence { number, .. } => {
                        let first = *outline.sequences.entry(*number).or_insert(at);
                        outline.repeated.extend((first != at).then_some(*number));
                    }
                    ItemKind::Label(Label::Name(name)) => {
                        outline.labels.entry(name.clone()).or_insert(at);
                    }
                    ItemKind::Label(Label::Number(number)) => {
                        outline.labels.entry(number.to_string()).or_insert(at);
                    }
                    _ => {}
                }
            }
            let works = block.items.iter().any(|item| {
                !matches!(
                    item.kind,
                    ItemKind::Comment(_)
                        | ItemKind::Program(_)
                        | ItemKind::Sequence { .. }
                        | ItemKind::MacroMark
                        | ItemKind::EndOfBlock
                        | ItemKind::Tape
                )
            });
            if works {
                outline.first_work = outline.first_work.min(at);
            }
        }
        let close = blocks.iter().position(|block| has(block, 'M', 30));
        for (at, block) in blocks.iter().enumerate().take(close.unwrap_or(0)) {
            if let Some(number) = definition(block) {
                outline.subroutines.entry(number).or_insert(at);
                outline.definitions.insert(at);
            }
        }
        if let Some(close) = close.filter(|_| !outline.definitions.is_empty()) {
            outline.main = close + 1;
        }
        outline
    }

    /// True where a block begins a subroutine.
    pub fn defines(&self, index: usize) -> bool {
        self.definitions.contains(&index)
    }

    /// True between the first definition and the end of the subroutines.
    pub fn is_in_area(&self, index: usize) -> bool {
        index < self.main && self.definitions.iter().any(|first| *first < index)
    }

    /// True where the program has subroutines at its head.
    pub fn has_area(&self) -> bool {
        !self.definitions.is_empty()
    }

    /// True where something is done before a block.
    pub fn works_before(&self, index: usize) -> bool {
        self.first_work < index
    }

    /// The block of a label; of two the first.
    pub fn label(&self, label: &Label) -> Option<usize> {
        match label {
            Label::Name(name) => self.labels.get(name),
            Label::Number(number) => self.labels.get(&number.to_string()),
        }
        .copied()
    }

    /// The block of a sequence number, the first from the head, and whether it stands again.
    pub fn sequence(&self, number: u32) -> Option<(usize, bool)> {
        self.sequences.get(&number).map(|at| (*at, self.repeated.contains(&number)))
    }

    /// The block that begins a subroutine: number 1 is `L100`.
    pub fn subroutine(&self, number: u32) -> Option<usize> {
        self.subroutines.get(&number).copied()
    }
}

/// The subroutine that a block begins: `L100` alone but for its number and its comment.
fn definition(block: &Block) -> Option<u32> {
    let mut words = block.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Word(word) => Some(word),
        _ => None,
    });
    let word = words.next().filter(|word| word.letter == 'L')?;
    let number = whole(word)?;
    (words.next().is_none() && number >= 100 && number.is_multiple_of(100)).then_some(number / 100)
}

fn has(block: &Block, letter: char, number: u32) -> bool {
    block.items.iter().any(|item| {
        matches!(&item.kind, ItemKind::Word(word) if word.letter == letter && whole(word) == Some(number))
    })
}

fn whole(word: &Word) -> Option<u32> {
    match &word.value {
        Some(Expr { kind: ExprKind::Number(number), .. })
            if number.value.fract() == 0.0 && (0.0..1e9).contains(&number.value) =>
        {
            Some(number.value as u32)
        }
        _ => None,
    }
}
