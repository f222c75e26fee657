//! The modal state that the meaning of later blocks depends on.

use crate::ir::analysis::dataflow::{Lattice, OneOf};
use crate::lower::common::InForce;
use crate::syntax::{Block, ItemKind, SetOption, for_each_item};
use std::collections::BTreeSet;

/// Places of rounding that SET never stated.
pub const DEFAULT_PLACES: u8 = u8::MAX;

/// Modal calls in force that are counted.
pub const MOST_MODAL: u8 = 4;

/// What the other programs of a file set.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    /// Places of rounding.
    pub places: OneOf<u8>,
    /// Whether angles are radians.
    pub radians: OneOf<bool>,
}

impl Sets {
    /// What nothing sets.
    pub const NONE: Self = Self { places: OneOf::NONE, radians: OneOf::NONE };

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
                    self.places.join(&OneOf::one(DEFAULT_PLACES));
                    self.radians.join(&OneOf::one(false));
                }
                for option in options {
                    match option {
                        SetOption::Degrees | SetOption::Radians => {
                            self.radians.join(&OneOf::one(*option == SetOption::Radians));
                        }
                        SetOption::Round(places) => {
                            self.places.join(&OneOf::one(*places));
                        }
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
    pub motion: InForce<u32>,
    /// G codes of the drilling cycle, in thousandths; 0 for none.
    pub cycle: OneOf<u32>,
    /// True where a cycle was ended and no interpolation was given after that.
    pub after_cycle: bool,
    /// True where the interpolation is the one from before a cycle.
    pub resumed: bool,
    /// Whether dimensions are incremental; none while only the caller knows.
    pub incremental: OneOf<bool>,
    /// Whether angles are radians.
    pub radians: InForce<bool>,
    /// Places of rounding.
    pub places: InForce<u8>,
    /// True where moves may still be to come when a statement runs.
    pub moved: bool,
    /// How many modal calls may be in force, up to [`MOST_MODAL`]; so many may be any number.
    pub modal: u8,
    /// The subroutines that they may run, by their places.
    pub modal_subs: BTreeSet<usize>,
    /// True in a subroutine that a modal call may run.
    pub in_modal: bool,
    /// True where a modal call of another program may be in force.
    pub modal_program: bool,
    /// The constants that R0 to R9 may hold, as bits.
    pub r: [OneOf<u64>; 10],
    /// After a block with a block skip, its level, and what is set if the switch is on: a run of such blocks is run or passed over as a
    /// whole. Nobody turns the switch within a run.
    pub skipping: Option<(u8, Box<State>)>,
}

/// States of `self` or of `other`.
impl Lattice for State {
    fn join(&mut self, other: &Self) -> bool {
        let mut skips = false;
        match (&mut self.skipping, &other.skipping) {
            (None, None) => {}
            (Some((level, on)), Some((other, there))) if level == other => skips = on.join(there),
            _ => {
                let (was, mut other) = (self.skipping.is_some(), other.clone());
                self.end_skips(None);
                other.end_skips(None);
                return self.join(&other) || was;
            }
        }
        let (modal, subs) = (self.modal, self.modal_subs.len());
        self.modal = modal.max(other.modal);
        self.modal_subs.extend(&other.modal_subs);
        let joined = [
            self.motion.join(&other.motion),
            self.cycle.join(&other.cycle),
            self.after_cycle.join(&other.after_cycle),
            self.resumed.join(&other.resumed),
            self.incremental.join(&other.incremental),
            self.radians.join(&other.radians),
            self.places.join(&other.places),
            self.moved.join(&other.moved),
            self.in_modal.join(&other.in_modal),
            self.modal_program.join(&other.modal_program),
        ];
        let registers = self.r.iter_mut().zip(&other.r).map(|(mine, theirs)| mine.join(theirs));
        let registers = registers.fold(false, |any, one| any | one);
        skips || registers || joined.contains(&true) || self.modal != modal || self.modal_subs.len() != subs
    }
}

impl State {
    /// Ends a run of blocks with a block skip, unless the next block goes on with this level: both ways meet.
    pub fn end_skips(&mut self, level: Option<u8>) {
        if let Some((_, on)) = self.skipping.take_if(|(other, _)| Some(*other) != level) {
            self.join(&on);
        }
    }

    /// At a program's first block.
    pub fn entry() -> Self {
        Self {
            motion: InForce::entry(),
            cycle: OneOf::one(0),
            radians: InForce { entry: true, ..InForce::one(false) },
            places: InForce::one(DEFAULT_PLACES),
            moved: true,
            r: std::array::from_fn(|_| OneOf::any()),
            ..Self::default()
        }
    }

    /// Another program ran: it may have set any variable, or what `others` do. It leaves `motion`; where that is not
    /// known, and of the other modes, it is taken to leave them as they were.
    pub fn called(&mut self, others: &Sets, motion: Option<&Motion>) {
        // Its moves run the subroutine of a modal call, which sets what it likes.
        let before = (self.modal > 0 || self.modal_program).then(|| self.clone());
        if let Some(motion) = motion {
            motion.give(self);
        }
        self.motion.called |= motion.is_none() || before.is_some();
        if let Some(before) = before {
            self.join(&before);
        }
        self.places.called = true;
        self.places.set.join(&others.places);
        self.radians.called = true;
        self.radians.set.join(&others.radians);
        self.moved = true;
        self.r = std::array::from_fn(|_| OneOf::any());
    }

    /// The interpolation that a block sets, and the cycle (0 for its end).
    pub fn set_motion(&mut self, interpolation: Option<u32>, cycle: Option<u32>) {
        if let Some(code) = interpolation {
            self.motion = InForce::one(code);
            self.cycle = OneOf::one(0);
            self.after_cycle = false;
            self.resumed = false;
        }
        if let Some(code) = cycle {
            self.cycle = OneOf::one(code);
            self.after_cycle = code == 0;
            self.resumed = interpolation.is_none();
        }
    }
}

/// The motion modes that a program leaves to its caller.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    /// The interpolation; what it was entered with is the caller's.
    codes: InForce<u32>,
    cycle: OneOf<u32>,
    after_cycle: bool,
    resumed: bool,
}

impl Motion {
    /// Those of the state at its return.
    pub fn of(state: State) -> Self {
        let State { motion: codes, cycle, after_cycle, resumed, .. } = state;
        Self { codes, cycle, after_cycle, resumed }
    }

    /// Lets the caller go on in it.
    fn give(&self, state: &mut State) {
        if self.codes.entry {
            state.motion.set.join(&self.codes.set);
            // A cycle goes on if the program touches neither it nor the motion mode, which would end it.
            let sets_motion = self.codes.set.is_any() || !self.codes.set.list().is_empty();
            if sets_motion || self.after_cycle || self.cycle.is_any() || self.cycle.list() != [0] {
                state.cycle.join(&self.cycle);
            }
            state.motion.called |= self.codes.called;
            state.after_cycle |= self.after_cycle;
            state.resumed |= self.resumed;
        } else {
            state.motion = self.codes.clone();
            state.cycle = self.cycle.clone();
            (state.after_cycle, state.resumed) = (self.after_cycle, self.resumed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joining_reports_a_change_once() {
        let mut state = State::entry();
        let mut other = State::entry();
        other.set_motion(Some(1000), None);
        assert!(state.join(&other));
        assert!(!state.join(&other));
        assert!(state.motion.entry && state.motion.set.list() == [1000]);
    }
}
