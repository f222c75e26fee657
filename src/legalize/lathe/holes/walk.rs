//! The walk through the drilling blocks of a program.

use super::all::{All, all, stopped};
use super::called_waits::Followed;
use super::known::{Cycle, Turning};
use super::levels::Levels;
use super::pecks::Peck;
use super::rigid::{drilling, drop_rigid, rigid_after};
use super::waits::{Waits, other_waits};
use super::{by_place, by_step, drills, tells_all};
use crate::assume::Predicate;
use crate::canon::{Group, Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Expr, Module, Nc, NcItem, Stmt, StmtKind, Stmts, TermKind};
use crate::legalize::features::Feature;
use crate::legalize::lathe::place::{Place, changes_coordinates};
use crate::legalize::lathe::places::{at_blocks, may_be_entered};
use crate::legalize::lathe::straight::entered_straight;
use crate::legalize::layout::blanks::is_empty;
use crate::legalize::{Context, Modal};
use crate::text::Span;
use std::collections::BTreeMap;

/// Why a hole is refused, and what to do.
pub(super) type Refused = (&'static str, &'static str);

/// What the target does otherwise: what, what to do, the operation, and whether it is asked once for all programs.
pub(super) type Asked = (&'static str, &'static str, Op, bool);

/// A block that drills.
pub(super) struct Hole<'h> {
    pub nc: Nc,
    /// The source's code of the cycle.
    pub op: Op,
    /// True where the block has a code of a cycle.
    pub begins: bool,
    /// True where no cycle was in force before it.
    pub fresh: bool,
    /// Where the tool stands before it.
    pub place: Place,
    /// The same along the axis of the hole, where it is computed.
    pub computed: Option<Expr>,
    pub cycle: &'h mut Cycle,
    pub all: &'h All,
    pub target: &'h Control,
    pub turning: Turning,
    /// What P is told before it.
    pub waits: Waits,
    pub asked: Vec<Asked>,
    /// How long the peck of a hole of the target lasts, and whether this hole rests on that.
    pub peck: (Peck, bool),
    /// Blocks that go before it.
    pub before: Vec<Nc>,
    /// Blocks that go after it.
    pub after: Vec<Nc>,
    /// True where rapid traverse is in force before and after it.
    pub rapid: bool,
}

impl Hole<'_> {
    pub fn side(&self) -> bool {
        self.op.is_side_hole()
    }

    /// The axis word of the depth, and its increment.
    pub fn depth(&self) -> (Role, Role) {
        if self.side() { (Role::X, Role::StepX) } else { (Role::Z, Role::StepZ) }
    }

    /// Where the cycle began, if that is a known number.
    pub fn level(&self) -> Option<f64> {
        if self.side() { self.place.x() } else { self.place.z() }
    }

    /// Puts a word in the place of another, or at the end.
    pub fn put(&mut self, old: Role, new: Role, value: Expr) {
        let item = NcItem::Word(new, value);
        match self.nc.items.iter().position(|item| matches!(item, NcItem::Word(role, _) if *role == old)) {
            Some(at) => self.nc.items[at] = item,
            None => self.nc.items.push(item),
        }
    }

    /// Puts a word before the feed, or at the end.
    pub fn add_before_feed(&mut self, role: Role, value: Expr) {
        let feed = |item: &NcItem| matches!(item, NcItem::Word(Role::Feed, _));
        let at = self.nc.items.iter().position(feed).unwrap_or(self.nc.items.len());
        self.nc.items.insert(at, NcItem::Word(role, value));
    }

    pub fn drop(&mut self, role: Role) {
        self.nc.items.retain(|item| !matches!(item, NcItem::Word(found, _) if *found == role));
    }

    /// Writes the code of the cycle, in place of the source's or before the words.
    pub fn write(&mut self, op: Op) {
        let code = |item: &NcItem| matches!(item, NcItem::Op(op) if op.is_hole());
        match self.nc.items.iter().position(code) {
            Some(at) => self.nc.items[at] = NcItem::Op(op),
            None => self.nc.items.insert(0, NcItem::Op(op)),
        }
        self.cycle.written = Some(op);
    }

    pub fn has(&self, op: Op) -> bool {
        self.target.code_for(op, &BTreeMap::new()).is_some()
    }
}

pub(super) fn run(module: &mut Module, context: &mut Context<'_>, by_steps: bool) {
    let (facts, stopped) = (context.modal_facts(module), stopped(module, context));
    let other_waits = other_waits(&context.features, by_steps);
    let turns = |op| context.features.op(op);
    let waits = Waits::of(context.source, module);
    let stands = !turns(Op::SpindleCw) && !turns(Op::SpindleCcw) && !context.features.has(Feature::Code);
    let mut found: Vec<(usize, Diagnostic)> = Vec::new();
    let (mut is_ended, mut open) = (false, Vec::new());
    let peck = Peck::of(context.target, context.features.role(Role::CycleQ));
    let entered = may_be_entered(module);
    let over = (waits.calls_apart() && !entered).then(|| Followed::over(&waits, module));
    for (index, program) in module.programs.iter_mut().enumerate() {
        let states: Vec<Modal> = program.ids().map(|id| facts.at(index, id)).collect();
        let all = all(program, &states);
        let all =
            All { other_waits: other_waits || all.other_waits, stands, is_stopped: stopped[index], ..all };
        let straight = entered_straight(program);
        let begin = Place::keeping_level();
        let places = at_blocks(program, begin, entered);
        let told = match &over {
            Some(over) => program.ids().map(|id| over.at(index, id).copied().unwrap_or_default()).collect(),
            None => waits.at_blocks((index, program), entered),
        };
        let mut walk = Walk {
            cycle: Cycle::default(),
            place: begin,
            levels: Levels::default(),
            speed: None,
            is_said: false,
            stands: false,
            rigid: false,
            waits: waits.clone(),
            is_ended: false,
            open: Vec::new(),
            rests: BTreeMap::new(),
            peck,
        };
        walk.waits.come_in(told.first().copied().unwrap_or_default());
        for (at, ((block, mut state), straight)) in
            program.blocks.iter_mut().zip(states).zip(straight).enumerate()
        {
            if !straight {
                walk.cycle = Cycle::default();
                walk.place = places.get(at).copied().unwrap_or(begin);
                (walk.speed, walk.is_said, walk.stands, walk.rigid) = (None, false, false, false);
            }
            if !straight || over.is_some() {
                walk.waits.come_in(told.get(at).copied().unwrap_or_default());
            }
            let drilling = drilling(block);
            let mut out = Stmts::with_capacity(block.stmts.len());
            for mut stmt in std::mem::take(&mut block.stmts) {
                let span = stmt.site.span;
                walk.rigid = rigid_after(walk.rigid, &stmt, &drilling);
                if !by_steps {
                    // A speed that is said again would say of a spindle that stands how fast it turns.
                    let again = walk.stands && state.op(Group::Spindle).is_none();
                    drop_rigid(&mut stmt, context.target, walk.speed.filter(|_| again));
                    if again && is_empty(&stmt) {
                        continue;
                    }
                }
                match walk.stmt(&stmt, &mut state, (&all, context.target, by_steps)) {
                    None => out.push(stmt),
                    Some(Ok((made, asked))) => {
                        out.extend(made);
                        found.extend(asked.into_iter().map(|(what, help, op, once)| {
                            let told = Diagnostic::new(Code::Conditional, span, what).with_help(help);
                            let told = told.assuming(supposed(what, (op, span)));
                            (index, if once { told.asked_once() } else { told })
                        }));
                    }
                    Some(Err((what, help))) => {
                        found.push((index, Diagnostic::new(Code::NoEquivalent, span, what).with_help(help)));
                        out.push(stmt);
                    }
                }
            }
            block.stmts = out;
            let calls = matches!(block.term.kind, TermKind::Call { .. });
            if calls && walk.takes_wait(state.op(Group::Cycle), &all) {
                let refused = Diagnostic::new(Code::NoEquivalent, block.term.site.span, CALLS);
                found.push((index, refused.with_help(CALLS_HELP)));
            }
        }
        for (question, span) in walk.rests.into_values() {
            match question == Question::HolePeckLasts {
                true => context.rests_on_target(index, span, question),
                false => context.rests_on_source(index, span, question),
            }
        }
        is_ended |= walk.is_ended;
        open.extend(walk.open.into_iter().map(|span| (index, span)));
    }
    for (index, span) in open.into_iter().filter(|_| is_ended) {
        found.push((index, Diagnostic::new(Code::NoEquivalent, span, OPEN).with_help(OPEN_HELP)));
    }
    for (index, diagnostic) in found {
        let fact = format!("{} {:?}", diagnostic.message, diagnostic.span);
        context.add_once(index, &fact, diagnostic);
    }
}

/// What a walk knows.
struct Walk {
    cycle: Cycle,
    place: Place,
    levels: Levels,
    /// The last speed.
    speed: Option<f64>,
    /// True where a block gave the last speed.
    is_said: bool,
    /// True where the spindle that turns the part was stopped, and taps of live tools alone came since.
    stands: bool,
    /// True where a code made the next taps rigid, with their speed.
    rigid: bool,
    waits: Waits,
    /// True where a move after a hole ended the target's cycle.
    is_ended: bool,
    /// Holes without a code, of a cycle that other ways lead to too.
    open: Vec<Span>,
    /// What holes rest on that no source confirms, each with the first hole.
    rests: BTreeMap<&'static str, (Question, Span)>,
    /// How long the peck of a hole of the target lasts.
    peck: Peck,
}

/// What becomes of a block that drills, and what is asked.
type Made = Result<(Vec<Stmt>, Vec<Asked>), Refused>;

impl Walk {
    /// True where a hole of the cycle in force takes the last P of any code for its wait, on one of the two controls.
    fn takes_wait(&self, cycle: Option<Op>, all: &All) -> bool {
        // Which code the target has in force after a loop or a jump, is not known here.
        let may = matches!(cycle, Some(Op::FaceHole | Op::SideHole | Op::FaceBore | Op::SideBore))
            && self.cycle.written.is_none()
            && !(all.pecks.is_empty() && all.dwells.is_empty());
        let waits = |op: Option<Op>| op.is_some_and(Op::is_waiting_hole);
        let counts = self.cycle.dwell.as_ref().is_some_and(|wait| wait.constant() != Some(0.0));
        cycle.is_some_and(Op::is_hole) && (may || counts || waits(cycle) || waits(self.cycle.written))
    }

    /// Takes a statement; none where it stays as it is.
    fn stmt(
        &mut self,
        stmt: &Stmt,
        state: &mut Modal,
        (all, target, by_steps): (&All, &Control, bool),
    ) -> Option<Made> {
        let (before, spindle) = (state.op(Group::Cycle), state.op(Group::Spindle));
        let motion = state.op(Group::Motion);
        state.step(stmt);
        let turns =
            |nc: &Nc| nc.ops().any(|op| op.group() == Group::Spindle) || nc.word(Role::Speed).is_some();
        let says = stmt.kind.nc().is_some_and(turns);
        let stands = spindle == Some(Op::SpindleStop) || self.stands && spindle.is_none();
        self.stands = stands && !says;
        let waits = self.waits.clone();
        self.waits.take(stmt);
        self.place.enter(stmt);
        self.levels.enter(stmt, &mut self.place);
        let place = stmt.kind.nc().map_or(self.place, |nc| self.place.counted_in(nc));
        self.place.step(stmt);
        self.cycle.shifted |= stmt.kind.nc().is_some_and(changes_coordinates);
        let nc = match &stmt.kind {
            StmtKind::Nc(nc) => nc,
            StmtKind::Comment | StmtKind::Assign { .. } => return None,
            kind => {
                let calls = matches!(kind, StmtKind::ModalCall(_)) && self.takes_wait(before, all);
                self.cycle = Cycle::default();
                (self.speed, self.is_said, self.stands) = (None, false, false);
                return calls.then_some(Err((CALLS, CALLS_HELP)));
            }
        };
        if let Some(speed) = nc.word(Role::Speed) {
            self.speed = speed.constant().filter(|_| stmt.site.skip.is_none());
            let none = speed.constant().is_some_and(|speed| speed <= 0.0);
            self.is_said = stmt.site.skip.is_none() && !none;
        }
        if nc.has(Op::Dwell) && self.takes_wait(before, all) {
            return Some(Err((WAITS, "end the cycle before the wait, and write it again after it")));
        }
        let op = drills(nc, state)?;
        let begins = nc.ops().any(Op::is_hole);
        if stmt.site.skip.is_some() {
            return Some(Err((
                SKIPPED,
                "give the block a condition, or write its words in the block after it too",
            )));
        }
        if op.is_waiting_hole() && nc.word(Role::CycleDwell).is_none() {
            let builders = waits.after_builders().then_some(Question::HoleWaitBuilders);
            let calls = waits.after_calls().then_some(Question::HoleWaitCalls);
            for question in builders.into_iter().chain(calls) {
                self.rests.entry(question.fact()).or_insert((question, stmt.site.span));
            }
        }
        let fresh = before == Some(Op::CycleOff);
        let surface = state.op(Group::SpeedMode) == Some(Op::SurfaceSpeed);
        let turning = Turning {
            speed: self.speed.filter(|speed| *speed > 0.0 && !surface),
            is_said: self.is_said && !surface,
            by_turn: state.op(Group::FeedMode) == Some(Op::FeedPerTurn),
            stands: all.stands || stands,
            rigid: self.rigid,
        };
        if before.is_none() {
            // If one is in force, it began where the tool stands on every way, as its holes end there.
            let level = if op.is_side_hole() { place.x() } else { place.z() };
            if !begins || level.is_none() || !tells_all(nc, op, by_steps) {
                return Some(Err((UNKNOWN, UNKNOWN_HELP)));
            }
            self.cycle = Cycle { initial: level, ..Cycle::default() };
        } else if fresh {
            self.cycle = Cycle { pecked: Some(false), ..Cycle::default() };
        } else if self.cycle.shifted {
            return Some(Err((SHIFTED, "end the cycle before it (G80), and write it again after it")));
        }
        if !fresh && !begins && self.cycle.written.is_none() {
            self.open.push(stmt.site.span);
        }
        let computed = self.levels.level(&place, op.is_side_hole());
        let mut hole = Hole {
            computed,
            nc: nc.clone(),
            op,
            begins,
            fresh,
            place,
            cycle: &mut self.cycle,
            all,
            target,
            turning,
            waits,
            asked: Vec::new(),
            peck: (self.peck, false),
            before: Vec::new(),
            after: Vec::new(),
            rapid: motion == Some(Op::Rapid) && state.op(Group::Motion) == motion,
        };
        let done = if by_steps { by_step::change(&mut hole) } else { by_place::change(&mut hole) };
        if hole.peck.1 {
            let question = Question::HolePeckLasts;
            self.rests.entry(question.fact()).or_insert((question, stmt.site.span));
        }
        let Ok(times) = done else { return done.err().map(Err) };
        let (nc, asked, lead, tail) = (hole.nc, hole.asked, hole.before, hole.after);
        self.is_ended |= self.cycle.is_ended;
        // The spindle that turns the part is after a tap of a live tool as before it (docs/lathe.md Q11), after others it may turn.
        self.stands &= self.cycle.written.is_none_or(|op| !op.is_tap() || op.is_live_tap());
        let again = Nc { items: nc.items.iter().filter(|item| says_again(item)).cloned().collect() };
        let first = Stmt { kind: StmtKind::Nc(nc), site: stmt.site.clone() };
        let site = crate::ir::SourceInfo { span: stmt.site.span, ..Default::default() };
        let more = Stmt { kind: StmtKind::Nc(again), site: site.clone() };
        let new = |nc| Stmt { kind: StmtKind::Nc(nc), site: site.clone() };
        let holes = [first].into_iter().chain(std::iter::repeat_n(more, times - 1));
        let made = lead.into_iter().map(new).chain(holes).chain(tail.into_iter().map(new));
        Some(Ok((made.collect(), asked)))
    }
}

/// What a finding about a hole supposes.
fn supposed(what: &str, (op, span): (Op, Span)) -> Predicate {
    match op.is_side_hole() {
        _ if what == by_place::PECKS => Predicate::Pecks(vec![span]),
        _ if ![by_step::COMPUTED, by_place::COMPUTED].contains(&what) => Predicate::Substitute(op),
        true => Predicate::Levels(vec![span], 0),
        false => Predicate::Levels(vec![span], 2),
    }
}

/// True for what each repeat of a hole is told: its place.
fn says_again(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, _) if role.is_axis())
}

const SHIFTED: &str = "an offset or a shift came while this drilling cycle was in force: no source says whether its planes move with it";
const SKIPPED: &str = "a block skip before a drilling block: what lasts from it is not known after it";
const WAITS: &str =
    "a G4 in a drilling cycle that waits: on one of the two controls its P is the wait of the next hole too";
const CALLS: &str = "a call in a drilling cycle that waits: on one of the two controls the P of the call is the wait of the next hole too";
const CALLS_HELP: &str = "end the cycle before the call (G80), and write it again, with its P, after it";
const OPEN: &str = "a hole without a code of its own, to which other ways lead, while a hole of the library begins below its plane: its way back ends the target's cycle";
const OPEN_HELP: &str = "write the code of the cycle, with its words, into this block too";
const UNKNOWN: &str = "whether a drilling cycle is in force before this one is not known";
const UNKNOWN_HELP: &str = "write G80, or G0 and a place, before the cycle";
