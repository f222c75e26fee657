//! The text of the Macro B family: what Fanuc and Haas write alike.
//!
//! The program is laid out in source order by a `flow::Plan`, which decides
//! for each block how its end is written: as nothing, GOTO, IF, or a loop. The
//! plan says which blocks need a sequence number, `labels` gives them, and one walk over
//! the blocks writes the lines. Nothing is looked up twice: the spellings of
//! the control are gathered in `spellings` first, and text goes into one string.

mod calls;
mod conditions;
mod expressions;
mod flow;
mod labels;
mod line;
mod loops;
mod numbers;
mod program;
mod reach;
mod remarks;
mod spellings;
mod statements;
mod system;
mod taken;
#[cfg(test)]
mod tests;
mod words;

use super::{Emitted, Naming, Writer};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::Program;
use crate::text::Span;
use labels::Labels;
use line::Line;
use spellings::Spellings;
use std::string::FromUtf8Error;
use std::sync::Arc;

/// What tells the dialects of the family apart beyond their tables.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// True where a subprogram call may stand behind other words of its block.
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
            labels: Labels::default(),
            text: Vec::new(),
            emitted: Emitted::default(),
            faults: Vec::new(),
            span: Span::default(),
            line: Line::default(),
            depth: 0,
            holds_back: false,
            nested: 0,
            place: expressions::Place::Statement,
        };
        emitter.program();
        let Emitter { text, emitted, faults, .. } = emitter;
        // It is ASCII; were it not, nothing would be lost.
        let lossy = |fault: FromUtf8Error| String::from_utf8_lossy(fault.as_bytes()).into_owned();
        let text = String::from_utf8(text).unwrap_or_else(lossy);
        if faults.is_empty() { Ok(Emitted { text, ..emitted }) } else { Err(faults) }
    })
}

/// The state of writing one program.
struct Emitter<'p> {
    program: &'p Program,
    names: &'p Naming,
    control: &'p Control,
    style: &'p Style,
    spellings: &'p Spellings<'p>,
    labels: Labels,
    /// What is written so far. Bytes, because most of them are written one by one.
    text: Vec<u8>,
    /// Everything else about it.
    emitted: Emitted,
    faults: Vec<Diagnostic>,
    /// Where the statement that is being written comes from.
    span: Span,
    line: Line<'p>,
    /// Brackets that are open.
    depth: u32,
    /// True behind a limit on reading ahead: empty blocks there have their use.
    holds_back: bool,
    /// Expressions that are being written inside one another.
    nested: u32,
    place: expressions::Place,
}

impl Emitter<'_> {
    /// Notes that the program cannot be written.
    fn refuse(&mut self, code: Code, message: impl Into<Arc<str>>) {
        self.faults.push(Diagnostic::new(code, self.span, message));
    }

    /// Notes what a person must look at.
    fn review(&mut self, code: Code, message: String) {
        self.emitted.findings.push(Diagnostic::new(code, self.span, message));
    }

    /// Notes that the target's table lacks something.
    fn unmapped(&mut self, what: impl std::fmt::Display) {
        let message = format!("{} has no way to write {what}", self.control.dialect().title);
        self.refuse(Code::Unmapped, message);
    }

    /// Notes it where the control lacks a statement; true where it has it.
    fn has_statement(&mut self, name: &str) -> bool {
        let known = self.control.statement(name).is_some();
        if !known {
            self.unmapped(format_args!("the statement '{name}'"));
        }
        known
    }

    fn push(&mut self, c: char) {
        match u8::try_from(c) {
            Ok(byte) if byte.is_ascii() => self.text.push(byte),
            _ => self.push_str(c.encode_utf8(&mut [0; 4])),
        }
    }

    fn push_str(&mut self, text: &str) {
        self.text.extend_from_slice(text.as_bytes());
    }
}
