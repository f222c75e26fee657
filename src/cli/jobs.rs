//! What a conversion is asked to do: by its arguments, and by the project file for what they leave out.

use super::common::{
    control, controls, doubt, endings, kinds, meeting, names, own_profile, profile_files, read, read_all,
    read_found, source_of,
};
use super::reviews::way_of;
use super::streams::{complain, remark};
use crate::dialect::Control;
use crate::library::{
    Conversion, Files, Folder, Held, Input, LeftOut, Lock, Manifest, Project, Recovered, Spots,
    another_library, certificate_of, plan, real_place, same_file, slashed, withheld_of, without_builders,
};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// One library to convert, and where to.
pub struct Job {
    /// Its programs.
    pub inputs: Vec<Input>,
    /// By program file: true if it is to be written. The others are its library.
    pub named: Vec<bool>,
    /// What was left out of the folders that were named.
    pub left_out: Vec<LeftOut>,
    /// The control they are written for.
    pub source: Control,
    /// The control they go to.
    pub target: Control,
    /// Where the conversions go; none for standard output.
    pub out: Option<Out>,
    /// The choices of earlier runs.
    pub lock: Lock,
    /// What was said of the programs as a whole.
    pub notes: Vec<String>,
    /// Why the library is taken to be a lathe's, where no profile says it.
    taken: Option<String>,
    /// The library and the machine, by their names in the project file; none if it is not of one.
    pub way: Option<[String; 2]>,
    /// True if all of that library is here, as the project file has it.
    pub is_whole: bool,
}

impl Job {
    /// The choices of earlier runs that this one keeps to: those for what it prunes count no more, nor those for files
    /// that have no conversion in the folder any more.
    pub fn lock(&self, prune: bool) -> Lock {
        let mut lock = self.lock.clone();
        let Some(out) = self.out.as_ref() else { return lock };
        let names: BTreeSet<&str> = out.names.iter().map(String::as_str).collect();
        let (folder, manifest) = (out.held.folder(), &out.manifest);
        let gone = manifest.gone(folder, |source| names.contains(source));
        let converted = manifest.converted();
        let stays = |file: &String| {
            let is_here = converted.contains(file.as_str()) || folder.join(file).exists();
            names.contains(file.as_str()) || (is_here && !(prune && gone.contains_key(file.as_str())))
        };
        // A lock that names no file is an older one; one that names nothing that was converted here may be of another folder.
        let is_of_folder = lock.files.iter().any(|file| converted.contains(file.as_str()));
        if is_of_folder && lock.files.iter().any(stays) {
            lock.files.retain(stays);
        }
        lock
    }

    /// The programs of the library that were not named, and whose conversions in the folder are others since a register moved
    /// in this run: they are named from now on, and their places are given.
    pub fn name_moved(&mut self, conversion: &Conversion) -> Vec<PathBuf> {
        let Some(out) = self.out.as_ref().filter(|_| self.lock.moves_to(&conversion.lock)) else {
            return Vec::new();
        };
        let converted = out.manifest.converted();
        let mut moved = Vec::new();
        let texts = conversion.texts.iter().zip(&out.names);
        for ((input, named), (text, name)) in self.inputs.iter().zip(&mut self.named).zip(texts) {
            let place = out.held.folder().join(name);
            let stands = || std::fs::read(&place).ok();
            if !*named
                && converted.contains(input.name.as_str())
                && stands() != text.clone().map(String::into_bytes)
            {
                *named = true;
                moved.push(place);
            }
        }
        moved
    }

    /// What to tell if the lock of the folder is of another library, and stands in the way of this one.
    pub fn refusal(&self, conversion: &Conversion) -> Option<String> {
        let out = self.out.as_ref()?;
        let folder = out.held.folder();
        let is_ours = |input: &Input| out.manifest.comes_from(folder, &input.name, &input.path);
        let what = another_library(&self.lock, &self.inputs, is_ours, conversion)?;
        Some(format!("{}: {what}", folder.join(Lock::NAME).display()))
    }
}

/// The folder that a library's conversions go to. No other run writes there before this one has ended.
pub struct Out {
    /// The folder.
    pub held: Held,
    /// Where the conversion of each program file goes, from the folder, with `/` between parts.
    pub names: Vec<String>,
    /// True if the choices of this run are kept for the next one.
    pub keeps_lock: bool,
    /// What earlier runs wrote there.
    pub manifest: Manifest,
}

impl Out {
    /// Every place that a run may write to there.
    pub fn places(&self) -> impl Iterator<Item = PathBuf> + '_ {
        let own = [Lock::NAME, Manifest::NAME].map(str::to_owned).into_iter();
        let all = self.names.iter().flat_map(|name| [name.clone(), certificate_of(name), withheld_of(name)]);
        own.chain(all).map(|name| self.held.folder().join(name))
    }
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
    /// Files and folders with the programs that those call, or that call them.
    pub library: &'a [PathBuf],
}

/// The jobs, planned: every place is known, and no two files go to one. With them come all files that the command
/// reads: none of them is ever written to.
pub fn jobs(wish: &Wish<'_>) -> Result<(Vec<Job>, Files), u8> {
    let mut read: Vec<PathBuf> = profile_files(wish.machines.iter());
    if wish.paths.is_empty() && !wish.library.is_empty() {
        return Err(complain("--library goes with files that are named: name the programs to convert"));
    }
    let jobs =
        if wish.paths.is_empty() { of_project(wish, &mut read)? } else { vec![of_paths(wish, &mut read)?] };
    let programs = jobs.iter().flat_map(|job| &job.inputs).map(|input| input.path.as_path());
    let files = Files::of(read.iter().map(PathBuf::as_path).chain(programs));
    for place in jobs.iter().filter_map(|job| job.out.as_ref()).flat_map(Out::places) {
        if files.holds(&place) {
            return Err(complain(format!("{} is an input and would be overwritten", place.display())));
        }
    }
    apart(&jobs)?;
    // It is one library, wherever it goes.
    jobs.iter().filter_map(|job| job.taken.as_ref()).collect::<BTreeSet<_>>().into_iter().for_each(remark);
    Ok((jobs, files))
}

/// Says so where two libraries would be written to one place: the folder of one may lie in that of another.
fn apart(jobs: &[Job]) -> Result<(), u8> {
    let (mut spots, mut taken) = (Spots::default(), BTreeSet::new());
    for place in jobs.iter().filter_map(|job| job.out.as_ref()).flat_map(Out::places) {
        if !taken.insert(spots.of(&place)) {
            let what = "two libraries would be written there; nothing was written. Give each a folder of \
                        its own";
            return Err(complain(format!("{}: {what}", place.display())));
        }
    }
    Ok(())
}

fn of_paths(wish: &Wish<'_>, read_too: &mut Vec<PathBuf>) -> Result<Job, u8> {
    let (inputs, left_out) = read_all(wish.paths)?;
    let (inputs, named) = with_library(inputs, wish.library)?;
    let from = source_of(wish.from, wish.to.as_slice(), wish.machines, &inputs)?;
    let Some(to) = wish.to else {
        return Err(complain(format!("name the control to convert for with --to: one of {}", names())));
    };
    let own = own_profile(wish.from, &inputs)?;
    let (source, target) = controls(&from, to, wish.machines, own.as_deref())?;
    read_too.extend(profile_files(own.iter()));
    let way = way_of(&inputs, &source, &target);
    let job = planned(
        (inputs, named, left_out),
        source,
        target,
        wish.out.map(|folder| hold(folder).map(|held| (folder, held))).transpose()?,
    )?;
    Ok(Job { way, ..job })
}

/// The programs with the rest of their library, and which of them were named. A file that stands in the library has its name
/// there: its conversion goes where it would go with the whole.
fn with_library(inputs: Vec<Input>, library: &[PathBuf]) -> Result<(Vec<Input>, Vec<bool>), u8> {
    if library.is_empty() {
        let named = vec![true; inputs.len()];
        return Ok((inputs, named));
    }
    let ours = Files::of(inputs.iter().map(|input| input.path.as_path()));
    let mut all: BTreeMap<String, (Input, bool)> = BTreeMap::new();
    let (mut missing, mut read) = (inputs, read(library)?);
    for input in read.drain(..) {
        let is_named = ours.holds(&input.path);
        // The path by which it was named is the one that people know.
        let own = missing.iter().position(|own| is_named && same_file(&own.path, &input.path));
        let path = own.map(|at| missing.remove(at).path);
        let input = Input { path: path.unwrap_or(input.path), ..input };
        all.insert(input.name.clone(), (input, is_named));
    }
    for input in missing {
        if let Some((other, _)) = all.get(&input.name) {
            let (a, b) = (input.path.display(), other.path.display());
            return Err(complain(format!("{a} and {b} would both be written to {}", input.name)));
        }
        all.insert(input.name.clone(), (input, true));
    }
    Ok(all.into_values().unzip())
}

/// A library of the project file, and one of the machines that it goes to.
struct Way<'p> {
    programs: Folder,
    source: Control,
    target: Control,
    folder: PathBuf,
    name: &'p str,
    machine: &'p str,
}

/// One job for each library and target of the project file.
fn of_project(wish: &Wish<'_>, read_too: &mut Vec<PathBuf>) -> Result<Vec<Job>, u8> {
    let Some(project) = Project::find(Path::new(".")).map_err(complain)? else {
        let what = "name the files or folders to convert (there is no macroglot.toml here or above)";
        return Err(complain(what));
    };
    if !wish.machines.is_empty() {
        return Err(complain("a project takes its machines from macroglot.toml: leave --machine out"));
    }
    read_too.push(project.root.join(Project::NAME));
    let profiles = project.machines.values().filter_map(|machine| machine.profile.as_ref());
    let profiles: Vec<PathBuf> = profiles.map(|profile| project.root.join(profile)).collect();
    read_too.extend(profile_files(profiles.iter()));
    let control_of = |name: &str| {
        let machine = &project.machines[name];
        let profile = machine.profile.as_ref().map(|profile| short(&project.root.join(profile)));
        control(&machine.dialect, profile.as_deref())
    };
    // With --out, the folders of the project file count from there.
    let root = wish.out.unwrap_or(&project.root);
    let wanted = |name: Option<&str>, control: &Control| name.is_none_or(|name| name == control.name());
    let mut ways = Vec::new();
    for (name, library) in &project.libraries {
        if let Some(what) = project.missing(name) {
            return Err(complain(what));
        }
        for (machine, folder) in &library.targets {
            let (source, target) = meeting(control_of(&library.machine)?, control_of(machine)?)?;
            if wanted(wish.from, &source) && wanted(wish.to, &target) {
                let folder = short(&root.join(folder));
                for programs in library.folders(|path| short(&project.root.join(path)), &endings()) {
                    let (source, target) = (source.clone(), target.clone());
                    let folder = folder.join(&programs.name);
                    ways.push(Way { programs, source, target, folder, name, machine });
                }
            }
        }
    }
    if ways.is_empty() {
        return Err(complain("macroglot.toml has no library for this target"));
    }
    let mut held = hold_all(&ways)?;
    let planned = ways.into_iter().map(|way| {
        let out = held.remove(&way.folder).map(|held| (way.folder.as_path(), held));
        let (inputs, left_out) = read_found(way.programs.read(&way.source).0)?;
        let named = vec![true; inputs.len()];
        let names = Some([way.name.to_owned(), way.machine.to_owned()]);
        let job = planned((inputs, named, left_out), way.source, way.target, out)?;
        Ok(Job { way: names, is_whole: true, ..job })
    });
    planned.collect()
}

/// Takes the folders of all ways, in one order for every run: two runs that wait for each other would wait for ever.
fn hold_all(ways: &[Way<'_>]) -> Result<BTreeMap<PathBuf, Held>, u8> {
    let mut seen: BTreeMap<PathBuf, &Way<'_>> = BTreeMap::new();
    for way in ways {
        if let Some(other) = seen.insert(real_place(&way.folder), way) {
            let (folder, name) = (way.folder.display(), way.name);
            let what =
                format!("{folder}: libraries '{}' and '{name}' would both be written there", other.name);
            return Err(complain(format!("{what}; nothing was written. Give each a folder of its own")));
        }
    }
    seen.into_values().map(|way| Ok((way.folder.clone(), hold(&way.folder)?))).collect()
}

/// Takes an output folder for this run.
fn hold(folder: &Path) -> Result<Held, u8> {
    let wait = || remark(format!("another run is writing to {}; waiting for it to end", folder.display()));
    let (held, recovered) = Held::take(folder, wait).map_err(complain)?;
    let what = match recovered {
        Recovered::Nothing => return Ok(held),
        Recovered::Finished => {
            "an earlier run was interrupted while it wrote; its finished files are in place now"
        }
        Recovered::TakenBack => {
            "an earlier run was interrupted before it wrote anything; its temporary files are removed now"
        }
    };
    remark(format!("{}: {what}", folder.display()));
    Ok(held)
}

fn planned(
    (inputs, named, mut left_out): (Vec<Input>, Vec<bool>, Vec<LeftOut>),
    source: Control,
    target: Control,
    out: Option<(&Path, Held)>,
) -> Result<Job, u8> {
    let without = without_builders(inputs, &source);
    without.told.iter().for_each(remark);
    left_out.extend(without.left_out);
    let kept =
        without.inputs.into_iter().map(|(at, input)| (input, named.get(at).is_none_or(|named| *named)));
    let (inputs, named): (Vec<Input>, Vec<bool>) = kept.unzip();
    if inputs.is_empty() {
        return Err(complain("there is no other program to convert"));
    }
    let (source, target, taken) = kinds(&inputs, (source, target))?;
    let fresh = Lock::new(source.name(), target.name());
    let (out, lock) = match out {
        Some((folder, held)) => {
            let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
            let places = plan(folder, &names, &inputs).map_err(complain)?;
            let manifest = Manifest::load(folder).map_err(complain)?;
            // From a machine to itself nothing is chosen.
            let keeps_lock = !source.is_same_machine(&target);
            let lock = match keeps_lock {
                true => {
                    Lock::load(&folder.join(Lock::NAME), source.name(), target.name()).map_err(complain)?
                }
                false => fresh,
            };
            let names =
                places.iter().map(|place| slashed(place.strip_prefix(folder).unwrap_or(place))).collect();
            (Some(Out { held, names, keeps_lock, manifest }), lock)
        }
        None if named.iter().filter(|named| **named).count() > 1 => {
            return Err(complain("several programs need an output folder: give --out DIR"));
        }
        None => (None, fresh),
    };
    let notes = doubt(source.name(), &inputs).into_iter().chain(taken.clone()).collect();
    Ok(Job { inputs, named, left_out, source, target, out, lock, notes, taken, way: None, is_whole: false })
}

/// A path as it is seen from the current folder, where it lies under that.
pub(super) fn short(path: &Path) -> PathBuf {
    let here = std::env::current_dir().and_then(std::fs::canonicalize).unwrap_or_default();
    match path.strip_prefix(&here) {
        Ok(rest) if !rest.as_os_str().is_empty() => rest.to_owned(),
        _ => path.to_owned(),
    }
}
