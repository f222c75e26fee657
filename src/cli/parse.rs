//! `macroglot parse PATH...`.

use super::{FOUND, WELL, common};
use crate::dialect::registry;
use crate::report::Sheet;
use crate::syntax::{parse_file, parse_totals};
use std::path::PathBuf;
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files, folders, or - for standard input
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// The control the programs are written for; recognized where it is left out
    #[arg(long, short, value_name = "D")]
    dialect: Option<String>,
    /// How to print the counts
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Draw every fault that is found
    #[arg(long)]
    faults: bool,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

#[derive(serde::Serialize)]
struct Counts {
    files: usize,
    bytes: usize,
    blocks: usize,
    unparsed: usize,
    faulty: usize,
    lossless: usize,
    seconds: f64,
}

pub fn run(arguments: &Arguments) -> u8 {
    let inputs = match common::read(&arguments.paths) {
        Ok(inputs) => inputs,
        Err(code) => return code,
    };
    let name = match common::dialect_of(arguments.dialect.as_deref(), &inputs) {
        Ok(name) => name,
        Err(code) => return code,
    };
    let Some(parse) = registry::find(&name).map(|entry| entry.parse) else {
        return common::complain(format!("no dialect is named '{name}': use one of {}", common::names()));
    };
    let start = Instant::now();
    let mut counts = Counts {
        files: inputs.len(),
        bytes: 0,
        blocks: 0,
        unparsed: 0,
        faulty: 0,
        lossless: 0,
        seconds: 0.0,
    };
    for input in &inputs {
        let totals = parse_totals(&input.bytes, parse);
        counts.bytes += input.bytes.len();
        counts.blocks += totals.blocks;
        counts.unparsed += totals.unparsed;
        counts.faulty += totals.faulty;
        counts.lossless += usize::from(totals.lossless);
        if arguments.faults && totals.faulty > 0 {
            let sheet = Sheet::new(&input.path.display().to_string(), &input.bytes);
            for fault in parse_file(&input.bytes, parse).blocks.iter().flat_map(|block| &block.errors) {
                eprint!("{}", sheet.draw(&fault.clone().into()));
            }
        }
    }
    counts.seconds = start.elapsed().as_secs_f64();
    match arguments.format {
        Format::Json => common::print(&(serde_json::to_string(&counts).unwrap_or_default() + "\n")),
        Format::Text => common::print(&format!(
            "{} files, {} bytes, {} blocks: {} unparsed, {} with faults; {} of {} files lossless; {:.3} s\n",
            counts.files,
            counts.bytes,
            counts.blocks,
            counts.unparsed,
            counts.faulty,
            counts.lossless,
            counts.files,
            counts.seconds
        )),
    }
    if counts.unparsed == 0 && counts.lossless == counts.files { WELL } else { FOUND }
}
