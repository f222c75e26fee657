//! Repeated moves, where the target repeats drilling cycles and calls only.
//!
//! Law: a block with a repeat of n does n times what it does once; so does a loop that runs the block and counts n
//! down. Side conditions: no drilling cycle is in force (there the target repeats as well), and n is 1 or
//! more, since what a repeat of none does is not the same everywhere.
//! Where the source moves once whatever the count, and the target would repeat, the count goes.
//! Words of a block that is repeated are computed once; under a modal call the macro may change what they are
//! computed from, so such a block is refused.
//! Counter-example: `X1. L3` under a cycle whose state is not known here, which is refused.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{
    BinOp, BlockId, Class, Cond, Expr, Module, Nc, NcItem, Place, Program, Relation, SourceInfo, StmtKind,
    TermKind, Var,
};
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::legalize::{Context, Modal, ModalFacts};

/// Unrolls repeated moves into loops, where only the source has them; where only the target has, a count goes.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let ncs = |program: &Program, wanted: &dyn Fn(&Nc) -> bool| {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        stmts.any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if wanted(nc)))
    };
    let repeats = |nc: &Nc| nc.word(Role::Repeat).is_some();
    let affected: Vec<usize> =
        (0..module.programs.len()).filter(|at| ncs(&module.programs[*at], &repeats)).collect();
    if affected.is_empty() {
        return;
    }
    let drills = module.programs.iter().any(|program| ncs(program, &|nc| nc.ops().any(Op::is_cycle)));
    let facts = context.modal_facts(module);
    if !context.source.is(Question::RepeatMoves) && context.target.is(Question::RepeatMoves) {
        return affected
            .into_iter()
            .for_each(|index| once(&mut module.programs[index], index, drills, &facts, context));
    }
    if !context.source.is(Question::RepeatMoves) || context.target.is(Question::RepeatMoves) {
        return affected
            .into_iter()
            .for_each(|index| doubt(&module.programs[index], index, drills, &facts, context));
    }
    for index in affected {
        unroll(&mut module.programs[index], index, drills, &facts, context);
    }
}

/// Whether a drilling cycle is in force; `any` if the library has some.
fn drills_here(state: &Modal, any: bool) -> Option<bool> {
    state.drills().or((!any).then_some(false))
}

/// A repeat outside of drilling cycles is copied; what both controls make of it must be confirmed.
fn doubt(program: &Program, index: usize, drills: bool, facts: &ModalFacts, context: &mut Context<'_>) {
    for (id, block) in program.ids().zip(&program.blocks) {
        let mut state = facts.at(index, id);
        for stmt in &block.stmts {
            state.step(stmt);
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if nc.word(Role::Repeat).is_some() && !drills_here(&state, drills).unwrap_or(false) {
                context.rests_on_source(index, stmt.site.span, Question::RepeatMoves);
                context.rests_on_target(index, stmt.site.span, Question::RepeatMoves);
            }
        }
    }
}

/// The source is taken to move once, whatever the count, and the target would repeat: the count goes.
fn once(program: &mut Program, index: usize, drills: bool, facts: &ModalFacts, context: &mut Context<'_>) {
    for (at, block) in program.blocks.iter_mut().enumerate() {
        let mut state = facts.at(index, BlockId(at as u32));
        for stmt in &mut block.stmts {
            state.step(stmt);
            let span = stmt.site.span;
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            let cycle = drills_here(&state, drills);
            if nc.word(Role::Repeat).is_none() || cycle == Some(true) {
                continue;
            }
            context.rests_on_source(index, span, Question::RepeatMoves);
            if cycle.is_none() {
                let what = "the count repeats the drilling cycle on some paths to this block, and on the target the move on others";
                context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
            }
            nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Repeat, _)));
        }
    }
}

fn unroll(program: &mut Program, index: usize, drills: bool, facts: &ModalFacts, context: &mut Context<'_>) {
    let mut temps = highest_temp(program);
    let mut state = Modal::unknown();
    rebuild(program, &mut |builder, part| {
        let stmt = match part {
            Part::Start(id) => {
                state = facts.at(index, id);
                return;
            }
            Part::Stmt(stmt) => stmt,
            end @ Part::Term(_) => return end.keep(builder),
        };
        state.step(&stmt);
        let count = match &stmt.kind {
            StmtKind::Nc(nc) if !nc.ops().any(Op::is_cycle) => nc.word(Role::Repeat).cloned(),
            _ => None,
        };
        let cycle = drills_here(&state, drills);
        let (Some(count), StmtKind::Nc(nc)) = (count.filter(|_| cycle != Some(true)), &stmt.kind) else {
            return builder.push(stmt.kind, stmt.site);
        };
        let span = stmt.site.span;
        let mut refuse = |why: &str| context.add(index, Diagnostic::new(Code::NoEquivalent, span, why));
        if cycle.is_none() {
            refuse(
                "the count repeats the drilling cycle on some paths to this block, and the move on others",
            );
        }
        let computed = |item: &NcItem| matches!(item, NcItem::Word(_, value) if value.constant().is_none());
        if state.may_call() && nc.items.iter().any(computed) {
            refuse(
                "a repeated move with computed words under a modal call: the macro may change the words \
                 between the repeats",
            );
        }
        if stmt.site.skip.is_some() {
            refuse("a repeated move with a block skip: skip it by a condition");
        }
        if count.constant().is_some_and(|n| n < 1.0 || n.fract() != 0.0) {
            refuse("no source says what a repeat count below 1, or with a fraction, does to a move");
        }
        let mut nc = nc.clone();
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Repeat, _)));
        if count.constant() == Some(1.0) {
            return builder.push(StmtKind::Nc(nc), stmt.site);
        }
        temps += 1;
        let left = Var { class: Class::Temp, number: temps };
        let set = |value| StmtKind::Assign { target: Place::Var(left), value };
        builder.push(set(count), SourceInfo { span: stmt.site.span, ..SourceInfo::default() });
        let (head, body, behind) = (builder.fresh(), builder.fresh(), builder.fresh());
        builder.start(head);
        let cond = Cond::Compare(Relation::Greater, Expr::Var(left), Expr::Number(0.0));
        builder.end(
            TermKind::Branch { cond: Box::new(cond), then: body, otherwise: behind },
            SourceInfo::default(),
        );
        builder.start(body);
        builder.push(StmtKind::Nc(nc), stmt.site);
        let one_less = Expr::binary(BinOp::Sub, Expr::Var(left), Expr::Number(1.0));
        builder.push(set(one_less), SourceInfo::default());
        builder.end(TermKind::Jump(head), SourceInfo::default());
        builder.start(behind);
    });
}
