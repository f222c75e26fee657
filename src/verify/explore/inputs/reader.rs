//! Reads what a program takes from outside.

use super::input::{Input, Inputs};
use super::solve::{constant, solve};
use crate::canon::{Func, Op, Sys};
use crate::dialect::Control;
use crate::syntax::{
    BinaryOp, Expr, ExprKind, Index, Item, ItemKind, TableRow, Target, TestSubject, VarRef, Word,
    for_each_expr,
};
use crate::verify::sides::{Arguments, class_of, name_of};
use std::collections::{BTreeMap, BTreeSet};

/// Assignments that a number is followed back through, at the most.
const STEPS_BACK: usize = 4;

/// The locals of a program that it may be given by itself.
#[derive(Clone, Copy)]
pub(super) enum Locals<'c> {
    /// None of them: what it is called with stands in registers that nobody knows.
    None,
    /// All that it reads.
    All,
    /// Those whose registers are known.
    These(&'c Arguments),
}

impl Locals<'_> {
    fn has(self, local: &str) -> bool {
        match self {
            Self::None => false,
            Self::All => true,
            Self::These(arguments) => arguments.has(local),
        }
    }

    /// True for a variable that may have no value: any that is no argument, and an argument that calls may leave out.
    fn may_be_vacant(self, name: &str) -> bool {
        match self {
            Self::These(arguments) => !arguments.has(name) || arguments.may_be_vacant(name),
            _ => true,
        }
    }
}

/// Reads the items of programs, one after the other.
pub(super) struct Reader<'c> {
    control: &'c Control,
    /// The locals that may be given, in the program itself; none in those that it calls: their locals are their own.
    pub(super) own: Locals<'c>,
    /// The same, in whichever program it is.
    given: Locals<'c>,
    pairs: Vec<(String, String)>,
    written: BTreeSet<String>,
    order: Vec<String>,
    compared: BTreeMap<String, Vec<f64>>,
    /// What was written last into a variable, if it is made of one variable.
    made_of: BTreeMap<String, Expr>,
    numbers: Vec<f64>,
    /// State that is read, and the numbers that it is compared with.
    cells: BTreeMap<(Sys, Vec<u32>), Vec<f64>>,
    skips: BTreeSet<u8>,
    asks: bool,
    /// Where computed jumps of the program at hand are sent.
    pub(super) labels: Vec<u32>,
    inch: Option<bool>,
    selected: Option<bool>,
    /// True if a code takes the radius of its tool off by itself: a round pocket.
    pockets: bool,
}

impl<'c> Reader<'c> {
    pub(super) fn new(control: &'c Control, given: Locals<'c>) -> Self {
        Self {
            control,
            own: given,
            given,
            pairs: Vec::new(),
            written: BTreeSet::new(),
            order: Vec::new(),
            compared: BTreeMap::new(),
            made_of: BTreeMap::new(),
            numbers: Vec::new(),
            cells: BTreeMap::new(),
            skips: BTreeSet::new(),
            asks: false,
            labels: Vec::new(),
            inch: None,
            selected: None,
            pockets: false,
        }
    }

    /// Goes through the items of a block; `sure` where they run whenever the block does.
    pub(super) fn items(&mut self, items: &[Item], sure: bool) {
        for item in items {
            match &item.kind {
                ItemKind::Skip(switch) => {
                    self.skips.insert(switch.unwrap_or(1));
                }
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
            ItemKind::Word(word) => self.unit(word),
            ItemKind::Assign { target, value, .. } => {
                self.numbers.extend(step(target, value, self.control));
                self.asks |= self.state_of(target) == Some(Sys::StopMessage);
                self.write(target, sure);
                self.make(target, value);
            }
            ItemKind::Timer(target) => self.write(target, sure),
            ItemKind::Input { targets, .. } => {
                self.asks = true;
                targets.iter().for_each(|target| self.write(target, sure));
            }
            ItemKind::Goto(Target::Computed(to)) | ItemKind::Branch { target: Target::Computed(to), .. } => {
                self.jump(to);
            }
            ItemKind::Step { target, .. } => self.read(target),
            ItemKind::Test(TestSubject::Variable(variable)) => {
                self.read(variable);
                self.compare(variable, &[0.0]);
            }
            ItemKind::Transfer { table, cells } => {
                if let TableRow::Variable(row) = &table.row {
                    self.read(row);
                }
                for cell in cells {
                    if cell.store { self.read(&cell.variable) } else { self.write(&cell.variable, sure) }
                }
            }
            _ => {}
        }
    }

    fn unit(&mut self, word: &Word) {
        let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else { return };
        match self.control.code(word.letter, number.value, &[]).map(|row| row.op) {
            Some(Op::CheckInch) => _ = self.inch.get_or_insert(true),
            Some(Op::CheckMetric) => _ = self.inch.get_or_insert(false),
            Some(Op::Inch) => _ = self.selected.get_or_insert(true),
            Some(Op::Metric) => _ = self.selected.get_or_insert(false),
            Some(Op::PocketCw | Op::PocketCcw) => self.pockets = true,
            _ => {}
        }
    }

    fn write(&mut self, target: &VarRef, sure: bool) {
        if let (Some(name), true) = (name_of(target, self.control), sure) {
            self.written.insert(name);
        }
    }

    /// Remembers what a variable is made of, to say what that must be for a condition on it.
    fn make(&mut self, target: &VarRef, value: &Expr) {
        let Some(name) = name_of(target, self.control) else { return };
        match solve(value, 1.0) {
            Some(_) => self.made_of.insert(name, value.clone()),
            None => self.made_of.remove(&name),
        };
    }

    fn read_in(&mut self, e: &Expr) {
        match &e.kind {
            ExprKind::Variable(variable) => self.read(variable),
            ExprKind::Call { function: Func::Asin | Func::Acos, arguments, .. } => self.in_domain(arguments),
            _ => {}
        }
    }

    /// Has arguments on both sides of 0 tried, of functions that take little else.
    fn in_domain(&mut self, arguments: &[Expr]) {
        let [argument] = arguments else { return };
        for wanted in [-0.5, 0.5] {
            let Some((variable, value)) = solve(argument, wanted) else { return };
            let Some(name) = name_of(variable, self.control) else { return };
            self.trace_back(name.clone(), vec![value]);
            self.compared.entry(name).or_default().push(value);
        }
    }

    /// The machine state that a variable is.
    fn state_of(&self, variable: &VarRef) -> Option<Sys> {
        let Index::Number(number) = variable.index else { return None };
        self.control.read_system(&variable.name, Some(number)).map(|(state, ..)| state)
    }

    fn cell(&self, variable: &VarRef) -> Option<(Sys, Vec<u32>)> {
        let number = match &variable.index {
            Index::Number(number) | Index::Bit(number, _) => Some(*number),
            _ => None,
        };
        let (state, subscripts, _) = self.control.read_system(&variable.name, number)?;
        Some((state, subscripts))
    }

    fn read(&mut self, variable: &VarRef) {
        if let Some(cell) = self.cell(variable) {
            self.cells.entry(cell).or_default();
        } else if let Some(name) = name_of(variable, self.control)
            && class_of(self.control, &name)
                .is_some_and(|class| class.class != "local" || self.own.has(&name))
            && !self.written.contains(&name)
            && !self.order.contains(&name)
        {
            self.order.push(name);
        }
    }

    fn condition(&mut self, condition: &Expr) {
        walk(condition, &mut |e| {
            self.read_in(e);
            let ExprKind::Binary(op, operands) = &e.kind else { return };
            if !is_relation(*op) {
                return;
            }
            let [left, right] = &**operands;
            let (mut constants, mut variables) = (vec![0.0], Vec::new());
            for side in [left, right] {
                walk(side, &mut |e| match &e.kind {
                    ExprKind::Number(number) => constants.extend([number.value, -number.value]),
                    ExprKind::Variable(variable) => variables.push((**variable).clone()),
                    _ => {}
                });
            }
            // What a sum or a product must be says what its variable must be.
            for (side, other) in [(left, right), (right, left)] {
                if let Some((variable, value)) = constant(other).and_then(|wanted| solve(side, wanted)) {
                    self.compare(variable, &[value]);
                }
            }
            for variable in &variables {
                self.compare(variable, &constants);
            }
            if let [a, b] = variables.as_slice()
                && let (Some(a), Some(b)) = (name_of(a, self.control), name_of(b, self.control))
            {
                self.pairs.push((a, b));
            }
        });
    }

    /// Lets a computed jump go to each label.
    fn jump(&mut self, to: &Expr) {
        for label in std::mem::take(&mut self.labels).iter().map(|label| f64::from(*label)) {
            self.numbers.push(label);
            if let Some((variable, value)) = solve(to, label)
                && let Some(name) = name_of(variable, self.control)
            {
                self.compared.entry(name).or_default().push(value);
            }
        }
    }

    fn compare(&mut self, variable: &VarRef, constants: &[f64]) {
        // The constants themselves tell most, so they come first.
        let beside = constants.iter().flat_map(|c| [c - 1.0, c + 1.0, c + 0.5]);
        let near: Vec<f64> = constants.iter().copied().chain(beside).filter(|c| c.abs() < 1e7).collect();
        self.numbers.extend(&near);
        if let Some(cell) = self.cell(variable) {
            self.cells.entry(cell).or_default().extend(near);
        } else if let Some(name) = name_of(variable, self.control) {
            self.trace_back(name.clone(), near.clone());
            self.compared.entry(name).or_default().extend(near);
        }
    }

    /// Has numbers tried in what a variable is made of: `#2=ASIN[#1]` is -30 for #1 -0.5.
    fn trace_back(&mut self, mut name: String, mut values: Vec<f64>) {
        for _ in 0..STEPS_BACK {
            let Some(value) = self.made_of.get(&name) else { return };
            let found = values.iter().filter_map(|wanted| solve(value, *wanted));
            let found: Vec<_> =
                found.filter_map(|(variable, n)| Some((name_of(variable, self.control)?, n))).collect();
            let Some(from) = found.first().map(|(from, _)| from.clone()) else { return };
            values = found.into_iter().map(|(_, n)| n).filter(|n| n.abs() < 1e7).collect();
            self.compared.entry(from.clone()).or_default().extend(&values);
            if from == name {
                return;
            }
            name = from;
        }
    }

    pub(super) fn finish(mut self) -> Inputs {
        let tidy = |mut values: Vec<f64>| {
            // -0 is the same start value as 0.
            values.iter_mut().for_each(|value| *value += 0.0);
            let mut seen = BTreeSet::new();
            values.retain(|value| seen.insert(value.to_bits()));
            values.truncate(40);
            values
        };
        let (control, own) = (self.control, self.given);
        let mut input = |name: String| Input {
            nullable: class_of(control, &name).is_some_and(|class| class.nullable)
                && own.may_be_vacant(&name),
            values: tidy(self.compared.remove(&name).unwrap_or_default()),
            name,
            theirs: false,
        };
        let variables: Vec<Input> = std::mem::take(&mut self.order).into_iter().map(&mut input).collect();
        let place = |name: &String| variables.iter().position(|input| input.name == *name);
        let pairs = self.pairs.iter().filter_map(|(a, b)| Some((place(a)?, place(b)?)));
        Inputs {
            pairs: pairs.collect::<BTreeSet<_>>().into_iter().collect(),
            variables,
            numbers: tidy(self.numbers),
            cells: self.cells.into_iter().map(|(cell, values)| (cell, tidy(values))).collect(),
            skips: self.skips,
            asks: self.asks,
            sets_named: false,
            rotary: [false; 3],
            turns_by_sign: false,
            second_home: [None; 3],
            peck_clearance: None,
            unworn: self.pockets,
            unworn_lengths: false,
            one_table: None,
            zero_is_home: false,
            many_tools: false,
            inch: self.inch,
            selected: self.selected,
        }
    }
}

/// By how much a variable goes on each time, and twice that: a way of so few steps comes to its end.
fn step(target: &VarRef, value: &Expr, control: &Control) -> Vec<f64> {
    let ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract, operands) = &value.kind else {
        return Vec::new();
    };
    let [left, right] = &**operands;
    match (&left.kind, &right.kind) {
        (ExprKind::Variable(variable), ExprKind::Number(by))
            if name_of(variable, control) == name_of(target, control) =>
        {
            vec![by.value, by.value * 2.0]
        }
        _ => Vec::new(),
    }
}

fn is_relation(op: BinaryOp) -> bool {
    use BinaryOp::*;
    matches!(op, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
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
        ExprKind::Binary(_, operands) => operands.iter().for_each(|a| walk(a, visit)),
        ExprKind::Call { arguments, .. } => arguments.iter().for_each(|a| walk(a, visit)),
    }
}
