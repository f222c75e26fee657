//! What a key takes, in words of the shop: the reader of TOML tells it in words of programmers.

/// What is wrong with a value of a machine profile, from what the reader of TOML says.
pub(super) fn in_words(message: &str) -> String {
    let quoted = |text: &str| text.trim_matches('`').replace('`', "'");
    if let Some((found, wanted)) = message.strip_prefix("unknown variant ").and_then(expected) {
        return format!("'{}' is no answer here: it is {}", quoted(found), listed(wanted));
    }
    if let Some((found, wanted)) = message.strip_prefix("unknown field ").and_then(expected) {
        return format!("unknown key '{}': this takes {}", quoted(found), listed(wanted));
    }
    if let Some(name) = message.strip_prefix("missing field ") {
        return format!("'{}' is missing here", quoted(name));
    }
    let found = ["invalid type: ", "invalid value: "].iter().find_map(|start| message.strip_prefix(start));
    let (found, wanted) = match (found.and_then(expected), message) {
        (Some((found, wanted)), _) => (Some(found.replace('`', "")), wanted),
        (None, "wanted string or table") => (None, "a string"),
        (None, _) => return message.replace('`', "'"),
    };
    let wanted = match wanted {
        "a sequence" => "a list, as [\"X\", \"Y\"]",
        "a string" | "path string" => "a text in quotes",
        "a boolean" => "true or false, without quotes",
        "u32" | "u64" | "usize" | "u8" | "u16" => "a whole number that is not negative",
        "a map" => "a table",
        other => other,
    };
    match found {
        Some(found) => format!("{wanted} must stand here, not {found}"),
        None => format!("{wanted} must stand here"),
    }
}

fn expected(text: &str) -> Option<(&str, &str)> {
    text.split_once(", expected ")
}

/// `` one of `a`, `b`, `c` `` and `` `a` or `b` `` as a list in words.
fn listed(wanted: &str) -> String {
    let all: Vec<&str> = wanted.split('`').skip(1).step_by(2).collect();
    match all.split_last() {
        None => wanted.to_owned(),
        Some((last, [])) => format!("\"{last}\""),
        Some((last, others)) => format!("\"{}\" or \"{last}\"", others.join("\", \"")),
    }
}

/// What to do about a text that is not TOML; `line` is the one where the reader stopped.
pub(super) fn as_toml(message: &str, line: &str) -> &'static str {
    if message == "duplicate key" {
        return "write each key once: keep the line that is right";
    }
    // A question of a survey whose sign was taken away, with its choice still in it.
    let is_choice = |line: &str| line.contains("\" or \"") || line.contains("true or false");
    if is_choice(line.split('#').next().unwrap_or_default()) {
        return "of the values of a question one stays: units = \"inch\"";
    }
    if line.contains(['\u{201c}', '\u{201d}', '\u{201e}', '\u{2018}', '\u{2019}']) {
        return "write straight quotes: \"metric\"";
    }
    "write it as TOML: name = \"text\", name = 5, name = true, or name = [\"a\", \"b\"]"
}

#[cfg(test)]
mod tests {
    use super::{as_toml, in_words};

    #[test]
    fn faults_are_told_in_words_of_the_shop() {
        for (told, words) in [
            (
                "unknown variant `metrisch`, expected `inch` or `metric`",
                "'metrisch' is no answer here: it is \"inch\" or \"metric\"",
            ),
            (
                "unknown variant ``, expected one of `X`, `Y`, `Z`",
                "'' is no answer here: it is \"X\", \"Y\" or \"Z\"",
            ),
            ("unknown variant `drop`, expected `omit`", "'drop' is no answer here: it is \"omit\""),
            (
                "unknown field `nam`, expected `code` or `name`",
                "unknown key 'nam': this takes \"code\" or \"name\"",
            ),
            ("missing field `text`", "'text' is missing here"),
            (
                "invalid type: string \"XYZ\", expected a sequence",
                "a list, as [\"X\", \"Y\"] must stand here, not string \"XYZ\"",
            ),
            (
                "invalid value: integer `-5`, expected u32",
                "a whole number that is not negative must stand here, not integer -5",
            ),
            ("wanted string or table", "a text in quotes must stand here"),
            ("something else", "something else"),
        ] {
            assert_eq!(in_words(told), words);
        }
    }

    #[test]
    fn what_to_do_fits_the_line() {
        assert!(as_toml("duplicate key", "a = 1").starts_with("write each key once"));
        assert!(as_toml("unexpected", "units = \"inch\" or \"metric\" # why").starts_with("of the values"));
        assert!(as_toml("unexpected", "units = \u{201c}metric\u{201d}").starts_with("write straight"));
        assert!(as_toml("unexpected", "units = # \"a\" or \"b\"").starts_with("write it as TOML"));
    }
}
