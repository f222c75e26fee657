//! The modal state that the meaning of later blocks depends on.

use crate::ir::analysis::dataflow::Lattice;
use crate::syntax::{Block, ItemKind, SetOption, for_each_item};

/// How many values are told apart before the set counts as any.
const MOST: usize = 8;

/// The values that something may have at a place of the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Values<T> {
    list: Vec<T>,
    any: bool,
}

impl<T> Default for Values<T> {
    fn default() -> Self {
        Self::NONE
    }
}

impl<T> Values<T> {
    /// No value.
    pub const NONE: Self = Self { list: Vec::new(), any: false };
}

impl<T: Copy + Ord> Values<T> {
    /// Any value at all.
    pub fn any() -> Self {
        Self { list: Vec::new(), any: true }
    }

    /// This value only.
    pub fn one(value: T) -> Self {
        Self { list: vec![value], any: false }
    }

    /// Values of `self` or of `other`.
    pub fn join(&mut self, other: &Self) {
        self.any |= other.any;
        for value in &other.list {
            if let Err(at) = self.list.binary_search(value) {
                self.list.insert(at, *value);
            }
        }
        if self.any || self.list.len() > MOST {
            *self = Self::any();
        }
    }

    /// True where nothing is known.
    pub fn is_any(&self) -> bool {
        self.any
    }

    /// The values, in order; none if nothing is known.
    pub fn list(&self) -> &[T] {
        &self.list
    }
}

/// Places of rounding that SET never stated.
pub const DEFAULT_PLACES: u8 = u8::MAX;

/// Modal calls in force that are counted.
pub const MOST_MODAL: u8 = 4;

/// What the other programs of a file set.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    /// Places of rounding.
    pub places: Values<u8>,
    /// Whether angles are radians.
    pub radians: Values<bool>,
}

impl Sets {
    /// What nothing sets.
    pub const NONE: Self = Self { places: Values::NONE, radians: Values::NONE };

    /// What either sets.
    pub fn join(&mut self, other: &Self) {
        self.places.join(&other.places);
        self.radians.join(&other.radians);
    }

    /// Adds what a program sets.
    pub fn add(&mut self, blocks: &[Block]) {
        for block in blocks {
            for_each_item(&block.items, &mut |item| {
                let ItemKind::Set(options) = &item.kind else { return };
                if options.is_empty() {
                    self.places.join(&Values::one(DEFAULT_PLACES));
                    self.radians.join(&Values::one(false));
                }
                for option in options {
                    match option {
                        SetOption::Degrees | SetOption::Radians => {
                            self.radians.join(&Values::one(*option == SetOption::Radians));
                        }
                        SetOption::Round(places) => self.places.join(&Values::one(*places)),
                        SetOption::Debug | SetOption::Run => {}
                    }
                }
            });
        }
    }
}

/// What the program has set, on the ways that lead to a place of it.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct State {
    /// G codes of the interpolation, in thousandths: rapid, feed, arcs. Drilling
    /// cycles are a group of their own here.
    pub motion: Values<u32>,
    /// G codes of the drilling cycle, in thousandths; 0 for none.
    pub cycle: Values<u32>,
    /// True where a cycle was ended and no interpolation was given after that.
    pub after_cycle: bool,
    /// True where the interpolation is the one from before a cycle.
    pub resumed: bool,
    /// True where the motion mode may be the one that the program was entered with.
    pub motion_entry: bool,
    /// True where a program was called since the motion mode was set.
    pub motion_called: bool,
    /// Whether dimensions are incremental; none while only the caller knows.
    pub incremental: Values<bool>,
    /// Whether angles are radians.
    pub radians: Values<bool>,
    /// True where the angle unit may come from outside the program.
    pub radians_outside: bool,
    /// Places of rounding.
    pub places: Values<u8>,
    /// True where a program was called since they were set.
    pub places_called: bool,
    /// True where moves may still be to come when a statement runs.
    pub moved: bool,
    /// How many modal calls may be in force, up to [`MOST_MODAL`]; so many may be any number.
    pub modal: u8,
    /// True in a subroutine that a modal call may run.
    pub in_modal: bool,
    /// True where a modal call of another program may be in force.
    pub modal_program: bool,
    /// The constants that R0 to R9 may hold, as bits.
    pub r: [Values<u64>; 10],
}

/// States of `self` or of `other`.
impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.clone();
        self.motion.join(&other.motion);
        self.cycle.join(&other.cycle);
        self.after_cycle |= other.after_cycle;
        self.resumed |= other.resumed;
        self.motion_entry |= other.motion_entry;
        self.motion_called |= other.motion_called;
        self.incremental.join(&other.incremental);
        self.radians.join(&other.radians);
        self.radians_outside |= other.radians_outside;
        self.places.join(&other.places);
        self.places_called |= other.places_called;
        self.moved |= other.moved;
        self.modal = self.modal.max(other.modal);
        self.in_modal |= other.in_modal;
        self.modal_program |= other.modal_program;
        self.r.iter_mut().zip(&other.r).for_each(|(mine, theirs)| mine.join(theirs));
        *self != before
    }
}

impl State {
    /// At a program's first block.
    pub fn entry() -> Self {
        Self {
            motion_entry: true,
            cycle: Values::one(0),
            radians: Values::one(false),
            radians_outside: true,
            places: Values::one(DEFAULT_PLACES),
            moved: true,
            r: std::array::from_fn(|_| Values::any()),
            ..Self::default()
        }
    }

    /// Another program ran: it may have set any variable, or what `others` do. It leaves `motion`; where that is not
    /// known, and of the other modes, it is taken to leave them as they were.
    pub fn called(&mut self, others: &Sets, motion: Option<&Motion>) {
        match motion {
            // Its moves run the subroutine of a modal call, which sets what it likes.
            Some(motion) if self.modal == 0 && !self.modal_program => motion.give(self),
            _ => self.motion_called = true,
        }
        self.places_called = true;
        self.places.join(&others.places);
        self.radians.join(&others.radians);
        self.radians_outside = true;
        self.moved = true;
        self.r = std::array::from_fn(|_| Values::any());
    }

    /// The interpolation that a block sets, and the cycle (0 for its end).
    pub fn set_motion(&mut self, interpolation: Option<u32>, cycle: Option<u32>) {
        if let Some(code) = interpolation {
            self.motion = Values::one(code);
            self.cycle = Values::one(0);
            self.motion_entry = false;
            self.motion_called = false;
            self.after_cycle = false;
            self.resumed = false;
        }
        if let Some(code) = cycle {
            self.cycle = Values::one(code);
            self.after_cycle = code == 0;
            self.resumed = interpolation.is_none();
        }
    }
}

/// The motion modes that a program leaves to its caller.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The interpolation.
    codes: Values<u32>,
    /// True where the caller's may still be in force.
    callers: bool,
    /// True where another program may have set it, of which nothing is known.
    unknown: bool,
    cycle: Values<u32>,
    after_cycle: bool,
    resumed: bool,
}

impl Motion {
    /// Those of the state at its return.
    pub fn of(state: State) -> Self {
        Self {
            codes: state.motion,
            callers: state.motion_entry,
            unknown: state.motion_called,
            cycle: state.cycle,
            after_cycle: state.after_cycle,
            resumed: state.resumed,
        }
    }

    /// Lets the caller go on in it.
    pub fn give(&self, state: &mut State) {
        if self.callers {
            state.motion.join(&self.codes);
            // A cycle goes on if the program touches neither it nor the motion mode, which would end it.
            let sets_motion = self.codes.is_any() || !self.codes.list().is_empty();
            if sets_motion || self.after_cycle || self.cycle.is_any() || self.cycle.list() != [0] {
                state.cycle.join(&self.cycle);
            }
            state.motion_called |= self.unknown;
            state.after_cycle |= self.after_cycle;
            state.resumed |= self.resumed;
        } else {
            state.motion = self.codes.clone();
            state.cycle = self.cycle.clone();
            state.motion_entry = false;
            (state.motion_called, state.after_cycle, state.resumed) =
                (self.unknown, self.after_cycle, self.resumed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_values_than_are_told_apart_are_any() {
        let mut values = Values::one(0);
        for value in 1..8 {
            values.join(&Values::one(value));
            assert!(!values.is_any());
        }
        values.join(&Values::one(8));
        assert!(values.is_any() && values.list().is_empty());
    }

    #[test]
    fn joining_reports_a_change_once() {
        let mut state = State::entry();
        let mut other = State::entry();
        other.set_motion(Some(1000), None);
        assert!(state.join(&other));
        assert!(!state.join(&other));
        assert!(state.motion_entry && state.motion.list() == [1000]);
    }
}
