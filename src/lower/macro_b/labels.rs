//! The blocks that jumps can reach, and the ranges of loops.

use super::Lowering;
use super::codes::Codes;
use super::split::Piece;
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::BlockId;
use crate::syntax::{Expr, ExprKind, Item, ItemKind, ParsedFile};
use crate::text::Span;

/// The sequence numbers of a program that jumps or calls. One that only runs from
/// its first block to its last has none, and stays one basic block.
#[derive(Debug, Default)]
pub(super) struct Labels {
    /// In the order of their blocks.
    list: Vec<Label>,
    /// Each number with the index of its label, in order of both.
    by_number: Vec<(u32, usize)>,
    /// Targets of computed jumps listed so far.
    listed: usize,
}

/// Each computed jump lists every number; a program that would list more than this is refused.
const MAX_LISTED: usize = 4_000_000;

/// Where the lists grow longer than this, computed jumps share one.
const MANY_LISTED: usize = 100_000;

#[derive(Debug)]
struct Label {
    number: u32,
    /// The block of the file that has it.
    at: usize,
    span: Span,
    /// The blocks where the loops begin that it lies in, outermost first.
    loops: Vec<usize>,
}

impl Label {
    /// Block 0 is the entry; the labels' blocks follow it.
    fn id(index: usize) -> BlockId {
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
    fn places(&self, number: u32) -> &[(u32, usize)] {
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

impl Lowering<'_> {
    /// The block that a jump to a sequence number finds. Where none is, the
    /// program is refused and the id is one of an empty block.
    pub(super) fn target(&mut self, number: u32, span: Span) -> BlockId {
        let Some(index) = self.choose(number, span) else {
            let message = format!("no block of this program has the sequence number {number}");
            self.findings.add(Diagnostic::new(Code::TargetMissing, span, message));
            return self.builder.fresh();
        };
        if self.enters_loop(index) {
            let message = format!("the jump goes into the loop around N{number}");
            let help = "enter the loop at its WHILE or DO";
            self.findings.add(Diagnostic::new(Code::JumpIntoLoop, span, message).with_help(help));
        }
        Label::id(index)
    }

    /// True where computed jumps must share a list of targets, and may: each number stands once.
    pub(super) fn is_crowded(&self) -> bool {
        let labels = &self.labels;
        labels.listed.saturating_add(labels.by_number.len()) > MANY_LISTED
            && labels.by_number.windows(2).all(|pair| pair[0].0 != pair[1].0)
    }

    /// Every number and the block that a computed jump to it finds.
    pub(super) fn all_targets(&mut self, span: Span) -> Vec<(u32, BlockId)> {
        let mut numbers: Vec<u32> = self.labels.by_number.iter().map(|place| place.0).collect();
        numbers.dedup();
        self.labels.listed = self.labels.listed.saturating_add(numbers.len());
        if self.labels.listed > MAX_LISTED {
            self.findings.not_understood(span, "too many computed jumps to too many sequence numbers");
            return Vec::new();
        }
        let mut targets = Vec::with_capacity(numbers.len());
        for number in numbers {
            if let Some(index) = self.choose(number, span) {
                targets.push((number, Label::id(index)));
            }
        }
        targets
    }

    fn enters_loop(&self, index: usize) -> bool {
        let label = self.labels.list.get(index);
        let inside = |start: &usize| self.loops.iter().any(|open| open.start == *start);
        label.is_some_and(|label| !label.loops.iter().all(inside))
    }

    fn choose(&mut self, number: u32, span: Span) -> Option<usize> {
        let forward = self.control.behaviour(Question::GotoForwardFirst).map(|row| row.value.as_str());
        let candidates = self.labels.places(number);
        let first = candidates.first()?.1;
        let count = candidates.len();
        if count == 1 {
            return Some(first);
        }
        let (chosen, rule) = match forward {
            Some("true") => {
                // They stand in the order of their blocks.
                let is_behind = |place: &(u32, usize)| {
                    self.labels.list.get(place.1).is_some_and(|label| label.at <= self.at)
                };
                let found = candidates.get(candidates.partition_point(is_behind));
                (
                    found.map_or(first, |place| place.1),
                    "the control searches forward first, then from the head of the program",
                )
            }
            Some("false") => (first, "the control finds the first one in the program"),
            _ => (first, "no source says which one the control finds, so the first one counts"),
        };
        if let Some(row) =
            self.control.behaviour(Question::GotoForwardFirst).filter(|row| row.value != "unknown")
        {
            self.findings.rest_on(row, span);
        }
        let line = self.labels.list.get(chosen).map_or(0, |label| self.parsed.line_of(label.span.start));
        let message = format!("N{number} is in this program {count} times; {rule}: line {line} is taken");
        self.findings.add(Diagnostic::new(Code::TargetTwice, span, message));
        Some(chosen)
    }
}
