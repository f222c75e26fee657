//! Inputs and outputs that the target shows the other way round.
//!
//! Laws: an input that reads 1 when it is on is one less what reads 0 when it is on; an output that any number but 0
//! switches on is switched alike by whether the number is 0, where 0 switches it on. Side condition, for a reviewer: the number
//! of the signal means the same wire on both machines, which their profiles say (`[[signal]]`). Where a number is computed the
//! target must have all of its signals in one run. Counter-example: `#1100=2.` and `O(1)=1-2`, which lets the output float.

use crate::canon::Sys;
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{BinOp, Cond, Expr, Place, Program, Relation, StmtKind};
use crate::legalize::{Context, rewrite_program};
use crate::text::Span;

/// A state, and the one that is its opposite.
const OPPOSITES: [(Sys, Sys); 4] = [
    (Sys::Input, Sys::InputInverted),
    (Sys::InputInverted, Sys::Input),
    (Sys::Output, Sys::OutputInverted),
    (Sys::OutputInverted, Sys::Output),
];

/// Reads and writes signals as the target shows them; true if there are any.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let mut missing: Vec<(Span, Sys, Option<u32>)> = Vec::new();
    let shows = |e: &Expr| matches!(e, Expr::System(state, _) if is_signal(*state));
    let mut any = rewrite_program(program, shows, &mut |e, _, rewriter| {
        let Expr::System(state, subscripts) = e else { return e };
        let there = held(state, &subscripts, target);
        missing.extend(there.err().map(|number| (rewriter.span, state, number)));
        match there {
            Ok(other) if other != state => {
                Expr::binary(BinOp::Sub, Expr::Number(1.0), Expr::System(other, subscripts))
            }
            _ => Expr::System(state, subscripts),
        }
    });
    if any {
        turned_back(program);
    }
    for stmt in program.blocks.iter_mut().flat_map(|block| &mut block.stmts) {
        let StmtKind::Assign { target: Place::System(state, subscripts), value } = &mut stmt.kind else {
            continue;
        };
        if !is_signal(*state) {
            continue;
        }
        any = true;
        match held(*state, subscripts, target) {
            Ok(other) if other != *state => {
                *state = other;
                *value = is_zero(std::mem::replace(value, Expr::Vacant));
            }
            Ok(_) => {}
            Err(number) => missing.push((stmt.site.span, *state, number)),
        }
    }
    for (span, state, number) in missing {
        report(index, span, state, number, context);
    }
    any
}

/// Makes an input of one less what is one less it: it reads 0 or 1. An output may hold another number.
fn turned_back(program: &mut Program) {
    let mut turn = |e: &mut Expr| {
        e.walk_mut(&mut |part| {
            if let Some(input) = one_less(part).and_then(one_less)
                && matches!(input, Expr::System(Sys::Input | Sys::InputInverted, _))
            {
                *part = input.clone();
            }
        });
    };
    for block in &mut program.blocks {
        block.stmts.iter_mut().for_each(|stmt| stmt.kind.exprs_mut(&mut turn));
        block.term.kind.exprs_mut(&mut turn);
    }
}

/// What an expression takes from one.
fn one_less(e: &Expr) -> Option<&Expr> {
    match e {
        Expr::Binary(BinOp::Sub, operands) if operands[0].constant() == Some(1.0) => Some(&operands[1]),
        _ => None,
    }
}

/// True for the state of an input or output.
pub(in crate::legalize) fn is_signal(state: Sys) -> bool {
    opposite(state).is_some()
}

fn opposite(state: Sys) -> Option<Sys> {
    OPPOSITES.iter().find(|(own, _)| *own == state).map(|(_, other)| *other)
}

/// The state by which the target shows a signal; else the number that it has none for, and none of a computed one.
fn held(state: Sys, subscripts: &[Expr], target: &Control) -> Result<Sys, Option<u32>> {
    let states = [Some(state), opposite(state)].into_iter().flatten();
    let numbers: Option<Vec<u32>> =
        subscripts.iter().map(|s| s.constant().and_then(crate::ir::eval::whole)).collect();
    match numbers {
        Some(numbers) => {
            let has = |state: &Sys| target.system_address(*state, &numbers).is_some();
            states.into_iter().find(has).ok_or(numbers.first().copied())
        }
        None => {
            let runs = |state: Sys| target.system_runs(state).count();
            let mut having = states.filter(|state| runs(*state) > 0);
            match (having.next(), having.next()) {
                (Some(state), None) if runs(state) == 1 => Ok(state),
                _ => Err(None),
            }
        }
    }
}

/// 1 where a value is 0, else 0.
fn is_zero(value: Expr) -> Expr {
    match value.constant() {
        Some(number) => Expr::Number(f64::from(u8::from(number == 0.0))),
        None => {
            let value = match value {
                Expr::Vacant => return Expr::Number(1.0),
                value if value.may_be_vacant() => Expr::binary(BinOp::Add, value, Expr::Number(0.0)),
                value => value,
            };
            Expr::Truth(Box::new(Cond::Compare(Relation::Equal, value, Expr::Number(0.0))))
        }
    }
}

fn report(index: usize, span: Span, state: Sys, number: Option<u32>, context: &mut Context<'_>) {
    let title = &context.target.dialect().title;
    let kind = if matches!(state, Sys::Input | Sys::InputInverted) { "input" } else { "output" };
    let what = match number {
        Some(number) => format!("{title} has no {kind} {number}"),
        None => format!("the number of an {kind} is computed, and {title} does not count its {kind}s so"),
    };
    let named = number.map_or("NUMBER".into(), |number| number.to_string());
    let mut shown = [state].into_iter().chain(opposite(state));
    let counts = shown.any(|state| context.target.system_run(state).is_some());
    let help = match (counts, kind) {
        (true, _) => format!(
            "say in the target's profile which of its {kind}s is wired for it: [[signal]] with {kind} = 1 and \
             number = {named}"
        ),
        (false, "output") => format!(
            "if codes of the machine's builder switch it, name both in the target's profile: [[site]] with \
             op = \"output.on\" or \"output.off\", and fixed = {{ \"output.bit\" = {named} }}"
        ),
        (false, _) => {
            format!("no source says that a program of {title} can read an {kind}: write this by hand")
        }
    };
    let mut told = Diagnostic::new(Code::NoEquivalent, span, what.clone()).with_help(help);
    if let Some(number) = number.filter(|_| counts) {
        told = told.asking_for(Asks::Signal { input: kind == "input", number });
    }
    context.add_once(index, &what, told);
}
