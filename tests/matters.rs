//! What a trace can be unsure of, a machine profile can confirm, and the page on traces lists.

mod support;

use macroglot::control::{Library, LoadedFile, ProgramRef, Scenario, trace::EventKind};
use macroglot::dialect::{Control, Profile, Question, matters, registry};
use macroglot::syntax::parse_file;
use std::collections::BTreeSet;
use support::{asks, rust_files, text};

/// The string literals behind a call of these names.
fn literals(text: &str, calls: &[&str]) -> Vec<String> {
    let behind = |call: &&str| {
        let rest = text.split(*call).skip(1).map(str::trim_start);
        rest.filter_map(|rest| rest.strip_prefix('"')?.split_once('"'))
            .map(|(name, _)| name.to_owned())
            .collect()
    };
    calls.iter().flat_map(|call: &&str| -> Vec<String> { behind(call) }).collect()
}

/// The facts that the emulated controls name, as machine profiles do.
fn named() -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    for (path, text) in rust_files("src/control").into_iter().filter(|(path, _)| !path.contains("tests")) {
        all.extend(literals(&text, &[".doubt("]));
        let asked = Question::ALL.iter().filter(|question| asks(&text, **question));
        all.extend(asked.map(|question| question.fact().to_owned()));
        assert!(!text.contains("doubt(format"), "{path}: a fact has a name that stands in the source");
    }
    all
}

fn confirms(dialect: &str, fact: &str) -> bool {
    let profile = Profile::read(&format!("dialect = \"{dialect}\"\nconfirm = [\"{fact}\"]\n")).unwrap();
    Control::new(registry::find(dialect).unwrap(), profile).is_ok()
}

#[test]
fn what_a_trace_is_unsure_of_some_profile_confirms() {
    let named = named();
    assert!(named.len() > 60, "{named:#?}");
    for fact in &named {
        let known = registry::all().iter().any(|entry| confirms(entry.name, fact));
        assert!(known, "no table and no profile can confirm {fact}");
    }
    assert!(!confirms("fanuc", "machine:nothing"));
}

/// Facts that conversions and verification name with a literal. Rows are named by the tables themselves.
#[test]
fn what_a_diagnostic_names_some_profile_confirms() {
    const KINDS: &[&str] = &[
        "numbers",
        "limit",
        "operator",
        "function",
        "statement",
        "behaviour",
        "variable",
        "system",
        "word",
        "code",
        "argument",
        "machine",
    ];
    let mut seen = BTreeSet::new();
    let files = rust_files("src")
        .into_iter()
        .filter(|(path, _)| !path.contains("test") && !path.contains("dialect/"));
    for literal in files.flat_map(|(_, text)| text.split('"').map(str::to_owned).collect::<Vec<_>>()) {
        let Some((kind, name)) = literal.split_once(':').filter(|(kind, _)| KINDS.contains(kind)) else {
            continue;
        };
        if name.is_empty() || name.contains(' ') {
            continue;
        }
        // What is put in when the program runs.
        let name = match name.split_once('{') {
            Some((before, _)) if kind == "code" => format!("{before}M77"),
            Some((before, _)) if kind == "machine" => format!("{before}M77"),
            Some((before, _)) if matches!(kind, "word" | "argument") => format!("{before}Q"),
            Some((before, _)) if kind == "statement" => format!("{before}goto"),
            Some((before, _)) if kind == "limit" => format!("{before}call.all"),
            Some((before, _)) if kind == "function" => format!("{before}sin"),
            Some((before, _)) => format!("{before}1"),
            None => name.to_owned(),
        };
        seen.insert(format!("{kind}:{name}"));
    }
    assert!(seen.len() > 40, "{seen:#?}");
    for fact in &seen {
        let known = registry::all().iter().any(|entry| confirms(entry.name, fact));
        assert!(known, "no profile can confirm {fact}");
    }
    for entry in registry::all() {
        let control = Control::plain(entry.name).unwrap();
        for row in &control.dialect().behaviours {
            assert!(confirms(entry.name, row.question.fact()), "{}: {}", entry.name, row.question);
        }
    }
}

#[test]
fn matters_are_listed_and_each_may_come() {
    let (named, page) = (named(), text("docs/trace.md"));
    for (name, meaning) in matters::ALL {
        // A question took the place of this one; what a profile confirmed by its name still counts.
        let asked = *name == matters::SHIFT && named.contains(Question::CycleShift.fact());
        assert!(asked || named.contains(*name), "{name} is no matter of any emulated control");
        assert!(page.contains(&format!("| `{name}` | {meaning} |")), "docs/trace.md does not list {name}");
    }
    assert!(matters::ALL.is_sorted());
}

/// What a run on a machine of this profile is unsure of.
fn unsure(profile: &str, program: &str) -> BTreeSet<String> {
    unsure_on("fanuc", profile, program)
}

fn unsure_on(dialect: &str, profile: &str, program: &str) -> BTreeSet<String> {
    let profile = Profile::read(&format!("dialect = \"{dialect}\"\n{profile}")).unwrap();
    let entry = registry::find(dialect).unwrap();
    let control = Control::new(entry, profile).unwrap();
    let parsed = parse_file(program.as_bytes(), entry.parse);
    let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
    let (library, main) = (Library::new(&files), ProgramRef { file: 0, program: 0 });
    let run = (entry.execute.unwrap())(&library, main, &control, &Scenario::default());
    let facts = run.events.into_iter().filter_map(|event| match event.what {
        EventKind::Unsure { fact } => Some(fact),
        _ => None,
    });
    facts.collect()
}

#[test]
fn a_confirmed_matter_is_not_doubted() {
    let (program, fact) = ("O1\nG90G0X1.Y1.\nG2X1.Y1.R2.F100.\nM30\n", "machine:arc.radius.full.circle");
    assert!(unsure_on("haas", "", program).contains(fact));
    assert!(!unsure_on("haas", &format!("confirm = [\"{fact}\"]\n"), program).contains(fact));
}

/// Fanuc B-63324EN/03 p. 48: an arc by its radius that ends at its start is one of 0 degrees, and the cutter does not move.
#[test]
fn what_a_manual_says_of_a_matter_is_not_doubted() {
    let program = "O1\nG90G0X1.Y1.\nG2X1.Y1.R2.F100.\nM30\n";
    assert!(!unsure("", program).contains("machine:arc.radius.full.circle"));
}

/// No source says what a tool word of two digits is, nor in which feed mode a Haas lathe starts.
#[test]
fn a_lathe_is_doubted_where_it_is_no_mill() {
    let lathe = "machine = \"lathe\"\naxes = [\"X\", \"Z\", \"C\", \"Y\"]\n";
    let (feed, tool) = ("machine:feed.mode.at.start", "behaviour:turret.short");
    let cut = "G97S500M3\nG0X10.\nG1X5.F.2\nM30\n";
    let short = unsure(lathe, &format!("O1\nT01\n{cut}"));
    assert!(short.contains(tool) && !short.contains(feed), "{short:?}");
    let whole = unsure(lathe, &format!("O1\nT0101\n{cut}"));
    assert!(!whole.contains(feed) && !whole.contains(tool), "{whole:?}");
    let silent = unsure_on("haas", lathe, &format!("O1\nT0101\n{cut}"));
    assert!(silent.contains(feed), "{silent:?}");
    let told = unsure_on("haas", lathe, &format!("O1\nG99T0101\n{cut}"));
    assert!(!told.contains(feed), "{told:?}");
    let mill = unsure("", "O1\nT1M6\nG0X10.\nG1X5.F100.\nM30\n");
    assert!(!mill.contains(feed) && !mill.contains(tool), "{mill:?}");
}

/// A turret that turns while the slide moves, or after it, is another machine; the offset of the same station turns nothing.
#[test]
fn a_turret_that_turns_beside_a_move_is_doubted() {
    let fact = "machine:lathe.tool.beside.move";
    let lathe = "machine = \"lathe\"\n";
    assert!(unsure(lathe, "O1\nT0101\nG0X10.T0202\nM30\n").contains(fact));
    assert!(!unsure(lathe, "O1\nT0101\nG0X10.T0100\nT0202\nG0X20.\nM30\n").contains(fact));
}

/// M6 stands beside its T in every program of the manual (seed 000:457): what it does alone no source says.
#[test]
fn a_tool_change_without_its_tool_is_doubted_of_a_fadal() {
    let fact = "machine:tool.change.alone";
    assert!(unsure_on("fadal", "", "N1 O1\nN2 T2\nN3 M6\nN4 M2\n").contains(fact));
    assert!(!unsure_on("fadal", "", "N1 O1\nN2 M6 T2\nN3 M2\n").contains(fact));
    assert!(!unsure_on("fanuc", "", "O1\nT2\nM6\nM30\n").contains(fact));
}
