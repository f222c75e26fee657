//! Threads: single ones (M2 to M5), and those of many passes (P1 to P11).

use super::screw::{Screw, by_one_block, by_two_blocks, depths, form_of, unset};
use super::way::Point;
use super::{EXACT, alarm, sense};
use crate::canon::{CycleSetting, Op, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::{EventKind, Position, Trace};

/// The turns of a thread.
pub struct Lead {
    pub lead: f64,
    pub start: f64,
    pub change: f64,
    /// The length over which it runs out, and its angle.
    pub chamfer: Option<(f64, f64)>,
}

/// A thread from where the tool stands to the end that the block says.
pub fn single(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    if command.word(Role::CornerRadius).or(command.word(Role::CornerChamfer)).is_some() {
        return Err(alarm("PS0050", "a corner after a thread"));
    }
    let to = machine.target(command);
    let variable = machine.motion == Op::ThreadVariable;
    let growth = command.word(Role::LeadGrowth).map_or(0.0, |growth| growth * machine.unit());
    let lead = Lead {
        lead: machine.feed,
        start: command.word(Role::ThreadStart).unwrap_or(0.0),
        change: if variable { growth } else { 0.0 },
        chamfer: None,
    };
    thread_to(machine, to, &lead, trace)
}

fn thread_to(
    machine: &mut Machine,
    to: crate::control::scenario::Axes,
    cut: &Lead,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let from = machine.position;
    let (dx, dz) = ((to[0] - from[0]).abs() / 2.0, (to[2] - from[2]).abs());
    let way = dx.max(dz);
    if way <= EXACT {
        return Ok(());
    }
    if cut.lead <= 0.0 {
        return Err(Stop::unnamed("a thread without a lead"));
    }
    let turns = turns_of(way, cut).ok_or_else(|| alarm("PS0313", "the lead becomes negative"))?;
    machine.position = to;
    super::time::thread(machine, &from, turns);
    trace.push(EventKind::Thread {
        from: Position(from),
        to: Position(to),
        lead: cut.lead,
        start: cut.start,
        change: cut.change,
        chamfer: cut.chamfer.map(|(length, _)| length),
        chamfer_angle: cut.chamfer.filter(|(length, _)| *length > 0.0).map(|(_, angle)| angle),
    });
    Ok(())
}

/// How many turns a way takes: the lead grows with each, and the way of n turns is `n F + n² K / 2`.
fn turns_of(way: f64, cut: &Lead) -> Option<f64> {
    if cut.change == 0.0 {
        return Some(way / cut.lead);
    }
    let under = cut.lead * cut.lead + 2.0 * cut.change * way;
    (under > 0.0).then(|| (under.sqrt() - cut.lead) / cut.change)
}

impl Machine {
    /// A thread to a place, X as a radius.
    pub(super) fn thread_way(
        &mut self,
        x: Option<f64>,
        z: Option<f64>,
        cut: &Lead,
        trace: &mut Trace,
    ) -> Result<(), Stop> {
        let to = self.placed(x, z);
        thread_to(self, to, cut, trace)
    }

    /// The run-out of a single pass: with two blocks that of a parameter, if the profile gives it and no block changed it (P9).
    pub(super) fn single_chamfer(&self, lead: f64, trace: &mut Trace) -> Option<(f64, f64)> {
        if self.lathe.runs_straight {
            return Some((0.0, 0.0));
        }
        let leads = self.rules.turning.run_out.filter(|_| self.lathe.thread.digits.is_none());
        match self.rules.turning.two_blocks {
            true => leads.map(|leads| self.run_out_left((leads * lead, 45.0), lead)),
            false => self.set_chamfer(lead, trace),
        }
    }

    /// The run-out that the settings of the control say.
    fn set_chamfer(&self, lead: f64, trace: &mut Trace) -> Option<(f64, f64)> {
        if self.lathe.runs_straight {
            return Some((0.0, 0.0));
        }
        let turning = &self.rules.turning;
        if turning.run_out.is_none() {
            trace.doubt("machine:lathe.thread.runout");
        }
        let own = turning.run_out.map(|leads| (leads * lead, turning.run_out_angle.unwrap_or(45.0)));
        own.map(|own| self.run_out_left(own, lead))
    }

    /// A run-out as it counts: where it is left to the machine only whether there is one.
    fn run_out_left(&self, own: (f64, f64), lead: f64) -> (f64, f64) {
        let is_left = self.rules.turning.left.contains(&CycleSetting::ThreadRunOut);
        if is_left && own.0 > 0.0 { (lead, 45.0) } else { own }
    }
}

/// Cuts a thread in many passes.
pub fn many(machine: &mut Machine, command: &Command, trace: &mut Trace) -> Result<(), Stop> {
    let start = machine.position;
    let motion = machine.motion;
    let a = machine.tool_at();
    let e = machine.end_of_cycle(command, a);
    let turning = &machine.rules.turning;
    let (form, stands_in) = (turning.thread_form, turning.two_blocks && !turning.thread_form);
    let screw = match form {
        true => by_two_blocks(machine, command, trace)?,
        false => by_one_block(machine, command, trace)?,
    };
    let screw = screw.left(&machine.rules.turning)?;
    let lead = machine.feed;
    let chamfer = match form {
        true => {
            let [_, leads, _] = form_of(machine)?;
            let leads = if machine.lathe.runs_straight { 0.0 } else { leads };
            Some(machine.run_out_left((leads * lead, 45.0), lead))
        }
        false if stands_in && machine.rules.turning.run_out.is_none() => return Err(unset("run-out")),
        false => machine.set_chamfer(lead, trace),
    };
    let lead = Lead { lead, start: command.word(Role::ThreadStart).unwrap_or(0.0), change: 0.0, chamfer };
    trace.doubt("machine:lathe.thread.passes");
    let (before, off) = (machine.off_by(), machine.most_off(command, |_| true));
    for (at, depth) in depths(&screw)?.into_iter().enumerate() {
        // A depth may be the sum of as many first ones; X counts twice.
        trace.rounded = before + (4.0 + 2.0 * at as f64) * off;
        let far = screw.both.is_some_and(|leading| (at % 2 == 1) == leading);
        pass(machine, (a, e), &screw, (depth, far), &lead, trace)?;
        if trace.is_full() {
            break;
        }
    }
    machine.settle(&start);
    machine.cycle_done(motion);
    Ok(())
}

/// P6 to P8: a pass of a depth, along the far flank or the near one.
fn pass(
    machine: &mut Machine,
    (a, e): (Point, Point),
    screw: &Screw,
    (depth, far): (f64, bool),
    lead: &Lead,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let (sx, sz) = (sense(e[0] - a[0]), sense(e[1] - a[1]));
    let along = if far { 2.0 * screw.height - depth } else { depth };
    let z = a[1] + sz * along * (screw.angle / 2.0).to_radians().tan();
    let x = e[0] - sx * (screw.height - depth);
    let part = if (e[1] - a[1]).abs() <= EXACT { 0.0 } else { (e[1] - z) / (e[1] - a[1]) };
    machine.rapid_way(Some(x + screw.taper * part), Some(z), trace);
    machine.thread_way(Some(x), Some(e[1]), lead, trace)?;
    machine.rapid_way(Some(a[0]), None, trace);
    machine.rapid_way(None, Some(a[1]), trace);
    Ok(())
}

impl Machine {
    /// The end that the axis words of a cycle say, X as a radius; an axis without a word stays.
    pub(super) fn end_of_cycle(&self, command: &Command, a: Point) -> Point {
        let to = self.target(command);
        let place = |axis: usize, own: f64| {
            let named = command.axes().any(|(named, _)| named == axis);
            if named { (to[axis] - self.frame.shift(axis)) * self.real(axis) } else { own }
        };
        [place(0, a[0]), place(2, a[1])]
    }
}
