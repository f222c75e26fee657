//! The text of a Bosch CC 100: plain blocks of words, and parametric blocks of one step each.
//!
//! Every block has a number, counted from 1, and nothing goes to it by that number: jumps and calls go to `$n` on blocks
//! of their own. A program of more blocks than there are numbers has none. The main part comes first and `M30` ends it;
//! what it calls, and the stops that stand for alarms, come after it (seed 004:218 to 241, 464, 1568).

mod expressions;
mod labels;
mod lines;
mod program;
mod statements;
mod words;

use super::{Naming, Writer};
use crate::dialect::Control;
use crate::emit::common::sheet::{Forms, Sheet};
use crate::emit::common::spellings::Spellings;
use crate::ir::Program;
use labels::Labels;
use lines::Page;

/// `N1`; a program's name stands in a comment.
const FORMS: Forms = Forms { sequence: 'N', program: 'O', program_digits: 4 };

/// Writes programs; see [`super::Emit`].
pub fn emit<'a>(names: &'a Naming, control: &'a Control) -> Writer<'a> {
    let spellings = Spellings::of(control);
    Box::new(move |valid| {
        let write = |bare: bool| {
            let mut emitter = Emitter {
                program: valid.program(),
                names,
                control,
                spellings: &spellings,
                out: Sheet::new(control, FORMS),
                page: Page::new(bare),
                labels: Labels::default(),
                alarms: Vec::new(),
            };
            emitter.program();
            (emitter.page.last > control.text().sequence_max, emitter.out.end())
        };
        match write(false) {
            (true, _) => write(true).1,
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
    /// The stops that stand for alarms: their labels and texts.
    alarms: Vec<(u32, String)>,
}
