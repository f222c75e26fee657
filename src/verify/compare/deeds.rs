//! What an event is, in a few words: for two events that are not of one kind.

use crate::canon::Op;
use crate::control::trace::{EventKind, Spindle};

/// What two events that are not of one kind do.
pub fn apart(source: &EventKind, target: &EventKind) -> String {
    match (deed(source), deed(target)) {
        (ours, theirs) if ours == theirs => "they do different things".to_owned(),
        (ours, theirs) => format!("they do different things: the source {ours}, the target {theirs}"),
    }
}

/// What the machine does, as the end of a sentence that begins with it.
fn deed(event: &EventKind) -> &'static str {
    match event {
        EventKind::Rapid { .. } => "moves rapidly",
        EventKind::Feed { .. } => "moves at the feed",
        EventKind::Arc { .. } => "moves on an arc",
        EventKind::Thread { .. } => "cuts a thread",
        EventKind::Probe { .. } => "moves until the probe touches",
        EventKind::Corner { .. } => "rounds or chamfers a corner",
        EventKind::Hole { .. } => "begins a drilling cycle",
        EventKind::Roughing { .. } => "roughs a contour",
        EventKind::Dwell { .. } => "waits",
        EventKind::Spindle { direction: Spindle::Stopped, .. } => "stops the spindle",
        EventKind::Spindle { direction: Spindle::Oriented, .. } => "holds the spindle at an angle",
        EventKind::Spindle { .. } => "turns the spindle",
        EventKind::SpeedLimit { .. } => "limits the spindle speed",
        EventKind::Coolant { state: Op::CoolantOff } => "switches coolant off",
        EventKind::Coolant { .. } => "switches coolant on",
        EventKind::ToolReady { .. } => "puts a tool ready",
        EventKind::ToolChange { .. } => "changes the tool",
        EventKind::ToolLength { .. } => "takes another tool length",
        EventKind::CutterRadius { .. } => "takes another cutter radius",
        EventKind::ToolOffset { .. } => "takes another tool offset",
        EventKind::WorkOffset { .. } => "takes another work offset",
        EventKind::Write { .. } => "writes a state of the machine",
        EventKind::Variable { .. } => "writes a variable",
        EventKind::Stop => "stops",
        EventKind::OptionalStop => "stops, as the switch of optional stops is on",
        EventKind::Message { .. } => "stops with a message",
        EventKind::Alarm(..) => "stops with an alarm",
        EventKind::Output { .. } => "puts out a text",
        EventKind::Asked { .. } => "asks the operator",
        EventKind::Other { .. } => "reads a code that moves nothing",
        EventKind::Act { .. } => "does what a code of the machine's builder says",
        EventKind::End { .. } => "ends the program",
        EventKind::Enter { .. } => "calls a program",
        EventKind::Leave => "returns to the caller",
        EventKind::Outside(..) => "calls a program that stands in the machine",
        EventKind::Unsure { .. } => "does what no source confirms",
    }
}
