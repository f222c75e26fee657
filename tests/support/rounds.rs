//! Programs that are converted to another control and back: the last text does what the first one did.

use crate::support::root;
use macroglot::control::LoadedFile;
use macroglot::dialect::{Control, Plain, Profile, Question, registry};
use macroglot::library::{
    Conversion, Input, Lock, Options, Outcome, ProgramReport, Project, convert, gather, judge,
};
use macroglot::syntax::{ParsedFile, parse_file};
use macroglot::verify::{Effort, Side};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Less than a conversion is given: both ways are verified elsewhere, and what a round changes shows early.
const EFFORT: Effort = Effort {
    fewest: 6,
    telling: 32,
    drawn: 3,
    scenarios: 32,
    tries: 80,
    steps: 5_000,
    all_steps: 60_000,
    seed: 0x6d67_0001,
    program_seconds: 60.0,
    library_seconds: 3600.0,
    allowed_mm: 0.0,
};

/// What became of a library on its way to another control and back.
pub struct Round {
    pub from: String,
    pub to: String,
    pub inputs: Vec<Input>,
    /// Programs that were written on the other control.
    pub there: usize,
    /// The programs of the first text; those that came back have what the verifier says of that text and the last one.
    pub back: Conversion,
    /// Files that came back.
    pub files: usize,
    /// Files whose text on the other control was the same after the second way there.
    pub same_there: usize,
    /// Files whose text was the same after the second way back.
    pub same_back: usize,
    /// Files that had gone round twice, and whose text a third way there and back changed.
    pub changed: Vec<String>,
}

/// A machine of the project file for programs of others, set to the unit.
fn machine(name: &str, unit: &str) -> Control {
    let project = Project::find(root()).unwrap().unwrap();
    let targets = project.libraries.values().flat_map(|library| library.targets.keys());
    let mut machines = targets.map(|name| &project.machines[name]).filter(|machine| machine.dialect == name);
    let path = machines.next().and_then(|machine| machine.profile.as_ref()).unwrap();
    let text = std::fs::read_to_string(root().join(path)).unwrap();
    let others = text.lines().filter(|line| !line.starts_with("units = "));
    let text = format!("units = \"{unit}\"\n{}", others.collect::<Vec<_>>().join("\n"));
    Control::new(registry::find(name).unwrap(), Profile::read(&text).unwrap()).unwrap()
}

/// Takes a library there and back, three times, between two machines of the project file that measure alike.
pub fn round(from: &str, to: &str, inputs: &[Input]) -> Round {
    // The course's programs are metric, and so is their machine; all others measure in inches.
    let unit = if from == "cc100" { "metric" } else { "inch" };
    between((from, to), &machine(from, unit), &machine(to, unit), inputs)
}

/// Takes the lathe programs of the project file to other lathes and back: to the one that the file names, and to their own
/// control with its other two systems of G codes.
pub fn turning() -> Vec<Round> {
    let project = Project::find(root()).unwrap().unwrap();
    let library = &project.libraries["turning"];
    let own = library.only.iter().flatten().map(|name| library.path.join(name));
    let files: Vec<_> = own.chain(library.shared.iter().cloned()).map(|path| root().join(path)).collect();
    let inputs = gather(&files, &[]).programs;
    let profile = |machine: &str| {
        let path = project.machines[machine].profile.as_ref().unwrap();
        Profile::load(&root().join(path)).unwrap()
    };
    let control =
        |profile: Profile| Control::new(registry::find(&profile.dialect).unwrap(), profile).unwrap();
    let mut home = profile(&library.machine);
    // What the shop keeps for itself the programs have been given.
    home.reserved.clear();
    let system = |name: &str| {
        let mut other = home.clone();
        other.settings.insert("gcode_system".into(), Plain::Word(name.into()));
        control(other)
    };
    let target = library.targets.keys().next().unwrap();
    let ways = [
        ("haas lathe", control(profile(target))),
        ("fanuc lathe B", system("B")),
        ("fanuc lathe C", system("C")),
    ];
    let home = control(home.clone());
    let round = |(to, away): (&str, Control)| between(("fanuc lathe", to), &home, &away, &inputs);
    ways.into_iter().map(round).collect()
}

fn between((from, to): (&str, &str), home: &Control, away: &Control, inputs: &[Input]) -> Round {
    let first = plain(inputs, home, away);
    let there = inputs_of(inputs, &first);
    let second = plain(&there, away, home);
    let mut back = composed((inputs, &first), (&there, &second), home, away);
    judge(inputs, &mut back, home, home, EFFORT);
    let home_again = inputs_of(&there, &second);
    let there_again = inputs_of(&home_again, &plain(&home_again, home, away));
    let back_again = inputs_of(&there_again, &plain(&there_again, away, home));
    // The same texts as the time before become the same again.
    let back_thrice = if back_again == home_again {
        back_again.clone()
    } else {
        let there_thrice = inputs_of(&back_again, &plain(&back_again, home, away));
        inputs_of(&there_thrice, &plain(&there_thrice, away, home))
    };
    let settled = |input: &&Input| !back_again.contains(input);
    let changed = back_thrice.iter().filter(settled).map(|input| input.name.clone()).collect();
    let same =
        |before: &[Input], after: &[Input]| after.iter().filter(|input| before.contains(input)).count();
    Round {
        from: from.to_owned(),
        to: to.to_owned(),
        inputs: inputs.to_vec(),
        there: first.programs.iter().filter(|program| program.outcome != Outcome::Refused).count(),
        back,
        files: home_again.len(),
        same_there: same(&there, &there_again),
        same_back: same(&home_again, &back_again),
        changed,
    }
}

fn plain(inputs: &[Input], source: &Control, target: &Control) -> Conversion {
    convert(inputs, source, target, Lock::new(source.name(), target.name()), Options::default())
}

/// The texts of a conversion as the next one reads them.
fn inputs_of(inputs: &[Input], conversion: &Conversion) -> Vec<Input> {
    let written = inputs.iter().zip(&conversion.texts);
    let written = written.filter_map(|(input, text)| {
        let bytes = text.as_ref()?.clone().into_bytes();
        Some(Input { path: input.path.clone(), name: input.name.clone(), bytes })
    });
    written.collect()
}

/// Two conversions, one behind the other, as one: its texts are the last ones, its reports those of the first programs.
fn composed(
    (inputs, first): (&[Input], &Conversion),
    (there, second): (&[Input], &Conversion),
    home: &Control,
    away: &Control,
) -> Conversion {
    let parsed: Vec<ParsedFile<'_>> =
        there.iter().map(|input| parse_file(&input.bytes, away.entry().parse)).collect();
    let loaded: Vec<LoadedFile<'_>> =
        there.iter().zip(&parsed).map(|(input, parsed)| LoadedFile { name: &input.name, parsed }).collect();
    let side = Side::new(away, away.entry().execute.unwrap(), &loaded);
    let starts = side.programs().iter().map(|program| {
        let block = parsed[program.file].blocks.get(side.blocks(*program).start);
        (program.file, block.map_or(0, |block| block.span.start as usize))
    });
    let starts: Vec<(usize, usize)> = starts.collect();
    let files = second.programs.iter().map(|program| program.file);
    assert!(starts.iter().map(|(file, _)| *file).eq(files), "reading and running cut a file alike");
    let place = |name: &str| there.iter().position(|input| input.name == name);
    let texts = inputs.iter().map(|input| second.texts[place(&input.name)?].clone());
    let programs = first.programs.iter().map(|program| {
        let file = place(&inputs[program.file].name);
        let inside = |(at, start): &(usize, usize)| Some(*at) == file && program.range.contains(start);
        let parts = starts.iter().zip(&second.programs).filter(|(at, _)| inside(at));
        let parts: Vec<&ProgramReport> = parts.map(|(_, part)| part).collect();
        let written = |program: &ProgramReport| program.outcome != Outcome::Refused;
        let is_back = written(program) && !parts.is_empty() && parts.iter().all(|part| written(part));
        let outcome = if is_back { Outcome::Review } else { Outcome::Refused };
        let range = if is_back { whole(parts.iter().map(|part| &part.range)) } else { 0..0 };
        ProgramReport { outcome, verdict: None, map: Vec::new(), range, ..program.clone() }
    });
    let programs = programs.collect();
    let lock = one_lock(&first.lock, &second.lock, away, home);
    let (taken, links) = (String::new(), first.links.clone());
    Conversion { programs, texts: texts.collect(), lock, taken, states_reserved: true, links }
}

/// The run of bytes that holds all of these.
fn whole<'r>(ranges: impl Iterator<Item = &'r Range<usize>> + Clone) -> Range<usize> {
    let filled = ranges.filter(|range| !range.is_empty());
    let start = filled.clone().map(|range| range.start).min().unwrap_or(0);
    start..filled.map(|range| range.end).max().unwrap_or(0)
}

/// Where each variable and program of the first text is in the last one.
fn one_lock(first: &Lock, second: &Lock, away: &Control, home: &Control) -> Lock {
    let letter = |control: &Control| {
        let row = control.classes().iter().find(|row| row.class != "letter").unwrap();
        row.name.clone()
    };
    let (there, here) = (letter(away), letter(home));
    let number = |name: &str| name.strip_prefix(&here).and_then(|number| number.parse::<u32>().ok());
    // A register that the way back left where it was: numbers are kept where variables may be vacant.
    let own = |name: &str| number(name).filter(|_| home.is(Question::Vacancy));
    let image = |name: &str| second.variables.get(name).copied().or_else(|| own(name));
    let mut variables = BTreeMap::new();
    let mut scratch: BTreeSet<u32> = second.scratch.iter().copied().collect();
    let mut came_from = BTreeMap::new();
    for (name, at) in &first.variables {
        let (register, to) = if name.ends_with("(..)") {
            let register = format!("{there}(..)");
            let to = second.variables.get(&register).map(|base| base + at);
            (register, to)
        } else {
            let register = format!("{there}{at}");
            let to = image(&register);
            (register, to)
        };
        // What no program that came back has is nowhere.
        match to {
            Some(to) => drop(variables.insert(name.clone(), to)),
            None => scratch.extend(number(name)),
        }
        came_from.insert(register, name);
    }
    let between: Vec<String> = first.scratch.iter().map(|number| format!("{there}{number}")).collect();
    let between: BTreeSet<&String> = between.iter().chain(&first.of_words).collect();
    scratch.extend(between.iter().filter_map(|name| image(name)));
    for (name, at) in &second.variables {
        let flag = name.strip_prefix("flag of ").and_then(|of| came_from.get(of));
        let known = came_from.contains_key(name) || between.contains(name);
        match flag {
            Some(of) => drop(variables.insert(format!("flag of {of}"), *at)),
            None if !known => drop(variables.entry(name.clone()).or_insert(*at)),
            None => {}
        }
    }
    // What a call has of its own is nowhere at the end, if the other control has no such variables.
    let locals = |control: &Control| -> Vec<u32> {
        let rows = control.classes().iter().filter(|row| row.class == "local");
        rows.flat_map(|row| row.first..=row.last).collect()
    };
    if locals(away).is_empty() {
        scratch.extend(locals(home));
    }
    // What nothing of the library uses has no place on another control, whatever a clearing of all does to it.
    if here != there {
        let rows = home.classes().iter().filter(|row| row.name == here && row.class != "local");
        let unused = rows.flat_map(|row| row.first..=row.last).filter(|number| {
            !first.variables.contains_key(&format!("{here}{number}"))
                && !first.variables.contains_key(&format!("{here}(..)"))
                && !variables.values().any(|taken| taken == number)
        });
        scratch.extend(unused);
    }
    let program = |number: u32| second.programs.get(&format!("O{number:04}")).copied().unwrap_or(number);
    let programs = first.programs.iter().map(|(name, number)| (name.clone(), program(*number)));
    let mut programs: BTreeMap<String, u32> = programs.collect();
    for (name, number) in &second.programs {
        programs.entry(name.clone()).or_insert(*number);
    }
    Lock {
        variables,
        scratch: scratch.into_iter().collect(),
        of_words: second.of_words.clone(),
        programs,
        ..Lock::new(&first.from, &second.to)
    }
}
