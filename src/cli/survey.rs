//! `macroglot survey PATH...`.

use super::WELL;
use super::common::{self, control, controls, doubt, own_profile, read_all, source_of};
use super::streams::{self, complain, complain_lines, remark};
use crate::dialect::{Machine, Side};
use crate::library::{Files, Input, WhyNot, of_library, settled, without_builders, write_file};
use crate::survey::{self, Survey};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files and folders of one library, or - for standard input
    #[arg(value_name = "PATH", required = true)]
    paths: Vec<PathBuf>,
    /// The control the programs are written for; recognized if it is left out
    #[arg(long, value_name = "D")]
    from: Option<String>,
    /// The control they are to run on; without it, only what their own control understands is told
    #[arg(long, value_name = "D")]
    to: Option<String>,
    /// A machine profile of the source or the target (it names its dialect); may be given twice. Of two with one dialect the first is the
    /// source's
    #[arg(long, value_name = "FILE")]
    machine: Vec<PathBuf>,
    /// Write what is asked into this profile of the source, as lines to fill in: answers that stand there are kept. The
    /// target's profile is FILE-to-D beside it, or the one that --machine names
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// How to print it
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(()) => WELL,
        Err(code) => code,
    }
}

/// Files that are named of those that are left out.
const MOST_NAMED: usize = 3;

fn work(arguments: &Arguments) -> Result<(), u8> {
    let (inputs, left_out) = read_all(&arguments.paths)?;
    let to = arguments.to.as_deref();
    let from = source_of(arguments.from.as_deref(), to.as_slice(), &arguments.machine, &inputs)?;
    let mut dialects: Vec<&str> = [from.as_str()].into_iter().chain(to).collect();
    // A library that stays on its control has one profile, where nobody names two.
    if arguments.machine.len() < 2 {
        dialects.dedup();
    }
    let (machines, places) = profiles(arguments, &dialects)?;
    let own = own_profile(arguments.from.as_deref(), &inputs)?;
    let mut is_open_lathe = [false; 2];
    let (source, target, taken) = match to {
        Some(to) => {
            let both = controls(&from, to, &machines, own.as_deref())?;
            let stated = [&both.0, &both.1].map(|control| control.profile().machine.is_some());
            let (source, target, taken) = settled(&inputs, both.0, both.1).map_err(complain_lines)?;
            let lathe = [&source, &target].map(|control| control.machine() == Machine::Lathe);
            is_open_lathe = [lathe[0] && !stated[0], lathe[1] && !stated[1]];
            (source, Some(target), taken)
        }
        None => {
            let source = control(&from, machines.first().or(own.as_ref()).map(PathBuf::as_path))?;
            let (source, taken) = of_library(&inputs, source);
            is_open_lathe[0] = taken.is_some();
            (source, None, taken)
        }
    };
    let without = without_builders(inputs, &source);
    without.told.iter().for_each(remark);
    let inputs: Vec<Input> = without.inputs.into_iter().map(|(_, input)| input).collect();
    let programs = Files::of(inputs.iter().map(|input| input.path.as_path()));
    if let Some(place) = places.iter().find(|place| programs.holds(place)) {
        return Err(complain(format!("{} is a program and would be overwritten", place.display())));
    }
    doubt(source.name(), &inputs);
    for left in left_out.iter().filter(|left| left.why == WhyNot::Program) {
        remark(format!(
            "left out {}: {}; name the file itself to read it",
            left.path.display(),
            left.why.words()
        ));
    }
    let unknown: Vec<String> = (left_out.iter().filter(|left| left.why == WhyNot::Unknown))
        .map(|left| left.path.display().to_string())
        .collect();
    if !unknown.is_empty() {
        let named = unknown.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
        let more = if unknown.len() > MOST_NAMED { ", ..." } else { "" };
        let (files, count) = (if unknown.len() == 1 { "file" } else { "files" }, unknown.len());
        remark(format!(
            "left out {count} {files} with an unknown ending: {named}{more}; name a file itself to read it"
        ));
    }
    let mut survey = common::with_spinner(format!("looking at {} files", inputs.len()), || {
        survey::survey(&inputs, &source, target.as_ref())
    });
    (survey.taken, survey.is_open_lathe) = (taken, is_open_lathe);
    let sides = places.iter().zip([Side::Source, Side::Target]);
    let filled = sides.map(|(place, side)| Ok((place, filled(&survey, side, place)?)));
    // Both are known before either is written.
    for (place, text) in filled.collect::<Result<Vec<_>, u8>>()? {
        let Some(text) = text else { continue };
        write_file(place, text.as_bytes(), false).map_err(complain)?;
        remark(format!("{}: the lines that begin with #? are to be filled in", place.display()));
    }
    match arguments.format {
        Format::Text => streams::print(&survey::text(&survey)),
        Format::Json => streams::print(&survey::json(&survey)),
    }
}

/// The profiles that count, and those that are written: of the source, and of the target if there is one.
fn profiles(arguments: &Arguments, dialects: &[&str]) -> Result<(Vec<PathBuf>, Vec<PathBuf>), u8> {
    let mut machines = arguments.machine.clone();
    let mut named: Vec<String> = Vec::new();
    for machine in &machines {
        let dialect = common::profile(machine)?.unwrap_or_default().dialect;
        if !dialects.contains(&dialect.as_str()) {
            return Err(complain(common::of_neither(machine, &dialect)));
        }
        named.push(dialect);
    }
    let Some(file) = &arguments.write else { return Ok((machines, Vec::new())) };
    let mut places = Vec::new();
    for (side, dialect) in dialects.iter().enumerate() {
        // The profile that was named gets the questions about its machine: of two with one dialect the second is the target's.
        let second = side == 1 && dialects[0] == *dialect;
        let mut of_dialect = (0..named.len()).filter(|at| named[*at] == *dialect);
        if let Some(at) = of_dialect.nth(usize::from(second)) {
            places.push(arguments.machine[at].clone());
            continue;
        }
        let path = if side == 0 { file.clone() } else { beside(file, dialect) };
        if path.exists() {
            let of = common::profile(&path)?.unwrap_or_default().dialect;
            if of != *dialect {
                let path = path.display();
                return Err(complain(format!(
                    "{path} is a profile for '{of}', and the questions are about '{dialect}': name another file with --write"
                )));
            }
            // What an earlier survey wrote counts, once somebody has filled it in.
            machines.push(path.clone());
        }
        places.push(path);
    }
    Ok((machines, places))
}

/// Where the target's profile stands: beside the source's.
fn beside(file: &Path, to: &str) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!("{stem}-to-{to}.toml"))
}

/// A profile with the questions; none if it has them.
fn filled(survey: &Survey<'_>, side: Side, place: &Path) -> Result<Option<String>, u8> {
    let old = match std::fs::read_to_string(place) {
        Ok(text) => Some(text),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        Err(error) => return Err(complain(format!("{}: {error}", place.display()))),
    };
    let text = survey::filled(survey, side, old.as_deref())
        .map_err(|why| complain(format!("{}: {why}", place.display())))?;
    Ok(Some(text).filter(|text| old.as_ref() != Some(text)))
}
