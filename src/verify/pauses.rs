//! Spindle and coolant at stops of which nobody knows what they end.
//!
//! Where the source's control is the one, the target's may do as it does; where the target's is, the conversion has to see
//! to it, but for an optional stop and a tool change, of which it says so.

use super::observe::Act;
use crate::canon::Op;
use crate::control::trace::{Happening, Spindle, Told};

/// What runs on one side.
#[derive(Clone, Debug)]
pub struct Runs {
    spindle: Happening,
    coolant: Happening,
    /// True once it passed a stop of which nobody knows what it ends.
    open: bool,
}

impl Runs {
    /// What runs before a program says anything.
    pub fn new() -> Self {
        let spindle = Happening::Spindle { direction: Spindle::Stopped, speed: 0.0, surface: false };
        Self { spindle, coolant: Happening::Coolant { state: Op::CoolantOff }, open: false }
    }

    /// Takes an act.
    pub fn take(&mut self, act: &Act<'_>) {
        match &*act.what {
            what @ Happening::Spindle { .. } => self.spindle = what.clone(),
            what @ Happening::Coolant { .. } => self.coolant = what.clone(),
            _ => {}
        }
        self.open |= act.told == Told::Open;
    }

    /// True once it passed a stop of which nobody knows what it ends.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// True for a new speed of a spindle that goes on as it was.
    pub fn goes_on(&self, what: &Happening) -> bool {
        let turns = |what: &Happening| match what {
            Happening::Spindle { direction, .. } => Some(*direction),
            _ => None,
        };
        turns(what).is_some() && turns(what) == turns(&self.spindle)
    }

    /// True where two spindles part in nothing but whether they turn.
    pub fn only_turns(a: &Happening, b: &Happening) -> bool {
        use Happening::Spindle;
        match (a, b) {
            (
                Spindle { direction, speed, surface },
                Spindle { direction: other, speed: there, surface: surface_there },
            ) => direction != other && speed == there && surface == surface_there,
            _ => false,
        }
    }

    /// The coolant.
    pub fn coolant(&self) -> Op {
        match self.coolant {
            Happening::Coolant { state } => state,
            _ => Op::CoolantOff,
        }
    }

    /// True where a change says what runs on the other side already, and may have run here.
    pub fn is_told(&self, other: &Self, act: &Act<'_>) -> bool {
        self.open && (*act.what == other.spindle || *act.what == other.coolant)
    }
}

/// True where a stop changes something that the next stop of the other side may change too, as nobody knows; `target`
/// for an act of the target.
pub fn may_do_so(act: &Act<'_>, others: &[Act<'_>], target: bool) -> bool {
    let stops = |act: &&Act<'_>| {
        use Happening::{Asked, End, Message, OptionalStop, Stop, ToolChange};
        matches!(
            *act.what,
            Asked { .. } | End { .. } | Message { .. } | OptionalStop | Stop | ToolChange { .. }
        )
    };
    let next = others.iter().find(stops).filter(|next| next.told == Told::Open);
    let excused = |next: &Act<'_>| {
        target || matches!(*next.what, Happening::OptionalStop | Happening::ToolChange { .. })
    };
    act.told == Told::Implied && next.is_some_and(excused)
}
