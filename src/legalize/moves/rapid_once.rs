//! A rapid move that leaves the interpolation in force alone.
//!
//! Law: such a block is a rapid move, after which the interpolation that was in force is said again. Side conditions:
//! it is known, and is straight (an arc code alone means another thing on each control), and no drilling cycle is in
//! force, which a rapid code would end.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::ir::{Module, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::{Context, replace_statements};

/// Replaces rapid moves of one block.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    if context.target.code_for(Op::RapidOnce, &Default::default()).is_some() {
        return;
    }
    let facts = context.modal_facts(module);
    replace_statements(module, &facts, |index, state, mut stmt, out| {
        let motion = state.op(Group::Motion).filter(|motion| matches!(motion, Op::Rapid | Op::Linear));
        let drills = state.op(Group::Cycle) != Some(Op::CycleOff);
        state.step(&stmt);
        let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        let StmtKind::Nc(nc) = &mut stmt.kind else {
            out.push(stmt);
            return;
        };
        let once = nc.has(Op::RapidOnce);
        if once {
            for item in &mut nc.items {
                if *item == NcItem::Op(Op::RapidOnce) {
                    *item = NcItem::Op(Op::Rapid);
                }
            }
        }
        out.push(stmt);
        match motion.filter(|_| !drills) {
            _ if !once => {}
            Some(Op::Rapid) => {}
            Some(motion) => {
                let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(motion)] });
                out.push(Stmt { kind, site });
            }
            None => {
                let what = "a rapid move for one block: the mode to go back to is not known; it must be a \
                            straight move without a drilling cycle";
                context.add(index, Diagnostic::new(Code::NoEquivalent, site.span, what));
            }
        }
    });
}
