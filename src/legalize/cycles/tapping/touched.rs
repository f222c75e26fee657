//! What calls of a library do to the feed and to the cycle in force.

use crate::canon::{Group, Role};
use crate::ir::analysis::calls_of;
use crate::ir::{BlockId, Call, Callee, Module, Nc, NcItem, Stmt, StmtKind, TermKind};
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::collections::BTreeSet;

/// Which programs may change the feed or the cycle in force, themselves or by what they call.
pub struct Touched {
    names: HashMap<ProgramName, usize>,
    programs: Vec<bool>,
}

impl Touched {
    /// Looks at a library.
    pub fn of(module: &Module) -> Self {
        let named = module.programs.iter().enumerate();
        let names = named.filter_map(|(at, program)| Some((program.name.clone()?, at))).collect();
        let mut touched = Self { names, programs: vec![false; module.programs.len()] };
        loop {
            let before = touched.programs.clone();
            for (index, program) in module.programs.iter().enumerate() {
                let own = || program.blocks.iter().flat_map(|block| &block.stmts).any(changes);
                let calls = || program.blocks.iter().flat_map(calls_of);
                let touches = before[index] || own() || calls().any(|call| touched.touches(index, call));
                touched.programs[index] = touches;
            }
            if touched.programs == before {
                return touched;
            }
        }
    }

    /// True where a call of a program may change them.
    pub fn touches(&self, program: usize, call: &Call) -> bool {
        let callee = match &call.callee {
            Callee::Block(_) => Some(program),
            Callee::Program(name) => self.names.get(name).copied(),
            Callee::Computed(_) | Callee::Cycle(_) => None,
        };
        callee.and_then(|callee| self.programs.get(callee)).is_none_or(|touches| *touches)
    }

    /// True where it is not known what runs after a block.
    pub fn is_unknown(&self, term: &TermKind) -> bool {
        match term {
            TermKind::Call { call, .. } => match &call.callee {
                Callee::Block(_) => false,
                Callee::Program(name) => !self.names.contains_key(name),
                Callee::Computed(_) | Callee::Cycle(_) => true,
            },
            TermKind::Chain(_) => true,
            _ => false,
        }
    }
}

/// The blocks that calls enter.
pub fn roots(module: &Module) -> BTreeSet<(usize, BlockId)> {
    let mut roots = BTreeSet::new();
    for (index, program) in module.programs.iter().enumerate() {
        roots.insert((index, BlockId(0)));
        for call in program.blocks.iter().flat_map(calls_of) {
            if let Callee::Block(entry) = call.callee {
                roots.insert((index, entry));
            }
        }
    }
    roots
}

/// True for a block that leaves the cycle in force as it is: it says places, or from where they count.
pub fn keeps_cycle(nc: &Nc) -> bool {
    let apart = |group| matches!(group, Group::Distance | Group::WorkOffset | Group::ReturnPlane);
    nc.items.iter().all(|item| match item {
        NcItem::Op(op) => apart(op.group()),
        NcItem::Word(..) => true,
        NcItem::Code(..) => false,
    })
}

/// True for what may change the feed or the cycle, or opens a modal call.
fn changes(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Nc(nc) => !keeps_cycle(nc) || nc.word(Role::Feed).is_some(),
        StmtKind::ModalCall(_) => true,
        _ => false,
    }
}
