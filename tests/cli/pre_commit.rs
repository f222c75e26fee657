//! The hooks of `.pre-commit-hooks.yaml`, run by pre-commit itself in a repository of its own, and the wheel that a hook
//! in Python installs.

use crate::python;
use crate::support::{root, text};
use macroglot::dialect::{Entry, registry};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

const PROJECT: &str = "[machines.fv]\ndialect = \"fanuc\"\n\n[machines.vf2]\ndialect = \"haas\"\n\n\
                       [libraries.mill]\npath = \"programs\"\nmachine = \"fv\"\n\n[libraries.mill.targets]\n\
                       vf2 = \"haas\"\n\n[checks]\nround_trip = [\"vf2\"]\n";
const SOUND: &str = "O1000\nG21 G17 G90 G40 G80 G94 G54\nG0 X1.\nM30\n";

/// A shop's repository, with the hooks installed.
struct Shop {
    room: TempDir,
    path: String,
}

impl Shop {
    /// With these hooks, as a configuration lists them.
    fn with(hooks: &str) -> Self {
        let path = format!(
            "{}:{}:{}",
            Path::new(env!("CARGO_BIN_EXE_macroglot")).parent().unwrap().display(),
            python::tools().display(),
            std::env::var("PATH").unwrap()
        );
        let shop = Self { room: TempDir::new().unwrap(), path };
        std::fs::create_dir_all(shop.folder().join("programs")).unwrap();
        shop.write("macroglot.toml", PROJECT);
        shop.write("programs/o1000.nc", SOUND);
        shop.write("README.md", "# A shop\n");
        shop.write(".pre-commit-config.yaml", &format!("repos:\n- repo: local\n  hooks:\n{hooks}"));
        for line in [
            "git init -q -b main",
            "git config user.name shop",
            "git config user.email shop@example.com",
            "git add .",
            "git commit -q -m programs",
            "pre-commit install",
        ] {
            python::said(&shop.run(line), line);
        }
        shop
    }

    fn folder(&self) -> PathBuf {
        self.room.path().join("shop")
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.folder().join(name), text).unwrap();
    }

    fn run(&self, line: &str) -> Output {
        let mut command = Command::new("sh");
        command.args(["-c", line]).current_dir(self.folder()).env("PATH", &self.path);
        command.env("HOME", self.room.path()).env("PRE_COMMIT_HOME", self.room.path().join("cache"));
        command.env("GIT_CONFIG_NOSYSTEM", "1").env_remove("GIT_DIR").env_remove("GIT_INDEX_FILE");
        command.output().unwrap()
    }

    /// A commit that the hooks let through, and what they said.
    fn commits(&self, line: &str) -> String {
        python::said(&self.run(line), line)
    }

    /// A commit that the hooks stop, and what they said.
    fn stops(&self, line: &str) -> String {
        let output = self.run(line);
        let all = String::from_utf8_lossy(&[&output.stdout[..], &output.stderr].concat()).into_owned();
        assert!(!output.status.success(), "{line} went through\n{all}");
        all
    }
}

/// The hooks of the repository, with the binary of this build.
fn hooks() -> String {
    let hooks = text(".pre-commit-hooks.yaml").replace("language: rust", "language: system");
    let lines = hooks.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| format!("  {line}\n")).collect()
}

#[test]
fn the_hooks_are_what_pre_commit_takes() {
    let checked = Command::new(python::tools().join("pre-commit"))
        .args(["validate-manifest", ".pre-commit-hooks.yaml"])
        .current_dir(root())
        .output();
    python::said(&checked.unwrap(), "pre-commit validate-manifest");
    // The files that folders are read for are those that the hooks are given.
    let hooks = text(".pre-commit-hooks.yaml");
    for ending in registry::all().iter().flat_map(Entry::endings) {
        let named = hooks.lines().filter(|line| line.contains("files:"));
        let signs = |line: &str| line.split(['|', '(', ')']).any(|part| part == ending);
        let mut named = named.map(signs);
        assert!(named.all(|named| named), "no hook is given .{ending}");
    }
}

#[test]
fn a_sound_commit_passes_and_other_files_are_left_alone() {
    let shop = Shop::with(&hooks());
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X2."));
    let passed = shop.commits("git commit -a -m move");
    assert!(passed.contains("macroglot check") && passed.contains("Passed"), "{passed}");
    shop.write("README.md", "# The shop\n");
    shop.write("notes", "M38\n");
    let passed = shop.commits("git add . && git commit -m words");
    assert!(passed.contains("(no files to check)") && !passed.contains("Passed"), "{passed}");
}

#[test]
fn a_fault_stops_the_commit_and_says_where_it_is() {
    let shop = Shop::with(&hooks());
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X[1."));
    let stopped = shop.stops("git commit -a -m fault");
    assert!(stopped.contains("programs/o1000.nc:3:") && stopped.contains("MG0112"), "{stopped}");
    assert!(stopped.contains("| G0 X[1."), "{stopped}");
    // One that is new, beside one that was committed.
    shop.commits("git checkout -q -- . && git status");
    shop.write("programs/o2000.nc", &SOUND.replace("O1000", "O2000").replace("M30", "M38\nM30"));
    let stopped = shop.stops("git add . && git commit -m new");
    assert!(stopped.contains("programs/o2000.nc:4:1: MG0301"), "{stopped}");
}

#[test]
fn a_partial_commit_is_checked_as_it_is_committed() {
    let shop = Shop::with(&hooks());
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X3."));
    shop.commits("git add programs");
    // What is not committed may be at work.
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X3.\nX["));
    shop.commits("git commit -m part");
    assert!(shop.commits("git diff").contains("+X["));
    // And what is committed is not what stands there.
    shop.commits("git add programs");
    shop.write("programs/o1000.nc", SOUND);
    assert!(shop.stops("git commit -m part").contains("MG0112"));
}

#[test]
fn a_conversion_goes_with_its_source() {
    let shop = Shop::with(&hooks());
    shop.commits("macroglot convert --quiet && git add . && git commit -m converted");
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X4."));
    let stopped = shop.stops("git commit -a -m move");
    assert!(stopped.contains("MG0906") && stopped.contains("macroglot convert"), "{stopped}");
    shop.commits("macroglot convert --quiet && git add . && git commit -m move");
}

/// The fenced block of `docs/check.md` with this in it.
fn recipe(language: &str, with: &str) -> String {
    let page = text("docs/check.md");
    let fence = format!("```{language}\n");
    let blocks = page.split(&fence).skip(1).filter_map(|rest| rest.split("\n```").next());
    let mut blocks = blocks.filter(|block| block.contains(with));
    blocks.next().unwrap_or_else(|| panic!("docs/check.md has no recipe with {with}")).to_owned()
}

#[test]
fn the_recipes_work_as_they_stand() {
    let shop = Shop::with(&hooks());
    // Of pre-commit, listed by hand.
    shop.write(".pre-commit-config.yaml", &recipe("yaml", "language: system"));
    shop.commits("git add . && git commit -m recipe");
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X[1."));
    assert!(shop.stops("git commit -a -m fault").contains("MG0112"));
    // Of git alone.
    shop.commits("pre-commit uninstall");
    shop.commits(&recipe("sh", "checkout-index"));
    shop.commits("git add programs");
    shop.write("programs/o1000.nc", SOUND);
    assert!(shop.stops("git commit -m fault").contains("programs/o1000.nc:3:"), "what is staged counts");
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X2."));
    shop.commits("git commit -a -m sound");
    shop.write("README.md", "# The shop\n");
    shop.commits("git commit -a -m words");
    // Of a code host: what its last step runs.
    let workflow = recipe("yaml", "pull_request");
    let step = workflow.lines().filter_map(|line| line.trim().strip_prefix("- run: ")).next_back().unwrap();
    shop.commits(step);
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X[1."));
    assert!(shop.stops(step).contains("::error file=programs/o1000.nc,line=3,"));
    // With a baseline.
    for line in recipe("sh", "--write-baseline").lines() {
        shop.commits(line);
    }
}

/// A crate that is packed as ours is, whose program is the one that was built for the tests: another build of all of it would
/// take longer than all other tests here.
fn packed() -> TempDir {
    let folder = TempDir::new().unwrap();
    let manifest = text("Cargo.toml");
    let (head, _) = manifest.split_once("[dependencies]").unwrap();
    assert!(head.contains("[lib]") && head.contains("[[bin]]"), "{head}");
    let main = format!(
        "fn main() {{\n    let mut program = std::process::Command::new({:?});\n    let status = \
         program.args(std::env::args_os().skip(1)).status().unwrap();\n    \
         std::process::exit(status.code().unwrap_or(101));\n}}\n",
        env!("CARGO_BIN_EXE_macroglot")
    );
    std::fs::create_dir(folder.path().join("src")).unwrap();
    for (name, text) in [("Cargo.toml", head), ("src/lib.rs", ""), ("src/main.rs", &main)] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    for name in ["pyproject.toml", "README.md", "LICENSE-MIT", "LICENSE-APACHE"] {
        std::fs::copy(root().join(name), folder.path().join(name)).unwrap();
    }
    folder
}

#[test]
fn a_wheel_installs_and_a_hook_in_python_runs_it() {
    let wheels = TempDir::new().unwrap();
    let crate_folder = packed();
    let built = Command::new(python::tools().join("maturin"))
        .args(["build", "--profile", "dev", "--quiet", "--out"])
        .arg(wheels.path())
        .current_dir(crate_folder.path())
        .env("CARGO_TARGET_DIR", crate_folder.path().join("target"))
        .output();
    python::said(&built.unwrap(), "maturin build");
    let wheel = std::fs::read_dir(wheels.path()).unwrap().flatten().map(|entry| entry.path()).next().unwrap();
    let fresh = wheels.path().join("fresh");
    let mut pip = Command::new(python::tools().join("pip"));
    pip.args(["install", "--no-index", "--quiet", "--prefix"]).arg(&fresh).arg(&wheel);
    python::said(&pip.output().unwrap(), "pip install");
    let version = Command::new(fresh.join("bin/macroglot")).arg("--version").output().unwrap();
    assert_eq!(python::said(&version, "version"), format!("macroglot {}\n", env!("CARGO_PKG_VERSION")));
    let hook = format!(
        "  - id: macroglot\n    name: macroglot\n    entry: macroglot check\n    language: python\n    \
         additional_dependencies: ['{}']\n    files: '\\.nc$'\n",
        wheel.display()
    );
    let shop = Shop::with(&hook);
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X["));
    assert!(shop.stops("git commit -a -m fault").contains("MG0112"));
    shop.write("programs/o1000.nc", &SOUND.replace("X1.", "X5."));
    shop.commits("git commit -a -m sound");
}
