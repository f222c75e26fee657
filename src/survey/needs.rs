//! Which lines about a machine itself a library needs: who is asked for what no program rests on answers no question with care.

use super::{AskedStart, Survey};
use crate::canon::Op;
use crate::dialect::{Control, Machine, Settled, Side};
use crate::ir::{Module, NcItem};

/// What the programs show of that.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Needs {
    /// A return without axes: it takes home what no program moves, too.
    whole_return: bool,
    /// Words for the way of an axis, as a lathe has them in the G code system that is taken.
    steps: bool,
    /// Programs at whose heads no code can be written rest on the unit of the target.
    unit_there: bool,
}

impl Needs {
    pub(super) fn of(module: &Module, unit_there: bool) -> Self {
        let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
        let mut needs = Self { unit_there, ..Self::default() };
        for nc in stmts.filter_map(|stmt| stmt.kind.nc()) {
            needs.whole_return |= nc.has(Op::ReferenceReturn) && !nc.moves();
            needs.steps |=
                nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_step()));
        }
        needs
    }
}

impl Survey<'_> {
    /// True where the programs of a lathe show the G code system that is taken: others have no such words.
    pub(super) fn shows_code_system(&self, side: Side) -> bool {
        side == Side::Source && self.needs.steps
    }

    /// True where the axes that a machine has make a difference: beside those of every machine of its kind programs move some, send
    /// home all that there are, or have letters that are axes on some machines alone.
    pub(super) fn needs_axes(&self) -> bool {
        !self.further_axes.is_empty()
            || self.needs.whole_return
            || self.shape.lathe > 0 && self.taken.is_none()
            || self.is_told("axes = [")
    }

    /// True where the programs show all that the line of the source's axes says: they move one more than every mill has.
    pub(super) fn shows_axes(&self) -> bool {
        let mill = self.controls[0].machine() == Machine::Mill;
        mill && self.further_axes.len() == 1 && !self.needs.whole_return
    }

    /// True where the unit that a machine is set to makes a difference: programs do not name theirs, or settings hold lengths in it.
    pub(super) fn needs_units(&self, side: Side, control: &Control) -> bool {
        let start = if side == Side::Source { &self.start } else { &self.start_of_target };
        let of_control = |row: &str| row.contains("unit of the control");
        let is_length = |name: &str| {
            let row =
                ["setting.", "parameter."].iter().find_map(|of| control.setting_row(&format!("{of}{name}")));
            row.is_some_and(|row| of_control(&row.meaning))
        };
        let profile = control.profile();
        start.iter().any(AskedStart::is_unit)
            || self.settings.iter().any(|asked| asked.side == side && of_control(&asked.meaning))
            || profile.settings.keys().chain(profile.parameters.keys()).any(|name| is_length(name))
            || self.asks(control, &Settled::UNITS)
            || side == Side::Target && self.needs.unit_there
            || self.is_told_of_units(side)
    }

    /// True where conversions take variables of the target for their own use.
    pub(super) fn takes_registers(&self) -> bool {
        std::iter::once(&self.rest).chain(&self.then).any(|made| !made.taken.is_empty())
    }

    fn asks(&self, control: &Control, settled: &Settled) -> bool {
        let is_it = |of: &Control| of.name() == control.name() && of.profile().file == control.profile().file;
        let asked = |questions: &crate::report::Questions<'_>| {
            let machines = questions.machines.iter().filter(|machine| is_it(machine.control));
            machines.flat_map(|machine| &machine.facts).any(|fact| fact.settled_by == *settled)
        };
        self.with_questions(asked) || self.with_later(asked)
    }

    /// True where help of a finding names the key of the unit: of the target, or of the source.
    fn is_told_of_units(&self, side: Side) -> bool {
        self.has_help(&|help| {
            let names = ["as units", "units = ", "`units`"].iter().any(|words| help.contains(words));
            names && help.contains("target") == (side == Side::Target)
        })
    }

    /// True where help of a finding names this line of a profile.
    pub(super) fn is_told(&self, words: &str) -> bool {
        self.has_help(&|help| help.contains(words))
    }

    fn has_help(&self, is_it: &dyn Fn(&str) -> bool) -> bool {
        let made = std::iter::once(&self.rest).chain(&self.then);
        let mut findings = made.flat_map(|made| &made.programs).flat_map(|program| &program.diagnostics);
        findings.any(|finding| finding.help.as_deref().is_some_and(is_it))
    }
}
