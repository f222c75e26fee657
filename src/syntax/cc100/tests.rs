use super::{by_grammar, parse_line};
use crate::syntax::testing::*;
use crate::syntax::{ItemKind, TokenKind};

#[test]
fn every_program_of_the_corpus_is_read() {
    read_all_programs("cc100", parse_line);
}

#[test]
fn every_fragment_is_read_or_refused_as_the_manual_says() {
    check_fragments(
        "cc100",
        parse_line,
        &[
            ("V7 = V3 * SIN V5", "OneOperation", 11),
            ("X0 Y=V1", "MixedBlock", 4),
            ("V1=TAN V2", "UnknownFunction", 4),
        ],
    );
}

/// Written by hand: `:=` assigns, `=` stands in a parametric word, an operator stands
/// before its operands.
#[test]
fn blocks_mean_what_they_spell() {
    let table = [
        ("N1 G90", "N1 G90"),
        ("N+5 V1=50 V2=25", "N+5 V1:=50 V2:=25"),
        ("N007 G0 X-20 Y42.5 Z5 T01", "N7 G0 X-20 Y42.5 Z5 T1"),
        ("g1x+3.z.5", "G1 X+3. Z0.5"),
        ("X=V1", "X=V1"),
        ("X=V3 Y=VY", "X=V3 Y=VY"),
        ("x = v3", "X=V3"),
        ("G=V19 X=V23 Y=V22", "G=V19 X=V23 Y=V22"),
        ("G0 X=V23 Y=V22", "G0 X=V23 Y=V22"),
        ("G=V30 P=V31 L=V32", "G=V30 P=V31 L=V32"),
        ("G81 V1=5 V2=-10", "G81 V1:=5 V2:=-10"),
        ("VX=340 VY=-265.5", "VX:=340 VY:=-265.5"),
        ("V6 = V5", "V6:=V5"),
        ("V8 = V7 - V1", "V8:=(Subtract V7 V1)"),
        ("V1=V2+V3", "V1:=(Add V2 V3)"),
        ("V4=V4* -1", "V4:=(Multiply V4 -1)"),
        ("V4=V4*-1", "V4:=(Multiply V4 -1)"),
        ("V3=V2/3.", "V3:=(Divide V2 3.)"),
        ("V1=V1+1 VZ=V1* -1", "V1:=(Add V1 1) VZ:=(Multiply V1 -1)"),
        ("V6=SIN V5", "V6:=Sin(V5)"),
        ("V11=SIN V26 V12=COS V26", "V11:=Sin(V26) V12:=Cos(V26)"),
        ("V6=SQRV5", "V6:=Sqrt(V5)"),
        ("V1=ATN VX", "V1:=Atan(VX)"),
        ("V50=T", "V50:=T"),
        ("V1=S V2=X", "V1:=S V2:=X"),
        ("V17=V20-V15 BLE P99", "V17:=(Subtract V20 V15) LessEqual($99)"),
        ("BEQ V1", "Equal(V1)"),
        ("BNE P5", "NotEqual($5)"),
        ("BGT P5", "Greater($5)"),
        ("BLT P05", "Less($5)"),
        ("BGE P5", "GreaterEqual($5)"),
        ("TST V1", "test(V1)"),
        ("TST G97", "test(G97)"),
        ("TST QX", "test(QX)"),
        ("tst qm", "test(QM)"),
        ("INC V12", "inc(V12)"),
        ("N25 DEC VC", "N25 dec(VC)"),
        ("TIM VT", "tim(VT)"),
        ("COR=T01 R=V1 L=V2", "COR[T1](R<-V1;L<-V2;)"),
        ("COR=V50 V51=R", "COR[V50](R->V51;)"),
        ("TRF=G54 V1=X V2=Y V3=Z", "TRF[G54](X->V1;Y->V2;Z->V3;)"),
        ("TRF=V4 X=VX Y=VY", "TRF[V4](X<-VX;Y<-VY;)"),
        ("TRF=G92 V1=X BEQ P1", "TRF[G92](X->V1;) Equal($1)"),
        ("G22 P1 L2", "G22 P1 L2"),
        ("G24 P2", "G24 P2"),
        ("N24 $01", "N24 $1"),
        ("$1 (SUB)", "$1 Closed[SUB]"),
        ("N44 (A - B)", "N44 Closed[A - B]"),
        ("VX=200 (CORNER)", "VX:=200 Closed[CORNER]"),
        ("G820", "G820"),
        ("%", "%"),
        ("N9", "N9"),
    ];
    for (line, tree) in table {
        assert_eq!(show(parse_line, line), tree, "{line}");
        assert_eq!(faults(parse_line, line), [], "{line}");
    }
}

#[test]
fn slips_are_named_at_their_place() {
    let table = [
        ("V1=V2+V3+V4", "OneOperation", 9),
        ("V1=SIN V2*V3", "OneOperation", 10),
        ("V1=V2*SIN V3", "OneOperation", 7),
        ("V1=(V2+V3)*2", "NoBrackets", 4),
        ("V1=V2*(V3+1)", "NoBrackets", 7),
        ("V1=TAN V2", "UnknownFunction", 4),
        ("V1=SQRT V2", "UnknownFunction", 4),
        ("Y=V1 X0", "MixedBlock", 6),
        ("G1 X=V4 F4000", "MixedBlock", 9),
        ("M3 V1=5", "MixedBlock", 4),
        ("X=V4 Y=15", "ConstantInWord", 8),
        ("V1=-V2", "SignedVariable", 4),
        ("V1=3*V2", "UnshownOperand", 4),
        ("V1=SIN 30", "UnshownOperand", 8),
        ("V1=G", "ValueNotReadable", 4),
        ("$1 G0", "LabelNotAlone", 4),
        ("N5 (TEXT", "UnclosedComment", 4),
        ("G0 X Y1", "WordWithoutValue", 4),
        ("TAN V1", "WordWithoutValue", 1),
        ("N99999999999", "NumberTooLarge", 2),
        ("X1 N5", "Unreadable", 4),
        ("V12", "Unreadable", 4),
        ("BEQ 5", "Unreadable", 5),
        ("TST X", "Unreadable", 5),
        ("N5 /G0", "Unreadable", 4),
    ];
    for (line, code, column) in table {
        assert_eq!(faults(parse_line, line), [(code.to_owned(), column)], "{line}");
    }
}

#[test]
fn nothing_is_fatal_in_a_long_block() {
    let words = "X=V1 ".repeat(50_000);
    assert_eq!(parse(parse_line, words.as_bytes())[0].items.len(), 50_000);
    let sum = format!("V1=1{}", "+1".repeat(50_000));
    assert_eq!(faults(parse_line, &sum)[0].0, "OneOperation");
}

#[test]
fn foreign_bytes_stay_in_comments() {
    let blocks = parse(parse_line, b"\0\0N5 (caf\xe9 \x07\xff)");
    assert!(is_clean(&blocks));
    assert_eq!(blocks[0].tokens[0].kind, TokenKind::Space);
    let blocks = parse(parse_line, b"G0 X\xe91");
    assert_eq!(blocks[0].items[0].kind, ItemKind::Unparsed);
}

#[test]
fn any_bytes_print_back() {
    lossless_under_mutation("cc100", parse_line);
}

#[test]
fn plain_blocks_are_what_the_grammar_says() {
    assert_plain_blocks_agree("cc100", by_grammar);
}
