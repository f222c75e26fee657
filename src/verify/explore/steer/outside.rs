//! One number that a program takes from outside, and what it may be.

use crate::canon::{Group, Sys};
use crate::control::Scenario;
use crate::control::scenario::Probe;
use crate::verify::explore::inputs::Inputs;
use std::collections::BTreeMap;

/// The circumstances of a run: a scenario, and what is in registers that the target alone has.
#[derive(Clone, Debug)]
pub struct Circumstances {
    /// What both sides meet.
    pub scenario: Scenario,
    /// What is in registers of the target alone.
    pub theirs: BTreeMap<String, f64>,
    /// What stands in place of literals that are edited alike on both sides.
    pub literals: Vec<f64>,
}

impl Circumstances {
    /// Circumstances of texts as they stand.
    pub fn new(scenario: Scenario, theirs: BTreeMap<String, f64>) -> Self {
        Self { scenario, theirs, literals: Vec::new() }
    }
}

/// One number that a program takes from outside.
#[derive(Clone, Debug, PartialEq)]
pub enum Input {
    /// A variable, and whether it is one that the target alone has.
    Variable(String, bool),
    /// A value of machine state, by place.
    State(usize),
    /// An answer of the operator, by place.
    Answer(usize),
    /// A work offset: its number, and the axis from 0.
    Work(u32, usize),
    /// The length of a tool.
    Length(u32),
    /// The radius of a tool.
    Radius(u32),
    /// The wear of a tool's length.
    LengthWear(u32),
    /// The wear of a tool's radius.
    RadiusWear(u32),
    /// How far a probe move gets, by place.
    Probe(usize),
    /// Where the machine stands at the start: the axis from 0.
    Start(usize),
    /// The work offset that is selected at the start, as the number of its code.
    Selected,
    /// The tool in the spindle at the start.
    Tool,
    /// The time of day, in seconds.
    Time,
    /// The day, counted from some day on.
    Day,
    /// A literal that is edited alike on both sides, by place.
    Literal(usize),
}

/// Answers that are steered.
const FIRST: usize = 4;
/// Probe moves that are steered.
const PROBES: usize = 8;
/// Inputs that are looked at, at the most.
const MOST_INPUTS: usize = 400;
/// The code of the first work offset, on every control that has such codes.
const FIRST_OFFSET: f64 = 54.0;
/// The letter T, counted from A as 1.
const T: u32 = 20;

/// The inputs of a program, those first that conditions ask most. `reached` are those that a run came to by computed
/// numbers.
pub fn inputs_of(inputs: &Inputs, reached: &[Input], scenario: &Scenario) -> Vec<Input> {
    let variables = inputs.variables.iter().map(|input| Input::Variable(input.name.clone(), input.theirs));
    let read = |wanted: Sys| inputs.cells.keys().any(|(state, _)| *state == wanted);
    let tool = read(Sys::ActiveTool) || inputs.cells.contains_key(&(Sys::Address, vec![T]));
    // What the profile says of the start, or the operator's machine, is not tried otherwise.
    let is_open = scenario.called && !scenario.as_stated.contains(&Group::WorkOffset);
    let selected = inputs.cells.keys().any(|(state, subscripts)| Input::is_selected(*state, subscripts));
    let machine = [
        (Input::Selected, is_open && selected),
        (Input::Time, read(Sys::Time)),
        (Input::Day, read(Sys::Date) || read(Sys::ShortDate)),
        (Input::Tool, tool),
    ];
    let machine = machine.into_iter().filter(|(_, is_read)| *is_read).map(|(input, _)| input);
    let cells = inputs.cells.keys().filter_map(|(state, subscripts)| Input::of_cell(*state, subscripts));
    let state = (0..scenario.state.len()).map(Input::State);
    let answers = (0..if inputs.asks { FIRST.min(scenario.answers.len()) } else { 0 }).map(Input::Answer);
    let probes = (0..PROBES).map(Input::Probe);
    // Rotary axes stand anywhere as in other scenarios, unless conversions hold for those that stand at 0.
    let turned = (3..6).filter(|axis| !inputs.turns_by_sign && inputs.rotary[axis - 3]);
    let start = turned.chain(0..3).map(Input::Start);
    let all = variables
        .chain(reached.iter().cloned())
        .chain(machine)
        .chain(answers)
        .chain(cells)
        .chain(state)
        .chain(probes)
        .chain(start)
        // Tools are not worn where the target keeps no wear apart.
        .filter(|input| match input {
            Input::LengthWear(_) => !inputs.unworn_lengths,
            Input::RadiusWear(_) => !inputs.unworn,
            _ => true,
        })
        .take(MOST_INPUTS);
    let mut once: Vec<Input> = Vec::new();
    for input in all {
        if !once.contains(&input) {
            once.push(input);
        }
    }
    once
}

impl Input {
    /// True for the modal code of the work offset.
    pub fn is_selected(state: Sys, subscripts: &[u32]) -> bool {
        let group = Group::WorkOffset.number();
        state == Sys::Modal && subscripts.first().is_some_and(|own| Some(*own) == group)
    }

    /// The offset that a state of the machine is; none of what is no offset.
    pub fn of_cell(state: Sys, subscripts: &[u32]) -> Option<Self> {
        match (state, subscripts) {
            (Sys::WorkOffset, [number, axis]) => Some(Self::Work(*number, (*axis as usize).checked_sub(1)?)),
            (Sys::LengthGeometry | Sys::ToolOffset, [number]) => Some(Self::Length(*number)),
            (Sys::LengthWear, [number]) => Some(Self::LengthWear(*number)),
            (Sys::RadiusGeometry | Sys::DiameterGeometry | Sys::DiameterOrRadius, [number]) => {
                Some(Self::Radius(*number))
            }
            (Sys::RadiusWear | Sys::DiameterWear | Sys::DiameterOrRadiusWear, [number]) => {
                Some(Self::RadiusWear(*number))
            }
            _ => None,
        }
    }

    /// The numbers that the program compares it with, and their neighbours.
    pub fn compared_with(&self, inputs: &Inputs) -> Vec<f64> {
        let Input::Variable(name, theirs) = self else { return Vec::new() };
        let own = inputs.variables.iter().find(|input| input.name == *name && input.theirs == *theirs);
        own.map_or_else(Vec::new, |input| input.values.clone())
    }

    /// What it is.
    pub fn get(&self, from: &Circumstances) -> f64 {
        let Circumstances { scenario, theirs, literals } = from;
        let found = match self {
            Input::Variable(name, false) => scenario.variables.get(name).copied(),
            Input::Variable(name, true) => theirs.get(name).copied(),
            Input::State(at) => scenario.state.get(*at).map(|state| state.value),
            Input::Answer(at) => scenario.answers.get(*at).copied(),
            Input::Work(number, axis) => {
                scenario.work_offsets.get(number).and_then(|axes| axes.get(*axis)).copied()
            }
            Input::Length(number) => scenario.tools.get(number).map(|tool| tool.length),
            Input::Radius(number) => scenario.tools.get(number).map(|tool| tool.radius),
            Input::LengthWear(number) => scenario.tools.get(number).map(|tool| tool.length_wear),
            Input::RadiusWear(number) => scenario.tools.get(number).map(|tool| tool.radius_wear),
            Input::Probe(at) => match scenario.probes.get(*at) {
                Some(Probe::Part(part)) => Some(*part),
                _ => Some(1.0),
            },
            Input::Start(axis) => scenario.start.get(*axis).copied(),
            Input::Selected => {
                Some(FIRST_OFFSET + f64::from(scenario.entry.work.unwrap_or(1).clamp(1, 6)) - 1.0)
            }
            Input::Tool => Some(f64::from(scenario.tool)),
            Input::Time => Some(seconds_of(scenario.time)),
            Input::Day => Some(day_of(scenario.date)),
            Input::Literal(at) => literals.get(*at).copied(),
        };
        found.unwrap_or(0.0)
    }

    /// The same circumstances with another value here; none if it cannot be.
    pub fn set(&self, from: &Circumstances, value: f64) -> Option<Circumstances> {
        // What nobody would enter proves nothing.
        if !value.is_finite() || value.abs() > 1e6 {
            return None;
        }
        let mut out = from.clone();
        let scenario = &mut out.scenario;
        match self {
            Input::Variable(name, theirs) => {
                let all = if *theirs { &mut out.theirs } else { &mut scenario.variables };
                all.insert(name.clone(), value);
            }
            Input::State(at) => scenario.state.get_mut(*at)?.value = value.round().abs(),
            Input::Answer(at) => *scenario.answers.get_mut(*at)? = value,
            Input::Work(number, axis) => {
                *scenario.work_offsets.entry(*number).or_default().get_mut(*axis)? = value
            }
            Input::Length(number) => scenario.tools.entry(*number).or_default().length = value,
            Input::Radius(number) => {
                let tool = scenario.tools.entry(*number).or_default();
                tool.radius = value.abs();
                if let Some(shared) = &scenario.one_table {
                    tool.length = tool.radius * shared.per;
                }
            }
            Input::LengthWear(number) => scenario.tools.entry(*number).or_default().length_wear = value,
            Input::RadiusWear(number) => scenario.tools.entry(*number).or_default().radius_wear = value,
            Input::Probe(at) => {
                // After the last one all miss.
                scenario.probes.resize((at + 1).max(scenario.probes.len()), Probe::Miss);
                *scenario.probes.get_mut(*at)? =
                    if (0.0..=1.0).contains(&value) { Probe::Part(value) } else { Probe::Miss };
            }
            Input::Start(axis) => *scenario.start.get_mut(*axis)? = value,
            Input::Selected => {
                let offset =
                    Some(value - FIRST_OFFSET).filter(|at| at.fract() == 0.0 && (0.0..6.0).contains(at))?;
                scenario.entry.work = Some(offset as u32 + 1);
            }
            // A spindle without a tool has tool 0.
            Input::Tool => {
                // From a larger one it may go down to two digits.
                let most = f64::from(scenario.tool.max(99));
                scenario.tool = Some(value.round()).filter(|tool| (0.0..=most).contains(tool))? as u32
            }
            Input::Time => scenario.time = time_at(value)?,
            Input::Day => scenario.date = date_at(value)?,
            // As many digits as people write.
            Input::Literal(at) => *out.literals.get_mut(*at)? = (value * 1e6).round() / 1e6,
        }
        Some(out)
    }

    /// The same circumstances without it: nothing ever set the variable. None of what is always there.
    pub fn unset(&self, from: &Circumstances) -> Option<Circumstances> {
        let Input::Variable(name, theirs) = self else { return None };
        let mut out = from.clone();
        let all = if *theirs { &mut out.theirs } else { &mut out.scenario.variables };
        all.remove(name)?;
        Some(out)
    }

    /// The first step away from where it is.
    pub fn step(&self) -> f64 {
        match self {
            Input::Probe(_) => 0.25,
            // Conditions ask for the shift, not for the second.
            Input::Time => 3600.0,
            _ => 1.0,
        }
    }
}

/// Seconds of a time of day that is written hhmmss.
fn seconds_of(time: f64) -> f64 {
    let (hours, minutes) = ((time / 10_000.0).floor(), (time / 100.0).floor() % 100.0);
    hours * 3600.0 + minutes * 60.0 + time % 100.0
}

/// So many seconds as a time of day; none of more than a day.
fn time_at(seconds: f64) -> Option<f64> {
    let seconds = Some(seconds.round()).filter(|seconds| (0.0..86_400.0).contains(seconds))?;
    let (minutes, hours) = ((seconds / 60.0).floor(), (seconds / 3600.0).floor());
    Some(hours * 10_000.0 + minutes % 60.0 * 100.0 + seconds % 60.0)
}

/// The days of a month, the shortest one: any of them is in each month.
const DAYS: f64 = 28.0;

/// The days of a date that is written yyyymmdd, with months of 28 days.
fn day_of(date: f64) -> f64 {
    let (year, month) = ((date / 10_000.0).floor(), (date / 100.0).floor() % 100.0);
    (year * 12.0 + month - 1.0) * DAYS + (date % 100.0).min(DAYS) - 1.0
}

/// The date of such a day; none of a year that no clock has.
fn date_at(day: f64) -> Option<f64> {
    let (day, month) = (day.round() % DAYS, (day.round() / DAYS).floor());
    let year = Some((month / 12.0).floor()).filter(|year| (1970.0..2100.0).contains(year))?;
    Some(year * 10_000.0 + (month % 12.0 + 1.0) * 100.0 + day + 1.0)
}

#[cfg(test)]
mod tests {
    use super::{Input, date_at, day_of, inputs_of, seconds_of, time_at};
    use crate::control::Scenario;
    use crate::verify::explore::inputs::Inputs;

    /// What a run came to by computed numbers is no exception.
    #[test]
    fn wear_stays_as_it_is_where_the_target_keeps_none() {
        let reached = [Input::RadiusWear(3), Input::LengthWear(3), Input::Radius(3)];
        let worn = |unworn: bool, unworn_lengths: bool| {
            let inputs = Inputs { unworn, unworn_lengths, ..Inputs::default() };
            let all = inputs_of(&inputs, &reached, &Scenario::default());
            reached.clone().map(|input| all.contains(&input))
        };
        assert_eq!(worn(false, false), [true, true, true]);
        assert_eq!(worn(true, false), [false, true, true]);
        assert_eq!(worn(false, true), [true, false, true]);
    }

    #[test]
    fn times_of_day() {
        assert_eq!((seconds_of(143_015.0), time_at(52_215.0)), (52_215.0, Some(143_015.0)));
        assert_eq!((time_at(0.0), time_at(86_399.0)), (Some(0.0), Some(235_959.0)));
        assert_eq!((time_at(-1.0), time_at(86_400.0)), (None, None));
    }

    #[test]
    fn days() {
        let new_year = day_of(20_260_101.0);
        assert_eq!(date_at(new_year), Some(20_260_101.0));
        assert_eq!(date_at(new_year + 27.0), Some(20_260_128.0));
        assert_eq!(date_at(new_year + 28.0), Some(20_260_201.0));
        assert_eq!(date_at(new_year - 1.0), Some(20_251_228.0));
        assert_eq!((date_at(0.0), date_at(f64::from(u32::MAX))), (None, None));
    }
}
