//! The page of one dialect: every row of its table with its source.

use super::matrix::{MARKS, mark, run};
use super::table::columns;
use super::{Compares, Control, Row, matters};
use crate::canon::Op;

/// All that is known of a control: section by section, each row with its
/// source, and with its note where it has one. A `?` marks what no maker's text confirms, a `~` what is common.
pub fn page(control: &Control) -> String {
    let dialect = control.dialect();
    let mut out = format!("{} ({})\n{MARKS}\n", dialect.title, dialect.name);
    if let Some(advice) = &dialect.advice {
        out.push_str(&format!("{advice}.\n"));
    }
    let numbers = &dialect.numbers;
    section(&mut out, "NUMBERS", std::slice::from_ref(numbers), |row| {
        vec![format!(
            "without a point {:?}, argument {:?}, feed {:?}; {} mm, {} inch, {} degrees; arithmetic {}",
            row.bare_length,
            row.bare_argument,
            row.bare_feed,
            row.increment_mm,
            row.increment_inch,
            row.increment_degrees,
            row.arithmetic
        )]
    });
    section(&mut out, "TEXT", std::slice::from_ref(&dialect.text), |row| {
        let known = |number: Option<u32>| number.map_or("unknown".into(), |number| number.to_string());
        vec![format!(
            "line {}, macro line {}, N to {}, O to {}, message {}",
            known(row.line),
            known(row.macro_line),
            row.sequence_max,
            row.program_max,
            known(row.message)
        )]
    });
    section(&mut out, "NAMES", std::slice::from_ref(&dialect.names), |row| {
        let name = |name: &Option<String>| name.clone().unwrap_or("none".into());
        let (program, numbered) = (name(&row.program), name(&row.numbered));
        let tape = if row.tape { ", files between %" } else { "" };
        vec![format!("programs {program}, system variables by number {numbered}{tape}")]
    });
    section(&mut out, "FORMS", &dialect.forms, |row| {
        let takes: Vec<&str> = row.takes.iter().map(|operand| operand.name()).collect();
        let class = row.class.as_ref().map_or(String::new(), |class| format!("{class} only"));
        let apart = if row.mixed { "" } else { "constants and variables in blocks of their own" };
        let zero = if row.compares == Compares::Zero { "against 0" } else { "" };
        let limits: Vec<&str> =
            [class.as_str(), apart, zero].into_iter().filter(|limit| !limit.is_empty()).collect();
        vec![row.place.name().into(), row.written.clone(), takes.join(", "), limits.join(", ")]
    });
    section(&mut out, "LIMITS", &dialect.limits, |row| {
        let max = row.max.map_or("none".into(), |max| max.to_string());
        vec![row.name.clone(), max, row.alarm.clone().unwrap_or_default()]
    });
    section(&mut out, "FORBIDDEN", &dialect.forbidden, |row| {
        let names = |ops: &[Op]| ops.iter().map(|op| op.name()).collect::<Vec<_>>().join(", ");
        let unless =
            if row.unless.is_empty() { String::new() } else { format!("but in {}", names(&row.unless)) };
        let words = row.words.iter().map(|role| role.name()).collect::<Vec<_>>().join(", ");
        match (row.words.is_empty(), row.negative) {
            (true, _) => vec![format!("under {}", names(&row.under)), names(&row.ops), unless],
            (false, true) => vec!["below 0".into(), words],
            (false, false) if row.ops.is_empty() => vec!["anywhere".into(), words],
            (false, false) => vec![format!("beside {}", names(&row.ops)), words],
        }
    });
    section(&mut out, "OPERATORS", &dialect.operators, |row| {
        let place = if row.condition_only { "in conditions" } else { "" };
        vec![row.spelling.clone(), row.meaning.clone(), format!("rank {}", row.rank), place.into()]
    });
    section(&mut out, "FUNCTIONS", &dialect.functions, |row| {
        let range =
            |of: &Option<String>, word: &str| of.as_ref().map_or(String::new(), |r| format!("{word} {r}"));
        vec![
            row.spelling.clone(),
            row.fact(),
            range(&row.domain, "of"),
            range(&row.range, "gives"),
            option(&row.option),
        ]
    });
    section(&mut out, "STATEMENTS", &dialect.statements, |row| {
        vec![row.name.clone(), row.spelling.clone(), option(&row.option)]
    });
    section(&mut out, "BEHAVIOURS", &dialect.behaviours, |row| {
        let one_of = match row.one_of.as_slice() {
            [] => row.value.clone(),
            answers if answers.contains(&row.value) => format!("{}, or as the profile says", row.value),
            answers => answers.join(" or "),
        };
        vec![row.question.name().into(), one_of, row.question.meaning().into()]
    });
    section(&mut out, "VARIABLES", &dialect.variables, |row| {
        let kept = match row.retained {
            Some(true) => "kept at power-off",
            Some(false) => "lost at power-off",
            None => "",
        };
        let runs = run(&row.name, row.first, row.last, row.class == "letter");
        vec![runs, row.class.clone(), kept.into(), option(&row.option)]
    });
    section(&mut out, "AS ON THE EMULATED CONTROL", &dialect.matters, |row| {
        let meaning = matters::meaning(&row.fact()).unwrap_or_default();
        vec![row.name.clone(), meaning.into()]
    });
    section(&mut out, "VARIABLES IN USE", &dialect.in_use, |row| {
        vec![run(&row.name, row.first, row.last, false), row.by.clone()]
    });
    section(&mut out, "SECOND NUMBERS", &dialect.same_cells, |row| {
        let cells = run(&row.name, row.cell, row.last - row.first + row.cell, false);
        vec![run(&row.name, row.first, row.last, false), format!("the cells of {cells}"), option(&row.option)]
    });
    section(&mut out, "SYSTEM VARIABLES", &dialect.system, |row| {
        let runs = match (row.first, row.last()) {
            (Some(first), Some(last)) => run(&row.name, first, last, false),
            _ => row.name.clone(),
        };
        vec![runs, row.state.name().into(), row.access.clone(), only(&row.machine, &row.when, &row.option)]
    });
    section(&mut out, "WORDS", &dialect.words, |row| {
        let op = row.op.map_or(String::new(), |op| op.name().into());
        vec![row.letter.clone(), row.role.name().into(), op, only(&row.machine, &row.when, &None)]
    });
    section(&mut out, "CODES", &dialect.codes, |row| {
        let words: Vec<String> = row.words.iter().map(|(letter, role)| format!("{letter} {role}")).collect();
        let read = if row.preferred { "" } else { "read only" };
        vec![
            row.code.clone(),
            row.op.name().into(),
            words.join(", "),
            read.into(),
            only(&row.machine, &row.when, &row.option),
        ]
    });
    section(&mut out, "CALL ARGUMENTS", &dialect.arguments, |row| {
        vec![row.letter.to_string(), format!("#{}", row.local)]
    });
    section(&mut out, "SETTINGS", &dialect.settings, |row| {
        let value = control.setting(&row.name).map_or("not set".into(), |value| format!("= {value}"));
        let name = row.through.map_or(row.name.clone(), |last| format!("{} to {last}", row.name));
        vec![name, value, row.values.join(" "), row.meaning.clone()]
    });
    out
}

fn section<T: Row>(out: &mut String, title: &str, rows: &[T], cells: impl Fn(&T) -> Vec<String>) {
    if rows.is_empty() {
        return;
    }
    let lines: Vec<Vec<String>> = rows
        .iter()
        .map(|row| {
            let origin = row.origin();
            let mut line = cells(row);
            if let Some(first) = line.first_mut() {
                *first = mark(first, origin);
            }
            let note = origin.note.as_ref().map_or(String::new(), |note| format!("; {note}"));
            let table = origin.table.as_ref().map_or(String::new(), |table| format!("{table}: "));
            line.push(format!("[{table}{}{note}]", origin.source));
            line
        })
        .collect();
    out.push('\n');
    out.push_str(title);
    out.push('\n');
    *out += &columns(&lines);
}

fn option(option: &Option<String>) -> String {
    option.as_ref().map_or(String::new(), |option| format!("option {option}"))
}

fn only(machine: &Option<String>, when: &Option<String>, bought: &Option<String>) -> String {
    let parts = [machine.clone(), when.clone(), bought.as_ref().map(|name| format!("option {name}"))];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
