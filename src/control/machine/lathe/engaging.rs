//! What engages the C axis of a lathe, and what lets it go (Q4).

use super::Machine;
use crate::canon::Act;
use crate::control::trace::{EventKind, Trace};
use std::collections::BTreeMap;

/// The place of C in the list of the axes.
pub(super) const C: usize = 5;

/// A return to the reference position: where that engages C, it does what the code of other machines does.
pub fn by_return(machine: &mut Machine, named: &[usize], trace: &mut Trace) {
    if machine.rules.turning.c_by_return && named.contains(&C) {
        machine.lathe.c_engaged = true;
        trace.push(EventKind::Act { name: Act::C_AXIS[0].into(), words: BTreeMap::new(), surface: false });
    }
}

/// A builder's code. False where it lets go of an axis that nothing has engaged, which does nothing.
pub fn by_code(machine: &mut Machine, act: Act) -> bool {
    let name = act.name();
    let was = machine.lathe.c_engaged;
    if name == Act::C_AXIS[0] {
        machine.lathe.c_engaged = true;
    } else if name == Act::C_AXIS[1] {
        machine.lathe.c_engaged = false;
        return was;
    }
    true
}

/// The spindle starts: where a return engages C, this lets it go.
pub fn by_start(machine: &mut Machine, trace: &mut Trace) {
    if machine.rules.turning.c_by_return && std::mem::take(&mut machine.lathe.c_engaged) {
        trace.push(EventKind::Act { name: Act::C_AXIS[1].into(), words: BTreeMap::new(), surface: false });
    }
}
