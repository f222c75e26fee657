//! Subroutines inside a program, where the target wants them: after the program's end, or, where it
//! calls programs only, as programs of their own.
//!
//! A subroutine at the head of its program, jumped over, is moved after the end; the order of blocks
//! means nothing but to the reader.
//!
//! Law: what a call of a block runs is what is reachable from it; a program
//! made of copies of those blocks does the same and returns to the same place.
//! Side condition: blocks that the main part reaches as well are copied, so an
//! operator who edits one must edit both; the copies carry the same comments. Remarks above a subroutine go with it.

use crate::dialect::Question;
use crate::ir::{
    Block, BlockId, Callee, Comment, Module, Program, SourceInfo, StmtKind, Stmts, TermKind, Terminator,
};
use crate::legalize::{Context, calls_of, reachable};
use crate::syntax::{Label, ProgramName};
use std::collections::{BTreeMap, BTreeSet};
use thin_vec::ThinVec;

/// Gives each called block a program of its own, or its place after the program's end.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    // A program that is called may not have any: no program is told apart by that, so none has.
    if context.target.statement("call.local").is_some() && context.target.is(Question::SubsInCalled) {
        module.programs.iter_mut().for_each(move_behind);
        return;
    }
    let mut out = Vec::with_capacity(module.programs.len());
    let mut origins = Vec::with_capacity(module.programs.len());
    for (index, program) in std::mem::take(&mut module.programs).into_iter().enumerate() {
        outline(program, &mut out);
        origins.resize(out.len(), context.origins[index]);
    }
    module.programs = out;
    context.origins = origins;
}

/// The blocks that are called.
fn entries(program: &Program) -> BTreeSet<BlockId> {
    let calls = program.blocks.iter().flat_map(calls_of);
    let blocks = calls.filter_map(|call| match call.callee {
        Callee::Block(entry) => Some(entry),
        _ => None,
    });
    blocks.collect()
}

/// Moves the subroutines that a program begins with after its end.
fn move_behind(program: &mut Program) {
    let Some(TermKind::Jump(start)) = program.blocks.first().map(|block| &block.term.kind) else { return };
    let (start, all) = (start.index(), program.blocks.len());
    let main = reachable(program, BlockId(0));
    let called: BTreeSet<BlockId> =
        entries(program).iter().flat_map(|&entry| reachable(program, entry)).collect();
    let only_called = |at| !main.contains(&BlockId(at)) && called.contains(&BlockId(at));
    if !(2..all).contains(&start) || !(1..start as u32).all(only_called) {
        return;
    }
    let moved = start - 1;
    program.blocks[1..].rotate_left(moved);
    let place = |id: &mut BlockId| match id.index() {
        0 => {}
        at if at < start => *id = BlockId((at + all - start) as u32),
        at => *id = BlockId((at - moved) as u32),
    };
    for block in &mut program.blocks {
        for_each_jump(&mut block.term.kind, &mut |to| place(to));
        for_each_callee(block, &mut |callee| {
            if let Callee::Block(entry) = callee {
                place(entry);
            }
        });
    }
}

/// Appends the program and, after it, the programs made of its subroutines.
fn outline(mut program: Program, out: &mut Vec<Program>) {
    let entries = entries(&program);
    if entries.is_empty() {
        out.push(program);
        return;
    }
    let names: BTreeMap<BlockId, ProgramName> =
        entries.iter().map(|&entry| (entry, sub_name(&program, entry))).collect();
    let main = reachable(&program, BlockId(0));
    let (mut outlined, mut headed) = (BTreeSet::new(), BTreeSet::new());
    let mut subs = Vec::new();
    for (&entry, name) in &names {
        let body = reachable(&program, entry);
        outlined.extend(body.iter().copied());
        let site = SourceInfo { comments: called(&program, entry), ..SourceInfo::default() };
        let remarks = remarks_above(&program, entry, &main);
        headed.extend(remarks.iter().copied());
        let mut sub = extract(&program, entry, &body, Some(name.clone()), site);
        head(&mut sub, remarks.iter().filter_map(|id| program.block(*id)));
        subs.push(sub);
    }
    // What nothing reaches stays, and with it what that could jump to.
    let strays =
        program.ids().filter(|id| !main.contains(id) && !outlined.contains(id) && !headed.contains(id));
    let strays = strays.filter(|id| program.block(*id).is_some_and(says_something));
    let strays: BTreeSet<BlockId> = strays.flat_map(|id| reachable(&program, id)).collect();
    let keep = &main | &strays;
    let (name, site) = (program.name.take(), std::mem::take(&mut program.site));
    let mut all = vec![extract(&program, BlockId(0), &keep, name, site)];
    all.extend(subs);
    for program in &mut all {
        program.blocks.iter_mut().for_each(|block| rename_calls(block, &names));
    }
    out.extend(all);
}

/// The blocks of remarks alone that stand above a subroutine, which no run comes to: people wrote them about it.
fn remarks_above(program: &Program, entry: BlockId, reached: &BTreeSet<BlockId>) -> Vec<BlockId> {
    let mut above = Vec::new();
    let mut next = entry;
    while let Some(id) = next.0.checked_sub(1).map(BlockId) {
        let goes_on = |block: &Block| block.term.kind == TermKind::Jump(next) && block.labels.is_empty();
        let remarks = |block: &Block| block.stmts.iter().all(|stmt| stmt.kind == StmtKind::Comment);
        let plain = program.block(id).is_some_and(|block| goes_on(block) && remarks(block));
        if !plain || reached.contains(&id) {
            break;
        }
        above.push(id);
        next = id;
    }
    above.reverse();
    above
}

/// Puts remarks before the first block.
fn head<'b>(program: &mut Program, above: impl Iterator<Item = &'b Block>) {
    let stmts = above.flat_map(|block| &block.stmts).filter(|stmt| !stmt.site.comments.is_empty());
    let stmts: Stmts = stmts.cloned().collect();
    if stmts.is_empty() {
        return;
    }
    for block in &mut program.blocks {
        for_each_jump(&mut block.term.kind, &mut |to| to.0 += 1);
    }
    let term = Terminator { kind: TermKind::Jump(BlockId(1)), site: SourceInfo::default() };
    program.blocks.insert(0, Block { labels: ThinVec::new(), stmts, term });
}

/// False for an empty line that a run would pass by.
fn says_something(block: &Block) -> bool {
    let silent = |site: &SourceInfo| site.sequence.is_none() && site.comments.is_empty();
    let passes = matches!(block.term.kind, TermKind::Jump(_)) && block.term.site == SourceInfo::default();
    let mut stmts = block.stmts.iter();
    !(passes
        && block.labels.is_empty()
        && stmts.all(|stmt| stmt.kind == StmtKind::Comment && silent(&stmt.site)))
}

/// What people call a subroutine, where that is a name and no number: it stands beside the program's number.
fn called(program: &Program, entry: BlockId) -> ThinVec<Comment> {
    let labels = program.block(entry).into_iter().flat_map(|block| &block.labels);
    let names = labels.filter_map(|label| match label {
        Label::Name(name) => Some(Comment { text: name.clone(), leading: false }),
        Label::Number(_) => None,
    });
    names.take(1).collect()
}

/// A name that no program in any source has: the parent's and the label.
fn sub_name(program: &Program, entry: BlockId) -> ProgramName {
    let parent = match &program.name {
        Some(name) => name.short().into_owned(),
        None => format!("FILE{}", program.file),
    };
    let label = match program.block(entry).and_then(|block| block.labels.first()) {
        Some(Label::Number(n)) => n.to_string(),
        Some(Label::Name(name)) => name.clone(),
        None => format!("BLOCK{}", entry.0),
    };
    ProgramName::Name(format!("{parent}/{label}"))
}

/// Where some of the blocks stand in a program of them: after a jump to the entry, unless that comes first.
pub(super) fn places(entry: BlockId, body: &BTreeSet<BlockId>) -> BTreeMap<BlockId, BlockId> {
    let shift = u32::from(body.first() != Some(&entry));
    body.iter().copied().zip((shift..).map(BlockId)).collect()
}

/// A program of some of the blocks, entered at `entry`.
pub(super) fn extract(
    program: &Program,
    entry: BlockId,
    body: &BTreeSet<BlockId>,
    name: Option<ProgramName>,
    site: SourceInfo,
) -> Program {
    let leads = body.first() == Some(&entry);
    let place = places(entry, body);
    let mut blocks = Vec::with_capacity(body.len() + 1);
    if !leads {
        let jump = TermKind::Jump(place.get(&entry).copied().unwrap_or(BlockId(0)));
        let term = Terminator { kind: jump, site: SourceInfo::default() };
        blocks.push(Block { labels: ThinVec::new(), stmts: Stmts::new(), term });
    }
    for block in body.iter().filter_map(|&id| program.block(id)) {
        let mut block = block.clone();
        for_each_jump(&mut block.term.kind, &mut |to| *to = place.get(to).copied().unwrap_or(*to));
        blocks.push(block);
    }
    Program { name, file: program.file, site, held: Vec::new(), blocks }
}

/// Every successor; callees keep their ids until they are renamed.
fn for_each_jump(kind: &mut TermKind, f: &mut dyn FnMut(&mut BlockId)) {
    match kind {
        TermKind::Call { next, .. } => f(next),
        other => other.for_each_target(f),
    }
}

pub(super) fn for_each_callee(block: &mut Block, f: &mut dyn FnMut(&mut Callee)) {
    for stmt in &mut block.stmts {
        if let StmtKind::ModalCall(call) = &mut stmt.kind {
            f(&mut call.callee);
        }
    }
    if let TermKind::Call { call, .. } = &mut block.term.kind {
        f(&mut call.callee);
    }
}

fn rename_calls(block: &mut Block, names: &BTreeMap<BlockId, ProgramName>) {
    for_each_callee(block, &mut |callee| {
        if let Callee::Block(entry) = callee
            && let Some(name) = names.get(entry)
        {
            *callee = Callee::Program(name.clone());
        }
    });
}
