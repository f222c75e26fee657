//! Runs CC100 programs: plain blocks and parametric ones, by the rules of its course text.

mod blocks;
mod calls;
mod condition;
mod polar;
mod statements;
mod store;
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
use crate::dialect::Control;
use condition::Condition;
use polar::Polar;
use std::collections::HashMap;
use store::Store;

/// Runs a program on the emulated control; [`super::Execute`].
///
/// The files of the library named `cycle20...` and so on are the cycles: G820 runs the first
/// program of `cycle20...`.
pub fn execute(library: &Library<'_>, main: ProgramRef, control: &Control, scenario: &Scenario) -> Run {
    with_kept(library, control, || (), |kept| run(library, kept, main, control, scenario))
}

fn run<'r>(
    library: &'r Library<'_>,
    kept: Kept<'r, (), Labels>,
    main: ProgramRef,
    control: &'r Control,
    scenario: &'r Scenario,
) -> Run {
    let session = Session::new(library, control, scenario);
    let lasting = Lasting::at_start(&session);
    let last = session.words_in_force().into_iter().collect();
    let mut interpreter = Interpreter {
        session,
        store: Store::new(scenario),
        condition: Condition::default(),
        polar: Polar::default(),
        kept,
        last,
        at: At { section: 0, index: 0 },
        depth: 0,
        lasting,
        stood: None,
    };
    let halt = interpreter.main(main);
    let variables = interpreter.store.all();
    interpreter.session.finish(halt, variables)
}

/// The labels of a program: the first block of each, and whether it stands again.
type Labels = HashMap<u32, (usize, bool)>;

/// The next block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct At {
    section: usize,
    /// Counted from the section's first block.
    index: usize,
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
    store: Store,
    condition: Condition,
    polar: Polar,
    kept: Kept<'r, (), Labels>,
    /// The last value of each address.
    last: HashMap<char, f64>,
    at: At,
    /// How many calls are open.
    depth: u32,
    lasting: Lasting<'r>,
    /// The block after the last stop, while nothing but jumps came after it.
    stood: Option<At>,
}

impl Interpreter<'_, '_> {
    fn main(&mut self, main: ProgramRef) -> Halt {
        match self.session.section_of(main) {
            Ok(section) => self.at = At { section, index: 0 },
            Err(halt) => return halt,
        }
        loop {
            match self.step() {
                Ok(Next::On) => {}
                Ok(Next::Back) => return Halt::Ended(Op::End),
                Err(halt) => return halt,
            }
        }
    }

    /// Runs one block. After the last one the run is over, in a subprogram too.
    fn step(&mut self) -> Flow<Next> {
        let Some(block) = self.session.block(self.at.section, self.at.index) else {
            return Err(Halt::Ended(Op::End));
        };
        self.session.enter_block(self.at.section, block.span)?;
        self.at.index += 1;
        self.session.refuse_faulty(block)?;
        self.run(block)
    }
}
