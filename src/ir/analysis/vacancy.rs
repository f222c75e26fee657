//! Which variables may be vacant where.
//!
//! At a program's entry every variable of a nullable class may be vacant, but for those stated
//! to be assigned (arguments that every call gives). Arithmetic never yields vacant; copies do
//! where what they copy may be. A comparison with vacant settles it on each of its ways.

use super::dataflow::{Analysis, Cursor, Direction, Lattice, States, Steps, solve};
use super::effects::{Seen, Summaries};
use super::{BitRow, Cfg, Universe, VarSet, modal_bodies};
use crate::canon::{Role, Sys};
use crate::ir::{
    Bank, Block, BlockId, Call, Callee, Class, Cond, Expr, Nc, NcItem, Place, Program, Relation, Stmt,
    StmtKind, TermKind, Var,
};
use crate::syntax::ProgramName;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

/// What may be vacant in one program.
#[derive(Debug)]
pub struct Vacancy<'p> {
    rules: Rules<'p>,
    states: States<BitRow>,
}

/// What statements, and ways between blocks, do to what may be vacant.
#[derive(Debug)]
struct Rules<'p> {
    program: &'p Program,
    summaries: &'p Summaries,
    universe: Universe,
    /// What may be vacant at the entry.
    entry: BitRow,
    /// True if only callers enter the program: no return starts it again.
    called: bool,
    /// What callees leave with a number, by their names.
    filled: &'p Filled,
}

/// The variables that a program leaves with a number whenever it returns, by its name.
pub type Filled = BTreeMap<ProgramName, BTreeSet<Var>>;

/// Of no program.
static NONE: Filled = Filled::new();

/// What is known of a program by the library around it.
#[derive(Clone, Copy, Debug)]
pub struct Around<'a> {
    /// What is never vacant at its entry.
    pub assigned: &'a BTreeSet<Var>,
    /// True if only its callers enter it: it never starts itself again.
    pub called: bool,
    /// Variables to follow that it may not name itself.
    pub named: &'a BTreeSet<Var>,
    /// What its callees leave with a number.
    pub filled: &'a Filled,
}

impl Lattice for BitRow {
    fn join(&mut self, other: &Self) -> bool {
        BitRow::join(self, other)
    }
}

impl Analysis for Rules<'_> {
    type State = BitRow;
    const DIRECTION: Direction = Direction::Forward;
    const AS_THEY_STAND: bool = true;

    fn entries(&self, cfg: &Cfg) -> Vec<(BlockId, BitRow)> {
        // A body that a modal call enters is entered with anything.
        let modal: BTreeSet<BlockId> = modal_bodies(self.program).collect();
        let called = |root: BlockId| cfg.preds(root).is_empty() || modal.contains(&root);
        let roots = cfg.roots().iter().copied();
        let entered = roots.filter(|root| *root == BlockId(0) || called(*root));
        let state = |root| if root == BlockId(0) { self.entry.clone() } else { self.universe.all() };
        entered.map(|root| (root, state(root))).collect()
    }

    fn block(&self, id: BlockId, block: &Block, row: &mut BitRow) {
        self.stmts(id, block, row);
    }

    /// What the terminator of `from` does on the way to `to`.
    fn edge<'s>(&self, from: BlockId, to: BlockId, row: &'s BitRow) -> Option<Cow<'s, BitRow>> {
        let Some(block) = self.program.block(from) else {
            if self.called && to == BlockId(0) {
                return None;
            }
            // After returns: the locals of a level that ended are not those of its caller.
            return self.changed(row, |row| {
                row.join(&self.locals());
            });
        };
        match &block.term.kind {
            TermKind::Branch { cond, then, otherwise } if then != otherwise && may_settle(cond) => {
                self.changed(row, |row| self.refine(cond, to == *then, row))
            }
            TermKind::Call { call, next } => match call.callee {
                Callee::Block(entry) if to == entry && to != *next => {
                    if call.level {
                        self.changed(row, |row| self.enter(call, row))
                    } else {
                        Some(Cow::Borrowed(row))
                    }
                }
                Callee::Block(_) if to != *next => Some(Cow::Borrowed(row)),
                // It passes its part by where it runs no times; else what that leaves comes from its returns.
                Callee::Block(entry) if to != entry && !call.level => {
                    let count = call.count.as_ref().and_then(Expr::constant);
                    count.is_none_or(|count| count < 1.0).then_some(Cow::Borrowed(row))
                }
                _ => self.changed(row, |row| {
                    self.disturb(self.summaries.by_call(call), row);
                    let filled = self.filled_by(call).into_iter().flatten();
                    filled.filter_map(|var| self.universe.place(*var)).for_each(|at| row.remove(at));
                }),
            },
            _ => Some(Cow::Borrowed(row)),
        }
    }
}

impl Steps for Rules<'_> {
    fn stmt(&self, _: (BlockId, usize), stmt: &Stmt, row: &mut BitRow) {
        let sure = stmt.site.skip.is_none();
        match &stmt.kind {
            StmtKind::Assign { target, value } => {
                let vacant = self.yields_vacant(value, row);
                self.write(target, vacant, sure, row);
            }
            // What the operator gives is a number.
            StmtKind::Input { target, .. } => self.write(target, false, sure, row),
            StmtKind::ClearAll(class) if sure => row.subtract(&self.universe.classes(|c| c == *class)),
            StmtKind::Nc(nc) => self.disturb(self.summaries.by_nc(nc).into(), row),
            _ => {}
        }
    }
}

impl<'p> Vacancy<'p> {
    /// Computes it. `assigned` are never vacant at the entry.
    pub fn of(program: &'p Program, summaries: &'p Summaries, assigned: &BTreeSet<Var>) -> Self {
        let named = BTreeSet::new();
        let around = Around { assigned, called: false, named: &named, filled: &NONE };
        Self::entered(program, summaries, around, &NONE)
    }

    /// The same with what the library says of the program.
    pub fn around(program: &'p Program, summaries: &'p Summaries, around: Around<'p>) -> Self {
        Self::entered(program, summaries, around, around.filled)
    }

    fn entered(
        program: &'p Program,
        summaries: &'p Summaries,
        Around { assigned, called, named, .. }: Around<'_>,
        filled: &'p Filled,
    ) -> Self {
        let universe = universe(program, named);
        let mut entry = universe.all();
        assigned.iter().filter_map(|var| universe.place(*var)).for_each(|at| entry.remove(at));
        let rules = Rules { program, summaries, universe, entry, called, filled };
        let states = solve(&rules, program, &Cfg::whole(program, summaries.come_back()));
        Self { rules, states }
    }

    /// The variables of several programs that have a number wherever this one returns; none if it may go on elsewhere.
    pub fn filled(&self) -> BTreeSet<Var> {
        let blocks = || self.rules.program.ids().zip(&self.rules.program.blocks);
        let elsewhere =
            |kind: &TermKind| matches!(kind, TermKind::Return { to: Some(_) } | TermKind::Chain(_));
        if blocks().any(|(_, block)| elsewhere(&block.term.kind)) {
            return BTreeSet::new();
        }
        let mut all: Option<BTreeSet<Var>> = None;
        for (id, block) in blocks().filter(|(_, block)| matches!(block.term.kind, TermKind::Return { .. })) {
            if self.states.at(id).is_none() {
                continue;
            }
            let vars = self.rules.universe.vars().iter().filter(|var| var.class.shared());
            let sure =
                vars.filter(|var| !self.may_be_vacant(id, block.stmts.len(), **var)).copied().collect();
            all = Some(match all {
                Some(all) => &all & &sure,
                None => sure,
            });
        }
        all.unwrap_or_default()
    }

    /// True where the variable may be vacant before statement `at` of a block (past the last:
    /// before its terminator). False where control does not come.
    pub fn may_be_vacant(&self, id: BlockId, at: usize, var: Var) -> bool {
        self.may_yield_vacant(id, at, &Expr::Var(var))
    }

    /// True where the expression may yield vacant there.
    pub fn may_yield_vacant(&self, id: BlockId, at: usize, e: &Expr) -> bool {
        let mut cursor = Cursor::default();
        let row = cursor.seek(&self.rules, &self.states, self.rules.program, (id, at));
        row.is_some_and(|row| self.rules.yields_vacant(e, row))
    }

    /// Calls `f` before each statement of a block, and with the number of statements before its
    /// terminator, with what may yield vacant there.
    pub fn forward(&self, id: BlockId, f: &mut dyn FnMut(usize, super::Holds<'_, Expr>)) {
        let (Some(block), Some(row)) = (self.rules.program.block(id), self.states.at(id)) else { return };
        let mut row = row.clone();
        self.rules.each(id, block, &mut row, &mut |at, row| f(at, &|e| self.rules.yields_vacant(e, row)));
        f(block.stmts.len(), &|e| self.rules.yields_vacant(e, &row));
    }

    /// The statements with a word that may not be there, as what it holds may be vacant: a sign before it changes nothing
    /// in that. Of each word that `is_asked` names.
    pub fn absent(&self, is_asked: &dyn Fn(&Nc, Role) -> bool) -> BTreeSet<(BlockId, usize)> {
        let unsigned = |value: &Expr| match value {
            Expr::Negate(inner) => Expr::clone(inner),
            value => value.clone(),
        };
        let mut found = BTreeSet::new();
        for (id, block) in self.rules.program.ids().zip(&self.rules.program.blocks) {
            self.forward(id, &mut |at, may| {
                let Some(nc) = block.stmts.get(at).and_then(|stmt| stmt.kind.nc()) else { return };
                let absent = nc.items.iter().any(|item| match item {
                    NcItem::Word(role, value) if is_asked(nc, *role) => {
                        let value = unsigned(value);
                        value.may_be_vacant() && may(&value)
                    }
                    _ => false,
                });
                if absent {
                    found.insert((id, at));
                }
            });
        }
        found
    }
}

/// The variables that a program names and that may be vacant, and these.
fn universe(program: &Program, named: &BTreeSet<Var>) -> Universe {
    let mut vars = VarSet::default();
    vars.extend(named.iter().copied().filter(|var| var.class.nullable()));
    program.variables(&mut |var| {
        if var.class.nullable() {
            vars.insert(var);
        }
    });
    for block in &program.blocks {
        // The arguments of a level are locals of the body that it enters.
        if let TermKind::Call { call, .. } = &block.term.kind {
            vars.extend(call.arguments.iter().map(|a| Var { class: Class::Local, number: a.local }));
        }
    }
    Universe::new(vars.iter().collect())
}

impl Rules<'_> {
    fn changed<'s>(&self, row: &BitRow, change: impl FnOnce(&mut BitRow)) -> Option<Cow<'s, BitRow>> {
        let mut row = row.clone();
        change(&mut row);
        Some(Cow::Owned(row))
    }

    /// What a call surely leaves with a number: it runs, and comes back behind itself.
    fn filled_by(&self, call: &Call) -> Option<&BTreeSet<Var>> {
        let Callee::Program(name) = &call.callee else { return None };
        let runs = call.count.as_ref().is_none_or(|count| count.constant().is_some_and(|n| n >= 1.0));
        self.filled.get(name).filter(|_| runs && !self.summaries.come_back())
    }

    fn locals(&self) -> BitRow {
        self.universe.classes(|class| class == Class::Local)
    }

    /// A level of locals begins.
    fn enter(&self, call: &Call, row: &mut BitRow) {
        let outer = row.clone();
        row.join(&self.locals());
        for argument in &call.arguments {
            let var = Var { class: Class::Local, number: argument.local };
            self.write(&Place::Var(var), self.yields_vacant(&argument.value, &outer), true, row);
        }
    }

    fn write(&self, target: &Place, vacant: bool, sure: bool, row: &mut BitRow) {
        match target {
            Place::Var(var) => {
                let Some(at) = self.universe.place(*var) else { return };
                if vacant {
                    row.insert(at);
                } else if sure {
                    row.remove(at);
                }
            }
            Place::Indirect(Bank::Numbered, _) if vacant => {
                row.join(&self.universe.all());
            }
            Place::Indirect(..) | Place::System(..) => {}
        }
    }

    /// What is written out of sight may be vacant.
    fn disturb(&self, written: Seen<'_>, row: &mut BitRow) {
        if written.is_empty() {
            return;
        }
        self.universe
            .vars()
            .iter()
            .enumerate()
            .filter(|(_, var)| written.contains(**var))
            .for_each(|(at, _)| row.insert(at));
    }

    fn refine(&self, cond: &Cond, holds: bool, row: &mut BitRow) {
        cond.likened(holds, &mut |var, other, differs| {
            // Not vacant: unlike vacant, or like something that never is.
            let settled = if differs { is_vacant(other) } else { !self.yields_vacant(other, row) };
            if let Some(at) = self.universe.place(var).filter(|_| settled) {
                row.remove(at);
            }
        });
    }

    fn yields_vacant(&self, e: &Expr, row: &BitRow) -> bool {
        match e {
            Expr::Var(var) if var.class.nullable() => self.universe.place(*var).is_none_or(|at| row.has(at)),
            e => e.may_be_vacant(),
        }
    }
}

/// False where a condition says nothing of what is vacant.
fn may_settle(cond: &Cond) -> bool {
    match cond {
        Cond::Compare(relation, ..) => matches!(relation, Relation::Equal | Relation::NotEqual),
        Cond::Switch(_) => false,
        Cond::And(_) | Cond::Or(_) | Cond::Not(_) => true,
    }
}

fn is_vacant(e: &Expr) -> bool {
    matches!(e, Expr::Vacant | Expr::System(Sys::Empty, _))
}
