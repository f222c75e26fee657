//! Variables and arrays: V and R, and the state of the machine by its names.

use super::Interpreter;
use super::registers::{PLANE, Register};
use crate::canon::{Group, Op, Sys};
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::dialect::Question;
use crate::syntax::{Index, VarRef};
use std::collections::BTreeMap;

impl Interpreter<'_, '_> {
    /// The value of a variable.
    pub(super) fn variable(&mut self, variable: &VarRef) -> Flow<f64> {
        let number = self.subscript(variable)?;
        if let Some(register) = self.register(variable, number)? {
            return Ok(self.registers.get(register).unwrap_or_else(|| {
                // Nothing has set it since the control was switched on.
                self.session.act_as(Question::CommonAtPowerOn, "");
                0.0
            }));
        }
        let control = self.session.control;
        let Some((state, subscripts, row)) = control.read_system(&variable.name, number) else {
            return Err(nothing(variable, number).into());
        };
        if row.access == "w" {
            return Err(Stop::unnamed(format!("{} can only be written", variable.name)).into());
        }
        self.session.trace.rest_on(row);
        self.state(state, &subscripts).ok_or_else(|| nothing(variable, number).into())
    }

    fn state(&mut self, state: Sys, subscripts: &[u32]) -> Option<f64> {
        let session = &mut self.session;
        let state = match state {
            Sys::AxisPosition => {
                if self.moving {
                    // Without WAIT the line is worked out while the axes still move.
                    session.trace.doubt(Question::LookaheadRunsEarly.fact());
                }
                session.rest_on(Question::PositionFrame);
                match session.control.behaviour(Question::PositionFrame).map(|row| row.value.as_str()) {
                    Some("machine") => Sys::MachinePosition,
                    _ => Sys::WorkPosition,
                }
            }
            Sys::ModalMotionPlus1 => return Some(self.code_in_force(Group::Motion)? + 1.0),
            // By the common number of the group. That one is added is stated for the first group only.
            Sys::Modal => {
                let group = match subscripts.first()? {
                    2 => Group::Plane,
                    3 => Group::Distance,
                    7 => Group::RadiusComp,
                    9 => Group::Cycle,
                    10 => Group::ReturnPlane,
                    _ => return None,
                };
                return self.code_in_force(group);
            }
            other => other,
        };
        session.machine.read(state, subscripts, &mut session.trace)
    }

    /// The number of the G code that is in force in a group.
    fn code_in_force(&self, group: Group) -> Option<f64> {
        let op: Op = self.session.machine.modal(group)?;
        let row = self.session.control.code_for(op, &BTreeMap::new())?;
        Some(row.head()?.number())
    }

    /// Writes a variable.
    pub(super) fn assign(&mut self, variable: &VarRef, value: f64) -> Flow<()> {
        let number = self.subscript(variable)?;
        if let Some(register) = self.register(variable, number)? {
            self.keep(register, value);
            return Ok(());
        }
        let session = &mut self.session;
        let control = session.control;
        let Some((state, subscripts, row)) = control.read_system(&variable.name, number) else {
            return Err(nothing(variable, number).into());
        };
        if row.access == "r" {
            return Err(Stop::unnamed(format!("{} can only be read", variable.name)).into());
        }
        session.trace.rest_on(row);
        Ok(session.machine.write(state, &subscripts, value, &mut session.trace)?)
    }

    /// Gives a V or R its value.
    pub(super) fn keep(&mut self, register: Register, value: f64) {
        self.plane_moved |= register == PLANE;
        self.registers.set(register, value);
        self.session.wrote(|| register.to_string(), Some(value));
    }

    /// The V or R of a name; none for other names.
    pub(super) fn register(&mut self, variable: &VarRef, number: Option<u32>) -> Flow<Option<Register>> {
        if !matches!(&*variable.name, "V" | "R") {
            return Ok(None);
        }
        let register = number.and_then(|number| Register::new(&variable.name, number));
        let class = number.and_then(|number| self.session.control.variable_class(&variable.name, number));
        if let Some(class) = class {
            self.session.trace.rest_on(class);
        }
        register.map(Some).ok_or_else(|| nothing(variable, number).into())
    }

    /// The subscript; a computed one with a fraction is rounded, which nobody confirms.
    pub(super) fn subscript(&mut self, variable: &VarRef) -> Flow<Option<u32>> {
        let expr = match &variable.index {
            Index::None => return Ok(None),
            Index::Number(number) => return Ok(Some(*number)),
            Index::Computed(expr) => expr,
            Index::Bit(..) | Index::Letter(_) | Index::Name(_) => {
                return Err(Halt::Error("the control has no such variable".into()));
            }
        };
        let value = self.value(expr)?;
        if value.fract() != 0.0 {
            self.session.act_as(Question::IndexOfFraction, "round");
        }
        let rounded = value.round();
        if !(0.0..=f64::from(u32::MAX)).contains(&rounded) {
            return Err(Stop::unnamed(format!("{} has no subscript {value}", variable.name)).into());
        }
        Ok(Some(rounded as u32))
    }
}

fn nothing(variable: &VarRef, number: Option<u32>) -> Stop {
    let number = number.map(|number| number.to_string()).unwrap_or_default();
    Stop::unnamed(format!("there is no {}{number}", variable.name))
}
