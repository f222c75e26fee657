//! `macroglot survey PATH...`.

use super::WELL;
use super::common::{self, control, controls, dialect_of, doubt, own_profile, read};
use super::streams::{self, complain, remark};
use crate::dialect::Side;
use crate::library::{Files, write_file};
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
    /// A machine profile of the source or the target (it names its dialect); may be given twice
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

fn work(arguments: &Arguments) -> Result<(), u8> {
    let inputs = read(&arguments.paths)?;
    let from = dialect_of(arguments.from.as_deref(), &inputs)?;
    let written =
        arguments.write.as_ref().map(|file| profiles(file, arguments.to.as_deref())).unwrap_or_default();
    let mut machines = arguments.machine.clone();
    // What an earlier survey wrote counts, once somebody has filled it in.
    let mut of: Vec<String> = Vec::new();
    for machine in &machines {
        of.push(common::profile(machine)?.unwrap_or_default().dialect);
    }
    let mut places: Vec<Option<PathBuf>> = Vec::new();
    for (path, dialect) in written.iter().zip([Some(from.as_str()), arguments.to.as_deref()]) {
        let given = of.iter().position(|of| Some(of.as_str()) == dialect);
        if let Some(at) = given {
            places.push(Some(arguments.machine[at].clone()));
            continue;
        }
        if path.exists() {
            machines.push(path.clone());
        }
        places.push(Some(path.clone()));
    }
    let own = own_profile(arguments.from.as_deref(), &inputs)?;
    let (source, target) = match arguments.to.as_deref() {
        Some(to) => {
            let (source, target) = controls(&from, to, &machines, own.as_deref())?;
            (source, Some(target))
        }
        None => (control(&from, machines.first().or(own.as_ref()).map(PathBuf::as_path))?, None),
    };
    doubt(source.name(), &inputs);
    let survey = common::with_spinner(format!("looking at {} files", inputs.len()), || {
        survey::survey(&inputs, &source, target.as_ref())
    });
    for (place, side) in places.iter().zip([Side::Source, Side::Target]) {
        let Some(place) = place else { continue };
        if Files::of(inputs.iter().map(|input| input.path.as_path())).holds(place) {
            return Err(complain(format!("{} is a program and would be overwritten", place.display())));
        }
        fill(&survey, side, place)?;
    }
    match arguments.format {
        Format::Text => streams::print(&survey::text(&survey)),
        Format::Json => streams::print(&survey::json(&survey)),
    }
}

/// The places of both profiles: the target's is beside the source's.
fn profiles(file: &Path, to: Option<&str>) -> Vec<PathBuf> {
    let mut all = vec![file.to_owned()];
    if let Some(to) = to {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        all.push(file.with_file_name(format!("{stem}-to-{to}.toml")));
    }
    all
}

/// Puts the questions into a profile.
fn fill(survey: &Survey<'_>, side: Side, place: &Path) -> Result<(), u8> {
    let old = match std::fs::read_to_string(place) {
        Ok(text) => Some(text),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
        Err(error) => return Err(complain(format!("{}: {error}", place.display()))),
    };
    let text = survey::filled(survey, side, old.as_deref())
        .map_err(|why| complain(format!("{}: {why}", place.display())))?;
    if old.as_deref() == Some(&*text) {
        return Ok(());
    }
    write_file(place, text.as_bytes(), false).map_err(complain)?;
    remark(format!("{}: the lines that begin with #? are to be filled in", place.display()));
    Ok(())
}
