//! The leaves of a block, as the grammars yield them.

use crate::syntax::{Token, TokenKind};
use crate::text::Span;
use smallvec::SmallVec;

/// Kinds of leaves, and of what the grammar yields as one and [`push`] cuts into them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lex {
    Space,
    Comment,
    /// `#100`: cut by [`push`].
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
    #[default]
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
            Self::Letter => "a word",
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
pub type Lexemes = SmallVec<[Lexeme; 32]>;

/// Adds to a row what a grammar read as one: a leaf, or several that are written together, and the blanks after it.
pub fn push(row: &mut Lexemes, kind: Lex, start: u32, text: &[u8]) {
    let mut cut = Cut { row, at: start, rest: text };
    match kind {
        Lex::Nothing => {}
        Lex::Numbered => {
            cut.take(Lex::Hash, 1);
            cut.integer();
        }
        Lex::Integer => cut.integer(),
        // A comment that nothing closes ends with the line, blanks included.
        Lex::Comment if !text.trim_ascii_end().ends_with(b")") => cut.take(kind, text.len()),
        Lex::Space | Lex::OutputText => cut.take(kind, text.len()),
        kind => cut.take(kind, text.trim_ascii_end().len()),
    }
    cut.blanks();
}

/// Cuts what is written together into its leaves.
struct Cut<'a> {
    row: &'a mut Lexemes,
    /// Where the rest starts in the file.
    at: u32,
    rest: &'a [u8],
}

impl Cut<'_> {
    /// How many bytes of a kind come next.
    fn run(&self, kind: impl Fn(&u8) -> bool) -> usize {
        self.rest.iter().take_while(|byte| kind(byte)).count()
    }

    fn take(&mut self, kind: Lex, length: usize) {
        let end = self.at + length as u32;
        self.row.push(Lexeme { kind, span: Span::new(self.at, end) });
        self.at = end;
        self.rest = self.rest.get(length..).unwrap_or_default();
    }

    fn blanks(&mut self) {
        let blanks = self.run(|byte| matches!(byte, b' ' | b'\t'));
        if blanks > 0 {
            self.take(Lex::Space, blanks);
        }
    }

    /// Digits, and the bit that may stand after those of a variable.
    fn integer(&mut self) {
        self.take(Lex::Integer, self.run(u8::is_ascii_digit));
        if self.rest.first() == Some(&b'.') {
            self.take(Lex::Bit, 1 + self.rest[1..].iter().take_while(|byte| byte.is_ascii_digit()).count());
        }
    }
}

/// True where the leaves tile the block.
pub fn is_tiled(row: &[Lexeme], block: Span) -> bool {
    let mut at = block.start;
    row.iter().all(|leaf| std::mem::replace(&mut at, leaf.span.end) == leaf.span.start) && at == block.end
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
                    $rule::output_numbered => Self::Numbered,
                    $rule::letter => Self::Letter,
                    $rule::number => Self::Number,
                    $rule::integer | $rule::index | $rule::output_integer | $rule::output_index => {
                        Self::Integer
                    }
                    $rule::sign => Self::Sign,
                    $rule::hash => Self::Hash,
                    $rule::open | $rule::output_open => Self::Open,
                    $rule::close | $rule::output_close => Self::Close,
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
