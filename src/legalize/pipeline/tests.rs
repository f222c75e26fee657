use super::*;
use std::collections::BTreeSet;

#[test]
fn what_a_pass_needs_runs_before_it() {
    let mut ran = BTreeSet::new();
    for (group, pass) in passes() {
        for need in pass.needs {
            assert!(ran.contains(need), "{}/{} needs '{need}' before it", group.name, pass.name);
        }
        ran.insert(pass.name);
    }
}

#[test]
fn names_are_unique_and_passes_have_a_sentence() {
    let mut seen = BTreeSet::new();
    for (group, pass) in passes() {
        assert!(seen.insert((group.name, pass.name)), "{}/{} stands twice", group.name, pass.name);
        assert!(!pass.does.is_empty() && pass.does.len() < 90, "{}", pass.name);
    }
}

#[test]
fn a_tidying_pass_has_the_name_that_it_gives_itself() {
    for (_, pass) in passes() {
        if let Run::Tidies(tidy) = pass.run {
            assert_eq!(pass.name, tidy.name());
        }
    }
}

#[test]
fn what_tidies_legal_programs_keeps_them_legal() {
    let legal = GROUPS.iter().find(|group| group.name == "tidy-legal").unwrap();
    for pass in legal.passes {
        assert!(matches!(pass.run, Run::Tidies(tidy) if tidy.keeps_legal()), "{}", pass.name);
    }
}

#[test]
fn a_name_finds_its_pass() {
    assert_eq!(through("line-comments"), Ok(1));
    assert_eq!(through("tidy/copy-propagation"), through("copy-propagation"));
    let count = passes().count();
    assert_eq!(through("program-numbers"), Ok(count));
    assert_eq!(
        through("foldd").unwrap_err().to_string(),
        "no pass is named 'foldd'; `macroglot ir --passes` lists them"
    );
    let told = through("fold").unwrap_err().to_string();
    assert_eq!(told, "'fold' stands in several groups: say 'tidy/fold' or 'tidy-legal/fold'");
}
