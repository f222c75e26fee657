//! Lathes: how a library is known to be one's, and what is said of it.

use super::{Shop, repository, unmarked};

const SHAFT: &str =
    "O1\n(SHAFT)\nT0101\nG21 G97 S500 M3\nG0 X50. Z2.\nG1 G99 Z-20. F.2\nM98 P2\nG28 U0 W0\nM30\n";
const CUT: &str = "O2\nG1 X40. F.1\nM99\n";
const PLATE: &str = "O11\nG21 G17 G90 G40 G80 G94 G54\nT1 M6\nG0 X0. Y0.\nG43 H1 Z5.\nM30\n";
const SAID: &str =
    "no profile says the kind of machine: it is taken as a lathe, because of T0101 in shaft.nc:3.";

fn turning() -> Shop {
    Shop::with(&[("lib/shaft.nc", SHAFT), ("lib/cut.nc", CUT)])
}

/// The sign stands in one program; the other one has none, and is the same machine's.
#[test]
fn a_library_without_a_profile_is_known_by_its_programs() {
    let shop = turning();
    let run = shop.run("convert lib --from fanuc --to haas --out out --no-verify --format json");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert_eq!(run.err.matches(SAID).count(), 1, "{}", run.err);
    assert!(
        run.err.contains("machine = \"lathe\"") && run.err.contains("gcode_system = \"A\""),
        "{}",
        run.err
    );
    assert!(run.out.contains("it is taken as a lathe"), "the report has it too: {}", run.out);
    // G99 is a feed a turn, on either lathe; read as a mill's it would be a return to R.
    let text = unmarked(&shop.read("out/shaft.nc"));
    assert!(text.contains("T0101\n") && text.contains("G99") && text.contains("F0.2"), "{text}");
    // Where the profile says it, nothing is taken.
    shop.write("m.toml", b"dialect = \"fanuc\"\nmachine = \"lathe\"\n");
    let told = shop.run("convert lib --from fanuc --to haas --machine m.toml --out told --no-verify");
    assert!(told.code == 0 && !told.err.contains("taken as a lathe"), "{}", told.err);
    assert_eq!(shop.read("told/shaft.nc"), shop.read("out/shaft.nc"));
}

#[test]
fn it_is_said_once_however_many_machines_it_goes_to() {
    let shop = turning();
    let project = "[machines.old]\ndialect = \"fanuc\"\n[machines.one]\ndialect = \"haas\"\n[machines.two]\ndialect = \
                   \"haas\"\n[libraries.shop]\npath = \"lib\"\nmachine = \"old\"\n[libraries.shop.targets]\none = \
                   \"a\"\ntwo = \"b\"\n";
    shop.write("macroglot.toml", project.as_bytes());
    let run = shop.run("convert --no-verify --quiet");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert_eq!(run.err.matches(SAID).count(), 1, "{}", run.err);
    let checked = shop.run("check --no-cache --only read");
    assert_eq!(checked.err.matches(SAID).count(), 1, "{}", checked.err);
}

#[test]
fn a_library_of_two_machines_is_not_guessed() {
    let shop = turning();
    shop.write("lib/plate.nc", PLATE.as_bytes());
    let run = shop.run("convert lib --from fanuc --to haas --out out --no-verify --verbose");
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(!run.err.contains("taken as a lathe"), "{}", run.err);
    assert!(run.out.contains("MG0349") && run.out.contains("`only` and `except`"), "{}", run.out);
    let files = shop.files();
    assert!(files.contains_key("out/plate.nc") && !files.contains_key("out/shaft.nc"));
    // As two libraries both are converted.
    let project = "[machines.old]\ndialect = \"fanuc\"\n[machines.mill]\ndialect = \"haas\"\n[machines.lathe]\ndialect = \
                   \"haas\"\n[libraries.milling]\npath = \"lib\"\nonly = [\"plate.nc\"]\nmachine = \
                   \"old\"\n[libraries.milling.targets]\nmill = \"m\"\n[libraries.turning]\npath = \"lib\"\nexcept = \
                   [\"plate.nc\"]\nmachine = \"old\"\n[libraries.turning.targets]\nlathe = \"t\"\n";
    shop.write("macroglot.toml", project.as_bytes());
    let run = shop.run("convert --no-verify --quiet");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert_eq!(run.err.matches(SAID).count(), 1, "{}", run.err);
    let files = shop.files();
    assert!(
        files.contains_key("m/plate.nc")
            && files.contains_key("t/shaft.nc")
            && files.contains_key("t/cut.nc")
    );
    assert!(!files.contains_key("m/shaft.nc") && !files.contains_key("t/plate.nc"));
}

/// G95 is no code of system A: no program of its library is read by that, not even one that has no such code.
#[test]
fn another_code_system_is_asked_for_by_its_key() {
    let shop = turning();
    shop.write("lib/face.nc", b"O3\nT0202\nG21 G95 G90\nG1 X0. F.2\nM30\n");
    let run = shop.run("convert lib --from fanuc --to haas --out out --no-verify --verbose");
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.out.contains("3 refused"), "{}", run.out);
    assert!(run.out.contains("MG0356") && run.out.contains("gcode_system = \"B\" or \"C\""), "{}", run.out);
    shop.write("m.toml", b"dialect = \"fanuc\"\n[settings]\ngcode_system = \"B\"\n");
    let told = shop.run("convert lib/face.nc --from fanuc --to haas --machine m.toml --no-verify");
    assert!(told.code == 0 && told.out.contains("G99"), "{}{}", told.out, told.err);
}

/// What the survey takes is a line to fill in: nothing is decided for the shop.
#[test]
fn a_survey_says_it_and_asks() {
    let shop = turning();
    let run = shop.run("survey lib --from fanuc --to haas --write m.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(run.out.contains(&format!("machine   {SAID}")), "{}", run.out);
    let (source, target) = (shop.read("m.toml"), shop.read("m-to-haas.toml"));
    let kind = "\nmachine = \"lathe\" # or \"mill\": T0101 in shaft.nc:3\n";
    assert!(source.contains(kind), "{source}");
    // U and W are increments in one G code system alone.
    assert!(!source.contains("gcode_system"), "{source}");
    assert!(target.contains("\nmachine = \"lathe\" # as the programs are a lathe's\n"), "{target}");
    // All of its axes every lathe has.
    assert!(!source.contains("axes") && !source.contains("title"), "{source}");
    // Answered, it is not asked again.
    let again = shop.run("survey lib --from fanuc --to haas --write m.toml");
    assert!(again.code == 0 && !again.out.contains("taken as"), "{}{}", again.out, again.err);
    // Where nothing shows the system, it is asked, until the profile says it.
    shop.write("lib/shaft.nc", SHAFT.replace("G28 U0 W0\n", "").as_bytes());
    shop.run("survey lib --from fanuc --to haas --write n.toml");
    shop.run("survey lib --from fanuc --to haas --write n.toml");
    let asked = shop.read("n.toml");
    assert!(asked.contains("#? gcode_system = \"A\" # or \"B\" or \"C\": "), "{asked}");
}

/// Y that a lathe's programs move is an axis of it, and C; on a face Y is what C makes.
#[test]
fn a_survey_names_the_axes_that_programs_move() {
    let milled = "O5\nT0101\nG0 X50. Z5. C0.\nG112\nG17\nG1 X20. Y5. F100.\nY0.\nG113\nG18\nM30\n";
    let shop = Shop::with(&[("lib/face.nc", milled)]);
    let run = shop.run("survey lib --from haas --to fanuc --write m.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(shop.read("m.toml").contains("#? axes = [\"X\", \"Z\", \"C\"] # in"), "{}", shop.read("m.toml"));
    let shop = Shop::with(&[("lib/flat.nc", "O6\nT0101\nG53 Y0.\nG0 X50. Z5. C0.\nG1 Y3. F50.\nM30\n")]);
    let run = shop.run("survey lib --from haas --to fanuc --write m.toml");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        shop.read("m.toml").contains("#? axes = [\"X\", \"Z\", \"Y\", \"C\"] # in"),
        "{}",
        shop.read("m.toml")
    );
}

/// The seminar's lathe programs, on the machines that ship: M910 calls O9020, and #5002 is Z.
#[test]
fn the_profiles_that_ship_are_lathes() {
    let shop = Shop::with(&[(
        "a.nc",
        "O1\nT0101\nG0 X20. Z5.\nM910 A68. B3. S500 T14 Y1. D20. F.1 X0.\n#1=#5002\nG0 Z[#1+1.]\nM30\n",
    )]);
    let from = repository("machines/fanuc-0i-t.toml");
    let to = repository("machines/haas-st.toml");
    let run =
        shop.run(&format!("convert a.nc --from fanuc --to haas --machine {from} --machine {to} --no-verify"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.out.contains("P9020") && run.out.contains("T0101"), "{}", run.out);
}

/// The chip conveyor of the Haas that ships is left out for a lathe without one, which is told once.
#[test]
fn the_chip_conveyor_of_the_haas_that_ships_is_no_question_of_a_program() {
    let shop = Shop::with(&[("a.nc", "O1\nG20 G99 T0101\nM31\nG0 X2. Z.1\nM33\nM30\n")]);
    let from = repository("machines/haas-st.toml");
    let to = repository("machines/fanuc-0i-t.toml");
    let run = shop.run(&format!(
        "convert a.nc --from haas --to fanuc --machine {from} --machine {to} --out out --no-verify"
    ));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.out.contains("M31 (chip conveyor forward) is left out"), "{}", run.out);
    let made = shop.read("out/a.nc");
    assert!(!made.contains("M31") && !made.contains("M33") && made.contains("G0 X2. Z0.1"), "{made}");
}

/// Four holes on a face with the codes of a builder, by the pair of profiles that ships: the same names, other numbers.
#[test]
fn the_profiles_of_live_tools_that_ship_are_a_pair() {
    let shop = Shop::with(&[(
        "a.nc",
        "O1\nT0909\nM76\nG28 H0\nG98\nM70 S2000\nG0 X2. Z.2 C0.\nM73\nG83 Z-.8 R-.1 Q2000 F10.\nG80\nM74\nC90.\nM73\nG83 Z-.8 R-.1 F10.\nG80\n\
         M74\nM72\nM75\nG0 X8. Z4.\nM30\n",
    )]);
    let from = repository("machines/fanuc-live-tools.toml");
    let to = repository("machines/haas-st-live-tools.toml");
    let run =
        shop.run(&format!("convert a.nc --from fanuc --to haas --machine {from} --machine {to} --out out"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let made = shop.read("out/a.nc");
    let made: Vec<&str> = made.lines().filter(|line| !line.contains("MACROGLOT")).collect();
    assert_eq!(
        made.join("\n"),
        "O0001\nT0909\nM154\nG28 H0.\nG98\nM133 P2000\nG0 X2. Z0.2 C0.\nM14\nG83 Z-0.8 R0.1 Q0.2 F10.\nG80\nM15\nC90.\nM14\nG81 Z-0.8 R0.1 F10.\nG80\n\
         M15\nM135\nM155\nG0 X8. Z4.\nM30",
    );
}

/// D beside G71 is a word of the older form in one block: the refusal and the survey name the parameter that says so, and answered it
/// is read.
#[test]
fn a_word_of_the_older_form_asks_for_its_parameter() {
    let shop = Shop::with(&[
        (
            "lib/a.nc",
            "O1\nG20 G99 T0101\nG0 X2.5 Z.1\nG71 P10 Q20 U.02 W.004 D800 F.01\nN10 G0 X1.\nG1 Z-.4\nN20 X2.4\nM30\n",
        ),
        (
            "fanuc.toml",
            "dialect = \"fanuc\"\nmachine = \"lathe\"\ndecimal_point = \"calculator\"\n[settings]\ngcode_system = \"A\"\n",
        ),
        (
            "answered.toml",
            "extends = \"fanuc.toml\"\ndialect = \"fanuc\"\n[parameters]\n\"0001.1\" = 1\n5133 = 0.02\n",
        ),
        ("haas.toml", "dialect = \"haas\"\nmachine = \"lathe\"\n[settings]\n73 = 0.02\n"),
    ]);
    let line = |profile: &str| {
        format!(
            "convert lib --from fanuc --to haas --machine {profile} --machine haas.toml --out out --no-verify"
        )
    };
    let run = shop.run(&line("fanuc.toml"));
    assert_eq!(run.code, 1, "{}{}", run.out, run.err);
    assert!(run.out.contains("D has no meaning beside G71 P"), "{}", run.out);
    assert!(run.out.contains("under [parameters]: \"0001.1\" = \"1\""), "{}", run.out);
    let run = shop.run("survey lib --from fanuc --to haas --machine fanuc.toml --write fanuc.toml");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(shop.read("fanuc.toml").contains("#? 0001.1 = \"0\" or \"1\""), "{}", shop.read("fanuc.toml"));
    let run = shop.run(&line("answered.toml"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    // 800 steps of 0.0001 inch.
    assert!(
        shop.read("out/a.nc").contains("G71 P10 Q20 U0.02 W0.004 F0.01 D0.08"),
        "{}",
        shop.read("out/a.nc")
    );
}

/// X and Z alone, and a feed mode of a lathe: a mill has it for its drilling cycles.
#[test]
fn a_library_that_shows_no_kind_is_asked_it() {
    let turned = "O1\nG98\nG20\nG80\nG40\nG54\nM3 S2000 F10.\nG0\nX1.7\nZ.05\nG1\nX-.05\nM30\n";
    let shop = Shop::with(&[("lib/o1.nc", turned)]);
    let run = shop.run("convert lib --from haas --to fanuc --out out --no-verify");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.out.contains("nothing in the library shows whether"), "{}", run.out);
    let survey = shop.run("survey lib --from haas --to fanuc --write m.toml");
    assert_eq!(survey.code, 0, "{}", survey.err);
    let asked = "#? machine = \"mill\" or \"lathe\" # no program shows which of them it is for";
    assert!(shop.read("m.toml").contains(asked), "{}", shop.read("m.toml"));
    shop.write("k.toml", b"dialect = \"haas\"\nmachine = \"mill\"\n");
    let run = shop.run("convert lib --machine k.toml --to fanuc --out told --no-verify");
    assert!(!run.out.contains("nothing in the library shows whether"), "{}", run.out);
    // A program that drills has the code for its holes.
    shop.write("lib/o1.nc", turned.replace("G0\n", "G81 X1. Z-1. R.1\nG80\nG0\n").as_bytes());
    let run = shop.run("convert lib --from haas --to fanuc --out out --no-verify");
    assert!(!run.out.contains("nothing in the library shows whether"), "{}", run.out);
}
