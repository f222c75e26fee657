//! `macroglot man [COMMAND]`.

use super::streams::{complain, print};
use super::{Cli, WELL};
use clap::{Command, CommandFactory};
use clap_mangen::Man;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The command whose page is wanted; the page of macroglot itself without one
    command: Option<String>,
}

pub fn run(arguments: &Arguments) -> u8 {
    page(arguments.command.as_deref()).and_then(|page| print(&page)).err().unwrap_or(WELL)
}

fn page(wanted: Option<&str>) -> Result<String, u8> {
    let mut all = Cli::command();
    all.build();
    let command = match wanted {
        None => all,
        Some(name) => {
            let unknown = || {
                let names: Vec<&str> = all.get_subcommands().map(Command::get_name).collect();
                complain(format!("no command is named '{name}': use one of {}", names.join(", ")))
            };
            // Built, it has the name that `man` finds it by: macroglot-convert.
            all.find_subcommand(name).cloned().ok_or_else(unknown)?
        }
    };
    let mut page = Vec::new();
    Man::new(command).render(&mut page).map_err(complain)?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
