//! What the verifier found of a program, in words.

use super::{escaped, plural, ticked};
use crate::library::{Outcome, ProgramReport};
use crate::report::certificate::facts;
use crate::report::trace::number;
use crate::verify::{Assumed, Moment, NotReached, ProgramCertificate};
use std::fmt::Write;

/// Entries of a list that are shown.
const MOST: usize = 30;

/// The certificate of a program; why there is none where there is none.
pub fn certificate(out: &mut String, program: &ProgramReport, found: Option<&ProgramCertificate>) {
    out.push_str("<h4>Verification</h4>\n");
    let Some(found) = found else {
        let why = match (program.outcome, program.verdict) {
            (Outcome::Refused, None) => "It was refused before anything could be verified.",
            (_, Some(_)) => "It could not be verified; its finding says why.",
            _ => "It was not verified: nothing was run beside its source.",
        };
        let _ = writeln!(out, "<p>{why}</p>");
        return;
    };
    out.push_str("<ul class=\"facts\">\n");
    for text in facts(found) {
        let _ = writeln!(out, "<li>{}", escaped(&text));
    }
    list(out, "Why it is not decided", found.reasons.iter().map(|reason| escaped(&reason.text)));
    let assumed = found.assumptions.iter().map(assumption);
    list(out, "What the conversion supposes", assumed);
    list(out, "Ways of the source that no scenario went", found.not_reached.iter().map(way));
    list(out, "Ways of the target that no scenario went", found.target_not_reached.iter().map(way));
    list(
        out,
        "Ways of the source that only other numbers in it would go",
        found.by_own_numbers.iter().map(way),
    );
    list(out, "The same of the target", found.target_by_own_numbers.iter().map(way));
    list(
        out,
        "Ways to an alarm that no scenario went, and that both texts write alike",
        found.by_text.iter().map(way),
    );
    list(
        out,
        "Facts that mattered and that no manual confirms",
        found.unconfirmed.iter().map(|f| escaped(f)),
    );
    let texts = found
        .texts
        .iter()
        .map(|(a, b)| format!("<code>{}</code> is <code>{}</code>", escaped(a), escaped(b)));
    list(out, "Texts that are written differently and say the same", texts);
    let edits = found.edits.iter().map(|edit| {
        escaped(&format!(
            "{} in line {} ({} in line {} of the target) was {}",
            edit.variable,
            edit.line,
            edit.register,
            edit.target_line,
            number(edit.value)
        ))
    });
    list(out, "Constants that were edited alike in both texts, to reach what they decide", edits);
    out.push_str("</ul>\n");
    witness(out, found);
}

fn list(out: &mut String, title: &str, all: impl ExactSizeIterator<Item = String>) {
    let count = all.len();
    if count == 0 {
        return;
    }
    let _ = writeln!(out, "<li>{title}:\n<ul>");
    all.take(MOST).for_each(|text| _ = writeln!(out, "<li>{text}"));
    if count > MOST {
        let _ = writeln!(out, "<li>and {} more, in the certificate", count - MOST);
    }
    out.push_str("</ul>\n");
}

fn assumption(assumed: &Assumed) -> String {
    let runs = match (assumed.kept, assumed.broken) {
        (Some(kept), Some(broken)) => {
            format!("{} kept it and did the same, {broken} broke it", plural(kept, "run"))
        }
        _ => "no run can show it: a person must".to_owned(),
    };
    format!("line {}: {} <i>({runs})</i>", assumed.line, ticked(&assumed.text))
}

fn way(branch: &NotReached) -> String {
    let way = match branch.way {
        "true" => "never true",
        "false" => "never false",
        _ => "never gone",
    };
    format!(
        "line {}, column {}: <code>{}</code> was {way}",
        branch.line,
        branch.column,
        escaped(&branch.text)
    )
}

/// Where the two differ.
fn witness(out: &mut String, found: &ProgramCertificate) {
    let Some(witness) = &found.witness else { return };
    let _ = writeln!(out, "<h4>Where they differ</h4>\n<p>{}</p>\n<table>", escaped(&witness.what));
    for (side, moment) in [("Source", &witness.source), ("Target", &witness.target)] {
        let _ =
            writeln!(out, "<tr><th>{side}<td>{}", moment.as_ref().map_or_else(|| "nothing more".into(), at));
    }
    let variables = witness.scenario.variables.iter().take(MOST);
    let set: Vec<String> = variables.map(|(name, value)| format!("{name} = {}", number(*value))).collect();
    if !set.is_empty() {
        let _ = writeln!(out, "<tr><th>Started with<td>{}", escaped(&set.join(", ")));
    }
    out.push_str("</table>\n");
}

fn at(moment: &Moment) -> String {
    let Moment { file, program, line, block, .. } = moment;
    format!("<code>{}</code>, line {line} of {} {}", escaped(block), escaped(file), escaped(program))
}
