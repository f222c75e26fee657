//! The state of the machine that a program leaves to whoever goes on.

use super::Machine;
use super::frame::Rotation;
use crate::canon::{Group, Op};
use crate::control::scenario::{AXES, Axes, Tool};
use crate::control::table::Table;

/// The groups whose codes a caller may rely on.
const MODES: [Group; 8] = [
    Group::Motion,
    Group::Cycle,
    Group::Plane,
    Group::Distance,
    Group::FeedMode,
    Group::Units,
    Group::ReturnPlane,
    Group::SpeedMode,
];

/// What is in force, besides the offsets, spindle and coolant that events tell.
#[derive(Clone, Debug, PartialEq)]
pub struct ExitState {
    /// The operation in force in each modal group.
    pub modes: Vec<(Group, Op)>,
    /// True where the program named its unit; else that is the one it began in.
    pub unit_named: bool,
    /// The feed in force, millimetres.
    pub feed: f64,
    /// True where that feed was told per turn: it is none in another mode.
    pub feed_by_turn: bool,
    /// The selected work offset: 0 none.
    pub work: u32,
    /// What is added to a programmed coordinate: work offset and shifts.
    pub shift: Axes,
    /// The tool length, and true if a return or a machine move may have cancelled it.
    pub length: (f64, bool),
    /// How far a coordinate may be off by rounding, millimetres.
    pub rounded: f64,
    /// How far a place that the program read may have been off by rounding, in its units.
    pub read: f64,
    /// Mirrored axes and about which coordinate.
    pub mirror: [Option<f64>; AXES],
    /// Scale factors and their centre.
    pub scale: Option<(Axes, Axes)>,
    /// Rotation.
    pub rotation: Option<Rotation>,
    /// Machine position, millimetres.
    pub position: Axes,
    /// True where the shift of all work offsets lies in the register of the local shift.
    pub external_is_local: bool,
    /// Work offsets by common number, millimetres.
    pub work_offsets: Table<Axes>,
    /// The shift of all of them, millimetres.
    pub external: Axes,
    /// The tool table.
    pub tools: Table<Tool>,
}

impl Machine {
    /// What is in force now, at the end of a run: the machine's tables go with it.
    pub fn left(&mut self) -> ExitState {
        let length = if self.length_lost.is_some() { self.length_value() } else { self.frame.length };
        self.frame.length = 0.0;
        let mut state = self.state();
        state.length.0 = length;
        (self.work_offsets, self.tools) = Default::default();
        state
    }

    /// What is in force now; the length is not looked up.
    pub(super) fn state(&self) -> ExitState {
        ExitState {
            modes: MODES.into_iter().filter_map(|group| Some((group, self.modal(group)?))).collect(),
            unit_named: self.unit_named,
            feed: self.feed,
            feed_by_turn: self.feed_by_turn,
            work: self.frame.number,
            shift: self.frame.shifts(),
            length: (0.0, self.length_lost.is_some()),
            rounded: self.off_by(),
            read: self.rounding.read,
            mirror: self.frame.mirror,
            scale: self.frame.scale,
            rotation: self.frame.rotation,
            position: self.position,
            external_is_local: self.rules.local_is_external.peek(),
            work_offsets: self.work_offsets.clone(),
            external: self.frame.external,
            tools: self.compared_tools(),
        }
    }
}
