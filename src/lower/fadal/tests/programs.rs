//! Whole programs: jumps, subroutines, calls, modal state over ways.

use super::{control, found, lowered};

/// The lines of a program's text form.
fn program(source: &str) -> String {
    let (lines, _) = lowered(source, &control(""));
    format!("{}\n", lines.join("\n"))
}

#[test]
fn subroutines_stand_at_the_head_and_are_jumped_over() {
    let source = "O1\nL100\nX1.\nL200\nX2.\nM17\nM30\nG91 G1\nL101\nL203\nM2\n";
    let expected = "program O1 file 0 {\nblock0:\njump block3\nblock1 (:L100):\nnc axis.x=1\nreturn\nblock2 (:L200):\nnc axis.x=2\nreturn\nblock3:\nnc distance.incremental motion.linear\ncall block1 -> block4\nblock4:\ncall block2 times 3 -> block5\nblock5:\nend\n}\n";
    assert_eq!(program(source), expected);
    assert_eq!(found(source, ""), Vec::<String>::new());
}

#[test]
fn a_computed_call_is_chosen_from_what_its_variable_may_hold() {
    // One constant: one call with its count.
    let one = program("O1\nL100\nG1 X1.\nM17\nM30\nR2+102.\nL+R2\nM2\n");
    assert!(one.contains("call block1 times 2 -> "), "{one}");
    // Two subroutines: a comparison picks.
    let two = program("O1\nL100\nG1 X1.\nL200\nG1 X2.\nM17\nM30\nR2+101.\n#IF V1=1 THEN R2=202\nL+R2\nM2\n");
    assert!(two.contains("tmp.1 = param.2\nbranch all(tmp.1 ge 101, tmp.1 lt 200) ? "), "{two}");
    assert!(two.contains("call block1 times tmp.1 - 100 -> "), "{two}");
    assert!(two.contains("call block2 times tmp.1 - 200 -> "), "{two}");
    assert!(!two.contains("alarm"), "{two}");
    // Nothing known: any of the program's subroutines, or an alarm, and the reviewer is told.
    let open = "O1\nL100\nG1 X1.\nM17\nM30\n#R2=V1\nL+R2\nM2\n";
    let any = program(open);
    assert!(any.contains("alarm 1 \"NO SUCH SUBROUTINE\""), "{any}");
    assert_eq!(found(open, ""), ["Conditional"]);
    // Of no subroutine of the program it can be none but one of the control's own.
    assert_eq!(found("O1\n#R2=V1\nL+R2\nM2\n", ""), ["NotUnderstood"]);
}

#[test]
fn modal_calls_name_their_subroutine() {
    let source = "O1\nL100\nG1 Z-1.\nM17\nM30\nG0 X0\nL101 G66\nM45\nX1.\nG67\nM2\n";
    let text = program(source);
    assert!(
        text.contains("nc motion.rapid axis.x=0\nmodal block1\nnc cycle.here\nnc axis.x=1\nmodal.off\nend\n"),
        "{text}"
    );
    assert!(found(source, "").is_empty());
    let nested = "O1\nL100\nL201 G66\nX1.\nG67\nM17\nL200\nM17\nM30\nG0 X0\nL101 G66\nX1.\nG67\nM2\n";
    assert_eq!(found(nested, ""), ["behaviour:call.modal.nested"]);
    // What a modal subroutine drills is no move of its caller: no G1 that would end the cycle.
    let drills = "O1\nL100\n#:A\nG82 Z-1. R0+2. P250\nX+R9\nG80\n#IF V1>0 THEN GOTO :A\nM17\nM30\n";
    let text = program(&format!("{drills}G1 X0\nL101 G66\nX4.\nG67\nM2\n"));
    assert!(text.contains("nc axis.x=param.9"), "{text}");
}

#[test]
fn fixed_subroutines_take_the_words_of_their_block() {
    let text = program("O1\nL9101 R1+1. X+R6. P1 F30.\nM2\n");
    assert!(
        text.contains("param.1 = 1\ncall cycle 9101 level (24: param.6, 16: 1, 6: 30) -> block1"),
        "{text}"
    );
    assert_eq!(found("O1\nL9101 R1+1. P1\nM2", ""), ["FixedSubroutine"]);
}

#[test]
fn programs_are_called_returned_from_and_chained() {
    let text = program("O1\nR5+1. M98 P800\nM98 P+R3\nM98 P9 L4\n#START 7\n");
    assert!(text.contains("param.5 = 1\ncall O800 -> block1"), "{text}");
    assert!(text.contains("call O9 times 4 -> "), "{text}");
    assert!(text.contains("chain O7"), "{text}");
    assert!(program("O1\nG0 X1. M99\n").contains("nc motion.rapid axis.x=1\nreturn"));
    assert!(program("O1\nM30\n").contains("end rewind"));
    // M99 P jumps, in this program where the number stands in it.
    let text = program("O1\nN5 G0 X1.\nM99 P5\n");
    assert!(text.contains("block1 (N5):\nnc motion.rapid axis.x=1\njump block1"), "{text}");
}

#[test]
fn jumps_find_the_first_of_their_goals() {
    let source = "O1\n#:A\nG0 X1.\n#:A\nG0 X2.\n#GOTO :A\n";
    let text = program(source);
    assert!(
        text.contains("block1 (:A):\nnc motion.rapid axis.x=1\nnc motion.rapid axis.x=2\njump block1"),
        "{text}"
    );
    assert_eq!(found(source, ""), Vec::<String>::new());
    assert_eq!(found("O1\nN1 G0 X1.\nN1 X2.\n#GOTO N1\n", ""), ["TargetTwice"]);
    assert_eq!(found("O1\nL100\nN7 G1 X1.\nM17\nM30\n#GOTO N7\n", ""), ["SubroutineLeft"]);
}

#[test]
fn motion_modes_are_followed_over_ways_and_calls() {
    // A loop that comes back in an arc mode: straight either way.
    let text = program("O1\nG1 X0\n#:A\nX1.\nG2 X2. I.5\n#IF V1=1 THEN GOTO :A\nM2\n");
    assert!(text.contains("block1 (:A):\nnc motion.linear axis.x=1\n"), "{text}");
    // Rapid on one way and an arc on the other: no one translation.
    let found1 = found("O1\nG0 X0\n#:A\nX1.\nG2 X2. I.5\n#IF V1=1 THEN GOTO :A\nM2\n", "");
    assert!(found1.contains(&"ModalConflict".to_owned()), "{found1:?}");
    // The mode comes back from a subroutine.
    let text = program("O1\nL100\nG3 X1. I1.\nM17\nM30\nG0 X0\nL101\nX5.\nM2\n");
    assert!(text.contains("nc motion.linear axis.x=5"), "{text}");
    // After a cycle the mode from before it is spelled out, unless a program was called since.
    let cycled = |call: &str| format!("O1\nG0 X0\n{call}G81 Z-1. R0+.1\nG80\nX5.\nM2\n");
    assert!(program(&cycled("")).contains("nc motion.rapid axis.x=5"));
    assert!(program(&cycled("M98 P7\n")).contains("nc axis.x=5"));
    assert!(found(&cycled("M98 P7\n"), "").contains(&"ModalAssumed".to_owned()));
    // So are the places of rounding: another program of the file sets them otherwise, or not.
    let rounds = |set: &str| format!("O1\n#SET RND3\nM98 P2\n#V1=RND(V2)\nM2\nO2\n{set}\nM99\n");
    assert!(found(&rounds("#SET RND2"), "").contains(&"ModalConflict".to_owned()));
    assert_eq!(found(&rounds("#SET RND3"), ""), ["ModalAssumed", "behaviour:round.half.away"]);
    // A called program is taken to leave it alone, and that is said.
    let found2 = found("O1\nG3 X1. I1.\nM98 P5\nX2. I1.\nM2\n", "");
    assert!(found2.contains(&"ModalAssumed".to_owned()), "{found2:?}");
}

#[test]
fn block_skip_goes_round_what_changes_the_flow() {
    let text = program("O1\n/M98 P5\nG0 X1.\nM2\n");
    assert!(text.contains("branch switch 1 ? block3 : block1\nblock1:\ncall O5 -> block2"), "{text}");
    let parsed = crate::syntax::parse_file(b"O1\n/G0 X1.\n", crate::syntax::fadal::parse_line);
    let lowered = super::lower(&parsed, 0, "t", &control(""));
    assert_eq!(lowered.programs[0].0.blocks[0].stmts[0].site.skip, Some(1));
}

#[test]
fn a_file_is_cut_at_its_names() {
    let text = program("(HEAD\nN1 O5 (FIRST\nM99\nO6*SECOND\nM99\n%\n");
    assert!(text.starts_with("program O5 file 0 {"), "{text}");
    assert!(text.contains("program O6 file 0 {"), "{text}");
    let text = program("G0 X0\nO5\nM2\n");
    assert!(text.starts_with("program unnamed file 0 {"), "{text}");
    assert!(text.contains("program O5 file 0 {"), "{text}");
}

#[test]
fn comments_are_kept() {
    let source = b"O1 (NAME\nL100 (SUB\nG1 X1.\nM17 (END OF SUB\n(BETWEEN\nM30 (AREA\nM2 (LAST\n(TAIL\n";
    let parsed = crate::syntax::parse_file(source, crate::syntax::fadal::parse_line);
    let lowered = super::lower(&parsed, 0, "t", &control(""));
    let (program, _) = &lowered.programs[0];
    let mut texts: Vec<&str> = program.site.comments.iter().map(|r| r.text.as_str()).collect();
    for block in &program.blocks {
        let sites = block.stmts.iter().map(|stmt| &stmt.site).chain([&block.term.site]);
        texts.extend(sites.flat_map(|site| &site.comments).map(|r| r.text.as_str()));
    }
    assert_eq!(texts, ["NAME", "SUB", "END OF SUB", "BETWEEN", "AREA", "LAST", "TAIL"]);
}
