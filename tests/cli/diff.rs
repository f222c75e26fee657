//! `macroglot diff`: what changed for the machine.

use super::{Run, Shop, repository};
use serde_json::Value;

/// Moves whose places are worked out by hand below.
const OLD: &str = "%\nO0100 (TEST)\nG21 G17 G90 G40 G80 G94\nN10 G0 X0 Y0\nN20 #101=5\nN30 G1 X10. F100\nN40 X10. Y10.\n\
                   N50 X-5. Y10.\nN60 IF [#101 GT 3] GOTO 80\nN70 G0 Z10.\nN80 G0 Z50.\nM30\n%\n";

/// The diff of that and of what a change makes of it.
fn diff(changes: &[(&str, &str)], flags: &str) -> Run {
    let mut new = OLD.to_owned();
    for (from, to) in changes {
        assert!(new.contains(from), "{from}");
        new = new.replace(from, to);
    }
    let shop = Shop::with(&[("old.nc", OLD), ("new.nc", &new)]);
    shop.run(&format!("diff old.nc new.nc --from fanuc {flags}"))
}

/// The changes that a program's motion lists.
fn motion(run: &Run) -> Vec<Value> {
    let all: Value = serde_json::from_str(&run.out).unwrap_or_else(|error| panic!("{error}: {}", run.out));
    let programs = all["programs"].as_array().unwrap();
    programs.iter().flat_map(|p| p["motion"]["changes"].as_array().cloned().unwrap_or_default()).collect()
}

#[test]
fn one_sign() {
    let run = diff(&[("G1 X10. F100", "G1 X-10. F100")], "--motion");
    assert_eq!(run.code, 1, "{}", run.err);
    let told = "~ line 6: feed move: X 10.000 -> -10.000 (-20.000)\n      - old.nc: N30 G1 X10. F100\n      + new.nc: N30 G1 \
                X-10. F100\n";
    assert!(run.out.contains(told), "{}", run.out);
    assert_eq!(run.out.matches("~ ").count(), 1, "nothing else differs: {}", run.out);
    // By words: the sign is marked with its word.
    let run = diff(&[("G1 X10. F100", "G1 X-10. F100")], "--text --format html");
    assert!(run.out.contains("N30 G1 <mark>X-10.</mark> F100"), "{}", run.out);
}

#[test]
fn another_look_is_no_effect() {
    let changes = [
        ("N10 G0 X0 Y0", "N1 G00X0Y0 (HOME)"),
        ("N20 ", "  "),
        ("G1 X10. F100", "g01 X010.00 F0100"),
        ("(TEST)", "(ANOTHER)"),
        ("GOTO 80", "GOTO 800"),
        ("N80", "N800"),
    ];
    let run = diff(&changes, "");
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.out.starts_with("No effect on the machine.\n"), "{}", run.out);
    assert!(run.out.contains("nothing changed that the control reads"), "{}", run.out);
    // The text changed, the normalised text did not.
    assert!(
        run.out.contains("\ntext: old.nc -> new.nc\n") && !run.out.contains("normalised:"),
        "{}",
        run.out
    );
    assert_eq!(diff(&[], "").out, "Nothing changed.\n");
}

/// A point says what a number counts: without it a length may count increments.
#[test]
fn a_point_is_no_spelling() {
    let run = diff(&[("G0 Z10.", "G0 Z10")], "--normalised");
    assert!(run.code == 1 && run.out.contains("G0 Z10\n"), "{}", run.out);
}

#[test]
fn a_jump_to_another_block_is_no_numbering() {
    let run = diff(&[("GOTO 80", "GOTO 70")], "--motion --structure");
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(run.out.contains("line 10 label: a jump or call comes here now"), "{}", run.out);
    assert!(run.out.contains("line 11 label: no jump or call comes here any more"), "{}", run.out);
    assert!(run.out.contains("+ new line 10: added: rapid move to Z 10.000"), "{}", run.out);
}

#[test]
fn an_inserted_move() {
    let run = diff(&[("N40 X10.", "N35 X12. Y5.\nN40 X10.")], "--motion --format json");
    let changes = motion(&run);
    assert_eq!((run.code, changes.len()), (1, 1), "what follows is the same: {changes:?}");
    let new = &changes[0]["new"];
    assert_eq!(
        (&changes[0]["old"], &new["line"], &new["block"]),
        (&Value::Null, &7.into(), &"N35 X12. Y5.".into())
    );
    assert_eq!((&new["event"]["to"]["x"], &new["event"]["to"]["y"]), (&12.0.into(), &5.0.into()));
}

#[test]
fn moves_that_follow_a_shift_are_counted() {
    let relative = |x: &str| format!("O1\nG21 G17 G91 G40 G80 G94\nG1 X{x} F100\nY1.\nY2.\nY3.\nM30\n");
    let shop = Shop::with(&[("old.nc", &relative("1.")), ("new.nc", &relative("1.5"))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion");
    assert!(run.out.contains("(+0.500); and by just as much at 3 places that follow"), "{}", run.out);
}

#[test]
fn another_feed() {
    let run = diff(&[("F100", "F120")], "--motion");
    let told =
        "~ line 6: feed move: feed 100 mm/min -> 120 mm/min; and by just as much at 2 places that follow";
    assert!(run.code == 1 && run.out.contains(told), "{}", run.out);
}

#[test]
fn inches_are_told_in_inches() {
    let inch = |x: &str| format!("O1\nG20 G17 G90 G40 G80 G94\nG1 X{x} F10.\nM30\n");
    let shop = Shop::with(&[("old.nc", &inch("1.")), ("new.nc", &inch("1.25"))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion");
    assert!(run.out.contains("inches") && run.out.contains("X 1.0000 -> 1.2500 (+0.2500)"), "{}", run.out);
}

#[test]
fn what_is_no_move() {
    let old = "O1\nG21 G17 G90 G40 G80 G94\nG54\nT1 M6\nG43 H1 Z50.\nS1000 M3\nM8\nG4 P500\nG1 X1. F100\nM0\nG4 P100\n#3006=1(TURN)\n\
               M9\nM5\nM30\n";
    let new =
        old.replace("G54", "G55").replace("H1", "H2").replace("S1000 M3", "S1200 M4").replace("P500", "P700");
    let new = new.replace("M0\n", "").replace("(TURN)", "(TURN IT)");
    let shop = Shop::with(&[("old.nc", old), ("new.nc", &new)]);
    let out = shop.run("diff old.nc new.nc --from fanuc --motion").out;
    let told = [
        "spindle: clockwise, 1000 turns -> counter-clockwise, 1200 turns",
        "tool length: number 1 -> number 2",
        "wait: 0.5 s -> 0.7 s",
        "taken out: stop",
        "message: 'TURN' -> 'TURN IT'",
        "work offset 1 -> 2, tool length 1 -> 2",
    ];
    for words in told {
        assert!(out.contains(words), "no '{words}' in {out}");
    }
}

#[test]
fn a_renamed_variable() {
    let run = diff(&[("#101", "#150")], "--structure --motion");
    assert_eq!(run.code, 0, "{}", run.out);
    assert!(run.out.starts_with("No effect on the machine.\n"), "{}", run.out);
    assert!(run.out.contains("#101 is #150 now, in all its places"), "{}", run.out);
    // One place keeps the old name: nothing was renamed.
    let run = diff(&[("#101=5", "#150=5")], "--structure --motion");
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(run.out.contains("#150 is new") && !run.out.contains("is #150 now"), "{}", run.out);
}

/// Two variables that change their names with each other are the same for the machine.
#[test]
fn variables_that_are_swapped() {
    let text = "O1\nG21 G17 G90 G40 G80 G94\n#101=5.\n#102=7.\nG1 X#101 Y#102 F100\nM30\n";
    let swapped = text.replace("#101", "#1X").replace("#102", "#101").replace("#1X", "#102");
    let shop =
        Shop::with(&[("old.nc", text), ("new.nc", &swapped), ("half.nc", &text.replace("X#101", "X#102"))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion --structure");
    assert_eq!(run.code, 0, "{}", run.out);
    let run = shop.run("diff old.nc half.nc --from fanuc --motion");
    assert!(run.code == 1 && run.out.contains("X 5.000 -> 7.000 (+2.000)"), "{}", run.out);
}

const MAIN: &str = "O1000\nG21 G17 G90 G40 G80 G94\nG0 X0 Y0 Z50.\nG65 P9001 A10. B5.\nM98 P2000\nM30\n";
const CALLED: &str = "O9001\nG0 X#1 Y#2\nG1 Z-#2 F200\nG0 Z50.\nM99\n";
const OTHER: &str = "O2000\nG1 X5. F50\nM99\n";

#[test]
fn a_changed_subprogram_shows_in_its_main_program() {
    let changed = CALLED.replace("Z-#2", "Z-[#2+1.]");
    let files = [("a/main.nc", MAIN), ("a/sub.nc", CALLED), ("a/other.nc", OTHER)];
    let others = [("b/main.nc", MAIN), ("b/sub.nc", changed.as_str()), ("b/other.nc", OTHER)];
    let shop = Shop::with(&[files, others].concat());
    let run = shop.run("diff a b --from fanuc --motion");
    assert_eq!(run.code, 1, "{}", run.err);
    let main =
        run.out.split("\n\n").find(|part| part.starts_with("O1000 (main.nc)")).expect("the main program");
    assert!(main.contains("feed move: Z -5.000 -> -6.000 (-1.000)\n      - sub.nc: G1 Z-#2 F200"), "{main}");
    assert!(!run.out.contains("O2000"), "{}", run.out);
    let run = shop.run("diff a b --from fanuc --format json");
    let all: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((&all["untouched"], &all["verdict"]), (&1.into(), &"different".into()));
    // The same of one file, with its library.
    let run = shop.run("diff a/sub.nc b/sub.nc --from fanuc --motion --library a");
    assert!(run.out.contains("O1000 (main.nc): different"), "{}", run.out);
    // A program that stands in another file now is the same program.
    let shop = Shop::with(&[("a/x.nc", MAIN), ("a/y.nc", OTHER), ("b/x.nc", OTHER), ("b/y.nc", MAIN)]);
    let run = shop.run("diff a b --from fanuc");
    assert_eq!(run.code, 0, "{}", run.out);
    assert!(run.out.contains("it stands in y.nc now, before in x.nc"), "{}", run.out);
}

#[test]
fn programs_that_are_new_gone_or_numbered_anew() {
    let shop = Shop::with(&[
        ("a/main.nc", MAIN),
        ("a/sub.nc", CALLED),
        ("a/other.nc", OTHER),
        ("b/main.nc", MAIN),
        ("b/sub.nc", &CALLED.replace("O9001", "O9002")),
        ("b/more.nc", "O5\nM30\n"),
    ]);
    let run = shop.run("diff a b --from fanuc");
    assert_eq!(run.code, 1);
    assert!(
        run.out.contains("O2000 (other.nc): different for the machine\n  the program is gone"),
        "{}",
        run.out
    );
    assert!(
        run.out.contains("O0005 (more.nc): different for the machine\n  the program is new"),
        "{}",
        run.out
    );
    assert!(run.out.contains("program O9001 is O9002 now"), "{}", run.out);
    // What calls a program that is not there any more is not the same.
    assert!(!run.out.contains("O1000 (main.nc): no effect"), "{}", run.out);
    let run = shop.run("diff /dev/null a/other.nc --from fanuc --motion");
    assert!(run.code == 1 && run.out.contains("the program is new"), "{}", run.out);
    let run = shop.run("diff a/other.nc /dev/null --from fanuc --motion");
    assert!(run.code == 1 && run.out.contains("the program is gone"), "{}", run.out);
}

#[test]
fn a_conversion_is_the_same_as_its_source() {
    let shop = Shop::with(&[("a.nc", super::CLEAN)]);
    let run = shop.run("convert a.nc --from fanuc --to haas --out out --quiet");
    assert_eq!(run.code, 0, "{}", run.err);
    let run = shop.run("diff a.nc out/a.nc --from fanuc --to haas --motion");
    assert_eq!(run.code, 0, "{}", run.out);
    assert!(run.out.starts_with("No effect on the machine.\n"), "{}", run.out);
    let written = shop.read("out/a.nc");
    assert!(written.contains("X2."), "{written}");
    shop.write("out/a.nc", written.replace("X2.", "X2.5").as_bytes());
    let run = shop.run("diff a.nc out/a.nc --from fanuc --to haas --motion");
    assert!(run.code == 1 && run.out.contains("X 2.0000 -> 2.5000 (+0.5000)"), "{}", run.out);
}

#[test]
fn a_tolerance_is_allowed() {
    let profile = "dialect = \"fanuc\"\n";
    let shop = Shop::with(&[
        ("old.nc", "O1\nG21 G17 G90 G40 G80 G94\nG1 X1. F100\nX2.\nM30\n"),
        ("new.nc", "O1\nG21 G17 G90 G40 G80 G94\nG1 X1. F100\nX2.04\nM30\n"),
        ("fanuc.toml", profile),
    ]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion --machine fanuc.toml");
    assert!(run.code == 1 && run.out.contains("X 2.000 -> 2.040 (+0.040)"), "{}", run.out);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion --tolerance 0.05");
    assert!(!run.out.contains("different for the machine"), "{}", run.out);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion --tolerance 0.03");
    assert!(run.code == 1 && run.out.contains("up to 0.03 mm counts as the same"), "{}", run.out);
}

#[test]
fn many_places_are_bounded() {
    let many = |y: &str| {
        let moves: String =
            (1..300).map(|n| format!("G1 X{n}. Y{}\n", if n % 2 == 0 { y } else { "0" })).collect();
        format!("O1\nG21 G17 G90 G40 G80 G94\nF100\n{moves}M30\n")
    };
    let old = many("1.");
    let many_new = old.lines().enumerate().map(|(n, line)| line.replace("Y1.", &format!("Y{n}.5")) + "\n");
    let shop = Shop::with(&[("old.nc", &old), ("new.nc", &many_new.collect::<String>())]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion --most 10");
    assert_eq!(run.out.matches("  ~ line").count(), 10, "{}", run.out);
    // 149 moves, each by an amount of its own.
    assert!(run.out.contains("and 139 more places"), "{}", run.out);
}

#[test]
fn what_cannot_be_compared() {
    let shop = Shop::with(&[("a.nc", OLD), ("empty.nc", "")]);
    shop.write("binary.nc", b"\x7fELF\x01\x02\x03");
    shop.fails("diff a.nc binary.nc --from fanuc", &["binary.nc", "binary"]);
    shop.fails("diff a.nc missing.nc --from fanuc", &["missing.nc", "no such file"]);
    shop.fails("diff a.nc --from fanuc", &["OLD NEW"]);
    shop.fails("diff a.nc a.nc a.nc --from fanuc", &["OLD NEW"]);
    shop.fails("diff a.nc a.nc --from siemens", &["siemens"]);
    shop.fails("diff a.nc a.nc --from fanuc --tolerance=-1", &["--tolerance"]);
    shop.fails("diff a.nc a.nc --from fanuc --tolerance nan", &["--tolerance"]);
    shop.fails("diff --normalise a.nc a.nc --from fanuc", &["one file"]);
    let run = shop.run("diff empty.nc empty.nc --from fanuc");
    assert_eq!((run.code, run.out.as_str()), (0, "Nothing changed.\n"));
}

#[test]
fn colours_and_formats() {
    let change = [("G1 X10. F100", "G1 X-10. F100"), ("(TEST)", "(<b>\u{1b}[31m`*)")];
    assert!(!diff(&change, "").out.contains('\u{1b}'), "no colours where there is no terminal");
    let always = diff(&change, "--color always").out;
    assert!(always.starts_with("\u{1b}[1;31mThe machine does something else"), "{always}");
    assert!(!always.contains("\u{1b}[31m`"), "what a program holds is shown, not sent: {always}");
    let html = diff(&change, "--format html").out;
    assert!(html.ends_with("</html>\n") && html.contains("&lt;b&gt;") && !html.contains("<script"), "{html}");
    let markdown = diff(&change, "--format markdown").out;
    assert!(markdown.starts_with("**The machine does something else: 1 program.**\n"), "{markdown}");
    assert!(markdown.contains("- line 6: feed move: X 10.000 -> -10.000 (-20.000)"), "{markdown}");
    let json: Value = serde_json::from_str(&diff(&change, "--format json").out).unwrap();
    assert_eq!(json["format"], 1);
    assert_eq!(json["files"][0]["text"]["hunks"][0]["lines"][0]["on"], "both");
    let sarif = diff(&change, "--format sarif").out;
    let log = crate::sarif::valid(&sarif);
    let results = log["runs"][0]["results"].as_array().unwrap();
    assert!(results.iter().any(|result| result["ruleId"] == "diff.motion"), "{sarif}");
}

#[test]
fn the_arguments_of_git() {
    let shop = Shop::with(&[("old.nc", OLD), ("new.nc", &OLD.replace("G1 X10.", "G1 X-10."))]);
    let git = "programs/a.nc old.nc 0123abc 100644 new.nc 4567def 100644";
    let run = shop.run(&format!("diff --from fanuc {git}"));
    // git ends where a driver has another exit code.
    assert!(
        run.code == 0 && run.out.contains("text: programs/a.nc -> programs/a.nc"),
        "{}{}",
        run.out,
        run.err
    );
    assert_eq!(shop.run(&format!("diff --from fanuc --exit-code {git}")).code, 1);
    let gone = "programs/a.nc old.nc 0123abc 100644 /dev/null . .";
    assert!(shop.run(&format!("diff --from fanuc {gone}")).out.contains("the program is gone"));
}

/// Changes that look like another spelling, and that a control may read otherwise: none may pass without a run.
#[test]
fn what_only_looks_like_another_spelling() {
    let text = "O1\nG21 G17 G90 G40 G80 G94\nN100 #1=1\n#3006=1(TURN)\nM0(DONE)\n/G4 P100\nG1 X1 0 F100\nM98 P2\nGOTO 90\nN90 \
                GOTO#1\nN1 M30\n";
    let sub = "O2\nG0 Z1.\nM99 P100\n";
    let changes = [
        ("N100", "N200"),
        ("N1 M30", "N2 M30"),
        ("(TURN)", "(STOP)"),
        ("(DONE)", "(GONE)"),
        ("/G4", "G4"),
        ("/G4", "/2G4"),
        ("X1 0", "X1"),
        ("X1 0", "X1. 0"),
        ("N90 ", "N91 "),
        ("P100", "P100."),
        ("M98 P2", "M98 P0002"),
        ("#1=1", "#1=-1"),
        ("#1=1", "#01=000000001"),
    ];
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        let new = text.replacen(from, to, 1);
        let shop =
            Shop::with(&[("a/main.nc", text), ("a/sub.nc", sub), ("b/main.nc", &new), ("b/sub.nc", sub)]);
        let run = shop.run("diff a b --from fanuc --motion --program-seconds 2");
        assert!(run.code < 2, "{from} to {to}: {}", run.err);
        assert!(!run.out.contains("control reads"), "{from} to {to}: {}", run.out);
        assert!(run.out.contains("O0001"), "{from} to {to}: {}", run.out);
    }
}

/// Two programs of one number: each has its place.
#[test]
fn programs_of_one_number() {
    let twice = "O1\nG21\nM30\nO1\nG20\nM30\n";
    let shop = Shop::with(&[("a/x.nc", twice), ("a/y.nc", OTHER), ("b/x.nc", twice), ("b/y.nc", OTHER)]);
    assert_eq!(shop.run("diff a b --from fanuc").out, "Nothing changed.\n");
}

/// Variables that a computed number reaches are no longer the same under another name.
#[test]
fn a_name_that_a_computed_number_reaches() {
    let text = "O1\nG21 G17 G90 G40 G80 G94\n#101=5.\n#1=101\nG1 X#[#1] F100\nM30\n";
    let shop = Shop::with(&[("old.nc", text), ("new.nc", &text.replace("#101=", "#102="))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion");
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(run.out.contains("taken out: feed move to X 5.000"), "{}", run.out);
}

/// What a program leaves for the next one differs too.
#[test]
fn what_stands_at_the_end() {
    let text = "O1\nG21 G17 G90 G40 G80 G94\n#500=5.\nM30\n";
    let shop = Shop::with(&[("old.nc", text), ("new.nc", &text.replace("#500=5.", "#500=6."))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion");
    assert_eq!(run.code, 1, "{}", run.out);
    assert!(
        run.out.contains("~ at the end: #500 is 5 in the old program, #500 is 6 in the new one"),
        "{}",
        run.out
    );
}

#[test]
fn a_program_that_is_not_there_is_named() {
    let shop = Shop::with(&[("old.nc", MAIN), ("new.nc", &MAIN.replace("B5.", "B6."))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion");
    assert_eq!(run.code, 1, "{}", run.out);
    for words in ["O9001 is not in the library", "--library"] {
        assert!(run.out.contains(words), "{}", run.out);
    }
}

/// A library against itself.
#[test]
fn a_library_is_the_same_as_itself() {
    for dialect in ["fanuc", "cc100"] {
        let folder = repository(&format!("corpus/{dialect}"));
        let run = Shop::empty().run(&format!("diff {folder} {folder} --from {dialect}"));
        assert_eq!((run.code, run.out.as_str()), (0, "Nothing changed.\n"), "{dialect}");
    }
}

/// A message after a stop that was taken out is no other way of that stop.
#[test]
fn a_stop_before_a_message() {
    let text = "O1\nG21 G17 G90 G40 G80 G94\nG1 X1. F100\nM0\n#3006=1(TURN)\nM30\n";
    let shop = Shop::with(&[("old.nc", text), ("new.nc", &text.replace("M0\n", ""))]);
    let run = shop.run("diff old.nc new.nc --from fanuc --motion");
    assert!(run.code == 1 && run.out.contains("- old line 4: taken out: stop\n"), "{}", run.out);
    assert!(!run.out.contains("message"), "{}", run.out);
}

/// #4114 is the sequence number: who reads it sees that blocks were renumbered, by its name or by a computed number.
#[test]
fn a_program_that_reads_its_sequence_number() {
    for read in ["#500=#4114", "#1=4114\n#500=#[#1]"] {
        let text = format!("O1\nG21 G17 G90 G40 G80 G94\nN10 G0 X1.\n{read}\nG0 X#500\nM30\n");
        let shop = Shop::with(&[("old.nc", &text), ("new.nc", &text.replace("N10", "N20"))]);
        let run = shop.run("diff old.nc new.nc --from fanuc --motion");
        assert!(
            run.code == 1 && run.out.contains("rapid move: X 10.000 -> 20.000 (+10.000)\n"),
            "{}",
            run.out
        );
    }
}

/// Both paths lie between X-10 and X10, Y0 and Y10: 24.08 pixels a millimetre, X0 at 340 and Y0 at 496.4. The old move ends
/// at X10, 240.8 to the right, and the new one at X-10.
#[test]
fn both_paths_in_one_picture() {
    let new = OLD.replace("G1 X10. F100", "G1 X-10. F100");
    let shop = Shop::with(&[("old.nc", OLD), ("new.nc", &new)]);
    shop.run("diff old.nc new.nc --from fanuc --plot both.svg --motion");
    let svg = shop.read("both.svg");
    for ring in ["cx=\"580.8\" cy=\"496.4\" r=\"7\"", "cx=\"99.2\" cy=\"496.4\" r=\"7\""] {
        assert!(svg.contains(ring), "{ring}: {svg}");
    }
    // The line of the new program stands beside its ring.
    assert!(svg.contains("<text class=\"ap\" x=\"108.2\" y=\"491.4\">6</text>"), "{svg}");
    assert!(svg.contains(">old.nc and new.nc<") && svg.contains(">XY, mm<"), "{svg}");
    // As PNG, twice as large; its size stands in big-endian numbers after the name of the first part.
    shop.run("diff old.nc new.nc --from fanuc --plot both.PNG");
    let png = std::fs::read(shop.path("both.PNG")).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!((&png[16..20], &png[20..24]), (&2600_u32.to_be_bytes()[..], &1552_u32.to_be_bytes()[..]));
    let same = shop.run("diff old.nc old.nc --from fanuc --plot same.svg");
    assert_eq!(same.code, 0);
    assert!(shop.read("same.svg").contains("no move, feed, wait or stop differs"));
}

/// A difference that only the size of a tool makes is drawn with sizes.
#[test]
fn what_only_a_tools_length_shows_is_drawn_with_it() {
    let old = "O1\nG21 G17 G90 G54\nT1 M6\nG43 H1 Z50.\nG1 Z0. F100\nG49 G0 Z100.\nM30\n";
    let shop = Shop::with(&[("old.nc", old), ("new.nc", &old.replace("H1", "H2"))]);
    shop.run("diff old.nc new.nc --from fanuc --plot both.svg");
    let svg = shop.read("both.svg");
    assert!(svg.contains("class=\"ap\"") && !svg.contains("no move"), "{svg}");
}

#[test]
fn a_picture_of_what_has_no_counterpart_says_so() {
    let shop = Shop::with(&[("old.nc", OLD), ("still.nc", "O5\nM30\n")]);
    shop.run("diff /dev/null old.nc --from fanuc --plot none.svg");
    assert!(shop.read("none.svg").contains("no program stands on both sides"));
    shop.run("diff still.nc still.nc --from fanuc --plot still.svg");
    assert!(shop.read("still.svg").contains("neither program makes a move"));
    // What is compared is never drawn over.
    for input in ["old.nc", "still.nc"] {
        let run = shop.run(&format!("diff old.nc still.nc --from fanuc --plot {input} --force"));
        assert!(run.err.contains("would be overwritten"), "{}", run.err);
    }
    assert_eq!(shop.read("old.nc"), OLD);
}
