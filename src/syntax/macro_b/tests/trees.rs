//! Blocks of real programs and the trees they must have, written by hand.

use super::show::show;
use super::{BOTH, FANUC, HAAS};

/// Blocks that both dialects read alike.
const SHARED: &[(&str, &str)] = &[
    ("N10 G1 X1.2 Y-.5 F30. (comment)", "N10 G=1 X=1.2. Y=neg(0.5.) F=30. (comment)"),
    ("g01 x 1. y - 2", "G=1 X=1. Y=neg(2)"),
    ("IF[#1EQ#0]GOTO9", "if [Equal(#1,#0)] {goto 9}"),
    ("IF [ #1 EQ #0 ] GOTO 9", "if [Equal(#1,#0)] {goto 9}"),
    ("if[#1eq#0]goto9", "if [Equal(#1,#0)] {goto 9}"),
    ("N230IF[#609GT0]#712=#609", "N230 if [Greater(#609,0)] {#712:=#609}"),
    ("#03=1", "#3:=1"),
    ("GOTO0003", "goto 3"),
    ("O9609IF[#1LT2]GOTO100", "program 9609 if [Less(#1,2)] {goto 100}"),
    ("N02 #768=#601 (for T31) GOTO08", "N2 #768:=#601 (for T31) goto 8"),
    ("N1 #29=1 GOTO10", "N1 #29:=1 goto 10"),
    (
        "WHILE [ #1 GT #2 ] DO1 #1= #1 - #3 IF [ #1 LT #2 ] THEN #1= #2",
        "while [Greater(#1,#2)] do1 #1:=Subtract(#1,#3) if-then [Less(#1,#2)] {#1:=#2}",
    ),
    ("IF[#598 NE 1.]G65 P9725", "if [NotEqual(#598,1.)] {G=65 P=9725}"),
    ("WH[[#1GE#2]OR[#1EQ#2]]DO1;", "while [Or([GreaterEqual(#1,#2)],[Equal(#1,#2)])] do1 ;"),
    ("DO1", "do1"),
    ("END1", "end1"),
    ("G65P9310(X-10.)Y-10.W58.", "G=65 P=9310 (X-10.) Y=neg(10.) W=58."),
    ("X[#1](NOTE)Y[#2]", "X=[#1] (NOTE) Y=[#2]"),
    ("G65 P220002 A-1. F#09 S#19 I#04", "G=65 P=220002 A=neg(1.) F=#9 S=#19 I=#4"),
    ("G65P9820I#3J#2I#22J#5Q#17", "G=65 P=9820 I=#3 J=#2 I=#22 J=#5 Q=#17"),
    ("M98P[#891]", "M=98 P=[#891]"),
    ("GOTO#149", "goto #149"),
    ("GOTO[#147*100]", "goto [Multiply(#147,100)]"),
    ("#[#[#147+23]]=#14+#32", "#(#(Add(#147,23))):=Add(#14,#32)"),
    ("#[#100] = #[#100]+#107 (ADD)", "#(#100):=Add(#(#100),#107) (ADD)"),
    ("#118=ATAN[#25]/[#24]", "#118:=AtanSlash(#25,#24)"),
    ("#1=ATAN[#2,#3]", "#1:=AtanComma(#2,#3)"),
    ("#1=ATN[#2]*2", "#1:=Multiply(AtanPlain(#2),2)"),
    ("#9=PRM[1241]/[1]", "#9:=ParameterSlash(1241,1)"),
    ("G01X-[#501*0.9]F3000,R10", "G=1 X=neg([Multiply(#501,0.9.)]) F=3000 ,R=10"),
    ("/2M98P8001", "skip2 M=98 P=8001"),
    ("/N1(..)", "skip N1 (..)"),
    ("N5/M8", "N5 skip M=8"),
    ("Z-1.0/M08", "Z=neg(1.) skip M=8"),
    ("#1=#2/M8", "#1:=#2 skip M=8"),
    ("#1=#2/8", "#1:=Divide(#2,8)"),
    ("DPRNT[ANG/#1[44]/**ACTUAL/#139[44]]", "dprint 'ANG/' #1[4.4] '/**ACTUAL/' #139[4.4]"),
    ("DPRNT[-----]", "dprint '-----'"),
    ("BPRNT[X#[#1][53]]", "bprint 'X' #(#1)[5.3]"),
    ("POPEN", "open"),
    ("PCLOS;", "close ;"),
    ("#3000=121", "#3000:=121"),
    ("N881#3000=1(TEXT; MORE)", "N881 #3000:=1 (TEXT; MORE)"),
    ("()()()(SUBS)()()", "() () () (SUBS) () ()"),
    ("#101=0(X;XW*1jV5)", "#101:=0 (X;XW*1jV5)"),
    ("#1=1;#2=2 ; (END)", "#1:=1 ; | #2:=2 ; | (END)"),
    ("; ;", "; | ;"),
    ("%", "%"),
    (":1234", "program 1234"),
    ("O<PART-1A>(X)", "program <PART-1A> (X)"),
    ("<O0001>", "program <O0001>"),
    ("&F=//CNC_MEM/USER/PATH1/", "outside<&F=//CNC_MEM/USER/PATH1/>"),
    ("#1=1+2*3-4", "#1:=Subtract(Add(1,Multiply(2,3)),4)"),
    ("#1=#2*#3AND#4", "#1:=And(Multiply(#2,#3),#4)"),
    ("#1=-#2-#3-#4*5/#6", "#1:=Subtract(Subtract(neg(#2),#3),Divide(Multiply(#4,5),#6))"),
    ("#1=#2 OR #3 MOD 2", "#1:=Or(#2,Modulo(#3,2))"),
    ("#1=-#2*3", "#1:=Multiply(neg(#2),3)"),
    ("#1=#2*-1", "#1:=Multiply(#2,neg(1))"),
    ("#1=5M8", "#1:=5 M=8"),
    ("#1=#2 END1", "#1:=#2 end1"),
    ("T[[#20*100]+#20]", "T=[Add([Multiply(#20,100)],#20)]"),
    ("IF[#1 EQ 1](NOTE)THEN(MORE)#2=3", "if-then [Equal(#1,1)] {(NOTE) (MORE) #2:=3}"),
    ("IF[#1 EQ #2] AND [#3 EQ #4] THEN #5 = 0 ;", "if-then And([Equal(#1,#2)],[Equal(#3,#4)]) {#5:=0} ;"),
    ("WHILE[#1 LT 1](NOTE)DO 2", "(NOTE) while [Less(#1,1)] do2"),
    ("\0\0\0%", "%"),
    // A byte order mark before the text, and the Ctrl-Z after it: nothing that a control sees.
    ("\u{feff}%", "%"),
    ("\u{feff}O1", "program 1"),
    ("\u{feff}G1 X2 (A)", "G=1 X=2 (A)"),
    ("%\u{1a}", "%"),
    ("M30 \u{1a}", "M=30"),
    ("\u{1a}", ""),
    ("(\u{e9}\u{1}) M8", "(\u{e9}\u{1}) M=8"),
];

#[test]
fn both_dialects_read_these_alike() {
    for dialect in BOTH {
        for (text, tree) in SHARED {
            let blocks = dialect.line(text.as_bytes());
            assert_eq!(show(&blocks, text.as_bytes()), *tree, "{}: {text}", dialect.name);
            for block in &blocks {
                assert_eq!(block.errors, [], "{}: {text}", dialect.name);
            }
        }
    }
}

#[test]
fn what_only_one_reads() {
    let fanuc = [
        ("X[#POS1] Y-[#POS2]", "X=#<POS1> Y=neg(#<POS2>)"),
        ("[#TOOL_NO]=10;", "#<TOOL_NO>:=10 ;"),
        ("#[100+[#ABS]] = 500", "#(Add(100,#<ABS>)):=500"),
        ("#500=[1000+[#pos2]*10]", "#500:=[Add(1000,Multiply(#<POS2>,10))]"),
        ("#1=[#_ABSIO[2]]", "#1:=#_ABSIO(2)"),
        ("SETVN 510[TOOL_NO, WORK_NO]", "names 510 TOOL_NO,WORK_NO"),
    ];
    let haas = [
        ("#10100=#30003.078", "#10100:=#30003.78"),
        ("IF[#30057.21]GOTO22", "if [#30057.21] {goto 22}"),
        ("[#10000 LT 10] M99 P10", "if-bare [Less(#10000,10)] {M=99 P=10}"),
        ("N50 [#1000] GOTO10", "N50 if-bare [#1000] {goto 10}"),
        (
            "IF [ #21 EQ #22 ] THEN #7= [ #17 * 0.9 ] S [ #18 * 0.85 ]",
            "if-then [Equal(#21,#22)] {#7:=[Multiply(#17,0.9.)] S=[Multiply(#18,0.85.)]}",
        ),
    ];
    for (dialect, other, rows) in [(FANUC, HAAS, &fanuc[..]), (HAAS, FANUC, &haas[..])] {
        for (text, tree) in rows {
            assert_eq!(show(&dialect.line(text.as_bytes()), text.as_bytes()), *tree, "{text}");
            let read_too = text.starts_with("IF [");
            assert_eq!(other.line(text.as_bytes())[0].errors.is_empty(), read_too, "{}: {text}", other.name);
        }
    }
}

/// Seed 001:1056 ranks AND with the products, OR and XOR with the sums; the table of Haas has them after the
/// comparisons, as true and false are numbers there.
#[test]
fn bit_operators_have_their_own_ranks() {
    for (text, fanuc, haas) in [
        ("#1=#2+#3AND#4", "#1:=Add(#2,And(#3,#4))", "#1:=And(Add(#2,#3),#4)"),
        ("#1=#2OR#3+#4", "#1:=Add(Or(#2,#3),#4)", "#1:=Or(#2,Add(#3,#4))"),
        ("#1=#2XOR#3AND#4", "#1:=Xor(#2,And(#3,#4))", "#1:=Xor(#2,And(#3,#4))"),
        (
            "IF[#1EQ2AND#3GT4]GOTO5",
            "if [Greater(Equal(#1,And(2,#3)),4)] {goto 5}",
            "if [And(Equal(#1,2),Greater(#3,4))] {goto 5}",
        ),
        (
            "IF[#1]OR[#2]AND[#3]GOTO5",
            "if Or([#1],And([#2],[#3])) {goto 5}",
            "if Or([#1],And([#2],[#3])) {goto 5}",
        ),
    ] {
        for (dialect, tree) in [(FANUC, fanuc), (HAAS, haas)] {
            assert_eq!(
                show(&dialect.line(text.as_bytes()), text.as_bytes()),
                tree,
                "{}: {text}",
                dialect.name
            );
        }
    }
}

#[test]
fn text_before_the_tape_sign_is_outside() {
    let source = b"Archived by the shop, 3 March\r\n%\r\nO1\r\nM30\r\n%\r\n";
    for dialect in BOTH {
        let shown = show(&dialect.file(source), source);
        assert_eq!(shown, "outside<Archived by the shop, 3 March> | % | program 1 | M=30 | %");
        // With code before it, an unreadable line is an unreadable line.
        let source = b"O1\nNOT CODE\nM30\n%\nO2\n";
        assert_eq!(show(&dialect.file(source), source), "program 1 | UNPARSED | M=30 | % | program 2");
    }
}
