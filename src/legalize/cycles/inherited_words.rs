//! Words of a drilling cycle in a program whose callers have the cycle in force.
//!
//! Law: I, J, K and R without a code are what the code in force takes them for. Lowering reads a program alone, and takes them for
//! words of an arc where no code of the program says what is in force: where all callers have one drilling cycle in force, they are
//! the words of its code; where their cycles differ, those that all cycles of the source take alike. Side condition: a cycle is in
//! force on every way. Counter-example: `X10. K3` in a program that `G81` and `M98` come to, which makes three holes.

use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Control};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, StmtKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use std::collections::BTreeMap;

const ARC: [Role; 4] = [Role::ArcI, Role::ArcJ, Role::ArcK, Role::ArcRadius];

const TOLD: &str =
    "the callers of this program have a drilling cycle in force: this word is one of the cycle's";

/// True if the library calls programs, drills, and has words of arcs.
pub fn concerns(features: &Features, _: &Context<'_>) -> bool {
    features.any_op(Op::is_cycle) && ARC.iter().any(|role| features.role(*role))
}

/// Gives such words the role that they have beside the code of the cycle; true where one got it.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                state.step(stmt);
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if state.drills() != Some(true) || has_code(nc) {
                    continue;
                }
                let rows = rows(state.op(Group::Cycle), context.source);
                if !take(nc, &rows, context.source) {
                    continue;
                }
                changed = true;
                context.add_once(index, TOLD, Diagnostic::new(Code::Conditional, stmt.site.span, TOLD));
            }
        }
    }
    changed
}

/// True for a block whose own code says what its words are.
fn has_code(nc: &Nc) -> bool {
    nc.ops().any(|op| matches!(op.group(), Group::Motion | Group::Cycle))
}

/// The rows of the cycle in force: of all cycles, where it is one or another.
fn rows(cycle: Option<Op>, source: &Control) -> Vec<&CodeMeaning> {
    match cycle {
        Some(cycle) => source.code_for(cycle, &BTreeMap::new()).into_iter().collect(),
        None => source.dialect().codes.iter().filter(|row| row.op.is_cycle()).collect(),
    }
}

/// The role that a letter has beside each of these codes; none if they differ, or if one does not take it.
fn common_role(letter: char, rows: &[&CodeMeaning]) -> Option<Role> {
    let letter = letter.to_string();
    let mut roles = rows.iter().map(|row| row.words.get(letter.as_str()));
    let first = *roles.next()??;
    roles.all(|role| role == Some(&first)).then_some(first)
}

/// Takes words of arcs for those of a cycle; true where one was.
fn take(nc: &mut Nc, rows: &[&CodeMeaning], source: &Control) -> bool {
    let mut taken = false;
    for item in &mut nc.items {
        let NcItem::Word(role, value) = item else { continue };
        let letter = source.letter(*role, None).filter(|(_, comma)| !comma && ARC.contains(role));
        let Some(own) = letter.and_then(|(letter, _)| common_role(letter, rows)) else { continue };
        *role = own;
        // A count is a whole number, whatever a length without a point counts.
        if let (Role::Repeat, Expr::Increments(count)) = (own, &*value) {
            *value = Expr::Number(*count);
        }
        taken = true;
    }
    taken
}
