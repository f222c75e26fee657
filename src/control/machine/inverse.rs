//! Feeds in inverse time, each for the move of its own block.

use super::{Command, Machine};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use crate::control::trace::FeedMode;

/// Stops at a move that feeds in inverse time and has no feed of its own.
pub(super) fn check(machine: &Machine, command: &Command) -> Result<(), Stop> {
    let inverse = machine.feed_mode == FeedMode::Inverse && !machine.rules.lathe;
    let feeds = machine.motion != Op::Rapid && !command.has(Op::RapidOnce);
    if inverse && feeds && command.word(Role::Feed).is_none() {
        return Err(Stop::unnamed("a move under inverse time feed without a feed in its block"));
    }
    Ok(())
}

/// Stops at a drilling cycle: it has more moves than one, and no source says what F is for them.
pub(super) fn cycle(machine: &Machine) -> Result<(), Stop> {
    if machine.feed_mode == FeedMode::Inverse {
        return Err(Stop::unnamed("a drilling cycle under inverse time feed"));
    }
    Ok(())
}
