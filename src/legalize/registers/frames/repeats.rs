//! Repeated calls with arguments: each run of the macro finds its arguments anew.
//!
//! Law: a call that opens a level and runs n times sets the level's locals before each of its runs; so does a loop that
//! calls once and counts n down. A count below 1 runs nothing here, and what it does on the source no maker's text says.
//! Counter-example: `G65 P9010 L2 A1.`, where O9010 does `#1=#1+1`, of a source whose repeats find what the run before left: that is
//! refused.

use super::levels::Levels;
use crate::canon::Func;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::upward_exposed::UpwardExposed;
use crate::ir::{
    BinOp, Call, Class, Cond, Expr, Module, Place, Program, Relation, SourceInfo, StmtKind, TermKind, Var,
};
use crate::legalize::Context;
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::text::Span;
use std::collections::BTreeSet;

/// The repeated calls of a source whose repeats do not set the arguments again, by their programs.
pub(super) fn kept(module: &Module, source: &Control) -> Vec<(usize, Span, Call)> {
    let answer = source.behaviour(Question::CallRepeatReloadsArguments).map(|row| row.value.as_str());
    let mut found = Vec::new();
    if answer != Some("false") {
        return found;
    }
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            let TermKind::Call { call, .. } = &block.term.kind else { continue };
            if call.level && call.count.as_ref().is_some_and(|count| count.constant() != Some(1.0)) {
                found.push((index, block.term.site.span, (**call).clone()));
            }
        }
    }
    found
}

/// Refuses those whose callee writes a local that its next run reads first; `module` has statics in the place of locals.
pub(super) fn refuse(
    kept: Vec<(usize, Span, Call)>,
    module: &Module,
    (levels, exposed): (&Levels, &UpwardExposed),
    context: &mut Context<'_>,
) {
    if kept.is_empty() {
        return;
    }
    let stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    let written: BTreeSet<Var> = stmts
        .filter_map(|stmt| match stmt.kind.target() {
            Some(Place::Var(var)) => Some(*var),
            _ => None,
        })
        .collect();
    for (index, span, call) in kept {
        let leaves = levels.callees(index, &call).into_iter().any(|callee| {
            exposed.at_entry(callee).into_iter().any(|var| levels.has(callee, var) && written.contains(&var))
        });
        if leaves {
            let found = Diagnostic::new(Code::NoEquivalent, span, LEAVES).with_help(LEAVES_HELP);
            context.add(index, found);
        }
    }
}

const LEAVES: &str = "the called program changes a local variable that its next repeat reads, and the source does not set it again; the target has no \
                      locals, and the loop that repeats the call there sets them each time";
const LEAVES_HELP: &str = "give what one run leaves for the next a common variable";

/// Makes loops of the repeated calls that are `wanted`.
pub fn loops(program: &mut Program, wanted: impl Fn(&Call) -> bool) {
    loops_with(program, wanted, &BTreeSet::new());
}

/// The same. Of calls at the places `vacant` the count may be vacant: that word is not there, so they run once.
pub fn loops_with(program: &mut Program, wanted: impl Fn(&Call) -> bool, vacant: &BTreeSet<Span>) {
    let wanted = |call: &Call| call.count.is_some() && wanted(call);
    let repeated = |kind: &TermKind| matches!(kind, TermKind::Call { call, .. } if wanted(call));
    if !program.blocks.iter().any(|block| repeated(&block.term.kind)) {
        return;
    }
    let mut temps = highest_temp(program);
    rebuild(program, &mut |builder, part| {
        let Part::Term(mut term) = part else { return part.keep(builder) };
        let (mut call, next) = match term.kind {
            TermKind::Call { call, next } if wanted(&call) => (call, next),
            kind => {
                term.kind = kind;
                return Part::Term(term).keep(builder);
            }
        };
        let Some(count) = call.count.take().filter(|count| count.constant() != Some(1.0)) else {
            return builder.end(TermKind::Call { call, next }, term.site);
        };
        // A count that is rounded is counted down to below a half: 2.4 runs twice, and 2.5 three times.
        let (count, (relation, least)) = match count {
            Expr::Call(Func::Round, operands) if operands.len() == 1 => {
                let count = operands.into_iter().next().unwrap_or(Expr::Number(1.0));
                (count, (Relation::GreaterEqual, 0.5))
            }
            count => (count, (Relation::Greater, 0.0)),
        };
        temps += 1;
        let left = Var { class: Class::Temp, number: temps };
        let set = |value| StmtKind::Assign { target: Place::Var(left), value };
        let span = || SourceInfo { span: term.site.span, ..SourceInfo::default() };
        let is_none = vacant
            .contains(&term.site.span)
            .then(|| Cond::Compare(Relation::Equal, count.clone(), Expr::Vacant));
        builder.push(set(count), span());
        let (head, body, after) = (builder.fresh(), builder.fresh(), builder.fresh());
        if let Some(cond) = is_none {
            let once = builder.fresh();
            builder.end(TermKind::Branch { cond: Box::new(cond), then: once, otherwise: head }, span());
            builder.start(once);
            builder.push(set(Expr::Number(1.0)), span());
            builder.end(TermKind::Jump(head), SourceInfo::default());
        }
        builder.start(head);
        let cond = Cond::Compare(relation, Expr::Var(left), Expr::Number(least));
        builder.end(TermKind::Branch { cond: Box::new(cond), then: body, otherwise: next }, span());
        builder.start(body);
        let one_less = Expr::binary(BinOp::Sub, Expr::Var(left), Expr::Number(1.0));
        builder.end(TermKind::Call { call, next: after }, term.site.clone());
        builder.start(after);
        builder.push(set(one_less), SourceInfo::default());
        builder.end(TermKind::Jump(head), SourceInfo::default());
    });
}
