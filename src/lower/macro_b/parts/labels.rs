//! The blocks that jumps can reach, and the ranges of loops.

use super::split::Piece;
use crate::canon::Op;
use crate::ir::BlockId;
use crate::lower::macro_b::codes::Codes;
use crate::syntax::{Expr, ExprKind, Item, ItemKind, ParsedFile};
use crate::text::Span;

/// The sequence numbers of a program that jumps or calls. One that only runs from
/// its first block to its last has none, and stays one basic block.
#[derive(Debug, Default)]
pub struct Labels {
    /// In the order of their blocks.
    pub list: Vec<Label>,
    /// Each number with the index of its label, in order of both.
    pub by_number: Vec<(u32, usize)>,
    /// Targets of computed jumps listed so far.
    pub listed: usize,
}

/// One sequence number.
#[derive(Debug)]
pub struct Label {
    /// Its sequence number.
    pub number: u32,
    /// The block of the file that has it.
    pub at: usize,
    /// The place of its word.
    pub span: Span,
    /// The blocks where the loops begin that it lies in, outermost first.
    pub loops: Vec<usize>,
}

impl Label {
    /// Block 0 is the entry; the labels' blocks follow it.
    pub fn id(index: usize) -> BlockId {
        BlockId(index as u32 + 1)
    }
}

impl Labels {
    /// Finds the labels of a program.
    pub fn scan(parsed: &ParsedFile<'_>, piece: &Piece, codes: &mut Codes<'_>) -> Self {
        let body = || parsed.blocks.get(piece.body.clone()).unwrap_or_default().iter();
        if !body().any(|block| jumps(&block.items, codes)) {
            return Self::default();
        }
        let mut labels = Self::default();
        let mut open: Vec<(u32, usize)> = Vec::new();
        for (offset, block) in body().enumerate() {
            let at = piece.body.start + offset;
            for item in &block.items {
                match &item.kind {
                    ItemKind::Sequence { number, .. } => labels.add(*number, at, item.span, &open),
                    ItemKind::Do { number, .. } => open.push((*number, at)),
                    ItemKind::End { number } => {
                        if let Some(found) = open.iter().rposition(|(open, _)| open == number) {
                            open.truncate(found);
                        }
                    }
                    _ => {}
                }
            }
        }
        labels.by_number = labels.list.iter().map(|label| label.number).zip(0..).collect();
        labels.by_number.sort_unstable();
        labels
    }

    fn add(&mut self, number: u32, at: usize, span: Span, open: &[(u32, usize)]) {
        if self.list.last().is_some_and(|last| last.at == at) {
            return;
        }
        self.list.push(Label { number, at, span, loops: open.iter().map(|(_, start)| *start).collect() });
    }

    /// How many there are: their blocks have the ids from 1 on.
    pub fn count(&self) -> usize {
        self.list.len()
    }

    /// The label of a block of the file: its number and its id.
    pub fn of_block(&self, at: usize) -> Option<(u32, BlockId)> {
        let index = self.list.binary_search_by_key(&at, |label| label.at).ok()?;
        self.list.get(index).map(|label| (label.number, Label::id(index)))
    }

    /// The number with the indices of its labels.
    pub fn places(&self, number: u32) -> &[(u32, usize)] {
        let start = self.by_number.partition_point(|place| place.0 < number);
        let end = self.by_number.partition_point(|place| place.0 <= number);
        &self.by_number[start..end]
    }
}

/// True where control may leave the straight way: the items jump or call.
fn jumps(items: &[Item], codes: &mut Codes<'_>) -> bool {
    items.iter().any(|item| match &item.kind {
        ItemKind::Goto(_) => true,
        ItemKind::If { body, .. } => jumps(body, codes),
        ItemKind::Word(word) if matches!(word.letter, 'G' | 'M') && !word.comma => {
            let Some(Expr { kind: ExprKind::Number(number), .. }) = &word.value else { return true };
            codes.find(word.letter, number.value).and_then(|id| codes.get(id)).is_some_and(|code| {
                code.alias.is_some()
                    || (code.row)
                        .is_some_and(|row| row.op.is_flow() && !matches!(row.op, Op::End | Op::EndRewind))
            })
        }
        _ => false,
    })
}
