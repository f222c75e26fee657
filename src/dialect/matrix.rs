//! The capability matrix: one line a concept, one column a dialect.

use super::table::columns;
use super::{BareLength, Control, OperandPlace, Origin, Question, registry};
use crate::canon::{Func, Op, Sys};
use std::collections::BTreeSet;

/// A cell of a control that has no such thing.
const NONE: &str = ".";

/// What the marks mean.
pub(super) const MARKS: &str =
    "? no maker's text confirms it    ~ no maker's text was reached, and two sources of the trade agree";

/// The matrix of all dialects, without machine profiles. A `?` stands after
/// what no maker's text confirms, a `~` after what sources of the trade agree on, a `.` where the
/// control has no such thing.
pub fn matrix() -> String {
    let controls: Vec<Control> =
        registry::all().iter().filter_map(|entry| Control::plain(entry.name)).collect();
    let mut out = format!("{MARKS}    . the control has no such thing\n");
    let head = |title: &str| {
        let mut row = vec![title.to_string()];
        row.extend(controls.iter().map(|control| control.name().to_string()));
        row
    };
    let mut section = |title: &str, rows: Vec<Vec<String>>| {
        let mut lines = vec![head(title)];
        lines.extend(rows.into_iter().filter(|row| row.iter().skip(1).any(|cell| cell != NONE)));
        out.push('\n');
        out += &columns(&lines);
    };
    let row = |concept: &str, cell: &dyn Fn(&Control) -> String| {
        let mut row = vec![concept.to_string()];
        row.extend(controls.iter().map(cell));
        row
    };

    section(
        "NUMBERS",
        vec![
            row("length without a point", &|c| bare(c.bare_length(), &c.numbers().origin)),
            row("feed without a point", &|c| bare(c.bare_feed(), &c.numbers().origin)),
            row("arithmetic", &|c| mark(&c.numbers().arithmetic, &c.numbers().origin)),
            row("macro line", &|c| count(c.text().macro_line.or(c.text().line), &c.text().origin)),
            row("largest N", &|c| count(Some(c.text().sequence_max), &c.text().origin)),
            row("largest O", &|c| count(Some(c.text().program_max), &c.text().origin)),
        ],
    );
    section(
        "VARIABLES",
        names(&controls, |d| d.variables.iter().map(|v| v.class.clone()).collect())
            .iter()
            .map(|class| {
                row(class, &|c| {
                    let runs: Vec<String> = c
                        .classes()
                        .iter()
                        .filter(|v| v.class == *class)
                        .map(|v| mark(&run(&v.name, v.first, v.last, class == "letter"), &v.origin))
                        .collect();
                    if runs.is_empty() { NONE.into() } else { runs.join(" ") }
                })
            })
            .collect(),
    );
    section(
        "OPERANDS",
        OperandPlace::ALL
            .iter()
            .map(|place| {
                row(place.name(), &|c| {
                    c.form(*place).map_or(NONE.into(), |form| {
                        let takes: Vec<&str> = form.takes.iter().map(|operand| operand.name()).collect();
                        mark(&takes.join("/"), &form.origin)
                    })
                })
            })
            .collect(),
    );
    section(
        "LIMITS",
        names(&controls, |d| d.limits.iter().map(|l| l.name.clone()).collect())
            .iter()
            .map(|name| {
                row(name, &|c| {
                    c.limit_row(name).map_or(NONE.into(), |l| {
                        mark(&l.max.map_or("none".into(), |max| max.to_string()), &l.origin)
                    })
                })
            })
            .collect(),
    );
    section(
        "OPERATORS",
        super::check::MEANINGS
            .iter()
            .map(|meaning| {
                row(meaning, &|c| c.operator(meaning).map_or(NONE.into(), |o| mark(&o.spelling, &o.origin)))
            })
            .collect(),
    );
    section(
        "FUNCTIONS",
        Func::ALL
            .iter()
            .flat_map(|function| [1, 2].map(|n| (*function, n)))
            .map(|(function, n)| {
                let concept =
                    if n == 1 { function.name().to_string() } else { format!("{function}, two arguments") };
                row(&concept, &|c| {
                    c.function(function, n).map_or(NONE.into(), |f| mark(&f.spelling, &f.origin))
                })
            })
            .collect(),
    );
    section(
        "STATEMENTS",
        names(&controls, |d| d.statements.iter().map(|s| s.name.clone()).collect())
            .iter()
            .map(|name| {
                row(name, &|c| c.statement(name).map_or(NONE.into(), |s| mark(&s.spelling, &s.origin)))
            })
            .collect(),
    );
    section(
        "BEHAVIOURS",
        Question::ALL
            .iter()
            .map(|question| {
                row(question.name(), &|c| {
                    c.behaviour(*question).map_or(NONE.into(), |b| mark(&b.value, &b.origin))
                })
            })
            .collect(),
    );
    section(
        "SYSTEM STATE",
        Sys::ALL
            .iter()
            .map(|state| {
                row(state.name(), &|c| {
                    c.system_run(*state).map_or(NONE.into(), |v| {
                        mark(&v.first.map_or(v.name.clone(), |first| format!("{}{first}", v.name)), &v.origin)
                    })
                })
            })
            .collect(),
    );
    section(
        "OPERATIONS",
        Op::ALL
            .iter()
            .map(|op| {
                row(op.name(), &|c| {
                    let code = c
                        .dialect()
                        .codes
                        .iter()
                        .find(|code| (code.op == *op || code.also.contains(op)) && code.preferred);
                    let any = || c.dialect().codes.iter().find(|code| code.op == *op);
                    match (code.or_else(any), c.word_for(*op)) {
                        (Some(code), _) => mark(&code.code, &code.origin),
                        (None, Some(word)) => mark(&word.letter, &word.origin),
                        (None, None) => NONE.into(),
                    }
                })
            })
            .collect(),
    );
    out
}

/// The names that any of the dialects has, in order.
fn names(controls: &[Control], of: impl Fn(&super::Dialect) -> Vec<String>) -> Vec<String> {
    let all: BTreeSet<String> = controls.iter().flat_map(|control| of(control.dialect())).collect();
    all.into_iter().collect()
}

/// A cell, with the mark of how sure it is.
pub(super) fn mark(cell: &str, origin: &Origin) -> String {
    format!("{cell}{}", origin.mark.sign())
}

fn bare(bare: BareLength, origin: &Origin) -> String {
    match bare {
        BareLength::Increments => mark("increments", origin),
        BareLength::Units => mark("units", origin),
        BareLength::Unknown => "unknown".into(),
    }
}

fn count(number: Option<u32>, origin: &Origin) -> String {
    number.map_or(NONE.into(), |number| mark(&number.to_string(), origin))
}

/// A run of variables as people write it: `#100-199`, `VA-Z`.
pub(super) fn run(name: &str, first: u32, last: u32, letters: bool) -> String {
    let shown = |number: u32| match char::from_u32(u32::from('A') + number.saturating_sub(1)) {
        Some(letter) if letters => letter.to_string(),
        _ => number.to_string(),
    };
    if first == last {
        format!("{name}{}", shown(first))
    } else {
        format!("{name}{}-{}", shown(first), shown(last))
    }
}
