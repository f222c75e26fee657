//! Values that are vacant, and that the target's table holds doubled or halved.
//!
//! Law: a word whose value is vacant is not there, so a block that writes a table with it writes nothing; twice vacant
//! is 0, and the target would write that. So where the value may be vacant, the block stands twice: without the value
//! under the condition that it is vacant, and with it. Side condition: only values that are scaled. A sign before a
//! vacant variable leaves nothing to write either, unless the source's table has the word there as 0; if nobody
//! confirmed that, lowering said so.
//! Counter-example without it: `G10 L12 P3 R#2` with #2 vacant clears the radius that the source leaves alone.
//!
//! Where it ends: an amount that is computed and added under incremental coordinates. Half of an increment that its word
//! loses is lost again each time.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::dataflow::reached;
use crate::ir::analysis::{Cfg, Summaries, Vacancy};
use crate::ir::{
    BlockId, Call, Callee, Cond, Expr, Module, Nc, NcItem, Program, Relation, SourceInfo, StmtKind, TermKind,
};
use crate::legalize::features::Features;
use crate::legalize::rewrite::{Part, rebuild};
use crate::legalize::variables::state::table_factor;
use crate::legalize::{Context, calls_of};
use crate::text::Span;
use std::collections::BTreeSet;

/// Writes such blocks twice.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if table_factor(context.source, context.target).is_none_or(|factor| factor == 1.0) {
        return;
    }
    added(module, context);
    let summaries = context.summaries(module);
    let signs = context.source.behaviour(Question::BracketVacantWord).is_none_or(|row| row.value != "zero");
    for program in &mut module.programs {
        let places = places(program, &summaries, signs);
        if !places.is_empty() {
            split(program, &places);
        }
    }
}

/// Tells of amounts that are computed and may be added to the table.
fn added(module: &Module, context: &mut Context<'_>) {
    let computed = |nc: &Nc| written(nc).is_some_and(|value| value.constant().is_none());
    let stmts = || module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let any = stmts().any(|stmt| stmt.kind.nc().is_some_and(computed));
    if !any || !Features::of(&module.programs).any_op(|op| op == Op::Incremental) {
        return;
    }
    let pairs = context.called(module).pairs(module);
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                if let Some(nc) = stmt.kind.nc().filter(|nc| computed(nc)) {
                    let mut words = state.clone();
                    words.step_words(nc);
                    if words.op(Group::Distance) != Some(Op::Absolute) {
                        let again = calls_again(index, &pairs, module) || runs_again(program, id);
                        report(index, stmt.site.span, again, context);
                    }
                }
                state.step(stmt);
            }
        }
    }
}

/// One that the library may add again is refused; what is added once in a run is off by half an increment at the most.
fn report(index: usize, span: Span, again: bool, context: &mut Context<'_>) {
    let (code, what) = if again {
        let what = "a computed amount may be added here repeatedly to the cutter table, and the target's \
                    table holds twice or half of it: the loss in the last digit adds up";
        (Code::NoEquivalent, what)
    } else {
        let what = "a computed amount may be added here to the cutter table, and the target's table holds \
                    twice or half of it: each run of the program may lose half an increment";
        (Code::Conditional, what)
    };
    let help = "write the whole value under G90, or round the amount so that it can be halved";
    context.add_once(index, what, Diagnostic::new(code, span, what).with_help(help));
}

/// True where the programs that call one may run it more than once in one run: unless each of them is called by none, and names it in one
/// call, without a count and in no loop.
fn calls_again(index: usize, pairs: &[(usize, usize)], module: &Module) -> bool {
    let name = module.programs.get(index).and_then(|program| program.name.as_ref());
    let callers: BTreeSet<usize> =
        pairs.iter().filter(|(_, callee)| *callee == index).map(|(caller, _)| *caller).collect();
    callers.into_iter().any(|caller| {
        let Some(program) = module.programs.get(caller) else { return true };
        let named = |call: &Call| matches!(&call.callee, Callee::Program(callee) if Some(callee) == name);
        let mut places = program
            .ids()
            .zip(&program.blocks)
            .flat_map(|(id, block)| calls_of(block).filter(|call| named(call)).map(move |call| (id, call)));
        let only = places.next().filter(|(id, call)| call.count.is_none() && !runs_again(program, *id));
        let restarts = program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Return { .. }));
        let modal = program.blocks.iter().flat_map(|block| &block.stmts);
        let modal = modal.into_iter().any(|stmt| matches!(stmt.kind, StmtKind::ModalCall(_)));
        only.is_none()
            || places.next().is_some()
            || restarts
            || modal
            || pairs.iter().any(|(_, callee)| *callee == caller)
    })
}

/// True where a block may come again in one run of the program.
fn runs_again(program: &Program, block: BlockId) -> bool {
    let cfg = Cfg::of(program);
    let calls_itself = |call: &Call| matches!(call.callee, Callee::Block(_)) || call.count.is_some();
    let after = cfg.succs(block).iter().copied();
    let seen = reached(after, |at, go| cfg.succs(at).iter().for_each(|to| go(*to)));
    seen.contains(&block) || program.blocks.iter().flat_map(calls_of).any(calls_itself)
}

/// The statements whose value may be vacant; with `signs` after a sign too.
fn places(program: &Program, summaries: &Summaries, signs: bool) -> BTreeSet<(BlockId, usize)> {
    let vacancy = Vacancy::of(program, summaries, &BTreeSet::new());
    let mut found = BTreeSet::new();
    for (id, block) in program.ids().zip(&program.blocks) {
        vacancy.forward(id, &mut |at, may| {
            if let Some(StmtKind::Nc(nc)) = block.stmts.get(at).map(|stmt| &stmt.kind)
                && written(nc)
                    .map(|value| if signs { unsigned(value) } else { value })
                    .is_some_and(|value| value.may_be_vacant() && may(value))
            {
                found.insert((id, at));
            }
        });
    }
    found
}

fn written(nc: &Nc) -> Option<&Expr> {
    nc.word(Role::OffsetValue).filter(|_| crate::legalize::variables::state::writes_radius(nc))
}

/// What the signs stand before.
fn unsigned(value: &Expr) -> &Expr {
    match value {
        Expr::Negate(inner) => unsigned(inner),
        value => value,
    }
}

fn split(program: &mut Program, places: &BTreeSet<(BlockId, usize)>) {
    let (mut block, mut at) = (BlockId(0), 0);
    rebuild(program, &mut |builder, part| {
        match &part {
            Part::Start(id) => (block, at) = (*id, 0),
            Part::Term(_) => {}
            Part::Stmt(stmt) => {
                at += 1;
                if places.contains(&(block, at - 1))
                    && let StmtKind::Nc(nc) = &stmt.kind
                    && let Some(value) = written(nc).cloned()
                {
                    let (empty, full, behind) = (builder.fresh(), builder.fresh(), builder.fresh());
                    let cond = Cond::Compare(Relation::Equal, unsigned(&value).clone(), Expr::Vacant);
                    builder.end(
                        TermKind::Branch { cond: Box::new(cond), then: empty, otherwise: full },
                        SourceInfo::default(),
                    );
                    builder.start(full);
                    builder.push(stmt.kind.clone(), stmt.site.clone());
                    builder.end(TermKind::Jump(behind), SourceInfo::default());
                    builder.start(empty);
                    let mut without = nc.clone();
                    without.items.retain(|item| !matches!(item, NcItem::Word(Role::OffsetValue, _)));
                    let site =
                        SourceInfo { skip: stmt.site.skip, span: stmt.site.span, ..SourceInfo::default() };
                    builder.push(StmtKind::Nc(without), site);
                    builder.start(behind);
                    return;
                }
            }
        }
        part.keep(builder);
    });
}
