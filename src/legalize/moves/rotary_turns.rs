//! Turns of a rotary axis that are too long for one block of the target.
//!
//! Law: an axis that turns in increments by more degrees than a block of the target takes turns by as many equal parts as it needs,
//! in a row. Side conditions: the words are numbers; the axis turns alone, or beside others in a straight feed, whose ways are cut
//! into the same parts; no block is one of a cycle, an arc, an inverse-time feed or a repeat, or has an M code, which would act
//! between the parts. Anything else is refused.
//! Counter-example: `G91 G0 A1500. X20.`, where no source says that a rapid move is straight.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::Modal;
use crate::ir::{Expr, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, replace_statements};

/// The limit of the table: degrees of one block.
const ROW: &str = "rotary.turn";

/// Digits that words of degrees and lengths keep.
const DIGITS: f64 = 1e4;

/// More parts than these nobody means.
const MOST_PARTS: f64 = 1000.0;

const ROTARY: [Role; 3] = [Role::A, Role::B, Role::C];

/// True if a block of the target turns so far at the most, and the library turns a rotary axis.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.target.limit(ROW).is_some() && ROTARY.iter().any(|role| features.role(*role))
}

/// Cuts turns.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let Some(most) = context.target.limit(ROW).map(f64::from) else { return };
    let facts = context.modal_facts(module);
    replace_statements(module, &facts, |index, state, stmt, out| {
        state.step(&stmt);
        let long = stmt.kind.nc().map_or(0.0, longest);
        if long <= most {
            return out.push(stmt);
        }
        match parts(&stmt, state, (long / most).ceil()) {
            Some(made) => out.extend(made),
            None => {
                let title = &context.target.dialect().title;
                let what = format!(
                    "a rotary axis turns by {long} degrees here, and a block of the {title} turns by {most} at the most"
                );
                let help = "write it as several blocks under G91, without other axes";
                let found = Diagnostic::new(Code::NoEquivalent, stmt.site.span, what).with_help(help);
                context.add(index, found);
                out.push(stmt);
            }
        }
    });
}

/// The largest number of a word of a rotary axis.
fn longest(nc: &Nc) -> f64 {
    let words = ROTARY.iter().filter_map(|role| nc.word(*role)?.constant());
    words.fold(0.0, |most, turn| f64::max(most, turn.abs()))
}

/// The turn in so many parts; none if it cannot be cut.
fn parts(stmt: &Stmt, state: &Modal, count: f64) -> Option<Vec<Stmt>> {
    let nc = stmt.kind.nc()?;
    let is_axis = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
    let axes: Vec<(Role, f64)> = nc
        .items
        .iter()
        .filter_map(|item| match item {
            NcItem::Word(role, value) if role.is_axis() => Some(value.constant().map(|value| (*role, value))),
            _ => None,
        })
        .collect::<Option<_>>()?;
    let motion = state.op(Group::Motion);
    let straight = motion == Some(Op::Linear) || motion == Some(Op::Rapid) && axes.len() == 1;
    let plain = nc.ops().all(|op| matches!(op.group(), Group::Motion | Group::Distance | Group::FeedMode))
        && state.op(Group::Distance) == Some(Op::Incremental)
        && state.op(Group::Cycle).is_none_or(|op| op == Op::CycleOff)
        && state.op(Group::FeedMode) != Some(Op::FeedInverse)
        && nc.word(Role::Repeat).is_none()
        && nc.moves()
        && !state.may_call();
    if !straight || !plain || count > MOST_PARTS {
        return None;
    }
    let at = |value: f64, part: f64| (value * part / count * DIGITS).round() / DIGITS;
    let mut made = Vec::new();
    for part in 1..=count as u32 {
        let (before, here) = (f64::from(part - 1), f64::from(part));
        let way = |value: f64| ((at(value, here) - at(value, before)) * DIGITS).round() / DIGITS;
        let first = part == 1;
        let mut items: Vec<NcItem> =
            nc.items.iter().filter(|item| first && !is_axis(item)).cloned().collect();
        items.extend(axes.iter().map(|(role, value)| NcItem::Word(*role, Expr::Number(way(*value)))));
        let aside = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        let site = if first { stmt.site.clone() } else { aside };
        made.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
    }
    Some(made)
}
