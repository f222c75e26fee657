//! Which modal state holds where: forward over the ways that control can take.

use super::others::Others;
use super::settings::statement;
use super::shape::{Goal, Shape, goal, return_goal, returns_computed};
use super::state::{MOST_MODAL, State, Values};
use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::dataflow::{Flow as Places, Lattice};
use crate::lower::common::constant;
use crate::lower::fadal::codes::{Codes, Step, operand, parametric, steps, word};
use crate::syntax::{Block, Expr, Item, ItemKind};
use std::collections::BTreeSet;

/// The modal state at the head of every run of a program.
#[derive(Debug)]
pub struct Flow<'b> {
    blocks: &'b [Block],
    control: &'b Control,
    shape: &'b Shape,
    /// What is known of the file's programs, and which of them this is.
    others: (&'b Others, usize),
    at: Places<State>,
    returned: Vec<Option<State>>,
    modal_subs: Vec<usize>,
    /// The state where the program returns to its caller.
    left: Option<State>,
    /// True where it may end in another way than by a return to after its call.
    ends_elsewhere: bool,
    calling: BTreeSet<usize>,
}

impl<'b> Flow<'b> {
    /// Follows all ways through a program.
    pub fn new(
        blocks: &'b [Block],
        control: &'b Control,
        shape: &'b Shape,
        others: (&'b Others, usize),
    ) -> Self {
        let mut flow = Self {
            blocks,
            control,
            shape,
            others,
            at: Places::new(shape.leaders.len()),
            returned: vec![None; shape.subs.len()],
            modal_subs: Vec::new(),
            left: None,
            ends_elsewhere: false,
            calling: BTreeSet::new(),
        };
        // The definitions at the head are jumped over.
        let defined = shape.subs.first().is_some_and(|sub| sub.blocks.start == 0);
        flow.reach(if defined { shape.main } else { 0 }, &State::entry());
        while let Some(run) = flow.at.pop() {
            flow.run(run);
        }
        flow
    }

    /// The state at the head of the run that begins at this block; none if no run does.
    /// A run that nothing reaches has a state in which nothing was set.
    pub fn at(&self, block: usize) -> Option<State> {
        let run = self.shape.leaders.binary_search(&block).ok()?;
        Some(self.at.state(run).cloned().unwrap_or_default())
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

    /// The state after a block that leaves the flow alone.
    pub fn behind(&mut self, block: &Block, state: State) -> State {
        let keep = state.clone();
        self.block(block, None, state).unwrap_or(keep)
    }

    /// The constants that a subroutine call's value may be.
    pub fn constants(value: &Expr, state: &State) -> Values<u64> {
        match (constant(value), parametric(value)) {
            (Some(value), _) => Values::one(value.to_bits()),
            (None, Some((number, false))) => {
                state.r.get(number as usize).cloned().unwrap_or_else(Values::any)
            }
            _ => Values::any(),
        }
    }

    fn run(&mut self, run: usize) {
        let Some(mut state) = self.at.state(run).cloned() else { return };
        let start = self.shape.leaders.get(run).copied().unwrap_or(0);
        let end = self.shape.leaders.get(run + 1).copied().unwrap_or(self.blocks.len());
        for at in start..end {
            let Some(block) = self.blocks.get(at) else { return };
            let Some(next) = self.block(block, Some((run, at)), state) else { return };
            state = next;
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
        let Ok(run) = self.shape.leaders.binary_search(&block) else { return };
        self.at.flow(run, state);
    }

    fn give_back(&mut self, sub: usize, state: &State) {
        let Some(slot) = self.returned.get_mut(sub) else { return };
        let changed = match slot {
            Some(old) => old.join(state),
            None => {
                *slot = Some(state.clone());
                true
            }
        };
        if changed {
            self.calling.iter().for_each(|run| self.at.again(*run));
        }
    }

    /// The state after a block; none if control does not go on there. `run` is
    /// given while the ways are followed, none when they are known.
    fn block(&mut self, block: &Block, run: Option<(usize, usize)>, state: State) -> Option<State> {
        let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
        let before = skipped.then(|| state.clone());
        let behind = self.items(&block.items, run, state, 0);
        match (before, behind) {
            (Some(mut before), Some(behind)) => {
                before.join(&behind);
                Some(before)
            }
            (before, behind) => behind.or(before),
        }
    }

    fn items(
        &mut self,
        items: &[Item],
        run: Option<(usize, usize)>,
        mut state: State,
        depth: u8,
    ) -> Option<State> {
        for item in items {
            match &item.kind {
                ItemKind::Goto(target) => {
                    if let (Some(goal), Some(_)) = (goal(target), run) {
                        self.jump(&goal, &state);
                    }
                    return None;
                }
                ItemKind::Start(_) => return None,
                ItemKind::If { body, .. } if depth < 16 => {
                    if let Some(done) = self.items(body, run, state.clone(), depth + 1) {
                        state.join(&done);
                    }
                }
                kind => statement(kind, &mut state),
            }
        }
        if items.iter().any(|item| word(item).is_some()) {
            return self.words(items, run, state);
        }
        Some(state)
    }

    fn jump(&mut self, goal: &Goal, state: &State) {
        if let Some((at, _)) = self.shape.goals.get(goal).copied() {
            self.reach(at, state);
        }
    }

    fn words(&mut self, items: &[Item], run: Option<(usize, usize)>, mut state: State) -> Option<State> {
        let codes = Codes::new(items, self.control);
        state.set_motion(codes.interpolation(), codes.cycle());
        for row in codes.known() {
            match row.op {
                Op::Absolute => state.incremental = Values::one(false),
                Op::Incremental => state.incremental = Values::one(true),
                Op::CallModalOff if state.modal == 0 => state.modal_program = false,
                Op::CallModalOff if state.modal < MOST_MODAL => state.modal -= 1,
                _ => {}
            }
        }
        let axis = |letter| self.control.role(letter, false, None).is_some_and(crate::canon::Role::is_axis);
        let moves = items.iter().filter_map(word).any(|word| axis(word.letter));
        state.moved |= moves;
        // A move after a cycle spells its interpolation out, see `motion`.
        let spells = moves && codes.motion().is_none() && !codes.takes_axes() && state.cycle.list() == [0];
        if spells && !state.motion_entry && state.motion.list().len() == 1 {
            state.after_cycle = false;
            state.resumed = false;
        }
        if state.modal > 0 && (moves || codes.has(Op::CycleHere)) {
            let (modal, in_modal) = (state.modal, state.in_modal);
            // The moves of the subroutine run what was in force before it.
            let inside = if modal < MOST_MODAL { modal - 1 } else { modal };
            for sub in self.modal_subs.clone() {
                let mut entered = State { modal: inside, in_modal: true, ..state.clone() };
                if self.call(sub, false, run, &mut entered) {
                    state.join(&State { modal, in_modal, ..entered });
                }
            }
        }
        // A register code: which variable it writes is the table's, not told apart here.
        if codes.known().any(|row| matches!(row.op, Op::WriteVariable | Op::ReadOffset)) {
            state.r = std::array::from_fn(|_| Values::any());
        }
        let modal = codes.has(Op::CallModal);
        if state.modal_program && moves {
            self.called(&mut state);
        }
        for step in steps(items, &codes) {
            match step {
                Step::Local(value) => {
                    let subs = self.callees(value, &state);
                    if modal {
                        state.modal = (state.modal + 1).min(MOST_MODAL);
                        subs.iter().for_each(|sub| {
                            if !self.modal_subs.contains(sub) {
                                self.modal_subs.push(*sub);
                            }
                        });
                        continue;
                    }
                    let again = constant(value).is_none_or(|value| value % 100.0 != 1.0);
                    state = self.call_any(&subs, again, run, state)?;
                }
                Step::Program => {
                    let (others, own) = self.others;
                    state.modal_program |= modal;
                    let before = state.clone();
                    state.called(others.sets(own), others.motion(items, &codes));
                    let count = operand(items, &codes, Role::CallCount);
                    if count.is_some_and(|count| constant(count).is_none_or(|count| count < 1.0)) {
                        state.join(&before);
                    }
                }
                Step::SubEnd => {
                    if let Some((sub, _)) = run.and_then(|(_, at)| Some((self.shape.region(at)?, ()))) {
                        self.give_back(sub, &state);
                    }
                    return None;
                }
                Step::Return => {
                    let goal = return_goal(items, &codes);
                    if run.is_some() && operand(items, &codes, Role::Sequence).is_none() {
                        self.leave(&state);
                    } else {
                        self.ends_elsewhere = true;
                    }
                    if let (Some(goal), Some(_)) = (goal, run) {
                        self.jump(&goal, &state);
                    }
                    if run.is_some() && returns_computed(items, &codes) {
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

    fn callees(&self, value: &Expr, state: &State) -> Vec<usize> {
        let values = Self::constants(value, state);
        if values.is_any() {
            return self.shape.numbers.values().copied().collect();
        }
        let number = |bits: &u64| (f64::from_bits(*bits) / 100.0).floor();
        let subs = values.list().iter().map(number).filter(|n| (0.0..100.0).contains(n));
        let mut subs: Vec<usize> = subs.filter_map(|number| self.shape.sub(number as u32)).collect();
        subs.dedup();
        subs
    }

    fn call_any(
        &mut self,
        subs: &[usize],
        again: bool,
        run: Option<(usize, usize)>,
        state: State,
    ) -> Option<State> {
        if subs.is_empty() {
            // A subroutine that the control keeps, or none: refused or reviewed where it is lowered.
            let mut state = state;
            self.called(&mut state);
            return Some(state);
        }
        let mut behind: Option<State> = None;
        for sub in subs {
            let mut entered = state.clone();
            if self.call(*sub, again, run, &mut entered) {
                match &mut behind {
                    Some(behind) => drop(behind.join(&entered)),
                    None => behind = Some(entered),
                }
            }
        }
        behind
    }

    /// Runs a subroutine on the state. False where it is not known yet to return.
    fn call(&mut self, sub: usize, again: bool, run: Option<(usize, usize)>, state: &mut State) -> bool {
        if let (Some((run, _)), Some(entry)) = (run, self.shape.subs.get(sub)) {
            let entry = entry.blocks.start;
            self.calling.insert(run);
            // A repeat is entered from the one before it.
            let mut first = state.clone();
            if again && let Some(Some(returned)) = self.returned.get(sub) {
                first.join(returned);
            }
            self.reach(entry, &first);
        }
        match self.returned.get(sub) {
            Some(Some(returned)) => {
                *state = returned.clone();
                true
            }
            _ => false,
        }
    }
}
