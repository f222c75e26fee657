//! A program without what no machine sees: spacing, the numbers of blocks, the spelling of numbers, comments.
//!
//! A block is told by two texts. One is for people ([`Normal::text`]). The other ([`Normal::known`]) is for the claim that
//! nothing changed for the control, and keeps more where it might: the comments that stops and alarms may show, and the
//! sequence numbers that anything may name.

use super::labels::{Labels, code_of, words};
use crate::canon::{Op, Sys};
use crate::dialect::Control;
use crate::syntax::{
    Block, Expr, ExprKind, Index, Item, ItemKind, TableRow, Target, TestSubject, TokenKind, VarRef,
    for_each_expr, for_each_item,
};
use crate::text::{Span, decode};
use crate::verify::name_of;
use std::collections::BTreeSet;

/// A block.
#[derive(Clone, Debug)]
pub struct Normal {
    /// Its line.
    pub line: usize,
    /// As people read it.
    pub text: String,
    /// As the control reads it.
    pub known: String,
    /// The first text with a mark for each variable.
    pub bare: String,
    /// The second text with a mark for each variable.
    pub shape: String,
    /// True where the number of a variable is computed.
    pub computes: bool,
    /// The variables of the block, in their order.
    pub variables: Vec<String>,
    /// True where it may go on elsewhere than in the next block.
    pub jumps: bool,
    /// True where it calls.
    pub calls: bool,
    /// True where nothing but the machine says which program it calls.
    pub open: bool,
}

/// The numbers of blocks that anything in a library may name, besides the jumps of their own programs.
#[derive(Clone, Debug, Default)]
pub struct Named {
    numbers: BTreeSet<u32>,
    /// True where some are computed.
    any: bool,
}

impl Named {
    /// Takes in the numbers that P and Q words of a text have. A text that may read the last sequence number names all.
    pub fn read(&mut self, blocks: &[Block], control: &Control) {
        for block in blocks {
            self.any |= computes(block) || reads_address(block, control);
            for_each_item(&block.items, &mut |item| match &item.kind {
                ItemKind::Word(word) if matches!(word.letter, 'P' | 'Q') => {
                    let value = word.value.as_ref();
                    self.numbers.extend(value.and_then(whole));
                    self.any |= value.is_some_and(|value| !is_literal(value));
                }
                ItemKind::Goto(Target::Computed(_))
                | ItemKind::Branch { target: Target::Computed(_), .. }
                | ItemKind::Unparsed => self.any = true,
                _ => {}
            });
        }
    }

    /// The same of both sides of a diff.
    pub fn join(mut self, other: Self) -> Self {
        self.numbers.extend(other.numbers);
        Self { any: self.any || other.any, ..self }
    }

    fn has(&self, number: u32) -> bool {
        self.any || self.numbers.contains(&number)
    }
}

/// The digits that any control reads of a number.
const SURE_DIGITS: usize = 8;

/// The blocks of a program; those that say nothing are left out.
pub fn normal(
    blocks: &[Block],
    source: &[u8],
    control: &Control,
    named: &Named,
    line_of: impl Fn(u32) -> usize,
) -> Vec<Normal> {
    let labels = Labels::of(blocks, control);
    let mut out: Vec<Normal> = Vec::new();
    let mut shows = false;
    for block in blocks {
        let shown_before = std::mem::replace(&mut shows, shows_comment(block, control));
        let mut normal = Normal {
            line: line_of(block.span.start),
            text: String::new(),
            known: String::new(),
            bare: String::new(),
            shape: String::new(),
            computes: computes(block),
            variables: Vec::new(),
            jumps: jumps(block),
            calls: false,
            open: false,
        };
        (normal.calls, normal.open) = calls(block, control);
        spell(&mut normal, block, source, (&labels, named, control));
        let is_comment = block.items.iter().all(|item| {
            matches!(item.kind, ItemKind::Comment(_) | ItemKind::Sequence { .. } | ItemKind::EndOfBlock)
        });
        if shows || (shown_before && is_comment) {
            for token in block.tokens.iter().filter(|token| token.kind == TokenKind::Comment) {
                let comment = decode(token.span.of(source));
                [&mut normal.known, &mut normal.shape].into_iter().for_each(|text| *text += &comment);
            }
        }
        if !normal.text.is_empty() || !normal.known.is_empty() {
            out.push(normal);
        }
    }
    out
}

/// Writes the block's texts.
fn spell(
    out: &mut Normal,
    block: &Block,
    source: &[u8],
    (labels, named, control): (&Labels, &Named, &Control),
) {
    let variables = variables(&block.items, control);
    let mut head = block.items.iter().filter_map(|item| match item.kind {
        ItemKind::Sequence { number, inserted: false } => Some((number, item.span)),
        _ => None,
    });
    let sequence = head.next();
    if let Some((number, _)) = sequence {
        if let Some(name) = labels.names.get(&number) {
            out.text = format!("@{name} ");
        }
        out.known = out.text.clone();
        if named.has(number) {
            out.known += &format!("={number} ");
        }
        out.bare = out.text.clone();
        out.shape = out.known.clone();
    }
    let unread = block.items.iter().any(|item| matches!(item.kind, ItemKind::Unparsed));
    let (mut last, mut done) = (TokenKind::Space, Span::default());
    let (mut letter, mut was_word) = (String::new(), false);
    for token in &block.tokens {
        let within = |span: Span| span.start <= token.span.start && token.span.end <= span.end;
        let aside = matches!(token.kind, TokenKind::Space | TokenKind::Comment | TokenKind::EndOfBlock);
        if (aside && !unread) || sequence.is_some_and(|(_, span)| within(span)) {
            continue;
        }
        let raw = decode(token.span.of(source));
        // A variable may be several tokens.
        let same_variable = done != Span::default() && within(done);
        if unread {
            let all = [&mut out.text, &mut out.known, &mut out.bare, &mut out.shape];
            all.into_iter().for_each(|text| *text += &raw);
            continue;
        }
        let is_name = |kind: TokenKind| matches!(kind, TokenKind::Number | TokenKind::Variable);
        let is_word = token.kind == TokenKind::Operator && raw.starts_with(char::is_alphabetic);
        let gap = matches!(token.kind, TokenKind::Letter | TokenKind::Keyword) && last != TokenKind::Space
            || last == TokenKind::Keyword
            || is_word
            || was_word
            || (token.kind == TokenKind::Variable && is_name(last) && !same_variable);
        was_word = is_word;
        let mut plain = match token.kind {
            TokenKind::Number => number(&raw),
            TokenKind::Text => raw.to_string(),
            _ => raw.to_uppercase(),
        };
        let mut known = match token.kind {
            // Many digits may be too many, and those of a call may be a number and a count.
            TokenKind::Number if letter == "P" || raw.len() > SURE_DIGITS => raw.to_string(),
            TokenKind::Text | TokenKind::Other | TokenKind::Mark => raw.to_string(),
            _ => plain.clone(),
        };
        if let Some(name) = labels.places.iter().find(|(span, _)| within(*span)).map(|(_, name)| *name)
            && token.kind == TokenKind::Number
        {
            plain = format!("@{name}");
            known = plain.clone();
        }
        if token.kind == TokenKind::Letter {
            letter = plain.clone();
        }
        let before = if gap { " " } else { "" };
        out.text += &format!("{before}{plain}");
        // Blanks and comments may part what would be one thing without them.
        out.known += &format!("{known} ");
        match variables.iter().find(|(span, _)| within(*span)) {
            Some((span, _)) if *span == done => {}
            Some((span, name)) => {
                done = *span;
                out.bare += &format!("{before}?");
                out.shape += "? ";
                out.variables.push(name.clone());
            }
            None => {
                out.bare += &format!("{before}{plain}");
                out.shape += &format!("{known} ");
            }
        }
        last = token.kind;
    }
    for text in [&mut out.text, &mut out.known, &mut out.bare] {
        *text = text.trim().to_owned();
    }
}

/// A number without zeros that say nothing; its point stays, for it may say what the number counts.
fn number(raw: &str) -> String {
    let (whole, fraction) = raw.split_once('.').map_or((raw, None), |(whole, rest)| (whole, Some(rest)));
    let trimmed = whole.trim_start_matches('0');
    let whole = if trimmed.is_empty() { "0" } else { trimmed };
    match fraction {
        Some(fraction) => format!("{whole}.{}", fraction.trim_end_matches('0')),
        None => whole.to_owned(),
    }
}

/// True where the block calls, and where nothing but the machine says what.
fn calls(block: &Block, control: &Control) -> (bool, bool) {
    let words = words(block);
    let by_alias = words.iter().any(|(letter, number)| {
        matches!(letter, 'G' | 'M' | 'T' | 'S' | 'B')
            && number.is_none_or(|number| control.alias(*letter, number).is_some())
    });
    let start = block.items.iter().any(|item| matches!(item.kind, ItemKind::Start(_)));
    let code = code_of(block, control).filter(|row| !matches!(row.op, Op::Return | Op::SubEnd));
    let literal = words.iter().any(|(letter, number)| *letter == 'P' && number.is_some());
    (code.is_some() || by_alias || start, by_alias || start || (code.is_some() && !literal))
}

/// True where the block reads the last value of an address, which may be the sequence number.
fn reads_address(block: &Block, control: &Control) -> bool {
    let mut found = false;
    for_each_expr(&block.items, &mut |e| {
        if let ExprKind::Variable(variable) = &e.kind
            && let Index::Number(number) = variable.index
        {
            let state = control.read_system(&variable.name, Some(number)).map(|(state, ..)| state);
            found |= matches!(state, Some(Sys::Address | Sys::AddressNow));
        }
    });
    found
}

/// True where the number of a variable is computed.
fn computes(block: &Block) -> bool {
    let mut found = false;
    let computed = |variable: &VarRef| matches!(variable.index, Index::Computed(_));
    for_each_item(&block.items, &mut |item| match &item.kind {
        ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } | ItemKind::Timer(target) => {
            found |= computed(target);
        }
        ItemKind::Clear(ranges) => found |= ranges.iter().any(|(_, to)| to.is_some()),
        ItemKind::Transfer { .. }
        | ItemKind::Input { .. }
        | ItemKind::Test(_)
        | ItemKind::SetNames { .. } => {
            found = true;
        }
        _ => {}
    });
    for_each_expr(&block.items, &mut |e| {
        found |= matches!(&e.kind, ExprKind::Variable(variable) if computed(variable));
    });
    found
}

fn jumps(block: &Block) -> bool {
    let mut found = false;
    for_each_item(&block.items, &mut |item| {
        use ItemKind::{Branch, Do, End, Goto, If};
        found |= matches!(item.kind, If { .. } | Do { .. } | End { .. } | Goto(_) | Branch { .. });
    });
    found
}

/// True where a comment in the block, or alone after it, may be shown to the operator.
fn shows_comment(block: &Block, control: &Control) -> bool {
    let mut found = false;
    for_each_item(&block.items, &mut |item| match &item.kind {
        ItemKind::Assign { .. } => found = true,
        ItemKind::Word(word) => {
            let number = word.value.as_ref().and_then(|value| match &value.kind {
                ExprKind::Number(number) => Some(number.value),
                _ => None,
            });
            found |= match (word.letter, number) {
                ('M', _) | ('G', None) => true,
                ('G', Some(number)) => control.code('G', number, &[]).is_none(),
                _ => false,
            };
        }
        _ => {}
    });
    found
}

fn is_literal(value: &Expr) -> bool {
    match &value.kind {
        ExprKind::Number(_) => true,
        ExprKind::Negate(inner) | ExprKind::Plus(inner) => is_literal(inner),
        _ => false,
    }
}

/// A whole number that is written.
pub fn whole(value: &Expr) -> Option<u32> {
    match &value.kind {
        // A float outside the range becomes its nearest end.
        ExprKind::Number(number) if number.value.fract() == 0.0 => Some(number.value as u32),
        _ => None,
    }
}

/// The variables of a block whose numbers are written, with their places.
pub fn variables(items: &[Item], control: &Control) -> Vec<(Span, String)> {
    let mut out = Vec::new();
    let mut take = |variable: &VarRef| {
        let is_numbered = matches!(variable.index, Index::Number(_) | Index::Letter(_));
        out.extend(name_of(variable, control).filter(|_| is_numbered).map(|name| (variable.span, name)));
    };
    for_each_item(items, &mut |item| match &item.kind {
        ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } | ItemKind::Timer(target) => {
            take(target)
        }
        ItemKind::Test(TestSubject::Variable(variable)) => take(variable),
        ItemKind::Transfer { table, cells } => {
            if let TableRow::Variable(variable) = &table.row {
                take(variable);
            }
            cells.iter().for_each(|cell| take(&cell.variable));
        }
        ItemKind::Input { targets, .. } => targets.iter().for_each(&mut take),
        ItemKind::Clear(ranges) => ranges.iter().for_each(|(from, to)| {
            take(from);
            to.iter().for_each(&mut take);
        }),
        _ => {}
    });
    for_each_expr(items, &mut |e| {
        if let ExprKind::Variable(variable) = &e.kind {
            take(variable);
        }
    });
    out.sort_by_key(|(span, _)| (span.start, span.end));
    out.dedup();
    out
}
