//! One block: its label, its block skip, its statements in order.

use super::remarks;
use crate::canon::Op;
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::Question;
use crate::ir::{Cond, SourceInfo, StmtKind, TermKind};
use crate::lower::macro_b::build::{Lowering, Motion};
use crate::lower::macro_b::parts::{Piece, Words, acts, site};
use crate::syntax::{Block, Fence, Item, ItemKind, Label, ProgramName, for_each_item};
use crate::text::Span;
use smallvec::SmallVec;

const LONG_NUMBERS: &str = "if its numbers have eight digits, which is an option, write program_digits = \"8\" under [settings] of its profile";

const REMARK: &str = "this comment is not closed on its line, and goes on over the next lines: no control takes that. Write each line of it in \
     round brackets";

const NEVER_RUN: &str = "this block cannot be read, and the machine never gets to it: it is left out";

/// True for a block that nothing can name: beside its comments its text has no number of a block, of a program or of a loop.
fn is_unnamed(text: &[u8]) -> bool {
    let mut in_comment = false;
    !text.iter().enumerate().any(|(at, byte)| {
        in_comment = if in_comment { *byte != b')' } else { *byte == b'(' };
        let after = text[at + 1..].trim_ascii_start().first();
        let numbers = after.is_some_and(|after| after.is_ascii_digit() || matches!(after, b'#' | b'['));
        let stands_before = |word: &[u8]| {
            let before = text.get(..at).unwrap_or_default().trim_ascii_end();
            before.len() >= word.len() && before[before.len() - word.len()..].eq_ignore_ascii_case(word)
        };
        let names = match byte.to_ascii_uppercase() {
            b'N' | b':' => numbers,
            // Not that of GOTO, which names another block.
            b'O' => numbers && !stands_before(b"GOT"),
            b'D' => numbers && stands_before(b"EN"),
            b'%' | b'<' => true,
            _ => false,
        };
        !in_comment && names
    })
}

/// Levels of block skips with their places among the items.
type Placed = SmallVec<[(usize, u8); 2]>;

/// The levels of the block skips before the first item that acts, and those after it with their places.
pub(super) fn levels(items: &[Item], first: usize) -> (SmallVec<[u8; 2]>, Placed) {
    let (mut head, mut middle) = (SmallVec::new(), Placed::new());
    for (index, item) in items.iter().enumerate() {
        let ItemKind::Skip(level) = item.kind else { continue };
        let level = level.unwrap_or(1).clamp(1, 9);
        if index < first { head.push(level) } else { middle.push((index, level)) }
    }
    (head, middle)
}

/// What stands on a block, besides words and comments.
#[derive(Default)]
struct Contents {
    /// The first item that acts.
    first: Option<usize>,
    /// The first sequence number.
    number: Option<usize>,
    inserted: bool,
    skips: bool,
    loops: bool,
}

impl Contents {
    fn of(items: &[Item]) -> Self {
        let mut found = Self::default();
        for (index, item) in items.iter().enumerate() {
            match item.kind {
                ItemKind::Sequence { inserted, .. } => {
                    found.number = found.number.or(Some(index));
                    found.inserted |= inserted;
                }
                ItemKind::Skip(_) => found.skips = true,
                ItemKind::Do { .. } | ItemKind::End { .. } => found.loops = true,
                _ => {}
            }
            if found.first.is_none() && acts(item) {
                found.first = Some(index);
            }
        }
        found
    }
}

impl<'a> Lowering<'a> {
    /// All blocks of the program.
    pub fn body(&mut self, piece: &Piece) {
        let parsed = self.parsed;
        if piece.head.is_none() && piece.name.is_none() {
            for &index in &piece.leading {
                if let Some(block) = parsed.blocks.get(index).filter(|_| piece.body.is_empty()) {
                    self.builder.push(StmtKind::Comment, site(block, self.source));
                }
            }
        }
        let first = parsed.blocks.get(piece.body.start).map_or(0, |block| block.span.start);
        let mut line = parsed.lines.partition_point(|line| line.end.end <= first);
        for at in piece.body.clone() {
            let Some(block) = parsed.blocks.get(at) else { break };
            while let Some(before) = parsed.lines.get(line).filter(|l| l.end.end <= block.span.start) {
                // A line with nothing on it has no block; the reader of the program sees it all the same.
                if before.text.is_empty() && before.text.start >= first {
                    self.builder
                        .push(StmtKind::Comment, SourceInfo { span: before.text, ..SourceInfo::default() });
                }
                line += 1;
            }
            self.at = at;
            self.in_data &= !self.ends_data(block);
            if self.in_data {
                self.builder.push(StmtKind::Comment, site(block, self.source));
                continue;
            }
            let is_dead = self.is_over && is_unnamed(block.span.of(self.source));
            let refused = block.errors.iter().any(|error| error.code.severity() == Severity::Error);
            if is_dead && refused {
                self.findings.add(Diagnostic::new(Code::NeverRun, block.span, NEVER_RUN));
                self.builder.push(StmtKind::Comment, SourceInfo::default());
            } else {
                self.block(block, piece.head == Some(at));
            }
            self.is_over = !self.builder.is_open() || is_dead;
        }
        self.close_loops();
        self.close_hub();
        self.nowhere.close(&mut self.builder);
    }

    fn block(&mut self, block: &'a Block, is_head: bool) {
        self.tell_errors(block);
        if let Some((number, id)) = self.labels.of_block(self.at) {
            self.builder.start(id);
            self.builder.label(Label::Number(number));
            self.motion.join();
        }
        let mut site = site(block, self.source);
        if block.span.of(self.source).trim_ascii().is_empty() {
            // Spaces alone say as little as a line with nothing on it.
            site.span = Span::default();
        }
        if is_head {
            // They are the program's.
            site.comments.clear();
            self.long_number(block);
        }
        for_each_item(&block.items, &mut |item| {
            if matches!(&item.kind, ItemKind::Comment(comment) if comment.fence == Fence::Within) {
                self.rest_on_statement("comment.in.brackets", item.span);
            }
        });
        let contents = Contents::of(&block.items);
        if contents.inserted {
            self.findings.not_understood(block.span, "'N+' is not a sequence number here");
        }
        let refused = block.errors.iter().any(|error| error.code.severity() == Severity::Error);
        if refused && !contents.loops {
            return self.builder.push(StmtKind::Comment, site);
        }
        let Some(first) = contents.first else {
            if !is_head || site.sequence.is_some() {
                self.builder.push(StmtKind::Comment, site);
            }
            return;
        };
        if contents.number.is_some_and(|at| at > first)
            && !self.findings.is(Question::SequenceAnywhere, site.span)
        {
            self.findings.not_understood(site.span, "the sequence number must stand first in its block");
        }
        if contents.skips { self.skipping(block, first, site) } else { self.items(&block.items, &site) }
    }

    /// Tells what cannot be read of a block; of a comment that goes on over lines once.
    fn tell_errors(&mut self, block: &'a Block) {
        if self.at < self.remark_end && !block.errors.is_empty() {
            return;
        }
        let rest = self.parsed.blocks.get(self.at..).unwrap_or_default();
        let end = remarks::begins(block).then(|| remarks::ends_at(rest, self.source)).flatten();
        self.remark_end = self.remark_end.max(end.map_or(0, |more| self.at + more + 1));
        for error in &block.errors {
            let message = match end {
                Some(_) if error.code == Code::UnclosedComment => REMARK.into(),
                _ => error.message.clone(),
            };
            self.findings.add(Diagnostic::new(error.code, error.span, message));
        }
    }

    /// A program number of more digits than this machine's have: its calls are read otherwise where these have as many.
    fn long_number(&mut self, block: &Block) {
        let number = |item: &Item| match item.kind {
            ItemKind::Program(ProgramName::Number(number)) => Some((number, item.span)),
            _ => None,
        };
        let most = self.control.text().program_max;
        let is_long = |(number, _): &(u32, Span)| *number > most;
        let splits = self.control.statement("call.repeat.digits").is_some();
        if let Some((number, span)) = block.items.iter().find_map(number).filter(is_long).filter(|_| splits) {
            let what =
                format!("O{number}: program numbers of this machine have four digits, and this one has more");
            let told = Diagnostic::new(Code::Conditional, span, what).with_help(LONG_NUMBERS);
            self.findings.add(told.asked_once());
        }
    }

    /// A block with a block skip.
    fn skipping(&mut self, block: &'a Block, first: usize, mut site: SourceInfo) {
        let items = block.items.as_slice();
        for item in items {
            let ItemKind::Skip(level) = item.kind else { continue };
            let level = level.unwrap_or(1);
            if !(1..=9).contains(&level) {
                self.findings.not_understood(item.span, "the level of a block skip is 1 to 9");
            }
            if level > 1 && !self.findings.is(Question::SkipLevels, item.span) {
                self.unknown_behaviour(Question::SkipLevels, item.span);
            }
        }
        let (head, middle) = levels(items, first);
        site.skip = None;
        if let ([level], []) = (head.as_slice(), middle.as_slice())
            && self.skipped_loop(block, *level, &site)
        {
            return;
        }
        let loops = items.iter().any(|i| matches!(i.kind, ItemKind::Do { .. } | ItemKind::End { .. }));
        if loops || head.len() > 1 || middle.len() > 1 || (!head.is_empty() && !middle.is_empty()) {
            self.unclear_skip(block, loops);
            return self.builder.push(StmtKind::Comment, site);
        }
        if let Some(&(index, level)) = middle.first() {
            let place = items.get(index).map_or(block.span, |item| item.span);
            if !self.findings.is(Question::SkipMidblock, place) {
                self.unknown_behaviour(Question::SkipMidblock, place);
            }
            // Values and switch are read when the block begins: one block with all words, one without
            // those after the sign.
            let before = items.get(..index).unwrap_or_default();
            return self.on_switch(level, &site, Some(before), items);
        }
        let Some(&level) = head.first() else { return };
        if self.leaves(items) {
            self.on_switch(level, &site, None, items);
        } else {
            site.skip = Some(level);
            self.items(items, &site);
        }
    }

    /// Some items where the switch is on (none: straight on), others where it is off.
    fn on_switch(&mut self, level: u8, site: &SourceInfo, on: Option<&'a [Item]>, off: &'a [Item]) {
        let (otherwise, next) = (self.builder.fresh(), self.builder.fresh());
        let then = if on.is_some() { self.builder.fresh() } else { next };
        self.builder
            .end(TermKind::Branch { cond: Box::new(Cond::Switch(level)), then, otherwise }, site.clone());
        let before = self.motion;
        let mut ways = [(otherwise, Some(off)), (then, on)];
        // The control comes to a `/GOTO` while the switch is off, so that the shorter text has the other
        // way first, unless this one goes elsewhere at its end.
        if !self.goes_elsewhere(off) {
            ways.reverse();
        }
        let mut left: Option<Motion> = None;
        for (start, items) in ways {
            self.motion = before;
            if let Some(items) = items {
                self.builder.start(start);
                self.items(items, site);
                if self.builder.is_open() {
                    self.builder.end(TermKind::Jump(next), SourceInfo::default());
                }
            }
            if let Some(other) = left.replace(self.motion) {
                self.motion.meet(other);
            }
        }
        self.builder.start(next);
    }

    /// True where the last of the items is a jump, a return or the end.
    fn goes_elsewhere(&mut self, items: &[Item]) -> bool {
        match items.iter().rev().find(|item| acts(item)).map(|item| &item.kind) {
            Some(ItemKind::Goto(_)) => true,
            Some(ItemKind::Word(word)) => {
                let row = self.flow_code(word).and_then(|id| self.codes.get(id)?.row);
                row.is_some_and(|row| matches!(row.op, Op::Return | Op::End | Op::EndRewind))
            }
            _ => false,
        }
    }

    /// True where the items do more than statements can that lie in one basic block.
    fn leaves(&mut self, items: &[Item]) -> bool {
        items.iter().any(|item| match &item.kind {
            ItemKind::Goto(_) | ItemKind::If { .. } => true,
            ItemKind::Word(word) => self.flow_code(word).is_some(),
            _ => false,
        })
    }

    /// The items of a block, or those after a THEN, in order.
    pub fn items(&mut self, items: &'a [Item], site: &SourceInfo) {
        let mut words = Words::new();
        let (mut groups, mut assigns) = (0u32, 0u32);
        let waits = self.control.is(Question::GotoActsLast);
        let mut jump = None;
        for (index, item) in items.iter().enumerate() {
            if !acts(item) {
                continue;
            }
            if waits && matches!(item.kind, ItemKind::Goto(_)) {
                jump = jump.or(Some(item));
                continue;
            }
            if let ItemKind::Word(word) = &item.kind {
                groups += u32::from(words.is_empty());
                words.push((word, item.span));
                continue;
            }
            if !words.is_empty() {
                self.words(&std::mem::take(&mut words), site);
            }
            groups += 1;
            assigns += u32::from(matches!(item.kind, ItemKind::Assign { .. }));
            self.statement(item, items.get(index + 1..).unwrap_or_default(), site);
        }
        if !words.is_empty() {
            self.words(&words, site);
        }
        if let Some(jump) = jump {
            groups += 1;
            self.statement(jump, &[], site);
        }
        if groups > 1 {
            let question =
                if groups == assigns { Question::AssignSharesBlock } else { Question::StatementSharesBlock };
            match self.findings.behaviour(question, site.span) {
                Some("true") => {}
                Some(_) if self.control.behaviour(question).is_some_and(|row| row.origin.is_settled()) => {
                    let message = "the control takes one statement in a block, and none beside words";
                    self.findings.not_understood(site.span, message);
                }
                // Real programs do it; that it is so is said already.
                Some(_) => {}
                None => self.unknown_behaviour(question, site.span),
            }
        }
    }
}
