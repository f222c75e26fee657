use super::*;

#[test]
fn words_are_written_in_order_with_their_letters() {
    use Op::*;
    for (items, text) in [
        (
            vec![op(Linear), word(Role::X, n(1.5)), word(Role::Y, v(2)), word(Role::Feed, n(30.0))],
            "G1 X1.5 Y#2 F30.",
        ),
        (
            vec![
                op(Absolute),
                op(Rapid),
                op(SelectWork),
                word(Role::WorkOffset, n(2.0)),
                word(Role::X, n(10.0)),
            ],
            "G90 G0 G55 X10.",
        ),
        (vec![op(SelectWork), word(Role::WorkOffset, n(101.0))], "G54.1 P1"),
        (vec![op(SelectWork), word(Role::WorkOffset, add(v(1), n(100.0)))], "G54.1 P#1"),
        (vec![word(Role::X, neg(v(4)))], "X-#4"),
        (vec![word(Role::X, add(v(1), v(2)))], "X[#1+#2]"),
        (vec![word(Role::X, neg(add(v(1), v(2))))], "X-[#1+#2]"),
        (vec![word(Role::X, indirect(v(1)))], "X#[#1]"),
        (vec![word(Role::X, neg(indirect(add(v(1), n(1.0)))))], "X-#[#1+1]"),
        (vec![word(Role::X, n(-0.5))], "X-0.5"),
        (vec![word(Role::X, neg(n(5.0)))], "X-5."),
        (vec![word(Role::X, neg(n(-5.0)))], "X5."),
        (vec![word(Role::X, n(0.0))], "X0."),
        (vec![word(Role::X, Expr::Increments(10.0))], "X10"),
        (vec![word(Role::X, neg(Expr::Increments(10.0)))], "X-10"),
        (vec![word(Role::X, neg(neg(v(1))))], "X-[-#1]"),
        (vec![word(Role::X, call(Func::RoundIncrement, [v(1)]))], "X[ROUND[#1]]"),
        (vec![word(Role::X, Expr::Vacant)], "X#0"),
        (vec![op(SpindleCw), word(Role::Speed, n(1000.0))], "M3 S1000"),
        (vec![word(Role::Speed, n(1000.5))], "S[1000.5]"),
        (vec![word(Role::Speed, call(Func::Round, [v(1)]))], "S[ROUND[#1]]"),
        (vec![word(Role::Tool, n(5.0)), op(ToolChange)], "T5 M6"),
        (vec![op(Dwell), word(Role::DwellMs, n(500.0))], "G4 P500"),
        (vec![op(Dwell), word(Role::DwellS, n(1.5))], "G4 X1.5"),
        (vec![op(Dwell), word(Role::DwellS, n(2.0))], "G4 X2."),
        (vec![op(Linear), word(Role::X, n(1.0)), word(Role::CornerRadius, n(2.0))], "G1 X1. ,R2."),
        (vec![op(LengthPlus), word(Role::LengthOffset, n(1.0)), word(Role::Z, n(5.0))], "G43 H1 Z5."),
        (
            vec![
                op(ReturnR),
                op(CycleDrill),
                word(Role::Z, n(-10.0)),
                word(Role::CycleR, n(2.0)),
                word(Role::Feed, n(100.0)),
                word(Role::Repeat, n(0.0)),
            ],
            "G99 G81 Z-10. R2. F100. K0",
        ),
        (vec![word(Role::X, n(1.0)), word(Role::CycleR, n(2.0))], "X1. R2."),
        (vec![op(WriteWork), word(Role::OffsetRow, n(1.0)), word(Role::X, v(1))], "G10 L2 P1 X#1"),
        (vec![op(WriteWork), word(Role::OffsetRow, n(103.0)), word(Role::X, v(1))], "G10 L20 P3 X#1"),
        (
            vec![op(WriteWork), word(Role::OffsetRow, add(v(3), n(100.0))), word(Role::X, v(1))],
            "G10 L20 P#3 X#1",
        ),
        (vec![NcItem::Code('G', v(10)), word(Role::X, n(1.2))], "G#10 X1.2"),
        (vec![NcItem::Code('M', n(60.0))], "M60"),
    ] {
        assert_eq!(line("fanuc", nc(items)), text);
    }
}

#[test]
fn a_block_never_says_something_else() {
    use Op::*;
    for items in [
        // No such operation, no such letter.
        vec![op(Wrap)],
        vec![op(Linear), word(Role::ProbePoint, n(1.0))],
        vec![op(SelectWork), word(Role::WorkOffset, v(1))],
        vec![op(SelectWork), word(Role::WorkOffset, n(50.0))],
        // One letter for two roles.
        vec![word(Role::ArcRadius, n(1.0)), word(Role::CycleR, n(1.0))],
        vec![op(Dwell), word(Role::X, n(1.0))],
        vec![word(Role::X, n(1.0)), word(Role::X, n(2.0))],
        // ROUND in a word is another rounding.
        vec![word(Role::X, call(Func::Round, [v(1)]))],
        vec![op(Dwell), word(Role::DwellMs, n(0.5))],
        vec![word(Role::X, Expr::Increments(0.5))],
        // With a speed beside it the code is another one.
        vec![op(SetPosition), word(Role::Speed, n(1000.0))],
        vec![NcItem::Code('M', n(787.0))],
        vec![op(Return)],
    ] {
        let program = one([nc(items.clone())]);
        assert!(refused("fanuc", &program).contains(&Code::Unmapped), "{items:?}");
    }
}

#[test]
fn a_block_has_as_many_m_codes_as_the_control_takes() {
    let program = one([nc([op(Op::SpindleStop), op(Op::CoolantOff)])]);
    assert_eq!(refused("haas", &program), [Code::Unmapped]);
    assert_eq!(line("haas", nc([op(Op::SpindleStop)])), "M5");
}

#[test]
fn increments_are_written_only_where_the_control_counts_so() {
    let calculator = "dialect = \"fanuc\"\n[parameters]\n3401.0 = 1\n";
    let control = Control::from_profile(calculator);
    let Ok(control) = control else { panic!("{control:?}") };
    let program = one([nc([word(Role::X, Expr::Increments(10.0))])]);
    let faults = crate::emit::fanuc::emit(&names(), &control)(Valid::unchecked(&program)).unwrap_err();
    assert_eq!(faults[0].code, Code::Unmapped);
    // What F counts without a point no source says here.
    assert_eq!(refused("fanuc", &one([nc([word(Role::Feed, Expr::Increments(12.0))])])), [Code::Unmapped]);
    assert_eq!(line("haas", nc([word(Role::Feed, Expr::Increments(12.0))])), "F12");
}
