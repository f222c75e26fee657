//! Locals of call levels as registers that all programs see, for a target without locals.
//!
//! Law: a local of a program becomes a static of its own, and so does the same local of every program that shares its
//! level: those that are called without a level of their own, as far as they name it. A call that opens a level sets the
//! statics of the callee to the arguments, as far as it reads them, and to 0 what else it may read before it sets it; a
//! program that a run begins with sets those of its own, and one that returns though nothing calls it finds them where
//! whoever calls it from outside sets them. What a call may write that its caller needs afterwards (a
//! routine that is called with a level and shares locals with its caller in another way) is kept in temporaries over the
//! call.
//!
//! Side condition: no program is called again before it ends, if anything of its level must outlive that call; each
//! level would need registers of its own. Counter-example: a macro that calls itself and counts down in #1.
//! What is vacant has flags by now ([`crate::legalize::variables::vacancy_flags`]).

mod apart;
mod calls;
mod levels;
pub(in crate::legalize) mod repeats;

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::statics;
use crate::ir::analysis::upward_exposed::{UpwardExposed, roots};
use crate::ir::{
    Bank, Block, BlockId, Callee, Class, Expr, Module, Place, Program, SourceInfo, Stmt, StmtKind, TermKind,
    Terminator, Var, flag_of,
};
use crate::legalize::calls::merged;
use crate::legalize::features::{Feature, Features};
use crate::legalize::registers::interface::Interface;
use crate::legalize::registers::names::OF;
use crate::legalize::registers::needs::has_locals;
use crate::legalize::rewrite::put_first;
use crate::legalize::{Context, Position, Rewriter, calls_of, rewrite_program};
use crate::syntax::ProgramName;
use levels::Levels;
use std::collections::BTreeSet;
use thin_vec::ThinVec;

/// True if programs have variables or give arguments, and the target no locals.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    (features.has(Feature::Variable) || features.has(Feature::Call)) && !has_locals(context.target)
}

/// Turns all locals into statics.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    refuse_computed(module, context);
    let kept = repeats::kept(module, context.source);
    module.programs.iter_mut().for_each(|program| repeats::loops(program, |call| call.level));
    let levels = Levels::of(module, context.source);
    let mut interface = Interface::default();
    for (index, program) in module.programs.iter_mut().enumerate() {
        program.held = held(index, program, &levels, context.source);
        rename(index, program, &levels);
    }
    apart::give(module, context.source, &mut interface);
    let cut = calls::cut(module);
    let exposed = UpwardExposed::among(&cut, statics(module));
    repeats::refuse(kept, module, (&levels, &exposed), context);
    let opened = calls::pass(module, &levels, &exposed);
    calls::keep(module, &cut, &opened, &levels, context);
    for index in roots(module) {
        let vars: Vec<Var> =
            exposed.at_entry(index).into_iter().filter(|var| levels.has(index, *var)).collect();
        begin(index, &mut module.programs[index], &vars, &levels, (&mut interface, context));
    }
    context.taken = module.programs.iter().enumerate().filter_map(|(at, p)| taken(at, p, &exposed)).collect();
    apart::rename(module, &interface);
    context.interface = interface;
    if !context.target.is(Question::Vacancy) {
        module.programs.iter_mut().for_each(plain);
    }
}

/// What people call the statics that a program names: its locals, and those of what it gives arguments to.
fn held(index: usize, program: &Program, levels: &Levels, source: &Control) -> Vec<(Var, String)> {
    let mut held = levels.held(index, source);
    let mut known: BTreeSet<Var> = held.iter().map(|(var, _)| *var).collect();
    for call in program.blocks.iter().flat_map(calls_of).filter(|call| call.level) {
        let Callee::Program(name) = &call.callee else { continue };
        for callee in levels.callees(index, call) {
            let locals = levels.held(callee, source).into_iter();
            held.extend(
                locals
                    .filter(|(var, _)| known.insert(*var))
                    .map(|(var, local)| (var, format!("{local} of {}", name.short()))),
            );
        }
    }
    held
}

/// What a program calls those of its own locals that it reads before it sets them.
fn taken(
    index: usize,
    program: &Program,
    exposed: &UpwardExposed,
) -> Option<(ProgramName, BTreeSet<String>)> {
    let is_taken = exposed.at_entry_of(index);
    let flag = flag_of("");
    let is_own = |name: &str| !name.strip_prefix(&flag).unwrap_or(name).contains(OF);
    let own = program.held.iter().filter(|(var, name)| is_taken(*var) && is_own(name));
    Some((program.name.clone()?, own.map(|(_, name)| name.clone()).collect()))
}

/// A computed number cannot find what a local became.
fn refuse_computed(module: &Module, context: &mut Context<'_>) {
    let mut numbers = context.reached.sure.clone();
    numbers.join(&context.reached.everything(context.source, context.target));
    if !(1..=33).any(|local| numbers.contains(local)) {
        return;
    }
    for (index, program) in module.programs.iter().enumerate() {
        let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        let computed = stmts.filter(|stmt| {
            let mut found = matches!(stmt.kind.target(), Some(Place::Indirect(Bank::Numbered, _)));
            stmt.kind.exprs(&mut |e| {
                e.walk(&mut |e| found |= matches!(e, Expr::Indirect(Bank::Numbered, _)));
            });
            found
        });
        for stmt in computed {
            let what = "a computed number may be that of a local variable, and the target has no locals: what stands for them has other numbers";
            let help = "use common variables for what is reached by computed numbers";
            context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help));
        }
    }
}

fn rename(index: usize, program: &mut Program, levels: &Levels) {
    apart::each_var(program, &|var| {
        if var.class == Class::Local {
            *var = levels.of_local(index, var.number);
        }
    });
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        if let StmtKind::Assign { target: Place::Var(var), value } = &mut stmt.kind
            && var.class == Class::Static
            && *value == Expr::Vacant
        {
            *value = Expr::Number(0.0);
        }
    }
}

/// What a program that a run begins with sets to 0 first.
fn begin(
    index: usize,
    program: &mut Program,
    vars: &[Var],
    levels: &Levels,
    (interface, context): (&mut Interface, &mut Context<'_>),
) {
    if vars.is_empty() {
        return;
    }
    if program.returns() {
        let own = (levels, context.source);
        // Where calls reach no farther than the file, nobody outside can call it.
        if !merged::concerns(context.target)
            && apart::take(index, vars, own, program.name.as_ref(), interface)
        {
            return;
        }
        let names: Vec<String> = vars.iter().map(|var| levels.name(*var)).collect();
        let what = format!(
            "{} is read before it is set, and nothing in the library calls this program: on a target without local variables, neither what a caller gives nor what the run before left can be found",
            names.join(", ")
        );
        let help = "convert it together with the programs that call it; or set the variable first";
        context.add(index, Diagnostic::new(Code::NoEquivalent, program.site.span, what).with_help(help));
        return;
    }
    let zero = |var: &Var| Stmt {
        kind: StmtKind::Assign { target: Place::Var(*var), value: Expr::Number(0.0) },
        site: SourceInfo::default(),
    };
    let term = Terminator { kind: TermKind::Jump(BlockId(1)), site: SourceInfo::default() };
    let block = Block { labels: ThinVec::new(), stmts: vars.iter().map(zero).collect(), term };
    put_first(program, vec![block]);
}

/// Nothing is vacant on the target: a sum with 0 is what is added to, and what is made vacant is 0.
fn plain(program: &mut Program) {
    let sum = |e: &Expr| matches!(e, Expr::Binary(crate::ir::BinOp::Add, _));
    rewrite_program(program, sum, &mut |e, _: Position, _: &mut Rewriter<'_>| match e {
        Expr::Binary(crate::ir::BinOp::Add, operands) => match *operands {
            [value, Expr::Number(0.0)] | [Expr::Number(0.0), value] => value,
            [a, b] => Expr::binary(crate::ir::BinOp::Add, a, b),
        },
        other => other,
    });
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        if let StmtKind::Assign { target: Place::Var(_), value: value @ Expr::Vacant } = &mut stmt.kind {
            *value = Expr::Number(0.0);
        }
    }
}
