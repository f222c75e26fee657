//! `macroglot parse PATH...`.

use super::{FOUND, WELL, common, streams};
use crate::dialect::registry;
use crate::library::{Found, Input, InputError, LeftOut, Source, sources};
use crate::report::{Drawings, left_out_text};
use crate::syntax::{ParseTotals, Parser, parse_faults, parse_totals};
use crate::text::json;
use std::path::PathBuf;
use std::time::Instant;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// Files, folders, or - for standard input
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// The control the programs are written for; recognized if it is left out
    #[arg(long, short, value_name = "D")]
    dialect: Option<String>,
    /// How to print the counts
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Name every file of the folders that is left out
    #[arg(long)]
    verbose: bool,
    /// Draw the faults that are found
    #[arg(long)]
    faults: bool,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

#[derive(Default, serde::Serialize)]
struct Counts {
    files: usize,
    bytes: usize,
    blocks: usize,
    unparsed: usize,
    faulty: usize,
    lossless: usize,
    seconds: f64,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<LeftOut>,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    let Found { programs, mut left_out, errors } = sources(&arguments.paths, &common::endings());
    let mut sources = common::fit(programs, &errors)?;
    let heads = if arguments.dialect.is_some() { &mut [] } else { sources.as_mut_slice() };
    // What cannot be read is said below.
    let heads: Vec<Input> = heads.iter_mut().filter_map(|source| source.head().ok()).collect();
    let name = common::dialect_of(arguments.dialect.as_deref(), &heads)?;
    let Some(parse) = registry::find(&name).map(|entry| entry.parse) else {
        return Err(streams::complain(format!(
            "no dialect is named '{name}': use one of {}",
            common::names()
        )));
    };
    let start = Instant::now();
    let mut counts = Counts::default();
    let (mut read, mut errors) = (Vec::new(), Vec::new());
    for source in sources {
        match totals(source, parse, arguments.faults) {
            Ok((bytes, totals)) => {
                counts.files += 1;
                counts.bytes += bytes;
                counts.blocks += totals.blocks;
                counts.unparsed += totals.unparsed;
                counts.faulty += totals.faulty;
                counts.lossless += usize::from(totals.lossless);
                read.push(bytes);
            }
            Err(error) => errors.push(error),
        }
    }
    common::fit(read, &errors)?;
    left_out.extend(errors.iter().filter_map(InputError::left_out));
    counts.left_out = left_out;
    counts.seconds = start.elapsed().as_secs_f64();
    match arguments.format {
        Format::Json => streams::print(&(json(&counts) + "\n"))?,
        Format::Text => streams::print(&format!(
            "{}{} files, {} bytes, {} blocks: {} unparsed, {} with faults; {} of {} files lossless; {:.3} s\n",
            left_out_text(&counts.left_out, arguments.verbose),
            counts.files,
            counts.bytes,
            counts.blocks,
            counts.unparsed,
            counts.faulty,
            counts.lossless,
            counts.files,
            counts.seconds
        ))?,
    }
    Ok(if counts.unparsed == 0 && counts.lossless == counts.files { WELL } else { FOUND })
}

/// The length of a file and what it amounts to; with `draw`, its faults are drawn.
fn totals(source: Source, parse: Parser, draw: bool) -> Result<(usize, ParseTotals), InputError> {
    if !draw {
        let mut totals = ParseTotals::none();
        let bytes = source.pieces(&mut |piece| totals = totals.plus(parse_totals(piece, parse)))?;
        return Ok((bytes, totals));
    }
    // Drawing a fault takes the text around it.
    let input = source.read()?;
    let faults = parse_faults(&input.bytes, parse);
    let mut drawings = Drawings::new(&input.path.display().to_string(), &input.bytes);
    faults.iter().for_each(|fault| streams::tell_drawn(drawings.draw(&fault.clone().into())));
    drawings.left_out().iter().for_each(streams::remark);
    Ok((input.bytes.len(), parse_totals(&input.bytes, parse)))
}
