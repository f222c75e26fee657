//! Faults between the blocks of a file: loops, jumps and modal calls that do not match.

use crate::diag::Code;
use crate::syntax::support::fault;
use crate::syntax::{Block, Expr, ExprKind, Item, ItemKind, SyntaxError, Target, for_each_item};
use crate::text::Span;
use std::collections::HashMap;

/// Finds what is wrong between the blocks of a file, program by program. What is wrong
/// inside a block stands in [`Block::errors`].
///
/// A program ends where the next one begins, or at `%`. Blocks that were not read are
/// passed over, so that their faults are not reported twice; `source` is the file.
pub fn check_blocks(blocks: &[Block], source: &[u8]) -> Vec<SyntaxError> {
    let mut errors = Vec::new();
    let mut program = Program::default();
    for item in blocks.iter().flat_map(|block| &block.items) {
        if matches!(item.kind, ItemKind::Program(_) | ItemKind::Tape) {
            std::mem::take(&mut program).finish(&mut errors);
        }
        for_each_item(std::slice::from_ref(item), &mut |item| program.add(item, source, &mut errors));
    }
    program.finish(&mut errors);
    errors.sort_by_key(|error| error.span.start);
    errors
}

/// A loop of a program.
struct Loop {
    number: u32,
    /// The loop that it stands in.
    outer: Option<usize>,
    span: Span,
}

/// What is known of a program up to some block.
#[derive(Default)]
struct Program {
    loops: Vec<Loop>,
    /// The loops that are open, as places in `loops`.
    open: Vec<usize>,
    /// For each sequence number how often it stands, and in which loop it stands first.
    labels: HashMap<u32, (usize, Option<usize>)>,
    jumps: Vec<(u32, Span, Option<usize>)>,
    modal_calls: usize,
    /// True where a block was not read: it may hold any label or loop.
    has_gaps: bool,
}

impl Program {
    fn add(&mut self, item: &Item, source: &[u8], errors: &mut Vec<SyntaxError>) {
        let inside = self.open.last().copied();
        match &item.kind {
            ItemKind::Unparsed => self.has_gaps = true,
            ItemKind::Sequence { number, .. } => self.labels.entry(*number).or_insert((0, inside)).0 += 1,
            ItemKind::Goto(Target::Sequence(number)) => self.jumps.push((*number, item.span, inside)),
            ItemKind::Do { number, .. } => {
                self.open.push(self.loops.len());
                self.loops.push(Loop { number: *number, outer: inside, span: item.span });
            }
            ItemKind::End { number } => self.close(*number, item.span, errors),
            ItemKind::Word(word) if word.letter == 'G' => match word.value.as_ref().and_then(code) {
                Some(66.0 | 66.1) => self.modal_calls += 1,
                Some(67.0) if self.modal_calls == 0 => {
                    let text = String::from_utf8_lossy(item.span.of(source)).into_owned();
                    let message = format!("`{text}` cancels no modal call: none is active here");
                    errors.push(fault(Code::ModalCallNotOpen, item.span, message));
                }
                Some(67.0) => self.modal_calls -= 1,
                _ => {}
            },
            _ => {}
        }
    }

    fn close(&mut self, number: u32, span: Span, errors: &mut Vec<SyntaxError>) {
        let place = self.open.iter().rposition(|&open| self.loops[open].number == number);
        match place {
            Some(place) => {
                let closed = self.open.remove(place);
                if let Some(&inner) = self.open.get(place) {
                    let inner = self.loops[inner].number;
                    let message = format!("END{number} closes a loop while loop {inner} inside it is open");
                    errors.push(fault(Code::LoopsCross, span, message));
                }
                // What stays open is no longer inside the loop that was closed.
                let outer = self.loops[closed].outer;
                for &open in &self.open[place..] {
                    if self.loops[open].outer == Some(closed) {
                        self.loops[open].outer = outer;
                    }
                }
            }
            None if self.has_gaps => {}
            None => {
                errors.push(fault(
                    Code::LoopNotPaired,
                    span,
                    format!("no DO{number} is open for this END{number}"),
                ));
            }
        }
    }

    /// True where a jump at `from` stands inside the loop `target`, or in one inside that.
    fn is_within(&self, mut from: Option<usize>, target: Option<usize>) -> bool {
        let Some(target) = target else { return true };
        while let Some(at) = from {
            if at == target {
                return true;
            }
            from = self.loops[at].outer;
        }
        false
    }

    fn finish(self, errors: &mut Vec<SyntaxError>) {
        if !self.has_gaps {
            for open in self.open.iter().map(|&open| &self.loops[open]) {
                let message = format!("this DO{0} has no END{0}", open.number);
                errors.push(fault(Code::LoopNotPaired, open.span, message));
            }
        }
        for &(number, span, from) in &self.jumps {
            match self.labels.get(&number) {
                None if self.has_gaps => {}
                None => {
                    let message = format!("no block of this program has the number N{number}");
                    errors.push(fault(Code::MissingTarget, span, message));
                }
                Some((2.., _)) => {
                    let message = format!("N{number} stands more than once in this program");
                    errors.push(fault(Code::DuplicateTarget, span, message));
                }
                Some((_, inside)) if !self.is_within(from, *inside) => {
                    let message = format!("N{number} stands inside a loop, and this jump does not");
                    errors.push(fault(Code::JumpIntoLoop, span, message));
                }
                Some(_) => {}
            }
        }
    }
}

/// The number of a code that is written as one.
fn code(value: &Expr) -> Option<f64> {
    match &value.kind {
        ExprKind::Number(number) => Some(number.value),
        _ => None,
    }
}
