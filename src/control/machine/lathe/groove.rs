//! Grooves in pecks, and pecks of a drill (G1 to G11).

use super::way::Point;
use super::{EXACT, alarm, sense};
use crate::canon::{CycleSetting, Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// A groove: along which axis it pecks (0 for X, 1 for Z), and its lengths.
struct Groove {
    along: usize,
    a: Point,
    e: Point,
    peck: f64,
    step: f64,
    relief: f64,
    retract: f64,
    /// How far the words may have been rounded off: all moves by the first, each peck and each step by the second once more.
    off: (f64, f64),
}

/// Cuts a groove, column by column.
pub fn run(machine: &mut Machine, op: Op, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let (start, motion) = (machine.position, machine.motion);
    let groove = groove(machine, op, command, trace)?;
    trace.doubt("machine:lathe.groove.moves");
    let across = 1 - groove.along;
    let (first, last) = (groove.a[across], groove.e[across]);
    let way = sense(last - first);
    let mut column = 0u32;
    loop {
        let next = first + way * f64::from(column) * groove.step;
        let is_last = way == 0.0 || groove.step <= 0.0 || (next - last) * way >= -EXACT;
        let at = if column > 0 && is_last { last } else { next };
        trace.rounded = groove.off(column);
        if column > 0 {
            machine.go_one(across, at, true, trace);
        }
        pecks(machine, &groove, column, trace);
        trace.rounded = groove.off(column);
        if column > 0 && groove.relief > 0.0 {
            machine.go_one(across, at - way * groove.relief, true, trace);
        }
        machine.go_one(groove.along, groove.a[groove.along], true, trace);
        if is_last || trace.is_full() {
            break;
        }
        column += 1;
    }
    machine.go_one(across, first, true, trace);
    machine.settle(&start);
    machine.cycle_done(motion);
    Ok(())
}

/// G3: in pecks to the bottom.
fn pecks(machine: &mut Machine, groove: &Groove, column: u32, trace: &mut Trace) {
    let (top, bottom) = (groove.a[groove.along], groove.e[groove.along]);
    let way = sense(bottom - top);
    let mut count = 0u32;
    while !trace.is_full() {
        count += 1;
        let next = top + way * f64::from(count) * groove.peck;
        if groove.peck <= 0.0 || (next - bottom) * way >= -EXACT {
            break;
        }
        trace.rounded = groove.off(column + count);
        machine.go_one(groove.along, next, false, trace);
        machine.go_one(groove.along, next - way * groove.retract, true, trace);
    }
    trace.rounded = groove.off(column);
    machine.go_one(groove.along, bottom, false, trace);
}

impl Groove {
    /// How far a place may be off to which so many pecks and steps lead; X counts twice.
    fn off(&self, count: u32) -> f64 {
        self.off.0 + 2.0 * f64::from(count) * self.off.1
    }
}

fn groove(machine: &Machine, op: Op, command: &Command, trace: &mut Trace) -> Result<Groove, Stop> {
    let (unit, turning) = (machine.unit(), &machine.rules.turning);
    let length = |role| command.word(role).map(|value| value * unit);
    let along = usize::from(op == Op::FaceGroove);
    let roles = [Role::GrooveX, Role::GrooveZ];
    let (peck, step) = (length(roles[along]).unwrap_or(0.0), length(roles[1 - along]).unwrap_or(0.0));
    let names = |axis: usize| command.axes().any(|(named, _)| named == 2 * axis);
    if !names(along) {
        return Err(Stop::unnamed("a groove without the place of its bottom"));
    }
    let a = machine.tool_at();
    let e = machine.end_of_cycle(command, a);
    let relief = length(Role::GrooveRelief).unwrap_or(0.0);
    let steps = names(1 - along) && (e[1 - along] - a[1 - along]).abs() > EXACT;
    if peck < 0.0 || step < 0.0 {
        return Err(alarm("PS0320", "a peck or a step of a groove is negative"));
    }
    if relief < 0.0 && names(1 - along) {
        return Err(alarm("PS0318", "the relief of a groove is negative"));
    }
    if steps && step == 0.0 {
        return Err(alarm("PS0319", "a groove of several columns without the step between them"));
    }
    // Without the word of the other axis nothing is left at the bottom (G4).
    let relief = if names(1 - along) { relief.max(0.0) } else { 0.0 };
    let told = if op == Op::FaceGroove { machine.lathe.face_retract } else { machine.lathe.groove_retract };
    let several = peck > 0.0 && peck < (e[along] - a[along]).abs() - EXACT;
    let left = turning.left.contains(&CycleSetting::PeckRetract);
    let retract = match told.or(turning.peck_retract) {
        _ if left => 0.0,
        Some(retract) => retract,
        None if !several => 0.0,
        None if turning.two_blocks => {
            return Err(Stop::unnamed("pecks whose way back no block and no parameter says"));
        }
        None => {
            trace.doubt("machine:lathe.peck.retract");
            machine.peck_clearance
        }
    };
    let own = machine.most_off(command, |role| matches!(role, Role::GrooveX | Role::GrooveZ));
    let off = (machine.off_by() + 4.0 * machine.most_off(command, |_| true), own);
    Ok(Groove { along, a, e, peck, step, relief, retract, off })
}
