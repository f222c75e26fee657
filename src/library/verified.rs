//! Lets the verifier judge a conversion: what differs is refused, what is not decided is for review.

use super::{Conversion, Input, Outcome};
use crate::control::{LoadedFile, ProgramRef};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::syntax::{ParsedFile, parse_file};
use crate::text::Span;
use crate::verify::{self, Certificate, Effort, Job, Names, ProgramCertificate, Side};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// A program that is to be judged: its report among the conversion's, and the program on its control.
type Wanted = (usize, ProgramRef);

/// The longest file that is verified beside its conversion, bytes: both are held in memory block by block.
const LONGEST: usize = 8 << 20;

/// Verifies every program that was converted, and lets its outcome rest on that. Yields a certificate
/// for each file that has a conversion.
pub fn judge(
    inputs: &[Input],
    conversion: &mut Conversion,
    source: &Control,
    target: &Control,
    effort: Effort,
) -> Vec<Option<Certificate>> {
    let (Some(run), Some(run_there)) = (source.entry().execute, target.entry().execute) else {
        open(conversion).for_each(|program| undecided(program, "there is no emulated control to run it on"));
        return vec![None; inputs.len()];
    };
    let long: Vec<bool> = inputs.iter().map(|input| input.bytes.len() > LONGEST).collect();
    open(conversion).filter(|program| long[program.file]).for_each(|program| {
        undecided(program, "the file is too long to be verified on the way; run `macroglot verify` on it");
    });
    let texts = conversion.texts.iter().enumerate().filter(|(at, _)| !long[*at]);
    let texts: Vec<(usize, String)> = texts.filter_map(|(at, text)| Some((at, text.clone()?))).collect();
    let bytes = |at: usize| if long[at] { &[][..] } else { &inputs[at].bytes };
    let ours: Vec<ParsedFile<'_>> =
        (0..inputs.len()).map(|at| parse_file(bytes(at), source.entry().parse)).collect();
    let theirs: Vec<ParsedFile<'_>> =
        texts.iter().map(|(_, text)| parse_file(text.as_bytes(), target.entry().parse)).collect();
    let ours: Vec<LoadedFile<'_>> =
        inputs.iter().zip(&ours).map(|(input, parsed)| LoadedFile { name: &input.name, parsed }).collect();
    let theirs: Vec<LoadedFile<'_>> = texts
        .iter()
        .zip(&theirs)
        .map(|((at, _), parsed)| LoadedFile { name: &inputs[*at].name, parsed })
        .collect();
    let (from, to) = (Side::new(source, run, &ours), Side::new(target, run_there, &theirs));
    let lock = &conversion.lock;
    let names = Names {
        variables: lock.variables.clone(),
        scratch: lock.scratch.iter().copied().collect(),
        programs: lock.programs.clone(),
    };
    let mut reported: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for program in &conversion.programs {
        let facts =
            program.diagnostics.iter().filter_map(|diagnostic| diagnostic.fact.as_deref().map(str::to_owned));
        reported.entry(inputs[program.file].name.clone()).or_default().extend(facts);
    }
    let job = Job { source: &from, target: &to, names: &names, reported: &reported, effort };
    let wanted = wanted(conversion, &from.programs(), inputs.len());
    let mut verified: Vec<Option<Certificate>> = wanted
        .par_iter()
        .map(|wanted| {
            let programs: Vec<ProgramRef> = wanted.iter().map(|(_, program)| *program).collect();
            (!programs.is_empty()).then(|| verify::verify(&job, &programs))
        })
        .collect();
    verify::implicate(verified.iter_mut().flatten());
    for (file, certificate) in verified.iter().enumerate() {
        let Some(certificate) = certificate else { continue };
        for ((at, program), found) in wanted[file].iter().zip(&certificate.programs) {
            let block = ours[file].parsed.blocks.get(from.blocks(*program).start);
            apply(conversion, *at, block.map_or_else(Span::default, |block| block.span), found);
        }
        if certificate.outcome == verify::Outcome::Different {
            withdraw(conversion, file);
        }
    }
    verified
}

/// The programs that have a conversion.
fn open(conversion: &mut Conversion) -> impl Iterator<Item = &mut super::ProgramReport> {
    conversion.programs.iter_mut().filter(|program| program.outcome != Outcome::Refused)
}

/// The programs of each file that are to be judged.
fn wanted(conversion: &mut Conversion, all: &[ProgramRef], files: usize) -> Vec<Vec<Wanted>> {
    let mut wanted = vec![Vec::new(); files];
    for (file, wanted) in wanted.iter_mut().enumerate() {
        let sections = all.iter().filter(|program| program.file == file).copied();
        let reports: Vec<usize> =
            (0..conversion.programs.len()).filter(|at| conversion.programs[*at].file == file).collect();
        if reports.iter().all(|at| conversion.programs[*at].verdict.is_some()) {
            continue;
        }
        // Both sides cut a file at its program words; where they disagree, nothing can be verified.
        if sections.clone().count() == reports.len() {
            let paired = reports.into_iter().zip(sections);
            wanted.extend(paired.filter(|(at, _)| conversion.programs[*at].outcome != Outcome::Refused));
        } else {
            open(conversion)
                .filter(|program| program.file == file)
                .for_each(|program| undecided(program, "the emulated control divides the file otherwise"));
        }
    }
    wanted
}

/// Notes that nothing could be verified.
fn undecided(program: &mut super::ProgramReport, why: &str) {
    program.diagnostics.push(Diagnostic::new(Code::NotDecided, Span::default(), why));
    program.outcome = Outcome::Review;
    program.verdict = Some(verify::Outcome::Undecided);
}

/// Writes into a program's report what the verifier found.
fn apply(conversion: &mut Conversion, at: usize, span: Span, found: &ProgramCertificate) {
    let program = &mut conversion.programs[at];
    program.verdict = Some(found.outcome);
    match found.outcome {
        verify::Outcome::Same => {}
        verify::Outcome::Undecided => {
            for reason in &found.reasons {
                program.diagnostics.push(Diagnostic::new(Code::NotDecided, span, reason.text.clone()));
            }
            program.outcome = Outcome::Review;
        }
        verify::Outcome::Different => {
            let what = found.witness.as_ref().map_or_else(String::new, |witness| {
                let block = |moment: &Option<verify::Moment>| {
                    moment.as_ref().map_or_else(|| "nothing more".into(), |m| format!("'{}'", m.block))
                };
                format!("{}: {} against {}", witness.what, block(&witness.source), block(&witness.target))
            });
            let alone = if found.run_alone {
                "; it was run by itself, as no run of what calls it comes to this"
            } else {
                ""
            };
            let what = what + alone;
            program.diagnostics.push(Diagnostic::new(Code::VerifiedDifferent, span, what));
            program.outcome = Outcome::Refused;
        }
    }
    if found.rounding_sensitive == Some(true) {
        let what = "the path changes when the target's arithmetic keeps fewer digits";
        program.diagnostics.push(Diagnostic::new(Code::RoundingSensitive, span, what));
        program.outcome = program.outcome.max(Outcome::Review);
    }
}

/// Takes back the text of a file of which a program differs.
fn withdraw(conversion: &mut Conversion, file: usize) {
    conversion.texts[file] = None;
    for program in conversion.programs.iter_mut().filter(|program| program.file == file) {
        program.map.clear();
        if program.outcome != Outcome::Refused {
            let what = "stands in one file with a program that differs, so it is not written either";
            program.diagnostics.push(Diagnostic::new(Code::VerifiedDifferent, Span::default(), what));
            program.outcome = Outcome::Refused;
        }
    }
}
