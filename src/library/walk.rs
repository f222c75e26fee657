//! Finds the programs in a folder, and says of every other file why it is left out.

use super::outputs::SIDECARS;
use super::places::slashed;
use super::unread::{InputError, LeftOut, WhyNot};
use super::{Lock, Manifest, Project};
use crate::dialect::registry;
use ignore::WalkBuilder;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// What a folder holds.
#[derive(Debug, Default)]
pub struct Walked {
    /// Its programs, and their names in it.
    pub programs: Vec<(PathBuf, String)>,
    /// Everything else.
    pub left_out: Vec<LeftOut>,
}

/// Endings that program files have, over and above those of the dialects' tables.
const ENDINGS: &[&str] = &[
    "nc", "cnc", "ngc", "tap", "eia", "iso", "prg", "pgm", "mpf", "spf", "min", "txt", "prog", "gcode", "g",
    "ncf", "fnc", "h",
];

/// The programs of a folder: files whose ending programs have, or that have none and a number, or begin as programs do. Ignore files are honoured;
/// those above the folder are not if they hide all of it, for it was named by hand.
///
/// # Errors
/// A folder that cannot be read, or has no program.
pub fn walk(folder: &Path, endings: &[String]) -> Result<Walked, InputError> {
    let mut walked = look(folder, endings, true)?;
    if walked.programs.is_empty() {
        walked = look(folder, endings, false)?;
    }
    if walked.programs.is_empty() {
        let endings = ENDINGS.iter().map(|e| format!(".{e}")).collect::<Vec<_>>().join(" ");
        return Err(InputError::NoPrograms(folder.to_owned(), endings));
    }
    Ok(walked)
}

fn look(folder: &Path, endings: &[String], above: bool) -> Result<Walked, InputError> {
    let fault = |error| InputError::Unreadable(folder.to_owned(), io::Error::other(error));
    let mut walked = Walked::default();
    let mut seen = BTreeSet::new();
    let mut walk = WalkBuilder::new(folder);
    walk.require_git(false).parents(above).git_global(above).git_exclude(above);
    // What an earlier run wrote into a folder below is no source of the next one.
    walk.filter_entry(|entry| entry.depth() == 0 || !is_output(entry.path()));
    for entry in walk.sort_by_file_path(Path::cmp).build() {
        let entry = entry.map_err(fault)?;
        let path = entry.path();
        if let Some(kind) = entry.file_type().filter(|kind| !kind.is_dir()) {
            // Without an ending its text says what it is.
            let bare = || path.extension().is_none() && looks_like_program(path);
            if kind.is_file() && (is_program(path, endings) || bare()) {
                if is_for_people(path) {
                    walked.left_out.push(LeftOut { path: path.to_owned(), why: WhyNot::Prose });
                } else {
                    let name = path.strip_prefix(folder).map(slashed).unwrap_or_default();
                    walked.programs.push((path.to_owned(), name));
                }
            } else if !is_own(path) {
                let why = match kind.is_symlink() {
                    true => WhyNot::Link,
                    false if looks_like_program(path) => WhyNot::Program,
                    false => WhyNot::Unknown,
                };
                walked.left_out.push(LeftOut { path: path.to_owned(), why });
            }
        }
        seen.insert(entry.into_path());
    }
    // What a folder that was not entered holds is not counted.
    let entered = seen.clone();
    let mut all = WalkBuilder::new(folder);
    all.standard_filters(false).filter_entry(move |entry| {
        entry.depth() == 0 || entry.path().parent().is_some_and(|above| entered.contains(above))
    });
    for entry in all.sort_by_file_path(Path::cmp).build() {
        let path = entry.map_err(fault)?.into_path();
        if !seen.contains(&path) {
            let is_hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
            let why = match is_hidden {
                true => WhyNot::Hidden,
                false if is_output(&path) => WhyNot::Written,
                false => WhyNot::Ignored,
            };
            walked.left_out.push(LeftOut { path, why });
        }
    }
    Ok(walked)
}

/// True for a folder in which macroglot keeps a list of what it wrote.
fn is_output(path: &Path) -> bool {
    path.join(Manifest::NAME).is_file()
}

/// What stands before the numbers of programs, on any control.
fn program_marks() -> &'static [&'static str] {
    static MARKS: OnceLock<Vec<&str>> = OnceLock::new();
    MARKS.get_or_init(|| {
        let dialects = registry::all().iter().filter_map(|entry| entry.dialect().ok());
        dialects.filter_map(|dialect| dialect.names.program.as_deref()).collect()
    })
}

fn is_program(path: &Path, endings: &[String]) -> bool {
    match path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()) {
        Some(ending) => ENDINGS.contains(&ending.as_str()) || endings.contains(&ending),
        // Controls write O1234 and the like, shops O1234A; build files and licences have no ending either.
        None => path.file_name().is_some_and(|name| {
            let name = name.to_string_lossy().to_ascii_uppercase();
            let marked = program_marks().iter().find_map(|mark| name.strip_prefix(mark));
            let number = marked.unwrap_or(&name);
            let digits = number.bytes().take_while(u8::is_ascii_digit).count();
            digits == number.len() || marked.is_some() && digits > 0
        }),
    }
}

/// The ending that programs share with texts for people.
const SHARED: &str = "txt";

/// Bytes of a file that are looked at to tell a text for people from a program.
const LOOKED_AT: u64 = 8 * 1024;

/// True for a file with the ending that programs and texts share, if it reads like a text.
fn is_for_people(path: &Path) -> bool {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(SHARED)) {
        return false;
    }
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut head));
    read.is_ok() && is_prose(&String::from_utf8_lossy(&head))
}

/// True for a file that begins as programs do: with the mark of a tape (`%`), if any, and then with the number of a program or its
/// name in angle brackets.
fn looks_like_program(path: &Path) -> bool {
    let mut head = Vec::new();
    let read = File::open(path).and_then(|file| file.take(LOOKED_AT).read_to_end(&mut head));
    if read.is_err() || head.contains(&0) {
        return false;
    }
    let text = String::from_utf8_lossy(&head).to_ascii_uppercase();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && *line != TAPE);
    let first = lines.next().unwrap_or_default();
    let first = first.strip_prefix(TAPE).unwrap_or(first).trim_start();
    let after_n = first
        .strip_prefix('N')
        .map(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit()).trim_start());
    let first = after_n.unwrap_or(first);
    if first
        .strip_prefix('<')
        .and_then(|rest| rest.split_once('>'))
        .is_some_and(|(name, _)| !name.trim().is_empty() && !name.starts_with(['!', '?', '/']))
    {
        return !is_markup(&text);
    }
    program_marks().iter().filter_map(|mark| first.strip_prefix(mark)).any(|rest| {
        let name = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        name.len() < rest.len() && !name.starts_with(|c: char| c.is_ascii_alphanumeric())
    })
}

/// True for a page or a table in angle brackets all over, which is no program.
fn is_markup(text: &str) -> bool {
    text.contains("</") || text.contains("/>")
}

/// The mark at both ends of a tape.
const TAPE: &str = "%";

/// True where most lines are sentences: three words or more, and more of them than of anything else. Comments count as
/// nothing.
fn is_prose(text: &str) -> bool {
    let (mut prose, mut all) = (0, 0);
    for line in text.lines() {
        let line = without_comments(line);
        let pieces: Vec<&str> = line.split_whitespace().collect();
        let is_word = |piece: &&&str| {
            let letters = piece.trim_matches(|c: char| c.is_ascii_punctuation());
            letters.chars().count() > 1 && letters.chars().all(|c| c.is_alphabetic() || c == '\'' || c == '-')
        };
        let words = pieces.iter().filter(is_word).count();
        all += usize::from(!pieces.is_empty());
        prose += usize::from(words >= 3 && 3 * words > 2 * pieces.len());
    }
    2 * prose > all
}

/// A line without what stands in round brackets.
fn without_comments(line: &str) -> String {
    let mut depth = 0_usize;
    let mut out = String::with_capacity(line.len());
    for sign in line.chars() {
        match sign {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ if depth == 0 => out.push(sign),
            _ => {}
        }
    }
    out
}

/// True for what macroglot itself keeps in folders.
fn is_own(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    [Lock::NAME, Manifest::NAME, Project::NAME].contains(&&*name)
        || SIDECARS.iter().any(|end| name.ends_with(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_without_ending_are_programs_by_their_number() {
        for (name, program) in [
            ("O1234", true),
            ("8010", true),
            ("README", false),
            ("a.NC", true),
            ("a.tsv", false),
            ("O9500x", true),
            ("o12-old", true),
            ("Once", false),
            ("7z", false),
        ] {
            assert_eq!(is_program(Path::new(name), &[]), program, "{name}");
        }
    }

    #[test]
    fn a_text_for_people_is_no_program() {
        let prose = "Programs for the new mill.\n\nRead this before you run any of them:\nO1000 is the main program.\n";
        assert!(is_prose(prose) && is_prose("All tools are in the drawer\n"));
        for program in [
            "%\nO1000 (THE PART THAT GOES INTO THE DRAWER)\nG0 X1.\nM30\n%\n",
            "(ALL OF THIS IS A COMMENT AND NOTHING ELSE)\n",
            "IF [#1 EQ #0] GOTO 99\nWHILE [#1 LT 3] DO1\nEND1\nG65 P9 A1\n",
            "#PRINT \"ENTER THE DEPTH OF CUT\"\n#INPUT V1\n#IF V1 LT 5 THEN GOTO :A\nX1.\n",
            "TST V1\nBNE P99\nV1 = V2 + V3\nG1 X=V1\n",
            "",
        ] {
            assert!(!is_prose(program), "{program}");
        }
    }
}
