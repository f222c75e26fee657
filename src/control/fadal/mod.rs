//! Runs Fadal programs: macro lines and NC lines, by the rules of its manual.
//!
//! The interpreter reads the blocks as they stand. Calls are calls of its own: what a
//! subroutine's blocks do happens inside `Interpreter::call`, to a bounded depth.

mod blocks;
mod calls;
mod macros;
mod outline;
mod output;
mod registers;
mod system;
#[cfg(test)]
mod tests;
mod values;

use super::kept::{Kept, with_kept};
use super::library::{Library, ProgramRef};
use super::outcome::Run;
use super::scenario::Scenario;
use super::session::{Flow, Halt, Session};
use super::words::Lasting;
use crate::canon::Op;
use crate::dialect::{Control, Question};
use crate::syntax::Block;
use outline::Outline;
use registers::Registers;
use std::sync::LazyLock;

/// Runs a program on the emulated control; [`super::Execute`].
pub fn execute(library: &Library<'_>, main: ProgramRef, control: &Control, scenario: &Scenario) -> Run {
    with_kept(library, control, || (), |kept| run(library, kept, main, control, scenario))
}

fn run<'r>(
    library: &'r Library<'_>,
    kept: Kept<'r, (), Outline>,
    main: ProgramRef,
    control: &'r Control,
    scenario: &'r Scenario,
) -> Run {
    let session = Session::new(library, control, scenario);
    let lasting = Lasting::at_start(&session);
    let mut interpreter = Interpreter {
        session,
        registers: Registers::new(scenario),
        kept,
        at: At { section: 0, index: 0 },
        level: Level::Main,
        depth: 0,
        lasting,
        modal: Vec::new(),
        in_modal: false,
        line: String::new(),
        line_ends_in_value: false,
        printed: None,
        waited: false,
        moving: false,
        plane_moved: false,
    };
    let halt = interpreter.main(main);
    interpreter.flush();
    let variables = interpreter.registers.all();
    interpreter.session.finish(halt, variables)
}

/// The outline of a program that is not there.
static NOWHERE: LazyLock<Outline> = LazyLock::new(Outline::default);

/// The next block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct At {
    section: usize,
    /// Counted from the section's first block.
    index: usize,
}

/// What the running blocks are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Level {
    /// The main program.
    Main,
    /// A subroutine at the head of a program, from its definition on.
    Subroutine,
    /// A program that M98 called.
    Program,
}

/// What comes after a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// The block that [`Interpreter::at`] names.
    On,
    /// Back to the call.
    Back,
}

struct Interpreter<'r, 'f> {
    session: Session<'r, 'f>,
    registers: Registers,
    kept: Kept<'r, (), Outline>,
    at: At,
    level: Level,
    depth: u32,
    lasting: Lasting<'r>,
    /// The subroutines of G66 and their counts, innermost last.
    modal: Vec<calls::Local>,
    /// True in a subroutine that a modal call runs.
    in_modal: bool,
    /// What PRINT left on the line of the screen.
    line: String,
    /// True where a value is the last that was put on it.
    line_ends_in_value: bool,
    /// The last line of it if it may ask for a value at a stop, until words are read.
    printed: Option<String>,
    /// True after a block that waits for the moves, until the next block that is no PRINT.
    waited: bool,
    /// True while moves may still be under way: nothing waited for them.
    moving: bool,
    /// True once R0 has another value than the retract plane of the drilling cycle in force was told.
    plane_moved: bool,
}

impl<'r> Interpreter<'r, '_> {
    fn main(&mut self, main: ProgramRef) -> Halt {
        let section = match self.session.section_of(main) {
            Ok(section) => section,
            Err(halt) => return halt,
        };
        self.at = At { section, index: 0 };
        loop {
            match self.step() {
                Ok(Next::On) => {}
                Ok(Next::Back) => return Halt::Ended(Op::Return),
                Err(halt) => return halt,
            }
        }
    }

    /// Runs one block.
    fn step(&mut self) -> Flow<Next> {
        let Some(block) = self.session.block(self.at.section, self.at.index) else {
            return self.behind_the_last();
        };
        self.session.enter_block(self.at.section, block.span)?;
        self.at.index += 1;
        self.session.refuse_faulty(block)?;
        if let Some(next) = self.area(self.at.index - 1)? {
            return Ok(next);
        }
        self.run(block)
    }

    fn behind_the_last(&mut self) -> Flow<Next> {
        if self.level == Level::Program {
            self.session.trace.doubt("machine:program.without.return");
            return Ok(Next::Back);
        }
        Err(Halt::Ended(Op::End))
    }

    /// What a block at the border of a subroutine does by standing there.
    fn area(&mut self, index: usize) -> Flow<Option<Next>> {
        let outline = self.outline();
        if !outline.defines(index) {
            return Ok(None);
        }
        if self.level == Level::Subroutine {
            self.session.act_as(Question::SubEndsAtNext, "true");
            return Ok(Some(Next::Back));
        }
        if outline.is_in_area(index) {
            return Err(calls::nothing_open());
        }
        if outline.works_before(index) {
            self.session.act_as(Question::SubAreaEntered, "true");
        }
        self.at.index = outline.main;
        Ok(Some(Next::On))
    }

    /// The outline of the running program.
    fn outline(&self) -> &'r Outline {
        let section = self.at.section;
        let made = || {
            let blocks: Vec<&'r Block> =
                (0..).map_while(|index| self.session.block(section, index)).collect();
            Outline::new(&blocks)
        };
        self.kept.program(section, self.session.length(section), made).unwrap_or(&NOWHERE)
    }
}
