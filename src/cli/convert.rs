//! `macroglot convert PATH...`.

use super::jobs::{Job, Wish, jobs};
use super::{FOUND, WELL, common, outcome, reviews, streams};
use crate::legalize::Elsewhere;
use crate::library::{Certificates, Conversion, Options, Outcome, ProgramReport, convert, judge_telling};
use crate::opt::Level;
use crate::report::{self, Part};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files, folders, or - for standard input; without one, the project file's libraries
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// The control the programs are written for; recognized if it is left out
    #[arg(long, value_name = "D")]
    from: Option<String>,
    /// The control they are to run on
    #[arg(long, value_name = "D")]
    to: Option<String>,
    /// A machine profile of the source or the target (it names its dialect); may be given twice. Of two with one dialect the first is the
    /// source's
    #[arg(long, value_name = "FILE")]
    machine: Vec<PathBuf>,
    /// The folder that conversions are written to; a single program goes to standard output without it
    #[arg(long, short, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Files and folders with the programs that those call, or that call them: read with them, and not written
    #[arg(long, value_name = "PATH")]
    library: Vec<PathBuf>,
    /// Write refused programs too, with an alarm at every hole
    #[arg(long)]
    draft: bool,
    /// Run every conversion against its source on emulated controls, and write a certificate beside it (the default)
    #[arg(long, overrides_with = "no_verify")]
    verify: bool,
    /// Do not verify
    #[arg(long, overrides_with = "verify")]
    no_verify: bool,
    /// Remove the conversions of earlier runs whose sources are gone
    #[arg(long)]
    prune: bool,
    /// Replace read-only files too
    #[arg(long)]
    force: bool,
    /// How much to optimize: 0 nothing, 1 what conversion itself introduced, 2 more
    #[arg(short = 'O', value_name = "LEVEL", default_value_t = 1, value_parser = clap::value_parser!(u8).range(0..=2))]
    optimize: u8,
    /// Write a report; its ending says the format: .json .sarif .md .html .txt. May be given more than once
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,
    /// How to print the outcome
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Draw every finding at its place, and name every file of the folders that is left out
    #[arg(long)]
    verbose: bool,
    /// Print no findings, only what became of each program
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    time: common::Time,
}

#[derive(Clone, Copy, Debug, PartialEq, clap::ValueEnum)]
enum Format {
    Text,
    Json,
    Sarif,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

/// Converts a library. Of those that go to one machine of a project the later ones leave free what the earlier ones have there.
fn one(job: &Job, there: &mut BTreeMap<String, Elsewhere>, (prune, options): (bool, Options)) -> Conversion {
    let mut lock = job.lock(prune);
    let elsewhere = job.way.as_ref().map(|[_, machine]| there.entry(machine.clone()).or_default());
    lock.elsewhere = elsewhere.as_deref().cloned().unwrap_or_default();
    let conversion = convert(&job.inputs, &job.source, &job.target, lock, options);
    if let Some(elsewhere) = elsewhere {
        let names = conversion.programs.iter().filter_map(|program| program.name.as_deref());
        conversion.lock.held_there(names, elsewhere);
    }
    conversion
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    let (mut jobs, read) = jobs(&Wish {
        paths: &arguments.paths,
        from: arguments.from.as_deref(),
        to: arguments.to.as_deref(),
        machines: &arguments.machine,
        out: arguments.out.as_deref(),
        library: &arguments.library,
    })?;
    outcome::check_reports(&arguments.report, &jobs, &read)?;
    let level = level(arguments.optimize);
    let options = Options { level, draft: arguments.draft, marks: true };
    let files: usize = jobs.iter().map(|job| job.inputs.len()).sum();
    // On a thread of the pool, whose other work then takes up the memory that a pass gives back.
    let mut conversions: Vec<Conversion> = common::with_spinner(format!("converting {files} files"), || {
        rayon::scope(|_| {
            let mut there = BTreeMap::new();
            jobs.iter().map(|job| one(job, &mut there, (arguments.prune, options))).collect()
        })
    });
    for (job, conversion) in jobs.iter_mut().zip(&conversions) {
        if let Some(what) = job.refusal(conversion) {
            return Err(streams::complain(what));
        }
        for place in job.name_moved(conversion) {
            streams::remark(format!("{} is written again: a register moved", place.display()));
        }
    }
    let is_verified = arguments.verify || !arguments.no_verify;
    let certificates = match is_verified {
        true => verified(&arguments.time, &jobs, &mut conversions),
        false => Vec::new(),
    };
    reviews::apply(&jobs, &mut conversions, is_verified)?;
    jobs.iter().zip(&conversions).for_each(|(job, conversion)| outcome::tell_of_library(job, conversion));
    let (mut changes, mut folders) = (Vec::new(), Vec::new());
    for (at, (job, conversion)) in jobs.iter().zip(&conversions).enumerate() {
        let wanted = |out| outcome::wanted(job, out, conversion, certificates.get(at));
        let wanted = job.out.as_ref().map(wanted).unwrap_or_default();
        let (changed, told) = outcome::changed(job, wanted, conversion, arguments.prune)?;
        changes.push(changed);
        folders.push(told);
    }
    let targets: Vec<_> = jobs.iter().zip(&conversions).map(|(job, c)| outcome::targets(job, c)).collect();
    let parts: Vec<Part<'_>> = jobs
        .iter()
        .zip(&conversions)
        .zip(targets.iter().zip(&folders))
        .enumerate()
        .map(|(at, ((job, conversion), (targets, folder)))| Part {
            from: job.source.name(),
            to: job.target.name(),
            controls: [&job.source, &job.target],
            inputs: &job.inputs,
            named: &job.named,
            conversion,
            certificates: certificates.get(at),
            targets,
            notes: &job.notes,
            advice: job.target.dialect().advice.as_deref(),
            folder,
            left_out: &job.left_out,
            verbose: arguments.verbose,
        })
        .collect();
    let reports = outcome::reports(&arguments.report, &parts);
    outcome::publish_all(&jobs, changes, reports, arguments.force)?;
    match arguments.format {
        Format::Json => streams::print_by(|out| report::write_json(&parts, out))?,
        Format::Sarif => streams::print(&report::sarif(&parts))?,
        Format::Text => {
            if arguments.verbose && !arguments.quiet {
                parts.iter().for_each(outcome::draw);
            }
            outcome::summarize(&jobs, &parts, !arguments.quiet)?;
        }
    }
    let refused = report::Totals::of(&parts).refused > 0;
    Ok(if refused { FOUND } else { WELL })
}

/// How much is optimized.
pub(super) fn level(named: u8) -> Level {
    [Level::O0, Level::O1, Level::O2][usize::from(named.min(2))]
}

/// The certificates of every job's files; the outcomes then rest on them.
pub(super) fn verified(
    time: &common::Time,
    jobs: &[Job],
    conversions: &mut [Conversion],
) -> Vec<Certificates> {
    let open = |program: &&ProgramReport| program.outcome != Outcome::Refused;
    let all = conversions.iter().map(|conversion| conversion.programs.iter().filter(open).count()).sum();
    common::with_progress("verifying", all, |done| {
        let effort = common::effort(time);
        // All libraries at once: one long program would else leave the other cores idle at the end of each.
        let judged = jobs.par_iter().zip(conversions).map(|(job, conversion)| {
            match job.source.is_same_machine(&job.target) {
                // A program that stays on its machine is copied, byte for byte.
                true => Certificates::default(),
                false => judge_telling(
                    &job.inputs,
                    conversion,
                    (&job.source, &job.target),
                    (effort, &job.named),
                    done,
                ),
            }
        });
        judged.collect()
    })
}
