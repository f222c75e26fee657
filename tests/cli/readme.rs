//! What the README says to type works, and what it shows is so.

use crate::support::{root, text};
use std::process::Command;

/// The lines of the fenced blocks of a language.
fn fenced(markdown: &str, language: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let mut inside = false;
    for line in markdown.lines() {
        match line.strip_prefix("```") {
            Some(mark) => inside = !inside && mark == language,
            None if inside => lines.push(line.to_owned()),
            None => {}
        }
    }
    lines
}

#[test]
fn every_command_runs() {
    let program = std::path::Path::new(env!("CARGO_BIN_EXE_macroglot"));
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let readme = text("README.md");
    let commands = fenced(&readme, "sh");
    assert!(commands.len() > 10);
    let mut ran = 0;
    for command in commands {
        let typed = command.replace("cargo run --release --", "macroglot");
        // `tests/totals.rs` runs the first command, and reads what it prints.
        let first = typed.split('#').next().is_some_and(|typed| typed.trim_end() == "macroglot convert");
        if !typed.starts_with("macroglot ") || first {
            continue;
        }
        // The conversions of whole libraries are verified there too: here it is the options that count.
        let mut words = typed.split(' ');
        let whole = words.nth(1) == Some("convert")
            && words.next().is_some_and(|path| path != "-" && !path.contains('.'));
        let typed = if whole { format!("{typed} --no-verify") } else { typed };
        let output = Command::new("sh").args(["-c", &typed]).env("PATH", &path).current_dir(root()).output();
        let output = output.unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        // Corpus programs may be refused; wrong usage, a signal or a panic may not be.
        assert!(matches!(output.status.code(), Some(0 | 1)), "{command}: {:?}\n{said}", output.status);
        assert!(!output.stdout.is_empty() || said.contains("refused"), "{command} says nothing");
        ran += 1;
    }
    assert!(ran > 10, "only {ran} commands were run");
}

#[test]
fn the_two_commands_stand_first() {
    let commands = fenced(&text("README.md"), "sh");
    assert!(commands[0].starts_with("cargo run --release -- convert "), "{}", commands[0]);
    assert!(commands[1].starts_with("cargo test "), "{}", commands[1]);
    let ci = text(".ci/run");
    assert_eq!(ci.lines().last(), Some("step cargo test"), "the last step is the README's test command");
}

#[test]
fn the_project_file_shown_is_the_one_that_ships() {
    let file = text("macroglot.toml");
    for line in fenced(&text("README.md"), "toml") {
        assert!(file.lines().any(|kept| kept == line), "macroglot.toml has no line '{line}'");
    }
}

#[test]
fn every_link_leads_somewhere() {
    for page in [
        "README.md",
        "docs/ARCHITECTURE.md",
        "docs/add-a-dialect.md",
        "docs/add-an-emulation.md",
        "docs/add-a-diagnostic.md",
    ] {
        let folder = root().join(page);
        let folder = folder.parent().unwrap();
        let markdown = text(page);
        for (at, head) in markdown.match_indices("](") {
            let link = markdown[at + head.len()..].split(')').next().unwrap();
            if !link.starts_with("http") {
                assert!(folder.join(link).exists(), "{page}: {link}");
            }
        }
    }
}

/// Paths in backticks, in the pages for contributors, are of files that are there.
#[test]
fn paths_in_the_pages_exist() {
    for page in [
        "docs/ARCHITECTURE.md",
        "docs/add-a-dialect.md",
        "docs/add-an-emulation.md",
        "docs/add-a-diagnostic.md",
    ] {
        let markdown = text(page);
        assert!(markdown.lines().count() < 200, "{page} is long");
        for piece in markdown.split('`').skip(1).step_by(2) {
            let path = piece.trim_end_matches('/');
            let known =
                ["src/", "tests/", "docs/", "dialects/", "corpus/", "grammar/", "machines/", "filetests/"];
            let plain = !path.contains(['<', '*', ' ', '{']) && !path.contains("NAME");
            if plain && known.iter().any(|folder| path.starts_with(folder)) {
                assert!(root().join(path).exists(), "{page}: {path}");
            }
        }
    }
}
