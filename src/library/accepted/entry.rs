//! An accepted review, as it stands in the project file.

use crate::diag::{Accepted, Code, Severity};
use serde::Deserialize;
use std::fmt::Write;
use toml::Spanned;
use toml::value::Datetime;

/// One question, answered: of one program, at all its places at which the same is asked; or of the library, in all its
/// programs.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// The library, by its name in the project file.
    pub(super) library: Spanned<String>,
    /// The machine that it is converted to.
    pub(super) target: Spanned<String>,
    /// The file, seen from the project file; none for what is asked once for the library.
    pub(super) file: Option<Spanned<String>>,
    /// The program; none for one without a name.
    pub(super) program: Option<Spanned<String>>,
    /// The code.
    pub(super) code: Spanned<String>,
    /// What was asked.
    pub(super) says: Spanned<String>,
    /// Where, as a person reads it; none for what is asked once for the library.
    pub(super) at: Option<Spanned<String>>,
    /// Who accepted it.
    pub(super) who: Spanned<String>,
    /// The day.
    pub(super) when: Spanned<Datetime>,
    /// Why.
    pub(super) why: Option<Spanned<String>>,
    /// The hash of what was asked, and of what the answer rests on.
    pub(super) hash: Spanned<String>,
}

/// Letters of each half of a hash.
pub(super) const HALF: usize = 16;

/// Whether a diagnostic of this code can be accepted.
///
/// # Errors
/// Why it cannot.
pub fn acceptable(code: Code) -> Result<(), String> {
    let number = code.number();
    let why = if code == Code::VerifiedDifferent {
        "says that the machines do not do the same"
    } else if number.starts_with("MG09") {
        "is what `macroglot check` finds: [[checks.allow]] is for that"
    } else if code.severity() == Severity::Error {
        "is an error: what it refuses has no conversion"
    } else if code.is_of_machine() {
        "is asked of the machine: its profile answers it for all programs"
    } else if code.severity() == Severity::Note {
        "is a note, which asks nothing"
    } else {
        return Ok(());
    };
    Err(format!("{number} cannot be accepted: it {why}"))
}

impl Entry {
    /// The key of what it is about: library, target, file, program and code.
    pub(super) fn key(&self) -> [&str; 5] {
        let program = self.program().unwrap_or_default();
        [self.library.get_ref(), self.target.get_ref(), self.file(), program, self.code.get_ref()]
    }

    /// The library.
    pub fn library(&self) -> &str {
        self.library.get_ref()
    }

    /// The machine that the library is converted to.
    pub fn target(&self) -> &str {
        self.target.get_ref()
    }

    /// The file, seen from the project file; empty for what is asked once for the library.
    pub fn file(&self) -> &str {
        self.file.as_ref().map_or("", |file| file.get_ref())
    }

    /// The program; none for one without a name.
    pub fn program(&self) -> Option<&str> {
        self.program.as_ref().map(|program| program.get_ref().as_str())
    }

    /// What it is about, in one line.
    pub fn about(&self) -> String {
        let program = self.program().map(|program| format!(" {program}")).unwrap_or_default();
        let [library, target, file, _, code] = self.key();
        match &self.at {
            Some(at) => format!("{file}{program}, {library} to {target}: {code}, {}", at.get_ref()),
            None => format!("the library, {library} to {target}: {code}, {}", self.says()),
        }
    }

    /// What was asked.
    pub fn says(&self) -> &str {
        self.says.get_ref()
    }

    /// What a person said of it.
    pub fn accepted(&self) -> Accepted {
        Accepted {
            who: self.who.get_ref().clone(),
            when: self.when.get_ref().to_string(),
            why: self.why.as_ref().map(|why| why.get_ref().clone()),
        }
    }

    /// What is wrong with it, and where in the text.
    pub(crate) fn fault(&self) -> Option<(usize, String)> {
        let code = self.code.get_ref();
        let known = Code::find(code).filter(|known| known.number() == code);
        let of_code = match known {
            Some(known) => acceptable(known).err(),
            None => Some(format!("'{code}' is no code: `macroglot explain` lists them, such as MG0405")),
        };
        if let Some(why) = of_code {
            return Some((self.code.span().start, why));
        }
        if self.file.is_some() != self.at.is_some() || self.program.is_some() && self.file.is_none() {
            let why = "what is asked of a program has `file` and `at`; what is asked once for the library has neither of \
                       them, and no `program`";
            return Some((self.code.span().start, why.into()));
        }
        if self.who.get_ref().trim().is_empty() {
            return Some((self.who.span().start, "say who accepted it: `who = \"...\"`".into()));
        }
        let when = self.when.get_ref();
        if when.date.is_none() || when.time.is_some() || when.offset.is_some() {
            let why = format!("`when` is a day, as in `when = 2026-11-26`, and not '{when}'");
            return Some((self.when.span().start, why));
        }
        let hash = self.hash.get_ref();
        let hex =
            |half: &str| half.len() == HALF && half.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
        let whole = hash.split_once('-').is_some_and(|(program, machines)| hex(program) && hex(machines));
        (!whole).then(|| {
            let why = format!("'{hash}' is no hash of an accepted review: `macroglot accept` writes it");
            (self.hash.span().start, why)
        })
    }

    /// Its text in the project file, a line each.
    pub(super) fn lines(&self) -> Vec<String> {
        let text = |name: &str, value: &str| format!("{name} = {}", quoted(value));
        let mut lines = vec!["[[accepted]]".to_owned()];
        lines.push(text("library", self.library.get_ref()));
        lines.push(text("target", self.target.get_ref()));
        lines.extend(self.file.as_ref().map(|file| text("file", file.get_ref())));
        lines.extend(self.program.as_ref().map(|program| text("program", program.get_ref())));
        lines.push(text("code", self.code.get_ref()));
        lines.push(text("says", self.says.get_ref()));
        lines.extend(self.at.as_ref().map(|at| text("at", at.get_ref())));
        lines.push(text("who", self.who.get_ref()));
        lines.push(format!("when = {}", self.when.get_ref()));
        lines.extend(self.why.as_ref().map(|why| text("why", why.get_ref())));
        lines.push(text("hash", self.hash.get_ref()));
        lines
    }
}

/// A text as TOML writes it on one line.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for sign in text.chars() {
        match sign {
            '"' | '\\' => out.extend(['\\', sign]),
            // What acts on a terminal or turns a line round does not do so where the file is read.
            sign if crate::text::acts(sign) => _ = write!(out, "\\U{:08X}", sign as u32),
            sign => out.push(sign),
        }
    }
    out.push('"');
    out
}
