use super::*;

fn writes(dialect: &str, program: &Program, lines: &[&str]) {
    assert_eq!(text(dialect, program).lines().collect::<Vec<_>>(), lines);
}

fn fanuc(program: &Program, lines: &[&str]) {
    writes("fanuc", program, lines);
}

fn le(number: u32, limit: f64) -> Cond {
    compare(Relation::LessEqual, v(number), n(limit))
}

#[test]
fn a_branch_jumps_over_what_it_leaves_out() {
    fanuc(
        &blocks([(&[], vec![], branch(gt(1, 5.0), 2, 1)), (&[], vec![mv(1.0)], jump(2)), (&[], vec![], END)]),
        &["IF [#1 GT 5] GOTO 10", "X1.", "N10 M30"],
    );
    fanuc(
        &blocks([(&[], vec![], branch(gt(1, 5.0), 1, 2)), (&[], vec![mv(1.0)], jump(2)), (&[], vec![], END)]),
        &["IF [#1 LE 5] GOTO 10", "X1.", "N10 M30"],
    );
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 5.0), 2, 3)),
            (&[], vec![mv(1.0)], END),
            (&[], vec![mv(2.0)], jump(1)),
            (&[], vec![mv(3.0)], jump(1)),
        ]),
        &["IF [#1 GT 5] GOTO 20", "GOTO 30", "N10 X1.", "M30", "N20 X2.", "GOTO 10", "N30 X3.", "GOTO 10"],
    );
    // Both ways lead to the same place; the condition is still evaluated.
    fanuc(
        &blocks([(&[], vec![], branch(gt(1, 5.0), 1, 1)), (&[], vec![], END)]),
        &["IF [#1 GT 5] GOTO 10", "N10 M30"],
    );
}

#[test]
fn one_macro_statement_stands_behind_then() {
    let program = |stmt| {
        blocks([(&[], vec![], branch(gt(1, 5.0), 1, 2)), (&[], vec![stmt], jump(2)), (&[], vec![], END)])
    };
    fanuc(&program(set(2, n(1.0))), &["IF [#1 GT 5] THEN #2=1", "M30"]);
    let alarm = StmtKind::Alarm { number: n(1.0).into(), text: "TOO DEEP".into() };
    fanuc(&program(alarm), &["IF [#1 GT 5] THEN #3000=1 (TOO DEEP)", "M30"]);
    fanuc(&program(StmtKind::OpenPort), &["IF [#1 LE 5] GOTO 10", "POPEN", "N10 M30"]);
    // Another way into the statement, or two statements.
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(9, 0.0), 2, 1)),
            (&[], vec![], branch(gt(1, 5.0), 2, 3)),
            (&[], vec![set(2, n(1.0))], jump(3)),
            (&[], vec![], END),
        ]),
        &["IF [#9 GT 0] GOTO 10", "IF [#1 LE 5] GOTO 20", "N10 #2=1", "N20 M30"],
    );
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 5.0), 1, 2)),
            (&[], vec![set(2, n(1.0)), set(3, n(1.0))], jump(2)),
            (&[], vec![], END),
        ]),
        &["IF [#1 LE 5] GOTO 10", "#2=1", "#3=1", "N10 M30"],
    );
}

#[test]
fn words_stand_behind_then_where_they_did_and_may() {
    let mut builder = Builder::new();
    let at = SourceInfo { comments: [comment("LAST", false)].into(), ..numbered(1, 10) };
    let (then, otherwise) = (builder.fresh(), builder.fresh());
    builder.end(TermKind::Branch { cond: Box::new(gt(1, 5.0)), then, otherwise }, at.clone());
    builder.start(then);
    builder.push(mv(1.0), at);
    builder.start(otherwise);
    builder.end(END, site(2));
    let program = builder.finish(None, 0, SourceInfo::default());
    writes("haas", &program, &["N10 IF [#1 GT 5] THEN X1. (LAST)", "M30"]);
    fanuc(&program, &["N10 IF [#1 LE 5] GOTO 20 (LAST)", "X1.", "N20 M30"]);
}

#[test]
fn conditions_are_joined_and_turned_round() {
    let program = |cond, then, otherwise| {
        blocks([
            (&[], vec![], branch(cond, then, otherwise)),
            (&[], vec![mv(1.0)], jump(2)),
            (&[], vec![], END),
        ])
    };
    let head = |dialect: &str, program: &Program| {
        let text = text(dialect, program);
        text.lines().next().unwrap().strip_suffix(" GOTO 10").unwrap().to_owned()
    };
    let both = || Cond::And(vec![gt(1, 0.0), gt(2, 0.0)]);
    assert_eq!(head("fanuc", &program(both(), 2, 1)), "IF [[#1 GT 0] AND [#2 GT 0]]");
    assert_eq!(head("fanuc", &program(both(), 1, 2)), "IF [[#1 LE 0] OR [#2 LE 0]]");
    let not = Cond::Not(Box::new(Cond::Or(vec![both(), gt(3, 0.0)])));
    assert_eq!(head("haas", &program(not, 2, 1)), "IF [[[#1 LE 0] OR [#2 LE 0]] AND [#3 LE 0]]");
    let sums = || compare(Relation::Equal, add(v(1), n(1.0)), mul(neg(v(2)), n(-3.0)));
    assert_eq!(head("fanuc", &program(sums(), 2, 1)), "IF [[#1+1] EQ [-#2]*[-3]]");
    assert_eq!(head("haas", &program(sums(), 2, 1)), "IF [[#1+1] EQ [-#2]*[-3]]");
    let vacant = compare(Relation::NotEqual, v(1), Expr::Vacant);
    assert_eq!(head("fanuc", &program(vacant, 2, 1)), "IF [#1 NE #0]");
    let signs = compare(Relation::Less, v(1), n(-5.0));
    assert_eq!(head("fanuc", &program(signs, 2, 1)), "IF [#1 LT -5]");
    let switch = Cond::And(vec![Cond::Switch(1), gt(1, 0.0)]);
    assert_eq!(refused("fanuc", &program(switch, 2, 1)), [Code::Unmapped]);
    assert_eq!(refused("fanuc", &program(Cond::And(vec![]), 2, 1)), [Code::Unmapped]);
}

#[test]
fn a_loop_that_tests_at_its_head_is_while() {
    let program = |cond, then, otherwise| {
        blocks([
            (&[], vec![set(1, n(0.0))], jump(1)),
            (&[], vec![], branch(cond, then, otherwise)),
            (&[], vec![mv(1.0), set(1, add(v(1), n(1.0)))], jump(1)),
            (&[], vec![], END),
        ])
    };
    let lines = ["#1=0", "WHILE [#1 LE 9] DO1", "X1.", "#1=#1+1", "END1", "M30"];
    fanuc(&program(le(1, 9.0), 2, 3), &lines);
    // As IF .. GOTO out of it, it is the same loop.
    fanuc(&program(gt(1, 9.0), 3, 2), &lines);
}

#[test]
fn a_loop_may_be_left_early() {
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 0.0), 1, 3)),
            (&[], vec![mv(1.0)], branch(gt(2, 3.0), 3, 2)),
            (&[], vec![mv(2.0)], jump(0)),
            (&[], vec![], END),
        ]),
        &["WHILE [#1 GT 0] DO1", "X1.", "IF [#2 GT 3] GOTO 10", "X2.", "END1", "N10 M30"],
    );
}

#[test]
fn a_loop_with_a_second_way_back_or_in_stays_jumps() {
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 0.0), 1, 3)),
            (&[], vec![mv(1.0)], branch(gt(2, 3.0), 0, 2)),
            (&[], vec![mv(2.0)], jump(0)),
            (&[], vec![], END),
        ]),
        &["N10 IF [#1 LE 0] GOTO 20", "X1.", "IF [#2 GT 3] GOTO 10", "X2.", "GOTO 10", "N20 M30"],
    );
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(9, 0.0), 3, 1)),
            (&[], vec![], branch(gt(1, 0.0), 2, 4)),
            (&[], vec![mv(1.0)], jump(3)),
            (&[], vec![mv(2.0)], jump(1)),
            (&[], vec![], END),
        ]),
        &["IF [#9 GT 0] GOTO 20", "N10 IF [#1 LE 0] GOTO 30", "X1.", "N20 X2.", "GOTO 10", "N30 M30"],
    );
    // A block that a caller returns to is a way in.
    let program = blocks([
        (&[], vec![], branch(gt(1, 0.0), 1, 2)),
        (&[50], vec![mv(1.0)], jump(0)),
        (&[], vec![], END),
    ]);
    fanuc(&program, &["WHILE [#1 GT 0] DO1", "N50 X1.", "END1", "M30"]);
    let mut kept = names();
    kept.keep_sequences(&crate::ir::analysis::Numbers::of([(50, 50)]));
    let emitted = emit_with("fanuc", &program, &kept).unwrap();
    assert_eq!(emitted.text, "N10 IF [#1 LE 0] GOTO 60\nN50 X1.\nGOTO 10\nN60 M30\n");
    // A loop that statements stand at the head of, and one that tests at its end.
    fanuc(
        &blocks([
            (&[], vec![mv(1.0)], branch(gt(1, 0.0), 1, 2)),
            (&[], vec![mv(2.0)], jump(0)),
            (&[], vec![], END),
        ]),
        &["N10 X1.", "IF [#1 LE 0] GOTO 20", "X2.", "GOTO 10", "N20 M30"],
    );
    fanuc(
        &blocks([(&[], vec![mv(1.0)], branch(gt(1, 0.0), 0, 1)), (&[], vec![], END)]),
        &["N10 X1.", "IF [#1 GT 0] GOTO 10", "M30"],
    );
    fanuc(&blocks([(&[], vec![mv(1.0)], jump(0))]), &["N10 X1.", "GOTO 10"]);
}

#[test]
fn the_fourth_loop_inside_others_is_jumps() {
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 0.0), 1, 8)),
            (&[], vec![], branch(gt(2, 0.0), 2, 7)),
            (&[], vec![], branch(gt(3, 0.0), 3, 6)),
            (&[], vec![], branch(gt(4, 0.0), 4, 5)),
            (&[], vec![mv(1.0)], jump(3)),
            (&[], vec![], jump(2)),
            (&[], vec![], jump(1)),
            (&[], vec![], jump(0)),
            (&[], vec![], END),
        ]),
        &[
            "WHILE [#1 GT 0] DO1",
            "WHILE [#2 GT 0] DO2",
            "WHILE [#3 GT 0] DO3",
            "N10 IF [#4 LE 0] GOTO 20",
            "X1.",
            "GOTO 10",
            "N20 END3",
            "END2",
            "END1",
            "M30",
        ],
    );
}

#[test]
fn loops_behind_one_another_have_the_same_number() {
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 0.0), 1, 2)),
            (&[], vec![mv(1.0)], jump(0)),
            (&[], vec![], branch(gt(2, 0.0), 3, 4)),
            (&[], vec![mv(2.0)], jump(2)),
            (&[], vec![], END),
        ]),
        &["WHILE [#1 GT 0] DO1", "X1.", "END1", "WHILE [#2 GT 0] DO1", "X2.", "END1", "M30"],
    );
}

#[test]
fn a_jump_from_inside_to_before_the_loop_does_not_hit_its_while() {
    // N20 is an empty block before the header: the label gets a line of its own.
    let program = |inner: TermKind| {
        let mut program = blocks([
            (&[20], vec![], jump(1)),
            (&[], vec![], branch(gt(1, 0.0), 2, 4)),
            (&[], vec![mv(1.0)], inner),
            (&[], vec![mv(2.0)], jump(1)),
            (&[], vec![], END),
        ]);
        program.blocks[1].term.site = numbered(1, 20);
        program
    };
    fanuc(
        &program(branch(gt(2, 0.0), 0, 3)),
        &["N20", "WHILE [#1 GT 0] DO1", "X1.", "IF [#2 GT 0] GOTO 20", "X2.", "END1", "M30"],
    );
    fanuc(&program(jump(3)), &["N20 WHILE [#1 GT 0] DO1", "X1.", "X2.", "END1", "M30"]);
}

#[test]
fn a_loop_whose_branch_keeps_the_level_has_a_slash_before_each_line() {
    let program = |jumped_to: u32| {
        let mut made = blocks([
            (&[], vec![mv(9.0)], branch(gt(3, 0.0), jumped_to, 1)),
            (&[], vec![], branch(Cond::Switch(2), 4, 2)),
            (&[], vec![], branch(le(1, 9.0), 3, 4)),
            (&[], vec![mv(1.0), set(1, add(v(1), n(1.0)))], jump(2)),
            (&[], vec![], END),
        ]);
        made.blocks[1].term.site.skip = Some(2);
        made
    };
    fanuc(
        &program(4),
        &[
            "X9.",
            "IF [#3 GT 0] GOTO 10",
            "/2 WHILE [#1 LE 9] DO1",
            "/2 X1.",
            "/2 #1=#1+1",
            "/2 END1",
            "N10 M30",
        ],
    );
    // Where something else comes into it, the switch is asked once, and the way round it is not skipped.
    fanuc(
        &program(3),
        &[
            "X9.",
            "IF [#3 GT 0] GOTO 20",
            "/2 GOTO 10",
            "GOTO 30",
            "N10 IF [#1 GT 9] GOTO 30",
            "N20 X1.",
            "#1=#1+1",
            "GOTO 10",
            "N30 M30",
        ],
    );
}

#[test]
fn the_block_skip_switch_is_a_slash() {
    let program = |cond, then, otherwise, stmts, kind| {
        blocks([(&[], vec![], branch(cond, then, otherwise)), (&[], stmts, kind), (&[], vec![], END)])
    };
    let on = || Cond::Switch(1);
    fanuc(&program(on(), 2, 1, vec![mv(1.0)], jump(2)), &["/X1.", "M30"]);
    fanuc(&program(Cond::Switch(2), 2, 1, vec![mv(1.0)], jump(2)), &["/2 X1.", "M30"]);
    fanuc(&program(Cond::Not(Box::new(on())), 1, 2, vec![mv(1.0)], jump(2)), &["/X1.", "M30"]);
    fanuc(&program(on(), 2, 1, vec![], RETURN), &["/M99", "M30"]);
    // What a jump looks for is not skipped.
    fanuc(&program(on(), 2, 1, vec![], jump(0)), &["N10", "/GOTO 10", "M30"]);
    fanuc(
        &program(on(), 2, 1, vec![mv(1.0), mv(2.0)], jump(2)),
        &["/GOTO 10", "GOTO 20", "N10 X1.", "X2.", "N20 M30"],
    );
    // While the switch is on, the control passes over `/GOTO 10` and comes to what stands after it.
    fanuc(&program(on(), 1, 2, vec![mv(1.0)], jump(2)), &["/GOTO 10", "X1.", "N10 M30"]);
    fanuc(
        &blocks([
            (&[], vec![], branch(on(), 3, 1)),
            (&[], vec![], branch(gt(1, 5.0), 2, 3)),
            (&[], vec![set(2, n(1.0))], jump(3)),
            (&[], vec![], END),
        ]),
        &["/IF [#1 GT 5] THEN #2=1", "M30"],
    );
    fanuc(
        &blocks([
            (&[], vec![], branch(on(), 2, 1)),
            (&[], vec![], branch(gt(1, 5.0), 3, 2)),
            (&[], vec![mv(1.0)], jump(3)),
            (&[], vec![], END),
        ]),
        &["/IF [#1 GT 5] GOTO 10", "X1.", "N10 M30"],
    );
}

#[test]
fn a_computed_jump_finds_every_number() {
    let program = |value| {
        let targets = vec![(10, BlockId(1)), (20, BlockId(2))];
        blocks([
            (&[], vec![], TermKind::Computed { value, targets: targets.into() }),
            (&[10], vec![mv(1.0)], jump(2)),
            (&[20], vec![], END),
        ])
    };
    fanuc(&program(Box::new(v(1))), &["GOTO #1", "N10 X1.", "N20 M30"]);
    fanuc(&program(Box::new(add(v(1), n(10.0)))), &["GOTO [#1+10]", "N10 X1.", "N20 M30"]);
}

#[test]
fn text_that_ends_in_the_middle_ends_at_its_end() {
    fanuc(
        &blocks([
            (&[], vec![], branch(gt(1, 0.0), 2, 1)),
            (&[], vec![mv(1.0)], TermKind::Stray),
            (&[], vec![mv(2.0)], TermKind::Stray),
        ]),
        &["IF [#1 GT 0] GOTO 10", "X1.", "GOTO 20", "N10 X2.", "N20"],
    );
}

#[test]
fn a_jump_to_nowhere_is_refused() {
    assert_eq!(refused("fanuc", &blocks([(&[], vec![], jump(7))])), [Code::Unmapped]);
}
