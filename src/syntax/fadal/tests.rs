use super::{by_grammar, parse_line, reader};
use crate::syntax::testing::*;
use crate::syntax::{ItemKind, TokenKind};

#[test]
fn every_program_of_the_corpus_is_read() {
    read_all_programs("fadal", parse_line);
}

#[test]
fn every_fragment_is_read_or_refused_as_the_manual_says() {
    check_fragments(
        "fadal",
        parse_line,
        &[
            ("N1 G0 G90 # V1=INT(V5 * 10000)/10000", "MixedLine", 11),
            ("#V1=1.23^5", "ExponentForm", 9),
            ("N2 #:TEST 'THIS IS A TEST", "LabelNotAlone", 11),
            // Read, for review: 64 characters as printed, and a line as typed at the prompt.
            ("#IF (V1 LT V2) OR (V1 LT V3) AND (NOT(V1 GT V4)) THEN GOTO :LOOP", "MacroLineTooLong", 64),
            ("SET RND5", "MarkMissing", 1),
        ],
    );
}

/// Written by hand: `:=` assigns, `<-` assigns by sign, `{}` are brackets of the source,
/// an operator stands before its operands, a number keeps its point.
#[test]
fn blocks_mean_what_they_spell() {
    let table = [
        // R variables on NC lines.
        ("R9+1.", "R9<-+1."),
        ("R3 + 7.5 R8-18. R7+R6", "R3<-+7.5 R8<--18. R7<-+R6"),
        ("X+R9 Y+ R2. X-R1 Z-R7.", "X+R9 Y+R2 X-R1 Z-R7"),
        ("N15 X - R1 Y + R2. G1 F34.", "N15 X-R1 Y+R2 G1 F34."),
        ("R+R7", "R+R7"),
        ("R0+R6 G3", "R0<-+R6 G3"),
        ("R0.1", "R0.1"),
        ("Z-1.R+0.1 F100.", "Z-1. R+0.1 F100."),
        ("R0+.1", "R0<-+0.1"),
        ("R10 R5", "R10 R5"),
        ("L9101 R1+1. X+R6. F+R4. P1", "L9101 R1<-+1. X+R6 F+R4 P1"),
        ("G81 G99 R0+.1 Z-.6 F40.", "G81 G99 R0<-+0.1 Z-0.6 F40."),
        ("L+R2", "L+R2"),
        ("g0g90z.1", "G0 G90 Z0.1"),
        ("M5M9;", "M5 M9 ;"),
        // Heads and comments.
        ("N01 L100(SUB TO CUT SLOT", "N1 L100 Open[SUB TO CUT SLOT]"),
        ("N1 O3*TOOL TIME", "N1 O3 Star[TOOL TIME]"),
        ("O5757", "O5757"),
        ("N1 O900(ROTATE X & Y)", "N1 O900 Closed[ROTATE X & Y]"),
        ("(A (B) C) ", "Closed[A (B) C]"),
        ("()()(SUBS) ()", "Closed[)()(SUBS) (]"),
        ("N26 (", "N26 Open[]"),
        ("N9 G51.1 Y0 'SET Y AXIS", "N9 G51.1 Y0 Apostrophe[SET Y AXIS]"),
        ("/N5 M8", "skip N5 M8"),
        ("/2 G0 X1", "skip2 G0 X1"),
        ("N5/M8", "N5 skip M8"),
        ("N5 /2 #WAIT", "N5 skip2 # wait"),
        ("%", "%"),
        // Macro lines.
        ("N15# :INSIDE", "N15 # :INSIDE"),
        ("N2# 'comment", "N2 # Apostrophe[comment]"),
        ("#", "#"),
        ("#If V2=1 then GOTO:SELECTION", "# if((Equal V2 1) goto(:SELECTION))"),
        ("# V2 = H99", "# V2:=H99"),
        ("N6 #IF V10>V1 THEN GOTO N03", "N6 # if((Greater V10 V1) goto(N3))"),
        ("#IF V7>=360 THEN V7=0", "# if((GreaterEqual V7 360) V7:=0)"),
        ("#IF V1=1 THEN IF V2=2 THEN WAIT", "# if((Equal V1 1) if((Equal V2 2) wait))"),
        ("#IF V20 > -V25 THEN GOTO :LOOP", "# if((Greater V20 -V25) goto(:LOOP))"),
        ("#IF V1<>2 THEN GOTO:A1", "# if((NotEqual V1 2) goto(:A1))"),
        ("#IF V1 < > 2 THEN WAIT", "# if((NotEqual V1 2) wait)"),
        (
            "#IF V1=1 OR V2=2 AND NOT V3=3 THEN WAIT",
            "# if((Or (Equal V1 1) (And (Equal V2 2) (Not (Equal V3 3)))) wait)",
        ),
        ("#IF(V5 + V6)<=0THENV7=ABS(V5+V6)", "# if((LessEqual {(Add V5 V6)} 0) V7:=Abs((Add V5 V6)))"),
        ("#V1=1-2-3", "# V1:=(Subtract (Subtract 1 2) 3)"),
        ("#V1=1+2*3/4", "# V1:=(Add 1 (Divide (Multiply 2 3) 4))"),
        ("#V1=-V2*3", "# V1:=(Multiply -V2 3)"),
        ("#V10=-(ABS(V6)-V5)", "# V10:=-{(Subtract Abs(V6) V5)}"),
        (
            "#FZ(V2)=(ABS(H(V10))+PZ1)*-1 'note",
            "# FZ[V2]:=(Multiply {(Add Abs(H[V10]) PZ1)} -1) Apostrophe[note]",
        ),
        ("#V(V(SQR(V2)))=1", "# V[V[Sqrt(V2)]]:=1"),
        ("#V(5)=G(1)+I(3)+HO(2)", "# V5:=(Add (Add G1 I3) HO2)"),
        ("#TU(R9)=TN", "# TU[R9]:=TN"),
        ("#V1=RND(VF)", "# V1:=RoundPlaces(VF)"),
        ("#V2=SIN (V7)*V1", "# V2:=(Multiply Sin(V7) V1)"),
        ("#CLEAR V3-V7,V15,V30", "# clear(V3..V7,V15,V30)"),
        ("#CLEAR", "# clear()"),
        ("#SET RND4", "# set[Round(4)]"),
        ("#SET DEB", "# set[Debug]"),
        ("#SET", "# set[]"),
        ("N3247 #START 7", "N3247 # start(7)"),
        ("N5 # INDEX \"M1 A90. F300.\"", "N5 # index(M1 A90. F300.)"),
        ("# PRINT, V2", "# print(V2)"),
        ("#PRINT \"A;'(\",V10,\" B\",", "# print(\"A;'(\",V10,\" B\"...)"),
        ("#SPRINT \"X \",AX 'out", "# sprint(\"X \",AX) Apostrophe[out]"),
        ("#PRINT", "# print()"),
        ("#SINPUT V1", "# sinput(V1)"),
        ("#V50=0'V50 IS THE COUNTER", "# V50:=0 Apostrophe[V50 IS THE COUNTER]"),
    ];
    for (line, tree) in table {
        assert_eq!(show(parse_line, line), tree, "{line}");
        assert_eq!(faults(parse_line, line), [], "{line}");
    }
}

#[test]
fn slips_are_named_at_their_place() {
    let table = [
        ("L9101 R1+V1. R2+V10.", vec![("VariableOnNcLine", 10), ("VariableOnNcLine", 17)]),
        ("X+V1", vec![("VariableOnNcLine", 3)]),
        ("G0 XV1", vec![("VariableOnNcLine", 5)]),
        ("R9=1.", vec![("EqualsOnNcLine", 3)]),
        ("G0 XR9", vec![("SignMissing", 5)]),
        ("G0 X Y1", vec![("WordWithoutValue", 4)]),
        ("G0 X", vec![("WordWithoutValue", 4)]),
        ("N5 #V1=2 G0", vec![("MixedLine", 10)]),
        ("#IF V19 THEN GOTO :LOOP", vec![("ConditionExpected", 5)]),
        ("#IF V1=1 AND V2 THEN WAIT", vec![("ConditionExpected", 14)]),
        ("#V1=V2=3", vec![("ComparisonAsValue", 5)]),
        ("#PRINT V1>2", vec![("ComparisonAsValue", 8)]),
        ("#V4=V3.3", vec![("Unreadable", 7)]),
        ("#R4=(6000/V2).75", vec![("Unreadable", 14)]),
        ("#V1=1.2E5", vec![("ExponentForm", 8)]),
        ("#V1=2 (note", vec![("MacroComment", 7)]),
        ("#PRINT \"A\";V1", vec![("SemicolonInMacro", 11)]),
        ("#PRINT \"A", vec![("UnterminatedText", 8)]),
        ("#:LOOP V1=1", vec![("LabelNotAlone", 8)]),
        ("G0 (RAPID) X1.", vec![("TextBehindComment", 11)]),
        ("(A) (B) X1 (C)", vec![("TextBehindComment", 8)]),
        ("PRINT \"A\"", vec![("Unreadable", 1)]),
        ("#IF V1=2 GOTO :A", vec![("Unreadable", 10)]),
        ("#GOTO 45", vec![("Unreadable", 7)]),
        ("N99999999999 G0", vec![("NumberTooLarge", 2)]),
        ("#V1=(V2", vec![("Unreadable", 8)]),
        ("#V1=V2)", vec![("Unreadable", 7)]),
        ("#V1=--2", vec![("Unreadable", 6)]),
        ("X1 N5", vec![("Unreadable", 4)]),
    ];
    for (line, expected) in table {
        let found = faults(parse_line, line);
        let found: Vec<(&str, u32)> = found.iter().map(|(code, column)| (code.as_str(), *column)).collect();
        assert_eq!(found, expected, "{line}");
    }
}

#[test]
fn a_macro_line_holds_63_characters_from_its_mark() {
    let line = |length: usize| format!("N17#V1=1 '{}", "x".repeat(length - 7));
    assert_eq!(faults(parse_line, &line(63)), []);
    assert_eq!(faults(parse_line, &line(64)), [("MacroLineTooLong".to_owned(), 67)]);
}

#[test]
fn depth_and_length_are_limited_not_fatal() {
    for inside in ["(", "-(", "ABS(", "V("] {
        let line = format!("#V1={}", inside.repeat(100_000));
        assert_eq!(faults(parse_line, &line)[0].0, "TooComplex");
    }
    for chain in ["+1", "*-1", " AND 1", "=1"] {
        let line = format!("#V1=1{}", chain.repeat(100_000));
        assert_eq!(faults(parse_line, &line)[0].0, "TooComplex");
    }
    let longest = format!("#IF {}V1=1 THEN WAIT", "NOT ".repeat(240));
    assert_eq!(show(parse_line, &longest).matches("Not").count(), 240);
    let nested = format!("#{}WAIT", "IF 1=1THEN".repeat(100));
    assert_eq!(show(parse_line, &nested).matches("if(").count(), 100);
    let deepest = format!("#V1={}1{}", "(".repeat(32), ")".repeat(32));
    assert_eq!(faults(parse_line, &deepest).iter().filter(|fault| fault.0 != "MacroLineTooLong").count(), 0);
    let words = "X1 ".repeat(50_000);
    assert_eq!(parse(parse_line, words.as_bytes())[0].items.len(), 50_000);
}

#[test]
fn foreign_bytes_stay_in_comments_and_texts() {
    let line = b"\0\0G0 X1.(caf\xe9 \x07\xff";
    let blocks = parse(parse_line, line);
    assert!(is_clean(&blocks));
    assert_eq!(blocks[0].tokens[0].kind, TokenKind::Space);
    let blocks = parse(parse_line, b"#PRINT \"\xc3\xa4\"");
    assert!(is_clean(&blocks));
    let blocks = parse(parse_line, b"G0 X\xe91");
    assert_eq!(blocks[0].items[0].kind, ItemKind::Unparsed);
}

#[test]
fn any_bytes_print_back() {
    lossless_under_mutation("fadal", parse_line);
}

#[test]
fn plain_blocks_are_what_the_grammar_says() {
    assert_plain_blocks_agree("fadal", by_grammar);
}

#[test]
fn ordinary_macro_lines_are_what_the_grammar_says() {
    let agrees = |shape: &str, least| assert_reader_agrees("fadal", reader::read, by_grammar, (shape, least));
    let value = "([VR][0-9]{1,3}|V\\([0-9]{1,3}\\)|[0-9]{1,3}\\.?[0-9]{0,2}|(SIN|abs|Int)\\(V[0-9]-2\\)|\\(-V3\\*2\\))";
    let sum = format!("-?{value}( ?[-+*/] ?{value}){{0,2}}");
    let body = format!("(GOTO ?:[A-Z]{{1,3}}|goto N[0-9]{{1,3}}|[VR][0-9]{{1,2}} ?= ?{sum})");
    agrees(
        &format!(
            "([Nn][0-9]{{1,4}} ?)?# ?(:[a-z0-9_]{{1,2}}|{body}|IF {sum} ?(<|>=|=) ?{sum} THEN {body}) ?"
        ),
        300,
    );
    agrees("([Nn][0-9]{1,4} )?([A-MPQS-UW-Z]([-+][Rr][0-9]|[-+]?[0-9]{1,3}\\.?[0-9]{0,2}) ?){1,3}", 300);
    // With much that is rare or wrong.
    let value = "([VRvr][0-9]{1,3}|[VR] ?\\([0-9 ]{1,3}\\)|V\\(V1[+ ]?[0-9]?\\)|[0-9]{0,3}\\.?[0-9]{0,2}|(SIN|ATN|RND|SQR|COS) ?\\(V[0-9] ?[-+] ?2\\)|H1|AX|V[XF])";
    let operator = " ?([-+*/]|=|<|>|<>|< >|<=|>=|EQ|and|OR|[-+] ?[-+]) ?";
    let sum = format!("[-+]? ?{value}({operator}{value}){{0,3}}");
    let body = format!("(GOTO ?:[A-Za-z_]{{1,3}}|goto ?N[0-9]{{1,3}}|{value} ?= ?{sum}|WAIT)");
    let statement = format!(
        "(:[A-Z ]{{0,2}}[a-z0-9_]{{0,2}}|{body}|IF ?\\(?{sum}\\)? ?(THEN)? ?(IF {sum} THEN )?{body})"
    );
    let tail = "( ?'[A-Z]{0,3}|[ \\t)=;.]?|[ \\t]{0,3})";
    agrees(&format!("[ \\t/]?([Nn][0-9]{{1,4}} ?)?# ?{statement}{tail}"), 50);
    let word = "[A-Za-z] ?([-+] ?[RrV][0-9]{1,2}\\.?|[-+]?[0-9]{1,3}\\.?[0-9]{0,2})";
    agrees(&format!("[ \\t/]?([Nn][0-9]{{1,4}})?([ \\t]{{0,2}}{word}){{1,4}}[ \\t;=#-]?"), 50);
}
