//! Findings of a file, drawn as many as a person looks at.
//!
//! A line may have as many findings as letters, and a drawing is a thousand times as long as a letter.

use super::Sheet;
use crate::diag::{Code, Diagnostic};
use std::collections::{BTreeMap, HashMap};

/// Findings of one code that are drawn of a line.
const OF_A_LINE: usize = 10;

/// Findings of one code that are drawn of a file.
const OF_A_FILE: usize = 500;

/// A file on which findings are drawn until there are too many of a kind; from there on they are counted.
///
/// The bounds are those of each code, so that no finding hides one of another kind.
pub struct Drawings<'b> {
    sheet: Sheet<'b>,
    of_lines: HashMap<(usize, Code), usize>,
    of_file: BTreeMap<Code, usize>,
    left_out: BTreeMap<Code, usize>,
}

impl<'b> Drawings<'b> {
    /// The file of this name.
    pub fn new(name: &str, bytes: &'b [u8]) -> Self {
        let sheet = Sheet::new(name, bytes);
        Self { sheet, of_lines: HashMap::new(), of_file: BTreeMap::new(), left_out: BTreeMap::new() }
    }

    /// A finding, drawn; none if it is counted alone.
    pub fn draw(&mut self, finding: &Diagnostic) -> Option<String> {
        let of_file = self.of_file.entry(finding.code).or_default();
        // The lines of those that are counted alone need not be known.
        let of_line = (*of_file < OF_A_FILE)
            .then(|| self.of_lines.entry((self.sheet.line(finding), finding.code)).or_default());
        let Some(of_line) = of_line.filter(|of_line| **of_line < OF_A_LINE) else {
            *self.left_out.entry(finding.code).or_default() += 1;
            return None;
        };
        *of_line += 1;
        *of_file += 1;
        Some(self.sheet.draw(finding))
    }

    /// How many findings were not drawn, if any were not.
    pub fn left_out(&self) -> Option<String> {
        let total: usize = self.left_out.values().sum();
        let codes: Vec<String> =
            self.left_out.iter().map(|(code, count)| format!("{count} of {}", code.number())).collect();
        let findings = if total == 1 { "finding" } else { "findings" };
        (total > 0).then(|| {
            format!("{}: {total} more {findings} not drawn: {}", self.sheet.name(), codes.join(", "))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Span;

    #[test]
    fn more_than_a_person_reads_is_counted() {
        let text = "M38 ".repeat(100) + "\n" + &"M38\n".repeat(1000);
        let mut drawings = Drawings::new("a.nc", text.as_bytes());
        let mut drawn =
            |code, at: u32| drawings.draw(&Diagnostic::new(code, Span::new(at, at + 3), "")).is_some();
        let of_first = (0..100).filter(|at| drawn(Code::Unmapped, 4 * at)).count();
        assert_eq!(of_first, 10);
        assert!(drawn(Code::TooComplex, 40), "another kind is drawn");
        let of_others = (0..1000).filter(|at| drawn(Code::Unmapped, 401 + 4 * at)).count();
        assert_eq!(of_others, 490);
        assert!(!drawn(Code::Unmapped, 401));
        let told = format!("a.nc: 601 more findings not drawn: 601 of {}", Code::Unmapped.number());
        assert_eq!(drawings.left_out(), Some(told));
        assert_eq!(Drawings::new("a.nc", b"").left_out(), None);
    }
}
