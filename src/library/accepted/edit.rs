//! Puts accepted reviews into the text of the project file, and leaves the rest as it stands: comments, order, line ends.

use super::entry::{Entry, quoted};
use crate::library::Project;
use std::ops::Range;

/// A change of the accepted reviews in a project file.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// One more.
    Add(Entry),
    /// This one, by its place in the file, is of now.
    Renew(usize, Entry),
    /// This one goes.
    Drop(usize),
}

/// Why a change cannot be put in.
const UNFIT: &str = "the entries do not fit into this file; nothing was written. Write those that stand there as `macroglot accept` \
                     does, each under [[accepted]]";

/// What stands in place of a part of the text.
type Splice = (Range<usize>, String);

/// The text of a project file with the changes in it, which are of these `entries`.
///
/// # Errors
/// Why they cannot be put in: the text is another one now, or is written in a form that they do not fit into.
pub fn edited(text: &str, entries: &[Entry], edits: &[Edit]) -> Result<String, String> {
    let read = |text: &str| toml::from_str::<Project>(text).map_err(|error| error.message().to_owned());
    let before = read(text)?;
    if before.accepted != entries {
        return Err("it was changed meanwhile; nothing was written. Run the same again".into());
    }
    let entries = &before.accepted;
    let line_end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut splices: Vec<Splice> = Vec::new();
    let mut wanted: Vec<Option<Entry>> = entries.iter().cloned().map(Some).collect();
    let mut added: Vec<&Entry> = Vec::new();
    for edit in edits {
        match edit {
            Edit::Add(entry) => added.push(entry),
            Edit::Renew(at, new) => {
                let old = entries.get(*at).ok_or("an entry is missing")?;
                splices.extend(renewed(text, old, new, line_end));
                let why = new.why.clone().or_else(|| old.why.clone());
                wanted[*at] = Some(Entry { why, ..new.clone() });
            }
            Edit::Drop(at) => {
                splices.extend(dropped(text, entries.get(*at).ok_or("an entry is missing")?));
                wanted[*at] = None;
            }
        }
    }
    let mut places: Vec<(usize, Vec<&Entry>)> = Vec::new();
    for entry in &added {
        let place = place_of(text, entries, entry);
        match places.iter_mut().find(|(at, _)| *at == place) {
            Some((_, all)) => all.push(entry),
            None => places.push((place, vec![entry])),
        }
    }
    for (at, all) in places {
        let mut new = String::new();
        let opens = text.get(..at).is_some_and(|before| !before.is_empty() && !before.ends_with('\n'));
        new.push_str(if opens { line_end } else { "" });
        for entry in all {
            new.push_str(line_end);
            entry.lines().iter().for_each(|line| new.extend([line, line_end]));
        }
        splices.push((at..at, new));
    }
    // From the last to the first, so that what is put in moves nothing that is still to be changed.
    splices.sort_by_key(|(range, _)| (range.start, range.end));
    let mut out = text.to_owned();
    for (range, new) in splices.into_iter().rev() {
        if out.get(range.clone()).is_none() {
            return Err("an entry is not where it was read".into());
        }
        out.replace_range(range, &new);
    }
    let unfit = || UNFIT.to_owned();
    let mut after = read(&out).map_err(|_| unfit())?;
    let mut now: Vec<Entry> = std::mem::take(&mut after.accepted);
    let mut then: Vec<Entry> = wanted.into_iter().flatten().chain(added.into_iter().cloned()).collect();
    let order = |entry: &Entry| entry.lines();
    now.sort_by_key(order);
    then.sort_by_key(order);
    let rest = Project { accepted: Vec::new(), ..before.clone() };
    match now == then && after == rest {
        true => Ok(out),
        false => Err(unfit()),
    }
}

/// Where a new entry goes: after the last one of its file, else after the last of all, else to the end of the text.
fn place_of(text: &str, entries: &[Entry], new: &Entry) -> usize {
    let alike = |entry: &&Entry| entry.key()[..3] == new.key()[..3];
    let last = entries.iter().rev().find(alike).or(entries.last());
    last.map_or(text.len(), |entry| line_after(text, extent(entry).end))
}

/// The values that change, and a reason that is new.
fn renewed(text: &str, old: &Entry, new: &Entry, line_end: &str) -> Vec<Splice> {
    let pairs = [(&old.says, &new.says), (&old.who, &new.who), (&old.hash, &new.hash)];
    let texts = pairs.into_iter().chain(old.at.as_ref().zip(new.at.as_ref())).filter(|(old, new)| old != new);
    let mut all: Vec<Splice> = texts.map(|(old, new)| (old.span(), quoted(new.get_ref()))).collect();
    if old.when != new.when {
        all.push((old.when.span(), new.when.get_ref().to_string()));
    }
    match (&old.why, &new.why) {
        (Some(old), Some(new)) if old != new => all.push((old.span(), quoted(new.get_ref()))),
        (None, Some(new)) => {
            let at = line_after(text, old.when.span().end);
            all.push((at..at, format!("why = {}{line_end}", quoted(new.get_ref()))));
        }
        _ => {}
    }
    all
}

/// The lines of an entry, but for comments that have a line of their own.
fn dropped(text: &str, entry: &Entry) -> Vec<Splice> {
    let extent = extent(entry);
    let start = header(text, extent.start);
    let end = line_after(text, extent.end);
    let spans = values(entry);
    let mut all = Vec::new();
    let mut at = start;
    let mut keeps = false;
    while at < end {
        let next = line_after(text, at).min(end);
        let line = text.get(at..next).unwrap_or_default();
        // A line that begins inside of a text is no comment, whatever it looks like.
        let inside = spans.iter().any(|span| span.start < at && at < span.end);
        if line.trim_start().starts_with('#') && !inside {
            keeps = true;
        } else {
            all.push((at..next, String::new()));
        }
        at = next;
    }
    // The empty line before it goes with it.
    let above = text.get(..start).unwrap_or_default();
    let gap =
        ["\r\n\r\n", "\n\n"].into_iter().find(|gap| above.ends_with(gap)).map_or(0, |gap| gap.len() / 2);
    if !keeps && gap > 0 {
        all.push((start - gap..start, String::new()));
    }
    all
}

fn values(entry: &Entry) -> Vec<Range<usize>> {
    let texts = [&entry.library, &entry.target, &entry.code, &entry.says, &entry.who, &entry.hash];
    let more = entry.file.iter().chain(&entry.at).chain(&entry.program).chain(&entry.why);
    texts.into_iter().chain(more).map(toml::Spanned::span).chain([entry.when.span()]).collect()
}

/// From the first value of an entry to its last.
fn extent(entry: &Entry) -> Range<usize> {
    let all = values(entry);
    let start = all.iter().map(|span| span.start).min().unwrap_or_default();
    start..all.iter().map(|span| span.end).max().unwrap_or_default()
}

/// The start of the line of an entry's header, above its first value.
fn header(text: &str, first: usize) -> usize {
    let above = text.get(..first).unwrap_or_default();
    let mut at = above.rfind('\n').map_or(0, |end| end + 1);
    let key = at;
    while at > 0 {
        let start = above.get(..at - 1).and_then(|above| above.rfind('\n')).map_or(0, |end| end + 1);
        let line = above.get(start..at).unwrap_or_default().trim();
        if line.starts_with("[[") {
            return start;
        }
        if !line.is_empty() && !line.starts_with('#') {
            break;
        }
        at = start;
    }
    key
}

/// The start of the line after the one that a byte stands in.
fn line_after(text: &str, at: usize) -> usize {
    text.get(at..).and_then(|rest| rest.find('\n')).map_or(text.len(), |end| at + end + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(file: &str, why: Option<&str>) -> String {
        let why = why.map(|why| format!("why = {why}\n")).unwrap_or_default();
        format!(
            "[[accepted]]\nlibrary = \"l\"\ntarget = \"t\"\nfile = \"{file}\"\ncode = \"MG0405\"\nsays = \"s\"\nat = \"a\"\n\
             who = \"w\"\nwhen = 2026-11-26\n{why}hash = \"0123456789abcdef-0123456789abcdef\"\n"
        )
    }

    fn read(text: &str) -> Vec<Entry> {
        toml::from_str::<Project>(text).unwrap().accepted
    }

    /// What looks like a comment, a header or an entry inside of a text is a part of that text.
    #[test]
    fn a_text_over_several_lines_goes_with_its_entry() {
        let why = "'''\n# no comment\n\n[[accepted]]\nwho = \"x\"\n'''";
        let (first, last) = (entry("a", Some(why)), entry("b", None));
        let text = format!("# head\n\n{first}\n# about b\n{last}");
        assert_eq!(
            edited(&text, &read(&text), &[Edit::Drop(0)]).unwrap(),
            format!("# head\n\n# about b\n{last}")
        );
        assert_eq!(
            edited(&text, &read(&text), &[Edit::Drop(1)]).unwrap(),
            format!("# head\n\n{first}\n# about b\n")
        );
        let both = edited(&text, &read(&text), &[Edit::Drop(1), Edit::Drop(0)]).unwrap();
        assert_eq!(both, "# head\n\n# about b\n");
        let new = read(&entry("a", Some("\"short\""))).remove(0);
        let renewed = edited(&text, &read(&text), &[Edit::Renew(0, new)]).unwrap();
        assert_eq!(renewed, text.replace(why, "\"short\""));
    }

    #[test]
    fn a_file_that_changed_meanwhile_is_left_alone() {
        let (text, other) = (entry("a", None), entry("b", None));
        let why = edited(&text, &read(&other), &[Edit::Drop(0)]).unwrap_err();
        assert!(why.contains("changed meanwhile"), "{why}");
        assert!(edited("[[accepted]", &[], &[]).is_err());
    }

    #[test]
    fn a_new_entry_goes_beside_those_of_its_file() {
        let text = format!("{}\n{}\n[checks] # last", entry("a", None), entry("b", None));
        let new = read(&entry("a", Some("\"more\""))).remove(0);
        let all = edited(&text, &read(&text), &[Edit::Add(new.clone())]).unwrap();
        let with = format!("{}\n{}\n", entry("a", None), entry("a", Some("\"more\"")));
        assert_eq!(all, text.replace(&format!("{}\n", entry("a", None)), &with));
        // The last line of a file may have no end.
        let open = edited("[checks] # last", &[], &[Edit::Add(new)]).unwrap();
        assert_eq!(open, format!("[checks] # last\n\n{}", entry("a", Some("\"more\""))));
    }
}
