//! What changed in the build of a program: blocks, jumps, calls, labels, variables.

use super::normal::Normal;
use super::result::{Note, Renamed};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::collections::BTreeSet;

/// Notes of a program, at the most, besides those that count.
const MOST: usize = 200;

/// What changed from the old blocks to the new ones, both of one dialect.
pub fn structure(old: &[Normal], new: &[Normal], renamed: &[Renamed]) -> Vec<Note> {
    let texts = |blocks: &[Normal]| blocks.iter().map(|block| block.text.clone()).collect::<Vec<_>>();
    let (mut added, mut gone, mut changed) = (0, 0, 0);
    let (mut first, mut notes) = ([None, None], Vec::new());
    for op in capture_diff_slices(Algorithm::Myers, &texts(old), &texts(new)) {
        if let DiffOp::Equal { .. } = op {
            continue;
        }
        let (ours, theirs) = (&old[op.old_range()], &new[op.new_range()]);
        let both = ours.len().min(theirs.len());
        changed += both;
        gone += ours.len() - both;
        added += theirs.len() - both;
        first[0] = first[0].or(ours.first().map(|block| block.line));
        first[1] = first[1].or(theirs.first().map(|block| block.line));
        for at in 0..ours.len().max(theirs.len()) {
            notes.extend(of_block(ours.get(at), theirs.get(at), renamed));
        }
    }
    let left_out = notes.len().saturating_sub(MOST);
    notes.truncate(MOST);
    if left_out > 0 {
        notes.push(note("jump", format!("and {left_out} more jumps and calls"), [None; 2]));
    }
    if added + gone + changed > 0 {
        let all = [(added, "added"), (gone, "taken out"), (changed, "changed")];
        let told = all.iter().filter(|(count, _)| *count > 0);
        let told = told.map(|(count, what)| format!("{} {what}", blocks(*count)));
        let text = told.collect::<Vec<_>>().join(", ");
        notes.insert(0, note("blocks", text, first));
    }
    notes.extend(variables(old, new, renamed));
    notes
}

fn note(about: &'static str, text: String, [old, new]: [Option<usize>; 2]) -> Note {
    Note { about, text, old, new }
}

fn blocks(count: usize) -> String {
    if count == 1 { "1 block".into() } else { format!("{count} blocks") }
}

/// What is to be said of a block that was changed, added or taken out; nothing where it neither jumps nor calls, and
/// nothing where only the name of a variable is another.
fn of_block(old: Option<&Normal>, new: Option<&Normal>, renamed: &[Renamed]) -> Option<Note> {
    let kind = |block: &Normal| {
        if block.calls { Some("call") } else { block.jumps.then_some("jump") }
    };
    let lines = [old.map(|block| block.line), new.map(|block| block.line)];
    if let Some(text) = old.zip(new).and_then(|(old, new)| label(&old.text, &new.text)) {
        return Some(note("label", text.into(), lines));
    }
    let (a, b) = (old.filter(|block| kind(block).is_some()), new.filter(|block| kind(block).is_some()));
    let (about, text) = match (a, b) {
        (Some(a), Some(b)) if only_names(a, b, renamed) => return None,
        (Some(a), Some(b)) if kind(a) == kind(b) => {
            (kind(a)?, format!("{} changed: {} -> {}", kind(a)?, a.text, b.text))
        }
        (Some(a), Some(b)) => {
            (kind(b)?, format!("{} in place of a {}: {} -> {}", kind(b)?, kind(a)?, a.text, b.text))
        }
        (Some(a), None) => (kind(a)?, format!("{} taken out: {}", kind(a)?, a.text)),
        (None, Some(b)) => (kind(b)?, format!("{} added: {}", kind(b)?, b.text)),
        (None, None) => return None,
    };
    Some(note(about, text, lines))
}

/// What is to be said of a block of which only its label is another.
fn label(old: &str, new: &str) -> Option<&'static str> {
    fn rest(text: &str) -> Option<&str> {
        Some(text.strip_prefix('@')?.split_once(' ')?.1)
    }
    match (rest(old), rest(new)) {
        (Some(rest), None) if rest == new => Some("no jump or call comes here any more"),
        (None, Some(rest)) if rest == old => Some("a jump or call comes here now"),
        _ => None,
    }
}

/// True for blocks that differ by the names of renamed variables alone.
fn only_names(a: &Normal, b: &Normal, renamed: &[Renamed]) -> bool {
    let is_same = |(old, new): (&String, &String)| {
        old == new || renamed.iter().any(|one| one.old == *old && one.new == *new)
    };
    a.bare == b.bare
        && a.variables.len() == b.variables.len()
        && a.variables.iter().zip(&b.variables).all(is_same)
}

fn variables(old: &[Normal], new: &[Normal], renamed: &[Renamed]) -> Vec<Note> {
    let all = |blocks: &[Normal]| {
        blocks.iter().flat_map(|block| block.variables.iter().cloned()).collect::<BTreeSet<String>>()
    };
    let line = |blocks: &[Normal], name: &String| {
        blocks.iter().find(|block| block.variables.contains(name)).map(|block| block.line)
    };
    let (ours, theirs) = (all(old), all(new));
    let mut notes = Vec::new();
    let here = renamed.iter().filter(|one| ours.contains(&one.old) && theirs.contains(&one.new));
    for one in here.clone() {
        let beware =
            if one.local { "" } else { "; whoever sets it by hand or elsewhere must use the new name" };
        let text = format!("{} is {} now, in all its places{beware}", one.old, one.new);
        notes.push(note("variable", text, [line(old, &one.old), line(new, &one.new)]));
    }
    let was: BTreeSet<&String> = here.clone().map(|one| &one.old).collect();
    let is: BTreeSet<&String> = here.map(|one| &one.new).collect();
    for name in ours.difference(&theirs).filter(|name| !was.contains(name)) {
        notes.push(note("variable", format!("{name} is not used any more"), [line(old, name), None]));
    }
    for name in theirs.difference(&ours).filter(|name| !is.contains(name)) {
        notes.push(note("variable", format!("{name} is new"), [None, line(new, name)]));
    }
    notes
}

/// What is another register in a conversion: the names of the lock that both sides use.
pub fn moved(old: &[Normal], new: &[Normal], names: &[(String, String)]) -> Vec<Note> {
    let line = |blocks: &[Normal], name: &String| {
        blocks.iter().find(|block| block.variables.contains(name)).map(|block| block.line)
    };
    let all = names.iter().filter(|(from, to)| from != to).filter_map(|(from, to)| {
        let lines = [line(old, from), line(new, to)];
        lines[0]?;
        Some(note("variable", format!("{from} stands in {to}"), lines))
    });
    all.collect()
}
