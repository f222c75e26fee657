//! What subcommands share: choosing controls, printing, complaining.

use super::UNUSABLE;
use super::streams::{complain, complain_lines, remark};
use crate::diag::Code;
use crate::dialect::{Control, Entry, Profile, registry};
use crate::library::{
    Detected, Files, Found, Input, InputError, LeftOut, Project, detect, gather, looks_like, of_library,
    settled,
};
use crate::verify::Effort;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Reads the programs under the paths; faults are said, and any of them is fatal.
pub fn read(paths: &[PathBuf]) -> Result<Vec<Input>, u8> {
    read_all(paths).map(|(inputs, _)| inputs)
}

/// Reads the programs under the paths, and says what was left out.
pub fn read_all(paths: &[PathBuf]) -> Result<(Vec<Input>, Vec<LeftOut>), u8> {
    read_found(gather(paths, &endings()))
}

/// What was read, and what was left out.
pub fn read_found(found: Found<Input>) -> Result<(Vec<Input>, Vec<LeftOut>), u8> {
    let Found { programs, mut left_out, errors } = found;
    left_out.extend(errors.iter().filter_map(InputError::left_out));
    Ok((fit(programs, &errors)?, left_out))
}

/// Endings of program files, by the tables of all dialects.
pub fn endings() -> Vec<String> {
    registry::all().iter().flat_map(Entry::endings).collect()
}

/// What was read of the programs, unless a fault among them is fatal.
pub fn fit<T>(read: Vec<T>, errors: &[InputError]) -> Result<Vec<T>, u8> {
    let harmless = |error: &InputError| error.left_out().is_some();
    for error in errors {
        complain(error);
    }
    // In a folder of good programs one that is no program is left out; alone it is all there was.
    if errors.is_empty() || (!read.is_empty() && errors.iter().all(harmless)) {
        Ok(read)
    } else {
        Err(UNUSABLE)
    }
}

/// The control of a dialect, with a machine profile where one is given for it.
pub fn control(name: &str, machine: Option<&Path>) -> Result<Control, u8> {
    let Some(entry) = registry::find(name) else {
        return Err(complain(format!("no dialect is named '{name}': use one of {}", names())));
    };
    let plain = || {
        let mut profile = Profile::default();
        profile.dialect = name.into();
        profile
    };
    let profile = match machine {
        Some(path) => profile(path)?.unwrap_or_else(plain),
        None => plain(),
    };
    if let Some(path) = machine.filter(|_| profile.dialect != name) {
        let (path, theirs) = (path.display(), &profile.dialect);
        let what = "name the profile of this machine, or the dialect of that one";
        return Err(complain(format!(
            "{path} is a profile for '{theirs}', and the machine is a {name}: {what}"
        )));
    }
    Control::new(entry, profile).map_err(|faults| {
        if faults.iter().any(|fault| fault.code == Code::DialectTable) {
            return complain_lines(entry.faults_as_text(&faults));
        }
        let path = machine.map_or_else(|| entry.file.into(), |path| path.display().to_string());
        let text = machine.and_then(|path| std::fs::read_to_string(path).ok()).unwrap_or_default();
        complain_lines(crate::dialect::faults_as_text(&path, &text, &faults))
    })
}

/// The controls of a source and a target, each with its machine profile where one is given; `own` is
/// the source's where none is.
pub fn controls(
    from: &str,
    to: &str,
    machines: &[PathBuf],
    own: Option<&Path>,
) -> Result<(Control, Control), u8> {
    let profiles: Vec<(&PathBuf, Profile)> = machines
        .iter()
        .map(|path| profile(path).map(|profile| (path, profile.unwrap_or_default())))
        .collect::<Result<_, _>>()?;
    if let Some((path, odd)) = profiles.iter().find(|(_, p)| p.dialect != from && p.dialect != to) {
        return Err(complain(of_neither(path, &odd.dialect)));
    }
    let of = |name: &str| -> Vec<&Path> {
        profiles.iter().filter(|(_, p)| p.dialect == name).map(|(path, _)| path.as_path()).collect()
    };
    let (sources, targets) = (of(from), of(to));
    // Of two machines with one control the first is the source.
    let second = targets.get(1).filter(|_| from == to);
    let target = second.or(targets.first()).copied();
    meeting(control(from, sources.first().copied().or(own))?, control(to, target)?)
}

/// What is wrong with a profile of a control that is neither the source's nor the target's.
pub fn of_neither(path: &Path, dialect: &str) -> String {
    format!(
        "{} is a profile for '{dialect}', which is neither the source nor the target: name the profile of one of the two machines, \
         or change --from or --to",
        path.display()
    )
}

/// A source and a target that know of each other what their profiles say of both.
pub fn meeting(source: Control, target: Control) -> Result<(Control, Control), u8> {
    Control::meeting(source, target).map_err(complain_lines)
}

/// Both machines of a conversion, with the kind of the library's programs where their profiles leave it open; why, if that is
/// a lathe because of its programs.
pub fn kinds(
    inputs: &[Input],
    (source, target): (Control, Control),
) -> Result<(Control, Control, Option<String>), u8> {
    let (source, target, taken) = settled(inputs, source, target).map_err(complain_lines)?;
    Ok((source, target, taken.map(|taken| taken.to_string())))
}

/// As [`kinds`], and says why.
pub fn kinds_told(inputs: &[Input], controls: (Control, Control)) -> Result<(Control, Control), u8> {
    let (source, target, taken) = kinds(inputs, controls)?;
    taken.iter().for_each(remark);
    Ok((source, target))
}

/// The control that programs are read by, with the kind of machine that they show where its profile leaves it open. Why is
/// said.
pub fn kind_told(inputs: &[Input], control: Control) -> Control {
    let (control, taken) = of_library(inputs, control);
    taken.iter().for_each(remark);
    control
}

/// A machine profile, with all that it extends.
pub fn profile(path: &Path) -> Result<Option<Profile>, u8> {
    Profile::load(path).map(Some).map_err(|why| complain_lines(why.lines()))
}

/// The files that profiles stand in, those that they extend included. One that cannot be read stands in its own.
pub fn profile_files<'p>(profiles: impl Iterator<Item = &'p PathBuf>) -> Vec<PathBuf> {
    let files = |path: &PathBuf| match Profile::load(path) {
        Ok(profile) => profile.files().cloned().collect(),
        Err(_) => vec![path.clone()],
    };
    profiles.flat_map(files).collect()
}

/// The names of all dialects.
pub fn names() -> String {
    registry::all().iter().map(|entry| entry.name).collect::<Vec<_>>().join(", ")
}

/// The dialect of the machine that the project file names for the library which holds all the
/// inputs, and that machine's profile.
pub fn project_machine(inputs: &[Input]) -> Result<Option<(String, Option<PathBuf>)>, u8> {
    let Some(project) = Project::find(Path::new(".")).map_err(complain)? else { return Ok(None) };
    let library = project.libraries_of(inputs.iter().map(|input| input.path.as_path())).next();
    let machine = library.and_then(|(_, library)| project.machines.get(&library.machine));
    Ok(machine.map(|machine| {
        (machine.dialect.clone(), machine.profile.as_ref().map(|profile| project.root.join(profile)))
    }))
}

/// The profile of the project's own machine, which speaks for its library where the arguments are silent.
pub fn own_profile(named: Option<&str>, inputs: &[Input]) -> Result<Option<PathBuf>, u8> {
    match named {
        Some(_) => Ok(None),
        None => Ok(project_machine(inputs)?.and_then(|(_, profile)| profile)),
    }
}

/// Says so where programs do not look like those of the control that they are said to be written for.
pub fn doubt(name: &str, inputs: &[Input]) -> Option<String> {
    let told = looks_like(inputs, name).map(|told| {
        format!(
            "the programs are read as {name}, but {told}. If that is what it is, name it with --from or --dialect"
        )
    });
    if let Some(told) = &told {
        remark(told);
    }
    told
}

/// The dialect that was named, or that of the source's machine among those given; else the one that the text shows.
/// `others` are the dialects of the other side: their machines are not the source's, but for the first of two of one dialect.
pub fn source_of(
    named: Option<&str>,
    others: &[&str],
    machines: &[PathBuf],
    inputs: &[Input],
) -> Result<String, u8> {
    if named.is_some() || machines.is_empty() {
        return dialect_besides(named, others, inputs);
    }
    let mut spoken = Vec::new();
    for path in machines {
        spoken.extend(profile(path)?.map(|profile| profile.dialect));
    }
    let twice = |name: &String| spoken.iter().filter(|other| *other == name).count() > 1;
    let own: BTreeSet<&String> =
        spoken.iter().filter(|name| !others.contains(&name.as_str()) || twice(name)).collect();
    match own.into_iter().collect::<Vec<_>>().as_slice() {
        [name] => Ok((*name).clone()),
        _ => dialect_besides(None, others, inputs),
    }
}

/// The control of a source alone, with the machine profile that was given for it.
pub fn source(named: Option<&str>, machine: Option<&PathBuf>, inputs: &[Input]) -> Result<Control, u8> {
    let name = source_of(named, &[], machine.map(std::slice::from_ref).unwrap_or_default(), inputs)?;
    if let Some(path) = machine
        && let Some(odd) = profile(path)?.filter(|profile| profile.dialect != name)
    {
        let (path, dialect) = (path.display(), odd.dialect);
        return Err(complain(format!(
            "{path} is a profile for '{dialect}', and the program is one for '{name}'"
        )));
    }
    let own = if machine.is_some() { None } else { own_profile(named, inputs)? };
    control(&name, machine.or(own.as_ref()).map(PathBuf::as_path))
}

/// The dialect that was named, or the one that the text shows.
pub fn dialect_of(named: Option<&str>, inputs: &[Input]) -> Result<String, u8> {
    dialect_besides(named, &[], inputs)
}

/// The same of a source: of two that read the text alike, the one that is not that of the other side.
fn dialect_besides(named: Option<&str>, others: &[&str], inputs: &[Input]) -> Result<String, u8> {
    if let Some(name) = named {
        return Ok(name.into());
    }
    if let Some((dialect, _)) = project_machine(inputs)? {
        return Ok(dialect);
    }
    match detect(inputs) {
        Detected::Mixed(most, file, like) => Err(complain(format!(
            "the files are for different controls: most look like {}, and {file} looks like {}. Name the \
             files of one control only, or name one control for all of them with --from or --dialect",
            most.name, like.name
        ))),
        Detected::Sure(entry) => Ok(entry.name.into()),
        Detected::Unsure(entries) => {
            let left: Vec<&str> =
                entries.iter().map(|entry| entry.name).filter(|name| !others.contains(name)).collect();
            if let ([name], true) = (left.as_slice(), entries.len() > 1) {
                let other = others.join(" and ");
                remark(format_args!(
                    "the programs are read as {name}; they may be {other} as well, which is the target. If they are, name it with --from"
                ));
                return Ok((*name).into());
            }
            let likely = entries.iter().map(|entry| entry.name).collect::<Vec<_>>().join(" or ");
            Err(complain(format!(
                "the control of the programs is not certain: it may be {likely}. Name it with --from or \
                 --dialect"
            )))
        }
    }
}

/// Runs something long; what it does and how long it has taken is shown where standard error is a terminal.
pub fn with_spinner<T>(what: String, work: impl FnOnce() -> T) -> T {
    let bar = shown(indicatif::ProgressBar::new_spinner(), "{spinner} {msg}, {elapsed}");
    bar.set_message(what);
    let done = work();
    bar.finish_and_clear();
    done
}

/// Runs something long that tells when so many of all are done: their count, their rate and the time left are shown too.
pub fn with_progress<T>(
    what: &'static str,
    all: usize,
    work: impl FnOnce(&(dyn Fn(usize) + Sync)) -> T,
) -> T {
    let bar = shown(
        indicatif::ProgressBar::new(all as u64),
        "{spinner} {msg} {pos} of {len} programs, {per_sec}, {eta} left",
    );
    bar.set_message(what);
    let done = work(&|count| bar.inc(count as u64));
    bar.finish_and_clear();
    done
}

/// A bar in this form that moves by itself; nothing where standard error is no terminal.
fn shown(bar: indicatif::ProgressBar, form: &str) -> indicatif::ProgressBar {
    use std::io::IsTerminal;
    if !std::io::stderr().is_terminal() {
        return indicatif::ProgressBar::hidden();
    }
    if let Ok(style) = indicatif::ProgressStyle::with_template(form) {
        bar.set_style(style);
    }
    bar.enable_steady_tick(std::time::Duration::from_millis(100));
    bar
}

/// How long verification may take.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct Time {
    /// Seconds of processor time for the verification of one program; what is not done then is undecided
    #[arg(long, value_name = "N", default_value_t = Effort::default().program_seconds)]
    program_seconds: f64,
    /// Seconds of processor time for the verification of all programs together
    #[arg(long, value_name = "N", default_value_t = Effort::default().library_seconds)]
    library_seconds: f64,
}

/// How much the verifier may do.
pub fn effort(time: &Time) -> Effort {
    let Time { program_seconds, library_seconds } = *time;
    Effort { program_seconds, library_seconds, ..Effort::default() }
}

/// Says so if a file that is to be written is one that is read.
pub fn not_over<'p>(path: &Path, read: impl Iterator<Item = &'p Path>) -> Result<(), u8> {
    match Files::of(read).holds(path) {
        true => Err(complain(format!("{} is an input and would be overwritten", path.display()))),
        false => Ok(()),
    }
}
