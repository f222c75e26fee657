//! A certificate in words.

use super::totals::plural;
use super::trace::number;
use crate::text::shown;
use crate::verify::{self, Certificate, Moment, NotReached, ProgramCertificate};
use std::fmt::Write;

/// Entries of a list that are shown of a program; the certificate has all.
const MOST: usize = 10;

/// What was verified, for people: each program with what was found, why it is not decided, and where the two differ.
pub fn certificate(certificate: &Certificate) -> String {
    let mut out = String::new();
    for program in &certificate.programs {
        of_program(&mut out, program);
    }
    let count = |outcome| certificate.programs.iter().filter(|program| program.outcome == outcome).count();
    let [same, undecided, different] =
        [verify::Outcome::Same, verify::Outcome::Undecided, verify::Outcome::Different].map(count);
    let programs = plural(certificate.programs.len(), "program");
    // Writing to memory cannot fail.
    let _ = writeln!(out, "{programs}: {same} the same, {undecided} undecided, {different} different");
    out
}

fn of_program(out: &mut String, found: &ProgramCertificate) {
    let name = found.program.as_deref().unwrap_or("(no name)");
    let target = found.target.as_deref().unwrap_or("no counterpart");
    let _ = writeln!(out, "{name} ({} and {target})", shown(&found.source));
    facts(found).iter().for_each(|fact| _ = writeln!(out, "  {}", shown(fact)));
    list(out, "Why it is not decided", found.reasons.iter().map(|reason| reason.text.clone()));
    let assumed = found.assumptions.iter().map(|assumed| {
        let runs = match (assumed.kept, assumed.broken) {
            (Some(kept), Some(broken)) => format!("{} kept it, {broken} broke it", plural(kept, "run")),
            _ => "no run can show it: a person must".to_owned(),
        };
        format!("line {}: {} ({runs})", assumed.line, assumed.text)
    });
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
    let unconfirmed = found.unconfirmed.iter().cloned();
    list(out, "Facts that mattered and that no manual confirms", unconfirmed);
    if let Some(witness) = &found.witness {
        let _ = writeln!(out, "  Where they differ: {}", shown(&witness.what));
        for (side, moment) in [("source", &witness.source), ("target", &witness.target)] {
            let at = moment.as_ref().map_or_else(|| "nothing more".into(), at);
            let _ = writeln!(out, "    {side}: {}", shown(&at));
        }
        let set = witness.scenario.variables.iter().take(MOST);
        let set: Vec<String> = set.map(|(name, value)| format!("{name} = {}", number(*value))).collect();
        if !set.is_empty() {
            let _ = writeln!(out, "    started with: {}", set.join(", "));
        }
    }
    out.push('\n');
}

fn list(out: &mut String, title: &str, all: impl ExactSizeIterator<Item = String>) {
    let count = all.len();
    if count == 0 {
        return;
    }
    let _ = writeln!(out, "  {title}:");
    all.take(MOST).for_each(|text| _ = writeln!(out, "    - {}", shown(&text)));
    if count > MOST {
        let _ = writeln!(out, "    - and {} more: --format json has all", count - MOST);
    }
}

fn way(branch: &NotReached) -> String {
    let way = match branch.way {
        "true" => "never true",
        "false" => "never false",
        _ => "never gone",
    };
    format!("line {}, column {}: {} was {way}", branch.line, branch.column, branch.text)
}

fn at(moment: &Moment) -> String {
    let Moment { file, program, line, block, .. } = moment;
    format!("{block}, line {line} of {file} {program}")
}

/// What is to be said of each certificate.
pub(super) fn facts(found: &ProgramCertificate) -> Vec<String> {
    let outcome = match found.outcome {
        verify::Outcome::Same => "The same: in no scenario did the machines do anything else.",
        verify::Outcome::Undecided if found.scenarios_compared == 0 => {
            "Not decided: nothing could be compared to the end on both machines."
        }
        verify::Outcome::Undecided => "Not decided: no difference was found, but not everything was shown.",
        verify::Outcome::Different => "Different: the machines do not do the same.",
    };
    let mut all = vec![
        outcome.to_owned(),
        format!(
            "{} tried, {} compared to the end on both machines.",
            plural(found.scenarios_tried, "scenario"),
            found.scenarios_compared
        ),
        format!(
            "Ways of branches reached: {} of {} of the source, {} of {} of the target.",
            found.branches_covered,
            found.branches_total,
            found.target_branches_covered,
            found.target_branches_total
        ),
    ];
    if found.scenarios_compared > 0 {
        all.push(format!(
            "Largest distance between positions that count as the same: {} mm; allowed are {} mm.",
            number(found.largest_difference_mm),
            number(found.tolerance_mm)
        ));
    }
    match found.rounding_sensitive {
        Some(true) => all.push("Its path changes where the target computes with fewer digits.".into()),
        Some(false) => {
            all.push("Its path stays the same where the target computes with fewer digits.".into())
        }
        None => {}
    }
    if !found.given.is_empty() {
        all.push(format!("It was run as its callers leave the machine: {}.", found.given.join(", ")));
    }
    if found.never_come_to {
        all.push("Other programs call it, but none of their runs reached it.".into());
    }
    if found.run_alone {
        all.push("It was run by itself: no run of its callers could show what it does then.".into());
    }
    if !found.started.is_empty() {
        all.push(format!("It was also started with: {}.", found.started.join(", ").replace('_', " ")));
    }
    all
}
