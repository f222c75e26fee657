use super::*;

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
        let site = Site { sequence: *number, ..site(at) };
        builder.push(mv(f64::from(at + 1)), site);
    }
    for target in targets {
        builder.end_then(Site::default(), |no| branch_to(*target, no));
    }
    builder.end(END, Site::default());
    builder.finish(None, 0, Site::default())
}

fn branch_to(to: u32, no: BlockId) -> TermKind {
    TermKind::Branch { cond: gt(1, 0.0), yes: BlockId(to), no }
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
            (&[], vec![], TermKind::Computed { value: v(1), targets }),
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
    kept.keep_sequence(123456);
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
fn the_name_of_a_label_is_kept_as_a_comment() {
    let mut program = blocks([(&[], vec![mv(1.0)], jump(0))]);
    program.blocks[0].labels.push(Label::Name("LOOP".into()));
    fanuc(&program, &["N10 (LOOP) X1.", "GOTO 10"]);
    program.blocks[0].term.kind = END;
    fanuc(&program, &["X1.", "M30"]);
}
