//! The trace of a run, for people and for programs. `docs/trace.md` describes both.

use crate::control::trace::{AXIS_NAMES, Event, EventKind, Position, Program};
use crate::control::{End, Heard, Run};
use crate::library::Input;
use crate::text::{LineIndex, shown, write_json};
use serde::Serialize;
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
    what: &'a EventKind,
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
    end: &'a End,
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
        let goes_on = match run.end {
            End::StepBudget | End::TimeBudget => "; the program goes on, and --steps allows more",
            _ => "",
        };
        writeln!(self.out, "\n{} blocks{goes_on}", run.steps)
    }
}

/// Axes that changed, or all three where none did.
fn axes(from: &Position, to: &Position) -> String {
    let mut out = String::new();
    for (axis, name) in AXIS_NAMES.iter().enumerate() {
        let (a, b) = (from.0[axis], to.0[axis]);
        if a != b {
            out.push(' ');
            out.extend(name.chars().map(|letter| letter.to_ascii_uppercase()));
            out += &number(b);
        }
    }
    out
}

/// A number to the sixth place, without trailing zeros.
pub(super) fn number(value: f64) -> String {
    let Some(millionths) = millionths(value) else { return long(value) };
    let sign = if millionths < 0 { "-" } else { "" };
    let (whole, mut rest, mut places) =
        (millionths.unsigned_abs() / MILLION, millionths.unsigned_abs() % MILLION, 6);
    if rest == 0 {
        return format!("{sign}{whole}");
    }
    while rest.is_multiple_of(10) {
        (rest, places) = (rest / 10, places - 1);
    }
    format!("{sign}{whole}.{rest:0places$}")
}

const MILLION: u64 = 1_000_000;

/// The nearest whole number of millionths, where that is sure: not where two are as near, and not of so large a number that
/// its product is off.
fn millionths(value: f64) -> Option<i64> {
    let scaled = value * MILLION as f64;
    let beside_tie = (scaled - scaled.floor() - 0.5).abs() > 1e-3;
    // The product is off by 2e-5 at the most.
    (scaled.abs() < 1e11 && beside_tie).then(|| scaled.round() as i64)
}

/// The same of any number, by its exact digits.
fn long(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

fn describe(what: &EventKind, programs: &[Program]) -> String {
    use EventKind::*;
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
        Thread { from, to, lead, .. } => format!("thread {}  lead {}", axes(from, to), number(*lead)),
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
        Roughing { cycle, depth, allowance: [x, z], contour, .. } => format!(
            "rough   {cycle} of {} lines and arcs, {} deep, leaves X{} Z{}",
            contour.len(),
            number(*depth),
            number(*x),
            number(*z)
        ),
        Dwell { seconds } => format!("dwell   {} s", number(*seconds)),
        Spindle { direction, speed, .. } => format!("spindle {direction:?} {}", number(*speed)),
        SpeedLimit { speed } => format!("speed   at most {}", number(*speed)),
        Coolant { state } => format!("{state}"),
        ToolReady { tool } => format!("tool    {} ready", number(*tool)),
        ToolChange { tool } => format!("tool    {} in the spindle", number(*tool)),
        ToolLength { offset, value } => format!("length  H{offset} = {}", number(*value)),
        CutterRadius { side, offset, value, .. } => {
            format!("cutter  {side:?} D{offset} = {}", number(*value))
        }
        ToolOffset { offset, x, z } => format!("offset  {offset} = X{} Z{}", number(*x), number(*z)),
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
        Act { name, words, surface } => format!("code    {}", act(name, words, *surface)),
        End { by } => format!("{by}"),
        Enter { program, .. } => {
            let name = programs.get(*program as usize).map_or("", |program| program.name.as_str());
            format!("call    {name}")
        }
        Leave => "return".into(),
        Outside(call) => format!("call    {}, which stands in the machine", call.name()),
        Unsure { fact } => format!("unsure  {fact}"),
    }
}

/// A builder's code by its name, with the values of its words.
pub(super) fn act(name: &str, words: &std::collections::BTreeMap<String, f64>, surface: bool) -> String {
    let name = name.split(crate::canon::Act::OWN).next().unwrap_or(name);
    let words = words.iter().map(|(word, value)| format!(" {word} {}", number(*value)));
    let all = words.fold(name.to_owned(), |all, word| all + &word);
    if surface { all + " (surface speed)" } else { all }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_digits_that_they_have_by_exact_arithmetic() {
        let (mut state, mut short) = (1u64, 0);
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        let ties = (0..2000).map(|n| (f64::from(n) + 0.5) / 64.0 / 1e6 * 64.0);
        let halves = (0..2000).map(|n| f64::from(n) / 128.0);
        let drawn = (0..20_000).map(|at: i32| {
            let value = next() as f64 / (1u64 << 53) as f64 - 0.5;
            value * 10f64.powi(at % 14 - 4)
        });
        let drawn: Vec<f64> = drawn.collect();
        let rounded: Vec<f64> = drawn.iter().map(|value| (value * 1e4).round() / 1e4).collect();
        let edges = [0.0, -0.0, 1e-7, -1e-7, 5e-7, -5e-7, 1e5, 1e15, f64::NAN, f64::INFINITY, 0.1, -25.4];
        for value in drawn.into_iter().chain(rounded).chain(ties).chain(halves).chain(edges) {
            short += usize::from(millionths(value).is_some());
            assert_eq!(number(value), long(value), "{value:?}");
            assert_eq!(number(-value), long(-value), "-{value:?}");
        }
        assert!(short > 20_000, "{short}");
    }
}
