//! One program while it is lowered.

use crate::canon::{Op, Role};
use crate::dialect::{CodePlace, Control, Question};
use crate::ir::{BlockId, Builder, SourceInfo, Var};
use crate::lower::common::{Findings, Nowhere};
use crate::lower::macro_b::codes::{CodeId, Codes};
use crate::lower::macro_b::parts::{Labels, Piece};
use crate::syntax::{ParsedFile, ProgramName, Word};
use crate::text::Span;
use std::collections::BTreeMap;

/// The roles that letters had under a motion code, where nothing was to be said of them.
#[derive(Debug, Default)]
pub struct RolesUnder {
    pub under: Motion,
    pub roles: [Option<Role>; 26],
}

impl RolesUnder {
    /// That of a word; none if it was not noted.
    pub fn role(&self, word: &Word) -> Option<Role> {
        let at = (word.letter as usize).wrapping_sub('A' as usize);
        self.roles.get(at).copied().flatten().filter(|_| !word.comma && !word.equals)
    }
}

/// One program while it is lowered.
pub struct Lowering<'a> {
    pub parsed: &'a ParsedFile<'a>,
    pub source: &'a [u8],
    pub control: &'a Control,
    pub names: &'a BTreeMap<String, Var>,
    pub codes: Codes<'a>,
    pub labels: Labels,
    pub findings: Findings<'a>,
    pub builder: Builder,
    /// The block that computed jumps share, and where the first of them stands.
    pub hub: Option<(BlockId, Span)>,
    /// Where jumps go to numbers that no block has.
    pub nowhere: Nowhere,
    /// The loops that are open here, innermost last.
    pub loops: Vec<Loop>,
    /// The loop under a block skip that is open here.
    pub skipped: Option<SkippedLoop>,
    /// Modal calls that were begun and not ended, as the text has it.
    pub modal_calls: usize,
    /// The motion code in force as the text has it, for the roles of words that stand without one.
    pub motion: Motion,
    pub known: RolesUnder,
    /// Index of the block being lowered.
    pub at: usize,
    /// The first block of the program.
    pub start: usize,
    /// The block after the last one of the program.
    pub end: usize,
    /// True in a program that a code calls, where such codes call nothing.
    pub aliased: bool,
    /// True where a word or an argument has a signed variable for its value.
    pub signed: bool,
    /// True while the look-ahead is limited, as the text has it.
    pub lookahead_limited: bool,
    /// True while feeds count inverse time, as the text has it.
    pub inverse: bool,
    /// True after what ended the run, or left by a jump, where no block since can be jumped to.
    pub is_over: bool,
    /// True from a block on that begins a table of data, until the code that ends it.
    pub in_data: bool,
    /// The number of the block after the comment that goes on over lines; 0 before the first.
    pub remark_end: usize,
    /// True where the block at hand has axis words beside a code that may take words.
    pub moves: bool,
}

/// A loop that has begun.
pub struct Loop {
    pub number: u32,
    /// The block of the file where it begins.
    pub start: usize,
    pub head: BlockId,
    pub exit: BlockId,
    pub site: SourceInfo,
}

/// A loop under a block skip that has begun.
pub struct SkippedLoop {
    pub level: u8,
    /// The block of the file where it ends.
    pub end: usize,
    /// Where control goes on.
    pub next: BlockId,
    /// The motion code in force before it.
    pub before: Motion,
}

/// The motion code in force as the text has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    pub code: Option<CodeId>,
    /// Its row, where words beside it told which one it is.
    pub beside: Option<CodePlace>,
    /// True where a jump may have come in since the code, with another one in force.
    pub joined: bool,
    /// How the feed counts, where a code before says it on every way.
    pub feed: Option<Op>,
}

impl Motion {
    /// Something may have come in, or run, with another code in force.
    pub fn join(&mut self) {
        self.joined = true;
        self.feed = None;
    }

    /// Another way comes in with what is in force there.
    pub fn meet(&mut self, other: Self) {
        self.joined |= other.joined || (self.code, self.beside) != (other.code, other.beside);
        self.feed = self.feed.filter(|feed| other.feed == Some(*feed));
    }
}

impl<'a> Lowering<'a> {
    /// Nothing of a program yet.
    pub fn new(
        parsed: &'a ParsedFile<'a>,
        control: &'a Control,
        names: &'a BTreeMap<String, Var>,
        (codes, findings): (Codes<'a>, Findings<'a>),
        labels: Labels,
        piece: &Piece,
    ) -> Self {
        let mut builder = Builder::over(1 + labels.count());
        if labels.count() == 0 {
            builder.reserve(piece.body.len());
        }
        let aliased = match piece.name {
            Some(ProgramName::Number(number)) => codes.is_alias_target(number),
            _ => false,
        };
        Self {
            parsed,
            source: parsed.source,
            control,
            names,
            codes,
            labels,
            findings,
            builder,
            hub: None,
            nowhere: Nowhere::default(),
            loops: Vec::new(),
            skipped: None,
            modal_calls: 0,
            motion: Motion::default(),
            known: RolesUnder::default(),
            at: piece.body.start,
            start: piece.body.start,
            end: piece.body.end,
            aliased,
            signed: false,
            lookahead_limited: false,
            inverse: false,
            is_over: false,
            in_data: false,
            remark_end: 0,
            moves: false,
        }
    }

    /// Says that the construct rests on a question that the table does not answer.
    pub fn unknown_behaviour(&mut self, question: Question, span: Span) {
        let note = self.control.behaviour(question).and_then(|row| row.origin.note.as_deref());
        self.findings.unconfirmed(question.fact().into(), note.or(Some(question.meaning())), span);
    }
}
