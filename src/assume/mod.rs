//! What a conversion supposes of the runs of a program, as values.
//!
//! Whoever converts a construct in a way that holds for some runs only makes an [`Assumption`]; the finding that a
//! person reads is drawn from it, and the verifier tries it on every run of both sides. So a predicate says exactly for
//! which runs the conversion holds: a run that keeps it and still differs is a fault of the conversion.

mod domain;
mod numbers;

pub use domain::Domain;
pub use numbers::{Numbers, Subscripts};

use crate::canon::{CycleSetting, Func, Op};
use crate::text::Span;
use std::sync::Arc;

/// Something that a conversion supposes of a program.
#[derive(Clone, Debug, PartialEq)]
pub struct Assumption {
    /// Where, in the file of the source.
    pub place: Span,
    /// What a person reads of it.
    pub text: Arc<str>,
    /// What must hold.
    pub predicate: Predicate,
}

/// What must hold of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Predicate {
    /// A fact that no source confirms is as the tables have it, named as machine profiles confirm it.
    Fact(Arc<str>),
    /// The numbers of variables that are computed stay in those that the conversion holds for.
    Subscripts(Subscripts),
    /// So do the arguments of a function.
    Arguments {
        /// The function.
        function: Func,
        /// The blocks that call it.
        places: Vec<Span>,
        /// The arguments that the conversion holds for.
        domain: Domain,
    },
    /// Calls nest no deeper than the target's levels.
    Nesting {
        /// The limit, as the tables name it: `call.all`.
        limit: Arc<str>,
        /// Whether a call counts that shares its caller's locals, and one that has its own.
        counts: [bool; 2],
        /// The levels.
        most: u32,
    },
    /// The computed codes of a letter are among those that mean the same on both controls.
    Codes {
        /// The letter.
        letter: char,
        /// The blocks that compute one.
        places: Vec<Span>,
        /// Those codes.
        same: Vec<f64>,
    },
    /// The numbers that the program gives its alarms are no larger than this.
    Alarms(f64),
    /// Both machines are set to one unit when the program starts.
    Unit,
    /// The target is set to the unit that this code names, and not to that of its profile, while the program runs.
    SetTo(Op),
    /// These modes are in force when the program starts, as the profile of the source says.
    Start(Vec<Op>),
    /// Nothing calls the program: it is run by itself.
    Main,
    /// This tool is in the spindle when the program starts.
    Loaded(u32),
    /// This variable of the source holds this number when the program starts: its callers have set it.
    Holds(Arc<str>, f64),
    /// A setting of the target has this value, in the unit of its control.
    Setting(Arc<str>, f64),
    /// The same once it is set to another unit than its profile gives ([`Self::SetTo`]), in that unit.
    TurnedSetting(Arc<str>, f64),
    /// Cycles that are kept take this from a setting of the target, whatever it says: a person accepts that.
    OfMachine(CycleSetting),
    /// The speeds that these blocks compute are whole numbers above 0.
    WholeSpeeds(Vec<Span>),
    /// The arcs of these blocks pass at most half a turn.
    ShortArcs(Vec<Span>),
    /// The arcs of these blocks end as far from their centre as they begin.
    ArcEnds(Vec<Span>),
    /// The pecks that these blocks tell a drilling cycle are there, and not 0.
    Pecks(Vec<Span>),
    /// The drilling cycles of these blocks begin at their retract plane or beyond it, along X (0) or Z (2).
    Levels(Vec<Span>, usize),
    /// The tools that these blocks change to are whole numbers, and not 0.
    Tools(Vec<Span>),
    /// The spindle stands at the stops of these blocks.
    Stands(Vec<Span>),
    /// Where these blocks name a tool length, their word of its axis has a value.
    LengthAxis(Vec<Span>),
    /// The target has no such operation: it does something near instead, or nothing, and a person accepts that.
    Substitute(Op),
    /// Something of the machine or the shop that no run shows: how a signal is wired, what an operator does.
    Unseen,
}

impl Predicate {
    /// The blocks that it is about; none if it is about the whole run.
    pub fn places_mut(&mut self) -> Option<&mut Vec<Span>> {
        match self {
            Self::Subscripts(Subscripts { places, .. })
            | Self::Arguments { places, .. }
            | Self::Codes { places, .. }
            | Self::WholeSpeeds(places)
            | Self::ShortArcs(places)
            | Self::ArcEnds(places)
            | Self::Pecks(places)
            | Self::Levels(places, _)
            | Self::Tools(places)
            | Self::Stands(places)
            | Self::LengthAxis(places) => Some(places),
            _ => None,
        }
    }

    /// The name of its kind, as certificates have it.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Fact(_) => "fact",
            Self::Subscripts(_) => "subscripts",
            Self::Arguments { .. } => "arguments",
            Self::Nesting { .. } => "nesting",
            Self::Codes { .. } => "codes",
            Self::Alarms(_) => "alarms",
            Self::Unit => "unit",
            Self::SetTo(_) => "unit_set",
            Self::Start(_) => "start",
            Self::Main => "main",
            Self::Loaded(_) => "tool",
            Self::Holds(..) => "variable",
            Self::Setting(..) | Self::TurnedSetting(..) => "setting",
            Self::OfMachine(_) => "cycle_setting",
            Self::WholeSpeeds(_) => "speeds",
            Self::ShortArcs(_) => "arcs",
            Self::ArcEnds(_) => "arc_ends",
            Self::Pecks(_) => "pecks",
            Self::Levels(..) => "levels",
            Self::Tools(_) => "tools",
            Self::Stands(_) => "spindle_stands",
            Self::LengthAxis(_) => "length_axis",
            Self::Substitute(_) => "substitute",
            Self::Unseen => "unseen",
        }
    }

    /// The fact that the tables name, where it is about one.
    pub fn fact(&self) -> Option<Arc<str>> {
        match self {
            Self::Fact(fact) => Some(fact.clone()),
            Self::Nesting { limit, .. } => Some(format!("limit:{limit}").into()),
            _ => None,
        }
    }

    /// True where runs show whether it holds. Runs take facts, the unit and the tool to be as it says.
    pub fn is_seen(&self) -> bool {
        let set = matches!(self, Self::Fact(_) | Self::Unit | Self::Start(_) | Self::Main | Self::Loaded(_))
            || matches!(self, Self::Setting(..) | Self::TurnedSetting(..) | Self::Holds(..))
            || matches!(self, Self::SetTo(_));
        !set && !self.is_accepted()
    }

    /// True for a number that the program computes, so that a run may be more or less far from it.
    pub fn is_computed(&self) -> bool {
        matches!(self, Self::Subscripts(_) | Self::Codes { .. })
    }

    /// True for what no run can keep or break.
    pub fn is_accepted(&self) -> bool {
        matches!(self, Self::Substitute(_) | Self::Unseen | Self::OfMachine(_))
    }

    /// Numbers worth a try: the ends of what is assumed to be safe, its inside, and what lies just outside. Of the
    /// safe numbers of variables `held` are registers that hold something else.
    pub fn telling_numbers(&self, held: &[u32]) -> Vec<f64> {
        match self {
            Self::Subscripts(subscripts) => subscripts.telling_numbers(held),
            Self::Arguments { domain, .. } => domain.telling_numbers(),
            Self::Nesting { most, .. } => [1, 2].map(|by| f64::from(most.saturating_add(by))).into(),
            Self::Codes { same, .. } => same.clone(),
            Self::Alarms(most) => vec![*most, most + 1.0],
            Self::Fact(_)
            | Self::Unit
            | Self::SetTo(_)
            | Self::Start(_)
            | Self::Main
            | Self::Loaded(_)
            | Self::Holds(..)
            | Self::Setting(..)
            | Self::TurnedSetting(..)
            | Self::Pecks(_)
            | Self::Levels(..) => Vec::new(),
            Self::ShortArcs(_) | Self::ArcEnds(_) | Self::WholeSpeeds(_) | Self::Stands(_) => Vec::new(),
            Self::LengthAxis(_)
            | Self::Tools(_)
            | Self::Substitute(_)
            | Self::Unseen
            | Self::OfMachine(_) => Vec::new(),
        }
    }
}
