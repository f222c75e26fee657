//! Threads: single ones (M2 to M5), and those of many passes (P1 to P11).

use super::settings::Turning;
use super::way::Point;
use super::{EXACT, alarm, sense};
use crate::canon::{Op, Role};
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
    super::time::thread(machine, &from, turns, trace);
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
        let leads = self.rules.turning.run_out.filter(|_| self.lathe.thread.digits.is_none());
        match self.rules.turning.two_blocks {
            true => leads.map(|leads| (leads * lead, 45.0)),
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
        turning.run_out.map(|leads| (leads * lead, turning.run_out_angle.unwrap_or(45.0)))
    }
}

/// A thread of many passes, lengths in millimetres, depths as radii.
struct Screw {
    height: f64,
    first: f64,
    least: f64,
    allowance: f64,
    finishes: u32,
    /// Of the flanks, degrees.
    angle: f64,
    taper: f64,
    /// True where each pass is deeper by the same.
    even: bool,
    /// Where the passes take both flanks in turn: whether the first one takes the leading one.
    both: Option<bool>,
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
    let lead = machine.feed;
    let chamfer = match form {
        true => {
            let [_, leads, _] = form_of(machine)?;
            Some((leads * lead, 45.0))
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

/// The depths of all passes (P5, P6, P11).
fn depths(screw: &Screw) -> Result<Vec<f64>, Stop> {
    let last = screw.height - screw.allowance;
    if last <= EXACT {
        return Err(for_all("PS0316", "the allowance of the thread is as large as its height"));
    }
    let mut out = Vec::new();
    let mut depth = 0.0;
    while depth < last - EXACT {
        if out.len() > MOST {
            return Err(Stop::unnamed("a thread of more passes than the emulated lathe makes"));
        }
        let count = (out.len() + 1) as f64;
        let next = if screw.even { screw.first * count } else { screw.first * count.sqrt() };
        let least = if screw.even || out.is_empty() { 0.0 } else { depth + screw.least };
        depth = next.max(least).min(last);
        if depth >= last - EXACT {
            depth = last;
        }
        out.push(depth);
    }
    out.extend((0..screw.finishes).map(|_| screw.height));
    Ok(out)
}

/// An alarm that the target must have too: it may make the passes by itself.
fn for_all(number: &str, text: &str) -> Stop {
    Stop { for_all: true, ..alarm(number, text) }
}

/// More passes than any thread has.
const MOST: usize = 10_000;

/// P1: no finishing passes are one.
fn one_at_least(finishes: f64, trace: &mut Trace) -> f64 {
    if finishes == 0.0 {
        trace.doubt("machine:lathe.thread.finishes");
    }
    if finishes == 0.0 { 1.0 } else { finishes }
}

/// P1, P3.
fn by_two_blocks(machine: &Machine, command: &Command, trace: &mut Trace) -> Result<Screw, Stop> {
    let (unit, form, turning) = (machine.unit(), machine.lathe.thread, &machine.rules.turning);
    let length = |role| command.word(role).map_or(0.0, |value| value * unit);
    let [finishes, _, angle] = form_of(machine)?;
    let finishes = one_at_least(finishes, trace);
    let least = form.least.or(turning.thread_least).ok_or_else(|| unset("least depth"))?;
    let allowance =
        form.allowance.or(turning.thread_allowance).ok_or_else(|| unset("finishing allowance"))?;
    let (height, first) = (length(Role::ThreadHeight), length(Role::ThreadFirst));
    check_values(turning, angle, (height, first, least), finishes)?;
    let taper = length(Role::Taper);
    let finishes = finishes as u32;
    Ok(Screw { height, first, least, allowance, finishes, angle, taper, even: false, both: None })
}

/// Finishing passes, run-out in leads and angle: the six digits of the first block, else parameters.
fn form_of(machine: &Machine) -> Result<[f64; 3], Stop> {
    let turning = &machine.rules.turning;
    match machine.lathe.thread.digits {
        Some(digits) => {
            Ok([(digits / 10_000.0).floor(), (digits / 100.0).floor() % 100.0 / 10.0, digits % 100.0])
        }
        None => {
            let finishes = turning.thread_finishes.ok_or_else(|| unset("number of finishing passes"))?;
            let leads = turning.run_out.ok_or_else(|| unset("run-out"))?;
            Ok([finishes, leads, turning.thread_angle.ok_or_else(|| unset("angle"))?])
        }
    }
}

fn unset(what: &str) -> Stop {
    Stop::unnamed(format!("a thread whose {what} no block and no parameter says"))
}

/// P2, P3, P6.
fn by_one_block(machine: &Machine, command: &Command, trace: &mut Trace) -> Result<Screw, Stop> {
    let (unit, turning) = (machine.unit(), &machine.rules.turning);
    let length = |role| command.word(role).map_or(0.0, |value| value * unit);
    let way = command.word(Role::ThreadInfeed);
    if way.is_none() && !turning.two_blocks {
        // A P of another code may be in force (S10).
        trace.doubt("machine:lathe.thread.infeed");
    }
    let way = way.unwrap_or(1.0);
    let both = match way {
        1.0 | 3.0 => None,
        2.0 | 4.0 => Some(machine.rules.leading_first.ask(trace).ok_or_else(|| {
            Stop::unnamed(format!("a thread cut by P{way}: in which order the flanks are cut is not known"))
        })?),
        _ => return Err(Stop::unnamed(format!("a thread cut by P{way}: there are four ways"))),
    };
    let angle = command.word(Role::ThreadAngle).unwrap_or(0.0);
    let (height, first) = (length(Role::ThreadHeight), length(Role::ThreadFirst));
    let (least, allowance, finishes) = match turning.two_blocks {
        true => by_parameters(turning, angle, (height, first), trace)?,
        false => by_settings(turning, angle, (height, first), trace)?,
    };
    Ok(Screw {
        height,
        first,
        least,
        allowance,
        finishes,
        angle,
        taper: length(Role::Taper),
        even: way > 2.0,
        both,
    })
}

/// The alarms at values that no thread can have (P1, P3).
fn check_values(
    turning: &Turning,
    angle: f64,
    (height, first, least): (f64, f64, f64),
    finishes: f64,
) -> Result<(), Stop> {
    if turning.thread_angles.as_ref().is_some_and(|angles| !angles.contains(&angle)) {
        return Err(alarm("PS0315", "an angle that no thread of this control has"));
    }
    if height <= 0.0 || first <= 0.0 {
        return Err(for_all("PS0317", "a thread without its height or its first depth"));
    }
    if least > height {
        return Err(alarm("PS0316", "the least depth of the thread is over its height"));
    }
    if !(1.0..100.0).contains(&finishes) {
        return Err(Stop::unnamed("a thread without a finishing pass"));
    }
    Ok(())
}

/// Least depth, allowance and finishing passes that parameters say where no block can.
fn by_parameters(
    turning: &Turning,
    angle: f64,
    (height, first): (f64, f64),
    trace: &mut Trace,
) -> Result<(f64, f64, u32), Stop> {
    let least = turning.thread_least.ok_or_else(|| unset("least depth"))?;
    let allowance = turning.thread_allowance.ok_or_else(|| unset("finishing allowance"))?;
    let finishes = turning.thread_finishes.ok_or_else(|| unset("number of finishing passes"))?;
    let finishes = one_at_least(finishes, trace);
    check_values(turning, angle, (height, first, least), finishes)?;
    Ok((least, allowance, finishes as u32))
}

/// The same from settings, which are 0 where nobody gives them.
fn by_settings(
    turning: &Turning,
    angle: f64,
    (height, first): (f64, f64),
    trace: &mut Trace,
) -> Result<(f64, f64, u32), Stop> {
    if !(0.0..=120.0).contains(&angle) {
        return Err(Stop::unnamed("the angle of the thread is not from 0 to 120 degrees"));
    }
    if height <= 0.0 || first <= 0.0 {
        return Err(Stop::for_all("a thread without its height or its first depth"));
    }
    if turning.thread_allowance.is_none() || turning.thread_least.is_none() {
        trace.doubt("machine:lathe.thread.settings");
    }
    let allowance = turning.thread_allowance.unwrap_or(0.0);
    Ok((turning.thread_least.unwrap_or(0.0), allowance, u32::from(allowance > 0.0)))
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

#[cfg(test)]
mod tests {
    use super::{Screw, depths};

    fn screw(first: f64, height: f64, allowance: f64, least: f64) -> Screw {
        Screw {
            height,
            first,
            least,
            allowance,
            finishes: 2,
            angle: 60.0,
            taper: 0.0,
            even: false,
            both: None,
        }
    }

    #[test]
    fn each_pass_takes_as_much_as_the_first() {
        // .4 times the root of 1, 2, 3, ... until 1.45; the step from .8 to .894 is under the least one of .1.
        let found = depths(&screw(0.4, 1.5, 0.05, 0.1)).unwrap();
        let by_root = [0.4, 0.4 * 2f64.sqrt(), 0.4 * 3f64.sqrt(), 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.45];
        assert_eq!(found.len(), by_root.len() + 2);
        assert!(found.iter().zip(by_root).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        assert_eq!(found[by_root.len()..], [1.5, 1.5]);
    }

    #[test]
    fn one_deep_pass_and_an_allowance_too_large() {
        assert_eq!(depths(&screw(2.0, 1.5, 0.0, 0.0)).unwrap(), [1.5, 1.5, 1.5]);
        assert_eq!(depths(&screw(0.4, 1.0, 1.0, 0.0)).unwrap_err().number, "PS0316");
    }
}
