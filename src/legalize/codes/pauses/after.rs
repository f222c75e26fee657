//! Whether a program cuts after a place before it says itself what runs.

use crate::canon::{Group, Op, Role, Running};
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
}

/// The blocks of a library, as far as spindle and coolant go.
pub(super) struct After<'m> {
    module: &'m Module,
    facts: &'m ModalFacts,
    /// By program and block: the steps of its statements by their numbers, for spindle and coolant, and its end. Few
    /// programs are asked for.
    programs: Vec<OnceCell<Vec<Steps>>>,
    by_name: HashMap<&'m ProgramName, usize>,
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
    pub fn of(module: &'m Module, facts: &'m ModalFacts) -> Self {
        let names = module.programs.iter().enumerate();
        let by_name = names.filter_map(|(index, program)| Some((program.name.as_ref()?, index))).collect();
        let programs = std::iter::repeat_with(OnceCell::new).take(module.programs.len()).collect();
        Self { module, facts, programs, by_name }
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
                let steps = steps(&stmt.kind, &state);
                match stmt.site.skip {
                    // It may be passed over: what it says does not count, what it cuts does.
                    Some(_) => steps.map(|step| step.filter(|step| *step == Step::Cuts)),
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
        let mut seen = BTreeSet::new();
        let (cuts, returns) = self.walk((program, block), number, running, &mut seen, 0);
        cuts || returns
    }

    /// Whether a way cuts, and whether one returns before anything was said. Calls deeper than the bound may do both.
    fn walk(
        &self,
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
            match rest.into_iter().next() {
                Some(Step::Says) => continue,
                Some(Step::Cuts) => return (true, false),
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
                    let (cuts, passes) = match seen.insert(*callee) {
                        _ if depth > 15 => (true, true),
                        true => self.walk(*callee, 0, running, seen, depth + 1),
                        false => (false, true),
                    };
                    if cuts {
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
fn steps(kind: &StmtKind, state: &Modal) -> [Option<Step>; 2] {
    match kind {
        StmtKind::Nc(nc) => Running::ALL.map(|running| {
            let says = nc.ops().any(|op| says(op, running));
            if says { Some(Step::Says) } else { may_cut(nc, state).then_some(Step::Cuts) }
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
