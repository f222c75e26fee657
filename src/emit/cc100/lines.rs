//! Lines: their numbers, and what becomes of comments.
//!
//! A comment has a block of its own (seed 004:1570). The one after `M0` is what the operator reads, so no other one may
//! stand there: it waits for the next block.

use super::Emitter;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Side, to_confirm};
use crate::emit::common::comments::{spelled, wrap};
use crate::emit::common::digits::write_integer;
use crate::ir::{Comment, SourceInfo};
use crate::text::Span;
use std::collections::BTreeSet;

/// Characters of a comment: the longest that the course prints has 63 (seed 004:1570).
const COMMENT: usize = 63;

/// No source says that the control has a switch for it.
pub(super) const SKIP: &str = "a block skip: no source says that it has one. Put a jump on a variable round the block, \
                               and let the operator set the variable";

/// The line that is being written, and what waits for the next one.
#[derive(Default)]
pub(super) struct Page<'p> {
    /// True where blocks have no numbers, because there are more blocks than numbers.
    bare: bool,
    /// The number of the last block.
    pub last: u32,
    /// Where the line's own text starts.
    start: usize,
    waiting: Vec<&'p Comment>,
    site: Option<&'p SourceInfo>,
    /// True right after a stop: a comment here would be its message.
    stopped: bool,
    /// True if a variable is none of those for programs.
    pub crowded: bool,
    /// What is longer than any source shows and has been told.
    told: BTreeSet<&'static str>,
}

impl Page<'_> {
    /// A page whose blocks have numbers, unless it is `bare`.
    pub fn new(bare: bool) -> Self {
        Self { bare, ..Self::default() }
    }
}

impl<'p> Emitter<'p> {
    /// Keeps the comments of a site for the next line, but for those that the line before had, from the same block.
    pub(super) fn carry(&mut self, site: &'p SourceInfo) {
        let last = self.page.site.replace(site);
        if last.is_some_and(|last| std::ptr::eq(last, site)) {
            return;
        }
        let same = last.is_some_and(|last| {
            !site.span.is_empty() && last.span == site.span && last.comments == site.comments
        });
        if !same {
            self.page.waiting.extend(&site.comments);
        }
    }

    /// Takes a comment away from those that wait.
    pub(super) fn hold_back(&mut self, comment: Option<&Comment>) {
        self.page.waiting.retain(|waits| comment.is_none_or(|comment| !std::ptr::eq(*waits, comment)));
    }

    /// The comments that wait for a line.
    pub(super) fn take_carried(&mut self) -> Vec<&'p Comment> {
        std::mem::take(&mut self.page.waiting)
    }

    /// Writes the comments that wait, unless they would be taken for a message.
    pub(super) fn flush_comments(&mut self) {
        if !self.page.stopped {
            self.take_carried().into_iter().for_each(|comment| self.comment(&comment.text));
        }
    }

    /// Starts a line.
    pub(super) fn begin(&mut self, site: &'p SourceInfo) {
        self.out.span = site.span;
        self.carry(site);
        if site.skip.is_some() {
            self.out.unmapped(SKIP);
        }
        self.open();
    }

    /// Starts a line that no block of the source is like.
    pub(super) fn open(&mut self) {
        self.flush_comments();
        self.page.start = self.out.text.len();
    }

    /// Separates a word from what stands before it on the line.
    pub(super) fn word(&mut self, text: &str) {
        self.space();
        self.out.push_str(text);
    }

    /// As [`Self::word`], without the word.
    pub(super) fn space(&mut self) {
        if self.out.text.len() > self.page.start {
            self.out.push(' ');
        }
    }

    /// True if another load would make the line longer than this.
    pub(super) fn is_long(&self, most: usize) -> bool {
        const LOAD: usize = 8;
        self.out.text.len() - self.page.start + LOAD > most
    }

    /// Ends the line, if anything stands on it.
    pub(super) fn finish(&mut self) {
        let text = self.out.text.split_off(self.page.start);
        if text.is_empty() {
            return;
        }
        let start = self.head();
        self.out.text.extend_from_slice(&text);
        let length = self.out.text.len() - start;
        self.beyond("number.digits", digits(&text), "a number");
        self.beyond("block.length", length, "a block");
        self.end_line(start);
    }

    /// Reports what is longer than the control is known to take: once a program where no source says how long it may be.
    fn beyond(&mut self, limit: &'static str, found: usize, what: &str) {
        let Some(row) = self.control.limit_row(limit) else { return };
        let Some(most) = row.max.filter(|most| found > *most as usize) else { return };
        let title = &self.control.dialect().title;
        let (unit, code) = match limit {
            "number.digits" => ("digits", Code::NumberTooLong),
            _ => ("characters", Code::LineTooLong),
        };
        if row.origin.is_settled() {
            let message = format!("{what} of {found} {unit}, and the {title} takes {most}");
            return self.out.refuse(code, message);
        }
        if !self.page.told.insert(limit) {
            return;
        }
        let note = row.origin.note.as_deref().unwrap_or("not stated");
        let fact = format!("limit:{}", row.name);
        let message =
            format!("{what} of {found} {unit}, and no source shows one of more than {most}: {note}");
        let help = to_confirm(&fact, Side::Target);
        let found = Diagnostic::new(Code::UnconfirmedFact, self.out.span, message);
        self.out.emitted.findings.push(found.with_help(help).with_fact(fact.as_str()));
    }

    /// Ends the line of a stop, and writes the message that it shows after it.
    pub(super) fn finish_stop(&mut self, message: &str) {
        self.finish();
        self.page.stopped = message.is_empty();
        self.comment(message);
    }

    /// Writes a comment on blocks of its own.
    pub(super) fn comment(&mut self, text: &str) {
        let text = plain(text);
        if text.is_empty() {
            return;
        }
        for piece in wrap(&text, COMMENT) {
            let start = self.head();
            self.out.push('(');
            self.out.push_str(piece);
            self.out.push(')');
            self.end_line(start);
        }
    }

    /// Writes the label of a block on a line of its own.
    pub(super) fn label_line(&mut self, label: u32) {
        self.out.span = Span::default();
        let start = self.head();
        self.out.push('$');
        self.out.integer(label);
        self.end_line(start);
    }

    /// Starts a block with its number.
    fn head(&mut self) -> usize {
        let start = self.out.text.len();
        self.page.stopped = false;
        self.page.last += 1;
        if !self.page.bare {
            self.out.push(self.out.forms.sequence);
            write_integer(&mut self.out.text, u64::from(self.page.last));
            self.out.push(' ');
        }
        start
    }

    fn end_line(&mut self, start: usize) {
        if !self.out.span.is_empty() {
            self.out.emitted.blocks.push((self.out.span, start..self.out.text.len()));
        }
        self.out.push('\n');
    }
}

/// Digits of the longest number of a block; a zero before the point is none.
fn digits(text: &[u8]) -> usize {
    let numbers = text.split(|byte| !byte.is_ascii_digit() && *byte != b'.');
    let count = |number: &[u8]| {
        let number = number.strip_prefix(b"0.").unwrap_or(number);
        number.iter().filter(|byte| byte.is_ascii_digit()).count()
    };
    numbers.map(count).max().unwrap_or(0)
}

/// A text in capital letters, without brackets.
pub(super) fn plain(text: &str) -> String {
    let text = spelled(text).to_ascii_uppercase().replace(['[', ']', '(', ')'], " ");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
