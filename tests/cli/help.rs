//! Help texts, and wrong usage.

use super::Shop;

const COMMANDS: [&str; 13] = [
    "survey",
    "convert",
    "accept",
    "check",
    "parse",
    "verify",
    "diff",
    "run",
    "ir",
    "dialects",
    "explain",
    "completions",
    "man",
];

#[test]
fn help_texts() {
    let shop = Shop::empty();
    let run = shop.run("--help");
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    insta::assert_snapshot!("help", run.out);
    for command in COMMANDS {
        let run = shop.run(&format!("{command} --help"));
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{command}");
        insta::assert_snapshot!(format!("help_{command}"), run.out);
    }
}

/// What `groff` makes of a page names its command, its arguments and its exit.
#[test]
fn manual_pages() {
    let shop = Shop::empty();
    let run = shop.run("man");
    assert!(run.out.starts_with(".ie") && run.out.contains("\n.TH macroglot 1 "), "{}", run.out);
    for command in COMMANDS {
        let run = shop.run(&format!("man {command}"));
        assert_eq!((run.code, run.err.as_str()), (0, ""), "{command}");
        assert!(run.out.contains(&format!("\n.TH macroglot-{command} 1 ")), "{command}: {}", run.out);
        assert!(run.out.contains("\n.SH OPTIONS\n"), "{command}");
    }
    shop.fails("man transmogrify", &["transmogrify", "convert"]);
}

/// What a release packs: the binary runs, each command has its page, and each shell its completions.
#[test]
#[cfg(unix)]
fn an_archive_holds_what_a_release_says() {
    let shop = Shop::empty();
    let target = "x86_64-unknown-linux-gnu";
    let packed = std::process::Command::new(super::repository(".ci/archive"))
        .arg(target)
        .env("MACROGLOT_BINARY", env!("CARGO_BIN_EXE_macroglot"))
        .env("MACROGLOT_DIST", shop.path("dist"))
        .output()
        .unwrap();
    assert!(packed.status.success(), "{}", String::from_utf8_lossy(&packed.stderr));
    let name = format!("macroglot-{}-{target}", env!("CARGO_PKG_VERSION"));
    let unpacked = std::process::Command::new("tar")
        .args(["-xzf", &format!("dist/{name}.tar.gz")])
        .current_dir(shop.path(""))
        .status();
    assert!(unpacked.unwrap().success());
    for command in COMMANDS {
        assert!(shop.read(&format!("{name}/man/macroglot-{command}.1")).contains(".TH"), "{command}");
    }
    assert!(shop.read(&format!("{name}/completions/macroglot.bash")).contains("macroglot"));
    let version =
        std::process::Command::new(shop.path(&format!("{name}/macroglot"))).arg("--version").output();
    assert!(version.unwrap().status.success());
}

#[test]
fn version() {
    let run = Shop::empty().run("--version");
    assert_eq!((run.code, run.out), (0, format!("macroglot {}\n", env!("CARGO_PKG_VERSION"))));
}

#[test]
fn wrong_usage_is_2() {
    let shop = Shop::with(&[("a.nc", super::CLEAN)]);
    shop.fails("", &["Usage"]);
    shop.fails("transmogrify a.nc", &["transmogrify"]);
    shop.fails("convert a.nc --form fanuc --to haas", &["--form", "--from"]);
    shop.fails("convert a.nc --from fanuc --to haas -O7", &["7"]);
    shop.fails("convert a.nc --from fanuc --to haas --format xml", &["xml"]);
    shop.fails("convert a.nc --from fanuc", &["--to", "haas"]);
    shop.fails("convert a.nc --from siemens --to haas", &["siemens", "fanuc"]);
    shop.fails("convert a.nc --from fanuc --to siemens", &["siemens", "haas"]);
    shop.fails("parse a.nc --dialect siemens", &["siemens"]);
    shop.fails("parse", &["PATH"]);
    shop.fails("ir a.nc --dialect siemens", &["siemens"]);
    shop.fails("dialects siemens", &["siemens"]);
    shop.fails("explain MG9999", &["MG9999"]);
    shop.fails("completions cobol", &["cobol"]);
}
