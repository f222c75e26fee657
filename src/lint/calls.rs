//! Calls: how deep they go, whether they ever come back, and whether what they call is there.

use super::looked::{Findings, Looked, blocks};
use crate::diag::Code;
use crate::dialect::Limit;
use crate::ir::analysis::dataflow::reached_among;
use crate::ir::analysis::own_call;
use crate::ir::{Block, BlockId, Call, Callee, Program, StmtKind, TermKind};
use crate::syntax::ProgramName;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// A program entered at a block.
type Routine = (usize, BlockId);

/// A call from one routine to another.
struct Way {
    from: usize,
    to: usize,
    level: bool,
    program: usize,
    span: Span,
}

/// The routines of a library, and the calls between them.
struct Routines {
    count: usize,
    ways: Vec<Way>,
    all: Vec<Routine>,
}

fn entry_of(looked: &Looked<'_>, program: usize, call: &Call) -> Option<Routine> {
    match &call.callee {
        Callee::Block(entry) => Some((program, *entry)),
        Callee::Program(name) => Some((looked.program_of(name)?, BlockId(0))),
        Callee::Computed(_) | Callee::Cycle(_) => None,
    }
}

fn calls(block: &Block) -> impl Iterator<Item = (&Call, Span)> {
    let modal = block.stmts.iter().filter_map(|stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => Some((&**call, stmt.site.span)),
        _ => None,
    });
    modal.chain(match &block.term.kind {
        TermKind::Call { call, .. } => Some((&**call, block.term.site.span)),
        _ => None,
    })
}

fn routines(looked: &Looked<'_>) -> Routines {
    let mut all: Vec<Routine> = looked.programs().map(|(at, _)| (at, BlockId(0))).collect();
    let called = looked.sites().iter().filter_map(|site| entry_of(looked, site.program, site.call));
    all.extend(called);
    all.sort_unstable();
    all.dedup();
    let places: BTreeMap<Routine, usize> =
        all.iter().enumerate().map(|(at, routine)| (*routine, at)).collect();
    let mut ways = Vec::new();
    for (from, (program, entry)) in all.iter().enumerate() {
        let Some(body) = looked.module.programs.get(*program) else { continue };
        if !body.blocks.iter().any(|block| calls(block).next().is_some()) {
            continue;
        }
        let seen = reached_among(body.blocks.len(), [entry.index()], |at, go| {
            let block = body.blocks.get(at).into_iter();
            block.flat_map(|block| block.term.kind.successors()).for_each(|to| go(to.index()));
        });
        for (block, _) in body.blocks.iter().zip(seen).filter(|(_, seen)| *seen) {
            for (call, span) in calls(block) {
                let to = entry_of(looked, *program, call).and_then(|to| places.get(&to));
                ways.extend(to.map(|to| Way { from, to: *to, level: call.level, program: *program, span }));
            }
        }
    }
    Routines { count: all.len(), ways, all }
}

impl Routines {
    /// By routine, whether calls lead from it back to one that was entered.
    fn cyclic(&self) -> Vec<bool> {
        let mut left = vec![0usize; self.count];
        let mut callers: Vec<Vec<usize>> = vec![Vec::new(); self.count];
        for way in &self.ways {
            left[way.from] += 1;
            callers[way.to].push(way.from);
        }
        let mut work: Vec<usize> = (0..self.count).filter(|at| left[*at] == 0).collect();
        let mut cyclic = vec![true; self.count];
        while let Some(at) = work.pop() {
            cyclic[at] = false;
            for from in &callers[at] {
                left[*from] -= 1;
                if left[*from] == 0 {
                    work.push(*from);
                }
            }
        }
        cyclic
    }
}

/// So deep calls, and so many programs that come back to themselves, no control runs.
const DEEPEST: usize = 64;

/// Calls of parts times blocks up to which a program is followed.
const MOST_PARTS: usize = 1 << 19;

/// True where calls go deeper than any control goes, or a program has more of them than anybody writes: what is in
/// force is not followed there.
pub(super) fn is_tangled(looked: &Looked<'_>) -> bool {
    if looked.sites().is_empty() {
        return false;
    }
    let is_wide = |program: &Program| {
        let parts = program.blocks.iter().filter_map(own_call).count();
        parts.saturating_mul(program.blocks.len()) > MOST_PARTS
    };
    if looked.module.programs.iter().any(is_wide) {
        return true;
    }
    let routines = routines(looked);
    let cyclic = routines.cyclic();
    let depth = depths(&routines, &cyclic, DEEPEST, |_| true);
    cyclic.iter().filter(|cyclic| **cyclic).count() > DEEPEST || depth.iter().any(|depth| *depth > DEEPEST)
}

/// A call that goes deeper than the control's levels.
pub(super) fn too_deep(looked: &Looked<'_>, findings: &mut Findings) {
    if looked.sites().is_empty() {
        return;
    }
    let routines = routines(looked);
    let cyclic = routines.cyclic();
    let mut told = BTreeSet::new();
    for name in ["call.macro", "call.subprogram", "call.all"] {
        let Some(row) = looked.control.limit_row(name) else { continue };
        let Some(most) = row.max else { continue };
        let counts = |way: &&Way| match name {
            "call.macro" => way.level,
            "call.subprogram" => !way.level,
            _ => true,
        };
        let depth = depths(&routines, &cyclic, most as usize, counts);
        for way in routines.ways.iter().filter(counts).filter(|way| !cyclic[way.from] && !cyclic[way.to]) {
            if depth[way.from] == most as usize && told.insert((way.program, way.span)) {
                let file = looked.module.programs[way.program].file;
                findings.add(file, Code::CallsTooDeep, way.span, deep(name, most, row));
            }
        }
    }
}

fn deep(name: &str, most: u32, row: &Limit) -> String {
    let what = match name {
        "call.macro" => "macro calls",
        "call.subprogram" => "calls of subprograms",
        _ => "calls",
    };
    let sure = if row.origin.is_settled() { "" } else { "; no manual confirms the limit" };
    format!(
        "the call is {} levels deep, and the control has {most} levels of {what}{sure} ('limits.{name}')",
        most + 1
    )
}

/// By routine, the most calls that lead to it, up to one more than `most`.
fn depths(routines: &Routines, cyclic: &[bool], most: usize, counts: impl Fn(&&Way) -> bool) -> Vec<usize> {
    let mut depth = vec![0usize; routines.count];
    // Those that cannot come back to themselves settle within as many rounds as there are levels of any kind.
    for _ in 0..routines.count {
        let mut changed = false;
        for way in routines.ways.iter().filter(|way| !cyclic[way.from] && !cyclic[way.to]) {
            let more = depth[way.from] + usize::from(counts(&way));
            let next = more.min(most + 1);
            if next > depth[way.to] {
                depth[way.to] = next;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    depth
}

/// A program that calls itself, with no way on which it comes to an end.
pub(super) fn endless_calls(looked: &Looked<'_>, findings: &mut Findings) {
    if looked.sites().is_empty() {
        return;
    }
    let routines = routines(looked);
    let cyclic = routines.cyclic();
    if !cyclic.contains(&true) {
        return;
    }
    let places: BTreeMap<Routine, usize> =
        routines.all.iter().enumerate().map(|(at, routine)| (*routine, at)).collect();
    let mut ends: Vec<bool> = cyclic.iter().map(|cyclic| !cyclic).collect();
    let mut changed = true;
    while std::mem::take(&mut changed) {
        for at in 0..routines.count {
            if !ends[at] && may_end(looked, routines.all[at], &places, &ends) {
                ends[at] = true;
                changed = true;
            }
        }
    }
    let mut told = BTreeSet::new();
    for way in &routines.ways {
        if !ends[way.from] && !ends[way.to] && told.insert(way.from) {
            let (program, _) = routines.all[way.to];
            let shown = looked.shown(program);
            let message =
                format!("{shown} is called before it ends, and no way through it ends without that call");
            findings.add(looked.module.programs[way.program].file, Code::EndlessCalls, way.span, message);
        }
    }
}

/// True where some way through a routine ends it, past calls of such alone that end.
fn may_end(
    looked: &Looked<'_>,
    (at, entry): Routine,
    places: &BTreeMap<Routine, usize>,
    ends: &[bool],
) -> bool {
    let Some(program) = looked.module.programs.get(at) else { return true };
    let mut found = false;
    let count = program.blocks.len();
    reached_among(count, [entry.index()], |id, go| {
        let Some(block) = program.blocks.get(id) else { return };
        found |= block.stmts.iter().any(|stmt| matches!(stmt.kind, StmtKind::Alarm { .. }));
        match &block.term.kind {
            TermKind::Return { .. } | TermKind::End { .. } | TermKind::Stray | TermKind::Chain(_) => {
                found = true
            }
            TermKind::Call { call, next } => {
                let callee = entry_of(looked, at, call).and_then(|entry| places.get(&entry));
                if callee.is_none_or(|callee| ends[*callee]) {
                    go(next.index());
                }
            }
            kind => kind.successors().into_iter().for_each(|to| go(to.index())),
        }
    });
    found
}

/// A called program that the library does not have.
pub(super) fn missing_program(looked: &Looked<'_>, findings: &mut Findings) {
    for (at, _, block) in blocks(looked.module) {
        let file = looked.module.programs[at].file;
        let chain = match &block.term.kind {
            TermKind::Chain(name) => Some((name, block.term.site.span)),
            _ => None,
        };
        let called = calls(block).filter_map(|(call, span)| match &call.callee {
            Callee::Program(name) => Some((name, span)),
            _ => None,
        });
        for (name, span) in called.chain(chain) {
            if looked.program_of(name).is_none() {
                let message = format!("the library has no program {}", name.short());
                findings.add(file, Code::MissingProgram, span, message);
            }
        }
    }
}

/// A file whose name is a program number that none of its programs has.
pub(super) fn file_number(looked: &Looked<'_>, findings: &mut Findings) {
    let Some(sign) = looked.control.names().program.as_deref().filter(|sign| !sign.is_empty()) else {
        return;
    };
    let mut numbers: BTreeMap<usize, (Span, Vec<u32>)> = BTreeMap::new();
    for (_, program) in looked.programs() {
        if let Some(ProgramName::Number(number)) = program.name {
            let (_, all) = numbers.entry(program.file).or_insert((program.site.span, Vec::new()));
            all.push(number);
        }
    }
    for (file, (span, numbers)) in numbers {
        let Some(input) = looked.inputs.get(file) else { continue };
        let Some(wanted) = number_in(&input.name, sign).filter(|wanted| !numbers.contains(wanted)) else {
            continue;
        };
        let message = format!(
            "the file is named by the number {wanted}, and its program has the number {}",
            numbers.first().copied().unwrap_or_default()
        );
        findings.add(file, Code::FileNumber, span, message);
    }
}

/// The program number that a file's name begins with.
fn number_in(name: &str, sign: &str) -> Option<u32> {
    let last = name.rsplit('/').next()?;
    let head = last.get(..sign.len()).filter(|head| head.eq_ignore_ascii_case(sign))?;
    let rest = &last[head.len()..];
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    rest[..end].parse().ok()
}
