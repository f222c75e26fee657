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
        (PROJECT.replace("[machines.new]", "[machines.new"), &["macroglot.toml:3:14: "][..]),
        (PROJECT.replace("path =", "folder ="), &["macroglot.toml:6:1: ", "folder"]),
        (
            PROJECT.replace("machine = \"old\"", "machine = \"lost\""),
            &["macroglot.toml:7:1: ", "shop", "lost"],
        ),
        (PROJECT.replace("\"programs\"", "\"nowhere\""), &["macroglot.toml:6:1: ", "nowhere"]),
        (PROJECT.replace("\"haas\"", "\"siemens\""), &["macroglot.toml:4:1: ", "siemens"]),
        (PROJECT.replace("new = ", "other = "), &["macroglot.toml:9:1: ", "'other'"]),
        (PROJECT.replace("path =", "except = [\"[\"]\npath ="), &["macroglot.toml:6:1: ", "no pattern"]),
        (
            PROJECT.replace("path =", "shared = [\"programs\", \"lost\"]\npath ="),
            &["macroglot.toml:6:23: ", "lost"],
        ),
        (
            format!("{PROJECT}[checks]\nround_trip = [\"haas\", \"odd\"]\n"),
            &["macroglot.toml:11:23: ", "'odd'"],
        ),
        (PROJECT.replace("\"out\"", "\"programs\""), &["overwritten"]),
        (PROJECT.replace("\"haas\"", "\"haas\"\nprofile = \"m.toml\""), &["macroglot.toml:5:1: ", "m.toml"]),
        ("[machines]\n".into(), &["no library"]),
    ] {
        shop.write("macroglot.toml", text.as_bytes());
        shop.fails("convert", words);
    }
}

#[test]
fn a_code_that_is_none_is_named_with_its_line_in_the_project_file() {
    let shop = Shop::with(&[("programs/a.nc", CLEAN)]);
    for (more, words) in [
        ("[checks]\nignore = [\"MG0\", \"MG99\"]\n", &["macroglot.toml:11:18: ", "'MG99'"][..]),
        ("[[checks.allow]]\ncode = \"X\"\npath = \"*\"\nreason = \"r\"\n", &["macroglot.toml:10:1: ", "'X'"]),
        ("[checks]\nround_trip = [\"odd\"]\n", &["macroglot.toml:11:15: ", "'odd'"]),
    ] {
        shop.write("macroglot.toml", format!("{PROJECT}{more}").as_bytes());
        shop.fails("check", words);
    }
}

#[test]
fn a_profile_of_another_control_is_no_profile_of_the_machine() {
    let project = PROJECT.replace("\"haas\"", "\"haas\"\nprofile = \"m.toml\"");
    let files =
        [("macroglot.toml", project.as_str()), ("m.toml", "dialect = \"fadal\"\n"), ("programs/a.nc", CLEAN)];
    Shop::with(&files).fails("convert", &["m.toml", "'fadal'", "a haas"]);
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

/// A shop with a folder for each of two jobs, whose programs have the same numbers, and a folder of macros for both.
fn two_jobs() -> Shop {
    let main = "O1000\nG21 G17 G90 G40 G80 G94 G54\nG0 X0. Y0.\nG65 P9000 A10.\nG65 P9001 A1.\nM30\n";
    let macro_of = |number: u32, axis: char| format!("O{number}\nG1 {axis}#1 F100.\nM99\n");
    let project = PROJECT
        .replace("machine = \"old\"", "machine = \"old\"\napart = true\nshared = [\"programs/macros\"]");
    Shop::with(&[
        ("macroglot.toml", &project),
        ("programs/job1/main.nc", main),
        ("programs/job2/main.nc", &main.replace("X0.", "X7.")),
        // The second job has a macro of its own.
        ("programs/job2/own.nc", &macro_of(9000, 'Z')),
        ("programs/macros/o9000.nc", &macro_of(9000, 'X')),
        ("programs/macros/o9001.nc", &macro_of(9001, 'Y')),
    ])
}

#[test]
fn folders_are_libraries_of_their_own_and_share_what_the_project_file_says() {
    let shop = two_jobs();
    let run = shop.run("convert");
    assert_eq!(run.code, 0, "{}", run.err);
    let files = shop.files();
    let written: Vec<&str> =
        names(&files).into_iter().filter(|name| name.starts_with("out/") && name.ends_with(".nc")).collect();
    assert_eq!(
        written,
        [
            "out/job1/macros/o9000.nc",
            "out/job1/macros/o9001.nc",
            "out/job1/main.nc",
            "out/job2/macros/o9001.nc",
            "out/job2/main.nc",
            "out/job2/own.nc"
        ],
        "a program of its own stands before a shared one"
    );
    assert!(shop.read("out/job2/own.nc").contains("G1 Z#1"));
    let twice = shop.run("convert --verbose");
    assert!(!twice.out.contains("MG0602") && !twice.out.contains("MG0603"), "{}", twice.out);
    assert!(twice.out.contains("fanuc to haas, from programs/job2:"), "{}", twice.out);
    assert!(
        twice.out.contains("programs/macros/o9000.nc: shared, where the folder has its own"),
        "{}",
        twice.out
    );
    // Without the two lines it is one library, in which the numbers stand twice.
    shop.write("macroglot.toml", PROJECT.as_bytes());
    let one = shop.run("convert --out all --verbose");
    assert!(one.out.contains("MG0602"), "{}", one.out);
}

/// Each folder is checked by itself, and a shared program once.
#[test]
fn folders_are_checked_by_themselves() {
    let shop = two_jobs();
    assert_eq!(shop.run("convert").code, 0);
    let run = shop.run("check --cache cache --against new");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.out.starts_with("5 files checked, nothing found"), "{}", run.out);
    shop.write("programs/job2/own.nc", b"O9000\nG1 Z#1 F[100.\nM99\n");
    let run = shop.run("check --cache cache --against new");
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(run.out.contains("programs/job2/own.nc:2"), "{}", run.out);
}

/// Two machines' programs in one folder are two libraries: each file is of one of them.
#[test]
fn a_library_takes_some_files_of_its_folder() {
    let more = "[libraries.other]\npath = \"programs\"\nonly = [\"**/b*.nc\"]\nmachine = \"old\"\n[libraries.other.targets]\nnew = \"other\"\n";
    let project =
        PROJECT.replace("machine = \"old\"", "except = [\"b.nc\", \"sub/*\"]\nmachine = \"old\"") + more;
    let numbered = |number: u32| CLEAN.replace("O1234", &format!("O{number}"));
    let shop = Shop::with(&[
        ("macroglot.toml", &project),
        ("programs/a.nc", CLEAN),
        ("programs/b.nc", &numbered(2)),
        ("programs/sub/b2.nc", &numbered(3)),
        ("programs/sub/deep/c.nc", &numbered(4)),
    ]);
    let run = shop.run("convert --verbose");
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let files = shop.files();
    let written = |folder: &str| -> Vec<String> {
        let all = names(&files).into_iter().filter(|name| name.starts_with(folder) && name.ends_with(".nc"));
        all.map(str::to_owned).collect()
    };
    // A single star stops at the folder.
    assert_eq!(written("out/"), ["out/a.nc", "out/sub/deep/c.nc"]);
    assert_eq!(written("other/"), ["other/b.nc", "other/sub/b2.nc"]);
    assert!(run.out.contains("programs/b.nc: not of this library by macroglot.toml"), "{}", run.out);
    // A file alone is of the library that takes it.
    let checked = shop.run("check programs/b.nc --no-cache");
    assert!(checked.out.starts_with("1 file checked"), "{}{}", checked.out, checked.err);
}

#[test]
fn names_that_take_no_file_are_faults() {
    let shop = Shop::with(&[("programs/a.nc", CLEAN)]);
    for (line, words) in [
        ("only = []", &["shop", "'only' names no file"][..]),
        ("only = [\"[\"]", &["shop", "'[' is no pattern"]),
        ("only = [\"b.nc\"]", &["programs", "'b.nc' under 'only'"]),
        ("except = [\"b.nc\"]", &["programs", "'b.nc' under 'except'"]),
        ("only = [\"*.tap\"]", &["programs", "no program of the folder"]),
    ] {
        let text = PROJECT.replace("machine = \"old\"", &format!("{line}\nmachine = \"old\""));
        shop.write("macroglot.toml", text.as_bytes());
        shop.fails("convert", words);
    }
    // A pattern may be there for files to come.
    let text = PROJECT.replace("machine = \"old\"", "except = [\"*.bak\"]\nmachine = \"old\"");
    shop.write("macroglot.toml", text.as_bytes());
    assert_eq!(shop.run("convert").code, 0);
}

/// Whose profile counts for a file says the library that takes it.
#[test]
fn a_file_has_the_machine_of_its_library() {
    let project = "[machines.inch]\ndialect = \"fanuc\"\nprofile = \"inch.toml\"\n[machines.metric]\ndialect = \
                   \"fanuc\"\nprofile = \"metric.toml\"\n[libraries.a]\npath = \"programs\"\nexcept = \
                   [\"b.nc\"]\nmachine = \"inch\"\n[libraries.b]\npath = \"programs\"\nonly = [\"b.nc\"]\nmachine = \
                   \"metric\"\n";
    let program = "O1\nG90 G0 X1.\nM30\n";
    let shop = Shop::with(&[
        ("macroglot.toml", project),
        ("inch.toml", "dialect = \"fanuc\"\nunits = \"inch\"\n"),
        ("metric.toml", "dialect = \"fanuc\"\nunits = \"metric\"\n"),
        ("programs/a.nc", program),
        ("programs/b.nc", program),
    ]);
    for (file, code) in [("a", "G20"), ("b", "G21")] {
        let run = shop.run(&format!("convert programs/{file}.nc --to haas --no-verify"));
        assert!(run.out.contains(code), "{}{}", run.out, run.err);
    }
}

/// Two old machines go to one new one: a number that a program is given there is no program's of the other library, and what
/// one library keeps in a register the other one does not use.
#[test]
fn libraries_that_go_to_one_machine_share_no_invented_number() {
    let project = "\
[machines.old]
dialect = \"fadal\"
[machines.new]
dialect = \"fanuc\"
[libraries.first]
path = \"first\"
machine = \"old\"
[libraries.first.targets]
new = \"out/first\"
[libraries.second]
path = \"second\"
machine = \"old\"
[libraries.second.targets]
new = \"out/second\"
";
    let program = |name: &str| {
        format!(
            "N1 O{name}\nN2 L100\nN3 G90 G0 X1.\nN4 M17\nN5 M30\nN6 G20 G90 G94 G17 E1\nN7 #V1=V1+1\nN8 L101\nN9 M2\n"
        )
    };
    let shop = Shop::with(&[
        ("macroglot.toml", project),
        ("first/a.nc", &program("1")),
        ("second/b.nc", &program("2")),
    ]);
    for _ in 0..2 {
        shop.run("convert");
        let (first, second) = (shop.read("out/first/a.nc"), shop.read("out/second/b.nc"));
        assert!(first.contains("O8000 (L100)") && !first.contains("O8001"), "{first}");
        assert!(second.contains("O8001 (L100)") && !second.contains("O8000"), "{second}");
        let counter = |text: &str| text.split_once("(V1=").unwrap().1.split(')').next().unwrap().to_owned();
        assert_ne!(counter(&first), counter(&second));
    }
}
