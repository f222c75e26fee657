//! Visits the expressions of statements, terminators, calls and conditions.
//!
//! "Outermost" expressions are those that stand in a statement by themselves; [`Expr::walk`]
//! goes on into their operands. Order is the order of evaluation.

use super::{
    BlockId, Call, Callee, Class, Cond, Expr, Nc, NcItem, OutputPart, Place, PrintPart, Program, StmtKind,
    TermKind, Var,
};
use crate::canon::Op;

/// Writes a visitor by shared and by exclusive reference from one text.
macro_rules! visitors {
    ($name:ident, $iter:ident $(, $mut:tt)?) => {
        impl Expr {
            #[doc = "Visits the operands, those in conditions included, not theirs."]
            pub fn $name<'e, F: FnMut(&'e $($mut)? Expr) + ?Sized>(&'e $($mut)? self, f: &mut F) {
                match self {
                    Expr::Number(_) | Expr::Increments(_) | Expr::Vacant | Expr::Var(_) => {}
                    Expr::Indirect(_, a) | Expr::Negate(a) => f(a),
                    Expr::System(_, all) | Expr::Call(_, all) => all.$iter().for_each(|e| f(e)),
                    Expr::Binary(_, operands) => operands.$iter().for_each(|e| f(e)),
                    Expr::Truth(cond) => cond.$name(f),
                }
            }
        }

        impl Cond {
            #[doc = "Visits the outermost expressions."]
            pub fn $name<'e, F: FnMut(&'e $($mut)? Expr) + ?Sized>(&'e $($mut)? self, f: &mut F) {
                match self {
                    Cond::Compare(_, a, b) => {
                        f(a);
                        f(b);
                    }
                    Cond::And(all) | Cond::Or(all) => all.$iter().for_each(|cond| cond.$name(f)),
                    Cond::Not(inner) => inner.$name(f),
                    Cond::Switch(_) => {}
                }
            }
        }

        impl Place {
            #[doc = "Visits the outermost expressions that say which place it is."]
            pub fn $name<'e, F: FnMut(&'e $($mut)? Expr) + ?Sized>(&'e $($mut)? self, f: &mut F) {
                match self {
                    Place::Var(_) => {}
                    Place::Indirect(_, index) => f(index),
                    Place::System(_, subscripts) => subscripts.$iter().for_each(|e| f(e)),
                }
            }
        }

        impl Call {
            #[doc = "Visits the outermost expressions: callee, arguments, count."]
            pub fn $name<'e, F: FnMut(&'e $($mut)? Expr) + ?Sized>(&'e $($mut)? self, f: &mut F) {
                if let Callee::Computed(number) = &$($mut)? self.callee {
                    f(number);
                }
                self.arguments.$iter().for_each(|argument| f(&$($mut)? argument.value));
                self.count.$iter().for_each(|e| f(e));
            }
        }

        impl StmtKind {
            #[doc = "Visits the outermost expressions, those of a written place included."]
            pub fn $name<'e, F: FnMut(&'e $($mut)? Expr) + ?Sized>(&'e $($mut)? self, f: &mut F) {
                match self {
                    StmtKind::Assign { target, value } => {
                        target.$name(f);
                        f(value);
                    }
                    StmtKind::Nc(nc) => nc.items.$iter().for_each(|item| match item {
                        NcItem::Word(_, value) | NcItem::Code(_, value) => f(value),
                        NcItem::Op(_) => {}
                    }),
                    StmtKind::ModalCall(call) => call.$name(f),
                    StmtKind::Alarm { number, .. } | StmtKind::StopMessage { number, .. } => f(number),
                    StmtKind::Output(parts) => parts.$iter().for_each(|part| {
                        if let OutputPart::Value { value, .. } = part {
                            f(value);
                        }
                    }),
                    StmtKind::Print { parts, .. } => parts.$iter().for_each(|part| {
                        if let PrintPart::Value(value) = part {
                            f(value);
                        }
                    }),
                    StmtKind::Input { target, .. } => target.$name(f),
                    StmtKind::LimitLookahead(count) => f(count),
                    StmtKind::Comment
                    | StmtKind::ClearAll(_)
                    | StmtKind::ModalCallOff
                    | StmtKind::OpenPort
                    | StmtKind::ClosePort
                    | StmtKind::Sync
                    | StmtKind::SetNames { .. } => {}
                }
            }
        }

        impl TermKind {
            #[doc = "Visits the outermost expressions, those of a condition included."]
            pub fn $name<'e, F: FnMut(&'e $($mut)? Expr) + ?Sized>(&'e $($mut)? self, f: &mut F) {
                match self {
                    TermKind::Branch { cond, .. } => cond.$name(f),
                    TermKind::Computed { value, .. } => f(value),
                    TermKind::Call { call, .. } => call.$name(f),
                    TermKind::Return { to } => to.$iter().for_each(|e| f(e)),
                    TermKind::Jump(_) | TermKind::Chain(_) | TermKind::End { .. } | TermKind::Stray => {}
                }
            }
        }
    };
}

visitors!(exprs, iter);
visitors!(exprs_mut, iter_mut, mut);

impl Expr {
    /// Visits the expression and everything in it. Bounded by the validator's depth limit.
    pub fn walk<'e, F: FnMut(&'e Expr) + ?Sized>(&'e self, f: &mut F) {
        f(self);
        match self {
            Expr::Number(_) | Expr::Increments(_) | Expr::Vacant | Expr::Var(_) => {}
            Expr::Indirect(_, a) | Expr::Negate(a) => a.walk(f),
            Expr::System(_, all) | Expr::Call(_, all) => all.iter().for_each(|e| e.walk(f)),
            Expr::Binary(_, operands) => operands.iter().for_each(|e| e.walk(f)),
            Expr::Truth(cond) => cond.exprs(&mut |e| e.walk(f)),
        }
    }

    /// Like [`Expr::walk`], to change things in place.
    pub fn walk_mut(&mut self, f: &mut dyn FnMut(&mut Expr)) {
        f(self);
        self.exprs_mut(&mut |operand| operand.walk_mut(f));
    }

    /// True where evaluating it may stop the machine, so that it must not be dropped. Only what
    /// surely cannot is false: plain reads, constants, and rounding and signs of these. Sums and
    /// products may overflow on a control with a short range.
    pub fn may_alarm(&self) -> bool {
        use crate::canon::Func;
        match self {
            Expr::Number(_) | Expr::Vacant | Expr::Var(_) => false,
            Expr::Negate(a) => a.may_alarm(),
            Expr::Call(Func::Abs | Func::Fix | Func::Fup | Func::Round | Func::Sign, arguments) => {
                arguments.iter().any(Expr::may_alarm)
            }
            _ => true,
        }
    }
}

impl Cond {
    /// True where testing it may stop the machine.
    pub fn may_alarm(&self) -> bool {
        let mut found = false;
        self.exprs(&mut |e| found |= e.may_alarm());
        found
    }
}

impl Cond {
    /// True where the operator's switches have a say.
    pub fn has_switch(&self) -> bool {
        match self {
            Cond::Compare(_, a, b) => a.has_switch() || b.has_switch(),
            Cond::And(all) | Cond::Or(all) => all.iter().any(Cond::has_switch),
            Cond::Not(inner) => inner.has_switch(),
            Cond::Switch(_) => true,
        }
    }
}

impl Expr {
    fn has_switch(&self) -> bool {
        if let Expr::Truth(cond) = self {
            return cond.has_switch();
        }
        let mut found = false;
        self.exprs(&mut |operand| found |= operand.has_switch());
        found
    }
}

impl StmtKind {
    /// The alarm of a draft, in the place of what has no conversion.
    pub fn not_converted(code: &str) -> Self {
        Self::Alarm { number: Expr::Number(99.0).into(), text: format!("NOT CONVERTED {code}").into() }
    }

    /// Its NC words, where it is a block of them.
    pub fn nc(&self) -> Option<&Nc> {
        if let StmtKind::Nc(nc) = self { Some(nc) } else { None }
    }

    /// True for a block of NC words that has this operation.
    pub fn has_op(&self, op: Op) -> bool {
        self.nc().is_some_and(|nc| nc.has(op))
    }

    /// The place that the statement writes by itself.
    pub fn target(&self) -> Option<&Place> {
        match self {
            StmtKind::Assign { target, .. } | StmtKind::Input { target, .. } => Some(target),
            _ => None,
        }
    }
}

impl TermKind {
    /// Calls `f` on each of [`TermKind::successors`].
    pub fn each_successor(&self, f: &mut impl FnMut(BlockId)) {
        match self {
            TermKind::Jump(to) | TermKind::Call { next: to, .. } => f(*to),
            TermKind::Branch { then, otherwise, .. } => {
                f(*then);
                f(*otherwise);
            }
            TermKind::Computed { targets, .. } => targets.iter().for_each(|(_, to)| f(*to)),
            TermKind::Return { .. } | TermKind::Chain(_) | TermKind::End { .. } | TermKind::Stray => {}
        }
    }
}

impl Program {
    /// The temporaries, as often as they are written: none is read that is not.
    pub fn temporaries(&self) -> impl Iterator<Item = Var> + '_ {
        let targets = self.blocks.iter().flat_map(|block| &block.stmts).filter_map(|stmt| stmt.kind.target());
        targets.filter_map(|place| match place {
            Place::Var(var) if var.class == Class::Temp => Some(*var),
            _ => None,
        })
    }

    /// Visits every variable that the program names, as often as it does.
    pub fn variables<F: FnMut(Var) + ?Sized>(&self, f: &mut F) {
        let mut read = |e: &Expr| e.variables(f);
        for block in &self.blocks {
            for stmt in &block.stmts {
                stmt.kind.exprs(&mut read);
                match (&stmt.kind, stmt.kind.target()) {
                    (StmtKind::SetNames { first: var, .. }, _) | (_, Some(Place::Var(var))) => {
                        read(&Expr::Var(*var));
                    }
                    _ => {}
                }
            }
            block.term.kind.exprs(&mut read);
        }
    }
}

impl Expr {
    /// Visits every variable in the expression.
    pub fn variables<F: FnMut(Var) + ?Sized>(&self, f: &mut F) {
        match self {
            Expr::Var(var) => f(*var),
            Expr::Number(_) | Expr::Increments(_) | Expr::Vacant => {}
            Expr::Indirect(_, a) | Expr::Negate(a) => a.variables(f),
            Expr::System(_, all) | Expr::Call(_, all) => all.iter().for_each(|e| e.variables(f)),
            Expr::Binary(_, operands) => operands.iter().for_each(|e| e.variables(f)),
            Expr::Truth(cond) => cond.exprs(&mut |e| e.variables(f)),
        }
    }
}
