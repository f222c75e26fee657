//! Calls of programs that stand in the machine and are no part of the library.

use super::memory::Locals;
use super::run::{Next, Runner};
use crate::control::machine::LEFT;
use crate::control::outside::{Drawn, OutsideCall};
use crate::control::session::Halt;
use crate::control::trace::EventKind;
use std::collections::BTreeMap;
use std::sync::Arc;

impl Runner<'_> {
    /// Tells of such a call, with its own locals or with those of the caller; then goes on where the program may have left
    /// all that it shares.
    pub fn call_outside(&mut self, program: u32, runs: u32, own: Option<Locals>) -> Result<Next, Halt> {
        let shares = own.is_none() && self.rules.locals_shared.ask(&mut self.session.trace);
        let levels = self.memory.levels.len() - usize::from(own.is_none());
        self.check_depth(own.is_some(), levels)?;
        let outside = Arc::clone(&self.session.library().outside);
        let found = match own {
            Some(locals) => locals,
            None if shares => self.locals(),
            None => Locals::default(),
        };
        let known = |number: &usize| own.is_some() || outside.locals().contains(number);
        // Locals are numbers up to 33.
        let locals: BTreeMap<u32, f64> = found
            .values()
            .filter(|(number, _)| known(number))
            .map(|(number, value)| (number as u32, value))
            .collect();
        let common = outside.common().filter_map(|(number, here)| Some((number, self.memory.get(here)?)));
        let common = common.collect();
        let state = self.session.machine.found();
        let call = OutsideCall { program, runs, locals, common, state };
        self.session.trace.push(EventKind::Outside(Box::new(call)));
        self.calls_outside += 1;
        let Some(drawn) = Drawn::new(self.session.scenario.outside, self.calls_outside) else {
            return Ok(Next::On);
        };
        for (number, here) in outside.common() {
            self.memory.set(here, drawn.variable(number), 0.0);
        }
        for number in outside.locals().iter().filter(|_| shares) {
            self.memory.set_local(*number, drawn.variable(*number as u32), 0.0);
        }
        let modes = self.session.scenario.outside_modes;
        self.session.machine.go_on(drawn, modes);
        if modes {
            self.cycle = None;
            self.show_modes(&LEFT);
        }
        Ok(Next::On)
    }
}
