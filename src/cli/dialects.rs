//! `macroglot dialects [D]`.

use super::{WELL, common, streams};
use crate::dialect::{matrix, page};
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
        None => streams::print(&matrix()),
        Some(name) => common::control(name, arguments.machine.as_deref())
            .and_then(|control| streams::print(&page(&control))),
    };
    printed.err().unwrap_or(WELL)
}
