//! Reads a dialect's table and refuses one that contradicts itself.

use super::check::{self, Tables};
use super::extend::{self, Base, Bases, Whole};
use super::reader::{Placed, Reader};
use super::{CodeMeaning, Dialect, Row};
use crate::diag::{Code, Diagnostic};
use toml::de::DeTable;

/// The sections and the plain keys of a table.
const KEYS: &[&str] = &[
    "name",
    "title",
    "family",
    "extensions",
    "advice",
    "extends",
    "without",
    "numbers",
    "text",
    "names",
    "forms",
    "limits",
    "forbidden",
    "operators",
    "functions",
    "statements",
    "behaviours",
    "variables",
    "matters",
    "in_use",
    "same_cells",
    "system",
    "words",
    "codes",
    "arguments",
    "settings",
];

/// What a base does not say: it is no control.
const OF_CONTROLS: &[&str] = &["family", "extensions", "advice"];

/// What a base may say.
pub(super) fn base_keys() -> Vec<&'static str> {
    KEYS.iter().copied().filter(|key| !OF_CONTROLS.contains(key)).collect()
}

/// Reads a table, laid over the base that it extends. All that is wrong comes back at once, each fault at its place in
/// `text`, or after its end in the texts of the bases.
pub fn load(text: &str, bases: &[Base<'_>]) -> Result<Dialect, Vec<Diagnostic>> {
    load_by(text, bases, check::all)
}

/// The same of a table that was checked before: its rows are not held against each other, a third of the work.
pub(super) fn load_checked(text: &str, bases: &[Base<'_>]) -> Result<Dialect, Vec<Diagnostic>> {
    load_by(text, bases, |_, _| {})
}

fn load_by(
    text: &str,
    bases: &[Base<'_>],
    check: impl FnOnce(&mut Reader, &Tables),
) -> Result<Dialect, Vec<Diagnostic>> {
    let mut reader = Reader::new(Code::DialectTable);
    let mut document = reader.document(text);
    let dialect = read(&mut reader, &mut document, &Bases { all: bases, own: text.len() }, check);
    match dialect {
        Some(dialect) if reader.faults.is_empty() => Ok(dialect),
        _ => Err(reader.faults),
    }
}

fn read(
    reader: &mut Reader,
    document: &mut DeTable<'_>,
    bases: &Bases<'_>,
    check: impl FnOnce(&mut Reader, &Tables),
) -> Option<Dialect> {
    reader.known_keys(document, KEYS);
    let name: Option<String> = reader.require(document, "name");
    let title = reader.require(document, "title");
    let family = reader.require(document, "family");
    let extensions = reader.take(document, "extensions").unwrap_or_default();
    let advice = reader.take(document, "advice");
    reader.control = name.clone().unwrap_or_default();
    let Whole { numbers, text, names, tables } = extend::read(reader, document, bases);
    let numbers = there(reader, numbers);
    let text = there(reader, text);
    let names = there(reader, names);
    check(reader, &tables);
    Some(Dialect {
        name: name?,
        title: title?,
        family: family?,
        extensions,
        advice,
        numbers: numbers?,
        text: text?,
        names: names?,
        forms: plain(tables.forms),
        limits: plain(tables.limits),
        forbidden: plain(tables.forbidden),
        operators: plain(tables.operators),
        functions: plain(tables.functions),
        statements: plain(tables.statements),
        behaviours: plain(tables.behaviours),
        variables: plain(tables.variables),
        matters: plain(tables.matters),
        in_use: plain(tables.in_use),
        same_cells: plain(tables.same_cells),
        system: plain(tables.system),
        words: plain(tables.words),
        codes: plain(tables.codes).into_iter().flat_map(spell_out).collect(),
        other_codes: Vec::new(),
        other_system: Vec::new(),
        arguments: plain(tables.arguments),
        settings: plain(tables.settings),
    })
}

/// The sections of a document.
pub(super) fn sections(reader: &mut Reader, document: &mut DeTable<'_>) -> Whole {
    Whole {
        numbers: only(reader, document),
        text: only(reader, document),
        names: only(reader, document),
        tables: Tables {
            forms: reader.rows(document),
            limits: reader.rows(document),
            forbidden: reader.rows(document),
            operators: reader.rows(document),
            functions: reader.rows(document),
            statements: reader.rows(document),
            behaviours: reader.rows(document),
            variables: reader.rows(document),
            matters: reader.rows(document),
            in_use: reader.rows(document),
            same_cells: reader.rows(document),
            system: reader.rows(document),
            words: reader.rows(document),
            codes: reader.rows(document),
            arguments: reader.rows(document),
            settings: reader.rows(document),
        },
    }
}

/// A section that is one row.
fn only<T: Row>(reader: &mut Reader, document: &mut DeTable<'_>) -> Option<Placed<T>> {
    let value = document.remove(T::SECTION)?;
    reader.row(value)
}

/// A section that must be there.
fn there<T: Row>(reader: &mut Reader, row: Option<Placed<T>>) -> Option<T> {
    if row.is_none() && reader.faults.is_empty() {
        reader.fault(0..0, format!("'{}' is missing", T::SECTION), format!("add '[{}]'", T::SECTION));
    }
    row.map(|row| row.row)
}

fn plain<T>(rows: Vec<Placed<T>>) -> Vec<T> {
    rows.into_iter().map(|placed| placed.row).collect()
}

/// A row for a run of codes, as one row a code.
fn spell_out(row: CodeMeaning) -> Vec<CodeMeaning> {
    let Some(through) = row.through else { return vec![row] };
    let Some(head) = row.head() else { return vec![row] };
    let first = head.whole();
    (first..=through)
        .map(|number| {
            let mut one = row.clone();
            one.through = None;
            one.code =
                row.code.replacen(&format!("{}{first}", head.letter), &format!("{}{number}", head.letter), 1);
            if let Some(counted) = row.counted
                && let Some(value) = one.fixed.get_mut(&counted)
            {
                *value += f64::from(number - first);
            }
            one
        })
        .collect()
}
