//! What the words of a block mean together: their codes, and the role of each word beside them.

use super::Style;
use super::code::{Coded, Ex, Meaning, Word};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::dialect::{Control, Question, Row, beside_letter};

/// The meaning, where no code is computed.
pub fn fixed(control: &Control, style: &Style, words: &[Word]) -> Option<Meaning> {
    let constant = |word: &Word| match word.value {
        Ex::Number(value) if word.form.is_literal() => Some(value),
        _ => None,
    };
    let computed = |word: &&Word| is_code(word.letter, word.comma) && constant(word).is_none();
    if words.iter().any(|word| computed(&word)) {
        return None;
    }
    // What is dropped when the block runs is looked at again then.
    let values: Vec<Option<f64>> = words.iter().map(constant).collect();
    let mut meaning = of(control, style, words, &vec![true; words.len()], &values);
    let measured = |role: &Option<Role>| role.is_some_and(|role| role.is_length() || role.is_axis());
    let computed = |(word, role): (&Word, &Option<Role>)| !word.form.is_literal() && measured(role);
    if words.iter().zip(&meaning.alone).any(computed) {
        acts_as(control, Question::WordBareExpression, "value", &mut meaning.facts);
    }
    Some(meaning)
}

fn acts_as(control: &Control, question: Question, answer: &str, facts: &mut Vec<String>) {
    if !control.behaviour(question).is_some_and(|row| row.origin.is_settled() && row.value == answer) {
        facts.push(question.fact().into());
    }
}

/// True for the letters whose numbers are codes.
pub fn is_code(letter: char, comma: bool) -> bool {
    !comma && matches!(letter, 'G' | 'M')
}

/// The meaning of those words that are there; `values` holds the values that are known.
pub fn of(
    control: &Control,
    style: &Style,
    words: &[Word],
    there: &[bool],
    values: &[Option<f64>],
) -> Meaning {
    let mut meaning = Meaning {
        beside: Vec::with_capacity(words.len()),
        alone: Vec::with_capacity(words.len()),
        ..Meaning::default()
    };
    let present = || words.iter().zip(there).zip(values).enumerate().filter(|(_, ((_, there), _))| **there);
    let block: Vec<(char, Option<f64>)> =
        present().map(|(_, ((word, _), value))| (beside_letter(word.letter, word.comma), *value)).collect();
    let mut called = false;
    for (at, ((word, _), value)) in present() {
        if !is_code(word.letter, word.comma) {
            continue;
        }
        // After a macro call every other letter is an argument, M too.
        if called {
            if word.letter == 'G' {
                meaning.fault =
                    Some(Stop::alarm(style.alarms.call_not_alone, "a G code among the arguments of a call"));
            }
            continue;
        }
        let number = value.unwrap_or(f64::NAN);
        let alias = control.alias(word.letter, number);
        let place = if alias.is_some() { None } else { control.code_place(word.letter, number, &block) };
        let row = place.and_then(|place| control.code_at(place));
        called = alias.is_some_and(|alias| alias.arguments)
            || row.is_some_and(|row| matches!(row.op, Op::CallMacro | Op::CallModal | Op::CallModalEach));
        if let Some(row) = row.filter(|row| !row.origin.is_settled()) {
            meaning.facts.push(row.fact());
        }
        if row.is_none() && alias.is_none() && word.letter == 'G' {
            let text = format!("G{number} is no code of this control");
            meaning.fault.get_or_insert(Stop::alarm(style.alarms.no_such_code, text));
        }
        meaning.codes.push(Coded { word: at, letter: word.letter, number, row: place, alias });
    }
    count_m(control, &meaning.codes, &mut meaning.facts);
    for (at, word) in words.iter().enumerate() {
        let here = there.get(at).copied().unwrap_or(false) && !is_code(word.letter, word.comma);
        let beside = meaning.codes.iter().filter_map(|code| code.row).find_map(|place| {
            let row = control.code_at(place)?;
            let role = control.role(word.letter, word.comma, Some(row))?;
            (row.words.iter().any(|(_, found)| *found == role) && reads(row, word)).then_some((role, place))
        });
        meaning.beside.push(beside.filter(|_| here));
        let alone = control.word(word.letter, word.comma).filter(|_| here);
        if let Some(row) = alone.filter(|row| beside.is_none() && !called && !row.origin.is_settled()) {
            meaning.facts.push(row.fact());
        }
        meaning.alone.push(alone.map(|row| row.role));
    }
    meaning
}

/// True where a code names the letter among its own words.
pub fn reads(row: &crate::dialect::CodeMeaning, word: &Word) -> bool {
    row.words.keys().any(|written| {
        let (comma, letter) = match written.strip_prefix(',') {
            Some(letter) => (true, letter),
            None => (false, written.as_str()),
        };
        let mut chars = letter.chars();
        comma == word.comma && chars.next() == Some(word.letter) && chars.as_str().is_empty()
    })
}

fn count_m(control: &Control, codes: &[Coded], facts: &mut Vec<String>) {
    let count = codes.iter().filter(|code| code.letter == 'M').count();
    let most = match control.behaviour(Question::MCodesPerBlock).map(|row| row.value.as_str()) {
        Some("any") => usize::MAX,
        Some("3") => 3,
        _ => 1,
    };
    if count > most {
        facts.push(Question::MCodesPerBlock.fact().into());
    }
}
