//! The control-flow graph of a program.

use super::dataflow::reached_among;
use crate::ir::{Block, BlockId, Call, Callee, Module, Program, StmtKind, TermKind};
use crate::syntax::Label;
use foldhash::HashSet;
use smallvec::{SmallVec, smallvec};
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// Most blocks have one way or two.
type Ways = SmallVec<[BlockId; 2]>;

/// Successors, predecessors and a reverse postorder.
#[derive(Clone, Debug, Default)]
pub struct Cfg {
    succs: Vec<Ways>,
    /// Who looks back asks for them.
    preds: OnceCell<Vec<Ways>>,
    roots: Vec<BlockId>,
    /// Few ask for it.
    order: OnceCell<Vec<BlockId>>,
}

impl Cfg {
    /// The graph in which a call goes on after itself and a return goes nowhere. Its roots are
    /// the entry and the blocks that calls enter.
    pub fn of(program: &Program) -> Self {
        let succs = program.blocks.iter().map(|block| block.term.kind.successors()).collect();
        Self::new(succs, program)
    }

    /// The graph of every way that control can go: calls enter their block, and the returns of a called part go on after the
    /// calls of that part, to the labelled blocks where they name one, and (if nobody called the program) to the entry. With
    /// `come_back` (see [`may_come_back`]) a call of another program may go on at any labelled block.
    ///
    /// Past the last block stand some that the program does not have, so that many returns to many places are not as many
    /// edges as their product: first the one that every way to an unknown label goes through, then those of the returns.
    pub fn whole(program: &Program, come_back: bool) -> Self {
        let label = BlockId(program.blocks.len() as u32);
        let mut after: BTreeMap<BlockId, Ways> = [(BlockId(0), smallvec![BlockId(0)])].into();
        let mut succs: Vec<Ways> = Vec::with_capacity(program.blocks.len() + 2);
        let mut looks = come_back;
        for block in &program.blocks {
            succs.push(match &block.term.kind {
                TermKind::Call { call, next } => match &call.callee {
                    Callee::Block(entry) => {
                        let ways = after.entry(*entry).or_default();
                        ways.push(*next);
                        // One that runs again begins where it returned.
                        ways.extend(call.count.is_some().then_some(*entry));
                        // One that runs no times, and the locals of a level, pass the body by.
                        if call.count.is_some() || call.level {
                            smallvec![*entry, *next]
                        } else {
                            smallvec![*entry]
                        }
                    }
                    _ if come_back => smallvec![*next, label],
                    _ => smallvec![*next],
                },
                TermKind::Return { to: None } => Ways::new(),
                TermKind::Return { to: Some(_) } => {
                    looks = true;
                    smallvec![label]
                }
                kind => kind.successors(),
            });
        }
        succs.push(labelled(program).filter(|_| looks).collect());
        // At an unknown label nobody can tell in which part a run is.
        // Without parts of its own all returns go on at one place, whichever blocks they stand in.
        let told = after.len() > 1 && !looks && modal_bodies(program).next().is_none();
        returns_go_on(&mut succs, after, program, told);
        // What no part reaches never runs: it goes anywhere.
        let all = (label.0 + 1..succs.len() as u32).map(BlockId);
        for id in program.ids().filter(|id| returns(program, *id)) {
            let ways = &mut succs[id.index()];
            if !ways.iter().any(|way| *way > label) {
                ways.extend(all.clone());
            }
        }
        Self::new(succs, program)
    }

    /// The graph of every way within a program: calls enter their block, and the returns of a called part go on after the
    /// calls of that part, and at its beginning where a call repeats it. A program with very many calls and blocks is taken
    /// to go on after any call.
    ///
    /// Past the last block stands one for each called part, that all its returns go through.
    pub fn parts(program: &Program) -> Self {
        let mut succs: Vec<Ways> = Vec::with_capacity(program.blocks.len());
        let mut after: BTreeMap<BlockId, Ways> = BTreeMap::new();
        for block in &program.blocks {
            succs.push(match own_call(block) {
                Some((entry, next, repeats)) => {
                    let ways = after.entry(entry).or_default();
                    ways.extend(repeats.then_some(entry).into_iter().chain([next]));
                    smallvec![entry]
                }
                None => block.term.kind.successors(),
            });
        }
        returns_go_on(&mut succs, after, program, true);
        Self::new(succs, program)
    }

    fn new(mut succs: Vec<Ways>, program: &Program) -> Self {
        let count = succs.len();
        for targets in &mut succs {
            // Most blocks go on at the next one alone.
            if let [to] = targets.as_slice() {
                if to.index() >= count {
                    targets.clear();
                }
                continue;
            }
            targets.sort_unstable();
            targets.dedup();
            targets.retain(|to| to.index() < count);
        }
        let mut roots: Vec<BlockId> = [BlockId(0)].into_iter().chain(entries(program)).collect();
        roots.retain(|root| root.index() < program.blocks.len());
        Self { succs, preds: OnceCell::new(), roots, order: OnceCell::new() }
    }

    fn turned(&self) -> Vec<Ways> {
        let mut preds = vec![Ways::new(); self.succs.len()];
        for (from, targets) in (0..).map(BlockId).zip(&self.succs) {
            targets.iter().for_each(|to| preds[to.index()].push(from));
        }
        preds
    }

    fn number(&self) -> Vec<BlockId> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.succs.len()];
        let mut stack: Vec<(BlockId, usize)> = Vec::new();
        // The last root first: reversing puts the entry in front.
        for root in self.roots.iter().rev() {
            if std::mem::replace(&mut seen[root.index()], true) {
                continue;
            }
            stack.push((*root, 0));
            while let Some((at, next)) = stack.last_mut() {
                let Some(to) = self.succs[at.index()].get(*next).copied() else {
                    order.push(*at);
                    stack.pop();
                    continue;
                };
                *next += 1;
                if !std::mem::replace(&mut seen[to.index()], true) {
                    stack.push((to, 0));
                }
            }
        }
        order.reverse();
        order
    }

    /// Where control can go from a block, each once, in the order of ids.
    pub fn succs(&self, id: BlockId) -> &[BlockId] {
        self.succs.get(id.index()).map_or(&[], Ways::as_slice)
    }

    /// Where control can come from.
    pub fn preds(&self, id: BlockId) -> &[BlockId] {
        self.preds.get_or_init(|| self.turned()).get(id.index()).map_or(&[], Ways::as_slice)
    }

    /// Where control enters: the entry first, then the blocks that calls enter.
    pub fn roots(&self) -> &[BlockId] {
        &self.roots
    }

    /// The blocks that can be reached, in reverse postorder.
    pub fn order(&self) -> &[BlockId] {
        self.order.get_or_init(|| self.number())
    }

    /// How many blocks the graph has.
    pub fn len(&self) -> usize {
        self.succs.len()
    }

    /// True for a graph without blocks.
    pub fn is_empty(&self) -> bool {
        self.succs.is_empty()
    }
}

/// Called parts times blocks up to which the returns of parts are told apart.
const MOST: usize = 1 << 22;

/// Lets the returns of each part go on after its calls, by a block past the last one: by one for all parts where they are
/// not `told` apart.
fn returns_go_on(succs: &mut Vec<Ways>, mut after: BTreeMap<BlockId, Ways>, program: &Program, told: bool) {
    if !told || after.len().saturating_mul(program.blocks.len()) > MOST {
        let returned = BlockId(succs.len() as u32);
        succs.push(std::mem::take(&mut after).into_values().flatten().collect());
        program.ids().filter(|id| returns(program, *id)).for_each(|id| succs[id.index()].push(returned));
    }
    for (entry, after) in after {
        let returned = BlockId(succs.len() as u32);
        succs.push(after);
        let part = reachable(program, entry).into_iter();
        part.filter(|id| returns(program, *id)).for_each(|id| succs[id.index()].push(returned));
    }
}

fn returns(program: &Program, id: BlockId) -> bool {
    program.block(id).is_some_and(|block| matches!(block.term.kind, TermKind::Return { .. }))
}

impl Call {
    /// True where it may run more than once: what it leaves, its next run finds.
    pub fn repeats(&self) -> bool {
        self.count.as_ref().is_some_and(|count| count.constant().is_none_or(|count| count > 1.0))
    }
}

/// The part of the same program that a block calls at its end, where control goes on, and whether the call may run it
/// more than once.
pub fn own_call(block: &Block) -> Option<(BlockId, BlockId, bool)> {
    match &block.term.kind {
        TermKind::Call { call, next } => Some((entry(&call.callee)?, *next, call.count.is_some())),
        _ => None,
    }
}

/// The blocks that a routine entered at `entry` can run, calls stepped over.
pub fn reachable(program: &Program, entry: BlockId) -> BTreeSet<BlockId> {
    let seen = reached_among(program.blocks.len(), [entry.index()], |at, go| {
        if let Some(block) = program.blocks.get(at) {
            block.term.kind.each_successor(&mut |to| go(to.index()));
        }
    });
    program.ids().filter(|id| seen[id.index()]).collect()
}

/// The blocks that calls of this program enter, modal ones included.
pub fn entries(program: &Program) -> impl Iterator<Item = BlockId> + '_ {
    let called = program.blocks.iter().filter_map(|block| own_call(block).map(|(entry, ..)| entry));
    modal_bodies(program).chain(called)
}

/// The blocks of this program that modal calls enter.
pub fn modal_bodies(program: &Program) -> impl Iterator<Item = BlockId> + '_ {
    program.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| match &stmt.kind {
        StmtKind::ModalCall(call) => entry(&call.callee),
        _ => None,
    })
}

fn entry(callee: &Callee) -> Option<BlockId> {
    if let Callee::Block(id) = callee { Some(*id) } else { None }
}

/// The blocks that a number finds.
pub(super) fn labelled(program: &Program) -> impl Iterator<Item = BlockId> + '_ {
    program.ids().zip(&program.blocks).filter_map(|(id, block)| {
        block.labels.iter().any(|label| matches!(label, Label::Number(_))).then_some(id)
    })
}

/// True where a call of another program may come back at a label of the caller: some program of
/// the library returns to a sequence number, or a callee is not in the library.
pub fn may_come_back(module: &Module) -> bool {
    let names: HashSet<_> = module.programs.iter().filter_map(|p| p.name.as_ref()).collect();
    module.programs.iter().flat_map(|program| &program.blocks).any(|block| match &block.term.kind {
        TermKind::Return { to } => to.is_some(),
        TermKind::Call { call, .. } => match &call.callee {
            Callee::Program(name) => !names.contains(name),
            Callee::Block(_) => false,
            Callee::Computed(_) | Callee::Cycle(_) => true,
        },
        _ => false,
    })
}
