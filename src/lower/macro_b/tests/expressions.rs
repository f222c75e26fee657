//! Expressions, conditions and variables.

use super::{means, refuses, rests_on, reviews, told};
use crate::diag::Code;

#[test]
fn variables() {
    means("fanuc", "#03=1", "0: local.3 = 1 | stray");
    means("fanuc", "#1=#0", "0: local.1 = vacant | stray");
    means("fanuc", "#1=#3100", "0: local.1 = vacant | stray");
    // Brackets are no evaluation: vacancy is copied. A sum is, and makes it 0 by the contract.
    means("fanuc", "#2=[#1]", "0: local.2 = local.1 | stray");
    means("fanuc", "#2=#1+#1", "0: local.2 = local.1 + local.1 | stray");
    means("fanuc", "#100=#500", "0: common.100 = retained.500 | stray");
    means("haas", "#100=#500", "0: retained.100 = retained.500 | stray");
    means("fanuc", "#1=#5041", "0: local.1 = sys pos.work[1] | stray");
    means("fanuc", "#1=#5022", "0: local.1 = sys pos.machine[2] | stray");
    means("fanuc", "#1=#5221", "0: local.1 = sys wcs[1, 1] | stray");
    means("fanuc", "#1=#5242", "0: local.1 = sys wcs[2, 2] | stray");
    means("fanuc", "#1=#4001", "0: local.1 = sys modal[1] | stray");
    means("fanuc", "#1100=1(OUTPUT)", "0: sys output[0] = 1 | stray");
    means("fanuc", "#3001=0", "0: sys timer.ms = 0 | stray");
}

#[test]
fn variables_that_cannot_be() {
    refuses("fanuc", "#1=#99", &[Code::NotUnderstood]);
    refuses("fanuc", "#0=#1", &[Code::NullAssigned]);
    refuses("fanuc", "#1000=1", &[Code::NotWritable]);
    refuses("haas", "#10100=#30003.078", &[Code::NotUnderstood]);
}

#[test]
fn computed_numbers() {
    means("fanuc", "#[#100]=#[#100]+#107", "0: #[common.100] = #[common.100] + common.107 | stray");
    means("fanuc", "#[100]=1", "0: common.100 = 1 | stray");
    means("fanuc", "#[#[#147+23]]=#14", "0: #[#[common.147 + 23]] = local.14 | stray");
    means("haas", "#101= #[#100 +500]", "0: retained.101 = #[retained.100 + 500] | stray");
    // The constant folds, the sum does not: its source form is kept.
    means("fanuc", "#1=#[100+1]", "0: local.1 = #[100 + 1] | stray");
}

#[test]
fn the_newer_numbers_are_the_older_ones() {
    means("haas", "#10100=#10501", "0: retained.100 = retained.501 | stray");
    means("haas", "#1=#[10100+#2]", "0: local.1 = #[100 + local.2] | stray");
    means("haas", "#[#1+10500]=#2", "0: #[local.1 + 500] = local.2 | stray");
    means("haas", "#1=#[10200+#2]", "0: local.1 = #[10200 + local.2] | stray");
    refuses("fanuc", "#10700=1", &[Code::NotUnderstood]);
}

#[test]
fn names() {
    means(
        "fanuc",
        "SETVN 510[TOOL_NO, WORK_NO]\n[#TOOL_NO]=10",
        "0: names retained.510 [\"TOOL_NO\", \"WORK_NO\"] | retained.510 = 10 | stray",
    );
    means("fanuc", "#1=[#_EMPTY]", "0: local.1 = vacant | stray");
    means("fanuc", "#1=[#_PI]", "0: local.1 = sys pi | stray");
    refuses("fanuc", "[#NOBODY]=10", &[Code::NotUnderstood]);
}

#[test]
fn arithmetic() {
    means("fanuc", "#1=#2+#3*SIN[#4]", "0: local.1 = local.2 + local.3 * sin(local.4) | stray");
    means("fanuc", "#1=-[#2-3]", "0: local.1 = -(local.2 - 3) | stray");
    means("fanuc", "#100=#1*[#2-3]", "0: common.100 = local.1 * (local.2 - 3) | stray");
    means("fanuc", "#3=FUP[#2]+FIX[#1]", "0: local.3 = fup(local.2) + fix(local.1) | stray");
    means("fanuc", "#1=#2 AND 7", "0: local.1 = local.2 and 7 | stray");
    // Two arguments, and one with a quotient.
    means("fanuc", "#1=ATAN[#2]/[#3]", "0: local.1 = atan(local.2, local.3) | stray");
    means("fanuc", "#100=[ATAN[1]]/10", "0: common.100 = atan(1) / 10 | stray");
    refuses("fanuc", "#100=ATAN[1]/10", &[Code::AtanDivision]);
    refuses("haas", "#1=LN[#2]", &[Code::NotUnderstood]);
}

#[test]
fn remainders() {
    means("fanuc", "#1=#2MOD#3", "0: local.1 = local.2 mod local.3 | stray");
    assert_eq!(told("fanuc", "#1=#2MOD#3", "behaviour:mod.rounds.operands"), 0);
    means("haas", "#1=27 MOD 20", "0: local.1 = 27 mod 20 | stray");
    assert_eq!(told("haas", "#1=27 MOD 20", "behaviour:mod.rounds.operands"), 0);
    rests_on("haas", "#1=#2 MOD 20", "behaviour:mod.rounds.operands");
    rests_on("haas", "#1=#2 MOD 20\n#1=#3 MOD 20", "behaviour:mod.sign");
}

#[test]
fn bits_of_fractions() {
    // The class cuts the fraction off; the common form rounds, so the cut is spelled out.
    means("haas", "#100=#100 AND #22", "0: retained.100 = fix(retained.100) and fix(local.22) | stray");
    means("haas", "#1=12 AND 10", "0: local.1 = 12 and 10 | stray");
    rests_on("fanuc", "#1=#2 AND #3", "behaviour:bits.of.fraction");
}

#[test]
fn rounding() {
    means("fanuc", "#1=ROUND[#2]", "0: local.1 = round(local.2) | stray");
    means("fanuc", "G0X[ROUND[#1]]", "0: nc motion.rapid axis.x=round.increment(local.1) | stray");
    means(
        "fanuc",
        "G0X-[ROUND[#1]+ROUND[#2]]",
        "0: nc motion.rapid axis.x=-(round.increment(local.1) + round.increment(local.2)) | stray",
    );
    // A whole-number word has whole numbers for increments.
    means("haas", "G41D[ROUND[1.67]]", "0: nc radius.left offset.radius=round(1.67) | stray");
}

#[test]
fn comparisons_as_values() {
    means("haas", "#2=[#4 GT 9.2]", "0: local.2 = truth(local.4 gt 9.2) | stray");
    refuses("fanuc", "#2=[#4 GT 9.2]", &[Code::NotUnderstood]);
}

#[test]
fn conditions() {
    means(
        "fanuc",
        "IF[#1EQ#0]THEN#1=0",
        "0: branch local.1 eq vacant ? b1 : b2\n1: local.1 = 0 | jump b2\n2: stray",
    );
    means(
        "fanuc",
        "IF[[#1EQ1]AND[#2NE2]]THEN#1=0",
        "0: branch all(local.1 eq 1, local.2 ne 2) ? b1 : b2\n1: local.1 = 0 | jump b2\n2: stray",
    );
    means(
        "fanuc",
        "IF[[#1EQ1]OR[#2GT2]OR[#3LE3]]THEN#1=0",
        "0: branch any(local.1 eq 1, local.2 gt 2, local.3 le 3) ? b1 : b2\n1: local.1 = 0 | jump b2\n2: stray",
    );
    means(
        "fanuc",
        "IF[[#1EQ1]XOR[#2EQ2]]THEN#1=0",
        "0: branch any(all(local.1 eq 1, local.2 ne 2), all(local.1 ne 1, local.2 eq 2)) ? b1 : b2\n\
         1: local.1 = 0 | jump b2\n2: stray",
    );
    // Bits, compared.
    means(
        "fanuc",
        "IF[[#1AND1]EQ1]THEN#1=0",
        "0: branch local.1 and 1 eq 1 ? b1 : b2\n1: local.1 = 0 | jump b2\n2: stray",
    );
}

#[test]
fn numbers_as_conditions() {
    // An input is 0 or 1, never vacant.
    means(
        "haas",
        "[#1000] GOTO10\nN10",
        "0: branch sys input[0] ne 0 ? b2 : b1\n1: jump b2\n2 N10: comment | stray",
    );
    // A variable may be vacant, which is not "not zero".
    means(
        "haas",
        "IF [#1] THEN #2=1",
        "0: branch local.1 + 0 ne 0 ? b1 : b2\n1: local.2 = 1 | jump b2\n2: stray",
    );
    rests_on("haas", "IF [#1] THEN #2=1", "behaviour:number.is.condition");
    refuses("fanuc", "IF[#1]THEN#2=1", &[Code::NotUnderstood]);
    // OR of a number and a truth value works on bits.
    means(
        "haas",
        "IF [[#1024] OR [#1022 EQ 0]] #115=#115+1",
        "0: branch sys input[24] or truth(sys input[22] eq 0) ne 0 ? b1 : b2\n\
         1: retained.115 = retained.115 + 1 | jump b2\n2: stray",
    );
}

#[test]
fn early_reads() {
    reviews("haas", "#1=#5041", &[Code::EarlyRead]);
    reviews("haas", "G103P1\n#1=#5041", &[]);
    reviews("haas", "#1=#5041\n#2=#5042", &[Code::EarlyRead]);
    // The class's own example: the output is set before the dwell is over.
    reviews("haas", "#1124=1;\nG04 P2.;\n#1124=0;", &[Code::EarlyRead]);
    reviews("haas", "G103 P1;\n#1124=1;\nG04 P2.;\n#1124=0;", &[]);
    // The maker tells to stop reading ahead before it (B-63324EN/03 p. 674).
    reviews("fanuc", "#1=#5041", &[Code::EarlyRead]);
}
