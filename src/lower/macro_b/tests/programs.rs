//! Programs of a file, comments, messages, output.

use super::{lowered, means, reviews};
use crate::diag::Code;
use crate::ir::Comment;
use crate::syntax::ProgramName;

fn names(source: &str) -> Vec<Option<ProgramName>> {
    lowered("fanuc", source).programs.into_iter().map(|(program, _)| program.name).collect()
}

#[test]
fn programs_of_a_file() {
    use ProgramName::Number;
    assert_eq!(names(""), []);
    assert_eq!(names("%\n%"), []);
    assert_eq!(names("%\nO1\nM30\nO0002\nM99\n%"), [Some(Number(1)), Some(Number(2))]);
    assert_eq!(names("G0X1.\nM30\nO2\nM99"), [None, Some(Number(2))]);
    assert_eq!(names("(ONLY A COMMENT)"), [None]);
    assert_eq!(names(":1234\nM30"), [Some(Number(1234))]);
    assert!(lowered("fanuc", "%\nO1\nM30\n%").tape);
    assert!(!lowered("fanuc", "O1\nM30").tape);
}

#[test]
fn comments_belong_to_someone() {
    let lowered = lowered("fanuc", "(MAIN PROGRAM)\nO0023(FRAME)\n(NOTE)\nG0X1.(MOVE)\n(AHEAD)G1Y1.F1.\nM30");
    let (program, _) = &lowered.programs[0];
    let comment = |text: &str, leading| Comment { text: text.into(), leading };
    assert_eq!(program.site.comments, [comment("MAIN PROGRAM", true), comment("FRAME", false)]);
    let comments: Vec<_> = program.blocks[0].stmts.iter().map(|stmt| stmt.site.comments.clone()).collect();
    assert_eq!(
        comments,
        [vec![comment("NOTE", true)], vec![comment("MOVE", false)], vec![comment("AHEAD", true)]]
    );
}

#[test]
fn empty_blocks_are_kept() {
    means(
        "haas",
        "#1124=1;\n;\n\nG04 P2.;",
        "0: sys output[24] = 1 | comment | comment | nc dwell dwell.s=2 | stray",
    );
    // One line, two blocks.
    means("haas", "G04 P2.; #1124=0;", "0: nc dwell dwell.s=2 | sys output[24] = 0 | stray");
    means("fanuc", "N25\nN30(TEXT)", "0: comment | comment | stray");
}

#[test]
fn sequence_numbers_stay_with_their_blocks() {
    let lowered = lowered("fanuc", "N25G0X1.\nN30M30");
    let (program, _) = &lowered.programs[0];
    assert_eq!(program.blocks[0].stmts[0].site.sequence.get(), Some(25));
    assert_eq!(program.blocks[0].term.site.sequence.get(), Some(30));
}

#[test]
fn alarms_and_messages() {
    means("fanuc", "#3000=121", "0: alarm 121 \"\" | stray");
    means("fanuc", "N881#3000=1(COOLANT OFF ALARM)", "0: alarm 1 \"COOLANT OFF ALARM\" | stray");
    means("fanuc", "#3006=1 (INSTALL SUPPORT)", "0: stop 1 \"INSTALL SUPPORT\" | stray");
    means(
        "fanuc",
        "IF[#1EQ1]THEN#3000=1(TEXT)",
        "0: branch local.1 eq 1 ? b1 : b2\n1: alarm 1 \"TEXT\" | jump b2\n2: stray",
    );
    let lowered = lowered("fanuc", "#3000=1(TEXT)");
    // The message is no comment as well.
    assert_eq!(lowered.programs[0].0.blocks[0].stmts[0].site.comments, []);
}

#[test]
fn output() {
    means(
        "haas",
        "POPEN\nDPRNT[ANG/#1[44]/**ACTUAL/#139[44]]\nPCLOS",
        "0: port.open | output [\"ANG/\", local.1: 4, 4, \"/  ACTUAL/\", retained.139: 4, 4] | port.close | stray",
    );
    means("fanuc", "DPRNT[-----]", "0: output [\"-----\"] | stray");
    reviews("fanuc", "DPRNT[A B]", &[Code::OutputBlank]);
}
