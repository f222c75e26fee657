//! What a program reads of the page: which files it is about, and the hash of each.

use super::super::{Date, Part, Totals};
use crate::library::Outcome;
use crate::text::json_pretty;
use crate::verify::{self, Identity, sha256};
use serde::Serialize;
use sha2::{Digest, Sha256};

/// Version of the shape of the block.
const FORMAT: u32 = 1;

#[derive(Serialize)]
struct Data<'a> {
    format: u32,
    macroglot: &'static str,
    date: String,
    totals: Totals,
    libraries: Vec<Library<'a>>,
}

#[derive(Serialize)]
struct Library<'a> {
    from: Machine,
    to: Machine,
    files: Vec<File>,
    programs: Vec<Program<'a>>,
}

#[derive(Serialize)]
struct Machine {
    control: String,
    profile: Option<String>,
    sha256: String,
}

/// A file of the source and what was written for it.
#[derive(Serialize)]
pub(super) struct File {
    pub source: String,
    pub source_sha256: String,
    pub target: Option<String>,
    pub target_sha256: Option<String>,
}

#[derive(Serialize)]
struct Program<'a> {
    file: usize,
    program: Option<&'a str>,
    outcome: Outcome,
    verdict: Option<verify::Outcome>,
}

/// The block as JSON that stands in HTML: no sign of it can end the element.
pub(super) fn data(parts: &[Part<'_>], date: Date) -> String {
    let libraries = parts.iter().map(library).collect();
    let (macroglot, totals) = (env!("CARGO_PKG_VERSION"), Totals::of(parts));
    let data = Data { format: FORMAT, macroglot, date: date.to_string(), totals, libraries };
    json_pretty(&data).replace('<', "\\u003c") + "\n"
}

fn library<'a>(part: &Part<'a>) -> Library<'a> {
    let [from, to] = part.controls.map(|control| Machine {
        control: control.name().to_owned(),
        profile: control.profile().file.as_ref().map(|path| path.display().to_string()),
        sha256: Identity::of(control).sha256,
    });
    let programs = part.programs().map(|(_, program)| Program {
        file: program.file,
        program: program.name.as_deref(),
        outcome: program.outcome,
        verdict: program.verdict,
    });
    Library { from, to, files: files(part), programs: programs.collect() }
}

/// The files of a library with their hashes.
pub(super) fn files(part: &Part<'_>) -> Vec<File> {
    let is_copied = part.controls[0].is_same_machine(part.controls[1]);
    let files = part.inputs.iter().enumerate().map(|(at, input)| {
        let text = part.conversion.texts.get(at).and_then(Option::as_ref);
        let target = part.targets.get(at).and_then(Option::as_ref).map(|path| path.display().to_string());
        File {
            source: input.path.display().to_string(),
            source_sha256: sha256(&input.bytes),
            target,
            target_sha256: match is_copied {
                true => Some(sha256(&input.bytes)),
                false => text.map(|text| sha256(text.as_bytes())),
            },
        }
    });
    files.collect()
}

/// One hash of many: that of their lines, a hash and a name each, as `sha256sum` prints them.
pub(super) fn together<'a>(files: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    let lines: String = files.map(|(name, hash)| format!("{hash}  {name}\n")).collect();
    sha256(lines.as_bytes())
}

/// The hash of a text, as a content security policy names it.
pub(super) fn base64_sha256(text: &str) -> String {
    const SIGNS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let hash = Sha256::digest(text.as_bytes());
    let mut out = String::new();
    for three in hash.chunks(3) {
        let bits =
            three.iter().fold(0_u32, |bits, byte| bits << 8 | u32::from(*byte)) << (8 * (3 - three.len()));
        for place in 0..4 {
            let sign = SIGNS[(bits >> (18 - 6 * place) & 63) as usize];
            out.push(if place <= three.len() { char::from(sign) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::base64_sha256;

    /// `printf abc | openssl dgst -sha256 -binary | base64`
    #[test]
    fn a_hash_is_written_as_browsers_read_it() {
        assert_eq!(base64_sha256("abc"), "ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
    }
}
