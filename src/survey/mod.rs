//! One look over a library before it is converted: what it is, and what must be known of its machines.
//!
//! Nothing is written and nothing is judged by running it. What the conversion would ask stands here once each, with how many programs wait for
//! it, and what would become of the library now, and once all of it is answered.

mod answered;
mod beside;
mod callers;
mod codes;
mod digits;
mod families;
mod far_places;
mod filled;
mod json;
mod kept;
mod keys;
mod machine;
mod needs;
mod own_calls;
mod programs;
mod shape;
mod signals;
mod site_rows;
mod speeds;
mod start;
mod text;
mod there;
mod tried;
mod unseen;
mod variables;
mod words;

pub use callers::MayCall;
pub use codes::AskedCode;
pub use filled::{Unfit, filled};
pub use json::json;
pub use keys::AskedSetting;
pub use shape::{Missing, Shape};
pub use signals::AskedSignal;
pub use start::AskedStart;
pub use text::text;
pub use there::AskedThere;
pub use variables::AskedVariables;
pub use words::AskedWord;

use crate::canon::Role;
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::{Control, Question, Settled};
use crate::library::{
    Conversion, Input, Lock, Options, Outcome, ProgramReport, TakenAsLathe, Told, Understood, convert,
    is_of_another, outcome, understood,
};
use crate::report::{Fact, Part, Questions};
use serde::Serialize;
use shape::Places;
use std::collections::BTreeMap;

/// What a look over a library showed.
pub struct Survey<'a> {
    inputs: &'a [Input],
    /// The machine that its programs are for, and the one that they are to go to; twice the first if no other was named.
    controls: [&'a Control; 2],
    /// True if a target was named.
    goes: bool,
    /// Why the library is read as a lathe's, where no profile says it.
    pub taken: Option<TakenAsLathe>,
    /// By machine: true where it is a lathe, and its profile does not say so.
    pub is_open_lathe: [bool; 2],
    /// What the library is.
    pub shape: Shape,
    /// The codes of which a profile must say what the machine's builder made of them; what frees most programs is first.
    pub codes: Vec<AskedCode>,
    /// Codes that call a program of the builder by a parameter, and that the target has itself.
    own_calls: Vec<own_calls::OwnCall>,
    /// What its programs take from the machine when they begin, and the profile does not say.
    pub start: Vec<AskedStart>,
    /// What the target must begin in too, and its profile does not say: of programs at whose heads no code can be written.
    pub start_of_target: Vec<AskedStart>,
    /// Settings of the machines that programs wait for; those of most programs are first.
    pub settings: Vec<AskedSetting>,
    /// Words that the profiles of the machines would have to name at codes of their builders.
    pub words: Vec<AskedWord>,
    /// Names of the source's codes for which the target's profile has no code.
    pub there: Vec<AskedThere>,
    /// Inputs and outputs of which the target's profile must say the wire.
    pub signals: Vec<AskedSignal>,
    /// Variables that programs use and the table of their control has not.
    pub variables: Vec<AskedVariables>,
    /// The letters of the axes that its programs move and that not every such machine has.
    further_axes: Vec<Role>,
    /// The places in machine coordinates that its programs name, each with how many of them do.
    far_places: Vec<(String, usize)>,
    /// What else they show of their machine.
    needs: needs::Needs,
    /// What is found in its programs, but for those codes and for what its shape says.
    rest: Conversion,
    /// What is found in its programs once all that was asked before is answered, again and again; none if no target was named.
    then: Vec<Conversion>,
    /// The machines as they are then.
    best: Option<[Control; 2]>,
    /// What would become of it now.
    pub now: Outcomes,
    /// What would become of it once all that profiles can answer is answered; none if no target was named.
    pub answered: Option<Outcomes>,
    /// Nothing is written.
    folder: Told,
    /// Why programs stay refused then, with how many of them say so; the most frequent first.
    pub stays: Vec<(String, usize)>,
}

/// How many programs come out how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Outcomes {
    /// Programs that need no look.
    pub converted: usize,
    /// Programs that a person must look at.
    pub review: usize,
    /// Programs without a conversion.
    pub refused: usize,
}

impl Outcomes {
    fn of(programs: &[ProgramReport]) -> Self {
        let count = |outcome| programs.iter().filter(|program| program.outcome == outcome).count();
        let [converted, review, refused] = [Outcome::Converted, Outcome::Review, Outcome::Refused].map(count);
        Self { converted, review, refused }
    }
}

/// What a feed without a decimal point counts, which is known of millimetres a minute.
const BARE_FEED: &str = "bare_feed";

/// How often what was asked is answered, to see what is asked then.
const ROUNDS: usize = 4;

/// Looks over the library.
pub fn survey<'a>(inputs: &'a [Input], source: &'a Control, target: Option<&'a Control>) -> Survey<'a> {
    let library = understood(inputs, source);
    let places = Places::new(inputs);
    let shape = Shape::of(inputs, &places, &library);
    let mut start = start::asked(&places, source, &library.module);
    let (mut start_of_target, unit_there) = target.map_or_else(Default::default, |target| {
        start::asked_of_target(&places, (source, target), &library.module)
    });
    if let Some(target) = target {
        // A profile that says anything of the start is taken to say all of it.
        let no_length = |of: [&Control; 2]| start::no_length(&places, of, &library.module);
        start.extend(start.is_empty().then(|| no_length([source, target])).flatten());
        start_of_target.extend(start_of_target.is_empty().then(|| no_length([target, source])).flatten());
    }
    let further_axes = variables::further_axes(source, &library.module);
    let needs = needs::Needs::of(&library.module, unit_there);
    let digits =
        target.map_or_else(Vec::new, |target| digits::asked(&places, [source, target], &library.module));
    let far_places = target.map_or_else(Vec::new, |target| far_places::named(target, &library.module));
    let speeds = target.map_or_else(Vec::new, |target| speeds::asked(&places, target, &library.module));
    let own_calls = target
        .map_or_else(Vec::new, |target| own_calls::found(inputs, &places, [source, target], &library.module));
    let mut conversion = match target {
        Some(target) => plain(inputs, source, target),
        None => as_read(inputs, source, library),
    };
    let now = Outcomes::of(&conversion.programs);
    let mut codes = codes::asked(inputs, &places, source, &conversion.programs);
    let other_system = |finding: &Diagnostic| finding.code == Code::CodeSystem;
    if conversion.programs.iter().flat_map(|program| &program.diagnostics).any(other_system) {
        // What the codes of another system mean is asked by its name.
        let number = |code: &str| code.strip_prefix('G').and_then(|number| number.parse().ok());
        codes.retain(|asked| !number(&asked.code).is_some_and(|code| is_of_another(source, code)));
        start = start::asked_by_others(&places, inputs, source);
    }
    let controls = [source, target.unwrap_or(source)];
    let mut settings = keys::asked(&places, controls, &conversion.programs);
    settings.extend(callers::by_parameter(&mut codes, source));
    settings.extend(digits);
    settings.extend(speeds);
    let words = words::asked(&places, &conversion.programs);
    let there = there::asked(&places, source, &conversion.programs);
    let signals = signals::asked(&places, &conversion.programs);
    let variables = variables::asked(&places, source, &conversion.programs);
    for program in &mut conversion.programs {
        let of_shape = |code| matches!(code, Code::OutsideLibrary | Code::TwinProgram);
        program.diagnostics.retain(|finding| !codes::asks_code(finding) && !of_shape(finding.code));
    }
    let goes = target.is_some();
    let mut survey = Survey {
        inputs,
        controls,
        goes,
        taken: None,
        is_open_lathe: [false; 2],
        shape,
        codes,
        own_calls,
        start,
        start_of_target,
        settings,
        words,
        there,
        signals,
        variables,
        further_axes,
        far_places,
        needs,
        rest: conversion,
        then: Vec::new(),
        best: None,
        now,
        answered: None,
        folder: Told::default(),
        stays: Vec::new(),
    };
    if target.is_some() {
        let _ = (0..ROUNDS).find(|_| !survey.answer(&places));
        let answered = survey.best.take();
        if let (Some(last), Some([source, target])) = (survey.then.last_mut(), answered) {
            tried::add_facts(inputs, last, [&source, &target]);
        }
    }
    survey
}

impl Survey<'_> {
    /// True for a file of the library, as places name it.
    fn has_file(&self, name: &str) -> bool {
        self.inputs.iter().any(|input| input.name == name || input.path.to_string_lossy() == name)
    }

    /// Converts the library with all answered that was asked so far. True if that asks something new.
    fn answer(&mut self, places: &Places<'_>) -> bool {
        let then = [true, false].map(|chosen| {
            let controls = answered::controls(self, chosen);
            (plain(self.inputs, &controls[0], &controls[1]), controls)
        });
        let best = then.into_iter().min_by_key(|(then, _)| {
            let Outcomes { refused, review, .. } = Outcomes::of(&then.programs);
            (refused, review)
        });
        let Some((best, controls)) = best else { return false };
        self.best = Some(controls);
        self.answered = Some(Outcomes::of(&best.programs));
        self.stays = reasons(&best.programs);
        let known = self.asked_so_far();
        let codes = codes::asked(self.inputs, places, self.controls[0], &best.programs).into_iter();
        let mut codes: Vec<AskedCode> =
            codes.filter(|new| !self.codes.iter().any(|old| old.code == new.code)).collect();
        let is_asked = |parameter: u32| self.settings.iter().any(|asked| asked.name == parameter.to_string());
        codes.iter_mut().for_each(|code| code.calls.retain(|call| !is_asked(call.parameter)));
        self.codes.extend(codes);
        let asked = keys::asked(places, self.controls, &best.programs);
        let is_known =
            |new: &AskedSetting| self.settings.iter().any(|old| old.side == new.side && old.name == new.name);
        // A length that was read in a unit that nobody has said yet.
        let has_unit = self.controls.iter().any(|control| control.units().is_some());
        let is_guessed =
            |new: &AskedSetting| !has_unit && Question::find(&new.name) == Some(Question::CyclePeckClearance);
        let new: Vec<AskedSetting> =
            asked.into_iter().filter(|new| !is_known(new) && !is_guessed(new)).collect();
        self.settings.extend(new);
        let words = words::asked(places, &best.programs).into_iter();
        let words: Vec<AskedWord> = words.filter(|new| !self.words.iter().any(|old| old.is(new))).collect();
        self.words.extend(words);
        let signals = signals::asked(places, &best.programs).into_iter();
        let signals: Vec<AskedSignal> =
            signals.filter(|new| !self.signals.iter().any(|old| old.is(new))).collect();
        self.signals.extend(signals);
        self.then.push(best);
        known != self.asked_so_far()
    }

    /// How much is asked of each kind.
    fn asked_so_far(&self) -> [usize; 5] {
        let [codes, settings, words] = [self.codes.len(), self.settings.len(), self.words.len()];
        [codes, settings, words, self.signals.len(), self.asked_later()]
    }

    /// How many facts are asked of the machines once others are known.
    fn asked_later(&self) -> usize {
        self.with_later(|later| later.machines.iter().map(|machine| machine.facts.len()).sum())
    }

    /// What it asks beside the codes, each thing once.
    pub fn with_questions<T>(&self, look: impl FnOnce(&Questions<'_>) -> T) -> T {
        let mut questions = Questions::of(&[self.part(&self.rest)]);
        self.without_unit(&mut questions);
        look(&questions)
    }

    /// What it will ask of the machines once all of that is answered, and does not ask now.
    pub fn with_later<T>(&self, look: impl FnOnce(&Questions<'_>) -> T) -> T {
        // What is asked now is taken out first; then questions of one kind become one.
        let mut later = Questions::single(&self.then.iter().map(|then| self.part(then)).collect::<Vec<_>>());
        let now = Questions::single(&[self.part(&self.rest)]);
        let known = |fact: &Fact<'_>| {
            now.machines.iter().flat_map(|machine| &machine.facts).any(|of| of.settled_by == fact.settled_by)
        };
        later.machines.iter_mut().for_each(|machine| machine.facts.retain(|fact| !known(fact)));
        self.without_unit(&mut later);
        later.machines.retain(|machine| !machine.facts.is_empty());
        later.group();
        later.open.clear();
        later.notes = 0;
        look(&later)
    }

    /// What it asks of the machines now and once that is answered, together: a profile has one line for it.
    pub(super) fn with_all<T>(&self, look: impl FnOnce(&Questions<'_>) -> T) -> T {
        let parts: Vec<Part<'_>> =
            std::iter::once(&self.rest).chain(&self.then).map(|made| self.part(made)).collect();
        let mut questions = Questions::single(&parts);
        self.without_unit(&mut questions);
        questions.group();
        look(&questions)
    }

    /// Takes out the question of the source's unit where it stands among what programs take from the machine, and what hangs on its
    /// answer: who answers metric is not asked.
    fn without_unit(&self, questions: &mut Questions<'_>) {
        let source = self.controls[0];
        let is_source =
            |of: &Control| of.name() == source.name() && of.profile().file == source.profile().file;
        if self.start.iter().any(AskedStart::is_unit) {
            for machine in questions.machines.iter_mut().filter(|machine| is_source(machine.control)) {
                machine.facts.retain(|fact| {
                    fact.settled_by != Settled::UNITS
                        && !matches!(&fact.settled_by, Settled::Setting { name, .. } if name == BARE_FEED)
                });
            }
            questions.machines.retain(|machine| !machine.facts.is_empty());
        }
    }

    fn part<'s>(&'s self, conversion: &'s Conversion) -> Part<'s> {
        Part {
            from: self.controls[0].name(),
            to: self.controls[1].name(),
            controls: self.controls,
            inputs: self.inputs,
            named: &[],
            conversion,
            certificates: None,
            targets: &[],
            notes: &[],
            advice: None,
            folder: &self.folder,
            left_out: &[],
            verbose: false,
        }
    }
}

fn plain(inputs: &[Input], source: &Control, target: &Control) -> Conversion {
    convert(inputs, source, target, Lock::new(source.name(), target.name()), Options::default())
}

/// A library that goes nowhere: what its own control understands of it.
fn as_read(inputs: &[Input], source: &Control, library: Understood) -> Conversion {
    let programs = library.module.programs.iter().zip(library.found).map(|(program, diagnostics)| {
        let outcome = outcome(&diagnostics);
        let name = program.name.as_ref().map(ToString::to_string);
        ProgramReport {
            file: program.file,
            name,
            outcome,
            verdict: None,
            diagnostics,
            map: Vec::new(),
            range: 0..0,
        }
    });
    Conversion {
        programs: programs.collect(),
        texts: vec![None; inputs.len()],
        lock: Lock::new(source.name(), source.name()),
        taken: String::new(),
        states_reserved: false,
        links: Vec::new(),
    }
}

/// The errors of refused programs, each text once with how many programs have it.
fn reasons(programs: &[ProgramReport]) -> Vec<(String, usize)> {
    let mut all: BTreeMap<String, usize> = BTreeMap::new();
    for program in programs.iter().filter(|program| program.outcome == Outcome::Refused) {
        let errors = program.diagnostics.iter().filter(|finding| finding.severity() == Severity::Error);
        let mut told: Vec<String> =
            errors.map(|finding| format!("{} {}", finding.code.number(), finding.message)).collect();
        told.sort();
        told.dedup();
        told.into_iter().for_each(|text| *all.entry(text).or_default() += 1);
    }
    let mut all: Vec<(String, usize)> = all.into_iter().collect();
    all.sort_by_key(|(_, programs)| std::cmp::Reverse(*programs));
    all
}
