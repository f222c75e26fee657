//! The two libraries of a diff, program by program.

use super::normal::{Named, Normal, normal};
use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::Control;
use crate::library::Input;
use crate::syntax::{ParsedFile, parse_file};
use crate::verify::Side;
use rayon::prelude::*;
use std::collections::HashMap;

/// A library as it was read.
#[derive(Clone, Copy, Debug)]
pub struct Shelf<'a> {
    /// Its files; none of a library that is not there.
    pub inputs: &'a [Input],
    /// The control that it is written for.
    pub control: &'a Control,
}

impl<'a> Shelf<'a> {
    /// Its files, parsed.
    pub fn parsed(&self) -> Vec<ParsedFile<'a>> {
        let parse = self.control.entry().parse;
        self.inputs.iter().map(|input| parse_file(&input.bytes, parse)).collect()
    }

    /// The same, with their names.
    pub fn loaded<'p>(&'p self, parsed: &'p [ParsedFile<'p>]) -> Vec<LoadedFile<'p>> {
        self.inputs
            .iter()
            .zip(parsed)
            .map(|(input, parsed)| LoadedFile { name: &input.name, parsed })
            .collect()
    }
}

/// The programs of a side, without what no machine sees.
pub type Texts = HashMap<ProgramRef, Vec<Normal>>;

/// The numbers that P and Q words of a side name.
pub fn named(side: &Side<'_>) -> Named {
    let mut named = Named::default();
    side.files.iter().for_each(|file| named.read(&file.parsed.blocks, side.control));
    named
}

/// The texts of all programs of a side.
pub fn texts(side: &Side<'_>, named: &Named) -> Texts {
    let all = side.programs().par_iter().filter_map(|program| {
        let parsed = side.files.get(program.file)?.parsed;
        let line_of = |at: u32| parsed.line_of(at);
        Some((*program, normal(side.text(*program), parsed.source, side.control, named, line_of)))
    });
    all.collect()
}

/// The line that a program begins in.
pub fn line_of(side: &Side<'_>, program: ProgramRef) -> usize {
    let start = side.text(program).first().map_or(0, |block| block.span.start);
    side.files.get(program.file).map_or(1, |file| file.parsed.line_of(start))
}

/// The name of a program's file.
pub fn file_of(side: &Side<'_>, program: ProgramRef) -> Option<String> {
    side.files.get(program.file).map(|file| file.name.to_owned())
}
