//! A survey for programs. Its keys are a contract.

use super::{AskedCode, AskedSetting, AskedStart, AskedVariables, AskedWord, Outcomes, Shape, Survey};
use crate::diag::{Code, Severity};
use crate::dialect::Side;
use crate::report::{Question, Questions};
use serde::Serialize;

#[derive(Serialize)]
struct Report<'a> {
    from: &'a str,
    to: Option<&'a str>,
    library: &'a Shape,
    /// Why the library is read as a lathe's, where no profile says it.
    #[serde(skip_serializing_if = "Option::is_none")]
    taken: Option<String>,
    codes: &'a [AskedCode],
    start: &'a [AskedStart],
    start_of_target: &'a [AskedStart],
    settings: Vec<Setting<'a>>,
    words: Vec<Word<'a>>,
    /// Runs of variables that the table of the source's control has not.
    variables: &'a [AskedVariables],
    questions: Vec<Asked<'a>>,
    /// What is asked once all of that is answered.
    later: Vec<Asked<'a>>,
    now: Outcomes,
    #[serde(skip_serializing_if = "Option::is_none")]
    answered: Option<Outcomes>,
    stays: Vec<Stays<'a>>,
}

#[derive(Serialize)]
struct Asked<'a> {
    code: Code,
    severity: Severity,
    message: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<&'a str>,
    programs: usize,
    places: &'a [String],
    /// The control whose profile answers it.
    #[serde(skip_serializing_if = "Option::is_none")]
    machine: Option<&'a str>,
}

#[derive(Serialize)]
struct Setting<'a> {
    /// The control whose profile states it.
    machine: &'a str,
    #[serde(flatten)]
    asked: &'a AskedSetting,
}

#[derive(Serialize)]
struct Word<'a> {
    /// The control whose profile names it.
    machine: &'a str,
    #[serde(flatten)]
    asked: &'a AskedWord,
}

#[derive(Serialize)]
struct Stays<'a> {
    why: &'a str,
    programs: usize,
}

/// The survey as JSON text.
pub fn json(survey: &Survey<'_>) -> String {
    let stays = survey.stays.iter().map(|(why, programs)| Stays { why, programs: *programs }).collect();
    let [source, target] = survey.controls;
    let settings = survey.settings.iter().map(|asked| Setting {
        machine: if asked.side == Side::Source { source } else { target }.name(),
        asked,
    });
    let settings: Vec<Setting<'_>> = settings.collect();
    let words = survey.words.iter().map(|asked| Word {
        machine: if asked.side == Side::Source { source } else { target }.name(),
        asked,
    });
    survey.with_later(|later| {
        survey.with_questions(|questions| {
            let report = Report {
                from: source.name(),
                to: survey.goes.then(|| target.name()),
                library: &survey.shape,
                taken: survey.taken.as_ref().map(ToString::to_string),
                codes: &survey.codes,
                start: &survey.start,
                start_of_target: &survey.start_of_target,
                settings,
                words: words.collect(),
                variables: &survey.variables,
                questions: all(questions),
                later: all(later),
                now: survey.now,
                answered: survey.answered,
                stays,
            };
            // All keys are texts, and writing to memory cannot fail.
            let mut text = serde_json::to_string_pretty(&report).unwrap_or_default();
            text.push('\n');
            text
        })
    })
}

fn all<'q>(questions: &'q Questions<'_>) -> Vec<Asked<'q>> {
    let open = questions.open.iter().map(|question| asked(question, None));
    let of = questions.machines.iter().flat_map(|machine| {
        machine.facts.iter().map(|fact| asked(&fact.asked, Some(machine.control.name())))
    });
    open.chain(of).collect()
}

fn asked<'q>(question: &'q Question<'_>, machine: Option<&'q str>) -> Asked<'q> {
    Asked {
        code: question.code,
        severity: question.code.severity(),
        message: question.text,
        help: question.help,
        programs: question.programs,
        places: &question.places,
        machine,
    }
}
