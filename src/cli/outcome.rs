//! What is told of conversions, and where: reports, drawings, standard output.

use super::jobs::{Job, Out};
use super::streams::{complain, print, remark, tell, tell_drawn};
use crate::library::{
    Certificates, Change, Conversion, Files, Held, Input, Kind, Lock, Made, Outcome, ProgramReport, Spots,
    Told, Wanted, certificate_of, changes, check, linked_files, profiles_of, publish, withheld_of,
    write_file,
};
use crate::report::{self, Date, Drawings, Part};
use crate::verify::{Certificate, sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A renderer of reports.
type Renderer = fn(&[Part<'_>]) -> String;

/// The renderer that a report's ending names.
fn renderer(path: &Path) -> Option<Renderer> {
    Some(match path.extension()?.to_str()? {
        "json" => report::json,
        "sarif" => report::sarif,
        "md" => report::markdown,
        "html" => |parts| report::html(parts, Date::today()),
        "txt" => report::summary,
        _ => return None,
    })
}

/// Says what is wrong with the places of reports, before anything is done. `read` are the files that the command reads.
pub fn check_reports(reports: &[PathBuf], jobs: &[Job], read: &Files) -> Result<(), u8> {
    let mut spots = Spots::default();
    let outs = jobs.iter().filter_map(|job| job.out.as_ref());
    let kept =
        |out: &Out| out.manifest.files.keys().map(|name| out.held.folder().join(name)).collect::<Vec<_>>();
    let places = outs.flat_map(|out| out.places().chain(kept(out)));
    let mut places: BTreeMap<PathBuf, &str> =
        places.map(|place| (spots.of(&place), "is where a program goes, or what is kept of it")).collect();
    for path in reports {
        let wrong = if renderer(path).is_none() {
            "the ending says the format of a report: .json .sarif .md .html .txt"
        } else if read.holds(path) {
            "is an input and would be overwritten"
        } else if let Some(wrong) = places.insert(spots.of(path), "is named twice") {
            wrong
        } else {
            continue;
        };
        return Err(complain(format!("{}: {wrong}", path.display())));
    }
    Ok(())
}

/// What a conversion puts into its folder: programs, drafts and certificates.
pub fn wanted<'p>(
    job: &'p Job,
    out: &'p Out,
    conversion: &'p Conversion,
    judged: Option<&Certificates>,
) -> Vec<Wanted<'p>> {
    let mut wanted = Vec::new();
    for (at, name) in out.names.iter().enumerate().filter(|(at, _)| job.named[*at]) {
        let bytes = match conversion.texts.get(at).and_then(Option::as_ref) {
            _ if job.source.is_same_machine(&job.target) => Some(job.inputs[at].bytes.as_slice()),
            text => text.map(String::as_bytes),
        };
        if let Some(bytes) = bytes {
            let refused = |program: &ProgramReport| program.file == at && program.outcome == Outcome::Refused;
            // Of a refused program nothing is written but its draft.
            let is_draft =
                conversion.programs.iter().any(|program| refused(program) && !program.map.is_empty());
            let kind = if is_draft { Kind::Draft } else { Kind::Program };
            let rests_on = Vec::new();
            wanted.push(Wanted { name: name.clone(), kind, source: name, bytes: bytes.into(), rests_on });
        }
        let mut certificate = |all: Option<&Vec<Option<Certificate>>>, name: String, kind| {
            if let Some(certificate) = all.and_then(|all| all.get(at)).and_then(Option::as_ref) {
                let bytes = certificate.print().into_bytes().into();
                let rests_on = if kind == Kind::Certificate {
                    rests_on(judged, at, out, conversion)
                } else {
                    Vec::new()
                };
                wanted.push(Wanted { name, kind, source: &out.names[at], bytes, rests_on });
            }
        };
        certificate(judged.map(|judged| &judged.written), certificate_of(name), Kind::Certificate);
        certificate(judged.map(|judged| &judged.withheld), withheld_of(name), Kind::Withheld);
    }
    wanted
}

/// The other conversions that the certificate of a file rests on, with the hashes of their texts.
fn rests_on(
    judged: Option<&Certificates>,
    at: usize,
    out: &Out,
    conversion: &Conversion,
) -> Vec<(String, String)> {
    let others = judged.and_then(|judged| judged.rest_on.get(at)).into_iter().flatten();
    let other = |other: &usize| {
        let text = conversion.texts.get(*other)?.as_ref()?;
        Some((out.names.get(*other)?.clone(), sha256(text.as_bytes())))
    };
    others.filter_map(other).collect()
}

/// What is new in an output folder, and what is told of it.
pub fn changed<'p>(
    job: &'p Job,
    wanted: Vec<Wanted<'p>>,
    conversion: &Conversion,
    prune: bool,
) -> Result<(Vec<Change<'p>>, Told), u8> {
    let Some(out) = &job.out else { return Ok(Default::default()) };
    let named = || out.names.iter().zip(&job.inputs).zip(&job.named).filter(|(_, named)| **named);
    let sources = named().map(|((name, input), _)| (name.as_str(), input.path.as_path()));
    let profiles = profiles_of(&job.source, &job.target);
    let made = |input: &Input| Made { sha256: sha256(&input.bytes), profiles: profiles.clone() };
    let made = named().map(|((name, input), _)| (name.clone(), made(input))).collect();
    let found = changes(out.held.folder(), &out.manifest, wanted, &sources.collect(), made, prune);
    let (mut changes, told) = found.map_err(complain)?;
    let mut lock = conversion.lock.clone();
    let is_of = |file: &str, name: &String| {
        [file, &certificate_of(file), &withheld_of(file)].contains(&name.as_str())
    };
    lock.files.retain(|file| !told.pruned.iter().any(|name| is_of(file, name)));
    let lock = lock.print().into_bytes();
    let path = out.held.folder().join(Lock::NAME);
    if out.keeps_lock && std::fs::read(path).ok().is_none_or(|now| now != lock) {
        changes.insert(0, Change { place: Lock::NAME.into(), bytes: Some(lock.into()), aside: None });
    }
    Ok((changes, told))
}

/// Says which programs of a library the written ones call, or are called by, that stand otherwise in the output folder.
pub fn tell_of_library(job: &Job, conversion: &Conversion) {
    let Some(out) = job.out.as_ref().filter(|_| job.named.contains(&false)) else { return };
    for at in linked_files(conversion, &job.named) {
        let (Some(text), Some(name)) = (conversion.texts.get(at).and_then(Option::as_ref), out.names.get(at))
        else {
            continue;
        };
        let path = out.held.folder().join(name);
        let what = match std::fs::read(&path) {
            Ok(bytes) if bytes == text.as_bytes() => continue,
            Ok(_) => "is not what this conversion goes with",
            Err(_) => "is not there yet",
        };
        let (path, input) = (path.display(), job.inputs[at].path.display());
        remark(format!("{path} {what}: convert {input} into the same folder too, before either runs"));
    }
}

/// The reports, in the places where the user wants them.
pub fn reports(reports: &[PathBuf], parts: &[Part<'_>]) -> Vec<Change<'static>> {
    let reports = reports.iter().filter_map(|path| {
        let bytes = renderer(path)?(parts).into_bytes();
        let place = std::path::absolute(path).unwrap_or_else(|_| path.clone());
        Some(Change { place, bytes: Some(bytes.into()), aside: None })
    });
    reports.collect()
}

/// Puts everything in its place, folder by folder; the reports with the last of them.
pub fn publish_all(
    jobs: &[Job],
    changes: Vec<Vec<Change<'_>>>,
    reports: Vec<Change<'static>>,
    force: bool,
) -> Result<(), u8> {
    let mut sets: Vec<(&Held, Vec<Change<'_>>)> = jobs
        .iter()
        .zip(changes)
        .filter_map(|(job, changes)| Some((&job.out.as_ref()?.held, changes)))
        .collect();
    match sets.last_mut() {
        Some((_, changes)) => changes.extend(reports),
        None => {
            for report in &reports {
                let bytes = report.bytes.as_deref().unwrap_or_default();
                write_file(&report.place, bytes, force).map_err(complain)?;
            }
        }
    }
    // No set is published if another one cannot be.
    sets.iter().try_for_each(|(held, changes)| check(held, changes, force)).map_err(complain)?;
    sets.iter().try_for_each(|(held, changes)| publish(held, changes, force)).map_err(complain)
}

/// Where the conversion of each file of a job is written, if it is.
pub fn targets(job: &Job, conversion: &Conversion) -> Vec<Option<PathBuf>> {
    let Some(out) = &job.out else { return vec![None; conversion.texts.len()] };
    let all = conversion.texts.iter().zip(&out.names).zip(&job.named);
    all.map(|((text, name), named)| text.as_ref().filter(|_| *named).map(|_| out.held.folder().join(name)))
        .collect()
}

/// Draws the findings at their source, on standard error.
pub fn draw(part: &Part<'_>) {
    let mut drawings: Option<(usize, Drawings<'_>)> = None;
    for (_, program) in part.programs() {
        for diagnostic in &program.diagnostics {
            let (file, input) = (program.file, &part.inputs[program.file]);
            if drawings.as_ref().is_none_or(|(at, _)| *at != file) {
                tell_left_out(drawings.take());
                drawings = Some((file, Drawings::new(&input.path.display().to_string(), &input.bytes)));
            }
            tell_drawn(drawings.as_mut().and_then(|(_, drawings)| drawings.draw(diagnostic)));
        }
    }
    tell_left_out(drawings);
}

fn tell_left_out(drawings: Option<(usize, Drawings<'_>)>) {
    if let Some(told) = drawings.and_then(|(_, drawings)| drawings.left_out()) {
        remark(format!("{told}; `--report FILE.json` has all"));
    }
}

/// Prints what became of the programs, and what it `asks` of a person; where there is no output folder, standard output has the program instead.
///
/// # Errors
/// The exit code where it cannot be written.
pub fn summarize(jobs: &[Job], parts: &[Part<'_>], asks: bool) -> Result<(), u8> {
    let summary = if asks { report::summary(parts) } else { report::outcomes(parts) };
    match (jobs, parts) {
        ([Job { out: None, .. }], [part]) => {
            let at = part.named.iter().position(|named| *named).unwrap_or_default();
            if let Some(Some(text)) = part.conversion.texts.get(at) {
                print(text)?;
            }
            tell(&summary);
            Ok(())
        }
        _ => print(&summary),
    }
}
