//! `macroglot completions SHELL`.

use super::{Cli, WELL, streams};
use clap::CommandFactory;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The shell
    shell: clap_complete::Shell,
}

pub fn run(arguments: &Arguments) -> u8 {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "macroglot", &mut script);
    streams::print(&String::from_utf8_lossy(&script)).err().unwrap_or(WELL)
}
