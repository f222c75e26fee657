//! Machine profiles: what one machine's owner bought and set.

use super::reader::Reader;
use super::start::Start;
use super::{BareLength, SiteCode};
use crate::diag::{Code, Diagnostic};
use serde::Deserialize;
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// A machine profile (`machines/*.toml`, or the shop's own). Whatever it leaves
/// out is as the dialect's table has it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Profile {
    /// The dialect it is for.
    pub dialect: String,
    /// A profile whose answers count where this one has none: a path from the folder of this one's file.
    pub extends: Option<std::path::PathBuf>,
    /// Name for people.
    pub title: Option<String>,
    /// The kind of machine.
    pub machine: Option<Machine>,
    /// What becomes of output that the machine has no way to send; absent where a program with output is refused.
    pub outputs: Option<Outputs>,
    /// The units its programs are in where no code says so.
    pub units: Option<Units>,
    /// What a number without a decimal point counts.
    pub decimal_point: Option<DecimalPoint>,
    /// False where programs that are written for it get no line that says what they were made of.
    pub head: Option<bool>,
    /// How the lines of programs end that are written for it; absent where they end as those of the source.
    pub line_ends: Option<LineEnds>,
    /// The options that were bought; absent where it is not known which.
    pub options: Option<Vec<String>>,
    /// How many tool offsets the machine has.
    pub offsets: Option<u32>,
    /// How many additional work offsets the machine has.
    pub work_offsets: Option<u32>,
    /// Its axes, in the order of the control's axis numbers: `["X", "Z", "C", "Y"]`.
    pub axes: Option<Vec<Axis>>,
    /// Parameters of the control, by number: `6058 = 383`, `"6004.0" = 1`.
    pub parameters: BTreeMap<String, Plain>,
    /// Settings of the control, by number or name.
    pub settings: BTreeMap<String, Plain>,
    /// Answers to questions of behaviour, found on the machine: `divide.by.zero = "alarm"`. They count instead of the
    /// table's, and as confirmed.
    pub behaviours: BTreeMap<String, Plain>,
    /// Limits, found on the machine: `call.all = 8`. They count instead of the table's, and as confirmed.
    pub limits: BTreeMap<String, u32>,
    /// What is in force when a program begins.
    pub start: Start,
    /// Variables that programs must not be given: `#149`, `#500-#549`, `VX`.
    pub reserved: Vec<String>,
    /// The variables that there are; absent where the table's classes all are. Ones that the table has not say what they are:
    /// `#98000-#98499 retained`.
    pub variables: Option<Vec<String>>,
    /// Programs that stand in the machine and do the same as those of their numbers on the machine that calls of them come
    /// from: `O9810`, `O9700-O9999`, `O910002 as O8006`.
    pub programs: Vec<String>,
    /// The numbers that programs get there which have none, or another one, on the source: `O1000-O1999`.
    pub program_numbers: Vec<String>,
    /// Places in machine coordinates of the machine that programs come from, and where each lies on this one:
    /// `X-11. Z-13. as X-300. Z-200.`.
    pub machine_places: Vec<String>,
    /// The variables by which those programs give their results, and their numbers on the machine that calls come from:
    /// `#135-#149 as #185-#199`.
    pub standing_results: Vec<String>,
    /// Facts that the shop has checked, by the name that diagnostics give them.
    pub confirm: Vec<String>,
    /// Codes that the machine's builder or the shop defined: rows of `[[site]]`, and lines of `[codes]`.
    pub site: Vec<SiteCode>,
    /// What is wired to the inputs and outputs.
    pub signal: Vec<Signal>,
    /// The file that it was read from, for reports.
    #[serde(skip)]
    pub file: Option<std::path::PathBuf>,
    /// The files of the profiles that it extends, the nearest first.
    #[serde(skip)]
    pub bases: Vec<std::path::PathBuf>,
    /// Where the file's `confirm`, `parameters`, ... stand, for reports.
    #[serde(skip)]
    pub(super) places: BTreeMap<String, std::ops::Range<usize>>,
}

/// What becomes of output that a machine has no way to send.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outputs {
    /// It is left out: nobody reads it.
    Omit,
}

/// How lines end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LineEnds {
    /// With a line feed.
    Lf,
    /// With a carriage return and a line feed.
    Crlf,
    /// With a carriage return.
    Cr,
}

/// The kind of machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Machine {
    /// Milling machine or machining centre.
    Mill,
    /// Lathe.
    Lathe,
}

impl Machine {
    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Machine::Mill => "mill",
            Machine::Lathe => "lathe",
        }
    }
}

/// An axis, in the order of the common axis numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[allow(missing_docs)]
pub enum Axis {
    X = 1,
    Y,
    Z,
    A,
    B,
    C,
    U,
    V,
    W,
    E,
}

impl Axis {
    /// All of them: the order of a mill's axis numbers.
    pub const ALL: [Axis; 9] =
        [Axis::X, Axis::Y, Axis::Z, Axis::A, Axis::B, Axis::C, Axis::U, Axis::V, Axis::W];

    /// Its common number: 1 for X.
    pub const fn number(self) -> u32 {
        self as u32
    }
}

/// The units of lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Units {
    /// Inches.
    Inch,
    /// Millimetres.
    #[serde(alias = "mm")]
    Metric,
}

/// How a number without a decimal point is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DecimalPoint {
    /// As on a pocket calculator: whole units.
    Calculator,
    /// In least increments.
    Increments,
}

impl From<DecimalPoint> for BareLength {
    fn from(point: DecimalPoint) -> Self {
        match point {
            DecimalPoint::Calculator => BareLength::Units,
            DecimalPoint::Increments => BareLength::Increments,
        }
    }
}

/// A value of a parameter or setting.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "a value is true or false, a number, or a word in quotes")]
pub enum Plain {
    /// True or false, which is 1 or 0.
    Truth(bool),
    /// A whole number.
    Whole(i64),
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

impl std::fmt::Display for Plain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Plain::Truth(truth) => write!(f, "{}", u8::from(*truth)),
            Plain::Whole(number) => write!(f, "{number}"),
            Plain::Number(number) => write!(f, "{number}"),
            Plain::Word(word) => f.write_str(word),
        }
    }
}

/// An input or output of the control, and the number that the shop's programs know its wire by.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// The control's input: 1 is `I(1)`.
    #[serde(default)]
    pub input: Option<u32>,
    /// The control's output.
    #[serde(default)]
    pub output: Option<u32>,
    /// The number of the signal on the other control: 24 is `#1124`.
    pub number: u32,
    /// What the control shows when the signal is on: 0 or 1; absent where it is as the table has it.
    #[serde(default)]
    pub on: Option<u32>,
    /// What it is, in words.
    #[serde(default)]
    pub text: Option<String>,
}

/// A run of variables in a profile: `#500-#549`, `V90`, `VX`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VariableRun {
    /// The name before the number.
    pub name: String,
    /// First number; a letter variable has its letter's number, 1 for A.
    pub first: u32,
    /// Last number.
    pub last: u32,
    /// True for a letter variable.
    pub letter: bool,
    /// What it is, where the table has no such variables: `common` or `retained`; `none` where the machine has none of these.
    pub kind: Option<String>,
}

impl VariableRun {
    /// Reads a run; none if it is not one.
    pub fn read(text: &str) -> Option<Self> {
        let (text, kind) = match text.trim().split_once(' ') {
            Some((text, kind)) => (text, Some(kind.trim().to_owned())),
            None => (text.trim(), None),
        };
        let (from, to) = text.split_once('-').unwrap_or((text, text));
        let (name, first, letter) = one(from.trim())?;
        let (other, last, other_letter) =
            one(to.trim()).or_else(|| Some((name, to.trim().parse().ok()?, letter)))?;
        let fits = name == other && letter == other_letter && first <= last;
        fits.then(|| Self { name: name.into(), first, last, letter, kind })
    }

    /// True of variables that the machine does not have.
    pub fn is_missing(&self) -> bool {
        self.kind.as_deref() == Some("none")
    }

    /// True where the run holds the variable.
    pub fn holds(&self, name: &str, number: u32, letter: bool) -> bool {
        self.name == name && self.letter == letter && (self.first..=self.last).contains(&number)
    }
}

/// `#500`, or `VX` as the letter variable X of V.
fn one(text: &str) -> Option<(&str, u32, bool)> {
    let digits = text.find(|c: char| c.is_ascii_digit()).unwrap_or(text.len());
    let (name, number) = text.split_at_checked(digits)?;
    if !number.is_empty() {
        let number = number.parse().ok()?;
        return (!name.is_empty()).then_some((name, number, false));
    }
    let letter = name.chars().last().filter(char::is_ascii_uppercase)?;
    let name = name.get(..name.len().checked_sub(1)?)?;
    (!name.is_empty()).then(|| (name, u32::from(letter) - u32::from('A') + 1, true))
}

impl Profile {
    /// Reads a profile. What it says of its dialect is checked by `Control::new`.
    pub fn read(text: &str) -> Result<Self, Vec<Diagnostic>> {
        let mut reader = Reader::new(Code::MachineProfile);
        let mut document = reader.document(text);
        for key in ["parameters", "settings", "behaviours", "limits"] {
            if let Some(DeValue::Table(table)) = document.get_mut(key).map(|value| value.get_mut()) {
                flatten(table, 0);
            }
        }
        let mut places = places(&document);
        super::site_lines::join(&mut document, &mut reader);
        places.extend(self::places(&document));
        let whole = toml::Spanned::new(0..0, DeValue::Table(document));
        let profile = reader.value::<Profile>(whole);
        match profile {
            Some(profile) if reader.faults.is_empty() => Ok(Self { places, ..profile }),
            _ => Err(reader.faults),
        }
    }
}

impl Profile {
    /// Where an entry stands in the text that it was read from: `confirm`, or `settings:162`.
    pub fn place(&self, entry: &str) -> Option<std::ops::Range<usize>> {
        self.places.get(entry).cloned()
    }

    /// What it says, wherever that stood.
    #[must_use]
    pub fn without_places(mut self) -> Self {
        self.places.clear();
        self
    }
}

/// `6004.0 = 1` reaches us as a table in a table: it is the parameter `6004.0`. So is `divide.by.zero = "alarm"`.
fn flatten(table: &mut DeTable<'_>, depth: u32) {
    for (key, value) in std::mem::take(table) {
        let place = value.span();
        match value.into_inner() {
            DeValue::Table(mut inner) if depth < 8 => {
                flatten(&mut inner, depth + 1);
                for (rest, value) in inner {
                    let name = format!("{}.{}", key.get_ref(), rest.get_ref());
                    table.insert(toml::Spanned::new(rest.span(), name.into()), value);
                }
            }
            value => {
                table.insert(key, toml::Spanned::new(place, value));
            }
        }
    }
}

/// Where each entry of a profile stands, by `section:entry`.
fn places(document: &DeTable<'_>) -> BTreeMap<String, std::ops::Range<usize>> {
    let mut places = BTreeMap::new();
    for (key, value) in document {
        let section = key.get_ref();
        places.insert(section.to_string(), value.span());
        match value.get_ref() {
            DeValue::Table(table) => {
                for name in table.keys() {
                    places.insert(format!("{section}:{}", name.get_ref()), name.span());
                }
            }
            DeValue::Array(entries) => {
                for entry in entries {
                    let name =
                        entry.get_ref().as_str().or_else(|| entry.get_ref().get("code")?.get_ref().as_str());
                    if let Some(name) = name {
                        places.insert(format!("{section}:{name}"), entry.span());
                    }
                }
            }
            _ => {}
        }
    }
    places
}
