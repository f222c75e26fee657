//! Tables that extend others.

use super::table;
use crate::dialect::{Base, Dialect, faults_of_files, load};

const BASE: &str = r#"name = "family"
title = "Family"
limits = [
  { name = "brackets", max = 5, source = { test = "page 1", other = "page 2" } },
  { name = "message", max = 9, source = { other = "page 3" } },
  { name = "do.depth", max = 3, source = { test = { source = "page 4", confirmed = false, note = "told" }, other = "page 5" } },
]
codes = [
  { code = "M6", op = "tool.change", source = { test = "page 6" } },
]
"#;

fn loaded(rows: &str, bases: &[Base<'_>]) -> Result<Dialect, String> {
    let text = table(rows);
    let mut files = vec![("t.toml", text.as_str())];
    files.extend(bases.iter().map(|base| (base.file, base.text)));
    load(&text, bases).map_err(|faults| faults_of_files(&files, &faults))
}

fn base(text: &str) -> Base<'_> {
    Base { name: "family", file: "family.toml", text, document: None }
}

/// With a row of `limits` in the base's place of BASE.
fn with(row: &str) -> String {
    format!("name = \"family\"\ntitle = \"Family\"\nlimits = [\n  {row},\n]\n")
}

#[track_caller]
fn refused(rows: &str, text: &str, expected: &str) {
    let faults = loaded(rows, &[base(text)]).map(|_| ()).unwrap_err();
    assert!(faults.contains(expected), "expected '{expected}' in:\n{faults}");
}

const EXTENDS: &str = "extends = \"family\"\n";

#[test]
fn a_row_has_the_source_of_the_control_that_extends() {
    let dialect = loaded(EXTENDS, &[base(BASE)]).unwrap();
    let limit = |name: &str| {
        let row = dialect.limits.iter().find(|row| row.name == name).unwrap();
        (row.max, row.origin.source.as_str(), row.origin.is_confirmed(), row.origin.table.as_deref())
    };
    assert_eq!(limit("brackets"), (Some(5), "page 1", true, Some("family")));
    assert_eq!(limit("do.depth"), (Some(3), "page 4", false, Some("family")));
    // What another control's manual says is nothing that this one's does.
    assert_eq!(limit("message"), (Some(9), "another control", false, Some("family")));
    let note = dialect.limits.iter().find(|row| row.name == "message").unwrap().origin.note.clone();
    assert_eq!(note.as_deref(), Some("known of other, and no source of test says so"));
}

#[test]
fn a_row_stands_for_that_of_the_base() {
    let rows = format!(
        "{EXTENDS}limits = [{{ name = \"brackets\", max = 7, source = \"page 9\" }}]\nwithout = [\"code:M6\"]"
    );
    let dialect = loaded(&rows, &[base(BASE)]).unwrap();
    let limits: Vec<(&str, Option<u32>)> =
        dialect.limits.iter().map(|row| (row.name.as_str(), row.max)).collect();
    assert_eq!(limits, [("message", Some(9)), ("do.depth", Some(3)), ("brackets", Some(7))]);
    assert!(dialect.codes.is_empty());
    assert!(loaded("", &[base(BASE)]).unwrap().limits.is_empty());
}

#[test]
fn rows_under_another_condition_stand_beside_that_of_the_base() {
    let text = "name = \"family\"\ntitle = \"F\"\ncodes = [\n  { code = \"G99\", op = \"return.r\", machine = \"mill\", source = { test = \"p\" } },\n]\n";
    let rows = format!(
        "{EXTENDS}codes = [{{ code = \"G99\", op = \"feed.per.turn\", machine = \"lathe\", source = \"s\" }}]"
    );
    assert_eq!(loaded(&rows, &[base(text)]).unwrap().codes.len(), 2);
    // Without a condition it would hold beside the base's.
    let rows = rows.replace(", machine = \"lathe\"", "");
    refused(&rows, text, "t.toml:2:10: MG0202: G99 stands twice");
}

#[test]
fn refuses_what_cannot_be_extended() {
    refused(
        "extends = \"familie\"",
        BASE,
        "t.toml:1:11: MG0202: no table 'familie' can be extended (did you mean 'family'?)",
    );
    refused("extends = 7", BASE, "t.toml:1:11");
    let itself = format!("extends = \"family\"\n{BASE}");
    refused(EXTENDS, &itself, "family.toml:1:11: MG0202: 'family' extends itself");
    let other = Base { name: "other", file: "other.toml", text: &itself, document: None };
    let round = format!("extends = \"other\"\n{BASE}");
    let faults = loaded(EXTENDS, &[base(&round), other]).map(|_| ()).unwrap_err();
    assert!(faults.contains("other.toml:1:11: MG0202: 'family' extends itself"), "{faults}");
}

#[test]
fn refuses_rows_that_change_nothing() {
    let row = r#"limits = [{ name = "brackets", max = 5, source = "page 1" }]"#;
    refused(
        &format!("{EXTENDS}{row}"),
        BASE,
        "t.toml:2:11: MG0202: 'limit:brackets' says what the row of 'family' says",
    );
    let without = "without = [\"limit:bracket\"]";
    refused(
        &format!("{EXTENDS}{without}"),
        BASE,
        "t.toml:2:12: MG0202: there is no row 'limit:bracket' to leave out",
    );
    refused(without, BASE, "there is no row 'limit:bracket' to leave out");
    let both = format!("{EXTENDS}without = [\"limit:brackets\"]\n{}", row.replace("5", "7"));
    refused(&both, BASE, "'limit:brackets' is left out by 'without', and stands here");
    let twice =
        format!("{EXTENDS}limits = [\n{a},\n{a},\n]", a = r#"{ name = "brackets", max = 7, source = "s" }"#);
    refused(&twice, BASE, "t.toml:4:1: MG0202: 'brackets' stands twice");
}

#[test]
fn faults_of_a_base_stand_in_its_file() {
    refused(
        EXTENDS,
        &with(r#"{ name = "bracket", source = { test = "s" } }"#),
        "family.toml:4:3: MG0202: unknown word 'bracket'",
    );
    refused(
        EXTENDS,
        &with(r#"{ name = "brackets", maxx = 1, source = { test = "s" } }"#),
        "family.toml:4:24: MG0202: unknown key 'maxx'",
    );
    refused(
        EXTENDS,
        &with(r#"{ name = "brackets", source = "s" }"#),
        "family.toml:4:3: MG0202: a row of a base that is settled has a source for each control",
    );
    refused(EXTENDS, &with(r#"{ name = "brackets", source = { test = 7 } }"#), "family.toml:4:");
    refused(
        EXTENDS,
        &with(r#"{ name = "brackets", source = { test = "" } }"#),
        "family.toml:4:3: MG0202: the source is empty",
    );
    refused(
        EXTENDS,
        "name = \"family\"\ntitle = \"F\"\nfamily = \"x\"\n",
        "family.toml:3:1: MG0202: unknown key 'family'",
    );
    refused(EXTENDS, "name = \"family\"\n", "family.toml:");
    refused(EXTENDS, "name = \n", "family.toml:1:");
    let twice = with(
        r#"{ name = "message", max = 1, source = { test = "s" } }, { name = "message", max = 2, source = { test = "s" } }"#,
    );
    refused(EXTENDS, &twice, "'message' stands twice");
    refused(
        r#"limits = [{ name = "brackets", source = { test = "s" } }]"#,
        BASE,
        "t.toml:1:11: MG0202: a source for each control stands in a base",
    );
}
