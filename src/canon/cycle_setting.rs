//! What of a lathe's cycles a setting of the machine may say in place of the program.

use super::{Op, Role};

/// Something that a cycle takes from its block on one control, and from a setting of the machine on another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CycleSetting {
    /// How far a pass of a roughed contour goes back.
    RoughRetract,
    /// How far a peck of a groove or a face goes back.
    PeckRetract,
    /// The least depth of a pass of a thread.
    ThreadLeast,
    /// What is left of a thread for its finishing passes.
    ThreadAllowance,
    /// How many finishing passes there are.
    ThreadFinishes,
    /// How long a thread runs out, where it does.
    ThreadRunOut,
}

impl CycleSetting {
    /// What a word of a cycle is of these; none for what shapes the part: depths, allowances of contours, angles.
    pub fn of(cycle: Op, role: Role) -> Option<Self> {
        match (cycle, role) {
            (Op::RoughTurning | Op::RoughFacing, Role::CutRetract) => Some(Self::RoughRetract),
            (Op::Groove | Op::FaceGroove, Role::CutRetract) => Some(Self::PeckRetract),
            (Op::Threading, Role::ThreadLeast) => Some(Self::ThreadLeast),
            (Op::Threading, Role::ThreadAllowance) => Some(Self::ThreadAllowance),
            (Op::Threading, Role::ThreadFinishes) => Some(Self::ThreadFinishes),
            (Op::Threading | Op::ThreadingPass, Role::ThreadRunOut) => Some(Self::ThreadRunOut),
            _ => None,
        }
    }
}
