//! Which rules of the grammar are lexemes, and of what kind.

use super::grammar::Rule;
use crate::syntax::TokenKind::{self, *};

/// The kind of token a rule's text becomes; `None` for rules made of others.
pub(super) fn kind(rule: Rule) -> Option<TokenKind> {
    Some(match rule {
        Rule::tape | Rule::dollar => Mark,
        Rule::skip => Skip,
        Rule::n_letter | Rule::letter | Rule::p_letter | Rule::g_letter | Rule::row_letter | Rule::read => {
            Letter
        }
        Rule::digits | Rule::number => Number,
        Rule::variable => Variable,
        Rule::comment_text => Comment,
        Rule::inserted
        | Rule::sign
        | Rule::equals
        | Rule::add
        | Rule::subtract
        | Rule::multiply
        | Rule::divide => Operator,
        Rule::function
        | Rule::relation
        | Rule::test_word
        | Rule::flag
        | Rule::inc
        | Rule::dec
        | Rule::timer_word
        | Rule::table => Keyword,
        _ => return None,
    })
}

/// What a rule is called in a message; `None` for what would only add noise.
pub(super) fn name(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::digits | Rule::number | Rule::constant => "a number",
        Rule::variable | Rule::v_letter => "a variable",
        Rule::function | Rule::call => "a function",
        Rule::equals => "`=`",
        Rule::word | Rule::letter => "a word",
        Rule::label => "a label",
        Rule::comment | Rule::comment_text => "a comment",
        Rule::cell => "a cell such as `R=V1` or `V1=R`",
        Rule::p_letter => "P and a label's number",
        Rule::g_letter => "a G code",
        Rule::flag => "QX, QY, QZ, QE or QM",
        Rule::EOI => "the end of the block",
        _ => return None,
    })
}
