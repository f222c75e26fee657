//! Threads an inch, where the target takes the lead alone.
//!
//! Law: the lead is an inch, in the unit in force, by their count. Side condition: the unit is known. Error bound: half of the sixth decimal of the lead.
//! Counter-example: `G32 Z-20. E10.` in a program that is called in inches and in millimetres.

use super::settings::takes;
use crate::canon::{Op, Role};
use crate::dialect::Units;
use crate::ir::{BinOp, Block, Expr, Module, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::moves::increments::{Counted, Texts, each};

const TEXTS: Texts = Texts {
    unknown: "the lead of a thread is told by threads an inch (E), and the target takes it as a length, whose unit is not known here",
    guessed: "the lead of a thread is told by threads an inch (E), and is written in the unit that the program names: a called program outside the library \
              must not change it",
};

/// True where threads an inch stand, and the target has no word for them.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.role(Role::ThreadsPerInch) && !takes(context.target, Op::Thread, Role::ThreadsPerInch)
}

/// Writes the lead.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let told = |item: &NcItem| matches!(item, NcItem::Word(Role::ThreadsPerInch, _));
    let chosen = |block: &Block| {
        block.stmts.iter().filter_map(|stmt| stmt.kind.nc()).any(|nc| nc.items.iter().any(told))
    };
    each(module, context, Some(TEXTS), chosen, &mut |kind, units| match kind {
        Counted::Stmt(StmtKind::Nc(nc)) => nc.items.iter_mut().all(|item| lead(item, units)),
        _ => true,
    })
}

/// Makes the lead of a count; false where that is not known.
fn lead(item: &mut NcItem, units: Option<Units>) -> bool {
    let NcItem::Word(role, value) = item else { return true };
    if *role != Role::ThreadsPerInch {
        return true;
    }
    let inch = match units {
        Some(Units::Inch) => 1.0,
        Some(Units::Metric) => 25.4,
        None => return false,
    };
    let count = std::mem::replace(value, Expr::Vacant);
    *value = match count.constant() {
        Some(count) if count > 0.0 => Expr::Number((inch / count * 1e6).round() / 1e6),
        _ => Expr::Binary(BinOp::Div, Box::new([Expr::Number(inch), count])),
    };
    *role = Role::Lead;
    true
}
