//! Words, comments and statements.

use super::super::statements::MOST_CONDITIONS;
use super::cursor::{Reader, is_blank, taken};
use super::expressions::constant;
use crate::syntax::{
    Comment, Expr, ExprKind, Fence, Index, ItemKind, Number, ProgramName, Target, TokenKind, Word,
};
use crate::text::Span;

impl<const ITEMS: bool, const TOKENS: bool> Reader<'_, ITEMS, TOKENS> {
    /// Reads the whole block.
    pub fn block(&mut self) -> Option<()> {
        self.items(0)?;
        self.end_of_block()
    }

    /// Reads items up to the end of the block; `depth` says under how many conditions.
    fn items(&mut self, depth: usize) -> Option<()> {
        while self.at < self.line.len() {
            let start = self.at as u32;
            match self.byte() {
                b'N' | b'n' => self.sequence()?,
                b'O' | b'o' | b':' => self.program()?,
                b'A'..=b'Z' | b'a'..=b'z' if self.byte_after(1).is_ascii_alphabetic() => {
                    self.statement(depth)?;
                }
                letter @ (b'A'..=b'Z' | b'a'..=b'z') => self.word(start, letter, false)?,
                b'#' => self.assign()?,
                b' ' | b'\t' => self.blanks(),
                b'(' => self.comment()?,
                b';' => return Some(()),
                b'/' => self.skip(),
                b'%' => {
                    self.take(TokenKind::Mark, 1);
                    self.item(start, ItemKind::Tape);
                }
                b',' => {
                    self.take(TokenKind::Operator, 1);
                    match self.byte() {
                        letter @ (b'A'..=b'M' | b'P'..=b'Z' | b'a'..=b'm' | b'p'..=b'z') => {
                            self.word(start, letter, true)?;
                        }
                        _ => return None,
                    }
                }
                _ => return None,
            }
        }
        Some(())
    }

    /// The `;` and the blanks that end the line after it, if there is one.
    fn end_of_block(&mut self) -> Option<()> {
        if self.at == self.line.len() {
            return Some(());
        }
        let sign = self.take_close(TokenKind::EndOfBlock, 1);
        let after = self.rest();
        let blanks = after.iter().take_while(|byte| is_blank(**byte)).count();
        self.item(sign.start, ItemKind::EndOfBlock);
        match after.get(blanks) {
            // The grammar's side knows that tape leader after a block counts as blanks.
            Some(0 | 0x7f) => return None,
            // Other blanks belong to the next block.
            None if blanks > 0 => self.blanks(),
            _ => {}
        }
        Some(())
    }

    fn sequence(&mut self) -> Option<()> {
        let letter = self.take(TokenKind::Letter, 1);
        let number = self.integer()?;
        self.item(letter.start, ItemKind::Sequence { number, inserted: false });
        Some(())
    }

    fn program(&mut self) -> Option<()> {
        let letter = self.take(TokenKind::Letter, 1);
        let number = self.integer()?;
        self.item(letter.start, ItemKind::Program(ProgramName::Number(number)));
        Some(())
    }

    /// A letter and its value directly after it. A plain word is put together where its parts are at hand: nine of
    /// ten words are plain, and to hand an expression on takes longer than to read it.
    #[inline]
    fn word(&mut self, start: u32, letter: u8, comma: bool) -> Option<()> {
        self.take_close(TokenKind::Letter, 1);
        let letter = letter.to_ascii_uppercase();
        match (self.byte(), self.byte_after(1)) {
            (b'0'..=b'9' | b'.', _) => {
                let (number, span) = self.number_of(letter)?;
                self.word_with(start, letter, comma, Expr { kind: ExprKind::Number(number), span });
            }
            (sign @ (b'-' | b'+'), b'0'..=b'9' | b'.') => {
                let sign_span = self.take_close(TokenKind::Operator, 1);
                let (number, span) = self.number_of(letter)?;
                if ITEMS {
                    let inner = Box::new(Expr { kind: ExprKind::Number(number), span });
                    let kind = if sign == b'-' { ExprKind::Negate(inner) } else { ExprKind::Plus(inner) };
                    self.word_with(start, letter, comma, Expr { kind, span: sign_span.to(span) });
                }
            }
            _ => {
                self.doubt();
                let value = self.signed_value()?;
                self.doubt_if(!ITEMS && constant(&value).is_some())?;
                self.word_with(start, letter, comma, value);
            }
        }
        Some(())
    }

    /// The number of a plain word.
    #[inline(always)]
    fn number_of(&mut self, letter: u8) -> Option<(Number, Span)> {
        let (number, span) = self.number()?;
        self.doubt_if(can_be_wrong(letter, number))?;
        Some((number, span))
    }

    #[inline(always)]
    fn word_with(&mut self, start: u32, letter: u8, comma: bool, value: Expr) {
        let letter = char::from(letter);
        self.item(start, ItemKind::Word(Word { letter, comma, value: Some(value), equals: false }));
    }

    /// A comment that is closed and holds no other.
    fn comment(&mut self) -> Option<()> {
        let text = self.line.get(self.at + 1..)?;
        let length = memchr::memchr2(b')', b'(', text).filter(|end| text.get(*end) == Some(&b')'))?;
        let span = self.take(TokenKind::Comment, length + 2);
        let text = Span::new(span.start + 1, span.end - 1);
        self.item(span.start, ItemKind::Comment(Comment { text, fence: Fence::Closed }));
        Some(())
    }

    /// `/`, or `/2` where one digit stands.
    fn skip(&mut self) {
        let switch = self.byte_after(1);
        let numbered = switch.is_ascii_digit() && !self.byte_after(2).is_ascii_digit();
        let span = self.take(TokenKind::Skip, 1 + usize::from(numbered));
        self.item(span.start, ItemKind::Skip(numbered.then(|| switch - b'0')));
    }

    fn assign(&mut self) -> Option<()> {
        self.doubt();
        let target = self.variable()?;
        let start = target.span.start;
        self.take_sign(b'=', TokenKind::Operator)?;
        let value = self.expression()?;
        if ITEMS {
            self.item(start, ItemKind::Assign { target: Box::new(target), value, by_sign: false });
            return Some(());
        }
        let long = |number: Number| self.rules.constant_digits.is_some_and(|most| number.digits > most);
        self.doubt_if(target.index == Index::Number(0) || constant(&value).is_some_and(long))?;
        self.met += 1;
        Some(())
    }

    /// What begins with a keyword.
    fn statement(&mut self, depth: usize) -> Option<()> {
        self.doubt();
        let start = self.at as u32;
        let kind = match self.byte() | 0x20 {
            b'i' => self.conditional(depth)?,
            b'g' => self.jump()?,
            b'w' => {
                self.take_keyword(b"WHILE")?;
                let condition = self.condition()?;
                self.loop_head(Some(condition))?
            }
            b'd' => self.loop_head(None)?,
            b'e' => {
                self.take_keyword(b"END")?;
                ItemKind::End { number: self.loop_number()? }
            }
            _ => return None,
        };
        self.item(start, kind);
        Some(())
    }

    fn conditional(&mut self, depth: usize) -> Option<ItemKind> {
        if depth >= MOST_CONDITIONS {
            return None;
        }
        self.take_keyword(b"IF")?;
        let condition = self.condition()?;
        let (first, met) = (self.items.len(), self.met);
        while self.byte() == b'(' {
            self.comment()?;
        }
        let then = self.take_keyword(b"THEN").is_some();
        self.items(depth + 1)?;
        if !ITEMS {
            // Nothing conditional is a fault.
            self.doubt_if(self.met == met)?;
            return Some(ItemKind::EndOfBlock);
        }
        let body = taken(self.items, first);
        Some(ItemKind::If { condition: Box::new(condition), then, bare: false, body })
    }

    fn jump(&mut self) -> Option<ItemKind> {
        self.take_keyword(b"GOTO")?;
        let target = match self.byte() {
            b'0'..=b'9' => Target::Sequence(self.integer()?),
            b'#' | b'[' => Target::Computed(self.value()?),
            _ => return None,
        };
        Some(ItemKind::Goto(target))
    }

    fn loop_head(&mut self, condition: Option<Expr>) -> Option<ItemKind> {
        self.take_keyword(b"DO")?;
        Some(ItemKind::Do { condition, number: self.loop_number()? })
    }

    fn loop_number(&mut self) -> Option<u32> {
        let number = self.integer()?;
        self.doubt_if(!(1..=3).contains(&number))?;
        Some(number)
    }
}

/// True for a plain word that the checks look at: a code that calls a macro, a whole number with a point.
#[inline(always)]
fn can_be_wrong(letter: u8, number: Number) -> bool {
    match letter {
        b'G' => (65.0..67.0).contains(&number.value),
        b'M' | b'S' | b'T' => number.point,
        _ => false,
    }
}
