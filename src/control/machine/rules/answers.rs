//! Answers that are more than yes or no.

use super::{Fact, fact};
use crate::dialect::{Control, Machine, Question};

/// What the offset values of cutter radii are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RadiusTable {
    /// Radii.
    Radius,
    /// Diameters.
    Diameter,
}

/// What a return or a move in machine coordinates does to the tool length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LengthAfter {
    /// It is in force in the next block.
    Kept,
    /// It is gone until the program names it again.
    Cancelled,
    /// The same, where the axis of the length moved.
    CancelledAlong,
}

/// What becomes of an arc without a centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoCentre {
    /// An alarm.
    Alarm,
    /// A straight move.
    Straight,
}

/// The retract plane of a drilling cycle that is told none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPlane {
    /// Where the tool is when the cycle begins.
    Here,
    /// 0.
    Zero,
    /// It is an alarm.
    Alarm,
}

/// The retract plane of a drilling cycle that is told none; a silent table is like most.
pub(super) fn no_plane(control: &Control) -> Fact<NoPlane> {
    let read = |value: &str| match value {
        "here" => Some(NoPlane::Here),
        "zero" => Some(NoPlane::Zero),
        "alarm" => Some(NoPlane::Alarm),
        _ => None,
    };
    let question = Question::CycleRMissing;
    fact(control, question, read, NoPlane::Here).or_silent(control, question)
}

/// What a tool change does where no tool was named since the last one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BareChange {
    /// It takes the tool in the spindle again.
    Same,
    /// It takes the tool that the last change put back.
    Pot,
    /// It is an alarm.
    Alarm,
}

/// What a tool change does where no tool was named since the last one; a silent table is like most.
pub(super) fn bare_change(control: &Control) -> Fact<BareChange> {
    let read = |value: &str| match value {
        "same" => Some(BareChange::Same),
        "pot" => Some(BareChange::Pot),
        "alarm" => Some(BareChange::Alarm),
        _ => None,
    };
    let question = Question::ChangeWithoutTool;
    fact(control, question, read, BareChange::Same).or_silent(control, question)
}

/// Whether a word that changes the tool does so for the tool in the spindle; a silent table is like most.
pub(super) fn tool_again(control: &Control) -> Fact<bool> {
    let read = |value: &str| match value {
        "changes" => Some(true),
        "skipped" => Some(false),
        _ => None,
    };
    let question = Question::ToolWordAgain;
    fact(control, question, read, true).or_silent(control, question)
}

/// Whether something is known to be ignored.
pub(super) fn ignored(control: &Control, question: Question) -> Fact<bool> {
    fact(control, question, |value| (value == "ignored").then_some(true), false)
}

/// True for a control that answers a question so.
pub(super) fn are(control: &Control, question: Question, with: &str) -> bool {
    control.behaviour(question).is_some_and(|row| row.value == with)
}

/// True where the sign of an angle that is zero is a way too; so it is taken where nobody says it.
pub(super) fn zero_has_sign(control: &Control) -> bool {
    !are(control, Question::RotaryZeroSign, "false")
}

/// True for a mill whose rotary axes go the way that the sign of an angle says.
pub(super) fn turns_by_sign(control: &Control) -> bool {
    control.machine() == Machine::Mill && are(control, Question::RotaryWay, "sign")
}
