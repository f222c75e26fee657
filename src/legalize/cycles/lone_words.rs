//! Words of a drilling cycle in a block that drills nothing.
//!
//! Law: where the source leaves such words out, they go. Where both controls keep them for the holes to come they stay, and where
//! nobody says it of one of them the program is refused: such a block is a slip. Side condition: the block has no place and no plane of the cycle, which make a hole or the data of
//! one. Counter-example: `X2. P2000`, whose hole waits.

use super::cycle_words::ROLES;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Module, Nc, NcItem, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True if there are such words, and the source's table asks what they do.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    context.source.behaviour(Question::CycleWordsAlone).is_some()
        && ROLES.iter().any(|role| features.role(*role))
}

/// Leaves out what the source does, and says what rests on the controls; true where something went.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let facts = context.modal_facts(module);
    let ignored = answer(context.source) == Some("ignored");
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            for stmt in &mut block.stmts {
                state.step(stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                if !is_alone(nc, &state, context.source) {
                    continue;
                }
                if ignored {
                    nc.items.retain(|item| !is_of_cycle(item));
                    if nc.items.is_empty() {
                        stmt.kind = StmtKind::Comment;
                    }
                    changed = true;
                    continue;
                }
                let known = |control: &Control| {
                    control.behaviour(Question::CycleWordsAlone).is_none() || answer(control).is_some()
                };
                if known(context.source) && known(context.target) {
                    context.must_agree(index, span, Question::CycleWordsAlone);
                } else {
                    context.add(index, Diagnostic::new(Code::NoEquivalent, span, ALONE));
                }
            }
        }
    }
    changed
}

/// What a control is known to do with them.
fn answer(control: &Control) -> Option<&str> {
    let row = control
        .behaviour(Question::CycleWordsAlone)
        .filter(|row| row.origin.is_settled() && row.value != "unknown")?;
    Some(&row.value)
}

/// True for words of a cycle that drill nothing; `after` is what is in force after the block.
fn is_alone(nc: &Nc, after: &Modal, source: &Control) -> bool {
    let begins = nc.ops().any(Op::is_cycle);
    let drills = nc.names_axis()
        || nc.word(Role::CycleR).is_some()
        || nc.word(Role::Repeat).is_some()
        || nc.has(Op::CycleHere)
        || begins && source.is(source.of_wordless_cycles());
    let under = begins || after.op(Group::Cycle).is_some_and(Op::is_cycle);
    under && !drills && nc.items.iter().any(is_of_cycle)
}

fn is_of_cycle(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, _) if ROLES.contains(role))
}

const ALONE: &str = "words of a drilling cycle in a block that drills nothing: nobody says whether they count for the next holes. Write \
     them in the block of the next hole, or say cycle.words.alone in both machine profiles";
