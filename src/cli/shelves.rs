//! Which libraries a check is about, and which of their files: by its arguments, and by the project file.

use super::common::{control, endings, kind_told, own_profile, profile, profile_files, read_all, source_of};
use super::jobs::short;
use super::streams::{complain, remark};
use crate::check::{Output, Shelf};
use crate::dialect::{Control, registry};
use crate::library::{
    Answers, Checks, Folder, Input, Library, Lock, Manifest, Project, ProjectPlaces, of_target, profiles_of,
};
use std::path::{Path, PathBuf};

/// What arguments say of the libraries.
pub struct Asked<'a> {
    /// Files and folders.
    pub paths: &'a [PathBuf],
    /// Name of the dialect.
    pub dialect: Option<&'a str>,
    /// Machines or dialects to go to and come back from.
    pub against: &'a [String],
    /// Machine profiles.
    pub machines: &'a [PathBuf],
}

/// The libraries, and what the project file says of checks.
pub struct Shelves {
    /// The libraries that anything is looked at of.
    pub shelves: Vec<Shelf>,
    /// What the project file says of checks.
    pub checks: Checks,
    /// Where the project file says it.
    pub places: ProjectPlaces,
    /// The folder that files are seen from.
    pub root: PathBuf,
    /// The signed reports.
    pub signed: Vec<PathBuf>,
    /// Other files that are read.
    pub read: Vec<PathBuf>,
}

/// Finds them.
///
/// # Errors
/// The exit code; what is wrong was said.
pub fn shelves(asked: &Asked<'_>) -> Result<Shelves, u8> {
    // A dialect that is named, or standard input, is no project's.
    let by_hand =
        asked.dialect.is_some() || !asked.machines.is_empty() || asked.paths.contains(&PathBuf::from("-"));
    let project = if by_hand { None } else { Project::find(Path::new(".")).map_err(complain)? };
    match project {
        Some(project) => of_project(asked, &project),
        None if asked.paths.is_empty() => {
            Err(complain("name the files or folders to check (there is no macroglot.toml here or above)"))
        }
        None => of_paths(asked),
    }
}

fn of_paths(asked: &Asked<'_>) -> Result<Shelves, u8> {
    let (inputs, _) = read_all(asked.paths)?;
    let others: Vec<&str> = asked.against.iter().map(String::as_str).collect();
    let dialect = source_of(asked.dialect, &others, asked.machines, &inputs)?;
    let own = own_profile(asked.dialect, &inputs)?;
    let mut profiles = Vec::new();
    for path in asked.machines {
        profiles.push((path.as_path(), profile(path)?.unwrap_or_default().dialect));
    }
    let named = asked.against.iter().map(String::as_str).chain([dialect.as_str()]);
    let named: Vec<&str> = named.collect();
    if let Some((path, odd)) = profiles.iter().find(|(_, of)| !named.contains(&of.as_str())) {
        let what = "which is neither --dialect nor --against";
        return Err(complain(format!("{} is a profile for '{odd}', {what}", path.display())));
    }
    let machine = |name: &str| profiles.iter().find(|(_, of)| of == name).map(|(path, _)| *path);
    let home = kind_told(&inputs, control(&dialect, machine(&dialect).or(own.as_deref()))?);
    let away = |name: &String| Ok((name.clone(), of_target(&home, control(name, machine(name))?)));
    let away = asked.against.iter().map(away);
    let rounds = away.collect::<Result<Vec<_>, u8>>()?;
    let shelf = Shelf {
        wanted: vec![true; inputs.len()],
        whole: false,
        inputs,
        control: home,
        rounds,
        outputs: Vec::new(),
        answers: None,
    };
    Ok(Shelves {
        shelves: vec![shelf],
        checks: Checks::default(),
        places: ProjectPlaces::default(),
        root: std::env::current_dir().unwrap_or_default(),
        signed: Vec::new(),
        read: asked.machines.to_vec(),
    })
}

fn of_project(asked: &Asked<'_>, project: &Project) -> Result<Shelves, u8> {
    let wanted = asked.paths.iter().map(|path| {
        let missing = |_| complain(format!("{}: there is no such file or folder", path.display()));
        std::fs::canonicalize(path).map_err(missing)
    });
    let wanted: Vec<PathBuf> = wanted.collect::<Result<_, u8>>()?;
    let mut shelves = Vec::new();
    for (name, library) in &project.libraries {
        if let Some(what) = project.missing(name) {
            return Err(complain(what));
        }
        // A shared program is looked at with the first folder that has it.
        for (at, programs) in
            library.folders(|path| short(&project.root.join(path)), &endings()).into_iter().enumerate()
        {
            let targets =
                library.targets.iter().map(|(to, folder)| (to.clone(), folder.join(&programs.name)));
            let own = Library { targets: targets.collect(), ..library.clone() };
            shelves.extend(of_folder(asked, project, (name, &own), (programs, at == 0), &wanted)?);
        }
    }
    let none = asked.paths.is_empty() && shelves.is_empty();
    if none {
        return Err(complain("macroglot.toml names no library: there is nothing to check"));
    }
    Ok(Shelves {
        shelves,
        checks: project.checks.clone(),
        places: project.places.clone(),
        root: project.root.clone(),
        signed: project.checks.signed.iter().map(|report| short(&project.root.join(report))).collect(),
        read: vec![project.root.join(Project::NAME)],
    })
}

/// A folder of a library of the project; none if no path that was named lies in it, nor in what it is converted to.
fn of_folder(
    asked: &Asked<'_>,
    project: &Project,
    (name, library): (&str, &Library),
    (programs, is_first): (Folder, bool),
    wanted: &[PathBuf],
) -> Result<Option<Shelf>, u8> {
    let folder = project.root.join(&library.path);
    let real = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let outputs: Vec<PathBuf> =
        library.targets.values().map(|target| real(&project.root.join(target))).collect();
    let meets =
        |folder: &PathBuf| wanted.iter().any(|path| path.starts_with(folder) || folder.starts_with(path));
    let about_all = about_all(project, library, &outputs);
    let is_whole = |path: &PathBuf| real(&folder).starts_with(path) || about_all.contains(path);
    let whole = wanted.is_empty() || wanted.iter().any(is_whole);
    if !whole && !meets(&real(&folder)) && !outputs.iter().any(meets) {
        return Ok(None);
    }
    let control = machine(project, &library.machine)?;
    let (found, own) = programs.read(&control);
    // One that cannot be read is told of, and the others are checked.
    for error in found.errors.iter().filter(|error| error.left_out().is_none()) {
        remark(error);
    }
    if found.programs.is_empty() {
        return Ok(None);
    }
    let inputs = found.programs;
    let control = kind_told(&inputs, control);
    let is_wanted = |input: &Input| {
        let file = real(&input.path);
        // A conversion that is named stands for its source.
        let converted = outputs.iter().map(|output| output.join(&input.name));
        let of = |file: &PathBuf| wanted.iter().any(|path| file.starts_with(path));
        whole || of(&file) || converted.into_iter().any(|file| of(&file))
    };
    let looked_at = |(at, input): (usize, &Input)| (at < own || is_first) && is_wanted(input);
    let wanted: Vec<bool> = inputs.iter().enumerate().map(looked_at).collect();
    if !wanted.contains(&true) {
        return Ok(None);
    }
    let round_trip = if asked.against.is_empty() { &project.checks.round_trip } else { asked.against };
    let mut rounds = Vec::new();
    for name in round_trip {
        let Some((name, _)) = project.machine_of(name) else {
            let dialects = registry::all().iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ");
            return Err(complain(format!(
                "--against {name}: no machine of macroglot.toml has this name; a dialect is one of {dialects}"
            )));
        };
        let away = of_target(&control, machine(project, &name)?);
        if !away.is_same_machine(&control) {
            rounds.push((name, away));
        }
    }
    let mut targets = Vec::new();
    let outputs = library.targets.iter().map(|(name, folder)| {
        let target = of_target(&control, machine(project, name)?);
        let profiles = profiles_of(&control, &target);
        targets.push((name.clone(), target));
        Ok(Output { machine: name.clone(), folder: short(&project.root.join(folder)), profiles })
    });
    let outputs = outputs.collect::<Result<Vec<_>, u8>>()?;
    let (entries, root) = (project.accepted.clone(), project.root.clone());
    let answers = Answers { library: name.to_owned(), entries, targets, root };
    Ok(Some(Shelf { inputs, wanted, whole, control, rounds, outputs, answers: Some(answers) }))
}

/// The files that all programs of a library hang on: the project file, the profiles of its machines, and what macroglot
/// notes of its conversions.
fn about_all(project: &Project, library: &Library, outputs: &[PathBuf]) -> Vec<PathBuf> {
    let machines =
        [&library.machine].into_iter().chain(library.targets.keys()).chain(&project.checks.round_trip);
    let machines = machines.filter_map(|name| project.machine_of(name));
    let profiles: Vec<PathBuf> =
        machines.filter_map(|(_, machine)| Some(project.root.join(machine.profile?))).collect();
    let profiles = profile_files(profiles.iter()).into_iter();
    let notes = outputs.iter().flat_map(|output| [Lock::NAME, Manifest::NAME].map(|name| output.join(name)));
    let all = profiles.chain([project.root.join(Project::NAME)]).chain(notes);
    all.filter_map(|path| std::fs::canonicalize(path).ok()).collect()
}

/// The control of a machine of the project, or of a dialect.
fn machine(project: &Project, name: &str) -> Result<Control, u8> {
    let Some((_, machine)) = project.machine_of(name) else {
        return Err(complain(format!("no machine is named '{name}'")));
    };
    control(&machine.dialect, machine.profile.map(|profile| short(&project.root.join(profile))).as_deref())
}
