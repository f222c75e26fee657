//! Which G code system the programs of a lathe show.

use super::*;
use crate::library::understood;

/// What is said of each file, by a profile of a lathe.
fn said(more: &str, files: &[&str]) -> Vec<Option<String>> {
    let inputs = files.iter().enumerate().map(|(at, text)| {
        let name = format!("f{at}.nc");
        Input { path: (&name).into(), name, bytes: text.as_bytes().to_vec() }
    });
    let inputs: Vec<Input> = inputs.collect();
    let control =
        Control::from_profile(&format!("dialect = \"fanuc\"\nmachine = \"lathe\"\n{more}")).unwrap();
    let library = understood(&inputs, &control);
    let told = library.found.iter().map(|found| {
        let of = found.iter().find(|finding| finding.code == Code::CodeSystem)?;
        assert!(of.help.as_ref().unwrap().contains("gcode_system = \"B\" or \"C\""));
        Some(of.message.to_string())
    });
    told.collect()
}

fn shows(block: &str) -> bool {
    let told = said("", &[&format!("O1\nT0101\nG0 X50. Z2.\n{block}\nM30\n")]);
    told[0].is_some()
}

/// By the table of the three systems in facts/fanuc-lathe.md 1.
#[test]
fn codes_that_the_usual_system_has_not() {
    for block in [
        "G77 X48. Z-20. F.2",
        "G78 X48. Z-20. F1.5",
        "G79 X20. Z-1. F.2",
        "G24 X20. Z-1. F.2",
        "G33 Z-20. F1.5",
        "G91 G1 Z-2. F.1",
        "G95 G1 Z-20. F.2",
        "G90 G0 X50. Z2.",
        "G90",
        "G94 G1 Z-20. F100.",
        "G92 S2000",
        "G92 X200. Z100.",
        "G20 X48. Z-20. F.2",
        "G21 X48. Z-20. F1.5",
        "G73 U2. R.5\nG73 P10 Q20 U.4 W.1 F.25\nN10 G0 X40.\nN20 G1 Z-20.",
        "N10 G0 X40.\nN20 G1 Z-20.\nG72 P10 Q20",
    ] {
        assert!(shows(block), "{block}");
    }
}

#[test]
fn codes_of_the_usual_system() {
    for block in [
        "G90 X48. Z-20. F.2\nX46.",
        "G90 U-2. W-20. F.2",
        "G92 X48. Z-20. F1.5\nG92 X47.5",
        "G94 X20. Z-1. F.2",
        "G20 G99 G1 Z-20. F.01",
        "G21",
        "G98 G1 Z-20. F100.",
        "G50 S2000",
        "G32 Z-20. F1.5",
        "G72 W2. R1.\nG72 P10 Q20\nN10 G0 Z-5.\nN20 G1 X20.",
        "G73 U2. W1. R3\nG73 P10 Q20\nN10 G0 X40.\nN20 G1 Z-20.",
        "G71 U2. R1.\nG71 P10 Q20 U.4 W.1 F.2\nN10 G0 X40.\nN20 G1 Z-20.\nG70 P10 Q20",
    ] {
        assert!(!shows(block), "{block}");
    }
}

/// G50 limits the speed in system A alone; in B and C that is G92. Shops write G90 into a line of safe codes as on mills.
#[test]
fn a_limit_of_the_speed_shows_the_usual_system() {
    let safe = "O1\nG18 G20 G40 G80 G90 G99\nT0101\nG0 X50. Z2.\nM30\n";
    let limits = "O2\nT0202\nG50 S2000\nG0 X50. Z2.\nM30\n";
    assert_eq!(said("", &[safe, limits]), [None, None]);
    assert!(said("", &[safe]).iter().all(Option::is_some));
    // So do a thread to a place with its lead, and a return by increments.
    for other in
        ["O3\nT0101\nG0 X50. Z2.\nG92 X47. Z-20. F1.5\nM30\n", "O3\nT0101\nG28 U0 W0\nG0 X50. Z2.\nM30\n"]
    {
        assert_eq!(said("", &[safe, other]), [None, None], "{other}");
    }
    let zero = "O3\nT0101\nG92 X200. Z100.\nG28 X50. Z2.\nM30\n";
    assert!(said("", &[safe, zero]).iter().all(Option::is_some));
    for other in ["G95 G1 Z-20. F.2", "G92 S2000", "G90 G0 X50. Z2.", "G94 G1 Z-20. F100."] {
        let other = format!("O3\nT0101\nG0 X50. Z2.\n{other}\nM30\n");
        assert!(said("", &[safe, limits, &other]).iter().all(Option::is_some), "{other}");
    }
}

#[test]
fn one_code_speaks_for_the_library() {
    let other = "O2\nG98 G1 X5. F100.\nM30\n";
    let counts = "O3\n#500=#500+1\nM99\n";
    let told = said("", &["O1\nG95 G1 Z-2. F.2\nM30\n", other, counts]);
    assert_eq!(
        told[0].as_deref(),
        Some("G code system A is assumed, G95 is no code of it; in B and C it is feed per turn")
    );
    assert!(told[1].as_ref().unwrap().contains("in line 2 of f0.nc, "), "{told:?}");
    // What says nothing to a machine is the same in all of them.
    assert_eq!(told[2], None);
    let profile = "[settings]\ngcode_system = \"B\"";
    assert_eq!(said(profile, &["O1\nG95 G1 Z-2. F.2\nM30\n", other]), [None, None]);
}

/// A profile that says what is in force, in the codes of the system that is assumed: G99 is no code for it in the others.
#[test]
fn what_programs_begin_in_is_said_in_the_assumed_system() {
    let begins = "[start]\ncodes = \"G54 G18 G0 G21 G99\"";
    assert!(said(begins, &["O1\nG40\nG92 S3000\nG0 X5.\nM30\n"])[0].is_some());
    assert_eq!(said(begins, &["O1\nG50 S3000\nG92 X20. Z-5. F1.5\nM30\n"]), [None]);
}

#[test]
fn what_the_profile_says_of_a_code_is_no_sign() {
    let calls = "[parameters]\n6050 = 77";
    assert_eq!(said(calls, &["O1\nG77 X1. Z2.\nM30\n", "O9010\nM99\n"]), [None, None]);
    let site = "[[site]]\ncode = \"G79\"\ntext = \"chuck\"\ndo = \"omit\"";
    assert_eq!(said(site, &["O1\nG79\nM30\n"]), [None]);
}
