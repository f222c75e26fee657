//! Spindle and coolant at stops, tool changes and ends, which controls end or let run.
//!
//! Law: what the source ends at a stop is ended by codes before it, wherever no source says that the target's stop does so:
//! that is the same on every control. An optional stop takes none, as nothing ends where it is switched off, and a tool
//! change is left to the machine, unless its table says nothing of it and something is known to run. Where the target's
//! profile says that they end nothing there, both take them, an optional stop M5 only if the program says what turns before
//! it cuts: where it is switched off, the target then does what the source does where it is on. What a stop ends
//! matters after it where the program cuts before it says itself what runs: then the facts that no source confirms are
//! named. A change that the target passes over where the tool is in the spindle ends nothing there, unless it is known to be another.
//! What a message or a stop leaves running, and the target's stop ends, is started again after it where it is known, after an optional stop too,
//! if the tool moves or a wait comes before the program says itself what runs.
//! Counter-example: `M3 S1000` .. `M0 (TURN THE PART)`, where one control stops the spindle and another one's builder decides.

mod after;
mod kinds;
mod lay;
mod lost;
mod related;
mod switched;
mod touched;

use crate::canon::{Group, Op, Pause, Running};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Ends;
use crate::ir::analysis::over_calls::OverCalls;
use crate::ir::{Block, BlockId, Module, StmtKind, TermKind};
use crate::legalize::features::{Feature, Features};
use crate::legalize::{Context, Modal};
use crate::text::Span;
use after::After;
pub(in crate::legalize) use kinds::pause_of;
use kinds::{ends_run, has_messages, restarts, stops_in, tool_after, written};
use lay::{Again, lay};
pub(in crate::legalize) use related::related;
use related::{spread, started};
use std::collections::BTreeMap;
use switched::{Switched, Switches};
use touched::{Touched, Touches};

/// Why what acts after a move cannot have a block of its own where that move runs a modal call.
pub(in crate::legalize) const AFTER_CALL: &str = "a modal call is in force, and this block does something \
                                                  after its move: on the target that would come after the \
                                                  call. Put it into a block before the move, or after the \
                                                  end of the modal call";

/// True where something that may be running is started, or runs from the start: in a piece of a program.
pub fn concerns(features: &Features, entry: &Modal) -> bool {
    let runs = |running: Running| entry.op(ends(running).0);
    let may = |running: Running| {
        starts_in(features, running) || starts(running).iter().any(|op| runs(running) == Some(*op))
    };
    Running::ALL.into_iter().any(may)
}

/// True where something may start it: its codes, a code by a variable, or a tap the spindle.
fn starts_in(features: &Features, running: Running) -> bool {
    let taps = running == Running::Spindle && features.any_op(Op::is_tap);
    taps || features.has(Feature::MachineCode) || starts(running).iter().any(|op| features.op(*op))
}

/// What starts it.
fn starts(running: Running) -> &'static [Op] {
    match running {
        Running::Spindle => &[Op::SpindleCw, Op::SpindleCcw],
        Running::Coolant => &[Op::Mist, Op::Flood],
    }
}

/// Its group, and what ends it.
fn ends(running: Running) -> (Group, Op) {
    match running {
        Running::Spindle => (Group::Spindle, Op::SpindleStop),
        Running::Coolant => (Group::Coolant, Op::CoolantOff),
    }
}

/// One way has the spindle turning, and another one holds it.
const LETS_GO: &str = "the M5 before this stop releases a spindle that M19 holds: write M3 or M19 again \
                       after the stop";

/// A cut with coolant or without it, as the switch is.
const DRY: &str = "M9 is written before this optional stop, as the target's leaves coolant on: where the switch is off, coolant \
                   is off too until the program switches it on again; write M8 after the stop, before the next cut";

/// Ends before stops what the source ends at them; true if that changed anything.
pub fn run(module: &mut Module, context: &mut Context<'_>) -> bool {
    let stops = stops(module, context);
    let changes = !stops.is_empty();
    for Stop { place: (index, id), before, again } in stops {
        let Some(block) = module.programs[index].blocks.get_mut(id.index()) else { continue };
        lay(block, before, &again);
    }
    changes
}

/// What has to be ended in a block before its stops.
struct Stop {
    place: (usize, BlockId),
    /// By the number of a statement, past the last for the end of the block.
    before: BTreeMap<usize, Vec<Op>>,
    /// What is started again, by the number of the statement that it comes after.
    again: Vec<Again>,
}

/// The blocks in which something has to be ended.
fn stops(module: &Module, context: &mut Context<'_>) -> Vec<Stop> {
    let mut found = Vec::new();
    // The text of a piece of a program ends, and the run does not.
    let piece = if context.goes_on { module.programs.len().checked_sub(1) } else { None };
    let run_ends =
        |index: usize, kind: &TermKind| ends_run(kind) && !(piece == Some(index) && *kind == TermKind::Stray);
    let stops = |index: usize, block: &Block| run_ends(index, &block.term.kind) || stops_in(block);
    let any = |asks: &dyn Fn(usize, &Block) -> bool| {
        let mut programs = module.programs.iter().enumerate();
        programs.any(|(index, program)| program.blocks.iter().any(|block| asks(index, block)))
    };
    if !any(&stops) {
        return found;
    }
    context.count(module);
    let started = started(module, context);
    // What nothing starts that the program has to do with, and no run finds running, does not run there.
    let found_running = |running: Running| match context.entry.op(ends(running).0) {
        Some(op) => starts(running).contains(&op),
        None => false,
    };
    let entered = Running::ALL.into_iter().any(found_running);
    let may_run = |index: usize| entered || started[index] != [false; 2];
    let asks = |index: usize, block: &Block| may_run(index) && stops(index, block);
    if !any(&asks) {
        return found;
    }
    let facts = context.modal_facts(module);
    let holds = related(module, context, |features| features.op(Op::SpindleOrient));
    let mut lost = lost::lost(module, context.source);
    spread(&mut lost, module, context);
    let passes = context.target.skips_same_tool() && !context.source.skips_same_tool();
    let after = After::of(module, &facts, [context.source, context.target]);
    let touches = OverCalls::of(module, &Touches([context.source, context.target]));
    let switches = Switches::of(module, &context.entry);
    for (index, program) in module.programs.iter().enumerate() {
        for (id, block) in program.ids().zip(&program.blocks).filter(|(_, block)| asks(index, block)) {
            let mut place = Place {
                index,
                id,
                state: facts.at(index, id),
                restarted: [false; 2],
                skipped: false,
                ends: run_ends(index, &block.term.kind),
                started: started[index],
                holds: holds[index],
                lost: lost[index],
                after: &after,
                again: Vec::new(),
                switched: switches.at(index, id).copied().unwrap_or_else(Switched::unknown),
                tool: None,
                touched: touches.at(index, id).copied().unwrap_or_default(),
                stood_in: false,
                is_plain_stop: false,
                passes,
            };
            let before = place.block(block, context);
            let again = std::mem::take(&mut place.again);
            if !before.is_empty() || !again.is_empty() {
                found.push(Stop { place: (index, id), before, again });
            }
        }
    }
    found
}

/// A place in a program.
struct Place<'p> {
    index: usize,
    id: BlockId,
    state: Modal,
    /// What the block of a tool change starts after it.
    restarted: [bool; 2],
    /// True where a block skip may leave it out.
    skipped: bool,
    /// True where the run ends at the end of the block.
    ends: bool,
    /// Whether the program, or one that calls it or that it calls, starts it.
    started: [bool; 2],
    /// True if the program, or one that calls it or that it calls, holds the spindle at an angle.
    holds: bool,
    /// True if a stop or a tool change of the program, or of one that it calls or that calls it, may leave it ended: whether it runs
    /// later is not known then.
    lost: [bool; 2],
    after: &'p After<'p>,
    /// What the target ends at the stop and the source does not: it is started again after it.
    again: Vec<Again>,
    switched: Switched,
    /// The tool that the block put into the spindle last.
    tool: Option<f64>,
    /// A builder's code since the program last said what the spindle does.
    touched: Touched,
    /// True at a message that is a program stop of the source, which has no messages and showed a text before it.
    is_plain_stop: bool,
    /// True at a stop that stands for a code of the source which ends nothing there.
    stood_in: bool,
    /// True where the target passes over a change to the tool that is in the spindle: then it ends nothing.
    passes: bool,
}

impl Place<'_> {
    /// What has to be ended before the stops of a block, by the numbers of their statements.
    fn block(&mut self, block: &Block, context: &mut Context<'_>) -> BTreeMap<usize, Vec<Op>> {
        let mut found = BTreeMap::new();
        for (number, stmt) in block.stmts.iter().enumerate() {
            let pause = pause_of(&stmt.kind);
            self.switched.step(stmt);
            self.state.step(stmt);
            self.touched.step(stmt, [context.source, context.target]);
            let before = self.tool;
            self.tool = tool_after(&stmt.kind, before).filter(|_| !self.state.may_call());
            let is_other = matches!((before, self.tool), (Some(before), Some(tool)) if before != tool);
            self.restarted = Running::ALL.map(|running| restarts(&stmt.kind, running));
            self.skipped = stmt.site.skip.is_some();
            self.stood_in = matches!(stmt.kind, StmtKind::StopMessage { .. })
                && context.stood_in.contains(&(context.origin(self.index), stmt.site.span));
            self.is_plain_stop =
                matches!(stmt.kind, StmtKind::StopMessage { .. }) && !has_messages(context.source);
            let Some((pause, optional)) = pause else { continue };
            // What stands beside a move is left: before it, the move would find it ended.
            let moves = pause == Pause::Change && matches!(&stmt.kind, StmtKind::Nc(nc) if nc.moves());
            let ends = !(pause == Pause::Change && self.passes && !is_other);
            let before = self.stop((pause, optional, moves, ends), number + 1, stmt.site.span, context);
            if before.is_empty() {
                continue;
            }
            if matches!(&stmt.kind, StmtKind::Nc(nc) if nc.moves()) && self.state.may_call() {
                context.add(self.index, Diagnostic::new(Code::NoEquivalent, stmt.site.span, AFTER_CALL));
            }
            found.insert(number, before);
        }
        if self.ends {
            (self.restarted, self.skipped, self.stood_in) = ([false; 2], false, false);
            self.is_plain_stop = false;
            let before =
                self.stop((Pause::End, false, false, true), usize::MAX, block.term.site.span, context);
            if !before.is_empty() {
                found.insert(block.stmts.len(), before);
            }
        }
        found
    }

    /// True where it may be running here.
    fn may_run(&self, running: Running) -> bool {
        let (group, _) = ends(running);
        match self.state.op(group) {
            Some(op) => starts(running).contains(&op),
            None => self.started[running as usize],
        }
    }

    /// What has to be ended before a stop, which may be passed over or change the tool beside a move, and on the target is
    /// sure to be one or not; `number` is that of the statement after it.
    fn stop(
        &mut self,
        (pause, optional, moves, is_one): (Pause, bool, bool, bool),
        number: usize,
        span: Span,
        context: &mut Context<'_>,
    ) -> Vec<Op> {
        let mut before = Vec::new();
        for running in Running::ALL {
            if !self.may_run(running) || self.restarted[running as usize] {
                continue;
            }
            let own = if self.is_plain_stop { Pause::Stop } else { pause };
            let here = match context.source.ends(own, running) {
                here if self.stood_in => Ends { answer: Some(false), known: true, ..here },
                here => here,
            };
            let there = context.target.ends(written(pause, context.target), running);
            let matters = self.after.matters(self.index, self.id, number, running);
            if matters && !here.known {
                context.rests_on_source(self.index, span, here.question);
            }
            let (_, op) = ends(running);
            if here.answer == Some(true) && !(there.known && there.answer == Some(true) && is_one) {
                let runs = self.state.op(ends(running).0).is_some_and(|op| starts(running).contains(&op));
                // A profile that says so is asked no more.
                let ends_nothing = there.known && there.answer == Some(false);
                let to_machine = moves || !ends_nothing && (!runs || there.answer.is_some() && is_one);
                let cuts = matters && running == Running::Spindle;
                let left = match pause {
                    Pause::Change => to_machine,
                    _ => optional && (cuts || !ends_nothing),
                };
                if optional && matters && !left {
                    context.add_once(self.index, DRY, Diagnostic::new(Code::Conditional, span, DRY));
                }
                if !left {
                    if running == Running::Spindle
                        && self.holds
                        && pause != Pause::End
                        && self.state.op(Group::Spindle).is_none()
                    {
                        context.add_once(
                            self.index,
                            LETS_GO,
                            Diagnostic::new(Code::Conditional, span, LETS_GO),
                        );
                    }
                    before.push(op);
                } else if matters || (optional && running == Running::Spindle) {
                    self.tell(pause, there, span, context);
                }
            }
            // One of which nobody knows what it ends may have ended it.
            let asks = match pause {
                Pause::Message => true,
                // Where an optional stop is switched off, it runs already what is started again.
                Pause::Stop => here.known && here.answer == Some(false),
                _ => false,
            };
            let sure = asks && there.known && there.answer == Some(true);
            let again = self.state.op(ends(running).0).filter(|op| starts(running).contains(op));
            let known = sure && here.answer != Some(true) && !self.lost[running as usize];
            // Where the switch is on, it stands on both.
            let shows = self.after.shows(self.index, self.id, number, running);
            let known_under = known && again.is_none() && !self.skipped && shows;
            if let Some((op, level)) = self.switched.of(running).filter(|_| known_under) {
                match self.touched.0.filter(|_| running == Running::Spindle) {
                    Some(act) => touched::tell(act, self.index, span, context),
                    None => self.again.push((number - 1, op, Some(level))),
                }
                continue;
            }
            match again.filter(|_| known) {
                Some(op) if shows => match self.touched.0.filter(|_| running == Running::Spindle) {
                    Some(act) => touched::tell(act, self.index, span, context),
                    None => self.again.push((number - 1, op, None)),
                },
                None if here.answer == Some(false) && there.answer != Some(false) && matters => {
                    self.tell(pause, there, span, context);
                }
                _ => {}
            }
            // A stop that is passed over ends nothing.
            if here.answer == Some(true) && !optional && !self.skipped {
                self.state.start_in(op);
            }
        }
        before
    }

    /// Says that the target may do otherwise, or does.
    fn tell(&self, pause: Pause, there: Ends, span: Span, context: &mut Context<'_>) {
        if !there.known {
            return context.rests_on_target(self.index, span, there.question);
        }
        let what = match pause {
            Pause::Change => {
                "the tool change leaves spindle or coolant otherwise on the target than on the source"
            }
            _ => "the stop leaves spindle or coolant otherwise on the target than on the source",
        };
        context.add_once(self.index, what, Diagnostic::new(Code::Conditional, span, what));
    }
}
