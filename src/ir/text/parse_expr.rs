//! Parses expressions, conditions and places, to a limited depth.

use super::MAX_DEPTH;
use super::lex::Tok;
use super::parse::{Parsed, Parser, numbered};
use super::print_expr::{CLASSES, OPERATORS, RELATIONS};
use crate::canon::{Func, Sys};
use crate::ir::{Bank, Cond, Expr, Place, Var};

impl Parser<'_> {
    /// A whole expression.
    pub(super) fn expr(&mut self) -> Parsed<Expr> {
        self.operation(0)
    }

    /// Operands joined by operators of at least this rank.
    fn operation(&mut self, least: u8) -> Parsed<Expr> {
        self.nested(|p| {
            let mut left = p.operand()?;
            while let Some((op, _, rank)) =
                OPERATORS.iter().find(|(_, name, rank)| *rank >= least && p.is_operator(name))
            {
                p.next();
                let right = p.operation(rank + 1)?;
                left = Expr::binary(*op, left, right);
                // A chain makes the tree higher at each step.
                p.height += 1;
                p.limit(p.height)?;
            }
            Ok(left)
        })
    }

    fn is_operator(&self, name: &str) -> bool {
        *self.peek() == Tok::Mark(name) || *self.peek() == Tok::Word(name)
    }

    fn operand(&mut self) -> Parsed<Expr> {
        if self.eat_mark("-") {
            return match self.number()? {
                Some(value) => Ok(Expr::Number(-value)),
                None => Ok(Expr::Negate(Box::new(self.nested(Self::operand)?))),
            };
        }
        if self.eat_mark("(") {
            let inner = self.expr()?;
            self.mark(")")?;
            return Ok(inner);
        }
        if let Some(value) = self.number()? {
            return Ok(Expr::Number(value));
        }
        if let Some(place) = self.place()? {
            return Ok(place.read());
        }
        self.word_operand()
    }

    /// An operand that starts with a word. Apart from [`Parser::operand`] to keep that one's frame small.
    fn word_operand(&mut self) -> Parsed<Expr> {
        let word = self.word()?;
        match word {
            "vacant" => Ok(Expr::Vacant),
            "increments" => {
                self.mark("(")?;
                let minus = self.eat_mark("-");
                let value = self.number()?.ok_or_else(|| self.unexpected("a number"))?;
                self.mark(")")?;
                Ok(Expr::Increments(if minus { -value } else { value }))
            }
            "truth" => {
                self.mark("(")?;
                let cond = self.cond()?;
                self.mark(")")?;
                Ok(Expr::Truth(Box::new(cond)))
            }
            _ => {
                let function = Func::find(word).ok_or_else(|| self.unexpected_before("an expression"))?;
                Ok(Expr::Call(function, self.list("(", ")", Self::expr)?.into()))
            }
        }
    }

    /// An unsigned number, if one is next.
    fn number(&mut self) -> Parsed<Option<f64>> {
        let value = match *self.peek() {
            Tok::Number(digits) => digits.parse().map_err(|_| self.unexpected("a number"))?,
            Tok::Word("inf") => f64::INFINITY,
            Tok::Word("NaN") => f64::NAN,
            _ => return Ok(None),
        };
        self.next();
        Ok(Some(value))
    }

    /// A place, if one is next.
    pub(super) fn place(&mut self) -> Parsed<Option<Place>> {
        let bank = match *self.peek() {
            Tok::Mark("#") => Bank::Numbered,
            Tok::Word("global") => Bank::Global,
            Tok::Word("param") => Bank::Parametric,
            Tok::Word("sys") => {
                self.next();
                let state = Sys::find(self.word()?).ok_or_else(|| self.unexpected_before("a state"))?;
                let subscripts = match self.peek() {
                    Tok::Mark("[") => self.list("[", "]", Self::expr)?,
                    _ => Vec::new(),
                };
                return Ok(Some(Place::System(state, subscripts.into())));
            }
            Tok::Word(word) => {
                let found = variable(word);
                if found.is_some() {
                    self.next();
                }
                return Ok(found.map(Place::Var));
            }
            _ => return Ok(None),
        };
        self.next();
        self.mark("[")?;
        let index = self.expr()?;
        self.mark("]")?;
        Ok(Some(Place::Indirect(bank, Box::new(index))))
    }

    /// A variable with a plain number.
    pub(super) fn var(&mut self) -> Parsed<Var> {
        variable(self.word()?).ok_or_else(|| self.unexpected_before("a variable"))
    }

    /// A whole condition.
    pub(super) fn cond(&mut self) -> Parsed<Cond> {
        self.nested(|p| {
            if p.eat_word("all") {
                return Ok(Cond::And(p.list("(", ")", Self::cond)?));
            }
            if p.eat_word("any") {
                return Ok(Cond::Or(p.list("(", ")", Self::cond)?));
            }
            if p.eat_word("not") {
                p.mark("(")?;
                let inner = p.cond()?;
                p.mark(")")?;
                return Ok(Cond::Not(Box::new(inner)));
            }
            if p.eat_word("switch") {
                let number = p.integer()?;
                return u8::try_from(number).map(Cond::Switch).map_err(|_| p.unexpected_before("a switch"));
            }
            let left = p.expr()?;
            let word = p.word()?;
            let relation = RELATIONS.iter().find(|(_, name)| *name == word);
            let (relation, _) = relation.ok_or_else(|| p.unexpected_before("a relation"))?;
            Ok(Cond::Compare(*relation, left, p.expr()?))
        })
    }

    /// Parses one level further down. `height` becomes that of the highest tree of this level.
    fn nested<T>(&mut self, inner: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        let beside = std::mem::take(&mut self.height);
        self.depth += 1;
        self.limit(self.depth)?;
        let parsed = inner(self)?;
        self.depth -= 1;
        self.height = beside.max(self.height + 1);
        self.limit(self.height)?;
        Ok(parsed)
    }

    fn limit(&self, levels: usize) -> Parsed<()> {
        if levels > MAX_DEPTH { Err(self.unexpected("less nesting")) } else { Ok(()) }
    }
}

fn variable(word: &str) -> Option<Var> {
    let (name, number) = word.split_once('.')?;
    let (class, _) = CLASSES.iter().find(|(_, n)| *n == name)?;
    Some(Var { class: *class, number: numbered(number, "")? })
}
