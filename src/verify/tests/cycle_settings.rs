//! Cycles that are kept where a setting of the target says how their passes come to the part.

use super::assumed::assumption;
use super::pairs::between;
use crate::assume::{Assumption, Predicate};
use crate::canon::CycleSetting;
use crate::dialect::Control;
use crate::verify::{Outcome, SymbolMap};

const FANUC: &str =
    "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"\ndecimal_point = \"calculator\"\n";
const HAAS: &str = "dialect = \"haas\"\nmachine = \"lathe\"\nunits = \"metric\"\n[settings]\n22 = \"1\"\n73 = \"0.5\"\n86 = \"0.05\"\n95 = \"1\"\n99 = \"0.1\"\n[behaviours]\nroughing.ends = \"along\"\n";

fn differs(source: &str, target: &str, left: &[CycleSetting]) -> bool {
    let supposed: Vec<(usize, Assumption)> =
        left.iter().map(|what| assumption(Predicate::OfMachine(*what))).collect();
    let whole = |body: &str| format!("O1\nG21\nG97S500M3\nG0X34.Z6.\n{body}\nG0X100.\nM30\n");
    let controls = [FANUC, HAAS].map(|profile| Control::from_profile(profile).unwrap());
    let found = between(&controls, [&whole(source), &whole(target)], &SymbolMap::default(), &supposed);
    found[0].outcome == Outcome::Different
}

#[test]
fn what_shapes_the_thread_is_compared() {
    use CycleSetting::{ThreadAllowance, ThreadLeast, ThreadRunOut};
    let source = "G76P012060Q50R0.02\nG76X28.16Z-25.P920Q300F1.5";
    let same = "G76X28.16Z-25.K0.92D0.3F1.5A60P1";
    let left = [ThreadLeast, ThreadAllowance, ThreadRunOut];
    assert!(!differs(source, same, &left));
    for less in [&left[1..], &left[..2], &[left[0], left[2]]] {
        assert!(differs(source, same, less), "{less:?}");
    }
    for other in [
        "G76X28.17Z-25.K0.92D0.3F1.5A60P1",
        "G76X28.16Z-25.01K0.92D0.3F1.5A60P1",
        "G76X28.16Z-25.K0.93D0.3F1.5A60P1",
        "G76X28.16Z-25.K0.92D0.31F1.5A60P1",
        "G76X28.16Z-25.K0.92D0.3F1.51A60P1",
        "G76X28.16Z-25.K0.92D0.3F1.5A55P1",
        "G76X28.16Z-25.K0.92D0.3F1.5A60P3",
        "G76X28.16Z-25.I0.01K0.92D0.3F1.5A60P1",
        "M24\nG76X28.16Z-25.K0.92D0.3F1.5A60P1\nM23",
        "G76X28.16Z-25.K0.92D0.3F1.5A60P1\nG92X28.16Z-25.F1.5\nG0X34.Z6.",
    ] {
        assert!(differs(source, other, &left), "{other}");
    }
}

#[test]
fn a_thread_that_ends_straight_is_none_that_runs_out() {
    let source = "G76P010060Q100R0.05\nG76X28.16Z-25.P920Q300F1.5";
    let left = [CycleSetting::ThreadRunOut];
    assert!(differs(source, "G76X28.16Z-25.K0.92D0.3F1.5A60P1", &left));
    assert!(!differs(source, "M24\nG76X28.16Z-25.K0.92D0.3F1.5A60P1\nM23", &left));
    assert!(!differs(source, "M24\nG76X28.16Z-25.K0.92D0.3F1.5A60P1\nM23", &[]));
}

#[test]
fn what_shapes_a_groove_is_compared() {
    let source = "G75R0.3\nG75X20.Z-3.P2000Q2500F0.1";
    let left = [CycleSetting::PeckRetract];
    assert!(!differs(source, "G75X20.Z-3.I2.K2.5F0.1", &left));
    assert!(differs(source, "G75X20.Z-3.I2.K2.5F0.1", &[CycleSetting::RoughRetract]));
    for other in
        ["X20.1Z-3.I2.K2.5F0.1", "X20.Z-3.1I2.K2.5F0.1", "X20.Z-3.I2.1K2.5F0.1", "X20.Z-3.I2.K2.4F0.1"]
    {
        assert!(differs(source, &format!("G75{other}"), &left), "{other}");
    }
}

#[test]
fn what_shapes_a_roughed_contour_is_compared() {
    let contour = "N1G0X20.\nG1Z-20.\nN2X34.";
    let pair = |target: &str, left: &[CycleSetting]| {
        let source = format!("G71U2.R1.\nG71P1Q2U0.4W0.1F0.2\n{contour}");
        differs(&source, &format!("{target}\n{contour}"), left)
    };
    let left = [CycleSetting::RoughRetract];
    let with = |target: &str| pair(target, &left);
    assert!(pair("G71P1Q2D2.U0.4W0.1F0.2", &[]));
    // How roughing ends is another matter: both profiles of the test say it alike.
    assert!(!with("G71P1Q2D2.U0.4W0.1F0.2"));
    assert!(with("G71P1Q2D2.1U0.4W0.1F0.2"));
    assert!(with("G71P1Q2D2.U0.5W0.1F0.2"));
    assert!(with("G71P1Q2D2.U0.4W0.2F0.2"));
}
