//! G90 and G91 by their places: a control may read a block from left to right, so that one counts for the words after it.

use super::reading::Reading;
use crate::canon::{Group, Op, Role};
use crate::dialect::Question;
use crate::ir::NcItem;
use crate::lower::fadal::build::Lowering;

impl<'b> Lowering<'b> {
    /// Puts the code that counts for the words of a block before them. Gives the one that counts from the next block on,
    /// where it is another; none if the block is not understood.
    pub(super) fn distance_by_place(&mut self, reading: &mut Reading<'b, '_>) -> Option<Option<Op>> {
        let runs = Runs::of(&reading.items);
        if runs.codes.is_empty() || !runs.words[0] && runs.codes.len() == 1 {
            return Some(None);
        }
        match self.rely(Question::DistanceCode, reading.span) {
            Some("by.place") => {}
            _ => return Some(None),
        }
        let last = runs.codes.last().copied();
        let told: Vec<usize> = (0..runs.words.len()).filter(|run| runs.words[*run]).collect();
        let (counts, after) = match told.as_slice() {
            [] => (last, None),
            [run] if *run == runs.codes.len() => (last, None),
            [0] => (None, last),
            [run] => (Some(runs.codes[run - 1]), last.filter(|last| *last != runs.codes[run - 1])),
            [0, ..] => return self.refuse(reading.span, UNTOLD),
            many if many.windows(2).all(|two| runs.codes[two[0] - 1] == runs.codes[two[1] - 1]) => {
                let counts = runs.codes[many[0] - 1];
                (Some(counts), last.filter(|last| *last != counts))
            }
            _ => {
                self.step_words(reading)?;
                (Some(Op::Absolute), last.filter(|last| *last != Op::Absolute))
            }
        };
        let items = std::mem::take(&mut reading.items);
        reading.items.extend(counts.map(NcItem::Op));
        reading.items.extend(items.into_iter().filter(|item| distance(item).is_none()));
        if after.is_some() && (self.state.modal > 0 || self.state.modal_program) {
            return self.refuse(reading.span, UNDER_CALL);
        }
        let repeats = |item: &NcItem| matches!(item, NcItem::Word(Role::Repeat, _));
        if after.is_some() && reading.items.iter().any(repeats) {
            return self.refuse(reading.span, REPEATED);
        }
        Some(after)
    }

    /// In a block with places and increments, the increments become words of their own.
    fn step_words(&mut self, reading: &mut Reading<'b, '_>) -> Option<()> {
        let plain = |op: Op| {
            matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw)
                || matches!(op.group(), Group::Distance | Group::Spindle | Group::Coolant)
        };
        let all_plain = reading.items.iter().all(|item| !matches!(item, NcItem::Op(op) if !plain(*op)));
        if !all_plain || self.in_cycle() {
            return self.refuse(reading.span, MIXED);
        }
        let mut mode = Op::Absolute;
        for item in &mut reading.items {
            mode = distance(item).unwrap_or(mode);
            let NcItem::Word(role, _) = item else { continue };
            if mode == Op::Incremental && depends(*role) {
                let pair = Role::STEPS.into_iter().find(|(whole, _)| whole == role);
                let Some((_, step)) = pair else { return self.refuse(reading.span, MIXED) };
                *role = step;
            }
        }
        Some(())
    }
}

const UNTOLD: &str = "G90 or G91 stands between the words of this block, and counts for those after it alone: write \
                      one before the first of them too";
const MIXED: &str = "G90 counts for some words of this block, and G91 for others: write them in two blocks, or all under \
                     one of the two";
const UNDER_CALL: &str =
    "G90 or G91 after the words of a move that calls a subroutine (G66): write it in a block of its own";
const REPEATED: &str = "G90 or G91 after the words of a block with L: write it in a block of its own";

/// The words of a block between its codes of the distance mode.
struct Runs {
    /// The codes, in order.
    codes: Vec<Op>,
    /// Whether words that hang on the mode stand before the first code, and after each.
    words: Vec<bool>,
}

impl Runs {
    fn of(items: &[NcItem]) -> Self {
        let mut runs = Self { codes: Vec::new(), words: vec![false] };
        for item in items {
            match item {
                NcItem::Word(role, _) if depends(*role) => {
                    runs.words.last_mut().into_iter().for_each(|any| *any = true);
                }
                item => {
                    if let Some(op) = distance(item) {
                        runs.codes.push(op);
                        runs.words.push(false);
                    }
                }
            }
        }
        runs
    }
}

fn distance(item: &NcItem) -> Option<Op> {
    match item {
        NcItem::Op(op) if op.group() == Group::Distance => Some(*op),
        _ => None,
    }
}

/// True for a word that means another thing under G91.
fn depends(role: Role) -> bool {
    role.is_axis() || matches!(role, Role::CycleR | Role::OffsetValue)
}
