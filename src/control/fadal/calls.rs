//! Calls: subroutines by L, programs by M98, and the modal call of G66.

use super::{At, Interpreter, Level, Next};
use crate::canon::Op;
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::control::trace::EventKind;
use crate::dialect::Question;

/// How deep calls nest before the emulation gives up; no source states a limit.
const DEEPEST: u32 = 40;

/// A call `Lsnn`: subroutine s, nn times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Local {
    number: u32,
    count: u32,
}

impl Local {
    /// The call that a value of L means; none below 100, where L counts repeats.
    pub fn new(value: u32) -> Option<Self> {
        (value >= 100).then_some(Local { number: value / 100, count: value % 100 })
    }
}

/// The first of the subroutines that the control keeps: L9101.
const FIRST_FIXED: u32 = 91;

impl Interpreter<'_, '_> {
    /// Runs a subroutine of the running program.
    pub(super) fn call_local(&mut self, call: Local) -> Flow<()> {
        let Some(index) = self.outline().subroutine(call.number) else {
            let number = call.number;
            return Err(match number {
                FIRST_FIXED.. => {
                    Halt::Error(format!("the control's own subroutine L{number:02}.. is not emulated"))
                }
                _ => self.session.no_label(&format!("subroutine L{number}00 is not there")),
            });
        };
        if call.count == 0 {
            self.session.act_as(Question::RepeatZero, "none");
        }
        // What stands after the definition's own block.
        let to = At { section: self.at.section, index: index + 1 };
        self.call(to, Level::Subroutine, call.count)
    }

    /// Runs another program.
    pub(super) fn call_program(&mut self, number: u32, count: u32) -> Flow<()> {
        let Some(section) = self.session.sections.numbered(number) else {
            return Err(Halt::Error(format!("program O{number} is not in the library")));
        };
        if count == 0 {
            self.session.act_as(Question::RepeatZero, "none");
        }
        self.call(At { section, index: 0 }, Level::Program, count)
    }

    fn call(&mut self, to: At, level: Level, count: u32) -> Flow<()> {
        if let Some(row) = self.session.control.limit_row("call.all")
            && let Some(most) = row.max.filter(|most| self.depth >= *most)
        {
            self.session.trace.rest_on(row);
            return Err(Stop::too_deep("", "call.all", most).into());
        }
        if self.depth >= DEEPEST {
            self.session.trace.doubt("limit:call.all");
            return Err(Stop::unnamed("calls are nested too deep").into());
        }
        self.depth += 1;
        let (back, outer) = (self.at, std::mem::replace(&mut self.level, level));
        let place = self.session.trace.at;
        for _ in 0..count {
            self.session.count()?;
            self.at = to;
            let program = self.session.program_number(to.section);
            self.session.enter(program, false);
            while self.step()? == Next::On {}
            self.session.trace.push(EventKind::Leave);
            self.session.trace.at = place;
        }
        self.depth -= 1;
        (self.at, self.level) = (back, outer);
        Ok(())
    }

    /// Runs the innermost modal subroutine, whose own moves run those that were in force before it. That they do
    /// no source says; a single one never runs itself.
    pub(super) fn call_modal(&mut self) -> Flow<()> {
        let all = self.modal.clone();
        let Some(call) = self.modal.pop() else { return Ok(()) };
        let outer = std::mem::replace(&mut self.in_modal, true);
        self.call_local(call)?;
        (self.in_modal, self.modal) = (outer, all);
        Ok(())
    }

    /// M99, with the sequence number beside it.
    pub(super) fn give_back(&mut self, to: Option<u32>) -> Flow<Next> {
        if let Some(number) = to {
            if self.level != Level::Main {
                self.session.act_as(Question::M99PInCalled, "true");
            }
            self.jump(number)?;
            return Ok(Next::On);
        }
        match self.level {
            Level::Program => Ok(Next::Back),
            Level::Subroutine => {
                self.session.trace.doubt("machine:m99.in.subroutine");
                Ok(Next::Back)
            }
            // Whoever called it goes on.
            Level::Main if self.session.scenario.called => Ok(Next::Back),
            Level::Main => {
                self.session.act_as(Question::M99MainRestarts, "false");
                Err(Halt::Ended(Op::End))
            }
        }
    }

    /// M17, and M30 where it closes the subroutines.
    pub(super) fn end_subroutine(&mut self, op: Op) -> Flow<Next> {
        match (self.level, op) {
            (Level::Subroutine, _) => Ok(Next::Back),
            (_, Op::SubAreaEnd) if !self.outline().is_in_area(self.at.index.saturating_sub(1)) => {
                if self.outline().has_area() {
                    self.session.trace.doubt("machine:sub.area.end.again");
                }
                self.session.act_as(Question::EndAlone, "true");
                Err(Halt::Ended(Op::EndRewind))
            }
            _ => Err(nothing_open()),
        }
    }
}

/// The end of a subroutine, where a jump came into it and no call.
pub(super) fn nothing_open() -> Halt {
    Halt::Error("a subroutine ends that was not called: no source says what the control does".into())
}
