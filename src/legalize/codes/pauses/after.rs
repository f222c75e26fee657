//! Whether a program cuts after a place before it says itself what runs.

use crate::canon::{Group, Op, Pause, Role, Running};
use crate::dialect::Control;
use crate::ir::{BlockId, Call, Callee, Module, Nc, NcItem, StmtKind, TermKind};
use crate::legalize::{Modal, ModalFacts};
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::cell::OnceCell;
use std::collections::BTreeSet;

/// What a run of statements does about what runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// It says what runs.
    Says,
    /// It may cut.
    Cuts,
    /// It moves without a cut, or waits.
    Goes,
    /// It says what runs in a block that moves: the move may come first.
    SaysBeside,
}

impl Step {
    fn says(self) -> bool {
        matches!(self, Self::Says | Self::SaysBeside)
    }
}

/// The blocks of a library, as far as spindle and coolant go.
pub(super) struct After<'m> {
    module: &'m Module,
    facts: &'m ModalFacts,
    /// By program and block: the steps of its statements by their numbers, for spindle and coolant, and its end. Few
    /// programs are asked for.
    programs: Vec<OnceCell<Vec<Steps>>>,
    by_name: HashMap<&'m ProgramName, usize>,
    /// For each of [`Running`], true if a tool change ends it on both controls: what ran before shows no more after one.
    changes_end: [bool; 2],
}

/// The steps of a block's statements, and how it ends.
type Steps = (Vec<[Option<Step>; 2]>, End);

/// How a block ends.
enum End {
    /// Goes on at blocks.
    On(Vec<BlockId>),
    /// Calls a routine, where it is known which, then goes on.
    Call(Option<(usize, BlockId)>, BlockId),
    /// Returns, or goes somewhere unknown.
    Out,
    /// Ends the run.
    Over,
}

impl<'m> After<'m> {
    pub fn of(module: &'m Module, facts: &'m ModalFacts, controls: [&Control; 2]) -> Self {
        let names = module.programs.iter().enumerate();
        let by_name = names.filter_map(|(index, program)| Some((program.name.as_ref()?, index))).collect();
        let programs = std::iter::repeat_with(OnceCell::new).take(module.programs.len()).collect();
        let ends = |control: &Control, running| {
            let ends = control.ends(Pause::Change, running);
            // A change to the tool that is in the spindle may be passed over.
            ends.known && ends.answer == Some(true) && !control.skips_same_tool()
        };
        let changes_end = Running::ALL.map(|running| controls.iter().all(|control| ends(control, running)));
        Self { module, facts, programs, by_name, changes_end }
    }

    fn block(&self, index: usize, id: BlockId) -> Option<&Steps> {
        self.programs.get(index)?.get_or_init(|| self.program(index)).get(id.index())
    }

    fn program(&self, index: usize) -> Vec<Steps> {
        let program = &self.module.programs[index];
        let blocks = program.ids().zip(&program.blocks).map(|(id, block)| {
            let mut state = self.facts.at(index, id);
            let steps = block.stmts.iter().map(|stmt| {
                state.step(stmt);
                let steps = steps(&stmt.kind, &state, self.changes_end);
                match stmt.site.skip {
                    // It may be passed over: what it says does not count, what it moves does.
                    Some(_) => steps.map(|step| step.filter(|step| !step.says())),
                    None => steps,
                }
            });
            (steps.collect(), self.end(index, &block.term.kind))
        });
        blocks.collect()
    }

    fn end(&self, index: usize, kind: &TermKind) -> End {
        match kind {
            TermKind::End { .. } | TermKind::Stray | TermKind::Chain(_) => End::Over,
            TermKind::Return { .. } => End::Out,
            TermKind::Call { call, next } => End::Call(self.routine(index, call), *next),
            kind => End::On(kind.successors().into_iter().collect()),
        }
    }

    fn routine(&self, index: usize, call: &Call) -> Option<(usize, BlockId)> {
        match &call.callee {
            Callee::Block(block) => Some((index, *block)),
            Callee::Program(name) => Some((*self.by_name.get(name)?, BlockId(0))),
            _ => None,
        }
    }

    /// True where some way from the statement `number` of a block cuts before it says what runs. What a caller does
    /// after a return is taken to cut.
    pub fn matters(&self, program: usize, block: BlockId, number: usize, running: Running) -> bool {
        self.comes_to(&[Step::Cuts], (program, block), number, running)
    }

    /// True where some way moves or waits before it says what runs, a cut or not.
    pub fn shows(&self, program: usize, block: BlockId, number: usize, running: Running) -> bool {
        self.comes_to(&[Step::Cuts, Step::Goes, Step::SaysBeside], (program, block), number, running)
    }

    fn comes_to(&self, wanted: &[Step], from: (usize, BlockId), number: usize, running: Running) -> bool {
        let (comes, returns) = self.walk(wanted, from, number, running, &mut BTreeSet::new(), 0);
        comes || returns
    }

    /// Whether a way comes to such a step, and whether one returns before anything was said. Calls deeper than the bound may do both.
    fn walk(
        &self,
        wanted: &[Step],
        from: (usize, BlockId),
        number: usize,
        running: Running,
        seen: &mut BTreeSet<(usize, BlockId)>,
        depth: u32,
    ) -> (bool, bool) {
        let mut work = vec![(from, number)];
        let mut returns = false;
        while let Some(((program, id), first)) = work.pop() {
            let Some((steps, end)) = self.block(program, id) else { return (true, true) };
            let rest = steps.iter().skip(first).filter_map(|steps| steps[running as usize]);
            match rest.into_iter().find(|step| step.says() || wanted.contains(step)) {
                Some(step) if wanted.contains(&step) => return (true, false),
                Some(_) => continue,
                None => {}
            }
            let mut go = |id: BlockId| {
                if seen.insert((program, id)) {
                    work.push(((program, id), 0));
                }
            };
            match end {
                End::Over => {}
                End::Out => returns = true,
                End::On(to) => to.iter().for_each(|id| go(*id)),
                End::Call(None, _) => return (true, false),
                End::Call(Some(callee), next) => {
                    let (comes, passes) = match seen.insert(*callee) {
                        _ if depth > 15 => (true, true),
                        true => self.walk(wanted, *callee, 0, running, seen, depth + 1),
                        false => (false, true),
                    };
                    if comes {
                        return (true, false);
                    }
                    if passes && seen.insert((program, *next)) {
                        work.push(((program, *next), 0));
                    }
                }
            }
        }
        (false, returns)
    }
}

/// What a statement does about spindle and coolant.
fn steps(kind: &StmtKind, state: &Modal, changes_end: [bool; 2]) -> [Option<Step>; 2] {
    match kind {
        StmtKind::Nc(nc) => Running::ALL.map(|running| {
            let changes = changes_end[running as usize] && nc.has(Op::ToolChange);
            let says = changes || nc.ops().any(|op| says(op, running));
            match (says, nc.moves() || nc.names_axis() || nc.has(Op::Dwell)) {
                (true, moves) => Some(if moves { Step::SaysBeside } else { Step::Says }),
                (false, _) if may_cut(nc, state) => Some(Step::Cuts),
                (false, moves) => moves.then_some(Step::Goes),
            }
        }),
        StmtKind::ModalCall(_) => [Some(Step::Cuts); 2],
        _ => [None; 2],
    }
}

fn says(op: Op, running: Running) -> bool {
    match running {
        Running::Spindle => {
            matches!(op, Op::SpindleCw | Op::SpindleCcw | Op::SpindleStop | Op::SpindleOrient)
        }
        Running::Coolant => matches!(op, Op::Mist | Op::Flood | Op::CoolantOff),
    }
}

/// True for a block that may cut; `state` is in force in it.
fn may_cut(nc: &Nc, state: &Modal) -> bool {
    use Op::*;
    let drills = state.op(Group::Cycle).is_none_or(Op::is_cycle);
    let rapid = |op: Op| matches!(op, RapidOnce | ReferenceReturn | ReferenceFrom | Reference2 | Home);
    let rapid = state.op(Group::Motion) == Some(Rapid) || nc.ops().any(rapid);
    let always = |op: Op| op.is_cycle() || matches!(op, CycleHere | Probe | ProbeOther);
    let arcs = |item: &NcItem| matches!(item, NcItem::Word(Role::ArcI | Role::ArcJ | Role::ArcK, _));
    nc.ops().any(always)
        || nc.items.iter().any(|item| matches!(item, NcItem::Code('G', _)))
        || ((nc.moves() || nc.items.iter().any(arcs)) && (drills || state.may_call() || !rapid))
}
