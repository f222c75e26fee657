//! What a conversion is asked to do: by its arguments, and by the project file for what they leave out.

use super::common::{complain, control, controls, dialect_of, doubt, names, own_profile, read};
use crate::dialect::Control;
use crate::library::{Files, Input, Lock, Project, plan};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// One library to convert, and where to.
pub struct Job {
    /// Its programs.
    pub inputs: Vec<Input>,
    /// The control they are written for.
    pub source: Control,
    /// The control they go to.
    pub target: Control,
    /// Where the conversion of each program file goes; none for standard output.
    pub places: Option<Vec<PathBuf>>,
    /// The choices of earlier runs.
    pub lock: Lock,
    /// Where the choices are kept.
    pub lock_path: Option<PathBuf>,
    /// What was said of the programs as a whole.
    pub notes: Vec<String>,
}

/// What arguments say of the jobs.
pub struct Wish<'a> {
    /// Files and folders; the libraries of the project file where there are none.
    pub paths: &'a [PathBuf],
    /// Name of the source dialect.
    pub from: Option<&'a str>,
    /// Name of the target dialect.
    pub to: Option<&'a str>,
    /// Machine profiles.
    pub machines: &'a [PathBuf],
    /// The output folder.
    pub out: Option<&'a Path>,
}

/// The jobs, planned: every place is known, and no two files go to one.
pub fn jobs(wish: &Wish<'_>) -> Result<Vec<Job>, u8> {
    let jobs = if wish.paths.is_empty() { of_project(wish)? } else { vec![of_paths(wish)?] };
    let inputs = Files::of(jobs.iter().flat_map(|job| &job.inputs).map(|input| input.path.as_path()));
    let mut taken = BTreeSet::new();
    for place in jobs.iter().flat_map(|job| job.places.iter().flatten().chain(&job.lock_path)) {
        if !taken.insert(place) {
            let what = "several libraries would be written there; nothing was written";
            return Err(complain(format!("{}: {what}", place.display())));
        }
        if inputs.holds(place) {
            return Err(complain(format!("{} is an input and would be overwritten", place.display())));
        }
    }
    Ok(jobs)
}

fn of_paths(wish: &Wish<'_>) -> Result<Job, u8> {
    let inputs = read(wish.paths)?;
    let from = dialect_of(wish.from, &inputs)?;
    let Some(to) = wish.to else {
        return Err(complain(format!("say the control to convert for with --to: one of {}", names())));
    };
    let own = own_profile(wish.from, &inputs)?;
    let (source, target) = controls(&from, to, wish.machines, own.as_deref())?;
    planned(inputs, source, target, wish.out)
}

/// One job for each library and target of the project file.
fn of_project(wish: &Wish<'_>) -> Result<Vec<Job>, u8> {
    let Some(project) = Project::find(Path::new(".")).map_err(complain)? else {
        let what = "name the files or folders to convert (there is no macroglot.toml here or above)";
        return Err(complain(what));
    };
    if !wish.machines.is_empty() {
        return Err(complain(
            "the machines of a project are those of its macroglot.toml: leave --machine out",
        ));
    }
    let control_of = |name: &str| {
        let machine = &project.machines[name];
        control(&machine.dialect, machine.profile.as_ref().map(|p| project.root.join(p)).as_deref())
    };
    // With --out, the folders of the project file count from there.
    let root = wish.out.unwrap_or(&project.root);
    let wanted = |name: Option<&str>, control: &Control| name.is_none_or(|name| name == control.name());
    let mut jobs = Vec::new();
    for library in project.libraries.values() {
        for (machine, folder) in &library.targets {
            let (source, target) = (control_of(&library.machine)?, control_of(machine)?);
            if wanted(wish.from, &source) && wanted(wish.to, &target) {
                let inputs = read(&[short(&project.root.join(&library.path))])?;
                jobs.push(planned(inputs, source, target, Some(&short(&root.join(folder))))?);
            }
        }
    }
    if jobs.is_empty() {
        return Err(complain("macroglot.toml names no library with a target that fits"));
    }
    Ok(jobs)
}

fn planned(inputs: Vec<Input>, source: Control, target: Control, out: Option<&Path>) -> Result<Job, u8> {
    let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
    let places = match out {
        Some(folder) => Some(plan(folder, &names, &inputs).map_err(complain)?),
        None if inputs.len() > 1 => {
            return Err(complain("several programs need a folder to go to: give --out DIR"));
        }
        None => None,
    };
    // From a machine to itself nothing is chosen.
    let lock_path = out.map(|folder| folder.join(Lock::NAME)).filter(|_| !source.is_same_machine(&target));
    let lock = match &lock_path {
        Some(path) => Lock::load(path, source.name(), target.name()).map_err(complain)?,
        None => Lock::new(source.name(), target.name()),
    };
    let notes = doubt(source.name(), &inputs).into_iter().collect();
    Ok(Job { inputs, source, target, places, lock, lock_path, notes })
}

/// A path as it is seen from the current folder, where it lies under that.
fn short(path: &Path) -> PathBuf {
    let here = std::env::current_dir().and_then(std::fs::canonicalize).unwrap_or_default();
    match path.strip_prefix(&here) {
        Ok(rest) if !rest.as_os_str().is_empty() => rest.to_owned(),
        _ => path.to_owned(),
    }
}
