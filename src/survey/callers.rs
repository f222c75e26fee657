//! Codes that may call a program of the library: parameters of a control give some programs a code.

use super::shape::NAMED;
use super::{AskedCode, AskedSetting};
use crate::dialect::{Control, Side};
use crate::library::{Input, ProgramReport};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Lines at the head of a program in which its comments name the code that calls it.
const HEAD: usize = 12;

/// A program that a code may call.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MayCall {
    /// The program's number.
    pub program: u32,
    /// True if the words of the block are its arguments.
    pub arguments: bool,
    /// The number of the parameter that says which code calls it: 6050.
    pub parameter: u32,
    /// True if comments of the program say that the code calls it.
    pub likely: bool,
    /// True if they say so by the parameter and its value.
    #[serde(skip)]
    pub is_stated: bool,
}

/// The programs of the library that a code may call: those whose comments name it or its parameter, else all of them. A
/// parameter that the profile states is known and asks nothing.
pub(super) fn may_call(
    code: &str,
    inputs: &[Input],
    source: &Control,
    programs: &[ProgramReport],
) -> Vec<MayCall> {
    let Some(letter) = code.chars().next() else { return Vec::new() };
    let Some(number) = code.get(1..).and_then(|number| number.parse::<u32>().ok()) else { return Vec::new() };
    let mut all = Vec::new();
    let mut told = Vec::new();
    let mut seen = BTreeSet::new();
    for row in &source.dialect().settings {
        let Some(rule) = row.alias.filter(|rule| rule.letter == letter) else { continue };
        let Some((stem, first)) = row.name.rsplit_once('.') else { continue };
        let Ok(first) = first.parse::<u32>() else { continue };
        for (parameter, program) in (first..=row.through.unwrap_or(first)).zip(rule.program..) {
            let is_it = |of: &&ProgramReport| of.name.as_deref().and_then(number_of) == Some(program);
            let Some(found) = programs.iter().find(is_it) else { continue };
            if source.setting(&format!("{stem}.{parameter}")).is_some() || !seen.insert(program) {
                continue;
            }
            let (head, body) =
                inputs.get(found.file).map(|input| head_and_body(input, program)).unwrap_or_default();
            // Inside the program that a code calls it would be called again.
            if has_word(&body, letter, number) {
                continue;
            }
            let stated = stated(&head, parameter);
            if stated.is_some_and(|stated| stated != number) {
                continue;
            }
            let likely = stated.is_some() || names(&head, &format!("{letter}{number}"));
            let is_stated = stated.is_some();
            let call = MayCall { program, arguments: rule.arguments, parameter, likely, is_stated };
            if likely {
                told.push(call.clone());
            }
            all.push(call);
        }
    }
    if told.is_empty() { all } else { told }
}

/// What a line of a profile says of a code, if it is more likely to call a program than to be the builder's: comments say so, or it
/// is a G code. An M code of which nothing says so is the builder's, and its line tells of the call. With the words that tell.
pub(super) fn answer(calls: &[MayCall], code: &str) -> (Option<String>, String) {
    let Some(first) = calls.first() else { return (None, String::new()) };
    let numbers = |arguments: bool| {
        let of = calls.iter().filter(|call| call.arguments == arguments);
        let numbers = of.map(|call| call.program.to_string()).collect::<Vec<_>>().join(" or ");
        let with = if arguments { ", arguments = true" } else { "" };
        (!numbers.is_empty()).then(|| format!("calls = {numbers}{with}"))
    };
    let number = code.get(1..).unwrap_or_default();
    let parameters =
        calls.iter().map(|call| format!("O{} if parameter {} is {number}", call.program, call.parameter));
    let parameters = parameters.collect::<Vec<_>>().join(", or ");
    // Two that may be it are no answer.
    let single = calls.iter().filter(|call| call.arguments == first.arguments).count() == 1;
    let answer = numbers(first.arguments).filter(|_| single && is_call(calls, code));
    let others =
        [true, false].into_iter().filter(|arguments| answer.is_none() || *arguments != first.arguments);
    let others: String = others.filter_map(numbers).map(|other| format!("; or {other}")).collect();
    let told = match answer {
        Some(_) => {
            format!("{others}; it calls {parameters}; else target = '' in place of calls")
        }
        None => format!("{others} in place of target: it calls {parameters}"),
    };
    (answer, told)
}

/// True for a code that is taken to call a program.
pub(super) fn is_call(calls: &[MayCall], code: &str) -> bool {
    calls.first().is_some_and(|first| first.likely || code.starts_with('G'))
}

/// The parameters that say which code calls a program, each asked once, where many codes of the builder might call it: their own lines
/// tell no more of it then. A code of which the program itself says that its parameter gives it the program is no line of its own: that is a
/// fact to confirm.
pub(super) fn by_parameter(codes: &mut Vec<AskedCode>, source: &Control) -> Vec<AskedSetting> {
    let told = |code: &AskedCode| match code.calls.as_slice() {
        [call] if call.is_stated => setting(source, call.parameter).map(|section| AskedSetting {
            as_fact: true,
            likely: code.code.get(1..).map(str::to_owned),
            meaning: format!("comments of O{} say that {} calls it", call.program, code.code),
            ..asked(section, call.parameter, code.programs, code.places.clone())
        }),
        _ => None,
    };
    let stated: Vec<AskedSetting> = codes.iter().filter_map(told).collect();
    codes.retain(|code| told(code).is_none());
    let open = by_number(codes, source);
    stated.into_iter().chain(open).collect()
}

/// The section of a profile that has a parameter which gives a program its code.
fn setting(source: &Control, parameter: u32) -> Option<&'static str> {
    source.dialect().settings.iter().filter(|row| row.alias.is_some()).find_map(|row| {
        let (stem, first) = row.name.rsplit_once('.')?;
        let first: u32 = first.parse().ok()?;
        let is_it = (first..=row.through.unwrap_or(first)).contains(&parameter);
        is_it.then_some(if stem == "parameter" { "parameters" } else { "settings" })
    })
}

fn asked(section: &'static str, parameter: u32, programs: usize, places: Vec<String>) -> AskedSetting {
    AskedSetting {
        side: Side::Source,
        section,
        name: parameter.to_string(),
        values: Vec::new(),
        wanted: Vec::new(),
        default: None,
        likely: Some("0".into()),
        as_fact: false,
        meaning: String::new(),
        programs,
        places,
    }
}

/// The letter of codes that may call one program, the programs that have them, and the first places.
type Callers = (char, BTreeSet<usize>, Vec<String>);

/// The parameters of which one answer says which of many codes calls a program; those codes ask it no more.
fn by_number(codes: &mut [AskedCode], source: &Control) -> Vec<AskedSetting> {
    let mut found: BTreeMap<(u32, u32), Callers> = BTreeMap::new();
    let may = |code: &AskedCode| !code.calls.is_empty() && !is_call(&code.calls, &code.code);
    let concerned: Vec<&AskedCode> = codes.iter().filter(|code| may(code)).collect();
    for code in &concerned {
        for call in &code.calls {
            let letter = code.code.chars().next().unwrap_or('M');
            let (_, programs, places) =
                found.entry((call.parameter, call.program)).or_insert((letter, BTreeSet::new(), Vec::new()));
            programs.extend(&code.of);
            let new = code.places.iter().take(NAMED.saturating_sub(places.len()));
            places.extend(new.cloned());
        }
    }
    if concerned.len() < 2 * found.len() + 2 {
        return Vec::new();
    }
    codes.iter_mut().filter(|code| may(code)).for_each(|code| code.calls.clear());
    let all = found.into_iter().filter_map(|((parameter, program), (letter, programs, places))| {
        let meaning = format!(
            "number of the {letter} code that calls O{program}, 0 if none does; the code that does needs no line under [codes]"
        );
        let section = setting(source, parameter)?;
        Some(AskedSetting { meaning, ..asked(section, parameter, programs.len(), places) })
    });
    all.collect()
}

/// The number in the name of a program.
fn number_of(name: &str) -> Option<u32> {
    let digits = name.trim_start_matches(|sign: char| !sign.is_ascii_digit());
    let end = digits.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(digits.len());
    digits.get(..end)?.parse().ok()
}

/// The comments in the first lines of a program, and what it has besides comments, in capitals.
fn head_and_body(input: &Input, program: u32) -> (String, String) {
    let text = String::from_utf8_lossy(&input.bytes).to_ascii_uppercase();
    let starts = |line: &str| line.starts_with(['O', ':', '<']) && number_of(line).is_some();
    let is_head = |line: &&str| starts(line) && number_of(line) == Some(program);
    let lines = text.lines().skip_while(|line| !is_head(line)).enumerate();
    let (mut head, mut body) = (String::new(), String::new());
    for (at, line) in lines.take_while(|(at, line)| *at == 0 || !starts(line)) {
        let mut open = false;
        for sign in line.chars() {
            match sign {
                '(' => open = true,
                ')' => {
                    open = false;
                    head.push(' ');
                }
                _ if !open => body.push(sign),
                _ if at < HEAD => head.push(sign),
                _ => {}
            }
        }
        head.push('\n');
        body.push('\n');
    }
    (head, body)
}

/// True if a program has the word of a letter with this number.
fn has_word(body: &str, letter: char, number: u32) -> bool {
    body.match_indices(letter).any(|(at, _)| {
        let rest = body.get(at + letter.len_utf8()..).unwrap_or_default().trim_start_matches([' ', '\t']);
        let end = rest.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(rest.len());
        !rest.get(end..).unwrap_or_default().starts_with('.')
            && rest.get(..end).and_then(|digits| digits.parse().ok()) == Some(number)
    })
}

/// True if a text has a word that no further digit follows.
fn names(text: &str, word: &str) -> bool {
    text.match_indices(word).any(|(at, _)| {
        let after = text.get(at + word.len()..).and_then(|rest| rest.chars().next());
        let before = text.get(..at).and_then(|rest| rest.chars().next_back());
        !after.is_some_and(|sign| sign.is_ascii_digit() || sign == '.')
            && !before.is_some_and(|sign| sign.is_ascii_alphanumeric())
    })
}

/// The code that a comment says of a parameter: 100 for `PARAM 6050=100`.
fn stated(text: &str, parameter: u32) -> Option<u32> {
    let close = text.replace([' ', '\t'], "");
    let key = format!("{parameter}=");
    close.match_indices(&key).find_map(|(at, _)| {
        let before = close.get(..at).and_then(|rest| rest.chars().next_back());
        let rest =
            close.get(at + key.len()..).filter(|_| !before.is_some_and(|sign| sign.is_ascii_digit()))?;
        let end = rest.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(rest.len());
        rest.get(..end)?.parse().ok()
    })
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    fn asked(files: &[(&str, &str)]) -> String {
        let input = |(name, text): &(&str, &str)| Input {
            path: (*name).into(),
            name: (*name).into(),
            bytes: text.as_bytes().into(),
        };
        let inputs: Vec<Input> = files.iter().map(input).collect();
        let profile = "dialect = \"fanuc\"\nmachine = \"mill\"\n";
        let source = Control::from_profile(profile).unwrap();
        let target = Control::from_profile("dialect = \"haas\"\nmachine = \"mill\"\n").unwrap();
        filled(&survey(&inputs, &source, Some(&target)), Side::Source, Some(profile)).unwrap()
    }

    #[test]
    fn a_program_that_has_the_code_itself_is_not_called_by_it() {
        let text = asked(&[("O9001.nc", "O9001(TOOL CHANGE)\nM205\nG91G30Z0\nM 201\nM99\n")]);
        assert!(text.contains("#? M201 = { target = ") && !text.contains("calls ="), "{text}");
    }

    #[test]
    fn two_programs_that_may_be_it_are_no_answer() {
        let main = ("a.nc", "O1\nG21 G90\nM144\nG0 X1.\nM30\n");
        let one = ("b.nc", "O9002(M144)\nG4 P1.\nM99\n");
        let other = ("c.nc", "O9005(NOT M144)\nG4 P1.\nM99\n");
        assert!(asked(&[main, one]).contains("#? M144 = { calls = 9002 }"), "{}", asked(&[main, one]));
        let text = asked(&[main, one, other]);
        assert!(
            text.contains("#? M144 = { target = \"\"") && text.contains("calls = 9002 or 9005 in place"),
            "{text}"
        );
        // What stands in the blocks of a program is no comment of it.
        let text = asked(&[main, ("b.nc", "O9002\nM145\nG4 P144.\nM99\n")]);
        assert!(!text.contains("#? M144 = { calls"), "{text}");
    }
}
