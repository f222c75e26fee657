//! Jumps, conditions, loops, block skip.

use super::{means, refuses, rests_on, reviews};
use crate::diag::Code;

#[test]
fn jumps() {
    means("fanuc", "GOTO 9\nN9M30", "0: jump b1\n1 N9: end rewind");
    // Leading zeros do not count.
    means("fanuc", "GOTO0003\nN03M30", "0: jump b1\n1 N3: end rewind");
    means(
        "fanuc",
        "IF[#1EQ#2]GOTO9\nM30\nN9M2",
        "0: branch local.1 eq local.2 ? b2 : b1\n1: end rewind\n2 N9: end",
    );
    means(
        "fanuc",
        "O9609IF[#1GT1]GOTO100\nN100M99",
        "0: branch local.1 gt 1 ? b2 : b1\n1: jump b2\n2 N100: return",
    );
    means(
        "fanuc",
        "N02 #768=#601 (for T31) GOTO08\nN08M30",
        "0: jump b1\n1 N2: retained.768 = retained.601 | jump b2\n2 N8: end rewind",
    );
    rests_on("fanuc", "N02 #768=#601 GOTO08\nN08M30", "behaviour:statement.shares.block");
    // Nothing has the number: an alarm when it gets there, once for each number.
    means(
        "fanuc",
        "IF[#1EQ0]GOTO5\nIF[#1EQ1]GOTO7\nIF[#1EQ2]GOTO5\nM30",
        "0: branch local.1 eq 0 ? b4 : b1\n1: branch local.1 eq 1 ? b5 : b2\n2: branch local.1 eq 2 ? b4 : b3\n\
         3: end rewind\n4: alarm 1 \"NO BLOCK N5\" | end\n5: alarm 1 \"NO BLOCK N7\" | end",
    );
    reviews("fanuc", "GOTO5", &[Code::TargetMissing]);
}

#[test]
fn numbers_that_stand_twice() {
    // Ahead first, then from the head.
    means("fanuc", "N10#1=1\nGOTO10\nN10M30", "0: jump b1\n1 N10: local.1 = 1 | jump b2\n2 N10: end rewind");
    means(
        "fanuc",
        "N10#1=1\nN10#1=2\nGOTO10",
        "0: jump b1\n1 N10: local.1 = 1 | jump b2\n2 N10: local.1 = 2 | jump b1",
    );
    reviews("fanuc", "N10#1=1\nGOTO10\nN10M30", &[Code::TargetTwice]);
    // A remembered number wins with MGO.
    means(
        "fanuc:[parameters]\n6000.1 = 1",
        "N10#1=1\nGOTO10\nN10M30",
        "0: jump b1\n1 N10: local.1 = 1 | jump b1\n2 N10: end rewind",
    );
    reviews("haas", "N10 #1=1\nGOTO10\nN10 M30", &[Code::TargetTwice]);
    // One in another program of the file is another label.
    means(
        "fanuc",
        "O1\nGOTO10\nN10M30\nO2\nGOTO10\nN10M99",
        "0: jump b1\n1 N10: end rewind\n0: jump b1\n1 N10: return",
    );
}

#[test]
fn computed_jumps() {
    means(
        "fanuc",
        "GOTO#149\nN10M30\nN20M2",
        "0: computed common.149 {10: b1, 20: b2}\n1 N10: end rewind\n2 N20: end",
    );
    means("haas", "GOTO[#100*100]\nN100 M30", "0: computed retained.100 * 100 {100: b1}\n1 N100: end rewind");
    rests_on("fanuc", "GOTO#149\nN10M30", "statement:goto.computed");
}

#[test]
fn only_programs_that_jump_have_labels() {
    means("fanuc", "N10G0X1.\nN20X2.\nM30", "0: nc motion.rapid axis.x=1 | nc axis.x=2 | end rewind");
}

#[test]
fn conditional_statements() {
    means(
        "fanuc",
        "N230IF[#609GT0]#712=#609",
        "0: branch retained.609 gt 0 ? b1 : b2\n1: retained.712 = retained.609 | jump b2\n2: stray",
    );
    reviews("fanuc", "IF[#609GT0]#712=#609", &[Code::ThenMissing]);
    means(
        "haas",
        "IF [ #21 EQ #22 ] THEN #7= [ #17 * 0.9 ] S [ #18 * 0.85 ]",
        "0: branch local.21 eq local.22 ? b1 : b2\n1: local.7 = local.17 * 0.9 | nc speed=(local.18 * 0.85) | jump b2\n2: stray",
    );
    means(
        "haas",
        "IF [#598 NE 1.] G65 P9725",
        "0: branch retained.598 ne 1 ? b1 : b3\n1: call O9725 level -> b2\n2: jump b3\n3: stray",
    );
    refuses("fanuc", "IF[#1EQ1]THENG0X1.", &[Code::NotUnderstood]);
}

#[test]
fn conditional_returns() {
    means(
        "haas",
        "N10 #1=1\nN50 [#100 LT 10] M99 P10\nM30",
        "0: jump b1\n1 N10: local.1 = 1 | jump b2\n2 N50: branch retained.100 lt 10 ? b3 : b4\n3: jump b1\n4: end rewind",
    );
}

#[test]
fn loops() {
    means(
        "fanuc",
        "WHILE[#2LE10]DO1\n#1=#1+#2\n#2=#2+1\nEND1\nM30",
        "0: jump b1\n1: branch local.2 le 10 ? b2 : b3\n2: local.1 = local.1 + local.2 | local.2 = local.2 + 1 | jump b1\n3: end rewind",
    );
    means("fanuc", "DO1\n#1=1\nEND1", "0: jump b1\n1: local.1 = 1 | jump b1\n2: stray");
    means(
        "haas",
        "WH [#[#33+1000] EQ 1] DO1;\nWH [#2 GT 4.] DO2;\nEND2;\nEND1",
        "0: jump b1\n1: branch #[local.33 + 1000] eq 1 ? b2 : b6\n2: jump b3\n3: branch local.2 gt 4 ? b4 : b5\n\
         4: jump b3\n5: jump b1\n6: stray",
    );
    // Several statements in one block.
    means(
        "haas",
        "WHILE [#1 GT #2] DO1 #1=#1-#3\nEND1",
        "0: jump b1\n1: branch local.1 gt local.2 ? b2 : b3\n2: local.1 = local.1 - local.3 | jump b1\n3: stray",
    );
    // A number is free again when its loop is closed.
    means("fanuc", "DO1\nEND1\nDO1\nEND1", "0: jump b1\n1: jump b1\n2: jump b3\n3: jump b3\n4: stray");
}

#[test]
fn loops_that_do_not_pair() {
    refuses(
        "fanuc",
        "WHILE[#1LT1]DO1\nWHILE[#1LT1]DO2\nEND1\nEND2",
        &[Code::LoopsCross, Code::LoopNotPaired],
    );
    refuses("fanuc", "END1", &[Code::LoopNotPaired]);
    refuses("fanuc", "DO1", &[Code::LoopNotPaired]);
    refuses("fanuc", "DO4\nEND4", &[Code::LoopNumber, Code::LoopNumber]);
    refuses("fanuc", "IF[#1EQ1]GOTO5\nWHILE[#1LT1]DO1\nN5#1=1\nEND1", &[Code::JumpIntoLoop]);
}

#[test]
fn modal_calls_that_do_not_pair() {
    // Outside a modal call an alarm, unless a parameter says otherwise (seed 001:2603).
    reviews("fanuc", "G67", &[Code::ModalCallNotOpen]);
    reviews("fanuc", "G66P9100\nG67\nN4G67", &[Code::ModalCallNotOpen]);
    reviews("fanuc", "G66P9100\nX1.\nG66P9200\nG67\nG67", &[]);
}

#[test]
fn jumps_out_of_loops_and_inside_them() {
    means(
        "fanuc",
        "DO1\nIF[#1EQ1]GOTO5\nEND1\nN5M30",
        "0: jump b1\n1: branch local.1 eq 1 ? b4 : b2\n2: jump b1\n3: jump b4\n4 N5: end rewind",
    );
    means(
        "fanuc",
        "DO1\nIF[#1EQ1]GOTO5\n#1=1\nN5END1",
        "0: jump b1\n1: branch local.1 eq 1 ? b3 : b2\n2: local.1 = 1 | jump b3\n3 N5: jump b1\n4: stray",
    );
}

#[test]
fn block_skip() {
    means("fanuc", "/#1=2\n/2G0X1.", "0: /1 local.1 = 2 | /2 nc motion.rapid axis.x=1 | stray");
    means("fanuc", "/N1(TEXT)", "0: /1 comment | stray");
    means("fanuc", "N5/M8", "0: /1 nc coolant.flood | stray");
    means(
        "fanuc",
        "/2M98P8001\nM30",
        "0: branch switch 2 ? b3 : b1\n1: call O8001 -> b2\n2: jump b3\n3: end rewind",
    );
    means(
        "fanuc",
        "/GOTO10\nM30\nN10M2",
        "0: branch switch 1 ? b2 : b1\n1: jump b3\n2: end rewind\n3 N10: end",
    );
    // Only what follows is skipped.
    means(
        "fanuc",
        "Z-1.0/M08",
        "0: branch switch 1 ? b1 : b2\n1: nc axis.z=-1 | jump b3\n2: nc axis.z=-1 coolant.flood | jump b3\n3: stray",
    );
    // The switch is asked once for a whole loop.
    means(
        "fanuc",
        "/DO1\n/#1=1\n/END1\n#2=2",
        "0: branch switch 1 ? b4 : b1\n1: jump b2\n2: local.1 = 1 | jump b2\n3: jump b4\n4: local.2 = 2 | stray",
    );
    refuses("fanuc", "DO1\n/END1", &[Code::LoopNotPaired, Code::SkipUnclear]);
    refuses("fanuc", "/G0X1./M8", &[Code::SkipUnclear]);
}

#[test]
fn returns() {
    means("fanuc", "M99", "0: return");
    means("fanuc", "M99P20", "0: return to 20");
    rests_on("fanuc", "M99P20", "behaviour:m99.p.jumps.here");
    means("haas", "M99 P20\nN20 M30", "0: jump b1\n1 N20: end rewind");
    means("haas", "M99 P20", "0: jump b1\n1: alarm 1 \"NO BLOCK N20\" | end");
    means("fanuc", "G0X1.M99", "0: nc motion.rapid axis.x=1 | return");
}

#[test]
fn ends() {
    means("fanuc", "G0Z1.M30", "0: nc motion.rapid axis.z=1 | end rewind");
    means("haas", "M02", "0: end");
}

#[test]
fn jump_on_an_input() {
    means(
        "haas",
        "M96 P10 Q8\nM30\nN10 M2",
        "0: sync | branch sys input[8] eq 0 ? b2 : b1\n1: end rewind\n2 N10: end",
    );
}

#[test]
fn a_comment_behind_a_jump() {
    means(
        "fanuc",
        "IF[#501EQ0]GOTO20 (IF PRESET IS ZERO SKIP)\nN20M99",
        "0: branch retained.501 eq 0 ? b2 : b1\n1: jump b2\n2 N20: return",
    );
}

#[test]
fn numbers_behind_words() {
    refuses("fanuc", "G0X1.N10", &[Code::NotUnderstood]);
    means("haas", "G0X1.N10", "0: nc motion.rapid axis.x=1 | stray");
}
