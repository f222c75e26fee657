//! Each check refuses a table that is wrong in its way, at the right line.

mod extends;
mod marks;
mod profiles;
mod site;

use super::{faults_as_text, load};

/// A table that loads, with `rows` in it; they begin on line 1.
pub(super) fn table(rows: &str) -> String {
    format!(
        r#"{rows}
name = "test"
title = "Test"
family = "test"
{}
[numbers]
bare_length = "units"
bare_argument = "units"
bare_feed = "units"
increment_mm = 0.001
increment_inch = 0.0001
increment_degrees = 0.001
arithmetic = "double"
source = "here"
[text]
sequence_max = 9999
program_max = 9999
source = "here"
[names]
tape = false
nameless = false
source = "here"
"#,
        if rows.contains("settings") { "" } else { SETTINGS }
    )
}

const SETTINGS: &str =
    r#"settings = [{ name = "setting.a", values = ["1", "2"], meaning = "m", source = "s" }]"#;

/// The faults of a table, as text.
pub(super) fn faults(rows: &str) -> String {
    let text = table(rows);
    match load(&text, &[]) {
        Ok(_) => String::new(),
        Err(faults) => faults_as_text("t.toml", &text, &faults),
    }
}

#[track_caller]
pub(super) fn refused(rows: &str, expected: &str) {
    let faults = faults(rows);
    assert!(faults.contains(expected), "expected '{expected}' in:\n{faults}");
}

#[test]
fn a_right_table_loads() {
    assert_eq!(faults(""), "");
    assert_eq!(faults(r#"limits = [{ name = "brackets", max = 5, source = "s" }]"#), "");
}

#[test]
fn names_file_line_and_what_to_do() {
    refused(
        "limits = [\n  { name = \"brackets\", source = \"s\" },\n  { name = \"brackets\", maxx = 5, source = \"s\" },\n]",
        "t.toml:3:24: MG0202: unknown key 'maxx' (did you mean 'max'?)",
    );
}

#[test]
fn reports_every_fault_at_once() {
    let faults = faults(
        "limits = [\n  { name = \"a\", sauce = \"s\" },\n  { name = \"b\", sauce = \"s\" },\n]\nwords2 = []",
    );
    assert_eq!(faults.lines().count(), 3, "{faults}");
}

#[test]
fn refuses_unknown_keys() {
    refused("limitz = []", "unknown key 'limitz' (did you mean 'limits'?)");
    refused(
        r#"system = [{ state = "wcs", first = 1, subscripts = [{ cont = 3 }], source = "s" }]"#,
        "unknown field `cont`",
    );
}

#[test]
fn refuses_what_is_missing_or_no_toml() {
    let text = table("").replace("name = \"test\"", "");
    let faults = load(&text, &[]).unwrap_err();
    assert!(faults_as_text("t", &text, &faults).contains("'name' is missing"));
    assert!(load("a = = b", &[]).is_err());
    assert!(load("", &[]).is_err());
    refused(r#"limits = [{ name = "brackets" }]"#, "the row has no source");
    refused(r#"limits = [7]"#, "a row of 'limits' is a table");
    refused(r#"limits = { name = "brackets" }"#, "'limits' is a list of rows");
}

#[test]
fn refuses_unknown_canonical_names() {
    refused(
        r#"codes = [{ code = "G0", op = "motion.rapidd", source = "s" }]"#,
        "no Op is named 'motion.rapidd'",
    );
    refused(r#"words = [{ letter = "X", role = "axis.q", source = "s" }]"#, "no Role is named 'axis.q'");
    refused(
        r#"functions = [{ function = "sine", spelling = "SIN", source = "s" }]"#,
        "no Func is named 'sine'",
    );
    refused(r#"system = [{ state = "wsc", first = 1, source = "s" }]"#, "no Sys is named 'wsc'");
    refused(r#"limits = [{ name = "bracket", source = "s" }]"#, "did you mean 'brackets'?");
    refused(r#"statements = [{ name = "gotoo", spelling = "GOTO", source = "s" }]"#, "did you mean 'goto'?");
    refused(
        r#"operators = [{ spelling = "+", meaning = "plus", rank = 1, source = "s" }]"#,
        "unknown word 'plus'",
    );
}

#[test]
fn refuses_unknown_behaviours_and_values() {
    refused(
        r#"behaviours = [{ name = "vacancie", value = "true", source = "s" }]"#,
        "no behaviour is named 'vacancie' (did you mean 'vacancy'?)",
    );
    refused(
        r#"behaviours = [{ name = "vacancy", value = "yes", source = "s" }]"#,
        "'yes' is not a value of vacancy",
    );
    refused(
        r#"behaviours = [{ name = "alarm.offset", value = "x", source = "s" }]"#,
        "'x' is not a value of alarm.offset (it is any number)",
    );
    refused(r#"behaviours = [{ name = "alarm.max", value = "inf", source = "s" }]"#, "'inf' is not a value");
    refused(
        "behaviours = [\n  { name = \"vacancy\", value = \"true\", source = \"s\" },\n  { name = \"vacancy\", value = \"false\", source = \"s\" },\n]",
        "t.toml:3:3: MG0202: 'vacancy' stands twice",
    );
}

#[test]
fn refuses_overlapping_and_backward_variables() {
    let class = |first: u32, last: u32, class: &str| {
        format!(r##"{{ class = "{class}", name = "#", first = {first}, last = {last}, source = "s" }}"##)
    };
    let two = |a: String, b: String| format!("variables = [\n  {a},\n  {b},\n]");
    refused(
        &two(class(1, 33, "local"), class(33, 99, "common")),
        "t.toml:3:3: MG0202: #33..99 overlaps #1..33",
    );
    refused(&two(class(1, 33, "local"), class(99, 34, "common")), "the range 99..34 is backwards");
    refused(&two(class(1, 33, "locale"), class(34, 99, "common")), "did you mean 'local'?");
    assert_eq!(faults(&two(class(1, 33, "local"), class(34, 99, "common"))), "");
    // V24 and VX are two variables.
    assert_eq!(faults(&two(class(1, 99, "common"), class(1, 26, "letter"))), "");
}

#[test]
fn second_numbers_name_variables() {
    let with = |first: u32, last: u32, cell: u32| {
        format!(
            r##"variables = [{{ class = "common", name = "#", first = 100, last = 199, source = "s" }}]
same_cells = [{{ name = "#", first = {first}, last = {last}, cell = {cell}, source = "s" }}]"##
        )
    };
    assert_eq!(faults(&with(1100, 1199, 100)), "");
    refused(&with(1199, 1100, 100), "the range 1199..1100 is backwards");
    refused(&with(1100, 1199, 150), "there is no variable #249");
    refused(&with(150, 159, 100), "#150 is a variable of its own");
}

#[test]
fn refuses_system_variables_that_share_a_number() {
    let run = |first: u32, count: u32, step: u32, more: &str| {
        format!(
            r#"{{ state = "wcs", first = {first}, subscripts = [{{ count = {count}, step = {step} }}], source = "s"{more} }}"#
        )
    };
    let two = |a: String, b: String| format!("system = [\n  {a},\n  {b},\n]");
    refused(&two(run(10, 5, 1, ""), run(14, 2, 1, "")), "#14..15 overlaps #10..14");
    // Interleaved runs have no number in common.
    assert_eq!(faults(&two(run(10, 3, 2, ""), run(11, 3, 2, ""))), "");
    assert_eq!(
        faults(&two(run(10, 5, 1, r#", machine = "mill""#), run(10, 5, 1, r#", machine = "lathe""#))),
        ""
    );
    assert_eq!(
        faults(&two(run(10, 5, 1, r#", when = "setting.a=1""#), run(10, 5, 1, r#", when = "setting.a=2""#))),
        ""
    );
    refused(&two(run(10, 0, 1, ""), run(20, 1, 1, "")), "a subscript has no values");
    refused(
        r#"system = [{ state = "wcs", first = 1, subscripts = [{ count = 9, step = 5 }, { count = 9 }], source = "s" }]"#,
        "two subscripts give the same number",
    );
    refused(r#"system = [{ state = "wcs", first = 1, access = "x", source = "s" }]"#, "unknown access 'x'");
    refused(r#"system = [{ state = "wcs", subscripts = [{ count = 2 }], source = "s" }]"#, "add 'first'");
}

#[test]
fn refuses_variables_that_are_free_and_of_the_system() {
    refused(
        r##"variables = [{ class = "common", name = "#", first = 1, last = 9, source = "s" }]
system = [{ state = "wcs", first = 5, source = "s" }]"##,
        "#1..9 holds system:#5",
    );
}

#[test]
fn refuses_duplicate_codes() {
    let code = |code: &str, op: &str, more: &str| {
        format!(r#"{{ code = "{code}", op = "{op}", source = "s"{more} }}"#)
    };
    let two = |a: String, b: String| format!("codes = [\n  {a},\n  {b},\n]");
    refused(&two(code("G0", "motion.rapid", ""), code("G0", "motion.linear", "")), "G0 stands twice");
    assert_eq!(faults(&two(code("G10 L2", "wcs.write", ""), code("G10 L10", "offset.write.length", ""))), "");
    refused(
        &two(
            code(
                "G54",
                "wcs.select",
                r#", through = 59, counted = "wcs.number", fixed = { "wcs.number" = 1 }"#,
            ),
            code("G55", "stop", ""),
        ),
        "G55 stands twice",
    );
    assert_eq!(
        faults(&two(
            code("G99", "return.r", r#", machine = "mill""#),
            code("G99", "feed.per.turn", r#", machine = "lathe""#)
        )),
        ""
    );
}

#[test]
fn refuses_two_preferred_spellings() {
    let code =
        |code: &str, more: &str| format!(r#"{{ code = "{code}", op = "tool.change", source = "s"{more} }}"#);
    let two = |a: String, b: String| format!("codes = [\n  {a},\n  {b},\n]");
    refused(&two(code("M6", ""), code("M16", "")), "M6 and M16 are both preferred for tool.change");
    assert_eq!(faults(&two(code("M6", ""), code("M16", ", preferred = false"))), "");
}

#[test]
fn refuses_misspelt_codes_and_conditions() {
    let one = |code: &str, more: &str| {
        format!(r#"codes = [{{ code = "{code}", op = "stop", source = "s"{more} }}]"#)
    };
    refused(&one("g0", ""), "'g0' is not a code");
    refused(&one("G0 10", ""), "'G0 10' is not a code");
    refused(&one("G", ""), "'G' is not a code");
    refused(&one("M9", ", through = 5"), "the run of codes is backwards");
    refused(&one("M9", r#", counted = "repeat""#), "nothing counts up");
    refused(&one("M9", r#", words = { PP = "repeat" }"#), "a word is one letter");
    refused(&one("M9", r#", shift = { repeat = [{ first = 3, last = 1, add = 1 }] }"#), "range is backwards");
    refused(&one("M9", r#", machine = "router""#), "unknown machine 'router'");
    refused(&one("M9", r#", when = "setting.b=1""#), "no setting says 'setting.b=1'");
    refused(&one("M9", r#", when = "setting.a=3""#), "no setting says 'setting.a=3'");
}

#[test]
fn refuses_rows_without_a_basis() {
    refused(r#"limits = [{ name = "brackets", source = " " }]"#, "the source is empty");
    refused(
        r#"limits = [{ name = "brackets", source = "s", confirmed = false }]"#,
        "limit:brackets is unconfirmed (add 'note' with what is not certain)",
    );
}

#[test]
fn refuses_settings_without_effect() {
    let set = |sets: &str| {
        format!(
            r#"settings = [{{ name = "setting.a", values = ["1"], sets = {sets}, meaning = "m", source = "s" }}]"#
        )
    };
    refused(
        &set(r#"{ 1 = { "behaviour:vacancy" = "perhaps" } }"#),
        "cannot set 'behaviour:vacancy' to 'perhaps'",
    );
    refused(&set(r#"{ 1 = { "limit:brackets" = "3" } }"#), "cannot set 'limit:brackets' to '3'");
    refused(
        r#"settings = [{ name = "setting.a", values = ["1"], default = "2", meaning = "m", source = "s" }]"#,
        "unknown word '2'",
    );
}
