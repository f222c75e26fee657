use super::*;
use crate::canon::Sys;
use thin_vec::thin_vec;

fn alarm(number: f64, text: &str) -> StmtKind {
    StmtKind::Alarm { number: n(number).into(), text: text.into() }
}

#[test]
fn statements_have_the_syntax_of_the_manuals() {
    let write = |state, subscripts: &[Expr], value| StmtKind::Assign {
        target: Place::System(state, subscripts.into()),
        value,
    };
    let target = Place::Indirect(Bank::Numbered, Box::new(add(v(1), n(100.0))));
    for (kind, text) in [
        (set(100, add(v(1), n(2.0))), "#100=#1+2"),
        (set(500, v(1)), "#500=#1"),
        (set(1, Expr::Vacant), "#1=#0"),
        (StmtKind::Assign { target, value: n(5.0) }, "#[#1+100]=5"),
        (write(Sys::WorkOffset, &[n(1.0), n(1.0)], n(0.0)), "#5221=0"),
        (write(Sys::WorkOffset, &[v(1), n(1.0)], v(2)), "#[5201+20*#1]=#2"),
        (alarm(101.0, "HOLE SPACING TOO SMALL"), "#3000=101 (HOLE SPACING TOO SMALL)"),
        (alarm(1.0, ""), "#3000=1"),
        (StmtKind::StopMessage { number: v(1).into(), text: "CHECK TOOL".into() }, "#3006=#1 (CHECK TOOL)"),
        (StmtKind::OpenPort, "POPEN"),
        (StmtKind::ClosePort, "PCLOS"),
        (
            StmtKind::SetNames { first: local(510), names: thin_vec!["TOOL".into(), "LIFE".into()] },
            "SETVN 510[TOOL,LIFE]",
        ),
        (
            StmtKind::Output(vec![
                OutputPart::Text("X".into()),
                OutputPart::Value { value: v(1), whole: 5, fraction: 3 },
                OutputPart::Text(" MM".into()),
            ]),
            "DPRNT[X#1[53]*MM]",
        ),
        (StmtKind::ModalCallOff, "G67"),
    ] {
        assert_eq!(line("fanuc", kind), text);
    }
    assert_eq!(line("haas", StmtKind::LimitLookahead(n(1.0))), "G103 P1");
}

#[test]
fn what_the_target_cannot_do_is_refused() {
    let read_only = Place::System(Sys::WorkPosition, [n(1.0)].into());
    for kind in [
        StmtKind::Sync,
        StmtKind::LimitLookahead(n(1.0)),
        StmtKind::Input { serial: false, target: Place::Var(local(1)) },
        StmtKind::Print { serial: false, parts: thin_vec![PrintPart::Value(v(1))], stay: false },
        StmtKind::ClearAll(Class::Global),
        StmtKind::Assign { target: read_only, value: n(0.0) },
        StmtKind::Output(vec![OutputPart::Value { value: add(v(1), v(2)), whole: 5, fraction: 3 }]),
        StmtKind::Output(vec![OutputPart::Value { value: v(1), whole: 5, fraction: 4 }]),
        StmtKind::Output(vec![OutputPart::Value { value: v(1), whole: 0, fraction: 0 }]),
    ] {
        assert!(refused("fanuc", &one([kind.clone()])).contains(&Code::Unmapped), "{kind:?}");
    }
    let text = StmtKind::Output(vec![OutputPart::Text("50%".into())]);
    assert_eq!(refused("fanuc", &one([text])), [Code::TextUnwritable]);
    let names = StmtKind::SetNames { first: local(510), names: thin_vec!["9X".into()] };
    assert_eq!(refused("fanuc", &one([names])), [Code::TextUnwritable]);
    assert_eq!(refused("haas", &one([StmtKind::ModalCallOff])), [Code::Unmapped]);
}

#[test]
fn a_message_that_looks_different_is_for_review() {
    let program = one([alarm(1.0, "WIDTH (IN)")]);
    let emitted = emit_with("fanuc", &program, &names()).unwrap();
    assert_eq!(emitted.text, "#3000=1 (WIDTH [IN])\n");
    assert_eq!(emitted.findings[0].code, Code::MessageAltered);
}

fn g65(arguments: &[(u32, Expr)]) -> Call {
    let arguments = arguments.iter().map(|(local, value)| Argument { local: *local, value: value.clone() });
    Call {
        callee: Callee::Program(ProgramName::Number(9010)),
        level: true,
        arguments: arguments.collect(),
        count: None,
    }
}

fn called(dialect: &str, call: Call) -> String {
    let program = blocks([
        (&[], vec![], TermKind::Call { call: Box::new(call), next: BlockId(1) }),
        (&[], vec![], END),
    ]);
    text(dialect, &program).strip_suffix("\nM30\n").unwrap().to_owned()
}

#[test]
fn arguments_go_by_letter_or_by_place() {
    for (arguments, text) in [
        (vec![(1, n(1.0)), (2, n(2.5)), (24, v(100))], "G65 P9010 A1. B2.5 X#100"),
        // I, J and K out of order would go by place.
        (vec![(6, n(3.0)), (1, n(0.5)), (5, n(2.0)), (4, n(1.0))], "G65 P9010 I1. A0.5 J2. K3."),
        (vec![(1, neg(v(3))), (2, neg(n(2.0))), (3, add(v(1), v(2)))], "G65 P9010 A-#3 B-2. C[#1+#2]"),
        (vec![(1, Expr::Increments(10.0))], "G65 P9010 A10"),
        // A vacant argument is one that is not written.
        (vec![(1, Expr::Vacant), (2, n(1.0))], "G65 P9010 B1."),
        // Of two the later counts.
        (vec![(1, n(1.0)), (1, n(2.0))], "G65 P9010 A2."),
        // Locals 10, 12, 14 to 16 and from 27 on have no letter of their own.
        (vec![(10, n(3.0)), (4, n(1.0)), (7, n(2.0)), (1, n(9.0))], "G65 P9010 A9. I1. I2. I3."),
        (vec![(4, n(1.0)), (6, n(2.0)), (8, n(3.0)), (10, n(4.0))], "G65 P9010 I1. K2. J3. I4."),
        (vec![], "G65 P9010"),
    ] {
        assert_eq!(called("fanuc", g65(&arguments)), text);
    }
}

#[test]
fn an_argument_that_no_letter_reaches_is_refused() {
    for arguments in [
        vec![(10, n(1.0))],
        vec![(4, n(1.0)), (10, n(2.0))],
        vec![(40, n(1.0))],
        vec![(1, call(Func::Sin, [v(1)])), (1, n(2.0))],
    ] {
        let call = g65(&arguments);
        let program = blocks([
            (&[], vec![], TermKind::Call { call: Box::new(call), next: BlockId(1) }),
            (&[], vec![], END),
        ]);
        assert_eq!(refused("fanuc", &program), [Code::Unmapped]);
    }
}

#[test]
fn calls_are_those_of_the_control() {
    let plain = |callee, count| Call { callee, level: false, arguments: vec![], count };
    let named = || Callee::Program(ProgramName::Name("SUB".into()));
    assert_eq!(called("fanuc", plain(named(), None)), "M98 P8000");
    assert_eq!(called("fanuc", plain(named(), Some(n(3.0)))), "M98 P8000 L3");
    assert_eq!(called("fanuc", plain(Callee::Computed(v(1)), Some(v(2)))), "M98 P#1 L#2");
    assert_eq!(called("fanuc", Call { count: Some(n(2.0)), ..g65(&[(1, n(1.0))]) }), "G65 P9010 L2 A1.");
    let modal = StmtKind::ModalCall(Box::new(g65(&[(21, n(5.0))])));
    assert_eq!(line("fanuc", modal), "G66 P9010 U5.");
    assert_eq!(refused("haas", &one([StmtKind::ModalCall(Box::new(g65(&[])))])), [Code::Unmapped]);
    let unnamed = plain(Callee::Program(ProgramName::Name("NOBODY".into())), None);
    let stays = |call| {
        blocks([(&[], vec![], TermKind::Call { call: Box::new(call), next: BlockId(1) }), (&[], vec![], END)])
    };
    assert_eq!(refused("fanuc", &stays(unnamed)), [Code::Unmapped]);
    assert_eq!(refused("fanuc", &stays(plain(Callee::Cycle(800), None))), [Code::Unmapped]);
    let level = Call { level: false, ..g65(&[(1, n(1.0))]) };
    assert_eq!(refused("fanuc", &stays(level)), [Code::Unmapped]);
}

#[test]
fn a_part_of_the_program_is_called_by_its_sequence_number() {
    let call = |to| Call {
        callee: Callee::Block(BlockId(to)),
        level: false,
        arguments: vec![],
        count: Some(n(2.0)),
    };
    let program = || {
        blocks([
            (&[], vec![], TermKind::Call { call: Box::new(call(2)), next: BlockId(1) }),
            (&[], vec![], END),
            (&[100], vec![mv(1.0)], RETURN),
        ])
    };
    assert_eq!(text("haas", &program()), "M97 P100 L2\nM30\nN100 X1.\nM99\n");
    assert!(refused("fanuc", &program()).contains(&Code::Unmapped));
}

#[test]
fn ends_and_returns() {
    let end = |kind| text("fanuc", &blocks([(&[], vec![mv(1.0)], kind)]));
    assert_eq!(end(END), "X1.\nM30\n");
    assert_eq!(end(TermKind::End { rewind: false }), "X1.\nM2\n");
    assert_eq!(end(RETURN), "X1.\nM99\n");
    assert_eq!(end(TermKind::Return { to: Some(n(10.0)) }), "X1.\nM99 P10\n");
    assert_eq!(end(TermKind::Return { to: Some(v(1)) }), "X1.\nM99 P#1\n");
    assert_eq!(end(TermKind::Stray), "X1.\n");
    // M99 P of this control jumps in the running program, which is another thing.
    let back = blocks([(&[], vec![], TermKind::Return { to: Some(n(10.0)) })]);
    assert_eq!(refused("haas", &back), [Code::Unmapped]);
    let chain = blocks([(&[], vec![], TermKind::Chain(ProgramName::Number(7)))]);
    assert_eq!(refused("fanuc", &chain), [Code::Unmapped]);
}

#[test]
fn what_came_from_one_block_goes_back_to_one() {
    let at = SourceInfo { comments: [comment("HOME", false)].into(), ..numbered(1, 50) };
    let home = nc([op(Op::Incremental), op(Op::ReferenceReturn), word(Role::Z, n(0.0))]);
    let program = |kind: TermKind, rest: usize| {
        let mut builder = Builder::new();
        builder.push(home.clone(), at.clone());
        builder.end(kind, at.clone());
        for _ in 0..rest {
            let next = builder.fresh();
            builder.start(next);
            builder.end(END, SourceInfo::default());
        }
        builder.finish(None, 0, SourceInfo::default())
    };
    assert_eq!(text("fanuc", &program(END, 0)), "N50 G91 G28 Z0. M30 (HOME)\n");
    let call = || Call {
        callee: Callee::Program(ProgramName::Number(8000)),
        level: false,
        arguments: vec![],
        count: None,
    };
    let kind = || TermKind::Call { call: Box::new(call()), next: BlockId(1) };
    assert_eq!(text("fanuc", &program(kind(), 1)), "N50 G91 G28 Z0. M98 P8000 (HOME)\nM30\n");
    assert_eq!(text("haas", &program(kind(), 1)), "N50 G91 G28 Z0. (HOME)\nM98 P8000\nM30\n");
}

#[test]
fn comments_and_names_stay_with_their_blocks() {
    let mut builder = Builder::new();
    let comments = [comment("CUT (DEEP)", true), comment("50%", false)].into();
    builder.push(mv(1.0), SourceInfo { comments, ..numbered(2, 10) });
    builder.push(StmtKind::Comment, SourceInfo { comments: [comment("ALONE", true)].into(), ..site(3) });
    builder.push(StmtKind::Comment, numbered(4, 20));
    builder.push(StmtKind::Comment, site(5));
    builder.push(mv(2.0), SourceInfo { skip: Some(1), ..numbered(6, 30) });
    builder.push(mv(3.0), SourceInfo { skip: Some(2), ..site(7) });
    let text_of_alarm = StmtKind::Alarm { number: n(1.0).into(), text: "STOP".into() };
    let comments = [comment("STOP", false), comment("OR ELSE", false)].into();
    builder.push(text_of_alarm, SourceInfo { comments, ..numbered(8, 40) });
    let head = SourceInfo { comments: [comment("BOLT CIRCLE", false)].into(), ..numbered(1, 1) };
    let program = builder.finish(Some(ProgramName::Number(12)), 0, head);
    assert_eq!(
        text("fanuc", &program),
        "O0012 (BOLT CIRCLE)\n\
         N10 (CUT [DEEP]) X1. (50PCT)\n\
         (ALONE)\n\
         N20\n\
         ;\n\
         /N30 X2.\n\
         /2 X3.\n\
         (OR ELSE)\n\
         N40 #3000=1 (STOP)\n"
    );
}

#[test]
fn a_long_line_gives_up_its_comments_first() {
    let long =
        "A COMMENT THAT IS SO LONG THAT IT WOULD NOT FIT BESIDE THE WORDS OF THE BLOCK IT STANDS IN AT ALL";
    let mut builder = Builder::new();
    builder.push(mv(1.0), SourceInfo { comments: [comment(long, false)].into(), ..numbered(1, 10) });
    let program = builder.finish(
        Some(ProgramName::Number(7)),
        0,
        SourceInfo { comments: [comment(long, true)].into(), ..site(0) },
    );
    let first = "(A COMMENT THAT IS SO LONG THAT IT WOULD NOT FIT BESIDE THE WORDS OF THE BLOCK";
    let text = text("haas", &program);
    assert_eq!(
        text,
        format!("O0007\n{first})\n(IT STANDS IN AT ALL)\n{first})\n(IT STANDS IN AT ALL)\nN10 X1.\n")
    );
    assert!(text.lines().all(|line| line.len() <= 80));
    // Counted as they are written: an umlaut is two letters, and a bracket at a piece's end stays.
    let comments = [comment(&format!("{} (IN BRACKETS) {}", "Ü".repeat(59), "%".repeat(50)), true)].into();
    let program = Builder::new().finish(Some(ProgramName::Number(7)), 0, SourceInfo { comments, ..site(0) });
    let (words, signs) = ("UE".repeat(39), "PCT".repeat(26));
    let text = super::text("haas", &program);
    assert_eq!(
        text,
        format!("O0007\n({words})\n({} [IN BRACKETS])\n({signs})\n({})\n", "UE".repeat(20), "PCT".repeat(24))
    );
    let sum = (0..30).fold(v(1), |sum, at| add(sum, v(at + 2)));
    assert_eq!(refused("haas", &one([set(100, sum.clone())])), [Code::LineTooLong]);
    assert!(line("fanuc", set(100, sum)).len() > 80);
}

#[test]
fn a_program_without_a_number_is_refused() {
    for name in [ProgramName::Name("NOBODY".into()), ProgramName::Number(0), ProgramName::Number(123456)] {
        let program = Builder::new().finish(Some(name), 0, SourceInfo::default());
        assert_eq!(refused("fanuc", &program), [Code::Unmapped]);
    }
}

#[test]
fn the_line_map_names_where_each_line_comes_from() {
    let mut builder = Builder::new();
    builder.push(mv(1.0), site(1));
    builder.push(mv(2.0), SourceInfo::default());
    builder.push(mv(3.0), site(2));
    let program = builder.finish(None, 0, SourceInfo::default());
    let emitted = emit_with("fanuc", &program, &names()).unwrap();
    assert_eq!(emitted.text, "X1.\nX2.\nX3.\n");
    assert_eq!(emitted.blocks, [(Span::new(10, 19), 0..3), (Span::new(20, 29), 8..11)]);
}
