//! Where the entries of a project file stand, for what is said of them.

use crate::text::LineIndex;
use std::collections::BTreeMap;
use toml::de::{DeTable, DeValue};

/// Tables in tables that are looked into: no key of a project file stands deeper.
const DEPTH: usize = 6;

/// The line and the column of each key of a project file, by the names from the root to it. An entry of a list has its
/// number, from 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ProjectPlaces {
    of: BTreeMap<Vec<String>, (u32, u32)>,
}

impl ProjectPlaces {
    /// The places of a file's text.
    pub(super) fn read(text: &str) -> Self {
        let mut places = Self::default();
        if let Ok(document) = DeTable::parse(text) {
            let lines = LineIndex::new(text.as_bytes());
            places.table(&[], document.get_ref(), &lines);
        }
        places
    }

    /// Where an entry stands, or the nearest one around it.
    #[must_use]
    pub fn at(&self, names: &[&str]) -> Option<(u32, u32)> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        (1..=names.len()).rev().find_map(|count| self.of.get(names.get(..count)?).copied())
    }

    /// The place as it stands before a message: `macroglot.toml:6:8`.
    #[must_use]
    pub fn named(&self, names: &[&str]) -> String {
        let place = self.at(names).map_or_else(String::new, |(line, column)| format!(":{line}:{column}"));
        format!("{}{place}", super::Project::NAME)
    }

    fn table(&mut self, names: &[String], table: &DeTable<'_>, lines: &LineIndex) {
        for (key, value) in table {
            let names: Vec<String> = names.iter().cloned().chain([key.get_ref().to_string()]).collect();
            self.put(&names, key.span().start, lines);
            self.inner(&names, value.get_ref(), lines);
        }
    }

    fn inner(&mut self, names: &[String], value: &DeValue<'_>, lines: &LineIndex) {
        if names.len() >= DEPTH {
            return;
        }
        match value {
            DeValue::Table(table) => self.table(names, table, lines),
            DeValue::Array(entries) => {
                for (number, entry) in entries.iter().enumerate() {
                    let names: Vec<String> = names.iter().cloned().chain([number.to_string()]).collect();
                    self.put(&names, entry.span().start, lines);
                    self.inner(&names, entry.get_ref(), lines);
                }
            }
            _ => {}
        }
    }

    fn put(&mut self, names: &[String], at: usize, lines: &LineIndex) {
        self.of.insert(names.to_vec(), lines.place(u32::try_from(at).unwrap_or(u32::MAX)));
    }
}
