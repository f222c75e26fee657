//! The trace of a run, for people and for programs. `docs/trace.md` describes both.

use crate::control::trace::{AXIS_NAMES, Event, Happening, Position, Program};
use crate::control::{Heard, Run};
use crate::library::Input;
use crate::text::{LineIndex, shown, write_json};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, Write};

/// How a trace is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceFormat {
    /// A table, and the final variables after it.
    Text,
    /// One event a line, then a line with the result.
    Json,
}

/// Prints a trace, piece by piece: a long run need not be kept to be printed.
pub struct TraceWriter<'a, W> {
    format: TraceFormat,
    inputs: &'a [Input],
    indexes: Vec<LineIndex>,
    /// The programs that ran so far.
    programs: Vec<Program>,
    out: W,
}

/// An event as a line of JSON.
#[derive(Serialize)]
struct Line<'a> {
    #[serde(flatten)]
    what: &'a Happening,
    program: &'a str,
    file: &'a str,
    line: u32,
    column: u32,
    block: [u32; 2],
}

/// The last line of JSON.
#[derive(Serialize)]
struct Result<'a> {
    event: &'a str,
    #[serde(flatten)]
    end: &'a crate::control::End,
    steps: u64,
    variables: &'a std::collections::BTreeMap<String, f64>,
}

impl<'a, W: Write> TraceWriter<'a, W> {
    /// Nothing is printed yet.
    pub fn new(format: TraceFormat, inputs: &'a [Input], out: W) -> Self {
        let indexes = inputs.iter().map(|input| LineIndex::new(&input.bytes)).collect();
        Self { format, inputs, indexes, programs: Vec::new(), out }
    }

    /// Prints what was heard of a run while it goes on.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn heard(&mut self, heard: &Heard) -> io::Result<()> {
        self.programs.extend_from_slice(&heard.programs);
        heard.events.iter().try_for_each(|event| self.event(event))
    }

    /// Prints the rest of a run, and its result.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn end(mut self, run: &Run) -> io::Result<()> {
        self.programs.clone_from(&run.programs);
        run.events.iter().try_for_each(|event| self.event(event))?;
        match self.format {
            TraceFormat::Text => self.variables(run),
            TraceFormat::Json => {
                let result =
                    Result { event: "result", end: &run.end, steps: run.steps, variables: &run.variables };
                write_json(&result, &mut self.out)?;
                writeln!(self.out)
            }
        }
    }

    fn event(&mut self, Event { at, what, .. }: &Event) -> io::Result<()> {
        let found = self.programs.get(at.program as usize);
        let program = found.map_or("", |program| &program.name);
        let file = found.map(|program| program.file);
        let place = |file: usize| Some(self.indexes.get(file)?.place(at.span.start));
        let (line, column) = file.and_then(place).unwrap_or((0, 0));
        match self.format {
            TraceFormat::Text => {
                let place = format!("{}:{line}", shown(program));
                let what = describe(what, &self.programs);
                writeln!(self.out, "{place:>12}  {}", shown(what.trim_end()))
            }
            TraceFormat::Json => {
                let file = file.and_then(|file| self.inputs.get(file)).map_or("", |input| &input.name);
                let block = [at.span.start, at.span.end];
                write_json(&Line { what, program, file, line, column, block }, &mut self.out)?;
                writeln!(self.out)
            }
        }
    }

    fn variables(&mut self, run: &Run) -> io::Result<()> {
        if !run.variables.is_empty() {
            writeln!(self.out)?;
        }
        for (name, value) in &run.variables {
            writeln!(self.out, "{name:>12} = {value}")?;
        }
        writeln!(self.out, "\n{} blocks", run.steps)
    }
}

/// Axes that changed, or all three where none did.
fn axes(from: &Position, to: &Position) -> String {
    let mut out = String::new();
    for (axis, name) in AXIS_NAMES.iter().enumerate() {
        let (a, b) = (from.0[axis], to.0[axis]);
        if a != b {
            let _ = write!(out, " {}{}", name.to_uppercase(), number(b));
        }
    }
    out
}

/// A number to the sixth place, without trailing zeros.
fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

fn describe(what: &Happening, programs: &[Program]) -> String {
    use Happening::*;
    match what {
        Rapid { from, to } => format!("rapid  {}", axes(from, to)),
        Feed { from, to, feed, .. } => format!("feed   {}  F{}", axes(from, to), number(*feed)),
        Arc { from, to, centre, radius, sweep, .. } => format!(
            "arc    {}  centre {} {} {}  radius {}  {} degrees",
            axes(from, to),
            number(centre.0[0]),
            number(centre.0[1]),
            number(centre.0[2]),
            number(*radius),
            number(*sweep)
        ),
        Thread { from, to, lead } => format!("thread {}  lead {}", axes(from, to), number(*lead)),
        Probe { from, to, hit, .. } => {
            format!("probe  {}  {}", axes(from, to), if *hit { "touched" } else { "missed" })
        }
        Corner { chamfer, size } => {
            format!("corner  {} {}", if *chamfer { "chamfer" } else { "radius" }, number(*size))
        }
        Hole { cycle, at, bottom } => format!(
            "hole    {cycle} at X{} Y{} Z{} to {}",
            number(at.0[0]),
            number(at.0[1]),
            number(at.0[2]),
            number(*bottom)
        ),
        Dwell { seconds } => format!("dwell   {} s", number(*seconds)),
        Spindle { direction, speed, .. } => format!("spindle {direction:?} {}", number(*speed)),
        SpeedLimit { speed } => format!("speed   at most {}", number(*speed)),
        Coolant { state } => format!("{state}"),
        ToolReady { tool } => format!("tool    {} ready", number(*tool)),
        ToolChange { tool } => format!("tool    {} in the spindle", number(*tool)),
        ToolLength { offset, value } => format!("length  H{offset} = {}", number(*value)),
        CutterRadius { side, offset, value } => format!("cutter  {side:?} D{offset} = {}", number(*value)),
        WorkOffset { number } => format!("work offset {number}"),
        Write { state, subscripts, value } => format!("write   {state} {subscripts:?} = {}", number(*value)),
        Variable { name, value: Some(value) } => format!("set     {name} = {}", number(*value)),
        Variable { name, value: None } => format!("set     {name} = vacant"),
        Stop => "stop".into(),
        OptionalStop => "optional stop".into(),
        Message { text } => format!("message {text}"),
        Alarm(stop) => format!("ALARM   {} {}", stop.number, stop.text),
        Output { text } => format!("output  {text}"),
        Asked { answer } => format!("asked   {}", number(*answer)),
        Other { operation, code: Some(code) } => format!("{operation} {code}"),
        Other { operation, code: None } => format!("{operation}"),
        End { by } => format!("{by}"),
        Enter { program, .. } => {
            let name = programs.get(*program as usize).map_or("", |program| program.name.as_str());
            format!("call    {name}")
        }
        Leave => "return".into(),
        Unsure { fact } => format!("unsure  {fact}"),
    }
}
