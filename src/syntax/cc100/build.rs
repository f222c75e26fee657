//! From pest's pairs to the items of a block.

use super::grammar::Rule;
use crate::canon::Func;
use crate::diag::Code;
use crate::syntax::support::{fault, number};
use crate::syntax::*;
use crate::text::Span;
use pest::iterators::{Pair, Pairs};
use thin_vec::ThinVec;

/// Addresses whose active value can be read (seed 004, line 1633).
const READABLE: &str = "XYZEIJKADFRST";

/// The items of a block that was read, and what is wrong with them.
pub(super) fn items(line: Span, pairs: Pairs<'_, Rule>) -> (Vec<Item>, Vec<SyntaxError>) {
    let mut build = Build { start: line.start, errors: Vec::new() };
    let mut items = Vec::with_capacity(8);
    for pair in pairs.filter(|pair| pair.as_rule() != Rule::EOI) {
        let span = build.span(&pair);
        match build.item(pair) {
            Some(kind) => items.push(Item { kind, span }),
            // The grammar gives every rule its parts, so nothing reaches this.
            None => build.fault(Code::Unreadable, span, "this cannot be read"),
        }
    }
    // Files are kept whole: room to spare in each block would be most of what they take.
    items.shrink_to_fit();
    (items, build.errors)
}

struct Build {
    start: u32,
    errors: Vec<SyntaxError>,
}

impl Build {
    fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        Span::new(self.start + span.start() as u32, self.start + span.end() as u32)
    }

    fn fault(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.errors.push(fault(code, span, message));
    }

    /// A whole number; where it has too many digits, a fault and the largest one.
    fn whole(&mut self, digits: &Pair<'_, Rule>) -> u32 {
        digits.as_str().parse().unwrap_or_else(|_| {
            self.fault(Code::NumberTooLarge, self.span(digits), "the number has too many digits");
            u32::MAX
        })
    }

    fn item(&mut self, pair: Pair<'_, Rule>) -> Option<ItemKind> {
        let rule = pair.as_rule();
        let span = self.span(&pair);
        let mut parts = pair.into_inner();
        Some(match rule {
            Rule::word => {
                let letter = letter(&parts.next()?);
                let value = Some(self.constant(parts)?);
                ItemKind::Word(Word { letter, comma: false, value, equals: false })
            }
            Rule::parametric_word => {
                let letter = letter(&parts.next()?);
                let value = Some(self.parametric_value(letter, parts.nth(1)?)?);
                ItemKind::Word(Word { letter, comma: false, value, equals: true })
            }
            Rule::assign => {
                let target = self.variable(parts.next()?)?;
                let value = self.value(parts.nth(1)?)?;
                ItemKind::Assign { target: Box::new(target), value, by_sign: false }
            }
            Rule::sequence => {
                let inserted = parts.clone().any(|part| part.as_rule() == Rule::inserted);
                ItemKind::Sequence { number: self.whole(&parts.last()?), inserted }
            }
            Rule::label => ItemKind::Label(Label::Number(self.whole(&parts.last()?))),
            Rule::comment => {
                let text = Span::new(span.start + 1, span.end - 1);
                ItemKind::Comment(Comment { text, fence: Fence::Closed })
            }
            Rule::branch => {
                let relation = relation(parts.next()?.as_str())?;
                let to = parts.last()?;
                let target = match to.as_rule() {
                    Rule::variable => Target::Computed(self.operand(to)?),
                    _ => Target::Label(Label::Number(self.whole(&to))),
                };
                ItemKind::Branch { relation, target }
            }
            Rule::transfer => self.transfer(parts)?,
            Rule::test => {
                let subject = parts.last()?;
                ItemKind::Test(match subject.as_rule() {
                    Rule::variable => TestSubject::Variable(Box::new(self.variable(subject)?)),
                    Rule::flag => TestSubject::Flag(subject.as_str().chars().last()?.to_ascii_uppercase()),
                    _ => TestSubject::Code(self.whole(&subject)),
                })
            }
            Rule::step => {
                let down = parts.next()?.as_rule() == Rule::dec;
                ItemKind::Step { target: Box::new(self.variable(parts.next()?)?), down }
            }
            Rule::timer => ItemKind::Timer(Box::new(self.variable(parts.nth(1)?)?)),
            Rule::tape => ItemKind::Tape,
            Rule::skip => ItemKind::Skip(None),
            _ => return None,
        })
    }

    /// A number, with its sign where one stands.
    fn constant(&mut self, parts: Pairs<'_, Rule>) -> Option<Expr> {
        let mut sign = None;
        for part in parts {
            let span = self.span(&part);
            if part.as_rule() != Rule::number {
                sign = Some((part.as_str() == "-", span));
                continue;
            }
            let plain = Expr { kind: ExprKind::Number(number(part.as_str())), span };
            let Some((negative, start)) = sign else { return Some(plain) };
            let kind = if negative { ExprKind::Negate } else { ExprKind::Plus };
            return Some(Expr { span: start.to(span), kind: kind(Box::new(plain)) });
        }
        None
    }

    fn parametric_value(&mut self, letter: char, pair: Pair<'_, Rule>) -> Option<Expr> {
        if pair.as_rule() == Rule::variable {
            return self.operand(pair);
        }
        let message = format!("a variable follows `{letter}=`: put the constant into one");
        self.fault(Code::ConstantInWord, self.span(&pair), message);
        self.constant(pair.into_inner())
    }

    fn value(&mut self, pair: Pair<'_, Rule>) -> Option<Expr> {
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::call => {
                let mut parts = pair.into_inner();
                let function = function(parts.next()?.as_str())?;
                let argument = parts.next()?;
                self.want_variable(&argument, "the argument of a function");
                let arguments = ThinVec::from([self.operand(argument)?]);
                Some(Expr { kind: ExprKind::Call { function, arguments, form: CallForm::Plain }, span })
            }
            Rule::operation => {
                let mut parts = pair.into_inner();
                let left = parts.next()?;
                self.want_variable(&left, "the first operand");
                let left = self.operand(left)?;
                let op = match parts.next()?.as_rule() {
                    Rule::add => BinaryOp::Add,
                    Rule::subtract => BinaryOp::Subtract,
                    Rule::multiply => BinaryOp::Multiply,
                    _ => BinaryOp::Divide,
                };
                let right = self.operand(parts.next()?)?;
                Some(Expr { kind: ExprKind::Binary(op, Box::new([left, right])), span })
            }
            Rule::read => {
                let name = pair.as_str().to_ascii_uppercase();
                if !READABLE.contains(&name) {
                    let message =
                        format!("the active {name} cannot be read: only X Y Z E I J K A D F R S T can");
                    self.fault(Code::ValueNotReadable, span, message);
                }
                let variable = VarRef { name: name.into(), index: Index::None, span };
                Some(Expr { kind: ExprKind::Variable(Box::new(variable)), span })
            }
            _ => self.operand(pair),
        }
    }

    /// Notes a constant where the manual shows variables only.
    fn want_variable(&mut self, pair: &Pair<'_, Rule>, what: &str) {
        if pair.as_rule() == Rule::constant {
            let message = format!("{what} is a constant here: the manual shows only a variable");
            self.fault(Code::UnshownOperand, self.span(pair), message);
        }
    }

    fn operand(&mut self, pair: Pair<'_, Rule>) -> Option<Expr> {
        let span = self.span(&pair);
        match pair.as_rule() {
            Rule::variable => {
                let variable = self.variable(pair)?;
                Some(Expr { kind: ExprKind::Variable(Box::new(variable)), span })
            }
            Rule::slip_signed => {
                self.fault(
                    Code::SignedVariable,
                    span,
                    "a variable takes no sign: multiply it by -1 in a step of its own",
                );
                let mut parts = pair.into_inner();
                let negative = parts.next()?.as_str() == "-";
                let inner = Box::new(self.operand(parts.next()?)?);
                let kind = if negative { ExprKind::Negate } else { ExprKind::Plus };
                Some(Expr { kind: kind(inner), span })
            }
            _ => self.constant(pair.into_inner()),
        }
    }

    /// `V12`, `VX`.
    fn variable(&mut self, pair: Pair<'_, Rule>) -> Option<VarRef> {
        let span = self.span(&pair);
        let index = pair.into_inner().last()?;
        let index = match index.as_rule() {
            Rule::digits => Index::Number(self.whole(&index)),
            _ => Index::Letter(letter(&index)),
        };
        Some(VarRef { name: "V".into(), index, span })
    }

    /// `COR=T10 R=V1 V2=L`.
    fn transfer(&mut self, mut parts: Pairs<'_, Rule>) -> Option<ItemKind> {
        let name = parts.next()?.as_str().to_ascii_uppercase();
        let mut row = parts.nth(1)?.into_inner();
        let first = row.next()?;
        let row = match first.as_rule() {
            Rule::variable => TableRow::Variable(self.variable(first)?),
            _ => TableRow::Word(letter(&first), self.whole(&row.next()?)),
        };
        let mut cells = Vec::new();
        for cell in parts {
            let cell = cell.into_inner().next()?;
            let store = cell.as_rule() == Rule::store;
            let mut sides = cell.into_inner();
            let (first, second) = (sides.next()?, sides.nth(1)?);
            let (column, variable) = if store { (first, second) } else { (second, first) };
            cells.push(Cell { letter: letter(&column), variable: self.variable(variable)?, store });
        }
        Some(ItemKind::Transfer { table: Box::new(Table { name, row }), cells })
    }
}

fn letter(pair: &Pair<'_, Rule>) -> char {
    pair.as_str().chars().next().unwrap_or(' ').to_ascii_uppercase()
}

fn function(name: &str) -> Option<Func> {
    Some(match name.to_ascii_uppercase().as_str() {
        "SQR" => Func::Sqrt,
        "SIN" => Func::Sin,
        "COS" => Func::Cos,
        "ATN" => Func::Atan,
        _ => return None,
    })
}

fn relation(name: &str) -> Option<BinaryOp> {
    Some(match name.to_ascii_uppercase().as_str() {
        "BEQ" => BinaryOp::Equal,
        "BNE" => BinaryOp::NotEqual,
        "BGT" => BinaryOp::Greater,
        "BLT" => BinaryOp::Less,
        "BGE" => BinaryOp::GreaterEqual,
        "BLE" => BinaryOp::LessEqual,
        _ => return None,
    })
}
