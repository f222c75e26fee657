//! Which programs may run in another unit than the one that a control is set to.

use crate::canon::Op;
use crate::dialect::{Control, Units};
use crate::ir::Module;
use crate::legalize::moves::increments::units_named;
use std::collections::BTreeSet;

/// The unit that a control is not set to, and its own, as people name them; with the code that names the former.
#[derive(Clone, Copy, Debug)]
pub(in crate::legalize) struct Turned {
    /// The code that names the other unit.
    pub op: Op,
    /// The other unit.
    pub program: &'static str,
    /// That of the profile.
    pub profile: &'static str,
}

impl Turned {
    /// Those of a control whose profile gives a unit.
    pub fn of(control: &Control) -> Option<Self> {
        let (op, program, profile) = match control.units()? {
            Units::Metric => (Op::Inch, "inches", "millimetres"),
            Units::Inch => (Op::Metric, "millimetres", "inches"),
        };
        Some(Self { op, program, profile })
    }

    /// The unit of the profile.
    pub fn own(self) -> Op {
        if self.op == Op::Inch { Op::Metric } else { Op::Inch }
    }
}

/// By program: the units that it names, or one that it comes to by calls; `calls` are callers with what each may run.
pub(in crate::legalize) fn named_below(module: &Module, calls: &[(usize, usize)]) -> Vec<BTreeSet<Op>> {
    let op = |units| if units == Units::Inch { Op::Inch } else { Op::Metric };
    let mut named: Vec<BTreeSet<Op>> =
        module.programs.iter().map(|program| units_named(program).map(op).collect()).collect();
    spread(calls.iter().map(|(caller, callee)| (*callee, *caller)), &mut named);
    named
}

/// By program: true where it may run in the unit that a control is not set to, as it or another program of the same run names that.
pub(in crate::legalize) fn may_be_other(
    module: &Module,
    calls: &[(usize, usize)],
    control: &Control,
) -> Vec<bool> {
    let Some(turned) = Turned::of(control) else { return vec![false; module.programs.len()] };
    let mut named = named_below(module, calls);
    spread(calls.iter().copied(), &mut named);
    named.iter().map(|named| named.contains(&turned.op)).collect()
}

/// Carries what is named along each pair, until nothing changes.
fn spread(pairs: impl Iterator<Item = (usize, usize)> + Clone, named: &mut [BTreeSet<Op>]) {
    let mut goes_on = true;
    while goes_on {
        goes_on = false;
        for (from, to) in pairs.clone() {
            let given = named.get(from).cloned().unwrap_or_default();
            if let Some(own) = named.get_mut(to)
                && !given.is_subset(own)
            {
                own.extend(given);
                goes_on = true;
            }
        }
    }
}
