//! ROUND inside a word, where it rounds to the least increment and the target's does not.
//!
//! Law: with n increments in a unit, `ROUND[a]` in a word is `ROUND[a * n] / n` outside one. Side condition: the unit in force
//! is known, as for [numbers without a point](super::increments). Within the last digit of a half the product may go the
//! other way. Counter-example: `X[ROUND[#1]]` before the program names its unit, with 1.23456: 1.235 or 1.2346.

use crate::canon::{Func, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Numbers, Question, Units};
use crate::ir::{BinOp, Block, Expr, Module, NcItem, Program, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};
use crate::legalize::moves::increments::{Counted, Texts, each};
use crate::text::Span;

/// True if there are functions, and ROUND in a word of the target is not to the least increment.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let row = context.target.behaviour(Question::RoundInAddress);
    features.has(Feature::Function) && row.is_none_or(|row| row.value != "increment")
}

const TEXTS: Texts = Texts {
    unknown: "ROUND in a word rounds to the least increment, and its size depends on the unit in force, which is not \
              known here",
    guessed: "ROUND in a word is taken in the unit that the program names: a called program outside the library must \
              not change it",
};

const NEAR: &str = "ROUND in a word, by arithmetic: a half within the last digit may go the other way";

/// Writes ROUND in words as arithmetic.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let numbers = context.source.numbers();
    let first: Vec<Option<Span>> = module.programs.iter().map(first_round).collect();
    let changed = each(module, context, Some(TEXTS), rounds, &mut |counted, units| match counted {
        Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| match item {
            NcItem::Word(role, value) => word(value, *role, units, numbers),
            _ => true,
        }),
        _ => true,
    });
    for (index, span) in first.into_iter().enumerate() {
        let finding = span.map(|span| Diagnostic::new(Code::NearlyEqual, span, NEAR));
        finding.into_iter().for_each(|finding| context.add_once(index, NEAR, finding));
    }
    changed
}

/// True where a block has ROUND in a word.
fn rounds(block: &Block) -> bool {
    block.stmts.iter().any(|stmt| has_round(&stmt.kind))
}

fn has_round(kind: &StmtKind) -> bool {
    let mut any = false;
    kind.exprs(&mut |e| any |= is_rounded(e));
    any
}

fn is_rounded(e: &Expr) -> bool {
    let mut any = false;
    e.walk(&mut |e| any |= matches!(e, Expr::Call(Func::RoundIncrement, _)));
    any
}

fn first_round(program: &Program) -> Option<Span> {
    let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    stmts.find(|stmt| has_round(&stmt.kind)).map(|stmt| stmt.site.span)
}

/// Rewrites ROUND in the value of a word; false where the unit that it needs is not known. A word that is neither a length
/// nor an angle keeps it.
fn word(value: &mut Expr, role: Role, units: Option<Units>, numbers: &Numbers) -> bool {
    let step = match units {
        _ if !is_rounded(value) => return true,
        _ if role.is_angle() => numbers.increment_degrees,
        _ if !role.is_length() => return true,
        Some(Units::Metric) => numbers.increment_mm,
        Some(Units::Inch) => numbers.increment_inch,
        None => return false,
    };
    let many = Expr::Number((1.0 / step).round());
    value.walk_mut(&mut |e| {
        if let Expr::Call(function @ Func::RoundIncrement, operands) = e
            && let Some(inner) = operands.pop()
        {
            *function = Func::Round;
            operands.push(Expr::binary(BinOp::Mul, inner, many.clone()));
            let rounded = std::mem::replace(e, Expr::Vacant);
            *e = Expr::binary(BinOp::Div, rounded, many.clone());
        }
    });
    true
}
