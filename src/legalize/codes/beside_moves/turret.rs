//! A builder's code beside T and a move, which acts before the turret turns or when it has turned.
//!
//! Law: what stands in a block of its own acts when that block comes. Where the code acts when the turret has turned, T stands first, then the
//! code, then the move. Side condition: T without a move turns the turret and moves nothing. Where the source does not say it, the code goes before
//! T, and a person looks at it. Counter-example: `G0 X40. M44 S6000 T0101` with a live tool in the old station.

use super::kind;
use crate::canon::{Auxiliary, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side, turret_parts};
use crate::ir::{Nc, NcItem, Stmt, StmtKind};
use crate::legalize::Context;

const FACT: Question = Question::MOtherBesideTurret;

/// Puts T of a block before the builder's codes that go before its move, or says that these act before the turret turns.
pub(super) fn ordered(
    early: &mut Vec<Vec<NcItem>>,
    stmt: &mut Stmt,
    index: usize,
    context: &mut Context<'_>,
) {
    if !before_turret(early, stmt) {
        return;
    }
    match answer(context.source) {
        "before" => {}
        "after" => turret_first(early, stmt),
        _ => {
            let help = format!("{TURRET_HELP}; or {}", context.source.to_settle(FACT.fact(), Side::Source));
            let finding = Diagnostic::new(Code::Conditional, stmt.site.span, BEFORE_TURRET);
            context.add_once(index, BEFORE_TURRET, finding.with_help(help).with_fact(FACT.fact()));
        }
    }
}

/// True where a builder's code goes before a block that turns the turret.
fn before_turret(early: &[Vec<NcItem>], stmt: &Stmt) -> bool {
    stmt.kind.nc().is_some_and(turns) && early.iter().flatten().any(is_builders)
}

/// True for a block that turns the turret.
pub(super) fn turns(nc: &Nc) -> bool {
    let word = nc.word(Role::Turret);
    word.is_some_and(|word| word.constant().is_none_or(|word| turret_parts(word).0 != 0.0))
}

fn is_builders(item: &NcItem) -> bool {
    kind(item, false) == Some(Auxiliary::Other)
}

/// What a control says of a builder's code beside T and a move.
pub(super) fn answer(control: &Control) -> &str {
    control.behaviour(FACT).map_or("unknown", |row| row.value.as_str())
}

/// Puts T before the builder's codes, in a block of its own.
fn turret_first(early: &mut Vec<Vec<NcItem>>, stmt: &mut Stmt) {
    let StmtKind::Nc(nc) = &mut stmt.kind else { return };
    let is_turret =
        |item: &NcItem| matches!(item, NcItem::Word(Role::Turret, _) | NcItem::Op(Op::TurretIndex));
    let (turret, kept) = std::mem::take(&mut nc.items).into_iter().partition(is_turret);
    nc.items = kept;
    let (codes, mut all): (Vec<_>, Vec<_>) =
        std::mem::take(early).into_iter().partition(|items| items.iter().any(is_builders));
    all.push(turret);
    all.extend(codes);
    *early = all;
}

const BEFORE_TURRET: &str = "a code of the builder stands beside a move and a T word that turns the turret, and goes before them: if it starts a live tool, \
                             the one of the old station turns while the turret turns";
const TURRET_HELP: &str =
    "write T into a block of its own before this one; then the turret has turned when the code acts";
