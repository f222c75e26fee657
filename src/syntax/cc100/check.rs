//! What the grammar alone cannot see: words that may not share a block, labels.

use crate::diag::Code;
use crate::syntax::support::fault;
use crate::syntax::targets::check_targets;
use crate::syntax::{Block, Expr, ExprKind, Item, ItemKind, Label, SyntaxError, Word};
use crate::text::Span;

/// How an item counts for the rule that plain and parametric do not mix. G
/// codes stand with either: the manual prints `G0 X=V23 Y=V22` and
/// `G81 V1=5 V2=-10` in running programs.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Plain,
    Parametric,
    Either,
}

fn kind(item: &Item) -> Kind {
    match &item.kind {
        ItemKind::Word(word) if word.equals => Kind::Parametric,
        ItemKind::Word(word) if word.letter != 'G' => Kind::Plain,
        ItemKind::Assign { .. }
        | ItemKind::Branch { .. }
        | ItemKind::Test(_)
        | ItemKind::Step { .. }
        | ItemKind::Timer(_)
        | ItemKind::Transfer { .. } => Kind::Parametric,
        _ => Kind::Either,
    }
}

/// A fault at the first item that does not go with those before it.
pub(super) fn mixture(items: &[Item]) -> Option<SyntaxError> {
    let mut first = Kind::Either;
    for item in items {
        let kind = kind(item);
        if kind == Kind::Either || kind == first {
            continue;
        }
        if first == Kind::Either {
            first = kind;
            continue;
        }
        let message = match kind {
            Kind::Plain => "a plain word may not stand behind parametric ones; divide the block",
            _ => {
                "a parametric word may not stand behind plain ones; put their numbers into variables, or divide the block"
            }
        };
        return Some(fault(Code::MixedBlock, item.span, message));
    }
    None
}

/// What is wrong between the blocks of a file: jumps and calls to a label that is not
/// there, and labels that stand again. What is wrong inside a block stands in
/// [`Block::errors`].
pub fn check_blocks(blocks: &[Block], _source: &[u8]) -> Vec<SyntaxError> {
    check_targets(blocks, call)
}

/// The label of `G22 P1` (a call) or `G24 P2` (a jump).
fn call(items: &[Item]) -> Option<(Label, Span)> {
    let word = |wanted: char| {
        items.iter().find_map(|item| match &item.kind {
            ItemKind::Word(Word {
                letter, value: Some(Expr { kind: ExprKind::Number(number), .. }), ..
            }) if *letter == wanted => Some((number.value, item.span)),
            _ => None,
        })
    };
    let (code, _) = word('G')?;
    let (label, span) = word('P')?;
    let whole = label.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&label);
    (whole && [22.0, 24.0].contains(&code)).then_some((Label::Number(label as u32), span))
}
