//! Registers in a row that an earlier conversion sets by a loop, on a target whose variables have no computed numbers.
//!
//! Law: `v = a`, and while `v` is not above `b`: `#[v] = c` and `v = v+1`, is `c` for each of the variables from `a` to
//! `b`, one after the other, and `v = b+1` at the end. Exact.
//!
//! Side condition: `a`, `b` and `c` are constants, the loop does nothing else, nothing but the statement before it and its own
//! end reaches it, no block of it can be skipped or found by a label, and `v` is none of the variables that it sets. The
//! head of the program must name `v` among the registers for values in between: no operator edits `a` or `b` then.
//! Counter-example: `#1=500` at the head of a program that a person wrote, who changes it to 510.

use super::subscript_chains::variable;
use crate::ir::eval::whole;
use crate::ir::{
    BinOp, Block, BlockId, Callee, Class, Cond, Expr, Module, Place, Program, Relation, SourceInfo, Stmt,
    StmtKind, TermKind, Var,
};
use crate::legalize::features::Features;
use crate::legalize::registers::names::name_of;
use crate::legalize::{Context, calls_of};

/// Most variables that a loop is written out for.
const MOST: u32 = 100;

/// True where heads name such registers, and the target takes no computed numbers of such variables.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.earlier.has_between() && super::subscript_chains::concerns(features, context)
}

/// Writes such loops out; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let mut found: Vec<(usize, Loop)> = Vec::new();
    for (index, program) in module.programs.iter().enumerate().filter(|(_, program)| computes(program)) {
        let between = context.earlier.between.get(index);
        let claims = |var: Var| {
            let name = name_of(var, module, context.source);
            name.is_some_and(|name| between.is_some_and(|between| between.contains(&name)))
        };
        let loops = program.ids().filter_map(|id| Loop::of(program, id, context));
        found.extend(loops.filter(|one| claims(one.counter)).map(|one| (index, one)));
    }
    for (index, one) in &found {
        one.write_out(&mut module.programs[*index]);
    }
    !found.is_empty()
}

/// True for a program that writes a variable by a computed number.
fn computes(program: &Program) -> bool {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.any(|stmt| matches!(stmt.kind.target(), Some(Place::Indirect(..))))
}

/// A loop that sets variables in a row.
struct Loop {
    /// The block before it, whose last statement sets the counter.
    before: BlockId,
    /// The block that compares.
    head: BlockId,
    /// The block that sets a variable and counts.
    body: BlockId,
    /// Where it goes on.
    behind: BlockId,
    counter: Var,
    /// The variables, in their order.
    vars: Vec<Var>,
    /// What each of them is set to.
    value: Expr,
    /// What the counter holds at the end.
    last: f64,
}

impl Loop {
    /// The loop whose head is this block.
    fn of(program: &Program, head: BlockId, context: &Context<'_>) -> Option<Self> {
        let first = program.block(head).filter(|block| block.stmts.is_empty() && is_bare(block))?;
        let TermKind::Branch { cond, then: body, otherwise: behind } = &first.term.kind else { return None };
        let Cond::Compare(Relation::LessEqual, Expr::Var(counter), Expr::Number(last)) = &**cond else {
            return None;
        };
        let block = program.block(*body).filter(|block| is_bare(block) && *body != head)?;
        if block.term.kind != TermKind::Jump(head) || *behind == head || behind == body {
            return None;
        }
        let [set, count] = block.stmts.as_slice() else { return None };
        let (Place::Indirect(bank, number), value) = plain(set)? else { return None };
        let next = Expr::binary(BinOp::Add, Expr::Var(*counter), Expr::Number(1.0));
        if plain(count)? != (&Place::Var(*counter), &next)
            || **number != Expr::Var(*counter)
            || !matches!(value, Expr::Number(_) | Expr::Vacant)
        {
            return None;
        }
        let ([before], []) = (&*others(program, head, *body)?, &*others(program, *body, head)?) else {
            return None;
        };
        let entry = program.block(*before).filter(|block| block.term.kind == TermKind::Jump(head))?;
        let (Place::Var(set), Expr::Number(first)) = plain(entry.stmts.last()?)? else { return None };
        let (from, to) = (exact(*first)?, exact(*last)?);
        if set != counter || counter.class == Class::Local || !(from..from.checked_add(MOST)?).contains(&to) {
            return None;
        }
        let vars: Option<Vec<Var>> =
            (from..=to).map(|number| variable(*bank, number, context.source)).collect();
        let vars = vars.filter(|vars| !vars.contains(counter))?;
        let (counter, value, last) = (*counter, value.clone(), last + 1.0);
        Some(Self { before: *before, head, body: *body, behind: *behind, counter, vars, value, last })
    }

    /// Puts an assignment of each variable in its place.
    fn write_out(&self, program: &mut Program) {
        for (id, to) in [(self.head, self.behind), (self.body, self.behind)] {
            if let Some(block) = program.blocks.get_mut(id.index()) {
                block.stmts.clear();
                block.term.kind = TermKind::Jump(to);
            }
        }
        let Some(block) = program.blocks.get_mut(self.before.index()) else { return };
        let Some(first) = block.stmts.pop() else { return };
        // The block's number and comments stay with the first of what it becomes.
        let others = SourceInfo { span: first.site.span, ..SourceInfo::default() };
        let sites = std::iter::once(first.site).chain(std::iter::repeat(others));
        let values = self.vars.iter().map(|var| (*var, self.value.clone()));
        let all = values.chain([(self.counter, Expr::Number(self.last))]).zip(sites);
        block.stmts.extend(all.map(|((var, value), site)| {
            let kind = StmtKind::Assign { target: Place::Var(var), value };
            Stmt { kind, site }
        }));
    }
}

/// True for a block that no label finds, with nothing to keep at its end.
fn is_bare(block: &Block) -> bool {
    block.labels.is_empty() && block.term.site.skip.is_none() && block.term.site.comments.is_empty()
}

/// The place and the value of an assignment that nothing skips.
fn plain(stmt: &Stmt) -> Option<(&Place, &Expr)> {
    match &stmt.kind {
        StmtKind::Assign { target, value } if stmt.site.skip.is_none() => Some((target, value)),
        _ => None,
    }
}

/// The blocks but `except` that go on at `to`; none if a run or a call may enter there.
fn others(program: &Program, to: BlockId, except: BlockId) -> Option<Vec<BlockId>> {
    let enters = |block: &Block| calls_of(block).any(|call| call.callee == Callee::Block(to));
    if to == BlockId(0) || program.blocks.iter().any(enters) {
        return None;
    }
    let goes = |block: &Block| block.term.kind.successors().contains(&to);
    let all = program.ids().zip(&program.blocks);
    Some(all.filter(|(id, block)| *id != except && goes(block)).map(|(id, _)| id).collect())
}

/// A constant that is the number of a variable.
fn exact(value: f64) -> Option<u32> {
    whole(value).filter(|number| f64::from(*number) == value)
}
