//! Contours whose last block is no stock: it goes back along Z, or beyond the start of the cycle.
//!
//! Law: where the source roughs without such a block and the target stops at it, the contour ends a block earlier, and each finishing of it is
//! written out: its blocks, and the way back to where it began. Side condition: the block lies no deeper than the start of every roughing that
//! reads the contour, all places are numbers, where each finishing begins is known, and no run comes to the contour but by its cycles. Counter-example: a way back along the turned part.

use super::contours::stops_beyond;
use super::place::Place;
use super::straight::entered_straight;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::ir::{BlockId, Expr, Module, Nc, NcItem, Program, SourceInfo, Stmt, StmtKind};
use crate::legalize::features::Features;
use crate::legalize::{Context, ModalFacts};
use crate::text::Span;

/// A place below which two are one.
const SAME: f64 = 1e-9;

/// The block and the place in it.
type At = (usize, usize);

/// True where the target stops at blocks that the source takes.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    features.any_op(|op| op == Op::RoughTurning)
        && !stops_beyond(context.source)
        && stops_beyond(context.target)
}

/// Takes such blocks out, and writes the finishing out; true where there were any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let steps = context.features.any_op(|op| op == Op::Incremental);
    if steps {
        return false;
    }
    let facts = context.modal_facts(module);
    let mut changed = false;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let readers = readers(program, (index, &facts));
        let mut done: Vec<[u32; 2]> = Vec::new();
        let mut ends = Vec::new();
        for reader in &readers {
            if !done.contains(&reader.ends) {
                done.push(reader.ends);
                let own: Vec<&Reader> = readers.iter().filter(|other| other.ends == reader.ends).collect();
                ends.extend(end_of(program, &own));
            }
        }
        // One that begins or ends in another is left as it is.
        let alone = |end: &End| {
            readers.iter().all(|reader| {
                reader.ends == end.ends || reader.ends.iter().all(|number| !end.ends.contains(number))
            })
        };
        for end in ends.into_iter().filter(alone).rev() {
            for span in end.apply(program) {
                context.add(index, Diagnostic::new(Code::WrittenOut, span, WRITTEN));
            }
            changed = true;
        }
    }
    changed
}

const WRITTEN: &str = "the last block of this contour cuts nothing, and the target's cycles stop at it: the contour ends before it, and this finishing is written out as moves";

/// A cycle that reads a contour.
struct Reader {
    at: At,
    /// The numbers of the first and the last block.
    ends: [u32; 2],
    finishes: bool,
    /// True for a cycle that can be told so.
    fits: bool,
    /// Where it begins.
    from: Option<[f64; 2]>,
}

fn readers(program: &Program, (index, facts): (usize, &ModalFacts)) -> Vec<Reader> {
    let straight = entered_straight(program);
    let (mut place, mut found) = (Place::default(), Vec::new());
    for (block, straight) in program.blocks.iter().enumerate().zip(straight) {
        let (at, block) = block;
        if !straight {
            place.forget();
        }
        let mut state = facts.at(index, BlockId(at as u32));
        for (count, stmt) in block.stmts.iter().enumerate() {
            place.enter(stmt);
            let (from, before) = (place, state.op(Group::Motion));
            place.step(stmt);
            state.step(stmt);
            let Some(nc) = stmt.kind.nc() else { continue };
            let Some(op) = nc.ops().find(|op| op.reads_contour()) else { continue };
            let number = |role| nc.word(role).and_then(Expr::constant).map(|number| number as u32);
            let Some(ends) = number(Role::ContourFirst).zip(number(Role::ContourLast)) else { continue };
            let finishes = op == Op::Finish;
            let fits = match op {
                Op::RoughTurning => true,
                Op::Finish => before == Some(Op::Rapid) && stmt.site.skip.is_none() && !state.may_call(),
                _ => false,
            };
            let from = from.x().zip(from.z()).filter(|_| !from.counts_steps() && !from.is_shifted());
            found.push(Reader {
                at: (at, count),
                ends: ends.into(),
                finishes,
                fits,
                from: from.map(Into::into),
            });
        }
    }
    found
}

/// A contour that ends a block earlier.
struct End {
    ends: [u32; 2],
    /// The first block, the new last one, and the one that goes.
    blocks: [At; 3],
    /// The finishing cycles, and where each begins.
    finishes: Vec<(At, [f64; 2])>,
}

/// What is to be done about a contour with these readers; none if it stays.
fn end_of(program: &Program, readers: &[&Reader]) -> Option<End> {
    let ends = readers.first()?.ends;
    if !readers.iter().all(|reader| reader.fits && reader.from.is_some()) {
        return None;
    }
    let [begin, last] = [find(program, ends[0])?, find(program, ends[1])?];
    // The cycle passes over it, and no jump leads into it.
    if begin.0 != last.0 || !readers.iter().any(|reader| is_right_before(program, reader.at, begin)) {
        return None;
    }
    let blocks = || program.blocks.iter().enumerate();
    let all = blocks()
        .flat_map(|(at, block)| block.stmts.iter().enumerate().map(move |(count, stmt)| ((at, count), stmt)));
    let contour: Vec<(At, &Stmt)> =
        all.filter(|(at, stmt)| (begin..=last).contains(at) && stmt.kind != StmtKind::Comment).collect();
    let ([.., (previous, before), (_, end)], true) = (contour.as_slice(), contour.len() > 2) else {
        return None;
    };
    let plain = |stmt: &Stmt| stmt.site.skip.is_none() && stmt.kind.nc().is_some_and(is_plain);
    let motions = contour.iter().filter_map(|(_, stmt)| stmt.kind.nc()).flat_map(Nc::ops);
    let motion = motions.filter(|op| op.group() == Group::Motion).last();
    if !contour.iter().all(|(_, stmt)| plain(stmt))
        || !matches!(motion, Some(Op::Rapid | Op::Linear))
        || !ends_plainly(end.kind.nc()?)
        || !is_move(before.kind.nc()?)
    {
        return None;
    }
    for reader in readers.iter().filter(|reader| !reader.finishes) {
        if !is_no_stock(&contour, reader.from?) {
            return None;
        }
    }
    let rough = readers.iter().any(|reader| !reader.finishes);
    let finishes =
        readers.iter().filter(|reader| reader.finishes).filter_map(|reader| Some((reader.at, reader.from?)));
    rough.then(|| End { ends, blocks: [begin, *previous, last], finishes: finishes.collect() })
}

/// True where a cycle reads what comes next, so that the run goes on after it.
fn is_right_before(program: &Program, at: At, begin: At) -> bool {
    let between = program.blocks.get(begin.0).and_then(|block| block.stmts.get(at.1 + 1..begin.1));
    at.0 == begin.0
        && between.is_some_and(|between| between.iter().all(|stmt| stmt.kind == StmtKind::Comment))
}

/// True where the last block lies no deeper than where the cycle begins, and goes back along Z, or beyond it (R10, R11).
fn is_no_stock(contour: &[(At, &Stmt)], from: [f64; 2]) -> bool {
    let mut places = vec![from];
    for (_, stmt) in contour {
        let Some(nc) = stmt.kind.nc() else { return false };
        let mut at = places[places.len() - 1];
        for (axis, role) in [Role::X, Role::Z].into_iter().enumerate() {
            match nc.word(role).map(Expr::constant) {
                Some(Some(value)) => at[axis] = value,
                Some(None) => return false,
                None => {}
            }
        }
        places.push(at);
    }
    let [_, begin, .., previous, last] = places.as_slice() else { return false };
    let infeed = sense(begin[0] - from[0]);
    let outside = |place: &[f64; 2]| (place[0] - from[0]) * infeed <= SAME;
    let back = (last[1] - previous[1]) * sense(previous[1] - begin[1]) < -SAME;
    let beyond = (last[0] - from[0]) * infeed < -SAME;
    infeed != 0.0 && outside(previous) && outside(last) && (back || beyond)
}

fn sense(way: f64) -> f64 {
    if way.abs() <= SAME { 0.0 } else { way.signum() }
}

/// True for a block that a contour may have, without increments.
fn is_plain(nc: &Nc) -> bool {
    nc.items.iter().all(|item| match item {
        NcItem::Op(op) => {
            op.group() == Group::RadiusComp || matches!(op, Op::Rapid | Op::Linear | Op::ArcCw | Op::ArcCcw)
        }
        NcItem::Word(role, _) => {
            matches!(role, Role::X | Role::Z | Role::ArcI | Role::ArcK | Role::ArcRadius | Role::Feed)
                || role.is_drawn()
        }
        NcItem::Code(..) => false,
    })
}

/// True for a move with no code but that of a straight one.
fn ends_plainly(nc: &Nc) -> bool {
    is_move(nc)
        && nc.items.iter().all(|item| match item {
            NcItem::Op(op) => matches!(op, Op::Rapid | Op::Linear | Op::RadiusOff),
            NcItem::Word(role, _) => matches!(role, Role::X | Role::Z | Role::Feed),
            NcItem::Code(..) => false,
        })
}

/// True for a block that goes to a place, without a corner after it.
fn is_move(nc: &Nc) -> bool {
    nc.names_axis() && !nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_drawn()))
}

/// The only statement with a number.
fn find(program: &Program, number: u32) -> Option<At> {
    let mut all = program.blocks.iter().enumerate().flat_map(|(at, block)| {
        let with =
            block.stmts.iter().enumerate().filter(|(_, stmt)| stmt.site.sequence.get() == Some(number));
        with.map(move |(count, _)| (at, count))
    });
    all.next().filter(|_| all.next().is_none())
}

impl End {
    /// Does it; the finishing cycles that are written out.
    fn apply(self, program: &mut Program) -> Vec<Span> {
        let [begin, previous, last] = self.blocks;
        let stmts = |program: &Program, to: At| {
            let all = program.blocks.iter().enumerate().flat_map(|(at, block)| {
                block.stmts.iter().enumerate().map(move |(count, stmt)| ((at, count), stmt))
            });
            all.filter(|(at, _)| (begin..=to).contains(at)).map(|(_, stmt)| stmt.clone()).collect::<Vec<_>>()
        };
        let contour: Vec<Stmt> =
            stmts(program, last).into_iter().filter(|stmt| stmt.kind != StmtKind::Comment).collect();
        // The number of the new last block, which may have one of its own.
        let own = program.blocks[previous.0].stmts[previous.1].site.sequence.get();
        let mut changes: Vec<(At, Option<[f64; 2]>)> =
            self.finishes.iter().map(|(at, from)| (*at, Some(*from))).collect();
        changes.push((last, None));
        changes.sort_by_key(|(at, _)| std::cmp::Reverse(*at));
        for block in &mut program.blocks {
            for stmt in &mut block.stmts {
                let StmtKind::Nc(nc) = &mut stmt.kind else { continue };
                let reads = nc.ops().any(Op::reads_contour)
                    && nc.word(Role::ContourLast).and_then(Expr::constant) == Some(f64::from(self.ends[1]));
                for item in nc.items.iter_mut().filter(|_| reads) {
                    if let (NcItem::Word(Role::ContourLast, value), Some(own)) = (item, own) {
                        *value = Expr::Number(f64::from(own));
                    }
                }
            }
        }
        let mut written = Vec::new();
        for ((block, count), from) in changes {
            let block = &mut program.blocks[block].stmts;
            let cycle = block.remove(count);
            match from {
                Some(from) => {
                    written.push(cycle.site.span);
                    block.splice(count..count, moves(&cycle, &contour, from));
                }
                None => {
                    if !cycle.site.comments.is_empty() {
                        let site = SourceInfo { sequence: None.into(), ..cycle.site.clone() };
                        block.insert(count, Stmt { kind: StmtKind::Comment, site });
                    }
                    if let (None, Some(stmt)) = (own, program.blocks[previous.0].stmts.get_mut(previous.1)) {
                        stmt.site.sequence = cycle.site.sequence;
                    }
                    let off = cycle.kind.nc().is_some_and(|nc| nc.has(Op::RadiusOff));
                    if let (true, Some(StmtKind::Nc(nc))) =
                        (off, program.blocks[previous.0].stmts.get_mut(previous.1).map(|stmt| &mut stmt.kind))
                    {
                        nc.items.retain(
                            |item| !matches!(item, NcItem::Op(op) if op.group() == Group::RadiusComp),
                        );
                        nc.items.insert(0, NcItem::Op(Op::RadiusOff));
                    }
                }
            }
        }
        written.reverse();
        written
    }
}

/// A finishing cycle as moves: what its block sets, the contour, and the way back to where it began.
fn moves(cycle: &Stmt, contour: &[Stmt], from: [f64; 2]) -> Vec<Stmt> {
    let mut site = cycle.site.clone();
    let rest = SourceInfo { span: cycle.site.span, ..SourceInfo::default() };
    let words = |item: &&NcItem| {
        !matches!(item, NcItem::Op(Op::Finish) | NcItem::Word(Role::ContourFirst | Role::ContourLast, _))
    };
    let sets: Vec<NcItem> =
        cycle.kind.nc().into_iter().flat_map(|nc| nc.items.iter().filter(words).cloned()).collect();
    let mut out = Vec::new();
    if !sets.is_empty() {
        out.push(Stmt { kind: StmtKind::Nc(Nc { items: sets }), site: std::mem::take(&mut site) });
    }
    for stmt in contour {
        let own = SourceInfo { span: stmt.site.span, ..SourceInfo::default() };
        let site = if out.is_empty() { std::mem::take(&mut site) } else { own };
        out.push(Stmt { kind: stmt.kind.clone(), site });
    }
    let [x, z] = from.map(Expr::Number);
    let back = vec![NcItem::Op(Op::Rapid), NcItem::Word(Role::X, x), NcItem::Word(Role::Z, z)];
    out.push(Stmt { kind: StmtKind::Nc(Nc { items: back }), site: rest });
    out
}
