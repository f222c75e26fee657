//! What only a lathe has: its turret and offsets, its single passes, its cycles over grooves, threads and contours.
//!
//! `docs/lathe.md` says move by move what they do; comments name its rows. X is kept as a diameter in positions; what is
//! worked out for a cycle is in radii.

mod along;
pub(super) mod check;
pub(super) mod contour;
mod corner;
mod drawn;
pub(super) mod engaging;
mod finish;
pub(super) mod groove;
pub(super) mod holes;
mod levels;
pub(super) mod pass;
mod profile;
mod rough;
mod screw;
pub(super) mod settings;
mod shape;
mod stretches;
pub(super) mod surface;
pub(super) mod thread;
pub(super) mod time;
pub(super) mod turret;
pub(super) mod waiting;
pub(super) mod way;
pub(super) mod zeros;

pub use contour::{Contour, Contoured};
pub(super) use settings::Turning;

use super::{Command, Machine};
use crate::canon::{Op, Role};
use crate::control::outcome::Stop;
use std::collections::BTreeMap;

/// A row of the table of tool offsets, millimetres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Offset {
    /// A diameter.
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub radius: f64,
    pub tip: f64,
}

/// What a roughing takes with each pass, and how far it goes back.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cut {
    pub depth: Option<f64>,
    pub retract: Option<f64>,
}

/// What a repeated contour was told: the stock as radius and length, and the passes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Repeat {
    pub x: Option<f64>,
    pub z: Option<f64>,
    pub passes: Option<f64>,
}

/// What a thread of many passes was told by its first block.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Form {
    /// Finishing passes, run-out in tenths of a lead, angle: two digits each.
    pub digits: Option<f64>,
    pub least: Option<f64>,
    pub allowance: Option<f64>,
}

/// The state of a lathe.
#[derive(Clone, Debug, Default)]
pub(super) struct Lathe {
    /// True where the C axis is engaged, as far as a code or a return has told (Q4).
    pub c_engaged: bool,
    /// The number of the tool offset in force.
    pub offset: u32,
    /// The one table, or that of the wear.
    pub table: BTreeMap<u32, Offset>,
    /// What is written as the geometry of a tool.
    pub geometry: BTreeMap<u32, Offset>,
    /// What is written as the shift of all zeros, along X (a diameter), Y and Z.
    pub work_shift: [f64; 3],
    /// The limit of turns a minute.
    pub limit: Option<f64>,
    /// The last speed in turns, and the last surface speed.
    pub speeds: [f64; 2],
    /// True once somebody said what the feed counts.
    pub feed_mode_told: bool,
    pub pass: pass::Pass,
    /// True where the program switched the run-out of threads off.
    pub runs_straight: bool,
    pub turning: Cut,
    pub facing: Cut,
    pub pattern: Repeat,
    pub face_retract: Option<f64>,
    pub groove_retract: Option<f64>,
    pub thread: Form,
    /// What the block goes along in place of its own words.
    pub way: Option<Vec<shape::Piece>>,
    /// Blocks that wait for the next one.
    pub waiting: Vec<waiting::Waiting>,
    /// Whether a word in incremental mode told the depth of the drilling cycle in force; none if a letter of its own did.
    pub hole_by_mode: Option<bool>,
    /// The last time of a wait, seconds.
    pub last_dwell: Option<f64>,
    /// True where threads an inch said the feed last.
    pub per_inch: bool,
    /// True once a feed a turn came while the spindle stood: how long that takes no source says.
    pub has_stood: bool,
    /// True once a tap has turned a spindle that stood, or a live tool, and left the spindle as it was.
    pub has_tapped: bool,
    /// True after a cycle, until a code of motion stands in a block.
    pub after_cycle: bool,
    /// The face or the side that is milled while C follows.
    pub surface: Option<surface::Surface>,
}

/// Takes the words of a block that only sets what the next cycle takes (R1, G10, P1).
pub(super) fn setup(machine: &mut Machine, op: Op, command: &Command) -> Result<(), Stop> {
    if command.has_axes() {
        return Err(Stop::unnamed(format!(
            "axis words beside {op}, which only sets what the next cycle takes"
        )));
    }
    let unit = machine.unit();
    let length = |role| command.word(role).map(|value| value * unit);
    let one_pair = machine.rules.turning.two_blocks;
    let lathe = &mut machine.lathe;
    let cut = |kept: Cut| Cut {
        depth: length(Role::CutDepth).or(kept.depth),
        retract: length(Role::CutRetract).or(kept.retract),
    };
    match op {
        Op::TurningSetup => lathe.turning = cut(lathe.turning),
        Op::FacingSetup => lathe.facing = cut(lathe.facing),
        Op::PatternSetup => {
            lathe.pattern = Repeat {
                x: length(Role::PatternX).or(lathe.pattern.x),
                z: length(Role::PatternZ).or(lathe.pattern.z),
                passes: command.word(Role::Passes).or(lathe.pattern.passes),
            };
        }
        Op::FaceGrooveSetup => lathe.face_retract = length(Role::CutRetract).or(lathe.face_retract),
        Op::GrooveSetup => lathe.groove_retract = length(Role::CutRetract).or(lathe.groove_retract),
        _ => {
            lathe.thread = Form {
                digits: command.word(Role::ThreadForm).or(lathe.thread.digits),
                least: length(Role::ThreadLeast).or(lathe.thread.least),
                allowance: length(Role::ThreadAllowance).or(lathe.thread.allowance),
            };
        }
    }
    // On a control of which such blocks write parameters, two cycles have one pair of them, or one (R1).
    if one_pair {
        match op {
            Op::TurningSetup => lathe.facing = lathe.turning,
            Op::FacingSetup => lathe.turning = lathe.facing,
            Op::FaceGrooveSetup => lathe.groove_retract = lathe.face_retract,
            Op::GrooveSetup => lathe.face_retract = lathe.groove_retract,
            _ => {}
        }
    }
    Ok(())
}

/// The meaning of a code or a word, for a place within a sentence.
fn said(meaning: &str) -> &str {
    meaning.trim().trim_end_matches('.')
}

/// An alarm by its number on the controls that number theirs.
fn alarm(number: &str, text: &str) -> Stop {
    Stop::alarm(number, text)
}

/// The sign of a way; 0 where there is none.
fn sense(way: f64) -> f64 {
    if way.abs() <= EXACT { 0.0 } else { way.signum() }
}

/// What lies no farther apart is one place, millimetres.
const EXACT: f64 = 1e-9;
