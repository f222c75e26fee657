//! The leaves of a block, as the scanner and the grammars both yield them.

use crate::syntax::{Token, TokenKind};
use crate::text::Span;
use smallvec::SmallVec;

/// Kinds of leaves; one for each leaf rule of `grammar/macro_b.pest`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lex {
    Space,
    Comment,
    /// A letter, perhaps a sign, and a number; cut into these by [`push`].
    PlainWord,
    /// `#` and digits; cut into these by [`push`].
    Numbered,
    Letter,
    Number,
    Integer,
    Bit,
    Sign,
    Hash,
    Open,
    Close,
    Equals,
    Comma,
    Slash,
    Skip,
    Tape,
    EndOfBlock,
    Operator,
    Join,
    Function,
    SequenceLetter,
    ProgramLetter,
    ProgramName,
    If,
    Then,
    Goto,
    While,
    Do,
    End,
    Output,
    OutputText,
    Port,
    SetNames,
    Name,
    /// Pest's end of input, and whatever yields no leaf.
    Nothing,
}

impl Lex {
    /// How an editor would colour it.
    pub const fn token(self) -> TokenKind {
        match self {
            Self::Space => TokenKind::Space,
            Self::Comment => TokenKind::Comment,
            Self::Letter | Self::SequenceLetter | Self::ProgramLetter => TokenKind::Letter,
            Self::Number | Self::Integer | Self::Bit => TokenKind::Number,
            Self::Sign | Self::Equals | Self::Comma | Self::Slash | Self::Operator | Self::Join => {
                TokenKind::Operator
            }
            Self::Hash => TokenKind::Variable,
            Self::Open | Self::Close => TokenKind::Bracket,
            Self::Skip => TokenKind::Skip,
            Self::Tape => TokenKind::Mark,
            Self::EndOfBlock => TokenKind::EndOfBlock,
            Self::OutputText | Self::ProgramName | Self::Name => TokenKind::Text,
            Self::Nothing => TokenKind::Other,
            _ => TokenKind::Keyword,
        }
    }

    /// What a programmer calls it; none for what may stand anywhere.
    pub const fn in_words(self) -> Option<&'static str> {
        Some(match self {
            Self::Space | Self::Comment | Self::Skip | Self::Tape | Self::Slash | Self::Nothing => {
                return None;
            }
            Self::Letter | Self::PlainWord => "a word",
            Self::Number | Self::Integer => "a number",
            Self::Bit => "a bit number",
            Self::Sign => "a sign",
            Self::Hash | Self::Numbered => "a variable",
            Self::Open => "`[`",
            Self::Close => "`]`",
            Self::Equals => "`=`",
            Self::Comma => "a comma",
            Self::EndOfBlock => "the end of the block",
            Self::Operator => "an operator",
            Self::Join => "AND, OR or XOR",
            Self::Function => "a function",
            Self::SequenceLetter => "an N number",
            Self::ProgramLetter | Self::ProgramName => "a program number",
            Self::If => "IF",
            Self::Then => "THEN",
            Self::Goto => "GOTO",
            Self::While => "WHILE",
            Self::Do => "DO",
            Self::End => "END",
            Self::Output | Self::Port => "an output statement",
            Self::OutputText => "text",
            Self::SetNames => "SETVN",
            Self::Name => "a name",
        })
    }
}

/// A leaf and where it stands in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lexeme {
    pub kind: Lex,
    pub span: Span,
}

/// The leaves of one block.
pub type Row = SmallVec<[Lexeme; 32]>;

/// Adds a leaf of a grammar, whose text is `text`, to a row; the two that are written
/// together are cut.
pub fn push(row: &mut Row, kind: Lex, span: Span, text: &[u8]) {
    let mut from = span.start;
    let mut cut = |kind, to| {
        row.push(Lexeme { kind, span: Span::new(from, to) });
        from = to;
    };
    match kind {
        Lex::Nothing => {}
        Lex::PlainWord => {
            cut(Lex::Letter, span.start + 1);
            if matches!(text.get(1), Some(b'-' | b'+')) {
                cut(Lex::Sign, span.start + 2);
            }
            cut(Lex::Number, span.end);
        }
        Lex::Numbered => {
            cut(Lex::Hash, span.start + 1);
            cut(Lex::Integer, span.end);
        }
        kind => cut(kind, span.end),
    }
}

/// Leaves as the tokens of a block.
pub fn tokens(row: &[Lexeme]) -> Vec<Token> {
    row.iter().map(|leaf| Token { kind: leaf.kind.token(), span: leaf.span }).collect()
}

/// Maps the `Rule` type of a dialect's grammar to [`Lex`]: the leaves have the same
/// names in every grammar of the family.
macro_rules! lexemes_of_rules {
    ($rule:ident) => {
        impl From<$rule> for $crate::syntax::macro_b::Lex {
            fn from(rule: $rule) -> Self {
                match rule {
                    $rule::space => Self::Space,
                    $rule::comment => Self::Comment,
                    $rule::plain_word => Self::PlainWord,
                    $rule::numbered => Self::Numbered,
                    $rule::letter => Self::Letter,
                    $rule::number => Self::Number,
                    $rule::integer => Self::Integer,
                    $rule::bit => Self::Bit,
                    $rule::sign => Self::Sign,
                    $rule::hash => Self::Hash,
                    $rule::open => Self::Open,
                    $rule::close => Self::Close,
                    $rule::equals => Self::Equals,
                    $rule::comma => Self::Comma,
                    $rule::slash => Self::Slash,
                    $rule::skip => Self::Skip,
                    $rule::tape => Self::Tape,
                    $rule::end_of_block => Self::EndOfBlock,
                    $rule::operator => Self::Operator,
                    $rule::join => Self::Join,
                    $rule::function | $rule::two_part_function => Self::Function,
                    $rule::sequence_letter => Self::SequenceLetter,
                    $rule::program_letter => Self::ProgramLetter,
                    $rule::program_name => Self::ProgramName,
                    $rule::if_word => Self::If,
                    $rule::then_word => Self::Then,
                    $rule::goto_word => Self::Goto,
                    $rule::while_word => Self::While,
                    $rule::do_word => Self::Do,
                    $rule::end_word => Self::End,
                    $rule::output_word => Self::Output,
                    $rule::output_text => Self::OutputText,
                    $rule::port => Self::Port,
                    $rule::names_word => Self::SetNames,
                    $rule::name => Self::Name,
                    _ => Self::Nothing,
                }
            }
        }
    };
}
pub(in crate::syntax) use lexemes_of_rules;
