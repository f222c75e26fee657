//! Finds the programs in a folder, and says of every other file why it is left out.

use super::outputs::SIDECARS;
use super::places::slashed;
use super::unread::{InputError, LeftOut, WhyNot};
use super::{Lock, Manifest, Project};
use crate::dialect::registry;
use ignore::WalkBuilder;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What a folder holds.
#[derive(Debug, Default)]
pub struct Walked {
    /// Its programs, and their names in it.
    pub programs: Vec<(PathBuf, String)>,
    /// Everything else.
    pub left_out: Vec<LeftOut>,
}

/// Endings that program files have, over and above those of the dialects' tables.
const ENDINGS: &[&str] = &[
    "nc", "cnc", "ngc", "tap", "eia", "iso", "prg", "pgm", "mpf", "spf", "min", "txt", "prog", "gcode", "g",
    "ncf", "fnc", "h",
];

/// The programs of a folder: files whose ending programs have, or that have none and a number. Ignore files are honoured;
/// those above the folder are not if they hide all of it, for it was named by hand.
///
/// # Errors
/// A folder that cannot be read, or has no program.
pub fn walk(folder: &Path, endings: &[String]) -> Result<Walked, InputError> {
    let mut walked = look(folder, endings, true)?;
    if walked.programs.is_empty() {
        walked = look(folder, endings, false)?;
    }
    if walked.programs.is_empty() {
        let endings = ENDINGS.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(" ");
        return Err(InputError::NoPrograms(folder.to_owned(), endings));
    }
    Ok(walked)
}

fn look(folder: &Path, endings: &[String], above: bool) -> Result<Walked, InputError> {
    let fault = |error| InputError::Unreadable(folder.to_owned(), io::Error::other(error));
    let mut walked = Walked::default();
    let mut seen = BTreeSet::new();
    let mut walk = WalkBuilder::new(folder);
    walk.require_git(false).parents(above).git_global(above).git_exclude(above);
    // What an earlier run wrote into a folder below is no source of the next one.
    walk.filter_entry(|entry| entry.depth() == 0 || !is_output(entry.path()));
    for entry in walk.sort_by_file_path(Path::cmp).build() {
        let entry = entry.map_err(fault)?;
        let path = entry.path();
        if let Some(kind) = entry.file_type().filter(|kind| !kind.is_dir()) {
            if kind.is_file() && is_program(path, endings) {
                let name = path.strip_prefix(folder).map(slashed).unwrap_or_default();
                walked.programs.push((path.to_owned(), name));
            } else if !is_own(path) {
                let why = if kind.is_symlink() { WhyNot::Link } else { WhyNot::Unknown };
                walked.left_out.push(LeftOut { path: path.to_owned(), why });
            }
        }
        seen.insert(entry.into_path());
    }
    // What a folder that was not entered holds is not counted.
    let entered = seen.clone();
    let mut all = WalkBuilder::new(folder);
    all.standard_filters(false).filter_entry(move |entry| {
        entry.depth() == 0 || entry.path().parent().is_some_and(|above| entered.contains(above))
    });
    for entry in all.sort_by_file_path(Path::cmp).build() {
        let path = entry.map_err(fault)?.into_path();
        if !seen.contains(&path) {
            let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
            let why = match is_hidden {
                true => WhyNot::Hidden,
                false if is_output(&path) => WhyNot::Written,
                false => WhyNot::Ignored,
            };
            walked.left_out.push(LeftOut { path, why });
        }
    }
    Ok(walked)
}

/// True for a folder in which macroglot keeps a list of what it wrote.
fn is_output(path: &Path) -> bool {
    path.join(Manifest::NAME).is_file()
}

/// What stands before the numbers of programs, on any control.
fn program_marks() -> &'static [&'static str] {
    static MARKS: OnceLock<Vec<&str>> = OnceLock::new();
    MARKS.get_or_init(|| {
        let dialects = registry::all().iter().filter_map(|entry| entry.dialect().ok());
        dialects.filter_map(|dialect| dialect.names.program.as_deref()).collect()
    })
}

fn is_program(path: &Path, endings: &[String]) -> bool {
    match path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()) {
        Some(ending) => ENDINGS.contains(&ending.as_str()) || endings.contains(&ending),
        // Controls write O1234 and the like; build files and licences have no ending either.
        None => path.file_name().is_some_and(|name| {
            let name = name.to_string_lossy().to_ascii_uppercase();
            let number = program_marks().iter().find_map(|mark| name.strip_prefix(mark)).unwrap_or(&name);
            number.bytes().all(|b| b.is_ascii_digit())
        }),
    }
}

/// True for what macroglot itself keeps in folders.
fn is_own(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    [Lock::NAME, Manifest::NAME, Project::NAME].contains(&&*name)
        || SIDECARS.iter().any(|end| name.ends_with(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_without_ending_are_programs_by_their_number() {
        for (name, program) in
            [("O1234", true), ("8010", true), ("README", false), ("a.NC", true), ("a.tsv", false)]
        {
            assert_eq!(is_program(Path::new(name), &[]), program, "{name}");
        }
    }
}
