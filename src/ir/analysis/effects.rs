//! What programs may read and write, calls included.

use super::Liveness;
use crate::canon::Op;
use crate::ir::{
    Bank, BlockId, Call, Callee, Class, Expr, Module, Nc, Place, Program, StmtKind, TermKind, Var,
};
use crate::syntax::ProgramName;
use std::collections::{BTreeMap, BTreeSet};

/// Variables, one by one and by whole classes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Vars {
    /// Single ones.
    pub vars: BTreeSet<Var>,
    /// All of these classes.
    pub classes: BTreeSet<Class>,
}

/// What may be read and written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    /// What may be read.
    pub reads: Vars,
    /// What may be written.
    pub writes: Vars,
}

/// The effects of every program of a module.
#[derive(Clone, Debug, Default)]
pub struct Summaries {
    /// By program: all it may read and write, and what it calls.
    effects: Vec<Effects>,
    /// By program: what it may read before it writes it.
    exposed: Vec<Vars>,
    names: BTreeMap<ProgramName, usize>,
    modal: Effects,
    come_back: bool,
}

const SHARED: [Class; 5] =
    [Class::Common, Class::Retained, Class::Global, Class::Parametric, Class::Register];

impl Vars {
    /// All that other programs see.
    pub fn shared() -> Self {
        Self { vars: BTreeSet::new(), classes: SHARED.into() }
    }

    /// The variables that a computed number of this bank may mean.
    pub fn bank(bank: Bank) -> Self {
        let classes: &[Class] = match bank {
            Bank::Numbered => &[Class::Local, Class::Common, Class::Retained],
            Bank::Global => &[Class::Global],
            Bank::Parametric => &[Class::Parametric],
        };
        Self { vars: BTreeSet::new(), classes: classes.iter().copied().collect() }
    }

    /// True where the variable is among them.
    pub fn contains(&self, var: Var) -> bool {
        self.classes.contains(&var.class) || self.vars.contains(&var)
    }

    /// Adds all of another; true where that changed it.
    pub fn join(&mut self, other: &Vars) -> bool {
        let before = (self.vars.len(), self.classes.len());
        self.vars.extend(&other.vars);
        self.classes.extend(&other.classes);
        before != (self.vars.len(), self.classes.len())
    }

    /// Without the variables of a class.
    #[must_use]
    pub fn without(mut self, class: Class) -> Self {
        self.classes.remove(&class);
        self.vars.retain(|var| var.class != class);
        self
    }

    /// Adds what evaluating an expression reads.
    pub fn read(&mut self, e: &Expr) {
        e.walk(&mut |part| match part {
            Expr::Var(var) => {
                self.vars.insert(*var);
            }
            Expr::Indirect(bank, _) => {
                self.join(&Self::bank(*bank));
            }
            _ => {}
        });
    }

    /// Adds what writing a place may change.
    pub fn write(&mut self, place: &Place) {
        match place {
            Place::Var(var) => {
                self.vars.insert(*var);
            }
            Place::Indirect(bank, _) => {
                self.join(&Self::bank(*bank));
            }
            Place::System(..) => {}
        }
    }
}

impl Effects {
    /// Of code that nobody knows: everything that is shared.
    pub fn unknown() -> Self {
        Self { reads: Vars::shared(), writes: Vars::shared() }
    }

    /// Of a body in the same program, or of what cannot be told: everything.
    pub fn everything() -> Self {
        let mut all = Vars::shared();
        all.classes.extend([Class::Local, Class::Temp]);
        Self { reads: all.clone(), writes: all }
    }

    fn join(&mut self, other: &Effects) -> bool {
        self.reads.join(&other.reads) | self.writes.join(&other.writes)
    }

    fn without(self, class: Class) -> Self {
        Self { reads: self.reads.without(class), writes: self.writes.without(class) }
    }
}

impl Summaries {
    /// The summaries of a module.
    pub fn of(module: &Module) -> Self {
        let names = module.programs.iter().enumerate();
        let names = names.filter_map(|(at, p)| p.name.clone().map(|name| (name, at))).collect();
        let mut out = Self {
            effects: module.programs.iter().map(own).collect(),
            exposed: vec![Vars::default(); module.programs.len()],
            names,
            modal: Effects::default(),
            come_back: super::may_come_back(module),
        };
        while out.spread(module) {}
        while out.expose(module) {}
        out
    }

    /// Adds to each program what its callees do; true where that changed something.
    fn spread(&mut self, module: &Module) -> bool {
        let mut changed = false;
        for (at, program) in module.programs.iter().enumerate() {
            for call in calls(program) {
                let effects = self.of_call(call);
                changed |= self.effects[at].join(&effects);
            }
            for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
                let StmtKind::ModalCall(call) = &stmt.kind else { continue };
                let body = self.of_call(call);
                changed |= self.modal.join(&body);
            }
            for block in &program.blocks {
                let TermKind::Chain(name) = &block.term.kind else { continue };
                let effects = self.of_program(name).without(Class::Temp);
                changed |= self.effects[at].join(&effects);
            }
            if program.blocks.iter().flat_map(|block| &block.stmts).any(|s| matches!(s.kind, StmtKind::Nc(_)))
            {
                let modal = self.modal.clone();
                changed |= self.effects[at].join(&modal);
            }
        }
        changed
    }

    fn expose(&mut self, module: &Module) -> bool {
        let mut changed = false;
        for (at, program) in module.programs.iter().enumerate() {
            let live = Liveness::of(program, self, super::Exit::Nothing);
            let exposed = Vars { vars: live.before(BlockId(0)).collect(), classes: live.classes_at_entry() };
            changed |= self.exposed[at].join(&exposed.without(Class::Temp));
        }
        changed
    }

    /// What a call may read and write, as its caller sees it: the locals of a level of its own are
    /// not among them. A body in the same program is everything.
    pub fn of_call(&self, call: &Call) -> Effects {
        let effects = match &call.callee {
            Callee::Program(name) => self.of_program(name).without(Class::Temp),
            Callee::Block(_) => Effects::everything(),
            Callee::Computed(_) | Callee::Cycle(_) => unknown_callee(),
        };
        let body = matches!(call.callee, Callee::Block(_));
        if call.level && !body { effects.without(Class::Local) } else { effects }
    }

    /// What a call may read before it writes it, as its caller sees it.
    pub fn exposed_by(&self, call: &Call) -> Vars {
        let Callee::Program(name) = &call.callee else { return self.of_call(call).reads };
        let exposed = self.exposed_of(name);
        if call.level { exposed.without(Class::Local) } else { exposed }
    }

    /// What a program of this name may read before it writes it.
    pub fn exposed_of(&self, name: &ProgramName) -> Vars {
        self.names.get(name).map_or_else(|| unknown_callee().reads, |at| self.exposed[*at].clone())
    }

    /// All that a program of this name may read and write.
    pub fn of_program(&self, name: &ProgramName) -> Effects {
        self.names.get(name).map_or_else(unknown_callee, |at| self.effects[*at].clone())
    }

    /// What an NC block may read and write besides its words: by a modal call that it makes, or by
    /// an operation that moves values between variables and tables.
    pub fn of_nc(&self, nc: &Nc) -> Effects {
        if nc.has(Op::ReadOffset) || nc.has(Op::WriteVariable) {
            Effects::everything()
        } else {
            self.modal.clone()
        }
    }

    /// True where a call of another program may go on at a labelled block of its caller.
    pub fn come_back(&self) -> bool {
        self.come_back
    }
}

/// Code outside the library may see its caller's locals too.
fn unknown_callee() -> Effects {
    Effects::everything().without(Class::Temp)
}

fn calls(program: &Program) -> impl Iterator<Item = &Call> {
    program.blocks.iter().filter_map(|block| match &block.term.kind {
        TermKind::Call { call, .. } if !matches!(call.callee, Callee::Block(_)) => Some(call),
        _ => None,
    })
}

/// What a program reads and writes by itself.
fn own(program: &Program) -> Effects {
    let mut out = Effects::default();
    for block in &program.blocks {
        for stmt in &block.stmts {
            stmt.kind.exprs(&mut |e| out.reads.read(e));
            stmt.kind.target().iter().for_each(|place| out.writes.write(place));
            match &stmt.kind {
                StmtKind::ClearAll(class) => {
                    out.writes.classes.insert(*class);
                }
                StmtKind::Nc(nc) if nc.has(Op::ReadOffset) || nc.has(Op::WriteVariable) => {
                    out.join(&Effects::everything());
                }
                _ => {}
            }
        }
        block.term.kind.exprs(&mut |e| out.reads.read(e));
    }
    out
}
