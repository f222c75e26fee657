//! Which rules of the grammar are lexemes, and of what kind.

use super::grammar::Rule;
use crate::syntax::TokenKind::{self, *};

/// The kind of token a rule's text becomes; `None` for rules made of others.
pub(super) fn kind(rule: Rule) -> Option<TokenKind> {
    Some(match rule {
        Rule::tape | Rule::mark => Mark,
        Rule::slash => Skip,
        Rule::n_letter | Rule::o_letter | Rule::letter => Letter,
        Rule::digits | Rule::number | Rule::stray_point => Number,
        Rule::r_name | Rule::r_used | Rule::v_used | Rule::single | Rule::array => Variable,
        Rule::label_name => Mark,
        Rule::bracket_comment | Rule::star_comment | Rule::apostrophe_comment => Comment,
        Rule::end_of_block => EndOfBlock,
        Rule::text => Text,
        Rule::open | Rule::close => Bracket,
        Rule::sign
        | Rule::minus
        | Rule::plus
        | Rule::comma
        | Rule::last_comma
        | Rule::to
        | Rule::equals
        | Rule::not
        | Rule::add
        | Rule::subtract
        | Rule::multiply
        | Rule::divide
        | Rule::equal
        | Rule::not_equal
        | Rule::less_equal
        | Rule::greater_equal
        | Rule::less
        | Rule::greater
        | Rule::and
        | Rule::or => Operator,
        Rule::if_word
        | Rule::then_word
        | Rule::goto_word
        | Rule::print_word
        | Rule::sprint_word
        | Rule::input_word
        | Rule::sinput_word
        | Rule::clear_word
        | Rule::set_word
        | Rule::wait_word
        | Rule::start_word
        | Rule::index_word
        | Rule::degrees
        | Rule::radians
        | Rule::debug
        | Rule::run
        | Rule::rnd_word
        | Rule::function => Keyword,
        _ => return None,
    })
}

/// What a rule is called in a message; `None` for what would only add noise.
pub(super) fn name(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::digits | Rule::number => "a number",
        Rule::sign | Rule::minus | Rule::plus => return None,
        Rule::variable | Rule::single | Rule::array | Rule::r_used | Rule::r_value => "a variable",
        Rule::function => "a function",
        Rule::open => "`(`",
        Rule::close => "`)`",
        Rule::equals => "`=`",
        Rule::then_word => "THEN",
        Rule::comma | Rule::last_comma => "`,`",
        Rule::text => "text in quotation marks",
        Rule::label_name => "a label",
        Rule::n_letter => "a block number",
        Rule::letter | Rule::word => "a word",
        Rule::nc_comment | Rule::macro_comment => "a comment",
        Rule::EOI => "the end of the line",
        Rule::add | Rule::subtract | Rule::multiply | Rule::divide => "an operator",
        Rule::equal | Rule::less | Rule::greater | Rule::and | Rule::or => "an operator",
        Rule::if_word | Rule::goto_word | Rule::print_word | Rule::assign => "a macro statement",
        Rule::degrees | Rule::run => "DEGREES, RADIANS, DEBUG, RUN or RND",
        _ => return None,
    })
}
