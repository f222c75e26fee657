//! What programs may read and write, calls included.

use super::call_graph::CallGraph;
use crate::canon::Op;
use crate::ir::{Bank, Call, Callee, Class, Expr, Module, Nc, Place, Program, StmtKind, TermKind, Var};
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

/// The effects of every program of a module, on all but its temporaries.
#[derive(Clone, Debug, Default)]
pub struct Summaries {
    /// By program: all it may read and write, what it calls included.
    effects: Vec<Effects>,
    names: BTreeMap<ProgramName, usize>,
    /// Of the modal calls that an NC block may make.
    modal: Effects,
    /// Of a body in the same program, or of what cannot be told.
    everything: Effects,
    /// Of code outside the library, which may see its caller's locals too.
    unknown: Effects,
    come_back: bool,
}

/// Variables of a callee as its caller sees them: the locals of a level of its own are not among them.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'s> {
    vars: &'s Vars,
    level: bool,
}

impl Seen<'_> {
    /// True where the variable is among them.
    pub fn contains(&self, var: Var) -> bool {
        !self.hides(var.class) && self.vars.contains(var)
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.vars().next().is_none() && self.classes().next().is_none()
    }

    /// The single ones.
    pub fn vars(&self) -> impl Iterator<Item = Var> + '_ {
        self.vars.vars.iter().copied().filter(|var| !self.hides(var.class))
    }

    /// The whole classes.
    pub fn classes(&self) -> impl Iterator<Item = Class> + '_ {
        self.vars.classes.iter().copied().filter(|class| !self.hides(*class))
    }

    fn hides(&self, class: Class) -> bool {
        self.level && class == Class::Local
    }
}

impl<'s> From<&'s Vars> for Seen<'s> {
    fn from(vars: &'s Vars) -> Self {
        Self { vars, level: false }
    }
}

const SHARED: [Class; 5] =
    [Class::Common, Class::Retained, Class::Global, Class::Parametric, Class::Register];

impl Vars {
    /// All that other programs see.
    pub fn shared() -> Self {
        Self { vars: BTreeSet::new(), classes: SHARED.into() }
    }

    /// The classes whose variables a computed number of this bank may mean.
    pub fn bank(bank: Bank) -> &'static [Class] {
        match bank {
            Bank::Numbered => &[Class::Local, Class::Common, Class::Retained],
            Bank::Global => &[Class::Global],
            Bank::Parametric => &[Class::Parametric],
        }
    }

    /// True where the variable is among them.
    pub fn contains(&self, var: Var) -> bool {
        self.classes.contains(&var.class) || self.vars.contains(&var)
    }

    /// Adds all of another; true where that changed it.
    pub fn join<'v>(&mut self, other: impl Into<Seen<'v>>) -> bool {
        let (other, before) = (other.into(), (self.vars.len(), self.classes.len()));
        self.vars.extend(other.vars());
        self.classes.extend(other.classes());
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
                self.classes.extend(Self::bank(*bank));
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
                self.classes.extend(Self::bank(*bank));
            }
            Place::System(..) => {}
        }
    }
}

impl Effects {
    /// Of a body in the same program, or of what cannot be told: everything.
    pub fn everything() -> Self {
        let mut all = Vars::shared();
        all.classes.extend([Class::Local, Class::Temp]);
        Self { reads: all.clone(), writes: all }
    }

    fn join(&mut self, other: &Effects, level: bool) -> bool {
        let seen = |vars| Seen { vars, level };
        self.reads.join(seen(&other.reads)) | self.writes.join(seen(&other.writes))
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
        let everything = Effects::everything();
        let mut out = Self {
            effects: module.programs.iter().map(own).collect(),
            names,
            modal: Effects::default(),
            unknown: everything.clone().without(Class::Temp),
            everything,
            come_back: super::may_come_back(module),
        };
        let graph = Graph::of(module, &mut out);
        out.spread(&graph);
        out
    }

    /// Adds to each program what its callees do.
    fn spread(&mut self, graph: &Graph) {
        // The modal calls stand behind the programs, as one more.
        self.effects.push(std::mem::take(&mut self.modal));
        graph.calls.settle(|at| {
            let mut mine = std::mem::take(&mut self.effects[at]);
            let mut changed = false;
            for (callee, level) in graph.calls.callees(at) {
                changed |= mine.join(&self.effects[*callee], *level);
            }
            self.effects[at] = mine;
            changed
        });
        self.modal = self.effects.pop().unwrap_or_default();
        if graph.modal_body {
            self.modal = self.everything.clone();
        }
    }

    /// What a call may read, as its caller sees it. A body in the same program is everything.
    pub fn reads(&self, call: &Call) -> Seen<'_> {
        let (effects, level) = self.of_call(call);
        Seen { vars: &effects.reads, level }
    }

    /// What a call may write, as its caller sees it. A body in the same program is everything.
    pub fn writes(&self, call: &Call) -> Seen<'_> {
        let (effects, level) = self.of_call(call);
        Seen { vars: &effects.writes, level }
    }

    fn of_call(&self, call: &Call) -> (&Effects, bool) {
        match &call.callee {
            Callee::Program(name) => (self.of_program(name), call.level),
            Callee::Block(_) => (&self.everything, false),
            Callee::Computed(_) | Callee::Cycle(_) => (&self.unknown, call.level),
        }
    }

    /// All that a program of this name may read and write.
    pub fn of_program(&self, name: &ProgramName) -> &Effects {
        self.names.get(name).map_or(&self.unknown, |at| &self.effects[*at])
    }

    /// What an NC block may read and write besides its words: by a modal call that it makes, or by
    /// an operation that moves values between variables and tables.
    pub fn of_nc(&self, nc: &Nc) -> &Effects {
        if moves_values(nc) { &self.everything } else { &self.modal }
    }

    /// True where a call of another program may go on at a labelled block of its caller.
    pub fn come_back(&self) -> bool {
        self.come_back
    }
}

/// Who calls whom, modal calls as one more program that everyone with NC blocks calls.
struct Graph {
    calls: CallGraph,
    /// True where a modal call runs a body of its own program.
    modal_body: bool,
}

impl Graph {
    /// The graph; calls that leave the library are added to the effects at once.
    fn of(module: &Module, summaries: &mut Summaries) -> Self {
        let modal = module.programs.len();
        let mut callees = vec![BTreeSet::new(); modal + 1];
        let mut modal_body = false;
        for (at, program) in module.programs.iter().enumerate() {
            let mut edge = |from: usize, callee: &Callee, level: bool| {
                let place = match callee {
                    Callee::Program(name) => summaries.names.get(name),
                    Callee::Block(_) => return modal_body |= from == modal,
                    Callee::Computed(_) | Callee::Cycle(_) => None,
                };
                match place {
                    Some(place) => drop(callees[from].insert((*place, level))),
                    None => {
                        let Summaries { effects, modal, unknown, .. } = &mut *summaries;
                        effects.get_mut(from).unwrap_or(modal).join(unknown, level);
                    }
                }
            };
            let mut moves = false;
            for block in &program.blocks {
                for stmt in &block.stmts {
                    match &stmt.kind {
                        StmtKind::ModalCall(call) => edge(modal, &call.callee, call.level),
                        StmtKind::Nc(_) => moves = true,
                        _ => {}
                    }
                }
                match &block.term.kind {
                    TermKind::Call { call, .. } => edge(at, &call.callee, call.level),
                    TermKind::Chain(name) => edge(at, &Callee::Program(name.clone()), false),
                    _ => {}
                }
            }
            if moves {
                callees[at].insert((modal, false));
            }
        }
        Self { calls: CallGraph::new(callees), modal_body }
    }
}

/// True where the block moves values between variables and tables.
fn moves_values(nc: &Nc) -> bool {
    nc.ops().any(|op| matches!(op, Op::ReadOffset | Op::WriteVariable))
}

/// What a program reads and writes by itself, temporaries aside.
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
                StmtKind::Nc(nc) if moves_values(nc) => {
                    out.join(&Effects::everything(), false);
                }
                _ => {}
            }
        }
        block.term.kind.exprs(&mut |e| out.reads.read(e));
    }
    out.without(Class::Temp)
}
