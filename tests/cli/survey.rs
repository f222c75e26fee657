//! A look over a library: what it says, and the profiles that it asks to fill in.

use super::Shop;
use serde_json::Value;

/// Three programs with two builder's codes, one call of a program that is missing, and a number that stands twice.
fn shop() -> Shop {
    Shop::with(&[
        ("lib/o1000.nc", "O1000\nG21 G90 G54 G17 G40 G80 G94\nM14 (CHUCK AIR)\nG0 X1.\nM30\n"),
        (
            "lib/o1001.nc",
            "O1001\nG21 G90 G54 G17 G40 G80 G94\nM14 (CHUCK AIR)\nM15\nG0 X1.\nM98 P2000\nM98 P9810\nM30\n",
        ),
        ("lib/o2000.nc", "O2000\nG0 X2.\nM99\n"),
        ("lib/old/o2000.nc", "O2000\nG0 X3.\nM99\n"),
        ("lib/o3000.nc", "O3000\nG21 G90 G54 G17 G40 G80 G94\nG0 X1.\nM30\n"),
    ])
}

fn json(shop: &Shop, line: &str) -> Value {
    let run = shop.run(line);
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_str(&run.out).unwrap()
}

#[test]
fn it_counts_what_stands_there() {
    let shop = shop();
    let survey = json(&shop, "survey lib --from fanuc --to haas --format json");
    let library = &survey["library"];
    assert_eq!((&library["files"], &library["programs"]), (&5.into(), &5.into()));
    let missing = &library["missing"][0];
    assert_eq!((&missing["name"], &missing["programs"]), (&"O9810".into(), &1.into()));
    assert_eq!(missing["places"][0], "o1001.nc:7");
    assert_eq!(library["twice"][0][0], "O2000");
    let codes: Vec<(&str, u64, u64)> = survey["codes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|code| {
            let number = |key: &str| code[key].as_u64().unwrap();
            (code["code"].as_str().unwrap(), number("programs"), number("frees"))
        })
        .collect();
    // O1001 has both codes, and calls a number that stands twice.
    assert_eq!(codes, [("M14", 2, 1), ("M15", 1, 0)]);
    assert_eq!(survey["codes"][0]["comment"], serde_json::json!(["CHUCK AIR", 2]));
    let refused = |key: &str| survey[key]["refused"].as_u64().unwrap();
    // What M14 alone stood in the way of comes through once it is answered; an ambiguous call does not.
    assert_eq!((refused("now"), refused("answered")), (2, 1));
    assert!(survey["stays"][0]["why"].as_str().unwrap().starts_with("MG0603 calls O2000"), "{survey}");
}

#[test]
fn without_a_target_only_its_own_control_is_asked() {
    let shop = shop();
    let run = shop.run("survey lib --from fanuc");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains("M14") && run.out.contains("(CHUCK AIR) stands beside it, 2 x"), "{}", run.out);
    assert!(!run.out.contains("answered"), "{}", run.out);
}

/// From the survey by two profiles to a converted program.
#[test]
fn what_is_filled_in_frees_programs() {
    let shop = shop();
    let survey = "survey lib/o1000.nc --from fanuc --to haas --write m1.toml";
    assert_eq!(shop.run(survey).code, 0);
    let asked = shop.read("m1.toml");
    let line = "\n#? M14 = { target = \"\", text = \"CHUCK AIR\" } # o1000.nc:3; as in: M14 (CHUCK AIR)\n";
    assert!(asked.contains("\n[codes]\n#: What the machine's builder made"), "{asked}");
    assert!(asked.contains(line), "{asked}");
    assert!(shop.read("m1-to-haas.toml").starts_with("dialect = \"haas\"\n"));
    // Without an answer the line is a fault at its own place.
    let unanswered = asked.replace("#? M14", "M14");
    shop.write("m1.toml", unanswered.as_bytes());
    let run = shop.run(survey);
    assert!(run.code == 2 && run.err.contains("'' is not a code"), "{}", run.err);
    shop.write("m1.toml", unanswered.replace("target = \"\"", "do = \"omit\"").as_bytes());
    let again = json(&shop, &format!("{survey} --format json"));
    assert_eq!((&again["codes"], &again["now"]["refused"]), (&serde_json::json!([]), &0.into()));
    let kept = shop.read("m1.toml");
    assert!(kept.contains("\nM14 = { do = \"omit\", text = ") && !kept.contains("#? M14"), "{kept}");
    assert_eq!(kept.matches("[codes]").count(), 1, "{kept}");
    let convert =
        "convert lib/o1000.nc --from fanuc --to haas --machine m1.toml --machine m1-to-haas.toml --out out";
    assert_eq!(shop.run(convert).code, 0);
}

/// Two machines of one control, as lathes of two systems of codes: each profile gets the questions about its machine.
#[test]
fn two_profiles_of_one_control_get_their_own_questions() {
    let lathe = |system: &str| {
        format!(
            "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"\naxes = [\"X\", \"Z\"]\ndecimal_point = \"calculator\"\n[settings]\ngcode_system = \"{system}\"\n"
        )
    };
    let program = "O1\nG50 S2000\nG96 S200 M3\nG0 X52. Z2.\nG97\nG0 X100.\nM99\n";
    let shop = Shop::with(&[("lib/a.nc", program), ("a.toml", &lathe("A")), ("b.toml", &lathe("B"))]);
    let run = shop.run("survey lib --from fanuc --to fanuc --machine a.toml --machine b.toml --write a.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    for profile in ["a.toml", "b.toml"] {
        let text = shop.read(profile);
        assert!(text.contains("#? \"speed.kept\" = "), "{profile}: {text}");
        assert!(text.contains("#? codes = "), "{profile}: {text}");
    }
}

/// Where holes end hangs on G98 and G99 in G code systems B and C, and a place beside an increment on the letters of the target.
#[test]
fn a_survey_asks_where_holes_end_and_for_the_letters_of_the_target() {
    let lathe = |system: &str| {
        format!(
            "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"\ndecimal_point = \"calculator\"\n[settings]\ngcode_system = \"{system}\"\n"
        )
    };
    let holes = "O1\nG90 G95 G54\nT0101\nG0 X0. Z5.\nG83 Z-20. R-3. F.1\nG80\nM30\n";
    let steps = "O2\nT0101\nG0 X#501 Z#500\nG1 X60. W-5. F.2\nM30\n";
    let shop = Shop::with(&[
        ("b/a.nc", holes),
        ("a/b.nc", steps),
        ("b.toml", &lathe("B")),
        ("a.toml", &lathe("A")),
        ("to.toml", &lathe("B")),
    ]);
    let run = shop.run("survey b --from fanuc --to haas --machine b.toml --write b.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    let text = shop.read("b.toml");
    assert!(text.lines().any(|line| line.starts_with("#? codes = ") && line.contains("G98|G99")), "{text}");
    let run = shop.run("survey a --from fanuc --to fanuc --machine a.toml --machine to.toml --write a.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    let text = shop.read("to.toml");
    assert!(text.contains("#? step_letters = \"yes\" or \"no\""), "{text}");
}

/// A damaged library may have any number of unknown codes and missing programs, and names that are markup elsewhere.
#[test]
fn a_damaged_library_is_told_of_in_time() {
    let calls: String =
        (1..2000).map(|n| format!("M98 P{n} (\"\\\u{7f}{n})\nG{}.{}\n", 500 + n % 400, n % 9)).collect();
    let shop = Shop::with(&[("lib/a.nc", &format!("O9000\n{calls}M99\nO9000\nM99\n"))]);
    let survey = json(&shop, "survey lib --from fanuc --to haas --write m.toml --format json");
    assert_eq!(survey["library"]["twice"], serde_json::json!([["O9000", ["a.nc", "a.nc"]]]));
    assert!(survey["library"]["missing"].as_array().unwrap().len() > 1500);
    let run = shop.run("survey lib --from fanuc --to haas --write m.toml");
    assert!(run.code == 0 && run.out.len() < 60_000, "{}", run.out.len());
}

#[test]
fn no_program_is_written_over() {
    let shop = shop();
    let run = shop.run("survey lib --from fanuc --write lib/o1000.nc");
    assert_eq!(run.code, 2);
    assert!(shop.read("lib/o1000.nc").starts_with("O1000\nG21"));
}

/// What programs begin in is one line of the profile, of the modes that they do not name themselves.
#[test]
fn what_programs_begin_in_is_asked_once() {
    let shop = Shop::with(&[
        ("lib/a.nc", "O1\nG21 G90 G17 G54\nG0 X1.\nG1 X2. F100.\nM98 P3\nM30\n"),
        ("lib/b.nc", "O2\nG21 G90 G17\nG1 X2. F100.\nM30\n"),
        ("lib/c.nc", "O3\nX3.\nM99\n"),
    ]);
    let survey = json(&shop, "survey lib --from fanuc --to haas --format json");
    let start = survey["start"].as_array().unwrap();
    let told: Vec<(&str, u64)> = start
        .iter()
        .map(|asked| (asked["what"].as_str().unwrap(), asked["programs"].as_u64().unwrap()))
        .collect();
    // O3 begins in what O1 sets; O1 names all but the feed mode, and O2 neither that nor the work offset.
    assert_eq!(told, [("feed a minute or a turn", 2), ("the work offset", 1)]);
    assert_eq!(start[0]["codes"], serde_json::json!(["G94", "G95"]));
    assert_eq!(start[1]["places"], serde_json::json!(["b.nc:1"]));
    let line = "survey lib --from fanuc --to haas --write m.toml";
    assert_eq!(shop.run(line).code, 0);
    let asked = shop.read("m.toml");
    assert!(asked.contains("[start]\n#: What is in force after a reset"), "{asked}");
    let choice = "#? codes = \"G94|G95 G54|G55|G56|G57|G58|G59\"\n";
    assert!(asked.contains(choice), "{asked}");
    // As it stands it is no answer.
    shop.write("m.toml", asked.replace("#? codes", "codes").as_bytes());
    assert_eq!(shop.run(line).code, 2);
    // One of two answered: the other one is still asked, and what was said stays.
    shop.write("m.toml", asked.replace(choice, "codes = \"G94\"\n").as_bytes());
    assert_eq!(shop.run(line).code, 0);
    let again = shop.read("m.toml");
    assert!(again.contains("\ncodes = \"G94\"\n"), "{again}");
    assert!(
        again.contains("#: Write these into codes too, one of each: G54|G55|G56|G57|G58|G59\n"),
        "{again}"
    );
    shop.write("m.toml", again.replace("\"G94\"", "\"G94 G54\"").as_bytes());
    assert_eq!(shop.run(line).code, 0);
    assert!(!shop.read("m.toml").contains("one of each"), "{}", shop.read("m.toml"));
}

/// At the head of a program that goes back there no code can stand: the target begins in the modes, or it is for review.
#[test]
fn what_the_target_must_begin_in_is_asked_of_its_profile() {
    let shop = Shop::with(&[("lib/a.nc", "O1\nG21 G90 G17 G54\nG0 X1.\nG1 X2. F100.\nM30\n")]);
    let line = "survey lib --from fanuc --to haas --write m.toml";
    let survey = json(&shop, &format!("{line} --format json"));
    assert_eq!(survey["start_of_target"], serde_json::json!([]));
    let shop = Shop::with(&[("lib/a.nc", "O1\nG21 G90 G17 G54\nG0 X1.\nG1 X2. F100.\nM99\n")]);
    assert_eq!(shop.run(line).code, 0);
    let choice = "#? codes = \"G94|G95\"\n";
    for machine in ["m.toml", "m-to-haas.toml"] {
        let asked = shop.read(machine);
        assert!(asked.contains(choice), "{machine}: {asked}");
    }
    let convert = "convert lib --machine m.toml --machine m-to-haas.toml --to haas --out out --format json";
    let outcome = |shop: &Shop| json(shop, convert)["programs"][0]["outcome"].clone();
    shop.write("m.toml", shop.read("m.toml").replace(choice, "codes = \"G94\"\n").as_bytes());
    assert_eq!(outcome(&shop), "review");
    let there = shop.read("m-to-haas.toml").replace(choice, "codes = \"G94\"\n");
    shop.write("m-to-haas.toml", there.as_bytes());
    assert_eq!(outcome(&shop), "converted");
}

/// A setting that a cycle takes its values from is a line of the profile, also if another one hides it at first.
#[test]
fn settings_that_cycles_wait_for_are_lines_of_the_profile() {
    let text = "%\nO5\nG20 G18 G40 G99 G54\nT303\nG97 S900 M3\nG0 X1.1 Z.1\nG76 X0.85 Z-0.9 K0.07 D0.017 F0.125\nG0 Z.1\nM30\n%\n";
    let shop = Shop::with(&[("lib/a.nc", text), ("h.toml", "dialect = \"haas\"\nmachine = \"lathe\"\n")]);
    let line = "survey lib --machine h.toml --to fanuc --write h.toml";
    let survey = json(&shop, &format!("{line} --format json"));
    let settings = survey["settings"].as_array().unwrap();
    let told: Vec<&str> = settings.iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert!(["86", "99"].iter().all(|name| told.contains(name)), "{survey}");
    assert!(settings.iter().all(|one| one["programs"] == 1 && one["places"][0] == "a.nc:7"), "{survey}");
    let asked = shop.read("h.toml");
    for name in &told {
        assert!(asked.contains(&format!("\n#? {name} = \"\" # ")), "{asked}");
    }
    assert_eq!((&survey["now"]["refused"], &survey["answered"]["refused"]), (&1.into(), &0.into()));
    let answered = asked.replace("#? 86 = \"\"", "86 = \"0.001\"").replace("#? 99 = \"\"", "99 = \"0.002\"");
    shop.write("h.toml", answered.replace("#? 95 = \"\"", "95 = \"1\"").as_bytes());
    assert_eq!(json(&shop, &format!("{line} --format json"))["now"]["refused"], 0);
}

/// What clamps the C axis for a hole, and what lets it go after it, is answered in the source's profile alone: no other question is left.
#[test]
fn what_clamps_an_axis_for_a_hole_is_asked_with_what_lets_it_go() {
    let text = "%\nO7\nG21 G98 G18 G54\nT0101\nG97 S900 M3\nG0 X30. Z5. C0.\nG83 Z-20. R-2. F100. M89\nC90. M89\nG80\nM30\n%\n";
    let source = "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"\ndecimal_point = \"calculator\"\naxes = [\"X\",\"Z\",\"C\"]\n[settings]\ngcode_system = \"A\"\n";
    let target = "dialect = \"haas\"\nmachine = \"lathe\"\nunits = \"metric\"\naxes = [\"X\",\"Z\",\"C\"]\n";
    let shop = Shop::with(&[("lib/a.nc", text), ("a.toml", source), ("h.toml", target)]);
    let machines = "--from fanuc --to haas --machine a.toml --machine h.toml";
    let survey = json(&shop, &format!("survey lib {machines} --write a.toml --format json"));
    assert_eq!(
        (&survey["now"]["refused"], &survey["answered"]["refused"]),
        (&1.into(), &0.into()),
        "{survey}"
    );
    let asked = shop.read("a.toml");
    let line = "\n#? \"M89, M90\" = { target = \", \" } # a.nc:7, a.nc:8; as in: ";
    assert!(asked.contains(line) && asked.contains("; a.nc:7, a.nc:8; goes with: "), "{asked}");
    let site = |code: &str, target: &str| {
        format!("[[site]]\ncode = \"{code}\"\ntext = \"clamp\"\ntarget = \"{target}\"\n")
    };
    let answered =
        format!("{source}[parameters]\n5110 = \"89\"\n{}{}", site("M89", "M14"), site("M90", "M15"));
    shop.write("a.toml", answered.as_bytes());
    let run = shop.run(&format!("convert lib {machines} --out out"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let made = shop.read("out/a.nc");
    let at = |code: &str| made.find(&format!("\n{code}\n")).unwrap_or_else(|| panic!("{code}: {made}"));
    assert!(at("M14") < at("M15"), "{made}");
}

/// What a number without a decimal point counts is a key of its own, not something to confirm.
#[test]
fn the_decimal_point_is_a_line_of_the_profile() {
    let shop = Shop::with(&[("lib/a.nc", "O1\nG21 G90 G17 G54 G94\nG0 X10\nM30\n")]);
    assert_eq!(shop.run("survey lib --from fanuc --to haas --write m.toml").code, 0);
    let asked = shop.read("m.toml");
    assert!(asked.contains("\n#? decimal_point = \"calculator\" or \"increments\" # "), "{asked}");
    assert!(!asked.contains("\"numbers\""), "{asked}");
    shop.write("m.toml", asked.replace("#? decimal_point = \"calculator\" or", "decimal_point =").as_bytes());
    assert_eq!(shop.run("survey lib --from fanuc --to haas --write m.toml").code, 0);
    assert!(!shop.read("m.toml").contains("#? decimal_point"));
}

/// Of a cycle that only this family of controls has, the profile says what becomes of it elsewhere.
#[test]
fn a_cycle_of_the_maker_alone_may_be_left_out() {
    let shop = Shop::with(&[
        ("lib/a.nc", "%\nO1\nG20 G90 G17 G54 G94\nG0 X1. Y1.\nG47 P0 (PART 7)\nG0 X2.\nM30\n%\n"),
        (
            "h.toml",
            "dialect = \"haas\"\n[[site]]\ncode = \"G47\"\ntext = \"engraves\"\nwords = { P = \"kind\" }\ndo = \"omit\"\n",
        ),
    ]);
    let run = shop.run("convert lib/a.nc --machine h.toml --to fanuc --out out");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let made = shop.read("out/a.nc");
    assert!(!made.contains("G47") && made.contains("X2."), "{made}");
    assert!(run.out.contains("engraves") || run.err.contains("engraves"), "{}{}", run.out, run.err);
}

/// What a lathe of another G code system begins in is asked in its codes, and either answer may come first.
#[test]
fn the_code_system_and_what_is_in_force_are_answered_in_any_order() {
    let text = "O1\nT0101\nG97 S500 M3\nG0 X60. Z2.\nG77 X50. Z-20. F.2\nX46.\nG0 Z5.\nM30\n";
    let shop = Shop::with(&[("lib/a.nc", text)]);
    let line = "survey lib --from fanuc --to haas --write m.toml";
    assert_eq!(shop.run(line).code, 0);
    let asked = shop.read("m.toml");
    // By facts/fanuc-lathe.md 1.
    assert!(asked.contains("#: Answer gcode_system first"), "{asked}");
    assert!(asked.contains("#? units = \"inch\" or \"metric\"") && !asked.contains("G70"), "{asked}");
    assert_eq!(asked.matches("#? codes = ").count(), 1, "{asked}");
    assert!(asked.contains("#: feed a minute or a turn: one of G94, G95 in B and C ("), "{asked}");
    assert!(asked.contains("#: absolute or incremental: one of G90, G91 in B and C ("), "{asked}");
    let begins = "[start]\ncodes = \"G21 G18 G95 G90 G54 G0\"\n";
    let kind = "dialect = \"fanuc\"\nmachine = \"lathe\"\naxes = [\"X\", \"Z\"]\n";
    let told = |profile: String, wanted: &[&str]| {
        shop.write("s.toml", profile.as_bytes());
        let run = shop.run("convert lib --machine s.toml --to haas --out out");
        assert_eq!(run.code, 2, "{}", run.out);
        assert!(wanted.iter().all(|wanted| run.err.contains(wanted)), "{}", run.err);
    };
    let system = "write gcode_system = \"B\" under [settings]";
    told(format!("{kind}{begins}"), &["G code system A is taken", system]);
    // A mill has G95 too, and no G99 that programs begin in.
    let of_a = "[start]\ncodes = \"G21 G18 G99 G54 G0\"\n";
    told(
        format!("dialect = \"fanuc\"\n{of_a}"),
        &["a mill is taken", "write machine = \"lathe\"", "gcode_system = \"A\""],
    );
    let settings = |system: &str| format!("[settings]\ngcode_system = \"{system}\"\n");
    told(format!("{kind}{}{begins}", settings("C")), &["gcode_system is \"C\"", system]);
    shop.write("s.toml", format!("{kind}{}{begins}", settings("B")).as_bytes());
    let run = shop.run("survey lib --machine s.toml --to haas");
    assert!(run.code == 0 && !run.out.contains("take from the machine"), "{}{}", run.out, run.err);
}

/// The words of a builder's code are asked with it, and what the line says is an answer.
#[test]
fn a_builders_code_is_asked_with_its_words() {
    let shop = Shop::with(&[
        ("lib/a.nc", "O1\nG21 G90 G17 G54 G94\nM200 P11\nG190 A1. Q2.\nG1 X1. F100.\nM30\n"),
        ("lib/b.nc", "O2\nG21 G90 G17 G54 G94\nG1 X5. F100. M201 P3\nM30\n"),
    ]);
    assert_eq!(shop.run("survey lib --from fanuc --to haas --write m.toml").code, 0);
    let asked = shop.read("m.toml");
    assert!(asked.contains("\n#? M200 = { target = \"\", words = { P = \"P\" } } # "), "{asked}");
    assert!(asked.contains("\n#? G190 = { target = \"\", words = { A = \"A\", Q = \"Q\" } } # "), "{asked}");
    // Beside a place it may be the word of another code.
    assert_eq!(asked.matches(", words = ").count(), 2, "{asked}");
    // A line that is left out needs no text.
    let answered = asked.replace("#? M2", "M2").replace("#? G190", "G190");
    let answered = answered.replace("target = \"\"", "do = \"omit\"");
    let unit = "units = \"metric\"\ndecimal_point = \"calculator\"\n";
    shop.write("m.toml", answered.replacen('\n', &format!("\n{unit}"), 1).as_bytes());
    let run = shop.run("convert lib/a.nc --machine m.toml --to haas --out out");
    assert!(run.out.contains(" 0 refused"), "{}{}", run.out, run.err);
    assert_eq!(run.out.matches("is left out").count(), 2, "{}", run.out);
}

/// A word of the builder that says which spindle a code turns is asked with that code, and words that a profile lacks at its codes are asked there;
/// once that is answered the program is free.
#[test]
fn words_beside_codes_of_the_spindle_are_asked_once() {
    let text = "O1\nG97S800M3P11\nM213 P2.\nM213 P3.\nG0 X50. Z2.\nM5 P11\nM30\n";
    let shop = Shop::with(&[("lib/a.nc", text)]);
    let head = |dialect: &str, code: &str| {
        let start = "[start]\ncodes = \"G21 G18 G99 G54 G0\"\n";
        let system = if dialect == "fanuc" { "[settings]\ngcode_system = \"A\"\n" } else { "" };
        format!(
            "dialect = \"{dialect}\"\nmachine = \"lathe\"\nunits = \"metric\"\ndecimal_point = \"calculator\"\n{start}{system}[[site]]\ncode = \
             \"{code}\"\ntext = \"a\"\nname = \"level\"\n"
        )
        .replace(if dialect == "haas" { "decimal_point = \"calculator\"\n" } else { "\u{0}" }, "")
    };
    shop.write("f.toml", head("fanuc", "M213").as_bytes());
    shop.write("h.toml", head("haas", "M513").as_bytes());
    let survey = "survey lib --machine f.toml --machine h.toml --to haas --write f.toml";
    for _ in 0..2 {
        let run = shop.run(survey);
        assert_eq!(run.code, 0, "{}{}", run.out, run.err);
        let (ours, theirs) = (shop.read("f.toml"), shop.read("h.toml"));
        for line in
            ["#? \"M3 P11\" = { op = \"spindle.cw\" } # ", "#? \"M5 P11\" = { op = \"spindle.stop\" } # "]
        {
            assert_eq!(ours.matches(line).count(), 1, "{line}{ours}");
        }
        for text in [&ours, &theirs] {
            assert_eq!(text.matches("#? words = { P = \"P\" } # ").count(), 1, "{text}");
        }
    }
    for (name, path) in [("f.toml", shop.read("f.toml")), ("h.toml", shop.read("h.toml"))] {
        let text = path.replace("#? \"M", "\"M").replace("#? words", "words");
        shop.write(name, text.as_bytes());
    }
    let run = shop.run("convert lib/a.nc --machine f.toml --machine h.toml --to haas --out out");
    assert!(run.out.contains(" 0 refused"), "{}{}", run.out, run.err);
    assert!(shop.read("out/a.nc").contains("M513 P2\n"), "{}", shop.read("out/a.nc"));
}

#[test]
fn how_a_haas_calculates_is_asked_if_fractions_are_compared() {
    let counts = "O1000\nG21 G90 G54 G17 G40 G80 G94 G0\n#1=0\nWHILE[#1LT5]DO1\n#1=#1+1\nEND1\nM30\n";
    let steps = "O1001\nG21 G90 G54 G17 G40 G80 G94 G0\n#1=0\nWHILE[#1LT5]DO1\n#1=#1+#2\nEND1\nM30\n";
    let asks = |text: &str, shop: Shop| {
        let run = shop.run("survey lib --from haas --to fanuc");
        assert_eq!(run.code, 0, "{}", run.err);
        assert_eq!(run.out.contains("arithmetic = \"single\" or \"double\""), text == steps, "{}", run.out);
    };
    for text in [counts, steps] {
        asks(text, Shop::with(&[("lib/o1000.nc", text)]));
    }
    // Once it is said, it is not asked again.
    let said = "dialect = \"haas\"\n[settings]\narithmetic = \"double\"\n";
    let shop = Shop::with(&[("lib/o1001.nc", steps), ("h.toml", said)]);
    let run = shop.run("survey lib --machine h.toml --to fanuc");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(!run.out.contains("arithmetic"), "{}", run.out);
}

/// The offset numbers of G10 are in the table of each kind of memory but one.
#[test]
fn a_fact_of_another_setting_may_be_confirmed() {
    let said = "dialect = \"fanuc\"\nconfirm = [\"code:G10 L12\"]\n[settings]\noffset_memory = \"A\"\n";
    let shop = Shop::with(&[("lib/o1000.nc", "O1000\nG21 G90 G54\nM30\n"), ("f.toml", said)]);
    let run = shop.run("survey lib --machine f.toml --to haas");
    assert_eq!(run.code, 0, "{}", run.err);
}

/// B-63943EN-1/02 p. 1654: G49 of a Fanuc with 5006.6 of 0 moves Z by the length that was in force, and that of a Haas moves nothing.
#[test]
fn a_length_that_is_cancelled_at_the_head_is_asked_of_the_machine_whose_code_moves() {
    let shop = Shop::with(&[
        ("lib/o1.nc", "O1\nG20 G90 G17 G40 G49 G80 G94 G54\nG0 X1. Y1.\nM30\n"),
        ("lib/o2.nc", "O2\nG20 G90 G17 G40 G80 G94 G54\nG43 H1 Z1.\nG0 X1. Y1.\nG49\nM30\n"),
        ("haas.toml", "dialect = \"haas\"\nunits = \"inch\"\nconfirm = [\"behaviour:length.moves\"]\n"),
        ("fanuc.toml", "dialect = \"fanuc\"\nunits = \"inch\"\n\n[parameters]\n\"5006.6\" = \"0\"\n"),
    ]);
    let machines = "--from haas --to fanuc --machine haas.toml --machine fanuc.toml";
    let convert = format!("convert lib/o1.nc {machines} --out out");
    let run = shop.run(&convert);
    assert!(
        run.out.contains("1 for review") && run.out.contains("write codes = \"G49\" under [start]"),
        "{}",
        run.out
    );
    // Of the two programs one names a length before it cancels it.
    let run = shop.run(&format!("survey lib {machines} --write fanuc.toml"));
    assert!(
        run.out.contains("no tool length in force, for this code moves its axis (G49) 1 program: o1.nc:1"),
        "{}",
        run.out
    );
    let asked = shop.read("fanuc.toml");
    assert!(asked.contains("#? codes = \"G49\""), "{asked}");
    shop.write("fanuc.toml", asked.replace("#? codes", "codes").as_bytes());
    let run = shop.run(&convert);
    assert!(run.out.contains("1 converted"), "{}", run.out);
    let run = shop.run(&format!("survey lib {machines}"));
    assert!(!run.out.contains("no tool length in force"), "{}", run.out);
}

/// facts/fadal.md 6: P of G83 is how far over the last depth each peck begins; a Haas has it as a setting.
#[test]
fn a_clearance_of_pecks_is_asked_of_the_target_with_what_it_must_be() {
    let shop = Shop::with(&[
        (
            "lib/o3.nc",
            "N1 O3\nN2 G21 G90 G17 G40 G80 G94 E1\nN3 G0 X0 Y0 Z20.\nN4 G98 G83 X5. Y5. R0+2. Z-12. Q3. P0.5 F100.\nN5 G80\nN6 M2\n",
        ),
        ("fadal.toml", "dialect = \"fadal\"\nunits = \"metric\"\n"),
        ("haas.toml", "dialect = \"haas\"\nunits = \"metric\"\n"),
    ]);
    let machines = "--from fadal --to haas --machine fadal.toml --machine haas.toml";
    let run = shop.run(&format!("survey lib {machines} --write fadal.toml"));
    assert_eq!(run.code, 0, "{}", run.err);
    let asked = shop.read("haas.toml");
    assert!(asked.contains("#? \"cycle.peck.clearance\" = \"0.5\" # how far over the last depth"), "{asked}");
    shop.write("haas.toml", asked.replace("#? \"cycle", "\"cycle").as_bytes());
    let run = shop.run(&format!("convert lib {machines} --out out"));
    assert!(run.out.contains("1 converted"), "{}", run.out);
    shop.write("haas.toml", shop.read("haas.toml").replace("0.5", "1").as_bytes());
    let run = shop.run(&format!("convert lib {machines} --out out"));
    assert!(
        run.out.contains("P beside G83 of the source") && run.out.contains("\"cycle.peck.clearance\" = 0.5"),
        "{}",
        run.out
    );
}

/// No source says how many digits a number of a CC100 may have: a shop tries it, so that nothing is refused for its answer.
#[test]
fn a_limit_that_a_shop_tries_refuses_nothing_in_the_outlook() {
    let text = "%\nN1 O1\nN2 G90 G40 G80 G0\nN3 X123.4567 Y0 E1\nN4 G1 X1. F20.\nN5 M2\n%\n";
    let shop = Shop::with(&[("lib/a.nc", text)]);
    let survey = json(&shop, "survey lib --from fadal --to cc100 --format json");
    assert_eq!((&survey["now"]["refused"], &survey["answered"]["refused"]), (&0.into(), &0.into()));
    assert!(survey.to_string().contains("limit:number.digits"), "{survey}");
}

#[test]
fn the_unit_is_asked_once_and_a_setting_by_its_name() {
    let shop = Shop::with(&[(
        "lib/o1.nc",
        "O1\nG90 G54 G17 G94 G0 Z5.\nG52 X5. Y5.\nG1 X1. F100.\nG52 X0 Y0\nM30\n",
    )]);
    let line = "survey lib --from haas --to fanuc";
    let run = shop.run(line);
    assert_eq!(run.out.matches("units = \"inch\" or \"metric\"").count(), 1, "{}", run.out);
    assert!(!run.out.contains("G20, G21") && !run.out.contains("MG0205:"), "{}", run.out);
    // Setting 33 says what G52 means there, so it is what the profile states.
    assert!(run.out.contains("# 33 = \"fanuc\" or \"haas\" or \"yasnac\""), "{}", run.out);
    assert!(!run.out.contains("\"code:G52\""), "{}", run.out);
    shop.run(&format!("{line} --write m.toml"));
    let profile = shop.read("m.toml");
    let units = "#? units = \"inch\" or \"metric\" # what its programs are in where no code says so, and its settings (o1.nc:1)\n";
    assert!(profile.contains(units) && !profile.contains("G20|G21"), "{profile}");
    // Answers to both leave nothing to ask of the source.
    let units = profile.replace(units, "units = \"metric\"\n");
    let said = units.replace("#? 33 = \"fanuc\" or \"haas\" or \"yasnac\"", "33 = \"haas\"");
    shop.write("m.toml", said.as_bytes());
    let again = shop.run("survey lib --machine m.toml --to fanuc");
    assert!(!again.out.contains("units =") && !again.out.contains("for the Haas"), "{}", again.out);
}

#[test]
fn what_variables_hold_after_power_on_is_asked_once_of_the_shop() {
    let shop = Shop::with(&[
        ("lib/a.nc", "O1\nG21 G90 G54 G17 G94 G0 Z5.\nG0 X#100\nM30\n"),
        ("lib/b.nc", "O2\nG21 G90 G54 G17 G94 G0 Z5.\nG0 X#110\nM30\n"),
        ("none.toml", "dialect = \"fanuc\"\n[behaviours]\n\"power.off.values\" = \"unused\"\n"),
        ("some.toml", "dialect = \"fanuc\"\n[behaviours]\n\"power.off.values\" = \"used\"\n"),
    ]);
    let counts = |run: &str, count: &str| assert!(run.contains(count), "{run}");
    let asked = shop.run("convert lib --from fanuc --to haas --out out --no-verify").out;
    counts(&asked, "2 converted, 0 for review, 0 refused");
    counts(&asked, "# \"power.off.values\" = \"used\" or \"unused\" # #100, #110 are vacant after power-on");
    // Nobody needs them: nothing is asked. Somebody does: each program that reads one before it writes it is for review.
    let none = shop.run("convert lib --machine none.toml --to haas --out out2 --no-verify").out;
    assert!(none.contains("2 converted, 0 for review") && !none.contains("MG0404"), "{none}");
    let some = shop.run("convert lib --machine some.toml --to haas --out out3 --no-verify").out;
    counts(&some, "0 converted, 2 for review, 0 refused");
    counts(&some, "  #110 is vacant after power-on");
}

/// A tool word that changes nothing for the tool in the spindle brings its length again after a return.
#[test]
fn what_a_tool_word_does_again_is_asked_where_a_length_waits_for_it() {
    let shop = Shop::with(&[(
        "lib/a.nc",
        "O1\nG21 G90 G54 G17 G94 G80 G40 G0\nT1 M6\nG43 H1 Z50.\nG28 Z0\nG43 H1 Z40.\nM30\n",
    )]);
    let line = "survey lib --from fanuc --to cc100";
    let run = shop.run(line);
    assert!(run.out.contains("[settings] tool_again = \"changes\" or \"skipped\""), "{}", run.out);
    assert!(run.out.contains("answered  1 converted, 0 for review, 0 refused"), "{}", run.out);
    shop.write("t.toml", b"dialect = \"cc100\"\nunits = \"metric\"\n[settings]\ntool_again = \"skipped\"\n");
    let run = shop.run("convert lib --from fanuc --machine t.toml --to cc100 --out out --no-verify");
    assert!(run.out.contains("0 refused"), "{}", run.out);
    assert!(shop.read("out/a.nc").contains("T01\nN"), "{}", shop.read("out/a.nc"));
}

/// A parameter of the control may let the code call a program of the library: as a code of the target it would be another one.
#[test]
fn a_code_that_may_call_a_program_of_the_library_is_asked_for_it() {
    let main = "O1\nG21 G90 G54 G17 G40 G80 G94\nG0 B0.\nG100 X1.\nM86 T2\nM51\nG0 X1.\nM30\n";
    let shop = Shop::with(&[
        ("lib/o1.nc", main),
        ("lib/o9010.nc", "O9010(ROW)\nG0 X#24\nM99\n"),
        ("lib/o9021.nc", "O9021(CHECK)\n(PARAM 6081 = 86)\n#500=#20\nM99\n"),
        ("lib/o9025.nc", "O9025(OTHER)\n#501=#20\nM99\n"),
        ("s.toml", "dialect = \"fanuc\"\nmachine = \"mill\"\n"),
        ("t.toml", "dialect = \"haas\"\nmachine = \"mill\"\n"),
    ]);
    shop.run("survey lib --from fanuc --to haas --machine s.toml --machine t.toml --write s.toml");
    let asked = shop.read("s.toml");
    for line in [
        "#? G100 = { calls = 9010, arguments = true } # o1.nc:4; as in: G100 X1.; it calls O9010 if parameter 6050 is 100; else \
         target = '' in place of calls",
        "#: \"parameter.6081=86\": comments of O9021 say that M86 calls it (o1.nc:5)",
        "#? \"parameter.6081=86\",",
        "#? M51 = { target = \"\" } # o1.nc:6; as in: M51; or calls = 9025, arguments = true in place of target: it calls O9025 \
         if parameter 6085 is 51",
        "#? axes = [\"X\", \"Y\", \"Z\", \"B\"] # in the order of the control's axis numbers",
    ] {
        assert!(asked.lines().any(|found| found == line), "{line} in {asked}");
    }
    let line = "#? axes = [\"X\", \"Y\", \"Z\", \"B\"] # those that the machine has";
    assert!(shop.read("t.toml").contains(line), "{}", shop.read("t.toml"));
    // A parameter that is stated asks nothing of its program.
    let stated = "dialect = \"fanuc\"\nmachine = \"mill\"\n[parameters]\n6050 = 0\n6081 = 86\n";
    shop.write("s.toml", stated.as_bytes());
    shop.run("survey lib --from fanuc --to haas --machine s.toml --machine t.toml --write s.toml");
    let asked = shop.read("s.toml");
    assert!(asked.contains("#? G100 = { target = \"\"") && !asked.contains("M86 ="), "{asked}");
}

/// That the turret turns beside a move only a run shows.
#[test]
fn what_only_a_run_shows_is_asked_in_the_first_round() {
    let shaft =
        "O1\nG21 G40 G99\nT0101\nG97 S500 M3\nG0 X50. Z2.\nG1 Z-20. F.2\nG0 X60. Z5. T0202\nG28 U0 W0\nM30\n";
    let shop = Shop::with(&[("lib/shaft.nc", shaft)]);
    let run = shop.run("survey lib --from fanuc --to haas --write m.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    for profile in ["m.toml", "m-to-haas.toml"] {
        let text = shop.read(profile);
        let asks = |fact: &str| text.contains(&format!("#: \"machine:lathe.{fact}\""));
        assert!(asks("tool.beside.move"), "{profile}: {text}");
    }
}
