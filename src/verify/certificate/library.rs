//! The certificate of a file or a library: what was run, and what came of it. `docs/certificate.md` explains its keys.

use super::outcome::Outcome;
use super::program::ProgramCertificate;
use crate::dialect::Control;
use crate::text::json_pretty;
use crate::verify::sides::{Effort, hex};
use serde::Serialize;
use sha2::{Digest, Sha256};

/// Version of the certificate's shape.
pub const FORMAT: u32 = 1;

/// What a verification found, for a file or a library.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Certificate {
    /// Version of the shape of this object.
    pub format: u32,
    /// Version of macroglot.
    pub macroglot: &'static str,
    /// The worst outcome of any program.
    pub outcome: Outcome,
    /// The control of the source.
    pub from: Identity,
    /// The control of the target.
    pub to: Identity,
    /// Seed of the scenarios that were drawn.
    pub seed: u64,
    /// Most blocks that a run executed.
    pub steps: u64,
    /// The programs of the source.
    pub programs: Vec<ProgramCertificate>,
}

/// Which control a side ran on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Identity {
    /// The dialect.
    pub control: String,
    /// Hash of its table and of the machine profile over it.
    pub sha256: String,
}

impl Certificate {
    /// A certificate of programs.
    pub fn new(from: &Control, to: &Control, effort: Effort, programs: Vec<ProgramCertificate>) -> Self {
        Self {
            format: FORMAT,
            macroglot: env!("CARGO_PKG_VERSION"),
            // Of nothing nothing was shown.
            outcome: programs.iter().map(|program| program.outcome).max().unwrap_or(Outcome::Undecided),
            from: Identity::of(from),
            to: Identity::of(to),
            seed: effort.seed,
            steps: effort.steps,
            programs,
        }
    }

    /// Takes the worst outcome of its programs anew.
    pub fn sum_up(&mut self) {
        self.outcome = self.programs.iter().map(|program| program.outcome).max().unwrap_or(self.outcome);
    }

    /// As JSON text.
    pub fn print(&self) -> String {
        json_pretty(self) + "\n"
    }
}

impl Identity {
    /// Of a control.
    pub fn of(control: &Control) -> Self {
        let mut hash = Sha256::new();
        for (_, text) in control.entry().files() {
            hash.update(text.as_bytes());
        }
        // Where the profile lies does not count.
        let mut profile = control.profile().clone();
        profile.file = None;
        profile.bases.clear();
        hash.update(format!("{profile:?}").as_bytes());
        Self { control: control.name().into(), sha256: hex(&hash.finalize()) }
    }
}
