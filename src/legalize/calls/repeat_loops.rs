//! Calls that run more often than the target's count says.
//!
//! Law: a loop that calls once and counts n down runs the callee n times. Side condition: n is a whole number, or is rounded as the
//! source rounds its word; one that is vacant is 1, as the word is not there; a count below 1 runs nothing here, and what it does on the source no maker's text says. Arguments are set before each run: if the
//! source sets them once, and the macro may change them, the call is refused. Counter-example: `M98 P10 L150` on a control whose
//! count has two digits.

use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::{Ranges, Summaries, Vacancy};
use crate::ir::{
    Block, BlockId, Call, Callee, Class, Expr, Module, Place, Program, Stmt, StmtKind, TermKind,
};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::registers::frames::repeats::loops_with;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

const REPEAT: &str = "repeat";

/// True if the target's calls run less often than the source's.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let most = |control: &crate::dialect::Control| control.limit(REPEAT).unwrap_or(u32::MAX);
    features.has(Feature::Call) && most(context.target) < most(context.source)
}

/// Makes loops of counts that are larger, or computed.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let most = context.target.limit(REPEAT).map_or(f64::INFINITY, f64::from);
    let wanted = |call: &Call| {
        let count = call.count.as_ref().map(|count| count.constant());
        count.is_some_and(|count| count.is_none_or(|count| !(0.0..=most).contains(&count)))
    };
    refuse(module, wanted, context);
    let vacant = vacant(module, wanted);
    if context.source.is(Question::IntegerWordRounds) {
        round(module, wanted, context);
    }
    for (index, program) in module.programs.iter_mut().enumerate() {
        loops_with(program, wanted, vacant.get(&index).unwrap_or(&BTreeSet::new()));
    }
}

/// By program, the calls whose count may be vacant.
fn vacant(module: &Module, wanted: impl Fn(&Call) -> bool) -> BTreeMap<usize, BTreeSet<Span>> {
    let count = |block: &Block| match &block.term.kind {
        TermKind::Call { call, .. } if wanted(call) => call.count.clone().filter(Expr::may_be_vacant),
        _ => None,
    };
    let asks = |program: &Program| program.blocks.iter().any(|block| count(block).is_some());
    let mut found: BTreeMap<usize, BTreeSet<Span>> = BTreeMap::new();
    if !module.programs.iter().any(asks) {
        return found;
    }
    let (summaries, given) = (Summaries::of(module), CalledPrograms::of(module).given(module));
    let none = BTreeSet::new();
    for (index, program) in module.programs.iter().enumerate().filter(|(_, program)| asks(program)) {
        let vacancy = Vacancy::of(program, &summaries, given.get(&index).unwrap_or(&none));
        for (id, block) in program.ids().zip(&program.blocks) {
            let Some(count) = count(block) else { continue };
            vacancy.forward(id, &mut |at, may| {
                if at == block.stmts.len() && may(&count) {
                    found.entry(index).or_default().insert(block.term.site.span);
                }
            });
        }
    }
    found
}

/// Rounds counts that may have a fraction, as the source rounds the word.
fn round(module: &mut Module, wanted: impl Fn(&Call) -> bool, context: &mut Context<'_>) {
    let summaries = context.summaries(module);
    for program in &mut module.programs {
        let found = fractions(program, &summaries, &wanted);
        for id in found {
            if let TermKind::Call { call, .. } = &mut program.blocks[id.index()].term.kind {
                call.count = call.count.take().map(|count| Expr::Call(Func::Round, [count].into()));
            }
        }
    }
}

/// The blocks whose call has a count that may have a fraction.
pub fn fractions(program: &Program, summaries: &Summaries, wanted: &impl Fn(&Call) -> bool) -> Vec<BlockId> {
    let count = |block: &Block| match &block.term.kind {
        TermKind::Call { call, .. } if wanted(call) => call.count.clone().filter(|count| !count.is_whole()),
        _ => None,
    };
    if !program.blocks.iter().any(|block| count(block).is_some()) {
        return Vec::new();
    }
    let mut vars = BTreeSet::new();
    for count in program.blocks.iter().filter_map(count) {
        count.variables(&mut |var| _ = vars.insert(var));
    }
    let ranges = Ranges::of_constants(program, summaries, vars);
    let blocks = program.ids().zip(&program.blocks);
    let open = blocks.filter(|(id, block)| {
        count(block).is_some_and(|count| !ranges.at(*id, block.stmts.len(), &count).all_whole())
    });
    open.map(|(id, _)| id).collect()
}

/// Refuses the calls whose macro may change its arguments, of a source whose repeats do not set them again: the loop does.
fn refuse(module: &Module, wanted: impl Fn(&Call) -> bool, context: &mut Context<'_>) {
    let answer = context.source.behaviour(Question::CallRepeatReloadsArguments).map(|row| row.value.as_str());
    if answer != Some("false") {
        return;
    }
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let TermKind::Call { call, .. } = &block.term.kind else { continue };
            if call.level && wanted(call) && !leaves_locals(module, &call.callee) {
                let found = Diagnostic::new(Code::NoEquivalent, block.term.site.span, CHANGES);
                context.add(index, found.with_help(CHANGES_HELP));
            }
        }
    }
}

/// True if a program writes no locals, and nothing that it calls can write them for it.
fn leaves_locals(module: &Module, callee: &Callee) -> bool {
    let Callee::Program(name) = callee else { return false };
    let mut named = module.programs.iter().filter(|program| program.name.as_ref() == Some(name)).peekable();
    let writes = |stmt: &Stmt| match stmt.kind.target() {
        Some(Place::Var(var)) => var.class == Class::Local,
        Some(Place::Indirect(..)) => true,
        _ => matches!(stmt.kind, StmtKind::ClearAll(_)),
    };
    let keeps = |block: &Block| {
        let shares = matches!(&block.term.kind, TermKind::Call { call, .. } if !call.level);
        !shares && !block.stmts.iter().any(writes)
    };
    named.peek().is_some() && named.all(|program| program.blocks.iter().all(keeps))
}

const CHANGES: &str = "the called program may change an argument that its next repeat reads, and the source does not set it again; the target \
                       needs a loop for this count, which sets it each time";
const CHANGES_HELP: &str = "give what one run leaves for the next a common variable";
