//! What the target cannot do, and what a conversion may do in its place.
//!
//! None of it moves an axis, and all of it a machinist would notice: so it makes no difference that a
//! verifier could blame on the conversion, and none that it could pass over in silence either. A program that
//! needs it is undecided, and the certificate names what a person must accept; unless the conversion told of it, which makes
//! the program one for review.

use super::kinds::is_mode;
use crate::canon::{Op, Role};
use crate::control::trace::{EventKind, Told};
use crate::dialect::Question;
use crate::verify::sides::Side;
use std::collections::BTreeMap;

/// One coolant for the other, where the target has no such coolant.
pub fn stands_for(target: &Side<'_>, source: &EventKind, there: &EventKind) -> Option<(Op, String)> {
    let (EventKind::Coolant { state }, EventKind::Coolant { state: other }) = (source, there) else {
        return None;
    };
    let both = matches!((state, other), (Op::Mist, Op::Flood) | (Op::Flood, Op::Mist));
    (both && lacks(target, *state))
        .then(|| (*state, format!("the target has no {state}: it does {other} instead")))
}

/// The other coolant coming on where the target has one kind only, which is on already.
pub fn goes_on(target: &Side<'_>, source: &EventKind, there: Op) -> Option<(Op, String)> {
    let EventKind::Coolant { state } = *source else { return None };
    let other = match state {
        Op::Mist => Op::Flood,
        Op::Flood => Op::Mist,
        _ => return None,
    };
    let lacking = [state, other].into_iter().find(|op| lacks(target, *op))?;
    (there == state || there == other)
        .then(|| (lacking, format!("the target has only one kind of coolant: {there} is on")))
}

/// A mode of corners or ramps, an exact stop of one block, or a limit on reading ahead, that the target has no code for, and a wait at
/// the bottom of a bore, that it has no word for.
pub fn is_left_out(target: &Side<'_>, source: &EventKind, told: Told) -> Option<(Op, String)> {
    if let Told::Bottom(op) = told {
        return waits_at_bottom(target, source, op);
    }
    let EventKind::Other { operation, .. } = source else { return None };
    ((is_mode(source) || *operation == Op::ExactStopOnce) && lacks(target, *operation))
        .then(|| (*operation, format!("the target has no {operation}: it is dropped")))
}

/// A wait at the bottom of a bore, beside whose code the target takes no wait: the tool stands, and no axis moves for it.
fn waits_at_bottom(target: &Side<'_>, source: &EventKind, op: Op) -> Option<(Op, String)> {
    let EventKind::Dwell { seconds } = source else { return None };
    let bores = matches!(op, Op::CycleFineBore | Op::CycleBackBore | Op::CycleBoreStop);
    let code =
        target.control.code_for(op, &BTreeMap::new()).filter(|row| bores && !row.takes(Role::CycleDwell))?;
    Some((
        op,
        format!(
            "the source waits {seconds} s at the bottom of a bore: the target's {} has no wait",
            code.code
        ),
    ))
}

/// A tool that is made ready, where a tool word of the target changes the tool. Each change is compared by its tool. The text is none where
/// the machine's profile has said so: then nobody has to accept it.
pub fn makes_ready(target: &Side<'_>, source: &EventKind) -> Option<Option<String>> {
    let EventKind::ToolReady { tool } = source else { return None };
    let row = target.control.behaviour(Question::ToolChangeWord).filter(|row| row.value == "t")?;
    let text = || format!("the source makes tool {tool} ready: the target has no word for that");
    Some((!row.origin.is_settled()).then(text))
}

/// A return with no work offset in force, where the target always has one. The conversion marks the moves of the
/// callers that it knows, and each of them is compared.
pub fn cannot_cancel(target: &Side<'_>, source: &EventKind) -> Option<String> {
    let none = matches!(source, EventKind::WorkOffset { number: 0 }) && lacks(target, Op::ShiftCancel);
    none.then(|| "the source returns with all zero shifts cancelled: the target cannot do that".to_owned())
}

/// A return to a block of whoever called the program, where it runs by itself: the target says where by a variable
/// that callers look at, and each of those that the library has is compared.
pub fn returns_to_caller(source: &EventKind) -> Option<String> {
    let EventKind::Other { operation: Op::Return, code: Some(code) } = source else { return None };
    Some(format!("it returns to block {code} of its caller: only a run with its callers can show that"))
}

/// A move at feed of a source that was given no feed: what its control does then no source says.
pub fn has_no_feed(source: &EventKind) -> Option<String> {
    let none = matches!(source, EventKind::Feed { feed: 0.0, .. } | EventKind::Arc { feed: 0.0, .. });
    none.then(|| "the source moves at feed without a feed: no source says what it does".to_owned())
}

/// What the target does and nobody could tell: it reads ahead less far.
pub fn is_idle(target: &EventKind) -> bool {
    matches!(target, EventKind::Other { operation: Op::LimitLookahead, .. })
}

/// A code that the source's tables do not know, written alike on both sides: nothing says what either does.
pub fn is_builders(source: &EventKind, target: &EventKind) -> Option<String> {
    match (source, target) {
        (
            EventKind::Other { operation: Op::Builder, code: Some(code) },
            EventKind::Other { code: Some(other), .. },
        ) if code == other => Some(format!("the machine builder decides what {code} does")),
        _ => None,
    }
}

/// True where the target can do an operation neither by a code nor by a word.
pub fn lacks(target: &Side<'_>, op: Op) -> bool {
    target.control.code_for(op, &BTreeMap::new()).is_none() && target.control.word_for(op).is_none()
}
