//! Programs of a lathe for a mill, and of a mill for a lathe.
//!
//! Law: an axis word goes where it went only if both machines take it for the same. A lathe takes X for a diameter,
//! and U, V and W for increments of X, Y and Z; on a mill U, V and W are axes of their own. So nothing that names an
//! axis is converted from one to the other. Counter-example: `G1 W-.25`, which no other code would show.
//! Nor is any other block of such a program: what its tools and speeds are for is not done there. One finding says so, and
//! an alarm stands for the blocks, which a draft shows. What only computes, asks or tells stays.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Machine;
use crate::ir::{Module, Nc, NcItem, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::legalize::lathe::settings::Kind;

const TURNS: &str = "it cannot turn";
const DIAMETERS: &str = "it takes X for a diameter";

fn why(context: &Context<'_>) -> &'static str {
    match context.source.machine() {
        Machine::Lathe => TURNS,
        Machine::Mill => DIAMETERS,
    }
}

/// What else was found in a program that is for another kind of machine asks for nothing: it is refused as a whole. Only that its
/// codes are those of another system stays, as the kind may rest on it.
pub fn drop_others(diagnostics: &mut Vec<Diagnostic>) {
    let whole = |found: &Diagnostic| {
        found.code == Code::NoEquivalent && [TURNS, DIAMETERS].iter().any(|why| found.message.ends_with(why))
    };
    if diagnostics.iter().any(whole) {
        diagnostics.retain(|found| whole(found) || found.code == Code::CodeSystem);
    }
}

/// True where the two machines are of different kinds.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    context.source.machine() != context.target.machine()
}

/// Refuses programs that name an axis, or what only one kind of machine does, between a lathe and a mill: each with one
/// finding, at its head.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let (from, to) = (context.source.machine().name(), context.target.machine().name());
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let mut stmts = program.blocks.iter().flat_map(|block| &block.stmts);
        if stmts.any(|stmt| stmt.kind.nc().is_some_and(is_of_one_kind)) {
            let what = format!("the program is for a {from}, and the target is a {to}: {}", why(context));
            context.add(index, Diagnostic::new(Code::NoEquivalent, program.site.span, what));
            stop_at_blocks(program);
            changed = true;
        }
    }
    changed
}

/// True of a block that is another one on the other kind of machine.
fn is_of_one_kind(nc: &Nc) -> bool {
    let is = |item: &NcItem| match item {
        NcItem::Word(role, _) => role.is_axis() || *role == Role::Turret,
        NcItem::Op(op) => {
            let turns = matches!(op, Op::Finish | Op::SurfaceSpeed | Op::FeedPerTurn | Op::LimitSpeed);
            turns || Kind::of_cycle(*op).or(Kind::of_setup(*op)).is_some()
        }
        NcItem::Code(..) => false,
    };
    nc.items.iter().any(is)
}

/// Puts one alarm in the place of all NC blocks that stand together.
fn stop_at_blocks(program: &mut Program) {
    for block in &mut program.blocks {
        let mut stopped = false;
        block.stmts.retain_mut(|stmt| {
            if stmt.kind.nc().is_none() {
                stopped &= matches!(stmt.kind, StmtKind::Comment);
                return true;
            }
            if std::mem::replace(&mut stopped, true) {
                stmt.kind = StmtKind::Comment;
                return !stmt.site.comments.is_empty();
            }
            let site = std::mem::take(&mut stmt.site);
            *stmt = Stmt { kind: StmtKind::not_converted(Code::NoEquivalent.number()), site };
            true
        });
    }
}
