//! Smaller programs to try where one shows a fault.

use super::{Kind, Program, Step, Value};

/// Programs with one step less, with a step in place of what it holds, or with a plainer value.
pub fn smaller(program: &Program) -> Vec<Program> {
    let mut out = Vec::new();
    for part in 0..=program.subs.len() {
        let steps = |program: &Program| {
            if part == 0 { program.main.clone() } else { program.subs[part - 1].clone() }
        };
        for with in variants(&steps(program)) {
            let mut next = program.clone();
            *(if part == 0 { &mut next.main } else { &mut next.subs[part - 1] }) = with;
            out.push(next);
        }
    }
    out
}

fn variants(steps: &[Step]) -> Vec<Vec<Step>> {
    let mut out = Vec::new();
    let mut with = |at: usize, new: Vec<Step>| {
        let mut next = steps.to_vec();
        next.splice(at..=at, new);
        out.push(next);
    };
    for (at, step) in steps.iter().enumerate() {
        with(at, Vec::new());
        let held = held(&step.kind);
        // A loop's body in its place may hold a way out of the loop.
        if !matches!(step.kind, Kind::Repeat { .. }) {
            held.iter().for_each(|body| with(at, (*body).clone()));
        }
        for (which, body) in held.iter().enumerate() {
            for inner in variants(body) {
                let mut kind = step.kind.clone();
                if let Some(place) = held_mut(&mut kind).into_iter().nth(which) {
                    *place = inner;
                }
                with(at, vec![Step { salt: step.salt, kind }]);
            }
        }
        for kind in plainer(&step.kind) {
            with(at, vec![Step { salt: step.salt, kind }]);
        }
    }
    out
}

/// True where the main program or a subprogram that it calls calls one.
pub fn is_called(main: &[Step], subs: &[Vec<Step>], wanted: usize) -> bool {
    let callers = subs.iter().enumerate().take(wanted);
    calls(main, wanted)
        || callers.into_iter().any(|(at, steps)| calls(steps, wanted) && is_called(main, subs, at))
}

fn calls(steps: &[Step], wanted: usize) -> bool {
    steps.iter().any(|step| match &step.kind {
        Kind::Call { sub, .. } => *sub == wanted,
        Kind::Far { subs, .. } => subs.contains(&wanted),
        Kind::Modal { sub, body, .. } => *sub == wanted || calls(body, wanted),
        kind => held(kind).iter().any(|body| calls(body, wanted)),
    })
}

/// The steps that a step holds.
fn held(kind: &Kind) -> Vec<&Vec<Step>> {
    match kind {
        Kind::If { then, otherwise, .. } => vec![then, otherwise],
        Kind::Repeat { body, .. } | Kind::Within { body, .. } | Kind::Modal { body, .. } => vec![body],
        Kind::Switch { arms, .. } | Kind::Jump { arms, .. } => arms.iter().collect(),
        _ => Vec::new(),
    }
}

fn held_mut(kind: &mut Kind) -> Vec<&mut Vec<Step>> {
    match kind {
        Kind::If { then, otherwise, .. } => vec![then, otherwise],
        Kind::Repeat { body, .. } | Kind::Within { body, .. } | Kind::Modal { body, .. } => vec![body],
        Kind::Switch { arms, .. } | Kind::Jump { arms, .. } => arms.iter_mut().collect(),
        _ => Vec::new(),
    }
}

/// The step with a part of a value in the value's place, or with less.
fn plainer(kind: &Kind) -> Vec<Kind> {
    let mut out = Vec::new();
    match kind {
        Kind::Set { slot, value } => {
            out.extend(parts(value).into_iter().map(|value| Kind::Set { slot: *slot, value }));
        }
        Kind::Move { rapid, axes, feed } => {
            for axis in 0..axes.len() {
                let Some(value) = &axes[axis] else { continue };
                let mut with = |new: Option<Value>| {
                    let mut axes = axes.clone();
                    axes[axis] = new;
                    out.push(Kind::Move { rapid: *rapid, axes, feed: *feed });
                };
                with(None);
                parts(value).into_iter().for_each(|part| with(Some(part)));
            }
        }
        Kind::Call { sub, values, times } => {
            for at in 0..values.len() {
                let mut fewer = values.clone();
                fewer.remove(at);
                out.push(Kind::Call { sub: *sub, values: fewer, times: *times });
            }
        }
        Kind::Figure(which, values) => {
            out.extend(simpler(values).into_iter().map(|values| Kind::Figure(*which, values)));
        }
        Kind::Within { frame, values, body } => out.extend(simpler(values).into_iter().map(|values| {
            let body = body.clone();
            Kind::Within { frame: *frame, values, body }
        })),
        Kind::Talk(which, value) => {
            out.extend(parts(value).into_iter().map(|value| Kind::Talk(*which, value)));
        }
        Kind::Words(which, value) => {
            out.extend(parts(value).into_iter().map(|value| Kind::Words(*which, value)));
        }
        Kind::Cells(which, value) => {
            out.extend(parts(value).into_iter().map(|value| Kind::Cells(*which, value)));
        }
        Kind::Beside { block, value, codes } => {
            for at in 0..codes.len() {
                let mut fewer = codes.clone();
                fewer.remove(at);
                out.push(Kind::Beside { block: *block, value: value.clone(), codes: fewer });
            }
            let with = |value| Kind::Beside { block: *block, value, codes: codes.clone() };
            out.extend(parts(value).into_iter().map(with));
        }
        Kind::Modal { sub, values, body } => {
            for at in 0..values.len() {
                let mut fewer = values.clone();
                fewer.remove(at);
                out.push(Kind::Modal { sub: *sub, values: fewer, body: body.clone() });
            }
        }
        Kind::Cycle { kind, depth, plane, initial, places } => {
            for at in 0..places.len() {
                let mut fewer = places.clone();
                fewer.remove(at);
                let (depth, plane) = (depth.clone(), plane.clone());
                out.push(Kind::Cycle { kind: *kind, depth, plane, initial: *initial, places: fewer });
            }
        }
        _ => {}
    }
    out
}

/// Two values, one of them a part of itself.
fn simpler([a, b]: &[Value; 2]) -> Vec<[Value; 2]> {
    let first = parts(a).into_iter().map(|a| [a, b.clone()]);
    first.chain(parts(b).into_iter().map(|b| [a.clone(), b])).collect()
}

fn parts(value: &Value) -> Vec<Value> {
    match value {
        Value::Unary(_, a) => vec![(**a).clone()],
        Value::Binary(_, a, b) => vec![(**a).clone(), (**b).clone()],
        _ => Vec::new(),
    }
}
