//! Tool changes for which no tool was named since the last one.
//!
//! Nothing is changed. One control takes the tool that is in the spindle again; another, with an arm, the one that waits, which is the tool that
//! the last change put back; a third stops. Where both are known to do the same nothing is said, where they differ the program is refused,
//! and where it is not known it is for review. Side conditions: no caller has named a tool; a program that returns and that nothing of
//! the library calls is taken to have one named. Counter-example: `T2`, `M6`, where tool 2 waits.

use super::shop::are_mills;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question, Side};
use crate::ir::Module;
use crate::ir::analysis::tool_word::ToolWord;
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::text::Span;

const QUESTION: Question = Question::ChangeWithoutTool;

/// True if the library changes tools, between two mills that do it by a code.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let by_code = |control: &Control| {
        let row = control.behaviour(Question::ToolChangeWord);
        row.is_some_and(|row| row.value == "m6") && control.behaviour(QUESTION).is_some()
    };
    are_mills(context) && features.op(Op::ToolChange) && by_code(context.source) && by_code(context.target)
}

/// Says where programs rest on it.
pub fn run(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            for stmt in &block.stmts {
                let nc = stmt.kind.nc();
                let bare = nc.is_some_and(|nc| nc.has(Op::ToolChange) && nc.word(Role::Tool).is_none());
                let none = match state.tool_word {
                    ToolWord::Changed => true,
                    ToolWord::Begun => !program.returns(),
                    ToolWord::Unknown | ToolWord::Waits => false,
                };
                if bare && none {
                    told(index, stmt.site.span, context);
                }
                state.step(stmt);
            }
        }
    }
}

/// Says what a change without a tool rests on.
fn told(index: usize, span: Span, context: &mut Context<'_>) {
    let answer = |control: &Control| control.behaviour(QUESTION).map(|row| row.value.clone());
    let (ours, theirs) = (answer(context.source), answer(context.target));
    let (ours, theirs) = (ours.as_deref().unwrap_or("unknown"), theirs.as_deref().unwrap_or("unknown"));
    let open = match (ours, theirs) {
        ("alarm", _) => return,
        ("unknown", _) => Some((context.source, Side::Source)),
        (_, "unknown") => Some((context.target, Side::Target)),
        _ if ours == theirs => return,
        _ => None,
    };
    let finding = match open {
        Some((control, side)) => Diagnostic::new(Code::Conditional, span, OPEN)
            .with_help(format!(
                "write T with its number into the block; or {}",
                control.to_settle(QUESTION.fact(), side)
            ))
            .with_fact(QUESTION.fact()),
        None => {
            let what = format!("{DIFFER}: {} on the source, {} on the target", does(ours), does(theirs));
            Diagnostic::new(Code::NoEquivalent, span, what)
                .with_help("write T with its number into the block")
        }
    };
    context.add_once(index, OPEN, finding);
}

/// What an answer says, in words.
fn does(answer: &str) -> &'static str {
    match answer {
        "same" => "it takes the tool that is in the spindle",
        "pot" => "it takes the tool that the last change put back",
        _ => "it is an alarm",
    }
}

const OPEN: &str = "a tool is changed here, and no T was named since the last change: what that does is not known of one of the two \
                    machines";

const DIFFER: &str = "a tool is changed here, and no T was named since the last change";
