//! What conversions of a project ask, and what its file has for that.

use super::jobs::Job;
use super::streams::{complain, remark};
use crate::dialect::Control;
use crate::library::{
    Answered, Asked, Conversion, Entry, Fit, Input, Project, Scopes, answered, asks_any, questions,
};
use std::collections::BTreeSet;
use std::path::Path;

/// Entries that are named of those that match nothing.
const NAMED: usize = 3;

/// The library of the project file that holds all the programs, and its machine that they are converted to, if there is one.
pub fn way_of(inputs: &[Input], source: &Control, target: &Control) -> Option<[String; 2]> {
    // Who names it all needs no project file: what is wrong in one is no matter here.
    let project = Project::find(Path::new(".")).ok().flatten()?;
    let real = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let is_it = |name: &str, control: &Control| {
        project.machines.get(name).is_some_and(|machine| {
            let profile = machine.profile.as_ref().map(|profile| real(&project.root.join(profile)));
            machine.dialect == control.name() && profile == control.profile().file.as_deref().map(real)
        })
    };
    let libraries = project.libraries_of(inputs.iter().map(|input| input.path.as_path()));
    let ways = libraries.filter(|(_, library)| is_it(&library.machine, source));
    let mut ways = ways.flat_map(|(name, library)| library.targets.keys().map(move |target| (name, target)));
    let (library, machine) = ways.find(|(_, machine)| is_it(machine, target))?;
    Some([library.clone(), machine.clone()])
}

/// What each job asks. Of a job that `wants` says no to, nothing is.
pub fn asked<'j>(
    jobs: &'j [Job],
    conversions: &[Conversion],
    root: &Path,
    wants: impl Fn([&str; 2]) -> bool,
) -> Vec<Asked<'j>> {
    let of_job = |(job, conversion): (&'j Job, &Conversion)| {
        let way = job.way.as_ref().map_or([""; 2], |way| way.each_ref().map(String::as_str));
        let questions = match wants(way) && asks_any(conversion) {
            true => {
                let scopes = Scopes::of(&job.inputs, &job.source, &job.target);
                questions(&job.inputs, conversion, &scopes, root)
            }
            false => Vec::new(),
        };
        Asked { way, questions, refused: Asked::refused(&job.inputs, conversion, root) }
    };
    jobs.iter().zip(conversions).map(of_job).collect()
}

/// What the project file has for it.
pub fn answers(asked: &[Asked<'_>], project: &Project) -> Answered {
    let ways = project.libraries.iter().flat_map(|(name, library)| {
        library.targets.keys().map(move |target| [name.as_str(), target.as_str()])
    });
    answered(asked, &project.accepted, &ways.collect())
}

/// Writes into conversions what somebody accepted, and says which entries match nothing, if all was `verified`: what only
/// the verifier asks is not asked otherwise.
pub fn apply(jobs: &[Job], conversions: &mut [Conversion], verified: bool) -> Result<(), u8> {
    if jobs.iter().all(|job| job.way.is_none()) {
        return Ok(());
    }
    let found = Project::find(Path::new(".")).map_err(complain)?;
    let Some(project) = found.filter(|project| !project.accepted.is_empty()) else { return Ok(()) };
    let entries = &project.accepted;
    let about: BTreeSet<[&str; 2]> = entries.iter().map(|entry| [entry.library(), entry.target()]).collect();
    let asked = asked(jobs, conversions, &project.root, |way| about.contains(&way));
    let answered = answers(&asked, &project);
    let all = asked.iter().zip(&answered.fits).zip(conversions).zip(jobs);
    for (((asked, fits), conversion), job) in all {
        // What a part of a library calls may not be here: that is no change of it.
        let told = |fit: &Fit| if job.is_whole || matches!(fit, Fit::Accepted(_)) { *fit } else { Fit::Open };
        let fits: Vec<Fit> = fits.iter().map(told).collect();
        Fit::apply(&fits, &asked.questions, entries, conversion);
    }
    let gone: Vec<&Entry> = answered.unmatched.iter().filter_map(|at| entries.get(*at)).collect();
    if verified && !gone.is_empty() && jobs.iter().all(|job| job.is_whole) {
        let named: Vec<String> = gone.iter().take(NAMED).map(|entry| entry.about()).collect();
        let more = if gone.len() > NAMED { "; ..." } else { "" };
        let entries = if gone.len() == 1 { "entry matches" } else { "entries match" };
        remark(format!(
            "{}: {} [[accepted]] {entries} nothing that is asked ({}{more}); `macroglot accept --all` drops what is \
             not asked any more",
            Project::NAME,
            gone.len(),
            named.join("; ")
        ));
    }
    Ok(())
}
