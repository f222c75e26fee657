//! `macroglot dialects [D]`.

use super::{WELL, common};
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
    match &arguments.dialect {
        None => common::print(&matrix()),
        Some(name) => match common::control(name, arguments.machine.as_deref()) {
            Ok(control) => common::print(&page(&control)),
            Err(code) => return code,
        },
    }
    WELL
}
