//! The rows of `dialects/*.toml`.

use super::{BareLength, Origin, Question, yes};
use crate::canon::{Func, Op, Role, Sys};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A limit: `brackets`, `do.depth`, `do.numbers`, `call.macro`, `call.all`, `repeat`, ...
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// Its name.
    pub name: String,
    /// The largest value allowed; absent for none.
    pub max: Option<u32>,
    /// The alarm past it.
    pub alarm: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// An operator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Operator {
    /// How it is written.
    pub spelling: String,
    /// What it does: `add`, `subtract`, `multiply`, `divide`, `modulo`, `and.bits`, `or.bits`,
    /// `xor.bits`, `and`, `or`, `not`, `negate`, `eq`, `ne`, `lt`, `le`, `gt`, `ge`.
    pub meaning: String,
    /// Rank: operators of a higher rank bind tighter.
    pub rank: u32,
    /// True where it may stand only in a condition.
    #[serde(default)]
    pub condition_only: bool,
    /// An option that must be bought, absent in the basic control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// A function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Function {
    /// What it computes.
    pub function: Func,
    /// How it is written.
    pub spelling: String,
    /// Other spellings that are read.
    #[serde(default)]
    pub aliases: Vec<String>,
    /// How many arguments.
    #[serde(default = "one")]
    pub arguments: u32,
    /// How two arguments are written: `slash` or `comma`.
    pub form: Option<String>,
    /// Its domain, in words: `-360..360`, `>=0`.
    pub domain: Option<String>,
    /// Its range, in words: `-90..90`, `0..360`.
    pub range: Option<String>,
    /// An option that must be bought, absent in the basic control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

fn one() -> u32 {
    1
}

/// A statement the control has: `goto`, `goto.computed`, `if.goto`, `if.then`, `if.then.words`,
/// `if.bare`, `while`, `do.endless`, `call.macro`, `call.modal`, `call.program`, `call.local`,
/// `call.repeat`, `return.to.sequence`, `output.formatted`, `setvn`, `print`, `input`, ...
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
    /// Its name.
    pub name: String,
    /// How it is written.
    pub spelling: String,
    /// An option that must be bought, absent in the basic control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// How the control behaves in a place where controls differ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Behaviour {
    /// The question: `vacancy`, `vacant.word.dropped`, `goto.forward.first`, `m99.p.jumps.here`, ...
    #[serde(rename = "name")]
    pub question: Question,
    /// The answer: one that the question may have.
    pub value: String,
    /// Where the answer is unknown: those that a source leaves open between. Beside an answer that is among them: what a machine
    /// may have, as its profile says, where most have that one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub one_of: Vec<String>,
    /// The option that the answer is `true` by; without it it is `false`. Of several rows of one question: the option, or
    /// `not.` and the option, that a control has with this answer.
    #[serde(default)]
    pub option: Option<String>,
    /// The kind of machine that it is the answer for: `mill`, `lathe`; absent for both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// A run of system variables.
///
/// The number of the variable with subscripts i, j is `first + i*step[0] + j*step[1]`
/// with each subscript counted from its `from`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SystemVariable {
    /// What it is.
    pub state: Sys,
    /// Its name before the number, where it is not `#`: `AX`, `FX`, `H`.
    #[serde(default = "hash")]
    pub name: String,
    /// Its fixed name, where it has one: `_EMPTY`, `_ABSIO[n]`; `_WZG{54}[n]` where its first subscript counts on from 54.
    pub alias: Option<String>,
    /// The first variable number; absent for a name without subscript.
    pub first: Option<u32>,
    /// One entry a subscript, outermost first.
    #[serde(default)]
    pub subscripts: Vec<Subscript>,
    /// True where its number stands in brackets: `I(1)`.
    #[serde(default)]
    pub array: bool,
    /// `r`, `w` or `rw`.
    #[serde(default = "rw")]
    pub access: String,
    /// The largest number that it may be set to, where that is known.
    pub most: Option<f64>,
    /// Constant subscripts that come before those above: the axis of `AX` is 1.
    #[serde(default)]
    pub fixed: Vec<u32>,
    /// Constant subscripts that come after those above: the axis of `FX3` is 1.
    #[serde(default)]
    pub after: Vec<u32>,
    /// The kind of machine that has it: `mill`, `lathe`; absent for both.
    pub machine: Option<String>,
    /// A setting that it needs: `setting.format=1`.
    pub when: Option<String>,
    /// An option that must be bought, absent in the basic control.
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

fn hash() -> String {
    "#".into()
}

fn rw() -> String {
    "rw".into()
}

/// One subscript of a run of system variables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subscript {
    /// Its smallest canonical value.
    #[serde(default = "one")]
    pub from: u32,
    /// How many values it has.
    pub count: u32,
    /// Distance between the variable numbers of two neighbours.
    #[serde(default = "one")]
    pub step: u32,
    /// True where it counts the axes of the machine in their order there.
    #[serde(default)]
    pub axis: bool,
}

/// What a letter means where no code says otherwise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WordMeaning {
    /// The letter; `,R` for a comma word.
    pub letter: String,
    /// Its role.
    pub role: Role,
    /// What the letter does by itself, without a code: `E2` selects a work offset.
    pub op: Option<Op>,
    /// True where the code of that operation is written beside it, if there is one: `G43 H1`.
    #[serde(default)]
    pub with_code: bool,
    /// True where an expression may stand after it.
    #[serde(default = "yes")]
    pub expression: bool,
    /// What is added to the numbers written, by role, to get the common ones:
    /// work offset `P1` of `G54.1` is number 101.
    #[serde(default)]
    pub shift: BTreeMap<Role, Vec<Shift>>,
    /// The kind of machine that has it: `mill`, `lathe`; absent for both.
    pub machine: Option<String>,
    /// A setting that it needs: `setting.format=1`.
    pub when: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// What a G or M code means.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodeMeaning {
    /// The code, without leading zeros; with a second word where that selects the
    /// meaning: `G10 L2`. Several spellings of one code are several rows.
    pub code: String,
    /// What it does.
    pub op: Op,
    /// Other operations that are written as this code, where the control makes no difference.
    #[serde(default)]
    pub also: Vec<Op>,
    /// Operations that it does besides, in the same instant: a builder's `M13` turns the spindle and switches coolant on. Such
    /// a code is read, and never written.
    #[serde(default)]
    pub with: Vec<Op>,
    /// Operands that the code itself fixes: `G55` selects work offset 2.
    #[serde(default)]
    pub fixed: BTreeMap<Role, f64>,
    /// Letters whose role beside this code differs from the usual one. `R0` is a
    /// parametric variable that the code reads as a word.
    #[serde(default)]
    pub words: BTreeMap<String, Role>,
    /// Letters that may stand beside it, over and above those whose role is the usual one:
    /// empty means the usual ones.
    #[serde(default)]
    pub required: Vec<String>,
    /// What is added to the numbers written, by role, to get the common ones:
    /// work offset `P1` of `G54.1` is number 101.
    #[serde(default)]
    pub shift: BTreeMap<Role, Vec<Shift>>,
    /// Letters whose numbers count least increments beside it, whatever those of others count, and never have a point.
    #[serde(default)]
    pub counts: Vec<char>,
    /// The last code of a run that begins with this one: `through = 59` beside `G54`.
    pub through: Option<u32>,
    /// The fixed operand that counts up by one along such a run.
    pub counted: Option<Role>,
    /// True for a code that stays in force; absent where its operation says it.
    pub modal: Option<bool>,
    /// The kind of machine that has it: `mill`, `lathe`; absent for both.
    pub machine: Option<String>,
    /// A setting that it needs: `setting.format=1`.
    pub when: Option<String>,
    /// True for the spelling that is written; others are only read.
    #[serde(default = "yes")]
    pub preferred: bool,
    /// An option that must be bought, absent in the basic control.
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// A letter of a macro call and the local variable it sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Argument {
    /// The letter.
    pub letter: char,
    /// The local variable, in argument specification I.
    pub local: u32,
    /// What the value counts without a decimal point, where it is not the general rule.
    pub bare: Option<BareLength>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// A setting that a machine profile may change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setting {
    /// Its name in the profile: `parameter.6008.7`, `g_alias`, `setting.162`.
    pub name: String,
    /// Its name on a control of another age.
    pub also: Option<String>,
    /// The option of machines that have it by that other name.
    pub also_with: Option<String>,
    /// Its value where the profile is silent; absent for none.
    pub default: Option<String>,
    /// True where no source says that a machine has the default: what rests on it
    /// is unconfirmed until a profile states the setting.
    #[serde(default)]
    pub assumed: bool,
    /// What it changes.
    pub meaning: String,
    /// The values that it may have; empty for any.
    #[serde(default)]
    pub values: Vec<String>,
    /// What each value changes in this table: `behaviour:NAME`, `limit:NAME`, `numbers:bare_length`.
    #[serde(default)]
    pub sets: BTreeMap<String, BTreeMap<String, String>>,
    /// The word that cycles of `cycles` have no letter for here: the value of the setting stands for it.
    pub gives: Option<Role>,
    /// The word that the cycles take from the setting where no block says it.
    pub otherwise: Option<Role>,
    /// How many parts make a whole, if the setting counts parts: 10 if its value is in tenths.
    pub parts: Option<u32>,
    /// The operations that take it.
    #[serde(default)]
    pub cycles: Vec<Op>,
    /// What of the machine its value is, where that is no word: a name of [`TELLS`](super::TELLS).
    pub tells: Option<String>,
    /// The last of a run of settings that begins with this one.
    pub through: Option<u32>,
    /// For a setting that gives a code a program: the code whose number is its value.
    pub alias: Option<AliasRule>,
    /// The kind of machine that has it: `mill`, `lathe`; absent for both.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub machine: Option<String>,
    /// By value: the operations that mean something then that no row says; none for every move.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub bars: BTreeMap<String, Vec<Op>>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

impl Setting {
    /// What its value is divided by to be that of its word.
    pub fn whole(&self) -> f64 {
        f64::from(self.parts.unwrap_or(1).max(1))
    }
}

/// A run of written numbers and what is added to them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shift {
    /// The first number written.
    pub first: u32,
    /// The last number written.
    pub last: u32,
    /// What is added.
    pub add: i64,
}

/// How a setting makes a code call a program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AliasRule {
    /// The letter of the code: `G`, `M`.
    pub letter: char,
    /// The program of the run's first setting; the next ones follow.
    pub program: u32,
    /// True where the words of the block are passed as arguments.
    pub arguments: bool,
}
