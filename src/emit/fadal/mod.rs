//! The text of a Fadal CNC 88: blocks of words with R variables, and macro lines after `#`.
//!
//! Every block has a number, counted from 1, and nothing goes to it by that number: jumps go to labels on lines of
//! their own. So numbers are spent freely, and a program of more blocks than there are numbers has none at all.

mod expressions;
mod labels;
mod lines;
mod program;
mod statements;
#[cfg(test)]
mod tests;
mod words;

use super::{Naming, Writer};
use crate::dialect::Control;
use crate::emit::common::sheet::{Forms, Sheet};
use crate::emit::common::spellings::Spellings;
use crate::ir::Program;
use labels::Labels;
use lines::Page;

/// `N1`, `O1234`.
const FORMS: Forms = Forms { sequence: 'N', program: 'O', program_digits: 1 };

/// Writes programs; see [`super::Emit`].
pub fn emit<'a>(names: &'a Naming, control: &'a Control) -> Writer<'a> {
    let spellings = Spellings::of(control);
    Box::new(move |valid| {
        let write = |numbered: bool| {
            let mut emitter = Emitter {
                program: valid.program(),
                names,
                control,
                spellings: &spellings,
                out: Sheet::new(control, FORMS),
                page: Page::new(numbered),
                labels: Labels::default(),
                nested: 0,
            };
            emitter.program();
            (emitter.page.is_full(control.text().sequence_max), emitter.out.end())
        };
        match write(true) {
            (true, _) => write(false).1,
            (false, made) => made,
        }
    })
}

/// The state of writing one program.
struct Emitter<'p> {
    program: &'p Program,
    names: &'p Naming,
    control: &'p Control,
    spellings: &'p Spellings<'p>,
    out: Sheet<'p>,
    page: Page<'p>,
    labels: Labels,
    /// Expressions that are being written inside one another.
    nested: u32,
}
