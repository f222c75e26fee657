//! Drilling cycles: what they take from variables, and where their holes end.
//!
//! The course has the planes alone. Which variable holds the depth of a peck or a dwell only the profile of a machine says: a
//! block that sets another one beside a cycle is refused until it does.

use super::Lowering;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BinOp, Class, Expr, Nc, NcItem, Var};
use crate::lower::common::constant;
use crate::syntax::{Index, Item, ItemKind, VarRef};
use crate::text::Span;

/// Milliseconds of a second.
const MILLISECONDS: f64 = 1000.0;

impl Lowering<'_> {
    /// Adds what a cycle takes from elsewhere.
    pub(super) fn cycle(&mut self, op: Op, nc: &mut Nc, items: &[Item], span: Span) {
        let mut read = Vec::new();
        if nc.word(Role::Z).is_none() {
            for (role, name) in
                [(Role::CycleR, Question::CycleVariableRetract), (Role::Z, Question::CycleVariableDepth)]
            {
                let number =
                    self.findings.behaviour(name, span).and_then(|number| number.parse::<u32>().ok());
                match number {
                    Some(number) => {
                        self.add(nc, NcItem::Word(role, self.held(number, items)), span);
                        read.push(number);
                    }
                    None => {
                        self.findings.not_understood(span, "no source says which variables the cycle reads");
                    }
                }
            }
            match self.findings.behaviour(Question::CycleReturns, span) {
                Some("retract") => self.add(nc, NcItem::Op(Op::ReturnR), span),
                Some(_) => {}
                None => {
                    let why = "holes are taken to end in the plane that the tool was in when the cycle began";
                    self.findings.unconfirmed(Question::CycleReturns.fact().into(), Some(why), span);
                }
            }
        }
        if let Some((question, role)) = more_of(op).filter(|(_, role)| nc.word(*role).is_none()) {
            let said = self.findings.behaviour(question, span).and_then(|number| number.parse::<u32>().ok());
            match said {
                // Such a machine takes it from elsewhere.
                Some(0) => {}
                Some(number) => {
                    let value = self.held(number, items);
                    if value.constant().is_some_and(|value| value < 0.0) {
                        self.findings
                            .not_understood(span, format!("V{number} is negative: {}", question.meaning()));
                    }
                    self.add(nc, NcItem::Word(role, in_common(role, value)), span);
                    read.push(number);
                }
                None => return self.ask(question, strange(items, &read), span),
            }
        }
        if let Some((variable, at)) = strange(items, &read) {
            let message = format!(
                "no source says what {} is to this drilling cycle, which takes {} alone",
                shown(variable),
                read.iter().map(|number| format!("V{number}")).collect::<Vec<_>>().join(", ")
            );
            let help = "if it is nothing to the cycle, give its assignment a block of its own. If it is the depth of a peck or a dwell, say \
                        in the machine profile that the code is another cycle: op = \"cycle.peck\" or op = \"cycle.drill.dwell\"";
            self.findings.add(Diagnostic::new(Code::NotUnderstood, at, message).with_help(help));
        }
    }

    /// What a variable holds when the words of the block act: the number that it is given there, or the variable.
    fn held(&self, number: u32, items: &[Item]) -> Expr {
        let own = |item: &&Item| written(item).is_some_and(|target| target.index == Index::Number(number));
        let given = items.iter().rfind(own).and_then(|item| match &item.kind {
            ItemKind::Assign { value, .. } => constant(value),
            _ => None,
        });
        given.map_or(Expr::Var(Var { class: Class::Global, number }), Expr::Number)
    }

    /// Asks which variable holds what a cycle of this kind needs.
    fn ask(&mut self, question: Question, likely: Option<(&VarRef, Span)>, span: Span) {
        let name = question.name();
        let number = match likely.map(|(variable, _)| &variable.index) {
            Some(Index::Number(number)) => *number,
            _ => 3,
        };
        let message = format!("no source says this of the control: {}", question.meaning());
        let help = format!(
            "write it into the machine profile, under [behaviours]: \"{name}\" = {number}; or 0 if the machine takes it from \
             elsewhere"
        );
        let at = likely.map_or(span, |(_, at)| at);
        let finding = Diagnostic::new(Code::NotUnderstood, at, message).with_help(help);
        self.findings.add(finding.lacking(format!("behaviour.{name}={number}")));
    }
}

/// What a cycle takes beside its planes.
fn more_of(op: Op) -> Option<(Question, Role)> {
    match op {
        Op::CyclePeck | Op::CycleChipBreak => Some((Question::CycleVariablePeck, Role::CycleQ)),
        Op::CycleDrillDwell | Op::CycleBoreDwell => Some((Question::CycleVariableDwell, Role::CycleDwell)),
        _ => None,
    }
}

/// A variable counts seconds, and the common form milliseconds.
fn in_common(role: Role, value: Expr) -> Expr {
    match (role, value) {
        (Role::CycleDwell, Expr::Number(seconds)) => Expr::Number(seconds * MILLISECONDS),
        (Role::CycleDwell, value) => Expr::binary(BinOp::Mul, value, Expr::Number(MILLISECONDS)),
        (_, value) => value,
    }
}

/// The variable that an item sets.
fn written(item: &Item) -> Option<&VarRef> {
    match &item.kind {
        ItemKind::Assign { target, .. } | ItemKind::Step { target, .. } => Some(target),
        ItemKind::Timer(target) => Some(target),
        _ => None,
    }
}

/// The first variable that a block sets, other than these.
fn strange<'i>(items: &'i [Item], read: &[u32]) -> Option<(&'i VarRef, Span)> {
    let mut set = items.iter().filter_map(|item| Some((written(item)?, item.span)));
    let known = |variable: &VarRef| matches!(variable.index, Index::Number(number) if read.contains(&number));
    set.find(|(variable, _)| !known(variable))
}

fn shown(variable: &VarRef) -> String {
    match &variable.index {
        Index::Number(number) => format!("V{number}"),
        _ => "another variable".into(),
    }
}
