//! Ways of branches that constants make impossible.
//!
//! `#100=6000` and in the next block `IF[#100GT2500]`: no circumstances go the other way, so nothing is missed where none
//! did. What a jump that was not taken says counts too: after `IF[#1LT2]GOTO9` the variable is 2 or more, and its whole
//! part no more than itself. Of a source only what stands in one row is looked at: the literals at its head are edited, and
//! then other ways are gone. Of a target that is run as it stands jumps are followed: a place that they lead to knows what
//! holds on each way there; one that a later jump leads back to, or that a call or a return may mean, knows nothing. Nor does
//! what comes after a code that may call something.

mod jumps;
mod known;

use crate::canon::{Func, Op, Sys};
use crate::control::ProgramRef;
use crate::dialect::{Control, Question};
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, Item, ItemKind, Target, TestSubject, VarRef};
use crate::text::Span;
use crate::verify::sides::{Side, class_of, name_of};
use jumps::{Jumps, State, goes, is_plain};
use known::{Known, Range, opposite};
use std::collections::BTreeSet;

/// What a control with a condition register holds there: no variable has this name.
const REGISTER: &str = "";

/// The conditions of a program and the way that each of them never goes: 1 for true, 0 for false.
///
/// How a vacant variable compares counts only where a source confirms it; or, with `as_run`, as the emulated control has
/// it: runs on it tell by themselves where that mattered.
pub fn impossible(side: &Side<'_>, program: ProgramRef, as_run: bool) -> BTreeSet<(Span, i64)> {
    let (control, text) = (side.control, side.text(program));
    // Under a modal call, its own or its callers', each move of the program may be one.
    let may_be = side.links().is_called(program) || !text.iter().all(|block| is_plain(&block.items, control));
    let modal = may_be && control.dialect().codes.iter().any(|row| row.op == Op::CallModal);
    let jumps = Jumps::of(text, control);
    let (known, out) = (State::new(), BTreeSet::new());
    let mut reader = Reader { control, as_run, modal, jumps, known, is_reached: true, out };
    for block in text {
        if as_run {
            let before = reader.is_reached.then(|| std::mem::take(&mut reader.known));
            let state = reader.jumps.enter(block, before);
            reader.is_reached = state.is_some();
            reader.known = state.unwrap_or_default();
        }
        // A block that can be skipped may not have run: only what it leaves alone is still known.
        let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
        let before = (skipped && reader.is_reached).then(|| reader.known.clone());
        if as_run {
            reader.words(&block.items);
            block.items.iter().for_each(|item| reader.item(item));
        } else {
            block.items.iter().for_each(|item| reader.in_row(item));
        }
        if let Some(before) = before {
            if reader.is_reached {
                reader.known.retain(|name, value| before.get(name) == Some(value));
            } else {
                (reader.known, reader.is_reached) = (before, true);
            }
        }
    }
    reader.out
}

struct Reader<'c> {
    control: &'c Control,
    as_run: bool,
    /// True if its moves may be calls.
    modal: bool,
    jumps: Jumps,
    known: State,
    /// False where nothing comes to.
    is_reached: bool,
    out: BTreeSet<(Span, i64)>,
}

impl Reader<'_> {
    /// An item of what stands in one row: anything but an assignment or a condition ends it.
    fn in_row(&mut self, item: &Item) {
        use ItemKind::*;
        match item.kind {
            Assign { .. } | If { .. } => self.item(item),
            Comment(_) | MacroMark | EndOfBlock | Tape | Program(_) | Skip(_) => {}
            _ => self.known.clear(),
        }
        self.is_reached = true;
    }

    fn item(&mut self, item: &Item) {
        use ItemKind::*;
        match &item.kind {
            Assign { target, value, .. } => {
                let value = self.value(value);
                self.set(REGISTER.into(), None);
                match self.name(target) {
                    Some(name) => self.set(name, value),
                    None => self.known.clear(),
                }
            }
            Goto(target) => self.leave(target, true),
            Branch { relation, target } => {
                let register = self.known.get(REGISTER).cloned();
                let held = match register {
                    Some(Known::Number(range)) => range.compare(*relation, &Range::one(0.0)),
                    _ => None,
                };
                self.decided(item.span, held);
                self.jumps.jump(target, self.state(held != Some(false)));
                self.is_reached &= held != Some(true);
            }
            Test(TestSubject::Variable(variable)) => {
                let value = self.value_of(variable);
                self.set(REGISTER.into(), value);
            }
            Test(_) => self.set(REGISTER.into(), None),
            If { condition, body, .. } => {
                let held = self.holds(condition);
                self.decided(condition.span, held);
                let runs = held != Some(false);
                for item in body {
                    match &item.kind {
                        Goto(target) => {
                            self.jumps.jump(target, self.state(runs));
                            self.is_reached &= held != Some(true);
                        }
                        _ if !runs => {}
                        // It may be done or not.
                        Assign { target, .. } => match self.name(target) {
                            Some(name) => self.set(name, None),
                            // An alarm, an output, an offset: no variable of a program.
                            None if self.is_system(target) => {}
                            None => self.known.clear(),
                        },
                        Comment(_) | EndOfBlock => {}
                        _ => self.known.clear(),
                    }
                }
                if held.is_none() && matches!(body.first().map(|item| &item.kind), Some(Goto(_))) {
                    self.went_on(condition);
                }
            }
            Comment(_)
            | MacroMark
            | EndOfBlock
            | Tape
            | Program(_)
            | Skip(_)
            | Sequence { .. }
            | Label(_) => {}
            // A loop begins again, and ends, with nothing known.
            Do { .. } | End { .. } => {
                self.known.clear();
                self.is_reached = true;
            }
            // Those of the block were looked at together.
            Word(_) | Print { .. } | Output { .. } | OpenPort | ClosePort => {}
            _ => self.known.clear(),
        }
    }

    /// What the words of a block leave known.
    fn words(&mut self, items: &[Item]) {
        if let Some(target) = goes(items, self.control) {
            return self.leave(&target, true);
        }
        let words = items.iter().any(|item| matches!(item.kind, ItemKind::Word(_)));
        if words && (self.modal || !is_plain(items, self.control)) {
            self.known.clear();
        }
    }

    /// Goes elsewhere for good.
    fn leave(&mut self, target: &Target, runs: bool) {
        self.jumps.jump(target, self.state(runs));
        self.is_reached = false;
    }

    /// What is known here, if a run comes here and goes on.
    fn state(&self, runs: bool) -> Option<State> {
        (runs && self.is_reached).then(|| self.known.clone())
    }

    /// Notes the way that a condition never goes; where nothing comes to it, it goes neither.
    fn decided(&mut self, span: Span, held: Option<bool>) {
        let never: &[i64] = match held {
            _ if !self.is_reached => &[0, 1],
            Some(held) => &[if held { 0 } else { 1 }],
            None => &[],
        };
        self.out.extend(never.iter().map(|way| (span, *way)));
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
        let name = name_of(variable, self.control)?;
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

    fn value_of(&self, variable: &VarRef) -> Option<Known> {
        let Index::Number(number) = variable.index else { return None };
        match self.control.read_system(&variable.name, Some(number)) {
            Some((Sys::Empty, ..)) => Some(Known::Vacant),
            Some(_) => None,
            None => self.known.get(&self.name(variable)?).cloned(),
        }
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
            ExprKind::Variable(variable) => self.value_of(variable),
            ExprKind::Binary(BinaryOp::Multiply | BinaryOp::Divide, operands) => {
                let [a, b] = &**operands;
                Some(Known::Number(number(a).times(&number(b))))
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

#[cfg(test)]
mod tests;
