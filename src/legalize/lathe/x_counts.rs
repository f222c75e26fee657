//! X of a lathe whose control is set to radii.
//!
//! Law: inside, X is a diameter everywhere; lowering doubles the words of a control that counts radii, and here those for a target that
//! counts them are halved. Side conditions: the words are numbers or values that are never vacant, and no program reads or writes a
//! place or an offset along X by a variable, which would count otherwise too. Counter-example: `#1=#5041` as the start of `G1 X[#1-2.]`.

use crate::canon::{Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine, Question};
use crate::ir::{Bank, BinOp, Expr, Module, NcItem, Place, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// The words that are diameters, or radii on such a control.
const WORDS: [Role; 3] = [Role::X, Role::StepX, Role::AllowanceX];

fn is_radius(control: &Control) -> bool {
    control.machine() == Machine::Lathe
        && control.behaviour(Question::XCounts).is_some_and(|row| row.value == "radius")
}

/// True where one of the two counts radii.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    is_radius(context.source) || is_radius(context.target)
}

/// Halves the words for a target that counts radii; true if there are any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let (from, to) = (is_radius(context.source), is_radius(context.target));
    let (mut changed, mut found) = (false, Vec::new());
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            for stmt in &mut block.stmts {
                if from != to && names_x(stmt) {
                    found.push((index, stmt.site.span, READ));
                }
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                for item in nc.items.iter_mut().filter(|_| to) {
                    let NcItem::Word(role, value) = item else { continue };
                    if !WORDS.contains(role) {
                        continue;
                    }
                    match half(value) {
                        Some(half) => *value = half,
                        None => found.push((index, stmt.site.span, VACANT)),
                    }
                    changed = true;
                }
            }
            let mut reads = false;
            block.term.kind.exprs(&mut |e| e.walk(&mut |e: &Expr| reads |= reads_x(e)));
            if from != to && reads {
                found.push((index, block.term.site.span, READ));
            }
        }
    }
    for (index, span, what) in found {
        let help = "write the number, or set both machines to diameters";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help));
    }
    changed
}

const READ: &str =
    "a place or an offset along X is read or written here, and one of the two machines counts radii";
const VACANT: &str = "X is computed from a variable that may be vacant, and the target counts radii";

/// Half of a value; none where a vacant one would become a number.
fn half(value: &Expr) -> Option<Expr> {
    match value {
        Expr::Number(number) => Some(Expr::Number(number / 2.0)),
        Expr::Increments(count) => Some(Expr::Increments(count / 2.0)),
        Expr::Negate(inner) if inner.may_be_vacant() => None,
        value if value.may_be_vacant() => None,
        value => Some(Expr::binary(BinOp::Div, value.clone(), Expr::Number(2.0))),
    }
}

/// True where a statement reads or writes state that has a length along X.
fn names_x(stmt: &Stmt) -> bool {
    let writes = match stmt.kind.target() {
        Some(Place::System(state, subscripts)) => is_along_x(*state, subscripts),
        Some(Place::Indirect(Bank::Numbered, _)) => true,
        _ => false,
    };
    let mut reads = false;
    stmt.kind.exprs(&mut |e| e.walk(&mut |e: &Expr| reads |= reads_x(e)));
    writes || reads
}

fn reads_x(e: &Expr) -> bool {
    match e {
        Expr::System(state, subscripts) => is_along_x(*state, subscripts),
        Expr::Indirect(Bank::Numbered, _) => true,
        _ => false,
    }
}

fn is_along_x(state: Sys, subscripts: &[Expr]) -> bool {
    let axis = subscripts.last().map(Expr::constant);
    let place = state.is_length() && !state.is_tool_offset();
    state == Sys::LatheX || place && axis.is_none_or(|axis| axis.is_none_or(|axis| axis == 1.0))
}
