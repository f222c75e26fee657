//! `macroglot explain CODE`.

use super::{WELL, streams};
use crate::diag::{ALL, Code};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The code, MG0301 or 0301; without it, all codes
    code: Option<String>,
}

pub fn run(arguments: &Arguments) -> u8 {
    match arguments.code.as_deref().map(|code| (code, Code::find(code))) {
        None => {
            let lines = ALL.iter().map(|code| format!("{}  {}\n", code.number(), code.title()));
            streams::print(&lines.collect::<String>()).err().unwrap_or(WELL)
        }
        Some((_, Some(code))) => streams::print(&crate::report::explain(code)).err().unwrap_or(WELL),
        Some((wanted, None)) => streams::complain(format!(
            "no diagnostic has the code '{wanted}'; 'macroglot explain' lists them all"
        )),
    }
}
