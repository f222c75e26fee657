//! From pest's pairs to the items of a block.

use super::builder::Build;
use super::check::{condition, value};
use super::grammar::Rule;
use crate::diag::Code;
use crate::syntax::*;
use crate::text::Span;
use pest::iterators::{Pair, Pairs};

/// Characters of a macro line from its `#` on (seed 000, line 225).
pub(super) const MACRO_LINE: u32 = 63;

/// The items of a line that was read, and what is wrong with them.
pub(super) fn items(source: &[u8], line: Span, pairs: Pairs<'_, Rule>) -> (Vec<Item>, Vec<SyntaxError>) {
    let mut build = Build::new(source, line);
    let mut items = Vec::with_capacity(8);
    for pair in pairs.filter(|pair| pair.as_rule() != Rule::EOI) {
        let span = build.span(&pair);
        match build.item(pair) {
            Some(item) => items.push(item),
            // The grammar gives every rule its parts, so nothing reaches this.
            None => build.fault(Code::Unreadable, span, "this cannot be read"),
        }
    }
    build.check_length(line);
    // Files are kept whole: room to spare in each block would be most of what they take.
    items.shrink_to_fit();
    (items, build.errors)
}

impl Build<'_> {
    fn item(&mut self, pair: Pair<'_, Rule>) -> Option<Item> {
        let mut span = self.span(&pair);
        let kind = match pair.as_rule() {
            Rule::word => self.word(pair),
            Rule::sequence => self.sequence(pair),
            Rule::set_r => self.set_by_sign(pair),
            Rule::mark => {
                self.mark = Some(span);
                ItemKind::MacroMark
            }
            Rule::label => ItemKind::Label(label(pair.as_str())),
            Rule::nc_comment | Rule::macro_comment => {
                // Blanks at the end of a comment are its own.
                span.end = span.start + pair.as_str().len() as u32;
                self.comment(pair, span)
            }
            Rule::program => {
                let number = pair.into_inner().last().map_or(0, |digits| self.whole(&digits));
                ItemKind::Program(ProgramName::Number(number))
            }
            Rule::skip => ItemKind::Skip(pair.into_inner().nth(1).and_then(|digits| self.small(&digits))),
            Rule::tape => ItemKind::Tape,
            Rule::end_of_block => ItemKind::EndOfBlock,
            _ => {
                if self.mark.is_none() {
                    self.fault(Code::MarkMissing, span, "in a program this statement needs a `#` before it");
                }
                self.statement(pair)?
            }
        };
        Some(Item { kind, span })
    }

    fn small(&mut self, digits: &Pair<'_, Rule>) -> Option<u8> {
        let number = digits.as_str().parse().ok();
        if number.is_none() {
            self.fault(Code::NumberTooLarge, self.span(digits), "the number has too many digits");
        }
        number
    }

    fn sequence(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let number = pair.into_inner().last().map_or(0, |digits| self.whole(&digits));
        ItemKind::Sequence { number, inserted: false }
    }

    fn word(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let mut parts = pair.into_inner();
        let letter = parts.next().and_then(|letter| letter.as_str().chars().next()).unwrap_or(' ');
        let value = parts.next().map(|first| self.signed(first, parts.next()));
        ItemKind::Word(Word { letter: letter.to_ascii_uppercase(), comma: false, value, equals: false })
    }

    /// `R3+7.5`.
    fn set_by_sign(&mut self, pair: Pair<'_, Rule>) -> ItemKind {
        let whole = self.span(&pair);
        let mut parts = pair.into_inner();
        let target = parts.next().map(|name| self.short_variable(&name));
        let target = target.unwrap_or(VarRef { name: "R".into(), index: Index::None, span: whole });
        let value = match parts.next() {
            Some(sign) => self.signed(sign, parts.next()),
            None => self.hole(whole),
        };
        ItemKind::Assign { target: Box::new(target), value, by_sign: true }
    }

    /// A number, or a sign and what it stands before.
    fn signed(&mut self, first: Pair<'_, Rule>, second: Option<Pair<'_, Rule>>) -> Expr {
        let Some(second) = second else { return self.nc_value(first) };
        let inner = Box::new(self.nc_value(second));
        let span = self.span(&first).to(inner.span);
        let kind = if first.as_str() == "-" { ExprKind::Negate(inner) } else { ExprKind::Plus(inner) };
        Expr { kind, span }
    }

    fn nc_value(&mut self, pair: Pair<'_, Rule>) -> Expr {
        if pair.as_rule() == Rule::number {
            return self.number(&pair);
        }
        let slip = pair.as_rule() == Rule::v_value;
        let whole = self.span(&pair);
        let Some(used) = pair.into_inner().next() else { return self.hole(whole) };
        let variable = self.short_variable(&used);
        let span = variable.span;
        if slip {
            let name = used.as_str();
            let message =
                format!("{name} cannot stand among NC words: copy it to an R variable on a macro line first");
            self.fault(Code::VariableOnNcLine, span, message);
        }
        Expr { kind: ExprKind::Variable(Box::new(variable)), span }
    }

    /// `R5`: a letter and digits.
    fn short_variable(&mut self, pair: &Pair<'_, Rule>) -> VarRef {
        let span = self.span(pair);
        let (name, digits) = pair.as_str().split_at_checked(1).unwrap_or(("R", "0"));
        let number = digits.parse().unwrap_or_else(|_| {
            self.fault(Code::NumberTooLarge, span, "the number has too many digits");
            u32::MAX
        });
        VarRef { name: super::expr::upper(name), index: Index::Number(number), span }
    }

    fn comment(&mut self, pair: Pair<'_, Rule>, span: Span) -> ItemKind {
        let text = pair.as_str();
        let body = text.trim_end_matches([' ', '\t']);
        let inside = |behind: usize| Span::new(span.start + 1, span.end - behind as u32);
        let comment = match pair.into_inner().next().map(|kind| kind.as_rule()) {
            Some(Rule::star_comment) => Comment { text: inside(0), fence: Fence::Star },
            Some(Rule::apostrophe_comment) => Comment { text: inside(0), fence: Fence::Apostrophe },
            _ => {
                let close = closing(text);
                if close == body.len() && close > 0 {
                    Comment { text: inside(text.len() - close + 1), fence: Fence::Closed }
                } else {
                    if close > 0 {
                        let behind = Span::new(span.start + close as u32, span.start + body.len() as u32);
                        let message = "the comment runs to the end of the line: the control does not \
                                       carry this out";
                        self.fault(Code::TextBehindComment, behind, message);
                    }
                    Comment { text: inside(0), fence: Fence::Open }
                }
            }
        };
        ItemKind::Comment(comment)
    }

    fn statement(&mut self, pair: Pair<'_, Rule>) -> Option<ItemKind> {
        let rule = pair.as_rule();
        let mut parts = pair.into_inner();
        let first = parts.next()?;
        Some(match rule {
            Rule::assign => {
                let target = self.variable(first);
                let value = self.value(parts.nth(1)?);
                ItemKind::Assign { target: Box::new(target), value, by_sign: false }
            }
            Rule::if_then => {
                let condition = self.expr(parts.next()?);
                self::condition(&condition, &mut self.errors);
                let body = parts.nth(1)?;
                let span = self.span(&body);
                let body = vec![Item { kind: self.statement(body)?, span }];
                ItemKind::If { condition: Box::new(condition), then: true, bare: false, body }
            }
            Rule::goto => {
                let to = parts.next()?;
                ItemKind::Goto(match to.as_rule() {
                    Rule::sequence => Target::Sequence(self.whole(&to.into_inner().last()?)),
                    _ => Target::Label(label(to.as_str())),
                })
            }
            Rule::print => {
                let serial = first.as_rule() == Rule::sprint_word;
                let (mut list, mut stay) = (Vec::new(), false);
                for part in parts {
                    match part.as_rule() {
                        Rule::text => list.push(PrintPart::Text(within(self.span(&part)))),
                        Rule::expr => list.push(PrintPart::Value(self.value(part))),
                        Rule::last_comma => stay = true,
                        _ => {}
                    }
                }
                ItemKind::Print { serial, parts: list, stay }
            }
            Rule::input => ItemKind::Input {
                serial: first.as_rule() == Rule::sinput_word,
                targets: vec![self.variable(parts.next()?)],
            },
            Rule::clear => {
                let ranges = parts.filter(|part| part.as_rule() == Rule::range);
                ItemKind::Clear(ranges.filter_map(|range| self.range(range)).collect())
            }
            Rule::set => ItemKind::Set(parts.filter_map(|option| self.option(option)).collect()),
            Rule::wait => ItemKind::Wait,
            Rule::start => ItemKind::Start(self.value(parts.next()?)),
            Rule::index => {
                let text = within(self.span(&parts.next()?)).of(self.source);
                ItemKind::Index(String::from_utf8_lossy(text).into_owned())
            }
            _ => return None,
        })
    }

    fn range(&mut self, pair: Pair<'_, Rule>) -> Option<(VarRef, Option<VarRef>)> {
        let mut parts = pair.into_inner();
        let from = self.variable(parts.next()?);
        Some((from, parts.nth(1).map(|to| self.variable(to))))
    }

    fn option(&mut self, pair: Pair<'_, Rule>) -> Option<SetOption> {
        Some(match pair.as_rule() {
            Rule::degrees => SetOption::Degrees,
            Rule::radians => SetOption::Radians,
            Rule::debug => SetOption::Debug,
            Rule::run => SetOption::Run,
            Rule::places => {
                let digits = pair.into_inner().last()?;
                SetOption::Round(self.small(&digits)?)
            }
            _ => return None,
        })
    }

    /// An expression that must be a value.
    fn value(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let expr = self.expr(pair);
        value(&expr, &mut self.errors);
        expr
    }

    fn check_length(&mut self, line: Span) {
        let Some(mark) = self.mark else { return };
        let end = Span::new(mark.start, line.end).of(self.source).trim_ascii_end().len() as u32;
        if end > MACRO_LINE {
            let message = format!("macro line of {end} characters; the control takes {MACRO_LINE}");
            self.fault(Code::MacroLineTooLong, Span::new(mark.start + MACRO_LINE, mark.start + end), message);
        }
    }
}

/// The bytes between the quotes.
fn within(text: Span) -> Span {
    Span::new(text.start + 1, text.end.saturating_sub(1).max(text.start + 1))
}

/// The name of `:LOOP`.
fn label(text: &str) -> Label {
    Label::Name(text.trim_start_matches([':', ' ', '\t']).to_ascii_uppercase())
}

/// Where the comments that `text` begins with, `(A) (B (C))`, are closed: the offset
/// after the last closing bracket; 0 where none is closed.
fn closing(text: &str) -> usize {
    let mut depth = 0usize;
    let mut closed = 0;
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' => depth += 1,
            b')' if depth > 0 => depth -= 1,
            b' ' | b'\t' => continue,
            _ if depth == 0 => break,
            _ => continue,
        }
        if depth == 0 {
            closed = at + 1;
        }
    }
    closed
}
