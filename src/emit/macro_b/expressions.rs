//! Expressions, with as few brackets as keep their tree, and as a reader needs.

use super::Emitter;
use crate::canon::{Func, Sys};
use crate::diag::Code;
use crate::dialect::Question;
use crate::emit::common::spellings::Operator;
use crate::ir::{Bank, BinOp, Expr, Relation, Var};

/// Expressions inside one another before the writer gives up; no control reads as many.
const DEEPEST: u32 = 300;

/// What an expression is written for: ROUND means another thing in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// An assignment, a condition, a jump.
    Statement,
    /// A word whose value the control rounds to an increment that is no whole number.
    Word,
    /// A word of whole numbers, where both kinds of rounding are one; an argument, whose
    /// increment its macro does not see.
    Whole,
}

/// Where an operand stands.
#[derive(Clone, Copy)]
struct Spot {
    /// Operators that bind less tightly than this are bracketed.
    rank: u32,
    /// True where a sign may stand: at the start, or with nothing but sums before the
    /// next operator.
    sign: bool,
}

impl Spot {
    const FREE: Spot = Spot { rank: 0, sign: true };
    /// The operand of a function's slash or of a sign: nothing may go without brackets.
    const CLOSED: Spot = Spot { rank: u32::MAX, sign: false };
}

impl Emitter<'_> {
    /// Writes a value to which nothing else is joined.
    pub(super) fn value(&mut self, value: &Expr) {
        self.expression(value, Spot::FREE);
    }

    /// Writes a value in brackets.
    pub(super) fn bracketed(&mut self, value: &Expr) {
        self.open();
        self.value(value);
        self.close();
    }

    /// Writes one side of a comparison.
    pub(super) fn compared(&mut self, value: &Expr, relation: Relation) {
        let rank = self.spellings.relation(relation).rank;
        // AND, OR and XOR could be read as joining conditions here.
        let bits = matches!(value, Expr::Binary(BinOp::And | BinOp::Or | BinOp::Xor, ..));
        // A sum is bracketed as people do: a control that binds a comparison as tightly would compare its last part alone.
        let sum = matches!(value, Expr::Binary(BinOp::Add | BinOp::Sub, ..));
        let rank = if rank == 0 || bits || sum { u32::MAX } else { rank.saturating_add(1) };
        self.expression(value, Spot { rank, sign: true });
    }

    /// Opens a bracket.
    pub(super) fn open(&mut self) {
        self.out.push('[');
        self.depth += 1;
        if let Some(most) = self.spellings.brackets
            && self.depth == most.saturating_add(1)
        {
            self.out.refuse(Code::NestsTooDeep, format!("more than {most} brackets inside one another"));
        }
    }

    /// Closes a bracket.
    pub(super) fn close(&mut self) {
        self.out.push(']');
        self.depth = self.depth.saturating_sub(1);
    }

    fn expression(&mut self, value: &Expr, spot: Spot) {
        if self.nested >= DEEPEST {
            return self.out.unmapped("an expression of so many operations");
        }
        self.nested += 1;
        match value {
            Expr::Number(number) if number.is_sign_negative() && !spot.sign => self.bracketed(value),
            Expr::Number(number) => self.out.number(*number, false),
            Expr::Increments(_) => self.out.unmapped("a count of increments in an expression"),
            Expr::Vacant => self.state(Sys::Empty, &[], false),
            Expr::Var(var) => self.variable(*var),
            Expr::Indirect(bank, number) => self.indirect(*bank, number),
            Expr::System(state, subscripts) => self.state(*state, subscripts, false),
            Expr::Negate(_) if !spot.sign => self.bracketed(value),
            Expr::Negate(inner) => {
                self.out.push('-');
                self.signed(inner);
            }
            Expr::Binary(op, operands) => self.binary(*op, operands, spot),
            Expr::Call(function, arguments) => self.call(*function, arguments, spot),
            Expr::Truth(condition) if self.control.is(Question::ComparisonIsValue) => {
                self.open();
                self.condition(condition, false);
                self.close();
            }
            Expr::Truth(_) => self.out.unmapped("a comparison as a value"),
        }
        self.nested -= 1;
    }

    /// Writes what stands after a minus sign.
    pub(super) fn signed(&mut self, value: &Expr) {
        match value {
            Expr::Binary(..) => self.bracketed(value),
            _ => self.expression(value, Spot::CLOSED),
        }
    }

    /// A negative constant is added by taking its opposite away, which rounds alike.
    fn binary(&mut self, op: BinOp, [a, b]: &[Expr; 2], spot: Spot) {
        // A number in brackets, which the control rounds as what it computes.
        if let (BinOp::Add, Expr::Number(_), Expr::Number(0.0)) = (op, a, b) {
            return self.expression(a, spot);
        }
        if let (BinOp::Add | BinOp::Sub, Expr::Number(number)) = (op, b)
            && number.is_sign_negative()
        {
            let op = if op == BinOp::Add { BinOp::Sub } else { BinOp::Add };
            return self.joined_by(op, a, &Expr::Number(-number), spot);
        }
        self.joined_by(op, a, b, spot);
    }

    fn joined_by(&mut self, op: BinOp, a: &Expr, b: &Expr, spot: Spot) {
        let Operator { text, rank } = self.spellings.binary(op);
        if text.is_empty() {
            return self.out.unmapped(format_args!("the operator {op:?}"));
        }
        let bracket = spot.rank > rank;
        if bracket {
            self.open();
        }
        // Operators of one rank go from left to right; one of unknown rank shares no bracket.
        let (left, right) = if rank == 0 { (u32::MAX, u32::MAX) } else { (rank, rank.saturating_add(1)) };
        let sign = (spot.sign || bracket) && matches!(op, BinOp::Add | BinOp::Sub);
        self.operand(a, op, Spot { rank: left, sign });
        if text.bytes().all(|byte| byte.is_ascii_alphabetic()) {
            self.out.push(' ');
            self.out.push_str(text);
            self.out.push(' ');
        } else {
            self.out.push_str(text);
        }
        self.operand(b, op, Spot { rank: right, sign: false });
        if bracket {
            self.close();
        }
    }

    /// `ATAN[1]/10` is read as the function's two-argument form, so a call that could be
    /// taken for the beginning of one gets brackets beside a slash.
    fn operand(&mut self, value: &Expr, beside: BinOp, spot: Spot) {
        let ambiguous = matches!(value, Expr::Call(function, arguments)
            if arguments.len() == 1 && self.has_slash_form(*function));
        let mixed = matches!(value, Expr::Binary(inner, _) if !beside.reads_beside(*inner));
        if ambiguous && matches!(beside, BinOp::Mul | BinOp::Div) {
            self.bracketed(value);
        } else if mixed {
            self.expression(value, Spot::CLOSED);
        } else {
            self.expression(value, spot);
        }
    }

    fn has_slash_form(&self, function: Func) -> bool {
        self.spellings.function(function, 2).is_some_and(|row| row.form.as_deref() == Some("slash"))
    }

    fn call(&mut self, function: Func, arguments: &[Expr], spot: Spot) {
        let misread = match function {
            Func::Round => self.spellings.round_is_increment && self.place == Place::Word,
            Func::RoundIncrement => self.place == Place::Statement,
            _ => false,
        };
        // ROUND is one function in the table and another in a word.
        let listed = match function {
            Func::RoundIncrement if self.spellings.round_is_increment => Func::Round,
            other => other,
        };
        let row = self.spellings.function(listed, arguments.len()).filter(|_| !misread);
        let Some(row) = row else {
            let n = arguments.len();
            return self.out.unmapped(format_args!("the function '{function}' of {n} operands here"));
        };
        match arguments {
            [a, b] if row.form.as_deref() == Some("slash") => {
                let bracket = spot.rank > 0 || !spot.sign;
                if bracket {
                    self.open();
                }
                self.out.push_str(&row.spelling);
                self.bracketed(a);
                self.out.push('/');
                self.bracketed(b);
                if bracket {
                    self.close();
                }
            }
            _ => {
                self.out.push_str(&row.spelling);
                self.open();
                for (at, argument) in arguments.iter().enumerate() {
                    if at > 0 {
                        self.out.push(',');
                    }
                    self.value(argument);
                }
                self.close();
            }
        }
    }

    /// Writes a variable.
    pub(super) fn variable(&mut self, var: Var) {
        match self.register(var) {
            Some(number) => {
                self.out.push('#');
                self.out.integer(number);
            }
            None => {
                self.out.lacks_register();
            }
        }
    }

    /// The number of a variable on the target.
    pub(super) fn register(&self, var: Var) -> Option<u32> {
        let register = self.names.variable(var).filter(|register| &*register.name == "#")?;
        match register.index {
            crate::emit::Index::Number(number) => Some(number),
            crate::emit::Index::Letter(_) => None,
        }
    }

    /// Writes the variable with a computed number.
    pub(super) fn indirect(&mut self, bank: Bank, number: &Expr) {
        if bank != Bank::Numbered {
            return self.out.unmapped("a computed variable of another control's numbering");
        }
        self.out.push('#');
        self.bracketed(number);
    }
}
