//! When a control does what stands beside a move.

use super::Control;
use crate::canon::{Auxiliary, Pause, Running};

/// When something acts that stands beside a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acts {
    /// The question that asks for it.
    pub question: &'static str,
    /// True when the move is done, false with its start: as the table has it, or as in the trade.
    pub late: bool,
    /// True where a source says so.
    pub known: bool,
}

impl Control {
    /// When this control does an operation of a kind that stands beside a move.
    pub fn acts(&self, kind: Auxiliary) -> Acts {
        // Few controls tell the spindle's two directions apart.
        let kind = match kind {
            Auxiliary::Forward if self.behaviour(kind.question()).is_none() => Auxiliary::Start,
            kind => kind,
        };
        let row = self.behaviour(kind.question());
        let late = row.and_then(|row| match row.value.as_str() {
            "start" => Some(false),
            "end" => Some(true),
            _ => None,
        });
        Acts {
            question: kind.question(),
            late: late.unwrap_or(kind.waits()),
            known: late.is_some() && row.is_some_and(|row| row.origin.confirmed),
        }
    }
}

/// Whether a stop ends what is running.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ends {
    /// The question that asks for it.
    pub question: &'static str,
    /// The answer; none where nobody knows.
    pub answer: Option<bool>,
    /// True where a source says so.
    pub known: bool,
}

impl Control {
    /// Whether a stop of this control ends what is running then.
    pub fn ends(&self, pause: Pause, running: Running) -> Ends {
        let question = pause.question(running);
        let row = self.behaviour(question);
        let answer = row.and_then(|row| row.value.parse().ok());
        let known = answer.is_some() && row.is_some_and(|row| row.origin.confirmed);
        Ends { question, answer, known }
    }
}
