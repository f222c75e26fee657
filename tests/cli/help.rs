//! Help texts, and wrong usage.

use super::Shop;

const COMMANDS: [&str; 9] =
    ["convert", "parse", "verify", "diff", "run", "ir", "dialects", "explain", "completions"];

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
