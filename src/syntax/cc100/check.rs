//! What the grammar alone cannot see: words that may not share a block, labels.

use crate::diag::Code;
use crate::syntax::support::fault;
use crate::syntax::{Item, ItemKind, SyntaxError};

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
            Kind::Plain => "a plain word cannot follow parametric words: divide the block",
            _ => {
                "a parametric word cannot follow plain words: put their numbers into variables, or divide \
                 the block"
            }
        };
        return Some(fault(Code::MixedBlock, item.span, message));
    }
    None
}
