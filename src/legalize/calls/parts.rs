//! Calls of a program from one of its sequence numbers on.
//!
//! Law: such a call runs what is reachable from that block; a program of copies of those blocks does the same and returns to the same
//! place. It is made once, whoever calls it. Side conditions: the library has the program, and one block of it has the number. Blocks
//! that several parts reach are copied, so an operator who edits one must edit all; what only parts reach stands in them alone. Counter-example: a number that stands twice.

use super::outline::{extract, for_each_callee, places};
use crate::diag::{Code, Diagnostic};
use crate::ir::{
    Block, BlockId, Call, Callee, Comment, Module, Program, SourceInfo, Stmt, StmtKind, TermKind,
};
use crate::legalize::{Context, calls_of, reachable, span_of};
use crate::syntax::{Label, ProgramName};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// Makes the parts that are called, and refuses calls of those that cannot be made.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let mut wanted: BTreeMap<(u32, u32), Vec<(usize, Span)>> = BTreeMap::new();
    for (index, program) in module.programs.iter().enumerate() {
        for block in &program.blocks {
            for call in calls_of(block) {
                if let Callee::Program(name) = &call.callee
                    && let Some(part) = name.as_part()
                {
                    wanted.entry(part).or_default().push((index, span_of(block, call)));
                }
            }
        }
    }
    let mut bodies: BTreeMap<usize, BTreeSet<BlockId>> = BTreeMap::new();
    for ((number, sequence), calls) in wanted {
        match part(module, number, sequence) {
            Ok((parent, body, program)) => {
                bodies.entry(parent).or_default().extend(body);
                module.programs.push(program);
                context.origins.push(context.origins.get(parent).copied().unwrap_or_default());
            }
            Err(why) => {
                for (index, span) in calls {
                    let finding = Diagnostic::new(Code::NoEquivalent, span, why.clone());
                    context.add(index, finding);
                    withdraw(module, index, span);
                }
            }
        }
    }
    for (parent, body) in bodies {
        shorten(module, parent, &body);
    }
}

/// Leaves out of a program what only its parts reach, unless a return to a sequence number may come there.
fn shorten(module: &mut Module, parent: usize, parts: &BTreeSet<BlockId>) {
    let comes_back = |block: &Block| matches!(block.term.kind, TermKind::Return { to: Some(_) });
    let calls = |call: &&Call| !matches!(call.callee, Callee::Block(_));
    let leaves = |program: &Program| program.blocks.iter().flat_map(calls_of).any(|call| calls(&call));
    if module.programs.get(parent).is_none_or(leaves)
        && module.programs.iter().flat_map(|program| &program.blocks).any(comes_back)
    {
        return;
    }
    let Some(program) = module.programs.get_mut(parent) else { return };
    let main = body(program, BlockId(0));
    let keep: BTreeSet<BlockId> =
        program.ids().filter(|id| main.contains(id) || !parts.contains(id)).collect();
    let closed = keep.iter().flat_map(|id| body(program, *id)).all(|id| keep.contains(&id));
    if !closed || keep.len() == program.blocks.len() {
        return;
    }
    let (name, site, held) =
        (program.name.take(), std::mem::take(&mut program.site), std::mem::take(&mut program.held));
    let mut short = cut(program, BlockId(0), &keep, name, site);
    short.held = held;
    *program = short;
}

/// A program of some of its blocks, the calls of its own subroutines among them.
fn cut(
    program: &Program,
    entry: BlockId,
    body: &BTreeSet<BlockId>,
    name: Option<ProgramName>,
    site: SourceInfo,
) -> Program {
    let mut made = extract(program, entry, body, name, site);
    let place = places(entry, body);
    for block in &mut made.blocks {
        for_each_callee(block, &mut |callee| {
            if let Callee::Block(to) = callee {
                *to = place.get(to).copied().unwrap_or(*to);
            }
        });
    }
    made
}

/// The part of a program from a sequence number on, its blocks there, and the place of the program; why not, where it cannot be made.
fn part(module: &Module, number: u32, sequence: u32) -> Result<(usize, BTreeSet<BlockId>, Program), String> {
    let name = ProgramName::Number(number);
    let short = name.short().into_owned();
    let mut found =
        module.programs.iter().enumerate().filter(|(_, program)| program.name.as_ref() == Some(&name));
    let Some((parent, program)) = found.next() else {
        return Err(format!(
            "{short} is called from N{sequence} on, and is not in the library: add its file"
        ));
    };
    let has = |id: &BlockId| {
        let labels = program.block(*id).into_iter().flat_map(|block| &block.labels);
        labels.into_iter().any(|label| *label == Label::Number(sequence))
    };
    let places: Vec<BlockId> = program.ids().filter(has).collect();
    let entry = match places.as_slice() {
        [entry] => *entry,
        [] => {
            return Err(format!("{short} is called from N{sequence} on, and no block of it has that number"));
        }
        _ => {
            return Err(format!("{short} is called from N{sequence} on, and that number stands twice in it"));
        }
    };
    let body = body(program, entry);
    let comment = Comment { text: format!("{short} FROM N{sequence}"), leading: false };
    let site = SourceInfo { comments: std::iter::once(comment).collect(), ..SourceInfo::default() };
    let name = ProgramName::part(number, sequence);
    let made = cut(program, entry, &body, Some(name), site);
    Ok((parent, body, made))
}

/// The blocks that a run from one of them comes to, those of its own subroutines too.
fn body(program: &Program, entry: BlockId) -> BTreeSet<BlockId> {
    let mut body = BTreeSet::new();
    let mut open = vec![entry];
    while let Some(next) = open.pop() {
        for id in reachable(program, next) {
            if !body.insert(id) {
                continue;
            }
            let calls = program.block(id).into_iter().flat_map(calls_of);
            open.extend(calls.filter_map(|call| match call.callee {
                Callee::Block(entry) => Some(entry),
                _ => None,
            }));
        }
    }
    body
}

/// Puts what is not converted in the place of a call.
fn withdraw(module: &mut Module, index: usize, span: Span) {
    let Some(program) = module.programs.get_mut(index) else { return };
    for block in &mut program.blocks {
        let TermKind::Call { call, next } = &block.term.kind else { continue };
        let is_part = matches!(&call.callee, Callee::Program(name) if name.as_part().is_some());
        if is_part && block.term.site.span == span {
            let next = *next;
            let site = std::mem::take(&mut block.term.site);
            let kind = StmtKind::not_converted(Code::NoEquivalent.number());
            block.stmts.push(Stmt { kind, site });
            block.term.kind = TermKind::Jump(next);
        }
    }
}
