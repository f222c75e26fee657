//! `macroglot dialects [D]`.

use super::{WELL, common, streams};
use crate::dialect::{Entry, matrix, page, registry};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A dialect, for all that is known of it; without it the controls side by side
    dialect: Option<String>,
    /// A machine profile to lay over the dialect
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
}

pub fn run(arguments: &Arguments) -> u8 {
    let printed = match &arguments.dialect {
        None => registry::all().iter().try_for_each(check).and_then(|()| streams::print(&matrix())),
        Some(name) => common::control(name, arguments.machine.as_deref()).and_then(|control| {
            check(control.entry())?;
            streams::print(&page(&control))
        }),
    };
    printed.err().unwrap_or(WELL)
}

/// Conversions take it that a shipped table is right; whoever reads it is told where it is not.
fn check(entry: &Entry) -> Result<(), u8> {
    entry.check().map_err(|faults| streams::complain_lines(entry.faults_as_text(&faults)))
}
