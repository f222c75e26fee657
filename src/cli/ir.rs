//! `macroglot ir FILE`.

use super::{FOUND, WELL, common, streams};
use crate::diag::{Diagnostic, Severity};
use crate::dialect::Control;
use crate::ir::{Module, Program};
use crate::legalize::pipeline::{self, GROUPS};
use crate::library::{Input, Partway, partway};
use crate::opt::Level;
use crate::report::Drawings;
use crate::syntax::parse_file;
use std::fmt::Write;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A file, or - for standard input
    #[arg(required_unless_present = "passes")]
    file: Option<PathBuf>,
    /// The control the program is written for; recognized if it is left out
    #[arg(long, short, value_name = "D")]
    dialect: Option<String>,
    /// A machine profile of the source or the target (it names its dialect); may be given twice. Of two with one dialect the first is the
    /// source's
    #[arg(long, value_name = "FILE")]
    machine: Vec<PathBuf>,
    /// Print what the passes make of the program for this control
    #[arg(long, short, value_name = "D")]
    to: Option<String>,
    /// Stop after this pass; all of them run if it is left out
    #[arg(long, value_name = "PASS", requires = "to")]
    after: Option<String>,
    /// List the passes in the order they run in
    #[arg(long, conflicts_with_all = ["file", "to", "after"])]
    passes: bool,
}

pub fn run(arguments: &Arguments) -> u8 {
    match print(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn print(arguments: &Arguments) -> Result<u8, u8> {
    let Some(file) = &arguments.file else {
        streams::print(&list())?;
        return Ok(WELL);
    };
    let inputs = common::read(std::slice::from_ref(file))?;
    let named = arguments.dialect.as_deref();
    match &arguments.to {
        Some(to) => {
            let name = common::source_of(named, &[to], &arguments.machine, &inputs)?;
            let (source, target) = common::controls(&name, to, &arguments.machine, None)?;
            legalized(&inputs, &source, &target, arguments.after.as_deref())
        }
        None => lowered(&inputs, &common::source(named, arguments.machine.first(), &inputs)?),
    }
}

/// Prints what a program means, before any pass.
fn lowered(inputs: &[Input], control: &Control) -> Result<u8, u8> {
    let entry = control.entry();
    let mut refused = false;
    for (at, input) in inputs.iter().enumerate() {
        let lowered = (entry.lower)(&parse_file(&input.bytes, entry.parse), at, &input.name, control);
        let (programs, found): (Vec<Program>, Vec<_>) = lowered.programs.into_iter().unzip();
        refused |= tell(input, &found.concat());
        streams::print(&Module { programs, names: lowered.names }.to_string())?;
    }
    Ok(if refused { FOUND } else { WELL })
}

/// Prints what the passes make of a program, up to one of them.
fn legalized(inputs: &[Input], source: &Control, target: &Control, after: Option<&str>) -> Result<u8, u8> {
    let count = match after {
        Some(name) => pipeline::through(name).map_err(streams::complain)?,
        None => usize::MAX,
    };
    let made = partway(inputs, source, target, Level::default(), count).map_err(streams::complain)?;
    let Partway { module, found, registers } = made;
    let refused = inputs.first().is_some_and(|input| tell(input, &found.concat()));
    let mut text = String::new();
    for (var, register) in &registers {
        let _ = writeln!(text, "; {var} is {}{}", register.name, register.number);
    }
    streams::print(&(text + &module.to_string()))?;
    Ok(if refused { FOUND } else { WELL })
}

/// Tells what was found in a file; true if anything is refused.
fn tell(input: &Input, found: &[Diagnostic]) -> bool {
    let mut drawings = Drawings::new(&input.path.display().to_string(), &input.bytes);
    for diagnostic in found {
        streams::tell_drawn(drawings.draw(diagnostic));
    }
    drawings.left_out().iter().for_each(streams::remark);
    found.iter().any(|diagnostic| diagnostic.severity() == Severity::Error)
}

/// The passes by group, each with what it does, needs and may change.
fn list() -> String {
    let mut text = String::from("lower: What a program means, as statements\n");
    for group in GROUPS {
        let _ = writeln!(text, "\n{}: {}", group.name, group.heading);
        for pass in group.passes {
            let _ = writeln!(text, "  {:<17} {}", pass.name, pass.does);
            let needs = match pass.needs {
                [] => String::new(),
                needs => format!("; needs {}", needs.join(", ")),
            };
            let _ = writeln!(text, "  {:<17}   changes {}{needs}", "", pass.changes);
        }
    }
    text + "\nemit: The target's text, which its own grammar reads back\n"
}
