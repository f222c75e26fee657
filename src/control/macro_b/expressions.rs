//! Expressions and variables, looked up once.

use super::code::{Ex, Form, System, Var, Word};
use crate::canon::Sys;
use crate::dialect::{Control, Question, Row};
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, VarRef};

/// Prepares expressions; the facts that they rest on are added to a list.
pub struct Expressions<'c, 'f> {
    control: &'c Control,
    facts: &'f mut Vec<String>,
    in_condition: bool,
}

impl<'c, 'f> Expressions<'c, 'f> {
    /// For one block, with its list of facts.
    pub fn new(control: &'c Control, facts: &'f mut Vec<String>) -> Self {
        Self { control, facts, in_condition: false }
    }

    /// An expression that gives a value.
    pub fn value(&mut self, expr: &Expr) -> Ex {
        self.in_condition = false;
        self.expr(expr)
    }

    /// The condition of IF and WHILE.
    pub fn condition(&mut self, expr: &Expr) -> Ex {
        self.in_condition = true;
        if !compares(expr) {
            self.behaviour(Question::NumberIsCondition);
        }
        self.expr(expr)
    }

    fn behaviour(&mut self, question: Question) {
        let sure = self
            .control
            .behaviour(question)
            .is_some_and(|row| row.origin.is_settled() && row.value == "true");
        if !sure {
            self.facts.push(question.fact().into());
        }
    }

    fn expr(&mut self, expr: &Expr) -> Ex {
        match &expr.kind {
            ExprKind::Number(number) => Ex::Number(number.value),
            ExprKind::Variable(variable) => Ex::Read(Box::new(self.variable(variable))),
            ExprKind::Group(inner) => Ex::Group(Box::new(self.expr(inner))),
            ExprKind::Negate(inner) => match self.expr(inner) {
                Ex::Number(value) => Ex::Number(-value),
                inner => Ex::Negate(Box::new(inner)),
            },
            ExprKind::Plus(inner) => Ex::Plus(Box::new(self.expr(inner))),
            ExprKind::Not(inner) => {
                let zero = Box::new(Ex::Number(0.0));
                Ex::Binary(BinaryOp::Equal, Box::new(self.expr(inner)), zero)
            }
            ExprKind::Binary(op, operands) => {
                let [a, b] = &**operands;
                if is_relation(*op) && !self.in_condition {
                    self.behaviour(Question::ComparisonIsValue);
                }
                self.operator(*op, a, b);
                Ex::Binary(*op, Box::new(self.expr(a)), Box::new(self.expr(b)))
            }
            ExprKind::Call { function, arguments, .. } => {
                match self.control.function(*function, arguments.len()) {
                    Some(row) if row.origin.is_settled() => {}
                    Some(row) => self.facts.push(row.fact()),
                    None => self.facts.push(format!("function:{function}")),
                }
                let was = std::mem::replace(&mut self.in_condition, false);
                let mut read = arguments.iter().map(|argument| Box::new(self.expr(argument)));
                let first = read.next();
                let second = read.next();
                self.in_condition = was;
                match (first, second) {
                    (Some(a), Some(b)) => Ex::Call2(*function, a, b),
                    (Some(a), None) => Ex::Call(*function, a),
                    _ => Ex::Number(f64::NAN),
                }
            }
        }
    }

    /// The rank of an operator matters where an operand is another operation without brackets.
    fn operator(&mut self, op: BinaryOp, a: &Expr, b: &Expr) {
        let joined = |expr: &Expr| match expr.kind {
            ExprKind::Binary(inner, ..) => inner != op,
            _ => false,
        };
        if !joined(a) && !joined(b) {
            return;
        }
        let meaning = match op {
            BinaryOp::Modulo => "modulo",
            BinaryOp::And => "and.bits",
            BinaryOp::Or => "or.bits",
            BinaryOp::Xor => "xor.bits",
            BinaryOp::Equal => "eq",
            BinaryOp::NotEqual => "ne",
            BinaryOp::Less => "lt",
            BinaryOp::LessEqual => "le",
            BinaryOp::Greater => "gt",
            BinaryOp::GreaterEqual => "ge",
            _ => return,
        };
        if let Some(row) = self.control.operator(meaning).filter(|row| !row.origin.is_settled()) {
            self.facts.push(row.fact());
        }
    }

    /// A variable.
    pub fn variable(&mut self, variable: &VarRef) -> Var {
        match &variable.index {
            Index::Number(number) => self.numbered(*number),
            Index::Bit(number, bit) => match self.numbered(*number) {
                Var::System(system) => Var::Bit(system, *bit),
                _ => Var::Missing(*number),
            },
            Index::Name(name) => match self.control.system_named(name) {
                Some(row) => row.first.map_or(Var::Missing(0), |first| self.numbered(first)),
                None => Var::Named(name.clone()),
            },
            Index::Computed(inner) if variable.name == "#" => {
                let was = std::mem::replace(&mut self.in_condition, false);
                let inner = Box::new(self.expr(inner));
                self.in_condition = was;
                Var::Computed(inner)
            }
            Index::Computed(inner) => {
                let inner = Box::new(self.expr(inner));
                Var::Family(variable.name.trim_start_matches('#').to_owned(), inner)
            }
            Index::None | Index::Letter(_) => Var::Missing(0),
        }
    }

    fn numbered(&mut self, number: u32) -> Var {
        let var = numbered(self.control, number);
        if let Var::System(system) = &var {
            self.facts.extend(system.unsure.clone());
        }
        var
    }

    /// True for the alarm, false for the stop with a message, none for other variables.
    pub fn signal(&self, target: &Var) -> Option<bool> {
        match target {
            Var::System(system) if system.state == Sys::Alarm => Some(true),
            Var::System(system) if system.state == Sys::StopMessage => Some(false),
            _ => None,
        }
    }

    /// A word and how its value is written.
    pub fn word(&mut self, letter: char, comma: bool, value: &Expr) -> Word {
        let form = form(value);
        Word { letter, comma, value: self.value(value), form }
    }
}

/// What a number names.
pub fn numbered(control: &Control, number: u32) -> Var {
    let number = control.cell("#", number);
    if (1..=33).contains(&number) {
        return Var::Local(number as usize);
    }
    if let Some((state, subscripts, row)) = control.read_system("#", Some(number)) {
        return Var::System(Box::new(System {
            number,
            state,
            subscripts,
            readable: row.access != "w",
            writable: row.access != "r",
            most: row.most,
            unsure: (!row.origin.is_settled()).then(|| row.fact()),
        }));
    }
    match control.variable_class("#", number) {
        Some(_) => Var::Shared(number),
        None => Var::Missing(number),
    }
}

fn form(value: &Expr) -> Form {
    match &value.kind {
        ExprKind::Number(number) if number.point => Form::Point,
        ExprKind::Number(_) => Form::Bare,
        ExprKind::Variable(_) => Form::Variable,
        ExprKind::Negate(inner) | ExprKind::Plus(inner) => match form(inner) {
            literal @ (Form::Bare | Form::Point) => literal,
            Form::Variable | Form::Wrapped => Form::Wrapped,
            Form::Computed => Form::Computed,
        },
        ExprKind::Group(inner) if matches!(form(inner), Form::Variable | Form::Wrapped) => Form::Wrapped,
        _ => Form::Computed,
    }
}

fn is_relation(op: BinaryOp) -> bool {
    use BinaryOp::*;
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

/// True where an expression compares, or joins comparisons.
fn compares(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Group(inner) | ExprKind::Not(inner) => compares(inner),
        ExprKind::Binary(BinaryOp::And | BinaryOp::Or | BinaryOp::Xor, operands) => {
            operands.iter().all(compares)
        }
        ExprKind::Binary(op, ..) => is_relation(*op),
        _ => false,
    }
}
