//! The command line: arguments in, exit code out, no logic.
//!
//! One file a subcommand. Standard output is data, standard error is for people: progress
//! (on a terminal only), summaries and diagnostics. Exit codes: 0 all well; 1 something was
//! refused, differs or fails the check; 2 wrong usage or unreadable input.

mod accept;
mod check;
mod common;
mod completions;
mod convert;
mod dialects;
mod diff;
mod drawing;
mod explain;
mod ir;
mod jobs;
mod man;
mod outcome;
mod pager;
mod parse;
mod reviews;
mod run;
mod shelves;
mod streams;
mod survey;
mod verify;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Translates parametric CNC programs from one control to another.
#[derive(Debug, Parser)]
#[command(name = "macroglot", version, about, max_term_width = 100, disable_help_subcommand = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Look over a library: what it is, and what must be known of its machines
    Survey(survey::Arguments),
    /// Convert programs, whole folders at once, for another control
    Convert(convert::Arguments),
    /// Accept what a conversion asks of a person, so that it is not asked again before it changes
    Accept(accept::Arguments),
    /// Check programs before they are committed: read, lint, round trips, fresh conversions
    Check(check::Arguments),
    /// Read programs, count their blocks and check that nothing is lost
    Parse(parse::Arguments),
    /// Run a program and its conversion on emulated controls and compare what the machines do
    Verify(verify::Arguments),
    /// Print what changed for the machine between two programs, or two folders of them
    Diff(diff::Arguments),
    /// Run a program on its emulated control and print what the machine would do
    Run(run::Arguments),
    /// Print the intermediate form of a program
    Ir(ir::Arguments),
    /// Print what the controls have and do, with sources
    Dialects(dialects::Arguments),
    /// Explain a diagnostic
    Explain(explain::Arguments),
    /// Print a completion script for a shell
    Completions(completions::Arguments),
    /// Print a manual page
    Man(man::Arguments),
}

/// All went well.
pub(crate) const WELL: u8 = 0;
/// Something was refused, differs or fails the check.
pub(crate) const FOUND: u8 = 1;
/// Wrong usage or unreadable input.
pub(crate) const UNUSABLE: u8 = 2;

/// Ended by the keyboard, as shells count it.
const INTERRUPTED: i32 = 130;

/// Runs the command line.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(answer) => return ExitCode::from(streams::answer(&answer)),
    };
    // Where no handler can be had, the next run removes what this one leaves.
    let _ = ctrlc::set_handler(|| {
        let _made = crate::library::abandon();
        std::process::exit(INTERRUPTED);
    });
    let code = match cli.command {
        Command::Survey(arguments) => survey::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Accept(arguments) => accept::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Parse(arguments) => parse::run(&arguments),
        Command::Run(arguments) => run::run(&arguments),
        Command::Verify(arguments) => verify::run(&arguments),
        Command::Diff(arguments) => diff::run(&arguments),
        Command::Ir(arguments) => ir::run(&arguments),
        Command::Dialects(arguments) => dialects::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
        Command::Man(arguments) => man::run(&arguments),
    };
    ExitCode::from(code)
}
