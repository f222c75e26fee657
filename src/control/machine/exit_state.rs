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
        let rounded = self.off_by();
        let is_lost = self.length_lost.is_some();
        let length = if is_lost { self.length_value() } else { self.frame.length };
        self.frame.length = 0.0;
        ExitState {
            modes: MODES.into_iter().filter_map(|group| Some((group, self.modal(group)?))).collect(),
            unit_named: self.unit_named,
            feed: self.feed,
            work: self.frame.number,
            shift: std::array::from_fn(|axis| self.frame.shift(axis)),
            length: (length, is_lost),
            rounded,
            read: self.rounding.read,
            mirror: self.frame.mirror,
            scale: self.frame.scale,
            rotation: self.frame.rotation,
            position: self.position,
            external_is_local: self.rules.local_is_external.peek(),
            work_offsets: std::mem::take(&mut self.work_offsets),
            external: self.frame.external,
            tools: std::mem::take(&mut self.tools),
        }
    }
}
