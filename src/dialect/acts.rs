//! When a control does what stands beside a move.

use super::{Control, Question};
use crate::canon::{Auxiliary, Pause, Running};

/// When something acts that stands beside a move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Acts {
    /// The question that asks for it.
    pub question: Question,
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
            Auxiliary::Forward if self.behaviour(Question::MForwardActs).is_none() => Auxiliary::Start,
            kind => kind,
        };
        let question = when(kind);
        let row = self.behaviour(question);
        let late = row.and_then(|row| match row.value.as_str() {
            "start" => Some(false),
            "end" => Some(true),
            _ => None,
        });
        Acts {
            question,
            late: late.unwrap_or(kind.waits()),
            known: late.is_some() && row.is_some_and(|row| row.origin.is_settled()),
        }
    }
}

/// The question that asks when an operation of a kind acts.
const fn when(kind: Auxiliary) -> Question {
    match kind {
        Auxiliary::Change => Question::MChangeActs,
        Auxiliary::Speed => Question::SActs,
        Auxiliary::Forward => Question::MForwardActs,
        Auxiliary::Start => Question::MStartActs,
        Auxiliary::Other => Question::MOtherActs,
        Auxiliary::Stop => Question::MStopActs,
    }
}

/// Whether a stop ends what is running.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ends {
    /// The question that asks for it.
    pub question: Question,
    /// The answer; none if nobody knows.
    pub answer: Option<bool>,
    /// True where a source says so.
    pub known: bool,
}

impl Control {
    /// Whether a stop of this control ends what is running then.
    pub fn ends(&self, pause: Pause, running: Running) -> Ends {
        let question = Question::ends(pause, running);
        let row = self.behaviour(question);
        let answer = row.and_then(|row| row.value.parse().ok());
        let known = answer.is_some() && row.is_some_and(|row| row.origin.is_settled());
        Ends { question, answer, known }
    }
}

impl Question {
    /// The question that asks whether a stop ends what is running.
    pub const fn ends(pause: Pause, running: Running) -> Self {
        match (pause, running) {
            (Pause::Stop, Running::Spindle) => Question::StopEndsSpindle,
            (Pause::Stop, Running::Coolant) => Question::StopEndsCoolant,
            (Pause::Message, Running::Spindle) => Question::MessageEndsSpindle,
            (Pause::Message, Running::Coolant) => Question::MessageEndsCoolant,
            (Pause::Change, Running::Spindle) => Question::ChangeEndsSpindle,
            (Pause::Change, Running::Coolant) => Question::ChangeEndsCoolant,
            (Pause::End, Running::Spindle) => Question::EndEndsSpindle,
            (Pause::End, Running::Coolant) => Question::EndEndsCoolant,
        }
    }
}
