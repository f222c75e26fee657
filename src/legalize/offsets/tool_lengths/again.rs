//! A tool change that is left out where its tool is in the spindle.
//!
//! Law: where a word of the tool in the spindle brings its length and changes nothing, `IF tool EQ n` past the change to tool
//! n is the change alone. Side conditions: the next block takes up or ends a length, so that the source counts the same
//! length on both ways; no tool waits for its change, where the last T is what is compared.
//! Counter-example: `T2`, then `IF [#4120 EQ 2]` past `M6 T2`, with another tool in the spindle.

use crate::canon::{Group, Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Question, Settled};
use crate::ir::analysis::ModalFacts;
use crate::ir::analysis::tool_word::ToolWord;
use crate::ir::{BlockId, Cond, Expr, Module, Nc, NcItem, Program, Relation, TermKind};
use crate::legalize::Context;
use crate::legalize::offsets::tool_word::{ADDRESS_T, ends_waiting};

/// Makes such changes plain ones.
pub(super) fn run(module: &mut Module, facts: &ModalFacts, context: &mut Context<'_>) {
    let found: Vec<(usize, BlockId, BlockId, bool)> = module
        .programs
        .iter()
        .enumerate()
        .flat_map(|(index, program)| {
            let ids = program.ids();
            ids.filter_map(move |id| passed(program, id).map(|(to, called)| (index, id, to, called)))
        })
        .collect();
    if found.is_empty() {
        return;
    }
    let waits = ends_waiting(module, facts);
    let title = &context.target.dialect().title;
    let what = format!(
        "the last T is compared, and {title} tells the tool in the spindle: when the program starts, the two must be the same tool"
    );
    for (index, id, to, called) in found {
        let Some(block) = module.programs.get_mut(index).and_then(|p| p.blocks.get_mut(id.0 as usize)) else {
            continue;
        };
        let mut state = facts.at(index, id);
        block.stmts.iter().for_each(|stmt| state.step(stmt));
        match state.tool_word {
            ToolWord::Waits if called => continue,
            begun @ (ToolWord::Begun | ToolWord::Unknown) if called => {
                let told = Diagnostic::new(Code::Conditional, block.term.site.span, what.clone());
                let told = if begun == ToolWord::Begun && !waits { told.asked_once() } else { told };
                context.add_once(index, &format!("{what} {begun:?}"), told);
            }
            _ => {}
        }
        block.term.kind = TermKind::Jump(to);
    }
}

/// With what the target's profile may say, where nobody knows what a word of the tool in the spindle does: one that changes
/// nothing brings the length at any place.
pub(super) fn asked(finding: Diagnostic, context: &Context<'_>) -> Diagnostic {
    let question = Question::ToolWordAgain;
    if context.target.behaviour(question).is_none_or(|row| row.origin.is_confirmed()) {
        return finding;
    }
    let Settled::Setting { section: "settings", name, .. } = context.target.settled_by(question.fact())
    else {
        return finding;
    };
    let help = format!(
        "if a tool word changes nothing there while its tool is in the spindle, write {name} = \"skipped\" under [settings] in the \
         target's profile. Else change to the tool again where its length is taken up"
    );
    finding.with_help(help).lacking_there(format!("setting.{name}=skipped"))
}

/// The block of a change that a comparison of its tool leaves out, and whether the last T is what is compared.
fn passed(program: &Program, id: BlockId) -> Option<(BlockId, bool)> {
    let block = |id: BlockId| program.blocks.get(id.0 as usize);
    let TermKind::Branch { cond, then, otherwise } = &block(id)?.term.kind else { return None };
    let Cond::Compare(relation, Expr::System(sys, subs), tool) = &**cond else { return None };
    let called = match (sys, subs.first().and_then(Expr::constant)) {
        (Sys::ActiveTool, _) => false,
        (Sys::Address, Some(letter)) if letter == f64::from(ADDRESS_T) => true,
        _ => return None,
    };
    let (past, change) = match relation {
        Relation::Equal => (*then, *otherwise),
        Relation::NotEqual => (*otherwise, *then),
        _ => return None,
    };
    let tool = tool.constant().filter(|tool| *tool >= 1.0 && tool.fract() == 0.0)?;
    let changes = block(change)?;
    let [stmt] = changes.stmts.as_slice() else { return None };
    let plain = |nc: &Nc| {
        let own = |item: &NcItem| {
            matches!(item, NcItem::Op(Op::ToolChange) | NcItem::Word(Role::Tool, Expr::Number(_)))
        };
        nc.has(Op::ToolChange)
            && nc.items.iter().all(own)
            && nc.word(Role::Tool).and_then(Expr::constant) == Some(tool)
    };
    let next = block(past)?.stmts.first()?;
    let takes = |nc: &Nc| {
        let says = nc.ops().any(|op| op.group() == Group::LengthComp) && !nc.has(Op::LengthMinus);
        (says && nc.has(Op::LengthOff))
            || nc.word(Role::LengthOffset).is_some_and(|row| row.constant().is_some())
    };
    let unskipped = stmt.site.skip.is_none() && next.site.skip.is_none();
    let fits = unskipped && stmt.kind.nc().is_some_and(plain) && next.kind.nc().is_some_and(takes);
    (fits && matches!(changes.term.kind, TermKind::Jump(to) if to == past)).then_some((change, called))
}
