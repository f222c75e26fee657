//! `macroglot check [PATH...]`.

use super::common::{Time, effort, not_over};
use super::shelves::{Asked, Shelves, shelves};
use super::streams::{complain, print};
use super::{FOUND, WELL, common};
use crate::check::{Allowed, Baseline, Cache, Checked, Part, Request, Selection, check};
use crate::library::{Checks, ProjectPlaces, write_file};
use crate::report;
use crate::verify::Effort;
use std::path::{Path, PathBuf};

/// Scenarios of a round trip that are compared even if nothing is left to be reached: a person waits, and a conversion is
/// verified with more.
const FEWEST: usize = 6;

/// Scenarios that are compared though they go no new way, because they have values that conditions name.
const TELLING: usize = 12;

/// Those of them in which the last digits are looked at closely.
const DRAWN: usize = 2;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files or folders that changed; all libraries of the project file without one
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// The control the programs are written for; the project file's, or recognized, if it is left out
    #[arg(long, short, value_name = "D")]
    dialect: Option<String>,
    /// A control, or a machine of the project file, that each program is to get to and come back from; may be given again
    #[arg(long, value_name = "D")]
    against: Vec<String>,
    /// A machine profile (it names its dialect); may be given again
    #[arg(long, value_name = "FILE")]
    machine: Vec<PathBuf>,
    /// What to look at, of read, lint, round and fresh; all of it if it is left out
    #[arg(long, value_name = "PART", value_enum, value_delimiter = ',')]
    only: Vec<Part>,
    /// Codes that count, or beginnings of some, in place of those that count by default; ALL for all
    #[arg(long, value_name = "CODE", value_delimiter = ',')]
    select: Vec<String>,
    /// Codes that count too
    #[arg(long, value_name = "CODE", value_delimiter = ',')]
    extend_select: Vec<String>,
    /// Codes that do not count
    #[arg(long, value_name = "CODE", value_delimiter = ',')]
    ignore: Vec<String>,
    /// Print how often each code was found, in place of the findings
    #[arg(long, conflicts_with = "format")]
    statistics: bool,
    /// Findings that were there before, as --write-baseline wrote them: only new ones count
    #[arg(long, value_name = "FILE")]
    baseline: Option<PathBuf>,
    /// Write what is found as a baseline for later checks
    #[arg(long, value_name = "FILE", conflicts_with = "baseline")]
    write_baseline: Option<PathBuf>,
    /// End with exit code 0 whatever is found
    #[arg(long)]
    exit_zero: bool,
    /// How to print what was found
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Neither read nor keep what earlier checks found
    #[arg(long)]
    no_cache: bool,
    /// Where to keep it; a folder of the user's caches if it is left out
    #[arg(long, value_name = "DIR", env = "MACROGLOT_CACHE")]
    cache: Option<PathBuf>,
    #[command(flatten)]
    time: Time,
}

#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum Format {
    Text,
    Json,
    Sarif,
    Github,
    Junit,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    let asked = Asked {
        paths: &arguments.paths,
        dialect: arguments.dialect.as_deref(),
        against: &arguments.against,
        machines: &arguments.machine,
    };
    let found = shelves(&asked)?;
    let selection = selection(arguments, &found.checks, &found.places)?;
    let allowed = allowed(&found)?;
    let baseline = match &arguments.baseline {
        Some(path) => Some(Baseline::load(path).map_err(complain)?),
        None => None,
    };
    if let Some(path) = &arguments.write_baseline {
        beside_inputs(path, &found)?;
    }
    let parts = if arguments.only.is_empty() { Part::ALL.to_vec() } else { arguments.only.clone() };
    let folder = arguments.cache.clone().or_else(Cache::of_user).filter(|_| !arguments.no_cache);
    let cache = Cache::new(folder);
    let all = found.shelves.iter().flat_map(|shelf| &shelf.wanted).filter(|wanted| **wanted).count();
    let mut checked = common::with_progress("checking", all, |done| {
        check(&Request {
            shelves: &found.shelves,
            root: &found.root,
            signed: &found.signed,
            parts: &parts,
            selection: &selection,
            allowed: &allowed,
            cache: &cache,
            effort: Effort { fewest: FEWEST, telling: TELLING, drawn: DRAWN, ..effort(&arguments.time) },
            done,
        })
    });
    if let Some(path) = &arguments.write_baseline {
        let text = Baseline::of(&checked.findings).print();
        write_file(path, text.as_bytes(), false).map_err(complain)?;
        checked.known = std::mem::take(&mut checked.findings).len();
    }
    if let Some(baseline) = &baseline {
        checked.known = baseline.take_known(&mut checked.findings);
    }
    print(&text(arguments, &checked))?;
    Ok(if checked.findings.is_empty() || arguments.exit_zero { WELL } else { FOUND })
}

fn text(arguments: &Arguments, checked: &Checked) -> String {
    if arguments.statistics {
        return report::check::statistics(checked);
    }
    match arguments.format {
        Format::Text => report::check::text(checked),
        Format::Json => report::check::json(checked),
        Format::Sarif => report::check::sarif(checked),
        Format::Github => report::check::github(checked),
        Format::Junit => report::check::junit(checked),
    }
}

/// The codes that count: the arguments' choice goes before that of the project file, what both leave out adds up.
fn selection(arguments: &Arguments, checks: &Checks, places: &ProjectPlaces) -> Result<Selection, u8> {
    let both = |ours: &[String], theirs: &[String]| [ours, theirs].concat();
    let select = if arguments.select.is_empty() { &checks.select } else { &arguments.select };
    let selection = Selection {
        select: select.clone(),
        extend: both(&arguments.extend_select, &checks.extend_select),
        ignore: both(&arguments.ignore, &checks.ignore),
    };
    match selection.unknown().first() {
        Some(text) => {
            let lists = [("select", &checks.select), ("extend_select", &checks.extend_select)];
            let mut lists = lists.into_iter().chain([("ignore", &checks.ignore)]);
            let place = lists.find_map(|(key, list)| {
                let at = list.iter().position(|one| one == text)?;
                Some(places.named(&["checks", key, &at.to_string()]) + ": ")
            });
            let place = place.unwrap_or_default();
            let what = "is no code and no beginning of one: `macroglot explain` lists them";
            Err(complain(format!("{place}'{text}' {what}")))
        }
        None => Ok(selection),
    }
}

/// What the project file allows.
fn allowed(found: &Shelves) -> Result<Vec<Allowed>, u8> {
    let allowed = found.checks.allow.iter().enumerate().map(|(at, allow)| {
        let place = found.places.named(&["checks", "allow", &at.to_string()]);
        let fault = |why: String| complain(format!("{place}: [[checks.allow]]: {why}"));
        Allowed::new(&allow.code, &allow.path, &allow.reason, &found.root).map_err(fault)
    });
    allowed.collect()
}

/// Says so if the baseline would be written over a file that is read.
fn beside_inputs(path: &Path, found: &Shelves) -> Result<(), u8> {
    let inputs = found.shelves.iter().flat_map(|shelf| &shelf.inputs).map(|input| input.path.as_path());
    not_over(path, inputs.chain(found.read.iter().map(PathBuf::as_path)))
}
