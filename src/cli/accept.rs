//! `macroglot accept [PATH...]`.

use super::jobs::{Job, Wish, jobs};
use super::streams::{complain, print};
use super::{FOUND, WELL, common, convert, reviews};
use crate::library::{
    Chosen, Conversion, Edit, Entry, Fit, Options, OutputError, Project, Signer, convert as converted,
    edited, edits, write_file,
};
use crate::report::{Accepting, Date, accepting};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files or folders whose questions are accepted; those of all libraries of the project file without one
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// Codes that are accepted, or beginnings of some
    #[arg(long, value_name = "CODE", value_delimiter = ',')]
    code: Vec<String>,
    /// Programs whose questions are accepted, by their names
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    program: Vec<String>,
    /// Libraries of the project file; all without one
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    library: Vec<String>,
    /// Machines of the project file that they are converted to; all without one
    #[arg(long, value_name = "MACHINE", value_delimiter = ',')]
    to: Vec<String>,
    /// Accept all that is asked
    #[arg(long)]
    all: bool,
    /// Who accepts it
    #[arg(long, value_name = "NAME", env = "MACROGLOT_WHO")]
    who: Option<String>,
    /// Why it is as it should
    #[arg(long, value_name = "TEXT")]
    why: Option<String>,
    /// How much to optimize, as `convert` is told it: what is asked may depend on it
    #[arg(short = 'O', value_name = "LEVEL", default_value_t = 1, value_parser = clap::value_parser!(u8).range(0..=2))]
    optimize: u8,
    /// Say what would be written, and write nothing
    #[arg(long)]
    dry_run: bool,
    #[command(flatten)]
    time: common::Time,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    let Some(project) = Project::find(Path::new(".")).map_err(complain)? else {
        return Err(complain("there is no macroglot.toml here or above: what is accepted is kept in it"));
    };
    let chosen = chosen(arguments, &project)?;
    let signer = signer(arguments)?;
    let wish = Wish { paths: &[], from: None, to: None, machines: &[], out: None, library: &[] };
    let (mut jobs, _) = jobs(&wish)?;
    jobs.retain(|job| {
        job.way.as_ref().is_some_and(|way| chosen.takes_way(way.each_ref().map(String::as_str)))
    });
    let files: usize = jobs.iter().map(|job| job.inputs.len()).sum();
    let options = Options { level: convert::level(arguments.optimize), draft: false, marks: true };
    let mut conversions: Vec<Conversion> = common::with_spinner(format!("converting {files} files"), || {
        let made = |job: &Job| converted(&job.inputs, &job.source, &job.target, job.lock(false), options);
        rayon::scope(|_| jobs.iter().map(made).collect())
    });
    convert::verified(&arguments.time, &jobs, &mut conversions);
    let asked = reviews::asked(&jobs, &conversions, &project.root, |_| true);
    let answered = reviews::answers(&asked, &project);
    let edits = edits(&asked, &answered, &project.accepted, (&chosen, &signer));
    let fits = answered.fits.iter().flatten();
    let open = fits.filter(|fit| !matches!(fit, Fit::Accepted(_))).count();
    let refused =
        asked.iter().map(|asked| asked.refused.iter().filter(|(file, _)| chosen.takes_file(file)).count());
    let told = Accepting {
        edits: &edits,
        entries: &project.accepted,
        open,
        refused: refused.sum(),
        is_tried: arguments.dry_run,
    };
    let told = accepting(&told);
    drop(asked);
    // The project file may lie in a folder that a library is written to.
    drop(jobs);
    if !arguments.dry_run && !edits.is_empty() {
        write(&project, &edits)?;
    }
    print(&told)?;
    Ok(if edits.is_empty() && !arguments.all && open > 0 { FOUND } else { WELL })
}

/// What is accepted, unless it is not said.
fn chosen(arguments: &Arguments, project: &Project) -> Result<Chosen, u8> {
    let Arguments { paths, code, program, library, to, all, .. } = arguments;
    if paths.is_empty() && code.is_empty() && program.is_empty() && !all {
        return Err(complain(
            "say what is accepted: files, --code, --program, or --all. `macroglot convert` lists what is asked",
        ));
    }
    let mut files = Vec::new();
    for path in paths {
        let missing = |_| complain(format!("{}: there is no such file or folder", path.display()));
        // A link is known by its own place, and by the one that it leads to.
        files.push(project.place_of(&std::fs::canonicalize(path).map_err(missing)?));
        files.push(project.place_of(path));
    }
    for name in library {
        if !project.libraries.contains_key(name) {
            return Err(complain(format!("--library {name}: macroglot.toml has no such library")));
        }
    }
    for name in to {
        if !project.libraries.values().any(|library| library.targets.contains_key(name)) {
            return Err(complain(format!(
                "--to {name}: no library of macroglot.toml is converted to this machine"
            )));
        }
    }
    let chosen = Chosen {
        libraries: library.clone(),
        targets: to.clone(),
        files,
        programs: program.clone(),
        codes: code.clone(),
    };
    match chosen.fault() {
        Some(fault) => Err(complain(fault)),
        None => Ok(chosen),
    }
}

fn signer(arguments: &Arguments) -> Result<Signer<'_>, u8> {
    let said =
        |text: &'_ Option<String>| text.as_deref().map(str::trim).filter(|text| !text.is_empty()).is_some();
    let who = arguments.who.as_deref().map(str::trim).unwrap_or_default();
    if !said(&arguments.who) && !arguments.dry_run {
        return Err(complain("say who accepts it: --who NAME, or MACROGLOT_WHO in the environment"));
    }
    let when =
        Date::today().day().parse().map_err(|_| complain("the day of today is none that a file can have"))?;
    Ok(Signer { who, when, why: arguments.why.as_deref().map(str::trim).filter(|_| said(&arguments.why)) })
}

/// Writes the changes into the project file.
fn write(project: &Project, edits: &[Edit]) -> Result<(), u8> {
    let path = project.root.join(Project::NAME);
    // A link to it stays one.
    let path = std::fs::canonicalize(&path).unwrap_or(path);
    let fault = |why: String| complain(format!("{}: {why}", path.display()));
    let text = std::fs::read_to_string(&path).map_err(|error| fault(error.to_string()))?;
    let entries: &[Entry] = &project.accepted;
    let text = edited(&text, entries, edits).map_err(fault)?;
    write_file(&path, text.as_bytes(), false).map_err(|error| match error {
        OutputError::ReadOnly(_) => fault("is read-only; nothing was written".into()),
        error => complain(error),
    })
}
