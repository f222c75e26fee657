//! What the passes of legalization make of a program moves as its list says: conversions run on the target's control.

use super::{Expectation, Move, difference, difference_by, expectations, expectations_of, moves};
use crate::support::root;
use macroglot::dialect::{Control, Profile, registry};
use macroglot::ir::Module;
use macroglot::legalize::Context;
use macroglot::legalize::pipeline::{self, Pass};
use macroglot::library::{Conversion, Input, Lock, Options, Outcome, convert};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A conversion that must make the same moves.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Converts {
    pub to: String,
    /// The files of `src/legalize/` that put something in another's place here.
    pub files: Vec<String>,
    #[serde(default)]
    pub profile: String,
    /// The circumstances on the target, where its variables have other names.
    pub scenario: Option<String>,
}

fn control(dialect: &str, profile: &str) -> Control {
    let entry = registry::find(dialect).expect("a dialect");
    Control::new(entry, Profile::read(profile).expect("a profile")).expect("a control")
}

fn inputs(expectation: &Expectation) -> Vec<Input> {
    let read = |name: &String| {
        let path = root().join(name);
        Input { bytes: std::fs::read(&path).unwrap(), path, name: name.clone() }
    };
    expectation.run.iter().map(read).collect()
}

fn conversion(expectation: &Expectation, source: &Control, target: &Control) -> Conversion {
    let lock = Lock::new(source.name(), target.name());
    convert(&inputs(expectation), source, target, lock, Options::default())
}

/// The passes that change the program on its way to a target.
fn acting(expectation: &Expectation, source: &Control, target: &Control) -> BTreeSet<String> {
    let mut module = Module::default();
    for (at, input) in inputs(expectation).iter().enumerate() {
        let entry = source.entry();
        let parsed = macroglot::syntax::parse_file(&input.bytes, entry.parse_items);
        let lowered = (entry.lower)(&parsed, at, &input.name, source);
        module.programs.extend(lowered.programs.into_iter().map(|(program, _)| program));
        module.names.extend(lowered.names);
    }
    let mut context = Context::new(source, target, module.programs.len());
    let mut acted = BTreeSet::new();
    for pass in legalization() {
        let before = module.clone();
        pass.apply(&mut module, &mut context);
        if module != before {
            acted.insert(pass.name.to_owned());
        }
    }
    acted
}

/// The expectation of a conversion: the same list, for the target's text.
fn of_target(
    expectation: &Expectation,
    converts: &Converts,
    made: &Conversion,
    folder: &Path,
) -> Expectation {
    // What only others call may be a part of their files.
    let write = |(at, text): (usize, &Option<String>)| {
        assert!(at > 0 || text.is_some(), "{}: not converted", expectation.run[at]);
        let path = folder.join(format!("{at}.nc"));
        std::fs::write(&path, text.as_ref()?).unwrap();
        Some(path.display().to_string())
    };
    // Where holes are written as moves nothing says that they are holes.
    let as_moves = converts.files.iter().any(|file| file.contains("hole_moves"));
    let kept = expectation.moves.lines().filter(|line| !(as_moves && line.starts_with("hole ")));
    let kept: String = kept.flat_map(|line| [line, "\n"]).collect();
    Expectation {
        c_axis: expectation.c_axis,
        control: converts.to.clone(),
        run: made.texts.iter().enumerate().filter_map(write).collect(),
        ends: expectation.ends.clone(),
        turns: expectation.turns,
        profile: format!("dialect = \"{}\"\n{}", converts.to, converts.profile),
        scenario: converts.scenario.clone().unwrap_or_else(|| expectation.scenario.clone()),
        moves: kept,
        converts: Vec::new(),
    }
}

/// The passes that run before variables have registers.
fn legalization() -> impl Iterator<Item = &'static Pass> {
    let passes = pipeline::passes().take_while(|(group, _)| group.name != "tidy-legal");
    passes.filter(|(group, _)| group.name != "tidy").map(|(_, pass)| pass)
}

/// The passes of `calls/chain.rs` or `expressions/functions/modulo.rs`; none of a file that runs with others.
fn passes_of(file: &str) -> Vec<&'static str> {
    let parts: Vec<String> =
        file.split('/').skip(1).map(|part| part.trim_end_matches(".rs").replace('_', "-")).collect();
    let named =
        |name: &&str| parts.iter().any(|part| part == name || (part == "chain" && *name == "return-to"));
    legalization().map(|pass| pass.name).filter(named).collect()
}

#[test]
fn conversions_move_as_the_geometry_of_the_source_says() {
    let mut wrong = Vec::new();
    let mut count = 0;
    for (path, expectation) in expectations() {
        for converts in &expectation.converts {
            count += 1;
            let name = format!("{} to {}", path.display(), converts.to);
            let source = control(&expectation.control, &expectation.profile);
            let target =
                control(&converts.to, &format!("dialect = \"{}\"\n{}", converts.to, converts.profile));
            let made = conversion(&expectation, &source, &target);
            if let Some(refused) = made.programs.iter().find(|program| program.outcome == Outcome::Refused) {
                let why = refused.diagnostics.iter().map(|found| found.message.to_string());
                wrong.push(format!("{name}: refused: {:?}", why.collect::<Vec<_>>()));
                continue;
            }
            let folder = tempfile::tempdir().unwrap();
            let there = of_target(&expectation, converts, &made, folder.path());
            let (found, end) = moves(&there);
            if let Some(difference) = difference(&found, &there.list()) {
                wrong.push(format!(
                    "{name}: {difference}\n{}",
                    made.texts.iter().flatten().cloned().collect::<String>()
                ));
            }
            if end != expectation.ends {
                wrong.push(format!("{name}: ends by {end}"));
            }
            let acted = acting(&expectation, &source, &target);
            let idle = converts.files.iter().filter(|file| {
                let passes = passes_of(file);
                !passes.is_empty() && !passes.iter().any(|pass| acted.contains(*pass))
            });
            wrong.extend(idle.map(|file| format!("{name}: {file} has nothing to do, but {acted:?}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count >= 20, "{count}");
}
/// The files of a folder, by their paths from it.
fn files_of(folder: &Path, from: &Path, all: &mut BTreeSet<String>) {
    for path in super::files(folder) {
        if path.is_dir() {
            files_of(&path, from, all);
        } else {
            all.insert(path.strip_prefix(from).unwrap().display().to_string());
        }
    }
}

/// A file of legalization that no list of moves is for needs a reason.
#[test]
fn every_pass_has_a_list_or_a_reason() {
    let (mut files, folder) = (BTreeSet::new(), root().join("src/legalize"));
    files_of(&folder, &folder, &mut files);
    let text = std::fs::read_to_string(root().join("tests/motions/passes.toml")).unwrap();
    let reasons: BTreeMap<String, String> = toml::from_str(&text).unwrap();
    let listed: BTreeSet<String> = expectations()
        .into_iter()
        .flat_map(|(_, expectation)| expectation.converts)
        .flat_map(|converts| converts.files)
        .collect();
    let known: BTreeSet<String> = listed.iter().chain(reasons.keys()).cloned().collect();
    assert_eq!(
        files.difference(&known).collect::<Vec<_>>(),
        Vec::<&String>::new(),
        "no list of moves and no reason"
    );
    assert_eq!(known.difference(&files).collect::<Vec<_>>(), Vec::<&String>::new(), "no such file");
    let both: Vec<&String> = reasons.keys().filter(|file| listed.contains(*file)).collect();
    assert!(both.is_empty(), "a list and a reason: {both:?}");
}

/// Numbers that a control rounds to its least increment lie about so far from those of the list, millimetres: an inch
/// control puts each of eight incremental moves a half of .00254 off at the most.
const ROUNDED: f64 = 0.011;

/// What the rounding of ends does to the centre of an arc by its radius, and to its angle.
const ROUNDED_ARC: f64 = 0.02;

/// The same of ends that are written in thousandths of a millimetre, and of an arc of 1.5 between two of them, degrees too.
const WRITTEN: f64 = 0.001;
const WRITTEN_ARC: f64 = 0.03;

/// Every program of every list that has a conversion makes the same moves there, but for the rounding of words.
#[test]
fn every_conversion_moves_as_its_source() {
    let all = expectations();
    let ways = all.par_iter().flat_map_iter(|(path, expectation)| {
        // A lathe's program has no machine to run on at the other control.
        let is_lathe = expectation.profile.contains("lathe");
        let others = ["fanuc", "haas"].into_iter().filter(move |to| !is_lathe && *to != expectation.control);
        others.map(move |to| (path, expectation, to))
    });
    let moved: Vec<Option<String>> = ways
        .filter_map(|(path, expectation, to)| {
            let difference = moves_otherwise(expectation, to)?;
            Some(difference.map(|difference| format!("{} to {to}: {difference}", path.display())))
        })
        .collect();
    let wrong: Vec<&str> = moved.iter().flatten().map(String::as_str).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    eprintln!("conversions that move alike: {}", moved.len());
    assert!(moved.len() >= 90, "{}", moved.len());
}

/// What a program's conversion moves otherwise, if anything; none if it has no conversion.
fn moves_otherwise(expectation: &Expectation, to: &str) -> Option<Option<String>> {
    let units = if expectation.profile.contains("inch") { "inch" } else { "metric" };
    let profile = format!("units = \"{units}\"");
    let source = control(&expectation.control, &expectation.profile);
    let target = control(to, &format!("dialect = \"{to}\"\n{profile}"));
    let made = conversion(expectation, &source, &target);
    if made.programs.iter().any(|program| program.outcome == Outcome::Refused) {
        return None;
    }
    let converts = Converts { to: to.into(), files: Vec::new(), profile, scenario: None };
    let folder = tempfile::tempdir().unwrap();
    let there = of_target(expectation, &converts, &made, folder.path());
    let (mut found, _) = moves(&there);
    let alike = |a: &Move, b: &Move| a.is_within(b, if a.kind == "arc" { ROUNDED_ARC } else { ROUNDED });
    // A wait that a person is told is left out.
    let told = || made.programs.iter().flat_map(|program| &program.diagnostics).map(|told| &*told.message);
    let mut list = there.list();
    list.retain(|one| {
        let wait = format!("the wait of {} s at the bottom", one.numbers.first().unwrap_or(&0.0));
        one.kind != "dwell" || !told().any(|told| told.starts_with(&wait))
    });
    // Whether the end of a program stops the spindle each control says for itself.
    let stops = |one: &mut Move| one.kind == "spindle" && one.mode == "stopped";
    if found.len() == list.len() + 1 {
        found.pop_if(stops);
    }
    Some(difference_by(&found, &list, alike))
}

/// Corners of lathes, and lines by their angle, that are written out go where the lists of their geometry say, but for the rounding of
/// words.
#[test]
fn corners_that_are_written_out_move_as_their_lists_say() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    let is_drawn =
        |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("dimensions-"));
    let lists = expectations_of("tests/motions/expected-live");
    for (path, expectation) in lists.into_iter().filter(|(path, _)| is_drawn(path)) {
        for to in ["fanuc", "haas"] {
            // How roughing ends is another thing on each of the two.
            let roughs =
                inputs(&expectation).iter().any(|input| input.bytes.windows(3).any(|word| word == b"G71"));
            if roughs && to != expectation.control {
                continue;
            }
            count += 1;
            let profile =
                "machine = \"lathe\"\nunits = \"metric\"\n[behaviours]\ncorners = \"moves\"\n".to_owned();
            let source = control(&expectation.control, &expectation.profile);
            let target = control(to, &format!("dialect = \"{to}\"\n{profile}"));
            let made = conversion(&expectation, &source, &target);
            let name = format!("{} to {to}", path.display());
            if let Some(refused) = made.programs.iter().find(|program| program.outcome == Outcome::Refused) {
                wrong.push(format!("{name}: {:?}", refused.diagnostics));
                continue;
            }
            let mut lines = made.texts.iter().flatten().flat_map(|text| text.lines());
            if lines.any(|line| !line.contains('(') && (line.contains(',') || line.contains(" A"))) {
                wrong.push(format!("{name}: a corner stays a word"));
            }
            let converts = Converts { to: to.into(), files: Vec::new(), profile, scenario: None };
            let folder = tempfile::tempdir().unwrap();
            let there = of_target(&expectation, &converts, &made, folder.path());
            let (found, end) = moves(&there);
            let alike =
                |a: &Move, b: &Move| a.is_within(b, if a.kind == "arc" { WRITTEN_ARC } else { WRITTEN });
            if let Some(difference) = difference_by(&found, &there.list(), alike) {
                wrong.push(format!("{name}: {difference}\n{:?}", made.texts));
            }
            assert_eq!(end, expectation.ends, "{name}");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(count >= 16, "{count}");
}
