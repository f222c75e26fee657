//! Spindle, coolant and tool change beside a move, which controls do with its start or when it is done.
//!
//! Law: what stands in a block of its own acts when that block comes, on every control. So a code goes before or after
//! the move, as the source does it, wherever no source says that the target does the same in one block. Beside a rapid
//! move or a wait nobody could tell in the work when spindle or coolant act: where the source does not say, they stay.
//! Where it matters and no source says it, the code goes where the trade has it, and the fact is named.
//! A T word of a lathe stays in the block of its move: whether the turret turns before the move, no source says (docs/lathe.md T5). Where a
//! builder's code acts when the turret has turned, T goes before the code, in a block of its own.
//! The blocks of a lathe's contour that the cycle counts on (the first, the last, a corner) stay whole where the target is taken to do the
//! same, and the fact is named. So do the blocks of single passes (G90, G92, G94), which M, S or T alone may make once more.
//! Counter-example: `G1 X5. M3 S1000`, which cuts with the spindle turning on one control, and then starts it on another.

mod turret;

use crate::canon::{Auxiliary, Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{self, BlockId, Module, Nc, NcItem, SourceInfo, Stmt, StmtKind, Stmts};
use crate::legalize::codes::pauses::{AFTER_CALL, pause_of};
use crate::legalize::features::Features;
use crate::legalize::{Context, Modal};

/// True where anything stands that may stand beside a move.
pub fn concerns(features: &Features) -> bool {
    features.any_op(|op| op.auxiliary().is_some()) || features.role(Role::Speed)
}

/// Puts what acts before or after the move of its block into blocks of its own; true if there was any.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let blocks = || module.programs.iter().flat_map(|program| &program.blocks);
    if !blocks().any(acts_beside) {
        return false;
    }
    let facts = context.modal_facts(module);
    let contours = context.features.any_op(Op::reads_contour);
    let pauses = blocks().flat_map(|block| &block.stmts).any(|stmt| pause_of(&stmt.kind).is_some());
    let (mut out, mut changed) = (Stmts::new(), false);
    for (index, program) in module.programs.iter_mut().enumerate() {
        let ends = [Role::ContourFirst, Role::ContourLast]
            .map(|role| if contours { named(program, role) } else { Vec::new() });
        for (at, block) in program.blocks.iter_mut().enumerate().filter(|(_, block)| acts_beside(block)) {
            let mut state = facts.at(index, BlockId(at as u32));
            let mut cornered = false;
            for stmt in block.stmts.drain(..) {
                let before = stmt.kind.nc().is_some_and(|nc| kinds(nc).next().is_some());
                let before = before.then(|| state.clone());
                let in_pass = passes(&state);
                state.step(&stmt);
                let corner = stmt.kind.nc().is_some_and(has_corner);
                let number = stmt.site.sequence.get();
                let [first, last] =
                    ends.each_ref().map(|ends| number.is_some_and(|number| ends.contains(&number)));
                // A jump to the number would pass over what acts before the move.
                let ends = last && !first && !out.is_empty();
                let head = first || cornered || in_pass;
                let whole = Whole { head, tail: last || corner || passes(&state), ends };
                cornered = corner;
                match before {
                    Some(before) => {
                        let span = stmt.site.span;
                        let apart = split(index, stmt, &before, (pauses, whole), context, &mut out);
                        if apart && (in_pass || passes(&state)) {
                            context.rests_on_target(index, span, Question::PassAlone);
                        }
                        changed |= apart;
                    }
                    None => out.push(stmt),
                }
            }
            block.stmts.reserve_exact(out.len());
            block.stmts.append(&mut out);
        }
    }
    changed
}

/// The sequence numbers that words of a role name.
fn named(program: &ir::Program, role: Role) -> Vec<u32> {
    let stmts = program.blocks.iter().flat_map(|block| &block.stmts);
    let words = stmts.filter_map(|stmt| stmt.kind.nc()?.word(role)?.constant());
    words.map(|number| number as u32).collect()
}

/// True where a turning pass is in force, which M, S or T alone may make once more.
fn passes(modal: &Modal) -> bool {
    modal.op(Group::Motion).is_some_and(Op::is_pass)
}

/// Where nothing may come between a block and its neighbour: before it, as it begins a contour, a corner waits for it or a turning pass is in
/// force, or after it, as it ends a contour, has a corner or leaves a pass in force.
#[derive(Clone, Copy)]
struct Whole {
    head: bool,
    tail: bool,
    /// True for the last block of a contour: what acts before its move is still in the contour, and the number goes with the move.
    ends: bool,
}

/// True for a line whose end the next block says too: with a corner, or by its angle.
fn has_corner(nc: &Nc) -> bool {
    nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if role.is_drawn()))
}

/// True for a block with a statement that may move and does something else too.
fn acts_beside(block: &ir::Block) -> bool {
    block.stmts.iter().filter_map(|stmt| stmt.kind.nc()).any(|nc| kinds(nc).next().is_some() && may_move(nc))
}

/// True for a statement that moves or waits in one state or another.
fn may_move(nc: &Nc) -> bool {
    nc.ops().any(|op| cuts(op) || waits(op)) || names_place(nc)
}

fn cuts(op: Op) -> bool {
    op.is_cycle() || op.is_lathe_cycle() || matches!(op, Op::CycleHere | Op::Probe | Op::ProbeOther)
}

fn waits(op: Op) -> bool {
    matches!(op, Op::Dwell | Op::ReferenceReturn | Op::ReferenceFrom | Op::Reference2 | Op::Home)
}

/// True where words say where to.
fn names_place(nc: &Nc) -> bool {
    let words = |role: Role| {
        matches!(role, Role::PolarAngle | Role::PolarDistance | Role::ArcI | Role::ArcJ | Role::ArcK)
    };
    nc.moves() || nc.items.iter().any(|item| matches!(item, NcItem::Word(role, _) if words(*role)))
}

/// Lays down a statement, and around it what acts before or after its move; true if there is any.
fn split(
    index: usize,
    mut stmt: Stmt,
    before: &Modal,
    (pauses, whole): (bool, Whole),
    context: &mut Context<'_>,
    out: &mut Stmts,
) -> bool {
    let StmtKind::Nc(nc) = &mut stmt.kind else {
        out.push(stmt);
        return false;
    };
    let moves = move_of(nc, before);
    if moves == Move::None {
        out.push(stmt);
        return false;
    }
    let mut block =
        Block { nc, before, pauses, whole, moves, early: Vec::new(), late: Vec::new(), theirs: Vec::new() };
    for fact in block.split(context) {
        context.rests_on_source(index, stmt.site.span, fact);
    }
    let Block { mut early, late, theirs, .. } = block;
    for fact in theirs {
        context.rests_on_target(index, stmt.site.span, fact);
    }
    let changed = !early.is_empty() || !late.is_empty();
    turret::ordered(&mut early, &mut stmt, index, context);
    if !late.is_empty() && before.may_call() {
        context.add(index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, AFTER_CALL));
    }
    let site = |first: bool, stmt: &mut Stmt| SourceInfo {
        span: stmt.site.span,
        sequence: if first { std::mem::take(&mut stmt.site.sequence) } else { None.into() },
        skip: stmt.site.skip,
        ..SourceInfo::default()
    };
    for (at, items) in early.into_iter().enumerate() {
        let site = site(at == 0 && !whole.ends, &mut stmt);
        out.push(Stmt { kind: StmtKind::Nc(Nc { items }), site });
    }
    let behind = late.into_iter().map(|items| (items, site(false, &mut stmt))).collect::<Vec<_>>();
    out.push(stmt);
    out.extend(behind.into_iter().map(|(items, site)| Stmt { kind: StmtKind::Nc(Nc { items }), site }));
    changed
}

/// What a block moves.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Move {
    /// Nothing.
    None,
    /// At rapid, or it waits.
    Idle,
    /// The tool may cut.
    Cut,
}

fn move_of(nc: &Nc, before: &Modal) -> Move {
    if nc.ops().any(cuts) {
        return Move::Cut;
    }
    if nc.ops().any(waits) {
        return Move::Idle;
    }
    if !names_place(nc) {
        return Move::None;
    }
    let mut state = before.clone();
    state.step_words(nc);
    let drills = state.op(Group::Cycle) != Some(Op::CycleOff);
    let rapid = nc.ops().any(|op| op == Op::RapidOnce) || state.op(Group::Motion) == Some(Op::Rapid);
    if rapid && !drills && !before.may_call() { Move::Idle } else { Move::Cut }
}

/// What kind an item is of; a speed beside a code that starts the spindle goes with that.
fn kind(item: &NcItem, starts: bool) -> Option<Auxiliary> {
    match item {
        NcItem::Op(op) => op.auxiliary(),
        NcItem::Code('M', _) => Some(Auxiliary::Other),
        NcItem::Word(Role::Speed, _) if !starts => Some(Auxiliary::Speed),
        NcItem::Code(..) | NcItem::Word(..) => None,
    }
}

fn starts(nc: &Nc) -> bool {
    nc.has(Op::SpindleCw) || nc.has(Op::SpindleCcw)
}

fn kinds(nc: &Nc) -> impl Iterator<Item = Auxiliary> + '_ {
    let starts = starts(nc);
    nc.items.iter().filter_map(move |item| kind(item, starts))
}

/// True for what goes where a code goes: the speed of a spindle that starts and how it counts, the tool of a change, what a
/// builder's code takes.
pub(in crate::legalize) fn belongs(item: &NcItem, code: &NcItem) -> bool {
    match item {
        NcItem::Word(Role::Speed, _) => matches!(code, NcItem::Op(Op::SpindleCw | Op::SpindleCcw)),
        // G97 without its S would take the number that G96 left.
        NcItem::Op(op) if op.group() == Group::SpeedMode => {
            matches!(code, NcItem::Op(Op::SpindleCw | Op::SpindleCcw) | NcItem::Word(Role::Speed, _))
        }
        NcItem::Word(Role::Tool, _) => *code == NcItem::Op(Op::ToolChange),
        NcItem::Word(Role::Output, _) => matches!(code, NcItem::Op(Op::OutputOn | Op::OutputOff)),
        NcItem::Word(role, _) if *role == Role::Act || role.is_act_word() => *code == NcItem::Op(Op::Act),
        _ => false,
    }
}

/// A block that moves, and what goes before it and after it, a block each.
struct Block<'b> {
    nc: &'b mut Nc,
    before: &'b Modal,
    /// True where the library has stops: the target may end at one what the source lets run.
    pauses: bool,
    whole: Whole,
    moves: Move,
    early: Vec<Vec<NcItem>>,
    late: Vec<Vec<NcItem>>,
    /// What the target is taken to do alike, and no source says.
    theirs: Vec<Question>,
}

impl Block<'_> {
    /// Takes out what does not stay; the unconfirmed facts about the source that this rests on.
    fn split(&mut self, context: &Context<'_>) -> Vec<Question> {
        let (mut facts, starts) = (Vec::new(), starts(self.nc));
        let mut wanted: Vec<Auxiliary> = kinds(self.nc).collect();
        wanted.sort();
        wanted.dedup();
        let changes = wanted.contains(&Auxiliary::Change);
        for kind in wanted {
            let (here, there) = (context.source.acts(kind), context.target.acts(kind));
            let tells = self.tells(kind);
            if !here.known && tells {
                facts.push(here.question);
            }
            // A tool in the changer does not turn: what starts waits for the change.
            let waits = changes && !kind.waits() && context.source.acts(Auxiliary::Change).late;
            let late = here.late || waits;
            // In one block the code acts before the turret turns or after, as each machine has it.
            let turns = kind == Auxiliary::Other && !late && turret::turns(self.nc);
            let alike = !turns || turret::answer(context.source) == turret::answer(context.target);
            let same = there.known && there.late == late && alike;
            let whole = if late { self.whole.tail } else { self.whole.head };
            if whole && !waits && there.late == late {
                self.theirs.extend(tells.then_some(there.question));
                continue;
            }
            // Of a builder's code nothing says which block it may stand in.
            if same || (!waits && !here.known && (!tells || kind == Auxiliary::Other)) {
                continue;
            }
            if here.known && !there.known && context.source.name() == context.target.name() {
                // Whoever said it of one machine can say it of the other, and the block stays whole.
                self.theirs.push(there.question);
            }
            self.take(kind, starts, late);
        }
        self.spread(context);
        self.stop_last();
        facts
    }

    /// A program stop waits for what goes after the move.
    fn stop_last(&mut self) {
        let stops = |item: &NcItem| matches!(item, NcItem::Op(Op::Stop | Op::OptionalStop));
        if self.late.is_empty() || !self.nc.items.iter().any(stops) {
            return;
        }
        let (stop, kept) = std::mem::take(&mut self.nc.items).into_iter().partition(stops);
        self.nc.items = kept;
        self.late.push(stop);
    }

    /// True where anybody could tell when a kind acts.
    fn tells(&self, wanted: Auxiliary) -> bool {
        match wanted {
            Auxiliary::Change | Auxiliary::Other => true,
            _ => self.moves == Move::Cut && self.nc.ops().any(|op| self.switches(op, wanted)),
        }
    }

    /// True for an operation of a kind that may change what is in force.
    fn switches(&self, op: Op, wanted: Auxiliary) -> bool {
        let other = self.pauses || self.before.op(op.group()) != Some(op);
        op.auxiliary() == Some(wanted) && (other || self.nc.word(Role::Speed).is_some())
    }

    /// Moves a kind out of the block: a code each, in their order.
    fn take(&mut self, wanted: Auxiliary, starts: bool, late: bool) {
        let items = std::mem::take(&mut self.nc.items);
        let codes: Vec<NcItem> =
            items.iter().filter(|item| kind(item, starts) == Some(wanted)).cloned().collect();
        let mut rest = items;
        for code in codes {
            let goes = |item: &NcItem| *item == code || belongs(item, &code);
            let (block, kept): (Vec<_>, Vec<_>) = rest.into_iter().partition(goes);
            rest = kept;
            if late { self.late.push(block) } else { self.early.push(block) }
        }
        self.nc.items = rest;
    }

    /// Leaves no more M codes beside the move than the target takes: the last that starts something, or the first that
    /// stops something.
    fn spread(&mut self, context: &Context<'_>) {
        let most = context.target.behaviour(Question::MCodesPerBlock).filter(|row| row.origin.is_settled());
        let most = most
            .map_or(1, |row| if row.value == "any" { usize::MAX } else { row.value.parse().unwrap_or(1) });
        loop {
            let codes: Vec<(Auxiliary, NcItem)> =
                (self.nc.items.iter()).filter_map(|item| Some((kind(item, true)?, item.clone()))).collect();
            if codes.len() <= most {
                return;
            }
            if context.source.name() == context.target.name()
                && !self.theirs.contains(&Question::MCodesPerBlock)
            {
                let row = context.target.behaviour(Question::MCodesPerBlock);
                self.theirs.extend(row.filter(|row| !row.origin.is_settled()).map(|row| row.question));
            }
            // What starts waits for a change beside it.
            let changes = codes.iter().any(|(kind, _)| *kind == Auxiliary::Change);
            let goes = |kind: Auxiliary| !changes && !kind.waits() && kind != Auxiliary::Speed;
            let first = codes.iter().find(|(kind, _)| goes(*kind));
            let late = first.is_none();
            // Of those that wait the one that acts last goes first: a stop comes after a change.
            let last = || codes.iter().max_by_key(|(kind, _)| *kind);
            let Some((_, code)) = first.or_else(last) else { return };
            let goes = |item: &NcItem| item == code || belongs(item, code);
            let (block, kept) = std::mem::take(&mut self.nc.items).into_iter().partition(goes);
            self.nc.items = kept;
            if late { self.late.insert(0, block) } else { self.early.push(block) }
        }
    }
}
