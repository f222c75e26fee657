//! Short arithmetic: what the makers' error bounds leave open, and what they do not.
//!
//! Bounds: the Haas class has 6/2 anywhere up to 3.000001 and 6/2+6/2 between 5.999998 and 6.000002 (seed 002:516);
//! the Fanuc manual has 0.002*1000 at 1.99999997 with 8 digits (seed 001:1452). Whole numbers that are added and
//! multiplied are exact in either. The sums of tenths below were worked out in single precision by hand.

use super::*;

const DIGIT: &str = "machine:arithmetic.last.digit";

/// What the last digit may decide, on a Haas and on a Fanuc with 8 digits; never on one with doubles.
#[track_caller]
fn open(statements: &str, expected: bool) {
    let text = format!("O1\n{statements}\nM30\nN9G0X9.\nM30\n");
    let tables = [haas(&text), fanuc_with("6008.0 = 1", &text)];
    for run in &tables {
        assert_eq!(doubts(run, DIGIT), expected, "{statements}: {:#?}", run.events);
    }
    assert!(!doubts(&fanuc(&text), DIGIT), "{statements}");
}

#[test]
fn what_the_makers_examples_leave_open_is_told() {
    for statements in [
        "#1=6/2\nIF[#1EQ3]GOTO9",
        "#1=6/2+6/2\nIF[#1EQ6]GOTO9",
        "#1=6/2\n#2=#1+3\n#3=#2-6\nIF[#3GT0]GOTO9",
        "#1=0.002\n#2=#1*1000\n#3=FIX[#2]",
        "#100=0.002\n#101=#100*1000\nIF[#101GE2]GOTO9",
        // Ten times a tenth: 1.0000001 in 24 bits, 0.9999999999999999 in 53.
        "#1=0\nWHILE[#1LT1]DO1\n#1=#1+0.1\nEND1",
        "#1=10\n#[#1/2.5]=1",
        "#1=SIN[30]\nIF[#1EQ0.5]GOTO9",
        "#1=3\n#2=ATAN[#1]/[#1]\nIF[#2EQ45]GOTO9",
        "#1=6/2-3\n#2=SQRT[ABS[#1]]\nIF[#2NE0]GOTO9",
        "#1=5/2\n#2=ROUND[#1]",
    ] {
        open(statements, true);
    }
}

#[test]
fn what_no_bound_leaves_open_is_not_told() {
    for statements in [
        "#1=0\nWHILE[#1LT10]DO1\n#1=#1+1\nEND1",
        "#1=0\nWHILE[#1LT2]DO1\n#1=#1+0.25\nEND1",
        // Half a step off every sum of tenths.
        "#1=0\nWHILE[#1LT0.95]DO1\n#1=#1+0.1\nEND1",
        "#1=0.1\nIF[#1EQ0.1]GOTO9",
        "#1=6/2\nIF[#1GT2.9]GOTO9",
        "#1=6/2\nIF[ROUND[#1]EQ3]GOTO9",
        "#1=0.002\n#2=FIX[#1*1000+0.001]",
        "#1=7\nIF[#1EQ7]GOTO9",
        "#1=10\n#[#1*10+1]=2",
        "#1=50\nG90G0X[#1*COS[30]]Y[#1*SIN[30]]",
    ] {
        open(statements, false);
    }
}

/// Near 123 the numbers of 24 binary digits are 7.6e-6 apart (2^-17), so that both constants may be the one value
/// 123.45679 to the control; near 2^24 they are one apart.
#[test]
fn a_constant_of_more_digits_is_rounded_when_read() {
    let open = |statements: &str| doubts(&haas(&format!("O1\n{statements}\nN9M30\n")), DIGIT);
    assert!(open("#1=123.456789\nIF[#1EQ123.456788]GOTO9"));
    assert!(open("#1=16777217\nIF[#1GT16777216]GOTO9"));
    assert!(open("#1=1234567.89\n#2=FIX[#1*10-12345678]"));
    assert!(!open("#1=123.4567\nIF[#1EQ123.4566]GOTO9"));
    assert!(!open("#1=123.456789\nIF[#1GT123.4]GOTO9"));
    assert!(!open("#1=16777216\nIF[#1EQ16777216]GOTO9"));
}

/// 3.333 and 3.333000333 are one value in seven digits.
#[test]
fn a_value_of_the_machine_is_rounded_when_read() {
    let open = |value: &str| {
        doubts(&haas(&format!("O1\nG21\n#2001={value}\nIF[#2001EQ3.333]GOTO9\nN9M30\n")), DIGIT)
    };
    assert!(!open("3.333"));
    assert!(open("3.333000333"));
    let profile = "dialect = \"haas\"\n[settings]\narithmetic = \"double\"\n";
    let doubles = Control::from_profile(profile).expect("a profile");
    let text = "O1\n#1=123.456789\nIF[#1EQ123.456788]GOTO9\nN9M30\n";
    assert!(!doubts(&run_on(&doubles, &[text], &Scenario::default()), DIGIT));
}

/// What an argument, a repeated macro, and a shared variable carry is as far off as it was.
#[test]
fn errors_go_along_with_values() {
    for text in [
        "O1\nG65P2A[6/2]\nM30\nO2\nIF[#1EQ3]GOTO9\nN9M99\n",
        "O1\n#100=6/2\nG65P2\nM30\nO2\nIF[#100EQ3]GOTO9\nN9M99\n",
        "O1\n#1=6/2\n#100=1\nG65P2B1.\nIF[#1EQ3]GOTO9\nN9M30\nO2\n#1=5\nM99\n",
    ] {
        assert!(doubts(&haas(text), DIGIT), "{text}");
    }
    let fresh = "O1\n#1=6/2\nG65P2A3.\nM30\nO2\nIF[#1EQ3]GOTO9\nN9M99\n";
    assert!(!doubts(&haas(fresh), DIGIT));
    let again = "O1\n#100=6/2\n#100=3\nIF[#100EQ3]GOTO9\nN9M30\n";
    assert!(!doubts(&haas(again), DIGIT));
}

/// 10000/3 inches have their seventh digit in the third place; an increment is a ten-thousandth.
#[test]
fn a_place_is_told_where_it_may_be_another_one() {
    assert!(doubts(&haas("O1\nG20G90G0X[10000/3]\nM30\n"), DIGIT));
    assert!(!doubts(&haas("O1\nG20G90G0X[10/3]\nM30\n"), DIGIT));
}

#[test]
fn a_corner_stands_beside_one_cut() {
    let corner = |block: &str| {
        let run = haas(&format!("O1\nG21G90G0X0Y0\nF100.\n{block}\nX30.Y9.\nM30\n"));
        let sizes = run.events.iter().filter_map(|event| match event.what {
            EventKind::Corner { chamfer, size } => Some((chamfer, size)),
            _ => None,
        });
        (sizes.collect::<Vec<_>>(), doubts(&run, "machine:corner.elsewhere"))
    };
    assert_eq!(corner("G1X50.,R5."), (vec![(false, 5.0)], false));
    assert_eq!(corner("#1=2\nG1X50.,C[#1*2]"), (vec![(true, 4.0)], false));
    for elsewhere in ["G0X50.,R5.", ",R5.", "G4P1.,C2.", "G81X1.Z-1.R1.F10.,R2.\nG80", "G28X0.,R1."] {
        assert_eq!(corner(elsewhere), (vec![], true), "{elsewhere}");
    }
    assert_eq!(corner("G1X50.,R5.,C2."), (vec![(false, 5.0), (true, 2.0)], true));
}
