//! Runs of blocks with a block skip, as one way round them.
//!
//! Law: blocks of one level that follow each other are run or passed over as a whole, since nobody turns the switch between them. So
//! they become a branch on the switch round plain blocks, in which what one of them sets is known in the next; at the end each of
//! them gets its `/` again. Side conditions: nothing comes into the run but at its head, and nothing leaves it but by calls that come
//! back. Where a pass put another way into the run, it stays a branch. Counter-example: a label in the run that a jump goes to.

use crate::diag::{Code, Diagnostic};
use crate::ir::analysis::{Arrivals, kept_level, part_under_skip};
use crate::ir::{BlockId, Cond, Program, SourceInfo, Stmt, StmtKind, TermKind, Terminator};
use crate::legalize::Context;
use crate::legalize::features::Feature;
use crate::legalize::rewrite::{Part, rebuild};
use std::collections::{BTreeMap, BTreeSet};

const ENTERED: &str = "a loop under a block skip that a jump or a return may come into elsewhere than at its head: it is not certain \
    what the control skips";

const AT_HEAD: &str = "let jumps and returns go to a block before the loop";

/// A place in a program: a block, and a statement of it; past the last one stands its end.
type Place = (usize, usize);

/// The ways into each block; a sequence number is one where something may return to any of them.
fn arrivals(program: &Program, context: &Context<'_>) -> Arrivals {
    let by_number = context.features.has(Feature::ReturnTo);
    Arrivals::of_program(program, |_| by_number)
}

/// A run of blocks with a block skip.
struct Run {
    level: u8,
    /// Where it ends: its last block stands before.
    end: Place,
    /// The blocks whose ends go round one call of the run.
    rounds: Vec<usize>,
    blocks: usize,
    /// True if a loop is in it, each block of which gets the block skip where it is written.
    loops: bool,
}

/// True if control comes into a block from these two alone.
fn is_from_both(ways: &Arrivals, block: usize, both: [usize; 2]) -> bool {
    let from = ways.of(block);
    !ways.is_entered(block) && from.len() == 2 && both.iter().all(|at| from.contains(at))
}

/// The switch that a block's end goes by, and where it goes while that is on, and off.
fn switch(term: &Terminator) -> Option<(u8, BlockId, BlockId)> {
    match &term.kind {
        TermKind::Branch { cond, then, otherwise } => match **cond {
            Cond::Switch(level) => Some((level, *then, *otherwise)),
            _ => None,
        },
        _ => None,
    }
}

/// Where control goes on after a block that nothing but a call leaves.
fn goes_on(term: &TermKind) -> Option<usize> {
    match term {
        TermKind::Jump(to) | TermKind::Call { next: to, .. } => Some(to.index()),
        _ => None,
    }
}

/// The blocks from `first` on, each of which only the one before leads to, up to the one that goes on at `join`.
fn chain(program: &Program, ways: &Arrivals, from: usize, first: usize, join: usize) -> Option<Vec<usize>> {
    let (mut before, mut at, mut found) = (from, first, Vec::new());
    loop {
        let block = program.blocks.get(at)?;
        if at != before + 1 || !ways.is_only_from(at, before) {
            return None;
        }
        found.push(at);
        let next = goes_on(&block.term.kind)?;
        if next == join {
            return Some(found);
        }
        (before, at) = (at, next);
    }
}

/// The run that begins at a place, if it has more than one block.
fn run_at(program: &Program, ways: &Arrivals, (mut at, mut number): Place) -> Option<Run> {
    let first = program.blocks.get(at)?;
    let level = match first.stmts.get(number) {
        Some(stmt) => stmt.site.skip.filter(|_| stmt.kind != StmtKind::Comment)?,
        None => switch(&first.term)?.0,
    };
    let mut run = Run { level, end: (at, number), rounds: Vec::new(), blocks: 0, loops: false };
    while let Some(block) = program.blocks.get(at) {
        let goes = |stmt: &&Stmt| stmt.site.skip == Some(level) || stmt.kind == StmtKind::Comment;
        for (number, _) in block.stmts.iter().enumerate().skip(number).take_while(|(_, stmt)| goes(stmt)) {
            if block.stmts[number].kind != StmtKind::Comment {
                (run.blocks, run.end) = (run.blocks + 1, (at, number + 1));
            }
        }
        if block.stmts.iter().skip(number).any(|stmt| !goes(&stmt)) {
            break;
        }
        number = 0;
        match (switch(&block.term), &block.term.kind) {
            (Some((_, on, _)), _) if kept_level(&block.term) == Some(level) => {
                let Some((_, part)) = part_under_skip(program, ways, at) else { break };
                let from = |from: &usize| *from == at || part.contains(from);
                if ways.is_entered(on.index()) || !ways.of(on.index()).iter().all(from) {
                    break;
                }
                run.rounds.push(at);
                run.loops = true;
                (run.blocks, run.end, at) = (run.blocks + 1, (on.index(), 0), on.index());
            }
            (Some((other, on, off)), _) if other == level => {
                let body = chain(program, ways, at, off.index(), on.index());
                let Some(last) = body.and_then(|body| body.last().copied()) else { break };
                if on.index() != last + 1 || !is_from_both(ways, on.index(), [at, last]) {
                    break;
                }
                run.rounds.push(at);
                (run.blocks, run.end, at) = (run.blocks + 1, (on.index(), 0), on.index());
            }
            (None, TermKind::Jump(to)) if to.index() == at + 1 && ways.is_only_from(at + 1, at) => at += 1,
            _ => break,
        }
    }
    (run.blocks > 1).then_some(run)
}

/// The runs of a program, by where they begin.
fn runs(program: &Program, ways: &Arrivals) -> BTreeMap<Place, Run> {
    let mut found = BTreeMap::new();
    let mut free = (0, 0);
    for (at, block) in program.blocks.iter().enumerate() {
        for number in 0..=block.stmts.len() {
            if (at, number) >= free
                && let Some(run) = run_at(program, ways, (at, number))
            {
                free = run.end;
                found.insert((at, number), run);
            }
        }
    }
    found
}

/// Tells of loops under a block skip that control may come into elsewhere than at their heads.
fn entered(program: &Program, ways: &Arrivals, mut tell: impl FnMut(Diagnostic)) {
    for (at, block) in program.blocks.iter().enumerate() {
        if kept_level(&block.term).is_some() && part_under_skip(program, ways, at).is_none() {
            let head = program.blocks.get(at + 1..).unwrap_or_default().iter();
            let spans = head.flat_map(|block| {
                block.stmts.iter().map(|stmt| stmt.site.span).chain([block.term.site.span])
            });
            let span = spans.into_iter().find(|span| !span.is_empty()).unwrap_or(block.term.site.span);
            tell(Diagnostic::new(Code::SkipUnclear, span, ENTERED).with_help(AT_HEAD));
        }
    }
}

/// Makes runs of blocks with a block skip branches; true where there was one.
pub fn together(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let ways = arrivals(program, context);
    entered(program, &ways, |told| context.add(index, told));
    let runs = runs(program, &ways);
    if runs.is_empty() {
        return false;
    }
    let ends: BTreeSet<Place> = runs.values().map(|run| run.end).collect();
    let rounds: BTreeSet<usize> = runs.values().flat_map(|run| run.rounds.iter().copied()).collect();
    let mut open: Option<(u8, BlockId)> = None;
    let mut place: Place = (0, 0);
    rebuild(program, &mut |builder, part| {
        if let Part::Start(id) = part {
            place = (id.index(), 0);
            return;
        }
        if ends.contains(&place)
            && let Some((_, end)) = open.take()
        {
            builder.start(end);
        }
        if let Some(run) = runs.get(&place) {
            let (body, end) = (builder.fresh(), builder.fresh());
            let cond = Box::new(Cond::Switch(run.level));
            let site = SourceInfo { skip: Some(run.level).filter(|_| run.loops), ..SourceInfo::default() };
            builder.end(TermKind::Branch { cond, then: end, otherwise: body }, site);
            builder.start(body);
            open = Some((run.level, end));
        }
        match part {
            Part::Stmt(mut stmt) => {
                place.1 += 1;
                if open.is_some() && stmt.kind != StmtKind::Comment {
                    stmt.site.skip = None;
                }
                builder.push(stmt.kind, stmt.site);
            }
            Part::Term(term) => match switch(&term) {
                Some((_, _, off)) if open.is_some() && rounds.contains(&place.0) => {
                    builder.end(TermKind::Jump(off), SourceInfo { skip: None, ..term.site });
                }
                _ => builder.end(term.kind, term.site),
            },
            Part::Start(_) => {}
        }
    });
    true
}

/// Gives each block of such a branch its block skip again; true where there was one.
pub fn apart(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let ways = arrivals(program, context);
    let mut levels: BTreeMap<usize, u8> = BTreeMap::new();
    let mut heads: BTreeSet<usize> = BTreeSet::new();
    // A call right after another one is gone round by itself.
    let mut after_calls: BTreeSet<usize> = BTreeSet::new();
    for (at, block) in program.blocks.iter().enumerate() {
        let Some((level, on, off)) = switch(&block.term) else { continue };
        let Some(body) = chain(program, &ways, at, off.index(), on.index()) else { continue };
        let is_plain = |at: &usize| {
            let goes = |stmt: &Stmt| stmt.site.skip.is_none() || stmt.kind == StmtKind::Comment;
            program.blocks[*at].stmts.iter().all(goes)
        };
        // One call alone is gone round as it is.
        let calls = |at: &&usize| matches!(program.blocks[**at].term.kind, TermKind::Call { .. });
        let says = body.iter().any(|at| !program.blocks[*at].stmts.is_empty())
            || body.iter().filter(calls).count() > 1;
        if says && body.iter().all(is_plain) {
            heads.insert(at);
            let before = body.iter().filter(calls);
            after_calls.extend(before.filter_map(|at| goes_on(&program.blocks[*at].term.kind)));
            levels.extend(body.into_iter().map(|at| (at, level)));
        }
    }
    if heads.is_empty() {
        return false;
    }
    let calls: BTreeMap<usize, BlockId> = levels
        .keys()
        .filter_map(|at| match (&program.blocks[*at].term.kind, program.blocks[*at].stmts.is_empty()) {
            (TermKind::Call { next, .. }, true) if !after_calls.contains(at) => Some((*at, *next)),
            _ => None,
        })
        .collect();
    let mut at = 0;
    rebuild(program, &mut |builder, part| match part {
        Part::Start(id) => at = id.index(),
        Part::Stmt(mut stmt) => {
            if let Some(level) = levels.get(&at).filter(|_| stmt.kind != StmtKind::Comment) {
                stmt.site.skip = Some(*level);
            }
            builder.push(stmt.kind, stmt.site);
        }
        Part::Term(term) => {
            let round = |level: u8, then: BlockId, otherwise: BlockId| TermKind::Branch {
                cond: Box::new(Cond::Switch(level)),
                then,
                otherwise,
            };
            // A call alone is gone round by the end of the block before it.
            let round_next = goes_on(&term.kind).and_then(|next| Some((next, *calls.get(&next)?)));
            match (switch(&term), levels.get(&at).copied(), round_next, term.kind) {
                (Some((level, _, off)), _, _, _) if heads.contains(&at) => match calls.get(&off.index()) {
                    Some(after) => builder.end(round(level, *after, off), term.site),
                    None => builder.end(TermKind::Jump(off), SourceInfo::default()),
                },
                (_, Some(level), Some((to, after)), TermKind::Jump(_)) => {
                    builder.end(round(level, after, BlockId(to as u32)), term.site);
                }
                (_, Some(level), _, TermKind::Call { call, next }) if !calls.contains_key(&at) => {
                    builder.end_then(SourceInfo::default(), |body| round(level, next, body));
                    builder.end(TermKind::Call { call, next }, term.site);
                }
                (_, _, _, kind) => builder.end(kind, term.site),
            }
        }
    });
    true
}
