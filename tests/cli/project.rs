//! `macroglot.toml`.

use super::{CLEAN, REFUSED, Shop, names};

const PROJECT: &str = "\
[machines.old]
dialect = \"fanuc\"
[machines.new]
dialect = \"haas\"
[libraries.shop]
path = \"programs\"
machine = \"old\"
[libraries.shop.targets]
new = \"out\"
";

#[test]
fn a_project_is_converted_without_arguments() {
    let shop = Shop::with(&[("macroglot.toml", PROJECT), ("programs/a.nc", CLEAN)]);
    let run = shop.run("convert");
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let files = shop.files();
    assert_eq!(
        names(&files),
        [
            "macroglot.toml",
            "out/a.nc",
            "out/a.nc.certificate.json",
            "out/macroglot.lock",
            "out/macroglot.manifest",
            "programs/a.nc"
        ]
    );
    // Again, elsewhere.
    assert_eq!(shop.run("convert --out copy --from fanuc --to haas").code, 0);
    assert_eq!(shop.read("copy/out/a.nc"), shop.read("out/a.nc"));
    shop.write("programs/b.nc", REFUSED.as_bytes());
    assert_eq!(shop.run("convert").code, 1);
    shop.fails("convert --to fadal", &["no library", "for this target"]);
    shop.fails("convert --machine m.toml", &["--machine"]);
}

#[test]
fn a_wrong_project_file_is_named_with_its_line() {
    let shop = Shop::with(&[("programs/a.nc", CLEAN)]);
    shop.fails("convert", &["macroglot.toml"]);
    for (text, words) in [
        (PROJECT.replace("[machines.new]", "[machines.new"), &["macroglot.toml:3"][..]),
        (PROJECT.replace("path =", "folder ="), &["macroglot.toml:6", "folder"]),
        (PROJECT.replace("machine = \"old\"", "machine = \"lost\""), &["shop", "lost"]),
        (PROJECT.replace("\"programs\"", "\"nowhere\""), &["nowhere"]),
        (PROJECT.replace("\"haas\"", "\"siemens\""), &["siemens"]),
        (PROJECT.replace("\"out\"", "\"programs\""), &["overwritten"]),
        (PROJECT.replace("\"haas\"", "\"haas\"\nprofile = \"m.toml\""), &["m.toml"]),
        ("[machines]\n".into(), &["no library"]),
    ] {
        shop.write("macroglot.toml", text.as_bytes());
        shop.fails("convert", words);
    }
}

/// Two libraries into one folder would mix their registers up.
#[test]
fn two_libraries_need_two_folders() {
    let both = format!(
        "{PROJECT}[libraries.more]\npath = \"more\"\nmachine = \"old\"\n[libraries.more.targets]\nnew = \"out\"\n"
    );
    let files = [("macroglot.toml", both.as_str()), ("programs/a.nc", CLEAN), ("more/b.nc", CLEAN)];
    Shop::with(&files).fails("convert", &["out", "nothing was written"]);
}

#[test]
fn a_program_for_another_machine_of_its_dialect_is_no_copy() {
    let project = PROJECT.replace("haas", "fanuc").replacen('\n', "\nprofile = \"inch.toml\"\n", 1);
    let shop = Shop::with(&[
        ("macroglot.toml", &project),
        ("inch.toml", "dialect = \"fanuc\"\nunits = \"inch\"\ndecimal_point = \"increments\"\n"),
        ("metric.toml", "dialect = \"fanuc\"\nunits = \"metric\"\ndecimal_point = \"calculator\"\n"),
        ("programs/a.nc", "O1\nG0X15000\nM30\n"),
    ]);
    shop.write(
        "macroglot.toml",
        project.replace("[machines.new]", "[machines.new]\nprofile = \"metric.toml\"").as_bytes(),
    );
    assert_eq!(shop.run("convert").code, 0);
    assert_eq!(super::unmarked(&shop.read("out/a.nc")), "O0001\nG20\nG0 X1.5\nM30\n");
}
