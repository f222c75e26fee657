//! Calls that open a level: arguments that the callee reads go to its statics, and what the caller still needs is kept.

use super::Levels;
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::LiveStatics;
use crate::ir::analysis::upward_exposed::UpwardExposed;
use crate::ir::{
    Block, BlockId, Call, Class, Expr, Module, OF_NO_LEVEL, Place, Program, SourceInfo, Stmt, StmtKind,
    TermKind, Var,
};
use crate::legalize::Context;
use crate::legalize::rewrite::{Part, highest_temp, rebuild};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// The calls that opened a level, and how many statements at the end of their blocks set the callee's statics.
pub(super) type Opened = BTreeMap<(usize, BlockId), usize>;

/// The library without the calls that open a level: what their callees write is not their caller's.
pub(super) fn cut(module: &Module) -> Module {
    let mut module = module.clone();
    for block in module.programs.iter_mut().flat_map(|program| &mut program.blocks) {
        if let TermKind::Call { call, next } = &mut block.term.kind
            && call.level
        {
            let read = std::mem::take(&mut call.arguments).into_iter().map(|argument| {
                assign(Var { class: Class::Temp, number: 0 }, number(argument.value), Span::default())
            });
            block.stmts.extend(read);
            block.term.kind = TermKind::Jump(*next);
        }
    }
    module
}

/// Sets the statics of each callee before its calls, which open no level any more.
pub(super) fn pass(module: &mut Module, levels: &Levels, exposed: &UpwardExposed) -> Opened {
    let mut opened = Opened::new();
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut temps = highest_temp(program);
        for (id, block) in program.ids().zip(&mut program.blocks) {
            if let Some(count) = open(index, block, &mut temps, levels, exposed) {
                opened.insert((index, id), count);
            }
        }
    }
    opened
}

fn open(
    index: usize,
    block: &mut Block,
    temps: &mut u32,
    levels: &Levels,
    exposed: &UpwardExposed,
) -> Option<usize> {
    let TermKind::Call { call, .. } = &mut block.term.kind else { return None };
    if !call.level {
        return None;
    }
    let callees = levels.callees(index, call);
    let mut values: Vec<(Vec<Var>, Expr)> = Vec::new();
    for argument in std::mem::take(&mut call.arguments) {
        let statics: BTreeSet<Var> =
            callees.iter().map(|callee| levels.of_local(*callee, argument.local)).collect();
        values.push((statics.into_iter().collect(), argument.value));
    }
    call.level = false;
    // What no callee reads before it sets it need not be set.
    let reads: BTreeSet<Var> = callees.iter().flat_map(|callee| exposed.at_entry(*callee)).collect();
    values.retain(|(statics, value)| value.may_alarm() || statics.iter().any(|var| reads.contains(var)));
    let given: BTreeSet<Var> = values.iter().flat_map(|(statics, _)| statics.iter().copied()).collect();
    let of_level = |callee: &usize| {
        let vars = exposed.at_entry(*callee).into_iter().filter(|var| levels.has(*callee, *var));
        vars.collect::<Vec<_>>()
    };
    let zeros: BTreeSet<Var> = callees.iter().flat_map(of_level).filter(|var| !given.contains(var)).collect();
    // All arguments are read before the first of them is set.
    let mut crossed = false;
    for (_, value) in &values {
        value.walk(&mut |e| crossed |= matches!(e, Expr::Var(var) if given.contains(var)));
    }
    let several = values.iter().any(|(statics, _)| statics.len() > 1);
    let mut stmts: Vec<(Var, Expr)> = Vec::new();
    if crossed || several {
        for (_, value) in &mut values {
            *temps += 1;
            let temp = Var { class: Class::Temp, number: *temps };
            stmts.push((temp, number(std::mem::replace(value, Expr::Var(temp)))));
        }
    }
    for (statics, value) in values {
        stmts.extend(statics.into_iter().map(|var| (var, number(value.clone()))));
    }
    stmts.extend(zeros.into_iter().map(|var| (var, Expr::Number(0.0))));
    let span = block.term.site.span;
    let count = stmts.len();
    block.stmts.extend(stmts.into_iter().map(|(var, value)| assign(var, value, span)));
    Some(count)
}

/// What is vacant is 0 in a variable that never is. A count of increments of an unknown size is refused by now.
pub(super) fn number(value: Expr) -> Expr {
    match value {
        Expr::Vacant => Expr::Number(0.0),
        Expr::Increments(count) => Expr::Number(count),
        Expr::Negate(inner) if matches!(*inner, Expr::Increments(_)) => number(*inner),
        value => value,
    }
}

fn assign(var: Var, value: Expr, span: Span) -> Stmt {
    let site = SourceInfo { span, ..SourceInfo::default() };
    Stmt { kind: StmtKind::Assign { target: Place::Var(var), value }, site }
}

/// Keeps over each of these calls what its caller needs after it and the callee may write: a level of its own ends with
/// the call, so in `cut` (see [`cut`]) is what callers need.
pub(super) fn keep(
    module: &mut Module,
    cut: &Module,
    opened: &Opened,
    levels: &Levels,
    context: &mut Context<'_>,
) {
    let (live, needs) = (LiveStatics::of(module), LiveStatics::of(cut));
    let through = needs.through(cut);
    let mut kept: BTreeMap<usize, BTreeMap<BlockId, Vec<Var>>> = BTreeMap::new();
    for (&(index, id), count) in opened {
        let Some(block) = module.programs[index].block(id) else { continue };
        let TermKind::Call { call, .. } = &block.term.kind else { continue };
        let mut written = live.written_by(index, call);
        let passing = block.stmts.iter().rev().take(*count).filter_map(|stmt| stmt.kind.target());
        written.extend(passing.filter_map(|place| match place {
            Place::Var(var) if var.class == Class::Static => Some(*var),
            _ => None,
        }));
        let mut after: BTreeSet<Var> = needs.after_call(cut, index, id).into_iter().collect();
        after.extend(needs.universe().members(&through[index]));
        let of_level = |var: &Var| written.contains(var) && var.number < OF_NO_LEVEL;
        let lost: Vec<Var> = after.into_iter().filter(of_level).collect();
        if lost.is_empty() {
            continue;
        }
        if live.calls(index, call, index) {
            refuse(index, call, block.term.site.span, &lost, levels, context);
        } else {
            kept.entry(index).or_default().insert(id, lost);
        }
    }
    for (index, kept) in kept {
        save(index, &mut module.programs[index], &kept, opened);
    }
}

fn refuse(index: usize, call: &Call, span: Span, lost: &[Var], levels: &Levels, context: &mut Context<'_>) {
    let names: Vec<String> = lost.iter().map(|var| levels.name(*var)).collect();
    let again = if matches!(call.callee, crate::ir::Callee::Computed(_)) { "may call" } else { "calls" };
    let what = format!(
        "this {again} the program again before it has ended, and {} must outlive the call: the target has no local variables, and so one set of them for all levels",
        names.join(", ")
    );
    let help = "write the repetition as a loop, or keep the values in common variables of each level";
    context.add(index, Diagnostic::new(Code::OutOfRegisters, span, what).with_help(help));
}

/// Copies to temporaries before the arguments are set, and back after the call.
fn save(index: usize, program: &mut Program, kept: &BTreeMap<BlockId, Vec<Var>>, opened: &Opened) {
    let mut next = highest_temp(program);
    let places: BTreeMap<BlockId, (usize, Vec<(Var, Var)>)> = kept
        .iter()
        .map(|(id, vars)| {
            let pairs = vars.iter().map(|var| {
                next += 1;
                (*var, Var { class: Class::Temp, number: next })
            });
            let pairs: Vec<(Var, Var)> = pairs.collect();
            let passing = opened.get(&(index, *id)).copied().unwrap_or_default();
            let count = program.block(*id).map_or(0, |block| block.stmts.len());
            (*id, (count - passing.min(count), pairs))
        })
        .collect();
    let copy = |to: Var, from: Var| StmtKind::Assign { target: Place::Var(to), value: Expr::Var(from) };
    let mut at = (BlockId(0), 0);
    rebuild(program, &mut |builder, part| {
        if let Part::Start(id) = part {
            at = (id, 0);
            return;
        }
        let place = places.get(&at.0);
        if let Some((first, pairs)) = place
            && *first == at.1
        {
            pairs.iter().for_each(|(var, temp)| builder.push(copy(*temp, *var), SourceInfo::default()));
        }
        at.1 += 1;
        match (part, place) {
            (Part::Term(term), Some((_, pairs))) => {
                let TermKind::Call { call, next } = term.kind else { return Part::Term(term).keep(builder) };
                let back = builder.fresh();
                builder.end(TermKind::Call { call, next: back }, term.site);
                builder.start(back);
                pairs.iter().for_each(|(var, temp)| builder.push(copy(*var, *temp), SourceInfo::default()));
                builder.end(TermKind::Jump(next), SourceInfo::default());
            }
            (part, _) => part.keep(builder),
        }
    });
}
