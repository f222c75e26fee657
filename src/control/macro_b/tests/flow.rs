//! Jumps, loops, calls and returns.

use super::*;

#[test]
fn an_endless_loop_is_a_result() {
    let control = Control::plain("fanuc").expect("the table loads");
    let scenario = Scenario { steps: 5000, ..Scenario::default() };
    for text in ["O1\nN1 GOTO1\n", "O1\nDO1\nEND1\n", "O1\nG4 P1\nM99\n", "O1\nM98 P1\n"] {
        let run = run_on(&control, &[text], &scenario);
        assert!(run.end == End::StepBudget || alarm(&run) == "PS0077", "{text}: {:?}", run.end);
    }
}

#[test]
fn sub_programs_share_locals_and_macros_do_not() {
    let run = fanuc(
        "O1\n#1=5\nM98 P2\n#101=#1\nG65 P3 A9.\n#102=#1\nM30\nO2\n#1=#1+1\nM99\nO3\n#103=#1\n#1=0\nM99\n",
    );
    let found = ["#101", "#102", "#103"].map(|name| value(&run, name));
    assert_eq!(found, [Some(6.0), Some(6.0), Some(9.0)]);
}

#[test]
fn repeats_run_in_all_so_often() {
    let run =
        fanuc("O1\nM98 P2 L3\nG65 P2 L2\nM98 P40003\nM30\nO2\n#101=#101+1\nM99\nO3\n#102=#102+1\nM99\n");
    assert_eq!((value(&run, "#101"), value(&run, "#102")), (Some(5.0), Some(4.0)));
    // Two sources of the trade agree on the digits before the number.
    assert!(!doubts(&run, "statement:call.repeat.digits"));
}

#[test]
fn repeated_macros_of_haas_keep_what_they_left() {
    let run = haas("O1\nG65 P2 L3 A1.\nM30\nO2\n#1=#1+1\n#101=#1\nM99\n");
    assert_eq!(value(&run, "#101"), Some(4.0));
}

#[test]
fn returns_to_a_number_go_to_the_caller_or_stay() {
    let text = "O1\nM98 P2\n#101=1\nN5 #102=1\nM30\nO2\n#103=#103+1\nIF[#103 GT 1]GOTO9\nM99 P5\nN5 #104=1\nN9 M99\n";
    let run = fanuc(text);
    let found = |run: &Run| ["#101", "#102", "#104"].map(|name| value(run, name).is_some());
    assert_eq!(found(&run), [false, true, false]);
    let run = haas(text);
    assert_eq!(found(&run), [true, true, true]);
}

/// A program that is run as if something called it.
#[test]
fn a_called_program_returns_by_m99_and_jumps_by_m99_p_where_the_control_does() {
    let text = b"O2\n#101=1\nM99P20\n#102=1\nN20#103=1\nM99\n";
    let called = Scenario { called: true, ..Scenario::default() };
    let found = |dialect: &str| {
        let run = crate::control::testing::run(dialect, &[("a.nc", text.as_slice())], &called);
        ["#101", "#102", "#103"].map(|name| value(&run, name).is_some())
    };
    assert_eq!(found("haas"), [true, false, true]);
    assert_eq!(found("fanuc"), [true, false, false]);
}

#[test]
fn local_calls_of_haas_return() {
    let run = haas("O1\nM97 P100 L2\n#102=1\nM30\nN100 #101=#101+1\nM99\n");
    assert_eq!((value(&run, "#101"), value(&run, "#102")), (Some(2.0), Some(1.0)));
}

#[test]
fn a_skipped_block_is_passed_over_where_its_switch_is_on() {
    let control = Control::plain("fanuc").expect("the table loads");
    let text = "O1\n/#101=1\n/2#102=1\nG4 P1 / M3\nM30\n";
    let with = |block_skip| run_on(&control, &[text], &Scenario { block_skip, ..Scenario::default() });
    let spindle = |run: &Run| run.events.iter().any(|event| matches!(event.what, EventKind::Spindle { .. }));
    let run = with(0);
    assert!(value(&run, "#101").is_some() && value(&run, "#102").is_some() && spindle(&run));
    let run = with(1 << 1);
    assert!(value(&run, "#101").is_none() && value(&run, "#102").is_some() && !spindle(&run));
}

#[test]
fn a_loop_whose_blocks_are_all_skipped_is_passed_over() {
    for dialect in ["fanuc", "haas"] {
        let control = Control::plain(dialect).expect("the table loads");
        let with = |text: &str, block_skip| {
            run_on(&control, &[text], &Scenario { block_skip, ..Scenario::default() })
        };
        let whole = "O1\n/WHILE[#101LT3]DO1\n/#101=#101+1\n/DO2\n/#102=#102+1\n/IF[#102GT9]GOTO5\n/END2\n/N5#102=0\n/END1\n#103=7\nM30\n";
        let run = with(whole, 0);
        assert_eq!((value(&run, "#101"), value(&run, "#103")), (Some(3.0), Some(7.0)), "{dialect}");
        let run = with(whole, 1 << 1);
        assert!(value(&run, "#101").is_none_or(|value| value == 0.0), "{dialect}");
        assert_eq!(value(&run, "#103"), Some(7.0), "{dialect}");
        // One of its ends alone is a fault while the other one is left out.
        for half in ["O1\n/DO1\n#101=1\nEND1\nM30\n", "O1\n#101=8\nWHILE[#101GT7]DO1\n#101=1\n/2END1\nM30\n"]
        {
            let run = with(half, 1 << 1 | 1 << 2);
            assert!(matches!(run.end, End::Alarm { .. }), "{dialect} {half}: {:?}", run.end);
        }
        let run = with("O1\n#101=8\n/WHILE[#101GT7]DO1\n#101=1\nEND1\nM30\n", 0);
        assert_eq!((value(&run, "#101"), run.end), (Some(1.0), End::Ended), "{dialect}");
    }
}

#[test]
fn words_before_and_after_a_block_skip_are_one_block() {
    let control = Control::plain("fanuc").expect("the table loads");
    let with = |block_skip| {
        let run = run_on(
            &control,
            &["O1\nG90\nG0 X1. / Y2.\nM30\n"],
            &Scenario { block_skip, ..Scenario::default() },
        );
        let ends = run.events.iter().filter_map(|event| match &event.what {
            EventKind::Rapid { to, .. } => Some((to.0[0], to.0[1])),
            _ => None,
        });
        ends.collect::<Vec<_>>()
    };
    assert_eq!(with(0).len(), 1);
    let (off, on) = (with(0)[0], with(1 << 1));
    assert_eq!((on.len(), on[0].0), (1, off.0));
    assert!((off.1 - on[0].1).abs() > 1.0);
}

#[test]
fn alarms_and_messages_show_their_text() {
    let run = fanuc("O1\n#3006=1(CHECK PART)\n#3000=101 (TOO SMALL)\n#101=1\n");
    assert_eq!(value(&run, "#101"), None);
    let End::Alarm { stop, .. } = &run.end else { panic!("{:?}", run.end) };
    assert_eq!(
        (stop.number.as_str(), stop.program_number, stop.text.as_str()),
        ("3101", Some(101.0), "TOO SMALL")
    );
    assert!(run.events.iter().any(|event| event.what == EventKind::Message { text: "CHECK PART".into() }));
    assert_eq!(alarm(&haas("O1\n#3000=1\n")), "1001");
}

/// The comment after the stop, none before it.
#[test]
fn a_stop_shows_its_comment() {
    let texts = |text: &str| -> Vec<EventKind> {
        let events = fanuc(text).events.into_iter().map(|event| event.what);
        events.filter(|what| matches!(what, EventKind::Message { .. } | EventKind::Stop)).collect()
    };
    let message = |text: &str| EventKind::Message { text: text.into() };
    assert_eq!(texts("O1\nN4 (LABEL) M0 (TURN THE PART)\nM30\n"), [message("TURN THE PART")]);
    assert_eq!(texts("O1\nN4 (LABEL) M0\n(NEXT)\nM30\n"), [EventKind::Stop]);
    assert_eq!(texts("O1\nG0 X1. (NO STOP)\nM30\n"), []);
    assert_eq!(texts("O1\nIF[1EQ1]THEN M0 (HERE)\nM30\n"), [message("HERE")]);
}

#[test]
fn output_to_a_closed_port_is_in_doubt() {
    let needs = "behaviour:output.needs.port";
    assert!(doubts(&fanuc("O1\nDPRNT[A]\nM30\n"), needs));
    assert!(doubts(&fanuc("O1\nPOPEN\nPCLOS\nDPRNT[A]\nM30\n"), needs));
    assert!(!doubts(&fanuc("O1\nPOPEN\nDPRNT[A]\nPCLOS\nM30\n"), needs));
}

#[test]
fn output_has_its_places() {
    let run = haas("O1\n#1=1.5\n#2=-12.3456\nDPRNT[X#1[53]*Y#2[32]Z#1[40]]\nM30\n");
    let text = run.events.iter().find_map(|event| match &event.what {
        EventKind::Output { text } => Some(text.as_str()),
        _ => None,
    });
    // Five and three places round the point are nine characters, three and two are six.
    assert_eq!(text, Some("X    1.500 Y-12.35Z   2"));
}

/// Formatting would make 12 and -0.12 of them: the even neighbours.
#[test]
fn a_half_goes_away_from_zero_in_output() {
    let run = haas("O1\n#1=12.5\n#2=-0.125\n#3=2.25\nDPRNT[N#1[40]D#2[32]E#3[32]]\nM30\n");
    let text = run.events.iter().find_map(|event| match &event.what {
        EventKind::Output { text } => Some(text.as_str()),
        _ => None,
    });
    assert_eq!(text, Some("N  13D -0.13E  2.25"));
    assert!(doubts(&run, "machine:output.half"));
    assert!(!doubts(&haas("O1\n#1=12.25\nDPRNT[N#1[40]]\nM30\n"), "machine:output.half"));
}

#[test]
fn a_word_that_picks_a_code_has_a_meaning() {
    for (block, letter) in [("G5.1 Q1", "word:Q"), ("G8 P1", "word:P"), ("G5 P10000", "word:P")] {
        assert!(!doubts(&fanuc(&format!("O1\n{block}\nM30\n")), letter), "{block}");
    }
    // Beside a code that it does not pick, nobody knows what it means.
    assert!(doubts(&fanuc("O1\nG90 Q1\nM30\n"), "word:Q"));
}

#[test]
fn a_state_that_takes_two_numbers_doubts_a_third() {
    assert!(doubts(&haas("O1\n#3003=2\nM30\n"), "machine:state.larger"));
    assert!(!doubts(&haas("O1\n#3003=1\nM30\n"), "machine:state.larger"));
    assert!(!doubts(&fanuc("O1\n#3003=3\nM30\n"), "machine:state.larger"));
}

#[test]
fn branches_tell_which_way_they_went() {
    let run = fanuc("O1\n#1=1\nIF[#1 EQ 1]GOTO5\n#1=2\nN5 WHILE[#1 LT 3]DO1\n#1=#1+1\nEND1\nM30\n");
    let ways: Vec<Vec<i64>> = run.branches.iter().map(|(_, ways)| ways.iter().copied().collect()).collect();
    assert_eq!(ways, [vec![1], vec![0, 1]]);
}

#[test]
fn state_is_read_where_the_tables_put_it() {
    let control = Control::plain("fanuc").expect("the table loads");
    let mut scenario = Scenario::default();
    scenario.work_offsets.insert(2, [100.0, 20.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    let text = "O1\nG21 G91 G55\nG90 G0 X1.5 Y2.\n#101=#4003\n#102=#5041\n#103=#5021\n#104=#5241\n#105=#4014\n#5242=7.5\n#106=#5242\nM30\n";
    let run = run_on(&control, &[text], &scenario);
    let found = ["#101", "#102", "#103", "#104", "#105", "#106"].map(|name| value(&run, name));
    assert_eq!(found, [90.0, 1.5, 101.5, 100.0, 55.0, 7.5].map(Some));
}

#[test]
fn any_bytes_run_to_some_end() {
    let scenario = Scenario { steps: 2000, ..Scenario::default() };
    let pieces = [
        "O1",
        "N1",
        "N2",
        "GOTO1",
        "GOTO#1",
        "#1=#1+1",
        "#[#1]=2",
        "IF[#1 LT 5]GOTO2",
        "WHILE[#1 LT 3]DO1",
        "END1",
        "END2",
        "DO2",
        "G65P1A1.",
        "G66P1",
        "G67",
        "M98P1",
        "M99",
        "M99P2",
        "M97P1",
        "G1X#1",
        "G2X1.I1.",
        "G2X1.R#1",
        "G81Z-1.R1.L5",
        "G83X1.Z-9.Q.001R1.",
        "G#1",
        "M#1",
        "G10L2P1X#1",
        "#5221=#1",
        "#3001=0",
        "DPRNT[#1[53]]",
        "G68X0Y0R30.",
        "G16",
        "G31X1.",
        "G28X0",
        "G53X0",
        "G52X1.",
        "G92X1.",
        "#1=SQRT[-1]",
        "#1=1/#2",
        "T#1M6",
        "%",
        "",
        "/#1=2",
        "[#1]GOTO2",
        "G54.1P#1",
        "#1=#[#1*1000000000]",
        "G4P#1",
        "#30057.21=1",
        "#1=#30057.21",
    ];
    // A fixed sequence: the state of a small generator.
    let mut seed = 0x2545_f491_u32;
    let mut draw = |below: usize| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as usize % below
    };
    for name in ["fanuc", "haas"] {
        let control = Control::plain(name).expect("the table loads");
        for _ in 0..300 {
            let text: Vec<&str> = (0..12).map(|_| pieces[draw(pieces.len())]).collect();
            let run = run_on(&control, &[&text.join("\n")], &scenario);
            assert!(run.steps <= 2001);
        }
    }
}

/// `PS0112` and `PS0119` are alarms of a computation (seed 001:1100), so a statement that is not run raises none.
#[test]
fn what_has_no_value_is_an_alarm_where_it_is_computed() {
    for (statement, number) in [
        ("THEN#2=1/0", "PS0112"),
        ("THEN#2=5MOD0", "PS0112"),
        ("GOTO[1/0]", "PS0112"),
        ("THEN#2=SQRT[-1]", "PS0119"),
        ("THEN#2=ACOS[2]", "PS0119"),
        ("THEN#2=LN[0]", "PS0119"),
    ] {
        let text = format!("O1\nIF[#101EQ1]{statement}\n#102=1\nM30\n");
        assert_eq!(value(&fanuc(&text), "#102"), Some(1.0), "{statement}");
        assert_eq!(value(&haas(&text), "#102"), Some(1.0), "{statement}");
        let run = fanuc(&text.replace("O1\n", "O1\n#101=1\n"));
        assert_eq!((alarm(&run), value(&run, "#102")), (number, None), "{statement}");
    }
}
