//! What stands in a library, whatever the place: by it a pass sees whether anything concerns it.

use crate::CHECKED;
use crate::canon::{Op, Role};
use crate::ir::{
    Bank, BinOp, Callee, Class, Cond, Expr, Nc, NcItem, Place, Program, StmtKind, TermKind, Var,
};

/// Kinds of things, besides operations and words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// A code known by its number.
    Code,
    /// One of them that may be any code of the machine.
    MachineCode,
    /// An NC block without words.
    Emptied,
    /// A modal call, or its end.
    Modal,
    /// A call of a block of the same program.
    LocalCall,
    /// Any other call.
    Call,
    /// A jump to another program.
    Chain,
    /// A return to a sequence number.
    ReturnTo,
    /// A jump to a computed label.
    ComputedJump,
    /// A wait for the moves before it, or a limit on reading ahead.
    Wait,
    /// A print.
    Print,
    /// Formatted output.
    Output,
    /// The opening or closing of its port.
    Port,
    /// A question to the operator.
    Input,
    /// The clearing of a class.
    Clear,
    /// An alarm, or a stop with a message.
    Message,
    /// A constant that more than eight digits may be needed for.
    Long,
    /// A count of increments.
    Increments,
    /// State of the machine, read or written.
    System,
    /// A variable, read or written.
    Variable,
    /// A temporary.
    Temp,
    /// A variable with a computed number.
    Indirect,
    /// One in a space of numbers that is not that of all variables.
    Banked,
    /// Any value but a constant.
    Computed,
    /// A function, or an operator that controls have as one or lack.
    Function,
    /// A comparison as a value.
    Truth,
    /// A branch on more than one comparison, or on none of one.
    Compound,
    /// A block skip.
    Skip,
}

/// The features of programs: which operations, words and things stand in them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Features {
    ops: [u64; 4],
    roles: [u64; 4],
    things: Things,
}

impl Features {
    /// Of these programs.
    pub fn of(programs: &[Program]) -> Self {
        let mut features = Self::default();
        programs.iter().for_each(|program| features.program(program));
        features
    }

    /// Of one program.
    pub fn of_program(program: &Program) -> Self {
        let mut features = Self::default();
        features.program(program);
        features
    }

    /// Of one program, of which this is known.
    pub fn of_known(known: Option<Self>, program: &Program) -> Self {
        let features = known.unwrap_or_else(|| Self::of_program(program));
        assert!(!CHECKED || features == Self::of_program(program), "a program has changed uncounted");
        features
    }

    /// Adds what stands elsewhere.
    pub fn add_all(&mut self, other: &Self) {
        self.ops.iter_mut().zip(other.ops).for_each(|(ops, more)| *ops |= more);
        self.roles.iter_mut().zip(other.roles).for_each(|(roles, more)| *roles |= more);
        self.things |= other.things;
    }

    /// True where there is one.
    pub fn has(&self, thing: Feature) -> bool {
        self.things & bit(thing) != 0
    }

    /// True where an NC block has the operation.
    pub fn op(&self, op: Op) -> bool {
        self.ops[op as usize / 64] >> (op as usize % 64) & 1 == 1
    }

    /// True where an NC block has such an operation.
    pub fn any_op(&self, wanted: impl Fn(Op) -> bool) -> bool {
        Op::ALL.iter().any(|op| self.op(*op) && wanted(*op))
    }

    /// True where an NC block has a word in the role.
    pub fn role(&self, role: Role) -> bool {
        self.roles[role as usize / 64] >> (role as usize % 64) & 1 == 1
    }

    fn add(&mut self, thing: Feature) {
        self.things |= bit(thing);
    }

    fn program(&mut self, program: &Program) {
        for block in &program.blocks {
            for stmt in &block.stmts {
                self.stmt(&stmt.kind);
                if stmt.site.skip.is_some() {
                    self.add(Feature::Skip);
                }
            }
            self.term(&block.term.kind);
        }
    }

    fn stmt(&mut self, kind: &StmtKind) {
        match kind {
            StmtKind::Nc(nc) => return self.nc(nc),
            StmtKind::ModalCall(call) => {
                self.callee(&call.callee);
                self.add(Feature::Modal);
            }
            StmtKind::ModalCallOff => self.add(Feature::Modal),
            StmtKind::Sync | StmtKind::LimitLookahead(_) => self.add(Feature::Wait),
            StmtKind::Print { .. } => self.add(Feature::Print),
            StmtKind::Output(_) => self.add(Feature::Output),
            StmtKind::OpenPort | StmtKind::ClosePort => self.add(Feature::Port),
            StmtKind::Input { .. } => self.add(Feature::Input),
            StmtKind::ClearAll(_) => self.add(Feature::Clear),
            StmtKind::Alarm { .. } | StmtKind::StopMessage { .. } => self.add(Feature::Message),
            StmtKind::SetNames { .. } => self.add(Feature::Variable),
            _ => {}
        }
        kind.exprs(&mut |e| self.value(e));
        kind.target().iter().for_each(|place| match place {
            Place::Var(var) => self.things |= in_variable(*var),
            Place::System(..) => self.add(Feature::System),
            Place::Indirect(bank, _) => self.things |= in_computed_number(*bank),
        });
    }

    fn nc(&mut self, nc: &Nc) {
        if nc.items.is_empty() {
            self.add(Feature::Emptied);
        }
        for item in &nc.items {
            match item {
                NcItem::Op(op) => self.ops[*op as usize / 64] |= 1 << (*op as usize % 64),
                NcItem::Word(role, value) => {
                    self.roles[*role as usize / 64] |= 1 << (*role as usize % 64);
                    // Most words are numbers.
                    match value {
                        Expr::Number(value) => self.things |= in_number(*value),
                        value => self.value(value),
                    }
                }
                NcItem::Code(letter, value) => {
                    self.add(Feature::Code);
                    if *letter == 'M' {
                        self.add(Feature::MachineCode);
                    }
                    self.value(value);
                }
            }
        }
    }

    fn term(&mut self, kind: &TermKind) {
        match kind {
            TermKind::Call { call, .. } => self.callee(&call.callee),
            TermKind::Chain(_) => self.add(Feature::Chain),
            TermKind::Return { to: Some(_) } => self.add(Feature::ReturnTo),
            TermKind::Computed { .. } => self.add(Feature::ComputedJump),
            TermKind::Branch { cond, .. } if matches!(**cond, Cond::And(_) | Cond::Or(_) | Cond::Not(_)) => {
                self.add(Feature::Compound);
            }
            TermKind::Branch { cond, .. } if matches!(**cond, Cond::Switch(_)) => self.add(Feature::Skip),
            TermKind::Jump(_) => return,
            _ => {}
        }
        kind.exprs(&mut |e| self.value(e));
    }

    fn callee(&mut self, callee: &Callee) {
        self.add(if matches!(callee, Callee::Block(_)) { Feature::LocalCall } else { Feature::Call });
    }

    fn value(&mut self, e: &Expr) {
        self.things |= in_value(e);
    }
}

/// Kinds of things, a bit each.
type Things = u32;

const fn bit(thing: Feature) -> Things {
    1 << thing as u32
}

/// What stands in a value: most of a library is values.
fn in_value(e: &Expr) -> Things {
    let all = |operands: &[Expr]| operands.iter().fold(0, |things, operand| things | in_value(operand));
    let things = match e {
        Expr::Number(value) => return in_number(*value),
        Expr::Increments(_) => return bit(Feature::Increments),
        Expr::Negate(inner) => return in_value(inner),
        Expr::Var(var) => in_variable(*var),
        Expr::System(_, subscripts) => bit(Feature::System) | all(subscripts),
        Expr::Indirect(bank, index) => in_computed_number(*bank) | in_value(index),
        Expr::Binary(BinOp::Mod | BinOp::And | BinOp::Or | BinOp::Xor, operands) => {
            bit(Feature::Function) | all(&**operands)
        }
        Expr::Binary(_, operands) => all(&**operands),
        Expr::Call(_, arguments) => bit(Feature::Function) | all(arguments),
        Expr::Truth(cond) => {
            let mut things = bit(Feature::Truth);
            cond.exprs(&mut |operand| things |= in_value(operand));
            things
        }
        Expr::Vacant => 0,
    };
    things | bit(Feature::Computed)
}

fn in_number(value: f64) -> Things {
    if is_long(value) { bit(Feature::Long) } else { 0 }
}

fn in_variable(var: Var) -> Things {
    let temp = if var.class == Class::Temp { bit(Feature::Temp) } else { 0 };
    bit(Feature::Variable) | temp
}

fn in_computed_number(bank: Bank) -> Things {
    let banked = if bank == Bank::Numbered { 0 } else { bit(Feature::Banked) };
    bit(Feature::Indirect) | banked
}

/// False where four digits before and four after the point write the number.
pub(super) fn is_long(value: f64) -> bool {
    let size = value.abs();
    size >= 1e4 || f64::from((size * 1e4 + 0.5) as u32) / 1e4 != size
}
