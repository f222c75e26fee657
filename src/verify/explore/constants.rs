//! Ways of branches that constants make impossible.
//!
//! `#100=6000` and in the next block `IF[#100GT2500]`: no circumstances go the other way, so nothing is missed where none
//! did. What a jump that was not taken says counts too: after `IF[#1LT2]GOTO9` the variable is 2 or more, and its whole
//! part no more than itself. Looked at is what stands in one row: whatever may be come to from elsewhere, calls, or moves
//! (a call may hang on them) ends what is known.

mod known;

use crate::canon::{Func, Sys};
use crate::control::ProgramRef;
use crate::dialect::{Control, Question};
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, Item, ItemKind, VarRef};
use crate::text::Span;
use crate::verify::sides::{Side, class_of};
use known::{Known, Range, opposite};
use std::collections::{BTreeMap, BTreeSet};

/// The conditions of a program and the way that each of them never goes: 1 for true, 0 for false.
///
/// How a vacant variable compares counts only where a source confirms it; or, with `as_run`, as the emulated control has
/// it: runs on it tell by themselves where that mattered.
pub fn impossible(side: &Side<'_>, program: ProgramRef, as_run: bool) -> BTreeSet<(Span, i64)> {
    let (known, out) = (BTreeMap::new(), BTreeSet::new());
    let mut reader = Reader { control: side.control, as_run, known, out };
    for block in side.text(program) {
        // A block that can be skipped may not have run: only what it leaves alone is still known.
        let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
        let before = skipped.then(|| reader.known.clone());
        block.items.iter().for_each(|item| reader.item(item));
        if let Some(before) = before {
            reader.known.retain(|name, value| before.get(name) == Some(value));
        }
    }
    reader.out
}

struct Reader<'c> {
    control: &'c Control,
    as_run: bool,
    known: BTreeMap<String, Known>,
    out: BTreeSet<(Span, i64)>,
}

impl Reader<'_> {
    fn item(&mut self, item: &Item) {
        use ItemKind::*;
        match &item.kind {
            Assign { target, value, .. } => {
                let value = self.value(value);
                match self.name(target) {
                    Some(name) => self.set(name, value),
                    None => self.known.clear(),
                }
            }
            If { condition, body, .. } => {
                if let Some(held) = self.holds(condition) {
                    self.out.insert((condition.span, i64::from(!held)));
                }
                for item in body {
                    match &item.kind {
                        // It may be done or not.
                        Assign { target, .. } => match self.name(target) {
                            Some(name) => self.set(name, None),
                            // An alarm, an output, an offset: no variable of a program.
                            None if self.is_system(target) => {}
                            None => self.known.clear(),
                        },
                        Goto(_) | Comment(_) | EndOfBlock => {}
                        _ => self.known.clear(),
                    }
                }
                if matches!(body.first().map(|item| &item.kind), Some(Goto(_))) {
                    self.went_on(condition);
                }
            }
            Comment(_) | MacroMark | EndOfBlock | Tape | Program(_) | Skip(_) => {}
            _ => self.known.clear(),
        }
    }

    /// Writes a variable; what was the whole part of its old value is that of nothing any more.
    fn set(&mut self, name: String, value: Option<Known>) {
        for known in self.known.values_mut() {
            if let Known::Number(range) = known
                && range.whole_of.as_ref() == Some(&name)
            {
                range.whole_of = None;
            }
        }
        match value {
            Some(Known::Number(Range { whole_of: Some(of), low, high })) if of == name => {
                self.known.insert(name, Known::Number(Range { low, high, whole_of: None }));
            }
            Some(value) => {
                self.known.insert(name, value);
            }
            None => {
                self.known.remove(&name);
            }
        }
    }

    /// Takes in that the jump on a condition was not taken.
    fn went_on(&mut self, condition: &Expr) {
        let ExprKind::Binary(op, operands) = &bare(condition).kind else { return };
        let [a, b] = &**operands;
        let ExprKind::Variable(variable) = &bare(a).kind else { return };
        let (Some(name), Some(holds)) = (self.name(variable), opposite(*op)) else { return };
        match self.value(b) {
            // It is not vacant.
            Some(Known::Vacant) if *op == BinaryOp::Equal => {
                self.known.entry(name).or_insert(Known::Number(Range::ANY));
            }
            Some(Known::Number(Range { low, high, .. })) if low == high => {
                let old = match self.known.get(&name) {
                    Some(Known::Number(range)) => range.clone(),
                    Some(Known::Vacant) => return,
                    // A vacant one, taken for 0, must have jumped.
                    None if !self.is_nullable(&name) => Range::ANY,
                    None if self.says(Question::VacantComparesAsZero, "true") => {
                        let jumps = Range::one(0.0).compare(*op, &Range::one(low)) == Some(true);
                        if !jumps || matches!(op, BinaryOp::Equal | BinaryOp::NotEqual) {
                            return;
                        }
                        Range::ANY
                    }
                    None => return,
                };
                self.known.insert(name, Known::Number(old.where_holds(holds, low)));
            }
            _ => {}
        }
    }

    /// The name of a variable that nothing but a program writes; none of any other, which might be any.
    fn name(&self, variable: &VarRef) -> Option<String> {
        let Index::Number(number) = variable.index else { return None };
        let name = format!("{}{number}", variable.name);
        let own = self.control.read_system(&variable.name, Some(number)).is_none();
        (own && class_of(self.control, &name).is_some()).then_some(name)
    }

    fn is_nullable(&self, name: &str) -> bool {
        class_of(self.control, name).is_some_and(|class| class.nullable)
    }

    fn is_system(&self, variable: &VarRef) -> bool {
        let Index::Number(number) = variable.index else { return false };
        self.control.read_system(&variable.name, Some(number)).is_some()
    }

    fn value(&self, e: &Expr) -> Option<Known> {
        let any = Some(Known::Number(Range::ANY));
        let number = |e: &Expr| match self.value(e) {
            Some(Known::Number(range)) => range,
            _ => Range::ANY,
        };
        match &e.kind {
            ExprKind::Number(number) => Some(Known::Number(Range::one(number.value))),
            ExprKind::Group(inner) | ExprKind::Plus(inner) => self.value(inner),
            ExprKind::Negate(inner) => Some(Known::Number(number(inner).negated())),
            ExprKind::Variable(variable) => {
                let Index::Number(number) = variable.index else { return None };
                match self.control.read_system(&variable.name, Some(number)) {
                    Some((Sys::Empty, ..)) => Some(Known::Vacant),
                    Some(_) => None,
                    None => self.known.get(&self.name(variable)?).cloned(),
                }
            }
            ExprKind::Binary(BinaryOp::Add, operands) => {
                let [a, b] = &**operands;
                Some(Known::Number(number(a).plus(&number(b))))
            }
            ExprKind::Binary(BinaryOp::Subtract, operands) => {
                let [a, b] = &**operands;
                Some(Known::Number(number(a).plus(&number(b).negated())))
            }
            ExprKind::Call { function: Func::Fix, arguments, .. } => {
                let [of] = arguments.as_slice() else { return any };
                let variable = match &bare(of).kind {
                    ExprKind::Variable(variable) => self.name(variable),
                    _ => None,
                };
                Some(Known::Number(number(of).whole(variable)))
            }
            // Arithmetic and functions never yield vacancy.
            _ => any,
        }
    }

    /// Whether a condition holds, where that is known.
    fn holds(&self, e: &Expr) -> Option<bool> {
        use BinaryOp::*;
        let (op, [left, right]) = match &e.kind {
            ExprKind::Group(inner) => return self.holds(inner),
            ExprKind::Binary(op, operands) => (*op, &**operands),
            _ => return None,
        };
        let (a, b) = (self.value(left)?, self.value(right)?);
        let as_zero = |known: &Known| match known {
            Known::Number(range) => Some(range.clone()),
            Known::Vacant => self.says(Question::VacantComparesAsZero, "true").then_some(Range::one(0.0)),
        };
        match (op, &a, &b) {
            (Equal | NotEqual, Known::Vacant, Known::Vacant) => Some(op == Equal),
            (Equal | NotEqual, Known::Vacant, Known::Number(other))
            | (Equal | NotEqual, Known::Number(other), Known::Vacant) => {
                let never_zero = other.low > 0.0 || other.high < 0.0;
                (never_zero || self.says(Question::VacantEqZero, "false")).then_some(op == NotEqual)
            }
            _ => {
                let (a, b) = (as_zero(&a)?, as_zero(&b)?);
                let by_whole = || self.against_its_whole(op, (left, &a), (right, &b));
                a.compare(op, &b).or_else(by_whole)
            }
        }
    }

    /// Whether a comparison of a variable with its whole part holds, where its sign says so.
    fn against_its_whole(&self, op: BinaryOp, left: (&Expr, &Range), right: (&Expr, &Range)) -> Option<bool> {
        use BinaryOp::*;
        let is = |whole: &Range, of: &Expr| {
            let ExprKind::Variable(variable) = &bare(of).kind else { return false };
            whole.whole_of.is_some() && whole.whole_of == self.name(variable)
        };
        // How it is written: the variable first.
        let (op, of) = if is(right.1, left.0) {
            (op, left.1)
        } else if is(left.1, right.0) {
            let turned = match op {
                Less => Greater,
                LessEqual => GreaterEqual,
                Greater => Less,
                GreaterEqual => LessEqual,
                op => op,
            };
            (turned, right.1)
        } else {
            return None;
        };
        match op {
            Less if of.low >= 0.0 => Some(false),
            GreaterEqual if of.low >= 0.0 => Some(true),
            Greater if of.high <= 0.0 => Some(false),
            LessEqual if of.high <= 0.0 => Some(true),
            _ => None,
        }
    }

    fn says(&self, question: Question, answer: &str) -> bool {
        let row = self.control.behaviour(question);
        row.is_some_and(|row| (row.origin.is_settled() || self.as_run) && row.value == answer)
    }
}

/// An expression without the brackets around it.
fn bare(e: &Expr) -> &Expr {
    // Parsers limit how deep expressions nest.
    match &e.kind {
        ExprKind::Group(inner) | ExprKind::Plus(inner) => bare(inner),
        _ => e,
    }
}
