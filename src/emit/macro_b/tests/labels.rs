use super::*;
use crate::ir::analysis::{Numbers, Summaries};

fn fanuc(program: &Program, lines: &[&str]) {
    assert_eq!(text("fanuc", program).lines().collect::<Vec<_>>(), lines);
}

/// The lines `X1.`, `X2.`, ... with these numbers, then jumps to those in `targets`.
fn lines(numbers: &[Option<u32>], targets: &[u32]) -> Program {
    let mut builder = Builder::over(numbers.len());
    for (at, number) in (0..).zip(numbers) {
        if at > 0 {
            builder.start(BlockId(at));
        }
        if let Some(number) = number {
            builder.label(Label::Number(*number));
        }
        let site = SourceInfo { sequence: (*number).into(), ..site(at) };
        builder.push(mv(f64::from(at + 1)), site);
    }
    for target in targets {
        builder.end_then(SourceInfo::default(), |otherwise| branch_to(*target, otherwise));
    }
    builder.end(END, SourceInfo::default());
    builder.finish(None, 0, SourceInfo::default())
}

fn branch_to(to: u32, otherwise: BlockId) -> TermKind {
    TermKind::Branch { cond: Box::new(gt(1, 0.0)), then: BlockId(to), otherwise }
}

#[test]
fn numbers_stay_on_their_blocks() {
    fanuc(&lines(&[Some(5), None, Some(7)], &[]), &["N5 X1.", "X2.", "N7 X3.", "M30"]);
    fanuc(&lines(&[Some(10), Some(20)], &[1]), &["N10 X1.", "N20 X2.", "IF [#1 GT 0] GOTO 20", "M30"]);
    // Twice, and nobody looks for it.
    fanuc(&lines(&[Some(10), Some(10)], &[]), &["N10 X1.", "N10 X2.", "M30"]);
}

#[test]
fn a_new_number_lies_between_its_neighbours() {
    for (numbers, text) in [
        ([Some(100), None, Some(200)], "N110 X2."),
        ([Some(95), None, Some(200)], "N100 X2."),
        ([Some(100), None, Some(105)], "N101 X2."),
        ([Some(100), None, Some(101)], "N9000 X2."),
        ([Some(200), None, Some(100)], "N9000 X2."),
        ([None, None, Some(30)], "N10 X2."),
        ([None, None, Some(3)], "N1 X2."),
        ([Some(99999), None, None], "N9000 X2."),
    ] {
        let program = lines(&numbers, &[1]);
        let number = text.split(' ').next().unwrap().trim_start_matches('N');
        let lines: Vec<String> = super::text("fanuc", &program).lines().map(str::to_owned).collect();
        assert_eq!(lines[1], text);
        assert_eq!(lines[3], format!("IF [#1 GT 0] GOTO {number}"));
    }
}

#[test]
fn a_number_that_another_block_is_found_by_becomes_a_comment() {
    fanuc(&lines(&[Some(10), Some(10)], &[1]), &["(N10) X1.", "N10 X2.", "IF [#1 GT 0] GOTO 10", "M30"]);
    fanuc(
        &lines(&[Some(10), Some(10), Some(30)], &[0, 1]),
        &["N10 X1.", "N20 (N10) X2.", "N30 X3.", "IF [#1 GT 0] GOTO 10", "IF [#1 GT 0] GOTO 20", "M30"],
    );
}

#[test]
fn a_number_that_the_control_does_not_take_becomes_a_comment() {
    fanuc(&lines(&[Some(0), Some(123456)], &[]), &["(N0) X1.", "(N123456) X2.", "M30"]);
    fanuc(&lines(&[Some(123456)], &[0]), &["N10 (N123456) X1.", "IF [#1 GT 0] GOTO 10", "M30"]);
}

#[test]
fn numbers_that_are_fixed_are_kept_or_refused() {
    let program = |targets: Vec<(u32, BlockId)>| {
        blocks([
            (&[], vec![], TermKind::Computed { value: Box::new(v(1)), targets: targets.into() }),
            (&[10, 20], vec![mv(1.0)], jump(2)),
            (&[10], vec![], END),
        ])
    };
    fanuc(&program(vec![(10, BlockId(1)), (20, BlockId(1))]), &["GOTO #1", "N20", "N10 X1.", "M30"]);
    let twice = program(vec![(10, BlockId(1)), (10, BlockId(2))]);
    assert_eq!(refused("fanuc", &twice), [Code::NoSequenceNumber]);
    let large = program(vec![(123456, BlockId(1))]);
    assert_eq!(refused("fanuc", &large), [Code::NoSequenceNumber]);
    let mut kept = names();
    kept.keep_sequences(&Numbers::of([(123456, 123456)]));
    let faults = emit_with("fanuc", &lines(&[Some(123456)], &[]), &kept).unwrap_err();
    assert_eq!(faults[0].code, Code::NoSequenceNumber);
}

#[test]
fn a_label_without_a_line_gets_one() {
    fanuc(&blocks([(&[], vec![mv(1.0)], jump(1)), (&[999], vec![], TermKind::Stray)]), &["X1.", "N999"]);
    fanuc(
        &blocks([(&[30], vec![], jump(1)), (&[40], vec![mv(1.0)], jump(0))]),
        &["N30", "N40 X1.", "GOTO 30"],
    );
}

#[test]
fn what_a_computed_jump_may_look_for_is_not_invented() {
    let jumping = |value: Expr, first: StmtKind| {
        let targets = vec![(20, BlockId(3))];
        let mut program = blocks([
            (
                &[],
                vec![],
                TermKind::Branch { cond: Box::new(gt(5, 3.0)), then: BlockId(1), otherwise: BlockId(2) },
            ),
            (&[], vec![mv(1.0), mv(2.0)], jump(2)),
            (&[], vec![first], TermKind::Computed { value: Box::new(value), targets: targets.into() }),
            (&[20], vec![mv(2.0)], END),
        ]);
        program.blocks[3].stmts[0].site.sequence = Some(20).into();
        program
    };
    let set = |value: f64| StmtKind::Assign { target: Place::Var(local(1)), value: Expr::Number(value) };
    let module = |program: &Program| Module { programs: vec![program.clone()], ..Module::default() };
    let written = |program: &Program| {
        let mut names = names();
        names.set_summaries(Summaries::of(&module(program)), 20);
        let text = emit_with("fanuc", program, &names).unwrap().text;
        text.lines().map(str::to_owned).collect::<Vec<_>>()
    };
    // #1 is 10: N10 would be found.
    let known = written(&jumping(v(1), set(10.0)));
    assert_eq!(known, ["IF [#5 LE 3] GOTO 1", "X1.", "X2.", "N1 #1=10", "GOTO #1", "N20 X2.", "M30"]);
    let elsewhere = written(&jumping(v(1), set(20.0)));
    assert_eq!(elsewhere[0], "IF [#5 LE 3] GOTO 10");
    // #7 may be anything: what lies above the program's numbers stops with an alarm, as it does on the source.
    let open = written(&jumping(v(7), set(10.0)));
    let guard = "IF [#7 GT 999] THEN #3000=1 (NO SUCH BLOCK)";
    let before = ["IF [#5 LE 3] GOTO 1000", "X1.", "X2.", "N1000 #1=10"];
    assert_eq!(open, [&before[..], &[guard, "GOTO #7", "N20 X2.", "M30"]].concat());
}

#[test]
fn a_number_that_a_computed_jump_must_not_find_becomes_a_comment() {
    // On the source 6 is no label.
    let targets = vec![(20, BlockId(1))];
    let mut program = blocks([
        (&[], vec![mv(1.0)], TermKind::Computed { value: Box::new(v(7)), targets: targets.into() }),
        (&[20], vec![mv(2.0)], END),
    ]);
    program.blocks[0].stmts[0].site.sequence = Some(6).into();
    fanuc(&program, &["(N6) X1.", "GOTO #7", "N20 X2.", "M30"]);
}

#[test]
fn the_name_of_a_label_is_kept_as_a_comment() {
    let mut program = blocks([(&[], vec![mv(1.0)], jump(0))]);
    program.blocks[0].labels.push(Label::Name("LOOP".into()));
    fanuc(&program, &["N10 (LOOP) X1.", "GOTO 10"]);
    program.blocks[0].term.kind = END;
    fanuc(&program, &["X1.", "M30"]);
}
