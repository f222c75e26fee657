//! Macro lines.

use super::{found, says};

/// Source and meaning, from the manual's examples and rules.
const STATEMENTS: &[(&str, &str)] = &[
    ("#V88 = V2 + V3", "global.88 = global.2 + global.3"),
    ("#V10=3/V12", "global.10 = 3 / global.12"),
    // Every subscript names V5 where V1=5 and V2=1.
    ("#V(5)=1", "global.5 = 1"),
    ("#V(V1)=1", "global[global.1] = 1"),
    ("#V(V1+V2-1)=1", "global[global.1 + global.2 - 1] = 1"),
    ("#V(V(SQR(V2)))=1", "global[global[sqrt(global.2)]] = 1"),
    ("#R3 = V2 * V17", "param.3 = global.2 * global.17"),
    ("#R(V1)=2", "param[global.1] = 2"),
    ("#V2 = ABS (V1)", "global.2 = abs(global.1)"),
    ("#V100 = INT(V23)", "global.100 = fix(global.23)"),
    ("#V50 = SGN (V77 - V78)", "global.50 = sign(global.77 - global.78)"),
    ("#V46 = SQR(9)", "global.46 = sqrt(9)"),
    ("#V12 = SIN(30) / COS(30)", "global.12 = sin(30) / cos(30)"),
    ("#V5 = ATN (V6/V7)", "global.5 = atan(global.6 / global.7)"),
    ("#V10=-(ABS(V6)-V5)", "global.10 = -(abs(global.6) - global.5)"),
    ("#SET RND4\n#V1 = RND(V1)", "global.1 = round.places(global.1, 4)"),
    (
        "#SET RAD\n#V1=SIN(V2)\n#SET DEG\n#V1=SIN(V2)",
        "global.1 = sin(global.2 * 57.29577951308232); global.1 = sin(global.2)",
    ),
    (
        "#SET RADIANS\n#V2=ATN(V1)\n#SET\n#V2=ATN(V1)",
        "global.2 = atan(global.1) * 0.017453292519943295; global.2 = atan(global.1)",
    ),
    // State of the machine.
    ("#V1=TN", "global.1 = sys tool.active"),
    ("#V1=TT3", "global.1 = sys tool.time.limit[3]"),
    ("#TU(R9)=0", "sys tool.time.used[param.9] = 0"),
    ("#D2 = D2 + .01", "sys offset.diameter.or.radius[2] = sys offset.diameter.or.radius[2] + 0.01"),
    ("#H33 = H33 - 16.", "sys offset.length[33] = sys offset.length[33] - 16"),
    ("#H99=H(R8)+FZ23", "sys offset.length[99] = sys offset.length[param.8] + sys wcs[117, 3]"),
    ("#FX1 = FX1 - 2.", "sys wcs[1, 1] = sys wcs[1, 1] - 2"),
    ("#V1=FY(V2)", "global.1 = sys wcs[round(global.2) + 94 * truth(round(global.2) ge 7), 2]"),
    ("#V1=PZ2", "global.1 = sys pos.probe[3, 2]"),
    ("#V1=G(1)", "global.1 = sys modal.motion.plus.one"),
    ("#V1=G(7)", "global.1 = sys modal.cycle.plane"),
    ("#V1=I(3)", "global.1 = sys input.inverted[3]"),
    ("#O(2) = 1", "sys output.inverted[2] = 1"),
    // HO(6) is W, HO(7) is A: axes 9 and 4.
    ("#V1=HO(6)", "global.1 = sys reference.offset[9]"),
    ("#V1=HO(7)", "global.1 = sys reference.offset[4]"),
    // Talking to the operator.
    ("#PRINT \"PART \",V10,", "print [\"PART \", global.10] stay"),
    ("#SPRINT \"DATA\"", "print serial [\"DATA\"]"),
    ("#INPUT V100", "input global.100"),
    ("#SINPUT R1", "input serial param.1"),
    ("#WAIT", "sync"),
    ("#CLEAR", "clear global"),
    ("#CLEAR V1", "global.1 = 0"),
    ("#CLEAR V3-V5,V15", "global.3 = 0; global.4 = 0; global.5 = 0; global.15 = 0"),
];

#[test]
fn statements_mean_what_the_manual_says() {
    for (source, meaning) in STATEMENTS {
        assert_eq!(says(&format!("O1\n{source}")), *meaning, "{source}");
    }
}

/// Conditions and what they are in the common form.
const CONDITIONS: &[(&str, &str)] = &[
    ("V1 <> 10", "global.1 ne 10"),
    ("V1 NE 10", "global.1 ne 10"),
    ("V1*V2=V3", "global.1 * global.2 eq global.3"),
    ("H16 <-10.67", "sys offset.length[16] lt -10.67"),
    ("(V1 GT V2) AND (V1 LT V3)", "all(global.1 gt global.2, global.1 lt global.3)"),
    ("(V1 GE V2) OR (V1 LE V3)", "any(global.1 ge global.2, global.1 le global.3)"),
    ("NOT(V1=0)", "not(global.1 eq 0)"),
    ("V1", "global.1 ne 0"),
];

#[test]
fn conditions_branch() {
    for (source, meaning) in CONDITIONS {
        let source = format!("O1\n#IF {source} THEN V7=1");
        let (lines, _) = super::lowered(&source, &super::control(""));
        let branch = format!("branch {meaning} ? block1 : block2");
        let rest = ["block1:", "global.7 = 1", "jump block2", "block2:", "stray", "}"];
        assert_eq!(lines[1..3], ["block0:".to_owned(), branch], "{source}");
        assert_eq!(lines[3..], rest, "{source}");
    }
}

#[test]
fn facts_of_macro_lines_are_reported() {
    assert_eq!(found("O1\n#V1=SIN(V2)", ""), ["behaviour:angles.unit"]);
    assert_eq!(found("O1\n#SET DEG\n#V1=SIN(V2)", ""), Vec::<String>::new());
    // 1/2 may be 0 or .5; 4/2 is 2 either way; V1 is no constant.
    assert_eq!(found("O1\n#V1=1/2", ""), ["behaviour:integer.divides"]);
    assert_eq!(found("O1\n#V1=4/2\n#V2=1./2\n#V3=V1/2", ""), Vec::<String>::new());
    assert_eq!(found("O1\n#V100=1", ""), Vec::<String>::new());
    assert_eq!(found("O1\n#PRINT V1", ""), ["behaviour:print.format"]);
    assert!(found("O1\n#IF V1 THEN V2=1", "").contains(&"behaviour:number.is.condition".to_owned()));
    assert_eq!(found("O1\n#V1=AX", ""), ["EarlyRead", "behaviour:position.frame"]);
    assert_eq!(found("O1\n#WAIT\n#V1=AX", ""), ["behaviour:position.frame"]);
    assert_eq!(found("O1\n#V1=V(V1/V2)", ""), ["behaviour:index.of.fraction"]);
    let mixed = found("O1\n#IF (V1=0) OR (V2=0) AND (V3=0) THEN V4=1", "");
    assert!(mixed.contains(&"behaviour:logic.rank".to_owned()), "{mixed:?}");
}

#[test]
fn a_jump_back_in_a_called_program_is_asked() {
    let asked = |text: &str| found(text, "").contains(&"behaviour:m99.p.in.called".to_owned());
    assert!(asked("O1\nM99 P5\nN5 M99"));
    assert!(!asked("O1\nM99 P5\nN5 M2"));
}

#[test]
fn what_cannot_be_known_is_refused() {
    for (source, code) in [
        ("#INDEX \"M1 A90. F300.\"", "Indexer"),
        ("#V1=RND(V1)", "ModalConflict"),
        ("#IF V1=1 THEN SET RAD\n#V2=SIN(V3)", "ModalConflict"),
        ("#IF V1=1 THEN SET RND3\n#SET DEG\n#V2=RND(V3)", "ModalConflict"),
        ("#V101=1", "NotUnderstood"),
        ("#R10=1", "NotUnderstood"),
        ("#TN=1", "NotUnderstood"),
        ("#FX49=1", "NotUnderstood"),
    ] {
        let found = found(&format!("O1\n{source}"), "");
        assert!(found.contains(&code.to_owned()), "{source}: {found:?}");
    }
}

#[test]
fn a_jump_to_nowhere_is_an_alarm() {
    for source in ["#GOTO :NOWHERE", "#GOTO N77", "M99 P77"] {
        let found = found(&format!("O1\n{source}"), "");
        assert_eq!(found, ["TargetMissing", "behaviour:goto.missing.alarms"], "{source}");
    }
    // So is a call of a subroutine that the program does not have.
    assert!(found("O1\nL301", "").contains(&"TargetMissing".to_owned()));
}
