//! What a trace can be unsure of, a machine profile can confirm, and the page on traces lists.

mod support;

use macroglot::dialect::{Control, Profile, matters, registry};
use std::collections::BTreeSet;
use support::{rust_files, text};

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
        let behaviours =
            [".rest_on(", "yes(control,", "fact(control,", "Answer::new(control,", "rest_on_behaviour("];
        let names = literals(&text, &behaviours).into_iter();
        all.extend(names.filter(|name| !name.is_empty()).map(|name| format!("behaviour:{name}")));
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

#[test]
fn matters_are_listed_and_each_may_come() {
    let (named, page) = (named(), text("docs/trace.md"));
    for (name, meaning) in matters::ALL {
        assert!(named.contains(*name), "{name} is no matter of any emulated control");
        assert!(page.contains(&format!("| `{name}` | {meaning} |")), "docs/trace.md does not list {name}");
    }
    assert!(matters::ALL.is_sorted());
}

#[test]
fn a_confirmed_matter_is_not_doubted() {
    use macroglot::control::{LoadedFile, ProgramRef, Scenario, trace::Happening};
    let unsure = |confirm: &str| {
        let profile = Profile::read(&format!("dialect = \"fanuc\"\nconfirm = [{confirm}]\n")).unwrap();
        let entry = registry::find("fanuc").unwrap();
        let control = Control::new(entry, profile).unwrap();
        let parsed = macroglot::syntax::parse_file(b"O1\nG90G0X1.Y1.\nG2X1.Y1.R2.F100.\nM30\n", entry.parse);
        let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
        let main = ProgramRef { file: 0, program: 0 };
        let run = (entry.execute.unwrap())(
            &macroglot::control::Library::new(&files),
            main,
            &control,
            &Scenario::default(),
        );
        let fact = "machine:arc.radius.full.circle";
        run.events
            .iter()
            .any(|event| matches!(&event.what, Happening::Unsure { fact: named } if named == fact))
    };
    assert!(unsure(""));
    assert!(!unsure("\"machine:arc.radius.full.circle\""));
}
