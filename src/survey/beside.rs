//! What programmers wrote beside a code: the comment of its block, or of the block before, and the words of its block.

use crate::canon::{Group, Op, Role};
use crate::dialect::{CodeHead, Control, Machine};
use crate::library::Input;
use crate::syntax::{Block, ExprKind, ItemKind, Word, parse_file};
use crate::text::Span;
use std::collections::BTreeMap;

/// Letters of a comment that count.
const LONGEST: usize = 60;

/// What stands beside a code.
#[derive(Default)]
pub(super) struct Beside {
    /// The comment that is about it.
    pub comment: Option<String>,
    /// The text of its block.
    pub block: String,
    /// The letters that can only be its own words.
    pub letters: Vec<char>,
}

/// What stands beside these places of a file.
pub(super) fn beside(input: &Input, control: &Control, places: &[Span]) -> Vec<Beside> {
    let parsed = parse_file(&input.bytes, control.entry().parse);
    let look = |place: &Span| {
        let at = parsed.blocks.partition_point(|block| block.span.end <= place.start);
        let Some(block) = parsed.blocks.get(at) else { return Beside::default() };
        let before = at.checked_sub(1).and_then(|at| parsed.blocks.get(at));
        // A comment with a block of its own is about what follows.
        let above = before.filter(|block| is_comment(block));
        let comment = comment(block, &input.bytes);
        Beside {
            comment: comment.or_else(|| above.and_then(|block| self::comment(block, &input.bytes))),
            block: line(block, &input.bytes),
            letters: letters(block, control),
        }
    };
    places.iter().map(look).collect()
}

/// The letters of a block with one code, but for those that mean something beside any code: beside an M code that is an axis,
/// a feed, a speed and a tool too. Codes that only say how words count, and those of compensation
/// and of the speed with their own word, may stand there.
fn letters(block: &Block, control: &Control) -> Vec<char> {
    let words = || {
        block.items.iter().filter_map(|item| match &item.kind {
            ItemKind::Word(word) if !word.comma => Some(word),
            _ => None,
        })
    };
    let group = |word: &&Word| {
        let ExprKind::Number(number) = &word.value.as_ref()?.kind else { return None };
        Some(control.code(word.letter, number.value, &[])?.op.group())
    };
    let is_aside = |word: &&Word| {
        use Group::{Distance, FeedMode, Plane, RadiusComp, ReturnPlane, SpeedMode, Units};
        group(word).is_some_and(|group| {
            matches!(group, Distance | FeedMode | Plane | RadiusComp | ReturnPlane | SpeedMode | Units)
        })
    };
    let compensates = words().any(|word| group(&word) == Some(Group::RadiusComp));
    let mut codes =
        words().filter(|word| "GM".contains(word.letter) && !is_aside(word)).map(|word| word.letter);
    let (Some(code), None) = (codes.next(), codes.next()) else { return Vec::new() };
    let counts = words().any(|word| group(&word) == Some(Group::SpeedMode));
    let taken = |letter: char| compensates && letter == 'D' || counts && letter == 'S';
    let words: Vec<char> = words().map(|word| word.letter).filter(|letter| !taken(*letter)).collect();
    let lathe = control.machine() == Machine::Lathe;
    let turns = |letter: char| {
        control.profile().axes.iter().flatten().any(|axis| format!("{axis:?}") == letter.to_string())
    };
    let is_axis = |letter: char| match letter {
        'X' | 'Y' | 'Z' | 'U' | 'V' | 'W' => true,
        'C' | 'H' => lathe || turns(letter),
        letter => turns(letter),
    };
    if code == 'M' && words.iter().any(|letter| is_axis(*letter)) {
        return Vec::new();
    }
    // Beside a G code of a builder a feed, a speed or a tool is asked too: a profile has to name it.
    let elsewhere = if code == 'M' { "GMNOSFT" } else { "GMNO" };
    words.into_iter().filter(|letter| !elsewhere.contains(*letter)).collect()
}

/// The code that switches an output in the block of a place, with its word as it is written: `M59 P1134`.
pub(super) fn switch(input: &Input, control: &Control, place: Span, op: Op) -> Option<String> {
    let parsed = parse_file(&input.bytes, control.entry().parse);
    let at = parsed.blocks.partition_point(|block| block.span.end <= place.start);
    let words = || {
        let items = parsed.blocks.get(at).into_iter().flat_map(|block| &block.items);
        items.filter_map(|item| match &item.kind {
            ItemKind::Word(word) if !word.comma => {
                Some((word.letter, String::from_utf8_lossy(item.span.of(&input.bytes)).into_owned()))
            }
            _ => None,
        })
    };
    let value = |text: &str| text.get(1..).and_then(|number| number.trim().parse::<f64>().ok());
    let stands = |head: CodeHead| {
        words().any(|(letter, text)| letter == head.letter && value(&text) == Some(head.number()))
    };
    let mut rows = control.dialect().codes.iter().filter(|row| row.op == op);
    let row = rows.find(|row| row.head().is_some_and(stands))?;
    let letter = row.words.iter().find(|(_, role)| **role == Role::Output).map(|(letter, _)| letter);
    let number = letter.and_then(|letter| words().find(|(found, _)| letter.starts_with(*found)));
    // A code of the profile switches one output, and has no word for it.
    let number = number.map_or_else(String::new, |(_, number)| format!(" {}", number.trim()));
    Some(format!("{}{number}", row.code))
}

fn is_comment(block: &Block) -> bool {
    let aside = |kind: &ItemKind| matches!(kind, ItemKind::Comment(_) | ItemKind::Sequence { .. });
    block.items.iter().all(|item| aside(&item.kind))
}

fn comment(block: &Block, bytes: &[u8]) -> Option<String> {
    let texts = block.items.iter().filter_map(|item| match &item.kind {
        ItemKind::Comment(comment) => Some(comment.text.of(bytes)),
        _ => None,
    });
    let text = texts.map(|text| String::from_utf8_lossy(text).into_owned()).collect::<Vec<_>>().join(" ");
    let text: String = text.split_whitespace().collect::<Vec<_>>().join(" ").chars().take(LONGEST).collect();
    (!text.is_empty()).then(|| text.to_uppercase())
}

fn line(block: &Block, bytes: &[u8]) -> String {
    String::from_utf8_lossy(block.span.of(bytes)).trim().chars().take(LONGEST).collect()
}

/// The comment that stands beside most of them, and beside how many.
pub(super) fn most(comments: impl Iterator<Item = String>) -> Option<(String, usize)> {
    let mut count: BTreeMap<String, usize> = BTreeMap::new();
    comments.for_each(|comment| *count.entry(comment).or_default() += 1);
    // Of equals the first in order.
    count.into_iter().rev().max_by_key(|(_, times)| *times)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_feed_is_a_word_of_a_builders_g_code_and_of_no_m_code() {
        let control = Control::from_profile("dialect = \"haas\"\nmachine = \"mill\"\n").unwrap();
        let bytes = b"G47 P0 X1. Z-2. F15.\nM77 P3 F15.\n".to_vec();
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes };
        let found = beside(&input, &control, &[Span { start: 0, end: 3 }, Span { start: 22, end: 25 }]);
        let letters: Vec<String> = found.into_iter().map(|one| one.letters.into_iter().collect()).collect();
        assert_eq!(letters, ["PXZF", "P"]);
        let bytes = b"G41 G150 P211 X1. Q.25 D01 F25.\nG77 M3 P1\n".to_vec();
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes };
        let found = beside(&input, &control, &[Span { start: 4, end: 8 }, Span { start: 32, end: 35 }]);
        let letters: Vec<String> = found.into_iter().map(|one| one.letters.into_iter().collect()).collect();
        assert_eq!(letters, ["PXQF", ""]);
        let control = Control::from_profile("dialect = \"fanuc\"\nmachine = \"lathe\"\n").unwrap();
        let bytes = b"G97S100M213P11\n".to_vec();
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes };
        assert_eq!(beside(&input, &control, &[Span { start: 7, end: 11 }])[0].letters, ['P']);
    }

    /// Two codes of a profile that switch an output each, and one of the table that has a word for it.
    #[test]
    fn an_output_is_asked_by_the_code_of_its_block() {
        let site = |code: &str, number: u32| {
            format!(
                "[[site]]\ncode = \"{code}\"\nop = \"output.on\"\nfixed = {{ \"output.bit\" = {number} }}\ntext = \"x\"\n"
            )
        };
        let profile =
            format!("dialect = \"haas\"\nmachine = \"mill\"\n{}{}", site("M162", 5), site("M164", 6));
        let control = Control::from_profile(&profile).unwrap();
        let bytes = b"M164\nM59 P1134 (ON)\nM5\n".to_vec();
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes };
        let asked = |start: u32| switch(&input, &control, Span { start, end: start + 1 }, Op::OutputOn);
        assert_eq!([0, 5, 20].map(asked), [Some("M164".to_owned()), Some("M59 P1134".to_owned()), None]);
    }
}
