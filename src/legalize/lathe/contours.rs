//! Contours: the blocks that a cycle of a lathe finds by the sequence numbers of the first and the last one.
//!
//! Law: a cycle reads the same contour if the same blocks stand between the two numbers, and each number stands once. Side condition: nothing
//! but moves and comments stands there, on one way. Counter-example: a label between them, where a jump may come in.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Module, Nc, Program, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;

/// True where cycles read contours.
pub fn concerns(features: &Features) -> bool {
    features.any_op(Op::reads_contour)
}

/// Checks that each contour that a cycle names is there, as a contour.
pub fn run(module: &Module, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter().enumerate() {
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            let StmtKind::Nc(nc) = &stmt.kind else { continue };
            if !nc.ops().any(Op::reads_contour) {
                continue;
            }
            if let Err(what) = check(program, nc) {
                context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
            }
        }
    }
}

fn check(program: &Program, nc: &Nc) -> Result<(), String> {
    let number = |role: Role| {
        let value = nc.word(role).and_then(|value| value.constant());
        value.filter(|value| *value > 0.0).map(|value| value as u32)
    };
    let (Some(first), Some(last)) = (number(Role::ContourFirst), number(Role::ContourLast)) else {
        return Err("the cycle does not say as numbers with which block its contour begins and ends".into());
    };
    let from = find(program, first)?;
    let to = find(program, last)?;
    if from.0 != to.0 {
        return Err(format!(
            "a jump can come in or go out between N{first} and N{last}: a contour goes straight through"
        ));
    }
    if from.1 > to.1 {
        return Err(format!("N{last}, the end of the contour, stands before N{first}, its beginning"));
    }
    let blocks =
        program.blocks.get(from.0).and_then(|block| block.stmts.get(from.1..=to.1)).unwrap_or_default();
    match blocks.iter().find(|stmt| !is_of_contour(stmt)) {
        Some(_) => Err(format!("something other than moves stands between N{first} and N{last}")),
        None => Ok(()),
    }
}

/// The only block and statement with a sequence number.
fn find(program: &Program, number: u32) -> Result<(usize, usize), String> {
    let mut all = program.blocks.iter().enumerate().flat_map(|(at, block)| {
        let with = block.stmts.iter().enumerate().filter(|(_, stmt)| stmt.site.sequence == Some(number));
        with.map(move |(place, _)| (at, place))
    });
    match (all.next(), all.next()) {
        (Some(place), None) => Ok(place),
        (None, _) => Err(format!("no block of this program has the number N{number}")),
        _ => Err(format!("N{number} stands more than once: which block the cycle takes is not sure")),
    }
}

fn is_of_contour(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Comment => true,
        StmtKind::Nc(nc) => !nc.ops().any(|op| {
            let mode = matches!(op.group(), Group::Distance | Group::Units | Group::Plane);
            mode || op.is_lathe_cycle() || op.is_lathe_setup() || op.is_pass()
        }),
        _ => false,
    }
}
