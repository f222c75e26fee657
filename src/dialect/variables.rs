//! The variables that programs may use freely, and their numbers.

use super::Origin;
use serde::{Deserialize, Serialize};

/// A class of variables.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VariableClass {
    /// `local`, `common`, `retained`, `parametric`, `letter`.
    pub class: String,
    /// Their name before the number: `#`, `V`, `R`.
    pub name: String,
    /// First number.
    pub first: u32,
    /// Last number.
    pub last: u32,
    /// True where the value survives power-off; absent where unknown.
    pub retained: Option<bool>,
    /// True where a variable may be vacant.
    #[serde(default)]
    pub nullable: bool,
    /// An option that must be bought, absent in the basic control.
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// A matter that no table asks about ([`matters`](super::matters)), and of which a source says that it is as the emulated
/// controls have it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matter {
    /// Its name without what all have in front: `arc.radius.full.circle`.
    pub name: String,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// Free variables that something of most shops has put to use: a conversion takes others while there are any.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InUse {
    /// Their name before the number.
    pub name: String,
    /// First number.
    pub first: u32,
    /// Last number.
    pub last: u32,
    /// What has them.
    pub by: String,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// Numbers that name the cells of other numbers: the control has two numberings of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SameCells {
    /// Their name before the number.
    pub name: String,
    /// First number.
    pub first: u32,
    /// Last number.
    pub last: u32,
    /// The number of the first cell among the variables.
    pub cell: u32,
    /// An option that must be bought, absent in the basic control.
    pub option: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

impl SameCells {
    /// The cell of one of the numbers.
    pub fn cell_of(&self, number: u32) -> u32 {
        number - self.first + self.cell
    }
}
