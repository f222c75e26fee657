//! Questions that an earlier survey of another library left in a profile: two old machines may go to one new one.

use super::filled::ASKS;
use super::unseen;
use std::collections::BTreeMap;

/// The sections whose questions stay.
const SECTIONS: [&str; 4] = [unseen::SECTION, "behaviours", "settings", "parameters"];

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
        assert_eq!(asked["confirm"], "#? \"code:M60\", # a brake (2 programs: A.NC:1, A.NC:7)\n");
        let kept = asked["behaviours"].lines().nth(1);
        assert_eq!(kept, Some(r#"#? "rotary.way" = "turns" # how (A.NC:3)"#));
        assert!(!asked.contains_key("start"));
    }
}
