//! Machine profiles on the command line.

use super::{CLEAN, Shop, repository};

#[test]
fn a_wrong_profile_is_named_with_its_line() {
    let shop = Shop::with(&[
        ("a.nc", CLEAN),
        ("key.toml", "dialect = \"fanuc\"\nmachin = \"mill\"\n"),
        ("syntax.toml", "dialect = \"fanuc\"\nunits = \n"),
        ("value.toml", "dialect = \"fanuc\"\n\nmachine = \"router\"\n"),
        ("nobody.toml", "dialect = \"siemens\"\n"),
        ("cc100.toml", "dialect = \"cc100\"\n"),
    ]);
    let line = "convert a.nc --from fanuc --to haas --machine";
    shop.fails(&format!("{line} key.toml"), &["key.toml:2", "machin"]);
    shop.fails(&format!("{line} syntax.toml"), &["syntax.toml:2"]);
    shop.fails(&format!("{line} value.toml"), &["value.toml:3", "router"]);
    shop.fails(&format!("{line} nobody.toml"), &["nobody.toml", "siemens"]);
    shop.fails(&format!("{line} cc100.toml"), &["cc100.toml", "neither"]);
    shop.fails(&format!("{line} nowhere.toml"), &["nowhere.toml"]);
    shop.fails("dialects fanuc --machine key.toml", &["key.toml:2"]);
}

/// G49 moves Z by a length in force on such a Fanuc (parameter 5006.6 is 0), and not on a Haas. What a machine begins in has none.
#[test]
fn a_tool_length_left_in_force_is_for_review_unless_a_start_is_stated() {
    let program = "O1\nG21 G90 G17 G94 G40 G80 G49 G54\nG0 X1.\nT1 M6\nG43 H1\nG0 X5.\nZ5.\nM30\n";
    let fanuc = "dialect = \"fanuc\"\nunits = \"metric\"\n[parameters]\n5006.6 = \"0\"\n";
    let stated = format!("{fanuc}[start]\ncodes = \"G21 G90 G17 G94 G0 G54\"\n");
    let shop = Shop::with(&[
        ("a.nc", program),
        ("h.toml", "dialect = \"haas\"\nunits = \"metric\"\n"),
        ("open.toml", fanuc),
        ("stated.toml", &stated),
    ]);
    for (profile, asked) in [("open.toml", true), ("stated.toml", false)] {
        let line = format!("convert a.nc --from haas --to fanuc --machine h.toml --machine {profile}");
        let run = shop.run(&line);
        assert!(run.out.contains("G0 X5.\nG43 H1 Z5.\n"), "{}{}", run.out, run.err);
        assert_eq!(run.err.contains("started with a tool length in force"), asked, "{}", run.err);
    }
}

/// What machines have in common stands once: the nearest profile counts first, lists count together.
#[test]
fn a_profile_extends_another() {
    let program = CLEAN.replace("G0 X1.", "G0 X1. A5.\nM14\nM15");
    let site =
        |code: &str, what: &str| format!("[[site]]\ncode = \"{code}\"\ntext = \"{code}\"\ndo = \"{what}\"\n");
    let base = format!(
        "dialect = \"fanuc\"\nconfirm = [\"word:A\"]\n{}{}",
        site("M14", "alarm"),
        site("M15", "omit")
    );
    let own = format!("extends = \"shop/base.toml\"\nhead = false\nunits = \"mm\"\n{}", site("M14", "omit"));
    let shop = Shop::with(&[("a.nc", &program), ("m/shop/base.toml", &base), ("m/own.toml", &own)]);
    let run = shop.run("convert a.nc --from fanuc --to haas --machine m/own.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(!run.err.contains("word:A") && !run.out.contains("#3000"), "{}{}", run.out, run.err);
    let run = shop.run("convert a.nc --from fanuc --to haas --machine m/shop/base.toml");
    assert!(run.out.contains("#3000"), "{}{}", run.out, run.err);
}

#[test]
fn what_is_wrong_with_an_extended_profile_is_told_at_its_place() {
    let extends = |file: &str| format!("dialect = \"fanuc\"\nextends = \"{file}\"\n");
    let shop = Shop::with(&[
        ("a.nc", CLEAN),
        ("key.toml", "dialect = \"fanuc\"\n\nmachin = \"mill\"\n"),
        ("fact.toml", "dialect = \"fanuc\"\n\nconfirm = [\"behaviour:no.such\"]\n"),
        ("haas.toml", "dialect = \"haas\"\n"),
        ("none.toml", "title = \"whose?\"\n"),
        ("of-none.toml", "extends = \"none.toml\"\n"),
        ("of-key.toml", &extends("key.toml")),
        ("of-fact.toml", &extends("fact.toml")),
        ("of-haas.toml", &extends("haas.toml")),
        ("of-nothing.toml", &extends("nowhere.toml")),
        ("of-folder.toml", &extends(".")),
        ("round.toml", &extends("about.toml")),
        ("about.toml", &extends("round.toml")),
    ]);
    let line = "convert a.nc --from fanuc --to haas --machine";
    shop.fails(&format!("{line} of-key.toml"), &["key.toml:3", "machin"]);
    shop.fails(&format!("{line} of-fact.toml"), &["fact.toml:3", "no.such"]);
    shop.fails(&format!("{line} of-none.toml"), &["none.toml", "does not say whose it is"]);
    shop.fails(&format!("{line} of-haas.toml"), &["of-haas.toml:2", "'haas'"]);
    shop.fails(&format!("{line} of-nothing.toml"), &["of-nothing.toml:2", "nowhere.toml"]);
    shop.fails(&format!("{line} of-folder.toml"), &["of-folder.toml:2"]);
    shop.fails(
        &format!("{line} round.toml"),
        &["about.toml:2", "a profile extends itself", "about.toml extends", "take one of these"],
    );
}

/// An extended profile is an input like any other.
#[test]
fn an_extended_profile_is_not_written_over() {
    let base = "dialect = \"fanuc\"\n";
    let shop = Shop::with(&[
        ("a.nc", CLEAN),
        ("base.toml", base),
        ("own.toml", "dialect = \"fanuc\"\nextends = \"base.toml\"\n"),
    ]);
    let line = "convert a.nc --from fanuc --to haas --machine own.toml --report base.toml.json";
    assert_eq!(shop.run(line).code, 0);
    std::fs::rename(shop.path("base.toml"), shop.path("base.json")).unwrap();
    shop.write("own.toml", b"dialect = \"fanuc\"\nextends = \"base.json\"\n");
    shop.fails(
        "convert a.nc --from fanuc --to haas --machine own.toml --report base.json",
        &["base.json", "input"],
    );
    assert_eq!(shop.read("base.json"), base);
}

/// What is open of a machine is asked once, makes no program one for review, and is not asked of a profile that states it.
#[test]
fn a_profile_answers_what_is_open_of_a_machine() {
    let program = CLEAN.replace("G0 X1.", "#100=#4001 AND 3\nG0 X1.");
    let confirm = "confirm = [\"behaviour:bits.of.fraction\"]\n";
    let shop = Shop::with(&[("a.nc", &program), ("m.toml", &format!("dialect = \"fanuc\"\n{confirm}"))]);
    let plain = shop.run("convert a.nc --from fanuc --to haas");
    assert!(plain.err.contains("bits.of.fraction") && plain.err.contains("1 converted"), "{}", plain.err);
    let known = shop.run("convert a.nc --from fanuc --to haas --machine m.toml");
    assert!(!known.err.contains("bits.of.fraction") && known.err.contains("1 converted"), "{}", known.err);
    assert_eq!(known.out, plain.out, "the same program, with nothing to look at");
}

/// In its own format the control has E and H where the one like Fanuc has G54 and G43.
#[test]
fn a_code_of_another_setting_is_told_so() {
    let program = "O1\nG90 G0 G55 X1. Y1.\nG43 H5 Z1.\nG41 G1 X2. D6 F10.\nG40 X0\nH7\nG42 X1.\nM2\n";
    let shop = Shop::with(&[("a.nc", program), ("m.toml", "dialect = \"fadal\"\n[settings]\nformat = 2\n")]);
    let own = shop.run("convert a.nc --from fadal --to fanuc");
    assert!(
        own.err.contains("no meaning for G55") && own.err.contains("format=2 under [settings]"),
        "{}",
        own.err
    );
    let like = shop.run("convert a.nc --from fadal --to fanuc --machine m.toml");
    // H picks no cutter there.
    let body = "O0001\nG90 G0 G55 X1. Y1.\nG43 H5 Z1.\nG41 G1 X2. D6 F10.\nG40 X0.\nG43 H7\nG42 X1.\nM2\n";
    assert!(super::unmarked(&like.out).contains(body), "{}", like.out);
}

/// M910 calls O9020 only where parameter 6080 says so.
#[test]
fn a_profile_gives_codes_their_meaning() {
    let shop = Shop::empty();
    let line = format!("convert {} --from fanuc --to haas --quiet", repository("corpus/fanuc/call-m910.nc"));
    assert_eq!(shop.run(&line).code, 1);
    let machine = repository("machines/fanuc-0i.toml");
    let run = shop.run(&format!("{line} --machine {machine}"));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("P9020"), "{}", run.out);
}

/// The main part ends, so the program is a main one; what stands behind its end only returns.
#[test]
fn the_unit_of_a_profile_is_written_where_unused_subroutines_stand_too() {
    let program = "G90\nG54\nG0 X5 Y0\nM30\n$1\nG0 X1\nG99\n";
    let shop = Shop::with(&[("a.nc", program), ("m.toml", "dialect = \"cc100\"\nunits = \"metric\"\n")]);
    let run = shop.run("convert a.nc --from cc100 --to haas --machine m.toml");
    assert_eq!(run.out.matches("G21").count(), 1, "{}", run.out);
}

/// O2 runs in millimetres from O1 and in inches from O3, where the machine starts: -6 is neither -0.006 nor -0.0006.
#[test]
fn a_program_called_from_both_units_has_no_size_of_increments() {
    let called = "O2\nG1 Z-6 F100.\nM99\n";
    let metric = "O1\nG21\nM98 P2\nM30\n";
    let shop = Shop::with(&[
        ("one.nc", &format!("{metric}{called}")),
        ("both.nc", &format!("{metric}{called}O3\nM98 P2\nM30\n")),
        ("m.toml", "dialect = \"haas\"\nunits = \"inch\"\n"),
        ("f.toml", "dialect = \"fanuc\"\nunits = \"inch\"\ndecimal_point = \"calculator\"\n"),
    ]);
    let line = "--from haas --to fanuc --machine m.toml --machine f.toml";
    let one = shop.run(&format!("convert one.nc {line}"));
    assert!(one.out.contains("Z-0.006"), "{}", one.out);
    let both = shop.run(&format!("convert both.nc {line}"));
    assert_eq!(both.code, 1, "{}", both.err);
    assert!(both.err.contains("not known here"), "{}", both.err);
}

/// A table of diameters gets twice the radius; a variable that is vacant would have written nothing.
#[test]
fn a_doubled_value_that_is_vacant_writes_nothing_either() {
    let shop = Shop::with(&[
        ("a.nc", "O1\nG91 G10 L12 P3 R#2\nM99\n"),
        ("b.nc", "O1\n#2=1.5\nG90 G10 L12 P3 R#2\nM99\n"),
        ("m.toml", "dialect = \"haas\"\n[settings]\n40 = \"diameter\"\n"),
    ]);
    let line = "--from fanuc --to haas --machine m.toml --no-verify";
    let run = shop.run(&format!("convert a.nc {line}"));
    let block = "IF [#2 EQ #0] GOTO 10\nG91 G10 L12 P3 R[#2*2]\nGOTO 20\nN10 G91 G10 L12 P3\nN20 M99";
    assert!(run.out.contains(block), "{} {}", run.out, run.err);
    let run = shop.run(&format!("convert b.nc {line}"));
    assert!(run.out.contains("R[#2*2]") && !run.out.contains("IF"), "{} {}", run.out, run.err);
}

/// Whoever has said which variables the shop keeps is told what is taken, and not asked again.
#[test]
fn the_registers_taken_are_told_and_reserved_is_asked_for() {
    let taking = "%\nO1\n#500=ASIN[#501]\nM30\n%\n";
    let shop = Shop::with(&[
        ("a.nc", taking),
        ("clean.nc", CLEAN),
        ("none.toml", "dialect = \"fanuc\"\nreserved = []\n"),
        ("some.toml", "dialect = \"fanuc\"\nreserved = [\"#100-#109\"]\n"),
    ]);
    let line = "convert a.nc --from haas --to fanuc";
    let asked = shop.run(line).err;
    assert!(
        asked.contains("registers taken: #100; if the machine") && asked.contains("'reserved'"),
        "{asked}"
    );
    let none = shop.run(&format!("{line} --machine none.toml")).err;
    assert!(none.contains("registers taken: #100\n"), "{none}");
    let some = shop.run(&format!("{line} --machine some.toml")).err;
    assert!(some.contains("registers taken: #110\n"), "{some}");
    let clean = shop.run("convert clean.nc --from haas --to fanuc").err;
    assert!(!clean.contains("registers"), "{clean}");
}

/// A machine that begins in G91 does otherwise with a program that names no mode: the source is run as its profile says, and the
/// target in whatever its own says.
#[test]
fn what_a_machine_begins_in_is_run_and_verified() {
    let program = "O1\nG1 X1. F100.\nX2.\nM30\n";
    let begins = |dialect: &str, codes: &str| {
        format!("dialect = \"{dialect}\"\nunits = \"metric\"\n[start]\ncodes = \"{codes}\"\n")
    };
    let shop = Shop::with(&[
        ("a.nc", program),
        ("old.toml", &begins("fanuc", "G91 G54")),
        ("new.toml", &begins("haas", "G90 G54")),
    ]);
    let there = shop.run("convert a.nc --from fanuc --to haas --machine old.toml --machine new.toml -o out");
    assert!(there.out.contains("1 converted") && there.out.contains("1 verified"), "{}", there.out);
    assert!(shop.read("out/a.nc").contains("\nG91\nG1 X1. F100.\n"), "{}", shop.read("out/a.nc"));
    // By G91 the second move ends at 3 mm, by G90 at 2.
    for (machine, control, end) in [("old.toml", "fanuc", "3.0"), ("new.toml", "haas", "2.0")] {
        let run = shop.run(&format!("run a.nc --dialect {control} --machine {machine} --trace json"));
        let last = run.out.lines().rfind(|line| line.contains("\"feed\",")).unwrap();
        assert!(last.contains(&format!("\"to\":{{\"x\":{end},")), "{last}");
    }
}

/// The table has no variables of six digits; the profile that ships for a Mitsubishi M70 has those from #900000 on.
#[test]
fn variables_of_six_digits_are_asked_of_the_profile() {
    let program = "O1 (PARTS IN #900000)\nG21 G90\n#900000=#900000+1.\nM30\n";
    let shop = Shop::with(&[("a.nc", program)]);
    let bare = shop.run("convert a.nc --from fanuc --to haas");
    assert_eq!(bare.code, 1, "{}", bare.err);
    assert!(bare.err.contains("no variable #900000"), "{}", bare.err);
    assert!(bare.err.contains("name it in 'variables' of its profile"), "{}", bare.err);
    let machine = repository("machines/mitsubishi-m70.toml");
    let run = shop.run(&format!("convert a.nc --from fanuc --to haas --machine {machine}"));
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("PARTS IN #100") && run.out.contains("#100=#100+1"), "{}", run.out);
    // The emulated control counts in it too.
    let ran = shop.run(&format!("run a.nc --dialect fanuc --machine {machine} --set #900000=4"));
    assert!(ran.out.contains("#900000 = 5"), "{}{}", ran.out, ran.err);
}

/// Every profile that ships is one, with what it extends; what it says of its kind is in its name.
#[test]
fn the_profiles_that_ship_are_read() {
    let folder = repository("machines");
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let dialect =
            text.lines().find_map(|line| line.strip_prefix("dialect = ")).unwrap().trim_matches('"');
        let run = Shop::empty().run(&format!("dialects {dialect} --machine {}", path.display()));
        assert_eq!(run.code, 0, "{}: {}", path.display(), run.err);
        let name = path.file_stem().unwrap().to_string_lossy();
        let is_lathe = name.ends_with("-t") || name.starts_with("haas-st") || name.ends_with("-live-tools");
        // Turning and facing passes are codes of lathes alone.
        assert_eq!(run.out.contains("pass.turning"), is_lathe, "{}", path.display());
        count += 1;
    }
    assert_eq!(count, 14);
}

/// A line that is commented out is an answer that nobody has given: put in, it must be one that the profile may have.
#[test]
fn the_lines_to_fill_in_are_of_their_profile() {
    for (name, lines) in [
        (
            "fanuc-30i.toml",
            &["offset_memory = \"C\"", "codes = \"G90 G17 G21 G54 G0 G94\"", "work_offsets = 48"][..],
        ),
        (
            "fanuc-30i-t.toml",
            &[
                "gcode_system = \"A\"",
                "codes = \"G18 G21 G54 G0 G99\"",
                "axes = [\"X\", \"Z\", \"C\", \"Y\"]",
            ],
        ),
        (
            "haas-st.toml",
            &["codes = \"G18 G20 G54 G0 G99\"", "287 = 0.05", "95 = 1", "99 = 0.001", "162 = 0", "22 = 0.05"],
        ),
    ] {
        let text = std::fs::read_to_string(repository(&format!("machines/{name}"))).unwrap();
        let mut filled = text.clone();
        for line in lines {
            assert!(text.contains(&format!("# {line}")), "{name}: {line}");
            filled = filled.replace(&format!("# {line}"), line);
        }
        let filled = filled.replace("# [settings]", "[settings]").replace("# [start]", "[start]");
        let dialect = if name.starts_with("haas") { "haas" } else { "fanuc" };
        let shop = Shop::with(&[("m.toml", &filled)]);
        let run = shop.run(&format!("dialects {dialect} --machine m.toml"));
        assert_eq!(run.code, 0, "{name}: {}", run.err);
    }
}

/// A profile that is wrong says in which line and column, what is wrong, and what to do.
#[test]
fn each_way_to_be_wrong_is_told_at_its_place() {
    let shop = Shop::with(&[("a.nc", CLEAN)]);
    let cases: [(&[u8], &[&str]); 14] = [
        (b"title = \"mill\"\n", &["p.toml:1:1", "does not say whose it is", "write dialect = "]),
        (b"", &["p.toml:1:1", "does not say whose it is"]),
        (b"dialect = \"siemens\"\n", &["p.toml:1:11", "no dialect is named 'siemens'", "fanuc"]),
        (
            b"dialect = \"fanuc\"\nunits = 5\n",
            &["p.toml:2:9", "a text in quotes must stand here", "docs/profiles.md"],
        ),
        (
            b"dialect = \"fanuc\"\nunits = \"cm\"\n",
            &["p.toml:2:9", "'cm' is no answer here: it is \"inch\", \"metric\" or \"mm\""],
        ),
        (
            b"dialect = \"fanuc\"\nunits = \"inch\" or \"metric\"\n",
            &["p.toml:2:16", "of the values of a question one stays"],
        ),
        (
            b"dialect = \"fanuc\"\naxes = \"XYZ\"\n",
            &["p.toml:2:8", "a list, as [\"X\", \"Y\"] must stand here"],
        ),
        (
            b"dialect = \"fanuc\"\noffsets = -5\n",
            &["p.toml:2:11", "a whole number that is not negative", "not integer -5"],
        ),
        (b"dialect = \"fanuc\"\nextends = \"\"\n", &["p.toml:2:11", "'extends' names no file"]),
        (b"dialect = \"fanuc\"\nextends = \".\"\n", &["p.toml:2:11", "is a folder"]),
        (
            b"dialect = \"fanuc\"\nextends = \"p.toml\"\n",
            &["p.toml:2:11", "a profile extends itself: p.toml extends p.toml"],
        ),
        (b"dialect = \"fanuc\"\ntitle = \"a\"\ntitle = \"b\"\n", &["p.toml:3:1", "write each key once"]),
        (
            b"dialect = \"fanuc\"\ntitle = \"fr\xE4se\"\n",
            &["p.toml:2:12", "the byte E4", "save the file as UTF-8"],
        ),
        (
            b"dialect = \"fanuc\"\n[[site]]\ntext = \"air\"\nname = \"x\"\n",
            &["p.toml:2:1", "'code' is missing here"],
        ),
    ];
    for (text, says) in cases {
        shop.write("p.toml", text);
        shop.fails("convert a.nc --from fanuc --to haas --machine p.toml", says);
    }
}
