//! Ways of branches that constants make impossible.
//!
//! `#100=6000` and in the next block `IF[#100GT2500]`: no circumstances go the other way, so nothing is missed where none
//! did. What a jump that was not taken says counts too: after `IF[#1LT2]GOTO9` the variable is 2 or more, and its whole
//! part no more than itself. Jumps are followed: a place that they lead to knows what holds on each way there, round a loop too;
//! one that a call or a return may mean knows nothing. After a code that may call something no
//! more is known than of the locals of a program whose callee has its own. The literals at the head of a main program are
//! edited, and then other ways are gone: what they are counts only where they stand in one row with the condition; further
//! off it counts that they are numbers.

mod conditions;
mod jumps;
mod known;

use crate::canon::{Func, Group, Sys};
use crate::control::ProgramRef;
use crate::dialect::{Control, Question};
use crate::syntax::{BinaryOp, Block, Expr, ExprKind, Index, Item, ItemKind, Target, TestSubject, VarRef};
use crate::text::Span;
use crate::verify::explore::steer::Input;
use crate::verify::sides::{Side, class_of, name_of};
pub use jumps::ends_head;
use jumps::{Jumps, State, goes, is_plain, join, keeps_locals};
pub use known::Given;
use known::{Known, Range};
use std::collections::BTreeSet;

/// What a control with a condition register holds there: no variable has this name.
const REGISTER: &str = "";

/// The conditions of a program and the way that each of them never goes: 1 for true, 0 for false.
///
/// How a vacant variable compares counts only where a source confirms it; or, with `as_run`, as the emulated control has
/// it: runs on it tell by themselves where that mattered.
pub fn impossible(
    side: &Side<'_>,
    program: ProgramRef,
    as_run: bool,
    given: &Given<'_>,
) -> BTreeSet<(Span, i64)> {
    let mut out = read(side, program, Looks { as_run, follows: as_run, edited: false }, given);
    if !as_run {
        let edited = !side.links().is_called(program);
        out.extend(read(side, program, Looks { as_run, follows: true, edited }, given));
    }
    out
}

/// How a text is looked at.
#[derive(Clone, Copy)]
struct Looks {
    as_run: bool,
    /// True if jumps are followed; else only what stands in one row counts.
    follows: bool,
    /// True if a literal at the head may be any number.
    edited: bool,
}

fn read(side: &Side<'_>, program: ProgramRef, looks: Looks, given: &Given<'_>) -> BTreeSet<(Span, i64)> {
    let (control, text, links) = (side.control, side.text(program), side.links());
    // Under a modal call, its own or its callers', each move of the program may be one.
    let may_be = links.is_called(program) || !text.iter().all(|block| is_plain(&block.items, control));
    let modal = may_be && links.has_modal_calls();
    let mut jumps = Jumps::of(text, control, links.returns_to_blocks());
    let six = !links.selects_more();
    let begin = |jumps| Reader {
        control,
        looks,
        six,
        modal,
        jumps,
        unit: given.unit,
        known: given.locals.iter().map(|name| (name.clone(), Known::Number(Range::ANY))).collect(),
        is_reached: true,
        in_head: looks.edited,
        out: BTreeSet::new(),
    };
    for _ in 0..ROUNDS {
        let mut reader = begin(jumps);
        reader.blocks(text);
        if reader.jumps.is_settled() {
            return reader.out;
        }
        jumps = reader.jumps.again();
    }
    let mut reader = begin(jumps.without_loops());
    reader.blocks(text);
    reader.out
}

/// The numbers of the codes of the standard work offsets, on every control that has such codes.
const SELECTED: Range = Range { low: 54.0, high: 59.0, whole_of: Some(String::new()) };

/// How often a text is read for what holds round its loops.
const ROUNDS: usize = 8;

struct Reader<'c> {
    control: &'c Control,
    looks: Looks,
    /// True where no program selects a work offset other than the standard six. That none is in force is asked of a person.
    six: bool,
    /// True if its moves may be calls.
    modal: bool,
    jumps: Jumps,
    /// The code of the unit, where that is always the same.
    unit: Option<f64>,
    known: State,
    /// False where nothing comes to.
    is_reached: bool,
    /// True as long as literals may be any number.
    in_head: bool,
    out: BTreeSet<(Span, i64)>,
}

impl Reader<'_> {
    /// Reads a program once.
    fn blocks(&mut self, text: &[Block]) {
        for block in text {
            if self.looks.follows {
                let before = self.is_reached.then(|| std::mem::take(&mut self.known));
                let state = self.jumps.enter(block, before);
                self.is_reached = state.is_some();
                self.known = state.unwrap_or_default();
            }
            // A block that can be skipped may not have run: only what it leaves alone is still known.
            let skipped = block.items.iter().any(|item| matches!(item.kind, ItemKind::Skip(_)));
            let before = (skipped && self.is_reached).then(|| self.known.clone());
            if self.looks.follows {
                self.words(&block.items);
                block.items.iter().for_each(|item| self.item(item));
            } else {
                block.items.iter().for_each(|item| self.in_row(item));
            }
            if let Some(before) = before {
                if self.is_reached {
                    self.known.retain(|name, value| before.get(name) == Some(value));
                } else {
                    (self.known, self.is_reached) = (before, true);
                }
            }
        }
    }

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
        self.in_head &= !ends_head(item);
        match &item.kind {
            Assign { target, value, .. } => {
                let value = self.value(value);
                self.set(REGISTER.into(), None);
                match self.name(target) {
                    Some(name) => self.set(name, value),
                    // Nothing goes on after an alarm.
                    None if self.looks.follows && self.is_alarm(target) => self.is_reached = false,
                    // No variable of a program; at a stop the operator may set any.
                    None if self.is_system(target) && self.state(target) != Some(Sys::StopMessage) => {}
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
                self.jumps.jump(target, self.known_if(held != Some(false)));
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
                self.branch(condition, body, held);
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

    /// What a condition guards may be done or not.
    fn branch(&mut self, condition: &Expr, body: &[Item], held: Option<bool>) {
        let before = self.known.clone();
        if held.is_none() {
            self.held(condition);
        }
        let mut goes_on = true;
        for item in body {
            match &item.kind {
                ItemKind::Goto(target) => {
                    self.jumps.jump(target, self.known_if(held != Some(false)));
                    goes_on = false;
                }
                ItemKind::Assign { target, .. } if self.name(target).is_some() => self.item(item),
                ItemKind::Assign { target, .. } if self.is_alarm(target) => goes_on = false,
                // An output, an offset: no variable of a program.
                ItemKind::Assign { target, .. } if self.is_system(target) => {}
                ItemKind::Comment(_) | ItemKind::EndOfBlock => {}
                _ => self.known.clear(),
            }
        }
        let done = std::mem::replace(&mut self.known, before);
        if held.is_none() {
            self.went_on(condition);
        }
        match held {
            Some(true) if goes_on => self.known = done,
            Some(true) => self.is_reached = false,
            None if goes_on => {
                let left = std::mem::take(&mut self.known);
                self.known = join(Some(left), Some(done)).unwrap_or_default();
            }
            _ => {}
        }
    }

    /// What the words of a block leave known.
    fn words(&mut self, items: &[Item]) {
        if let Some(target) = goes(items, self.control) {
            return self.leave(&target, true);
        }
        let words = items.iter().any(|item| matches!(item.kind, ItemKind::Word(_)));
        if words && (self.modal || !is_plain(items, self.control)) {
            let (control, own) = (self.control, keeps_locals(items, self.control));
            let is_local = |name: &str| class_of(control, name).is_some_and(|row| row.class == "local");
            self.known.retain(|name, _| own && is_local(name));
        }
    }

    /// Goes elsewhere for good.
    fn leave(&mut self, target: &Target, runs: bool) {
        self.jumps.jump(target, self.known_if(runs));
        self.is_reached = false;
    }

    /// What is known here, if a run comes here and goes on.
    fn known_if(&self, runs: bool) -> Option<State> {
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

    fn value_of(&self, variable: &VarRef) -> Option<Known> {
        let Index::Number(number) = variable.index else { return None };
        match self.control.read_system(&variable.name, Some(number)) {
            Some((Sys::Empty, ..)) => Some(Known::Vacant),
            Some((state, subscripts, _)) if self.six && Input::is_selected(state, &subscripts) => {
                Some(Known::Number(SELECTED))
            }
            // What the machine says is a number.
            Some((state, subscripts, _)) => {
                let unit = self
                    .unit
                    .filter(|_| state == Sys::Modal && subscripts.first().copied() == Group::Units.number());
                Some(Known::Number(unit.map_or(Range::ANY, Range::one)))
            }
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
            ExprKind::Number(_) if self.in_head => any,
            ExprKind::Number(number) => Some(Known::Number(Range::one(number.value))),
            ExprKind::Group(inner) | ExprKind::Plus(inner) => self.value(inner),
            ExprKind::Negate(inner) => Some(Known::Number(number(inner).negated())),
            ExprKind::Variable(variable) => self.value_of(variable),
            ExprKind::Binary(op @ (BinaryOp::Multiply | BinaryOp::Divide), operands) => {
                let [a, b] = [&operands[0], &operands[1]].map(number);
                Some(Known::Number(if *op == BinaryOp::Divide { a.by(&b) } else { a.times(&b) }))
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
            ExprKind::Call { function: function @ (Func::Round | Func::Abs), arguments, .. } => {
                let [of] = arguments.as_slice() else { return any };
                let of = number(of);
                Some(Known::Number(if *function == Func::Abs { of.absolute() } else { of.to_whole() }))
            }
            // Arithmetic and functions never yield vacancy.
            _ => any,
        }
    }

    fn says(&self, question: Question, answer: &str) -> bool {
        let row = self.control.behaviour(question);
        row.is_some_and(|row| (row.origin.is_settled() || self.looks.as_run) && row.value == answer)
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
