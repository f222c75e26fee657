//! Lines: what stands before and after the words of a block.

use super::comments::{spelled, wrap, write_comment, write_spelled};
use super::digits::write_padded;
use super::labels::Standing;
use super::sheet::Sheet;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Comment, Cond, SourceInfo};
use crate::text::Span;

/// What a line holds, as far as its comments and its length go.
#[derive(Clone, Copy, Default, PartialEq)]
pub(in crate::emit) enum Kind {
    /// Words.
    #[default]
    Words,
    /// A macro statement.
    Macro,
    /// A macro statement whose own text in brackets is a message, or that must stand
    /// alone: comments go before it, but for one that only repeats the message.
    Alone,
}

/// The line that is being written, and what waits for the next one.
#[derive(Default)]
pub(in crate::emit) struct Line<'p> {
    start: usize,
    head_end: usize,
    body: usize,
    kind: Kind,
    comments: Vec<&'p Comment>,
    /// The block that is being written.
    pub block: usize,
    /// The label that the next line must have.
    pub label: Option<u32>,
    /// What people called that label.
    pub name: Option<&'p str>,
    /// The skip level of the next line.
    pub skip: Option<u8>,
    /// That of every line from here on.
    pub under: Option<u8>,
    /// The condition of the next line, which stands after its THEN.
    pub condition: Option<&'p Cond>,
    /// The label that was written last on a line of its own.
    flushed: Option<u32>,
    sequence: Option<u32>,
    waiting: Vec<&'p Comment>,
    /// Lines without anything that stand before the next one.
    blanks: u8,
    last: Option<&'p SourceInfo>,
}

impl<'p> Sheet<'p> {
    /// Keeps the sequence number and the comments of a site for the next line, but for
    /// those that the line before had already, coming from the same block.
    pub fn carry(&mut self, site: &'p SourceInfo) {
        if self.line.last.is_some_and(|last| std::ptr::eq(last, site)) {
            return;
        }
        let last = self.line.last.filter(|last| !site.span.is_empty() && last.span == site.span);
        if last.is_none_or(|last| last.sequence.is_none()) && self.line.sequence.is_none() {
            self.line.sequence = site.sequence.get();
        }
        if last.is_none() {
            self.line.blanks = self.line.blanks.max(site.blanks);
        }
        if last.is_none_or(|last| last.comments != site.comments) {
            self.line.waiting.extend(&site.comments);
        }
        self.line.last = Some(site);
    }

    /// True where a label, comments or a sequence number wait for a line.
    pub fn is_waiting(&self) -> bool {
        self.line.label.is_some() || self.has_carried()
    }

    /// True where comments or a sequence number wait for a line.
    pub fn has_carried(&self) -> bool {
        self.line.sequence.is_some() || !self.line.waiting.is_empty()
    }

    /// True where the line before came from the same bytes.
    pub fn is_last_span(&self, span: Span) -> bool {
        !span.is_empty() && self.line.last.is_some_and(|last| last.span == span)
    }

    /// Starts a line; `message` is the text that its statement shows, if it shows any.
    pub fn begin(&mut self, site: &'p SourceInfo, kind: Kind, message: Option<&str>) {
        self.span = site.span;
        self.carry(site);
        self.blank_lines();
        let skip = self.line.skip.take().or(site.skip).or(self.line.under);
        if skip.is_some() && self.line.label.is_some() {
            // A skipped line need not be found by a jump.
            self.flush_label();
        }
        if message.is_some() && self.line.name.is_some() {
            // A control may show the first text of the block.
            self.flush_label();
            self.span = site.span;
        }
        self.line.kind = kind;
        self.line.comments = std::mem::take(&mut self.line.waiting);
        if kind == Kind::Alone {
            for comment in std::mem::take(&mut self.line.comments) {
                if message.is_none_or(|text| text.trim() != comment.text.trim()) {
                    self.comment_lines(&comment.text);
                }
            }
        }
        self.line.start = self.text.len();
        if let Some(level) = skip {
            self.skip(level);
        }
        let unprinted = self.head();
        self.line.head_end = self.text.len();
        if let Some(number) = unprinted.filter(|_| message.is_none()) {
            self.space();
            write_comment(&mut self.text, &format!("{}{number}", self.forms.sequence));
        }
        for at in 0..self.line.comments.len() {
            if let Some(&comment) = self.line.comments.get(at).filter(|comment| comment.leading) {
                self.space();
                write_comment(&mut self.text, &comment.text);
            }
        }
        self.line.body = self.text.len();
    }

    /// Writes the lines without anything that stood before the block, where a control's programs have such lines.
    fn blank_lines(&mut self) {
        let blanks = std::mem::take(&mut self.line.blanks);
        if self.control.text().blank_lines {
            (0..blanks).for_each(|_| self.push('\n'));
        }
    }

    /// Writes the sequence number. A number that the line cannot have is handed back, to be
    /// kept as a comment.
    fn head(&mut self) -> Option<u32> {
        let flushed = self.line.flushed.take();
        let sequence = self.line.sequence.take().filter(|number| Some(*number) != flushed);
        let standing = sequence.map(|n| (n, self.labels.standing(n, self.line.block)));
        if let Some(label) = self.line.label.take() {
            self.space();
            self.push(self.forms.sequence);
            self.integer(label);
            if let Some(name) = self.line.name.take() {
                self.space();
                write_comment(&mut self.text, name);
            }
            return standing.filter(|(n, s)| *n != label && *s != Standing::Label).map(|(n, _)| n);
        }
        match standing? {
            (number, Standing::Free) => {
                self.space();
                self.push(self.forms.sequence);
                self.integer(number);
                None
            }
            (_, Standing::Label) => None,
            (number, Standing::Barred) => Some(number),
        }
    }

    fn skip(&mut self, level: u8) {
        self.push('/');
        if level != 1 {
            if !self.control.is(Question::SkipLevels) {
                self.unmapped(format_args!("block skip {level}"));
            }
            self.integer(u32::from(level));
        }
    }

    /// Separates a word from what stands before it on the line.
    pub fn space(&mut self) {
        if self.text.len() > self.line.start && self.text.last() != Some(&b'/') {
            self.text.push(b' ');
        }
    }

    /// Adds a word of its own.
    pub fn word(&mut self, text: &str) {
        self.space();
        self.push_str(text);
    }

    /// Writes `O0001 (COMMENT)`: the name is the first on its line, so comments that find no room there
    /// follow on lines of their own. A sequence number beside it is left out: nothing goes there by it.
    pub fn program_line(&mut self, site: &'p SourceInfo, number: u32) {
        self.carry(site);
        self.line.sequence = None;
        self.span = site.span;
        self.line.start = self.text.len();
        self.push(self.forms.program);
        write_padded(&mut self.text, u64::from(number), self.forms.program_digits);
        let mut comments = std::mem::take(&mut self.line.waiting).into_iter().peekable();
        let limit = self.control.text().line.map_or(usize::MAX, |limit| limit as usize);
        while let Some(comment) = comments.peek() {
            let before = self.text.len();
            self.space();
            write_comment(&mut self.text, &comment.text);
            if self.text.len() - self.line.start > limit {
                self.text.truncate(before);
                break;
            }
            comments.next();
        }
        self.end_line();
        comments.for_each(|comment| self.comment_lines(&comment.text));
    }

    /// Ends the line.
    pub fn finish(&mut self) {
        let end = self.text.len();
        for at in 0..self.line.comments.len() {
            if let Some(&comment) = self.line.comments.get(at).filter(|comment| !comment.leading) {
                self.space();
                write_comment(&mut self.text, &comment.text);
            }
        }
        let text = self.control.text();
        let limit = if self.line.kind == Kind::Words { text.line } else { text.macro_line.or(text.line) };
        if let Some(limit) = limit
            && self.text.len() - self.line.start > limit as usize
        {
            self.shorten(end, limit as usize);
        }
        self.end_line();
    }

    fn end_line(&mut self) {
        if !self.span.is_empty() {
            self.emitted.blocks.push((self.span, self.line.start..self.text.len()));
        }
        self.push('\n');
    }

    /// Puts the comments of a line that is too long on lines before it.
    fn shorten(&mut self, end: usize, limit: usize) {
        let line = self.text.split_off(self.line.start);
        let at = |place: usize| place - self.line.start;
        let head = line.get(..at(self.line.head_end)).unwrap_or_default();
        let body = line.get(at(self.line.body)..at(end)).unwrap_or_default().trim_ascii_start();
        for comment in std::mem::take(&mut self.line.comments) {
            self.comment_lines(&comment.text);
        }
        self.line.start = self.text.len();
        self.text.extend_from_slice(head);
        if !body.is_empty() {
            self.space();
            self.text.extend_from_slice(body);
        }
        if self.line.kind == Kind::Words && self.text.len() - self.line.start > limit {
            let tight = tight(self.text.get(self.line.start..).unwrap_or_default());
            self.text.truncate(self.line.start);
            self.text.extend_from_slice(&tight);
        }
        let length = self.text.len() - self.line.start;
        if length > limit {
            let what = format!("the block has {length} characters, and a line takes {limit}");
            let told = Diagnostic::new(Code::LineTooLong, self.span, what);
            let text = self.control.text();
            let is_open = text.line == Some(limit as u32) && !text.origin.is_confirmed();
            let help = format!(
                "no maker's page says how long a line may be: if the machine takes longer ones, write \"line.length\" = {length} under \
                 [limits] in its profile"
            );
            self.faults.push(if is_open { told.with_help(help) } else { told });
        }
    }

    /// Writes a comment on lines of its own.
    pub fn comment_lines(&mut self, text: &str) {
        let room = self.control.text().line.map_or(usize::MAX, |most| most.saturating_sub(2) as usize);
        for piece in wrap(&spelled(text), room) {
            let start = self.text.len();
            write_spelled(&mut self.text, piece);
            if !self.span.is_empty() {
                self.emitted.blocks.push((self.span, start..self.text.len()));
            }
            self.push('\n');
        }
    }

    /// Writes the waiting label on a line of its own, if there is one.
    pub fn flush_label(&mut self) {
        if let Some(label) = self.line.label.take() {
            let name = self.line.name.take();
            self.blank_lines();
            self.label_line(label, name);
        }
    }

    /// Writes a line with nothing but a sequence number.
    pub fn label_line(&mut self, label: u32, name: Option<&str>) {
        self.span = Span::default();
        self.line.flushed = Some(label);
        self.line.start = self.text.len();
        self.push(self.forms.sequence);
        self.integer(label);
        if let Some(name) = name {
            self.space();
            write_comment(&mut self.text, name);
        }
        self.push('\n');
    }
}

/// The words of a line without the blanks that stand between a value and the letter of the next word. E stays apart: it
/// may be read as an exponent.
fn tight(line: &[u8]) -> Vec<u8> {
    let (mut out, mut depth) = (Vec::with_capacity(line.len()), 0_u32);
    for (at, sign) in line.iter().enumerate() {
        match sign {
            b'(' | b'[' => depth += 1,
            b')' | b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let before = out.last().is_some_and(|sign: &u8| sign.is_ascii_digit() || matches!(sign, b'.' | b']'));
        let after = line.get(at + 1).is_some_and(|sign| sign.is_ascii_uppercase() && *sign != b'E');
        let value = line.get(at + 2).is_some_and(|sign| !sign.is_ascii_alphabetic());
        if depth > 0 || *sign != b' ' || !(before && after && value) {
            out.push(*sign);
        }
    }
    out
}
