//! The list of dialects: the one place where a dialect is added, and so the one
//! that names modules further right than its own.

use super::load::load_checked;
use super::{Base, Dialect, faults_of_files, load};
use crate::control::{self, Execute};
use crate::diag::Diagnostic;
use crate::emit::{self, Emit};
use crate::lower::{self, Cuts, Lower};
use crate::syntax::{self, Parser};
use std::sync::OnceLock;
use toml::Spanned;
use toml::de::DeTable;

/// A dialect: its table, and the modules that know it by name.
pub struct Entry {
    /// Short name, as `--from` takes it.
    pub name: &'static str,
    /// Where its table lies in the repository.
    pub file: &'static str,
    /// Its table.
    pub table: &'static str,
    /// Reads its blocks.
    pub parse: Parser,
    /// Reads its blocks without their tokens.
    pub parse_items: Parser,
    /// Reads its blocks for their faults: it may leave out those that have none.
    pub parse_faults: Parser,
    /// Lowers its programs.
    pub lower: Lower,
    /// Cuts files that need not be lowered whole.
    pub cuts: Cuts,
    /// Writes programs for it; absent while it is a source only.
    pub emit: Option<Emit>,
    /// Runs programs as its control would; absent where there is no emulated control.
    pub execute: Option<Execute>,
    /// True where the emulated control reads blocks when a run comes to them, if they are not held.
    pub by_need: bool,
    loaded: OnceLock<Result<Dialect, Vec<Diagnostic>>>,
}

/// A line of a table.
#[derive(Default, serde::Deserialize)]
struct Head {
    extensions: Vec<String>,
}

macro_rules! entry {
    ($name:literal, $parse:expr, $parse_items:expr, $parse_faults:expr, $lower:expr, $cuts:expr, $emit:expr, $execute:expr, $by_need:expr) => {
        Entry {
            name: $name,
            file: concat!("dialects/", $name, ".toml"),
            table: include_str!(concat!("../../dialects/", $name, ".toml")),
            parse: $parse,
            parse_items: $parse_items,
            parse_faults: $parse_faults,
            lower: $lower,
            cuts: $cuts,
            emit: $emit,
            execute: $execute,
            by_need: $by_need,
            loaded: OnceLock::new(),
        }
    };
}

static ENTRIES: [Entry; 4] = [
    entry!(
        "fadal",
        syntax::fadal::parse_line,
        syntax::fadal::parse_items,
        syntax::fadal::parse_items,
        lower::fadal::lower,
        |_, _| Vec::new(),
        Some(emit::fadal::emit),
        Some(control::fadal::execute),
        false
    ),
    entry!(
        "fanuc",
        syntax::fanuc::parse_line,
        syntax::fanuc::parse_items,
        syntax::fanuc::parse_faults,
        lower::fanuc::lower,
        lower::fanuc::cuts,
        Some(emit::fanuc::emit),
        Some(control::fanuc::execute),
        true
    ),
    entry!(
        "haas",
        syntax::haas::parse_line,
        syntax::haas::parse_items,
        syntax::haas::parse_faults,
        lower::haas::lower,
        lower::haas::cuts,
        Some(emit::haas::emit),
        Some(control::haas::execute),
        true
    ),
    entry!(
        "cc100",
        syntax::cc100::parse_line,
        syntax::cc100::parse_items,
        syntax::cc100::parse_items,
        lower::cc100::lower,
        |_, _| Vec::new(),
        Some(emit::cc100::emit),
        Some(control::cc100::execute),
        false
    ),
];

/// The tables that others extend.
pub static BASES: [Base<'static>; 1] =
    [Base { name: "macro_b", file: "dialects/macro_b.toml", text: MACRO_B, document: Some(macro_b) }];

const MACRO_B: &str = include_str!("../../dialects/macro_b.toml");

/// The document of the base, read once for all tables; none if it is no TOML, which whoever reads it by itself is told.
fn macro_b() -> Option<&'static DeTable<'static>> {
    static DOCUMENT: OnceLock<Option<DeTable<'static>>> = OnceLock::new();
    DOCUMENT.get_or_init(|| DeTable::parse(MACRO_B).ok().map(Spanned::into_inner)).as_ref()
}

/// Every dialect.
pub fn all() -> &'static [Entry] {
    &ENTRIES
}

/// The dialect with this short name.
pub fn find(name: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.name == name)
}

impl Entry {
    /// Its facts. A shipped table loads (a test says so); the faults are for one that is being edited. An optimized build
    /// takes it that its rows do not contradict each other: [`Entry::check`] says whether they do.
    pub fn dialect(&self) -> Result<&Dialect, &[Diagnostic]> {
        let load = if cfg!(debug_assertions) { load } else { load_checked };
        self.loaded.get_or_init(|| load(self.table, &BASES)).as_ref().map_err(Vec::as_slice)
    }

    /// Holds the rows of its table against each other.
    ///
    /// # Errors
    /// Every fault of it.
    pub fn check(&self) -> Result<(), Vec<Diagnostic>> {
        load(self.table, &BASES).map(drop)
    }
}

impl Entry {
    /// The endings of its programs' files. One line of its table says them, and the rest is not read.
    pub fn endings(&self) -> Vec<String> {
        let line = self.table.lines().find(|line| line.starts_with("extensions"));
        line.and_then(|line| toml::from_str::<Head>(line).ok()).unwrap_or_default().extensions
    }

    /// The texts that its facts are read from, with their files: its table, and those that tables extend.
    pub fn files(&self) -> Vec<(&'static str, &'static str)> {
        let bases = BASES.iter().map(|base| (base.file, base.text));
        std::iter::once((self.file, self.table)).chain(bases).collect()
    }

    /// The faults of its table and of what it extends, one a line.
    pub fn faults_as_text(&self, faults: &[Diagnostic]) -> String {
        faults_of_files(&self.files(), faults)
    }
}

impl std::fmt::Debug for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Entry({})", self.name)
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
