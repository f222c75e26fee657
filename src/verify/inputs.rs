//! What a program takes from outside: read off its text.

use super::names::{Side, class_of};
use crate::canon::{Op, Sys};
use crate::control::ProgramRef;
use crate::dialect::Control;
use crate::syntax::{
    BinaryOp, Expr, ExprKind, Index, Item, ItemKind, Row, TestSubject, VarRef, Word, for_each_expr,
};
use std::collections::{BTreeMap, BTreeSet};

/// What a program takes from outside.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    /// The variables that are read before the text writes them.
    pub variables: Vec<Input>,
    /// Variables that conditions hold against each other, by place in `variables`.
    pub pairs: Vec<(usize, usize)>,
    /// Numbers that the program's conditions name, and their neighbours.
    pub numbers: Vec<f64>,
    /// State that the machine does not model and the program reads.
    pub cells: Vec<(Sys, Vec<u32>)>,
    /// True where a block can be skipped.
    pub skips: bool,
    /// True for each of A, B and C that a program of the library moves.
    pub rotary: [bool; 3],
    /// The unit that the machine must be set to, where the program checks it: true for inch.
    pub inch: Option<bool>,
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

/// True where another program of the library calls it: then that one has set what it takes.
pub fn is_called(side: &Side<'_>, program: ProgramRef) -> bool {
    let others = side.programs().into_iter().filter(|other| *other != program);
    let mut blocks = others.flat_map(|other| side.text(other));
    blocks.any(|block| calls(side, &block.items).any(|called| called == program))
}

/// Reads a program.
pub fn inputs(side: &Side<'_>, program: ProgramRef) -> Inputs {
    let mut reader = Reader::new(side.control);
    let mut called = vec![program];
    let mut at = 0;
    while let Some(&one) = called.get(at) {
        reader.own = at == 0;
        for block in side.text(one) {
            reader.items(&block.items, reader.own);
            let programs = calls(side, &block.items).filter(|program| !called.contains(program));
            let more: Vec<ProgramRef> = programs.collect();
            called.extend(more);
        }
        at += 1;
    }
    Inputs { rotary: ['A', 'B', 'C'].map(|letter| moves(side, letter)), ..reader.finish() }
}

/// True where a program of the library has a word of this axis.
fn moves(side: &Side<'_>, letter: char) -> bool {
    let blocks = side.files.iter().flat_map(|file| &file.parsed.blocks);
    let mut items = blocks.flat_map(|block| &block.items);
    items.any(|item| matches!(&item.kind, ItemKind::Word(word) if word.letter == letter))
}

/// The programs that a block may call: those whose numbers stand in its P words.
pub(super) fn calls<'s>(side: &'s Side<'_>, items: &'s [Item]) -> impl Iterator<Item = ProgramRef> + 's {
    items.iter().filter_map(|item| {
        let ItemKind::Word(word) = &item.kind else { return None };
        let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else {
            return None;
        };
        let is_number = word.letter == 'P' && number.value >= 1.0 && number.value.fract() == 0.0;
        // A float outside the range becomes its nearest end.
        is_number.then(|| side.numbered(number.value as u32)).flatten()
    })
}

struct Reader<'c> {
    control: &'c Control,
    /// True in the program itself, false in those that it calls: their locals are their own.
    own: bool,
    pairs: Vec<(String, String)>,
    written: BTreeSet<String>,
    order: Vec<String>,
    compared: BTreeMap<String, Vec<f64>>,
    numbers: Vec<f64>,
    cells: BTreeSet<(Sys, Vec<u32>)>,
    skips: bool,
    inch: Option<bool>,
}

impl<'c> Reader<'c> {
    fn new(control: &'c Control) -> Self {
        Self {
            control,
            own: true,
            pairs: Vec::new(),
            written: BTreeSet::new(),
            order: Vec::new(),
            compared: BTreeMap::new(),
            numbers: Vec::new(),
            cells: BTreeSet::new(),
            skips: false,
            inch: None,
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
            ItemKind::Word(word) => self.check_of_unit(word),
            ItemKind::Assign { target, value, .. } => {
                self.numbers.extend(step(target, value));
                self.write(target, sure);
            }
            ItemKind::Timer(target) => self.write(target, sure),
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

    fn check_of_unit(&mut self, word: &Word) {
        let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else { return };
        let checked = match self.control.code(word.letter, number.value, &[]).map(|row| row.op) {
            Some(Op::CheckInch) => true,
            Some(Op::CheckMetric) => false,
            _ => return,
        };
        self.inch.get_or_insert(checked);
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
            && class_of(self.control, &name).is_some_and(|class| self.own || class.class != "local")
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
            if let [a, b] = variables.as_slice()
                && let (Some(a), Some(b)) = (name_of(a), name_of(b))
            {
                self.pairs.push((a, b));
            }
        });
    }

    fn compare(&mut self, variable: &VarRef, constants: &[f64]) {
        // The constants themselves tell most, so they come first.
        let beside = constants.iter().flat_map(|c| [c - 1.0, c + 1.0, c + 0.5]);
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
        let variables: Vec<Input> = std::mem::take(&mut self.order).into_iter().map(&mut input).collect();
        let place = |name: &String| variables.iter().position(|input| input.name == *name);
        let pairs = self.pairs.iter().filter_map(|(a, b)| Some((place(a)?, place(b)?)));
        Inputs {
            pairs: pairs.collect::<BTreeSet<_>>().into_iter().collect(),
            variables,
            numbers: tidy(self.numbers),
            cells: self.cells.into_iter().collect(),
            skips: self.skips,
            rotary: [false; 3],
            inch: self.inch,
        }
    }
}

/// By how much a variable goes on each time, and twice that: a way of so few steps comes to its end.
fn step(target: &VarRef, value: &Expr) -> Vec<f64> {
    let ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract, left, right) = &value.kind else {
        return Vec::new();
    };
    match (&left.kind, &right.kind) {
        (ExprKind::Variable(variable), ExprKind::Number(by)) if name_of(variable) == name_of(target) => {
            vec![by.value, by.value * 2.0]
        }
        _ => Vec::new(),
    }
}

fn is_relation(op: BinaryOp) -> bool {
    use BinaryOp::*;
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
}

/// The whole name of a variable whose subscript is written: `#100`, `VX`.
pub(super) fn name_of(variable: &VarRef) -> Option<String> {
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
