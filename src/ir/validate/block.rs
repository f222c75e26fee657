//! Checks blocks: statements, terminators, calls.

use super::{Check, Problem, exists};
use crate::canon::{Group, Op, Role};
use crate::ir::{BlockId, Call, Callee, Class, Cond, Expr, Nc, NcItem, Place, Stmt, StmtKind, TermKind};
use crate::syntax::Label;
use std::collections::BTreeSet;

/// True for a branch on the switch of this level.
fn goes_round(term: &TermKind, level: u8) -> bool {
    matches!(term, TermKind::Branch { cond, .. } if **cond == Cond::Switch(level))
}

impl Check<'_> {
    pub(super) fn blocks(&mut self) {
        let program = self.program;
        let labels: BTreeSet<u32> = program.blocks.iter().flat_map(|b| numbers(&b.labels)).collect();
        for (id, block) in program.ids().zip(&program.blocks) {
            self.block = Some(id);
            for (at, stmt) in block.stmts.iter().enumerate() {
                self.statement = Some(at);
                self.stmt(stmt);
            }
            self.statement = None;
            if let Some(level) = block.term.site.skip.filter(|level| !goes_round(&block.term.kind, *level)) {
                self.add(Problem::Skip(level));
            }
            self.term(&block.term.kind, &labels);
        }
    }

    fn stmt(&mut self, stmt: &Stmt) {
        if let Some(level) = stmt.site.skip.filter(|level| !(1..=9).contains(level)) {
            self.add(Problem::Skip(level));
        }
        if let Some(Place::Var(var)) = stmt.kind.target()
            && !exists(*var)
        {
            self.add(Problem::Variable(*var));
        }
        match &stmt.kind {
            StmtKind::Nc(nc) => self.nc(nc),
            StmtKind::ModalCall(call) => self.call(call),
            StmtKind::Assign { target: Place::Var(var), value: Expr::Vacant } if !var.class.nullable() => {
                self.add(Problem::NeverVacant(*var));
            }
            StmtKind::ClearAll(class) if class.nullable() || matches!(class, Class::Temp | Class::Static) => {
                self.add(Problem::Clear);
            }
            StmtKind::SetNames { first, .. } if !exists(*first) => self.add(Problem::Variable(*first)),
            kind => kind.exprs(&mut |e| self.value(e)),
        }
        if let StmtKind::ModalCall(call) = &stmt.kind
            && let Callee::Block(entry) = &call.callee
        {
            self.target(*entry);
        }
    }

    fn nc(&mut self, nc: &Nc) {
        for (at, item) in nc.items.iter().enumerate() {
            let before = nc.items.iter().take(at);
            match item {
                NcItem::Op(op) => {
                    if op.is_flow() {
                        self.add(Problem::Flow(*op));
                    }
                    if before
                        .into_iter()
                        .any(|other| matches!(other, NcItem::Op(other) if clash(*other, *op)))
                    {
                        self.add(Problem::Group(op.group()));
                    }
                }
                NcItem::Word(role, value) => {
                    // A machine builder's code may have several words of its own.
                    let same = |other: &NcItem| matches!(other, NcItem::Word(other, _) if other == role);
                    if *role != Role::Builder && before.into_iter().any(same) {
                        self.add(Problem::Role(*role));
                    }
                    self.word(value);
                }
                NcItem::Code(letter, value) => {
                    if !matches!(letter, 'G' | 'M') {
                        self.add(Problem::Letter(*letter));
                    }
                    self.value(value);
                }
            }
        }
    }

    fn call(&mut self, call: &Call) {
        let mut locals = BTreeSet::new();
        for argument in &call.arguments {
            let var = crate::ir::Var { class: Class::Local, number: argument.local };
            if !exists(var) {
                self.add(Problem::Variable(var));
            }
            if !locals.insert(argument.local) {
                self.add(Problem::ArgumentTwice(argument.local));
            }
            self.word(&argument.value);
        }
        if !call.level && !call.arguments.is_empty() {
            self.add(Problem::NoLevel);
        }
        if let Callee::Computed(number) = &call.callee {
            self.value(number);
        }
        call.count.iter().for_each(|count| self.value(count));
    }

    fn term(&mut self, kind: &TermKind, labels: &BTreeSet<u32>) {
        match kind {
            TermKind::Call { call, .. } => self.call(call),
            TermKind::Branch { cond, .. } => self.cond(cond),
            kind => kind.exprs(&mut |e| self.value(e)),
        }
        kind.clone().for_each_target(&mut |to| self.target(*to));
        if let TermKind::Computed { targets, .. } = kind {
            self.computed(targets, labels);
        }
    }

    /// Every label is a target once, and a target has its label.
    fn computed(&mut self, targets: &[(u32, BlockId)], labels: &BTreeSet<u32>) {
        let mut seen = BTreeSet::new();
        for (label, target) in targets {
            if !seen.insert(*label) {
                self.add(Problem::LabelTwice(*label));
            }
            let block = self.program.block(*target);
            if block.is_some_and(|block| !numbers(&block.labels).any(|number| number == *label)) {
                self.add(Problem::Label { label: *label, target: *target });
            }
        }
        labels.difference(&seen).for_each(|label| self.add(Problem::LabelLeftOut(*label)));
    }

    fn target(&mut self, id: BlockId) {
        if self.program.block(id).is_none() {
            self.add(Problem::NoBlock(id));
        }
    }
}

/// True where the two cannot act in one block. Ending a cycle goes with any motion (`G80 G0`),
/// and the two ways of cooling go together.
fn clash(a: Op, b: Op) -> bool {
    let cancel = a != b && (a == Op::CycleOff || b == Op::CycleOff);
    let cooling = matches!((a, b), (Op::Mist, Op::Flood) | (Op::Flood, Op::Mist));
    a.group() == b.group() && a.group() != Group::OneShot && !cancel && !cooling
}

fn numbers(labels: &[Label]) -> impl Iterator<Item = u32> + '_ {
    labels.iter().filter_map(|label| match label {
        Label::Number(number) => Some(*number),
        Label::Name(_) => None,
    })
}
