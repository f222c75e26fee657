//! Whether what stands in an output folder was made of what stands in the library now.

use super::finding::{Finding, Pages};
use super::{Output, Shelf};
use crate::diag::Code;
use crate::library::{Kind, Manifest, is_pending};
use crate::text::Span;
use crate::verify::sha256;
use std::path::Path;

/// What to do about a conversion that is not fresh.
const AGAIN: &str = "run `macroglot convert`, and commit what it writes";

/// The findings of one folder.
///
/// # Errors
/// Why the folder cannot be looked at.
pub fn findings(shelf: &Shelf, output: &Output, pages: &Pages<'_>) -> Result<Vec<Finding>, String> {
    let folder = &output.folder;
    let shown = folder.display();
    if is_pending(folder) {
        return Err(format!("{shown}: a run is writing there, or was interrupted: run `macroglot convert`"));
    }
    let manifest = Manifest::load(folder).map_err(|error| error.to_string())?;
    if manifest.files.is_empty() && manifest.sources.is_empty() {
        return Err(format!("{shown} has no {}: nothing was converted there", Manifest::NAME));
    }
    if manifest.sources.is_empty() {
        let what = "was written by an earlier macroglot, which did not note of what: run `macroglot convert`";
        return Err(format!("{shown} {what}"));
    }
    let outdated = manifest.outdated_in(folder);
    let mut found = Vec::new();
    for (file, input) in shelf.inputs.iter().enumerate().filter(|(file, _)| shelf.wanted[*file]) {
        let mut tell = |code, message: String| {
            found.push(pages.at(code, file, Span::new(0, 0), message, Some(AGAIN.to_owned())));
        };
        let machine = &output.machine;
        match manifest.sources.get(&input.name) {
            None => tell(Code::ConversionMissing, format!("the program was never converted for {machine}")),
            Some(made) if made.sha256 != sha256(&input.bytes) => {
                tell(
                    Code::ConversionStale,
                    format!("the program changed after it was converted for {machine}"),
                );
            }
            Some(made) if made.profiles != output.profiles => {
                let what = "a machine profile changed after the program was converted for";
                tell(Code::ConversionStale, format!("{what} {machine}"));
            }
            Some(_) => {}
        }
        if let Some(outdated) = outdated.get(&input.name) {
            let others = outdated.others.join(", ");
            let what = "was verified together with others that have changed since";
            tell(Code::ConversionStale, format!("the conversion for {machine} {what}: {others}"));
        }
    }
    found.extend(by_hand(shelf, &manifest, folder));
    if shelf.whole {
        found.extend(gone(shelf, &manifest, folder));
    }
    Ok(found)
}

/// The conversions of files that are looked at, where another text stands than macroglot wrote.
fn by_hand(shelf: &Shelf, manifest: &Manifest, folder: &Path) -> Vec<Finding> {
    let wanted = |source: &str| {
        let at = shelf.inputs.iter().position(|input| input.name == source);
        at.is_some_and(|at| shelf.wanted[at])
    };
    let mut found = Vec::new();
    let programs =
        manifest.files.iter().filter(|(_, entry)| matches!(entry.kind, Kind::Program | Kind::Draft));
    for (name, entry) in programs.filter(|(_, entry)| entry.source.as_deref().is_some_and(wanted)) {
        let path = folder.join(name);
        let message = match std::fs::read(&path) {
            Ok(bytes) if sha256(&bytes) == entry.sha256 => continue,
            Ok(_) => "the conversion is not as macroglot wrote it; its certificate is about another text",
            Err(_) => "the conversion is in the folder's manifest and cannot be read",
        };
        let help = "make the change in the source, or in the machine profile, and run `macroglot convert`";
        found.push(Finding::of_file(Code::ConversionChanged, &path, message.into(), help.into()));
    }
    found
}

/// The conversions whose source is gone.
fn gone(shelf: &Shelf, manifest: &Manifest, folder: &Path) -> Vec<Finding> {
    let is_there = |name: &str| shelf.inputs.iter().any(|input| input.name == name);
    let gone = manifest.gone(folder, is_there);
    let firsts = gone.into_values().filter_map(|files| files.into_iter().next());
    let message = "the source of this conversion is gone";
    let help = "run `macroglot convert --prune`, which removes it";
    let tell =
        |name: &str| Finding::of_file(Code::SourceGone, &folder.join(name), message.into(), help.into());
    firsts.map(tell).collect()
}
