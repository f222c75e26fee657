//! The folders of a library of the project file: one library, or each by itself with what all of them share.
//!
//! A control has the programs of one folder and the shared ones in its memory. So each folder is written with a copy of what
//! is shared, and all of it has one map of registers. A program of its own stands before a shared one of the same number.

use super::inputs::{Files, Found, Input, Source, sources};
use super::project::Library;
use super::selection::{Selection, unknown};
use super::understood::understood;
use super::unread::{InputError, LeftOut, WhyNot};
use crate::dialect::Control;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Programs that are one library.
#[derive(Debug, Default)]
pub struct Folder {
    /// Its name, from the library's folder; empty for what is no folder of its own.
    pub name: String,
    own: Vec<Source>,
    shared: Vec<Source>,
    left_out: Vec<LeftOut>,
    errors: Vec<InputError>,
}

impl Library {
    /// Its folders. `place` is where a path of the project file is seen from here.
    pub fn folders(&self, place: impl Fn(&Path) -> PathBuf, endings: &[String]) -> Vec<Folder> {
        let Found { mut programs, mut left_out, mut errors } = sources(&[place(&self.path)], endings);
        // A pattern that cannot be read was told with the project file.
        let selection = Selection::of(self).unwrap_or_default();
        let names: BTreeSet<&str> = programs.iter().map(Source::name).collect();
        if let Some((key, name)) = unknown(self, &names) {
            errors.push(InputError::NotThere(place(&self.path), key, name.to_owned()));
        }
        let any = !programs.is_empty();
        programs.retain(|one| {
            let is_of = selection.takes(one.name());
            if !is_of {
                left_out.push(LeftOut { path: one.path.clone(), why: WhyNot::Excluded });
            }
            is_of
        });
        if any && programs.is_empty() {
            errors.push(InputError::NoneTaken(place(&self.path)));
        }
        let mut shared = Vec::new();
        for path in &self.shared {
            let path = place(path);
            let found = sources(std::slice::from_ref(&path), endings);
            left_out.extend(found.left_out);
            errors.extend(found.errors);
            let folder = path.is_dir().then(|| path.file_name()).flatten();
            let under = folder.map(|name| format!("{}/", name.to_string_lossy())).unwrap_or_default();
            shared.extend(found.programs.into_iter().map(|one| {
                let name = format!("{under}{}", one.name);
                one.named(name)
            }));
        }
        let all_shared = Files::of(shared.iter().map(|one: &Source| one.path.as_path()));
        let mut folders: BTreeMap<String, Folder> = BTreeMap::new();
        for one in programs.into_iter().filter(|one| !all_shared.holds(&one.path)) {
            let (folder, name) = match one.name.split_once('/').filter(|_| self.apart) {
                Some((folder, name)) => (folder.to_owned(), name.to_owned()),
                None => (String::new(), one.name.clone()),
            };
            folders.entry(folder).or_default().own.push(one.named(name));
        }
        if folders.is_empty() {
            folders.insert(String::new(), Folder::default());
        }
        let all = folders.into_iter().map(|(name, folder)| Folder { name, shared: shared.clone(), ..folder });
        let mut all: Vec<Folder> = all.collect();
        if let Some(first) = all.first_mut() {
            (first.left_out, first.errors) = (left_out, errors);
        }
        all
    }
}

impl Folder {
    /// Reads its programs; the number of its own ones, which stand before what is shared, comes with them.
    pub fn read(self, source: &Control) -> (Found<Input>, usize) {
        let Self { own, shared, left_out, errors, .. } = self;
        let mut found = Found { programs: Vec::new(), left_out, errors };
        let all = |sources: Vec<Source>, found: &mut Found<Input>| {
            for one in sources {
                match one.read() {
                    Ok(input) => found.programs.push(input),
                    Err(error) => found.errors.push(error),
                }
            }
        };
        all(own, &mut found);
        let count = found.programs.len();
        all(shared, &mut found);
        if found.programs.len() > count {
            leave_out_twins(&mut found, count, source);
        }
        (found, count)
    }
}

/// Leaves out the shared files whose programs all have a number that one of the folder's own has.
fn leave_out_twins(found: &mut Found<Input>, count: usize, source: &Control) {
    let module = understood(&found.programs, source).module;
    let own: BTreeSet<_> =
        module.programs.iter().filter(|p| p.file < count).filter_map(|p| p.name.as_ref()).collect();
    let mut twins = BTreeSet::new();
    for file in count..found.programs.len() {
        let mut names = module.programs.iter().filter(|p| p.file == file).map(|p| p.name.as_ref()).peekable();
        if names.peek().is_some() && names.all(|name| name.is_some_and(|name| own.contains(name))) {
            twins.insert(file);
        }
    }
    let taken: BTreeSet<String> = found.programs.iter().take(count).map(|input| input.name.clone()).collect();
    let all = std::mem::take(&mut found.programs);
    for (at, mut input) in all.into_iter().enumerate() {
        if twins.contains(&at) {
            found.left_out.push(LeftOut { path: input.path, why: WhyNot::Own });
            continue;
        }
        if at >= count && taken.contains(&input.name) {
            input.name = format!("shared/{}", input.name);
        }
        found.programs.push(input);
    }
}
