//! Where the tool of a lathe stands where ways of a program meet: as far as all of them agree.

use super::place::Place;
use crate::ir::analysis::entries;
use crate::ir::{BlockId, Callee, Module, Program, TermKind};

/// True where a program may be gone on in at any of its sequence numbers, from outside.
pub fn may_be_entered(module: &Module) -> bool {
    let enters = |term: &TermKind| match term {
        TermKind::Return { to } => to.is_some(),
        TermKind::Call { call, .. } => matches!(call.callee, Callee::Computed(_)),
        _ => false,
    };
    module.programs.iter().flat_map(|program| &program.blocks).any(|block| enters(&block.term.kind))
}

/// For each block, what all ways to it agree in; `begin` is what is known where a run or a call begins, and everywhere where runs may come in
/// from outside at any number.
pub fn at_blocks(program: &Program, begin: Place, is_entered: bool) -> Vec<Place> {
    if is_entered {
        return vec![begin; program.blocks.len()];
    }
    let mut known: Vec<Option<Place>> = vec![None; program.blocks.len()];
    let mut open = Vec::new();
    for entry in entries(program).chain([BlockId(0)]) {
        come(&mut known, &mut open, entry, begin);
    }
    // What is known of a block only gets less, so this ends.
    while let Some(at) = open.pop() {
        let Some((block, Some(mut place))) =
            program.blocks.get(at.index()).zip(known.get(at.index()).copied())
        else {
            continue;
        };
        for stmt in &block.stmts {
            place.enter(stmt);
            place.step(stmt);
        }
        if matches!(block.term.kind, TermKind::Call { .. }) {
            place.forget();
        }
        for to in block.term.kind.successors() {
            come(&mut known, &mut open, to, place);
        }
    }
    known.into_iter().map(|place| place.unwrap_or(begin)).collect()
}

/// Takes another way to a block, which is looked at again if less is known of it now.
fn come(known: &mut [Option<Place>], open: &mut Vec<BlockId>, to: BlockId, place: Place) {
    let Some(there) = known.get_mut(to.index()) else { return };
    let met = there.map_or(place, |there| there.met(&place));
    if there.replace(met) != Some(met) {
        open.push(to);
    }
}
