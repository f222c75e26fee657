//! Spindle and coolant at stops of which nobody knows what they end.
//!
//! Where the source's control is the one, the target's may do as it does; where the target's is, the conversion has to see
//! to it, but for an optional stop and a tool change, of which it says so.

use super::kinds::{is_move, is_pause, runs, setting};
use super::observe::Act;
use super::substitutes::stands_for;
use crate::canon::{Op, Running};
use crate::control::trace::{EventKind, Spindle, Told};
use crate::verify::sides::Side;

/// What runs on one side.
#[derive(Clone, Debug)]
pub struct Runs {
    spindle: EventKind,
    /// The same after a cycle, which may leave it turned round.
    last: EventKind,
    coolant: EventKind,
    /// For each of [`Running`], true if nobody knows whether it runs.
    open: [bool; 2],
    /// For each of [`Running`], true if a stop ended it last.
    by_stop: [bool; 2],
}

impl Runs {
    /// What runs before a program says anything.
    pub fn new() -> Self {
        let spindle = EventKind::Spindle { direction: Spindle::Stopped, speed: 0.0, surface: false };
        Self {
            last: spindle.clone(),
            spindle,
            coolant: EventKind::Coolant { state: Op::CoolantOff },
            open: [false; 2],
            by_stop: [false; 2],
        }
    }

    /// Takes an act.
    pub fn take(&mut self, act: &Act<'_>) {
        if matches!(*act.what, EventKind::Spindle { .. }) {
            self.last = (*act.what).clone();
        }
        match &*act.what {
            // What a cycle does to the spindle is said by no word.
            EventKind::Spindle { .. } if act.told == Told::Cycle => {}
            what @ EventKind::Spindle { .. } => self.spindle = what.clone(),
            what @ EventKind::Coolant { .. } => self.coolant = what.clone(),
            _ => {}
        }
        // Another act of the block may stand before what the block says of it.
        match runs(&act.what) {
            Some(running) => {
                self.open[running as usize] = act.event.open[running as usize];
                // A new speed of a spindle that stands lets it stand.
                let stands = matches!(*act.what, EventKind::Spindle { direction: Spindle::Stopped, .. });
                self.by_stop[running as usize] &= stands;
                self.by_stop[running as usize] |= act.told == Told::Implied;
            }
            None if is_pause(&act.what) => self.open = act.event.open,
            // What is started again is so before the tool moves.
            None if is_move(&act.what) => self.by_stop = [false; 2],
            None => {}
        }
    }

    /// True for a new speed of a spindle that goes on as it was.
    pub fn goes_on(&self, what: &EventKind) -> bool {
        let turns = |what: &EventKind| match what {
            EventKind::Spindle { direction, .. } => Some(*direction),
            _ => None,
        };
        // A cycle that stops the spindle lets it turn again as it was.
        turns(what).is_some() && [&self.last, &self.spindle].map(turns).contains(&turns(what))
    }

    fn of(&self, running: Running) -> &EventKind {
        match running {
            Running::Spindle => &self.spindle,
            Running::Coolant => &self.coolant,
        }
    }

    /// The coolant.
    pub fn coolant(&self) -> Op {
        match self.coolant {
            EventKind::Coolant { state } => state,
            _ => Op::CoolantOff,
        }
    }

    /// True if nobody knows whether the spindle turns.
    pub fn may_stand(&self) -> bool {
        self.open[Running::Spindle as usize]
    }

    /// True for what nobody knows to run before and after, and what is said of it is what was said before: a cycle came
    /// between.
    pub fn stays_open(&self, act: &Act<'_>) -> bool {
        let spindle = Running::Spindle as usize;
        self.open[spindle] && act.event.open[spindle] && *act.what == self.spindle
    }

    /// True if the next two acts of the other side are what it found running, and the end of that by a stop, where it is
    /// known to stand here: nobody saw it run.
    pub fn ended(&self, acts: &[Act<'_>]) -> bool {
        let [found, end, ..] = acts else { return false };
        let Some(running) = runs(&found.what) else { return false };
        let both = found.told == Told::Found && end.told == Told::Implied && runs(&end.what) == Some(running);
        let stands = match running {
            Running::Spindle => {
                matches!(self.spindle, EventKind::Spindle { direction: Spindle::Stopped, .. })
            }
            Running::Coolant => self.coolant() == Op::CoolantOff,
        };
        both && stands && !self.open[running as usize]
    }

    /// True for a new speed alone of a spindle that may stand, if a stop comes before anything else does.
    pub fn is_idle_speed(&self, acts: &[Act<'_>]) -> bool {
        let spindle = Running::Spindle as usize;
        let Some((act, rest)) = acts.split_first() else { return false };
        let stops = rest.iter().find(|act| runs(&act.what).is_none()).is_some_and(|act| is_pause(&act.what));
        self.open[spindle] && act.event.open[spindle] && self.goes_on(&act.what) && stops
    }

    /// True if the next act lets go of a spindle that is held at an angle, before a stop or the end: it stands either way,
    /// and before the tool moves again the program says of the spindle what it does.
    pub fn lets_go(&self, acts: &[Act<'_>]) -> bool {
        let is_held = matches!(self.spindle, EventKind::Spindle { direction: Spindle::Oriented, .. });
        let stops =
            |act: &Act<'_>| matches!(*act.what, EventKind::Spindle { direction: Spindle::Stopped, .. });
        let Some((act, rest)) = acts.split_first() else { return false };
        let before = rest.iter().take_while(|act| setting(&act.what).is_some() || is_pause(&act.what));
        let pauses = before.clone().any(|act| is_pause(&act.what));
        let says = before.clone().any(|act| runs(&act.what) == Some(Running::Spindle));
        let all = before.count() == rest.len();
        is_held && stops(act) && pauses && (says || all)
    }

    /// True for what lets go of a spindle that is held before a stop, of which nobody knows whether it does that by itself
    /// on the other side.
    pub fn may_be_let_go(&self, acts: &[Act<'_>], others: &[Act<'_>]) -> bool {
        let is_held = matches!(self.spindle, EventKind::Spindle { direction: Spindle::Oriented, .. });
        let stops = acts
            .first()
            .is_some_and(|act| matches!(*act.what, EventKind::Spindle { direction: Spindle::Stopped, .. }));
        let next = others.iter().find(|other| is_pause(&other.what));
        let open = next.is_some_and(|next| next.event.open[Running::Spindle as usize]);
        is_held && stops && open
    }

    /// True if a change says what is known to run on the other side already, and may have run here; not if the other side
    /// changes it next, which comes before what is said here.
    pub fn is_told(&self, other: &Self, act: &Act<'_>, others: &[Act<'_>]) -> bool {
        let Some(running) = runs(&act.what) else { return false };
        let next = others.first().filter(|next| runs(&next.what) == Some(running));
        if other.by_stop[running as usize] && next.is_some_and(|next| next.told != Told::Implied) {
            return false;
        }
        let there = match running {
            Running::Spindle => [&other.spindle, &other.last],
            Running::Coolant => [&other.coolant; 2],
        };
        there.contains(&&*act.what) && self.open[running as usize] && !other.open[running as usize]
    }
}

/// True for the next act of a side, and what comes after it on both, if the target's stop ended what goes on at the source's:
/// the end there, what the target starts again, and what the source ends later. `target` may have another code for it.
pub fn ends_earlier(
    runs: &[Runs; 2],
    side: usize,
    [acts, others]: [&[Act<'_>]; 2],
    target: &Side<'_>,
) -> bool {
    let Some((act, rest)) = acts.split_first() else { return false };
    match side {
        0 => ended_before(&runs[1], act, others),
        _ => {
            ends_cycles(&runs[1], act)
                || starts_again(runs, act, target)
                || ended_meanwhile(&runs[0], act, [rest, others], target)
        }
    }
}

/// True if the target starts again what its stop ended, and what ran on the source before the stop, or before one of which
/// nobody knows what it ended there; `side` is the target, which may have another code for it.
fn starts_again([source, target]: &[Runs; 2], act: &Act<'_>, side: &Side<'_>) -> bool {
    let Some(running) = runs(&act.what) else { return false };
    let open = |side: &Runs| side.open[running as usize];
    is_same(source.of(running), &act.what, side) && target.by_stop[running as usize] && !open(target)
}

/// True for what a stop of the target alone ends, if no move shows it: before the tool moves the target starts it again as it goes on
/// on the source, or the source ends it too, or both say the same of it.
fn ended_meanwhile(source: &Runs, act: &Act<'_>, [rest, others]: [&[Act<'_>]; 2], side: &Side<'_>) -> bool {
    let Some(running) = runs(&act.what).filter(|_| act.told == Told::Implied) else { return false };
    let next = |acts: &[Act<'_>]| {
        let dwells = |act: &Act<'_>| matches!(*act.what, EventKind::Dwell { .. });
        let mut stays = acts.iter().take_while(|act| !is_move(&act.what) && !dwells(act));
        stays.find(|act| runs(&act.what) == Some(running)).map(|act| (*act.what).clone())
    };
    let (here, there) = (next(others), next(rest));
    let again = |ran: &EventKind| there.as_ref().is_some_and(|again| is_same(ran, again, side));
    again(source.of(running)) || here.is_some_and(|here| here == *act.what || again(&here))
}

/// True for a stop that ends what a cycle alone may have left turning: by the program it stood.
fn ends_cycles(target: &Runs, act: &Act<'_>) -> bool {
    act.told == Told::Implied && target.spindle == *act.what && target.last != target.spindle
}

/// True for an end on the source of what the target's stop ended before, unless the target starts it again next.
fn ended_before(target: &Runs, act: &Act<'_>, others: &[Act<'_>]) -> bool {
    runs(&act.what).is_some_and(|running| {
        let at = running as usize;
        let again = others.first().is_some_and(|other| runs(&other.what) == Some(running));
        !again && target.by_stop[at] && !target.open[at] && target.of(running) == &*act.what
    })
}

fn is_same(ran: &EventKind, what: &EventKind, side: &Side<'_>) -> bool {
    ran == what || stands_for(side, ran, what).is_some()
}

/// True for the same new speed on both sides, if nobody knows whether one of the spindles turns, and the other stands
/// or is known to turn.
pub fn may_turn(source: &Act<'_>, target: &Act<'_>) -> bool {
    use EventKind::Spindle;
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

/// True if cycles leave the spindle as they found it on both sides, on one of which it stands.
pub fn ends_cycle(source: &Act<'_>, target: &Act<'_>) -> bool {
    let stands = |act: &Act<'_>| matches!(*act.what, EventKind::Spindle { direction: Spindle::Stopped, .. });
    let both = [source, target];
    both.iter().all(|act| act.told == Told::Cycle) && both.into_iter().any(stands)
}

/// True if a stop changes something that the next stop of the other side may change too, as nobody knows; `target` for
/// an act of the target.
pub fn may_do_so(act: &Act<'_>, others: &[Act<'_>], target: bool) -> bool {
    let Some(running) = runs(&act.what).filter(|_| act.told == Told::Implied) else { return false };
    let next = others.iter().find(|other| is_pause(&other.what));
    next.is_some_and(|next| {
        let excused = target || matches!(*next.what, EventKind::OptionalStop | EventKind::ToolChange { .. });
        excused && next.event.open[running as usize]
    })
}
