//! What a thread of many passes is told, and the depths of its passes (P1 to P6, P11).

use super::settings::Turning;
use super::{EXACT, alarm};
use crate::canon::{CycleSetting, Role};
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// A thread of many passes, lengths in millimetres, depths as radii.
pub(super) struct Screw {
    pub height: f64,
    pub first: f64,
    pub least: f64,
    pub allowance: f64,
    pub finishes: u32,
    /// Of the flanks, degrees.
    pub angle: f64,
    pub taper: f64,
    /// True where each pass is deeper by the same.
    pub even: bool,
    /// Where the passes take both flanks in turn: whether the first one takes the leading one.
    pub both: Option<bool>,
}

impl Screw {
    /// The thread with what is left to the machine: the same on both sides, so that all else is compared. What is wrong with the thread itself is an alarm
    /// before that.
    pub fn left(self, turning: &Turning) -> Result<Self, Stop> {
        let left = |what: CycleSetting| turning.left.contains(&what);
        if left(CycleSetting::ThreadAllowance) && self.height - self.allowance <= EXACT {
            return Err(no_pass());
        }
        let by_settings = !turning.two_blocks;
        let finishes = match () {
            () if left(CycleSetting::ThreadFinishes) => 1,
            // One pass takes off what is left there, and here it is something.
            () if left(CycleSetting::ThreadAllowance) && by_settings => 1,
            () => self.finishes,
        };
        let part = |what, of: f64, own: f64| if left(what) { self.height / of } else { own };
        let allowance = part(CycleSetting::ThreadAllowance, 16.0, self.allowance);
        let least = part(CycleSetting::ThreadLeast, 32.0, self.least);
        Ok(Self { allowance, least, finishes, ..self })
    }
}

/// The depths of all passes (P5, P6, P11).
pub(super) fn depths(screw: &Screw) -> Result<Vec<f64>, Stop> {
    let last = screw.height - screw.allowance;
    if last <= EXACT {
        return Err(no_pass());
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

/// P11.
fn no_pass() -> Stop {
    for_all("PS0316", "the allowance of the thread is as large as its height")
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
pub(super) fn by_two_blocks(machine: &Machine, command: &Command, trace: &mut Trace) -> Result<Screw, Stop> {
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
pub(super) fn form_of(machine: &Machine) -> Result<[f64; 3], Stop> {
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

pub(super) fn unset(what: &str) -> Stop {
    Stop::unnamed(format!("a thread whose {what} no block and no parameter says"))
}

/// P2, P3, P6.
pub(super) fn by_one_block(machine: &Machine, command: &Command, trace: &mut Trace) -> Result<Screw, Stop> {
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
