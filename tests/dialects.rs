//! The shipped tables and machine profiles load, and say what the manuals say.

use macroglot::canon::{Func, Op, Role, Sys};
use macroglot::dialect::{
    BareLength, Compares, Control, Mark, Operand, OperandPlace, Question, Row, matrix, page, registry,
};
use std::collections::BTreeSet;

#[test]
fn every_table_loads() {
    for entry in registry::all() {
        if let Err(faults) = entry.check() {
            panic!("{}", entry.faults_as_text(&faults));
        }
        let dialect = entry.dialect().unwrap();
        assert!(!entry.endings().is_empty());
        assert_eq!(entry.endings(), dialect.extensions, "{}", entry.name);
    }
}

#[test]
fn every_profile_loads() {
    let mut seen = 0;
    for file in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/machines")).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            if let Err(fault) = Control::load(&path) {
                panic!("{fault}");
            }
            seen += 1;
        }
    }
    assert!(seen >= 7, "{seen} profiles");
}

/// The rows of a table or a base, as they are written.
fn written(text: &str) -> Vec<toml::Table> {
    let table: toml::Table = text.parse().unwrap();
    let sections = table.values().filter_map(toml::Value::as_array).flatten();
    sections.filter_map(toml::Value::as_table).cloned().collect()
}

/// A base's rows name dialects that extend it, and each of these has a source of its own for every row.
#[test]
fn what_a_base_names_extends_it() {
    for base in &registry::BASES {
        let extends = format!("extends = \"{}\"", base.name);
        let children: Vec<&str> = registry::all()
            .iter()
            .filter(|entry| entry.table.contains(&extends))
            .map(|entry| entry.name)
            .collect();
        assert!(children.len() > 1, "{}", base.name);
        let mut named = 0;
        for row in written(base.text) {
            let sources = row.get("source").and_then(toml::Value::as_table);
            for name in sources.into_iter().flat_map(toml::Table::keys) {
                assert!(children.contains(&name.as_str()), "{}: {name}", base.file);
                named += 1;
            }
        }
        assert!(named > 200, "{named}");
        for name in children {
            let page = page(&control(name));
            assert!(!page.contains("another control"), "{name} has a row without a source of its own");
            assert!(
                page.contains(&format!("[{}: ", base.name)),
                "the page of {name} shows where its rows are from"
            );
        }
    }
}

/// The names of the sources that a common row rests on stand in the list of `dialects/README.md`; two of one author are
/// one source.
#[test]
fn the_sources_of_common_rows_are_known() {
    let readme = include_str!("../dialects/README.md");
    let author = |name: &str| match name {
        "CTRL" | "CODES" | "JSIM" => "SIM".to_owned(),
        "NCX" => "GEDIT".to_owned(),
        "CNCCI" => "MMS".to_owned(),
        name => name.to_owned(),
    };
    let mut seen = 0;
    let tables = registry::all().iter().map(|entry| entry.table);
    for row in tables.chain(registry::BASES.iter().map(|base| base.text)).flat_map(written) {
        let own = row.get("source").and_then(toml::Value::as_table).cloned().unwrap_or_default();
        for origin in own.values().filter_map(toml::Value::as_table).chain([&row]) {
            let Some(common) = origin.get("common").and_then(toml::Value::as_array) else { continue };
            let names = common.iter().filter_map(toml::Value::as_str);
            let names: BTreeSet<String> =
                names.map(|name| author(name.split(',').next().unwrap().trim())).collect();
            for name in &names {
                assert!(readme.contains(&format!("\n| `{name}` |")), "{name} is not in dialects/README.md");
            }
            assert!(names.len() > 1 || origin.contains_key("cites"), "{row}");
            seen += 1;
        }
    }
    assert!(seen > 100, "{seen}");
}

/// How sure the rows of each control are: confirmed, common, unconfirmed, and among these the questions that are answered
/// `unknown`. What rests on a question counts once, there. A row that gets surer lowers its figure here; none may rise
/// without a reason in the commit.
#[test]
fn so_many_rows_are_unconfirmed() {
    fn count<T: Row>(rows: &[T], counts: &mut [usize; 4]) {
        for row in rows.iter().filter(|row| row.origin().rests.is_none()) {
            let at = match row.origin().mark {
                Mark::Confirmed => 0,
                Mark::Common => 1,
                Mark::Unconfirmed => 2,
            };
            counts[at] += 1;
        }
    }
    let of = |name: &str| {
        let dialect = registry::find(name).unwrap().dialect().unwrap();
        let mut counts = [0; 4];
        count(&dialect.forms, &mut counts);
        count(&dialect.limits, &mut counts);
        count(&dialect.forbidden, &mut counts);
        count(&dialect.operators, &mut counts);
        count(&dialect.functions, &mut counts);
        count(&dialect.statements, &mut counts);
        count(&dialect.behaviours, &mut counts);
        count(&dialect.variables, &mut counts);
        count(&dialect.matters, &mut counts);
        count(&dialect.in_use, &mut counts);
        count(&dialect.same_cells, &mut counts);
        count(&dialect.system, &mut counts);
        count(&dialect.words, &mut counts);
        count(&dialect.codes, &mut counts);
        count(&dialect.arguments, &mut counts);
        count(&dialect.settings, &mut counts);
        count(std::slice::from_ref(&dialect.numbers), &mut counts);
        count(std::slice::from_ref(&dialect.text), &mut counts);
        counts[3] = dialect.behaviours.iter().filter(|row| row.value == "unknown").count();
        counts
    };
    let counts = ["fanuc", "haas", "fadal", "cc100"].map(of);
    assert_eq!(counts, [[409, 459, 85, 40], [624, 165, 88, 39], [284, 24, 102, 58], [252, 10, 64, 44]]);
}

fn control(name: &str) -> Control {
    Control::plain(name).unwrap()
}

fn profile(text: &str) -> Control {
    Control::from_profile(text).unwrap()
}

/// The axes by their common numbers.
const X: u32 = 1;
const Y: u32 = 2;
const Z: u32 = 3;

#[track_caller]
fn holds(control: &Control, name: &str, number: Option<u32>, state: Sys, subscripts: &[u32]) {
    let (found, at, _) = control.read_system(name, number).expect("no such variable");
    assert_eq!((found, at.as_slice()), (state, subscripts), "{name}{number:?}");
}

#[track_caller]
fn means(control: &Control, block: &str, op: Op) {
    let words = words(block);
    let (letter, number) = words[0];
    let code = control.code(letter, number.unwrap(), &words).expect("no such code");
    assert_eq!(code.op, op, "{block}");
}

fn words(block: &str) -> Vec<(char, Option<f64>)> {
    block.split(' ').map(|word| (word.chars().next().unwrap(), word[1..].parse().ok())).collect()
}

// Manual of 2017, p. 383 and 384, and the lathe's G71: 72 is an angle of a mill, and a depth of cut of a lathe.
#[test]
fn settings_of_one_number_differ_by_machine() {
    let mill = profile("dialect = \"haas\"\n[settings]\n72 = \"30\"\n73 = \"on\"");
    assert_eq!(mill.bare_angle(), Some(30.0));
    assert!(mill.is(Question::RotationAdds));
    let lathe = profile("dialect = \"haas\"\nmachine = \"lathe\"\n[settings]\n72 = \"30\"\n73 = \"0.5\"");
    assert_eq!(lathe.bare_angle(), None);
    // An angle of more than a turn is none; a Fanuc counts thousandths of a degree.
    assert_eq!(profile("dialect = \"haas\"\n[settings]\n72 = \"400\"").bare_angle(), None);
    assert_eq!(profile("dialect = \"fanuc\"\n[parameters]\n5410 = 45000").bare_angle(), Some(45.0));
}

// B-64114EN/01 p. 194 of lathes, B-63844EN/02 p. 204 of mills; Haas 96-8000 p. 168 of the older control.
#[test]
fn an_answer_may_be_for_one_machine() {
    let after = |text: &str| {
        let control = profile(text);
        let row = control.behaviour(Question::ReferenceLength).unwrap();
        (row.value.clone(), row.origin.is_confirmed())
    };
    assert_eq!(after("dialect = \"fanuc\""), ("cancelled.along".to_owned(), false));
    assert_eq!(after("dialect = \"fanuc\"\nmachine = \"lathe\""), ("kept".to_owned(), true));
    assert_eq!(after("dialect = \"haas\"\noptions = [\"rotation\"]"), ("cancelled".to_owned(), true));
    assert_eq!(after("dialect = \"haas\"\noptions = [\"ngc\"]"), ("cancelled".to_owned(), false));
    assert_eq!(after("dialect = \"haas\""), ("cancelled".to_owned(), false));
}

// Seed 001, "List of System Variables", "Position Information", "Work Offsets", "Modal Information".
#[test]
fn fanuc_system_variables_are_those_of_the_manual() {
    let mill = control("fanuc");
    holds(&mill, "#", Some(0), Sys::Empty, &[]);
    holds(&mill, "#", Some(3100), Sys::Empty, &[]);
    holds(&mill, "#", Some(3101), Sys::Pi, &[]);
    holds(&mill, "#", Some(1000), Sys::Input, &[0]);
    holds(&mill, "#", Some(1031), Sys::Input, &[31]);
    holds(&mill, "#", Some(1035), Sys::InputWord, &[3]);
    holds(&mill, "#", Some(1100), Sys::Output, &[0]);
    holds(&mill, "#", Some(1132), Sys::OutputWord, &[0]);
    holds(&mill, "#", Some(3000), Sys::Alarm, &[]);
    holds(&mill, "#", Some(3001), Sys::TimerMs, &[]);
    holds(&mill, "#", Some(3002), Sys::TimerHours, &[]);
    holds(&mill, "#", Some(3003), Sys::SingleBlock, &[]);
    holds(&mill, "#", Some(3006), Sys::StopMessage, &[]);
    holds(&mill, "#", Some(3011), Sys::Date, &[]); // 20190503
    holds(&mill, "#", Some(3012), Sys::Time, &[]);
    holds(&mill, "#", Some(3901), Sys::PartsMade, &[]);
    holds(&mill, "#", Some(4001), Sys::Modal, &[1]);
    holds(&mill, "#", Some(4014), Sys::Modal, &[14]);
    holds(&mill, "#", Some(4030), Sys::Other, &[4030]); // in the range, and its group is not named
    holds(&mill, "#", Some(4201), Sys::ModalNow, &[1]);
    holds(&mill, "#", Some(4102), Sys::Address, &[2]); // B
    holds(&mill, "#", Some(4107), Sys::Address, &[4]); // D
    holds(&mill, "#", Some(4109), Sys::Address, &[6]); // F
    holds(&mill, "#", Some(4111), Sys::Address, &[8]); // H
    holds(&mill, "#", Some(4119), Sys::Address, &[19]); // S
    holds(&mill, "#", Some(4120), Sys::Address, &[20]); // T
    holds(&mill, "#", Some(5001), Sys::EndPosition, &[X]);
    holds(&mill, "#", Some(5023), Sys::MachinePosition, &[Z]);
    holds(&mill, "#", Some(5041), Sys::WorkPosition, &[X]);
    holds(&mill, "#", Some(5063), Sys::SkipPosition, &[Z]);
    holds(&mill, "#", Some(5201), Sys::ExternalShift, &[X]);
    holds(&mill, "#", Some(5221), Sys::WorkOffset, &[1, X]); // G54
    holds(&mill, "#", Some(5242), Sys::WorkOffset, &[2, Y]); // G55
    holds(&mill, "#", Some(5323), Sys::WorkOffset, &[6, Z]); // G59
    assert!(mill.read_system("#", Some(5240)).is_none());
    assert!(mill.read_system("#", Some(100)).is_none());
    assert_eq!(
        mill.system_address(Sys::WorkOffset, &[2, Y]).map(|(name, n, _)| (name, n)),
        Some(("#", Some(5242)))
    );
    assert_eq!(mill.system_named("_EMPTY").map(|row| row.state), Some(Sys::Empty));
}

// Seed 001, "System Variable Names" and the tables after it: n is the bit or the axis of the machine.
#[test]
fn names_with_a_subscript_are_numbers() {
    let mill = control("fanuc");
    for (name, subscript, number) in [
        ("_ABSIO", 1, Some(5001)),
        ("_abskp", 5, Some(5065)),
        ("_ABSIO", 6, None),
        ("_UI", 0, Some(1000)),
        ("_UI", 31, Some(1031)),
        ("_UI", 32, None),
        ("_UOL", 3, Some(1135)),
        ("_WZCMN", 2, Some(5202)),
        ("_WZG54", 1, Some(5221)),
        ("_WZG55", 2, Some(5242)),
        ("_WZG59", 5, Some(5325)),
        ("_WZG53", 1, None),
        ("_WZG60", 1, None),
        ("_WZG", 1, None),
        ("_OFSX", 1, None),
        ("_EMPTY", 1, None),
    ] {
        assert_eq!(mill.number_named(name, subscript), number, "{name}[{subscript}]");
    }
    let lathe = profile("dialect = \"fanuc\"\nmachine = \"lathe\"\naxes = [\"X\", \"Z\", \"C\", \"Y\"]");
    for (name, subscript, number) in
        [("_ABSIO", 4, Some(5004)), ("_ABSIO", 5, None), ("_OFSZ", 64, Some(2164)), ("_WZG55", 2, Some(5242))]
    {
        assert_eq!(lathe.number_named(name, subscript), number, "{name}[{subscript}]");
    }
    holds(&mill, "#", Some(4330), Sys::AddressNow, &[16]);
    holds(&mill, "#", Some(5181), Sys::Other, &[5181]);
}

// Seed 001, "Tool Offset system example": X Z R T Y, and the axes X, Z of the seminar's machine,
// whose fourth axis is Y (O9019).
#[test]
fn a_lathe_has_its_own_offsets_and_axes() {
    let lathe = profile("dialect = \"fanuc\"\nmachine = \"lathe\"\naxes = [\"X\", \"Z\", \"C\", \"Y\"]");
    holds(&lathe, "#", Some(2001), Sys::LatheX, &[1]);
    holds(&lathe, "#", Some(2021), Sys::LatheX, &[21]); // "Wear offset of Tool 21 in X-Axis"
    holds(&lathe, "#", Some(2164), Sys::LatheZ, &[64]);
    holds(&lathe, "#", Some(2201), Sys::LatheRadius, &[1]);
    holds(&lathe, "#", Some(2301), Sys::LatheTip, &[1]);
    holds(&lathe, "#", Some(2449), Sys::LatheY, &[49]);
    holds(&lathe, "#", Some(14200), Sys::LatheY, &[200]);
    assert!(lathe.read_system("#", Some(2450)).is_none());
    holds(&lathe, "#", Some(5002), Sys::EndPosition, &[Z]);
    holds(&lathe, "#", Some(5004), Sys::EndPosition, &[Y]);
    holds(&lathe, "#", Some(5024), Sys::MachinePosition, &[Y]);
    holds(&lathe, "#", Some(5222), Sys::WorkOffset, &[1, Z]);
    means(&lathe, "G99", Op::FeedPerTurn);
    means(&lathe, "G50 S5000", Op::LimitSpeed);
    means(&lathe, "G50 X100 Z200", Op::SetPosition);
    assert_eq!(lathe.role('U', false, None), Some(Role::StepX));
    let dwell = lathe.code('G', 4.0, &[]);
    assert_eq!(lathe.role('U', false, dwell), Some(Role::DwellS));
    // Without its axes only X and Z are known.
    let bare = profile("dialect = \"fanuc\"\nmachine = \"lathe\"");
    holds(&bare, "#", Some(5002), Sys::EndPosition, &[Z]);
    assert!(bare.read_system("#", Some(5003)).is_none());
}

#[test]
fn fanuc_codes_are_those_of_the_manual() {
    let mill = control("fanuc");
    for (block, op) in [
        ("G0", Op::Rapid),
        ("G2", Op::ArcCw),
        ("G4 P500", Op::Dwell),
        ("G20", Op::Inch),
        ("G28", Op::ReferenceReturn),
        ("G31", Op::Probe),
        ("G54", Op::SelectWork),
        ("G58", Op::SelectWork),
        ("G65 P9010", Op::CallMacro),
        ("G66 P9110", Op::CallModal),
        ("G67", Op::CallModalOff),
        ("G81", Op::CycleDrill),
        ("G99", Op::ReturnR),
        ("M98 P8099", Op::CallProgram),
        ("M99", Op::Return),
        ("M30", Op::EndRewind),
    ] {
        means(&mill, block, op);
    }
    // What only the control has is named, and never carried across (facts/fanuc-mill.md 2).
    for block in ["G2.2", "G6.2", "G34", "G39", "G43.4 H1", "G54.2 P1", "G68.2 X0"] {
        means(&mill, block, Op::MachineSpecific);
    }
    let g58 = mill.code('G', 58.0, &[]).unwrap();
    assert_eq!(g58.fixed.get(&Role::WorkOffset), Some(&5.0));
    // The P of M98 is no work offset.
    assert_eq!(mill.code('G', 54.0, &words("G54 M98 P8099")).unwrap().code, "G54");
    assert_eq!(mill.code('G', 54.0, &words("G54 P3")).unwrap().code, "G54 P");
    assert!(mill.code('G', 383.0, &[]).is_none());
    assert_eq!(mill.argument_local('D'), Some(7));
    assert_eq!(mill.argument_local('Z'), Some(26));
    assert_eq!(mill.argument_letter(17), Some('Q'));
    assert_eq!(mill.argument_local('P'), None);
    assert_eq!(mill.limit("brackets"), Some(5));
    assert_eq!(mill.limit("do.depth"), Some(3));
    assert_eq!(mill.limit("call.macro"), Some(5));
    assert_eq!(mill.limit("call.all"), Some(15));
    assert_eq!(mill.variable_class("#", 33).unwrap().class, "local");
    assert_eq!(mill.variable_class("#", 100).unwrap().retained, Some(false));
    assert_eq!(mill.variable_class("#", 500).unwrap().retained, Some(true));
    assert!(mill.variable_class("#", 34).is_none());
    assert_eq!(mill.function(Func::Atan, 2).unwrap().form.as_deref(), Some("slash"));
    assert_eq!(mill.function_named("sqr").unwrap().function, Func::Sqrt);
    assert!(!mill.is(Question::VacantEqZero));
    assert!(mill.is(Question::ModRoundsOperands));
    assert!(mill.operator("modulo").unwrap().rank > mill.operator("add").unwrap().rank);
}

// Seed 001: parameters 6050-6059, 6080-6089, 6071-6079, and those of its examples.
#[test]
fn the_0i_profile_calls_the_seminars_programs() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/machines/fanuc-0i.toml")).unwrap();
    let control = profile(&text);
    let call = |letter, number| control.alias(letter, number).map(|a| (a.program, a.arguments, a.modal));
    assert_eq!(call('G', 383.0), Some((9018, true, false)));
    assert_eq!(call('G', 183.0), Some((9019, true, false)));
    assert_eq!(call('M', 910.0), Some((9020, true, false)));
    assert_eq!(call('M', 201.0), Some((9001, false, false)));
    assert_eq!(call('M', 203.0), Some((9003, false, false)));
    assert_eq!(call('M', 2900.0), Some((9005, false, false)));
    assert_eq!(call('M', 990.0), None);
    assert_eq!(call('G', 0.0), None);
    assert_eq!(control.bare_length(), BareLength::Units);
    assert!(control.is_reserved("#", 549) && !control.is_reserved("#", 550));
    assert_eq!(control.site_code('M', 290.0).unwrap().text, "chip conveyor on");
    let modal = profile("dialect = \"fanuc\"\n[parameters]\n6050 = -81");
    assert!(modal.alias('G', 81.0).unwrap().modal);
}

#[test]
fn parameters_change_behaviours() {
    let nat = |value: u8| profile(&format!("dialect = \"fanuc\"\n[parameters]\n6004.0 = {value}"));
    assert_eq!(nat(0).behaviour(Question::Atan2Range).unwrap().value, "0..360");
    assert_eq!(nat(1).behaviour(Question::Atan2Range).unwrap().value, "-180..180");
    assert_eq!(nat(1).behaviour(Question::AsinRange).unwrap().value, "-90..90");
    assert!(!profile("dialect = \"fanuc\"\n[parameters]\n6008.7 = 1").is(Question::ArgumentsOrderIjk));
    assert!(!profile("dialect = \"fanuc\"\n[parameters]\n6000.4 = 1").is(Question::GotoForwardFirst));
    assert_eq!(profile("dialect = \"fanuc\"\n[parameters]\n6008.0 = 1").numbers().arithmetic, "decimal8");
    let floats = profile("dialect = \"haas\"\n[settings]\n162 = 1");
    assert_eq!((floats.bare_length(), floats.bare_feed()), (BareLength::Units, BareLength::Increments));
    let by = |settings: &str, question| {
        let control = profile(&format!("dialect = \"haas\"\n[settings]\n{settings}"));
        let row = control.behaviour(question).unwrap();
        (row.value.clone(), row.origin.is_confirmed())
    };
    let shift = Question::EndClearsLocal;
    assert_eq!(by("33 = \"haas\"", shift), ("false".into(), true));
    assert_eq!(by("33 = \"fanuc\"", shift), ("true".into(), true));
    assert_eq!(by("", shift), ("true".into(), false));
    let bare = Question::CycleRunsWithoutAxes;
    assert_eq!(by("28 = \"off\"", bare), ("false".into(), true));
    assert_eq!(by("28 = \"on\"", bare), ("true".into(), true));
    assert_eq!(by("", bare), ("true".into(), false));
}

#[test]
fn profiles_state_options_variables_and_facts() {
    let basic = profile("dialect = \"fanuc\"\noptions = []");
    assert!(basic.variable_class("#", 149).is_some() && basic.variable_class("#", 150).is_none());
    assert!(basic.function(Func::Pow, 2).is_none());
    assert_eq!(basic.has_option("pow"), Some(false));
    assert_eq!(control("fanuc").has_option("pow"), None);
    let misspelled =
        Control::from_profile("dialect = \"haas\"\noptions = [\"macros\", \"rotaton\"]").unwrap_err();
    assert!(misspelled[0].message.contains("no row of") && misspelled[0].message.contains("'rotaton'"));
    assert!(misspelled[0].help.as_ref().unwrap().contains("macros, ngc, rotation, skip"));
    let few = profile("dialect = \"fanuc\"\nvariables = [\"#100-#120\"]");
    assert!(few.variable_class("#", 120).is_some() && few.variable_class("#", 121).is_none());
    let fact = "behaviour:m99.p.jumps.here";
    assert!(!control("fanuc").behaviour(Question::M99PJumpsHere).unwrap().origin.is_confirmed());
    let sure = profile(&format!("dialect = \"fanuc\"\nconfirm = [\"{fact}\"]"));
    assert!(sure.behaviour(Question::M99PJumpsHere).unwrap().origin.is_confirmed());
    let site =
        profile("dialect = \"cc100\"\n[[site]]\ncode = \"M20\"\nop = \"spindle.cw\"\ntext = \"drill on\"");
    means(&site, "M20", Op::SpindleCw);
}

#[test]
fn what_rests_on_an_unstated_setting_is_unconfirmed() {
    let plain = control("fanuc");
    let range = plain.behaviour(Question::Atan2Range).unwrap();
    assert!(!range.origin.is_confirmed() && range.origin.note.as_ref().unwrap().contains("parameter.6004.0"));
    let stated = profile("dialect = \"fanuc\"\n[parameters]\n6004.0 = 0");
    assert!(stated.behaviour(Question::Atan2Range).unwrap().origin.is_confirmed());
    assert!(
        !stated.is(Question::GotoForwardFirst)
            || !stated.behaviour(Question::GotoForwardFirst).unwrap().origin.is_confirmed()
    );
    let haas = |text: &str| profile(text).code('G', 52.0, &[]).unwrap().origin.is_confirmed();
    assert!(!haas("dialect = \"haas\""));
    assert!(haas("dialect = \"haas\"\n[settings]\n33 = \"fanuc\""));
}

#[test]
fn a_machine_has_so_many_offsets() {
    let fanuc = profile("dialect = \"fanuc\"\nwork_offsets = 48\noffsets = 99");
    let g541 = fanuc.code_for(Op::SelectWork, &[(Role::WorkOffset, 148.0)].into());
    assert_eq!(g541.map(|row| row.code.as_str()), Some("G54.1 P"));
    assert!(fanuc.code_for(Op::SelectWork, &[(Role::WorkOffset, 149.0)].into()).is_none());
    assert!(fanuc.system_address(Sys::WorkOffset, &[149, X]).is_none());
    assert!(fanuc.system_address(Sys::LengthGeometry, &[99]).is_some());
    assert!(fanuc.system_address(Sys::LengthGeometry, &[100]).is_none());
    let none = profile("dialect = \"haas\"\nwork_offsets = 0");
    assert!(none.code('G', 110.0, &[]).is_none() && none.code('G', 154.0, &words("G154 P1")).is_none());
    assert!(none.code('G', 59.0, &[]).is_some());
    let fadal = profile("dialect = \"fadal\"\nwork_offsets = 18");
    assert_eq!(fadal.written(None, Role::WorkOffset, 118.0), Some(24.0));
    assert_eq!(fadal.written(None, Role::WorkOffset, 119.0), None);
}

// Seed 002, appendices A, B and D.
#[test]
fn haas_tables_are_those_of_the_class() {
    let haas = control("haas");
    for (block, op) in [
        ("G12", Op::PocketCw),
        ("G53", Op::MachineOnce),
        ("G52", Op::LocalShift),
        ("G77", Op::CycleBackBore),
        ("G87", Op::CycleBoreManual),
        ("G88", Op::CycleBoreManual),
        ("G93", Op::FeedInverse),
        ("G100", Op::MirrorOff),
        ("G101", Op::MirrorOn),
        ("G103 P1", Op::LimitLookahead),
        ("G110", Op::SelectWork),
        ("G129", Op::SelectWork),
        ("G154 P1", Op::SelectWork),
        ("M16", Op::ToolChange),
        ("M28", Op::Builder),
        ("M10", Op::FourthBrakeOn),
        ("M11", Op::FourthBrakeOff),
        ("M12", Op::FifthBrakeOn),
        ("M13", Op::FifthBrakeOff),
        ("M88", Op::ThroughSpindle),
        ("M96 P10 Q8", Op::JumpInputOff),
        ("M97 P100", Op::CallLocal),
    ] {
        means(&haas, block, op);
    }
    let fixed = |number: f64| haas.code('G', number, &[]).unwrap().fixed.get(&Role::WorkOffset).copied();
    assert_eq!((fixed(110.0), fixed(129.0)), (Some(101.0), Some(120.0)));
    holds(&haas, "#", Some(1063), Sys::Input, &[63]);
    holds(&haas, "#", Some(1155), Sys::Output, &[55]);
    holds(&haas, "#", Some(11101), Sys::Input, &[101]);
    holds(&haas, "#", Some(12003), Sys::Output, &[3]);
    holds(&haas, "#", Some(2001), Sys::LengthGeometry, &[1]);
    holds(&haas, "#", Some(2201), Sys::LengthWear, &[1]);
    holds(&haas, "#", Some(2401), Sys::DiameterOrRadius, &[1]);
    holds(&haas, "#", Some(3026), Sys::ActiveTool, &[]);
    holds(&haas, "#", Some(3027), Sys::SpindleActual, &[]);
    holds(&haas, "#", Some(4000), Sys::Other, &[4000]);
    holds(&haas, "#", Some(4012), Sys::Modal, &[14]);
    holds(&haas, "#", Some(4124), Sys::Address, &[24]); // "the statement X1.3 sets variable #4124"
    holds(&haas, "#", Some(5401), Sys::ToolTable, &[1, 1]);
    holds(&haas, "#", Some(6001), Sys::Setting, &[1]);
    holds(&haas, "#", Some(6198), Sys::Other, &[6198]); // 1000000 on the newer control
    holds(&haas, "#", Some(6199), Sys::Setting, &[199]);
    holds(&haas, "#", Some(20033), Sys::Setting, &[33]);
    holds(&haas, "#", Some(6999), Sys::Parameter, &[499]);
    holds(&haas, "#", Some(7001), Sys::WorkOffset, &[101, X]); // G110
    holds(&haas, "#", Some(7382), Sys::WorkOffset, &[120, Y]); // G129
    holds(&haas, "#", Some(14001), Sys::WorkOffset, &[101, X]); // G154 P1
    holds(&haas, "#", Some(15966), Sys::WorkOffset, &[199, 6]); // G154 P99
    assert_eq!(haas.variable_class("#", 100).unwrap().retained, Some(true));
    assert!(haas.variable_class("#", 700).is_none());
    assert!(
        haas.is(Question::M99PJumpsHere)
            && haas.is(Question::ComparisonIsValue)
            && haas.is(Question::ThenWords)
    );
    assert_eq!(haas.behaviour(Question::MCodesPerBlock).unwrap().value, "1");
    let alias = profile("dialect = \"haas\"\n[parameters]\n82 = 50\n91 = 200");
    assert_eq!(alias.alias('M', 50.0).map(|a| (a.program, a.arguments)), Some((9001, false)));
    assert_eq!(alias.alias('G', 200.0).map(|a| (a.program, a.arguments)), Some((9010, true)));
}

// Seed 000, sections "Variables", "I, G, O, HO, TL, VF", and its programs.
#[test]
fn fadal_tables_are_those_of_the_manual() {
    let fadal = control("fadal");
    holds(&fadal, "AX", None, Sys::AxisPosition, &[X]);
    holds(&fadal, "FX", Some(1), Sys::WorkOffset, &[1, X]);
    holds(&fadal, "FZ", Some(23), Sys::WorkOffset, &[117, Z]);
    holds(&fadal, "FY", Some(48), Sys::WorkOffset, &[142, Y]);
    assert!(fadal.read_system("FX", Some(49)).is_none());
    holds(&fadal, "PY", Some(1), Sys::ProbePoint, &[Y, 1]);
    holds(&fadal, "H", Some(99), Sys::LengthGeometry, &[99]);
    holds(&fadal, "D", Some(5), Sys::DiameterOrRadius, &[5]);
    holds(&fadal, "TN", None, Sys::ActiveTool, &[]);
    holds(&fadal, "TU", Some(3), Sys::ToolTimeUsed, &[3]);
    holds(&fadal, "I", Some(29), Sys::InputInverted, &[29]);
    holds(&fadal, "O", Some(3), Sys::OutputInverted, &[3]);
    holds(&fadal, "G", Some(1), Sys::ModalMotionPlus1, &[]);
    holds(&fadal, "G", Some(7), Sys::CyclePlane, &[]);
    // The list of the 88HS: G17.1 lets the words A and B change places, and is no plane.
    means(&fadal, "G17.1", Op::MachineSpecific);
    means(&fadal, "G17.2", Op::MachineSpecific);
    means(&fadal, "G44 H2", Op::LengthMinus);
    holds(&fadal, "HO", Some(6), Sys::HomeOffset, &[9]); // W
    holds(&fadal, "HO", Some(7), Sys::HomeOffset, &[4]); // A
    for (block, op) in [
        ("G17 Q1", Op::Wrap),
        ("G17", Op::PlaneXy),
        ("G8", Op::RampsOff),
        ("G20", Op::CheckInch),
        ("G21", Op::CheckMetric),
        ("G50.1", Op::MirrorOff),
        ("G51.1", Op::MirrorOn),
        ("G51", Op::MachineSpecific),
        ("G68", Op::RotateOn),
        ("G10 L2 P1", Op::WriteWork),
        ("G10 L10 P1", Op::WriteLength),
        ("G84", Op::CycleTapByLead),
        ("M2", Op::End),
        ("M17", Op::SubEnd),
        ("M30", Op::SubAreaEnd),
        ("M45", Op::CycleHere),
        ("M60", Op::FourthBrakeOn),
        ("M61", Op::FourthBrakeOff),
        ("M62", Op::FifthBrakeOn),
        ("M63", Op::FifthBrakeOff),
        ("M64", Op::ProbeOn),
        ("M65", Op::ToolProbeOn),
    ] {
        means(&fadal, block, op);
    }
    // The Q of G83 does not wrap an axis.
    means(&fadal, "G17 G83 Q1", Op::PlaneXy);
    let drill = fadal.code('G', 81.0, &[]);
    assert_eq!(fadal.parametric(Role::CycleR, drill), Some(('R', 0)));
    assert_eq!(fadal.parametric_role('R', 0, fadal.code('G', 2.0, &[])), Some(Role::ArcRadius));
    assert_eq!(fadal.word('E', false).unwrap().op, Some(Op::SelectWork));
    assert_eq!(fadal.word('H', false).unwrap().op, Some(Op::LengthPlus));
    assert_eq!(fadal.canonical(None, Role::WorkOffset, 24.0), 118.0);
    assert_eq!(fadal.written(None, Role::WorkOffset, 118.0), Some(24.0));
    assert_eq!(fadal.written(None, Role::WorkOffset, 143.0), None);
    assert_eq!(fadal.text().macro_line, Some(63));
    assert_eq!(fadal.limit("round.places"), Some(5));
    assert_eq!(fadal.function_named("INT").unwrap().function, Func::Fix);
    assert_eq!(fadal.function_named("SGN").unwrap().function, Func::Sign);
    assert!(fadal.function(Func::Tan, 1).is_none());
    assert_eq!(fadal.variable_class("R", 9).unwrap().class, "parametric");
    assert_eq!(fadal.code_for(Op::EndRewind, &Default::default()).unwrap().code, "M2");
    let two = profile("dialect = \"fadal\"\n[settings]\nformat = 2");
    means(&two, "G84", Op::CycleTap);
    means(&two, "G43", Op::LengthPlus);
    assert!(fadal.code('G', 43.0, &[]).is_none());
}

// Seed 004, appendix 4 and the programs.
#[test]
fn cc100_tables_are_those_of_the_course() {
    let cc = control("cc100");
    for (block, op) in [
        ("G20", Op::Pole),
        ("G22 P1", Op::CallLocal),
        ("G24 P2", Op::Jump),
        ("G53", Op::ShiftCancel),
        ("G59", Op::SelectWork),
        ("G99", Op::Return),
        ("G820", Op::CallCycle),
        ("G823", Op::CallCycle),
        ("M2", Op::Return),
        ("M30", Op::EndRewind),
        ("M68", Op::Builder),
    ] {
        means(&cc, block, op);
    }
    assert_eq!(cc.role('A', false, None), Some(Role::PolarAngle));
    assert_eq!(cc.role('D', false, None), Some(Role::PolarDistance));
    assert_eq!(cc.role('T', false, cc.code('G', 42.0, &[])), Some(Role::RadiusOffset));
    assert_eq!(cc.word('T', false).unwrap().op, Some(Op::ToolChange));
    assert_eq!(cc.letter_class("V", 'Z').unwrap().class, "letter");
    assert_eq!(cc.variable_class("V", 99).unwrap().class, "common");
    assert!(cc.variable_class("V", 100).is_none());
    assert!(cc.is(Question::ConditionRegister));
    assert_eq!(cc.behaviour(Question::AngleLimit).unwrap().value, "360");
    assert_eq!(cc.behaviour(Question::ArcRadiusNegative).unwrap().value, "short");
    assert_eq!(cc.behaviour(Question::RepeatCounts).unwrap().value, "extra");
    assert_eq!(cc.limit("operators"), Some(1));
    holds(&cc, "COR R", Some(10), Sys::RadiusGeometry, &[10]);
    holds(&cc, "TRF=G54 X", None, Sys::WorkOffset, &[1, X]);
    holds(&cc, "TIM", None, Sys::CycleSeconds, &[]);
    assert_eq!(cc.code_for(Op::End, &Default::default()).unwrap().code, "M30");
}

#[test]
fn the_target_side_picks_what_can_be_written() {
    let code = |control: &Control, op, operands: &[(Role, f64)]| {
        control.code_for(op, &operands.iter().copied().collect()).map(|row| row.code.clone())
    };
    let (fanuc, haas, fadal) = (control("fanuc"), control("haas"), control("fadal"));
    assert_eq!(code(&fanuc, Op::SelectWork, &[(Role::WorkOffset, 2.0)]).as_deref(), Some("G55"));
    assert_eq!(code(&fanuc, Op::SelectWork, &[(Role::WorkOffset, 103.0)]).as_deref(), Some("G54.1 P"));
    assert_eq!(code(&haas, Op::SelectWork, &[(Role::WorkOffset, 103.0)]).as_deref(), Some("G112"));
    assert_eq!(code(&haas, Op::SelectWork, &[(Role::WorkOffset, 150.0)]).as_deref(), Some("G154 P"));
    assert_eq!(code(&haas, Op::SelectWork, &[(Role::WorkOffset, 250.0)]), None);
    assert_eq!(code(&fadal, Op::SelectWork, &[(Role::WorkOffset, 2.0)]), None);
    assert!(fadal.word_for(Op::SelectWork).is_some_and(|word| word.letter == "E"));
    assert_eq!(code(&haas, Op::WriteWork, &[(Role::OffsetRow, 101.0)]).as_deref(), Some("G10 L20"));
    assert_eq!(code(&haas, Op::WriteWork, &[(Role::OffsetRow, 1.0)]).as_deref(), Some("G10 L2"));
    assert_eq!(code(&haas, Op::ToolChange, &[]).as_deref(), Some("M6"));
    assert_eq!(code(&control("cc100"), Op::RotateOn, &[]), None);
    let g541 = fanuc.code_for(Op::SelectWork, &[(Role::WorkOffset, 103.0)].into());
    assert_eq!(fanuc.written(g541, Role::WorkOffset, 103.0), Some(3.0));
    let drill = fanuc.code('G', 81.0, &[]);
    assert_eq!(fanuc.letter(Role::CycleR, drill), Some(('R', false)));
    assert_eq!(fanuc.letter(Role::Repeat, drill), Some(('K', false)));
    // R is the retract plane there, so it cannot be a radius.
    assert_eq!(fanuc.letter(Role::ArcRadius, drill), None);
    assert_eq!(fanuc.letter(Role::ArcRadius, None), Some(('R', false)));
}

#[test]
fn every_system_variable_has_one_way_back() {
    for entry in registry::all() {
        let control = control(entry.name);
        for row in &control.dialect().system {
            let Some(first) = row.first else { continue };
            for number in first..=row.last().unwrap() {
                if let Some(subscripts) = row.subscripts_of(number) {
                    assert_eq!(row.number_of(&subscripts), Some(Some(number)), "{}{number}", row.name);
                }
            }
        }
    }
}

#[test]
fn the_matrix_and_the_pages_show_every_row() {
    let matrix = matrix();
    assert!(matrix.lines().any(|line| line.starts_with("cycle.drill ") && line.contains("G81")));
    assert!(matrix.lines().any(|line| line.starts_with("atan2.range ") && line.contains("0..360")));
    for entry in registry::all() {
        let control = control(entry.name);
        let page = page(&control);
        for code in &control.dialect().codes {
            assert!(page.contains(&code.code) && page.contains(&code.origin.source), "{}", code.code);
        }
    }
}

/// One value a tool is written under L11, and L1 says the same (B-63124EN p. 236); of the other memory L10 is the length's
/// geometry. Which of #2001 and #2201 is the geometry hangs on parameter 6000.3 (fanuc-mill.md 7).
#[test]
fn the_kind_of_offset_memory_says_what_its_numbers_are() {
    let memory = |kind: &str, v15: u32| {
        profile(&format!(
            "dialect = \"fanuc\"\n[settings]\noffset_memory = \"{kind}\"\n[parameters]\n\"6000.3\" = {v15}\n"
        ))
    };
    let shared = memory("A", 0);
    means(&shared, "G10 L11 P1", Op::WriteOffset);
    means(&shared, "G10 L1 P1", Op::WriteOffset);
    means(&memory("C", 0), "G10 L10 P1", Op::WriteLength);
    // Mitsubishi M700V/M70V programming manual, p. 236, memory II.
    for (code, op) in [
        ("G10 L10 P1", Op::WriteLength),
        ("G10 L11 P1", Op::WriteLengthWear),
        ("G10 L12 P1", Op::WriteRadius),
        ("G10 L13 P1", Op::WriteRadiusWear),
    ] {
        means(&memory("M", 0), code, op);
    }
    let states = |control: &Control| {
        [2001, 2201, 2401, 2601]
            .map(|number| control.read_system("#", Some(number)).map(|(state, ..)| state.name()))
    };
    assert_eq!(states(&shared), [Some("offset.shared"), None, None, None]);
    assert_eq!(states(&memory("B", 0)), [None; 4]);
    assert_eq!(states(&memory("C", 0)), [Some("offset.length.wear"), Some("offset.length"), None, None]);
    let fifteen = [
        "offset.length",
        "offset.length.wear",
        "offset.diameter.or.radius",
        "offset.diameter.or.radius.wear",
    ];
    assert_eq!(states(&memory("C", 1)), fifteen.map(Some));
}

/// Whether a control takes an expression, a variable, a constant in a place.
fn takes(control: &Control, place: OperandPlace) -> [bool; 3] {
    let form = control.form(place);
    [Operand::Expression, Operand::Variable, Operand::Literal]
        .map(|operand| form.is_some_and(|form| form.takes(operand)))
}

/// Fadal section 18: "Machine program code cannot be coded in a macro line"; words take R alone (seed 000:19, 99). Seed
/// 004:190 and 245: one step an assignment, no constant beside a variable; 1635: the second operand may be a constant.
#[test]
fn places_take_what_the_manuals_say() {
    use OperandPlace::{Assignment, Condition, First, Function, Jump, Loop, Output, Second, State, Word};
    for name in ["fanuc", "haas"] {
        let control = control(name);
        for place in [Word, Assignment, First, Second, Function, State, Condition, Loop] {
            assert_eq!(takes(&control, place), [true; 3], "{name} {place:?}");
        }
        assert_eq!(takes(&control, Output), [false, true, false]);
        assert_eq!((control.numbered(), control.names().program.as_deref()), (Some("#"), Some("O")));
    }
    let fadal = control("fadal");
    assert_eq!(takes(&fadal, Word), [false, true, true]);
    assert_eq!(fadal.form(Word).unwrap().class.as_deref(), Some("parametric"));
    assert_eq!(takes(&fadal, Assignment), [true; 3]);
    assert!(fadal.form(Loop).is_none() && fadal.numbered().is_none());
    // 63 characters, of which nine are kept for "/1N99999 ", and six are "#V100=".
    assert_eq!(fadal.room(Assignment), 54);
    assert_eq!(fadal.form(Assignment).unwrap().beside(), 6);
    // Posts cut at 80 (facts/fadal-target.md 1).
    assert_eq!(fadal.room(Word), 71);
    let cc100 = control("cc100");
    assert_eq!((takes(&cc100, First), takes(&cc100, Second)), ([false, true, false], [false, true, true]));
    assert_eq!((takes(&cc100, Function), takes(&cc100, State)), ([false, true, false], [false, true, false]));
    assert!(!cc100.form(Word).unwrap().mixed);
    assert_eq!(cc100.form(Condition).unwrap().compares, Compares::Zero);
    assert_eq!(takes(&cc100, Jump), [false, true, true]);
    assert_eq!((cc100.limit("operators"), cc100.names().program.as_deref()), (Some(1), None));
}

/// Fixture offsets E0 to E48 of the Fadal (manual of 2003, p. 231): from 7 on they are additional ones.
#[test]
fn a_word_says_which_common_numbers_it_has() {
    let fadal = control("fadal");
    assert_eq!(fadal.numbers_of(None, Role::WorkOffset).as_deref(), Some("0 to 6 and 101 to 142"));
    assert_eq!(fadal.numbers_of(None, Role::Feed), None);
}
