//! Which programs calls may come to, those by a computed number too.

use super::block_calls::calls_of;
use crate::ir::analysis::{Ranges, Summaries, Values};
use crate::ir::{Block, BlockId, Call, Callee, Class, Expr, Module, Place, Program, StmtKind, TermKind, Var};
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::collections::{BTreeMap, BTreeSet};

/// What the computed calls of a block may call.
#[derive(Clone, Debug, Default)]
pub struct Callees {
    /// The programs of the library with such a number, by index.
    pub programs: Vec<usize>,
    /// True where it is known to be one of them.
    pub known: bool,
    /// True where every number that it may be is that of one of them.
    pub all: bool,
}

impl Callees {
    /// Those that the caller's state is taken into: where any number may be meant, those that return.
    pub fn entered(&self, module: &Module) -> impl Iterator<Item = usize> {
        let returns = |at: usize| {
            let mut blocks = module.programs[at].blocks.iter();
            blocks.any(|block| matches!(block.term.kind, TermKind::Return { .. }))
        };
        self.programs.iter().copied().filter(move |at| self.known || returns(*at))
    }
}

/// The programs of a library that each of its calls may run.
pub struct CalledPrograms {
    by_name: HashMap<ProgramName, usize>,
    computed: BTreeMap<(usize, BlockId), Callees>,
}

impl CalledPrograms {
    /// Of a library.
    pub fn of(module: &Module) -> Self {
        let names = module.programs.iter().enumerate();
        let by_name = names.filter_map(|(index, program)| Some((program.name.clone()?, index))).collect();
        Self { by_name, computed: computed_calls(module) }
    }

    /// The programs that a call in this block may run, by index; none if it leaves the library or stays in its program.
    pub fn by(&self, place: (usize, BlockId), call: &Call) -> &[usize] {
        match &call.callee {
            Callee::Program(name) => self.by_name.get(name).map_or(&[], std::slice::from_ref),
            Callee::Computed(_) => self.computed.get(&place).map_or(&[], |callees| &callees.programs),
            Callee::Block(_) | Callee::Cycle(_) => &[],
        }
    }

    /// True where such a call may run what is not in the library.
    pub fn may_leave(&self, place: (usize, BlockId), call: &Call) -> bool {
        match &call.callee {
            Callee::Computed(_) => self.computed.get(&place).is_none_or(|callees| !callees.known),
            Callee::Block(_) => false,
            Callee::Program(_) | Callee::Cycle(_) => self.by(place, call).is_empty(),
        }
    }

    /// True where a computed call may run this program, and it is known what that call may run.
    pub fn is_known(&self, program: usize) -> bool {
        self.runs(program, true)
    }

    /// True where a computed call may run this program, or something else.
    pub fn is_guessed(&self, program: usize) -> bool {
        self.runs(program, false)
    }

    fn runs(&self, program: usize, known: bool) -> bool {
        self.computed.values().any(|callees| callees.known == known && callees.programs.contains(&program))
    }

    /// Every caller with what it may run.
    pub fn pairs(&self, module: &Module) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                let callees = calls_of(block).flat_map(|call| self.by((index, id), call));
                pairs.extend(callees.map(|callee| (index, *callee)));
            }
        }
        pairs
    }

    /// By program: the locals that every call of it in the library sets, and each of its runs leaves so where it repeats.
    pub fn given(&self, module: &Module) -> BTreeMap<usize, BTreeSet<Var>> {
        let mut given: BTreeMap<usize, BTreeSet<Var>> = BTreeMap::new();
        for (index, program) in module.programs.iter().enumerate() {
            for (id, block) in program.ids().zip(&program.blocks) {
                for call in calls_of(block) {
                    let sure = call.arguments.iter().filter(|a| call.level && !a.value.may_be_vacant());
                    let sets: BTreeSet<Var> =
                        sure.map(|a| Var { class: Class::Local, number: a.local }).collect();
                    for callee in self.by((index, id), call) {
                        let again = call.repeats().then(|| &module.programs[*callee]);
                        let kept = |var: &Var| again.is_none_or(|program| !may_empty(program, *var));
                        let sets: BTreeSet<Var> = sets.iter().copied().filter(kept).collect();
                        let all = given.entry(*callee).or_insert_with(|| sets.clone());
                        all.retain(|var| sets.contains(var));
                    }
                }
            }
        }
        given
    }
}

/// True where a run of a program may leave a variable vacant that it did not find so.
pub fn may_empty(program: &Program, var: Var) -> bool {
    program.blocks.iter().any(|block| {
        let calls =
            matches!(&block.term.kind, TermKind::Call { call, .. } if !call.level || var.class.shared());
        calls
            || block.stmts.iter().any(|stmt| match &stmt.kind {
                StmtKind::Assign { target: Place::Var(to), value } => *to == var && value.may_be_vacant(),
                StmtKind::ModalCall(_) => true,
                kind => matches!(kind.target(), Some(Place::Indirect(..))),
            })
    })
}

/// The computed calls of a library, by program and block.
pub fn computed_calls(module: &Module) -> BTreeMap<(usize, BlockId), Callees> {
    let computes = |block: &Block| calls_of(block).any(|call| computed(&call.callee).is_some());
    let blocks = module.programs.iter().enumerate().flat_map(|(index, program)| {
        program.ids().zip(&program.blocks).map(move |(id, block)| (index, id, block))
    });
    let blocks: Vec<_> = blocks.filter(|(.., block)| computes(block)).collect();
    if blocks.is_empty() {
        return BTreeMap::new();
    }
    let summaries = Summaries::of(module);
    let mut ranges: BTreeMap<usize, Ranges<'_>> = BTreeMap::new();
    let mut found = BTreeMap::new();
    for (index, id, block) in blocks {
        let ranges = ranges.entry(index).or_insert_with(|| Ranges::of(&module.programs[index], &summaries));
        let mut callees = Callees { programs: Vec::new(), known: true, all: true };
        for (at, number) in numbers(block) {
            let values = ranges.at(id, at, number);
            callees.known &= matches!(values, Values::Few(_));
            let programs = programs(module, &values);
            let numbers = |(first, last): &(u32, u32)| u64::from(last - first) + 1;
            let count: u64 = values.numbers().runs().iter().map(numbers).sum();
            callees.all &= callees.known && count == programs.len() as u64;
            callees.programs.extend(programs);
        }
        callees.programs.sort_unstable();
        callees.programs.dedup();
        found.insert((index, id), callees);
    }
    found
}

fn computed(callee: &Callee) -> Option<&Expr> {
    match callee {
        Callee::Computed(number) => Some(number),
        _ => None,
    }
}

/// The computed numbers that a block calls, and the statements that they stand in.
fn numbers(block: &Block) -> Vec<(usize, &Expr)> {
    let stmts = block.stmts.iter().enumerate().filter_map(|(at, stmt)| match &stmt.kind {
        StmtKind::ModalCall(call) => Some((at, computed(&call.callee)?)),
        _ => None,
    });
    let term = match &block.term.kind {
        TermKind::Call { call, .. } => computed(&call.callee).map(|number| (block.stmts.len(), number)),
        _ => None,
    };
    stmts.chain(term).collect()
}

fn programs(module: &Module, values: &Values) -> Vec<usize> {
    let numbers = values.numbers();
    let meant = |at: &usize| match module.programs[*at].name {
        Some(ProgramName::Number(number)) => numbers.contains(number),
        _ => false,
    };
    (0..module.programs.len()).filter(meant).collect()
}
