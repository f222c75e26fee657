//! The unconfirmed facts that an NC block as a whole rests on.

use super::block::Reading;
use super::program::Lowering;
use crate::canon::{Op, Role};
use crate::dialect::Question;
use crate::ir::{Class, Expr, NcItem, Var};

impl<'b> Lowering<'b> {
    /// Reports the unconfirmed facts that the block as a whole rests on.
    pub(super) fn block_facts(&mut self, reading: &mut Reading<'b, '_>, axes: bool) {
        let span = reading.span;
        let mine = |role| reading.items.iter().find_map(|item| word_in(item, role));
        if mine(Role::ArcI).or(mine(Role::ArcJ)).or(mine(Role::ArcK)).is_some() {
            let _ = self.rely(Question::ArcCentre, span);
        }
        if let Some(radius) = mine(Role::ArcRadius) {
            let negative = matches!(radius, Expr::Negate(_)) || radius.constant().is_some_and(|r| r < 0.0);
            let _ = self
                .rely(if negative { Question::ArcRadiusNegative } else { Question::ArcRadiusPositive }, span);
        }
        if reading.assigned.iter().any(|(var, _)| reading.read.contains(var)) {
            let _ = self.rely(Question::BlockAssignsFirst, span);
        }
        let codes = reading.codes;
        if codes.has(Op::RotateOn) {
            let _ = self.rely(Question::RotationDirection, span);
            if self.in_cycle() {
                let _ = self.rely(Question::RotationRunsCycle, span);
            }
        }
        if codes.has(Op::ReferenceReturn) && !axes {
            let _ = self.rely(Question::ReferenceAllAxes, span);
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
        let incremental = codes.has(Op::Incremental)
            || (!codes.has(Op::Absolute) && self.state.incremental.list().contains(&true));
        let begins = codes.motion().is_some_and(|row| row.op.is_cycle());
        if (begins || codes.motion().is_none() && self.in_cycle())
            && codes.value('R').is_some()
            && reading.items.iter().any(|item| word_in(item, Role::CycleR).is_some())
        {
            let _ = self.rely(Question::CycleRWord, span);
            self.plane_by_word = true;
        }
        match codes.motion() {
            Some(row) if row.op.is_cycle() => {
                if plane || codes.has(Op::CycleHere) {
                    let _ = self.rely(Question::CycleBlockRuns, span);
                }
                let has_plane = reading.items.iter().any(|item| word_in(item, Role::CycleR).is_some());
                if !has_plane && self.control.parametric_role('R', 0, Some(row)) == Some(Role::CycleR) {
                    if self.plane_by_word {
                        let what = "which retract plane this cycle takes after a word R is not known: write it as R0 with its sign";
                        self.findings.not_understood(span, what);
                    }
                    let _ = self.rely(Question::CycleR0Kept, span);
                    let r0 = Expr::Var(Var { class: Class::Parametric, number: 0 });
                    reading.items.push(NcItem::Word(Role::CycleR, r0));
                }
                if incremental {
                    let _ = self.rely(Question::CyclePlanesFrozen, span);
                }
            }
            None if axes && incremental && self.in_cycle() => {
                let _ = self.rely(Question::CyclePlanesFrozen, span);
            }
            _ => {}
        }
    }
}

fn word_in(item: &NcItem, role: Role) -> Option<&Expr> {
    match item {
        NcItem::Word(found, value) if *found == role => Some(value),
        _ => None,
    }
}
