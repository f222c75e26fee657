//! Programs that are run by themselves, and their heads.

use crate::canon::{Group, Op};
use crate::ir::analysis::ModalFacts;
use crate::ir::analysis::computed_calls::CalledPrograms;
use crate::ir::analysis::upward_exposed::roots;
use crate::ir::{BlockId, Class, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind, TermKind};
use crate::legalize::{Context, Modal, reachable};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The programs that end the run, but for those that others call and that may return to them. What only their
/// subroutines do, or what nothing reaches, says nothing of them.
pub(super) fn mains(module: &Module, called: &CalledPrograms) -> Vec<usize> {
    let roots: BTreeSet<usize> = uncalled(module, called).into_iter().collect();
    let is_main = |index: &usize| {
        let program = &module.programs[*index];
        let ends = |kind: &TermKind| matches!(kind, TermKind::End { .. } | TermKind::Stray);
        leaves_by(program, ends) && (roots.contains(index) || !returns(program))
    };
    (0..module.programs.len()).filter(is_main).collect()
}

/// True for one that may return to a caller.
pub(in crate::legalize) fn returns(program: &Program) -> bool {
    leaves_by(program, |kind| matches!(kind, TermKind::Return { .. }))
}

/// True where a program may end so, outside its subroutines.
pub(super) fn leaves_by(program: &Program, ends: impl Fn(&TermKind) -> bool) -> bool {
    if !program.blocks.iter().any(|block| ends(&block.term.kind)) {
        return false;
    }
    let own = reachable(program, BlockId(0));
    own.into_iter().filter_map(|id| program.block(id)).any(|block| ends(&block.term.kind))
}

/// The programs that no call runs, by name or surely by a computed number.
pub(super) fn uncalled(module: &Module, called: &CalledPrograms) -> Vec<usize> {
    roots(module).into_iter().filter(|root| !called.is_known(*root)).collect()
}

/// What is in force at every block where runs begin in what the source's machine begins in: G40, G49 and G80, and the codes
/// of its profile under `[start]`. Where a program may have callers that are not in the library, nothing of that is known.
pub(in crate::legalize) fn facts_from_reset(module: &Module, context: &Context<'_>) -> Arc<ModalFacts> {
    let called = context.called(module);
    if uncalled(module, &called).into_iter().any(|root| returns(&module.programs[root])) {
        return context.modal_facts(module);
    }
    facts_of_mains(module, context)
}

/// The same, of programs that do not return alone: no caller gives them what is in force.
pub(in crate::legalize) fn facts_of_mains(module: &Module, context: &Context<'_>) -> Arc<ModalFacts> {
    if context.entry != Modal::unknown() {
        return context.modal_facts(module);
    }
    let mut entry = context.entry.clone();
    [Op::RadiusOff, Op::LengthOff, Op::CycleOff].into_iter().for_each(|op| entry.start_in(op));
    let begun = context.source.start().iter().map(|mode| mode.op);
    begun
        .filter(|op| matches!(op.group(), Group::Distance | Group::Motion))
        .for_each(|op| entry.start_in(op));
    context.modal_facts_from(module, &entry)
}

/// Puts codes at the head of a program, after its comments.
pub(super) fn head(program: &mut Program, items: Vec<NcItem>) {
    if let Some(block) = program.blocks.first_mut() {
        let kind = StmtKind::Nc(Nc { items });
        let at = block
            .stmts
            .iter()
            .take_while(|stmt| matches!(stmt.kind, StmtKind::Comment | StmtKind::ClearAll(Class::Global)))
            .count();
        block.stmts.insert(at, Stmt { kind, site: SourceInfo::default() });
    }
}
