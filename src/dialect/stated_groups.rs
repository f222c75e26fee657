//! What a machine profile says of several questions by one name.

use super::overlay::Overlay;
use super::stated::{OPEN, answer, stated};
use super::{Dialect, HALTS, HALTS_WORDS, Question, QuestionGroup};

impl Overlay {
    /// Puts the answer to a group of questions in place of those that the table leaves open, and the profile too.
    pub(super) fn group(&mut self, dialect: &mut Dialect, name: &str, value: &str) {
        let Some(group) = QuestionGroup::find(name) else { return };
        let place = format!("behaviours:{name}");
        if !group.answers().admits(value) || OPEN.contains(&value) {
            let help = format!("it is {}", group.answers().written(&[]));
            return self.fault(&place, format!("'{value}' is not a value of {name}"), help);
        }
        let row = |question: &Question| dialect.behaviours.iter().find(|row| row.question == *question);
        let is_asked = |question: &Question| row(question).is_some() || question.needs() == Some("said");
        let asked: Vec<Question> = group.questions.iter().copied().filter(is_asked).collect();
        if asked.is_empty() {
            let help = "it has nothing that the questions are about: remove the line".to_owned();
            return self.fault(&place, format!("{} is not asked '{name}'", dialect.title), help);
        }
        for question in asked {
            let row = dialect.behaviours.iter().find(|row| row.question == question);
            let closed = row.filter(|row| !OPEN.contains(&row.value.as_str()) && row.origin.is_settled());
            let is_single =
                self.profile.behaviours.contains_key(question.name()) || self.is_set(dialect, question);
            if let Some(row) = closed.filter(|row| !is_single && row.value != value) {
                let message =
                    format!("{question} is '{}' in the table, and {name} says '{value}'", row.value);
                let help = format!("answer {question} by itself, if this machine is not so");
                self.fault(&place, message, help);
            } else if closed.is_none() && !is_single {
                match stated(dialect, question.name(), value) {
                    Ok(question) => answer(dialect, question, value.to_owned()),
                    Err((message, help)) => self.fault(&place, message, help),
                }
            }
        }
    }

    /// Answers what several stops end: `stop yes, message no`. A group that the profile answers by its own name stays so.
    pub(super) fn halts(&mut self, dialect: &mut Dialect, value: &str) {
        for part in value.split(',').map(str::trim).filter(|part| !part.is_empty()) {
            let said = part.split_once(' ').map(|(word, answer)| (word, answer.trim()));
            let group = said.and_then(|(word, _)| HALTS_WORDS.iter().find(|(own, _)| *own == word));
            let answer = match said {
                Some((_, "yes")) => "true",
                Some((_, "no")) => "false",
                _ => "",
            };
            match group.filter(|_| !answer.is_empty()) {
                Some((_, group)) if !self.profile.behaviours.contains_key(*group) => {
                    self.group(dialect, group, answer);
                }
                Some(_) => {}
                None => {
                    let words: Vec<&str> = HALTS_WORDS.iter().map(|(word, _)| *word).collect();
                    let help = format!("write yes or no after each: {}", words.join(" yes, ") + " no");
                    let place = format!("behaviours:{HALTS}");
                    self.fault(&place, format!("'{part}' is no answer of {HALTS}"), help);
                }
            }
        }
    }
}
