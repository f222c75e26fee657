//! NC words.

use super::{lowered, means, refuses, rests_on, reviews, told};
use crate::diag::Code;

#[test]
fn decimal_points() {
    means("fanuc", "G0X10", "0: nc motion.rapid axis.x=increments(10) | stray");
    means("fanuc", "G0X-10", "0: nc motion.rapid axis.x=increments(-10) | stray");
    means("fanuc", "G0X10.", "0: nc motion.rapid axis.x=10 | stray");
    means("fanuc", "G0X0Y-.5", "0: nc motion.rapid axis.x=0 axis.y=-0.5 | stray");
    // A value that is computed, or stands in brackets, counts whole units.
    means("fanuc", "#1=10\nX#1", "0: local.1 = 10 | nc axis.x=local.1 | stray");
    means("fanuc", "G00X[.5]Y[10]", "0: nc motion.rapid axis.x=0.5 axis.y=10 | stray");
    means("fanuc:decimal_point = \"calculator\"", "G0X10", "0: nc motion.rapid axis.x=10 | stray");
    rests_on("fanuc", "G0X10\nX20\nX30", "numbers");
    assert_eq!(told("fanuc:decimal_point = \"increments\"", "G0X10", "numbers"), 0);
    means("haas", "G0X5", "0: nc motion.rapid axis.x=increments(5) | stray");
}

#[test]
fn computed_words() {
    means("fanuc", "G00G91X-#1", "0: nc motion.rapid distance.incremental axis.x=-local.1 | stray");
    means("fanuc", "G01Z#501F#9", "0: nc motion.linear axis.z=retained.501 feed=local.9 | stray");
    means("fanuc", "G00X[#1+#2]", "0: nc motion.rapid axis.x=(local.1 + local.2) | stray");
    means("fanuc", "M03S[1000.5]", "0: nc spindle.cw speed=1001 | stray");
    means("fanuc", "M03S#1", "0: nc spindle.cw speed=local.1 | stray");
    means(
        "fanuc",
        "G01X-[#501*0.9]F3000.,R10.",
        "0: nc motion.linear axis.x=-(retained.501 * 0.9) feed=3000 corner.radius=10 | stray",
    );
    means("fanuc", "X[#1](NOTE)Y[#2]", "0: nc axis.x=local.1 axis.y=local.2 | stray");
    rests_on("fanuc", "X[#1]", "behaviour:bracket.vacant.word");
    assert_eq!(told("fanuc", "X#1", "behaviour:bracket.vacant.word"), 0);
}

#[test]
fn computed_codes() {
    means("fanuc", "G#10X1.2", "0: nc G=local.10 axis.x=1.2 | stray");
    // Whether the target means the same by each value is for legalization to say.
    reviews("fanuc", "M#120", &[]);
}

#[test]
fn operands_of_codes() {
    means("fanuc", "G90G54X1.", "0: nc distance.absolute wcs.select wcs.number=1 axis.x=1 | stray");
    means("fanuc", "G59", "0: nc wcs.select wcs.number=6 | stray");
    means("fanuc", "G54.1P3", "0: nc wcs.select wcs.number=103 | stray");
    means("haas", "G154P2", "0: nc wcs.select wcs.number=102 | stray");
    means("fanuc", "G43Z25.0H01M08", "0: nc length.plus axis.z=25 offset.length=1 coolant.flood | stray");
    means("haas", "G10L2P1X1.", "0: nc wcs.write offset.row=1 axis.x=1 | stray");
    means("fanuc", "G28Z25.0M05", "0: nc reference.return axis.z=25 spindle.stop | stray");
}

#[test]
fn dwells() {
    means("fanuc", "G4P500", "0: nc dwell dwell.ms=500 | stray");
    means("haas", "G04 P2", "0: nc dwell dwell.ms=2 | stray");
    means("haas", "G04 P2.", "0: nc dwell dwell.s=2 | stray");
    refuses("fanuc", "G4P2.", &[Code::NotUnderstood]);
    rests_on("haas", "G04 P#1", "behaviour:dwell.expression");
}

#[test]
fn roles_by_the_code_in_force() {
    means(
        "fanuc",
        "G81R2.5Z-14.7F150.L0\nX1.R3.\nG80\nG2X1.Y1.R5.",
        "0: nc cycle.drill cycle.r=2.5 axis.z=-14.7 feed=150 repeat=0 | nc axis.x=1 cycle.r=3 | nc cycle.off \
         | nc motion.arc.cw axis.x=1 axis.y=1 arc.radius=5 | stray",
    );
    // The code of the block decides before the one in force.
    means(
        "fanuc",
        "G82R1.Z-1.P200\nG4P300",
        "0: nc cycle.drill.dwell cycle.r=1 axis.z=-1 cycle.dwell=200 | nc dwell dwell.ms=300 | stray",
    );
    // A jump may come in with another code in force.
    reviews("fanuc", "G81R2.Z-1.\nN10X1.R3.\nIF[#1EQ1]GOTO10", &[Code::ModalAssumed]);
    reviews("fanuc", "N10G81R2.Z-1.\nX1.R3.\nIF[#1EQ1]GOTO10", &[]);
}

#[test]
fn words_without_a_meaning() {
    refuses("fanuc", "G0X1.Q5.", &[Code::NotUnderstood]);
    refuses("fanuc", "G777", &[Code::NotUnderstood]);
    refuses("fanuc", "M05.5", &[Code::NotInteger]);
    refuses("fanuc", "G0H1.5", &[Code::NotUnderstood]);
    reviews("fanuc", "G43H1.", &[Code::WholeWithPoint]);
}

#[test]
fn lathe_programs() {
    refuses("fanuc", "G28U0", &[Code::LatheProgram]);
    refuses("fanuc", "G50S3000", &[Code::LatheProgram]);
    refuses("fanuc", "T0303", &[Code::LatheProgram]);
    means("fanuc", "T0303 M6", "0: nc tool=303 tool.change | stray");
    means("fanuc:machine = \"lathe\"", "G1U5.0", "0: nc motion.linear step.x=5 | stray");
    means("fanuc", "T12M6", "0: nc tool=12 tool.change | stray");
    means("fanuc", "T0012M6", "0: nc tool=12 tool.change | stray");
}

#[test]
fn blocks_that_say_things_twice() {
    means("fanuc", "G0G1X1.", "0: nc motion.linear axis.x=1 | stray");
    reviews("fanuc", "G0G1X1.", &[Code::GroupTwice]);
    let second = |source: &str| {
        let lowered = lowered("fanuc", source);
        let mut all = lowered.programs.iter().flat_map(|(_, findings)| findings);
        all.find(|finding| finding.code == Code::GroupTwice).map(|finding| finding.message.to_string())
    };
    let says = |code: &str, does: &str| {
        Some(format!(
            "{code} is the second code of its group in this block, and counts, as the later one: {does}"
        ))
    };
    assert_eq!(second("G91G28Z0G90"), says("G90", "the axis goes to Z0 of the work first, then home"));
    assert_eq!(second("G91G90G30X0.Y#1"), says("G90", "the axes go to X0 Y of the work first, then home"));
    assert_eq!(
        second("G90G28Z5.G91"),
        says("G91", "the axis moves by Z5 from where the tool stands first, then home")
    );
    assert_eq!(second("G91G53Z-10.G90"), says("G90", "the axis goes to Z-10 of the machine"));
    let plain = "G90 is the second code of its group in this block: the second one counts";
    assert_eq!(second("G91G0Z0G90").as_deref(), Some(plain));
    reviews("fanuc", "G80G0X1.", &[]);
    means("fanuc", "X1.X2.", "0: nc axis.x=2 | stray");
    reviews("fanuc", "X1.X2.", &[Code::WordTwice]);
    reviews("haas", "M5M9", &[Code::MCodes]);
    rests_on("fanuc", "M5M9\nM3M8", "behaviour:m.codes.per.block");
}

#[test]
fn look_ahead() {
    means("haas", "G103 P1", "0: lookahead 1 | stray");
    means("haas", "G103", "0: lookahead 0 | stray");
}

#[test]
fn builders_codes_keep_their_numbers() {
    means("fanuc", "M290", "0: nc M=290 | stray");
}

#[test]
fn a_round_pocket_names_its_circles() {
    // I: the first circle, K: the last one, Q: the step between them.
    means("haas", "G12I1.F10.", "0: nc pocket.circle.cw pocket.first=1 feed=10 | stray");
}

#[test]
fn a_fact_is_said_once_a_program() {
    rests_on("fanuc", "G82R1.Z-1.\nG82R1.Z-1.\nG82R1.Z-1.", "code:G82");
    assert_eq!(told("fanuc", "O1\nG82R1.Z-1.\nM30\nO2\nG82R1.Z-1.\nM30", "code:G82"), 2);
}

#[test]
fn signed_variables_that_may_be_vacant() {
    const FACT: &str = "behaviour:bracket.vacant.word";
    rests_on("fanuc", "G0X-#1", FACT);
    rests_on("fanuc", "#1=2.\nG0X-#[#1]", FACT);
    rests_on("fanuc", "#1=#2\nG0X-#1", FACT);
    assert_eq!(told("fanuc", "#1=2.\nG0X-#1", FACT), 0);
    assert_eq!(told("fanuc", "#2=3.\n#1=#2\nG0X-#1", FACT), 0);
    // Tests exclude vacancy, on the one side or on the other.
    assert_eq!(told("fanuc", "IF[#4LE0]GOTO9\nG0X-#4\nN9M30", FACT), 0);
    assert_eq!(told("fanuc", "IF[#4EQ#0]GOTO9\nG0X-#4\nN9M30", FACT), 0);
    assert_eq!(told("fanuc", "IF[#4LT0]GOTO9\nG0X-#4\nN9M30", FACT), 1);
    assert_eq!(told("fanuc", "IF[#4NE#0]GOTO9\nG0X-#4\nN9M30", FACT), 1);
    // A subprogram shares the locals, a macro does not; commons are everyone's.
    assert_eq!(told("haas", "#1=2.\nM98 P1\nG0X-#1", FACT), 1);
    assert_eq!(told("haas", "#1=2.\nG65 P1\nG0X-#1", FACT), 0);
    assert_eq!(told("haas", "#101=2.\nG65 P1\nG0X-#101", FACT), 1);
}

/// Whether the macro finds such an argument vacant or 0 no source says.
#[test]
fn signed_variables_in_arguments_that_may_be_vacant() {
    const FACT: &str = "machine:argument.signed";
    rests_on("fanuc", "G65P2A-#9B1.", FACT);
    rests_on("haas", "G65P2A-#9B1.", FACT);
    rests_on("fanuc", "G66P2A-#9", FACT);
    assert_eq!(told("fanuc", "G65P2A#9B1.", FACT), 0);
    assert_eq!(told("fanuc", "#9=2.\nG65P2A-#9B1.", FACT), 0);
    assert_eq!(told("fanuc", "IF[#9EQ#0]GOTO9\nG65P2A-#9\nN9M30", FACT), 0);
    assert_eq!(told("fanuc", "G65P2A[0-#9]", FACT), 0);
}
