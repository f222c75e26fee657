//! More M codes in a block than the target takes, and codes that say what the target always does.
//!
//! Law: the M codes of one block act together: the tool is changed, then the spindle turns, coolant comes on, what stops
//! acts, and a program stop is last; given one a block in that order, the machine ends in the same state. The first stays
//! with its block, and the others come after it. Side condition: between two of them the machine may wait for the first to
//! be finished.
//! A code for turns per minute says nothing to a control without constant surface speed, and is left out.

use crate::canon::{Auxiliary, Op};
use crate::dialect::{Control, Question};
use crate::ir::{Nc, NcItem, Program, SourceInfo, Stmt, StmtKind};
use crate::legalize::Context;
use crate::legalize::codes::beside_moves::belongs;
use crate::legalize::features::{Feature, Features};
use std::collections::{BTreeMap, BTreeSet};

/// True where there are M codes, or what is left out.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let here = |op: Op| op == Op::TurnsPerMinute || is_m_code(op, context.target);
    features.has(Feature::Emptied) || features.has(Feature::Code) || features.any_op(here)
}

const QUESTION: Question = Question::MCodesPerBlock;

/// How many M codes stand together in a block; none if nobody said it.
fn most_of(control: &Control) -> Option<usize> {
    match control.behaviour(QUESTION)?.value.as_str() {
        "1" => Some(1),
        "3" => Some(3),
        "any" => Some(usize::MAX),
        _ => None,
    }
}

/// Gives each M code a block of its own, past those that the target takes together.
pub fn run(program: &mut Program, index: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let most = most_of(target).unwrap_or(1);
    // Of two machines of one control whoever knows it of one knows it of the other.
    let row = target.behaviour(QUESTION);
    let open = context.source.name() == target.name()
        && !context.source.is_same_machine(target)
        && row.is_some_and(|row| !row.origin.is_settled() || most_of(target).is_none());
    let mut split_at = None;
    let always_turns = target.code_for(Op::SurfaceSpeed, &BTreeMap::new()).is_none();
    let m_codes =
        context.m_codes.get_or_init(|| Op::ALL.iter().copied().filter(|op| is_m_code(*op, target)).collect());
    let mut changed = false;
    for block in &mut program.blocks {
        let mut behind = Vec::new();
        for (at, stmt) in block.stmts.iter_mut().enumerate() {
            let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
            let before = nc.items.len();
            if always_turns {
                nc.items.retain(|item| *item != NcItem::Op(Op::TurnsPerMinute));
            }
            let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
            let rest = split(nc, most, m_codes).into_iter().map(|items| {
                let kind = StmtKind::Nc(Nc { items });
                (at, Stmt { kind, site: site.clone() })
            });
            let count = behind.len();
            behind.extend(rest);
            if behind.len() > count {
                split_at = split_at.or(Some(stmt.site.span));
            }
            changed |= nc.items.is_empty() || nc.items.len() != before;
            if nc.items.is_empty() {
                stmt.kind = StmtKind::Comment;
            }
        }
        if !behind.is_empty() {
            let mut behind = behind.into_iter().peekable();
            let stmts = std::mem::take(&mut block.stmts).into_iter().enumerate();
            for (at, stmt) in stmts {
                block.stmts.push(stmt);
                while let Some((_, more)) = behind.next_if(|(place, _)| *place == at) {
                    block.stmts.push(more);
                }
            }
        }
    }
    if let Some(span) = split_at.filter(|_| open) {
        context.rests_on_target(index, span, QUESTION);
    }
    changed
}

/// True for an operation that the target has an M code for.
fn is_m_code(op: Op, target: &Control) -> bool {
    let by_name = || target.dialect().codes.iter().any(|row| row.op == op && row.code.starts_with('M'));
    let named = matches!(op, Op::Act | Op::OutputOn | Op::OutputOff) && by_name();
    named || target.code_for(op, &BTreeMap::new()).is_some_and(|row| row.code.starts_with('M'))
}

/// Takes the M codes past `most` out of a block, each with the words that a builder's code brings.
fn split(nc: &mut Nc, most: usize, m_codes: &BTreeSet<Op>) -> Vec<Vec<NcItem>> {
    let is_m = |item: &NcItem| match item {
        NcItem::Op(op) => m_codes.contains(op),
        NcItem::Code(letter, _) => *letter == 'M',
        NcItem::Word(..) => false,
    };
    if nc.items.iter().filter(|item| is_m(item)).count() <= most {
        return Vec::new();
    }
    let mut codes: Vec<(u8, usize)> = (nc.items.iter().enumerate())
        .filter(|(_, item)| is_m(item))
        .map(|(at, item)| (rank(item), at))
        .collect();
    codes.sort();
    let behind: Vec<usize> = codes.split_off(most).into_iter().map(|(_, at)| at).collect();
    let mut taken: Vec<Vec<NcItem>> =
        behind.iter().filter_map(|at| nc.items.get(*at)).map(|code| vec![code.clone()]).collect();
    let mut at = 0;
    nc.items.retain(|_| {
        at += 1;
        !behind.contains(&(at - 1))
    });
    for block in &mut taken {
        let Some(code) = block.first().filter(|code| brings(code)).cloned() else { continue };
        let (words, kept): (Vec<_>, Vec<_>) =
            std::mem::take(&mut nc.items).into_iter().partition(|item| belongs(item, &code));
        nc.items = kept;
        block.extend(words);
    }
    taken
}

/// True for a code that says nothing without the words that the profile fixes for it.
fn brings(code: &NcItem) -> bool {
    matches!(code, NcItem::Op(Op::Act | Op::OutputOn | Op::OutputOff))
}

/// The order in which codes act that nothing moves beside; a stop comes last.
fn rank(item: &NcItem) -> u8 {
    match item {
        NcItem::Op(op) => op.auxiliary().map_or(u8::MAX, |kind| kind as u8),
        NcItem::Code(..) | NcItem::Word(..) => Auxiliary::Other as u8,
    }
}
