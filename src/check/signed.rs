//! Whether what a signed report is about still stands there: programs, conversions, and the profiles of both machines.

use super::finding::Finding;
use crate::diag::Code;
use crate::dialect::Control;
use crate::verify::{Identity, sha256};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// What stands before the hashes in a report.
const BEGINS: &str = "<script type=\"application/json\" id=\"macroglot\">";
const ENDS: &str = "</script>";

/// The version of the shape of what is read.
const FORMAT: u32 = 1;

#[derive(Deserialize)]
struct Signed {
    format: u32,
    macroglot: String,
    libraries: Vec<Library>,
}

#[derive(Deserialize)]
struct Library {
    from: Machine,
    to: Machine,
    files: Vec<File>,
}

#[derive(Deserialize)]
struct Machine {
    profile: Option<PathBuf>,
    sha256: String,
}

#[derive(Deserialize)]
struct File {
    source: PathBuf,
    source_sha256: String,
    target: Option<PathBuf>,
    target_sha256: Option<String>,
}

/// The findings of one report. Its files are seen from the project's folder, `root`, where reports are written.
pub fn changed(report: &Path, root: &Path) -> Vec<Finding> {
    let find = |message: String| {
        let help = "have the change read, and a new report signed: `macroglot convert --report`; or take the \
                    files back to what was signed";
        Finding::of_file(Code::SignedStale, report, message, help.to_owned())
    };
    let signed = match read(report) {
        Ok(signed) => signed,
        Err(why) => return vec![find(why)],
    };
    let mut found = Vec::new();
    for Library { from, to, files } in &signed.libraries {
        for File { source, source_sha256, target, target_sha256 } in files {
            found.extend(otherwise(root, source, source_sha256));
            if let (Some(target), Some(hash)) = (target, target_sha256) {
                found.extend(otherwise(root, target, hash));
            }
        }
        // The hash of a machine is over its table too, which another version may have corrected.
        let of_this = signed.macroglot == env!("CARGO_PKG_VERSION");
        for machine in [from, to].into_iter().filter(|_| of_this) {
            found.extend(
                machine.profile.as_ref().and_then(|path| profile_changed(root, path, &machine.sha256)),
            );
        }
    }
    found.sort();
    found.dedup();
    found.into_iter().map(find).collect()
}

fn read(report: &Path) -> Result<Signed, String> {
    let text = std::fs::read(report).map_err(|error| format!("the signed report cannot be read: {error}"))?;
    let text = String::from_utf8_lossy(&text);
    let block = text.split_once(BEGINS).and_then(|(_, rest)| rest.split_once(ENDS));
    let Some((block, _)) = block else {
        return Err("is no report that macroglot wrote as a page: there are no hashes in it".into());
    };
    let signed: Signed = serde_json::from_str(block)
        .map_err(|error| format!("the hashes in the report cannot be read: {error}"))?;
    match signed.format {
        FORMAT => Ok(signed),
        other => Err(format!("the report is of format {other}, this macroglot reads format {FORMAT}")),
    }
}

/// What is to be said of a file that is another than the one that was signed for.
fn otherwise(root: &Path, file: &Path, hash: &str) -> Option<String> {
    match std::fs::read(root.join(file)) {
        Ok(bytes) if sha256(&bytes) == hash => None,
        Ok(_) => Some(format!("{} has changed since the report was signed", file.display())),
        Err(_) => Some(format!("{} was there when the report was signed, and is not now", file.display())),
    }
}

fn profile_changed(root: &Path, file: &Path, hash: &str) -> Option<String> {
    let control = Control::load(&root.join(file));
    let same = control.is_ok_and(|control| Identity::of(&control).sha256 == hash);
    (!same).then(|| format!("the profile {} has changed since the report was signed", file.display()))
}
