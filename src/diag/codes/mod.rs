//! The catalogue. Everything that is said of a code anywhere (`macroglot
//! explain`, `docs/diagnostics.md`, SARIF rules) comes from its row here.
//!
//! Codes are grouped by the part of the line that finds them: 01 text and
//! syntax, 02 dialects and machine profiles, 03 lowering, 04 legalization,
//! 05 emission, 06 libraries and projects, 07 the command line, 08 emulated
//! controls and verification, 09 checks. A number is never used again.
//!
//! Each group has its file, which adds its rows to those before it and hands them on to the next; here all of them become
//! one enum.

mod checks;
mod emission;
mod legalization;
mod libraries;
mod lowering;
mod machines;
mod text;
mod verification;

use super::Severity;
use checks::checks_codes;
use emission::emission_codes;
use legalization::legalization_codes;
use libraries::libraries_codes;
use lowering::lowering_codes;
use machines::machines_codes;
use text::text_codes;
use verification::verification_codes;

macro_rules! codes {
    ($($number:literal $name:ident $severity:ident $title:literal $page:literal)*) => {
        /// The code of a diagnostic.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = $title] $name,)*
        }

        /// Every code, in order.
        pub const ALL: &[Code] = &[$(Code::$name),*];

        impl Code {
            /// Its number as users see it: `MG0101`.
            pub const fn number(self) -> &'static str {
                match self { $(Code::$name => concat!("MG", $number),)* }
            }

            /// How grave it is.
            pub const fn severity(self) -> Severity {
                match self { $(Code::$name => Severity::$severity,)* }
            }

            /// True for what is open of a machine: its profile answers it, once for all programs.
            pub const fn is_of_machine(self) -> bool {
                matches!(self, Code::UnconfirmedFact | Code::StartUnknown)
            }

            /// What it is, in a few words.
            pub const fn title(self) -> &'static str {
                match self { $(Code::$name => $title,)* }
            }

            /// Its page: what happened, why it matters, what to do.
            pub const fn page(self) -> &'static str {
                match self { $(Code::$name => $page,)* }
            }
        }
    };
}

impl Code {
    /// The code with this number (`MG0101`, case and the letters MG left free).
    pub fn find(number: &str) -> Option<Code> {
        let digits = number.trim().trim_start_matches(['M', 'm', 'G', 'g']);
        ALL.iter().copied().find(|code| &code.number()[2..] == digits)
    }
}

impl serde::Serialize for Code {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.number())
    }
}

text_codes! {}
