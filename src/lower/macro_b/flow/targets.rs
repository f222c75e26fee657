//! The blocks that jumps find.

use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::BlockId;
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::parts::Label;
use crate::text::Span;

/// Each computed jump lists every number; a program that would list more than this is refused.
const MAX_LISTED: usize = 4_000_000;

/// Where the lists grow longer than this, computed jumps share one.
const MANY_LISTED: usize = 100_000;

impl Lowering<'_> {
    /// The block that a jump to a sequence number finds; one with an alarm if no block has it.
    pub fn target(&mut self, number: u32, span: Span) -> BlockId {
        let Some(index) = self.choose(number, span) else {
            let label = format!("N{number}");
            return self.nowhere.block(label, span, &mut self.builder, &mut self.findings);
        };
        if self.enters_loop(index) {
            let message = format!("the jump goes into the loop around N{number}");
            let help = "enter the loop at its WHILE or DO";
            self.findings.add(Diagnostic::new(Code::JumpIntoLoop, span, message).with_help(help));
        }
        Label::id(index)
    }

    /// True where computed jumps must share a list of targets, and may: each number stands once.
    pub fn is_crowded(&self) -> bool {
        let labels = &self.labels;
        labels.listed.saturating_add(labels.by_number.len()) > MANY_LISTED
            && labels.by_number.windows(2).all(|pair| pair[0].0 != pair[1].0)
    }

    /// Every number and the block that a computed jump to it finds.
    pub fn all_targets(&mut self, span: Span) -> Vec<(u32, BlockId)> {
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
