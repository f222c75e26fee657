//! Calls and their arguments.

use super::{means, refuses, rests_on, reviews};
use crate::diag::Code;

const ALIASES: &str = "fanuc:[parameters]\n6058 = 383\n6059 = -183\n6075 = 2900\n6080 = 910\n";

#[test]
fn macro_calls() {
    means("fanuc", "G65P9010A-1.B2.\nM30", "0: call O9010 level (1: -1, 2: 2) -> b1\n1: end rewind");
    means("fanuc", "G65P9010L2A1.0B2.0", "0: call O9010 level (1: 1, 2: 2) times 2 -> b1\n1: stray");
    means("fanuc", "G65P9310(X-10.)Y-10.W58.", "0: call O9310 level (25: -10, 23: 58) -> b1\n1: stray");
    // P may stand at the end; six digits are a program too.
    means("fanuc", "G65A1.0B2.0P1000", "0: call O1000 level (1: 1, 2: 2) -> b1\n1: stray");
    means(
        "fanuc",
        "G65P220002A-1.F#09S#19",
        "0: call O220002 level (1: -1, 9: local.9, 19: local.19) -> b1\n1: stray",
    );
    means("fanuc", "G65P#500A1.", "0: call computed retained.500 level (1: 1) -> b1\n1: stray");
    // M, S and T are arguments here.
    means(
        "fanuc",
        "G65P8010C1.S1.4T.002M5.",
        "0: call O8010 level (3: 1, 19: 1.4, 20: 0.002, 13: 5) -> b1\n1: stray",
    );
}

#[test]
fn codes_behind_a_call_are_arguments() {
    means("fanuc", "G65P1M30.", "0: call O1 level (13: 30) -> b1\n1: stray");
    refuses("fanuc", "M98P1M99", &[Code::NotUnderstood]);
}

#[test]
fn both_kinds_of_arguments() {
    means("fanuc", "G65P1I1.J2.K3.", "0: call O1 level (4: 1, 5: 2, 6: 3) -> b1\n1: stray");
    means("fanuc", "G65P1K1.J2.I3.", "0: call O1 level (6: 1, 8: 2, 10: 3) -> b1\n1: stray");
    means(
        "fanuc:[parameters]\n6008.7 = 1",
        "G65P1K1.J2.I3.",
        "0: call O1 level (6: 1, 5: 2, 4: 3) -> b1\n1: stray",
    );
    means(
        "fanuc",
        "G65P9820I#3J#2I#22J#5Q#17",
        "0: call O9820 level (4: local.3, 5: local.2, 7: local.22, 8: local.5, 17: local.17) -> b1\n1: stray",
    );
    // The maker's example: both I4.0 and D5.0 are for #7, and the later one wins.
    means(
        "fanuc",
        "G65A1.0B2.0I-3.0I4.0D5.0P1000",
        "0: call O1000 level (1: 1, 2: 2, 4: -3, 7: 5) -> b1\n1: stray",
    );
    refuses("haas", "G65 P1000 A1. I-3. I4. D5.", &[Code::ArgumentsMixed]);
    // On this control they go by place only where one of them stands twice.
    means("haas", "G65 P1 K1. J2. I3.", "0: call O1 level (6: 1, 5: 2, 4: 3) -> b1\n1: stray");
    means("haas", "G65 P1 W1. K3. I4.", "0: call O1 level (23: 1, 6: 3, 4: 4) -> b1\n1: stray");
    means("haas", "G65 P1 I1. J2. I3.", "0: call O1 level (4: 1, 5: 2, 7: 3) -> b1\n1: stray");
    rests_on("haas", "G65 P1 I1. I2. J3.", "behaviour:arguments.repeated.order");
    reviews("haas", "G65 P1 D1. D2.", &[Code::WordTwice]);
    // Ten sets end at #33; the eleventh has no locals.
    let sets = "I1.J1.K1.".repeat(11);
    refuses("fanuc", &format!("G65P1{sets}"), &[Code::MacroCallNotAlone; 3]);
}

#[test]
fn arguments_without_a_point() {
    means(
        "fanuc",
        "G65P8103U6V5I16.",
        "0: call O8103 level (21: increments(6), 22: increments(5), 4: 16) -> b1\n1: stray",
    );
    means("fanuc", "G65P1X0", "0: call O1 level (24: 0) -> b1\n1: stray");
    means("fanuc:decimal_point = \"calculator\"", "G65P1U6", "0: call O1 level (21: 6) -> b1\n1: stray");
    means("fanuc", "G65P1U[6]", "0: call O1 level (21: 6) -> b1\n1: stray");
}

#[test]
fn calls_that_share_their_block() {
    refuses("fanuc", "G01X100.0G65P9010", &[Code::MacroCallNotAlone]);
    refuses("fanuc", "A1.0G65P1000", &[Code::ArgumentBeforeCall]);
    means("fanuc", "G01X100.0M98P9010", "0: nc motion.linear axis.x=100 | call O9010 -> b1\n1: stray");
    refuses("fanuc", "G65A1.", &[Code::NotUnderstood]);
}

#[test]
fn subprograms() {
    means("fanuc", "M98P68003", "0: call O8003 times 6 -> b1\n1: stray");
    rests_on("fanuc", "M98P68003", "statement:call.repeat.digits");
    means("fanuc", "M98P8003L6", "0: call O8003 times 6 -> b1\n1: stray");
    means("fanuc", "M98P10003L6", "0: call O10003 times 6 -> b1\n1: stray");
    means("fanuc", "M98P0030001", "0: call O1 times 3 -> b1\n1: stray");
    means("haas", "M98 P10003", "0: call O10003 -> b1\n1: stray");
    means("fanuc", "M98P[#891]", "0: call computed retained.891 -> b1\n1: stray");
    means("fanuc", "M98P#1", "0: call computed local.1 -> b1\n1: stray");
    means("fanuc", "M98Q2103\nM30\nN2103M99", "0: call b2 -> b1\n1: end rewind\n2 N2103: return");
    means("haas", "M97 P100 L2\nM30\nN100 M99", "0: call b2 times 2 -> b1\n1: end rewind\n2 N100: return");
    refuses("fanuc", "M98", &[Code::NotUnderstood]);
}

#[test]
fn repeats_and_arguments() {
    // The class: later passes see what the pass before left.
    reviews("haas", "G65 P1 L2 A1.", &[Code::RepeatKeepsLocals]);
    rests_on("fanuc", "G65P1L2A1.", "behaviour:call.repeat.reloads.arguments");
    reviews("haas", "G65 P1 L2", &[]);
}

#[test]
fn modal_calls() {
    means(
        "fanuc",
        "G66P9100\nX10.0\nG66P9200\nX15.0\nG67\nG67\nX-25.0",
        "0: modal O9100 level | nc axis.x=10 | modal O9200 level | nc axis.x=15 | modal.off | modal.off | nc axis.x=-25 | stray",
    );
    refuses("haas", "G66 P9100", &[Code::NotUnderstood]);
    refuses("fanuc", "G66.1P9100", &[Code::NotUnderstood]);
}

#[test]
fn codes_that_call() {
    means(ALIASES, "G383A1.0Z-2.", "0: call O9018 level (1: 1, 26: -2) -> b1\n1: stray");
    means(ALIASES, "G183A1.", "0: modal O9019 level (1: 1) | stray");
    means(ALIASES, "G0X1.M2900", "0: nc motion.rapid axis.x=1 | call O9005 -> b1\n1: stray");
    means(
        ALIASES,
        "M910I69.T7.D1.0X-.04",
        "0: call O9020 level (4: 69, 20: 7, 7: 1, 24: -0.04) -> b1\n1: stray",
    );
    // Inside a program that a code calls, the codes that call are plain ones.
    refuses(ALIASES, "O9018\nG383A1.0\nM99", &[Code::NotUnderstood]);
    means(
        "fanuc:[parameters]\n6058 = 383\n6008.6 = 1",
        "O9018\nG383A1.0\nM99",
        "0: call O9018 level (1: 1) -> b1\n1: return",
    );
    // O9017 is called by no code here, so nothing changes in it.
    means(ALIASES, "O9017\nG383A1.0\nM99", "0: call O9018 level (1: 1) -> b1\n1: return");
    refuses("fanuc", "G383A1.0", &[Code::NotUnderstood]);
}
