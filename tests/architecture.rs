//! The rules of the house, as `docs/ARCHITECTURE.md` states them.

#[path = "support/files.rs"]
mod files;
#[path = "support/imports.rs"]
mod imports;
mod support;

use files::files;
use imports::{imports, module_of};
use macroglot::dialect::registry;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;
use support::{root, rust_files, text};

/// The rooms from left to right: none imports from one further right. `dialect::registry` stands
/// outside, because it is the list of what each dialect has in every room.
const ROOMS: &[&str] = &[
    "text", "canon", "assume", "diag", "dialect", "syntax", "ir", "lower", "opt", "legalize", "emit",
    "control", "verify", "library", "lint", "diff", "check", "report", "survey", "cli",
];

/// The rooms inside folders, from left to right: none imports from one further right, nor what the folder offers others.
const INNER: &[(&str, &[&str])] = &[
    ("src/verify", &["sides", "compare", "explore", "certificate", "entry", "triage", "driver"]),
    ("src/lower/fadal", &["codes", "flow", "build", "macros", "words", "program"]),
    ("src/lower/macro_b", &["codes", "parts", "build", "expressions", "words", "flow", "program"]),
];

const REGISTRY: &str = "src/dialect/registry.rs";

const LIMIT: usize = 400;

/// Where a dialect, or a family of them, may be named: its own module of a room that has one.
fn may_name_dialects(path: &str) -> bool {
    let own = registry::all().iter().map(|entry| entry.name).chain(["macro_b"]);
    let mut rooms = ["syntax", "lower", "emit", "control"].iter();
    let names: Vec<&str> = own.collect();
    path == REGISTRY
        || rooms.any(|room| {
            let Some(rest) = path.strip_prefix(&format!("src/{room}/")) else { return false };
            names.iter().any(|name| rest == format!("{name}.rs") || rest.starts_with(&format!("{name}/")))
        })
}

/// A module's declaration in its room names the dialect, and nothing else in that line does.
fn declares(line: &str, name: &str) -> bool {
    let line = line.trim();
    [format!("pub mod {name};"), format!("mod {name};"), format!("pub(crate) mod {name};")]
        .iter()
        .any(|d| d == line)
}

#[test]
fn only_its_own_modules_name_a_dialect() {
    let mut found = Vec::new();
    for (path, source) in rust_files("src") {
        if may_name_dialects(&path) || is_test(&path) {
            continue;
        }
        for (number, line) in without_tests(&source).lines().enumerate() {
            let lower = line.to_lowercase();
            for entry in registry::all() {
                if lower.contains(entry.name) && !declares(line, entry.name) {
                    found.push(format!("{path}:{}: {}", number + 1, line.trim()));
                }
            }
        }
    }
    assert!(found.is_empty(), "dialects are named outside their modules:\n{}", found.join("\n"));
}

/// The rooms that hold no spelling of a control: they ask its table.
const SPELL_NOTHING: &[&str] = &[
    "src/legalize/",
    "src/verify/",
    "src/library/",
    "src/lint/",
    "src/diff/",
    "src/check/",
    "src/report/",
    "src/opt/",
];

/// Where a sign that is also a name of variables or programs stands for something else.
const OTHER_SIGNS: &[(&str, &str)] = &[
    ("src/legalize/operator/letters.rs", "signs of texts: what stands behind the sign of a diameter"),
    ("src/legalize/operator/questions.rs", "signs of texts that formatted output reads as something else"),
    ("src/verify/compare/letters.rs", "letters of texts, as operators read them"),
    ("src/verify/compare/texts.rs", "signs of texts that read alike"),
    ("src/library/accepted/edit.rs", "the sign of a comment in a project file"),
    ("src/report/markdown.rs", "the sign of a heading"),
    ("src/report/html/mod.rs", "a number of a character, and the sign of a link in a page"),
    ("src/report/plot.rs", "colours"),
    ("src/report/plot/legend.rs", "colours"),
    ("src/report/plot/pair.rs", "colours"),
    ("src/report/plot/view.rs", "colours"),
];

#[test]
fn shared_rooms_spell_no_names_and_no_flow() {
    let (sigils, words) = spellings();
    let mut found = Vec::new();
    let files = rust_files("src").into_iter().filter(|(path, _)| {
        let shared = SPELL_NOTHING.iter().any(|room| path.starts_with(room));
        shared && !is_test(path) && !OTHER_SIGNS.iter().any(|(other, _)| path == other)
    });
    for (path, source) in files {
        for (number, line) in without_tests(&source).lines().enumerate() {
            let all = literals(code_of(line));
            if all.iter().any(|literal| spells(literal, &sigils, &words)) {
                found.push(format!("{path}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    assert!(
        found.is_empty(),
        "ask the control's table (`names`, `variables`, `forms`):\n{}",
        found.join("\n")
    );
}

/// The names before numbers of variables and programs, and the words that stand beside operands, of all controls.
fn spellings() -> (BTreeSet<String>, BTreeSet<String>) {
    let (mut sigils, mut found) = (BTreeSet::new(), BTreeSet::new());
    for dialect in registry::all().iter().filter_map(|entry| entry.dialect().ok()) {
        sigils.extend(dialect.variables.iter().map(|row| row.name.clone()));
        sigils.extend(dialect.names.program.iter().chain(&dialect.names.numbered).cloned());
        for written in dialect.forms.iter().map(|row| row.written.as_str()) {
            let words =
                words(written).into_iter().map(|word| word.trim_end_matches(|c: char| c.is_ascii_digit()));
            let is_word =
                |word: &&str| word.len() > 1 && word.bytes().all(|letter| letter.is_ascii_uppercase());
            found.extend(words.filter(is_word).map(str::to_owned));
        }
    }
    (sigils, found)
}

/// True for a literal that is a name before numbers, has one before a number, or has a word of a statement.
fn spells(literal: &str, sigils: &BTreeSet<String>, statements: &BTreeSet<String>) -> bool {
    let numbered = |sigil: &String| {
        literal.match_indices(sigil.as_str()).any(|(at, _)| {
            let before = literal[..at].chars().next_back();
            let behind = literal[at + sigil.len()..].chars().next();
            !before.is_some_and(|c| c.is_alphanumeric() || matches!(c, '{' | ':'))
                && behind.is_some_and(|c| c == '{' || c.is_ascii_digit())
        })
    };
    sigils.contains(literal)
        || sigils.iter().any(numbered)
        || words(literal).iter().any(|word| statements.contains(*word))
}

/// The texts and characters that stand in a line of code.
fn literals(line: &str) -> Vec<String> {
    let signs: Vec<char> = line.chars().collect();
    let (mut out, mut at) = (Vec::new(), 0);
    while at < signs.len() {
        let quote = signs[at];
        let is_char = quote == '\'' && (signs.get(at + 2) == Some(&'\'') || signs.get(at + 1) == Some(&'\\'));
        at += 1;
        if quote != '"' && !is_char {
            continue;
        }
        let start = at;
        while at < signs.len() && signs[at] != quote {
            at += if signs[at] == '\\' { 2 } else { 1 };
        }
        out.push(signs[start..at.min(signs.len())].iter().collect());
        at += 1;
    }
    out
}

#[test]
fn rooms_import_from_the_left_only() {
    let mut found = Vec::new();
    for (path, source) in rust_files("src") {
        let room = path.trim_start_matches("src/").split(['/', '.']).next().unwrap_or_default();
        let Some(at) = ROOMS.iter().position(|name| *name == room) else { continue };
        if path == REGISTRY || is_test(&path) {
            continue;
        }
        for (number, line) in without_tests(&source).lines().enumerate() {
            for (right, other) in ROOMS.iter().enumerate().skip(at + 1) {
                let imports = code_of(line).contains(&format!("crate::{other}::"))
                    || code_of(line).contains(&format!("crate::{other};"))
                    || code_of(line).contains("use crate::{") && words(line).contains(other);
                if imports {
                    let rank = format!("{room} is left of {}", ROOMS[right]);
                    found.push(format!("{path}:{}: {} ({rank})", number + 1, line.trim()));
                }
            }
        }
    }
    assert!(found.is_empty(), "imports from the right:\n{}", found.join("\n"));
}

#[test]
fn inner_rooms_import_from_the_left_only() {
    let mut found = Vec::new();
    for (folder, rooms) in INNER {
        for (path, source) in rust_files(folder).into_iter().filter(|(path, _)| !is_test(path)) {
            let inside = path.trim_start_matches(folder).trim_start_matches('/');
            let Some((room, _)) = inside.split_once('/') else {
                assert_eq!(inside, "mod.rs", "{path} stands in no room");
                continue;
            };
            let at = rooms.iter().position(|name| *name == room);
            let at = at.unwrap_or_else(|| panic!("{folder}/{room} has no place in the order"));
            for (line, import) in imports(&path, &without_comments(&without_tests(&source))) {
                let Some(rest) = import.strip_prefix(module_of(folder).as_slice()) else { continue };
                let other = rest.first().map_or("mod.rs", String::as_str);
                if !rooms[..=at].contains(&other) {
                    found.push(format!("{path}:{line}: {other}, which is not left of {room}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "imports from the right:\n{}", found.join("\n"));
}

#[test]
fn every_room_is_in_the_order() {
    let library = text("src/lib.rs");
    let modules = library.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
    for module in modules {
        assert!(ROOMS.contains(&module), "src/{module} has no place in the order");
    }
}

#[test]
fn files_are_one_room_each() {
    let long: Vec<String> = rust_files("src")
        .into_iter()
        .map(|(path, source)| (source.lines().count(), path))
        .filter(|(lines, _)| *lines > LIMIT)
        .map(|(lines, path)| format!("{path}: {lines} lines"))
        .collect();
    assert!(long.is_empty(), "over {LIMIT} lines:\n{}", long.join("\n"));
}

#[test]
fn nothing_in_src_panics_by_choice() {
    const WORDS: &[&str] =
        &[".unwrap()", ".expect(", "panic!(", "todo!(", "unimplemented!(", "unreachable!(", "#[ignore"];
    let mut found = Vec::new();
    for (path, source) in rust_files("src").into_iter().filter(|(path, _)| !is_test(path)) {
        for (number, line) in without_tests(&source).lines().enumerate() {
            if WORDS.iter().any(|word| code_of(line).contains(word)) {
                found.push(format!("{path}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    assert!(found.is_empty(), "src may not panic:\n{}", found.join("\n"));
}

/// Lines among which all dialects stand where a file lists them.
const ROW: usize = 7;

/// `docs/add-a-dialect.md` names every file and folder that dialects have by their names, and every file that lists them.
#[test]
fn the_page_of_steps_names_every_place_of_a_dialect() {
    let page = text("docs/add-a-dialect.md");
    let list = page.split_once("## Every place").expect("the page has the list").1;
    let told: BTreeSet<&str> = list
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|place| place.contains('/') || *place == "macroglot.toml")
        .collect();
    let names: Vec<&str> = registry::all().iter().map(|entry| entry.name).collect();
    let mut places: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for path in tracked() {
        for name in &names {
            if let Some(place) = place_of(&path, name) {
                places.entry(place).or_default().insert(name);
            }
        }
    }
    let shared = places.iter().filter(|(_, of)| of.len() > 1).map(|(place, _)| place.clone());
    let lists = tracked().into_iter().filter(|path| lists_all(path, &names));
    let missing: Vec<String> = shared.chain(lists).filter(|place| !told.contains(place.as_str())).collect();
    assert!(missing.is_empty(), "docs/add-a-dialect.md does not name:\n{}", missing.join("\n"));
    let is_there = |place: &str| places.contains_key(place) || root().join(place).exists();
    let gone: Vec<&str> = told.into_iter().filter(|place| !is_there(place)).collect();
    assert!(gone.is_empty(), "docs/add-a-dialect.md names what is not there: {gone:?}");
}

/// The place that a path is for any dialect: `grammar/NAME.pest`, or a module whether it is a file or a folder.
fn place_of(path: &str, name: &str) -> Option<String> {
    let is_word = |sign: Option<char>| sign.is_some_and(char::is_alphanumeric);
    let mut all = path.match_indices(name).map(|(at, _)| at);
    let at = all.find(|at| {
        let (before, after) = (&path[..*at], &path[at + name.len()..]);
        !is_word(before.chars().next_back()) && !is_word(after.chars().next())
    })?;
    let (before, after) = (&path[..at], &path[at + name.len()..]);
    let is_folder = after.starts_with('/') || path.starts_with("src/");
    // What is named for a machine or a pair is one of many.
    (!after.starts_with('-') && !before.ends_with('-'))
        .then(|| format!("{before}NAME{}", if is_folder { "" } else { after }))
}

/// True for a file of code or settings in which all dialects stand among a few lines.
fn lists_all(path: &str, names: &[&str]) -> bool {
    let is_code = [".rs", ".toml", ".py", "README.md"].iter().any(|ending| path.ends_with(ending))
        || path.starts_with(".ci/");
    let is_inside = path.contains('/') || path == "macroglot.toml";
    if !is_code || !is_inside || is_test(path) || path == "tests/architecture.rs" {
        return false;
    }
    let source = without_tests(&text(path));
    let lines: Vec<&str> = source.lines().collect();
    lines.windows(ROW.min(lines.len().max(1))).any(|row| {
        names.iter().all(|name| {
            row.iter().any(|line| line.split(|sign: char| !sign.is_alphanumeric()).any(|word| word == *name))
        })
    })
}

/// The files of the repository that a person keeps.
fn tracked() -> Vec<String> {
    const FOLDERS: &[&str] =
        &[".ci", "benches", "corpus", "dialects", "fuzz", "grammar", "machines", "src", "tests"];
    let kept = |folder: &&str| {
        let inside = files(&root().join(folder)).into_keys();
        inside.map(|name| format!("{folder}/{name}")).collect::<Vec<_>>()
    };
    let found = FOLDERS.iter().flat_map(kept).chain(["macroglot.toml".to_owned()]);
    let made = ["fuzz/corpus/", "fuzz/artifacts/", "fuzz/target/"];
    found
        .filter(|path| !made.iter().any(|folder| path.starts_with(folder)) && !path.contains("__pycache__"))
        .collect()
}

/// The rules themselves see what they are for.
#[test]
fn the_rules_have_teeth() {
    assert!(
        may_name_dialects("src/lower/fadal/words/block.rs") && may_name_dialects("src/emit/macro_b/mod.rs")
    );
    assert!(!may_name_dialects("src/legalize/fadal/x.rs") && !may_name_dialects("src/lower/common/mod.rs"));
    assert!(is_test("src/syntax/testing.rs") && !is_test("src/syntax/file.rs"));
    let line = r##"f("a\"b", 'c', b'"', x::<'t>('\'', "#"))"##;
    assert_eq!(literals(line), ["a\\\"b", "c", "\"", "\\'", "#"]);
    let (sigils, statements) = spellings();
    for literal in ["#", "V", "O", "leaves #{number}", "#100", "IF [] GOTO 99999", "THEN", "O{:04}"] {
        assert!(spells(literal, &sigils, &statements), "{literal}");
    }
    for literal in ["if", "V is", "NO.", "{name}(..)", "IO7"] {
        assert!(!spells(literal, &sigils, &statements), "{literal}");
    }
    assert_eq!(place_of("src/emit/haas.rs", "haas").as_deref(), Some("src/emit/NAME"));
    assert_eq!(place_of("grammar/haas.pest", "haas").as_deref(), Some("grammar/NAME.pest"));
    assert!(place_of("tests/conversions/fanuc-haas.toml", "haas").is_none());
    assert!(declares("pub mod fadal;", "fadal") && !declares("use super::fadal;", "fadal"));
    let tree = "use super::super::b::{C, d::{self, E}};\nlet x = crate::f::g(self::h::I, $crate::no);";
    let all = imports("src/a/k/l.rs", tree);
    let all: Vec<String> = all.iter().map(|(line, path)| format!("{line} {}", path.join("."))).collect();
    assert_eq!(all, ["1 a.b.C", "1 a.b.d.self", "1 a.b.d.E", "2 f.g", "2 a.k.l.h.I"]);
    assert_eq!(code_of("let a = 1; // .unwrap() is not code"), "let a = 1; ");
    assert_eq!(code_of(r#"let a = "https://x"; b"#), r#"let a = "https://x"; b"#);
    assert_eq!(without_tests("a\n#[cfg(test)]\nmod tests {\n    b\n}\nc\n"), "a\n\n\n\n\nc\n");
    assert_eq!(without_tests("#[cfg(test)]\nmod tests;\nc\n"), "\n\nc\n");
}

/// A file that only tests are built from: a module declared so, or one inside such a module.
fn is_test(path: &str) -> bool {
    static ROOTS: OnceLock<Vec<String>> = OnceLock::new();
    let roots = ROOTS.get_or_init(|| {
        let declared = |(path, source): (String, String)| {
            let folder = path.trim_end_matches(".rs").trim_end_matches("/mod").to_owned();
            let lines: Vec<&str> = source.lines().collect();
            let tested = (0..lines.len()).filter(|at| lines[*at] == "#[cfg(test)]").filter_map(|at| {
                let item = lines[at..].iter().find(|line| !line.starts_with('#'))?;
                item.split_once("mod ")?.1.strip_suffix(';').map(str::to_owned)
            });
            tested.map(|name| format!("{folder}/{name}")).collect::<Vec<_>>()
        };
        rust_files("src").into_iter().flat_map(declared).collect()
    });
    roots.iter().any(|root| path == format!("{root}.rs") || path.starts_with(&format!("{root}/")))
}

/// A source with its test modules and test items blanked; lines keep their numbers.
fn without_tests(source: &str) -> String {
    let mut out = String::new();
    let mut waiting = false;
    let mut inside = false;
    for line in source.lines() {
        if line == "#[cfg(test)]" {
            waiting = true;
        } else if waiting {
            waiting = false;
            inside = line.ends_with('{');
        } else if inside {
            inside = line != "}";
        } else {
            out.push_str(line);
        }
        out.push('\n');
    }
    out
}

/// A line without its comment.
fn code_of(line: &str) -> &str {
    let mut in_text = false;
    let bytes = line.as_bytes();
    for at in 0..bytes.len() {
        match bytes[at] {
            b'"' if at == 0 || bytes[at - 1] != b'\\' && bytes[at - 1] != b'\'' => in_text = !in_text,
            b'/' if !in_text && bytes.get(at + 1) == Some(&b'/') => return &line[..at],
            _ => {}
        }
    }
    line
}

/// A source without its comments; lines keep their numbers.
fn without_comments(source: &str) -> String {
    source.lines().map(|line| format!("{}\n", code_of(line))).collect()
}

fn words(line: &str) -> Vec<&str> {
    line.split(|sign: char| !sign.is_alphanumeric() && sign != '_').collect()
}
