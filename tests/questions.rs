//! Each question of behaviour is asked by code, and answered by each table that it concerns.

mod support;

use macroglot::dialect::{Answers, Control, Dialect, Question, Row, registry};
use std::sync::OnceLock;
use support::{asks, rust_files};

/// The list of questions names all of them, and asks none.
const LIST: &str = "src/dialect/questions.rs";

/// The files that ask a question.
fn places(question: Question) -> Vec<String> {
    static SOURCES: OnceLock<Vec<(String, String)>> = OnceLock::new();
    let sources = SOURCES.get_or_init(|| {
        let all = rust_files("src").into_iter();
        all.filter(|(path, _)| path != LIST && !path.contains("/tests")).collect()
    });
    sources.iter().filter(|(_, text)| asks(text, question)).map(|(path, _)| path.clone()).collect()
}

/// True for a module of one dialect, or of a family: what it asks, others need not answer.
fn is_of(path: &str, name: &str) -> bool {
    let folders = ["syntax", "lower", "emit", "control"].map(|room| format!("src/{room}/{name}"));
    folders.iter().any(|folder| path == format!("{folder}.rs") || path.starts_with(&format!("{folder}/")))
}

/// True where code that serves this dialect asks: its own modules, its family's, or those that serve all.
fn concerns(dialect: &Dialect, paths: &[String]) -> bool {
    let names: Vec<&str> = registry::all()
        .iter()
        .filter_map(|entry| entry.dialect().ok())
        .flat_map(|other| [other.name.as_str(), other.family.as_str()])
        .collect();
    paths.iter().any(|path| {
        let own = is_of(path, &dialect.name) || is_of(path, &dialect.family);
        own || !names.iter().any(|name| is_of(path, name))
    })
}

/// True where a table has what a question needs.
fn has(control: &Control, needs: &str) -> bool {
    needs.split(" or ").any(|all| all.split(" and ").all(|fact| has_fact(control, fact)))
}

fn has_fact(control: &Control, fact: &str) -> bool {
    let dialect = control.dialect();
    let (kind, name) = fact.split_once(':').expect("a fact has a kind");
    match kind {
        "behaviour" => {
            let (name, value) = name.split_once('=').unwrap_or((name, "true"));
            let question = Question::find(name).expect(fact);
            control.behaviour(question).is_some_and(|row| row.value == value)
        }
        "class" => control.classes().iter().any(|row| row.class == name),
        "op" => {
            let codes = dialect.codes.iter().flat_map(|row| row.also.iter().chain([&row.op]));
            let words = dialect.words.iter().filter_map(|row| row.op.as_ref());
            codes.chain(words).any(|op| op.name() == name)
        }
        "role" => {
            let codes = dialect.codes.iter().flat_map(|row| row.words.values());
            codes.chain(dialect.words.iter().map(|row| &row.role)).any(|role| role.name() == name)
        }
        "form" => {
            let (place, takes) = name.split_once('=').expect(fact);
            dialect
                .forms
                .iter()
                .any(|row| row.place.name() == place && row.takes.iter().any(|one| one.name() == takes))
        }
        "statement" => control.statement(name).is_some(),
        "operator" => control.operator(name).is_some(),
        "function" => dialect.functions.iter().any(|row| row.fact() == fact),
        _ => panic!("'{fact}' is of no kind that questions may need"),
    }
}

fn controls() -> Vec<Control> {
    registry::all().iter().map(|entry| Control::plain(entry.name).expect(entry.name)).collect()
}

/// True for a question whose answer rows of a table rest on: it is heard wherever one of them is used.
fn is_rested_on(question: Question) -> bool {
    fn names<T: Row>(rows: &[T], question: Question) -> bool {
        rows.iter().any(|row| row.origin().rests.as_deref() == Some(question.fact()))
    }
    registry::all().iter().filter_map(|entry| entry.dialect().ok()).any(|of| {
        names(&of.system, question)
            || names(&of.codes, question)
            || names(&of.operators, question)
            || names(&of.words, question)
    })
}

#[test]
fn every_question_is_asked_by_code() {
    let idle =
        Question::ALL.iter().filter(|question| places(**question).is_empty() && !is_rested_on(**question));
    let idle: Vec<&str> = idle.map(|q| q.name()).collect();
    assert!(idle.is_empty(), "no code asks: ask them, or take them out of {LIST} and the tables: {idle:#?}");
}

#[test]
fn every_question_is_answered_by_the_tables_that_it_concerns() {
    let mut silent = Vec::new();
    for question in Question::ALL {
        let paths = places(*question);
        for control in controls() {
            let arises = question.needs().is_none_or(|needs| needs != "said" && has(&control, needs));
            if arises && concerns(control.dialect(), &paths) && control.behaviour(*question).is_none() {
                silent.push(format!("{}: {question}, asked by {}", control.name(), paths.join(", ")));
            }
        }
    }
    assert!(silent.is_empty(), "no answer in the table: add a row, 'unknown' is one:\n{}", silent.join("\n"));
}

#[test]
fn every_question_is_answered_by_some_table() {
    for question in Question::ALL {
        // A number that may be said is one that only the profile of a machine has.
        let of_machine = question.needs() == Some("said") && question.answers() == Answers::Number;
        // What a shop says of its programs is no fact of a control.
        let of_shop = question.needs() == Some("said") && question.is_choice();
        let answered = controls().iter().any(|control| control.behaviour(*question).is_some());
        assert!(of_machine || of_shop || answered, "{question}");
    }
}

/// Whoever states an answer in a machine profile relies on its being heard.
#[test]
fn what_a_table_leaves_open_is_asked_of_its_control() {
    for control in controls() {
        for row in control.dialect().behaviours.iter().filter(|row| row.value == "unknown") {
            let heard = concerns(control.dialect(), &places(row.question));
            assert!(heard, "{}: no code asks {}", control.name(), row.question);
        }
    }
}

/// The tests themselves see what they are for.
#[test]
fn the_tests_have_teeth() {
    assert!(asks("is(Question::SActs)", Question::SActs) && !asks("Question::SActsOther", Question::SActs));
    let [macro_b, plain] = ["fanuc", "cc100"].map(|name| Control::plain(name).unwrap());
    assert!(has(&macro_b, "statement:call.modal and statement:call.macro"));
    assert!(
        !has(&plain, "statement:call.macro or function:round") && has(&plain, "behaviour:tool.change.word=t")
    );
    let own = ["src/lower/cc100/flow.rs".to_owned()];
    assert!(concerns(plain.dialect(), &own) && !concerns(macro_b.dialect(), &own));
    let family = ["src/lower/macro_b/flow/jumps.rs".to_owned()];
    assert!(!concerns(plain.dialect(), &family) && concerns(macro_b.dialect(), &family));
    assert!(concerns(plain.dialect(), &["src/legalize/mod.rs".to_owned()]));
    assert_eq!(places(Question::PrintFormat).len(), 2);
}
