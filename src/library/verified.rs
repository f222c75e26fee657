//! Lets the verifier judge a conversion: what differs is refused, what is not decided is for review.

use super::{Conversion, Input, Outcome};
use crate::control::{LoadedFile, ProgramRef};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::syntax::{ParsedFile, parse_file};
use crate::text::Span;
use crate::verify::{self, Certificate, Effort, Job, Names, ProgramCertificate, Side};

/// Verifies every program that was converted, and lets its outcome rest on that. Yields a certificate
/// for each file that has a conversion.
pub fn judge(
    inputs: &[Input],
    conversion: &mut Conversion,
    source: &Control,
    target: &Control,
    effort: Effort,
) -> Vec<Option<Certificate>> {
    let none = || inputs.iter().map(|_| None).collect();
    let (Some(run), Some(run_there)) = (source.entry().execute, target.entry().execute) else {
        for program in conversion.programs.iter_mut().filter(|program| program.outcome != Outcome::Refused) {
            let what = "there is no emulated control to run it on";
            program.diagnostics.push(Diagnostic::new(Code::NotDecided, Span::default(), what));
            program.outcome = Outcome::Review;
        }
        return none();
    };
    let texts: Vec<(usize, String)> =
        conversion.texts.iter().enumerate().filter_map(|(at, text)| Some((at, text.clone()?))).collect();
    let ours: Vec<ParsedFile<'_>> =
        inputs.iter().map(|input| parse_file(&input.bytes, source.entry().parse)).collect();
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
    let names = Names { variables: lock.variables.clone(), programs: lock.programs.clone() };
    let job = Job { source: &from, target: &to, names: &names, effort };
    let all = from.programs();
    let mut certificates: Vec<Option<Certificate>> = none();
    #[allow(clippy::needless_range_loop)] // the index names the file in three tables
    for file in 0..inputs.len() {
        let sections: Vec<ProgramRef> = all.iter().filter(|program| program.file == file).copied().collect();
        let reports: Vec<usize> =
            (0..conversion.programs.len()).filter(|at| conversion.programs[*at].file == file).collect();
        // Both sides cut a file at its program words; where they disagree, nothing was verified.
        let paired = sections.len() == reports.len();
        let wanted: Vec<(usize, ProgramRef)> = reports
            .iter()
            .copied()
            .zip(sections)
            .filter(|(at, _)| paired && conversion.programs[*at].outcome != Outcome::Refused)
            .collect();
        let open = reports.iter().filter(|at| conversion.programs[**at].outcome != Outcome::Refused).count();
        if open == 0 {
            continue;
        }
        if wanted.is_empty() {
            for at in reports {
                let program = &mut conversion.programs[at];
                let what = "the emulated control divides the file into other programs";
                program.diagnostics.push(Diagnostic::new(Code::NotDecided, Span::default(), what));
                program.outcome = program.outcome.max(Outcome::Review);
            }
            continue;
        }
        let programs: Vec<ProgramRef> = wanted.iter().map(|(_, program)| *program).collect();
        let certificate = verify::verify(&job, &programs);
        for ((at, program), found) in wanted.iter().zip(&certificate.programs) {
            let start = from.blocks(*program).start;
            let span = ours
                .get(file)
                .and_then(|f| f.parsed.blocks.get(start))
                .map_or_else(Span::default, |b| b.span);
            apply(conversion, *at, span, found);
        }
        certificates[file] = Some(certificate);
        if wanted.iter().any(|(at, _)| conversion.programs[*at].outcome == Outcome::Refused) {
            withdraw(conversion, file, &reports);
        }
    }
    certificates
}

/// Writes into a program's report what the verifier found.
fn apply(conversion: &mut Conversion, at: usize, span: Span, found: &ProgramCertificate) {
    let program = &mut conversion.programs[at];
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
fn withdraw(conversion: &mut Conversion, file: usize, reports: &[usize]) {
    conversion.texts[file] = None;
    for at in reports {
        let program = &mut conversion.programs[*at];
        program.map.clear();
        if program.outcome != Outcome::Refused {
            let what = "stands in one file with a program that differs, so it is not written either";
            program.diagnostics.push(Diagnostic::new(Code::VerifiedDifferent, Span::default(), what));
            program.outcome = Outcome::Refused;
        }
    }
}
