//! Questions that an earlier survey of another library left in a profile: two old machines may go to one new one.

use super::filled::{ASKS, TELLS};
use super::unseen;
use std::collections::BTreeMap;

/// The sections whose questions stay.
const SECTIONS: [&str; 5] = [unseen::SECTION, "behaviours", "settings", "parameters", super::speeds::SECTION];

/// Puts questions of other libraries after those of this one, unless it asks the same. `is_here` is true for a file of this library.
pub(super) fn others(old: &str, is_here: &dyn Fn(&str) -> bool, asked: &mut BTreeMap<&'static str, String>) {
    let mut section = None;
    for line in old.lines() {
        let trimmed = line.trim();
        if let Some(rest) = trimmed.strip_prefix('[') {
            section = SECTIONS.into_iter().find(|name| rest.split(']').next() == Some(name));
        } else if trimmed.starts_with("confirm") && trimmed.ends_with('[') {
            section = Some("confirm");
        } else if section == Some("confirm") && trimmed.starts_with(']') {
            section = None;
        }
        let Some(section) = section else { continue };
        let told = unseen::single(trimmed).filter(|_| section == unseen::SECTION);
        let trimmed = told.as_deref().unwrap_or(trimmed);
        if !trimmed.starts_with(ASKS) {
            continue;
        }
        let files = files(trimmed);
        if files.is_empty() || files.iter().all(|file| is_here(file)) {
            continue;
        }
        let lines = asked.entry(section).or_default();
        if !lines.lines().any(|own| key(own) == key(trimmed)) {
            lines.push_str(trimmed);
            lines.push('\n');
        }
    }
}

/// The lines of the codes of a machine's builder, with those of other libraries after them.
pub(super) fn codes(old: &str, is_here: &dyn Fn(&str) -> bool, mut own: String) -> String {
    let mut in_codes = false;
    for line in old.lines().map(str::trim) {
        if let Some(rest) = line.strip_prefix('[') {
            in_codes = rest.split(']').next() == Some(super::site_rows::SECTION);
        }
        let Some((row, about)) = line.split_once(" # ").filter(|_| in_codes && line.starts_with(ASKS)) else {
            continue;
        };
        let words = about.split([' ', ',', ';']).filter_map(|word| word.rsplit_once(':'));
        let mut files =
            words.filter(|(_, line)| line.parse::<u32>().is_ok()).map(|(file, _)| file).peekable();
        if files.peek().is_none() || files.all(is_here) || own.lines().any(|own| own.starts_with(row)) {
            continue;
        }
        if own.is_empty() {
            own = format!(
                "{TELLS} What another library asks of the codes of this machine: docs/builders-codes.md.\n"
            );
        }
        own.push_str(line);
        own.push('\n');
    }
    own
}

/// What a question asks for: the key, or the fact in its quotes.
fn key(line: &str) -> &str {
    let rest = line.trim_start().trim_start_matches(ASKS).trim_start();
    let end = rest.find(" = ").or_else(|| rest.find("\",")).unwrap_or(rest.len());
    rest.get(..end).unwrap_or(rest).trim_matches('"')
}

/// The files that its places name, in the brackets at its end.
fn files(line: &str) -> Vec<&str> {
    let Some((_, places)) = line.strip_suffix(')').and_then(|line| line.rsplit_once('(')) else {
        return Vec::new();
    };
    let places = places.split_once("programs: ").map_or(places, |(_, places)| places);
    places.split(", ").filter_map(|place| place.rsplit_once(':')).map(|(file, _)| file).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn questions_of_another_library_stay_and_those_of_this_one_are_asked_anew() {
        let old = r#"dialect = "fanuc"
confirm = [
#: "code:M60": a brake (2 programs: A.NC:1, A.NC:7)
#: "code:M61": another (B.NC:2)
#? "code:M60", "code:M61",
]

[behaviours]
#? "rotary.way" = "turns" # how (A.NC:3)
#? "change.ends" = true # what (A.NC:4)
[start]
#? codes = "G0" # (A.NC:1)
"#;
        let mut asked =
            BTreeMap::from([("behaviours", "#? \"change.ends\" = true # what (B.NC:9)\n".to_owned())]);
        others(old, &|file| file == "B.NC", &mut asked);
        assert_eq!(
            asked["confirm"],
            r##"#? "code:M60", # a brake (2 programs: A.NC:1, A.NC:7)
"##
        );
        let kept = asked["behaviours"].lines().nth(1);
        assert_eq!(kept, Some(r#"#? "rotary.way" = "turns" # how (A.NC:3)"#));
        assert!(!asked.contains_key("start"));
    }

    #[test]
    fn codes_of_another_library_stay_too() {
        let probe = "#? \"\" = { op = \"probe.on\" } # M64 of the source; A.NC:8";
        let old = format!(
            "[codes]\n{probe}\n#? M18 = {{ target = \"\" }} # 2 programs: B.NC:1, B.NC:2; as in: M18\n[start]\n{probe}\n"
        );
        let is_here = |file: &str| file == "B.NC";
        let alone = codes(&old, &is_here, String::new());
        assert!(
            alone.starts_with(TELLS) && alone.lines().count() == 2 && alone.ends_with(&format!("{probe}\n"))
        );
        let own = format!("{}\n", probe.replace("A.NC:8", "B.NC:9"));
        assert_eq!(codes(&old, &is_here, own.clone()), own);
    }
}
