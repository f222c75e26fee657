//! The lines of a profile in which is said what becomes of the codes of the machine's builder.

use super::filled::{ASKS, TELLS, plain};
use super::{AskedCode, Survey};
use crate::canon::Op;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The section of a profile with a line for each code.
pub(super) const SECTION: &str = "codes";

/// A line to fill in for each code. With a target one answer is enough: its code, in the source's profile alone.
pub(super) fn lines(survey: &Survey<'_>) -> String {
    let mut text = super::own_calls::lines(&survey.own_calls);
    if survey.codes.is_empty() {
        return text;
    }
    let told: &[&str] = match survey.goes {
        true => &[
            "What the machine's builder made of these codes: docs/builders-codes.md. Write the code that does the same on",
            "the target: target = \"M88\". Nothing of it has to stand in the target's profile. Where it has none, write do =",
            "\"omit\", \"stop\" or \"alarm\" in its place; do = \"same\" only where the target's own builder gave that very",
            "code the same meaning. For several machines give it a name instead, and their codes the same one.",
            "A text says what it does; a stop or an alarm needs it as its message.",
        ],
        false => &[
            "What the machine's builder made of these codes: docs/builders-codes.md. Give each a name (and the",
            "target's code the same one), or target = \"M88\", or do = \"omit\", \"stop\" or \"alarm\"; do = \"same\" only where",
            "the target's own builder gave that very code the same meaning.",
            "A text says what it does; a stop or an alarm needs it as its message.",
        ],
    };
    told.iter().for_each(|line| _ = writeln!(text, "{TELLS} {line}"));
    let pairs = pairs(&survey.codes);
    if !pairs.is_empty() {
        let _ = writeln!(text, "{TELLS} {PAIRED}");
    }
    for (at, code) in survey.codes.iter().enumerate() {
        match pairs.iter().find(|(first, second)| at == *first || at == *second) {
            Some((first, second)) if at == *first.min(second) => {
                pair(&mut text, [&survey.codes[*first], &survey.codes[*second]], survey.goes);
            }
            Some(_) => {}
            None => line(&mut text, code, survey.goes),
        }
    }
    text
}

/// What is said before codes that share a line.
const PAIRED: &str = "Two codes on one line, as they stand in the same programs: \"M10, M11\" = { target = \"M88, M89\" } says both in order. \
                      Write a line for each where only one has such a code.";

/// The codes that share a line, by their places in the list, the lower number first: on and off have numbers beside each other. Which two they are
/// is no matter of meaning, for each has its own answer. Of numbers in a row each pair begins at an odd place: three in a row are no pair and
/// a half, for nobody can tell which two belong together.
fn pairs(codes: &[AskedCode]) -> Vec<(usize, usize)> {
    let number = |code: &AskedCode| -> Option<(char, u32)> {
        let plain = code.op.is_none() && code.words.is_empty() && code.calls.is_empty();
        let letter = code.code.chars().next().filter(|_| plain)?;
        Some((letter, code.code.get(1..)?.parse().ok()?))
    };
    let mut all = Vec::new();
    for (at, one) in codes.iter().enumerate() {
        for (other, two) in codes.iter().enumerate() {
            let (Some((letter, low)), Some((same, high))) = (number(one), number(two)) else { continue };
            let apart = high.saturating_sub(low);
            let shared = one.of.intersection(&two.of).count();
            if letter == same
                && (1..=2).contains(&apart)
                && shared > 0
                && may_pair(codes, letter, [low, high])
            {
                let of = one.of.union(&two.of).count();
                // Those that stand in the same programs first, then those whose numbers are beside each other.
                all.push((apart, std::cmp::Reverse(shared * 1000 / of), low, at, other));
            }
        }
    }
    all.sort_unstable();
    let mut taken: Vec<(usize, usize)> = Vec::new();
    for (.., one, two) in all {
        if !taken.iter().any(|(a, b)| [one, two].contains(a) || [one, two].contains(b)) {
            taken.push((one, two));
        }
    }
    taken
}

/// True for two numbers of which the row of asked numbers that they stand in makes a pair.
fn may_pair(codes: &[AskedCode], letter: char, [low, high]: [u32; 2]) -> bool {
    let number = |code: &AskedCode| code.code.strip_prefix(letter)?.parse::<u32>().ok();
    let all: BTreeSet<u32> = codes.iter().filter_map(number).collect();
    if high - low > 1 {
        return !all.contains(&(low + 1));
    }
    let below = (0..low).rev().take_while(|number| all.contains(number)).count();
    let above = (high + 1..).take_while(|number| all.contains(number)).count();
    below % 2 == 0 && above % 2 == 0
}

fn pair(text: &mut String, of: [&AskedCode; 2], goes: bool) {
    let about = of.map(|code| {
        let programs =
            if code.programs == 1 { String::new() } else { format!("{} programs: ", code.programs) };
        let how = if code.block.contains(&code.code) { "as in" } else { "goes with" };
        let said = code.comment.as_ref().filter(|(said, _)| !code.block.contains(said));
        let said = said.map(|(said, _)| format!(" ({said})")).unwrap_or_default();
        format!("{programs}{}; {how}: {}{said}", code.places.join(", "), code.block)
    });
    let name = if goes { "target" } else { "name" };
    let key = of.map(|code| code.code.as_str()).join(", ");
    let _ = writeln!(text, "{ASKS} \"{key}\" = {{ {name} = \", \" }} # {}", plain(&about.join("; ")));
}

fn line(text: &mut String, code: &AskedCode, goes: bool) {
    let (called, may_call) = super::callers::answer(&code.calls, &code.code);
    let answer = match (code.op, goes) {
        _ if let Some(answer) = &called => answer.clone(),
        (Some(op), _) => format!("op = \"{op}\""),
        (None, true) => "target = \"\"".to_owned(),
        (None, false) => "name = \"\"".to_owned(),
    };
    let said = code.comment.as_ref().and_then(|(comment, _)| said(comment));
    let letters = code.words.iter().filter(|_| called.is_none());
    let words: Vec<String> = letters.map(|letter| format!("{letter} = \"{letter}\"")).collect();
    let keys = [Some(answer), said, in_braces(&words)].into_iter().flatten().collect::<Vec<_>>().join(", ");
    let programs = if code.programs == 1 { String::new() } else { format!("{} programs: ", code.programs) };
    // What lets an axis go after a hole stands in no block: the control gives it by itself.
    let how = if code.block.contains(&code.code) { "as in" } else { "goes with" };
    let mut about = format!("{programs}{}; {how}: {}", code.places.join(", "), code.block);
    about.push_str(match code.op {
        Some(Op::Probe) if code.code.contains(" R") => {
            "; where R says how the move stops, and the target may stop it its own way; else do = \"alarm\" in place of op"
        }
        Some(Op::Probe) => {
            "; where the probe of this signal ends the moves of the target's code too; else do = \"alarm\" in place of op"
        }
        Some(_) => "; where P says the spindle that the target's code turns too; else name = \"\" in place of op",
        None => "",
    });
    about.push_str(&may_call);
    about.push_str(match (words.is_empty(), goes) {
        (true, _) => "",
        (false, true) => {
            "; its words each with the letter that its value has there, beside a name with a name"
        }
        (false, false) => "; its words each with a name, beside target with that code's letter",
    });
    let _ = writeln!(text, "{ASKS} {} = {{ {keys} }} # {}", key(&code.code), plain(&about));
}

/// A code as the key of its line: `M14`, or `"M3 P11"`.
pub(super) fn key(code: &str) -> String {
    match !code.is_empty() && code.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
        true => code.to_owned(),
        false => format!("\"{code}\""),
    }
}

/// What a code does, as a key of its line; none if nothing is known.
pub(super) fn said(text: &str) -> Option<String> {
    let text: String =
        text.chars().filter(|letter| !letter.is_control() && !"\"\\".contains(*letter)).collect();
    (!text.trim().is_empty()).then(|| format!("text = \"{}\"", text.trim()))
}

/// The words of a code, as a key of its line; none if it has none.
pub(super) fn in_braces(words: &[String]) -> Option<String> {
    (!words.is_empty()).then(|| format!("words = {{ {} }}", words.join(", ")))
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Profile, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    fn asked(text: &str, profile: &str) -> String {
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let source = Control::from_profile(profile).unwrap();
        let target = Control::from_profile("dialect = \"haas\"\nmachine = \"mill\"\n").unwrap();
        filled(&survey(&inputs, &source, Some(&target)), Side::Source, Some(profile)).unwrap()
    }

    const PLAIN: &str = "dialect = \"fanuc\"\nmachine = \"mill\"\n";

    /// On and off are one line with an answer each; codes that no program has both of are two.
    #[test]
    fn two_codes_of_one_program_with_numbers_beside_each_other_share_a_line() {
        let text = "O1\nG21 G90\nM110 (CLAMP)\nG0 X1.\nM111\nM60\nM30\nO2\nM61\nM30\n";
        let text = asked(text, PLAIN);
        let line =
            "#? \"M110, M111\" = { target = \", \" } # a.nc:3; as in: M110 (CLAMP); a.nc:5; as in: M111";
        assert!(text.lines().any(|found| found == line), "{text}");
        assert!(
            text.contains("#? M60 = { target = \"\"") && text.contains("#? M61 = { target = \"\""),
            "{text}"
        );
        let answered = text
            .replace("#? \"M110, M111\" = { target = \", \" }", "\"M110, M111\" = { target = \"M68, M69\" }");
        let profile = Profile::read(&answered).unwrap();
        let rows: Vec<_> =
            profile.site.iter().map(|row| (row.code.as_str(), row.target.as_deref())).collect();
        assert_eq!(rows, [("M110", Some("M68")), ("M111", Some("M69"))]);
    }

    /// On, back and off of a live tool: nobody can tell which two belong together. Of four in a row there are two pairs.
    #[test]
    fn three_codes_in_a_row_are_no_pair() {
        let three = asked("O1\nG21 G90\nM143\nG0 X1.\nM144\nM145\nM30\n", PLAIN);
        for code in ["M143", "M144", "M145"] {
            assert!(three.contains(&format!("#? {code} = {{ target = \"\"")), "{three}");
        }
        let four = asked("O1\nG21 G90\nM143\nG0 X1.\nM144\nM145\nM146\nM30\n", PLAIN);
        assert!(four.contains("#? \"M143, M144\"") && four.contains("#? \"M145, M146\""), "{four}");
    }

    #[test]
    fn a_line_of_two_codes_names_two_of_each() {
        let read = |line: &str| Profile::read(&format!("{PLAIN}[codes]\n{line}\n"));
        assert_eq!(read("\"M10, M11\" = { do = \"omit\" }").unwrap().site.len(), 2);
        let named = read("\"M10, M11\" = { name = \"chuck.on, chuck.off\", text = \"chuck, air\" }").unwrap();
        assert_eq!(named.site[1].name.as_deref(), Some("chuck.off"));
        assert_eq!(named.site[0].text, "chuck, air");
        let faults = read("\"M10, M11\" = { target = \"M68\" }").unwrap_err();
        assert!(faults[0].message.contains("is 2 codes, and 'target' names 1"), "{faults:?}");
    }

    /// Many codes, and a program that one of them may call: the parameter is asked, and no code by itself.
    #[test]
    fn the_parameter_that_gives_a_program_its_code_is_asked_once() {
        let text = "O1\nG21 G90\nM110\nM111\nM60\nM84\nG0 X1.\nM30\nO9020\nM99\n";
        let text = asked(text, PLAIN);
        assert!(
            text.contains("#? 6080 = \"\" # number of the M code that calls O9020, 0 if none does"),
            "{text}"
        );
        assert!(!text.contains("calls =") && text.contains("#? \"M110, M111\" = {"), "{text}");
        let answered = text.replace("#? 6080 = \"\"", "6080 = \"60\"");
        let again = asked("O1\nG21 G90\nM110\nM111\nM60\nM84\nG0 X1.\nM30\nO9020\nM99\n", &answered);
        assert!(!again.contains("M60 =") && again.contains("M84 ="), "{again}");
    }
}
