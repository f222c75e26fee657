//! Jumps, subprograms after labels, and cycles in files of their own.

use super::{At, Interpreter, Labels, Next};
use crate::control::ProgramRef;
use crate::control::library::cycle_number;
use crate::control::outcome::Stop;
use crate::control::session::{Flow, Halt};
use crate::control::trace::EventKind;
use crate::dialect::Question;
use crate::syntax::{ItemKind, Label};

/// How deep calls nest before the emulation gives up.
const DEEPEST: u32 = 40;

impl Interpreter<'_, '_> {
    /// Goes on at a label of the running program.
    pub(super) fn jump(&mut self, label: u32) -> Flow<()> {
        self.at.index = self.label(label)?;
        Ok(())
    }

    fn label(&mut self, label: u32) -> Flow<usize> {
        let section = self.at.section;
        let labels = self.kept.program(section, self.session.length(section), || self.labels(section));
        let Some((index, again)) = labels.and_then(|labels| labels.get(&label)).copied() else {
            return Err(self.session.no_label(&format!("label ${label} is not there")));
        };
        if again {
            self.session.act_as(Question::GotoFirstLabel, "true");
        }
        Ok(index)
    }

    /// The labels of a program.
    fn labels(&self, section: usize) -> Labels {
        let mut found = Labels::new();
        for (index, block) in (0..).map_while(|at| Some((at, self.session.block(section, at)?))) {
            for item in &block.items {
                if let ItemKind::Label(Label::Number(number)) = item.kind {
                    found.entry(number).and_modify(|(_, again)| *again = true).or_insert((index, false));
                }
            }
        }
        found
    }

    /// G22: runs the blocks from a label on, up to G99.
    pub(super) fn call_local(&mut self, label: u32, count: u32) -> Flow<()> {
        let index = self.label(label)?;
        self.call(At { section: self.at.section, index }, count)
    }

    /// G8nn: runs a cycle.
    pub(super) fn call_cycle(&mut self, number: u32) -> Flow<()> {
        let file = self.session.files.iter().position(|file| cycle_number(file.name) == Some(number));
        let Some(file) = file else {
            return Err(Halt::Error(format!(
                "cycle {number} is not in the library, in a file named cycle{number:02}"
            )));
        };
        let section = self.session.section_of(ProgramRef { file, program: 0 })?;
        self.call(At { section, index: 0 }, 1)
    }

    /// True while the blocks of a cycle run.
    pub(super) fn in_cycle(&self) -> bool {
        let file = self.session.sections.all().get(self.at.section).map(|section| section.file);
        let file = file.and_then(|file| self.session.files.get(file));
        file.is_some_and(|file| cycle_number(file.name).is_some())
    }

    fn call(&mut self, to: At, count: u32) -> Flow<()> {
        if self.session.control.limit("call.all").is_some_and(|most| self.depth >= most) {
            self.session.trace.doubt("limit:call.all");
        }
        if self.depth >= DEEPEST {
            return Err(Stop::unnamed("calls are nested too deep").into());
        }
        self.depth += 1;
        let back = self.at;
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
        self.at = back;
        Ok(())
    }
}
