//! The Macro B family: what its controls share, which is nearly everything.
//!
//! Where they differ they do so by the answers of their tables (does `M99 P` jump
//! here, is a comparison a value, where does GOTO look first), so nothing here asks
//! for a dialect's name.
//!
//! - `split` cuts a file into programs,
//! - `labels` finds the blocks that jumps can reach and the ranges of loops,
//! - `block` lowers one block: block skip, its statements in order,
//! - `statement`, `loops`, `flow`, `call`, `arguments` are the macro statements and calls,
//! - `words`, `bare`, `roles` and `value` are the NC words,
//! - `expr`, `cond` and `variable` are the expressions,
//! - `vacancy` looks over the finished program for signed variables that may be vacant.

mod arguments;
mod bare;
mod block;
mod call;
mod codes;
mod cond;
mod expr;
mod flow;
mod labels;
mod loops;
mod roles;
mod split;
mod statement;
#[cfg(test)]
mod tests;
mod vacancy;
mod value;
mod variable;
mod words;

use super::Lowered;
use super::common::{Findings, comment_text};
use crate::dialect::{Control, Question};
use crate::ir::{BlockId, Builder, Comment, SourceInfo, Var};
use crate::syntax::{ItemKind, ParsedFile, ProgramName};
use crate::text::Span;
use bare::RolesUnder;
use codes::{CodeId, Codes};
use labels::Labels;
use split::Piece;
pub use split::cuts;
use std::collections::BTreeMap;

/// What only one control of the family has, and no table can say.
#[derive(Clone, Copy)]
pub(super) struct Family {
    /// Another number of the same variable, where the control numbers it twice.
    pub twin: fn(u32) -> Option<u32>,
}

/// Lowers all programs of a file.
pub(super) fn lower(parsed: &ParsedFile<'_>, file: usize, control: &Control, family: Family) -> Lowered {
    let (pieces, tape) = split::split(parsed);
    let names = variable::names(parsed, control, family);
    let mut codes = Codes::new(control);
    let mut findings = Findings::new(control);
    let mut programs = Vec::with_capacity(pieces.len());
    for piece in pieces {
        codes.forget_told();
        let labels = Labels::scan(parsed, &piece, &mut codes);
        let mut lowering = Lowering::new(parsed, control, family, &names, (codes, findings), labels, &piece);
        lowering.body(&piece);
        let Lowering { builder, findings: found, codes: met, signed, .. } = lowering;
        (codes, findings) = (met, found);
        let site = program_site(parsed, &piece);
        let program = builder.finish(piece.name, file, site);
        if signed && let Some(span) = vacancy::signed_word(&program, !control.is(Question::M99PJumpsHere)) {
            let note = "no source says that the control drops a word with a sign before its vacant variable";
            findings.unconfirmed(Question::BracketVacantWord.fact().into(), Some(note), span);
        }
        programs.push((program, findings.take_list()));
    }
    let names = names.into_iter().map(|(name, var)| (var, name)).collect();
    Lowered { programs, names, tape }
}

/// One program while it is lowered.
struct Lowering<'a> {
    parsed: &'a ParsedFile<'a>,
    source: &'a [u8],
    control: &'a Control,
    family: Family,
    names: &'a BTreeMap<String, Var>,
    codes: Codes<'a>,
    labels: Labels,
    findings: Findings<'a>,
    builder: Builder,
    /// The block that computed jumps share, and where the first of them stands.
    hub: Option<(BlockId, Span)>,
    /// The loops that are open here, innermost last.
    loops: Vec<Loop>,
    /// Modal calls that were begun and not ended, as the text has it.
    modal_calls: usize,
    /// The motion code in force as the text has it, for the roles of words that stand without one.
    motion: Motion,
    known: RolesUnder,
    /// Index of the block being lowered.
    at: usize,
    /// True in a program that a code calls, where such codes call nothing.
    aliased: bool,
    /// True where a word has a signed variable for its value.
    signed: bool,
    /// True while the look-ahead is limited, as the text has it.
    lookahead_limited: bool,
}

/// A loop that has begun.
struct Loop {
    number: u32,
    /// The block of the file where it begins.
    start: usize,
    head: BlockId,
    exit: BlockId,
    site: SourceInfo,
}

/// The motion code in force as the text has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Motion {
    code: Option<CodeId>,
    /// True where a jump may have come in since the code, with another one in force.
    joined: bool,
}

impl<'a> Lowering<'a> {
    fn new(
        parsed: &'a ParsedFile<'a>,
        control: &'a Control,
        family: Family,
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
            family,
            names,
            codes,
            labels,
            findings,
            builder,
            hub: None,
            loops: Vec::new(),
            modal_calls: 0,
            motion: Motion::default(),
            known: RolesUnder::default(),
            at: piece.body.start,
            aliased,
            signed: false,
            lookahead_limited: false,
        }
    }
}

/// The site of the block that names a program, with the comments that stand before it.
fn program_site(parsed: &ParsedFile<'_>, piece: &Piece) -> SourceInfo {
    let mut site = SourceInfo::default();
    for &index in &piece.leading {
        let Some(block) = parsed.blocks.get(index) else { continue };
        site.span = if site.span.is_empty() { block.span } else { site.span.to(block.span) };
        for item in &block.items {
            if let ItemKind::Comment(comment) = &item.kind {
                site.comments
                    .push(Comment { text: comment_text(comment.text, parsed.source), leading: true });
            }
        }
    }
    if let Some(block) = piece.head.and_then(|head| parsed.blocks.get(head)) {
        let own = block::site(block, parsed.source);
        site.span = own.span;
        site.comments.extend(own.comments);
    }
    site
}
