//! What programs may write, calls included.

use super::call_graph::CallGraph;
use super::set::VarSet;
use crate::canon::Op;
use crate::ir::{Bank, Call, Callee, Class, Expr, Module, Nc, Place, Program, Stmt, StmtKind, TermKind, Var};
use crate::syntax::ProgramName;
use foldhash::HashMap;
use std::collections::BTreeSet;

/// Variables, one by one and by whole classes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Vars {
    /// Single ones.
    pub vars: VarSet,
    /// All of these classes.
    pub classes: Classes,
}

/// A set of classes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Classes(u8);

impl Classes {
    /// Adds a class.
    pub fn insert(&mut self, class: Class) {
        self.0 |= 1 << class as u8;
    }

    /// Takes a class out.
    pub fn remove(&mut self, class: Class) {
        self.0 &= !(1 << class as u8);
    }

    /// True where the class is in.
    pub fn contains(self, class: Class) -> bool {
        self.0 >> class as u8 & 1 == 1
    }

    /// True where none is in.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The classes, in order.
    pub fn iter(self) -> impl Iterator<Item = Class> {
        Class::ALL.into_iter().filter(move |class| self.contains(*class))
    }
}

impl Extend<Class> for Classes {
    fn extend<I: IntoIterator<Item = Class>>(&mut self, classes: I) {
        classes.into_iter().for_each(|class| self.insert(class));
    }
}

/// What every program of a module may write, its temporaries aside.
#[derive(Clone, Debug, Default)]
pub struct Summaries {
    /// By program: what it calls included.
    written: Vec<Vars>,
    names: HashMap<ProgramName, usize>,
    /// By the modal calls that an NC block may make.
    modal: Vars,
    /// By a body in the same program, or by what cannot be told.
    everything: Vars,
    /// By code outside the library, which may see its caller's locals too.
    unknown: Vars,
    come_back: bool,
    /// True where some program begins a call at each move: then any program with moves calls.
    calls_at_moves: bool,
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
        self.classes().next().is_none() && self.vars().next().is_none()
    }

    /// The single ones.
    pub fn vars(&self) -> impl Iterator<Item = Var> + '_ {
        self.vars.vars.iter().filter(|var| !self.hides(var.class))
    }

    /// The whole classes.
    pub fn classes(&self) -> impl Iterator<Item = Class> + '_ {
        self.vars.classes.iter().filter(|class| !self.hides(*class))
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
        let mut classes = Classes::default();
        classes.extend(SHARED);
        Self { vars: VarSet::default(), classes }
    }

    /// All that a body in the same program sees.
    fn everything() -> Self {
        let mut all = Self::shared();
        all.classes.extend([Class::Local, Class::Temp]);
        all
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
        self.classes.contains(var.class) || self.vars.contains(var)
    }

    /// Adds all of another; true where that changed it.
    pub fn join<'v>(&mut self, other: impl Into<Seen<'v>>) -> bool {
        let (other, before) = (other.into(), self.classes);
        let changed = self.vars.join(&other.vars.vars, |class| !other.hides(class));
        self.classes.extend(other.classes());
        changed || before != self.classes
    }

    /// Without the variables of a class.
    #[must_use]
    pub fn without(mut self, class: Class) -> Self {
        self.classes.remove(class);
        self.vars.remove_class(class);
        self
    }

    /// Adds what evaluating an expression reads.
    pub fn read(&mut self, e: &Expr) {
        e.walk(&mut |part| match part {
            Expr::Var(var) => {
                self.vars.insert(*var);
            }
            Expr::Indirect(bank, _) => {
                self.classes.extend(Self::bank(*bank).iter().copied());
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
                self.classes.extend(Self::bank(*bank).iter().copied());
            }
            Place::System(..) => {}
        }
    }
}

impl Summaries {
    /// The summaries of a module.
    pub fn of(module: &Module) -> Self {
        let names = module.programs.iter().enumerate();
        let names = names.filter_map(|(at, p)| p.name.clone().map(|name| (name, at))).collect();
        let everything = Vars::everything();
        let mut out = Self {
            written: vec![Vars::default(); module.programs.len()],
            names,
            modal: Vars::default(),
            unknown: everything.clone().without(Class::Temp),
            everything,
            come_back: super::may_come_back(module),
            calls_at_moves: module
                .programs
                .iter()
                .flat_map(|p| &p.blocks)
                .flat_map(|b| &b.stmts)
                .any(is_modal),
        };
        let graph = Graph::of(module, &mut out);
        out.spread(&graph);
        out
    }

    /// Adds to each program what its callees do.
    fn spread(&mut self, graph: &Graph) {
        // The modal calls stand after the programs, as one more.
        self.written.push(std::mem::take(&mut self.modal));
        graph
            .calls
            .bottom_up(&mut self.written, |mine, callee, level| mine.join(Seen { vars: callee, level }));
        self.modal = self.written.pop().unwrap_or_default();
        if graph.modal_body {
            self.modal = self.everything.clone();
        }
    }

    /// What a call may write, as its caller sees it. A body in the same program is everything.
    pub fn by_call(&self, call: &Call) -> Seen<'_> {
        let (vars, level) = match &call.callee {
            Callee::Program(name) => (self.by_program(name), call.level),
            Callee::Block(_) => (&self.everything, false),
            Callee::Computed(_) | Callee::Cycle(_) => (&self.unknown, call.level),
        };
        Seen { vars, level }
    }

    /// All that a program of this name may write.
    pub fn by_program(&self, name: &ProgramName) -> &Vars {
        self.names.get(name).map_or(&self.unknown, |at| &self.written[*at])
    }

    /// What an NC block may write: by a modal call that it makes, or by an operation that moves values
    /// between variables and tables.
    pub fn by_nc(&self, nc: &Nc) -> &Vars {
        if moves_values(nc) { &self.everything } else { &self.modal }
    }

    /// True where a call of another program may go on at a labelled block of its caller.
    pub fn come_back(&self) -> bool {
        self.come_back
    }

    /// The same for one program: one that calls nothing is never come back to.
    pub fn come_back_to(&self, program: &Program) -> bool {
        self.come_back && (self.calls_at_moves || comes_back(program))
    }
}

fn is_modal(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::ModalCall(_))
}

/// True for a program that calls another one, or that returns to a number by itself.
fn comes_back(program: &Program) -> bool {
    program.blocks.iter().any(|block| match &block.term.kind {
        TermKind::Call { call, .. } => !matches!(call.callee, Callee::Block(_)),
        TermKind::Return { to } => to.is_some(),
        _ => false,
    })
}

/// Who calls whom, modal calls as one more program that everyone with NC blocks calls.
struct Graph {
    calls: CallGraph,
    /// True where a modal call runs a body of its own program.
    modal_body: bool,
}

impl Graph {
    /// The graph; what programs write by themselves, and by calls that leave the library, is added at once.
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
                        let Summaries { written, modal, unknown, .. } = &mut *summaries;
                        written.get_mut(from).unwrap_or(modal).join(Seen { vars: unknown, level });
                    }
                }
            };
            let mut moves = false;
            let mut own = Vars::default();
            for block in &program.blocks {
                for stmt in &block.stmts {
                    write(&mut own, &stmt.kind);
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
            summaries.written[at].join(&own.without(Class::Temp));
            if moves {
                callees[at].insert((modal, false));
            }
        }
        Self { calls: CallGraph::new(callees), modal_body }
    }
}

/// True where the block moves values between variables and tables.
pub(super) fn moves_values(nc: &Nc) -> bool {
    nc.ops().any(|op| matches!(op, Op::ReadOffset | Op::WriteVariable))
}

/// Adds what a statement writes by itself.
fn write(out: &mut Vars, kind: &StmtKind) {
    kind.target().iter().for_each(|place| out.write(place));
    match kind {
        StmtKind::ClearAll(class) => out.classes.insert(*class),
        StmtKind::Nc(nc) if moves_values(nc) => drop(out.join(&Vars::everything())),
        _ => {}
    }
}
