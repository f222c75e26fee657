//! Expressions, conditions and variables of a block.

use super::lexeme::Lex;
use super::tree::{Builder, MOST_OPERATORS};
use crate::canon::Func;
use crate::syntax::{BinaryOp, CallForm, Expr, ExprKind, Index, SyntaxError, VarRef};
use crate::text::Span;
use thin_vec::ThinVec;

impl Builder<'_> {
    /// `#1+#2*3`
    pub fn expression(&mut self) -> Result<Expr, SyntaxError> {
        self.joined(0, Self::signed)
    }

    /// Operands with operators of at least this rank between them, from left to right.
    fn joined(
        &mut self,
        least: u8,
        operand: fn(&mut Self) -> Result<Expr, SyntaxError>,
    ) -> Result<Expr, SyntaxError> {
        let mut left = operand(self)?;
        while let Some((op, rank)) = self.operator_from(least) {
            self.operators += 1;
            if self.operators > MOST_OPERATORS {
                return Err(self.too_deep());
            }
            self.pass_space();
            self.take();
            self.pass_space();
            let right = self.joined(rank + 1, operand)?;
            left = binary(op, left, right);
        }
        Ok(left)
    }

    /// The next operator and its rank, if that is high enough.
    fn operator_from(&self, least: u8) -> Option<(BinaryOp, u8)> {
        let by = usize::from(self.kind() == Lex::Space);
        if !matches!(self.ahead(by), Lex::Operator | Lex::Join) {
            return None;
        }
        let (op, _) = operator(self.span_ahead(by).of(self.source))?;
        let rank = (self.rank)(op);
        (rank >= least).then_some((op, rank))
    }

    /// An operand with the sign before it.
    pub fn signed(&mut self) -> Result<Expr, SyntaxError> {
        let Some(sign) = self.take_if(Lex::Sign) else { return self.operand() };
        self.pass_space();
        let operand = Box::new(self.operand()?);
        let span = sign.to(operand.span);
        let minus = sign.of(self.source) == b"-";
        Ok(Expr { kind: if minus { ExprKind::Negate(operand) } else { ExprKind::Plus(operand) }, span })
    }

    /// A number, variable, bracket or function call.
    pub fn operand(&mut self) -> Result<Expr, SyntaxError> {
        match self.kind() {
            Lex::Number => {
                let span = self.take();
                Ok(Expr { kind: ExprKind::Number(self.number(span)), span })
            }
            Lex::Hash => self.variable_operand(),
            Lex::Open if self.at_named_variable() => self.variable_operand(),
            Lex::Open => self.group(),
            Lex::Function => self.call(),
            _ => Err(self.misfit()),
        }
    }

    fn variable_operand(&mut self) -> Result<Expr, SyntaxError> {
        let variable = self.variable()?;
        let span = variable.span;
        Ok(Expr { kind: ExprKind::Variable(Box::new(variable)), span })
    }

    /// `[#1+2]`
    fn group(&mut self) -> Result<Expr, SyntaxError> {
        let (inner, span) = self.bracketed()?;
        Ok(Expr { kind: ExprKind::Group(Box::new(inner)), span })
    }

    /// What stands in a pair of brackets, and the span of both.
    fn bracketed(&mut self) -> Result<(Expr, Span), SyntaxError> {
        let open = self.need(Lex::Open)?;
        self.pass_space();
        let inner = self.expression()?;
        self.pass_remarks();
        Ok((inner, open.to(self.need(Lex::Close)?)))
    }

    /// `[#1 EQ #2]`, and several joined: `[#1 EQ #2] AND [#3 EQ #4]`.
    pub fn condition(&mut self) -> Result<Expr, SyntaxError> {
        self.pass_space();
        self.joined(0, Self::group)
    }

    fn call(&mut self) -> Result<Expr, SyntaxError> {
        let word = self.take();
        let function = function(word.of(self.source)).ok_or_else(|| self.misfit())?;
        self.need(Lex::Open)?;
        self.pass_space();
        let mut arguments = ThinVec::from([self.expression()?]);
        let mut form = CallForm::Plain;
        if self.meets(Lex::Comma) {
            self.take();
            self.pass_space();
            arguments.push(self.expression()?);
            form = CallForm::Comma;
        }
        self.pass_remarks();
        let mut span = word.to(self.need(Lex::Close)?);
        if self.meets(Lex::Slash) {
            self.take();
            self.pass_space();
            let (argument, brackets) = self.bracketed()?;
            arguments.push(argument);
            form = CallForm::Slash;
            span = span.to(brackets);
        }
        Ok(Expr { kind: ExprKind::Call { function, arguments, form }, span })
    }

    /// True at `[#NAME`.
    pub fn at_named_variable(&self) -> bool {
        let mut ahead = (1..5).map(|by| self.ahead(by)).filter(|kind| *kind != Lex::Space);
        ahead.next() == Some(Lex::Hash) && ahead.next() == Some(Lex::Name)
    }

    /// `#1`, `#[#1+2]`, `#30057.21`, `[#NAME]`
    pub fn variable(&mut self) -> Result<VarRef, SyntaxError> {
        if self.kind() == Lex::Open {
            return self.named_variable();
        }
        let hash = self.need(Lex::Hash)?;
        self.pass_space();
        if self.kind() == Lex::Open {
            let (inner, brackets) = self.bracketed()?;
            let index = Index::Computed(Box::new(inner));
            return Ok(VarRef { name: "#".into(), index, span: hash.to(brackets) });
        }
        let number = self.integer()?;
        let index = match self.take_if(Lex::Bit) {
            Some(bit) => Index::Bit(number, self.digits(bit, &bit.of(self.source)[1..])),
            None => Index::Number(number),
        };
        Ok(VarRef { name: "#".into(), index, span: Span::new(hash.start, self.end()) })
    }

    /// `[#NAME]`; a name with a subscript, `[#_ABSIO[1]]`, is a family of variables called `#_ABSIO`.
    fn named_variable(&mut self) -> Result<VarRef, SyntaxError> {
        let open = self.need(Lex::Open)?;
        self.need(Lex::Hash)?;
        let span = self.need(Lex::Name)?;
        let name = upper(span.of(self.source));
        let (name, index) = if self.kind() == Lex::Open {
            (format!("#{name}"), Index::Computed(Box::new(self.bracketed()?.0)))
        } else {
            ("#".to_owned(), Index::Name(name))
        };
        Ok(VarRef { name: name.into(), index, span: open.to(self.need(Lex::Close)?) })
    }
}

fn binary(op: BinaryOp, left: Expr, right: Expr) -> Expr {
    let span = left.span.to(right.span);
    Expr { kind: ExprKind::Binary(op, Box::new([left, right])), span }
}

/// How close an operator binds where AND is a product and OR and XOR are sums.
pub fn bits_among_arithmetic(op: BinaryOp) -> u8 {
    match op {
        BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Modulo | BinaryOp::And => 2,
        BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Or | BinaryOp::Xor => 1,
        _ => 0,
    }
}

/// How close an operator binds where AND, OR and XOR join comparisons.
pub fn bits_behind_relations(op: BinaryOp) -> u8 {
    match op {
        BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Modulo => 4,
        BinaryOp::Add | BinaryOp::Subtract => 3,
        BinaryOp::And => 1,
        BinaryOp::Or | BinaryOp::Xor => 0,
        _ => 2,
    }
}

/// The operator that a text begins with, and how long it is.
pub fn operator(text: &[u8]) -> Option<(BinaryOp, usize)> {
    Some(match text.first()? {
        b'+' => (BinaryOp::Add, 1),
        b'-' => (BinaryOp::Subtract, 1),
        b'*' => (BinaryOp::Multiply, 1),
        b'/' => (BinaryOp::Divide, 1),
        b'A'..=b'Z' | b'a'..=b'z' => return named_operator(text),
        _ => return None,
    })
}

fn named_operator(text: &[u8]) -> Option<(BinaryOp, usize)> {
    let upper = |at: usize| text.get(at).map_or(0, u8::to_ascii_uppercase);
    Some(match [upper(0), upper(1), upper(2)] {
        [b'E', b'Q', _] => (BinaryOp::Equal, 2),
        [b'N', b'E', _] => (BinaryOp::NotEqual, 2),
        [b'L', b'T', _] => (BinaryOp::Less, 2),
        [b'L', b'E', _] => (BinaryOp::LessEqual, 2),
        [b'G', b'T', _] => (BinaryOp::Greater, 2),
        [b'G', b'E', _] => (BinaryOp::GreaterEqual, 2),
        [b'O', b'R', _] => (BinaryOp::Or, 2),
        [b'A', b'N', b'D'] => (BinaryOp::And, 3),
        [b'X', b'O', b'R'] => (BinaryOp::Xor, 3),
        [b'M', b'O', b'D'] => (BinaryOp::Modulo, 3),
        _ => return None,
    })
}

/// The function of a name.
pub fn function(text: &[u8]) -> Option<Func> {
    let mut name = [0; 5];
    for (to, from) in name.iter_mut().zip(text) {
        *to = from.to_ascii_uppercase();
    }
    Some(match name.get(..text.len())? {
        b"SIN" => Func::Sin,
        b"COS" => Func::Cos,
        b"TAN" => Func::Tan,
        b"ASIN" => Func::Asin,
        b"ACOS" => Func::Acos,
        b"ATAN" | b"ATN" => Func::Atan,
        b"SQRT" | b"SQR" => Func::Sqrt,
        b"ABS" => Func::Abs,
        b"ROUND" | b"RND" => Func::Round,
        b"FIX" => Func::Fix,
        b"FUP" => Func::Fup,
        b"LN" => Func::Ln,
        b"EXP" => Func::Exp,
        b"POW" => Func::Pow,
        b"BIN" => Func::Bin,
        b"BCD" => Func::Bcd,
        b"ADP" => Func::AddPoint,
        b"PRM" => Func::Parameter,
        _ => return None,
    })
}

/// A name in upper case.
pub fn upper(text: &[u8]) -> String {
    String::from_utf8_lossy(text).to_ascii_uppercase()
}
