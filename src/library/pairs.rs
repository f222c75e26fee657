//! The programs of a library beside what they became, to be run for a person who looks at them.

use super::callees::programs_of;
use super::withdrawn::cut;
use super::{Conversion, Input, Outcome};
use crate::control::{LoadedFile, ProgramRef};
use crate::dialect::Control;
use crate::syntax::{Block, ParsedFile, parse_file};
use crate::text::Span;
use crate::verify::{Assumptions, Effort, Job, Picture, Side, Spent, SymbolMap, beside, pictured};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// The longest file of which pictures are made, bytes.
const LONGEST: usize = 1 << 20;

/// A library and its conversion, both read.
pub struct Pairs<'p> {
    job: &'p Job<'p>,
    programs: BTreeMap<usize, ProgramRef>,
    inputs: &'p [Input],
}

impl Pairs<'_> {
    /// A run of a program that is not too long, by its index among the reports, beside one of its conversion; `most` places are listed at which
    /// they differ.
    pub fn picture(&self, at: usize, most: usize) -> Option<Picture> {
        let program = *self.programs.get(&at)?;
        (!is_long(self.inputs.get(program.file)?)).then(|| pictured(self.job, program, None, most))?
    }

    /// The blocks of a program of the source.
    pub fn blocks(&self, at: usize) -> &[Block] {
        self.programs.get(&at).map_or(&[], |program| self.job.source.text(*program))
    }

    /// The bytes of the source's file that are a program's.
    pub fn extent(&self, at: usize) -> Option<Span> {
        let program = *self.programs.get(&at)?;
        let source = self.job.source;
        let first = |program: ProgramRef| source.text(program).first().map(|block| block.span.start);
        let start = if program.program == 0 { 0 } else { first(program)? };
        let next = ProgramRef { program: program.program + 1, ..program };
        let is_next = source.programs().contains(&next);
        let end = if is_next { first(next)? } else { self.inputs.get(program.file)?.bytes.len() as u32 };
        (start <= end).then(|| Span::new(start, end))
    }
}

/// Reads a library and its conversion, and lets `look` look at them. None where a control has no emulation, or where
/// nothing was converted.
pub fn with_pairs<T>(
    inputs: &[Input],
    conversion: &Conversion,
    (source, target): (&Control, &Control),
    look: impl FnOnce(&Pairs<'_>) -> T,
) -> Option<T> {
    let (run, run_there) = (source.entry().execute?, target.entry().execute?);
    if source.is_same_machine(target) {
        return None;
    }
    let is_refused = |at: &usize| conversion.programs[*at].outcome == Outcome::Refused;
    let refused: BTreeSet<usize> = (0..conversion.programs.len()).filter(is_refused).collect();
    let texts = (0..inputs.len()).filter(|at| !is_long(&inputs[*at]));
    let texts: Vec<(usize, String)> =
        texts.filter_map(|at| Some((at, cut(conversion, at, &refused)?))).collect();
    let bytes = |at: usize| if is_long(&inputs[at]) { &[][..] } else { &inputs[at].bytes };
    let ours: Vec<ParsedFile<'_>> =
        (0..inputs.len()).into_par_iter().map(|at| parse_file(bytes(at), source.entry().parse)).collect();
    let theirs: Vec<ParsedFile<'_>> =
        texts.par_iter().map(|(_, text)| parse_file(text.as_bytes(), target.entry().parse)).collect();
    let ours: Vec<LoadedFile<'_>> =
        inputs.iter().zip(&ours).map(|(input, parsed)| LoadedFile { name: &input.name, parsed }).collect();
    let theirs: Vec<LoadedFile<'_>> = (texts.iter().zip(&theirs))
        .map(|((at, _), parsed)| LoadedFile { name: &inputs[*at].name, parsed })
        .collect();
    let names = names(conversion);
    let (from, to) = (Side::new(source, run, &ours), Side::new(target, run_there, &theirs));
    let (from, to) = beside(from, to, &names);
    let programs = programs_of(conversion, from.programs());
    let programs = programs.into_iter().map(|(program, at)| (at, program)).collect();
    let job = Job {
        source: &from,
        target: &to,
        names: &names,
        assumptions: &Assumptions::new(),
        effort: Effort::default(),
        spent: &Spent::default(),
    };
    Some(look(&Pairs { job: &job, programs, inputs }))
}

fn is_long(input: &Input) -> bool {
    input.bytes.len() > LONGEST
}

/// What the verifier is told of a conversion.
pub(super) fn names(conversion: &Conversion) -> SymbolMap {
    let lock = &conversion.lock;
    SymbolMap {
        variables: lock.variables.clone(),
        scratch: lock.scratch.iter().copied().collect(),
        of_words: lock.of_words.iter().cloned().collect(),
        arguments: lock.arguments.clone(),
        always: lock.always.clone(),
        programs: lock.programs.clone(),
    }
}
