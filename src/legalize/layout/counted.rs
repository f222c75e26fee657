//! Sequence numbers that only count the blocks of a program that an earlier conversion wrote.
//!
//! Law: a sequence number does nothing where nothing looks for it. A control that has a number at each block, counted
//! by one, gets them from whoever writes for it. Going on to another control they say nothing to anybody, and a block
//! that is put in between has none: each way there and back would count anew. So they go, and a block keeps the name
//! that it is jumped to by: `:N10`, which such a control made of N10, is N10 again.
//!
//! Side conditions: an earlier conversion wrote the library, none of its programs returns to a number of its caller,
//! and the numbers of a program only grow. Numbers that jumps look for are labels, and stay. A name becomes a number
//! where no block of the program has that number yet, and nothing jumps to a computed one. Counter-example: the numbers
//! of a person, who stopped at N40 yesterday and goes on there.

use crate::dialect::Control;
use crate::ir::{Block, Module, Program, SourceInfo, TermKind};
use crate::legalize::Context;
use crate::legalize::features::Features;
use crate::syntax::Label;
use std::collections::BTreeSet;

/// True in a library that an earlier conversion wrote for a control that counts its blocks.
pub fn concerns(_: &Features, context: &Context<'_>) -> bool {
    counts(context.source) && context.earlier.is_written()
}

fn counts(control: &Control) -> bool {
    control.text().counted
}

/// Takes such numbers away, and gives labels their numbers back; true if there were any.
pub fn run(module: &mut Module, _: &mut Context<'_>) -> bool {
    let looks = |block: &Block| matches!(block.term.kind, TermKind::Return { to: Some(_) });
    if module.programs.iter().any(|program| program.blocks.iter().any(looks)) {
        return false;
    }
    let mut changed = false;
    for program in module.programs.iter_mut().filter(|program| grow(program)) {
        let before: BTreeSet<u32> = program.blocks.iter().flat_map(numbers).collect();
        let open = program.blocks.iter().any(|block| matches!(block.term.kind, TermKind::Computed { .. }));
        if !open {
            changed |= rename(program, before);
        }
        for site in program.blocks.iter_mut().flat_map(sites_mut) {
            changed |= site.sequence.take().is_some();
        }
    }
    changed
}

/// True where each number is larger than the one before.
fn grow(program: &Program) -> bool {
    let mut last = None;
    program.blocks.iter().flat_map(sites).filter_map(|site| site.sequence.get()).all(|number| {
        let grows = last.is_none_or(|last| last <= number);
        last = Some(number);
        grows
    })
}

/// Makes numbers of names like `:N10`; true if there were any. `taken` are the numbers that blocks have.
fn rename(program: &mut Program, mut taken: BTreeSet<u32>) -> bool {
    let mut changed = false;
    for label in program.blocks.iter_mut().flat_map(|block| &mut block.labels) {
        let Label::Name(name) = label else { continue };
        let Some(number) = number_of(name) else { continue };
        if taken.insert(number) {
            *label = Label::Number(number);
            changed = true;
        }
    }
    changed
}

/// The number in a name like `N10`.
fn number_of(name: &str) -> Option<u32> {
    let digits = name.trim_start_matches(':').strip_prefix('N')?;
    let plain = digits.bytes().all(|digit| digit.is_ascii_digit()) && !digits.starts_with('0');
    digits.parse().ok().filter(|_| plain)
}

fn numbers(block: &Block) -> impl Iterator<Item = u32> {
    block.labels.iter().filter_map(|label| match label {
        Label::Number(number) => Some(*number),
        Label::Name(_) => None,
    })
}

fn sites(block: &Block) -> impl Iterator<Item = &SourceInfo> {
    block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site])
}

fn sites_mut(block: &mut Block) -> impl Iterator<Item = &mut SourceInfo> {
    block.stmts.iter_mut().map(|stmt| &mut stmt.site).chain([&mut block.term.site])
}
