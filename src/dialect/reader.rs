//! Reads TOML tables row by row, so that each fault is reported at its place
//! and one fault does not hide the next.

use super::origin::{KEYS, Written};
use super::wanted::{as_toml, in_words};
use super::{Origin, Row};
use crate::diag::{Code, Diagnostic};
use crate::text::{LineIndex, Span, shown};
use serde::Deserialize;
use serde::de::{DeserializeOwned, Deserializer, Visitor};
use std::collections::BTreeMap;
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
    /// The control whose table is read: of several sources its own counts.
    pub control: String,
    /// The base that is read, and where its places begin.
    base: Option<(String, usize)>,
}

/// What a base's row says of one control's source.
#[derive(Deserialize)]
#[serde(
    untagged,
    expecting = "a source is its text, or a table of source, confirmed, common, cites and note"
)]
enum Source {
    Text(String),
    Of(Written),
}

impl Reader {
    pub fn new(code: Code) -> Self {
        Self { code, faults: Vec::new(), control: String::new(), base: None }
    }

    /// Goes into a base whose places begin at `start`; gives what [`Reader::leave`] takes.
    pub fn enter(&mut self, base: &str, start: usize) -> Option<(String, usize)> {
        self.base.replace((base.into(), start))
    }

    /// Goes back to the table that extends the base.
    pub fn leave(&mut self, outer: Option<(String, usize)>) {
        self.base = outer;
    }

    /// A place of the text that is read as one of all texts.
    pub fn placed(&self, place: Range<usize>) -> Range<usize> {
        let start = self.base.as_ref().map_or(0, |(_, start)| *start);
        place.start + start..place.end + start
    }

    /// Notes a fault in the text that is read.
    pub fn fault(&mut self, place: Range<usize>, message: impl Into<Arc<str>>, help: impl Into<Arc<str>>) {
        self.fault_at(self.placed(place), message, help);
    }

    /// Notes a fault at a place of all texts.
    pub fn fault_at(&mut self, place: Range<usize>, message: impl Into<Arc<str>>, help: impl Into<Arc<str>>) {
        let offset = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        let span = Span::new(offset(place.start), offset(place.end));
        self.faults.push(Diagnostic::new(self.code, span, message).with_help(help));
    }

    /// The whole document; an empty one where it is not TOML at all.
    pub fn document<'t>(&mut self, text: &'t str) -> DeTable<'t> {
        match DeTable::parse(text) {
            Ok(document) => document.into_inner(),
            Err(error) => {
                let place = error.span().unwrap_or(0..0);
                let at = place.start.min(text.len());
                let start = text.get(..at).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
                let line = text.get(start..).and_then(|rest| rest.lines().next()).unwrap_or_default();
                self.fault(place, error.message(), as_toml(error.message(), line));
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
                match self.code {
                    Code::MachineProfile => {
                        self.fault(
                            at,
                            in_words(error.message()),
                            "docs/profiles.md says what a profile takes",
                        );
                    }
                    _ => self.fault(at, error.message(), "see dialects/README.md for what the column takes"),
                }
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
        known.extend(KEYS);
        let before = self.faults.len();
        self.known_keys(&table, &known);
        if self.faults.len() > before {
            return None;
        }
        let mut origin = DeTable::new();
        for &key in KEYS {
            if let Some((key, value)) = table.remove_entry(key) {
                origin.insert(key, value);
            }
        }
        let origin = self.origin(place.clone(), origin);
        let mut row = self.value::<T>(Spanned::new(place.clone(), DeValue::Table(table)))?;
        *row.origin_mut() = origin?;
        Some(Placed { row, place: self.placed(place) })
    }

    /// Where a row comes from. In a base each control has a source of its own, which is its text, or a table of
    /// `source`, `confirmed`, `common` and `note` where these are its own too.
    fn origin(&mut self, place: Range<usize>, mut table: DeTable<'_>) -> Option<Origin> {
        let by_control = table.get("source").is_some_and(|source| source.get_ref().is_table());
        if !by_control {
            let written = self.value::<Written>(Spanned::new(place.clone(), DeValue::Table(table)))?;
            let origin = self.judged(place.clone(), written)?;
            if self.base.is_some() && origin.is_settled() {
                let help = "write source = { NAME = \"...\" } with the source of each control";
                self.fault(place, "a row of a base that is settled has a source for each control", help);
            }
            return Some(Origin { table: self.base.as_ref().map(|(base, _)| base.clone()), ..origin });
        }
        let Some((base, _)) = self.base.clone() else {
            self.fault(
                place,
                "a source for each control stands in a base",
                "write the source of this control",
            );
            return None;
        };
        let mut sources: BTreeMap<String, Source> = self.take(&mut table, "source")?;
        let shared = self.value::<Written>(Spanned::new(place.clone(), DeValue::Table(table)))?;
        let written = match sources.remove(&self.control) {
            Some(Source::Of(written)) => written,
            Some(Source::Text(source)) => Written { source: Some(source), ..shared },
            None => {
                let named: Vec<&str> = sources.keys().map(String::as_str).collect();
                let note =
                    format!("known of {}, and no source of {} says so", named.join(", "), self.control);
                let source = Some("another control".into());
                Written { source, confirmed: Some(false), note: Some(note), ..Written::default() }
            }
        };
        Some(Origin { table: Some(base), ..self.judged(place, written)? })
    }

    /// How sure a row is by what is written of it.
    fn judged(&mut self, place: Range<usize>, written: Written) -> Option<Origin> {
        match written.judged() {
            Ok(origin) => Some(origin),
            Err((message, help)) => {
                self.fault(place, message, help);
                None
            }
        }
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

/// The faults of a table and of its bases as text: the texts that their places count through, with their files.
pub fn faults_of_files(files: &[(&str, &str)], faults: &[Diagnostic]) -> String {
    let mut out = String::new();
    for fault in faults {
        let mut start = 0;
        let mut files = files.iter().copied();
        let found = files.find_map(|(file, text)| {
            let here = fault.span.start as usize - start;
            start += text.len();
            ((fault.span.start as usize) < start).then_some((file, text, here))
        });
        let (file, text, here) = found.unwrap_or(("", "", 0));
        let at = u32::try_from(here).unwrap_or(u32::MAX);
        let placed = Diagnostic { span: Span::new(at, at), ..fault.clone() };
        out += &faults_as_text(file, text, std::slice::from_ref(&placed));
    }
    out
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
