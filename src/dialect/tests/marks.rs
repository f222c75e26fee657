//! How sure a row is: what each mark needs, and what is refused.

use super::{faults, refused, table};
use crate::diag::{Code, Severity};
use crate::dialect::{Base, Control, Dialect, Mark, Question, Side, load};
use crate::text::Span;

fn row(keys: &str) -> String {
    format!("limits = [{{ name = \"brackets\", max = 5, {keys} }}]")
}

fn origin(keys: &str) -> (Mark, String) {
    let dialect: Dialect = load(&table(&row(keys)), &[]).unwrap();
    let origin = &dialect.limits[0].origin;
    (origin.mark, origin.source.clone())
}

#[test]
fn a_mark_is_what_the_keys_say() {
    assert_eq!(origin(r#"source = "page 1""#), (Mark::Confirmed, "page 1".into()));
    assert_eq!(
        origin(r#"source = "told", confirmed = false, note = "one report""#),
        (Mark::Unconfirmed, "told".into())
    );
    assert_eq!(
        origin(r#"common = ["POST, line 4", "COURSE, page 9"]"#),
        (Mark::Common, "POST, line 4; COURSE, page 9".into())
    );
    assert_eq!(
        origin(r#"source = "facts 3", common = ["BOOK"], cites = "B-1 p. 2""#),
        (Mark::Common, "facts 3; BOOK; after B-1 p. 2".into())
    );
}

#[test]
fn common_needs_two_sources_that_are_not_one() {
    let two = "MG0202: a common row needs two sources";
    refused(&row("common = []"), two);
    refused(&row(r#"common = ["POST"]"#), two);
    refused(&row(r#"common = [], cites = "B-1""#), two);
    // Two places of one source, however it is written, are one source.
    let twice = "MG0202: one source is named twice";
    refused(&row(r#"common = ["POST", "POST"]"#), twice);
    refused(&row(r#"common = ["POST, line 4", "post , line 90"]"#), twice);
    refused(&row(r#"common = ["POST: a", "POST, b"]"#), twice);
    refused(&row(r#"common = ["POST", "BOOK", "POST, b"]"#), twice);
    refused(&row(r#"common = ["POST", ""]"#), "a source has no name");
    refused(&row(r#"common = ["POST", ", line 4"]"#), "a source has no name");
    refused(&row(r#"common = ["POST"], cites = " ""#), "a source has no name");
    refused(&row(r#"common = "POST""#), "MG0202:");
}

#[test]
fn a_row_has_one_mark() {
    let both = "MG0202: a row has one mark: 'confirmed' or 'common'";
    refused(&row(r#"common = ["POST", "BOOK"], confirmed = true"#), both);
    refused(&row(r#"common = ["POST", "BOOK"], confirmed = false, note = "n""#), both);
    refused(&row(r#"source = "s", cites = "B-1""#), "'cites' stands without 'common'");
    refused(&row(r#"confirmed = false, note = "n""#), "the row has no source");
    // What nobody knows, nobody agrees on.
    let unknown = r#"behaviours = [{ name = "skip.levels", value = "unknown", common = ["POST", "BOOK"] }]"#;
    refused(unknown, "an answer that is 'unknown' is not common");
    assert_eq!(faults(&unknown.replace("unknown", "true")), "");
}

#[test]
fn a_base_names_the_common_sources_of_each_control() {
    let base = |source: &str| {
        format!("name = \"family\"\ntitle = \"F\"\nlimits = [{{ name = \"brackets\", max = 5, {source} }}]\n")
    };
    let mark = |source: &str| {
        let text = base(source);
        let bases = [Base { name: "family", file: "family.toml", text: &text, document: None }];
        load(&table("extends = \"family\"\n"), &bases).map(|dialect| dialect.limits[0].origin.mark)
    };
    let given = mark(r#"source = { test = { common = ["POST", "BOOK"] }, other = "page 1" }"#);
    assert_eq!(given.unwrap(), Mark::Common);
    assert_eq!(mark(r#"source = { other = { common = ["POST", "BOOK"] } }"#).unwrap(), Mark::Unconfirmed);
    let faults = mark(r#"common = ["POST", "BOOK"]"#).unwrap_err();
    assert!(faults[0].message.contains("has a source for each control"), "{faults:?}");
    assert!(mark(r#"source = { test = { common = ["POST"] } }"#).is_err());
}

/// A common fact has a note, an unconfirmed one a review; a profile that checked it leaves neither.
#[test]
fn a_common_fact_brings_a_note() {
    let plain = Control::plain("fanuc").unwrap();
    let fact = "behaviour:skip.midblock";
    assert_eq!(plain.mark(fact), Mark::Common);
    let told = plain.unconfirmed(Side::Source, fact, None, Span::new(0, 1));
    assert_eq!((told.code, told.severity()), (Code::CommonFact, Severity::Note));
    assert_eq!(told.fact(), Some(fact));
    assert_eq!(plain.mark("behaviour:bits.of.fraction"), Mark::Unconfirmed);
    let told = plain.unconfirmed(Side::Source, "behaviour:bits.of.fraction", None, Span::new(0, 1));
    assert_eq!((told.code, told.severity()), (Code::UnconfirmedFact, Severity::Review));
    assert_eq!(plain.mark("code:M77"), Mark::Unconfirmed);
    let checked = Control::from_profile(&format!("dialect = \"fanuc\"\nconfirm = [\"{fact}\"]")).unwrap();
    assert_eq!(checked.mark(fact), Mark::Confirmed);
}

#[test]
fn what_a_setting_decides_is_sure_and_still_open() {
    let row = |mark: &str| format!(r#"behaviours = [{{ name = "skip.levels", value = "setting", {mark} }}]"#);
    assert_eq!(faults(&row(r#"source = "s""#)), "");
    assert_eq!(faults(&row(r#"common = ["POST", "BOOK"]"#)), "");
    refused(
        &row(r#"source = "s", confirmed = false, note = "n""#),
        "no source says that a setting answers it",
    );
    // A question that no table leaves open has no such answer.
    let closed = r#"behaviours = [{ name = "repeat.counts", value = "setting", source = "s" }]"#;
    refused(closed, "'setting' is not a value of repeat.counts");
}

#[test]
fn what_a_setting_decides_is_asked_until_the_profile_says_it() {
    let told = |more: &str| {
        let control = Control::from_profile(&format!("dialect = \"fanuc\"\n{more}")).unwrap();
        let row = control.behaviour(Question::LengthMoves).unwrap();
        (row.value.clone(), row.origin.mark)
    };
    assert_eq!(told(""), ("unknown".into(), Mark::Unconfirmed));
    assert_eq!(told("[parameters]\n\"5006.6\" = 0"), ("true".into(), Mark::Confirmed));
    assert_eq!(told("[behaviours]\nlength.moves = false"), ("false".into(), Mark::Confirmed));
}

/// A code that all agree on rests on an answer that nobody confirms: once the shop has, what is left is common knowledge.
#[test]
fn what_a_row_rests_on_is_asked_until_it_is_confirmed() {
    let told = |confirm: &str| {
        let profile = format!("dialect = \"haas\"\nmachine = \"lathe\"\nconfirm = [{confirm}]\n");
        let control = Control::from_profile(&profile).unwrap();
        let told = control.unconfirmed(Side::Target, "code:G241", None, Span::default());
        (told.code, told.message.contains("behaviour:hole.side.plane"))
    };
    assert_eq!(told(""), (Code::UnconfirmedFact, true));
    assert_eq!(told("\"behaviour:hole.side.plane\""), (Code::CommonFact, false));
}
