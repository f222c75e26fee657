//! `macroglot ir FILE`.

use super::{FOUND, WELL, common, streams};
use crate::diag::Severity;
use crate::ir::Module;
use crate::report::Drawings;
use crate::syntax::parse_file;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A file, or - for standard input
    file: PathBuf,
    /// The control the program is written for; recognized where it is left out
    #[arg(long, short, value_name = "D")]
    dialect: Option<String>,
    /// The machine's profile
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> u8 {
    match print(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn print(arguments: &Arguments) -> Result<u8, u8> {
    let inputs = common::read(std::slice::from_ref(&arguments.file))?;
    let name = common::dialect_of(arguments.dialect.as_deref(), &inputs)?;
    let control = common::control(&name, arguments.machine.as_deref())?;
    let entry = control.entry();
    let mut refused = false;
    for (at, input) in inputs.iter().enumerate() {
        let lowered = (entry.lower)(&parse_file(&input.bytes, entry.parse), at, &input.name, &control);
        let mut drawings = Drawings::new(&input.path.display().to_string(), &input.bytes);
        let mut module = Module { names: lowered.names, ..Module::default() };
        for (program, diagnostics) in lowered.programs {
            for diagnostic in &diagnostics {
                refused |= diagnostic.severity() == Severity::Error;
                streams::tell_drawn(drawings.draw(diagnostic));
            }
            module.programs.push(program);
        }
        drawings.left_out().iter().for_each(streams::remark);
        streams::print(&module.to_string())?;
    }
    Ok(if refused { FOUND } else { WELL })
}
