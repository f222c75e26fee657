//! What variables, and the spaces that they are in, are called.

use crate::dialect::{Control, Question};
use crate::ir::{Bank, Class, Module, Var};
use crate::legalize::Context;

/// What stands between the name of a local and the program whose it is, where another one may have a local of the same
/// name: `#1 of O9010`.
pub(in crate::legalize) const OF: &str = " of ";

/// Names that a message tells of before it says how many more there are.
pub(super) const MOST_NAMED: usize = 8;

/// Names as a sentence has them: `a, b and c`; the first ones alone if they are many.
pub(super) fn listed(mut names: Vec<String>) -> String {
    let more = names.len().saturating_sub(MOST_NAMED);
    names.truncate(MOST_NAMED);
    if more > 0 {
        names.push(format!("{more} more"));
    }
    in_a_sentence(&names)
}

/// Names as a sentence has them, all of them.
pub(in crate::legalize) fn in_a_sentence(names: &[String]) -> String {
    match names.split_last() {
        Some((last, first)) if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        _ => names.concat(),
    }
}

/// Whose a variable is, as a text goes on after its name: ` of O9010`; nothing if the text does not say it.
pub(in crate::legalize) fn whose(rest: &str) -> &str {
    let program = rest.strip_prefix(OF).unwrap_or_default();
    let end = program.find(|sign: char| !sign.is_alphanumeric()).unwrap_or(program.len());
    if end == 0 { "" } else { &rest[..OF.len() + end] }
}

/// The class that a bank counts in.
pub(super) fn class_of(bank: Bank) -> Class {
    if bank == Bank::Parametric { Class::Parametric } else { Class::Global }
}

/// What the run of registers of a bank is called in the lock.
pub(in crate::legalize) fn run_name(bank: Bank, source: &Control) -> String {
    let row = source.classes().iter().find(|row| Some(row.class.as_str()) == bank.class());
    let name = row.map(|row| row.name.as_str()).or(source.numbered()).unwrap_or_default();
    format!("{name}(..)")
}

/// The variables of a bank of its own: their numbers and names.
pub(in crate::legalize) fn members(bank: Bank, module: &Module, context: &Context<'_>) -> Vec<(u32, String)> {
    let numbers = reached(bank, context.source).into_iter();
    let named =
        |number| Some((number, name_of(Var { class: class_of(bank), number }, module, context.source)?));
    numbers.filter_map(named).collect()
}

/// The numbers that a computed one can be, in a bank of its own.
pub(super) fn reached(bank: Bank, source: &Control) -> Vec<u32> {
    let Some(wanted) = bank.class() else { return Vec::new() };
    source
        .classes()
        .iter()
        .filter(|row| row.class == wanted && !row.nullable)
        .flat_map(|row| row.first..=row.last)
        .collect()
}

/// The name of a variable on the source.
pub fn name_of(var: Var, module: &Module, source: &Control) -> Option<String> {
    if let Some(name) = module.names.get(&var) {
        return Some(name.clone());
    }
    numbered_name(var, source)
}

/// The name of a variable by its number.
pub(in crate::legalize) fn numbered_name(var: Var, source: &Control) -> Option<String> {
    let class = match var.class {
        Class::Local => "local",
        Class::Common => "common",
        Class::Retained => "retained",
        Class::Global => "global",
        Class::Parametric => "parametric",
        Class::Register => return Some(format!("register {}", var.number)),
        Class::Temp | Class::Static => return None,
    };
    let rows = source.classes();
    let row = rows.iter().find(|row| row.class == class && (row.first..=row.last).contains(&var.number));
    let row = row.or_else(|| {
        rows.iter().find(|row| row.class != "letter" && (row.first..=row.last).contains(&var.number))
    });
    let name = row.map(|row| row.name.as_str()).or(source.numbered()).unwrap_or_default();
    Some(format!("{name}{}", var.number))
}

/// True if variables that may be vacant have the same numbers on both controls: where there are such, they have.
pub(super) fn numbers_alike(context: &Context<'_>) -> bool {
    context.target.is(Question::Vacancy)
}

/// True for a variable whose number the target has too.
pub(in crate::legalize) fn keeps_number(var: Var, context: &Context<'_>) -> bool {
    let name = pool_name(context.target);
    let there = context.target.variable_class(&name, var.number);
    let same_kind = there.is_some_and(|row| (row.class == "local") == (var.class == Class::Local));
    var.class.nullable()
        && numbers_alike(context)
        && same_kind
        && !(var.class != Class::Local && context.target.standing_results().names(var.number))
        && !context.target.is_reserved(&name, var.number)
}

/// The name that the target's registers have before their number.
pub(super) fn pool_name(target: &Control) -> String {
    let shared = target.classes().iter().find(|row| row.class != "local" && row.class != "letter");
    shared.map(|row| row.name.as_str()).or(target.numbered()).unwrap_or_default().to_owned()
}
