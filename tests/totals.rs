//! `corpus/TOTALS.md`: what becomes of the corpus, in figures that a change shows as a difference of
//! lines. `UPDATE=1 cargo test --test totals` writes it anew.

#[path = "support/rounds.rs"]
mod rounds;
mod support;

use macroglot::diag::{Code, Severity};
use macroglot::dialect::{Control, registry};
use macroglot::library::{Found, Lock, Options, convert, gather};
use macroglot::syntax::{parse_file, parse_totals};
use macroglot::verify::Outcome as Verdict;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use support::root;

/// What `macroglot convert` prints of a run.
#[derive(serde::Deserialize)]
struct Told {
    programs: Vec<Program>,
}

/// A program and what became of it.
#[derive(serde::Deserialize)]
struct Program {
    source: String,
    program: Option<String>,
    from: String,
    to: String,
    outcome: String,
    verdict: Option<String>,
    diagnostics: Vec<Finding>,
}

#[derive(serde::Deserialize)]
struct Finding {
    code: String,
    severity: String,
    message: String,
}

/// A library of the project file, and what became of its programs on the way to one of its targets.
struct Pair {
    from: String,
    to: String,
    programs: Vec<Program>,
    /// True for the library of lathes, which has the dialects of another one.
    lathe: bool,
}

impl Pair {
    /// The source as tables have it.
    fn source(&self) -> String {
        format!("{}{}", self.from, if self.lathe { " lathe" } else { "" })
    }

    /// The folder of its conversions, under `target/converted`.
    fn folder(&self) -> String {
        format!("{}-{}", if self.lathe { "turning" } else { &self.from }, self.to)
    }
}

/// What the README's first command makes of every library, for each of its targets.
fn pairs() -> Vec<Pair> {
    // Without the registers and numbers that an earlier run chose.
    let _ = std::fs::remove_dir_all(root().join("target/converted"));
    let program = env!("CARGO_BIN_EXE_macroglot");
    let mut run = std::process::Command::new(program);
    let output = run.args(["convert", "--format", "json"]).current_dir(root()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "some programs are refused: {said}");
    let told: Told = serde_json::from_slice(&output.stdout).unwrap();
    let mut pairs: Vec<Pair> = Vec::new();
    for program in told.programs {
        let is_of = |pair: &Pair| (&pair.from, &pair.to) == (&program.from, &program.to);
        // The libraries come in the order of their names, so that of lathes comes after the one of their dialects.
        let lathe = pairs.iter().any(is_of);
        match pairs.last_mut().filter(|pair| is_of(pair)) {
            Some(pair) => pair.programs.push(program),
            None => {
                let (from, to) = (program.from.clone(), program.to.clone());
                pairs.push(Pair { from, to, programs: vec![program], lathe });
            }
        }
    }
    pairs
}

const HEAD: &str = "\
# Totals over the corpus

Written by `UPDATE=1 cargo test --test totals`; the test fails where it is stale. The machines are
those of `macroglot.toml`.
";

#[test]
fn totals_are_fresh() {
    let mut out = String::from(HEAD);
    reading(&mut out);
    // Either alone leaves a core idle at the end of each library.
    let (pairs, rounds) = std::thread::scope(|scope| {
        let rounds = scope.spawn(all_rounds);
        (pairs(), rounds.join().unwrap())
    });
    assert_eq!(pairs.len(), 13, "the project file names all pairs of mills, and one of lathes");
    assert_eq!(pairs.iter().filter(|pair| pair.lathe).count(), 1);
    conversions(&mut out, &pairs);
    there_and_back(&mut out, &pairs, rounds);
    codes(&mut out, &pairs);
    refusals(&mut out, &pairs);
    support::assert_fresh("corpus/TOTALS.md", &out);
}

fn reading(out: &mut String) {
    out.push_str(
        "\n## Reading\n\nFragments: right ones read without an error, wrong ones whose fault is named.\n\n",
    );
    out.push_str(
        "| dialect | files parsed | blocks | unparsed | lossless | fragments right | fragments wrong |\n",
    );
    out.push_str("|---|---:|---:|---:|---:|---:|---:|\n");
    for entry in registry::all() {
        let Found { programs: inputs, errors, .. } = gather(&[root().join("corpus").join(entry.name)], &[]);
        assert!(errors.is_empty(), "{errors:?}");
        let (mut parsed, mut blocks, mut unparsed, mut lossless) = (0, 0, 0, 0);
        for input in &inputs {
            let totals = parse_totals(&input.bytes, entry.parse);
            parsed += usize::from(totals.unparsed == 0);
            blocks += totals.blocks;
            unparsed += totals.unparsed;
            lossless += usize::from(totals.lossless);
        }
        let n = inputs.len();
        assert_eq!((parsed, lossless), (n, n), "every program of {} is read, and kept", entry.name);
        let (right, wrong) = (fragments(entry, "ok"), fragments(entry, "error"));
        let _ = writeln!(
            out,
            "| {} | {parsed}/{n} | {blocks} | {unparsed} | {lossless}/{n} | {right} | {wrong} |",
            entry.name
        );
    }
}

/// How many fragments of a status come out as their status says, of how many.
fn fragments(entry: &registry::Entry, status: &str) -> String {
    let control = Control::plain(entry.name).unwrap();
    let table = support::text(&format!("corpus/{}/fragments.tsv", entry.name));
    let rows = table.lines().skip(1).map(|row| row.split('\t').collect::<Vec<_>>());
    let rows: Vec<_> = rows.filter(|row| row.get(2) == Some(&status)).collect();
    let named = |text: &str| {
        let parsed = parse_file(text.as_bytes(), entry.parse);
        let errors = parsed.blocks.iter().flat_map(|block| &block.errors);
        let refused = errors.into_iter().any(|error| error.code.severity() == Severity::Error);
        // What is wrong with a block only beside others, or in its meaning, is found behind parsing.
        let lowered = || {
            let lowered = (entry.lower)(&parsed, 0, "fragment.nc", &control);
            let mut found = lowered.programs.iter().flat_map(|(_, found)| found);
            found.any(|d| d.severity() == Severity::Error || d.code == Code::ModalCallNotOpen)
        };
        refused || status == "error" && lowered()
    };
    let good = rows.iter().filter(|row| named(row[1]) == (status == "error")).count();
    format!("{good}/{}", rows.len())
}

fn conversions(out: &mut String, pairs: &[Pair]) {
    out.push_str(
        "\n## Conversion\n\nVerified, undecided, different: what the verifier says of those with a conversion.\n\n",
    );
    out.push_str(
        "| from | to | programs | converted | for review | refused | verified | undecided | different |\n",
    );
    out.push_str("|---|---|---:|---:|---:|---:|---:|---:|---:|\n");
    for pair in pairs {
        let Pair { to, programs, .. } = pair;
        let from = pair.source();
        let [good, review, refused] = ["converted", "review", "refused"]
            .map(|outcome| programs.iter().filter(|program| program.outcome == outcome).count());
        let [same, undecided, different] = ["same", "undecided", "different"]
            .map(|verdict| programs.iter().filter(|p| p.verdict.as_deref() == Some(verdict)).count());
        let all = programs.len();
        assert_eq!(good + review + refused, all);
        let _ = writeln!(
            out,
            "| {from} | {to} | {all} | {good} | {review} | {refused} | {same} | {undecided} | {different} |"
        );
        assert_eq!(
            different, 0,
            "{from} to {to}: what differs is refused by its own reason, before it is run"
        );
        for program in programs.iter().filter(|program| program.outcome != "refused") {
            assert!(program.verdict.is_some(), "{from} to {to}: {} was not verified", program.source);
            let name = program.source.rsplit('/').next().unwrap();
            let certificate = format!("target/converted/{}/{name}.certificate.json", pair.folder());
            assert!(root().join(&certificate).exists(), "{certificate} is missing");
        }
    }
}

/// What the way there loses and says so, `tests/support/rounds.toml`.
#[derive(serde::Deserialize)]
struct Lost {
    lost: Vec<Loss>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Loss {
    /// The ways there, `fadal to fanuc`.
    pairs: Vec<String>,
    file: String,
    why: String,
}

/// Every library on its way to every other control and back, in order; that of lathes last.
fn all_rounds() -> Vec<rounds::Round> {
    let names = || registry::all().iter().map(|entry| entry.name);
    let ways: Vec<_> = names().flat_map(|from| names().map(move |to| (from, to))).collect();
    let round = |(from, to): (&str, &str)| {
        let inputs = gather(&[root().join("corpus").join(from)], &[]).programs;
        rounds::round(from, to, &inputs)
    };
    ways.into_iter().filter(|(from, to)| from != to).map(round).chain(rounds::turning()).collect()
}

fn there_and_back(out: &mut String, pairs: &[Pair], mut rounds: Vec<rounds::Round>) {
    out.push_str(
        "\n## There and back\n\nEach library converted to the other control and back, for a machine of the same kind: programs \
         that were written\nthere, and that came back; what the verifier says of the first text and the last one. Files that came \
         back: those\nwhose text there, and whose text back, was the same when they went round once more. When they go round a third time, none changes.\n\n",
    );
    out.push_str(
        "| from | over | there | back | verified | undecided | different | files | same there | same back |\n",
    );
    out.push_str("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    let lost: Lost = toml::from_str(&support::text("tests/support/rounds.toml")).unwrap();
    let (mut why, mut unknown) = (BTreeSet::new(), Vec::new());
    // In the order of the conversions; more ways of lathes go round than the project file names.
    rounds.sort_by_key(|round| {
        let at = pairs.iter().position(|pair| (&pair.from, &pair.to) == (&round.from, &round.to));
        at.unwrap_or(usize::MAX)
    });
    for round in rounds {
        let rounds::Round { from, to, inputs, there, back, files, same_there, same_back, changed } = round;
        assert!(changed.is_empty(), "{from} to {to}: texts that went round twice change: {changed:?}");
        let [same, undecided, different] = [Verdict::Same, Verdict::Undecided, Verdict::Different]
            .map(|verdict| back.programs.iter().filter(|p| p.verdict == Some(verdict)).count());
        let came_back = same + undecided + different;
        let _ = writeln!(
            out,
            "| {from} | {to} | {there} | {came_back} | {same} | {undecided} | {different} | {files} | {same_there} | {same_back} |"
        );
        for program in back.programs.iter().filter(|p| p.verdict == Some(Verdict::Different)) {
            let file = &inputs[program.file].name;
            let loss = lost.lost.iter().find(|loss| {
                loss.file == *file && loss.pairs.iter().any(|pair| *pair == format!("{from} to {to}"))
            });
            let found = program.diagnostics.iter().filter(|d| d.code == Code::VerifiedDifferent);
            let found: Vec<&str> = found.map(|d| &*d.message).collect();
            match loss {
                Some(loss) => drop(why.insert(format!("- {from} to {to}, {file}: {}\n", loss.why))),
                None => unknown.push(format!("{from} to {to} and back, {file}: {found:?}")),
            }
        }
    }
    out.push_str("\nWhat differs, because of what the way there says for review:\n\n");
    why.iter().for_each(|line| out.push_str(line));
    assert!(unknown.is_empty(), "these differ: {unknown:#?}");
}

/// Programs that have each code.
fn codes(out: &mut String, pairs: &[Pair]) {
    let mut rows: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (at, pair) in pairs.iter().enumerate() {
        for program in &pair.programs {
            let codes: BTreeSet<&str> = program.diagnostics.iter().map(|d| &*d.code).collect();
            for code in codes {
                rows.entry(code).or_insert_with(|| vec![0; pairs.len()])[at] += 1;
            }
        }
    }
    out.push_str("\n## Programs by code\n\n| code | |");
    pairs.iter().for_each(|pair| out.push_str(&format!(" {} to {} |", pair.source(), pair.to)));
    let _ = writeln!(out, "\n|---|---|{}", "---:|".repeat(pairs.len()));
    for (code, counts) in rows {
        let title = Code::find(code).unwrap().title();
        let _ = write!(out, "| {code} | {title} |");
        counts.iter().for_each(|count| out.push_str(&format!(" {count} |")));
        out.push('\n');
    }
}

/// Every refused program with every reason, each said once.
fn refusals(out: &mut String, pairs: &[Pair]) {
    out.push_str("\n## Refusals\n");
    for pair in pairs {
        let _ = writeln!(out, "\n### {} to {}\n", pair.source(), pair.to);
        for program in pair.programs.iter().filter(|program| program.outcome == "refused") {
            let name = program.source.rsplit('/').next().unwrap();
            let _ = writeln!(out, "- {name} {}", program.program.as_deref().unwrap_or(""));
            let errors = program.diagnostics.iter().filter(|finding| finding.severity == "error");
            let reasons: BTreeSet<(&str, &str)> = errors.map(|d| (&*d.code, &*d.message)).collect();
            for (code, message) in reasons {
                let _ = writeln!(out, "  - {code} {message}");
            }
        }
    }
}

#[test]
fn nothing_changes_from_a_control_to_itself() {
    for entry in registry::all() {
        let control = Control::plain(entry.name).unwrap();
        let Found { programs: inputs, .. } = gather(&[root().join("corpus").join(entry.name)], &[]);
        let lock = Lock::new(entry.name, entry.name);
        let conversion = convert(&inputs, &control, &control, lock, Options::default());
        for (input, text) in inputs.iter().zip(&conversion.texts) {
            let text = text.as_ref().map(|text| text.as_bytes());
            assert_eq!(text, Some(input.bytes.as_slice()), "{}", input.path.display());
        }
    }
}
