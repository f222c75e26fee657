//! What may stand once in an NC block of the common form stands once.

use crate::canon::{Group, Op, Role};
use crate::dialect::Question;
use crate::ir::{Expr, NcItem};
use crate::lower::fadal::build::Lowering;
use crate::text::Span;

impl<'b> Lowering<'b> {
    /// A letter that stands twice: the same value once, else it is not understood.
    pub(super) fn doubled(&mut self, items: &mut Vec<NcItem>, span: Span) -> Option<()> {
        let mut seen: Vec<(Role, Expr)> = Vec::new();
        let mut clash = None;
        let mut twice = false;
        items.retain(|item| {
            let NcItem::Word(role, value) = item else { return true };
            match seen.iter().find(|(other, _)| other == role) {
                Some((_, same)) if same == value => {
                    twice = true;
                    false
                }
                Some(_) => {
                    clash = Some(*role);
                    false
                }
                None => {
                    seen.push((*role, value.clone()));
                    true
                }
            }
        });
        if twice {
            self.suppose(Question::WordTwice, "true", span);
        }
        match clash {
            Some(role) => self.refuse(span, format!("the block gives '{role}' twice, with different values")),
            None => Some(()),
        }
    }

    /// Takes out the operations that would be the second of their group: the end of a cycle
    /// beside an interpolation acts before it, and coolants add up. Others contradict.
    pub(super) fn grouped(&mut self, items: &mut Vec<NcItem>, span: Span) -> Option<Vec<Op>> {
        let mut before = Vec::new();
        let mut kept: Vec<Op> = Vec::new();
        let ops: Vec<Op> = items.iter().filter_map(op_in).collect();
        let mut clash = false;
        items.retain(|item| {
            let Some(op) = op_in(item) else { return true };
            let others = || ops.iter().filter(|other| **other != op && other.group() == op.group());
            if kept.contains(&op) {
                return false;
            }
            let aside = match op {
                Op::CycleOff => others().all(|other| !other.is_cycle()) && others().next().is_some(),
                Op::Mist => ops.contains(&Op::Flood),
                _ => false,
            };
            if aside {
                before.push(op);
                return false;
            }
            clash |= op.group() != Group::OneShot && kept.iter().any(|other| other.group() == op.group());
            kept.push(op);
            true
        });
        before.dedup();
        if clash {
            let _ = self.rely(Question::OneGPerGroup, span);
            return self.refuse(span, "two codes of the block contradict each other");
        }
        Some(before)
    }
}

fn op_in(item: &NcItem) -> Option<Op> {
    match item {
        NcItem::Op(op) => Some(*op),
        _ => None,
    }
}
