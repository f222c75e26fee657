//! Questions of a machine that one answer of its profile settles, as one.

use super::questions::{Fact, KEPT, Machine, NAMED, Question, Questions};
use crate::dialect::{HALTS, HALTS_ASKED, HALTS_WORDS, QuestionGroup, Settled};

impl Questions<'_> {
    /// Puts questions of one kind together, of each machine that is asked two of them or more.
    pub fn group(&mut self) {
        for machine in &mut self.machines {
            QuestionGroup::all().iter().for_each(|group| put_together(machine, group));
            halts(machine);
        }
    }
}

/// The group's question stands where the first of its own stood.
fn put_together(machine: &mut Machine<'_>, group: &'static QuestionGroup) {
    let is_of = |fact: &Fact<'_>| group.has(&fact.settled_by, machine.control);
    let of: Vec<bool> = machine.facts.iter().map(is_of).collect();
    let (Some(first), true) = (of.iter().position(|of| *of), of.iter().filter(|of| **of).count() > 1) else {
        return;
    };
    let mut numbers = of.iter();
    let mut members: Vec<Fact<'_>> =
        machine.facts.extract_if(.., |_| numbers.next().is_some_and(|of| *of)).collect();
    let mut asked = members.remove(0).asked;
    members.into_iter().for_each(|member| join(&mut asked, member.asked));
    (asked.text, asked.help) = (group.meaning, None);
    machine.facts.insert(first, Fact { settled_by: group.settled(), asked });
}

/// One line for what several stops end, where more than one of them is asked.
fn halts(machine: &mut Machine<'_>) {
    let control = machine.control;
    let word_of = |fact: &Fact<'_>| {
        let of = HALTS_WORDS.iter().filter_map(|(word, name)| Some((*word, QuestionGroup::find(name)?)));
        let mut of = of
            .filter(|(_, group)| group.settled() == fact.settled_by || group.has(&fact.settled_by, control));
        of.next().map(|(word, _)| word)
    };
    let words: Vec<Option<&str>> = machine.facts.iter().map(word_of).collect();
    let asked: Vec<&str> =
        HALTS_WORDS.iter().map(|(word, _)| *word).filter(|word| words.contains(&Some(word))).collect();
    let Some(first) = words.iter().position(Option::is_some).filter(|_| asked.len() > 1) else { return };
    let mut of = words.iter();
    let mut members: Vec<Fact<'_>> =
        machine.facts.extract_if(.., |_| of.next().is_some_and(Option::is_some)).collect();
    let mut whole = members.remove(0).asked;
    members.into_iter().for_each(|member| join(&mut whole, member.asked));
    (whole.text, whole.help) = (HALTS_ASKED, None);
    let answers = asked.iter().map(|word| format!("{word} yes|no")).collect::<Vec<_>>().join(", ");
    let settled_by = Settled::Answer { question: HALTS.to_owned(), answers: format!("\"{answers}\"") };
    machine.facts.insert(first, Fact { settled_by, asked: whole });
}

/// Adds the programs and the places of another question.
fn join<'a>(asked: &mut Question<'a>, other: Question<'a>) {
    let all_known = asked.spots.len() == asked.programs && other.spots.len() == other.programs;
    let is_new = |spot: &&super::questions::Spot| {
        !asked.spots.iter().any(|known| (known.part, known.program) == (spot.part, spot.program))
    };
    let new: Vec<_> = other.spots.iter().filter(is_new).copied().collect();
    asked.programs = match all_known {
        true => asked.programs + new.len(),
        false => asked.programs.max(other.programs),
    };
    let room = KEPT.saturating_sub(asked.spots.len());
    asked.spots.extend(new.into_iter().take(room));
    for place in other.places {
        if asked.places.len() < NAMED && !asked.places.contains(&place) {
            asked.places.push(place);
        }
    }
    asked.danger = asked.danger.min(other.danger);
}
