//! The lock of an output folder: of this library, of one that has grown, and of another one.

use super::{Shop, unmarked};

const TO: &str = "--from fanuc --to haas";

/// The Haas has no #700: it goes to #800, the nearest that is free.
const MACRO: &str = "O9000\nG21\n#700=1.5\nG0 X#700\nM99\n";

/// Has a #800 of its own, which has that number on both controls.
const OWN: &str = "O1000\nG21\n#800=50.\nM98 P9000\nG0 X#800\nM30\n";

fn numbered(program: &str, number: u32) -> String {
    program.replacen("O1000", &format!("O{number}"), 1)
}

#[test]
fn a_variable_moves_where_a_new_program_has_its_register() {
    let shop = Shop::with(&[("lib/macro.nc", MACRO)]);
    shop.run(&format!("convert lib {TO} --out out"));
    assert!(shop.read("out/macroglot.lock").contains("\"#700\" = 800\n"));
    shop.write("lib/main.nc", OWN.as_bytes());
    let run = shop.run(&format!("convert lib {TO} --out out --verbose"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let told = "#700 moves from #800 to #801: this program uses #800 itself";
    assert!(run.err.contains(told), "{}", run.err);
    assert_eq!(unmarked(&shop.read("out/macro.nc")), "O9000\n(#700=#801)\nG21\n#801=1.5\nG0 X#801\nM99\n");
    assert!(shop.read("out/main.nc").contains("G0 X#800\n"));
    assert!(shop.read("out/macroglot.lock").contains("\"#700\" = 801\n"));
    // It stays there: nothing is told or written again.
    let before = shop.files();
    shop.run(&format!("convert lib {TO} --out out"));
    assert!(shop.files() == before);
}

/// The library is there to be read; what relies on the old register is written all the same, and nothing else.
#[test]
fn what_relies_on_a_register_that_moves_is_written_with_the_program_that_is_named() {
    let other = "O7\nG21\nG0 X1.\nM30\n";
    let shop = Shop::with(&[("lib/macro.nc", MACRO), ("lib/other.nc", other)]);
    shop.run(&format!("convert lib {TO} --out out"));
    let before = shop.files();
    shop.write("lib/main.nc", OWN.as_bytes());
    let run = shop.run(&format!("convert lib/main.nc --library lib {TO} --out out"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(run.err.contains("out/macro.nc is written again: a register moved"), "{}", run.err);
    assert_eq!(unmarked(&shop.read("out/macro.nc")), "O9000\n(#700=#801)\nG21\n#801=1.5\nG0 X#801\nM99\n");
    assert!(run.out.contains("2 programs in 2 files") && run.out.contains("2 verified"), "{}", run.out);
    assert_eq!(shop.read("out/other.nc").as_bytes(), before["out/other.nc"]);
}

/// A program that comes alone is told of at its own place.
#[test]
fn one_program_beside_an_earlier_library_is_refused_by_itself() {
    let shop = Shop::with(&[("a/macro.nc", MACRO), ("b/main.nc", OWN)]);
    shop.run(&format!("convert a {TO} --out out"));
    let before = shop.read("out/macro.nc");
    let run = shop.run(&format!("convert b {TO} --out out"));
    assert_eq!(run.code, 1);
    let told =
        "macroglot.lock keeps #800 for #700, and macro.nc relies on it, but this program uses #800 itself";
    assert!(run.out.contains(told), "{}", run.out);
    assert_eq!(shop.read("out/macro.nc"), before);
}

#[test]
fn the_lock_of_another_library_is_told_once_and_nothing_is_written() {
    let shop = Shop::with(&[("a/macro.nc", MACRO)]);
    shop.run(&format!("convert a {TO} --out out"));
    for number in 1001..1006 {
        shop.write(&format!("b/o{number}.nc"), numbered(OWN, number).as_bytes());
    }
    let words = [
        "macroglot.lock: is the lock of another library (macro.nc)",
        "5 programs of this one need registers that it keeps; nothing was written",
        "#800 for #700",
        "use another --out, or delete the lock",
    ];
    shop.fails(&format!("convert b {TO} --out out"), &words);
    // A lock that was copied there is no better.
    shop.write("copied/macroglot.lock", shop.read("out/macroglot.lock").as_bytes());
    shop.fails(&format!("convert b {TO} --out copied"), &words);
    std::fs::remove_file(shop.path("copied/macroglot.lock")).unwrap();
    assert!(shop.run(&format!("convert b {TO} --out copied")).code < 2);
    assert!(shop.path("copied/o1001.nc").exists());
    // Both in one run are one library.
    let run = shop.run(&format!("convert a b {TO} --out out"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(shop.read("out/macroglot.lock").contains("\"#700\" = 801\n"));
}

/// Where its registers are in nobody's way, two libraries share a folder.
#[test]
fn a_lock_of_another_library_that_is_in_nobodys_way_is_kept_to() {
    let shop = Shop::with(&[("a/macro.nc", MACRO)]);
    shop.run(&format!("convert a {TO} --out out"));
    for number in 1001..1004 {
        let text = numbered(&OWN.replace("#800", "#701"), number);
        shop.write(&format!("b/o{number}.nc"), text.replace("M98 P9000\n", "").as_bytes());
    }
    let run = shop.run(&format!("convert b {TO} --out out"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    let lock = shop.read("out/macroglot.lock");
    assert!(lock.contains("\"#700\" = 800\n") && lock.contains("\"#701\" = 801\n"), "{lock}");
}

/// What has no conversion in the folder relies on nothing there.
#[test]
fn a_conversion_that_was_taken_away_keeps_no_register() {
    let shop = Shop::with(&[("lib/macro.nc", MACRO), ("lib/z.nc", "O8\nG21\nG0 X1.\nM30\n")]);
    shop.run(&format!("convert lib {TO} --out out"));
    std::fs::rename(shop.path("lib/z.nc"), shop.path("lib/y.nc")).unwrap();
    shop.run(&format!("convert lib {TO} --out out"));
    shop.write("lib/main.nc", OWN.as_bytes());
    // The conversion of z.nc may still be on the machine.
    let run = shop.run(&format!("convert lib {TO} --out out"));
    assert!(run.out.contains("z.nc relies on it"), "{}", run.out);
    let run = shop.run(&format!("convert lib {TO} --out out --prune"));
    assert_eq!(run.code, 0, "{}{}", run.out, run.err);
    assert!(shop.read("out/macroglot.lock").contains("\"#700\" = 801\n"));
}
