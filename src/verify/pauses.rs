//! Spindle and coolant at stops of which nobody knows what they end.
//!
//! Where the source's control is the one, the target's may do as it does; where the target's is, the conversion has to see
//! to it, but for an optional stop and a tool change, of which it says so.

use super::observe::{Act, is_pause, runs};
use crate::canon::{Op, Running};
use crate::control::trace::{Happening, Spindle, Told};

/// What runs on one side.
#[derive(Clone, Debug)]
pub struct Runs {
    spindle: Happening,
    coolant: Happening,
    /// For each of [`Running`], true if nobody knows whether it runs.
    open: [bool; 2],
}

impl Runs {
    /// What runs before a program says anything.
    pub fn new() -> Self {
        let spindle = Happening::Spindle { direction: Spindle::Stopped, speed: 0.0, surface: false };
        Self { spindle, coolant: Happening::Coolant { state: Op::CoolantOff }, open: [false; 2] }
    }

    /// Takes an act.
    pub fn take(&mut self, act: &Act<'_>) {
        match &*act.what {
            what @ Happening::Spindle { .. } => self.spindle = what.clone(),
            what @ Happening::Coolant { .. } => self.coolant = what.clone(),
            _ => {}
        }
        // Another act of the block may stand before what the block says of it.
        match runs(&act.what) {
            Some(running) => self.open[running as usize] = act.event.open[running as usize],
            None if is_pause(&act.what) => self.open = act.event.open,
            None => {}
        }
    }

    /// True for a new speed of a spindle that goes on as it was.
    pub fn goes_on(&self, what: &Happening) -> bool {
        let turns = |what: &Happening| match what {
            Happening::Spindle { direction, .. } => Some(*direction),
            _ => None,
        };
        turns(what).is_some() && turns(what) == turns(&self.spindle)
    }

    /// The coolant.
    pub fn coolant(&self) -> Op {
        match self.coolant {
            Happening::Coolant { state } => state,
            _ => Op::CoolantOff,
        }
    }

    /// True if a change says what is known to run on the other side already, and may have run here. A cycle that stops
    /// the spindle and lets it turn again does neither for one that stands.
    pub fn is_told(&self, other: &Self, act: &Act<'_>) -> bool {
        let (running, there) = match runs(&act.what) {
            Some(Running::Spindle) => (Running::Spindle, &other.spindle),
            Some(Running::Coolant) => (Running::Coolant, &other.coolant),
            None => return false,
        };
        let again = act.event.open[running as usize] && is_at_speed(&act.what, there);
        (*act.what == *there || again) && self.open[running as usize] && !other.open[running as usize]
    }
}

/// True for two spindles at one speed, whether they turn or stand.
fn is_at_speed(a: &Happening, b: &Happening) -> bool {
    use Happening::Spindle;
    match (a, b) {
        (Spindle { speed, surface, .. }, Spindle { speed: there, surface: other, .. }) => {
            speed == there && surface == other
        }
        _ => false,
    }
}

/// True for the same new speed on both sides, if nobody knows whether one of the spindles turns, and the other stands
/// or is known to turn.
pub fn may_turn(source: &Act<'_>, target: &Act<'_>) -> bool {
    use Happening::Spindle;
    let (
        Spindle { direction, speed, surface },
        Spindle { direction: other, speed: there, surface: surface_there },
    ) = (&*source.what, &*target.what)
    else {
        return false;
    };
    let open = [source, target].map(|act| act.event.open[Running::Spindle as usize]);
    let apart = direction != other || open[0] != open[1];
    open.contains(&true) && apart && speed == there && surface == surface_there
}

/// True if a stop changes something that the next stop of the other side may change too, as nobody knows; `target` for
/// an act of the target.
pub fn may_do_so(act: &Act<'_>, others: &[Act<'_>], target: bool) -> bool {
    let Some(running) = runs(&act.what).filter(|_| act.told == Told::Implied) else { return false };
    let next = others.iter().find(|other| is_pause(&other.what));
    next.is_some_and(|next| {
        let excused = target || matches!(*next.what, Happening::OptionalStop | Happening::ToolChange { .. });
        excused && next.event.open[running as usize]
    })
}
