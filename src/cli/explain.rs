//! `macroglot explain CODE`.

use super::{WELL, common};
use crate::diag::{ALL, Code};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The code, MG0301 or 0301; all codes where none is given
    code: Option<String>,
}

pub fn run(arguments: &Arguments) -> u8 {
    match arguments.code.as_deref().map(|code| (code, Code::find(code))) {
        None => {
            let lines = ALL.iter().map(|code| format!("{}  {}\n", code.number(), code.title()));
            common::print(&lines.collect::<String>());
            WELL
        }
        Some((_, Some(code))) => {
            common::print(&crate::report::explain(code));
            WELL
        }
        Some((wanted, None)) => common::complain(format!(
            "no diagnostic has the code '{wanted}'; 'macroglot explain' lists them all"
        )),
    }
}
