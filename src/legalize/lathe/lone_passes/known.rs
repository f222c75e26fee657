//! What the turning, threading or facing pass in force was told, on every way through a library.

use super::super::place::changes_coordinates;
use crate::canon::{Group, Op, Role};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{Block, BlockId, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::{Modal, ModalFacts};

/// A word of the pass in force.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Word {
    /// It was not told.
    #[default]
    None,
    /// This one, with a number.
    Told(NcItem),
    /// Told, and not known: computed, counted from elsewhere, or not the same on all ways.
    Lost,
}

/// What the controls do with passes.
#[derive(Clone, Copy, Debug)]
pub struct Rules {
    /// The source leaves M, S and T alone what they are, and the target makes the pass once more.
    pub cancels: bool,
    /// A code for its own block takes the words of the pass away on the source.
    pub clears: bool,
    /// The target may not do the same there.
    pub clears_apart: bool,
    /// True in a program that is called while a pass is in force, and gives it back so.
    pub carried: bool,
    /// True where X and Z may be told in increments by a mode.
    pub increments: bool,
}

/// What is known of the pass in force.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// Its ends along X and Z, and its taper.
    pub words: [Word; 3],
    /// True where the target has none in force on some way, or without its words: the next block that goes on with it tells all.
    pub again: bool,
    /// True where a code for its own block came on some way after the words.
    pub crossed: bool,
    /// True where a pass was made on some way, and no other code of motion came after it.
    pub may_repeat: bool,
}

impl Lattice for Known {
    fn join(&mut self, other: &Self) -> bool {
        let before = self.clone();
        for (mine, theirs) in self.words.iter_mut().zip(&other.words) {
            if mine != theirs {
                *mine = Word::Lost;
            }
        }
        self.again |= other.again;
        self.crossed |= other.crossed;
        self.may_repeat |= other.may_repeat;
        *self != before
    }
}

impl Known {
    /// True where no pass was made since its code came into force: there is nothing to repeat.
    pub fn is_untold(&self) -> bool {
        self.words.iter().all(|word| *word == Word::None)
    }

    /// Takes a statement; `state` is what is in force after it.
    pub fn step(&mut self, stmt: &Stmt, state: &Modal, rules: Rules) {
        let before = stmt.site.skip.map(|_| self.clone());
        match &stmt.kind {
            StmtKind::Nc(nc) => self.block(nc, state, rules),
            StmtKind::ModalCall(_) => self.lose(),
            _ => {}
        }
        if let Some(before) = before {
            self.join(&before);
        }
    }

    fn block(&mut self, nc: &Nc, state: &Modal, rules: Rules) {
        if nc.ops().any(|op| op.group() == Group::Motion) {
            *self = Self::default();
        }
        let crosses = nc.ops().any(Op::is_for_its_block);
        match state.op(Group::Motion) {
            None => {
                self.may_repeat &= !(crosses && rules.clears);
                return self.lose();
            }
            Some(op) if !op.is_pass() => return,
            Some(_) => {}
        }
        if state.may_call() {
            return self.lose();
        }
        if crosses {
            self.cross(rules);
            return;
        }
        let steps = rules.increments && state.op(Group::Distance) != Some(Op::Absolute);
        // Another unit counts the numbers anew, and after another mode they are places no more.
        if nc.ops().any(|op| matches!(op.group(), Group::Units | Group::Distance)) && !self.is_untold() {
            self.words.iter_mut().for_each(Word::lose);
        }
        if changes_coordinates(nc) || nc.word(Role::Turret).is_some() {
            self.lose_steps(steps);
        }
        if runs(nc) {
            nc.items.iter().for_each(|item| self.word(item));
            (self.again, self.may_repeat) = (false, true);
        } else if switches_alone(nc) && rules.cancels && !self.is_untold() {
            self.again = true;
        }
    }

    /// Takes a code for its own block, which may end what the pass was told.
    fn cross(&mut self, rules: Rules) {
        self.crossed |= !self.is_untold();
        self.again |= rules.clears_apart && !self.is_untold();
        if rules.clears {
            (self.words, self.may_repeat) = Default::default();
        } else {
            self.lose_steps(rules.increments);
        }
    }

    fn word(&mut self, item: &NcItem) {
        let NcItem::Word(role, value) = item else { return };
        if let Some(word) = place_of(*role).and_then(|at| self.words.get_mut(at)) {
            *word = if value.constant().is_some() { Word::Told(item.clone()) } else { Word::Lost };
        }
    }

    /// The tool stands elsewhere than the increments count from.
    fn lose_steps(&mut self, all: bool) {
        for word in &mut self.words[..2] {
            if all || matches!(word, Word::Told(NcItem::Word(Role::StepX | Role::StepZ, _))) {
                word.lose();
            }
        }
    }

    /// Something ran that may have told anything.
    pub fn lose(&mut self) {
        self.words = [Word::Lost, Word::Lost, Word::Lost];
    }
}

impl Word {
    fn lose(&mut self) {
        if *self != Self::None {
            *self = Self::Lost;
        }
    }
}

/// Which of the words of a pass a role is.
pub fn place_of(role: Role) -> Option<usize> {
    match role {
        Role::X | Role::StepX => Some(0),
        Role::Z | Role::StepZ => Some(1),
        Role::Taper | Role::TaperZ => Some(2),
        _ => None,
    }
}

/// True for a block that makes the pass in force.
pub fn runs(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if place_of(*role).is_some()))
}

/// True for M, S or T without an axis, or another code than one of motion or for its own block.
pub fn switches_alone(nc: &Nc) -> bool {
    let told = nc.ops().any(|op| op.group() != Group::Motion && op != Op::Dwell && !op.only_counts())
        || nc.items.iter().any(|item| matches!(item, NcItem::Code('M', _)))
        || nc.word(Role::Speed).is_some()
        || nc.word(Role::Tool).is_some()
        || nc.word(Role::Turret).is_some();
    let other = nc.ops().any(|op| op.group() == Group::Motion || op.is_for_its_block());
    told && !other && !runs(nc) && !nc.names_axis()
}

/// Follows it over a library.
pub struct Passes<'f> {
    /// What is in force.
    pub facts: &'f ModalFacts,
    /// What the controls do.
    pub rules: Rules,
}

impl Follow for Passes<'_> {
    type Known = Known;

    fn outside(&self, _: usize) -> Known {
        Known::default()
    }

    fn stmts(&self, (index, id): (usize, BlockId), block: &Block, known: &mut Known) {
        let mut state = self.facts.at(index, id);
        for stmt in &block.stmts {
            state.step(stmt);
            known.step(stmt, &state, self.rules);
        }
    }

    fn lose(&self, known: &mut Known) {
        known.lose();
    }
}
