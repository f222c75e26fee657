//! What a table must not say: the same thing twice, a range backwards, two
//! answers to one question.

use super::answers::SETTING;
use super::check_sources::sources;
use super::overlay;
use super::profile::Axis;
use super::reader::{Placed, Reader, closest};
use super::{
    Argument, Behaviour, CodeMeaning, Forbidden, Form, Function, InUse, Limit, Matter, Operator, Question,
    Row, SameCells, Setting, Statement, SystemVariable, VariableClass, WordMeaning,
};
use std::collections::BTreeMap;

/// The rows of a table with their places.
#[derive(Default)]
pub(super) struct Tables {
    pub forms: Vec<Placed<Form>>,
    pub limits: Vec<Placed<Limit>>,
    pub forbidden: Vec<Placed<Forbidden>>,
    pub operators: Vec<Placed<Operator>>,
    pub functions: Vec<Placed<Function>>,
    pub statements: Vec<Placed<Statement>>,
    pub behaviours: Vec<Placed<Behaviour>>,
    pub variables: Vec<Placed<VariableClass>>,
    pub matters: Vec<Placed<Matter>>,
    pub in_use: Vec<Placed<InUse>>,
    pub same_cells: Vec<Placed<SameCells>>,
    pub system: Vec<Placed<SystemVariable>>,
    pub words: Vec<Placed<WordMeaning>>,
    pub codes: Vec<Placed<CodeMeaning>>,
    pub arguments: Vec<Placed<Argument>>,
    pub settings: Vec<Placed<Setting>>,
}

/// Runs every check.
pub(super) fn all(reader: &mut Reader, tables: &Tables) {
    duplicates(reader, &tables.forms, |row| row.place.name().into());
    duplicates(reader, &tables.limits, |row| row.name.clone());
    duplicates(reader, &tables.forbidden, Row::full_key);
    duplicates(reader, &tables.operators, |row| format!("{} {}", row.spelling, row.meaning));
    duplicates(reader, &tables.functions, |row| format!("{}/{}", row.spelling, row.arguments));
    duplicates(reader, &tables.statements, |row| row.name.clone());
    duplicates(reader, &tables.behaviours, Row::full_key);
    duplicates(reader, &tables.arguments, |row| row.letter.to_string());
    duplicates(reader, &tables.arguments, |row| format!("local {}", row.local));
    duplicates(reader, &tables.settings, Row::full_key);
    duplicates(reader, &tables.words, |row| format!("{} {:?} {:?}", row.letter, row.machine, row.when));
    duplicates(reader, &tables.matters, |row| row.name.clone());
    matters(reader, &tables.matters);
    forms(reader, tables);
    operators(reader, &tables.operators);
    names(reader, tables);
    answers(reader, &tables.behaviours);
    settings(reader, tables);
    variables(reader, &tables.variables);
    same_cells(reader, &tables.same_cells, &tables.variables);
    free_or_system(reader, tables);
    super::check_system::check(reader, &tables.system);
    super::check_codes::check(reader, &tables.codes);
    conditions(reader, tables);
    sources(reader, tables);
}

/// Reports two rows of one key.
fn duplicates<T>(reader: &mut Reader, rows: &[Placed<T>], key: impl Fn(&T) -> String) {
    let mut seen = BTreeMap::new();
    for placed in rows {
        let key = key(&placed.row);
        if seen.insert(key.clone(), ()).is_some() {
            reader.fault_at(placed.place.clone(), format!("'{key}' stands twice"), "keep one of the rows");
        }
    }
}

/// What an operator may mean.
pub const MEANINGS: &[&str] = &[
    "add", "subtract", "multiply", "divide", "modulo", "and.bits", "or.bits", "xor.bits", "and", "or", "xor",
    "not", "negate", "eq", "ne", "lt", "le", "gt", "ge",
];

/// What of a machine the value of a setting may be, where that is no word of a code: how far the end of an arc may lie off its
/// circle; the angle of the run-out of a thread, degrees; what the feed of a lathe counts at power-on, `turn` or `minute`.
/// The first and the last M code by which the paths of a machine wait for each other, the values of P beside one, and the mark
/// before a path's part of a file.
pub const TELLS: &[&str] = &[
    "arc.limit",
    "thread.run.out.angle",
    "lathe.feed",
    "contour.start.checked",
    "roughing.skips.steps",
    "roughing.skips.valleys",
    "paths.wait.first",
    "paths.wait.last",
    "paths.wait.p",
    "paths.mark",
];

/// Statements that a control can have.
pub const STATEMENTS: &[&str] = &[
    "goto",
    "goto.label",
    "goto.computed",
    "if.goto",
    "if.then",
    "if.then.words",
    "if.bare",
    "while",
    "do.endless",
    "branch",
    "branch.computed",
    "test",
    "step",
    "timer",
    "table.transfer",
    "test.unit",
    "assign.sign",
    "variable.computed",
    "call.macro",
    "call.modal",
    "call.program",
    "call.local",
    "call.cycle",
    "call.repeat",
    "call.repeat.digits",
    "comment.in.brackets",
    "jump.input",
    "return",
    "return.to.sequence",
    "start",
    "output.formatted",
    "output.binary",
    "output.close",
    "output.open",
    "setvn",
    "names.system",
    "alarm",
    "stop.message",
    "print",
    "print.serial",
    "input",
    "input.serial",
    "clear",
    "set",
    "wait",
    "lookahead.stop",
    "index",
    "indirect",
    "indirect.assign",
    "block.skip",
    "read.address",
    "read.bit",
];

/// Limits that a control can have.
pub const LIMITS: &[&str] = &[
    "brackets",
    "do.depth",
    "do.numbers",
    "call.macro",
    "call.subprogram",
    "call.all",
    "repeat",
    "constant.digits",
    "name.length",
    "round.places",
    "print.digits",
    "operators",
    "message",
    "message.alarm",
    "lookahead",
    "macro.lines",
    "g.codes",
    "number.digits",
    "block.length",
    "rotary.turn",
    "program.main",
];

fn names(reader: &mut Reader, tables: &Tables) {
    for placed in &tables.statements {
        one_of(reader, placed, &placed.row.name, STATEMENTS);
    }
    for placed in &tables.limits {
        one_of(reader, placed, &placed.row.name, LIMITS);
    }
}

/// A form is whole, and its class one that the control has.
fn forms(reader: &mut Reader, tables: &Tables) {
    for placed in &tables.forms {
        if let Some((message, help)) = placed.row.fault() {
            reader.fault_at(placed.place.clone(), message, help);
        }
        if let Some(class) = &placed.row.class {
            let known: Vec<&str> = tables.variables.iter().map(|row| row.row.class.as_str()).collect();
            one_of(reader, placed, class, &known);
        }
    }
}

fn operators(reader: &mut Reader, rows: &[Placed<Operator>]) {
    for placed in rows {
        one_of(reader, placed, &placed.row.meaning, MEANINGS);
    }
}

/// Every answer is one that its question may have. An answer that machines may have otherwise is one of theirs.
fn answers(reader: &mut Reader, rows: &[Placed<Behaviour>]) {
    for placed in rows {
        let Behaviour { question, value, one_of, .. } = &placed.row;
        let admits = |value: &str| question.answers().admits(value) || question.may_hang_on_setting(value);
        for value in [value].into_iter().chain(one_of).filter(|value| !admits(value)) {
            let message = format!("'{value}' is not a value of {question}");
            reader.fault_at(placed.place.clone(), message, format!("it is {}", question.answers()));
        }
        let open = |value: &str| ["unknown", SETTING].contains(&value);
        let twice =
            one_of.iter().enumerate().any(|(at, one)| one_of.iter().take(at).any(|other| other == one));
        if !one_of.is_empty() && (one_of.len() < 2 || twice || one_of.iter().any(|one| open(one))) {
            let help = "'one_of' lists two answers or more, each once, and none of them 'unknown'";
            reader.fault_at(
                placed.place.clone(),
                format!("{question} is left open, but 'one_of' has no answers"),
                help,
            );
        } else if !one_of.is_empty() && value != "unknown" && !one_of.contains(value) {
            let help = "write value = \"unknown\", or the answer into 'one_of'";
            reader.fault_at(
                placed.place.clone(),
                format!("{question} has an answer that is none of 'one_of'"),
                help,
            );
        }
    }
}

fn one_of<T: Row>(reader: &mut Reader, placed: &Placed<T>, value: &str, known: &[&str]) {
    if !known.contains(&value) {
        let help = match closest(value, known.iter().copied()) {
            Some(near) => format!("did you mean '{near}'?"),
            None => format!("it is one of {}", known.join(", ")),
        };
        reader.fault_at(placed.place.clone(), format!("unknown word '{value}'"), help);
    }
}

/// Second numbers name cells that are there, and are no variables of their own.
fn same_cells(reader: &mut Reader, rows: &[Placed<SameCells>], variables: &[Placed<VariableClass>]) {
    let is_variable = |name: &str, number: u32| {
        let mut rows = variables.iter().map(|placed| &placed.row);
        rows.any(|row| row.name == name && row.class != "letter" && (row.first..=row.last).contains(&number))
    };
    for placed in rows {
        let row = &placed.row;
        let Some(more) = row.last.checked_sub(row.first) else {
            let message = format!("the range {}..{} is backwards", row.first, row.last);
            reader.fault_at(placed.place.clone(), message, "write the smaller number as 'first'");
            continue;
        };
        let own = [row.first, row.last].into_iter().find(|number| is_variable(&row.name, *number));
        let missing =
            [row.cell, row.cell.saturating_add(more)].into_iter().find(|cell| !is_variable(&row.name, *cell));
        if let Some(number) = own {
            let message = format!("{}{number} is a variable of its own", row.name);
            reader.fault_at(placed.place.clone(), message, "take it out here, or among the variables");
        }
        if let Some(cell) = missing {
            let message = format!("there is no variable {}{cell}", row.name);
            reader.fault_at(placed.place.clone(), message, "write the number of the cell that 'first' names");
        }
    }
}

/// Variables of one name do not overlap, and no range is backwards.
fn variables(reader: &mut Reader, rows: &[Placed<VariableClass>]) {
    const CLASSES: &[&str] = &["local", "common", "retained", "parametric", "letter"];
    for (at, placed) in rows.iter().enumerate() {
        let row = &placed.row;
        one_of(reader, placed, &row.class, CLASSES);
        if row.first > row.last {
            let message = format!("the range {}..{} is backwards", row.first, row.last);
            reader.fault_at(placed.place.clone(), message, "write the smaller number as 'first'");
        }
        // A letter variable (`VX`) has its letter's number, which is not that of `V24`.
        let overlapped = rows.iter().take(at).map(|earlier| &earlier.row).find(|earlier| {
            earlier.name == row.name
                && (earlier.class == "letter") == (row.class == "letter")
                && earlier.first <= row.last
                && row.first <= earlier.last
        });
        if let Some(earlier) = overlapped {
            let message = format!(
                "{name}{}..{} overlaps {name}{}..{}",
                row.first,
                row.last,
                earlier.first,
                earlier.last,
                name = row.name
            );
            reader.fault_at(placed.place.clone(), message, "give each variable one class");
        }
    }
}

/// A variable that programs may use freely is no system variable.
fn free_or_system(reader: &mut Reader, tables: &Tables) {
    for placed in tables.variables.iter().filter(|placed| placed.row.class != "letter") {
        let class = &placed.row;
        let system = tables.system.iter().map(|system| &system.row).find(|system| {
            let Some((first, last)) = system.first.zip(system.last()) else { return false };
            system.name == class.name
                && (class.first.max(first)..=class.last.min(last))
                    .take(100_000)
                    .any(|number| system.subscripts_of(number).is_some())
        });
        if let Some(system) = system {
            let message = format!("{}{}..{} holds {}", class.name, class.first, class.last, system.fact());
            reader.fault_at(placed.place.clone(), message, "a variable is free or of the system");
        }
    }
}

/// What a setting changes must exist, with that value.
fn settings(reader: &mut Reader, tables: &Tables) {
    for placed in &tables.settings {
        let row = &placed.row;
        let values: Vec<&str> = row.values.iter().map(String::as_str).collect();
        let default = row.default.as_ref().filter(|_| !values.is_empty());
        default.into_iter().chain(row.bars.keys()).for_each(|value| one_of(reader, placed, value, &values));
        if let Some(tells) = row.tells.as_deref() {
            one_of(reader, placed, tells, TELLS);
        }
        for (target, value) in row.sets.values().flatten() {
            let known = match target.split_once(':') {
                Some(("behaviour", name)) => {
                    Question::find(name).is_some_and(|known| known.answers().admits(value))
                }
                Some(("limit", name)) => tables.limits.iter().any(|limit| limit.row.name == name),
                Some(("numbers", "bare_length" | "bare_argument" | "bare_feed" | "arithmetic")) => true,
                Some(("text", "program_max")) => value.parse().is_ok_and(|most: u32| most > 0),
                Some(("numbers", "feed_parts")) => value.parse().is_ok_and(|parts: f64| parts >= 1.0),
                _ => false,
            };
            if !known {
                let help =
                    "it is 'behaviour:NAME', 'limit:NAME' or 'numbers:bare_length', with a value of it";
                reader.fault_at(placed.place.clone(), format!("cannot set '{target}' to '{value}'"), help);
            }
        }
    }
}

/// `machine` and `when` name what exists.
fn conditions(reader: &mut Reader, tables: &Tables) {
    let rows = (tables.codes.iter().map(|p| (&p.place, &p.row.machine, &p.row.when)))
        .chain(tables.words.iter().map(|p| (&p.place, &p.row.machine, &p.row.when)))
        .chain(tables.system.iter().map(|p| (&p.place, &p.row.machine, &p.row.when)))
        .chain(tables.forbidden.iter().map(|p| (&p.place, &p.row.machine, &p.row.when)))
        .chain(tables.behaviours.iter().map(|p| (&p.place, &p.row.machine, &None)))
        .chain(tables.settings.iter().map(|p| (&p.place, &p.row.machine, &None)));
    for (place, machine, when) in rows {
        if let Some(machine) = machine
            && !matches!(machine.as_str(), "mill" | "lathe")
        {
            reader.fault_at(place.clone(), format!("unknown machine '{machine}'"), "it is 'mill' or 'lathe'");
        }
        if let Some(when) = when {
            let known = overlay::conditions(when).all(|(name, mut values)| {
                if let Some(letter) = name.strip_prefix("axis.") {
                    let is_axis = Axis::ALL.iter().any(|axis| format!("{axis:?}") == letter);
                    return is_axis && values.all(|value| matches!(value, "no" | "open"));
                }
                let mut settings = tables.settings.iter().filter(|setting| setting.row.name == name);
                settings.any(|setting| {
                    values.clone().all(|value| setting.row.values.iter().any(|known| known == value))
                })
            });
            if !known {
                let help = "write 'setting.NAME=VALUE' with a setting of this file and one of its values, or 'axis.A=no' or 'axis.A=open'";
                reader.fault_at(place.clone(), format!("no setting says '{when}'"), help);
            }
        }
    }
}

/// Each is one that the emulated controls know.
fn matters(reader: &mut Reader, rows: &[Placed<Matter>]) {
    for Placed { row, place, .. } in rows {
        if super::matters::meaning(&row.fact()).is_none() {
            let help = "src/dialect/matters.rs lists them, with 'machine:' before the name";
            reader.fault_at(place.clone(), format!("no matter is named '{}'", row.name), help);
        }
    }
}
