//! The machines of a survey, as they are once all that is asked of their profiles is answered.
//!
//! What the answers will be nobody knows yet: a code does the same there, a setting has its first value, and what no manual
//! confirms is so. How many programs are written then does not hang on which answer it is, as far as one more look can tell.

use super::Survey;
use crate::dialect::{Control, Plain, Profile, Settled, SiteCode, Without};
use crate::report::Questions;
use std::collections::BTreeMap;

/// A change of a profile.
type Answer = Box<dyn Fn(&mut Profile)>;

/// Both machines.
pub(super) fn controls(survey: &Survey<'_>) -> [Control; 2] {
    let [source, target] = survey.controls;
    let asked = |control: &Control| survey.with_questions(|questions| facts(questions, control));
    let codes = survey.codes.iter().map(|asked| -> Answer {
        let code = asked.code.clone();
        Box::new(move |profile| profile.site.push(site(&code)))
    });
    let source = with(source, codes.chain(asked(source)).collect());
    let target = with(target, asked(target));
    let as_they_are = [source.clone(), target.clone()];
    Control::meeting(source, target).map_or(as_they_are, |(source, target)| [source, target])
}

/// A code that the target has too.
fn site(code: &str) -> SiteCode {
    SiteCode {
        code: code.to_owned(),
        name: None,
        op: None,
        text: code.to_owned(),
        fixed: BTreeMap::new(),
        words: BTreeMap::new(),
        target: None,
        without: Some(Without::Same),
        calls: None,
        arguments: false,
        reads: BTreeMap::new(),
        sets: BTreeMap::new(),
        preferred: true,
    }
}

/// The answers to what is asked of a machine.
fn facts(questions: &Questions<'_>, control: &Control) -> Vec<Answer> {
    let is_it = |of: &Control| of.name() == control.name() && of.profile().file == control.profile().file;
    let machines = questions.machines.iter().filter(|machine| is_it(machine.control));
    machines.flat_map(|machine| &machine.facts).filter_map(|fact| answer(fact.settled_by.clone())).collect()
}

fn answer(settled: Settled) -> Option<Answer> {
    Some(match settled {
        Settled::Confirmed(fact) => Box::new(move |profile| profile.confirm.push(fact.clone())),
        Settled::Setting { section, name, values } => {
            let value = values.into_iter().next()?;
            Box::new(move |profile| {
                let section =
                    if section == "parameters" { &mut profile.parameters } else { &mut profile.settings };
                section.insert(name.clone(), Plain::Word(value.clone()));
            })
        }
        Settled::Answer { question, answers } => {
            let first = answers.split(" or ").next()?.trim_matches('"').to_owned();
            Box::new(move |profile| {
                profile.behaviours.insert(question.clone(), Plain::Word(first.clone()));
            })
        }
    })
}

/// The control with these answers in its profile: all of them, or those that its table takes.
fn with(control: &Control, answers: Vec<Answer>) -> Control {
    let mut profile = control.profile().clone();
    answers.iter().for_each(|answer| answer(&mut profile));
    if let Ok(made) = Control::new(control.entry(), profile) {
        return made;
    }
    let (mut made, mut profile) = (control.clone(), control.profile().clone());
    for answer in answers {
        let mut more = profile.clone();
        answer(&mut more);
        if let Ok(with) = Control::new(control.entry(), more.clone()) {
            (made, profile) = (with, more);
        }
    }
    made
}
