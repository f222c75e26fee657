//! What is accepted of the programs themselves: on the way to every machine that their library goes to.

use super::entry::Entry;
use super::questions::{asks, of_program, seen_from};
use super::scope::Scopes;
use crate::diag::{Accepted, Code};
use crate::dialect::Control;
use crate::library::{Input, Understood};
use crate::text::LineIndex;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// What the project file has for a library.
#[derive(Debug)]
pub struct Answers {
    /// The library's name.
    pub library: String,
    /// The entries of the project file.
    pub entries: Vec<Entry>,
    /// The machines that it goes to, by their names.
    pub targets: Vec<(String, Control)>,
    /// The project's folder.
    pub root: PathBuf,
}

/// By program, what was accepted: its code, what it says, and by whom.
pub type OfPrograms = BTreeMap<(usize, Code, Arc<str>), Accepted>;

impl Answers {
    /// What is accepted for every machine, of what `understood` found in the library.
    pub fn everywhere(&self, library: &Understood, inputs: &[Input], source: &Control) -> OfPrograms {
        let mut all: Option<OfPrograms> = None;
        for (name, target) in &self.targets {
            let has_any = |entry: &Entry| entry.library() == self.library && entry.target() == *name;
            if !self.entries.iter().any(has_any) {
                return OfPrograms::new();
            }
            let scopes = Scopes::of_module(&library.module, inputs, [source, target]);
            let found = self.on_way(name, &scopes, library, inputs);
            all = Some(match all {
                Some(all) => all.into_iter().filter(|(key, _)| found.contains_key(key)).collect(),
                None => found,
            });
        }
        all.unwrap_or_default()
    }

    fn on_way(&self, target: &str, scopes: &Scopes, library: &Understood, inputs: &[Input]) -> OfPrograms {
        let of_way = |entry: &&Entry| entry.library() == self.library && entry.target() == target;
        let key = |entry: &Entry| entry.key().map(str::to_owned);
        let entries: BTreeMap<([String; 5], &str), &Entry> = (self.entries.iter().filter(of_way))
            .map(|entry| ((key(entry), entry.hash.get_ref().as_str()), entry))
            .collect();
        let mut all = OfPrograms::new();
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        library.module.programs.iter().for_each(|program| *counts.entry(program.file).or_default() += 1);
        let file_lines = |file: &usize| Some((*file, LineIndex::new(&inputs.get(*file)?.bytes)));
        let lines: BTreeMap<usize, LineIndex> = counts.keys().filter_map(file_lines).collect();
        let mut before: BTreeMap<usize, usize> = BTreeMap::new();
        for (at, (program, found)) in library.module.programs.iter().zip(&library.found).enumerate() {
            let nth = before.entry(program.file).or_default();
            let this = *nth;
            *nth += 1;
            let (once, asked): (Vec<_>, Vec<_>) =
                found.iter().filter(|finding| asks(finding)).partition(|finding| finding.once);
            for finding in once {
                let code = finding.code.number();
                let hash = scopes.hash_once(code, &finding.message);
                let [library, target, code] = [self.library.as_str(), target, code].map(str::to_owned);
                let entry =
                    entries.get(&([library, target, String::new(), String::new(), code], hash.as_str()));
                if let Some(entry) = entry.filter(|entry| entry.answers(&hash, &finding.message)) {
                    all.insert((at, finding.code, finding.message.clone()), entry.accepted());
                }
            }
            let place = inputs.get(program.file).zip(lines.get(&program.file));
            let Some((input, lines)) = place.filter(|_| !asked.is_empty()) else { continue };
            let Some(scope) =
                scopes.program(program.file, this, counts.get(&program.file).copied().unwrap_or_default())
            else {
                continue;
            };
            let file = seen_from(&input.path, &self.root);
            let name = program.name.as_ref().map(ToString::to_string).unwrap_or_default();
            for ((code, says), _, hash) in of_program(asked.into_iter(), (input, lines), (scopes, scope)) {
                let (library, code_text) = (self.library.clone(), code.number().to_owned());
                let key = [library, target.to_owned(), file.clone(), name.clone(), code_text];
                let entry = entries.get(&(key, hash.as_str()));
                if let Some(entry) = entry.filter(|entry| entry.answers(&hash, &says)) {
                    all.insert((at, code, says), entry.accepted());
                }
            }
        }
        all
    }
}
