//! The texts of a library's programs.

use crate::control::{Library, ProgramRef};
use crate::dialect::Control;
use crate::syntax::{Block, ProgramName};

/// The texts of a library's programs, and the control that reads them.
#[derive(Clone, Copy)]
pub struct ProgramTexts<'t> {
    /// The control.
    pub control: &'t Control,
    /// The programs.
    pub library: &'t Library<'t>,
}

impl<'t> ProgramTexts<'t> {
    /// The name of a program, as written; none for one without.
    pub fn name(&self, program: ProgramRef) -> Option<&'t ProgramName> {
        self.library.sections.all().get(self.library.sections.place(program)?)?.name.as_ref()
    }

    /// The program with this number.
    pub fn numbered(&self, number: u32) -> Option<ProgramRef> {
        self.library.sections.program(self.library.sections.numbered(number)?)
    }

    /// True for a program that is there.
    pub fn has(&self, program: ProgramRef) -> bool {
        self.library.sections.place(program).is_some()
    }

    /// The blocks of a program.
    pub fn text(&self, program: ProgramRef) -> &'t [Block] {
        self.library.sections.place(program).map_or(&[], |place| self.library.blocks(place))
    }

    /// The blocks of a program, as a range of its file's.
    pub fn blocks(&self, program: ProgramRef) -> std::ops::Range<usize> {
        let section = self.library.sections.place(program).and_then(|at| self.library.sections.all().get(at));
        section.map_or(0..0, |section| section.blocks.clone())
    }
}
