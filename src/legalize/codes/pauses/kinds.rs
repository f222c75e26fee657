//! What statements are to spindle and coolant: stops, changes of the tool, and ends.

use super::starts;
use crate::canon::{Op, Pause, Role, Running, Sys};
use crate::dialect::Control;
use crate::ir::{Block, NcItem, StmtKind, TermKind};

/// True where the run ends, be it that the text of the program does.
pub(super) fn ends_run(kind: &TermKind) -> bool {
    matches!(kind, TermKind::End { .. } | TermKind::Stray)
}

/// True for a block with a stop.
pub(super) fn stops_in(block: &Block) -> bool {
    block.stmts.iter().any(|stmt| pause_of(&stmt.kind).is_some())
}

/// The kind of stop that a statement is, and whether it may be switched off. A question stops like a message.
pub(in crate::legalize) fn pause_of(kind: &StmtKind) -> Option<(Pause, bool)> {
    match kind {
        StmtKind::StopMessage { .. } | StmtKind::Input { .. } => Some((Pause::Message, false)),
        StmtKind::Nc(nc) if nc.has(Op::Stop) => Some((Pause::Stop, false)),
        StmtKind::Nc(nc) if nc.has(Op::OptionalStop) => Some((Pause::Stop, true)),
        StmtKind::Nc(nc) if nc.has(Op::ToolChange) => Some((Pause::Change, false)),
        _ => None,
    }
}

/// The tool in the spindle after a statement, where it is known; a call may change it.
pub(super) fn tool_after(kind: &StmtKind, before: Option<f64>) -> Option<f64> {
    match kind {
        StmtKind::Nc(nc) if nc.has(Op::ToolChange) => nc.word(Role::Tool)?.constant(),
        StmtKind::Nc(nc) if nc.items.iter().any(|item| matches!(item, NcItem::Code(..))) => None,
        StmtKind::Nc(_) | StmtKind::Assign { .. } => before,
        _ => None,
    }
}

/// True for a block that changes the tool and then starts it.
pub(super) fn restarts(kind: &StmtKind, running: Running) -> bool {
    matches!(kind, StmtKind::Nc(nc) if nc.has(Op::ToolChange) && starts(running).iter().any(|op| nc.has(*op)))
}

/// The kind of stop that is written for one: a message is a program stop on a control that has none.
pub(super) fn written(pause: Pause, target: &Control) -> Pause {
    match pause {
        Pause::Message if !has_messages(target) => Pause::Stop,
        pause => pause,
    }
}

/// True for a control that stops with a message.
pub(super) fn has_messages(control: &Control) -> bool {
    control.system_runs(Sys::StopMessage).next().is_some()
}
