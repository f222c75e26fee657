//! What a program takes from outside: read off its text.

use super::names::{Side, class_of};
use crate::canon::Sys;
use crate::control::ProgramRef;
use crate::dialect::Control;
use crate::syntax::{
    BinaryOp, Expr, ExprKind, Index, Item, ItemKind, Row, TestSubject, VarRef, for_each_expr,
};
use std::collections::{BTreeMap, BTreeSet};

/// What a program takes from outside.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    /// The variables that are read before the text writes them.
    pub variables: Vec<Input>,
    /// Numbers that the program's conditions name, and their neighbours.
    pub numbers: Vec<f64>,
    /// State that the machine does not model and the program reads.
    pub cells: Vec<(Sys, Vec<u32>)>,
    /// True where a block can be skipped.
    pub skips: bool,
}

/// A variable that a run is started with.
#[derive(Clone, Debug)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// True where it may be vacant.
    pub nullable: bool,
    /// The numbers that it is compared with, and their neighbours; those are the values worth trying.
    pub values: Vec<f64>,
}

/// Reads a program.
pub fn inputs(side: &Side<'_>, program: ProgramRef) -> Inputs {
    let file = side.files.get(program.file);
    let blocks = file.and_then(|file| file.parsed.blocks.get(side.blocks(program))).unwrap_or_default();
    let mut reader = Reader::new(side.control);
    for block in blocks {
        reader.items(&block.items, true);
    }
    reader.finish()
}

struct Reader<'c> {
    control: &'c Control,
    written: BTreeSet<String>,
    order: Vec<String>,
    compared: BTreeMap<String, Vec<f64>>,
    numbers: Vec<f64>,
    cells: BTreeSet<(Sys, Vec<u32>)>,
    skips: bool,
}

impl<'c> Reader<'c> {
    fn new(control: &'c Control) -> Self {
        Self {
            control,
            written: BTreeSet::new(),
            order: Vec::new(),
            compared: BTreeMap::new(),
            numbers: Vec::new(),
            cells: BTreeSet::new(),
            skips: false,
        }
    }

    /// Goes through the items of a block; `sure` where they run whenever the block does.
    fn items(&mut self, items: &[Item], sure: bool) {
        for item in items {
            match &item.kind {
                ItemKind::Skip(_) => self.skips = true,
                ItemKind::If { condition, body, .. } => {
                    self.condition(condition);
                    self.items(body, false);
                }
                ItemKind::Do { condition: Some(condition), .. } => self.condition(condition),
                kind => {
                    for_each_expr(std::slice::from_ref(item), &mut |e| self.read_in(e));
                    self.plain(kind, sure);
                }
            }
        }
    }

    /// Variables that stand in statements as names, not as expressions.
    fn plain(&mut self, kind: &ItemKind, sure: bool) {
        match kind {
            ItemKind::Assign { target, .. } | ItemKind::Timer(target) => self.write(target, sure),
            ItemKind::Input { targets, .. } => targets.iter().for_each(|target| self.write(target, sure)),
            ItemKind::Step { target, .. } => self.read(target),
            ItemKind::Test(TestSubject::Variable(variable)) => {
                self.read(variable);
                self.compare(variable, &[0.0]);
            }
            ItemKind::Transfer { table, cells } => {
                if let Row::Variable(row) = &table.row {
                    self.read(row);
                }
                for cell in cells {
                    if cell.store { self.read(&cell.variable) } else { self.write(&cell.variable, sure) }
                }
            }
            _ => {}
        }
    }

    fn write(&mut self, target: &VarRef, sure: bool) {
        if let (Some(name), true) = (name_of(target), sure) {
            self.written.insert(name);
        }
    }

    fn read_in(&mut self, e: &Expr) {
        if let ExprKind::Variable(variable) = &e.kind {
            self.read(variable);
        }
    }

    fn read(&mut self, variable: &VarRef) {
        let number = match &variable.index {
            Index::Number(number) | Index::Bit(number, _) => Some(*number),
            _ => None,
        };
        if let Some((state, subscripts, _)) = self.control.read_system(&variable.name, number) {
            self.cells.insert((state, subscripts));
        } else if let Some(name) = name_of(variable)
            && class_of(self.control, &name).is_some()
            && !self.written.contains(&name)
            && !self.order.contains(&name)
        {
            self.order.push(name);
        }
    }

    fn condition(&mut self, condition: &Expr) {
        walk(condition, &mut |e| {
            self.read_in(e);
            let ExprKind::Binary(op, left, right) = &e.kind else { return };
            if !is_relation(*op) {
                return;
            }
            let (mut constants, mut variables) = (vec![0.0], Vec::new());
            for side in [left, right] {
                walk(side, &mut |e| match &e.kind {
                    ExprKind::Number(number) => constants.extend([number.value, -number.value]),
                    ExprKind::Variable(variable) => variables.push((**variable).clone()),
                    _ => {}
                });
            }
            for variable in &variables {
                self.compare(variable, &constants);
            }
        });
    }

    fn compare(&mut self, variable: &VarRef, constants: &[f64]) {
        // The constants themselves tell most, so they come first.
        let beside = constants.iter().flat_map(|c| [c - 1.0, c + 1.0]);
        let near: Vec<f64> = constants.iter().copied().chain(beside).filter(|c| c.abs() < 1e7).collect();
        self.numbers.extend(&near);
        if let Some(name) = name_of(variable) {
            self.compared.entry(name).or_default().extend(near);
        }
    }

    fn finish(mut self) -> Inputs {
        let tidy = |mut values: Vec<f64>| {
            // -0 is the same start value as 0.
            values.iter_mut().for_each(|value| *value += 0.0);
            let mut seen = BTreeSet::new();
            values.retain(|value| seen.insert(value.to_bits()));
            values.truncate(40);
            values
        };
        let control = self.control;
        let mut input = |name: String| Input {
            nullable: class_of(control, &name).is_some_and(|class| class.nullable),
            values: tidy(self.compared.remove(&name).unwrap_or_default()),
            name,
        };
        let variables = std::mem::take(&mut self.order).into_iter().map(&mut input).collect();
        Inputs {
            variables,
            numbers: tidy(self.numbers),
            cells: self.cells.into_iter().collect(),
            skips: self.skips,
        }
    }
}

fn is_relation(op: BinaryOp) -> bool {
    use BinaryOp::*;
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

/// The whole name of a variable whose subscript is written: `#100`, `VX`.
fn name_of(variable: &VarRef) -> Option<String> {
    match &variable.index {
        Index::Number(number) => Some(format!("{}{number}", variable.name)),
        Index::Letter(letter) => Some(format!("{}{letter}", variable.name)),
        _ => None,
    }
}

fn walk<'e>(e: &'e Expr, visit: &mut dyn FnMut(&'e Expr)) {
    // Parsers limit how deep expressions nest.
    visit(e);
    match &e.kind {
        ExprKind::Number(_) => {}
        ExprKind::Variable(variable) => {
            if let Index::Computed(index) = &variable.index {
                walk(index, visit);
            }
        }
        ExprKind::Negate(a) | ExprKind::Plus(a) | ExprKind::Not(a) | ExprKind::Group(a) => walk(a, visit),
        ExprKind::Binary(_, a, b) => {
            walk(a, visit);
            walk(b, visit);
        }
        ExprKind::Call { arguments, .. } => arguments.iter().for_each(|a| walk(a, visit)),
    }
}
