//! The machines of a survey, as they are once all that is asked of their profiles is answered.
//!
//! What the answers will be nobody knows yet. A code is taken to be left out, what no manual confirms to be so, and a question
//! to have the answer of the other machine, or else its first one. If fewer programs are written with such answers than without
//! them, the questions with several answers are left open.

use super::{AskedStart, MayCall, Survey};
use crate::canon::Op;
use crate::dialect::{
    Control, DecimalPoint, HALTS, Plain, Profile, Question, QuestionGroup, Settled, Side, SiteCode, Units,
    Without,
};
use crate::report::Questions;
use std::collections::BTreeMap;

/// Codes that are answered, the most frequent first: a damaged library may have any number of them.
const CODES: usize = 500;

/// A change of a profile.
type Answer = Box<dyn Fn(&mut Profile)>;

/// Both machines; `chosen` says whether questions with several answers have one.
pub(super) fn controls(survey: &Survey<'_>, chosen: bool) -> [Control; 2] {
    let [source, target] = survey.controls;
    let asked = |control: &Control, other: &Control| {
        let now = survey.with_questions(|questions| facts(questions, control, other, chosen));
        let later = survey.with_later(|questions| facts(questions, control, other, chosen));
        now.into_iter().chain(later).collect::<Vec<Answer>>()
    };
    let codes = survey.codes.iter().take(CODES).map(|asked| -> Answer {
        let (code, words, op) = (asked.code.clone(), asked.words.clone(), asked.op);
        match asked.calls.first().filter(|_| super::callers::is_call(&asked.calls, &code)).cloned() {
            Some(MayCall { program, arguments, .. }) => Box::new(move |profile| {
                let row = site(&code, &[], op);
                profile.site.push(SiteCode { calls: Some(program), arguments, without: None, ..row });
            }),
            None => Box::new(move |profile| profile.site.push(site(&code, &words, op))),
        }
    });
    // The unit has a key of its own.
    let units = survey.start.iter().any(AskedStart::is_unit) && chosen;
    let units = units.then(|| -> Answer { Box::new(|profile| profile.units = Some(Units::Metric)) });
    let begins = survey.start.iter().filter(|asked| !asked.is_unit());
    let begins: Vec<String> = begins.filter_map(|asked| asked.codes.first().cloned()).collect();
    let start = chosen.then(|| -> Answer { Box::new(move |profile| begin(profile, &begins)) });
    let there = begins_there(survey);
    let start_there = chosen.then(|| -> Answer { Box::new(move |profile| begin(profile, &there)) });
    let all = super::variables::all(source, &survey.variables);
    let more: Option<Answer> = (!survey.variables.is_empty())
        .then(|| -> Answer { Box::new(move |profile| profile.variables = Some(all.clone())) });
    let answered = with(
        source,
        codes
            .chain(more)
            .chain(asked(source, target))
            .chain(units)
            .chain(start)
            .chain(settings(survey, Side::Source))
            .chain(words(survey, Side::Source))
            .chain(left_out(survey))
            .collect(),
    );
    let programs = super::programs::entries(survey);
    let stand: Answer = Box::new(move |profile| profile.programs.extend(programs.iter().cloned()));
    let (signals, of) = (survey.signals.clone(), target.clone());
    let wired: Answer = Box::new(move |profile| super::signals::answer(&of, &signals, profile));
    let of_target = asked(target, source).into_iter().chain(start_there).chain([stand, wired]);
    let of_target = of_target.chain(settings(survey, Side::Target)).chain(words(survey, Side::Target));
    let of_target = of_target.chain(codes_there(survey));
    let target = with(target, of_target.collect());
    let as_they_are = [answered.clone(), target.clone()];
    Control::meeting(answered, target).map_or(as_they_are, |(source, target)| [source, target])
}

/// What the target begins in: the same as the source, as far as its profile says that.
fn begins_there(survey: &Survey<'_>) -> Vec<String> {
    let [source, target] = survey.controls;
    let code = |asked: &AskedStart| {
        let mode = source.start().iter().find(|mode| mode.op.group() == asked.group);
        let same = mode.and_then(|mode| target.code_for(mode.op, &mode.fixed)).map(|row| row.code.clone());
        same.or_else(|| asked.codes.first().cloned())
    };
    survey.start_of_target.iter().filter_map(code).collect()
}

/// The settings that programs wait for, as a machine might have them.
fn settings<'s>(survey: &'s Survey<'_>, side: Side) -> impl Iterator<Item = Answer> + use<'s> {
    let of_side = survey
        .settings
        .iter()
        .filter(move |asked| asked.side == side && asked.section != super::speeds::SECTION);
    of_side.map(|asked| -> Answer {
        let (section, name, value) = (asked.section, asked.name.clone(), asked.usual());
        Box::new(move |profile| set(profile, section, &name, &value))
    })
}

/// The words that codes lack, each by the name that it has or by its letter.
fn words<'s>(survey: &'s Survey<'_>, side: Side) -> impl Iterator<Item = Answer> + use<'s> {
    survey.words.iter().filter(move |asked| asked.side == side).map(|asked| -> Answer {
        let (code, letter, name) = (asked.code.clone(), asked.letter.to_string(), asked.name.clone());
        Box::new(move |profile| {
            let sites = profile.site.iter_mut().filter(|site| site.code == code);
            sites.for_each(|site| _ = site.words.entry(letter.clone()).or_insert_with(|| name.clone()));
        })
    })
}

/// The codes for which the target would have to have one by their name: as if there were nothing to do there.
fn left_out<'s>(survey: &'s Survey<'_>) -> impl Iterator<Item = Answer> + use<'s> {
    survey.there.iter().filter(|asked| asked.op.is_none()).map(|asked| -> Answer {
        let name = asked.name.clone();
        Box::new(move |profile| {
            let sites = profile.site.iter_mut().filter(|site| site.name.as_ref() == Some(&name));
            sites.for_each(|site| site.without = Some(Without::Omit));
        })
    })
}

/// The codes of the target that do what its table has none for, with numbers that nobody uses.
fn codes_there<'s>(survey: &'s Survey<'_>) -> impl Iterator<Item = Answer> + use<'s> {
    let target = survey.controls[1];
    let free = (0..1000).rev().filter(|number| target.code('M', f64::from(*number), &[]).is_none());
    let ops = survey.there.iter().filter_map(|asked| asked.op);
    ops.zip(free).map(|(op, number)| -> Answer {
        Box::new(move |profile| profile.site.push(site(&format!("M{number}"), &[], Some(op))))
    })
}

fn set(profile: &mut Profile, section: &str, name: &str, value: &str) {
    let section = match section {
        "parameters" => &mut profile.parameters,
        "behaviours" => &mut profile.behaviours,
        _ => &mut profile.settings,
    };
    section.insert(name.to_owned(), Plain::Word(value.to_owned()));
}

/// Adds what programs begin in to what the profile says of that.
fn begin(profile: &mut Profile, codes: &[String]) {
    let said = profile.start.codes.take().into_iter();
    let all: Vec<String> = said.chain(codes.iter().cloned()).collect();
    profile.start.codes = (!all.is_empty()).then(|| all.join(" "));
}

/// A code that means nothing to the target, or does what it is likely to do.
fn site(code: &str, words: &[char], op: Option<Op>) -> SiteCode {
    SiteCode {
        code: code.to_owned(),
        name: None,
        op,
        with: Vec::new(),
        text: code.to_owned(),
        fixed: BTreeMap::new(),
        words: words.iter().map(|letter| (letter.to_string(), letter.to_string())).collect(),
        target: None,
        without: Some(Without::Omit).filter(|_| op.is_none()),
        calls: None,
        arguments: false,
        reads: BTreeMap::new(),
        sets: BTreeMap::new(),
        keeps: None,
        preferred: true,
    }
}

/// The answers to what is asked of a machine.
fn facts(questions: &Questions<'_>, control: &Control, other: &Control, chosen: bool) -> Vec<Answer> {
    let is_it = |of: &Control| of.name() == control.name() && of.profile().file == control.profile().file;
    let machines = questions.machines.iter().filter(|machine| is_it(machine.control));
    let settled = machines.flat_map(|machine| &machine.facts).map(|fact| fact.settled_by.clone());
    // What a limit is, a shop tries: its machine takes what its programs have, or its profile says how much it takes.
    let tried = |settled: &Settled| matches!(settled, Settled::Confirmed(fact) if fact.starts_with("limit:"));
    let settled = settled.filter(|settled| !tried(settled));
    let wanted = settled.filter(|settled| chosen || matches!(settled, Settled::Confirmed(_)));
    wanted.filter_map(|settled| answer(settled, other)).collect()
}

fn answer(settled: Settled, other: &Control) -> Option<Answer> {
    Some(match settled {
        Settled::Confirmed(fact) => Box::new(move |profile| profile.confirm.push(fact.clone())),
        Settled::Setting { section, name, values } => {
            let value = values.into_iter().next()?;
            Box::new(move |profile| set(profile, section, &name, &value))
        }
        // Either answers it.
        Settled::Key { name: "units", .. } => Box::new(|profile| profile.units = Some(Units::Metric)),
        Settled::Key { .. } => Box::new(|profile| profile.decimal_point = Some(DecimalPoint::Calculator)),
        Settled::Answer { question, answers } if question == HALTS => {
            let all = answers.trim_matches('"').replace("yes|no", "yes");
            Box::new(move |profile| {
                profile.behaviours.insert(HALTS.to_owned(), Plain::Word(all.clone()));
            })
        }
        Settled::Answer { question, answers } => {
            let first = QuestionGroup::find(&question).and_then(|group| group.questions.first().copied());
            let there = Question::find(&question).or(first).and_then(|question| other.behaviour(question));
            let mut all = answers.split(" or ").map(|answer| answer.trim_matches('"'));
            let same = all.clone().find(|answer| there.is_some_and(|row| row.value == *answer));
            let first = same.or_else(|| all.next())?.to_owned();
            Box::new(move |profile| {
                profile.behaviours.insert(question.clone(), Plain::Word(first.clone()));
            })
        }
    })
}

/// Tries of answers that the table may not take: a profile with a few hundred of them costs milliseconds each.
const TRIES: usize = 100;

/// The control with these answers in its profile: all of them, or those that its table takes.
fn with(control: &Control, answers: Vec<Answer>) -> Control {
    let mut made = control.clone();
    let mut tries = 0;
    // What does not go together is halved, until what is wrong stands alone.
    let mut groups: Vec<&[Answer]> = vec![&answers];
    while let Some(group) = groups.pop().filter(|_| tries < TRIES) {
        tries += 1;
        let mut profile = made.profile().clone();
        group.iter().for_each(|answer| answer(&mut profile));
        match Control::new(control.entry(), profile) {
            Ok(with) => made = with,
            Err(_) if group.len() > 1 => groups.extend(group.chunks(group.len().div_ceil(2)).rev()),
            Err(_) => {}
        }
    }
    made
}
