//! What a library is: its control, its machines, and who calls whom.

use crate::diag::Code;
use crate::dialect::Control;
use crate::ir::Callee;
use crate::ir::analysis::{calls_of, span_of};
use crate::library::{Input, Understood, likeness};
use crate::syntax::ProgramName;
use crate::text::{LineIndex, Span};
use serde::Serialize;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};

/// Places that are named of a thing.
pub(super) const NAMED: usize = 3;

/// What a library is.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Shape {
    /// Its files.
    pub files: usize,
    /// The programs in them.
    pub programs: usize,
    /// By control, the best first: its title, and how much of the text it reads without fault and has the codes of, in
    /// hundredths.
    pub reads: Vec<(String, u32)>,
    /// Programs that look like those of a lathe.
    pub lathe: usize,
    /// The first sign of that, and where it stands.
    pub lathe_sign: Option<(String, String)>,
    /// Programs of the library that others of it call.
    pub called: usize,
    /// Programs that are called and not in the library; what most programs call is first.
    pub missing: Vec<Missing>,
    /// Numbers that two programs or more have, with the files of these.
    pub twice: Vec<(String, Vec<String>)>,
    /// The folders that have programs of one number; empty if these stand in one.
    pub folders: Vec<String>,
}

impl Missing {
    /// Its number; none for one with a name.
    pub(super) fn number(&self) -> Option<u32> {
        self.name.strip_prefix('O')?.parse().ok()
    }
}

/// A program that is called and not in the library.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Missing {
    /// Its name.
    pub name: String,
    /// How many programs call it.
    pub programs: usize,
    /// How many of them call nothing else that is missing.
    #[serde(skip)]
    pub frees: usize,
    /// The first places.
    pub places: Vec<String>,
}

impl Shape {
    pub(super) fn of(inputs: &[Input], places: &Places<'_>, library: &Understood) -> Self {
        let programs = &library.module.programs;
        let mut shape = Self { files: inputs.len(), programs: programs.len(), ..Self::default() };
        for (entry, share) in likeness(inputs) {
            let title = Control::plain(entry.name).map(|control| control.dialect().title.clone());
            // Between 0 and 100.
            shape.reads.push((title.unwrap_or_default(), (share * 100.0).floor() as u32));
        }
        for (program, found) in programs.iter().zip(&library.found) {
            let sign = found.iter().find(|finding| finding.code == Code::LatheProgram);
            shape.lathe += usize::from(sign.is_some());
            if let Some(sign) = sign.filter(|_| shape.lathe_sign.is_none()) {
                shape.lathe_sign = Some((sign.message.to_string(), places.at(program.file, sign.span)));
            }
        }
        let mut by_name: BTreeMap<&ProgramName, Vec<usize>> = BTreeMap::new();
        for program in programs {
            if let Some(name) = &program.name {
                by_name.entry(name).or_default().push(program.file);
            }
        }
        let mut called: BTreeSet<&ProgramName> = BTreeSet::new();
        let mut missing: BTreeMap<&ProgramName, (BTreeSet<usize>, Vec<String>)> = BTreeMap::new();
        for (at, program) in programs.iter().enumerate() {
            for block in &program.blocks {
                for call in calls_of(block) {
                    let Callee::Program(name) = &call.callee else { continue };
                    if by_name.contains_key(name) {
                        called.insert(name);
                        continue;
                    }
                    let (callers, named) = missing.entry(name).or_default();
                    if callers.insert(at) && named.len() < NAMED {
                        named.push(places.at(program.file, span_of(block, call)));
                    }
                }
            }
        }
        shape.called = called.len();
        let mut waits: BTreeMap<usize, usize> = BTreeMap::new();
        missing.values().flat_map(|(callers, _)| callers).for_each(|at| *waits.entry(*at).or_default() += 1);
        let frees = |callers: &BTreeSet<usize>| callers.iter().filter(|at| waits.get(at) == Some(&1)).count();
        shape.missing = missing
            .into_iter()
            .map(|(name, (callers, places))| Missing {
                name: name.to_string(),
                programs: callers.len(),
                frees: frees(&callers),
                places,
            })
            .collect();
        shape.missing.sort_by_key(|missing| std::cmp::Reverse(missing.programs));
        shape.twins(inputs, &by_name);
        shape
    }

    /// Numbers that two programs have, and the folders that these lie in.
    fn twins(&mut self, inputs: &[Input], by_name: &BTreeMap<&ProgramName, Vec<usize>>) {
        let twice = by_name.iter().filter(|(_, files)| files.len() > 1);
        let mut folders = BTreeSet::new();
        for (name, files) in twice {
            let names: Vec<String> = files.iter().map(|file| inputs[*file].name.clone()).collect();
            let of: BTreeSet<&str> =
                names.iter().map(|file| file.rsplit_once('/').map_or("", |(folder, _)| folder)).collect();
            if of.len() > 1 {
                folders.extend(of.into_iter().map(str::to_owned));
            }
            self.twice.push((name.to_string(), names));
        }
        self.folders = folders.into_iter().collect();
    }
}

/// The files of a library, with their lines counted when the first place in one is named.
pub(super) struct Places<'a> {
    inputs: &'a [Input],
    lines: Vec<OnceCell<LineIndex>>,
}

impl<'a> Places<'a> {
    pub(super) fn new(inputs: &'a [Input]) -> Self {
        Self { inputs, lines: inputs.iter().map(|_| OnceCell::new()).collect() }
    }

    /// A place as `file:line`.
    pub(super) fn at(&self, file: usize, span: Span) -> String {
        let Some((input, lines)) = self.inputs.get(file).zip(self.lines.get(file)) else {
            return String::new();
        };
        let (line, _) = lines.get_or_init(|| LineIndex::new(&input.bytes)).place(span.start);
        format!("{}:{line}", input.name)
    }
}
