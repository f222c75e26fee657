//! The recipes of `docs/git.md`, each typed with git in a repository of its own.

use crate::support::text;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A main program, and a subprogram that it calls.
const MAIN: &str = "O1000\nN10 G21 G17 G90 G40 G80 G94\nN20 G0 X0 Y0\nN30 M98 P2000\nN40 G0 X30.\nN50 M30\n";
const SUB: &str = "O2000\nN10 G1 X10. F100\nN20 G1 X20.\nN30 M99\n";

/// The lines of the recipe under a heading, as one script; of several, the one with this number.
fn recipe(heading: &str, number: usize) -> String {
    let page = text("docs/git.md");
    let section = page.split("\n## ").find(|section| section.starts_with(heading));
    let section = section.unwrap_or_else(|| panic!("docs/git.md has no section '{heading}'"));
    let script = section.split("```sh\n").nth(number + 1).and_then(|rest| rest.split("```").next());
    script.unwrap_or_else(|| panic!("'{heading}' has no recipe {number}")).to_owned()
}

fn run(folder: &Path, script: &str) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_macroglot"));
    let path = format!("{}:{}", program.parent().unwrap().display(), std::env::var("PATH").unwrap());
    let home = folder.parent().unwrap();
    let mut command = Command::new("sh");
    command.args(["-e", "-c", script]).current_dir(folder).env("PATH", path);
    // No settings but those of the recipe.
    command.env("HOME", home).env("GIT_CONFIG_NOSYSTEM", "1").env_remove("GIT_DIR").env("GIT_PAGER", "cat");
    command.output().unwrap()
}

fn typed(folder: &Path, script: &str) -> String {
    let output = run(folder, script);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{script}: {:?}\n{said}", output.status);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// A repository with both programs. In the working tree the main program is numbered anew, and the subprogram goes
/// 0.5 mm farther.
fn repository() -> (TempDir, std::path::PathBuf) {
    let there = Command::new("git").arg("--version").output();
    assert!(there.is_ok_and(|git| git.status.success()), "this test needs git: install it");
    let room = TempDir::new().unwrap();
    let folder = room.path().join("shop");
    std::fs::create_dir(&folder).unwrap();
    std::fs::write(folder.join("main.nc"), MAIN).unwrap();
    std::fs::write(folder.join("sub.nc"), SUB).unwrap();
    typed(
        &folder,
        "git init -q -b main\ngit config user.name shop\ngit config user.email shop@example.com\n\
         git add .\ngit commit -q -m programs",
    );
    std::fs::write(folder.join("main.nc"), MAIN.replace("N2", "N1").replace("G0 X30.", "G00X30.0 (HOME)"))
        .unwrap();
    std::fs::write(folder.join("sub.nc"), SUB.replace("X20.", "X20.5")).unwrap();
    (room, folder)
}

#[test]
fn textconv_leaves_out_what_no_machine_sees() {
    let (_room, folder) = repository();
    let shown = typed(&folder, &recipe("A diff without", 0));
    assert!(shown.contains("-G1 X20.\n+G1 X20.5\n"), "{shown}");
    assert!(!shown.contains("X30.\n+"), "the main program only looks otherwise: {shown}");
}

#[test]
fn a_driver_says_what_the_machine_does() {
    let (_room, folder) = repository();
    let shown = typed(&folder, &recipe("Let `git diff` say", 0));
    assert!(shown.contains("X 20.000 -> 20.500 (+0.500)"), "{shown}");
    // The subprogram's file shows what its main program does with it.
    assert!(shown.contains("O1000 (main.nc): different for the machine"), "{shown}");
    // A file that is new, and one that is gone.
    typed(&folder, "cp sub.nc new.nc; sed -i s/O2000/O3000/ new.nc; git add -N new.nc; rm main.nc");
    let shown = typed(&folder, "git diff");
    assert!(shown.contains("the program is new") && shown.contains("the program is gone"), "{shown}");
}

#[test]
fn a_driver_for_once() {
    let (_room, folder) = repository();
    let shown = typed(&folder, &recipe("Let `git diff` say", 1));
    assert!(shown.contains("No effect on the machine.\n"), "{shown}");
    assert!(shown.contains("X 20.000 -> 20.500 (+0.500)"), "{shown}");
}

/// Of a renamed file git says the new name and how alike they are besides.
#[test]
fn a_driver_of_a_renamed_file() {
    let (_room, folder) = repository();
    let script = "git mv sub.nc called.nc; GIT_EXTERNAL_DIFF='macroglot diff --from fanuc --motion' git diff -M HEAD -- sub.nc \
                  called.nc";
    let shown = typed(&folder, script);
    assert!(shown.contains("O2000 (called.nc): different for the machine"), "{shown}");
    assert!(shown.contains("X 20.000 -> 20.500 (+0.500)"), "{shown}");
}

#[test]
fn a_driver_shows_the_rest_where_a_file_is_no_program() {
    let (_room, folder) = repository();
    std::fs::write(folder.join("main.nc"), b"\x7fELF\x01\x02\x03\x00\x00\x05\x06").unwrap();
    let shown = typed(&folder, "GIT_EXTERNAL_DIFF='macroglot diff --from fanuc --motion' git diff");
    assert!(shown.contains("main.nc: the change cannot be shown"), "{shown}");
    assert!(shown.contains("X 20.000 -> 20.500 (+0.500)"), "{shown}");
}

#[test]
fn a_difftool_of_files_and_of_folders() {
    let (_room, folder) = repository();
    let shown = typed(&folder, &recipe("As a difftool", 0));
    assert!(shown.contains("No effect on the machine.\n"), "{shown}");
    assert_eq!(
        shown.matches("X 20.000 -> 20.500 (+0.500)").count(),
        3,
        "file, then program and caller: {shown}"
    );
}

#[test]
fn a_comment_on_a_merge_request() {
    let (_room, folder) = repository();
    typed(&folder, "git switch -q -c change; git commit -q -a -m change");
    let shown = typed(&folder, &recipe("A comment on", 0));
    assert!(shown.starts_with("exit code 1\n**The machine does something else: 2 programs.**\n"), "{shown}");
    assert!(shown.contains("X 20.000 -> 20.500"), "{shown}");
}
