//! The rows of `corpus/*/values.tsv` that running can check. The expected values are the rows' own.

use super::*;
use crate::control::trace::Spindle;

/// `#2` after a statement, with some variables set before it.
fn after(given: &str, statement: &str) -> Option<f64> {
    value(&fanuc(&format!("O1\n{given}\n{statement}\nM30\n")), "#102")
}

fn near(found: Option<f64>, expected: f64) -> bool {
    found.is_some_and(|found| (found - expected).abs() < 1e-6)
}

#[test]
fn vacancy_is_copied_counts_as_zero_in_arithmetic_and_differs_from_zero() {
    for (statement, expected) in
        [("#102=#1", None), ("#102=[#1]", None), ("#102=#1+#1", Some(0.0)), ("#102=#1*5", Some(0.0))]
    {
        assert_eq!(after("", statement), expected, "{statement}");
    }
    for (condition, holds) in [
        ("#1 EQ 0", false),
        ("#1 NE 0", true),
        ("#1 EQ #0", true),
        ("#2 NE #0", false),
        ("#1 LT 0", false),
        ("#1 LE 0", true),
        ("#1 GT 0", false),
        ("#1 GE 0", true),
    ] {
        let found = after("", &format!("#102=5\nIF[{condition}]THEN#102=1"));
        assert_eq!(found == Some(1.0), holds, "{condition}");
    }
}

/// Speed of the spindle after a block.
fn speed(text: &str) -> f64 {
    let run = fanuc(text);
    let mut speeds = run.events.iter().filter_map(|event| match event.what {
        EventKind::Spindle { speed, direction: Spindle::Clockwise, .. } => Some(speed),
        _ => None,
    });
    speeds.next_back().expect("a spindle event")
}

#[test]
fn vacant_words_are_dropped_and_whole_number_words_rounded() {
    assert_eq!(speed("O1\nG97 M03 S800\nG97 M03 S#100\nM30\n"), 800.0);
    assert_eq!(speed("O1\nM03 S[1000.5]\nM30\n"), 1001.0);
    assert_eq!(speed("O1\n#1=1000.5\nM03 S#1\nM30\n"), 1001.0);
    assert_eq!(speed("O1\n#100=2500\nG97 M03 S#100\nM30\n"), 2500.0);
    assert!(matches!(fanuc("O1\nM03 S1001.5\nM30\n").end, End::Alarm { .. }));
}

#[test]
fn computed_words_are_rounded_to_the_least_increment() {
    let ends = |text: &str| moves(&fanuc(&format!("O1\nG21\n#1=1.2345\n#2=2.3456\n{text}\nM30\n")));
    assert_eq!(ends("G00 G91 X-#1"), [[-1.235, 0.0, 0.0]]);
    assert_eq!(ends("G91 G01 X-#2 F300"), [[-2.346, 0.0, 0.0]]);
    assert_eq!(ends("G00 G91 X[#1+#2]"), [[3.58, 0.0, 0.0]]);
    let back = ends("G00 G91 X-[ROUND[#1]+ROUND[#2]]");
    assert!((back[0][0] + 3.581).abs() < 1e-9, "{back:?}");
}

#[test]
fn codes_come_from_variables() {
    let run = fanuc("O1\nG1 X1. F10.\n#10=00\nG#10 X1.2\nM30\n");
    let rapid = run.events.iter().find_map(|event| match &event.what {
        EventKind::Rapid { to, .. } => Some(to.0[0]),
        _ => None,
    });
    assert_eq!(rapid, Some(1.2));
    let run = fanuc("O1\n#10=60\n#20=30\nIF[#10 GT #20]THEN#1=#10-#20\nM#1\n#100=1\n");
    assert_eq!((value(&run, "#1"), value(&run, "#100")), (Some(30.0), None), "M30 ended it");
}

#[test]
fn functions_give_the_manuals_values() {
    for (given, statement, expected) in [
        ("", "#102=123", 123.0),
        ("", "#102=[#_PI]", std::f64::consts::PI),
        ("", "#102=[#_E]", std::f64::consts::E),
        ("", "#102=ATAN[-1]/[-1]", 225.0),
        ("", "#102=[ATAN[1]]/10", 4.5),
        ("", "#102=ATAN[1]/[10]", 5.710593),
        ("#2=1.2345", "#102=ROUND[#2]", 1.0),
        ("#1=1.2", "#102=FUP[#1]", 2.0),
        ("#1=1.2", "#102=FIX[#1]", 1.0),
        ("#2=-1.2", "#102=FUP[#2]", -2.0),
        ("#2=-1.2", "#102=FIX[#2]", -1.0),
        ("#2=12", "#102=#2+10", 22.0),
        ("#2=12", "#102=#2-10", 2.0),
        ("#2=12", "#102=#2*10", 120.0),
        ("#2=20", "#102=#2/10", 2.0),
        ("#1=2\n#2=5", "#102=#1*[#2-3]", 4.0),
        ("", "#102=SIN[90.5]", 0.999_961_923),
        ("#2=2\n#3=3\n#4=30", "#102=#2+#3*SIN[#4]", 3.5),
        ("#2=2\n#3=10", "#102=POW[#2,#3]", 1024.0),
        ("", "#102=ASIN[-0.5]", 330.0),
        ("", "#102=ACOS[-1]", 180.0),
        ("", "#102=ATAN[-1]", -45.0),
        // MOD rounds both, and has the dividend's sign: 7.6 is 8, 2.6 is 3.
        ("#2=-7.6\n#3=2.6", "#102=#2 MOD #3", -2.0),
        ("", "#102=12 AND 10", 8.0),
        ("", "#102=12 XOR 10", 6.0),
        ("", "#102=BCD[25]", 37.0),
        ("", "#102=BIN[37]", 25.0),
    ] {
        let found = after(given, statement);
        assert!(near(found, expected), "{given} {statement}: {found:?}, not {expected}");
    }
    assert_eq!(after("", "#102=[#_EMPTY]"), None);
    let narrow = |text: &str| value(&fanuc_with("6004.0 = 1", &format!("O1\n{text}\nM30\n")), "#102");
    assert!(near(narrow("#102=ATAN[-1]/[-1]"), -135.0));
    assert!(near(narrow("#102=ASIN[-0.5]"), -30.0));
}

#[test]
fn what_cannot_be_calculated_is_an_alarm() {
    for (statement, number) in [
        ("#510=12345.6789", "TOO MANY DIGITS"),
        ("#510=0.12345678", "TOO MANY DIGITS"),
        ("#1=ASIN[1.5]", "PS0119"),
        ("#1=ACOS[-1.5]", "PS0119"),
        ("#1=EXP[1000]", "PS0119"),
        ("#100=ATAN[1]/10", "PS1131"),
        ("#1=SIN[[[[[[#2+#3]*#4]+#5]*#6]]]", "PS0118"),
        ("#1=#2/#3", "PS0112"),
        ("#1=POW[10,200]*POW[10,200]", "PS0111"),
        ("GOTO99", "PS0128"),
        ("WHILE[1 EQ 1]DO4\nEND4", "PS0126"),
        ("WHILE[#1 LT 1]DO1\nWHILE[#1 LT 1]DO2\nEND1\nEND2", "PS0124"),
        ("G67", "PS1100"),
    ] {
        let run = fanuc(&format!("O1\n{statement}\nM30\n"));
        assert_eq!(alarm(&run), number, "{statement}");
    }
    assert_eq!(value(&fanuc("O1\n#510=1234.5678\nM30\n"), "#510"), Some(1234.5678));
    // With 8 digits the limit is 10 to the 47th.
    let short = fanuc_with("6008.0 = 1", "O1\n#1=POW[10,30]*POW[10,18]\nM30\n");
    assert_eq!(alarm(&short), "PS0111");
}

#[test]
fn eight_digits_lose_what_fifteen_keep() {
    let text = "O1\n#2=98765432*100000\n#3=98765433*100000\n#101=#3-#2\n#102=1/3\nM30\n";
    let run = fanuc_with("6008.0 = 1", text);
    assert_eq!(value(&run, "#101"), Some(100_000.0));
    assert_eq!(value(&run, "#102"), Some(0.333_333_33));
}

#[test]
fn names_stand_for_variables() {
    let text = "O1\nSETVN 510[TOOL_NO, WORK_NO]\n[#WORK_NO]=7\nM30\n";
    assert_eq!(value(&fanuc(text), "#511"), Some(7.0));
}

#[test]
fn arguments_go_where_the_two_specifications_put_them() {
    let called = "O1\nG65 P1000 ARGUMENTS\nM30\nO1000\n#101=#1\n#102=#2\n#104=#4\n#105=#5\n#106=#6\n#107=#7\n#108=#8\n#110=#10\nM99\n";
    let found = |run: &Run, names: &[&str]| names.iter().map(|name| value(run, name)).collect::<Vec<_>>();
    let with = |arguments: &str| fanuc(&called.replace("ARGUMENTS", arguments));
    let run = with("I1. J2. K3.");
    assert_eq!(found(&run, &["#104", "#105", "#106"]), [Some(1.0), Some(2.0), Some(3.0)]);
    let run = with("K3. J2. I1.");
    assert_eq!(found(&run, &["#106", "#108", "#110"]), [Some(3.0), Some(2.0), Some(1.0)]);
    let run = with("A1.0 B2.0 I-3.0 I4.0 D5.0");
    let names = ["#101", "#102", "#104", "#107"];
    assert_eq!(found(&run, &names), [Some(1.0), Some(2.0), Some(-3.0), Some(5.0)]);
    let first = fanuc_with("6008.7 = 1", &called.replace("ARGUMENTS", "K3. J2. I1."));
    assert_eq!(found(&first, &["#104", "#105", "#106"]), [Some(1.0), Some(2.0), Some(3.0)]);
    // Without a point an argument counts least increments: 1500 is 1.5.
    assert_eq!(value(&with("A1500"), "#101"), Some(1.5));
}

#[test]
fn duplicate_numbers_are_found_forward_or_among_the_remembered() {
    let text = "O1\nN10 #101=#101+1\nIF[#101 GT 1]GOTO20\nGOTO10\nN10 #102=1\nN20 M30\n";
    let run = fanuc(text);
    assert_eq!((value(&run, "#101"), value(&run, "#102")), (Some(1.0), Some(1.0)));
    let run = fanuc_with("6000.1 = 1", text);
    assert_eq!((value(&run, "#101"), value(&run, "#102")), (Some(2.0), None));
}

#[test]
fn haas_reads_and_counts_as_its_class_says() {
    let set = |text: &str, name: &str| value(&haas(&format!("O1\n{text}\nM30\n")), name);
    assert_eq!(set("#100=10\n#510=3\n#101=#[#100+500]", "#101"), Some(3.0));
    assert!(near(set("#101=6/2", "#101"), 3.0));
    assert_eq!(set("#101=2+3*4", "#101"), Some(14.0));
    assert_eq!(set("#100=7.9\n#22=5.2\n#101=#100 AND #22", "#101"), Some(5.0));
    assert_eq!(set("#4=10.\n#102=[#4 GT 9.2]", "#102"), Some(1.0));
    assert_eq!(set("#1=3.54\n#102=FIX[#1]", "#102"), Some(3.0));
    assert_eq!(set("#102=SQRT[4.]", "#102"), Some(2.0));
    assert_eq!(set("G0 X1.3\n#102=#4124", "#102"), Some(1.3));
    assert_eq!(set("#100=10.4\nGOTO#100\n#102=1\nN10", "#102"), None);
    let run = haas("O1\nG65 P12 X1. T3.\nM30\nO12\n#101=#24\n#102=#20\nM99\n");
    assert_eq!((value(&run, "#101"), value(&run, "#102")), (Some(1.0), Some(3.0)));
}

#[test]
fn haas_inputs_steer_the_program() {
    let control = Control::plain("haas").expect("the table loads");
    let with = |bit: u32, value_: f64, text: &str| {
        let state = crate::control::scenario::StateValue {
            state: crate::canon::Sys::Input,
            subscripts: vec![bit],
            value: value_,
        };
        let scenario = Scenario { state: vec![state], ..Scenario::default() };
        value(&run_on(&control, &[text], &scenario), "#115")
    };
    let text = "O1\n#115=1\nIF [[#1024] OR [#1022 EQ 0]] #115=#115+1\nM30\n";
    assert_eq!(with(24, 1.0, text), Some(2.0));
    assert_eq!(with(22, 0.0, text), Some(2.0));
    assert_eq!(with(22, 1.0, text), Some(1.0));
    let text = "O1\n#115=1\n[#1000] GOTO10\n#115=2\nN10 M30\n";
    assert_eq!((with(0, 1.0, text), with(0, 0.0, text)), (Some(1.0), Some(2.0)));
    let text = "O1\n#115=1\nM96 P10 Q8\n#115=2\nN10 M30\n";
    assert_eq!((with(8, 1.0, text), with(8, 0.0, text)), (Some(2.0), Some(1.0)));
}

#[test]
fn dwells_count_seconds_with_a_point_on_haas() {
    let seconds = |run: &Run| {
        run.events.iter().find_map(|event| match event.what {
            EventKind::Dwell { seconds } => Some(seconds),
            _ => None,
        })
    };
    assert_eq!(seconds(&haas("O1\nG04 P2.\nM30\n")), Some(2.0));
    assert_eq!(seconds(&haas("O1\nG04 P2\nM30\n")), Some(0.002));
    assert_eq!(seconds(&fanuc("O1\nG04 X1.5\nM30\n")), Some(1.5));
    assert_eq!(seconds(&fanuc("O1\nG04 P1500\nM30\n")), Some(1.5));
    assert!(matches!(fanuc("O1\nG04 P1.5\nM30\n").end, End::Alarm { .. }));
}

/// Where functions alone are off in their last digit, those whose result stands in their argument are not.
#[test]
fn an_exact_function_has_no_last_digit() {
    let text = "O1\n#1=1/3\n#101=ABS[-#1]\n#102=#1*3-ABS[#1]*3\n#103=SQRT[3]\nM30\n";
    let scenario = Scenario { digits: Some(5), functions_only: true, ..Scenario::default() };
    let run = run_on(&Control::plain("fanuc").unwrap(), &[text], &scenario);
    assert_eq!(value(&run, "#101"), Some(1.0 / 3.0));
    assert_eq!(value(&run, "#102"), Some(0.0));
    assert_eq!(value(&run, "#103"), Some(1.7321));
}
