//! The catalogue of diagnostics: in order, in use, and the page made from it fresh.

mod support;

use macroglot::diag::{ALL, Code, Severity};
use std::collections::BTreeSet;
use std::fmt::Write;
use support::{assert_fresh, rust_files};

const SECTIONS: [&str; 9] = [
    "Text and syntax",
    "Dialects and machine profiles",
    "Lowering",
    "Legalization",
    "Emission",
    "Libraries and projects",
    "The command line",
    "Emulated controls and verification",
    "Checks",
];

#[test]
fn numbers_are_in_order_and_stand_once() {
    for pair in ALL.windows(2) {
        assert!(pair[0].number() < pair[1].number(), "{} before {}", pair[0].number(), pair[1].number());
    }
    let names: BTreeSet<&str> = ALL.iter().map(|code| code.title()).collect();
    assert_eq!(names.len(), ALL.len(), "two codes have one title");
}

#[test]
fn every_code_is_found_by_its_number() {
    for code in ALL {
        assert_eq!(Code::find(code.number()), Some(*code));
        assert_eq!(Code::find(&code.number().to_lowercase()), Some(*code));
        assert_eq!(Code::find(&code.number()[2..]), Some(*code));
    }
    assert_eq!(Code::find("MG9999"), None);
    assert_eq!(Code::find(""), None);
}

#[test]
fn every_code_is_used() {
    let sources: Vec<(String, String)> =
        rust_files("src").into_iter().filter(|(path, _)| !path.starts_with("src/diag/codes/")).collect();
    let text: String = sources.into_iter().map(|(_, source)| source).collect();
    let used: BTreeSet<&str> = text
        .match_indices("Code::")
        .map(|(at, head)| text[at + head.len()..].split(|c: char| !c.is_alphanumeric()).next().unwrap())
        .collect();
    let dead: Vec<String> = ALL
        .iter()
        .filter(|code| !used.contains(format!("{code:?}").as_str()))
        .map(|code| format!("{} {code:?}", code.number()))
        .collect();
    assert!(dead.is_empty(), "nothing finds these: {dead:?}");
}

#[test]
fn titles_are_words_and_pages_are_sentences() {
    for code in ALL {
        let (title, page) = (code.title(), code.page());
        assert!(!title.ends_with('.') && title.len() <= 60, "{}: {title}", code.number());
        assert!(page.trim() == page && page.ends_with(['.', '`', ')']), "{}: {page}", code.number());
    }
}

#[test]
fn the_page_is_fresh() {
    let mut out = String::from(
        "# Diagnostics\n\nWritten from `src/diag/codes/` by `UPDATE=1 cargo test --test catalogue`. \
         `macroglot explain CODE` prints one of them.\n\n\
         - **error**: the program is refused.\n\
         - **review**: the program is converted for review; a person must look at the place.\n\
         - **note**: the outcome stands.\n",
    );
    let mut section = "";
    for code in ALL {
        let number = &code.number()[2..];
        let here = SECTIONS[number[..2].parse::<usize>().unwrap() - 1];
        if here != section {
            let _ = write!(out, "\n## {here}\n");
            section = here;
        }
        let severity = match code.severity() {
            Severity::Error => "error",
            Severity::Review => "review",
            Severity::Note => "note",
        };
        let _ = write!(out, "\n### {}: {}\n\n*{severity}*\n\n{}\n", code.number(), code.title(), code.page());
    }
    assert_fresh("docs/diagnostics.md", &out);
}
