//! What the verifier makes of programs as mill shops write them.

use super::Shop;

const HAAS: &str = "dialect = \"haas\"\nunits = \"metric\"\n";
const FANUC: &str = "dialect = \"fanuc\"\nunits = \"metric\"\n";
const HEAD: &str = "G21 G17 G40 G49 G80 G90 G94 G54";

/// What a conversion between the two prints.
fn convert(way: &str, program: &str, (haas, fanuc): (&str, &str)) -> String {
    let (haas, fanuc) = (format!("{HAAS}{haas}"), format!("{FANUC}{fanuc}"));
    let shop = Shop::with(&[("a.nc", program), ("h.toml", &haas), ("f.toml", &fanuc)]);
    let run = shop.run(&format!("convert a.nc {way} --machine h.toml --machine f.toml"));
    format!("{}{}", run.out, run.err)
}

/// On the target a limit on reading ahead stands between the code and the alarm: nobody sees the difference.
#[test]
fn a_code_before_an_alarm_counts_on_both_sides_or_on_none() {
    for code in ["M19", "M3 S500", "M8"] {
        let program = format!("O1\n{HEAD}\n{code}\nIF[#1005EQ1]GOTO8\nG4X1.\nN8#3000=45(LOW)\nM30\n");
        let said = convert("--from fanuc --to haas", &program, ("", ""));
        assert!(said.contains("1 converted") && !said.contains("MG0801"), "{code}: {said}");
    }
}

/// The constants of a local subprogram stand in a program of their own on the target. Edited on both sides they show the way
/// that the last pass is cut to its depth: 5 passes of 0.4 come to 2 without it.
#[test]
fn constants_of_a_local_subprogram_are_edited_too() {
    let pass = "WHILE [#1 GT #2] DO1\n#1=#1-#3\nIF [#1 LT #2] THEN #1=#2\nG1 Z#1 F100.\nEND1";
    let program = format!("O1000\n{HEAD}\nM97 P5\nM30\nN5\n#1=0.\n#2=-2.\n#3=1.\n{pass}\nM99\n");
    let said = convert("--from haas --to fanuc", &program, ("", ""));
    assert!(said.contains("1 converted") && !said.contains("MG0802"), "{said}");
}

/// Twenty times 0.1 is a little more than 2 in doubles, and 2 in decimals: what both machines calculate with decides whether
/// they do the same. Functions may be off in their last digit on either.
#[test]
fn machines_that_are_both_said_to_calculate_with_doubles_add_alike() {
    let program = |step: &str| {
        format!("O1\n{HEAD}\n#1=0.\nWHILE [#1 GT -2.] DO1\n#1=#1-{step}\nG1 Z#1 F100.\nEND1\nM30\n")
    };
    let doubles = ("[settings]\narithmetic = \"double\"\n", "[parameters]\n6008.0 = \"0\"\n");
    let said = convert("--from haas --to fanuc", &program("0.1"), ("", ""));
    assert!(said.contains("MG0803") && said.contains("arithmetic = \"double\" under [settings]"), "{said}");
    for half in [(doubles.0, ""), ("", doubles.1)] {
        let said = convert("--from haas --to fanuc", &program("0.1"), half);
        assert!(said.contains("MG0803"), "{half:?}: {said}");
    }
    let said = convert("--from haas --to fanuc", &program("0.1"), doubles);
    assert!(said.contains("1 converted") && !said.contains("MG0803"), "{said}");
    let said = convert("--from haas --to fanuc", &program("SIN[30.]/5."), doubles);
    assert!(said.contains("MG0803") && said.contains("a function of the target"), "{said}");
}

/// Run by itself the subprogram has no depth of its pecks, which is an alarm (PS0045) on the source alone. Its caller gives
/// one. If a caller may give none, it stays for review.
#[test]
fn a_subprogram_that_its_callers_give_the_pecks_stops_by_itself_alone() {
    let sub = "O1002\nG99 G83 X0. Y0. Z-10. R2. Q#9 F100.\nG80\nM99\n";
    let head = HEAD.replace("G49 ", "");
    let main = format!("O1001\n{head}\n#9=2.\nM3 S500\nG0 X0. Y0.\nG43 H1 Z5.\nM98 P1002\nM30\n");
    let said = convert("--from fanuc --to haas", &format!("{main}{sub}"), ("", ""));
    assert!(said.contains("2 converted"), "{said}");
    let open = main.replace("#9=2.", "#9=#500");
    let said = convert("--from fanuc --to haas", &format!("{open}{sub}"), ("", ""));
    assert!(!said.contains("2 converted"), "{said}");
}

/// A control without exact stop: that it is left out is told, and no difference between the runs.
#[test]
fn an_exact_stop_of_one_block_that_is_left_out_is_no_difference() {
    let program = format!("O1\n{HEAD}\nG1 X0. Y0. Z0. F100.\nG9 X5.\nM30\n");
    let shop = Shop::with(&[("a.nc", &program), ("f.toml", FANUC)]);
    let run = shop.run("convert a.nc --from fanuc --to fadal --machine f.toml");
    assert!(run.err.contains("exact stop at the end of a block is dropped"), "{}{}", run.out, run.err);
    assert!(!run.out.contains("REFUSED") && !run.err.contains("MG0801"), "{}{}", run.out, run.err);
}

/// No program begins in a drilling cycle: one that ends in it loses nothing where the target ends it before its end.
#[test]
fn a_program_that_ends_in_a_cycle_is_converted() {
    let program = format!("O1\n{HEAD}\nG0 X0. Y0. Z25.\nG98 G81 X10. Z-10. R10. F100.\nX20.\nM30\n");
    let shop = Shop::with(&[("a.nc", &program), ("f.toml", FANUC)]);
    let run = shop.run("convert a.nc --from fanuc --to fadal --machine f.toml");
    let said = format!("{}{}", run.out, run.err);
    assert!(said.contains("1 verified") && !said.contains("the exit state differs"), "{said}");
}

/// A Fanuc has no #10000, so O9003, which stands there, cannot know it by that number; #150 it has.
#[test]
fn a_number_that_the_target_lacks_is_known_by_no_program_there() {
    let outcome = |variable: &str, more: &str| {
        let program = format!("O1\n{HEAD}\n{variable}=5.\nG65 P9003 A1.\nG0 X{variable}\nM30\n");
        convert("--from haas --to fanuc", &program, ("", &format!("programs = [\"O9003\"]\n{more}")))
    };
    let said = outcome("#10000", "reserved = []\n");
    assert!(said.contains("1 converted") && said.contains("#10000 is #"), "{said}");
    // A shop that keeps #150 to itself makes the conversion take another one, which O9003 may know.
    let said = outcome("#150", "reserved = [\"#150\"]\n");
    assert!(said.contains("1 for review") && said.contains("#150 is #"), "{said}");
}

/// A letter whose last value the target has no variable for is named by its variable, what it holds and what to do.
#[test]
fn a_missing_last_value_of_a_letter_says_what_it_is() {
    let text = "O1\nG21 G90 G17 G54 G94\nG54.1 P3\n#500=7001+[#4130-1]*20\nM30\n";
    let shop = Shop::with(&[("a.nc", text)]);
    let run = shop.run("convert a.nc --from fanuc --to haas --out out");
    let told = "no variable of Haas is known to hold what #4130 (the P of the last G54.1, an additional work offset) holds";
    assert!(run.out.contains(told), "{}", run.out);
    assert!(
        run.out.contains("help: if nothing that runs here needs it, take out what reads or sets it"),
        "{}",
        run.out
    );
}

/// `#1=#4001` and `G#1` at the end of a macro: between them it writes an offset or a shift by a computed number, or stops with an
/// alarm. Groups 1 and 3 have the same codes on a Fanuc and a Haas.
#[test]
fn a_saved_code_is_put_back_without_a_question() {
    let asked = |between: &str| {
        let program = format!(
            "O1\n{HEAD}\nG65 P2 D5. E1.\nM30\nO2\n#1=#4001\n#2=#4003\nG91 G0 Z5.\n{between}\nG#1 G#2\nM99\n"
        );
        let said = convert("--from fanuc --to haas", &program, ("", ""));
        assert!(!said.contains("REFUSED"), "{between}: {said}");
        said.contains("the number of the G code is computed")
    };
    let counted = "#4=0\nWHILE[#4LE5]DO1\n#[5221+#4*20]=1.5\n#4=#4+1\nEND1";
    // Its run is told: must stay in #500 to #699.
    let row = "#[500+#7]=2.";
    let alarm = "IF[#8EQ1]GOTO50\nGOTO8\nN50#1=41\n#3000=45(LOW)\nN8G4X1.";
    for between in ["", counted, row, alarm] {
        assert!(!asked(between), "{between}");
    }
    let any = "#[#7]=2.";
    let skipped = "IF[#8EQ1]GOTO50\nGOTO8\nN50#1=#7\n/#3000=45(LOW)\nN8G4X1.";
    let none = "IF[#8EQ1]GOTO50\nGOTO8\nN50#1=#7\n#3000=0(LOW)\nN8G4X1.";
    let local = "#[#4+1]=2.";
    for between in [any, skipped, none, local] {
        assert!(asked(between), "{between}");
    }
}

/// A Haas takes no limit on reading ahead under cutter compensation. A code that a macro saved and puts back begins none, so a read
/// of an input waits there, and whether the source waits too is one question for the library.
#[test]
fn a_saved_code_begins_no_compensation() {
    let is_open = |group: &str| {
        let program = format!(
            "O1\n{HEAD}\nG65 P2 D5.\nG65 P2 D5.\nM30\nO2\n#1=#{group}\n#[500+#7]=2.\nG4X1.\nIF[#1005EQ1]GOTO8\nG91 G0 Z5.\nN8G#1\nM99\n"
        );
        let said = convert("--from fanuc --to haas", &program, ("", ""));
        let (asked, once) = said.split_once("What is decided once").expect("both are said");
        assert!(asked.contains("review MG0314") || once.contains("review MG0314"), "{group}: {said}");
        asked.contains("no wait could be written here")
    };
    assert!(!is_open("4001"));
    assert!(is_open("4007"));
}

/// The number stands in the name of the file alone: what the caller is told is what to write where.
#[test]
fn a_program_whose_file_alone_has_its_number_is_found_by_the_reader() {
    let main = format!("O8000\n{HEAD}\nG0 X1.\nM98 P8001\nM30\n");
    let shop = Shop::with(&[("p/a.nc", main.as_str()), ("p/O8001", "G0 X2.\nM99\n"), ("f.toml", FANUC)]);
    let run = shop.run("convert p --from fanuc --to haas --machine f.toml --out out");
    let said = format!("{}{}", run.out, run.err);
    assert!(said.contains("MG0601") && said.contains("write O8001 as its first line"), "{said}");
}

/// Behaviours of a relative are asked by name: it has no parameters of these numbers.
#[test]
fn a_relative_of_another_maker_is_asked_for_no_parameters() {
    let program = format!("O1\n{HEAD}\nG43 H1\nG0 X1.\nG41 D1 X2.\nG40 X3.\nM30\n");
    let said = |settings: &str| convert("--from fanuc --to haas", &program, ("", settings));
    let own = said("");
    assert!(own.contains("5006.6"), "{own}");
    let other = said("[settings]\nown_parameters = \"no\"\n");
    assert!(!other.contains("5006.6 =") && other.contains("\"length.moves\" = "), "{other}");
}
