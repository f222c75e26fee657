//! Reads TOML tables row by row, so that each fault is reported at its place
//! and one fault does not hide the next.

use super::{Origin, Row};
use crate::diag::{Code, Diagnostic};
use crate::text::{LineIndex, Span, shown};
use serde::de::{DeserializeOwned, Deserializer, Visitor};
use std::ops::Range;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// A row and the place it was read from.
#[derive(Clone, Debug)]
pub(super) struct Placed<T> {
    pub row: T,
    pub place: Range<usize>,
}

/// Collects the faults of one file.
pub(super) struct Reader {
    /// The code that the faults get.
    pub code: Code,
    /// What was found so far.
    pub faults: Vec<Diagnostic>,
}

const ORIGIN: &[&str] = &["source", "confirmed", "note"];

impl Reader {
    pub fn new(code: Code) -> Self {
        Self { code, faults: Vec::new() }
    }

    /// Notes a fault.
    pub fn fault(&mut self, place: Range<usize>, message: impl Into<Arc<str>>, help: impl Into<Arc<str>>) {
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        let span = Span::new(offset(place.start), offset(place.end));
        self.faults.push(Diagnostic::new(self.code, span, message).with_help(help));
    }

    /// The whole document; an empty one where it is not TOML at all.
    pub fn document<'t>(&mut self, text: &'t str) -> DeTable<'t> {
        match DeTable::parse(text) {
            Ok(document) => document.into_inner(),
            Err(error) => {
                self.fault(error.span().unwrap_or(0..0), error.message(), "write it as TOML");
                DeTable::new()
            }
        }
    }

    /// Reports the keys of a table that nothing reads.
    pub fn known_keys(&mut self, table: &DeTable<'_>, known: &[&str]) {
        for key in table.keys().filter(|key| !known.contains(&key.get_ref().as_ref())) {
            let name = key.get_ref();
            let help = match closest(name, known.iter().copied()) {
                Some(near) => format!("did you mean '{near}'?"),
                None => format!("known here: {}", known.join(", ")),
            };
            self.fault(key.span(), format!("unknown key '{name}'"), help);
        }
    }

    /// Reads a value of any type.
    pub fn value<T: DeserializeOwned>(&mut self, value: Spanned<DeValue<'_>>) -> Option<T> {
        let place = value.span();
        if let Some(table) = value.get_ref().as_table()
            && let known @ [_, ..] = fields_of::<T>()
        {
            let before = self.faults.len();
            self.known_keys(table, known);
            if self.faults.len() > before {
                return None;
            }
        }
        match T::deserialize(ValueDeserializer::from(value)) {
            Ok(value) => Some(value),
            Err(error) => {
                let at = error.span().filter(|span| !span.is_empty()).unwrap_or(place);
                self.fault(at, error.message(), "see dialects/README.md for what the column takes");
                None
            }
        }
    }

    /// Takes one key out of a table and reads it.
    pub fn take<T: DeserializeOwned>(&mut self, table: &mut DeTable<'_>, key: &str) -> Option<T> {
        let value = table.remove(key)?;
        self.value(value)
    }

    /// Takes one key out of a table and reads it; its absence is a fault.
    pub fn require<T: DeserializeOwned>(&mut self, table: &mut DeTable<'_>, key: &str) -> Option<T> {
        if !table.contains_key(key) {
            self.fault(
                0..0,
                format!("'{key}' is missing"),
                format!("add '{key} = ...' at the head of the file"),
            );
        }
        self.take(table, key)
    }

    /// Reads a row: its origin's keys stand among its own.
    pub fn row<T: Row>(&mut self, value: Spanned<DeValue<'_>>) -> Option<Placed<T>> {
        let place = value.span();
        let DeValue::Table(mut table) = value.into_inner() else {
            self.fault(place, format!("a row of '{}' is a table", T::SECTION), "write { name = value, ... }");
            return None;
        };
        let mut known = fields_of::<T>().to_vec();
        known.extend(ORIGIN);
        let before = self.faults.len();
        self.known_keys(&table, &known);
        if self.faults.len() > before {
            return None;
        }
        let mut origin = DeTable::new();
        for &key in ORIGIN {
            if let Some((key, value)) = table.remove_entry(key) {
                origin.insert(key, value);
            }
        }
        let origin = self.value::<Origin>(Spanned::new(place.clone(), DeValue::Table(origin)));
        let mut row = self.value::<T>(Spanned::new(place.clone(), DeValue::Table(table)))?;
        *row.origin_mut() = origin?;
        Some(Placed { row, place })
    }

    /// Reads all rows of a section.
    pub fn rows<T: Row>(&mut self, document: &mut DeTable<'_>) -> Vec<Placed<T>> {
        let Some(section) = document.remove(T::SECTION) else { return Vec::new() };
        let place = section.span();
        match section.into_inner() {
            DeValue::Array(rows) => rows.into_iter().filter_map(|row| self.row(row)).collect(),
            _ => {
                self.fault(
                    place,
                    format!("'{}' is a list of rows", T::SECTION),
                    "write [ { ... }, { ... } ]",
                );
                Vec::new()
            }
        }
    }
}

/// The keys that a struct is read from; none for a type that is no struct.
fn fields_of<T: DeserializeOwned>() -> &'static [&'static str] {
    struct Probe<'f>(&'f mut &'static [&'static str]);

    impl<'de> Deserializer<'de> for Probe<'_> {
        type Error = serde::de::value::Error;

        fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
            Err(serde::de::Error::custom("only asked for its fields"))
        }

        fn deserialize_struct<V: Visitor<'de>>(
            self,
            _: &'static str,
            fields: &'static [&'static str],
            visitor: V,
        ) -> Result<V::Value, Self::Error> {
            *self.0 = fields;
            self.deserialize_any(visitor)
        }

        serde::forward_to_deserialize_any! {
            bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option
            unit unit_struct newtype_struct seq tuple tuple_struct map enum identifier ignored_any
        }
    }

    let mut fields: &'static [&'static str] = &[];
    let _ = T::deserialize(Probe(&mut fields));
    fields
}

/// The name that differs least from `name`, where that is little enough to be a slip.
pub(super) fn closest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    known
        .map(|candidate| (distance(name, candidate), candidate))
        .filter(|(distance, candidate)| *distance <= candidate.len().max(name.len()) / 3)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// How many characters must be put in, taken out or changed.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut corner = i;
        let mut left = i + 1;
        for (cell, y) in row.iter_mut().skip(1).zip(&b) {
            let above = *cell;
            left = (above + 1).min(left + 1).min(corner + usize::from(x != *y));
            corner = above;
            *cell = left;
        }
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
    }
    row.last().copied().unwrap_or(0)
}

/// The faults as text, one a line: file, line, what is wrong, what to do.
pub fn faults_as_text(file: &str, text: &str, faults: &[Diagnostic]) -> String {
    let lines = LineIndex::new(text.as_bytes());
    let mut out = String::new();
    for fault in faults {
        let (line, column) = lines.place(fault.span.start);
        let help = fault.help.as_ref().map_or_else(String::new, |help| format!(" ({help})"));
        let said = format!("{file}:{line}:{column}: {}: {}{help}", fault.code.number(), fault.message);
        out += &shown(&said);
        out.push('\n');
    }
    out
}
