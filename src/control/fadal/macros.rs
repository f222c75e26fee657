//! The statements of macro lines.

use super::registers::Register;
use super::{At, Interpreter};
use crate::canon::{Op, Pause};
use crate::control::session::{Flow, Halt};
use crate::control::trace::EventKind;
use crate::dialect::Question;
use crate::syntax::{Item, ItemKind, SetOption, Target, VarRef};

impl Interpreter<'_, '_> {
    /// Runs a statement; words and what has no effect are not its business.
    pub(super) fn statement(&mut self, kind: &ItemKind) -> Flow<()> {
        match kind {
            ItemKind::Assign { target, value, .. } => {
                let value = self.value(value)?;
                self.assign(target, value)?;
            }
            ItemKind::If { condition, body, .. } => {
                let holds = self.condition(condition)?;
                self.session.branch(i64::from(holds));
                if holds {
                    return self.statements(body);
                }
            }
            ItemKind::Goto(target) => self.goto(target)?,
            ItemKind::Print { parts, stay, .. } => self.print(parts, *stay)?,
            ItemKind::Input { targets, .. } => {
                // The run waits here, so that nothing is under way after it.
                self.moving = false;
                // What was printed to ask for it is on the screen by now.
                self.flush();
                for target in targets {
                    let answer = self.session.answer();
                    self.assign(target, answer)?;
                }
            }
            ItemKind::Clear(ranges) => self.clear(ranges)?,
            ItemKind::Set(options) => self.set(options),
            ItemKind::Wait => (self.moving, self.waited) = (false, true),
            ItemKind::Start(program) => self.start(program)?,
            ItemKind::Index(text) => {
                let code = Some(format!("INDEX {text}"));
                self.session.trace.push(EventKind::Other { operation: Op::MachineSpecific, code });
            }
            ItemKind::Word(_) => return Err(Halt::Error("words cannot stand on a macro line".into())),
            _ => {}
        }
        Ok(())
    }

    /// Runs what stands after THEN.
    fn statements(&mut self, body: &[Item]) -> Flow<()> {
        // An IF after THEN is as deep as the reader of blocks allows.
        body.iter().try_for_each(|item| self.statement(&item.kind))
    }

    fn goto(&mut self, target: &Target) -> Flow<()> {
        match target {
            Target::Label(label) => {
                let at = self.outline().label(label);
                self.at.index = at.ok_or_else(|| self.session.no_label("the label is not there"))?;
            }
            Target::Sequence(number) => self.jump(*number)?,
            Target::Computed(expr) => {
                self.session.act_as(Question::GotoComputed, "true");
                let number = self.value(expr)?;
                // A float outside the range becomes its nearest end.
                self.jump(number.round() as u32)?;
            }
        }
        Ok(())
    }

    /// Jumps to a sequence number of the running program.
    pub(super) fn jump(&mut self, number: u32) -> Flow<()> {
        let Some((at, again)) = self.outline().sequence(number) else {
            return Err(self.session.no_label(&format!("N{number} is not there")));
        };
        if again {
            self.session.act_as(Question::GotoForwardFirst, "false");
        }
        self.at.index = at;
        Ok(())
    }

    fn clear(&mut self, ranges: &[(VarRef, Option<VarRef>)]) -> Flow<()> {
        if ranges.is_empty() {
            for name in self.registers.clear_all() {
                self.session.wrote(|| name, Some(0.0));
            }
        }
        for (from, to) in ranges {
            let Some(to) = to else {
                self.assign(from, 0.0)?;
                continue;
            };
            let (first, last) = (self.subscript(from)?, self.subscript(to)?);
            // Both ends must be there, then all between them are.
            let ends = (self.register(from, first)?, self.register(to, last)?);
            if !matches!(ends, (Some(Register::V(_)), Some(Register::V(_)))) {
                return Err(Halt::Error("a range to clear goes from one V to another".into()));
            }
            for number in first.unwrap_or(1)..=last.unwrap_or(0) {
                if let Some(register) = Register::new("V", number) {
                    self.keep(register, 0.0);
                }
            }
        }
        Ok(())
    }

    fn set(&mut self, options: &[SetOption]) {
        if options.is_empty() {
            (self.registers.radians, self.registers.places) = (false, None);
        }
        for option in options {
            match option {
                SetOption::Degrees => self.registers.radians = false,
                SetOption::Radians => self.registers.radians = true,
                SetOption::Round(places) => {
                    let most = self.session.control.limit("round.places").unwrap_or(u32::MAX);
                    if u32::from(*places) > most {
                        self.session.trace.doubt("limit:round.places");
                    }
                    self.registers.places = Some((*places).min(15));
                }
                SetOption::Debug | SetOption::Run => {}
            }
        }
    }

    /// Goes over to another program for good; the operator starts it.
    fn start(&mut self, program: &crate::syntax::Expr) -> Flow<()> {
        let number = self.value(program)?.round() as u32;
        let Some(section) = self.session.sections.numbered(number) else {
            return Err(Halt::Error(format!("program {number} is not in the library")));
        };
        if self.depth > 0 {
            self.session.trace.doubt("machine:start.in.subprogram");
        }
        self.session.pause(Pause::Stop, EventKind::Stop);
        self.at = At { section, index: 0 };
        self.level = super::Level::Main;
        self.modal.clear();
        Ok(())
    }
}
