//! The trace of a run, for people and for programs. `docs/trace.md` describes both.

use crate::control::Run;
use crate::control::trace::{AXIS_NAMES, Event, Happening, Place, Position};
use crate::library::Input;
use crate::text::{LineIndex, shown};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Finds lines of places.
struct Lines<'a> {
    run: &'a Run,
    inputs: &'a [Input],
    indexes: Vec<LineIndex>,
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

impl<'a> Lines<'a> {
    fn new(run: &'a Run, inputs: &'a [Input]) -> Self {
        let indexes = inputs.iter().map(|input| LineIndex::new(&input.bytes)).collect();
        Self { run, inputs, indexes }
    }

    /// Program, file, line and column of a place.
    fn place(&self, at: Place) -> (&'a str, &'a str, u32, u32) {
        let Some(program) = self.run.programs.get(at.program as usize) else { return ("", "", 0, 0) };
        let file = self.inputs.get(program.file).map_or("", |input| input.name.as_str());
        let (line, column) =
            self.indexes.get(program.file).map_or((0, 0), |index| index.place(at.span.start));
        (&program.name, file, line, column)
    }
}

/// Writes one event a line, then a line with the result.
///
/// # Errors
/// Those of `out`.
pub fn trace_json(run: &Run, inputs: &[Input], mut out: impl Write) -> io::Result<()> {
    let lines = Lines::new(run, inputs);
    for Event { at, what, .. } in &run.events {
        let (program, file, line, column) = lines.place(*at);
        let block = [at.span.start, at.span.end];
        let line = Line { what, program, file, line, column, block };
        serde_json::to_writer(&mut out, &line)?;
        writeln!(out)?;
    }
    let result = Result { event: "result", end: &run.end, steps: run.steps, variables: &run.variables };
    serde_json::to_writer(&mut out, &result)?;
    writeln!(out)
}

/// Writes the trace as a table, and the final variables after it.
///
/// # Errors
/// Those of `out`.
pub fn trace_text(run: &Run, inputs: &[Input], mut out: impl Write) -> io::Result<()> {
    let lines = Lines::new(run, inputs);
    for Event { at, what, .. } in &run.events {
        let (program, _, line, _) = lines.place(*at);
        let place = format!("{}:{line}", shown(program));
        writeln!(out, "{place:>12}  {}", shown(describe(what, run).trim_end()))?;
    }
    if !run.variables.is_empty() {
        writeln!(out)?;
    }
    for (name, value) in &run.variables {
        writeln!(out, "{name:>12} = {value}")?;
    }
    writeln!(out, "\n{} blocks", run.steps)
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

fn describe(what: &Happening, run: &Run) -> String {
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
            let name = run.programs.get(*program as usize).map_or("", |program| program.name.as_str());
            format!("call    {name}")
        }
        Leave => "return".into(),
        Unsure { fact } => format!("unsure  {fact}"),
    }
}
