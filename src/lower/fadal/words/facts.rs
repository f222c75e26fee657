//! The unconfirmed facts that an NC block as a whole rests on.

use super::reading::Reading;
use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::ir::{Expr, NcItem};
use crate::lower::fadal::build::{Lowering, PLANE};

impl<'b> Lowering<'b> {
    /// Reports the unconfirmed facts that the block as a whole rests on.
    pub(super) fn block_facts(&mut self, reading: &mut Reading<'b, '_>, axes: bool) {
        let span = reading.span;
        let mine = |role| reading.items.iter().find_map(|item| word_in(item, role));
        if mine(Role::ArcI).or(mine(Role::ArcJ)).or(mine(Role::ArcK)).is_some() {
            self.suppose(Question::ArcCentre, "incremental", span);
        }
        if let Some(radius) = mine(Role::ArcRadius) {
            let negative = matches!(radius, Expr::Negate(_)) || radius.constant().is_some_and(|r| r < 0.0);
            let (question, answer) = match negative {
                true => (Question::ArcRadiusNegative, "long"),
                false => (Question::ArcRadiusPositive, "short"),
            };
            self.suppose(question, answer, span);
        }
        if reading.assigned.iter().any(|(var, _)| reading.read.contains(var)) {
            self.suppose(Question::BlockAssignsFirst, "true", span);
        }
        let codes = reading.codes;
        if codes.has(Op::RotateOn) {
            self.suppose(Question::RotationDirection, "ccw", span);
            if self.in_cycle() {
                let _ = self.rely(Question::RotationRunsCycle, span);
            }
        }
        if codes.has(Op::ReferenceReturn) && !axes {
            self.suppose(Question::ReferenceAllAxes, "true", span);
        }
        self.cycle_facts(reading, axes);
    }

    fn cycle_facts(&mut self, reading: &mut Reading<'b, '_>, axes: bool) {
        let span = reading.span;
        let codes = reading.codes;
        let plane = reading
            .items
            .iter()
            .any(|item| matches!(item, NcItem::Word(Role::X | Role::Y | Role::A | Role::B | Role::C, _)));
        let says = |op: Op| reading.items.contains(&NcItem::Op(op));
        let incremental =
            says(Op::Incremental) || (!says(Op::Absolute) && self.state.incremental.list().contains(&true));
        let begins = codes.motion().is_some_and(|row| row.op.is_cycle());
        if (begins || codes.motion().is_none() && self.in_cycle())
            && codes.value('R').is_some()
            && reading.items.iter().any(|item| word_in(item, Role::CycleR).is_some())
        {
            self.suppose(Question::CycleRWord, "true", span);
            self.planes.by_word = true;
        }
        match codes.motion() {
            Some(row) if row.op.is_cycle() => {
                if plane || codes.has(Op::CycleHere) {
                    self.suppose(Question::CycleBlockRuns, "true", span);
                }
                let has_plane = reading.items.iter().any(|item| word_in(item, Role::CycleR).is_some());
                if !has_plane && self.control.parametric_role('R', 0, Some(row)) == Some(Role::CycleR) {
                    if self.planes.by_word {
                        let what = "after a word R it is not known which retract plane this cycle takes: \
                                    write R0 with its sign";
                        self.findings.not_understood(span, what);
                    }
                    self.suppose(Question::CycleR0Kept, "true", span);
                    reading.items.push(NcItem::Word(Role::CycleR, Expr::Var(PLANE)));
                }
                if incremental {
                    self.suppose(Question::CyclePlanesFrozen, "true", span);
                }
            }
            None if axes && incremental && self.in_cycle() => {
                self.suppose(Question::CyclePlanesFrozen, "true", span);
            }
            _ => {}
        }
        if codes.motion().is_none() {
            self.notes_hole(reading, axes, incremental);
        }
    }
}

fn word_in(item: &NcItem, role: Role) -> Option<&Expr> {
    match item {
        NcItem::Word(found, value) if *found == role => Some(value),
        _ => None,
    }
}
