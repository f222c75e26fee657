//! What is told of conversions, and where: reports, drawings, standard output.

use super::common::{complain, print};
use super::jobs::Job;
use crate::library::{Certificates, Conversion, Output, certificate_of, same_file, withheld_of};
use crate::report::{self, Part, Sheet};
use crate::verify::Certificate;
use std::path::{Path, PathBuf};

/// A renderer of reports.
type Renderer = fn(&[Part<'_>]) -> String;

/// The renderer that a report's ending names.
fn renderer(path: &Path) -> Option<Renderer> {
    Some(match path.extension()?.to_str()? {
        "json" => report::json,
        "sarif" => report::sarif,
        "md" => report::markdown,
        "html" => report::html,
        "txt" => report::summary,
        _ => return None,
    })
}

/// Says what is wrong with the places of reports, before anything is done.
pub fn check_reports(reports: &[PathBuf], jobs: &[Job]) -> Result<(), u8> {
    for (at, path) in reports.iter().enumerate() {
        let wrong = if renderer(path).is_none() {
            "the ending says the format of a report: .json .sarif .md .html .txt"
        } else if jobs.iter().flat_map(|job| &job.inputs).any(|input| same_file(&input.path, path)) {
            "is an input and would be overwritten"
        } else if jobs.iter().flat_map(|job| job.places.iter().flatten()).any(|place| same_file(place, path))
        {
            "is where a program goes"
        } else if reports[..at].contains(path) {
            "is named twice"
        } else {
            continue;
        };
        return Err(complain(format!("{}: {wrong}", path.display())));
    }
    Ok(())
}

/// Everything that conversions write: programs, locks, reports.
pub fn outputs<'p>(jobs: &'p [Job], parts: &[Part<'p>], reports: &[PathBuf]) -> Vec<Output<'p>> {
    let mut outputs = Vec::new();
    for (job, part) in jobs.iter().zip(parts) {
        let Some(places) = &job.places else { continue };
        for ((text, place), input) in part.conversion.texts.iter().zip(places).zip(&job.inputs) {
            let bytes = match text {
                _ if job.source.is_same_machine(&job.target) => input.bytes.as_slice(),
                Some(text) => text.as_bytes(),
                None => continue,
            };
            outputs.push(Output { path: place.clone(), bytes: bytes.into() });
        }
        if let Some(path) = &job.lock_path {
            outputs
                .push(Output { path: path.clone(), bytes: part.conversion.lock.print().into_bytes().into() });
        }
    }
    for path in reports {
        if let Some(render) = renderer(path) {
            outputs.push(Output { path: path.clone(), bytes: render(parts).into_bytes().into() });
        }
    }
    outputs
}

/// The certificates: of what is written beside it, of what is not under a name of their own.
pub fn certificates(jobs: &[Job], judged: &[Certificates]) -> Vec<Output<'static>> {
    let output = |path: PathBuf, certificate: &Option<Certificate>| {
        Some(Output { path, bytes: certificate.as_ref()?.print().into_bytes().into() })
    };
    let mut outputs = Vec::new();
    for (job, judged) in jobs.iter().zip(judged) {
        let places = || job.places.iter().flatten();
        outputs.extend(places().zip(&judged.written).filter_map(|(p, c)| output(certificate_of(p), c)));
        outputs.extend(places().zip(&judged.withheld).filter_map(|(p, c)| output(withheld_of(p), c)));
    }
    outputs
}

/// Where the conversion of each file of a job is written, if it is.
pub fn targets(job: &Job, conversion: &Conversion) -> Vec<Option<PathBuf>> {
    let Some(places) = &job.places else { return vec![None; conversion.texts.len()] };
    let written = conversion.texts.iter().zip(places);
    written.map(|(text, place)| text.as_ref().map(|_| place.clone())).collect()
}

/// Draws every finding at its source, on standard error.
pub fn draw(part: &Part<'_>) {
    let mut sheet: Option<(usize, Sheet)> = None;
    for program in &part.conversion.programs {
        for diagnostic in &program.diagnostics {
            if sheet.as_ref().is_none_or(|(file, _)| *file != program.file) {
                let input = &part.inputs[program.file];
                sheet = Some((program.file, Sheet::new(&input.path.display().to_string(), &input.bytes)));
            }
            if let Some((_, sheet)) = &sheet {
                eprint!("{}", sheet.draw(diagnostic));
            }
        }
    }
}

/// Prints the summary; where there is no output folder, standard output has the program instead.
pub fn summarize(jobs: &[Job], parts: &[Part<'_>]) {
    let summary = report::summary(parts);
    match (jobs, parts) {
        ([Job { places: None, .. }], [part]) => {
            if let Some(Some(text)) = part.conversion.texts.first() {
                print(text);
            }
            eprint!("{summary}");
        }
        _ => print(&summary),
    }
}
