//! Names of variables in texts that people read.

use std::ops::Range;

/// From this many digits on a number beside a sign names a variable: nobody counts tools or holes so far.
const MANY_DIGITS: usize = 3;

/// What stands before other numbers too: a radius (`A CORNER OF R5`), what is counted (`PARTS IN #2 VISE`).
const OTHERWISE: &[&str] = &["R", "#"];

/// Words before a name that stand before variables alone.
const BEFORE: &[&str] =
    &["SET", "ENTER", "VARIABLE", "VARIABLES", "VAR", "REGISTER", "MACRO", "IF", "WHEN", "EDIT", "USES"];

/// Those that stand before the values of a drawing too, and not before what is counted.
const BEFORE_VALUES: &[&str] = &[
    "IN", "INTO", "TO", "CHECK", "CHANGE", "USE", "VALUE", "OF", "BY", "FROM", "LESS", "THAN", "EQ", "NE",
    "GT", "LT", "GE", "LE",
];

/// Words after a name that stand after variables alone.
const AFTER: &[&str] = &["HOLDS", "MISSING", "VACANT", "NULL"];

/// Those that say something of any value.
const AFTER_VALUES: &[&str] = &["IS", "ARE", "EQ", "NE", "GT", "LT", "GE", "LE", "MUST", "NOT"];

/// What may be the name of a variable in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct VariableName {
    /// Where it stands.
    pub at: Range<usize>,
    /// What stands before the number.
    pub prefix: String,
    /// Its number.
    pub number: u32,
    /// True where the text leaves no doubt that a variable is meant: `#500`, `SET #5`, `V5 = DEPTH`; not `TOOL #5`.
    pub sure: bool,
}

/// The names of variables in a text, where these stand before their numbers: `#`, `V`.
pub fn variable_names(text: &str, prefixes: &[&str]) -> Vec<VariableName> {
    let mut out = Vec::new();
    let may_begin = |sign: char| {
        let mut firsts = prefixes.iter().filter_map(|prefix| prefix.chars().next());
        firsts.any(|first| first.eq_ignore_ascii_case(&sign))
    };
    // Stops and messages are read at each run of a program: most signs are passed by at a glance.
    for (at, sign) in text.char_indices().filter(|(_, sign)| may_begin(*sign)) {
        let before = text.get(..at).unwrap_or_default();
        if before.ends_with(|sign: char| sign.is_alphanumeric() || sign == '_') {
            continue;
        }
        let digits_of = |prefix: &str| {
            let head = text.get(at..at + prefix.len())?;
            let rest = text.get(at + prefix.len()..)?;
            let digits = rest.len() - rest.trim_start_matches(|sign: char| sign.is_ascii_digit()).len();
            (head.eq_ignore_ascii_case(prefix) && digits > 0).then(|| rest.split_at(digits))
        };
        let read = prefixes
            .iter()
            .filter(|prefix| !prefix.is_empty())
            .find_map(|prefix| Some((prefix, digits_of(prefix)?)));
        let Some((prefix, (digits, rest))) = read else { continue };
        let goes_on = rest.starts_with(|sign: char| sign.is_alphanumeric() || sign == '_')
            || rest
                .strip_prefix('.')
                .is_some_and(|rest| rest.starts_with(|sign: char| sign.is_ascii_digit()));
        let Ok(number) = digits.parse::<u32>() else { continue };
        if goes_on || sign.is_ascii_digit() {
            continue;
        }
        let is_one = digits.trim_start_matches('0').len() >= MANY_DIGITS || told(before, rest, prefix);
        let sure = is_one && !counts(before, rest, prefix);
        let at = at..at + prefix.len() + digits.len();
        out.push(VariableName { at, prefix: (*prefix).to_owned(), number, sure });
    }
    out
}

/// The variable that an operator sets who reads this: the first that the text names for sure, or begins with.
pub fn variable_to_set(text: &str, prefixes: &[&str]) -> Option<VariableName> {
    // What stands for an alarm asks nothing.
    if text.trim_start().starts_with("ALARM ") {
        return None;
    }
    let start = text.len() - text.trim_start().trim_start_matches("SET ").len();
    variable_names(text, prefixes).into_iter().find(|name| name.sure || name.at.start == start)
}

/// True where what stands beside a name says that it is one.
fn told(before: &str, rest: &str, prefix: &str) -> bool {
    let is_word = |sign: char| sign.is_alphanumeric();
    let last = before.trim_end().rsplit(|sign| !is_word(sign)).next().unwrap_or_default();
    let next = rest.trim_start().split(|sign| !is_word(sign)).next().unwrap_or_default();
    let among = |words: &[&str], word: &str| words.iter().any(|known| known.eq_ignore_ascii_case(word));
    let sure = rest.trim_start().starts_with(['=', '<', '>']) || among(BEFORE, last) || among(AFTER, next);
    let otherwise = among(OTHERWISE, prefix);
    sure || (!otherwise && (among(BEFORE_VALUES, last) || among(AFTER_VALUES, next)))
}

/// True at the ends of a range (`#500-#510`): of what lies between nothing is known.
fn counts(before: &str, rest: &str, prefix: &str) -> bool {
    let after = rest.trim_start();
    let to = ["-", "..", "TO ", "THRU ", "THROUGH "].iter().find_map(|word| after.strip_prefix(word));
    let leads = to.is_some_and(|rest| {
        rest.trim_start().starts_with(|c: char| c.is_ascii_digit()) || rest.trim_start().starts_with(prefix)
    });
    let earlier = before.trim_end();
    let led = ["-", "..", " TO", " THRU", " THROUGH"].iter().find_map(|word| earlier.strip_suffix(word));
    let led = led.is_some_and(|text| {
        let word = text.trim_end().rsplit(' ').next().unwrap_or_default();
        word.starts_with(prefix) && word.ends_with(|sign: char| sign.is_ascii_digit())
    });
    leads || led
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sure(text: &str) -> Vec<(String, bool)> {
        let names = variable_names(text, &["#", "V", "R"]);
        names.iter().map(|name| (format!("{}{}", name.prefix, name.number), name.sure)).collect()
    }

    #[test]
    fn names_are_told_from_what_is_counted() {
        let one = |text: &str, name: &str, is_sure: bool| {
            assert_eq!(sure(text), [(name.to_owned(), is_sure)], "{text}");
        };
        one("SET #500 BEFORE START", "#500", true);
        one("#101 IS NULL", "#101", true);
        one("set #5 first", "#5", true);
        one("V5 = DEPTH", "V5", true);
        one("DEPTH IN V05", "V5", true);
        one("TOOL #5", "#5", false);
        one("OP #1 OF 3", "#1", false);
        one("R5 BALL NOSE", "R5", false);
        one("A CORNER OF R5", "R5", false);
        one("R5 IS THE FILLET", "R5", false);
        one("SET R5 FIRST", "R5", true);
        one("R9=ABSOLUTE Z DEPTH", "R9", true);
        one("A VALUE OF V5", "V5", true);
        one("PARTS IN #2 VISE", "#2", false);
        one("#1 OF 3 HOLES", "#1", false);
    }

    #[test]
    fn other_signs_are_no_names() {
        for text in ["#", "# 500", "V", "REV5", "#5A", "V5.2", "X500", "5#", "#99999999999", "É#"] {
            assert_eq!(sure(text), [], "{text}");
        }
    }

    #[test]
    fn ends_of_a_range_are_left_open() {
        assert_eq!(sure("#500-#510 ARE SIZES"), [("#500".into(), false), ("#510".into(), false)]);
        assert_eq!(sure("#500 TO #510"), [("#500".into(), false), ("#510".into(), false)]);
        assert_eq!(sure("#500 AND #510"), [("#500".into(), true), ("#510".into(), true)]);
    }
}
