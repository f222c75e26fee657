//! Drilling cycles that the target does not end by itself.
//!
//! Law: where a motion code ends a cycle on the source and not on the target, the cycle is ended in a block of its own
//! before the motion; so it is before the end of a program. A target may end it by straight motion and not by an arc: then it
//! is ended before arcs alone. Where no cycle is in force nothing is added; a program that
//! drills may find one in force at its start, though its own holes became moves. Side condition: none is in force at a tool
//! change, which such a control takes for a fault: after it the source may drill on, and the target would have to be told
//! the whole cycle again. Counter-example: `G81 X1. Z-5. R2. F100.`, `M6`, `X2.`

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::Context;
use crate::legalize::features::{Feature, Features};

/// True if the library has cycles, or codes that may be one, and the target does not end them by all motion.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let may_drill = features.any_op(|op| op.is_cycle() || op.is_hole())
        || features.has(Feature::Code)
        || context.chained
        || context.drills;
    let ends = Ends::of(context);
    may_drill && (ends.motion || features.any_op(|op| ends.are_before(op)))
}

/// Before what the cycles in force are to be ended.
#[derive(Clone, Copy)]
struct Ends {
    /// Before every motion code.
    motion: bool,
    /// Before arcs.
    arcs: bool,
}

impl Ends {
    fn of(context: &Context<'_>) -> Self {
        let [ours, theirs] =
            [context.source, context.target].map(|control| is_sure(control, Question::CycleEndsByMotion));
        // Here an arc ends a cycle, whatever the source was: where it is not known to, `cycle-arcs` refuses it.
        Self { motion: ours && !theirs, arcs: theirs && !is_sure(context.target, Question::CycleEndsByArc) }
    }

    /// True for a motion before which cycles are to be ended.
    fn are_before(self, op: Op) -> bool {
        op.group() == Group::Motion && op != Op::RapidOnce && (self.motion || self.arcs && op.is_arc())
    }
}

/// True if the control is sure to end a cycle so; a table that is silent says so.
fn is_sure(control: &Control, question: Question) -> bool {
    let row = control.behaviour(question);
    row.is_none_or(|row| row.value == "true" && row.origin.is_settled())
}

/// Ends cycles before what would go on drilling.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let facts = context.modal_facts(module);
    let ends = Ends::of(context);
    for (index, program) in module.programs.iter_mut().enumerate() {
        for (at, block) in program.blocks.iter_mut().enumerate() {
            let mut state = facts.at(index, BlockId(at as u32));
            let mut out = Stmts::with_capacity(block.stmts.len());
            for stmt in std::mem::take(&mut block.stmts) {
                let drills = state.op(Group::Cycle) != Some(Op::CycleOff);
                let known = state.op(Group::Cycle).is_some();
                state.step(&stmt);
                if let StmtKind::Nc(nc) = &stmt.kind
                    && drills
                {
                    if ends.motion && nc.has(Op::ToolChange) && known && !nc.has(Op::CycleOff) {
                        let what = "a drilling cycle is in force at this tool change, which the target takes for a \
                                    fault: end it before, with G80";
                        context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, what));
                    }
                    if is_motion(nc, ends) || ends.motion && !known && turns(nc) {
                        let end = end(&stmt.site);
                        state.step(&end);
                        out.push(end);
                    }
                }
                out.push(stmt);
            }
            if ends.motion
                && matches!(block.term.kind, TermKind::End { .. })
                && state.op(Group::Cycle).is_some_and(|op| op != Op::CycleOff)
            {
                out.push(end(&block.term.site));
            }
            block.stmts = out;
        }
    }
}

/// True for a block that names a motion before which cycles are to be ended, and ends none itself.
fn is_motion(nc: &Nc, before: Ends) -> bool {
    let ends = |op: Op| op.is_cycle() || op.is_hole() || op == Op::CycleOff;
    nc.ops().any(|op| before.are_before(op)) && !nc.ops().any(ends)
}

/// True for a rotation with its centre: under a cycle that a program finds in force, its words would be a hole.
fn turns(nc: &Nc) -> bool {
    nc.ops().any(|op| op.group() == Group::Rotation) && nc.names_axis()
}

/// The end of the cycle in force, in a block of its own.
fn end(site: &SourceInfo) -> Stmt {
    let site = SourceInfo { span: site.span, skip: site.skip, ..SourceInfo::default() };
    Stmt { kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::CycleOff)] }), site }
}
