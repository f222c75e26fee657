//! Kinds of events and runs: what is a setting, what a stop, what a return, and which run was cut off.

use crate::canon::{Group, Op, Running};
use crate::control::trace::EventKind;
use crate::control::{End, Run};

/// A group of settings, of which only what is in force at the next action counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Setting {
    Work,
    Length,
    Cutter,
    Offset,
    Limit,
    Ready,
    Spindle,
    Coolant,
}

/// The group that a setting belongs to; none for what is no setting.
pub fn setting(what: &EventKind) -> Option<Setting> {
    Some(match what {
        EventKind::WorkOffset { .. } => Setting::Work,
        EventKind::ToolLength { .. } => Setting::Length,
        EventKind::CutterRadius { .. } => Setting::Cutter,
        EventKind::ToolOffset { .. } => Setting::Offset,
        EventKind::SpeedLimit { .. } => Setting::Limit,
        EventKind::ToolReady { .. } => Setting::Ready,
        EventKind::Spindle { .. } => Setting::Spindle,
        EventKind::Coolant { .. } => Setting::Coolant,
        _ => return None,
    })
}

/// What runs or not by a setting.
pub fn running(setting: Setting) -> Option<Running> {
    match setting {
        Setting::Spindle => Some(Running::Spindle),
        Setting::Coolant => Some(Running::Coolant),
        _ => None,
    }
}

/// What an event starts or ends, if it is one of those.
pub fn runs(what: &EventKind) -> Option<Running> {
    running(setting(what)?)
}

/// True for what stops the program, for a while or for good.
pub fn is_pause(what: &EventKind) -> bool {
    use EventKind::{Asked, End, Message, OptionalStop, Stop, ToolChange};
    matches!(what, Asked { .. } | End { .. } | Message { .. } | OptionalStop | Stop | ToolChange { .. })
}

/// True for what moves the tool.
pub fn is_move(what: &EventKind) -> bool {
    use EventKind::{Arc, Feed, Probe, Rapid, Thread};
    matches!(what, Rapid { .. } | Feed { .. } | Arc { .. } | Thread { .. } | Probe { .. })
}

/// True for a mode of corners, ramps or gains, or a limit on reading ahead: it acts in the moves after it.
pub fn is_mode(what: &EventKind) -> bool {
    let EventKind::Other { operation, .. } = what else { return false };
    operation.group() == Group::PathMode
        || matches!(operation, Op::LimitLookahead | Op::AxisGain | Op::PathQuality | Op::StrokeCheckOff)
}

/// True for the end of a program that others call.
pub fn returns(what: &EventKind) -> bool {
    matches!(what, EventKind::End { by: Op::Return | Op::SubEnd })
}

/// True where the run was stopped from outside.
pub fn is_cut(run: &Run) -> bool {
    !matches!(run.end, End::Ended | End::Alarm { .. })
}
