//! Codes of the machine's builder, from two profiles to a verified conversion.

use super::{Shop, unmarked};

const FANUC: &str = "dialect = \"fanuc\"\nunits = \"metric\"\n
[[site]]
code = \"M14\"
name = \"chuck.air.on\"
words = { P = \"level\" }
text = \"chuck air on\"

[[site]]
code = \"M15\"
name = \"chuck.air.off\"
text = \"chuck air off\"
";

const HAAS: &str = "dialect = \"haas\"\nunits = \"metric\"\n
[[site]]
code = \"M151\"
name = \"chuck.air.on\"
words = { Q = \"level\" }
text = \"air\"

[[site]]
code = \"M152\"
name = \"chuck.air.off\"
text = \"no air\"
";

const PROGRAM: &str = "O1\nG90 G0 X5.\nM14 P3\nX10.\nM15\nM30\n";

#[test]
fn one_name_in_two_profiles_pairs_codes_both_ways() {
    let shop = Shop::with(&[("a.nc", PROGRAM), ("f.toml", FANUC), ("h.toml", HAAS)]);
    let machines = "--machine f.toml --machine h.toml";
    let run = shop.run(&format!("convert a.nc --from fanuc --to haas {machines} --out there"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.err.contains("1 converted") || run.out.contains("1 converted"), "{}{}", run.out, run.err);
    let there = unmarked(&shop.read("there/a.nc"));
    assert!(there.contains("G90 G0 X5.\nM151 Q3.\nX10.\nM152\nM30"), "{there}");
    let back = shop.run(&format!("convert there/a.nc --from haas --to fanuc {machines} --out back"));
    assert_eq!(back.code, 0, "{}", back.err);
    assert!(
        unmarked(&shop.read("back/a.nc")).contains("M14 P3\nX10.\nM15\nM30"),
        "{}",
        shop.read("back/a.nc")
    );
}

/// The verifier knows the codes by their names: another code, another value and another place are differences.
#[test]
fn the_verifier_compares_names_words_and_places() {
    let shop = Shop::with(&[("a.nc", PROGRAM), ("f.toml", FANUC), ("h.toml", HAAS)]);
    let verify = |text: &str| {
        shop.write("b.nc", text.as_bytes());
        shop.run("verify a.nc b.nc --from fanuc --to haas --machine f.toml --machine h.toml").code
    };
    assert_eq!(verify("O1\nG90 G0 X5.\nM151 Q3.\nX10.\nM152\nM30\n"), 0);
    assert_eq!(verify("O1\nG90 G0 X5.\nM152\nX10.\nM151 Q3.\nM30\n"), 1);
    assert_eq!(verify("O1\nG90 G0 X5.\nM151 Q4.\nX10.\nM152\nM30\n"), 1);
    assert_eq!(verify("O1\nG90 G0 X5.\nM151\nX10.\nM152\nM30\n"), 1);
    assert_eq!(verify("O1\nG90 G0 X5.\nX10.\nM151 Q3.\nM152\nM30\n"), 1);
    assert_eq!(verify("O1\nG90 G0 X5.\nX10.\nM152\nM30\n"), 1);
}

#[test]
fn a_run_shows_the_name_and_the_words() {
    let shop = Shop::with(&[("a.nc", PROGRAM), ("f.toml", FANUC)]);
    let json = shop.run("run a.nc --dialect fanuc --machine f.toml --trace json");
    assert!(
        json.out.contains("\"event\":\"act\",\"name\":\"chuck.air.on\",\"words\":{\"level\":3.0}"),
        "{}",
        json.out
    );
    let text = shop.run("run a.nc --dialect fanuc --machine f.toml --trace text");
    assert!(text.out.contains("chuck.air.on level 3"), "{}", text.out);
}

/// Two programs that leave one code out: a person is asked once, and told how many programs it concerns.
#[test]
fn what_is_left_out_is_told_once() {
    let omit = "dialect = \"fanuc\"\n[[site]]\ncode = \"M14\"\ndo = \"omit\"\ntext = \"chuck air on\"\n";
    let shop = Shop::with(&[("in/a.nc", "O1\nM14\nM30\n"), ("in/b.nc", "O2\nM14\nM30\n"), ("f.toml", omit)]);
    let run = shop.run("convert in --from fanuc --to haas --machine f.toml --out there");
    let said = format!("{}{}", run.out, run.err);
    assert_eq!(
        said.matches("M14 (chuck air on) is left out, as the source's profile says").count(),
        1,
        "{said}"
    );
    assert!(said.contains("2 converted, 0 for review"), "{said}");
    assert_eq!(run.code, 0, "{said}");
    assert!(!shop.read("there/a.nc").contains("M14"));
}

/// What the profile does not answer names the keys that do.
#[test]
fn a_code_that_no_profile_knows_names_the_key() {
    let shop = Shop::with(&[("a.nc", "O1\nM14\nM30\n"), ("b.nc", "N1 M14\nN2 M30\n"), ("f.toml", FANUC)]);
    for (file, from) in [("a.nc", "fanuc"), ("b.nc", "fadal"), ("b.nc", "cc100")] {
        let run = shop.run(&format!("convert {file} --from {from} --to haas --verbose"));
        assert_eq!(run.code, 1, "{}", run.err);
        let said = format!("{}{}", run.out, run.err);
        assert!(said.contains("[[site]]"), "{from}: {said}");
    }
    let known = shop.run("convert a.nc --from fanuc --to haas --machine f.toml --verbose");
    let said = format!("{}{}", known.out, known.err);
    assert!(said.contains("name = \"chuck.air.on\"") && said.contains("do = "), "{said}");
}

/// It is asked once for the library (docs/builders-codes.md): whoever wrote the profile has decided it.
#[test]
fn what_the_profile_leaves_out_sends_no_program_to_review() {
    let site =
        |code: &str, what: &str| format!("[[site]]\ncode = \"{code}\"\ntext = \"{code}\"\ndo = \"{what}\"\n");
    let profile =
        format!("dialect = \"fanuc\"\nunits = \"metric\"\n{}{}", site("M14", "omit"), site("M15", "stop"));
    let program = PROGRAM.replace(" P3", "");
    let shop = Shop::with(&[("a.nc", &program), ("f.toml", &profile)]);
    let run = shop.run("convert a.nc --from fanuc --to haas --machine f.toml --out there");
    let told = format!("{}{}", run.out, run.err);
    assert!(told.contains("1 converted") && !told.contains("MG0802"), "{told}");
    assert!(told.contains("M14 (M14) is left out") && told.contains("M15 (M15) is a stop"), "{told}");
}

/// What comes after an alarm in the place of a code is run by nobody: if every run comes to it, nothing is known of the rest.
#[test]
fn an_alarm_that_every_run_comes_to_leaves_the_program_undecided() {
    let head = "O1000\nG20 G17 G40 G49 G80 G90 G94\nG54 G0 X0 Y0\n";
    let shop = Shop::with(&[
        (
            "fanuc.toml",
            "dialect = \"fanuc\"\nunits = \"inch\"\n[codes]\nM50 = { do = \"alarm\", text = \"BAR FEED\" }\n",
        ),
        ("every.nc", &format!("%\n{head}M50\nG1 X1. F10.\nM30\n%\n")),
        ("some.nc", &format!("%\n{head}IF [#500 GT 5] GOTO 10\nG1 X1. F10.\nM30\nN10 M50\nM30\n%\n")),
    ]);
    let run = shop.run("convert every.nc --from fanuc --to haas --machine fanuc.toml");
    let wanted = "every run comes to it: M50 (BAR FEED) is an alarm on the target";
    assert!(run.err.contains(wanted) && run.err.contains("MG0802"), "{}", run.err);
    let run = shop.run("convert some.nc --from fanuc --to haas --machine fanuc.toml");
    assert!(run.err.contains("1 converted") && !run.err.contains("MG0802"), "{}", run.err);
}
