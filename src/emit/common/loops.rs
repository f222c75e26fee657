//! Loops that can be written as WHILE.
//!
//! Law: a header without statements whose branch goes to the block after it or to
//! `exit`, a body that ends with a jump to the header just before `exit`, and no other
//! way into the body, do what `WHILE[..]DOn` and `ENDn` around that body do.
//! Side conditions: nothing outside jumps or calls into the body (the control knows no loop
//! it did not enter by WHILE), the body's last block has the only jump back (a jump to the
//! line of WHILE from inside would enter the loop once more), and loops nest no
//! deeper than the control allows. Jumps out of the body are allowed.
//! Counter-example: `N1 IF[..]GOTO9 .. IF[..]GOTO1 .. GOTO1 N9` goes back twice and stays as it is.

use crate::ir::analysis::Arrivals;
use crate::ir::{Block, BlockId, Cond, Program, StmtKind, TermKind};

/// A loop, in the layout of its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Loop {
    /// The block that decides.
    pub header: usize,
    /// The last block of the body.
    pub last: usize,
    /// True where the branch leaves the loop when it holds.
    pub negated: bool,
    /// The number after DO: how many loops are round it, and one.
    pub number: u32,
}

/// All loops that can be written, outer ones first, at most `deepest` inside one another.
pub(super) fn find(program: &Program, arrivals: &Arrivals, deepest: u32) -> Vec<Loop> {
    let mut found: Vec<Loop> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for header in 0..program.blocks.len() {
        while open.last().is_some_and(|&last| last < header) {
            open.pop();
        }
        let number = open.len() as u32 + 1;
        if number <= deepest
            && let Some((last, negated)) = loop_at(program, arrivals, header)
        {
            open.push(last);
            found.push(Loop { header, last, negated, number });
        }
    }
    found
}

fn loop_at(program: &Program, arrivals: &Arrivals, header: usize) -> Option<(usize, bool)> {
    let block = program.blocks.get(header)?;
    let TermKind::Branch { cond, then, otherwise } = &block.term.kind else { return None };
    if !only_comments(block) || has_switch(cond) {
        return None;
    }
    let (exit, negated) = match (then.index(), otherwise.index()) {
        (body, exit) if body == header + 1 => (exit, false),
        (exit, body) if body == header + 1 => (exit, true),
        _ => return None,
    };
    let last = exit.checked_sub(1).filter(|&last| last > header)?;
    let back = TermKind::Jump(BlockId(header as u32));
    if program.blocks.get(last)?.term.kind != back {
        return None;
    }
    let enters = |block: usize| arrivals.of(block).iter().any(|&from| !(header..=last).contains(&from));
    let body_is_closed = (header + 1..=last).all(|b| !arrivals.is_entered(b) && !enters(b));
    let back_jumps = arrivals.of(header).iter().filter(|from| (header..=last).contains(from)).count();
    (body_is_closed && back_jumps == 1).then_some((last, negated))
}

fn only_comments(block: &Block) -> bool {
    block.stmts.iter().all(|stmt| stmt.kind == StmtKind::Comment && stmt.site.skip.is_none())
}

/// True where a condition asks the block-skip switch.
fn has_switch(condition: &Cond) -> bool {
    let mut work = vec![condition];
    while let Some(condition) = work.pop() {
        match condition {
            Cond::Switch(_) => return true,
            Cond::Not(inner) => work.push(inner),
            Cond::And(parts) | Cond::Or(parts) => work.extend(parts),
            Cond::Compare(..) => {}
        }
    }
    false
}
