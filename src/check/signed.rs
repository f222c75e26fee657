//! Whether what a signed report is about still stands there.

use super::finding::Finding;
use std::path::Path;

/// The findings of one report.
pub fn changed(_report: &Path) -> Vec<Finding> {
    Vec::new()
}
