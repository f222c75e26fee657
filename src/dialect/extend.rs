//! Tables that extend another: a base has the rows that a family shares, and what extends it says what differs.
//!
//! A row of the extending table stands for the base's row of its name. A base's row says for each control where that
//! control's own manual has it: a control that it does not name has the row unconfirmed.

use super::check::Tables;
use super::load;
use super::reader::{Placed, Reader, closest};
use super::{Names, Numbers, Row, Text};
use std::ops::Range;
use toml::Spanned;
use toml::de::DeTable;

/// A table that others extend, and that is no control by itself.
#[derive(Clone, Copy, Debug)]
pub struct Base<'t> {
    /// Its name, as `extends` takes it.
    pub name: &'t str,
    /// Where it lies in the repository.
    pub file: &'t str,
    /// Its text.
    pub text: &'t str,
    /// What its text says, where that is kept for all tables that extend it.
    pub document: Option<fn() -> Option<&'static DeTable<'static>>>,
}

/// What a table has in all.
#[derive(Default)]
pub(super) struct Whole {
    pub numbers: Option<Placed<Numbers>>,
    pub text: Option<Placed<Text>>,
    pub names: Option<Placed<Names>>,
    pub tables: Tables,
}

/// The bases that a table may extend. Places in them count on from the end of its own text, in this order.
pub(super) struct Bases<'t> {
    pub all: &'t [Base<'t>],
    /// The length of the table's own text.
    pub own: usize,
}

impl<'t> Bases<'t> {
    fn find(&self, name: &str) -> Option<(Base<'t>, usize)> {
        let mut start = self.own;
        for base in self.all {
            if base.name == name {
                return Some((*base, start));
            }
            start += base.text.len();
        }
        None
    }
}

/// A row that the control lacks although the base has it.
struct Without {
    fact: String,
    place: Range<usize>,
    used: bool,
}

/// Reads what a document says, laid over what it extends.
pub(super) fn read(reader: &mut Reader, document: &mut DeTable<'_>, bases: &Bases<'_>) -> Whole {
    over(reader, document, bases, &mut Vec::new())
}

fn over(reader: &mut Reader, document: &mut DeTable<'_>, bases: &Bases<'_>, seen: &mut Vec<String>) -> Whole {
    let extends: Option<Spanned<String>> = reader.take(document, "extends");
    let without: Vec<Spanned<String>> = reader.take(document, "without").unwrap_or_default();
    let mut without: Vec<Without> = without
        .into_iter()
        .map(|fact| Without { place: reader.placed(fact.span()), fact: fact.into_inner(), used: false })
        .collect();
    let own = load::sections(reader, document);
    let base = extends.and_then(|extends| extended(reader, &extends, bases, seen));
    let whole = match base {
        Some(base) => lay(reader, own, base, &mut without),
        None => own,
    };
    for left in without.iter().filter(|row| !row.used) {
        let message = format!("there is no row '{}' to leave out", left.fact);
        reader.fault_at(left.place.clone(), message, "name a row of the table that this one extends");
    }
    whole
}

/// What the named base has, its own bases under it.
fn extended(
    reader: &mut Reader,
    extends: &Spanned<String>,
    bases: &Bases<'_>,
    seen: &mut Vec<String>,
) -> Option<Whole> {
    let name = extends.get_ref();
    let Some((base, start)) = bases.find(name) else {
        let help = match closest(name, bases.all.iter().map(|base| base.name)) {
            Some(near) => format!("did you mean '{near}'?"),
            None => "the tables that can be extended are listed in src/dialect/registry.rs".into(),
        };
        reader.fault(extends.span(), format!("no table '{name}' can be extended"), help);
        return None;
    };
    if seen.contains(name) {
        reader.fault(extends.span(), format!("'{name}' extends itself"), "take 'extends' out of one of them");
        return None;
    }
    seen.push(name.clone());
    let outer = reader.enter(base.name, start);
    let kept = base.document.and_then(|document| document());
    let mut document = kept.cloned().unwrap_or_else(|| reader.document(base.text));
    reader.known_keys(&document, &load::base_keys());
    for key in ["name", "title"] {
        let _: Option<String> = reader.require(&mut document, key);
    }
    let whole = over(reader, &mut document, bases, seen);
    reader.leave(outer);
    Some(whole)
}

fn lay(reader: &mut Reader, own: Whole, base: Whole, without: &mut [Without]) -> Whole {
    let mut lay = Lay { reader, without };
    let (mine, its) = (own.tables, base.tables);
    Whole {
        numbers: own.numbers.or(base.numbers),
        text: own.text.or(base.text),
        names: own.names.or(base.names),
        tables: Tables {
            forms: lay.rows(mine.forms, its.forms),
            limits: lay.rows(mine.limits, its.limits),
            forbidden: lay.rows(mine.forbidden, its.forbidden),
            operators: lay.rows(mine.operators, its.operators),
            functions: lay.rows(mine.functions, its.functions),
            statements: lay.rows(mine.statements, its.statements),
            behaviours: lay.rows(mine.behaviours, its.behaviours),
            variables: lay.rows(mine.variables, its.variables),
            matters: lay.rows(mine.matters, its.matters),
            in_use: lay.rows(mine.in_use, its.in_use),
            same_cells: lay.rows(mine.same_cells, its.same_cells),
            system: lay.rows(mine.system, its.system),
            words: lay.rows(mine.words, its.words),
            codes: lay.rows(mine.codes, its.codes),
            arguments: lay.rows(mine.arguments, its.arguments),
            settings: lay.rows(mine.settings, its.settings),
        },
    }
}

struct Lay<'r> {
    reader: &'r mut Reader,
    without: &'r mut [Without],
}

impl Lay<'_> {
    /// The base's rows that nothing stands for, then the table's own.
    fn rows<T: Row + PartialEq + Clone>(
        &mut self,
        own: Vec<Placed<T>>,
        base: Vec<Placed<T>>,
    ) -> Vec<Placed<T>> {
        let mut rows = Vec::with_capacity(own.len() + base.len());
        let keys: Vec<String> = own.iter().map(|row| row.row.full_key()).collect();
        for placed in base {
            let (key, fact) = (placed.row.full_key(), placed.row.fact());
            let left_out = self.without.iter_mut().filter(|row| row.fact == fact);
            let left_out = left_out.map(|row| row.used = true).count() > 0;
            let stands_for = own.iter().zip(&keys).filter(|(_, own)| **own == key);
            let overridden =
                stands_for.map(|(row, _)| self.check_differs(row, &placed.row, left_out)).count() > 0;
            if !left_out && !overridden {
                rows.push(placed);
            }
        }
        rows.extend(own);
        rows
    }

    /// A row that says what the base's says is one too many.
    fn check_differs<T: Row + PartialEq + Clone>(&mut self, own: &Placed<T>, base: &T, left_out: bool) {
        let mut same = base.clone();
        same.origin_mut().table = own.row.origin().table.clone();
        let fact = base.fact();
        if left_out {
            let message = format!("'{fact}' is left out by 'without', and stands here");
            self.reader.fault_at(own.place.clone(), message, "take it out of 'without'");
        } else if same == own.row {
            let table = base.origin().table.clone().unwrap_or_default();
            let message = format!("'{fact}' says what the row of '{table}' says");
            self.reader.fault_at(own.place.clone(), message, "take the row out here");
        }
    }
}
