//! Moves in the motion mode of the caller, where the library says which that is.
//!
//! Law: lowering tells of a program that moves before it names a motion mode, as it sees that program alone. Where every caller
//! is in the library, and each leaves a straight mode in force, nothing is open. Counter-example: one call after `G2`, or a
//! program that the operator may start.

use crate::canon::{Group, Op};
use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{Modal, ModalFacts};
use crate::ir::{BlockId, Module};
use crate::lower::common::CALLERS_MODE;

/// Drops what was told of programs that begin in a straight motion mode, whoever calls them.
pub(super) fn settle(found: &mut [Vec<Diagnostic>], module: &Module, entry: &Modal) {
    let tells =
        |finding: &Diagnostic| finding.code == Code::ModalAssumed && *finding.message == *CALLERS_MODE;
    if !found.iter().flatten().any(tells) {
        return;
    }
    let facts = ModalFacts::of(module, entry);
    for (index, all) in found.iter_mut().enumerate() {
        let begins = facts.at(index, BlockId(0)).op(Group::Motion);
        if matches!(begins, Some(Op::Rapid | Op::Linear)) {
            all.retain(|finding| !tells(finding));
        }
    }
}
