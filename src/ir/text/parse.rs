//! Parses modules, programs, blocks and sites.

use super::TextError;
use super::lex::{At, Tok, error, lex};
use crate::ir::{Block, BlockId, Comment, Module, Program, SourceInfo, Stmt};
use crate::syntax::{Label, ProgramName};
use crate::text::Span;

/// What parsing yields.
pub(super) type Parsed<T> = Result<T, TextError>;

/// Reads tokens one after the other.
pub(super) struct Parser<'t> {
    text: &'t str,
    tokens: Vec<At<'t>>,
    at: usize,
    /// How deep the present expression nests.
    pub(super) depth: usize,
    /// How high the trees parsed at this depth are.
    pub(super) height: usize,
}

/// Reads a module.
pub(super) fn module(text: &str) -> Parsed<Module> {
    let mut p = Parser { text, tokens: lex(text)?, at: 0, depth: 0, height: 0 };
    let mut module = Module::default();
    p.eat_line();
    while *p.peek() != Tok::End {
        match p.word()? {
            "name" => {
                let var = p.var()?;
                let name = p.string()?;
                module.names.insert(var, name);
                p.line()?;
            }
            "program" => module.programs.push(p.program()?),
            _ => return Err(p.unexpected_before("'program' or 'name'")),
        }
    }
    Ok(module)
}

impl<'t> Parser<'t> {
    fn program(&mut self) -> Parsed<Program> {
        let name = if self.eat_word("unnamed") { None } else { Some(self.program_name()?) };
        let file = if self.eat_word("file") { self.integer()? as usize } else { 0 };
        let site = self.site()?;
        self.mark("{")?;
        self.line()?;
        let mut held = Vec::new();
        while self.eat_word("holds") {
            held.push((self.var()?, self.string()?));
            self.line()?;
        }
        let mut blocks = Vec::new();
        while !self.eat_mark("}") {
            if self.block_id()?.index() != blocks.len() {
                return Err(self.unexpected_before(&format!("'block{}'", blocks.len())));
            }
            blocks.push(self.block()?);
        }
        self.line()?;
        Ok(Program { name, file, site, held, blocks })
    }

    /// A block after its id.
    fn block(&mut self) -> Parsed<Block> {
        let mut labels = Vec::new();
        if self.eat_mark("(") {
            loop {
                labels.push(self.label()?);
                if !self.eat_mark(",") {
                    break;
                }
            }
            self.mark(")")?;
        }
        self.mark(":")?;
        self.line()?;
        let mut stmts = crate::ir::Stmts::new();
        loop {
            self.height = 0;
            if let Some(kind) = self.term_kind()? {
                let site = self.site()?;
                self.line()?;
                return Ok(Block {
                    labels: labels.into(),
                    stmts,
                    term: crate::ir::Terminator { kind, site },
                });
            }
            let kind = self.stmt_kind()?;
            let site = self.site()?;
            self.line()?;
            stmts.push(Stmt { kind, site });
        }
    }

    fn site(&mut self) -> Parsed<SourceInfo> {
        let mut site = SourceInfo::default();
        if self.eat_mark("@") {
            let start = self.integer()?;
            self.mark("..")?;
            site.span = Span::new(start, self.integer()?);
        }
        if let Tok::Word(word) = *self.peek()
            && let Some(number) = numbered(word, "N")
        {
            self.next();
            site.sequence = Some(number).into();
        }
        if self.eat_word("skip") {
            let level = self.integer()?;
            site.skip = Some(u8::try_from(level).map_err(|_| self.unexpected_before("a skip level"))?);
        }
        loop {
            let leading = self.eat_mark("^");
            if !leading && !matches!(self.peek(), Tok::Text(_)) {
                return Ok(site);
            }
            site.comments.push(Comment { text: self.string()?, leading });
        }
    }

    fn label(&mut self) -> Parsed<Label> {
        if self.eat_mark(":") {
            return Ok(Label::Name(match self.peek() {
                Tok::Text(_) => self.string()?,
                _ => self.word()?.to_owned(),
            }));
        }
        let number = numbered(self.word()?, "N").ok_or_else(|| self.unexpected_before("a label"))?;
        Ok(Label::Number(number))
    }

    pub(super) fn program_name(&mut self) -> Parsed<ProgramName> {
        if let Tok::Text(_) = self.peek() {
            return Ok(ProgramName::Name(self.string()?));
        }
        let number = numbered(self.word()?, "O").ok_or_else(|| self.unexpected_before("a program name"))?;
        Ok(ProgramName::Number(number))
    }

    pub(super) fn block_id(&mut self) -> Parsed<BlockId> {
        let id = numbered(self.word()?, "block").ok_or_else(|| self.unexpected_before("a block"))?;
        Ok(BlockId(id))
    }

    pub(super) fn peek(&self) -> &Tok<'t> {
        self.tokens.get(self.at).map_or(&Tok::End, |(token, _)| token)
    }

    pub(super) fn peek_second(&self) -> &Tok<'t> {
        self.tokens.get(self.at + 1).map_or(&Tok::End, |(token, _)| token)
    }

    pub(super) fn next(&mut self) {
        self.at += 1;
    }

    pub(super) fn eat_word(&mut self, word: &str) -> bool {
        let found = *self.peek() == Tok::Word(word);
        self.at += usize::from(found);
        found
    }

    pub(super) fn eat_mark(&mut self, mark: &str) -> bool {
        let found = *self.peek() == Tok::Mark(mark);
        self.at += usize::from(found);
        found
    }

    fn eat_line(&mut self) -> bool {
        let found = *self.peek() == Tok::Line;
        self.at += usize::from(found);
        found
    }

    fn line(&mut self) -> Parsed<()> {
        if self.eat_line() { Ok(()) } else { Err(self.unexpected("the end of the line")) }
    }

    pub(super) fn mark(&mut self, mark: &str) -> Parsed<()> {
        if self.eat_mark(mark) { Ok(()) } else { Err(self.unexpected(&format!("'{mark}'"))) }
    }

    pub(super) fn word(&mut self) -> Parsed<&'t str> {
        let Tok::Word(word) = *self.peek() else { return Err(self.unexpected("a word")) };
        self.next();
        Ok(word)
    }

    pub(super) fn string(&mut self) -> Parsed<String> {
        let Tok::Text(text) = self.peek() else { return Err(self.unexpected("a text in quotes")) };
        let text = text.clone();
        self.next();
        Ok(text)
    }

    pub(super) fn integer(&mut self) -> Parsed<u32> {
        let Tok::Number(digits) = *self.peek() else { return Err(self.unexpected("a whole number")) };
        let value = digits.parse().map_err(|_| self.unexpected("a whole number"))?;
        self.next();
        Ok(value)
    }

    /// An error at the next token.
    pub(super) fn unexpected(&self, wanted: &str) -> TextError {
        let at = self.tokens.get(self.at).map_or(self.text.len(), |(_, at)| *at);
        error(self.text, at, format!("expected {wanted}"))
    }

    /// An error at the token just read.
    pub(super) fn unexpected_before(&self, wanted: &str) -> TextError {
        let at = self.tokens.get(self.at.saturating_sub(1)).map_or(0, |(_, at)| *at);
        error(self.text, at, format!("expected {wanted}"))
    }
}

/// The number after a prefix: `N10`.
pub(super) fn numbered(word: &str, prefix: &str) -> Option<u32> {
    word.strip_prefix(prefix)?.parse().ok()
}
