//! The shape of `dialects/*.toml`. Every row says where it comes from, and how
//! sure it is.

use super::Forbidden;
use super::Origin;
use super::forms::{Form, LineCounts, Names};
use super::rows::*;
use super::{InUse, Matter, SameCells, VariableClass};
use serde::{Deserialize, Serialize};

pub(super) fn yes() -> bool {
    true
}

/// All that is known of one control. [`super::load()`] reads it, section by section.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Dialect {
    /// Short name, as `--from` takes it.
    pub name: String,
    /// Name for people.
    pub title: String,
    /// The family whose grammar and behaviour it shares.
    pub family: String,
    /// File name extensions its programs usually have, without the point.
    pub extensions: Vec<String>,
    /// What people must know before they run a converted program for the first time; absent if the control is not new here.
    pub advice: Option<String>,
    /// How numbers are written and kept.
    pub numbers: Numbers,
    /// Characters, comments, lengths.
    pub text: Text,
    /// Names of programs and variables.
    pub names: Names,
    /// What each place takes as an operand.
    pub forms: Vec<Form>,
    /// Nesting and other limits.
    pub limits: Vec<Limit>,
    /// What it takes for a fault while a code is in force.
    pub forbidden: Vec<Forbidden>,
    /// Operators, with their rank.
    pub operators: Vec<Operator>,
    /// Functions.
    pub functions: Vec<Function>,
    /// Statements it has.
    pub statements: Vec<Statement>,
    /// Yes-or-no questions of behaviour, by name.
    pub behaviours: Vec<Behaviour>,
    /// What is as the emulated controls have it, though no table asks about it.
    pub matters: Vec<Matter>,
    /// Classes of variables that programs may use freely.
    pub variables: Vec<VariableClass>,
    /// Those of them that most shops have put to use.
    pub in_use: Vec<InUse>,
    /// Second numbers of them.
    pub same_cells: Vec<SameCells>,
    /// System variables.
    pub system: Vec<SystemVariable>,
    /// What letters mean where no code says otherwise.
    pub words: Vec<WordMeaning>,
    /// G and M codes.
    pub codes: Vec<CodeMeaning>,
    /// G and M codes that it has under another setting.
    #[serde(skip)]
    pub other_codes: Vec<CodeMeaning>,
    /// System variables that it has under another setting.
    #[serde(skip)]
    pub other_system: Vec<SystemVariable>,
    /// Argument letters of macro calls and the local variable each sets.
    pub arguments: Vec<Argument>,
    /// Settings that a machine profile may change, with what they are by default.
    pub settings: Vec<Setting>,
}

/// How numbers are written and kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Numbers {
    /// What a length without a decimal point counts: `increments`, `units` (calculator type), or `unknown`.
    pub bare_length: BareLength,
    /// What a call argument without a decimal point counts.
    pub bare_argument: BareLength,
    /// What a feed without a decimal point counts.
    pub bare_feed: BareLength,
    /// True where a feed without a point, in millimetres a minute, is as written, and `bare_feed` is `unknown`: a feed in inches
    /// or a turn may count otherwise.
    #[serde(default)]
    pub whole_feeds: bool,
    /// How many counts make one unit of a feed without a point that counts units: 10 where it counts tenths.
    #[serde(default = "one")]
    pub feed_parts: f64,
    /// Letters whose numbers get a point from the control where lengths count units; the others count increments
    /// still. Empty where all lengths do, and no feed.
    #[serde(default)]
    pub calculator_letters: String,
    /// True where the machine profile says what a feed without a point counts.
    #[serde(skip)]
    pub feed_stated: bool,
    /// Least increment of a length in metric, millimetres.
    pub increment_mm: f64,
    /// Least increment of a length in inch.
    pub increment_inch: f64,
    /// Least increment of an angle, degrees.
    pub increment_degrees: f64,
    /// True where the letters of angles count increments of angles in the arguments of a call too, not of lengths.
    #[serde(default = "yes")]
    pub angle_arguments: bool,
    /// Most digits a constant may have; absent where unknown.
    pub digits: Option<u32>,
    /// The smallest number above 0 that is sure to be kept; absent where unknown.
    pub least: Option<f64>,
    /// How values are kept: `double`, `single`, `decimal8`, `unknown`.
    pub arithmetic: String,
    /// Where these come from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

fn one() -> f64 {
    1.0
}

impl Numbers {
    /// True where the control gives this letter's numbers their point, where lengths count units.
    pub fn calculator_reaches(&self, letter: char) -> bool {
        self.calculator_letters.is_empty() || self.calculator_letters.contains(letter)
    }
}

/// What a number without a decimal point counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BareLength {
    /// Least increments: `X10` is 0.010 mm.
    Increments,
    /// Whole units: `X10` is 10 mm.
    Units,
    /// No source says.
    Unknown,
}

/// Characters, comments, lengths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Text {
    /// Most characters of a block, absent where unknown.
    pub line: Option<u32>,
    /// Most characters of a macro statement's line, where that is another number.
    pub macro_line: Option<u32>,
    /// What counts as the length of a line.
    #[serde(default)]
    pub line_counts: LineCounts,
    /// True where each block of a program has a number, and they are counted by one.
    #[serde(default)]
    pub counted: bool,
    /// Largest sequence number.
    pub sequence_max: u32,
    /// Largest program number.
    pub program_max: u32,
    /// True where lines without anything may stand between the blocks of a program.
    #[serde(default)]
    pub blank_lines: bool,
    /// Most characters of a comment on a block of its own.
    pub comment: Option<u32>,
    /// Most blocks in a row that hold a comment and nothing else.
    pub comments_in_a_row: Option<u32>,
    /// Most characters of a message to the operator.
    pub message: Option<u32>,
    /// Signs that a message cannot have.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub message_lacks: String,
    /// Where these come from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}
