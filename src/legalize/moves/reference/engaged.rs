//! Whether C of a lathe is an axis at a place: a code of the builder engages it, another one lets it go.

use crate::canon::{Act, Op, Role};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::{Follow, OverCalls, called};
use crate::ir::{Block, BlockId, Module, Nc, Program, Stmt, StmtKind};
use crate::text::Span;
use std::collections::BTreeMap;

/// What may be true of it at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Engaged {
    /// It may be engaged.
    pub on: bool,
    /// It may be let go.
    pub off: bool,
}

/// What engages it on the source.
#[derive(Clone, Copy)]
struct Rules {
    /// A code by the name for that.
    by_code: bool,
    /// Its return to the reference position, until the spindle starts.
    by_return: bool,
}

impl Rules {
    fn of(source: &Control) -> Self {
        let on = Act::named(Act::C_AXIS[0]).number();
        let named =
            |row: &crate::dialect::CodeMeaning| row.op == Op::Act && row.fixed.get(&Role::Act) == Some(&on);
        Self {
            by_code: source.dialect().codes.iter().any(named),
            by_return: source.behaviour(Question::CAxisEngages).is_some_and(|row| row.value == "return"),
        }
    }

    fn are_known(self) -> bool {
        self.by_code || self.by_return
    }

    /// True where nobody says it: C is taken to be engaged where it has moved, and may be let go where the spindle starts.
    fn by_moves(self) -> bool {
        !self.are_known()
    }
}

/// True where the profile of the source says what engages it.
pub(super) fn is_told(source: &Control) -> bool {
    Rules::of(source).are_known()
}

/// True of a program that names C, or a code that engages it or lets it go.
pub(super) fn is_named(program: &Program) -> bool {
    let none = Rules { by_code: true, by_return: false };
    let names = |nc: &Nc| {
        [Role::C, Role::StepC].iter().any(|role| nc.word(*role).is_some())
            || told(nc, Engaged::UNKNOWN, none).is_some()
    };
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| stmt.kind.nc().is_some_and(names))
}

impl Engaged {
    const UNKNOWN: Self = Self { on: true, off: true };

    /// Takes a block; one under a block skip may do nothing.
    fn step(&mut self, stmt: &Stmt, rules: Rules) {
        if matches!(stmt.kind, StmtKind::ModalCall(_)) {
            *self = Self::UNKNOWN;
        }
        let Some(nc) = stmt.kind.nc() else { return };
        let Some(after) = told(nc, *self, rules) else { return };
        if stmt.site.skip.is_some() {
            self.join(&after);
        } else {
            *self = after;
        }
    }
}

/// What a block makes of it, if it does.
fn told(nc: &Nc, before: Engaged, rules: Rules) -> Option<Engaged> {
    let act = nc.word(Role::Act).filter(|_| nc.has(Op::Act)).and_then(|act| act.constant());
    if let Some(act) = act.and_then(Act::of) {
        let name = act.name();
        let at = Act::C_AXIS.iter().position(|known| **known == name)?;
        return Some(Engaged { on: at == 0, off: at == 1 });
    }
    let names = nc.word(Role::C).is_some() || nc.word(Role::StepC).is_some();
    let starts = nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw);
    if rules.by_moves() {
        let sets = |op: Op| {
            matches!(op, Op::WriteWork | Op::WriteTurret | Op::WriteOffset | Op::SetPosition | Op::LocalShift)
        };
        let after = if starts { Engaged { off: true, ..before } } else { before };
        return Some(if names && !nc.ops().any(sets) { Engaged { on: true, off: false } } else { after });
    }
    if !rules.by_return {
        return None;
    }
    if starts {
        return Some(Engaged { on: false, off: true });
    }
    (names && nc.has(Op::ReferenceReturn)).then_some(Engaged { on: true, off: false })
}

impl Lattice for Engaged {
    fn join(&mut self, other: &Self) -> bool {
        let was = *self;
        self.on |= other.on;
        self.off |= other.off;
        was != *self
    }
}

/// Follows a library: a run begins with C let go. A program that only others call, none of them in the library, begins with either.
pub(super) struct Engagement {
    rules: Rules,
    /// By program.
    unknown: Vec<bool>,
}

impl Engagement {
    /// At each bare return of a library, by its program and place in the text; `any` where the library moves C.
    pub fn at_returns(module: &Module, source: &Control, any: bool) -> BTreeMap<(usize, Span), Engaged> {
        let rules = Rules::of(source);
        let states = Self::follow(module, rules, any);
        let mut found = BTreeMap::new();
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                let mut known = states.at(index, id).copied().unwrap_or(Engaged::UNKNOWN);
                for stmt in &block.stmts {
                    known.step(stmt, rules);
                    if stmt.kind.nc().is_some_and(super::bare) {
                        found.insert((index, stmt.site.span), known);
                    }
                }
            }
        }
        found
    }

    fn follow(module: &Module, rules: Rules, any: bool) -> OverCalls<Engaged> {
        let called = called(module);
        let unknown = (module.programs.iter().zip(called))
            .map(|(program, called)| any && program.returns() && !called)
            .collect();
        OverCalls::of(module, &Self { rules, unknown })
    }
}

impl Follow for Engagement {
    type Known = Engaged;

    fn outside(&self, program: usize) -> Engaged {
        Engaged { on: self.unknown.get(program).copied().unwrap_or(true), off: true }
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Engaged) {
        block.stmts.iter().for_each(|stmt| known.step(stmt, self.rules));
    }

    fn lose(&self, known: &mut Engaged) {
        *known = Engaged::UNKNOWN;
    }
}
