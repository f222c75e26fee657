//! What the words of a block that sets a cycle mean, where they are computed or stand in the wrong place.
//!
//! Law: the form of a thread is the number that its variable holds. Side condition: one number reaches the block on all ways, and a person
//! looks at it, because whoever assigns another one has to convert again. Counter-example: a variable that a call leaves.

use super::super::cycle_values::constant;
use super::super::setting_values::{Found, So};
use super::super::settings::{Kind, row, takes};
use super::super::threads::has_angle;
use super::Values;
use crate::canon::{Op, Role};
use crate::dialect::Control;
use crate::ir::analysis::{Assigned, Constant, Summaries};
use crate::ir::{BlockId, Expr, Nc, NcItem, Program, Stmt, StmtKind, Var};

/// Puts the numbers of computed forms in their place.
pub(super) fn settle(program: &mut Program, summaries: &Summaries, found: &mut Found) {
    for (id, at, var) in computed(program) {
        let held = Assigned::new(program, summaries).at(var, id, at);
        let Some([Constant::Number(form)]) = held.as_deref() else { continue };
        let form = *form;
        let Some(stmt) = program.blocks.get_mut(id.0 as usize).and_then(|block| block.stmts.get_mut(at))
        else {
            continue;
        };
        let span = stmt.site.span;
        let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
        for item in &mut nc.items {
            if let NcItem::Word(Role::ThreadForm, value) = item {
                *value = Expr::Number(form);
            }
        }
        found.push((span, format!("{HELD}{form:06}"), HELD_HELP.into(), So::Open));
    }
}

/// Where a block sets the form of threads by a variable.
fn computed(program: &Program) -> Vec<(BlockId, usize, Var)> {
    let of_stmt = |stmt: &Stmt| match stmt.kind.nc()?.word(Role::ThreadForm)? {
        Expr::Var(var) => Some(*var),
        _ => None,
    };
    let blocks = program.ids().zip(&program.blocks);
    blocks
        .flat_map(|(id, block)| {
            let stmts = block.stmts.iter().enumerate();
            stmts.filter_map(move |(at, stmt)| Some((id, at, of_stmt(stmt)?)))
        })
        .collect()
}

/// What is wrong with a thread that the source does not cut: nothing is left for its passes, or it has another angle than threads have.
pub(super) fn no_pass(nc: &Nc, values: &Values, source: &Control) -> Option<(String, String)> {
    let angle = constant(values, Role::ThreadAngle).unwrap_or(0.0);
    if !has_angle(source, angle) {
        let what = format!(
            "{angle} degrees is no angle of a thread on the source: the control stops here with an alarm"
        );
        return Some((what, ANGLE_HELP.into()));
    }
    let height = nc.word(Role::ThreadHeight)?.constant()?;
    let left = constant(values, Role::ThreadAllowance)?;
    (height > 0.0 && left >= height).then(|| {
        let what = format!(
            "this thread is {height} high, and {left} of it are to be left for its last pass: nothing is left for the \
             passes before, and the control stops here with an alarm"
        );
        (what, NO_PASS_HELP.into())
    })
}

/// What is said of a move in the block that sets a cycle: the letter may be that of the other cycle.
pub(super) fn beside(kind: &Kind, rest: &[NcItem], source: &Control) -> (String, &'static str) {
    let other = match kind.setup {
        Op::FacingSetup => [Role::X, Role::StepX],
        _ => [Role::Z, Role::StepZ],
    };
    let is_other = |item: &NcItem| matches!(item, NcItem::Word(role, _) if other.contains(role));
    let letter = row(source, kind.setup).and_then(|row| {
        row.words.iter().find(|(_, role)| **role == Role::CutDepth).map(|(letter, _)| letter)
    });
    match (letter, row(source, kind.setup)) {
        (Some(letter), Some(code))
            if takes(source, kind.setup, Role::CutDepth) && rest.iter().any(is_other) =>
        {
            (
                format!(
                    "the depth of a pass is {letter} in the first block of {}, and this block has the word of the other \
                     axis: no source says what the control does with it",
                    code.code
                ),
                "write the depth with that letter",
            )
        }
        _ => (MOVES.into(), "give the move a block of its own"),
    }
}

const HELD: &str =
    "finishing passes, run-out and angle of a thread are those of the number that its variable holds here: ";
const HELD_HELP: &str =
    "convert the program again if the variable is given another number; or write the number itself";
const ANGLE_HELP: &str = "write the angle of the thread as the last two digits of P in the first block";
const NO_PASS_HELP: &str =
    "write what is left as a radius, with a decimal point: a number without one may count whole millimetres";
const MOVES: &str =
    "a move in the block that sets what the next cycle takes: no source says what the control does with it";
