//! Which variables need a flag, and where they may be vacant.

use super::MOST_WORDS;
use super::conditions::asks;
use super::entries::{Entries, Left};
use super::outside::Outside;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::dataflow::reached;
use crate::ir::analysis::{Around, Holds, Summaries, Vacancy};
use crate::ir::{
    Bank, BlockId, Call, Callee, Class, Cond, Expr, Module, NcItem, Place, Program, Relation, Stmt, StmtKind,
    TermKind, Var,
};
use crate::legalize::Context;
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A variable of a program; those that all see are of none.
type Key = (Option<usize>, Var);

/// A place in a program: a statement of a block, or past the last its end.
pub(super) type At = (BlockId, usize);

/// What may be vacant, and which of it has a flag.
#[derive(Default)]
pub(super) struct Marks {
    /// Variables with a flag.
    flagged: BTreeSet<Key>,
    /// By program: what is read at a place and may be vacant there.
    may: Vec<BTreeSet<(At, Var)>>,
    /// By program: what no flag can say.
    refused: Vec<Vec<(Span, String)>>,
    /// By program: blocks that make a variable 0 that is vacant, and do nothing else.
    zeroed: Vec<BTreeMap<BlockId, Var>>,
    names: Names,
    /// By program: the locals that every call gives a value.
    pub always: Vec<BTreeSet<u32>>,
    /// What programs outside the library are given.
    pub outside: Outside,
}

/// What is gathered before the flags are known.
#[derive(Default)]
struct Gathered {
    asked: BTreeSet<Key>,
    /// If the first needs a flag, so does the second.
    copies: BTreeMap<Key, BTreeSet<Key>>,
    /// Calls that share their caller's locals, both ways.
    neighbours: BTreeMap<usize, BTreeSet<usize>>,
    outside: Outside,
}

fn key(program: usize, var: Var) -> Key {
    (Some(program).filter(|_| !var.class.shared()), var)
}

impl Marks {
    pub fn of(module: &Module, summaries: &Summaries) -> Self {
        let mut marks = Self { names: Names::of(module), ..Self::default() };
        let mut gathered = Gathered::default();
        let mut entries = Entries::of(module, &marks.names);
        let count = module.programs.len();
        (marks.may, marks.refused) = (vec![BTreeSet::new(); count], vec![Vec::new(); count]);
        (marks.zeroed, marks.always) = (vec![BTreeMap::new(); count], vec![BTreeSet::new(); count]);
        let named = entries.named.clone();
        let filled = entries.filled(module, &marks.names, summaries);
        let left = Left { module, summaries, filled: &filled };
        for index in std::mem::take(&mut entries.order) {
            let program = &module.programs[index];
            let set = entries.of_program(index);
            let called = entries.is_called(index);
            let locals = set.iter().filter(|var| called && var.class == Class::Local);
            marks.always[index] = locals.map(|var| var.number).collect();
            let mut own = Own {
                index,
                names: &marks.names,
                may: BTreeSet::new(),
                refused: Vec::new(),
                zeroed: BTreeMap::new(),
                all: &mut gathered,
                entries: &mut entries,
                left: &left,
            };
            let around = Around { assigned: &set, called, named: &named[index], filled: &filled };
            own.look(program, &Vacancy::around(program, summaries, around));
            (marks.may[index], marks.refused[index]) = (own.may, own.refused);
            marks.zeroed[index] = own.zeroed;
        }
        marks.flagged = reached(gathered.asked.iter().copied(), |from: Key, go| {
            gathered.copies.get(&from).into_iter().flatten().for_each(|to| go(*to));
            if let (Some(program), var) = from {
                let near = gathered.neighbours.get(&program).into_iter().flatten();
                near.for_each(|other| go((Some(*other), var)));
            }
        });
        marks.outside = gathered.outside;
        marks
    }

    /// The flag of a variable, if it has one.
    pub fn flag(&self, program: usize, var: Var) -> Option<Var> {
        self.flagged.contains(&key(program, var)).then(|| var.flag())
    }

    /// True in a block that only makes a variable 0 which is 0 while it is vacant: nothing asks for its flag.
    pub fn needless(&self, program: usize, block: BlockId) -> bool {
        let var = self.zeroed.get(program).and_then(|zeroed| zeroed.get(&block));
        var.is_some_and(|var| self.flag(program, *var).is_none())
    }

    /// True if a local of a program that the call may run has a flag.
    pub fn passes(&self, caller: usize, call: &Call, local: u32) -> bool {
        let var = Var { class: Class::Local, number: local };
        let callees = self.names.callees(caller, call);
        callees.iter().any(|callee| self.flag(*callee, var).is_some())
    }

    /// True if the variable may be vacant where it is read there.
    pub fn may(&self, program: usize, at: At, e: &Expr) -> bool {
        matches!(e, Expr::Var(var) if self.may.get(program).is_some_and(|may| may.contains(&(at, *var))))
    }

    /// The variables with a flag that all programs see.
    pub fn shared(&self) -> impl Iterator<Item = Var> + '_ {
        self.flagged.iter().filter(|(program, _)| program.is_none()).map(|(_, var)| *var)
    }

    /// Refuses what no flag can say, and what writes a variable with a flag out of sight.
    pub fn refuse(&self, module: &Module, context: &mut Context<'_>) {
        for (index, found) in self.refused.iter().enumerate() {
            for (span, what) in found {
                context.add(index, Diagnostic::new(Code::NoEquivalent, *span, what.clone()));
            }
        }
        if self.flagged.is_empty() {
            return;
        }
        for (index, program) in module.programs.iter().enumerate() {
            let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
            for stmt in stmts.filter(|stmt| writes_by_number(stmt)) {
                let what = "this writes a variable by a computed number, and the library asks whether a variable is vacant: the target has no vacant variables, and the flag beside the variable would not follow";
                let help = "write the variable by its own number, or set it at the start of the program";
                context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help));
            }
        }
    }
}

/// The block that stands between `IF v EQ vacant` and what comes after it, if it is `v=0` alone, and the variable.
fn makes_zero(program: &Program, kind: &TermKind) -> Option<(BlockId, Var)> {
    let TermKind::Branch { cond, then, otherwise } = kind else { return None };
    let Cond::Compare(relation, Expr::Var(var), Expr::Vacant) = &**cond else { return None };
    let (set, past) = match relation {
        Relation::Equal => (*then, *otherwise),
        Relation::NotEqual => (*otherwise, *then),
        _ => return None,
    };
    let block = program.blocks.get(set.index())?;
    let zero = |stmt: &Stmt| {
        let value = Expr::Number(0.0);
        stmt.kind == StmtKind::Assign { target: Place::Var(*var), value } && stmt.site.comments.is_empty()
    };
    let alone = block.labels.is_empty() && matches!(block.stmts.as_slice(), [stmt] if zero(stmt));
    let ends = block.term.kind == TermKind::Jump(past) && block.term.site.comments.is_empty();
    let ways = program.blocks.iter().flat_map(|block| block.term.kind.successors());
    let only = ways.filter(|way| *way == set).take(2).count() == 1;
    (alone && ends && only).then_some((set, *var))
}

/// What stands after the minus of a word: if it is vacant, the word is not there.
pub(super) fn unsigned(value: &Expr) -> &Expr {
    match value {
        Expr::Negate(inner) => inner,
        value => value,
    }
}

fn writes_by_number(stmt: &Stmt) -> bool {
    matches!(stmt.kind.target(), Some(Place::Indirect(Bank::Numbered, _)))
}

/// The programs of a library by their names.
#[derive(Default)]
pub(super) struct Names {
    programs: BTreeMap<ProgramName, usize>,
    count: usize,
}

impl Names {
    pub fn of(module: &Module) -> Self {
        let programs = module.programs.iter().enumerate().filter_map(|(at, p)| Some((p.name.clone()?, at)));
        Self { programs: programs.collect(), count: module.programs.len() }
    }

    /// The program of this name.
    pub fn find(&self, name: &ProgramName) -> Option<usize> {
        self.programs.get(name).copied()
    }

    /// The programs that a call may run.
    pub fn callees(&self, caller: usize, call: &Call) -> Vec<usize> {
        match &call.callee {
            Callee::Program(name) => self.find(name).into_iter().collect(),
            Callee::Block(_) => vec![caller],
            Callee::Computed(_) | Callee::Cycle(_) => (0..self.count).collect(),
        }
    }
}

/// What one program gives.
struct Own<'o> {
    index: usize,
    names: &'o Names,
    may: BTreeSet<(At, Var)>,
    refused: Vec<(Span, String)>,
    zeroed: BTreeMap<BlockId, Var>,
    all: &'o mut Gathered,
    entries: &'o mut Entries,
    left: &'o Left<'o>,
}

impl Own<'_> {
    fn look(&mut self, program: &Program, vacancy: &Vacancy<'_>) {
        for (id, block) in program.ids().zip(&program.blocks) {
            vacancy.forward(id, &mut |at, may| match block.stmts.get(at) {
                Some(stmt) => {
                    stmt.kind.exprs(&mut |e| self.note((id, at), e, may));
                    self.stmt(stmt, may);
                }
                None => {
                    block.term.kind.exprs(&mut |e| self.note((id, at), e, may));
                    // What is 0 while it is vacant need not be made 0.
                    match makes_zero(program, &block.term.kind) {
                        Some((set, var)) => drop(self.zeroed.insert(set, var)),
                        None => self.end(&block.term.kind, block.term.site.span, may),
                    }
                }
            });
        }
    }

    fn note(&mut self, at: At, e: &Expr, may: Holds<'_, Expr>) {
        e.walk(&mut |e| {
            if let Expr::Var(var) = e
                && var.class.nullable()
                && may(e)
            {
                self.may.insert((at, *var));
            }
        });
        let span = Span::default();
        e.walk(&mut |e| {
            if let Expr::Truth(cond) = e {
                asks(cond, may, &mut |e| self.asked(e, span));
            }
        });
    }

    /// Someone tells vacant from 0 here.
    fn asked(&mut self, e: &Expr, span: Span) {
        match e {
            Expr::Var(var) => drop(self.all.asked.insert(key(self.index, *var))),
            Expr::Vacant => {}
            _ => {
                let what = "what is read here may be vacant, and the target has no vacant variables: only a variable that is named can have a flag beside it";
                self.refused.push((span, what.into()));
            }
        }
    }

    /// A value goes to a variable: its flag must be known if the variable's is.
    fn copied(&mut self, to: Key, value: &Expr, may: Holds<'_, Expr>, span: Span) {
        if !may(value) {
            return;
        }
        match value {
            Expr::Var(var) => {
                self.all.copies.entry(to).or_default().insert(key(self.index, *var));
            }
            Expr::Vacant => {}
            other => self.asked(other, span),
        }
    }

    fn stmt(&mut self, stmt: &Stmt, may: Holds<'_, Expr>) {
        let span = stmt.site.span;
        match &stmt.kind {
            StmtKind::Assign { target: Place::Var(var), value } if var.class.nullable() => {
                self.copied(key(self.index, *var), value, may, span);
            }
            StmtKind::Assign { target: Place::System(..), value } if may(value) => {
                self.refused.push((span, "a value that may be vacant is written to the machine's state, and the target has no vacant variables: set it before".into()));
            }
            StmtKind::Nc(nc) => {
                let mut words = 0;
                for item in &nc.items {
                    match item {
                        NcItem::Word(_, value) if may(unsigned(value)) => {
                            words += usize::from(!matches!(value, Expr::Vacant));
                            self.asked(unsigned(value), span);
                        }
                        NcItem::Code(_, value) if may(value) => {
                            self.refused.push((span, "the number of a code may be vacant here, and the target has no vacant variables: set it before".into()));
                        }
                        _ => {}
                    }
                }
                if words > MOST_WORDS {
                    let what = format!(
                        "{words} words of this block may be vacant, and the target has no vacant variables: the block would have to stand {} times",
                        1_u64 << words.min(40)
                    );
                    self.refused.push((span, what));
                }
            }
            StmtKind::Output(_) | StmtKind::Print { .. } => {
                let mut any = false;
                stmt.kind.exprs(&mut |e| any |= may(e));
                if any {
                    self.refused.push((span, "a value that is printed may be vacant, and the target has no vacant variables: set it before".into()));
                }
            }
            StmtKind::ModalCall(call) => self.call(call, span, may),
            _ => {}
        }
    }

    fn end(&mut self, kind: &TermKind, span: Span, may: Holds<'_, Expr>) {
        match kind {
            TermKind::Branch { cond, .. } => asks(cond, may, &mut |e| self.asked(e, span)),
            TermKind::Call { call, .. } => self.call(call, span, may),
            TermKind::Chain(name) => {
                let callee = self.names.find(name);
                callee.into_iter().for_each(|callee| self.shares(callee));
            }
            _ => {}
        }
    }

    fn call(&mut self, call: &Call, span: Span, may: Holds<'_, Expr>) {
        if call.count.as_ref().is_some_and(may) {
            let what =
                "how often this calls may be vacant, and the target has no vacant variables: set it before";
            self.refused.push((span, what.into()));
        }
        if self.all.outside.note(call, self.names, may) {
            let open = call.arguments.iter().filter(|argument| may(&argument.value));
            open.for_each(|argument| self.asked(&argument.value, span));
        }
        for callee in self.names.callees(self.index, call) {
            self.entries.enter(self.index, callee, call, self.left, may);
            if !call.level {
                self.shares(callee);
            }
            for argument in &call.arguments {
                let local = Var { class: Class::Local, number: argument.local };
                self.copied(key(callee, local), &argument.value, may, span);
            }
        }
    }

    /// Another program runs in the same level.
    fn shares(&mut self, callee: usize) {
        self.all.neighbours.entry(self.index).or_default().insert(callee);
        self.all.neighbours.entry(callee).or_default().insert(self.index);
    }
}
