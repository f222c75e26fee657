//! Parts of a program that call each other deeper than the target takes.
//!
//! Law: a call of a part of the same program runs its blocks up to a return and goes on after the call; the same blocks
//! in the place of the call, with a jump to after it for each return, do the same. So calls in parts that stand at the
//! deepest level which the target takes are written out, the innermost first, and nothing is left that nests deeper.
//! Parts that nothing calls any more go. Side conditions: no part calls itself, and the program does not grow beyond
//! what a reader can follow. Counter-example: ten macros that each call the next one twice.

use crate::ir::analysis::reachable;
use crate::ir::{BlockId, Builder, Callee, Program, SourceInfo, Stmt, TermKind, Terminator};
use crate::legalize::rewrite::{Part, rebuild};
use std::collections::{BTreeMap, BTreeSet};

/// Most blocks of a program after calls are written out.
const MOST: usize = 2_000;

/// Writes calls out until none nests deeper than `most`; false where the program would grow too large. Parts stand
/// after the first `own` blocks.
pub fn run(program: &mut Program, most: u32, own: usize) -> bool {
    let most = most.max(1);
    let mut changed = false;
    loop {
        let parts = parts(program);
        let depths = depths(&parts);
        // The innermost first: what is written out calls nothing itself.
        let innermost = |part: &BlockId| {
            depths.get(part).is_some_and(|depth| *depth >= most)
                && parts.get(part).is_some_and(|calls| {
                    !calls.is_empty()
                        && calls.iter().all(|callee| parts.get(callee).is_none_or(BTreeSet::is_empty))
                })
        };
        let Some(part) = parts.keys().find(|part| innermost(part)).copied() else { break };
        if program.blocks.len() > MOST {
            return false;
        }
        let within = reachable(program, part);
        write_out(program, &within);
        changed = true;
    }
    if changed {
        let used = parts(program).keys().flat_map(|part| reachable(program, *part)).collect();
        drop_others(program, &used, own);
    }
    true
}

/// What each part calls: the main part, and all that is called.
fn parts(program: &Program) -> BTreeMap<BlockId, BTreeSet<BlockId>> {
    let mut parts: BTreeMap<BlockId, BTreeSet<BlockId>> = BTreeMap::new();
    let mut open = vec![BlockId(0)];
    while let Some(part) = open.pop() {
        if parts.contains_key(&part) {
            continue;
        }
        let blocks = reachable(program, part);
        let calls: BTreeSet<BlockId> =
            blocks.into_iter().filter_map(|id| callee(&program.block(id)?.term.kind)).collect();
        open.extend(&calls);
        parts.insert(part, calls);
    }
    parts
}

fn callee(kind: &TermKind) -> Option<BlockId> {
    match kind {
        TermKind::Call { call, .. } => match call.callee {
            Callee::Block(entry) => Some(entry),
            _ => None,
        },
        _ => None,
    }
}

/// How many calls are open at most in each part; parts that call themselves have no depth.
fn depths(parts: &BTreeMap<BlockId, BTreeSet<BlockId>>) -> BTreeMap<BlockId, u32> {
    let mut depths = BTreeMap::from([(BlockId(0), 0)]);
    // No chain of calls is longer than there are parts.
    for _ in 0..parts.len() {
        let mut changed = false;
        for (part, calls) in parts {
            let Some(depth) = depths.get(part).copied() else { continue };
            for callee in calls {
                let deeper = depths.get(callee).is_none_or(|known| *known <= depth);
                if deeper {
                    depths.insert(*callee, depth + 1);
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
    }
    depths
}

/// Writes out all calls in these blocks.
fn write_out(program: &mut Program, within: &BTreeSet<BlockId>) {
    let before = program.clone();
    let mut here = BlockId(0);
    rebuild(program, &mut |builder, part| match part {
        Part::Start(id) => here = id,
        Part::Term(Terminator { kind: TermKind::Call { call, next }, site }) if within.contains(&here) => {
            match call.callee {
                Callee::Block(entry) => body(builder, &before, entry, next, site),
                _ => builder.end(TermKind::Call { call, next }, site),
            }
        }
        other => other.keep(builder),
    });
}

/// Lays the blocks of a part down, which goes on at `next` where it returned.
fn body(builder: &mut Builder, program: &Program, entry: BlockId, next: BlockId, site: SourceInfo) {
    let blocks = reachable(program, entry);
    let ids: BTreeMap<BlockId, BlockId> = blocks.iter().map(|id| (*id, builder.fresh())).collect();
    let Some(first) = ids.get(&entry).copied() else { return };
    builder.end(TermKind::Jump(first), site);
    for (id, copy) in &ids {
        let Some(block) = program.block(*id) else { continue };
        builder.start(*copy);
        for Stmt { kind, site } in block.stmts.iter().cloned() {
            builder.push(kind, SourceInfo { sequence: None.into(), ..site });
        }
        let Terminator { mut kind, site } = block.term.clone();
        match &mut kind {
            TermKind::Return { to: None } => kind = TermKind::Jump(next),
            kind => {
                let callee = callee(kind);
                kind.for_each_target(&mut |to| *to = ids.get(to).copied().unwrap_or(*to));
                if let (TermKind::Call { call, .. }, Some(entry)) = (kind, callee) {
                    call.callee = Callee::Block(entry);
                }
            }
        }
        builder.end(kind, SourceInfo { sequence: None.into(), ..site });
    }
}

/// Drops the parts that nothing runs any more.
fn drop_others(program: &mut Program, used: &BTreeSet<BlockId>, own: usize) {
    let mut place: Vec<Option<BlockId>> = Vec::with_capacity(program.blocks.len());
    let mut count = 0;
    for id in program.ids() {
        let stays = id.index() < own || used.contains(&id);
        place.push(stays.then_some(BlockId(count)));
        count += u32::from(stays);
    }
    let mut at = 0;
    program.blocks.retain(|_| {
        at += 1;
        place[at - 1].is_some()
    });
    for block in &mut program.blocks {
        block.term.kind.for_each_target(&mut |to| {
            if let Some(Some(moved)) = place.get(to.index()) {
                *to = *moved;
            }
        });
    }
}
