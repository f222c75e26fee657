//! Parses statements, terminators and calls.

use super::lex::Tok;
use super::parse::{Parsed, Parser};
use super::print_expr::CLASSES;
use crate::canon::{Op, Role};
use crate::ir::{Argument, Call, Callee, Expr, Nc, NcItem, OutputPart, PrintPart, StmtKind, TermKind};

impl Parser<'_> {
    /// What a statement does.
    pub(super) fn stmt_kind(&mut self) -> Parsed<StmtKind> {
        let Tok::Word(word) = *self.peek() else { return self.assign() };
        let kind = match word {
            "comment" => StmtKind::Comment,
            "modal.off" => StmtKind::ModalCallOff,
            "port.open" => StmtKind::OpenPort,
            "port.close" => StmtKind::ClosePort,
            "sync" => StmtKind::Sync,
            "nc" | "modal" | "alarm" | "stop" | "output" | "print" | "input" | "lookahead" | "names"
            | "clear" => {
                self.next();
                return self.stmt_rest(word);
            }
            _ => return self.assign(),
        };
        self.next();
        Ok(kind)
    }

    fn assign(&mut self) -> Parsed<StmtKind> {
        let target = self.place()?.ok_or_else(|| self.unexpected("a statement or a terminator"))?;
        self.mark("=")?;
        Ok(StmtKind::Assign { target, value: self.expr()? })
    }

    /// A statement after its first word.
    fn stmt_rest(&mut self, word: &str) -> Parsed<StmtKind> {
        Ok(match word {
            "nc" => StmtKind::Nc(self.nc()?),
            "modal" => StmtKind::ModalCall(Box::new(self.call()?)),
            "alarm" => StmtKind::Alarm { number: self.expr()?.into(), text: self.string()?.into() },
            "stop" => StmtKind::StopMessage { number: self.expr()?.into(), text: self.string()?.into() },
            "output" => StmtKind::Output(self.list("[", "]", Self::output_part)?),
            "print" => {
                let serial = self.eat_word("serial");
                let parts = self.list("[", "]", |p| match p.peek() {
                    Tok::Text(_) => Ok(PrintPart::Text(p.string()?)),
                    _ => Ok(PrintPart::Value(p.expr()?)),
                })?;
                StmtKind::Print { serial, parts: parts.into(), stay: self.eat_word("stay") }
            }
            "input" => {
                let serial = self.eat_word("serial");
                let target = self.place()?.ok_or_else(|| self.unexpected("a place"))?;
                StmtKind::Input { serial, target }
            }
            "clear" => {
                let word = self.word()?;
                let class = CLASSES.iter().find(|(_, name)| *name == word);
                StmtKind::ClearAll(class.ok_or_else(|| self.unexpected_before("a class"))?.0)
            }
            "lookahead" => StmtKind::LimitLookahead(self.expr()?),
            _ => StmtKind::SetNames { first: self.var()?, names: self.list("[", "]", Self::string)?.into() },
        })
    }

    fn output_part(&mut self) -> Parsed<OutputPart> {
        if let Tok::Text(_) = self.peek() {
            return Ok(OutputPart::Text(self.string()?));
        }
        let value = self.expr()?;
        self.mark(":")?;
        let whole = self.integer()?;
        self.mark(",")?;
        Ok(OutputPart::Value { value, whole, fraction: self.integer()? })
    }

    fn nc(&mut self) -> Parsed<Nc> {
        let mut items = Vec::new();
        loop {
            let named = *self.peek_second() == Tok::Mark("=");
            let item = match self.peek().clone() {
                Tok::Word(word) if named => {
                    self.next();
                    match Role::find(word) {
                        Some(role) => NcItem::Word(role, self.named_value()?),
                        None => NcItem::Code(self.letter(word)?, self.named_value()?),
                    }
                }
                Tok::Text(text) if named => {
                    self.next();
                    NcItem::Code(self.letter(&text)?, self.named_value()?)
                }
                Tok::Word(word) => {
                    let Some(op) = Op::find(word) else { return Ok(Nc { items }) };
                    self.next();
                    NcItem::Op(op)
                }
                _ => return Ok(Nc { items }),
            };
            items.push(item);
        }
    }

    fn named_value(&mut self) -> Parsed<Expr> {
        self.mark("=")?;
        self.expr()
    }

    fn letter(&self, text: &str) -> Parsed<char> {
        let mut chars = text.chars();
        match (chars.next(), chars.next()) {
            (Some(letter), None) => Ok(letter),
            _ => Err(self.unexpected_before("a role or a letter before '='")),
        }
    }

    /// A terminator, if one is next.
    pub(super) fn term_kind(&mut self) -> Parsed<Option<TermKind>> {
        let Tok::Word(word) = *self.peek() else { return Ok(None) };
        if !matches!(word, "jump" | "branch" | "computed" | "call" | "return" | "chain" | "end" | "stray") {
            return Ok(None);
        }
        self.next();
        Ok(Some(match word {
            "jump" => TermKind::Jump(self.block_id()?),
            "branch" => {
                let cond = self.cond()?;
                self.mark("?")?;
                let then = self.block_id()?;
                self.mark(":")?;
                TermKind::Branch { cond: Box::new(cond), then, otherwise: self.block_id()? }
            }
            "computed" => {
                let value = self.expr()?;
                let targets = self.list("{", "}", |p| {
                    let number = p.integer()?;
                    p.mark(":")?;
                    Ok((number, p.block_id()?))
                })?;
                TermKind::Computed { value: Box::new(value), targets: targets.into() }
            }
            "call" => {
                let call = self.call()?;
                self.mark("->")?;
                TermKind::Call { call: Box::new(call), next: self.block_id()? }
            }
            "return" => {
                let to = if self.eat_word("to") { Some(self.expr()?) } else { None };
                TermKind::Return { to }
            }
            "chain" => TermKind::Chain(self.program_name()?),
            "end" => TermKind::End { rewind: self.eat_word("rewind") },
            _ => TermKind::Stray,
        }))
    }

    fn call(&mut self) -> Parsed<Call> {
        let callee = match *self.peek() {
            Tok::Word("computed") => {
                self.next();
                Callee::Computed(self.expr()?)
            }
            Tok::Word("cycle") => {
                self.next();
                Callee::Cycle(self.integer()?)
            }
            Tok::Word(word) if word.starts_with("block") => Callee::Block(self.block_id()?),
            _ => Callee::Program(self.program_name()?),
        };
        let level = self.eat_word("level");
        let arguments = if *self.peek() == Tok::Mark("(") {
            self.list("(", ")", |p| {
                let local = p.integer()?;
                p.mark(":")?;
                Ok(Argument { local, value: p.expr()? })
            })?
        } else {
            Vec::new()
        };
        let count = if self.eat_word("times") { Some(self.expr()?) } else { None };
        Ok(Call { callee, level, arguments, count })
    }

    /// Things between two marks, with commas between them.
    pub(super) fn list<T>(
        &mut self,
        open: &str,
        close: &str,
        mut item: impl FnMut(&mut Self) -> Parsed<T>,
    ) -> Parsed<Vec<T>> {
        self.mark(open)?;
        let mut out = Vec::new();
        if self.eat_mark(close) {
            return Ok(out);
        }
        loop {
            out.push(item(self)?);
            if !self.eat_mark(",") {
                break;
            }
        }
        self.mark(close)?;
        Ok(out)
    }
}
