//! Findings that were there before: only what is new counts.

use super::finding::Finding;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The findings of an earlier check.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// Version of this file's shape.
    version: u32,
    /// By fingerprint, what was found: for the reader; the fingerprint decides.
    findings: BTreeMap<String, String>,
}

/// Why a baseline could not be used.
#[derive(Debug, thiserror::Error)]
#[error("{0}: {1}. Write it anew with --write-baseline")]
pub struct BaselineError(PathBuf, String);

const VERSION: u32 = 1;

impl Baseline {
    /// These findings.
    pub fn of(findings: &[Finding]) -> Self {
        let entry = |finding: &Finding| {
            let what = format!(
                "{} {}: {}",
                finding.code.number(),
                crate::library::slashed(&finding.file),
                finding.message
            );
            (finding.fingerprint.clone(), what)
        };
        Self { version: VERSION, findings: findings.iter().map(entry).collect() }
    }

    /// Reads one.
    ///
    /// # Errors
    /// A file that cannot be read, or is none.
    pub fn load(path: &Path) -> Result<Self, BaselineError> {
        let fault = |why: String| BaselineError(path.to_owned(), why);
        let text = std::fs::read(path).map_err(|error| fault(error.to_string()))?;
        let read: Self = serde_json::from_slice(&text).map_err(|error| fault(error.to_string()))?;
        match read.version {
            VERSION => Ok(read),
            other => Err(fault(format!("is of version {other}, this macroglot writes version {VERSION}"))),
        }
    }

    /// Its text.
    pub fn print(&self) -> String {
        crate::text::json_pretty(self) + "\n"
    }

    /// Takes out the findings that it knows, and counts them.
    pub fn take_known(&self, findings: &mut Vec<Finding>) -> usize {
        let before = findings.len();
        findings.retain(|finding| !self.findings.contains_key(&finding.fingerprint));
        before - findings.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Code;

    #[test]
    fn what_it_knows_is_taken_out() {
        let finding =
            |text: &str| Finding::of_file(Code::SourceGone, Path::new("a.nc"), text.into(), "h".into());
        let mut before = vec![finding("one"), finding("two")];
        super::super::finding::number(&mut before, Path::new("/"));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("b.json");
        std::fs::write(&path, Baseline::of(&before).print()).unwrap();
        let mut now = vec![finding("three"), finding("two"), finding("one")];
        super::super::finding::number(&mut now, Path::new("/"));
        assert_eq!(Baseline::load(&path).unwrap().take_known(&mut now), 2);
        assert_eq!(now.iter().map(|f| f.message.as_str()).collect::<Vec<_>>(), ["three"]);
        std::fs::write(&path, "{\"version\":9,\"findings\":{}}").unwrap();
        assert!(Baseline::load(&path).unwrap_err().to_string().contains("version 9"));
        std::fs::write(&path, "[").unwrap();
        assert!(Baseline::load(&path).unwrap_err().to_string().contains("--write-baseline"));
    }
}
