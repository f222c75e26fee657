//! Which modal state holds where: forward over the ways that control can take.

use super::others::Others;
use super::settings::statement;
use super::shape::{Goal, Shape, goal, return_goal, returns_computed};
use super::state::{MOST_MODAL, State};
use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::dataflow::{Lattice, OneOf, Routines};
use crate::lower::common::{constant, says_something};
use crate::lower::fadal::codes::{Codes, Step, operand, parametric, steps, word};
use crate::syntax::{Block, Expr, Item, ItemKind};

/// The modal state at the head of every run of a program.
#[derive(Debug)]
pub struct Flow<'b> {
    blocks: &'b [Block],
    control: &'b Control,
    shape: &'b Shape,
    /// What is known of the file's programs, and which of them this is.
    others: (&'b Others, usize),
    /// By run; a subroutine is entered at the run that it begins with.
    ways: Routines<State>,
    /// The state where the program returns to its caller.
    left: Option<State>,
    /// True where it may end in another way than by a return to after its call.
    ends_elsewhere: bool,
}

/// Ends the run of blocks with a block skip that ends before this block. Remarks go on with any.
pub fn end_skips(state: &mut State, block: &Block) {
    if block.items.iter().any(says_something) {
        state.end_skips(skip_level(block));
    }
}

/// The level of a block's skip, if it has one.
fn skip_level(block: &Block) -> Option<u8> {
    block.items.iter().find_map(|item| match item.kind {
        ItemKind::Skip(level) => Some(level.unwrap_or(1)),
        _ => None,
    })
}

impl<'b> Flow<'b> {
    /// Follows all ways through a program.
    pub fn new(
        blocks: &'b [Block],
        control: &'b Control,
        shape: &'b Shape,
        others: (&'b Others, usize),
    ) -> Self {
        Self::ranked((0..shape.leaders.len() as u32).collect(), blocks, control, shape, others)
    }

    /// The same where these ranks of runs say which comes first.
    pub(super) fn ranked(
        ranks: Vec<u32>,
        blocks: &'b [Block],
        control: &'b Control,
        shape: &'b Shape,
        others: (&'b Others, usize),
    ) -> Self {
        let ways = Routines::ranked(ranks);
        let mut flow = Self { blocks, control, shape, others, ways, left: None, ends_elsewhere: false };
        // The definitions at the head are jumped over.
        let defined = shape.subs.first().is_some_and(|sub| sub.blocks.start == 0);
        flow.reach(if defined { shape.main } else { 0 }, &State::entry());
        while let Some((run, state)) = flow.ways.pop() {
            flow.run(run, state);
        }
        flow.ways.close();
        flow
    }

    /// The state at the head of the run that begins at this block; none if no run does.
    /// A run that nothing reaches has a state in which nothing was set.
    pub fn at(&self, block: usize) -> Option<State> {
        let run = self.shape.leaders.binary_search(&block).ok()?;
        Some(self.ways.state(run).cloned().unwrap_or_default())
    }

    /// The state where the program returns to its caller; none if it may come back to another place.
    pub fn left(self) -> Option<State> {
        self.left.filter(|_| !self.ends_elsewhere)
    }

    /// Another program ran, which one is not known.
    fn called(&self, state: &mut State) {
        state.called(self.others.0.sets(self.others.1), None);
    }

    /// The program goes back to its caller.
    fn leave(&mut self, state: &State) {
        match &mut self.left {
            Some(left) => drop(left.join(state)),
            None => self.left = Some(state.clone()),
        }
    }

    /// The state after the block of these codes at a place, which leaves the flow alone.
    pub fn behind(&mut self, at: usize, block: &Block, codes: &Codes<'_, '_>, state: State) -> State {
        // Control goes on after any other block.
        let leaves = |item: &Item| matches!(item.kind, ItemKind::Goto(_) | ItemKind::Start(_));
        let keep =
            (block.items.iter().any(leaves) || !steps(&block.items, codes).is_empty()).then(|| state.clone());
        self.block(block, at, state, Some(codes)).or(keep).unwrap_or_default()
    }

    /// The constants that a subroutine call's value may be.
    pub fn constants(value: &Expr, state: &State) -> OneOf<u64> {
        match (constant(value), parametric(value)) {
            (Some(value), _) => OneOf::one(value.to_bits()),
            (None, Some((number, false))) => state.r.get(number as usize).cloned().unwrap_or_else(OneOf::any),
            _ => OneOf::any(),
        }
    }

    fn run(&mut self, run: usize, mut state: State) {
        let start = self.shape.leaders.get(run).copied().unwrap_or(0);
        let end = self.shape.leaders.get(run + 1).copied().unwrap_or(self.blocks.len());
        for at in start..end {
            let Some(block) = self.blocks.get(at) else { return };
            let Some(next) = self.block(block, at, state, None) else { return };
            state = next;
        }
        match self.blocks.get(end) {
            Some(next) if self.shape.region(end) == self.shape.region(end.saturating_sub(1)) => {
                end_skips(&mut state, next);
            }
            _ => state.end_skips(None),
        }
        match self.shape.region(end.saturating_sub(1)) {
            // What stands before the subroutines goes on at the main part.
            None if end < self.shape.main => self.reach(self.shape.main, &state),
            Some(sub) if self.shape.region(end) != Some(sub) => self.give_back(sub, &state),
            _ => {
                self.ends_elsewhere |= end >= self.blocks.len();
                self.reach(end, &state);
            }
        }
    }

    fn reach(&mut self, block: usize, state: &State) {
        if let Ok(run) = self.shape.leaders.binary_search(&block) {
            self.ways.go(run, state);
        }
    }

    /// The run that a subroutine begins with.
    fn entry(&self, sub: usize) -> Option<usize> {
        let sub = self.shape.subs.get(sub)?;
        self.shape.leaders.binary_search(&sub.blocks.start).ok()
    }

    fn give_back(&mut self, sub: usize, state: &State) {
        if let Some(entry) = self.entry(sub) {
            self.ways.give_back(entry, state);
        }
    }

    /// The state after the block at a place; none if control does not go on there.
    fn block(
        &mut self,
        block: &Block,
        at: usize,
        mut state: State,
        codes: Option<&Codes<'_, '_>>,
    ) -> Option<State> {
        end_skips(&mut state, block);
        if !block.items.iter().any(says_something) {
            return Some(state);
        }
        let level = skip_level(block);
        let on = match state.skipping.take() {
            Some((_, on)) => Some(on),
            None => level.map(|_| Box::new(state.clone())),
        };
        let after = self.items(&block.items, at, state, 0, codes);
        match (level.zip(on), after) {
            (None, after) => after,
            (Some((_, on)), None) => Some(*on),
            (skipping, Some(after)) => Some(State { skipping, ..after }),
        }
    }

    fn items(
        &mut self,
        items: &[Item],
        at: usize,
        mut state: State,
        depth: u8,
        codes: Option<&Codes<'_, '_>>,
    ) -> Option<State> {
        for item in items {
            match &item.kind {
                ItemKind::Goto(target) => {
                    if let Some(goal) = goal(target) {
                        self.jump(&goal, &state);
                    }
                    return None;
                }
                ItemKind::Start(_) => return None,
                ItemKind::If { body, .. } if depth < 16 => {
                    if let Some(done) = self.items(body, at, state.clone(), depth + 1, None) {
                        state.join(&done);
                    }
                }
                kind => statement(kind, &mut state),
            }
        }
        if items.iter().any(|item| word(item).is_some()) {
            return match codes {
                Some(codes) => self.words(items, at, state, codes),
                None => self.words(items, at, state, &Codes::new(items, self.control)),
            };
        }
        Some(state)
    }

    fn jump(&mut self, goal: &Goal, state: &State) {
        if let Some((at, _)) = self.shape.goals.get(goal).copied() {
            self.reach(at, state);
        }
    }

    fn words(&mut self, items: &[Item], at: usize, mut state: State, codes: &Codes<'_, '_>) -> Option<State> {
        state.set_motion(codes.interpolation(), codes.cycle());
        for row in codes.known() {
            match row.op {
                Op::Absolute => state.incremental = OneOf::one(false),
                Op::Incremental => state.incremental = OneOf::one(true),
                Op::CallModalOff if state.modal == 0 => state.modal_program = false,
                Op::CallModalOff if state.modal < MOST_MODAL => state.modal -= 1,
                _ => {}
            }
        }
        if state.modal == 0 {
            state.modal_subs.clear();
        }
        let axis = |letter| self.control.role(letter, false, None).is_some_and(crate::canon::Role::is_axis);
        let moves = items.iter().filter_map(word).any(|word| axis(word.letter));
        state.moved |= moves;
        // A move after a cycle spells its interpolation out, see `motion`.
        let spells = moves && codes.motion().is_none() && !codes.takes_axes() && state.cycle.list() == [0];
        if spells && !state.motion.entry && state.motion.set.only().is_some() {
            state.after_cycle = false;
            state.resumed = false;
        }
        if state.modal > 0 && (moves || codes.has(Op::CycleHere)) {
            let (modal, in_modal) = (state.modal, state.in_modal);
            // The moves of the subroutine run what was in force before it.
            let inside = if modal < MOST_MODAL { modal - 1 } else { modal };
            for sub in state.modal_subs.clone() {
                let entered = State { modal: inside, in_modal: true, ..state.clone() };
                if let Some(returned) = self.call(sub, false, at, &entered) {
                    state.join(&State { modal, in_modal, ..returned });
                }
            }
        }
        // A register code: which variable it writes is the table's, not told apart here.
        if codes.known().any(|row| matches!(row.op, Op::WriteVariable | Op::ReadOffset)) {
            state.r = std::array::from_fn(|_| OneOf::any());
        }
        let modal = codes.has(Op::CallModal);
        if state.modal_program && moves {
            self.called(&mut state);
        }
        for step in steps(items, codes) {
            match step {
                Step::Local(value) => {
                    let (subs, other) = self.callees(value, &state);
                    if modal {
                        state.modal = (state.modal + 1).min(MOST_MODAL);
                        state.modal_subs.extend(subs);
                        continue;
                    }
                    let again = constant(value).is_none_or(|value| value % 100.0 != 1.0);
                    state = self.call_any(&subs, other, again, at, state)?;
                }
                Step::Program => {
                    let (others, own) = self.others;
                    state.modal_program |= modal;
                    let before = state.clone();
                    state.called(others.sets(own), others.motion(items, codes));
                    let count = operand(items, codes, Role::CallCount);
                    if count.is_some_and(|count| constant(count).is_none_or(|count| count < 1.0)) {
                        state.join(&before);
                    }
                }
                Step::SubEnd => {
                    if let Some(sub) = self.shape.region(at) {
                        self.give_back(sub, &state);
                    }
                    return None;
                }
                Step::Return => {
                    let goal = return_goal(items, codes);
                    if operand(items, codes, Role::Sequence).is_none() {
                        self.leave(&state);
                    } else {
                        self.ends_elsewhere = true;
                    }
                    if let Some(goal) = goal {
                        self.jump(&goal, &state);
                    }
                    if returns_computed(items, codes) {
                        let all = self.shape.goals.keys();
                        let all = all.filter(|goal| matches!(goal, Goal::Sequence(_))).cloned();
                        all.collect::<Vec<_>>().iter().for_each(|goal| self.jump(goal, &state));
                    }
                    return None;
                }
                Step::AreaEnd | Step::End => return None,
                Step::Define(_) | Step::ModalOff => {}
            }
        }
        Some(state)
    }

    /// The subroutines of this program that a call's value may name, and whether it may name another: one that the control
    /// keeps, or none, which is refused or reviewed where it is lowered.
    fn callees(&self, value: &Expr, state: &State) -> (Vec<usize>, bool) {
        let values = Self::constants(value, state);
        if values.is_any() {
            return (self.shape.numbers.values().copied().collect(), true);
        }
        let number = |bits: &u64| (f64::from_bits(*bits) / 100.0).floor();
        let numbers = values.list().iter().map(number);
        let own = numbers.map(|n| if (0.0..100.0).contains(&n) { self.shape.sub(n as u32) } else { None });
        let own: Vec<Option<usize>> = own.collect();
        let mut subs: Vec<usize> = own.iter().flatten().copied().collect();
        subs.dedup();
        (subs, own.is_empty() || own.contains(&None))
    }

    fn call_any(
        &mut self,
        subs: &[usize],
        other: bool,
        again: bool,
        at: usize,
        state: State,
    ) -> Option<State> {
        let mut behind: Option<State> = None;
        if other {
            let mut called = state.clone();
            self.called(&mut called);
            behind = Some(called);
        }
        for sub in subs {
            let Some(returned) = self.call(*sub, again, at, &state) else { continue };
            match &mut behind {
                Some(behind) => drop(behind.join(&returned)),
                None => behind = Some(returned),
            }
        }
        behind
    }

    /// The state after a subroutine that the block at a place calls; none if it is not known to return.
    fn call(&mut self, sub: usize, again: bool, at: usize, state: &State) -> Option<State> {
        let entry = self.entry(sub)?;
        let run = self.shape.leaders.partition_point(|leader| *leader <= at).saturating_sub(1);
        self.ways.call(run, entry, state);
        let returned = self.ways.after(entry).cloned();
        if let (Some(returned), true) = (&returned, again) {
            // A repeat is entered from the one before it.
            self.ways.go(entry, returned);
        }
        returned
    }
}
