//! The last part of a case: what a run must have come to.

use crate::circumstances::numbers;
use macroglot::control::trace::{EventKind, Position, Spindle};
use macroglot::control::{End, Run};

/// How far a value may lie from the manual's, unless it says `about`.
const NEAR: f64 = 5e-7;

/// What of the events the wanted kind has, in order.
fn pick<T>(run: &Run, wanted: impl Fn(&EventKind) -> Option<T>) -> Vec<T> {
    run.events.iter().filter_map(|event| wanted(&event.what)).collect()
}

fn xyz(at: &Position) -> Vec<f64> {
    at.0[..3].to_vec()
}

fn moves(run: &Run) -> Vec<Vec<f64>> {
    pick(run, |what| match what {
        EventKind::Rapid { to, .. } | EventKind::Feed { to, .. } | EventKind::Arc { to, .. } => Some(xyz(to)),
        EventKind::Probe { to, .. } => Some(xyz(to)),
        _ => None,
    })
}

fn holes(run: &Run) -> Vec<Vec<f64>> {
    pick(run, |what| match what {
        EventKind::Hole { at, bottom, .. } => Some(vec![at.0[0], at.0[1], *bottom]),
        _ => None,
    })
}

fn output(run: &Run) -> Vec<String> {
    pick(run, |what| match what {
        EventKind::Output { text } => Some(text.clone()),
        _ => None,
    })
}

fn is_near(found: &[f64], wanted: &[f64]) -> bool {
    found.len() == wanted.len()
        && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= NEAR * b.abs().max(1.0))
}

fn without_blanks(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

/// One check of a run; what was found instead where it fails.
pub fn check(run: &Run, check: &str) -> Result<(), String> {
    let (word, rest) = check.split_once(' ').unwrap_or((check, ""));
    let wrong = |found: &dyn std::fmt::Debug| Err(format!("{check}: found {found:?}"));
    let test = |holds: bool, found: &dyn std::fmt::Debug| if holds { Ok(()) } else { wrong(found) };
    let alarm = match &run.end {
        End::Alarm { stop, .. } => format!("{} {}", stop.number, stop.text),
        _ => String::new(),
    };
    let count = |kind: &str| {
        pick(run, |what| {
            let is = match what {
                EventKind::Rapid { .. } => kind == "rapids",
                EventKind::Feed { .. } => kind == "feeds",
                EventKind::Arc { .. } => kind == "arcs",
                EventKind::Hole { .. } => kind == "holes",
                _ => false,
            };
            is.then_some(())
        })
        .len()
    };
    match word {
        "ends" => Ok(()),
        "alarm" => test(!alarm.is_empty() && alarm.contains(rest), &run.end),
        "out" => test(output(run).iter().any(|line| line == rest), &output(run)),
        "letters" => {
            test(output(run).iter().any(|line| without_blanks(line) == without_blanks(rest)), &output(run))
        }
        "message" => {
            let messages = pick(run, |what| match what {
                EventKind::Message { text } => Some(text.clone()),
                _ => None,
            });
            test(messages.iter().any(|text| text == rest), &messages)
        }
        "speed" | "still" => {
            let speeds = pick(run, |what| match what {
                EventKind::Spindle { speed, direction: Spindle::Clockwise, .. } => Some(*speed),
                _ => None,
            });
            let wanted: Option<f64> = (word == "speed").then(|| rest.parse().expect("a speed"));
            test(speeds.last().copied() == wanted, &speeds)
        }
        "moves" => {
            let found = moves(run);
            let wanted: Vec<Vec<f64>> = rest.split(';').map(numbers).collect();
            let near = found.len() == wanted.len() && found.iter().zip(&wanted).all(|(a, b)| is_near(a, b));
            test(near, &found)
        }
        "through" => test(moves(run).iter().any(|at| is_near(at, &numbers(rest))), &moves(run)),
        "last" => test(moves(run).last().is_some_and(|at| is_near(at, &numbers(rest))), &moves(run).last()),
        "largest" => {
            let at = numbers(rest);
            let found = moves(run).iter().map(|place| place[at[0] as usize]).fold(f64::MIN, f64::max);
            test(is_near(&[found], &at[1..]), &found)
        }
        "rapids" | "feeds" | "arcs" | "holes" => test(Ok(count(word)) == rest.parse(), &count(word)),
        "hole" => test(holes(run).iter().any(|at| is_near(at, &numbers(rest))), &holes(run)),
        "firsthole" => test(holes(run).first().is_some_and(|at| is_near(at, &numbers(rest))), &holes(run)),
        "lasthole" => test(holes(run).last().is_some_and(|at| is_near(at, &numbers(rest))), &holes(run)),
        "centre" | "sweep" => {
            let arcs = pick(run, |what| match what {
                EventKind::Arc { centre, sweep, .. } if word == "centre" => {
                    Some(if rest.is_empty() { vec![*sweep] } else { centre.0[..2].to_vec() })
                }
                EventKind::Arc { sweep, .. } => Some(vec![*sweep]),
                _ => None,
            });
            test(arcs.iter().any(|arc| is_near(arc, &numbers(rest))), &arcs)
        }
        "feed" => {
            let feeds = pick(run, |what| match what {
                EventKind::Feed { feed, .. } => Some(*feed),
                _ => None,
            });
            test(feeds.last().is_some_and(|feed| is_near(&[*feed], &numbers(rest))), &feeds)
        }
        "dwell" => {
            let waits = pick(run, |what| match what {
                EventKind::Dwell { seconds } => Some(*seconds),
                _ => None,
            });
            test(is_near(&waits, &numbers(rest)), &waits)
        }
        "tools" => {
            let tools = pick(run, |what| match what {
                EventKind::ToolChange { tool } => Some(*tool),
                _ => None,
            });
            let wanted = if rest.is_empty() { Vec::new() } else { numbers(rest) };
            // A run that goes on for ever is compared as far as the list goes.
            let near = tools.len() >= wanted.len() && is_near(&tools[..wanted.len()], &wanted);
            test(near && (run.end == End::StepBudget || tools.len() == wanted.len()), &tools)
        }
        "write" | "nowrite" => {
            let (name, value) = rest.split_once('=').unwrap_or((rest, "nan"));
            let wanted: f64 = value.parse().expect("a value");
            let writes = pick(run, |what| match what {
                EventKind::Write { state, subscripts, value } => {
                    let subscripts: Vec<String> = subscripts.iter().map(u32::to_string).collect();
                    Some((format!("{}[{}]", state.name(), subscripts.join(",")), *value))
                }
                _ => None,
            });
            let is = writes
                .iter()
                .any(|(found, value)| found == name && (wanted.is_nan() || is_near(&[*value], &[wanted])));
            test(is == (word == "write"), &writes)
        }
        "offset" => {
            let offsets = pick(run, |what| match what {
                EventKind::WorkOffset { number } => Some(f64::from(*number)),
                _ => None,
            });
            test(offsets.last().is_some_and(|number| is_near(&[*number], &numbers(rest))), &offsets)
        }
        "asked" => {
            let answers = pick(run, |what| match what {
                EventKind::Asked { answer } => Some(*answer),
                _ => None,
            });
            test(is_near(&answers, &numbers(rest)), &answers)
        }
        "stops" => {
            let stops = pick(run, |what| match what {
                EventKind::Stop | EventKind::Message { .. } => Some(()),
                _ => None,
            });
            test(Ok(stops.len()) == rest.parse(), &stops.len())
        }
        "end" => {
            let ends = pick(run, |what| match what {
                EventKind::End { by } => Some(by.name()),
                _ => None,
            });
            test(ends.last() == Some(&rest), &ends)
        }
        "unsure" => {
            let facts = pick(run, |what| match what {
                EventKind::Unsure { fact } => Some(fact.clone()),
                _ => None,
            });
            test(facts.iter().any(|fact| fact == rest), &facts)
        }
        "about" => {
            let (name, value) = rest.split_once('=').expect("a variable and a value");
            let wanted: f64 = value.parse().expect("a value");
            let found = run.variables.get(name).copied().unwrap_or(f64::NAN);
            // What seven digits keep; of a time, what reading the clock takes.
            test(
                (found - wanted).abs()
                    <= 1e-6 * wanted.abs() + if name.starts_with('V') { 0.01 } else { 0.0 },
                &found,
            )
        }
        "oneof" => {
            let (name, values) = rest.split_once('=').expect("a variable and values");
            let found = run.variables.get(name).copied().unwrap_or(f64::NAN);
            test(numbers(values).contains(&found), &found)
        }
        "went" => {
            // The values that a variable took, in order.
            let (name, values) = rest.split_once('=').expect("a variable and values");
            let found = pick(run, |what| match what {
                EventKind::Variable { name: found, value: Some(value) } if found == name => Some(*value),
                _ => None,
            });
            let wanted = numbers(values);
            test(found.len() >= wanted.len() && is_near(&found[..wanted.len()], &wanted), &found)
        }
        _ => {
            let (name, value) = check.split_once('=').unwrap_or_else(|| panic!("unknown check {check}"));
            let found = run.variables.get(name).copied();
            match value {
                "null" => test(found.is_none_or(|value| value == 0.0 && name.starts_with('V')), &found),
                _ => {
                    let wanted: f64 = value.parse().unwrap_or_else(|_| panic!("{check}"));
                    test(found.is_some_and(|found| is_near(&[found], &[wanted])), &found)
                }
            }
        }
    }
}

/// How a run must end: as its checks say, else by its end.
pub fn end(run: &Run, checks: &[&str]) -> Result<(), String> {
    let wanted = checks.iter().find_map(|check| check.strip_prefix("ends ")).unwrap_or_else(|| {
        if checks.iter().any(|check| check.starts_with("alarm")) { "alarm" } else { "ended" }
    });
    let found = match run.end {
        End::Ended => "ended",
        End::Alarm { .. } => "alarm",
        End::StepBudget | End::TimeBudget => "endless",
        End::Error { .. } => "error",
    };
    let holds = wanted == "any" || wanted == found;
    if holds { Ok(()) } else { Err(format!("ends {found}, not {wanted}: {:?}", run.end)) }
}
