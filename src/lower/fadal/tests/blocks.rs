//! NC blocks.

use super::{found, says};

/// Source and meaning, from the manual's examples and rules.
const BLOCKS: &[(&str, &str)] = &[
    // R variables are set by their sign and used after one, which multiplies.
    ("R8+50.0", "param.8 = 50"),
    ("F+R8", "nc feed=param.8"),
    ("R9+10. R8-18. R7+R6", "param.9 = 10; param.8 = -18; param.7 = param.6"),
    ("R7-R6", "param.7 = -param.6"),
    ("G1 X - R1 Y + R2. F34.", "nc motion.linear axis.x=-param.1 axis.y=param.2 feed=34"),
    ("X + R3. I - R4 J - R5 G3", "nc axis.x=param.3 arc.i=-param.4 arc.j=-param.5 motion.arc.ccw"),
    (
        "G0 G90 S8000 M3 E1 X+R1 Y-R2",
        "nc motion.rapid distance.absolute speed=8000 spindle.cw wcs.select wcs.number=1 axis.x=param.1 axis.y=-param.2",
    ),
    // The radius of an arc is the variable R0, or R alone.
    (
        "G3 X+R6 Y+R6 R0+R6",
        "param.0 = param.6; nc motion.arc.ccw axis.x=param.6 axis.y=param.6 arc.radius=param.6",
    ),
    ("G2 X+R9 Y+R8 F30. R+R7", "nc motion.arc.cw axis.x=param.9 axis.y=param.8 feed=30 arc.radius=param.7"),
    // Away from arcs, cycles and offset writes R0 is a variable only.
    ("G1 X1. R0+R6", "param.0 = param.6; nc motion.linear axis.x=1"),
    // A block under an arc mode without centre and radius is straight; the arc mode stays.
    (
        "G3 X1. I.5\nX2.\nX3. I.5",
        "nc motion.arc.ccw axis.x=1 arc.i=0.5; nc motion.linear axis.x=2; nc motion.arc.ccw axis.x=3 arc.i=0.5",
    ),
    // A full circle has a centre only.
    ("G3 X1. I.5\nI1.", "nc motion.arc.ccw axis.x=1 arc.i=0.5; nc motion.arc.ccw arc.i=1"),
    ("G2\nG1 X1.", "comment; nc motion.linear axis.x=1"),
    // Fixtures: E0 cancels, E7 is the first additional work offset.
    ("G0 E1 X0 Y0", "nc motion.rapid wcs.select wcs.number=1 axis.x=0 axis.y=0"),
    ("E0 X0 Y0 G0", "nc wcs.cancel axis.x=0 axis.y=0 motion.rapid"),
    ("E24", "nc wcs.select wcs.number=118"),
    ("E6", "nc wcs.select wcs.number=6"),
    ("E+R9", "nc wcs.select wcs.number=(param.9 + 94 * truth(param.9 ge 7))"),
    // Lengths: H without a G code; H0 and G49 cancel. H is the row of the diameter too, but for a D beside it.
    ("G0 H1 Z.1 M8", "nc motion.rapid length.plus offset.length=1 offset.radius=1 axis.z=0.1 coolant.flood"),
    ("G0 H1 Z.1 D4", "nc motion.rapid length.plus offset.length=1 axis.z=0.1 offset.radius=4"),
    ("G0 H0 Z0", "nc motion.rapid length.off offset.radius=0 axis.z=0"),
    ("G0 G49 Z0", "nc motion.rapid length.off axis.z=0"),
    ("G0 Z.1 H+R9", "nc motion.rapid axis.z=0.1 length.plus offset.length=param.9 offset.radius=param.9"),
    ("D1", "nc offset.radius=1"),
    ("G1 G41 Y-R4", "nc motion.linear radius.left axis.y=-param.4"),
    // G90 and G91 count for the words after them (seed 000, O600 and O700).
    ("G1 Y+R4 G40 G90", "nc motion.linear axis.y=param.4 radius.off; nc distance.absolute"),
    ("G1 G90 X2. G91 Y1.", "nc distance.absolute motion.linear axis.x=2 step.y=1; nc distance.incremental"),
    ("G1 G91 X2. G90 Y1.", "nc distance.absolute motion.linear step.x=2 axis.y=1"),
    ("G1 G91 G90 Y1. G90", "nc distance.absolute motion.linear axis.y=1"),
    (
        "G1 G91 X1. G91 Y1. G90",
        "nc distance.incremental motion.linear axis.x=1 axis.y=1; nc distance.absolute",
    ),
    ("G0 A-0", "nc motion.rapid axis.a=-0"),
    // Tools, spindle, coolant: in the order they are written in.
    ("T1M6", "nc tool=1 tool.change"),
    ("M6 T+R9", "nc tool.change tool=param.9"),
    ("M5 M9", "nc spindle.stop coolant.off"),
    ("S250. M4", "nc speed=250 spindle.ccw"),
    // The digit after the point of a speed is the belt range.
    ("S500.1", "nc speed=500"),
    ("M7 M8", "nc coolant.mist; nc coolant.flood"),
    ("G4 P500", "nc dwell dwell.ms=500"),
    ("G4 P+R4", "nc dwell dwell.ms=param.4"),
    ("G8 M92", "nc path.ramps.off path.gain"),
    ("M0", "nc stop"),
    ("M64", "nc probe.on"),
    ("M65", "nc probe.tool.on"),
    // Offsets: G10 with its L; R0 is the value.
    ("G91 G10 L02 X2. P1", "nc distance.incremental wcs.write axis.x=2 offset.row=1"),
    ("G10 L10 P1 R0+R8", "param.0 = param.8; nc offset.write.length offset.row=1 offset.value=param.8"),
    ("G10 L2 P7 X1.", "nc wcs.write offset.row=101 axis.x=1"),
    ("G10 L103 P5.", "param.3 = 5"),
    // Probing.
    (
        "G1 G31 X20. Y25. F25. P+R1",
        "nc motion.linear motion.probe axis.x=20 axis.y=25 feed=25 probe.point=param.1",
    ),
    // Drilling: R0 is the plane and keeps its value; M45 drills in place.
    (
        "G81 G99 R0+.1 Z-.6 F40. X2. Y-3.",
        "param.0 = 0.1; nc cycle.drill return.r cycle.r=0.1 axis.z=-0.6 feed=40 axis.x=2 axis.y=-3",
    ),
    ("G81 G99 Z-1.R+0.1 F100. M45", "nc cycle.drill return.r axis.z=-1 cycle.r=0.1 feed=100 cycle.here"),
    (
        "G81 X0 Y0 Z-.75 R0.1 G98 F20.",
        "nc cycle.drill axis.x=0 axis.y=0 axis.z=-0.75 cycle.r=0.1 return.initial feed=20",
    ),
    ("G81 X0 Z-1. F9.", "nc cycle.drill axis.x=0 axis.z=-1 feed=9 cycle.r=param.0"),
    (
        "G83 X0 Z-1. R0+.1 Q.2 F9.",
        "param.0 = 0.1; nc cycle.peck axis.x=0 axis.z=-1 cycle.r=0.1 cycle.q=0.2 feed=9",
    ),
    // I, J, K are pecks beside a peck cycle, also where it is modal.
    (
        "G83 X0 Z-1. R0+.1 I.3 J.1 K.1 F9.\nX1. I.4",
        "param.0 = 0.1; nc cycle.peck axis.x=0 axis.z=-1 cycle.r=0.1 cycle.peck.first=0.3 cycle.peck.less=0.1 cycle.peck.least=0.1 feed=9; nc axis.x=1 cycle.peck.first=0.4",
    ),
    // Tapping of the maker's own format: F is the speed and Q the lead.
    (
        "G84 X0 Z-1. R0+.1 F500. Q.05",
        "param.0 = 0.1; nc cycle.tap.by.lead axis.x=0 axis.z=-1 cycle.r=0.1 speed=500 lead=0.05",
    ),
    (
        "G81 X0 Z-1. R0+.1 F9.\nG91 X.5 L20",
        "param.0 = 0.1; nc cycle.drill axis.x=0 axis.z=-1 cycle.r=0.1 feed=9; nc distance.incremental axis.x=0.5 repeat=20",
    ),
    // The end of a cycle beside an interpolation acts before it; alone it brings back the old one, spelled out.
    ("G90 G80 G40 G0 Z0", "nc distance.absolute cycle.off radius.off motion.rapid axis.z=0"),
    (
        "G0 X0\nG81 X1. Z-1. R0+.1 F9.\nG80\nX2.",
        "nc motion.rapid axis.x=0; param.0 = 0.1; nc cycle.drill axis.x=1 axis.z=-1 cycle.r=0.1 feed=9; nc cycle.off; nc motion.rapid axis.x=2",
    ),
    ("G68 R+R7 X0 Y0", "nc rotate.on rotation.angle=param.7 axis.x=0 axis.y=0"),
    ("G51.1 Y0", "nc mirror.on axis.y=0"),
    ("G50.1", "nc mirror.off"),
    // G17 wraps with a Q, and is the plane without one.
    ("G17 Q+R1", "nc plane.wrap wrap.ratio=param.1"),
    ("G17", "nc plane.xy"),
    ("G28 X0 Y0 Z0", "nc reference.return axis.x=0 axis.y=0 axis.z=0"),
    ("G28", "nc reference.return"),
    ("G5 X1.", "nc motion.rapid.once axis.x=1"),
    // The same value twice is one word.
    ("G0 G49 Z0 E0 X0 Y0 Z0", "nc motion.rapid length.off axis.z=0 wcs.cancel axis.x=0 axis.y=0"),
    ("(ONLY A COMMENT", "comment"),
];

#[test]
fn blocks_mean_what_the_manual_says() {
    for (source, meaning) in BLOCKS {
        assert_eq!(says(&format!("O1\n{source}")), *meaning, "{source}");
    }
}

#[test]
fn what_no_source_says_is_reported_once() {
    assert_eq!(found("O1\nG1 X1\nY2", ""), ["numbers"]);
    assert_eq!(found("O1\nG1 X1\nY2", "decimal_point = \"calculator\""), Vec::<String>::new());
    assert_eq!(found("O1\nG1 X0 Y1.", ""), Vec::<String>::new());
    assert_eq!(found("O1\nG1 X1.\nG3 Y1. I.5", ""), Vec::<String>::new());
    assert_eq!(found("O1\nS500.1", ""), ["SpeedRange"]);
    assert_eq!(found("O1\n/G0 X1.", ""), ["behaviour:skip.levels"]);
    assert_eq!(found("O1\nG28", ""), ["CommonFact"]);
    assert_eq!(found("O1\nG0 Z0 E0 Z0", ""), ["behaviour:word.twice"]);
    assert_eq!(found("O1\nR1+2.\nG1 R2+1. X+R2", ""), ["behaviour:block.assigns.first"]);
    assert_eq!(found("O1\nG0 X0\nG81 X0 Z-1. R0+.1\nR0+.2", ""), ["behaviour:cycle.r0.kept"]);
    assert_eq!(found("O1\nG0 X0\nG81 X0 Z-1. R0+.1\nG68 R30. X0 Y0", ""), ["behaviour:rotation.runs.cycle"]);
}

#[test]
fn what_is_not_understood_refuses_the_program() {
    for source in [
        "G123",           // no row
        "M777",           // no row
        "G1 X1. Z1. Z2.", // which Z counts?
        "G0 G1 X1.",
        "G1 X1. P3.",    // P without a code that takes it
        "G10 L13 P1",    // which table?
        "G1 X+R6 R6+1.", // set behind its use
        "M98",           // no program
        "G1 X1. I.5",    // a centre on a straight line
    ] {
        let found = found(&format!("O1\n{source}"), "");
        assert!(found.contains(&"NotUnderstood".to_owned()), "{source}: {found:?}");
    }
    for (source, code) in [
        ("X1. I.5", "ModalConflict"), // the caller's arc?
        ("G1 X1.\nG81 Z-1. R0+.1\n#IF V1=1 THEN GOTO :A\nG80\n#:A\nX2.", "ModalConflict"), // drills or feeds
        ("#IF V1=1 THEN GOTO :A\nG2 X1. I1.\n#:A\nG90 X2.", "ModalConflict"), // arc or the caller's mode
    ] {
        let found = found(&format!("O1\n{source}"), "");
        assert!(found.contains(&code.to_owned()), "{source}: {found:?}");
    }
}

#[test]
fn a_profile_settles_what_the_table_leaves_open() {
    let lines = super::lowered("O1\nG1 X10\nZ-5", &super::control("decimal_point = \"increments\"")).0;
    assert_eq!(lines[2], "nc motion.linear axis.x=increments(10)");
    assert_eq!(lines[3], "nc axis.z=increments(-5)");
    let lines = super::lowered("O1\n#V1=AX", &super::control("[settings]\nposition_frame = \"work\"")).0;
    assert_eq!(lines[2], "global.1 = sys pos.work[1]");
    let lines = super::lowered("O1\nG84 X0 Z-1. R0+.1 F500.", &super::control("[settings]\nformat = 2")).0;
    assert_eq!(lines[3], "nc cycle.tap axis.x=0 axis.z=-1 cycle.r=0.1 feed=500");
    // What a variable holds that is set without a point would be a guess.
    let found = super::found("O1\nG81 X0 Z-1. R0+1", "decimal_point = \"increments\"");
    assert!(found.contains(&"NotUnderstood".to_owned()), "{found:?}");
}
