//! The pages of the codes that occur, as `explain` prints them.

use super::super::grade;
use super::{escaped, ticked};
use crate::diag::Code;
use std::collections::BTreeSet;
use std::fmt::Write;

/// What each code means.
pub fn pages(out: &mut String, codes: &BTreeSet<Code>) {
    out.push_str("<h2 id=\"codes\">What the codes mean</h2>\n");
    if codes.is_empty() {
        out.push_str("<p>Nothing was found that has a code.</p>\n");
    }
    for code in codes {
        let (number, severity) = (code.number(), grade(code.severity()));
        let _ = writeln!(
            out,
            "<section id=\"{number}\">\n<h3>{number}: {} ({severity})</h3>",
            escaped(code.title())
        );
        for paragraph in code.page().split("\n\n") {
            let _ = writeln!(out, "<p>{}</p>", ticked(paragraph));
        }
        out.push_str("</section>\n");
    }
}
