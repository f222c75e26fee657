//! Tools that are made ready, on a machine whose tool word changes the tool.
//!
//! Law: the tool that a change puts into the spindle is the one named last, in its block or before it. So it is named at its change,
//! and a word that only makes a tool ready goes: it moves nothing, and there it would change the tool. A note says so. Side
//! conditions: the tool that waits is one constant on all ways to the change; nothing reads the last tool word while a tool waits.
//! Counter-example: `T2` under a block skip, then `M6`: which tool it is the switch decides, and the change is refused.

use super::tool_word::ADDRESS_T;
use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::analysis::dataflow::{Lattice, Same};
use crate::ir::analysis::over_calls::{Follow, OverCalls};
use crate::ir::analysis::tool_word::ToolWord;
use crate::ir::{Block, BlockId, Expr, Module, Nc, NcItem, Stmt, StmtKind};
use crate::legalize::Context;
use crate::text::Span;

/// True if a tool word of the target changes the tool and brings no length, and one of the source does not.
pub fn concerns(source: &Control, target: &Control) -> bool {
    let by_word =
        |control: &Control| control.behaviour(Question::ToolChangeWord).is_some_and(|row| row.value == "t");
    by_word(target) && !by_word(source) && !target.is(Question::ToolWordSelectsLength)
}

/// The tool that waits for its change, if it is one constant.
type Waits = Same<f64>;

fn step(waits: &mut Waits, stmt: &Stmt) {
    let StmtKind::Nc(nc) = &stmt.kind else { return };
    let before = *waits;
    if nc.has(Op::ToolChange) || nc.items.iter().any(|item| matches!(item, NcItem::Code('M', _))) {
        waits.0 = None;
    } else if let Some(tool) = nc.word(Role::Tool) {
        waits.0 = tool.constant();
    }
    if stmt.site.skip.is_some() {
        waits.join(&before);
    }
}

struct Rules;

impl Follow for Rules {
    type Known = Waits;

    fn outside(&self, _: usize) -> Waits {
        Same(None)
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Waits) {
        block.stmts.iter().for_each(|stmt| step(known, stmt));
    }

    fn lose(&self, known: &mut Waits) {
        known.0 = None;
    }
}

/// Names tools at their changes, and takes out the words that make one ready.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let names = |nc: &Nc| nc.has(Op::ToolChange) != nc.word(Role::Tool).is_some();
    let mut stmts = module.programs.iter().flat_map(|program| &program.blocks).flat_map(|block| &block.stmts);
    if !stmts.any(|stmt| stmt.kind.nc().is_some_and(names)) {
        return;
    }
    reads(module, context);
    let known = OverCalls::of(module, &Rules);
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (id, block) in program.ids().zip(&mut program.blocks) {
            let mut waits = known.at(index, id).copied().unwrap_or(Same(None));
            let mut gone = Vec::new();
            for (at, stmt) in block.stmts.iter_mut().enumerate() {
                let before = waits;
                step(&mut waits, stmt);
                let span = stmt.site.span;
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                match (nc.has(Op::ToolChange), nc.word(Role::Tool), before.0) {
                    (true, None, Some(tool)) => {
                        nc.items.push(NcItem::Word(Role::Tool, Expr::Number(tool)));
                    }
                    (true, None, None) => {
                        context.add_once(index, UNNAMED, Diagnostic::new(Code::NoEquivalent, span, UNNAMED));
                    }
                    (false, Some(_), _) => {
                        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::Tool, _)));
                        if nc.items.is_empty() {
                            stmt.kind = StmtKind::Comment;
                            let bare = stmt.site.comments.is_empty() && stmt.site.sequence.get().is_none();
                            gone.extend(bare.then_some(at));
                        }
                        context.add_once(index, READY, Diagnostic::new(Code::DoesNothing, span, READY));
                    }
                    _ => {}
                }
            }
            gone.into_iter().rev().for_each(|at| _ = block.stmts.remove(at));
        }
    }
}

/// Refuses what reads the last tool word while another tool may be in the spindle.
fn reads(module: &Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks) {
            let mut state = facts.at(index, id);
            let mut tell = |at: ToolWord, shown: bool, span: Span| {
                if shown && at != ToolWord::Changed {
                    context.add_once(index, READS, Diagnostic::new(Code::NoEquivalent, span, READS));
                }
            };
            for stmt in &block.stmts {
                let mut shown = false;
                stmt.kind.exprs(&mut |e| shown |= reads_word(e));
                tell(state.tool_word, shown, stmt.site.span);
                state.step(stmt);
            }
            let mut shown = false;
            block.term.kind.exprs(&mut |e| shown |= reads_word(e));
            tell(state.tool_word, shown, block.term.site.span);
        }
    }
}

/// True if the last tool word is read in an expression, or may be.
pub(in crate::legalize) fn reads_word(e: &Expr) -> bool {
    let mut found = false;
    let letter = f64::from(ADDRESS_T);
    e.walk(&mut |e| {
        found |= matches!(e, Expr::System(Sys::Address, subscripts)
            if subscripts.first().is_some_and(|first| first.constant().is_none_or(|at| at == letter)));
    });
    found
}

const READY: &str = "T alone only makes a tool ready here, and on the target it changes the tool: it is left out, and the tool is named where it is \
                     changed";

const UNNAMED: &str = "T changes the tool on the target, and which tool this changes to is not known here: write T with its number into the \
                       block of the change";

const READS: &str = "this reads the last tool word while another tool may be in the spindle: on the target the two are the same. Keep the number in a \
                     variable";
