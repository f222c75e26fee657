//! The common vocabulary: what a machine can be told, whatever the control.
//!
//! The tables in `dialects/` map a control's spellings to these names and
//! back. A word whose spelling has no row has no name here, and what has no
//! name cannot be carried to another control: nothing unmapped can be printed.
//!
//! Names are stable: they stand in the TOML tables, in the text form of the
//! IR and in traces.

mod acts;
mod auxiliary;
mod cycle_setting;
mod function;
mod group;
mod kinds;
mod operation;
mod pause;
mod role;
mod role_kinds;
mod state;

pub use acts::Act;
pub use auxiliary::Auxiliary;
pub use cycle_setting::CycleSetting;
pub use function::Func;
pub use group::Group;
pub use operation::Op;
pub use pause::{Pause, Running};
pub use role::Role;
pub use state::Sys;

/// True for a number of a mode of quality ([`Op::PathQuality`]) that ends one: tables number them so that the last digit is 0.
pub fn ends_quality(mode: f64) -> bool {
    mode % 10.0 == 0.0
}

/// Defines an enum whose variants have stable names, and the lookup both ways.
macro_rules! vocabulary {
    ($(#[$meta:meta])* $type:ident { $($(#[doc = $doc:literal])+ $variant:ident = $name:literal,)* }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $type { $($(#[doc = $doc])+ $variant,)* }

        impl $type {
            /// All of them, in order.
            pub const ALL: &'static [$type] = &[$($type::$variant),*];

            /// Its stable name.
            pub const fn name(self) -> &'static str {
                match self { $($type::$variant => $name,)* }
            }

            /// The one with this name.
            pub fn find(name: &str) -> Option<Self> {
                match name { $($name => Some($type::$variant),)* _ => None }
            }

            /// What it means, in a sentence.
            pub const fn meaning(self) -> &'static str {
                match self { $($type::$variant => concat!($($doc),+),)* }
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl serde::Serialize for $type {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(self.name())
            }
        }

        impl<'de> serde::Deserialize<'de> for $type {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let name = <std::borrow::Cow<'de, str> as serde::Deserialize>::deserialize(deserializer)?;
                Self::find(&name).ok_or_else(|| {
                    serde::de::Error::custom(format!(concat!("no ", stringify!($type), " is named '{}'"), name))
                })
            }
        }
    };
}
use vocabulary;
