//! The text of one program while it is written.

use super::digits::{write_digits, write_integer};
use super::labels::Labels;
use super::lines::Line;
use crate::canon::Role;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{CodeMeaning, Control};
use crate::emit::Emitted;
use crate::text::Span;
use std::string::FromUtf8Error;
use std::sync::Arc;

/// How a target writes the numbers of programs and blocks.
#[derive(Clone, Copy, Debug)]
pub struct Forms {
    /// The letter of a sequence number.
    pub sequence: char,
    /// The letter of a program's number.
    pub program: char,
    /// How many digits a program's number has at least.
    pub program_digits: u32,
}

/// What is written so far, and the line that is being written.
pub(in crate::emit) struct Sheet<'p> {
    pub control: &'p Control,
    pub forms: Forms,
    pub labels: Labels,
    /// Bytes, because most of them are written one by one.
    pub text: Vec<u8>,
    /// Everything else about the program.
    pub emitted: Emitted,
    pub faults: Vec<Diagnostic>,
    /// Where the statement that is being written comes from.
    pub span: Span,
    pub line: Line<'p>,
}

impl<'p> Sheet<'p> {
    /// Without a line.
    pub fn new(control: &'p Control, forms: Forms) -> Self {
        Self {
            control,
            forms,
            labels: Labels::default(),
            text: Vec::new(),
            emitted: Emitted::default(),
            faults: Vec::new(),
            span: Span::default(),
            line: Line::default(),
        }
    }

    /// The program, if nothing of it was refused.
    pub fn end(self) -> Result<Emitted, Vec<Diagnostic>> {
        let Self { text, emitted, faults, .. } = self;
        // It is ASCII; were it not, nothing would be lost.
        let lossy = |fault: FromUtf8Error| String::from_utf8_lossy(fault.as_bytes()).into_owned();
        let text = String::from_utf8(text).unwrap_or_else(lossy);
        if faults.is_empty() { Ok(Emitted { text, ..emitted }) } else { Err(faults) }
    }
}

impl Sheet<'_> {
    /// Notes that the program cannot be written.
    pub fn refuse(&mut self, code: Code, message: impl Into<Arc<str>>) {
        self.faults.push(Diagnostic::new(code, self.span, message));
    }

    /// Notes what a person must look at.
    pub fn review(&mut self, code: Code, message: String) {
        self.emitted.findings.push(Diagnostic::new(code, self.span, message));
    }

    /// Adds what is decided once for the library.
    pub fn review_once(&mut self, code: Code, message: String) {
        self.emitted.findings.push(Diagnostic::new(code, self.span, message).asked_once());
    }

    /// Notes that the target's table lacks something.
    pub fn unmapped(&mut self, what: impl std::fmt::Display) {
        let message = format!("{} has no way to write {what}", self.control.dialect().title);
        self.refuse(Code::Unmapped, message);
    }

    /// Notes that the control's word has no such number.
    pub fn lacks_number(&mut self, number: f64, role: Role, code: Option<&CodeMeaning>) {
        let meaning = role.meaning().trim().trim_end_matches('.');
        let has =
            self.control.numbers_of(code, role).map(|has| format!("; it has {has}")).unwrap_or_default();
        self.unmapped(format_args!("{number} as the word '{role}' ({meaning}){has}"));
    }

    /// Notes that a variable of the block got no register. Who got those that there are is told of the program.
    pub fn lacks_register(&mut self) {
        self.refuse(Code::OutOfRegisters, "a variable of this block got no register");
    }

    /// Notes it where the control lacks a statement; true where it has it.
    pub fn has_statement(&mut self, name: &str) -> bool {
        let known = self.control.statement(name).is_some();
        if !known {
            self.unmapped(format_args!("the statement '{name}'"));
        }
        known
    }

    /// Adds a character.
    pub fn push(&mut self, c: char) {
        match u8::try_from(c) {
            Ok(byte) if byte.is_ascii() => self.text.push(byte),
            _ => self.push_str(c.encode_utf8(&mut [0; 4])),
        }
    }

    /// Adds text.
    pub fn push_str(&mut self, text: &str) {
        self.text.extend_from_slice(text.as_bytes());
    }
}

impl Sheet<'_> {
    /// Writes a number, its sign included; with `point` it has a decimal point even when whole.
    pub fn number(&mut self, value: f64, point: bool) {
        if !value.is_finite() {
            return self.unmapped("a number that is not finite");
        }
        let start = self.text.len();
        if value.is_sign_negative() {
            self.text.push(b'-');
        }
        let has_point = write_digits(&mut self.text, value.abs());
        if point && !has_point {
            self.text.push(b'.');
        }
        if let Some(most) = self.control.numbers().digits {
            self.limit_digits(start, most as usize);
        }
    }

    /// The zero before the point counts as a digit, so it goes first.
    fn limit_digits(&mut self, start: usize, most: usize) {
        let written = &self.text[start..];
        if written.len() <= most {
            return;
        }
        let digits = written.iter().filter(|byte| byte.is_ascii_digit()).count();
        if digits <= most {
            return;
        }
        let sign = usize::from(written.starts_with(b"-"));
        if digits == most + 1 && written[sign..].starts_with(b"0.") {
            self.text.remove(start + sign);
            return;
        }
        let written = String::from_utf8_lossy(written);
        let message = format!("{written} has {digits} digits, the control takes {most}");
        self.refuse(Code::NumberTooLong, message);
    }

    /// Writes a whole number.
    pub fn integer(&mut self, value: u32) {
        write_integer(&mut self.text, u64::from(value));
    }
}
