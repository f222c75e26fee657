//! What kind of value a role has: an axis, a length, an angle, a whole number.

use super::Role;

impl Role {
    /// The words of builders' codes that profiles name.
    pub const ACT_WORDS: [Role; 16] = [
        Role::Act1,
        Role::Act2,
        Role::Act3,
        Role::Act4,
        Role::Act5,
        Role::Act6,
        Role::Act7,
        Role::Act8,
        Role::Act9,
        Role::Act10,
        Role::Act11,
        Role::Act12,
        Role::Act13,
        Role::Act14,
        Role::Act15,
        Role::Act16,
    ];

    /// Each axis word that has an increment of its own, and that increment.
    pub const STEPS: [(Role, Role); 4] =
        [(Role::X, Role::StepX), (Role::Y, Role::StepY), (Role::Z, Role::StepZ), (Role::C, Role::StepC)];

    /// True for a word of a builder's code that a profile names: its value is carried as it is.
    pub const fn is_act_word(self) -> bool {
        matches!(
            self,
            Role::Act1
                | Role::Act2
                | Role::Act3
                | Role::Act4
                | Role::Act5
                | Role::Act6
                | Role::Act7
                | Role::Act8
                | Role::Act9
                | Role::Act10
                | Role::Act11
                | Role::Act12
                | Role::Act13
                | Role::Act14
                | Role::Act15
                | Role::Act16
        )
    }

    /// True for the target of an axis.
    pub const fn is_axis(self) -> bool {
        matches!(
            self,
            Role::X | Role::Y | Role::Z | Role::A | Role::B | Role::C | Role::E | Role::U | Role::V | Role::W
        ) || self.is_step()
    }

    /// True for the way of an axis from where it is.
    pub const fn is_step(self) -> bool {
        matches!(self, Role::StepX | Role::StepY | Role::StepZ | Role::StepC)
    }

    /// The common number of the axis that it moves: 1 for X.
    pub const fn axis_number(self) -> Option<u32> {
        Some(match self {
            Role::X | Role::StepX => 1,
            Role::Y | Role::StepY => 2,
            Role::Z | Role::StepZ => 3,
            Role::A => 4,
            Role::B => 5,
            Role::C | Role::StepC => 6,
            Role::U => 7,
            Role::V => 8,
            Role::W => 9,
            Role::E => 10,
            _ => return None,
        })
    }

    /// True where the control rounds the value to a whole number.
    pub const fn is_integer(self) -> bool {
        matches!(
            self,
            Role::Speed
                | Role::TapOutSpeed
                | Role::Tool
                | Role::Turret
                | Role::ContourFirst
                | Role::ContourLast
                | Role::ContourType
                | Role::Passes
                | Role::ThreadForm
                | Role::ThreadFinishes
                | Role::ThreadInfeed
                | Role::ThreadStart
                | Role::ThreadAngle
                | Role::LengthOffset
                | Role::RadiusOffset
                | Role::WorkOffset
                | Role::Repeat
                | Role::HolesCount
                | Role::PocketCount
                | Role::Program
                | Role::Sequence
                | Role::CallCount
                | Role::CallAgain
                | Role::Input
                | Role::Output
                | Role::Lookahead
                | Role::OffsetRow
                | Role::OffsetTip
                | Role::ReferencePoint
                | Role::ProbePoint
                | Role::Act
        )
    }

    /// True for an angle, counted in least increments of a degree where no point is written.
    pub const fn is_angle(self) -> bool {
        matches!(
            self,
            Role::A
                | Role::B
                | Role::C
                | Role::StepC
                | Role::Angle
                | Role::PolarAngle
                | Role::LineAngle
                | Role::HolesStart
                | Role::HolesStep
        )
    }

    /// True for the corner after a move, or the angle of a line: what a drawing gives in place of coordinates.
    pub const fn is_drawn(self) -> bool {
        let corner = matches!(self, Role::CornerRadius | Role::CornerChamfer | Role::RoundNext);
        corner || matches!(self, Role::ChamferX | Role::ChamferZ | Role::ChamferNext | Role::LineAngle)
    }

    /// True for a scale factor.
    pub const fn is_scale(self) -> bool {
        matches!(self, Role::Scale | Role::ScaleX | Role::ScaleY | Role::ScaleZ)
    }

    /// True for a length, counted in least increments where no point is written.
    pub const fn is_length(self) -> bool {
        matches!(
            self,
            Role::X
                | Role::Y
                | Role::Z
                | Role::E
                | Role::U
                | Role::V
                | Role::W
                | Role::StepX
                | Role::StepY
                | Role::StepZ
                | Role::Taper
                | Role::TaperZ
                | Role::CutDepth
                | Role::CutRetract
                | Role::AllowanceX
                | Role::AllowanceZ
                | Role::RoughX
                | Role::RoughZ
                | Role::PatternX
                | Role::PatternZ
                | Role::GrooveX
                | Role::GrooveZ
                | Role::GrooveRelief
                | Role::ThreadHeight
                | Role::ThreadFirst
                | Role::ThreadLeast
                | Role::ThreadAllowance
                | Role::LeadGrowth
                | Role::ArcI
                | Role::ArcJ
                | Role::ArcK
                | Role::ArcRadius
                | Role::CornerRadius
                | Role::CornerChamfer
                | Role::ChamferX
                | Role::ChamferZ
                | Role::ChamferNext
                | Role::RoundNext
                | Role::CycleR
                | Role::CycleRStep
                | Role::CylinderRadius
                | Role::CycleQ
                | Role::PeckFirst
                | Role::PeckLess
                | Role::PeckLeast
                | Role::PeckClear
                | Role::CycleI
                | Role::CycleJ
                | Role::PolarDistance
                | Role::HolesRadius
                | Role::HolesApart
                | Role::PocketFirst
                | Role::PocketLast
                | Role::PocketStep
                | Role::OffsetValue
                | Role::OffsetNose
        )
    }
}
