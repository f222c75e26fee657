//! `macroglot run FILE`.

use super::common::{kind_told, not_over, own_profile, profile_files, read, source};
use super::streams::{be_open, complain, complain_lines, print_by, tell};
use super::{FOUND, UNUSABLE, WELL, drawing};
use crate::control::trace::Place;
use crate::control::{End, Library, LoadedFile, ProgramRef, Run, Scenario};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::library::Input;
use crate::report::{Sheet, TraceFormat, TraceWriter, backplot};
use crate::syntax::{ParsedFile, parse_file};
use crate::text::shown;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::sync::mpsc::sync_channel;

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// A file, or - for standard input; its first program runs
    file: PathBuf,
    /// The control the program is written for; recognized if it is left out
    #[arg(long, short, value_name = "D")]
    dialect: Option<String>,
    /// The machine's profile
    #[arg(long, value_name = "FILE")]
    machine: Option<PathBuf>,
    /// Files and folders with the programs that it calls
    #[arg(long, value_name = "PATH")]
    library: Vec<PathBuf>,
    /// The circumstances of the run: offsets, tools, probe hits, switches (TOML; see docs/trace.md)
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Start value of a variable, by the control's own name: --set '#1=2.5'; may be given again
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
    /// What the operator answers, in order; may be given again
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    answer: Vec<f64>,
    /// Most blocks that are run, however long that takes; else a million, for ten seconds, or what the
    /// scenario says
    #[arg(long, value_name = "N")]
    steps: Option<u64>,
    /// How to print the trace
    #[arg(long, value_enum, default_value_t = Format::Text)]
    trace: Format,
    /// Draw the tool's path, as SVG, or as PNG if the name ends in .png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Draw it in machine coordinates, not from the work zero
    #[arg(long, requires = "plot")]
    machine_coordinates: bool,
    /// Replace a read-only drawing too
    #[arg(long)]
    force: bool,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    Text,
    Json,
}

impl From<Format> for TraceFormat {
    fn from(format: Format) -> Self {
        match format {
            Format::Text => Self::Text,
            Format::Json => Self::Json,
        }
    }
}

/// How many pieces of a trace wait for being printed; the run waits while there are more.
const WAITING: usize = 4;

/// Bytes of programs whose blocks are held while they run; those of longer ones are read so many bytes at a time.
const HELD: usize = 1 << 20;
const PIECE: usize = 32 << 10;

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    let mut inputs = read(std::slice::from_ref(&arguments.file))?;
    if inputs.len() > 1 {
        return Err(complain("run takes one program: name its file, and name the others with --library"));
    }
    let named = arguments.dialect.as_deref();
    let control = source(named, arguments.machine.as_ref(), &inputs)?;
    let own = own_profile(named, &inputs)?;
    if !arguments.library.is_empty() {
        let others = read(&arguments.library)?;
        let main = inputs.first().map(|input| input.path.clone());
        inputs.extend(others.into_iter().filter(|input| Some(&input.path) != main.as_ref()));
    }
    let control = kind_told(&inputs, control);
    let profiles = profile_files(arguments.machine.iter().chain(&own));
    let also = arguments.scenario.iter().chain(&profiles);
    let read = inputs.iter().map(|input| &input.path).chain(also).map(PathBuf::as_path);
    arguments.plot.as_ref().map_or(Ok(()), |path| not_over(path, read))?;
    let scenario = scenario(arguments, &control)?;
    let run = print_run(arguments, &inputs, &control, &scenario)?;
    if let Some(path) = &arguments.plot {
        let title = inputs.first().map_or_else(String::new, |input| input.name.clone());
        let from = drawing::coordinates(arguments.machine_coordinates);
        drawing::write(path, &backplot(&run, &title, from), arguments.force)?;
    }
    let Some((at, finding)) = finding(&run) else { return Ok(WELL) };
    let file = run.programs.get(at.program as usize).map_or(0, |program| program.file);
    match inputs.get(file) {
        Some(input) => {
            tell(&Sheet::new(&input.path.display().to_string(), &input.bytes).draw(&finding));
        }
        None => tell(&format!("{}\n", finding.message)),
    }
    Ok(FOUND)
}

/// Runs the program and prints its trace. Only a drawing needs all events at once; else the run comes back without those
/// that were printed while it went on.
fn print_run(
    arguments: &Arguments,
    inputs: &[Input],
    control: &Control,
    scenario: &Scenario,
) -> Result<Run, u8> {
    let entry = control.entry();
    let Some(execute) = entry.execute else {
        return Err(complain(format!("there is no emulated control for {}", entry.name)));
    };
    be_open()?;
    let by_need = entry.by_need && inputs.iter().map(|input| input.bytes.len()).sum::<usize>() > HELD;
    let read = |input| match by_need {
        true => ParsedFile::unread(input),
        false => parse_file(input, entry.parse_items),
    };
    let parsed: Vec<ParsedFile<'_>> = inputs.iter().map(|input| read(&input.bytes)).collect();
    let files: Vec<LoadedFile<'_>> = (inputs.iter().zip(&parsed))
        .map(|(input, parsed)| LoadedFile { name: &input.name, parsed })
        .collect();
    let library = match by_need {
        true => Library::read_by_need(&files, entry.parse_items, PIECE),
        false => Library::new(&files),
    };
    let format = arguments.trace.into();
    if arguments.plot.is_some() {
        let run = execute(&library, ProgramRef::FIRST, control, scenario);
        print_by(|out| TraceWriter::new(format, inputs, out).end(&run))?;
        return Ok(run);
    }
    let done = OnceLock::new();
    std::thread::scope(|scope| {
        let (listener, heard) = sync_channel(WAITING);
        let printer = scope.spawn(|| {
            print_by(|out| {
                let mut trace = TraceWriter::new(format, inputs, out);
                heard.into_iter().try_for_each(|heard| trace.heard(&heard))?;
                done.get().map_or(Ok(()), |run| trace.end(run))
            })
        });
        let _ = done.set(execute(&library.heard_by(&listener), ProgramRef::FIRST, control, scenario));
        drop(listener);
        printer.join().unwrap_or(Err(UNUSABLE))
    })?;
    done.into_inner().ok_or(UNUSABLE)
}

/// The scenario file with what the command line adds.
fn scenario(arguments: &Arguments, control: &Control) -> Result<Scenario, u8> {
    let mut scenario = match &arguments.scenario {
        // The machine begins as its profile says.
        None => Scenario {
            as_stated: control.start().iter().map(|mode| mode.op.group()).collect(),
            ..Scenario::default()
        },
        Some(path) => {
            let text = std::fs::read_to_string(path)
                .map_err(|error| complain(format!("{}: {error}", path.display())))?;
            let said = |error| complain_lines(format!("{}: {error}", shown(&path.display().to_string())));
            toml::from_str::<Scenario>(&text).map_err(said)?
        }
    };
    for set in &arguments.set {
        let parts = set.split_once('=').map(|(name, value)| (name.trim(), value.trim().parse::<f64>()));
        let Some((name, Ok(value))) = parts else {
            return Err(complain(format!("--set {set}: write NAME=VALUE, as in --set '#1=2.5'")));
        };
        if !is_variable(control, name) {
            return Err(complain(format!(
                "--set {set}: {} has no variable '{name}'",
                control.dialect().title
            )));
        }
        scenario.variables.insert(name.into(), value);
    }
    scenario.answers.extend(&arguments.answer);
    if let Some(steps) = arguments.steps {
        (scenario.steps, scenario.events, scenario.milliseconds) = (steps, usize::MAX, None);
    }
    scenario.variable_events = true;
    Ok(scenario)
}

/// True for a variable that a program may use freely.
fn is_variable(control: &Control, name: &str) -> bool {
    let digits = name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len());
    let (stem, number) = name.split_at(digits);
    if let Ok(number) = number.parse() {
        return control.variable_class(stem, number).is_some();
    }
    let mut letters = stem.chars();
    letters
        .next_back()
        .is_some_and(|letter| number.is_empty() && control.letter_class(letters.as_str(), letter).is_some())
}

/// Why the run did not come to its end, and at which place.
fn finding(run: &Run) -> Option<(Place, Diagnostic)> {
    let last = run.events.last().map(|event| event.at).unwrap_or_default();
    let (at, code, message) = match &run.end {
        End::Ended => return None,
        End::Alarm { at, stop } => {
            let parts = [stop.number.as_str(), stop.text.as_str()];
            let text = parts.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(": ");
            (*at, Code::AlarmRaised, text)
        }
        End::StepBudget => {
            let text =
                format!("after {} blocks the program is still running; --steps allows more", run.steps);
            (last, Code::NoEnd, text)
        }
        End::TimeBudget => {
            let text = "the program is still running when its time is up; --steps allows more";
            (last, Code::NoEnd, text.into())
        }
        End::Error { at, text } => (*at, Code::CannotRun, text.clone()),
    };
    Some((at, Diagnostic::new(code, at.span, message)))
}
