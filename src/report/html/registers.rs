//! The registers of the target, and what each holds.

use super::super::Part;
use super::{escaped, plural};
use crate::verify::class_of;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Registers that are listed of a library.
const MOST: usize = 2000;

/// A register of the target and what it holds.
pub struct Held<'a> {
    /// Its name.
    pub register: String,
    /// The variable, as the source names it.
    pub variable: &'a str,
}

/// The registers that hold variables of the source, in the order of their numbers.
pub fn held<'a>(part: &Part<'a>) -> Vec<Held<'a>> {
    let classes = part.controls[1].classes();
    let Some(row) = classes.iter().find(|row| row.class != "letter") else { return Vec::new() };
    let mut all: Vec<(u32, &str)> =
        part.conversion.lock.variables.iter().map(|(name, number)| (*number, name.as_str())).collect();
    all.sort_unstable();
    let named = |(number, variable)| Held { register: format!("{}{number}", row.name), variable };
    all.into_iter().map(named).collect()
}

/// The registers of each library.
pub fn registers(out: &mut String, parts: &[Part<'_>]) {
    out.push_str(
        "<h2 id=\"registers\">Registers</h2>\n<p class=\"small\">Variables that programs share, and those of a main program. What a call \
         has for itself is named in the comment at the head of each program.</p>\n",
    );
    for part in parts {
        let _ = writeln!(out, "<h3>{} to {}</h3>", escaped(part.from), escaped(part.to));
        let lock = &part.conversion.lock;
        let held = held(part);
        if held.is_empty() {
            out.push_str("<p>Every variable has its own number.</p>\n");
        } else {
            out.push_str("<table class=\"list\">\n<tr><th>Register<th>Holds<th>After power-off\n");
            for Held { register, variable } in held.iter().take(MOST) {
                let [from, to] = [(0, *variable), (1, register.as_str())]
                    .map(|(side, name)| class_of(part.controls[side], name).and_then(|class| class.retained));
                let kept = |kept: Option<bool>| match kept {
                    Some(true) => "kept",
                    Some(false) => "lost",
                    None => "not known",
                };
                let power = match (from, to) {
                    (from, to) if from == to => kept(to).to_owned(),
                    (from, to) => format!("{}; on the source {}", kept(to), kept(from)),
                };
                let _ = writeln!(out, "<tr><td>{}<td>{}<td>{power}", escaped(register), escaped(variable));
            }
            out.push_str("</table>\n");
            if held.len() > MOST {
                let _ = writeln!(out, "<p>and {} more, in the lock</p>", held.len() - MOST);
            }
        }
        let prefix = |numbers: &[u32]| {
            let name = part.controls[1].classes().iter().find(|row| row.class != "letter");
            let name = name.map_or("", |row| row.name.as_str());
            numbers.iter().map(|number| format!("{name}{number}")).collect::<Vec<_>>().join(", ")
        };
        if !lock.scratch.is_empty() || !lock.of_words.is_empty() {
            let mut all = prefix(&lock.scratch);
            lock.of_words.iter().for_each(|name| all += &format!(" {name}"));
            let _ = writeln!(
                out,
                "<p>Values in between, on which no program may rely: {}</p>",
                escaped(all.trim())
            );
        }
        if !part.conversion.taken.is_empty() {
            let ask = match part.conversion.states_reserved {
                true => "",
                false => {
                    ". If the machine uses any of them, name it in 'reserved' of its profile and convert again"
                }
            };
            let _ = writeln!(out, "<p>Registers taken: {}{ask}.</p>", escaped(&part.conversion.taken));
        }
        programs(out, &lock.programs);
    }
}

/// The numbers that programs got.
fn programs(out: &mut String, programs: &BTreeMap<String, u32>) {
    if programs.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "<details><summary>{} got a number of the target</summary>\n<table class=\"list\">\n<tr><th>Program of the source<th>Number on the \
         target",
        plural(programs.len(), "program")
    );
    for (name, number) in programs.iter().take(MOST) {
        let _ = writeln!(out, "<tr><td>{}<td>{number}", escaped(name));
    }
    out.push_str("</table>\n</details>\n");
}
