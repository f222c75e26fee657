//! The text of the Macro B family: what Fanuc and Haas write alike.
//!
//! The program is laid out in source order by a `common::flow::Plan`, which decides
//! for each block how its end is written: as nothing, GOTO, IF, or a loop. The
//! plan says which blocks need a sequence number, `labels` gives them, and one walk over
//! the blocks writes the lines. Nothing is looked up twice: the spellings of
//! the control are gathered in `spellings` first, and text goes into one string.

mod calls;
mod conditions;
mod expressions;
mod program;
mod statements;
mod system;
mod taken;
#[cfg(test)]
mod tests;
mod words;

use super::{Naming, Writer};
use crate::dialect::Control;
use crate::emit::common::lines::Kind;
use crate::emit::common::sheet::{Forms, Sheet};
use crate::emit::common::spellings::Spellings;
use crate::ir::{Program, SourceInfo};

/// `O0001`, `N10`.
const FORMS: Forms = Forms { sequence: 'N', program: 'O', program_digits: 4 };

/// What tells the dialects of the family apart beyond their tables.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// True where a subprogram call may stand after other words of its block.
    pub words_beside_call: bool,
}

/// Writes programs in the family's text; see [`super::Emit`].
pub fn emit<'a>(names: &'a Naming, control: &'a Control, style: &'static Style) -> Writer<'a> {
    let spellings = Spellings::of(control);
    Box::new(move |valid| {
        let mut emitter = Emitter {
            program: valid.program(),
            names,
            control,
            style,
            spellings: &spellings,
            out: Sheet::new(control, FORMS),
            depth: 0,
            holds_back: false,
            nested: 0,
            place: expressions::Place::Statement,
        };
        emitter.program();
        emitter.out.end()
    })
}

/// The state of writing one program.
struct Emitter<'p> {
    program: &'p Program,
    names: &'p Naming,
    control: &'p Control,
    style: &'p Style,
    spellings: &'p Spellings<'p>,
    out: Sheet<'p>,
    /// Brackets that are open.
    depth: u32,
    /// True after a limit on reading ahead: empty blocks there have their use.
    holds_back: bool,
    /// Expressions that are being written inside one another.
    nested: u32,
    place: expressions::Place,
}

impl<'p> Emitter<'p> {
    /// Starts a line; `message` is the text that its statement shows, if it shows any.
    fn begin(&mut self, site: &'p SourceInfo, kind: Kind, message: Option<&str>) {
        self.out.begin(site, kind, message);
        if let Some(condition) = self.out.line.condition.take() {
            self.out.space();
            self.out.push_str("IF ");
            self.bracketed_condition(condition, false);
            self.out.push_str(" THEN");
        }
    }
}
