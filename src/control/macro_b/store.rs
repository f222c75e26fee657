//! Reads and writes variables, those of the machine included.

use super::code::{Ex, System, Var};
use super::expressions::numbered;
use super::numeric::Value;
use super::run::Runner;
use crate::canon::{Group, Pause, Sys};
use crate::control::outcome::Stop;
use crate::control::session::Halt;
use crate::control::trace::EventKind;

impl Runner<'_> {
    /// The value of a variable.
    pub fn read(&mut self, var: &Var) -> Result<Value, Halt> {
        match var {
            Var::Local(number) => {
                self.off = self.memory.local_off(*number);
                Ok(self.memory.local(*number))
            }
            Var::Shared(number) => {
                self.off = self.memory.off(*number);
                Ok(self.memory.get(*number))
            }
            Var::System(system) => {
                let value = self.read_system(system)?;
                self.off = self.reading_off(value.unwrap_or(0.0));
                Ok(value)
            }
            Var::Bit(system, bit) => {
                let value = self.read_system(system)?.unwrap_or(0.0).abs() as u64;
                Ok(Some(value.checked_shr(*bit).map_or(0.0, |rest| f64::from((rest & 1) as u8))))
            }
            Var::Named(name) => {
                let var = self.named(name)?;
                self.read(&var)
            }
            Var::Computed(index) => {
                let number = self.index(index)?;
                self.off = 0.0;
                let var = self.found(number);
                self.read(&var)
            }
            Var::Family(name, index) => {
                let var = self.of_run(name, index)?;
                self.read(&var)
            }
            Var::Missing(number) => Err(self.no_variable(*number)),
        }
    }

    /// Gives a variable a value, which may be off by so much.
    pub fn write(&mut self, var: &Var, value: Value, off: f64) -> Result<(), Halt> {
        match var {
            Var::Local(number) => self.memory.set_local(*number, value, off),
            Var::Shared(number) => self.write_shared(*number, value, off),
            Var::System(system) => return self.write_system(system, value),
            Var::Named(name) => {
                let var = self.named(name)?;
                return self.write(&var, value, off);
            }
            Var::Computed(index) => {
                let number = self.index(index)?;
                let var = self.found(number);
                return self.write(&var, value, off);
            }
            Var::Family(name, index) => {
                let var = self.of_run(name, index)?;
                return self.write(&var, value, off);
            }
            Var::Bit(system, _) => return Err(self.no_variable(system.number)),
            Var::Missing(number) => return Err(self.no_variable(*number)),
        }
        Ok(())
    }

    fn write_shared(&mut self, number: u32, value: Value, off: f64) {
        self.memory.set(number, value, off);
        self.session.wrote(|| format!("#{number}"), value);
    }

    /// The variable with a fixed name and a subscript.
    fn of_run(&mut self, name: &str, index: &Ex) -> Result<Var, Halt> {
        let subscript = self.index(index)?;
        let number = self.session.control.number_named(name, subscript).ok_or_else(|| self.no_variable(0))?;
        self.off = 0.0;
        Ok(self.found(number))
    }

    /// The variable with a computed number; what it rests on is noted now.
    fn found(&mut self, number: u32) -> Var {
        let number = self.session.control.cell("#", number);
        self.session.trace.computed_number(number);
        let var = numbered(self.session.control, number);
        if let Var::System(system) = &var {
            system.unsure.iter().for_each(|fact| self.session.trace.doubt(fact));
        }
        var
    }

    fn named(&mut self, name: &str) -> Result<Var, Halt> {
        match self.memory.names.get(name) {
            Some(number) => Ok(numbered(self.session.control, *number)),
            None => {
                let text = format!("no variable is named {name}");
                Err(Halt::Alarm(Stop::alarm(self.style.alarms.no_variable, text)))
            }
        }
    }

    fn no_variable(&self, number: u32) -> Halt {
        let text = format!("#{number} is not there, or cannot be read or written");
        Halt::Alarm(Stop::alarm(self.style.alarms.no_variable, text))
    }

    fn read_system(&mut self, system: &System) -> Result<Value, Halt> {
        if !system.readable {
            return Err(self.no_variable(system.number));
        }
        let subscript = system.subscripts.last().copied().unwrap_or(0);
        Ok(match system.state {
            Sys::Empty => None,
            Sys::Modal | Sys::ModalNow => {
                if !Group::ALL.iter().any(|group| group.number() == Some(subscript)) {
                    self.session.trace.doubt(&format!("system:#{}", system.number));
                }
                Some(self.modal.get(subscript as usize).copied().unwrap_or(0.0))
            }
            Sys::Address | Sys::AddressNow => {
                Some(self.addresses.get(subscript as usize).copied().unwrap_or(0.0))
            }
            Sys::MainProgram => {
                let name = self.session.main_name();
                Some(name.trim_start_matches('O').parse().unwrap_or(0.0))
            }
            state => {
                let value = self.session.machine.read(state, &system.subscripts, &mut self.session.trace);
                Some(value.ok_or_else(|| self.no_variable(system.number))?)
            }
        })
    }

    fn write_system(&mut self, system: &System, value: Value) -> Result<(), Halt> {
        if !system.writable {
            return Err(self.no_variable(system.number));
        }
        let value = value.unwrap_or(0.0);
        if system.most.is_some_and(|most| !(0.0..=most).contains(&value)) {
            self.session.trace.doubt("machine:state.larger");
        }
        if matches!(system.state, Sys::Alarm | Sys::StopMessage) {
            // Reached by a computed number, so that no text is known.
            let number = format!("{}", self.rules.alarm_offset + value);
            if system.state == Sys::StopMessage {
                self.session.pause(Pause::Message, EventKind::Message { text: String::new() });
                return Ok(());
            }
            return Err(Halt::Alarm(Stop { program_number: Some(value), ..Stop::alarm(&number, "") }));
        }
        self.session.machine.write(system.state, &system.subscripts, value, &mut self.session.trace)?;
        Ok(())
    }
    /// Numbers of offsets, and a speed, that stand in words which were written before this run.
    pub(super) fn found_words(&mut self) {
        // D, H and S, counted from A as 1: what they say has no unit.
        let plain = |subscript: &u32| matches!(subscript, 4 | 8 | 19);
        for found in self.session.scenario.state.iter().filter(|found| found.state == Sys::Address) {
            let place = found.subscripts.first().filter(|subscript| plain(subscript));
            if let Some(address) = place.and_then(|place| self.addresses.get_mut(*place as usize)) {
                *address = found.value;
            }
        }
    }
}
