//! `macroglot verify SOURCE TARGET`.

use super::common::{
    Time, controls, dialect_of, effort, kinds_told, not_over, own_profile, profile_files, read, source_of,
};
use super::streams::{complain, print, remark};
use super::{FOUND, WELL, pager};
use crate::control::LoadedFile;
use crate::dialect::Control;
use crate::library::{Home, Input, Lock, Manifest, is_pending, write_file};
use crate::report;
use crate::syntax::{ParsedFile, parse_file};
use crate::verify::{Assumptions, Certificate, Effort, Job, Outcome, Side, Spent, SymbolMap, beside, verify};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The source: a file, or a folder of programs
    source: PathBuf,
    /// Its conversion: a file or a folder. The macroglot.lock of its output folder says which register is which
    target: PathBuf,
    /// The control the source is written for; recognized if it is left out
    #[arg(long, value_name = "D")]
    from: Option<String>,
    /// The control the target is written for; recognized if it is left out
    #[arg(long, value_name = "D")]
    to: Option<String>,
    /// A machine profile of the source or the target (it names its dialect); may be given twice. Of two with one dialect the first is the
    /// source's
    #[arg(long, value_name = "FILE")]
    machine: Vec<PathBuf>,
    /// Write the certificate to a file too
    #[arg(long, value_name = "FILE")]
    certificate: Option<PathBuf>,
    /// How to print what was found: text on a terminal, and JSON elsewhere, if it is left out
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// Replace a read-only certificate too
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    time: Time,
}

#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    let ours = read(std::slice::from_ref(&arguments.source))?;
    let theirs = read(std::slice::from_ref(&arguments.target))?;
    let theirs_named: Vec<&str> = theirs.iter().map(|input| input.name.as_str()).collect();
    let home = Home::of(folder_of(&arguments.target), &theirs_named).map_err(complain)?;
    let own_files = [Lock::NAME, Manifest::NAME].map(|name| home.folder.join(name));
    let programs = ours.iter().chain(&theirs).map(|input| &input.path);
    let profiles = profile_files(arguments.machine.iter());
    let read_files = programs.chain(&profiles).chain(&own_files).map(PathBuf::as_path);
    arguments.certificate.as_ref().map_or(Ok(()), |path| not_over(path, read_files))?;
    tell_changed(&home, &theirs)?;
    let to = dialect_of(arguments.to.as_deref(), &theirs)?;
    let from = source_of(arguments.from.as_deref(), &[&to], &arguments.machine, &ours)?;
    let own = own_profile(arguments.from.as_deref(), &ours)?;
    let (source, target) = kinds_told(&ours, controls(&from, &to, &arguments.machine, own.as_deref())?)?;
    let names = names(&home, &source, &target)?;
    let effort = effort(&arguments.time);
    let certificate = certify((&ours, &source), (&theirs, &target), &names, effort)?;
    let text = certificate.print();
    if let Some(path) = &arguments.certificate {
        write_file(path, text.as_bytes(), arguments.force).map_err(complain)?;
    }
    // Scripts rely on the certificate; a person at a terminal reads words.
    let usual = if pager::on_terminal() { Format::Text } else { Format::Json };
    match arguments.format.unwrap_or(usual) {
        Format::Text => print(&report::certificate(&certificate))?,
        Format::Json => print(&text)?,
    }
    Ok(if certificate.outcome == Outcome::Same { WELL } else { FOUND })
}

/// The folder that the target is, or lies in.
pub(super) fn folder_of(target: &Path) -> &Path {
    if target.is_dir() { target } else { target.parent().unwrap_or(Path::new("")) }
}

/// Says which files were changed since macroglot wrote them: the certificates beside them are of another text.
fn tell_changed(home: &Home, theirs: &[Input]) -> Result<(), u8> {
    if is_pending(&home.folder) {
        let what = "a run was interrupted while it wrote here: convert again, which restores the files first";
        return Err(complain(format!("{}: {what}", home.folder.display())));
    }
    let named: BTreeMap<String, &Input> =
        theirs.iter().map(|input| (home.name(&input.name), input)).collect();
    let texts = named.iter().map(|(name, input)| (name.as_str(), input.bytes.as_slice()));
    for name in home.manifest.changed(texts) {
        let what = "was changed since macroglot wrote it; its certificate is about the earlier text";
        remark(format!("{name}: {what}"));
    }
    let outdated = home.manifest.outdated_in(&home.folder);
    for (name, outdated) in outdated.into_iter().filter(|(name, _)| named.contains_key(name)) {
        let what = "a program that it calls, or that calls it, has changed since its certificate was made";
        remark(format!("{name}: {what}: {}", outdated.others.join(", ")));
    }
    Ok(())
}

/// What the lock of the target's output folder says.
pub(super) fn names(home: &Home, from: &Control, to: &Control) -> Result<SymbolMap, u8> {
    if from.is_same_machine(to) {
        return Ok(SymbolMap::default());
    }
    let lock = Lock::load(&home.folder.join(Lock::NAME), from.name(), to.name()).map_err(complain)?;
    Ok(SymbolMap {
        variables: lock.variables,
        scratch: lock.scratch.into_iter().collect(),
        of_words: lock.of_words.into_iter().collect(),
        arguments: lock.arguments,
        always: lock.always,
        programs: lock.programs,
    })
}

fn certify(
    (ours, source): (&[Input], &Control),
    (theirs, target): (&[Input], &Control),
    names: &SymbolMap,
    effort: Effort,
) -> Result<Certificate, u8> {
    let executor = |control: &Control| {
        let none = || complain(format!("there is no emulated control for '{}'", control.name()));
        control.entry().execute.ok_or_else(none)
    };
    let (run, run_there) = (executor(source)?, executor(target)?);
    let (ours_parsed, theirs_parsed) = (parsed(ours, source), parsed(theirs, target));
    let (ours, theirs) = (loaded(ours, &ours_parsed), loaded(theirs, &theirs_parsed));
    let (from, to) = (Side::new(source, run, &ours), Side::new(target, run_there, &theirs));
    let (from, to) = beside(from, to, names);
    let assumptions = Assumptions::new();
    let job = Job {
        source: &from,
        target: &to,
        names,
        assumptions: &assumptions,
        effort,
        spent: &Spent::default(),
    };
    Ok(verify(&job, &[]))
}

fn parsed<'a>(inputs: &'a [Input], control: &Control) -> Vec<ParsedFile<'a>> {
    inputs.iter().map(|input| parse_file(&input.bytes, control.entry().parse)).collect()
}

fn loaded<'a>(inputs: &'a [Input], parsed: &'a [ParsedFile<'a>]) -> Vec<LoadedFile<'a>> {
    inputs.iter().zip(parsed).map(|(input, parsed)| LoadedFile { name: &input.name, parsed }).collect()
}
