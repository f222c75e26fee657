//! Calls, returns, and calls after each move.

use super::code::{Coded, Words};
use super::memory::Locals;
use super::run::{Loaded, Next, Runner};
use crate::canon::Op;
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::control::trace::EventKind;

/// Calls nest no deeper than this on any control, where the table knows no limit.
const DEEPEST: usize = 100;

/// A program that runs.
pub struct Frame<'c> {
    pub program: Loaded<'c>,
    /// The block that comes next, or runs.
    pub at: usize,
    /// Where a repeat begins again.
    entry: usize,
    /// How often it is still to be repeated.
    repeats: u32,
    /// True where it has locals of its own.
    level: bool,
    /// The arguments it was called with.
    arguments: Option<Locals>,
    /// The modal call that started it.
    modal: Option<usize>,
    /// How many of the modal calls are in force here.
    visible: usize,
    /// True where an alias called it, or what called it.
    alias: bool,
}

impl<'c> Frame<'c> {
    /// The main program.
    pub fn main(program: Loaded<'c>) -> Self {
        Self::new(program, 0, 0)
    }

    fn new(program: Loaded<'c>, at: usize, visible: usize) -> Self {
        Self {
            program,
            at,
            entry: at,
            repeats: 0,
            level: false,
            arguments: None,
            modal: None,
            visible,
            alias: false,
        }
    }
}

/// What a call runs.
#[derive(Clone, Copy)]
pub enum Called {
    /// A program of the library, by section.
    Section(usize),
    /// One that stands in the machine, by its number on the source.
    Outside(u32),
}

/// A modal call in force.
pub struct ModalCall {
    program: Called,
    count: u32,
    /// Its locals: set by its own block, kept from call to call.
    locals: Locals,
    /// True where it calls after each block, not only after moves.
    each: bool,
    /// How many modal calls were in force where it was set: moves of its program call those.
    outer: usize,
}

impl<'c> Runner<'c> {
    /// True where codes that call programs do so here.
    pub fn aliases_count(&self) -> bool {
        !self.frames.last().is_some_and(|frame| frame.alias) || self.rules.alias_nested.peek()
    }

    /// A call with arguments, or the start of a modal one.
    pub fn call_macro(&mut self, words: &Words, call: Coded) -> Result<Next, Halt> {
        let arguments = self.arguments(words, call)?;
        let alias = call.alias;
        let number = alias.map(|alias| f64::from(alias.program)).or(arguments.program);
        let number = number.ok_or_else(|| Halt::Error("a call without its program".into()))?;
        let Some(called) = self.called(number) else { return Err(missing(number)) };
        let Some(count) = self.count(arguments.count) else { return Ok(Next::On) };
        let op = self.row(call.row).map_or(Op::CallMacro, |row| row.op);
        if alias.is_some_and(|alias| alias.modal) || op != Op::CallMacro {
            let each = op == Op::CallModalEach;
            let visible = self.frames.last().map_or(0, |frame| frame.visible);
            // Calls that an inner program started end with it.
            self.modal_calls.truncate(visible.max(self.outer_visible()));
            self.modal_calls.push(ModalCall {
                program: called,
                count,
                locals: arguments.locals,
                each,
                outer: visible,
            });
            let all = self.modal_calls.len();
            if let Some(frame) = self.frames.last_mut() {
                frame.visible = all;
            }
            if self.rules.modal_block_calls.ask(&mut self.session.trace) {
                return self.trigger_modal();
            }
            return Ok(Next::On);
        }
        let section = match called {
            Called::Section(section) => section,
            Called::Outside(program) => return self.call_outside(program, count, Some(arguments.locals)),
        };
        let mut frame = self.frame(section, count);
        frame.level = true;
        frame.arguments = Some(arguments.locals);
        frame.alias |= alias.is_some();
        self.memory.levels.push(arguments.locals);
        self.push(frame)
    }

    /// The most modal calls that any calling program sees.
    fn outer_visible(&self) -> usize {
        self.frames.iter().map(|frame| frame.visible).max().unwrap_or(0)
    }

    /// A call of a program that shares the caller's locals, from a sequence number on where it says one.
    pub fn call_program(
        &mut self,
        number: f64,
        (count, from): (Option<f64>, Option<f64>),
        alias: bool,
    ) -> Result<Next, Halt> {
        let (number, count) = self.repeat_digits(number.round(), count);
        let Some(called) = self.called(number) else { return Err(missing(number)) };
        let Some(count) = self.count(count) else { return Ok(Next::On) };
        let section = match called {
            Called::Section(section) => section,
            Called::Outside(_) if from.is_some() => {
                return Err(Halt::Error("a part of a program that is not in the library".into()));
            }
            Called::Outside(program) => return self.call_outside(program, count, None),
        };
        let mut frame = self.frame(section, count);
        frame.alias |= alias;
        if let Some(from) = from {
            let wanted = from.max(0.0).round() as u32;
            let places = frame.program.code.labels.get(&wanted).map_or(&[][..], Vec::as_slice);
            let [at] = places else { return Err(self.no_sequence(f64::from(wanted))) };
            if frame.program.code.loop_of.get(*at).copied().flatten().is_some() {
                self.session.trace.doubt("machine:jump.into.loop");
            }
            (frame.at, frame.entry) = (*at, *at);
        }
        self.push_subprogram(frame)
    }

    /// Enters a subprogram: with its caller's locals, where the control shares them.
    fn push_subprogram(&mut self, mut frame: Frame<'c>) -> Result<Next, Halt> {
        if !self.rules.locals_shared.ask(&mut self.session.trace) {
            frame.level = true;
            self.memory.levels.push(Locals::default());
        }
        self.push(frame)
    }

    /// `P68003` is six times O8003, where the control reads it so and its program numbers have four digits.
    fn repeat_digits(&mut self, number: f64, count: Option<f64>) -> (f64, Option<f64>) {
        let too_long = number > f64::from(self.session.control.text().program_max);
        if count.is_some() || !too_long {
            return (number, count);
        }
        let Some(row) = self.session.control.statement("call.repeat.digits") else { return (number, count) };
        self.session.trace.rest_on(row);
        (number % 10_000.0, Some((number / 10_000.0).floor()))
    }

    /// A call of a part of this program.
    pub fn call_local(&mut self, sequence: f64, count: Option<f64>) -> Result<Next, Halt> {
        let Some(frame) = self.frames.last() else { return Ok(Next::On) };
        let (program, from, visible, alias) = (frame.program, frame.at, frame.visible, frame.alias);
        let to = self.jump(sequence.max(0.0).round() as u32, from)?;
        let Some(count) = self.count(count) else { return Ok(Next::On) };
        let mut frame = Frame::new(program, to, visible);
        (frame.repeats, frame.alias) = (count - 1, alias);
        self.push_subprogram(frame)
    }

    /// How often a call runs; none for not at all.
    fn count(&mut self, count: Option<f64>) -> Option<u32> {
        match count {
            None => Some(1),
            // A float outside the range becomes its nearest end.
            Some(count) if count >= 0.5 => Some(count.round() as u32),
            Some(_) => (!self.rules.repeat_zero_none.ask(&mut self.session.trace)).then_some(1),
        }
    }

    fn called(&self, number: f64) -> Option<Called> {
        let whole = number.round();
        // In range by the test.
        let whole = (0.0..=f64::from(u32::MAX)).contains(&whole).then_some(whole as u32)?;
        let section = self.session.sections.numbered(whole).map(Called::Section);
        section.or_else(|| self.session.library().outside.source_of(whole).map(Called::Outside))
    }

    fn frame(&mut self, section: usize, count: u32) -> Frame<'c> {
        let program = self.load(section);
        let caller = self.frames.last();
        let (visible, alias) = caller.map_or((0, false), |caller| (caller.visible, caller.alias));
        let mut frame = Frame::new(program, 0, visible);
        (frame.repeats, frame.alias) = (count.saturating_sub(1), alias);
        frame
    }

    /// Starts a program; the caller goes on after its block.
    fn push(&mut self, frame: Frame<'c>) -> Result<Next, Halt> {
        self.check_depth(frame.level, self.memory.levels.len() - 1)?;
        if let Some(caller) = self.frames.last_mut() {
            caller.at += 1;
        }
        self.enter(frame.program.number, frame.level);
        self.frames.push(frame);
        Ok(Next::Block)
    }

    /// Stops where a call nests too deep; `levels` of locals are open in it, if it is one `with_level`.
    pub(super) fn check_depth(&mut self, with_level: bool, levels: usize) -> Result<(), Halt> {
        let depth = self.frames.len();
        let subs = depth - self.frames.iter().filter(|frame| frame.level).count();
        let counts = [
            ("call.all", Some(depth)),
            ("call.macro", with_level.then_some(levels)),
            ("call.subprogram", (!with_level).then_some(subs)),
        ];
        let control = self.session.control;
        for (name, count) in counts {
            if let (Some(row), Some(count)) = (control.limit_row(name), count)
                && let Some(most) = row.max.filter(|most| count > *most as usize)
            {
                self.session.trace.rest_on(row);
                return Err(Stop::too_deep(self.style.alarms.too_deep, name, most).into());
            }
        }
        if depth > DEEPEST {
            self.session.trace.doubt("limit:call.all");
            return Err(Stop::alarm(self.style.alarms.too_deep, "calls nest too deep").into());
        }
        Ok(())
    }

    /// The return from a program, to a block of the caller or of this program where one is named.
    pub fn give_back(&mut self, to: Option<f64>) -> Result<(), Halt> {
        let whole = to.map(|to| to.max(0.0).round() as u32);
        let main = self.frames.len() <= 1;
        let jumps = whole.is_some() && self.rules.return_jumps_here.peek();
        if main && self.session.scenario.called && !jumps {
            // Where the caller goes on is seen, though no caller is there.
            if let Some(number) = whole {
                let code = Some(format!("P{number}"));
                self.session.trace.push(EventKind::Other { operation: Op::Return, code });
            }
            return Err(Halt::Ended(Op::Return));
        }
        let at = self.frames.last().map_or(0, |frame| frame.at);
        if let Some(number) = whole.filter(|_| main || jumps) {
            self.rules.return_jumps_here.ask(&mut self.session.trace);
            let place = self.jump(number, at)?;
            self.go(place);
            return Ok(());
        }
        if main {
            if !self.rules.main_restarts.ask(&mut self.session.trace) {
                return Err(Halt::Ended(Op::End));
            }
            self.go(0);
            return Ok(());
        }
        if whole.is_none() && self.again() {
            return Ok(());
        }
        self.leave();
        if let Some(number) = whole {
            self.rules.return_jumps_here.ask(&mut self.session.trace);
            let place = self.jump(number, usize::MAX)?;
            self.go(place);
        }
        Ok(())
    }

    /// Starts a repeated program again; false where it has run often enough.
    fn again(&mut self) -> bool {
        let Some(frame) = self.frames.last_mut().filter(|frame| frame.repeats > 0) else { return false };
        frame.repeats -= 1;
        frame.at = frame.entry;
        let arguments = frame.arguments;
        if let Some(arguments) = arguments.filter(|arguments| *arguments != self.locals()) {
            // It matters only where the program changed its locals.
            if self.rules.repeat_reloads.ask(&mut self.session.trace)
                && let Some(locals) = self.memory.levels.last_mut()
            {
                *locals = arguments;
            }
        }
        true
    }

    fn leave(&mut self) {
        let Some(frame) = self.frames.pop() else { return };
        if frame.level {
            let locals = self.memory.levels.pop().unwrap_or_default();
            if let Some(call) = frame.modal.and_then(|index| self.modal_calls.get_mut(index))
                && self.rules.modal_keeps_locals.ask(&mut self.session.trace)
            {
                call.locals = locals;
            }
        }
        self.session.trace.push(EventKind::Leave);
    }

    /// True where a modal call is in force.
    pub fn has_modal_call(&self) -> bool {
        self.visible_call().is_some()
    }

    /// True where a modal call in force calls after every block.
    pub fn modal_call_each(&self) -> bool {
        self.visible_call().is_some_and(|(_, call)| call.each)
    }

    fn visible_call(&self) -> Option<(usize, &ModalCall)> {
        let index = self.frames.last()?.visible.checked_sub(1)?;
        Some((index, self.modal_calls.get(index)?))
    }

    /// Calls what the innermost modal call in force names; moves of that program call the next outer one.
    pub fn trigger_modal(&mut self) -> Result<Next, Halt> {
        let Some((index, call)) = self.visible_call() else { return Ok(Next::On) };
        let (called, count, locals, outer) = (call.program, call.count, call.locals, call.outer);
        let section = match called {
            Called::Section(section) => section,
            Called::Outside(program) => return self.call_outside(program, count, Some(locals)),
        };
        let mut frame = self.frame(section, count);
        (frame.level, frame.modal, frame.visible) = (true, Some(index), outer);
        self.memory.levels.push(locals);
        self.push(frame)
    }

    /// Ends the innermost modal call.
    pub fn end_modal(&mut self) -> Result<(), Halt> {
        let Some((index, outer)) = self.visible_call().map(|(index, call)| (index, call.outer)) else {
            if self.session.control.setting("parameter.6000.0") == Some("1") {
                return Ok(());
            }
            let stop = Stop::alarm(self.style.alarms.no_modal_call, "no modal call is in force");
            return Err(Halt::Alarm(stop));
        };
        if index + 1 == self.modal_calls.len() {
            self.modal_calls.pop();
        }
        if let Some(frame) = self.frames.last_mut() {
            frame.visible = outer;
        }
        Ok(())
    }
}

fn missing(number: f64) -> Halt {
    Halt::Error(format!("O{number} is not in the library"))
}
