//! What the words of a block cannot mean together on a lathe, and what they mean there only by an option of the machine.

use crate::canon::{Op, Role};
use crate::dialect::{Axis, Machine};
use crate::ir::{Nc, NcItem, SourceInfo};
use crate::lower::macro_b::build::Lowering;
use crate::text::Span;

/// The letters of [`Role::STEPS`].
const LETTERS: [&str; 4] = ["X and U", "Y and V", "Z and W", "C and H"];

impl Lowering<'_> {
    /// Checks a block of a lathe's program: what no source tells is said, not guessed.
    pub fn check_turning(&mut self, nc: &Nc, span: Span) {
        if self.control.machine() != Machine::Lathe {
            return;
        }
        let has = |role: Role| nc.word(role).is_some();
        let pairs = Role::STEPS.into_iter().zip(LETTERS);
        for (_, letters) in pairs.filter(|((whole, step), _)| has(*whole) && has(*step)) {
            let message = format!("{letters} in one block: no source says which of the two counts");
            self.findings.not_understood(span, message);
        }
        if nc.has(Op::MachineOnce) && Role::STEPS.iter().any(|(_, step)| has(*step)) {
            self.findings.not_understood(span, "an increment beside G53: no source says what it counts from");
        }
        if nc.word(Role::ArcRadius).and_then(|radius| radius.constant()).is_some_and(|radius| radius < 0.0) {
            self.findings.not_understood(
                span,
                "a negative R is an alarm on a lathe: an arc over 180 degrees is written with its centre, or as two arcs",
            );
        }
        self.check_turret(nc, span);
        self.check_line(nc, span);
    }

    /// A tool word of more than four digits, or where the control takes none.
    fn check_turret(&mut self, nc: &Nc, span: Span) {
        let Some(tool) = nc.word(Role::Turret) else { return };
        if tool.constant().is_some_and(|tool| tool >= 10_000.0) {
            let message =
                "a T word of more than four digits: which of them are the offset depends on the machine";
            self.findings.not_understood(span, message);
        }
        if nc.ops().any(|op| matches!(op, Op::LimitSpeed | Op::SetPosition | Op::Dwell)) {
            let message = "T beside G50 (G92) or G4 is an alarm: give T a block of its own";
            self.findings.not_understood(span, message);
        }
    }

    /// A and C in a block that cuts: the angle of a line and a chamfer, where the machine has no such axes.
    fn check_line(&mut self, nc: &Nc, span: Span) {
        let listed =
            |axis: Axis| self.control.profile().axes.as_ref().is_some_and(|axes| axes.contains(&axis));
        // In a drilling cycle it is the axis.
        let drills = |op: Op| op.is_cycle();
        let other = nc.items.iter().any(|item| matches!(item, NcItem::Code(..)))
            || nc.ops().any(drills)
            || self.motion.code.and_then(|id| self.codes.get(id)?.row).is_some_and(|row| drills(row.op));
        let cuts = Role::STEPS.iter().any(|(whole, step)| {
            !matches!(whole, Role::C) && (nc.word(*whole).is_some() || nc.word(*step).is_some())
        });
        let chamfer = nc.word(Role::C).is_some() && cuts && !other && !nc.has(Op::Rapid) && !listed(Axis::C);
        let angle = nc.word(Role::A).is_some() && !listed(Axis::A);
        for (found, what) in [
            (
                chamfer,
                "C beside X or Z is a chamfer on a lathe without a C axis: if the machine has one, list its axes in the profile",
            ),
            (
                angle,
                "A is the angle of a line on a lathe without an A axis: if the machine has one, list its axes in the profile",
            ),
        ] {
            if found {
                self.findings.not_understood(span, format!("{what}: axes = [\"X\", \"Z\", ...]"));
            }
        }
    }

    /// `G50 X Z S` limits the speed, and sets the place: two blocks here.
    pub fn apart_of_limit(&mut self, nc: &mut Nc, site: &SourceInfo) -> Option<Nc> {
        let axis = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
        if !nc.has(Op::LimitSpeed) || !nc.items.iter().any(axis) {
            return None;
        }
        if !self.control.dialect().codes.iter().any(|row| row.op == Op::SetPosition) {
            let message =
                "a position beside a limit of the spindle speed: no source says what it does on this control";
            self.findings.not_understood(site.span, message);
            return None;
        }
        let (words, rest): (Vec<_>, Vec<_>) = std::mem::take(&mut nc.items).into_iter().partition(axis);
        nc.items = rest;
        Some(Nc { items: std::iter::once(NcItem::Op(Op::SetPosition)).chain(words).collect() })
    }
}
