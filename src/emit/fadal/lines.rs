//! Lines: their numbers, and what becomes of comments.
//!
//! A comment goes to the end of its block, after `(` in a block of words and after an apostrophe on a macro line; a
//! label line takes none (seed 000, section 18; facts/fadal-target.md 1). It goes before its block where it has no room.

use super::Emitter;
use crate::diag::Code;
use crate::emit::common::comments::{spelled, wrap};
use crate::emit::common::digits::write_integer;
use crate::ir::{Comment, SourceInfo};
use crate::text::Span;
use std::collections::VecDeque;

/// What a line holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Words.
    Words,
    /// A macro statement, after `#`.
    Macro,
    /// A label, after `#`.
    Label,
}

/// The line that is being written, and what waits for the next one.
pub(super) struct Page<'p> {
    numbered: bool,
    /// The number of the last block.
    last: u32,
    kind: Kind,
    /// Where the line's own text starts; its number is put before it when it is done.
    start: usize,
    skip: bool,
    /// The next statement is skipped while the switch is on, all lines of it.
    pub skip_next: Option<u8>,
    /// Every line from here on is.
    pub under: Option<u8>,
    waiting: Vec<&'p Comment>,
    site: Option<&'p SourceInfo>,
    /// Comments in a row that were written on blocks of their own.
    row: usize,
    /// Comments that wait for a block with something else in it, each with the pieces that are left of it.
    rest: VecDeque<VecDeque<String>>,
}

impl Page<'_> {
    pub fn new(numbered: bool) -> Self {
        Self {
            numbered,
            last: 0,
            kind: Kind::Words,
            start: 0,
            skip: false,
            skip_next: None,
            under: None,
            waiting: Vec::new(),
            site: None,
            row: 0,
            rest: VecDeque::new(),
        }
    }

    /// True if there are more blocks than numbers.
    pub fn is_full(&self, most: u32) -> bool {
        self.numbered && self.last > most
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

    /// The comments that wait for a line.
    pub(super) fn take_carried(&mut self) -> Vec<&'p Comment> {
        std::mem::take(&mut self.page.waiting)
    }

    /// Writes the comments that wait on blocks of their own.
    pub(super) fn flush_comments(&mut self) {
        for comment in self.take_carried() {
            self.comment(&comment.text);
        }
    }

    /// Starts a line.
    pub(super) fn begin(&mut self, site: &'p SourceInfo, kind: Kind) {
        self.out.span = site.span;
        self.carry(site);
        let skip = self.page.skip_next.or(site.skip).or(self.page.under);
        if skip.is_some_and(|level| level != 1) {
            self.out.unmapped("a block skip of a level");
        }
        (self.page.kind, self.page.skip) = (kind, skip.is_some());
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

    /// Ends the line.
    pub(super) fn finish(&mut self) {
        let text = self.out.text.split_off(self.page.start);
        let (kind, skip) = (self.page.kind, self.page.skip);
        let comments = std::mem::take(&mut self.page.waiting);
        let most = match kind {
            Kind::Words => bound(self.control.text().line),
            Kind::Macro | Kind::Label => bound(self.control.text().macro_line.or(self.control.text().line)),
        };
        // A comment beside words has the room that is left; several are one.
        let told = comments.iter().map(|comment| plain(&comment.text)).filter(|text| !text.is_empty());
        let told = told.collect::<Vec<_>>().join(" ");
        let head =
            if self.page.numbered && !skip { 1 + digits(self.page.last + 1) + 1 } else { usize::from(skip) };
        let length = head + usize::from(kind != Kind::Words) + text.len();
        let beside = kind != Kind::Label && !told.is_empty() && length + 2 + told.len() <= most;
        if !beside && !told.is_empty() {
            self.comment(&told);
        }
        if text.is_empty() && !beside {
            return;
        }
        if length > most {
            let message = format!("the block has {length} characters, and a line takes {most}");
            self.out.refuse(Code::LineTooLong, message);
        }
        let start = self.head(skip);
        if kind != Kind::Words {
            self.out.push('#');
        }
        self.out.text.extend_from_slice(&text);
        if beside {
            if !text.is_empty() {
                self.out.push(' ');
            }
            self.out.push(if kind == Kind::Words { '(' } else { '\'' });
            self.out.push_str(&told);
        }
        self.end_line(start);
        self.end_row();
    }

    /// Characters of a comment on a block of its own.
    pub(super) fn widest_comment(&self) -> usize {
        bound(self.control.text().comment.or(self.control.text().line))
    }

    /// Writes a comment on blocks of its own.
    pub(super) fn comment(&mut self, text: &str) {
        let text = plain(text);
        if text.is_empty() {
            return;
        }
        let pieces = wrap(&text, self.widest_comment());
        self.page.rest.push_back(pieces.into_iter().map(str::to_owned).collect());
        self.write_comments(bound(self.control.text().comments_in_a_row));
    }

    /// Writes the comments that wait, as many as may stand in a row. No block comes between the pieces of one, unless it has more
    /// of them than that.
    fn write_comments(&mut self, most: usize) {
        while let Some(comment) = self.page.rest.front()
            && self.page.row < most
            && (comment.len() <= most - self.page.row || self.page.row == 0)
        {
            let room = most - self.page.row;
            let pieces: Vec<String> = match self.page.rest.front_mut() {
                Some(comment) => comment.drain(..comment.len().min(room)).collect(),
                None => return,
            };
            if self.page.rest.front().is_some_and(VecDeque::is_empty) {
                self.page.rest.pop_front();
            }
            for piece in pieces {
                let start = self.head(false);
                self.out.push('(');
                self.out.push_str(&piece);
                self.end_line(start);
                self.page.row += 1;
            }
        }
    }

    /// At most so many comments stand in a row. A block follows them, and the rest of the comments comes after it.
    fn end_row(&mut self) {
        self.page.row = 0;
        self.write_comments(bound(self.control.text().comments_in_a_row));
    }

    /// Writes the comments that are left after the last block.
    pub(super) fn end_comments(&mut self) {
        self.flush_comments();
        self.write_comments(usize::MAX);
    }

    /// Writes the label of a block on a line of its own.
    pub(super) fn label_line(&mut self, label: &str) {
        self.out.span = Span::default();
        let start = self.head(false);
        self.out.push_str("#:");
        self.out.push_str(label);
        self.end_line(start);
        self.end_row();
    }

    /// Starts a block with its number, or with `/`: a skipped one has none, because the control reads it always if a
    /// number stands before it (facts/fadal-target.md 1).
    fn head(&mut self, skip: bool) -> usize {
        let start = self.out.text.len();
        if skip {
            self.out.push('/');
        } else if self.page.numbered {
            self.page.last += 1;
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

/// A comment in the characters of this control: brackets would be taken for its end by some, so they go.
fn plain(text: &str) -> String {
    spelled(text)
        .replace(['[', ']', '(', ')', '\'', '*'], " ")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

/// How many digits a number has.
fn digits(number: u32) -> usize {
    number.checked_ilog10().unwrap_or(0) as usize + 1
}

/// What a table bounds, or nothing.
fn bound(most: Option<u32>) -> usize {
    most.map_or(usize::MAX, |most| most as usize)
}
