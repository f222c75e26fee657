//! What kind of thing an operation is: its modal group, and what it does to the words beside it.

use super::{Group, Op};

impl Group {
    /// The number of the group in [`super::Sys::Modal`]; none if it has none there.
    pub const fn number(self) -> Option<u32> {
        match self {
            Group::Motion => Some(1),
            Group::Plane => Some(2),
            Group::Distance => Some(3),
            Group::FeedMode => Some(5),
            Group::Units => Some(6),
            Group::RadiusComp => Some(7),
            Group::LengthComp => Some(8),
            Group::Cycle => Some(9),
            Group::ReturnPlane => Some(10),
            Group::Scaling => Some(11),
            Group::ModalCall => Some(12),
            Group::SpeedMode => Some(13),
            Group::WorkOffset => Some(14),
            Group::PathMode => Some(15),
            Group::Rotation => Some(16),
            _ => None,
        }
    }
}

impl Op {
    /// The modal group that the operation belongs to.
    pub const fn group(self) -> Group {
        use Op::*;
        match self {
            Rapid | Linear | ArcCw | ArcCcw | ArcTangent | Thread | ThreadVariable | TurningPass
            | ThreadingPass | FacingPass => Group::Motion,
            CycleOff | CycleDrill | CycleDrillDwell | CyclePeck | CycleChipBreak | CycleTap
            | CycleTapLeft | CycleTapRigid | CycleTapByLead | CycleBore | CycleBoreStop | CycleBackBore
            | CycleBoreManual | CycleBoreDwell | CycleFineBore | CycleOther => Group::Cycle,
            op if op.is_hole() => Group::Cycle,
            PlaneXy | PlaneZx | PlaneYz | PlaneOther | Wrap => Group::Plane,
            Absolute | Incremental => Group::Distance,
            FeedPerMinute | FeedPerTurn | FeedInverse => Group::FeedMode,
            Inch | Metric => Group::Units,
            RadiusOff | RadiusLeft | RadiusRight => Group::RadiusComp,
            LengthPlus | LengthMinus | LengthOff => Group::LengthComp,
            ReturnInitial | ReturnR => Group::ReturnPlane,
            ShiftCancel | SelectWork => Group::WorkOffset,
            ExactStop | CuttingMode | TappingMode | RampsOff | RampsOn => Group::PathMode,
            SurfaceSpeed | TurnsPerMinute => Group::SpeedMode,
            RotateOn | RotateOff => Group::Rotation,
            ScaleOn | ScaleOff => Group::Scaling,
            MirrorOn | MirrorOff => Group::Mirror,
            CallModal | CallModalEach | CallModalOff => Group::ModalCall,
            SpindleCw | SpindleCcw | SpindleStop | SpindleOrient => Group::Spindle,
            Mist | Flood | CoolantOff => Group::Coolant,
            _ => Group::OneShot,
        }
    }

    /// True for a code that mills a round pocket where the tool stands.
    pub const fn is_pocket(self) -> bool {
        matches!(self, Self::PocketCw | Self::PocketCcw)
    }

    /// True for a move along an arc.
    pub const fn is_arc(self) -> bool {
        matches!(self, Self::ArcCw | Self::ArcCcw | Self::ArcTangent)
    }

    /// True for a drilling cycle that stays in force.
    pub const fn is_cycle(self) -> bool {
        use Op::*;
        matches!(
            self,
            CycleDrill
                | CycleDrillDwell
                | CyclePeck
                | CycleChipBreak
                | CycleTap
                | CycleTapLeft
                | CycleTapRigid
                | CycleTapByLead
                | CycleBore
                | CycleBoreStop
                | CycleBackBore
                | CycleBoreManual
                | CycleBoreDwell
                | CycleFineBore
                | CycleOther
        ) || self.is_hole()
    }

    /// True for a drilling cycle of a lathe, which goes along Z or along X whatever the plane is.
    pub const fn is_hole(self) -> bool {
        use Op::*;
        let drills = matches!(self, FaceHole | FaceDrill | FaceDrillDwell | FacePeck);
        let taps = matches!(self, FaceTap | FaceTapMain | FaceTapMainLeft | FaceTapLive | FaceTapLiveLeft);
        let bores = matches!(self, FaceBore | FaceBoreStop | FaceBoreDwell);
        drills || taps || bores || self.is_side_hole()
    }

    /// True for one that goes along X.
    pub const fn is_side_hole(self) -> bool {
        use Op::*;
        let drills = matches!(self, SideHole | SideDrill | SideDrillDwell | SidePeck);
        let bores = matches!(self, SideBore | SideBoreStop | SideBoreDwell);
        drills || bores || matches!(self, SideTap | SideTapLive | SideTapLiveLeft)
    }

    /// True for a pass of a lathe, which goes to its end and back in each block while it is in force.
    pub const fn is_pass(self) -> bool {
        matches!(self, Op::TurningPass | Op::ThreadingPass | Op::FacingPass)
    }

    /// True for a code that only says how the words after it count: it asks nothing of the machine by itself.
    pub const fn only_counts(self) -> bool {
        matches!(self.group(), Group::Distance | Group::ReturnPlane)
    }

    /// True for a cycle that reads the blocks of a contour.
    pub const fn reads_contour(self) -> bool {
        matches!(self, Op::RoughTurning | Op::RoughFacing | Op::Pattern | Op::Finish)
    }

    /// True for a cycle of a lathe that runs once, in the block that names it.
    pub const fn is_lathe_cycle(self) -> bool {
        self.reads_contour() || matches!(self, Op::FaceGroove | Op::Groove | Op::Threading)
    }

    /// True for a block that only sets what the next such cycle takes.
    pub const fn is_lathe_setup(self) -> bool {
        use Op::*;
        matches!(
            self,
            TurningSetup | FacingSetup | PatternSetup | FaceGrooveSetup | GrooveSetup | ThreadingSetup
        )
    }

    /// True for a tapping cycle.
    pub const fn is_tap(self) -> bool {
        matches!(
            self,
            Op::CycleTap
                | Op::CycleTapLeft
                | Op::CycleTapRigid
                | Op::CycleTapByLead
                | Op::FaceTap
                | Op::FaceTapMain
                | Op::FaceTapMainLeft
                | Op::SideTap
        ) || self.is_live_tap()
    }

    /// True for a drilling cycle of a lathe whose own code takes the wait at the bottom.
    pub const fn is_waiting_hole(self) -> bool {
        use Op::*;
        matches!(self, FaceDrillDwell | FacePeck | FaceBoreDwell | SideDrillDwell | SidePeck | SideBoreDwell)
    }

    /// True for a tap whose cycle turns a live tool by itself.
    pub const fn is_live_tap(self) -> bool {
        matches!(self, Op::FaceTapLive | Op::FaceTapLiveLeft | Op::SideTapLive | Op::SideTapLiveLeft)
    }

    /// True for what axis words beside it belong to: a place in a table, an origin, a centre or a factor, and no move.
    pub const fn takes_axes(self) -> bool {
        use Op::*;
        matches!(
            self,
            SetPosition
                | LocalShift
                | WriteWork
                | WriteLength
                | WriteLengthWear
                | WriteRadius
                | WriteRadiusWear
                | WriteOffset
                | WriteTurret
                | ReadOffset
                | WriteVariable
                | Pole
                | Cylinder
                | ScaleOn
                | MirrorOn
                | MirrorOff
                | RotateOn
                | StrokeCheckOn
        )
    }

    /// True for a way to a reference position, to check it, or from it: axis words beside it are its points.
    pub const fn is_return(self) -> bool {
        use Op::*;
        matches!(self, ReferenceCheck | ReferenceReturn | ReferenceFrom | Reference2)
    }

    /// True for a G code that is for its own block alone, but for the wait.
    pub const fn is_for_its_block(self) -> bool {
        use Op::*;
        self.is_lathe_cycle()
            || self.is_lathe_setup()
            || matches!(
                self,
                SetPosition
                    | LocalShift
                    | LimitSpeed
                    | WriteWork
                    | WriteOffset
                    | WriteTurret
                    | ReadOffset
                    | WriteVariable
                    | ReferenceCheck
                    | ReferenceReturn
                    | ReferenceFrom
                    | Reference2
                    | Home
                    | MachineOnce
                    | RapidOnce
                    | ExactStopOnce
                    | Probe
                    | ProbeOther
            )
    }

    /// True for what acts once, with words that mean something else without it.
    pub const fn acts_with_words(self) -> bool {
        self.takes_axes() || matches!(self, Op::Dwell)
    }

    /// True for what becomes a terminator of the IR, not an operation of a block.
    pub const fn is_flow(self) -> bool {
        use Op::*;
        matches!(
            self,
            CallMacro
                | CallModal
                | CallModalEach
                | CallModalOff
                | CallProgram
                | CallLocal
                | CallCycle
                | JumpInputOff
                | Jump
                | Return
                | SubEnd
                | SubAreaEnd
                | End
                | EndRewind
        )
    }
}
