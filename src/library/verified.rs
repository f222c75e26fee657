//! Lets the verifier judge a conversion: what differs is refused, what is not decided is for review.

use super::callees::{Callees, programs_of};
use super::withdrawn::{Certificates, cut, withdraw, written};
use super::{Conversion, Input, Outcome};
use crate::assume::Assumption;
use crate::control::{LoadedFile, ProgramRef};
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::{Control, Side as Of};
use crate::ir::analysis::dataflow::reached;
use crate::syntax::{ParsedFile, parse_file};
use crate::text::Span;
use crate::verify::{self, Certificate, Effort, Job, OpenFact, ProgramCertificate, Side, Spent, Why};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A program that is to be judged: its report among the conversion's, and the program on its control.
type Wanted = (usize, ProgramRef);

/// The longest file that is verified beside its conversion, bytes: both are held in memory block by block.
const LONGEST: usize = 8 << 20;

/// Verifies every program that was converted, and lets its outcome rest on that.
///
/// A program that differs is withdrawn, and so is what calls it. Drafts take no part: whoever calls one is judged
/// as if it were not there.
pub fn judge(
    inputs: &[Input],
    conversion: &mut Conversion,
    source: &Control,
    target: &Control,
    effort: Effort,
) -> Certificates {
    judge_telling(inputs, conversion, (source, target), (effort, &[]), &|_| ())
}

/// The same for the files that are `named`, or for all if none is told; and tells how many programs of a file are done,
/// whenever one is.
pub fn judge_telling(
    inputs: &[Input],
    conversion: &mut Conversion,
    (source, target): (&Control, &Control),
    (effort, named): (Effort, &[bool]),
    done: &(dyn Fn(usize) + Sync),
) -> Certificates {
    let (Some(run), Some(run_there)) = (source.entry().execute, target.entry().execute) else {
        open(conversion).for_each(|program| undecided(program, "there is no emulated control to run it on"));
        return Certificates::none(inputs.len());
    };
    let long: Vec<bool> = inputs.iter().map(|input| input.bytes.len() > LONGEST).collect();
    open(conversion).filter(|program| long[program.file]).for_each(|program| {
        undecided(
            program,
            "the file is too long to be verified during the conversion: run `macroglot \
                            verify` on it",
        );
    });
    let refused: BTreeSet<usize> = refused(conversion).collect();
    let texts = (0..inputs.len()).filter(|at| !long[*at]);
    let texts: Vec<(usize, String)> =
        texts.filter_map(|at| Some((at, cut(conversion, at, &refused)?))).collect();
    let bytes = |at: usize| if long[at] { &[][..] } else { &inputs[at].bytes };
    let ours: Vec<ParsedFile<'_>> =
        (0..inputs.len()).into_par_iter().map(|at| parse_file(bytes(at), source.entry().parse)).collect();
    let theirs: Vec<ParsedFile<'_>> =
        texts.par_iter().map(|(_, text)| parse_file(text.as_bytes(), target.entry().parse)).collect();
    let ours: Vec<LoadedFile<'_>> =
        inputs.iter().zip(&ours).map(|(input, parsed)| LoadedFile { name: &input.name, parsed }).collect();
    let theirs: Vec<LoadedFile<'_>> = texts
        .iter()
        .zip(&theirs)
        .map(|((at, _), parsed)| LoadedFile { name: &inputs[*at].name, parsed })
        .collect();
    let names = super::pairs::names(conversion);
    let (from, to) = (Side::new(source, run, &ours), Side::new(target, run_there, &theirs));
    let (from, to) = verify::beside(from, to, &names);
    let all = from.programs();
    let reports = programs_of(conversion, all);
    let assumed = |at: &usize| assumptions(&conversion.programs[*at]);
    let assumptions = reports.iter().map(|(program, at)| (*program, assumed(at))).collect();
    let job = Job {
        source: &from,
        target: &to,
        names: &names,
        assumptions: &assumptions,
        effort,
        spent: &Spent::default(),
    };
    let wanted = wanted(conversion, all, (inputs.len(), named));
    let all_wanted: Vec<ProgramRef> = wanted.iter().flatten().map(|(_, program)| *program).collect();
    verify::prepare(&job, &all_wanted);
    let mut verified: Vec<Option<Certificate>> = wanted
        .par_iter()
        .map(|wanted| {
            let programs: Vec<ProgramRef> = wanted.iter().map(|(_, program)| *program).collect();
            let found = (!programs.is_empty()).then(|| verify::verify(&job, &programs));
            done(programs.len());
            found
        })
        .collect();
    verify::implicate(verified.iter_mut().flatten());
    let place = |program: ProgramRef| {
        let block = ours[program.file].parsed.blocks.get(from.blocks(program).start);
        block.map_or_else(Span::default, |block| block.span)
    };
    let mut callees = Callees::of(conversion, reports, refused);
    let mut found = BTreeMap::new();
    for (certificate, wanted) in verified.iter_mut().flatten().zip(wanted.iter().filter(|w| !w.is_empty())) {
        for ((at, program), mut found_here) in wanted.iter().zip(std::mem::take(&mut certificate.programs)) {
            let report = &mut conversion.programs[*at].diagnostics;
            let entered = found_here.entered.iter().filter(|entered| *entered != program);
            let below = entered.filter_map(|program| assumptions.get(program)).flatten();
            let below: Vec<Arc<str>> = below.map(|one| one.text.clone()).collect();
            ask_of_machines(&mut found_here, (report, &below), place(*program), [source, target]);
            callees.look(*at, place(*program), &found_here);
            found.insert(*at, found_here);
        }
    }
    callees.withdraw();
    for (at, found) in &mut found {
        let program = &mut conversion.programs[*at];
        // What is withdrawn for its callee says so at the call.
        if callees.withdrawn.contains_key(at) {
            apply(program, callees.place(*at), found, [source, target]);
            callees.reasons(*at, found);
            program.verdict = Some(found.outcome);
        } else {
            callees.reasons(*at, found);
            apply(program, callees.place(*at), found, [source, target]);
        }
    }
    callees.tell(conversion);
    withdraw(conversion, &callees.withdrawn);
    let withheld = callees.withdrawn.keys().copied().collect();
    let rest_on = rest_on(conversion, &callees, found.keys().copied());
    let judged = written(conversion, inputs, verified, found, &withheld);
    Certificates { rest_on, ..judged }
}

/// The other files that are written and that the programs of each file call into, however far down; and for what is
/// called the same of all that calls it, however far up: it was begun in what their runs give.
fn rest_on(
    conversion: &Conversion,
    callees: &Callees,
    judged: impl Iterator<Item = usize>,
) -> Vec<BTreeSet<usize>> {
    let mut files = vec![BTreeSet::new(); conversion.texts.len()];
    let file = |at: usize| conversion.programs[at].file;
    let mut by_file: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for at in judged.filter(|at| !callees.withdrawn.contains_key(at)) {
        by_file.entry(file(at)).or_default().insert(at);
    }
    let calls = callees.all();
    let mut callers: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (caller, callee) in calls.iter().flat_map(|(caller, all)| all.iter().map(move |at| (*caller, *at))) {
        callers.entry(callee).or_default().insert(caller);
    }
    for (here, programs) in by_file {
        let above = reached(programs, |at, go| callers.get(&at).into_iter().flatten().for_each(|to| go(*to)));
        let all = reached(above, |at, go| calls.get(&at).into_iter().flatten().for_each(|to| go(*to)));
        let others = all.into_iter().map(file).filter(|other| *other != here);
        files[here].extend(others.filter(|other| conversion.texts[*other].is_some()));
    }
    files
}

/// What the conversion of a program supposes.
fn assumptions(program: &super::ProgramReport) -> Vec<Assumption> {
    let mut all: Vec<Assumption> = Vec::new();
    for assumption in program.diagnostics.iter().filter_map(Diagnostic::assumption) {
        if !all.contains(&assumption) {
            all.push(assumption);
        }
    }
    all
}

/// The programs that have no conversion, drafts aside.
fn refused(conversion: &Conversion) -> impl Iterator<Item = usize> + '_ {
    let all = conversion.programs.iter().enumerate();
    all.filter(|(_, program)| program.outcome == Outcome::Refused).map(|(at, _)| at)
}

/// The programs that have a conversion.
fn open(conversion: &mut Conversion) -> impl Iterator<Item = &mut super::ProgramReport> {
    conversion.programs.iter_mut().filter(|program| program.outcome != Outcome::Refused)
}

/// The programs of each file that are to be judged.
fn wanted(
    conversion: &mut Conversion,
    all: &[ProgramRef],
    (files, named): (usize, &[bool]),
) -> Vec<Vec<Wanted>> {
    let mut wanted = vec![Vec::new(); files];
    for (file, wanted) in wanted.iter_mut().enumerate() {
        let sections = all.iter().filter(|program| program.file == file).copied();
        let reports: Vec<usize> =
            (0..conversion.programs.len()).filter(|at| conversion.programs[*at].file == file).collect();
        let is_named = named.get(file).is_none_or(|named| *named);
        if !is_named || reports.iter().all(|at| conversion.programs[*at].verdict.is_some()) {
            continue;
        }
        // Both sides cut a file at its program words; where they disagree, nothing can be verified.
        if sections.clone().count() == reports.len() {
            let paired = reports.into_iter().zip(sections);
            wanted.extend(paired.filter(|(at, _)| conversion.programs[*at].outcome != Outcome::Refused));
        } else {
            open(conversion).filter(|program| program.file == file).for_each(|program| {
                undecided(
                    program,
                    "the emulated control divides the file into \
                                                        programs differently",
                )
            });
        }
    }
    wanted
}

/// Notes that nothing could be verified.
fn undecided(program: &mut super::ProgramReport, why: &str) {
    program.diagnostics.push(Diagnostic::new(Code::NotDecided, Span::default(), why));
    program.outcome = Outcome::Review;
    program.verdict = Some(verify::Outcome::Undecided);
}

/// Asks the machines for what a program rests on that no source confirms, and that the conversion did not know of. Who answers
/// it answers for all programs: it is no reason to be undecided.
fn ask_of_machines(
    found: &mut ProgramCertificate,
    (report, below): (&mut Vec<Diagnostic>, &[Arc<str>]),
    span: Span,
    [source, target]: [&Control; 2],
) {
    for OpenFact { fact, side, text } in std::mem::take(&mut found.open_facts) {
        let control = if side == Of::Source { source } else { target };
        found.reasons.retain(|reason| reason.text != text);
        report.push(control.unconfirmed(side, &fact, None, span));
    }
    leave_to_others(found, report, below);
    if found.outcome == verify::Outcome::Undecided && found.reasons.is_empty() {
        found.outcome = verify::Outcome::Same;
    }
}

/// Leaves out runs that broke a condition which the report asks about anyway, or one `below` it that the report of a callee
/// asks about: its own question says what they met, and that no run kept it would be a reason by itself.
fn leave_to_others(found: &mut ProgramCertificate, report: &[Diagnostic], below: &[Arc<str>]) {
    let is_asked = |text: &str| {
        let mut asked = report.iter().filter(|finding| finding.severity() == Severity::Review);
        asked.any(|finding| finding.assumes.is_some() && text.ends_with(&*finding.message))
    };
    let is_below = |text: &str| below.iter().any(|asked| text.ends_with(&**asked));
    found
        .reasons
        .retain(|reason| reason.why != Why::Condition || !is_asked(&reason.text) && !is_below(&reason.text));
}

/// What happened, where the block does not show it: an alarm with its number, and anything where both `same` blocks do.
fn happened(event: &serde_json::Value, same: bool) -> String {
    let word = |name: &str| {
        event.get(name).map(|value| value.as_str().map_or_else(|| value.to_string(), Into::into))
    };
    let Some(kind) = word("event") else { return String::new() };
    if kind == "alarm" {
        let number = word("number").filter(|number| !number.is_empty());
        let text = word("text").unwrap_or_default();
        return number.map_or_else(|| format!("alarm: {text}"), |number| format!("alarm {number}: {text}"));
    }
    if !same {
        return String::new();
    }
    let shown = ["direction", "speed", "state", "station", "offset", "number", "seconds"];
    let words = shown.into_iter().filter_map(|name| Some(format!("{name} {}", word(name)?)));
    let words: Vec<String> = std::iter::once(kind.replace('_', " ")).chain(words).collect();
    words.join(", ")
}

/// Writes into a program's report what the verifier found.
fn apply(
    program: &mut super::ProgramReport,
    span: Span,
    found: &ProgramCertificate,
    controls: [&Control; 2],
) {
    program.verdict = Some(found.outcome);
    let stops = found.source_stops.iter().map(|text| Diagnostic::new(Code::SourceStops, span, text.clone()));
    program.diagnostics.extend(stops);
    program.diagnostics.extend(never_run(found).map(|text| Diagnostic::new(Code::NotRun, span, text)));
    match found.outcome {
        verify::Outcome::Same => {}
        verify::Outcome::Undecided => {
            for reason in &found.reasons {
                program.diagnostics.push(Diagnostic::new(Code::NotDecided, span, reason.text.clone()));
            }
            program.outcome = Outcome::Review;
        }
        verify::Outcome::Different => {
            let what = found.witness.as_ref().map_or_else(String::new, |witness| {
                let block = |moment: &Option<verify::Moment>| {
                    moment.as_ref().map_or_else(|| "nothing more".into(), |m| format!("'{}'", m.block))
                };
                let same = block(&witness.source) == block(&witness.target);
                let event = |moment: &Option<verify::Moment>| {
                    let told = moment.as_ref().map_or_else(String::new, |m| happened(&m.event, same));
                    if told.is_empty() { told } else { format!(" ({told})") }
                };
                let [ours, theirs] =
                    [&witness.source, &witness.target].map(|moment| block(moment) + &event(moment));
                format!("{}: {ours} against {theirs}", witness.what)
            });
            let alone = if found.run_alone {
                "; it was run by itself, because no run of its callers reaches this"
            } else {
                ""
            };
            let what = what + alone;
            program.diagnostics.push(Diagnostic::new(Code::VerifiedDifferent, span, what));
            program.outcome = Outcome::Refused;
        }
    }
    if found.rounding_sensitive == Some(true) {
        let told = |what: &'static str| Diagnostic::new(Code::RoundingSensitive, span, what);
        let fewer = "rounding may decide a comparison: the path changes if the target computes with fewer \
                     digits. Add a tolerance";
        let functions = "rounding may decide a comparison: the path changes if a function of the target is off in its last \
                         digit. Add a tolerance";
        let told = match controls.map(Control::says_double) {
            _ if controls.iter().all(|control| control.is_said_double()) => told(functions),
            [Some(ours), Some(theirs)] => told(fewer).with_help(format!(
                "if both machines calculate with about fifteen digits, say so: {ours} in the profile of the source, \
                 {theirs} in that of the target; what only adds, multiplies and divides then comes to the same on both"
            )),
            _ => told(fewer),
        };
        program.diagnostics.push(told);
        program.outcome = program.outcome.max(Outcome::Review);
    }
}

/// Ways that a note names.
const NAMED: usize = 3;

/// What no run went because the program's own numbers decide it; the target's branches where the source has none.
fn never_run(found: &verify::ProgramCertificate) -> Option<String> {
    let theirs = found.by_own_numbers.is_empty();
    let ways = if theirs { &found.target_by_own_numbers } else { &found.by_own_numbers };
    let whose = if theirs { " of the target" } else { "" };
    let named = ways.iter().take(NAMED);
    let named =
        named.map(|way| format!("'{}' in line {}{whose} is never {}", way.text.trim(), way.line, way.way));
    let more = ways.len().saturating_sub(NAMED);
    let rest = (more > 0).then(|| format!("and {more} more"));
    let all: Vec<String> = named.chain(rest).collect();
    (!all.is_empty())
        .then(|| format!("with the numbers that stand in the program, {}: no run went there", all.join("; ")))
}
