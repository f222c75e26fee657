//! Variables: their classes, and the flags that say which of them have a value.

/// A class of variables: who can see them and how long they last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Class {
    /// Local to a call level; may be vacant.
    Local,
    /// Seen by all programs, vacant after power-on; may be vacant.
    Common,
    /// Seen by all programs, kept over power-off; may be vacant.
    Retained,
    /// Seen by all programs, kept from run to run; whether over power-off no source says. Never vacant.
    Global,
    /// Like global, and the only variables that NC words of the source may use. Never vacant.
    Parametric,
    /// The condition register (number 0) and other hidden state of the source. Never vacant.
    Register,
    /// Introduced by the compiler, local to one program. Never vacant.
    Temp,
    /// A register of the compiler's own that all programs see: what a local becomes on a control without locals.
    /// Never vacant, and nothing outside looks at it.
    Static,
}

impl Class {
    /// All of them, in order.
    pub const ALL: [Self; 8] = [
        Self::Local,
        Self::Common,
        Self::Retained,
        Self::Global,
        Self::Parametric,
        Self::Register,
        Self::Temp,
        Self::Static,
    ];

    /// True where a variable of the class may be vacant.
    pub const fn nullable(self) -> bool {
        matches!(self, Class::Local | Class::Common | Class::Retained)
    }

    /// True where people and devices outside the programs see the variable, by its number.
    pub const fn is_numbered(self) -> bool {
        matches!(self, Class::Common | Class::Retained | Class::Global | Class::Parametric)
    }

    /// True where other programs see the variable.
    pub const fn shared(self) -> bool {
        !matches!(self, Class::Local | Class::Temp)
    }
}

/// A variable. Its number is the one it has in the source; letters count from 101 (VA).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Var {
    /// Its class.
    pub class: Class,
    /// Its number.
    pub number: u32,
}

impl Var {
    /// The flag that says whether a variable has a value, for a control that knows no vacant ones. A flag of a local is
    /// a local of the same level.
    #[must_use]
    pub const fn flag(self) -> Self {
        let first = if matches!(self.class, Class::Local) { LOCAL_FLAGS } else { FLAGS };
        Self { number: self.number + first, ..self }
    }
}

/// What people and the lock call the flag of a variable.
pub fn flag_of(name: &str) -> String {
    format!("flag of {name}")
}

/// Statics from this number on belong to no level: what a program sets there its callers find.
pub const OF_NO_LEVEL: u32 = 1_000_000;

/// The first of those that a pass sets, by what they hold: two passes may act on one program, so each has its own.
pub mod statics_of {
    use super::OF_NO_LEVEL;

    /// What the moves of drilling cycles count with.
    pub const HOLES: u32 = OF_NO_LEVEL;
    /// The cosine, the sine and the centre of a rotation.
    pub const ROTATION: u32 = OF_NO_LEVEL + 100;
    /// The length and the angle of a place in polar coordinates.
    pub const POLAR: u32 = OF_NO_LEVEL + 110;
    /// A local shift along X, Y and Z.
    pub const SHIFT: u32 = OF_NO_LEVEL + 120;
    /// The last numbers of tool offsets, and codes in force.
    pub const LAST_WORDS: u32 = OF_NO_LEVEL + 130;
}

/// Flags of locals have numbers from here on.
pub const LOCAL_FLAGS: u32 = 100;

/// The largest number that a shared variable may have: controls of six digits and two more.
pub const LAST_NUMBER: u32 = 99_999_999;

/// Flags of other variables have numbers from here on.
pub const FLAGS: u32 = LAST_NUMBER + 1;
