//! The Macro B family: what its controls share, which is nearly everything.
//!
//! Where they differ they do so by the answers of their tables (does `M99 P` jump
//! here, is a comparison a value, where does GOTO look first), so nothing here asks
//! for a dialect's name.
//!
//! Its rooms stand in one order, in which each uses only those before it; `tests/architecture.rs` fails otherwise:
//!
//! - `codes` keeps what the table says of each code,
//! - `parts` cuts a file into programs, and finds the blocks that jumps can reach and the ranges of loops,
//! - `build` is a program while it is lowered,
//! - `expressions` are those, conditions and variables,
//! - `words` are the words of NC blocks and the arguments of calls,
//! - `flow` is what leaves the straight way: calls, jumps, conditions, loops,
//! - `program` lowers block by block, and looks over the finished program for signed variables that may be vacant.

mod build;
mod codes;
mod expressions;
mod flow;
mod parts;
mod program;
#[cfg(test)]
mod tests;
mod words;

use super::Lowered;
use super::common::{Findings, comment_text};
use crate::dialect::{Control, Question};
use crate::ir::{Comment, SourceInfo};
use crate::syntax::{ItemKind, ParsedFile};
use build::Lowering;
use codes::Codes;
pub use parts::cuts;
use parts::{Labels, Piece};

/// Lowers all programs of a file.
pub(super) fn lower(parsed: &ParsedFile<'_>, file: usize, control: &Control) -> Lowered {
    let (pieces, tape) = parts::split(parsed);
    let names = expressions::names(parsed, control);
    let mut codes = Codes::new(control);
    let mut findings = Findings::new(control);
    let mut programs = Vec::with_capacity(pieces.len());
    for piece in pieces {
        codes.forget_told();
        let labels = Labels::scan(parsed, &piece, &mut codes);
        let mut lowering = Lowering::new(parsed, control, &names, (codes, findings), labels, &piece);
        lowering.body(&piece);
        let Lowering { builder, findings: found, codes: met, signed, .. } = lowering;
        (codes, findings) = (met, found);
        let site = program_site(parsed, &piece);
        let program = builder.finish(piece.name, file, site);
        if signed {
            let found = program::signed_variables(&program, !control.is(Question::M99PJumpsHere));
            if let Some(span) = found.word {
                let note =
                    "no source says that the control drops a word with a sign before its vacant variable";
                findings.unconfirmed(Question::BracketVacantWord.fact().into(), Some(note), span);
            }
            if let Some(span) = found.argument {
                let note = "no source says whether an argument with a sign before its vacant variable, A-#1, is 0 in the macro or \
                            vacant; it is taken as 0: set the variable before the call";
                findings.unconfirmed("machine:argument.signed".into(), Some(note), span);
            }
        }
        programs.push((program, findings.take_list()));
    }
    let names = names.into_iter().map(|(name, var)| (var, name)).collect();
    Lowered { programs, names, tape }
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
        let own = parts::site(block, parsed.source);
        site.span = own.span;
        site.comments.extend(own.comments);
    }
    site
}
