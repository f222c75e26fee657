//! What an earlier conversion wrote for people: the registers at a program's head, and the old names of labels.
//!
//! Law: a comment does nothing. `(V31=#100 V40=FLAG OF #100 SCRATCH R5)` says what registers of the source hold, and this
//! conversion writes such a head of its own: with the old one above it, each way there and back would add to the text.
//! Only comments at the head go that hold nothing but names of registers, one of them the source's. Any other word in one
//! keeps it, and so does a statement before it. The program's own number goes there too. At a label `($1)`, `(N10)` or `(L1)` was its name on another control.
//! A program without a number that begins with one, `(O1029)`, gets it back where nothing else has it or calls it. What heads
//! say is kept ([`Earlier`]): the registers are given by it, where they are free.

use super::earlier::Earlier;
use super::head_text::Head;
use crate::dialect::Control;
use crate::ir::{Block, Callee, Module, Program, SourceInfo, StmtKind, Stmts};
use crate::legalize::{Context, calls_of};
use crate::syntax::{Label, ProgramName};
use std::collections::BTreeSet;
use thin_vec::ThinVec;

/// Leaves such comments out; true if there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let source = context.source;
    let mut changed = false;
    let mut earlier = Earlier::of(module.programs.len());
    for (index, program) in module.programs.iter_mut().enumerate() {
        changed |= drop_head(program, source, &mut |head| earlier.add(index, head));
        for block in program.blocks.iter_mut().filter(|block| !block.labels.is_empty()) {
            changed |= drop_name(block);
        }
    }
    changed |= take_numbers(module, &mut earlier, context);
    context.earlier = earlier;
    changed
}

/// Takes the old name of a label out of the comments of the block's first statement: it is one of its labels again.
fn drop_name(block: &mut Block) -> bool {
    let Block { labels, stmts, term } = block;
    let Some(first) = stmts.first_mut() else { return drop_from(&mut term.site, labels) };
    let changed = drop_from(&mut first.site, labels);
    if changed && first.kind == StmtKind::Comment && first.site.comments.is_empty() {
        block.stmts.remove(0);
    }
    changed
}

fn drop_from(site: &mut SourceInfo, labels: &mut ThinVec<Label>) -> bool {
    let all = site.comments.len();
    site.comments.retain(|comment| {
        let name = counts(&comment.text);
        if name {
            // Before the others: a target whose labels have names takes the first.
            labels.insert(0, Label::Name(comment.text.clone()));
        }
        !name
    });
    site.comments.len() < all
}

/// True for a name that only counts.
pub(in crate::legalize) fn counts(name: &str) -> bool {
    let number =
        name.strip_prefix(['$', 'N']).or_else(|| name.strip_prefix('L').filter(|rest| rest.len() < 3));
    number.is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|digit| digit.is_ascii_digit()))
}

/// Takes the numbers that programs without one had before, `(O1029)`, where nothing else has them; true if there were any.
fn take_numbers(module: &mut Module, earlier: &mut Earlier, context: &Context<'_>) -> bool {
    // Only a control without such numbers has them in comments.
    if context.source.names().program.is_some() || context.target.names().program.is_none() {
        return false;
    }
    let most = context.target.text().program_max;
    let claims = module.programs.iter().map(number_at_head);
    let claims: Vec<Option<u32>> = claims.map(|n| n.filter(|n| (1..=most).contains(n))).collect();
    if claims.iter().all(Option::is_none) {
        return false;
    }
    let mut taken: BTreeSet<u32> = context.locked.programs.values().copied().collect();
    taken.extend(&context.locked.elsewhere.programs);
    for program in &module.programs {
        let called = program.blocks.iter().flat_map(calls_of).filter_map(|call| match &call.callee {
            Callee::Program(name) => Some(name),
            _ => None,
        });
        taken.extend(program.name.iter().chain(called).filter_map(|name| match name {
            ProgramName::Number(number) => Some(*number),
            ProgramName::Name(_) => None,
        }));
    }
    let mut changed = false;
    for (index, (program, claim)) in module.programs.iter_mut().zip(&claims).enumerate() {
        let Some(number) = claim.filter(|number| !taken.contains(number)) else { continue };
        if claims.iter().filter(|other| **other == Some(number)).count() == 1 {
            earlier.numbers.insert(index, number);
            program.blocks.iter_mut().take(1).for_each(|block| drop(block.stmts.remove(0)));
            changed = true;
        }
    }
    changed
}

/// The number in the first comment of a program that has none, if that comment is nothing else.
fn number_at_head(program: &Program) -> Option<u32> {
    let Some(ProgramName::Name(_)) = program.name else { return None };
    let first = program.blocks.first()?.stmts.first().filter(|stmt| stmt.kind == StmtKind::Comment)?;
    let [comment] = first.site.comments.as_slice() else { return None };
    let (_, digits) = parted(&comment.text)?;
    digits.parse().ok().filter(|number| ProgramName::Number(*number).to_string() == comment.text)
}

/// True for the number of a program as a comment, which a control without such numbers has at its head.
fn is_name(text: &str, name: Option<&ProgramName>) -> bool {
    let Some(own @ ProgramName::Number(_)) = name else { return false };
    parted(text).is_some_and(|text| parted(&own.short()) == Some(text))
}

/// What stands before the digits of a name, and its number without the zeros before it.
fn parted(name: &str) -> Option<(&str, &str)> {
    let at = name.find(|sign: char| sign.is_ascii_digit())?;
    let (sign, digits) = name.split_at_checked(at)?;
    Some((sign, digits.trim_start_matches('0')))
}

/// Takes the head away, and calls `f` with what each of its comments says.
fn drop_head(program: &mut Program, source: &Control, f: &mut dyn FnMut(&Head)) -> bool {
    // What was a part of a program, `($1)`, may say at its head what it was before that.
    let was_part = program.site.comments.iter().any(|comment| counts(&comment.text));
    let name = program.name.clone().filter(|_| !was_part);
    let (mut changed, mut scratch) = (false, false);
    // A block with a number is a block of the IR too, where something may jump to it.
    'head: for block in &mut program.blocks {
        let mut kept = Stmts::with_capacity(block.stmts.len());
        let mut rest = std::mem::take(&mut block.stmts).into_iter();
        let mut ended = false;
        for mut stmt in rest.by_ref() {
            ended = stmt.kind != StmtKind::Comment;
            if ended {
                kept.push(stmt);
                break;
            }
            let all = stmt.site.comments.len();
            stmt.site.comments.retain(|comment| {
                if is_name(&comment.text, name.as_ref()) {
                    return false;
                }
                let head = Head::of(&comment.text, source, scratch);
                let head = head.filter(|head| head.pairs || scratch);
                head.iter().for_each(&mut *f);
                scratch = head.as_ref().is_some_and(|head| scratch || head.scratch);
                head.is_none()
            });
            let left_out = stmt.site.comments.len() < all;
            changed |= left_out;
            if !left_out || !stmt.site.comments.is_empty() {
                kept.push(stmt);
            }
        }
        kept.extend(rest);
        block.stmts = kept;
        if ended || block.term.kind.successors().len() != 1 {
            break 'head;
        }
    }
    changed
}
