//! Questions of one kind that one answer of a machine profile answers.

use super::{Answers, Control, Question, Settled};

/// Questions that most machines answer alike, under one name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QuestionGroup {
    /// Its name, as under `[behaviours]`: `stop.ends`.
    pub name: &'static str,
    /// What it asks.
    pub meaning: &'static str,
    /// Its questions, which all have the answers of the first.
    pub questions: &'static [Question],
}

/// Every group.
const GROUPS: &[QuestionGroup] = &[
    QuestionGroup {
        name: "stop.ends",
        meaning: "a program stop stops the spindle and switches coolant off, and the program has to start them again: where \
                  only one of the two is so, answer 'stop.ends.spindle' and 'stop.ends.coolant'",
        questions: &[Question::StopEndsSpindle, Question::StopEndsCoolant],
    },
    QuestionGroup {
        name: "message.ends",
        meaning: "a stop with a message, or a question to the operator, stops the spindle and switches coolant off: where only one of the two is so, answer \
                  'message.ends.spindle' and 'message.ends.coolant'",
        questions: &[Question::MessageEndsSpindle, Question::MessageEndsCoolant],
    },
    QuestionGroup {
        name: "change.ends",
        meaning: "a tool change leaves the spindle stopped and coolant off: where only one of the two is so, answer \
                  'change.ends.spindle' and 'change.ends.coolant'",
        questions: &[Question::ChangeEndsSpindle, Question::ChangeEndsCoolant],
    },
    QuestionGroup {
        name: "end.ends",
        meaning: "the end of the program stops the spindle and switches coolant off: where only one of the two is so, answer \
                  'end.ends.spindle' and 'end.ends.coolant'",
        questions: &[Question::EndEndsSpindle, Question::EndEndsCoolant],
    },
    QuestionGroup {
        name: "no.result",
        meaning: "what a calculation without a result does: a division by zero, the root of a negative number",
        questions: &[Question::DivideByZero, Question::SqrtOfNegative],
    },
    QuestionGroup {
        name: "places",
        meaning: "whether places in machine coordinates, and work offsets that programs write as numbers, are right on this machine too, or are those of \
                  another: where only one of the two is so, or zero alone is meant as the home of each machine, answer 'machine.places' and \
                  'work.places'",
        questions: &[Question::WorkPlaces, Question::MachinePlaces],
    },
];

/// The line of a profile that answers for several stops at once: `"halts.end" = "stop yes, message no"`.
pub const HALTS: &str = "halts.end";

/// What that line asks.
pub const HALTS_ASKED: &str = "what stops the spindle and switches coolant off: a program stop, a stop with a message, a tool change; where one of them \
                               ends only one of the two, take it out and answer 'stop.ends.spindle' and 'stop.ends.coolant' (message.ends, change.ends)";

/// Its words, each with the group that it answers.
pub const HALTS_WORDS: [(&str, &str); 3] =
    [("stop", "stop.ends"), ("message", "message.ends"), ("change", "change.ends")];

impl QuestionGroup {
    /// The group with this name.
    pub fn find(name: &str) -> Option<&'static Self> {
        GROUPS.iter().find(|group| group.name == name)
    }

    /// The group that a question is in.
    pub fn of(question: Question) -> Option<&'static Self> {
        GROUPS.iter().find(|group| group.questions.contains(&question))
    }

    /// Every group.
    pub const fn all() -> &'static [Self] {
        GROUPS
    }

    /// The answers that it may have.
    pub fn answers(&self) -> Answers {
        self.questions.first().map_or(Answers::Number, |question| question.answers())
    }

    /// What a profile says to answer all of its questions.
    pub fn settled(&self) -> Settled {
        Settled::Answer { question: self.name.to_owned(), answers: self.answers().written(&[]) }
    }

    /// True where an answer of the profile settles one of its questions alone.
    pub fn has(&self, settled: &Settled, control: &Control) -> bool {
        self.questions.iter().any(|question| control.settled_by(question.fact()) == *settled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_of_a_group_have_the_same_answers_and_one_group() {
        for group in QuestionGroup::all() {
            assert!(Question::find(group.name).is_none() && group.questions.len() > 1, "{}", group.name);
            for question in group.questions {
                let (own, all) = (question.answers().written(&[]), group.answers().written(&[]));
                assert!(all.split(" or ").all(|one| own.contains(one)), "{question}");
                assert_eq!(QuestionGroup::of(*question), Some(group), "{question}");
            }
        }
    }

    /// Nobody's table answers where places are right, so the name answers both by itself.
    #[test]
    fn places_are_answered_under_one_name() {
        let read = |more: &str| {
            Control::from_profile(&format!("dialect = \"haas\"\n[behaviours]\nplaces = \"other\"\n{more}"))
                .unwrap()
        };
        let says = |control: &Control, question| control.behaviour(question).map(|row| row.value.clone());
        let both = read("");
        assert_eq!(says(&both, Question::MachinePlaces).as_deref(), Some("other"));
        assert_eq!(says(&both, Question::WorkPlaces).as_deref(), Some("other"));
        let home = read("\"machine.places\" = \"home\"\n");
        assert_eq!(says(&home, Question::MachinePlaces).as_deref(), Some("home"));
        assert_eq!(says(&home, Question::WorkPlaces).as_deref(), Some("other"));
    }
}
