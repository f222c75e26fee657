//! Assignments, steps, tests, transfers and branches.

use super::Interpreter;
use crate::canon::{Op, Role, Sys};
use crate::control::outcome::Stop;
use crate::control::session::Flow;
use crate::dialect::Question;
use crate::syntax::{Cell, Expr, ExprKind, ItemKind, Label, Table, TableRow, Target, TestSubject, VarRef};

impl Interpreter<'_, '_> {
    /// Runs a statement; true where it jumped.
    pub(super) fn statement(&mut self, kind: &ItemKind) -> Flow<bool> {
        match kind {
            ItemKind::Assign { target, value, .. } => self.assign(target, value)?,
            ItemKind::Step { target, down } => self.step_by_one(target, *down)?,
            ItemKind::Test(subject) => self.test(subject)?,
            ItemKind::Timer(target) => {
                let session = &mut self.session;
                let seconds = session.machine.read(Sys::CycleSeconds, &[], &mut session.trace).unwrap_or(0.0);
                let cell = self.cell(target)?;
                self.keep(cell, seconds);
                self.condition.load(seconds);
            }
            ItemKind::Transfer { table, cells } => {
                cells.iter().try_for_each(|cell| self.transfer(table, cell))?;
            }
            ItemKind::Branch { relation, target } => {
                let holds = self.condition.holds(*relation, &mut self.session.trace);
                self.session.branch(i64::from(holds));
                if holds {
                    self.branch(target)?;
                }
                return Ok(holds);
            }
            _ => {}
        }
        Ok(false)
    }

    fn assign(&mut self, target: &VarRef, value: &Expr) -> Flow<()> {
        let cell = self.cell(target)?;
        let result = self.value(value)?;
        self.keep(cell, result);
        match value.kind {
            ExprKind::Binary(..) => self.condition.set(result),
            _ => self.condition.load(result),
        }
        Ok(())
    }

    /// Gives a variable its value.
    fn keep(&mut self, cell: super::store::Cell, value: f64) {
        self.store.set(cell, value);
        self.session.wrote(|| cell.name(), Some(value));
    }

    /// INC and DEC: the fraction goes first.
    fn step_by_one(&mut self, target: &VarRef, down: bool) -> Flow<()> {
        let cell = self.cell(target)?;
        let before = self.store.get(cell).unwrap_or_else(|| {
            self.session.act_as(Question::InitialValue, "zero");
            0.0
        });
        if before < 0.0 && before.fract() != 0.0 {
            self.session.act_as(Question::FixTowardZero, "true");
        }
        let after = before.trunc() + if down { -1.0 } else { 1.0 };
        self.keep(cell, after);
        self.condition.set(after);
        Ok(())
    }

    fn test(&mut self, subject: &TestSubject) -> Flow<()> {
        let result = match subject {
            TestSubject::Variable(variable) => {
                let cell = self.cell(variable)?;
                self.store.get(cell).unwrap_or_else(|| {
                    self.session.act_as(Question::InitialValue, "zero");
                    0.0
                })
            }
            // Zero stands for yes.
            TestSubject::Code(number) => f64::from(u8::from(!self.is_active(*number))),
            TestSubject::Flag('M') => f64::from(u8::from(self.session.machine.is_inch())),
            // No code of this control mirrors; the switch of an axis is the operator's.
            TestSubject::Flag(_) => 1.0,
        };
        self.condition.set(result);
        Ok(())
    }

    fn is_active(&mut self, number: u32) -> bool {
        let session = &mut self.session;
        let control = session.control;
        let Some(row) = control.code('G', f64::from(number), &[]) else {
            session.trace.doubt("machine:test.of.code");
            return false;
        };
        session.trace.rest_on(row);
        match session.machine.modal(row.op.group()) {
            Some(Op::SelectWork) if row.op == Op::SelectWork => {
                row.fixed.get(&Role::WorkOffset) == Some(&f64::from(session.machine.work_offset()))
            }
            Some(op) => op == row.op,
            None => {
                session.trace.doubt("machine:test.of.code");
                false
            }
        }
    }

    /// `COR=T10 R=V1`, `TRF=G54 V1=X`.
    fn transfer(&mut self, table: &Table, cell: &Cell) -> Flow<()> {
        let row = match &table.row {
            TableRow::Word(_, number) => *number,
            TableRow::Variable(variable) => {
                let place = self.cell(variable)?;
                let number = self.store.get(place).unwrap_or(0.0);
                if number.fract() != 0.0 {
                    self.session.act_as(Question::IndexOfFraction, "round");
                }
                // A float outside the range becomes its nearest end.
                number.round() as u32
            }
        };
        let session = &mut self.session;
        let control = session.control;
        let (name, letter) = (&table.name, cell.letter);
        let found = match name.as_str() {
            "COR" => control.read_system(&format!("COR {letter}"), Some(row)),
            _ => control.read_system(&format!("{name}=G{row} {letter}"), None),
        };
        let Some((state, subscripts, fact)) = found else {
            return Err(Stop::unnamed(format!("{name} {row} has no {letter}")).into());
        };
        session.trace.rest_on(fact);
        let place = super::store::Cell::of(&cell.variable)
            .ok_or_else(|| Stop::unnamed("there is no such variable"))?;
        if cell.store {
            if fact.access == "r" {
                return Err(Stop::unnamed(format!("{name} {row} can only be read")).into());
            }
            let value = self.store.get(place).unwrap_or_else(|| {
                session.act_as(Question::InitialValue, "zero");
                0.0
            });
            return Ok(session.machine.write(state, &subscripts, value, &mut session.trace)?);
        }
        let value = match state {
            Sys::Pole => {
                Some(if subscripts.first() == Some(&1) { self.polar.pole.0 } else { self.polar.pole.1 })
            }
            _ => session.machine.read(state, &subscripts, &mut session.trace),
        };
        let value = value.ok_or_else(|| Stop::unnamed(format!("{name} {row} has no {letter}")))?;
        self.keep(place, value);
        self.condition.load(value);
        Ok(())
    }

    fn branch(&mut self, target: &Target) -> Flow<()> {
        match target {
            Target::Label(Label::Number(number)) | Target::Sequence(number) => self.jump(*number),
            Target::Label(Label::Name(name)) => {
                Err(self.session.no_label(&format!("there is no label {name}")))
            }
            Target::Computed(expr) => {
                let number = self.operand(expr)?;
                if number.fract() != 0.0 {
                    self.session.act_as(Question::IndexOfFraction, "round");
                }
                self.jump(number.round() as u32)
            }
        }
    }
}
