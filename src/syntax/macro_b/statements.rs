//! Words and statements of a block.

use super::lexeme::Lex;
use super::tree::Builder;
use crate::syntax::{Comment, Fence, Item, ItemKind, OutputPart, ProgramName, SyntaxError, Target, Word};
use crate::text::Span;

/// IFs that may stand after one another in a block.
pub const MOST_CONDITIONS: usize = 20;

impl Builder<'_> {
    /// Reads items up to the end of the row; under an IF (`depth` above 0) up to the end of the block.
    pub fn items(&mut self, items: &mut Vec<Item>, depth: usize) -> Result<(), SyntaxError> {
        loop {
            let start = self.here().start;
            let kind = match self.kind() {
                Lex::Nothing => return Ok(()),
                Lex::EndOfBlock if depth > 0 => return Ok(()),
                Lex::Space => {
                    self.take();
                    continue;
                }
                Lex::Letter => self.word(false)?,
                Lex::Comma => {
                    self.take();
                    self.word(true)?
                }
                Lex::Comment => self.comment(),
                Lex::EndOfBlock => self.mark(ItemKind::EndOfBlock),
                Lex::Tape => self.mark(ItemKind::Tape),
                Lex::Skip => self.skip(),
                Lex::SequenceLetter => {
                    self.take();
                    ItemKind::Sequence { number: self.integer()?, inserted: false }
                }
                Lex::ProgramLetter | Lex::ProgramName => self.program()?,
                Lex::Hash => self.assign()?,
                Lex::Open if self.at_named_variable() => self.assign()?,
                Lex::Open | Lex::If => self.conditional(depth)?,
                Lex::Goto => {
                    self.take();
                    ItemKind::Goto(self.target()?)
                }
                Lex::While | Lex::Do => self.loop_head(items)?,
                Lex::End => {
                    self.take();
                    ItemKind::End { number: self.integer()? }
                }
                Lex::Output => self.output()?,
                Lex::Port => self.port(),
                Lex::SetNames => self.set_names()?,
                _ => return Err(self.misfit()),
            };
            items.push(Item { kind, span: Span::new(start, self.end()) });
            items.append(&mut self.within);
        }
    }

    /// Passes blanks and comments before a closing bracket. The comments follow the item as ones of their own.
    pub fn pass_remarks(&mut self) {
        while matches!(self.kind(), Lex::Space | Lex::Comment) {
            let span = self.here();
            if self.kind() == Lex::Space {
                self.take();
            } else if let ItemKind::Comment(comment) = self.comment() {
                let kind = ItemKind::Comment(Comment { fence: Fence::Within, ..comment });
                self.within.push(Item { kind, span });
            }
        }
    }

    fn mark(&mut self, kind: ItemKind) -> ItemKind {
        self.take();
        kind
    }

    fn word(&mut self, comma: bool) -> Result<ItemKind, SyntaxError> {
        let letter = self.need(Lex::Letter)?;
        self.pass_space();
        let value = Some(self.signed()?);
        Ok(ItemKind::Word(Word { letter: letter_of(letter.of(self.source)), comma, value, equals: false }))
    }

    fn comment(&mut self) -> ItemKind {
        let span = self.take();
        let closed = span.len() > 1 && span.of(self.source).last() == Some(&b')');
        let (end, fence) = if closed { (span.end - 1, Fence::Closed) } else { (span.end, Fence::Open) };
        ItemKind::Comment(Comment { text: Span::new(span.start + 1, end), fence })
    }

    fn skip(&mut self) -> ItemKind {
        let span = self.take();
        ItemKind::Skip(span.of(self.source).get(1).map(|digit| digit.wrapping_sub(b'0')))
    }

    fn program(&mut self) -> Result<ItemKind, SyntaxError> {
        if self.take_if(Lex::ProgramLetter).is_some() && !self.meets(Lex::ProgramName) {
            return Ok(ItemKind::Program(ProgramName::Number(self.integer()?)));
        }
        let span = self.need(Lex::ProgramName)?;
        let text = span.of(self.source);
        let name = text.get(1..text.len().saturating_sub(1)).unwrap_or_default();
        Ok(ItemKind::Program(ProgramName::Name(String::from_utf8_lossy(name).into_owned())))
    }

    fn assign(&mut self) -> Result<ItemKind, SyntaxError> {
        let target = self.variable()?;
        self.need(Lex::Equals)?;
        self.pass_space();
        Ok(ItemKind::Assign { target: Box::new(target), value: self.expression()?, by_sign: false })
    }

    fn conditional(&mut self, depth: usize) -> Result<ItemKind, SyntaxError> {
        if depth >= MOST_CONDITIONS {
            return Err(self.too_deep());
        }
        let bare = self.take_if(Lex::If).is_none();
        let condition = self.condition()?;
        let mut body = Vec::with_capacity(1);
        body.append(&mut self.within);
        while matches!(self.kind(), Lex::Space | Lex::Comment) {
            self.gap(&mut body);
        }
        let then = self.take_if(Lex::Then).is_some();
        self.items(&mut body, depth + 1)?;
        body.shrink_to_fit();
        Ok(ItemKind::If { condition: Box::new(condition), then, bare, body })
    }

    /// Blanks and comments between the parts of a statement; a comment is kept as an item.
    fn gap(&mut self, items: &mut Vec<Item>) {
        if self.kind() == Lex::Space {
            self.take();
        } else {
            let span = self.here();
            items.push(Item { kind: self.comment(), span });
        }
    }

    fn target(&mut self) -> Result<Target, SyntaxError> {
        self.pass_space();
        if self.kind() == Lex::Integer {
            return Ok(Target::Sequence(self.integer()?));
        }
        Ok(Target::Computed(self.operand()?))
    }

    fn loop_head(&mut self, items: &mut Vec<Item>) -> Result<ItemKind, SyntaxError> {
        let condition = match self.take_if(Lex::While) {
            Some(_) => Some(self.condition()?),
            None => None,
        };
        items.append(&mut self.within);
        while matches!(self.kind(), Lex::Space | Lex::Comment) {
            self.gap(items);
        }
        self.need(Lex::Do)?;
        Ok(ItemKind::Do { condition, number: self.integer()? })
    }

    fn port(&mut self) -> ItemKind {
        let open = self.take().of(self.source).get(1).is_some_and(|byte| byte.eq_ignore_ascii_case(&b'O'));
        if open { ItemKind::OpenPort } else { ItemKind::ClosePort }
    }

    fn output(&mut self) -> Result<ItemKind, SyntaxError> {
        let binary = self.take().of(self.source).first().is_some_and(|byte| byte.eq_ignore_ascii_case(&b'B'));
        self.need(Lex::Open)?;
        let mut parts = Vec::new();
        loop {
            match self.kind() {
                Lex::Close => {
                    self.take();
                    return Ok(ItemKind::Output { binary, parts });
                }
                Lex::OutputText => parts.push(OutputPart::Text(self.take())),
                Lex::Hash => {
                    let value = self.operand()?;
                    self.need(Lex::Open)?;
                    let digits = self.need(Lex::Integer)?;
                    self.need(Lex::Close)?;
                    // [53] is two numbers of one digit each; [3] has only the second.
                    let (whole, fraction) = match digits.of(self.source) {
                        [whole, fraction] => (whole.wrapping_sub(b'0'), fraction.wrapping_sub(b'0')),
                        [fraction] => (0, fraction.wrapping_sub(b'0')),
                        _ => {
                            self.output_format(digits);
                            (0, 0)
                        }
                    };
                    let (whole, fraction) = (u32::from(whole), u32::from(fraction));
                    parts.push(OutputPart::Value { value, whole, fraction });
                }
                _ => return Err(self.misfit()),
            }
        }
    }

    fn output_format(&mut self, span: Span) {
        let message = "an output format has two digits: the places before and after the point, as in `[53]`";
        self.errors.push(SyntaxError {
            code: crate::diag::Code::OutputFormat,
            span,
            message: message.to_owned(),
        });
    }

    fn set_names(&mut self) -> Result<ItemKind, SyntaxError> {
        self.take();
        let first = self.integer()?;
        self.need(Lex::Open)?;
        let mut names = Vec::new();
        loop {
            let name = self.need(Lex::Name)?;
            names.push(super::expressions::upper(name.of(self.source)));
            if !self.meets(Lex::Comma) {
                break;
            }
            self.take();
        }
        self.need(Lex::Close)?;
        Ok(ItemKind::SetNames { first, names })
    }
}

fn letter_of(text: &[u8]) -> char {
    text.first().map_or(' ', |byte| char::from(byte.to_ascii_uppercase()))
}
