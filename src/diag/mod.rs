//! Diagnostics: one catalogue, one code each, and the values that carry them.

mod codes;

pub use codes::{ALL, Code};

use crate::assume::{Assumption, Predicate};
use crate::canon::Op;
use crate::text::Span;
use std::sync::Arc;

/// How grave a diagnostic is, and what it does to the outcome of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Worth knowing; the outcome stands.
    Note,
    /// A person must look at the place: the program is *converted for review*.
    Review,
    /// The program is *refused*.
    Error,
}

/// That a person looked at what a diagnostic asks, and found it to be as it should.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
pub struct Accepted {
    /// Who.
    pub who: String,
    /// The day, as `2026-11-26`.
    pub when: String,
    /// Why, if that was said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

impl std::fmt::Display for Accepted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "accepted by {} on {}", self.who, self.when)?;
        self.why.as_ref().map_or(Ok(()), |why| write!(f, ": {why}"))
    }
}

/// One finding, at a place of one source file.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Its code; severity, title and page come from the catalogue.
    pub code: Code,
    /// Where, in the file that it was found in.
    pub span: Span,
    /// What is the matter here, in one sentence.
    /// A library has few texts many times over, so they may be shared.
    pub message: Arc<str>,
    /// What to do about it here, where that is more than the catalogue says.
    pub help: Option<Arc<str>>,
    /// What the conversion supposes there.
    pub assumes: Option<Arc<Predicate>>,
    /// The code, letter and number, of which the source's machine profile may say what the builder made of it.
    pub asks: Option<Arc<Asks>>,
    /// The setting that the source's machine profile would have to state, as its table names it; after `=` the value that the
    /// program shows.
    pub setting: Option<Arc<str>>,
    /// The same of the target's profile.
    pub setting_there: Option<Arc<str>>,
    /// True for what a person decides once for the library and its machines: a program has a note of it.
    pub once: bool,
    /// Who accepted it, if somebody did: it asks nothing then.
    pub accepted: Option<Arc<Accepted>>,
}

/// What a machine profile may say of a code or a variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Asks {
    /// What the source's builder made of it.
    Code {
        /// The code: `M14`, or `M3 P11`.
        code: Arc<str>,
        /// What it is likely to do.
        op: Option<Op>,
    },
    /// Which code of the target does what one of the source's does, by the name that the source's profile gives it.
    There {
        /// The name: `chuck.clamp`.
        name: Arc<str>,
    },
    /// Which code of the target does this: its builder may have given it one.
    OpThere {
        /// What it does.
        op: Op,
    },
    /// What becomes of a code that switches an output: how it is written, the block says.
    Output {
        /// Whether it switches on or off.
        op: Op,
    },
    /// Whether the source's machine has a variable that its table has not.
    Variable {
        /// Its number.
        number: u32,
    },
    /// Which input or output of the target has the wire of this signal.
    Signal {
        /// True for an input.
        input: bool,
        /// Its number on the source.
        number: u32,
    },
    /// A word that it takes, of a code that the profile names.
    Word {
        /// True for the target's profile.
        target: bool,
        /// The code.
        code: Arc<str>,
        /// The letter.
        letter: char,
        /// What the shop calls it.
        name: Arc<str>,
    },
}

impl Diagnostic {
    /// A finding without a help text of its own.
    pub fn new(code: Code, span: Span, message: impl Into<Arc<str>>) -> Self {
        Self {
            code,
            span,
            message: message.into(),
            help: None,
            assumes: None,
            asks: None,
            setting: None,
            setting_there: None,
            once: false,
            accepted: None,
        }
    }

    /// Adds what to do about it.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<Arc<str>>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Names the code whose meaning the source's machine profile may say.
    #[must_use]
    pub fn asking(self, letter: char, number: f64) -> Self {
        self.asking_for(Asks::Code { code: format!("{letter}{number}").into(), op: None })
    }

    /// Names what a machine profile may say of a code.
    #[must_use]
    pub fn asking_for(mut self, asks: Asks) -> Self {
        self.asks = Some(Arc::new(asks));
        self
    }

    /// Names the setting that the source's machine profile would have to state.
    #[must_use]
    pub fn lacking(mut self, setting: impl Into<Arc<str>>) -> Self {
        self.setting = Some(setting.into());
        self
    }

    /// Names the setting that the target's machine profile would have to state.
    #[must_use]
    pub fn lacking_there(mut self, setting: impl Into<Arc<str>>) -> Self {
        self.setting_there = Some(setting.into());
        self
    }

    /// Asks it of the library and its machines once, since the answer is the same for all programs.
    #[must_use]
    pub fn asked_once(mut self) -> Self {
        self.once = true;
        self
    }

    /// Names the unconfirmed fact that it reports.
    #[must_use]
    pub fn with_fact(self, fact: impl Into<Arc<str>>) -> Self {
        self.assuming(Predicate::Fact(fact.into()))
    }

    /// Says what the conversion supposes there.
    #[must_use]
    pub fn assuming(mut self, predicate: Predicate) -> Self {
        self.assumes = Some(Arc::new(predicate));
        self
    }

    /// The unconfirmed fact that it reports, as machine profiles confirm it.
    pub fn fact(&self) -> Option<&str> {
        match self.assumes.as_deref()? {
            Predicate::Fact(fact) => Some(fact),
            _ => None,
        }
    }

    /// What the conversion supposes there, as a value; none if it supposes nothing.
    pub fn assumption(&self) -> Option<Assumption> {
        let predicate = match self.assumes.as_deref() {
            Some(predicate) => predicate.clone(),
            None if matches!(self.code, Code::Conditional | Code::UnconfirmedFact) => Predicate::Unseen,
            None => return None,
        };
        Some(Assumption { place: self.span, text: self.message.clone(), predicate })
    }

    /// The severity of its code.
    pub fn severity(&self) -> Severity {
        self.code.severity()
    }

    /// How grave it is for the program that it is found in. What is asked of the library or of a machine is a note
    /// there, and so is what was accepted.
    pub fn in_program(&self) -> Severity {
        match self.severity() {
            Severity::Review if self.accepted.is_some() || self.once || self.code.is_of_machine() => {
                Severity::Note
            }
            severity => severity,
        }
    }
}
