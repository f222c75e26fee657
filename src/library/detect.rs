//! Which control a library is written for, by its text.

use super::Input;
use crate::dialect::{Entry, registry};
use crate::syntax::{ItemKind, for_each_item, parse_file};

/// Bytes of each file that are looked at, and how many files.
const HEAD: usize = 16 * 1024;
const FILES: usize = 40;

/// What the text says.
#[derive(Clone, Debug, PartialEq)]
pub enum Detected {
    /// One control reads it, and no other does as well.
    Sure(&'static Entry),
    /// These read it alike.
    Unsure(Vec<&'static Entry>),
}

/// Reads the heads of the files by every control's grammar: the one that finds fewest faults, and
/// most words its table has a meaning for, is the one, where it is ahead of the others.
pub fn detect(inputs: &[Input]) -> Detected {
    let mut scores: Vec<(f64, &'static Entry)> =
        registry::all().iter().map(|entry| (score(entry, inputs), entry)).collect();
    scores.sort_by(|a, b| b.0.total_cmp(&a.0));
    let best = scores.first().map_or(0.0, |(score, _)| *score);
    let near: Vec<&'static Entry> =
        scores.iter().filter(|(score, _)| *score >= best - 0.02).map(|(_, entry)| *entry).collect();
    match near.as_slice() {
        [one] if best > 0.5 => Detected::Sure(one),
        _ => Detected::Unsure(near),
    }
}

/// The share of blocks without fault whose codes the table knows.
fn score(entry: &'static Entry, inputs: &[Input]) -> f64 {
    let Some(control) = crate::dialect::Control::plain(entry.name) else { return 0.0 };
    let (mut good, mut all) = (0.0, 0.0);
    for input in inputs.iter().take(FILES) {
        let end = input.bytes.len().min(HEAD);
        for block in parse_file(&input.bytes[..end], entry.parse).blocks {
            let mut known = block.errors.is_empty();
            for_each_item(&block.items, &mut |item| {
                if let ItemKind::Word(word) = &item.kind
                    && let ('G' | 'M', Some(value)) = (word.letter, &word.value)
                    && let crate::syntax::ExprKind::Number(number) = &value.kind
                {
                    known &= control.code(word.letter, number.value, &[]).is_some();
                }
            });
            all += 1.0;
            good += f64::from(u8::from(known));
        }
    }
    if all > 0.0 { good / all } else { 0.0 }
}
