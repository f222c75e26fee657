//! Ways of branches that constants make impossible.
//!
//! `#100=6000` and in the next block `IF[#100GT2500]`: no circumstances go the other way, so nothing is missed where none
//! did. Looked at is what stands in one row: whatever may be come to from elsewhere, calls, or moves (a call may hang on
//! them) ends what is known. What compares a vacant variable counts only where a source confirms how.

use super::names::{Side, class_of};
use crate::canon::Sys;
use crate::control::ProgramRef;
use crate::dialect::Control;
use crate::syntax::{BinaryOp, Expr, ExprKind, Index, Item, ItemKind, VarRef};
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet};

/// What is known of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    Vacant,
    Number(f64),
    /// A number, and not which.
    SomeNumber,
}

/// The conditions of a program and the way that each of them never goes: 1 for true, 0 for false.
pub fn impossible(side: &Side<'_>, program: ProgramRef) -> BTreeSet<(Span, i64)> {
    let mut reader = Reader { control: side.control, known: BTreeMap::new(), out: BTreeSet::new() };
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
    known: BTreeMap<String, Known>,
    out: BTreeSet<(Span, i64)>,
}

impl Reader<'_> {
    fn item(&mut self, item: &Item) {
        use ItemKind::*;
        match &item.kind {
            Assign { target, value, .. } => {
                let value = self.value(value);
                match (self.name(target), value) {
                    (Some(name), Some(value)) => {
                        self.known.insert(name, value);
                    }
                    (Some(name), None) => {
                        self.known.remove(&name);
                    }
                    (None, _) => self.known.clear(),
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
                            Some(name) => {
                                self.known.remove(&name);
                            }
                            // An alarm, an output, an offset: no variable of a program.
                            None if self.is_system(target) => {}
                            None => self.known.clear(),
                        },
                        Goto(_) | Comment(_) | EndOfBlock => {}
                        _ => self.known.clear(),
                    }
                }
            }
            Comment(_) | MacroMark | EndOfBlock | Tape | Program(_) | Skip(_) => {}
            _ => self.known.clear(),
        }
    }

    /// The name of a variable that nothing but a program writes; none of any other, which might be any.
    fn name(&self, variable: &VarRef) -> Option<String> {
        let Index::Number(number) = variable.index else { return None };
        let name = format!("{}{number}", variable.name);
        let own = self.control.read_system(&variable.name, Some(number)).is_none();
        (own && class_of(self.control, &name).is_some()).then_some(name)
    }

    fn is_system(&self, variable: &VarRef) -> bool {
        let Index::Number(number) = variable.index else { return false };
        self.control.read_system(&variable.name, Some(number)).is_some()
    }

    fn value(&self, e: &Expr) -> Option<Known> {
        match &e.kind {
            ExprKind::Number(number) => Some(Known::Number(number.value)),
            ExprKind::Group(inner) | ExprKind::Plus(inner) => self.value(inner),
            ExprKind::Negate(inner) => match self.value(inner) {
                Some(Known::Number(number)) => Some(Known::Number(-number)),
                _ => Some(Known::SomeNumber),
            },
            ExprKind::Variable(variable) => {
                let Index::Number(number) = variable.index else { return None };
                match self.control.read_system(&variable.name, Some(number)) {
                    Some((Sys::Empty, ..)) => Some(Known::Vacant),
                    Some(_) => None,
                    None => self.known.get(&self.name(variable)?).copied(),
                }
            }
            // Arithmetic and functions never yield vacancy.
            _ => Some(Known::SomeNumber),
        }
    }

    /// Whether a condition holds, where that is known.
    fn holds(&self, e: &Expr) -> Option<bool> {
        use BinaryOp::*;
        let (op, a, b) = match &e.kind {
            ExprKind::Group(inner) => return self.holds(inner),
            ExprKind::Binary(op, a, b) => (*op, self.value(a)?, self.value(b)?),
            _ => return None,
        };
        if matches!(op, Equal | NotEqual) {
            let same = match (a, b) {
                (Known::Number(a), Known::Number(b)) => a == b,
                (Known::Vacant, Known::Vacant) => true,
                (Known::Vacant, Known::Number(other)) | (Known::Number(other), Known::Vacant)
                    if other != 0.0 =>
                {
                    false
                }
                (Known::Vacant, _) | (_, Known::Vacant) => {
                    self.says("vacant.eq.zero", "false").then_some(false)?
                }
                _ => return None,
            };
            return Some(same == (op == Equal));
        }
        let number = |known: Known| match known {
            Known::Number(number) => Some(number),
            Known::Vacant => self.says("vacant.compares.as.zero", "true").then_some(0.0),
            Known::SomeNumber => None,
        };
        let (a, b) = (number(a)?, number(b)?);
        Some(match op {
            Less => a < b,
            LessEqual => a <= b,
            Greater => a > b,
            GreaterEqual => a >= b,
            _ => return None,
        })
    }

    fn says(&self, behaviour: &str, answer: &str) -> bool {
        let row = self.control.behaviour(behaviour);
        row.is_some_and(|row| row.origin.confirmed && row.value == answer)
    }
}
