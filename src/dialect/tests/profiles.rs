//! Machine profiles, and the answers that they state.

use super::{faults, refused};
use crate::canon::Op;
use crate::dialect::{Control, Profile, Question, Side, Units, faults_as_text, registry};
use crate::text::Span;

/// The profile is refused, and the fault says so.
fn wrong(text: &str, expected: &str) {
    let faults = Control::from_profile(text).map(|_| ()).unwrap_err();
    let faults = faults_as_text("p.toml", text, &faults);
    assert!(faults.contains(expected), "expected '{expected}' in:\n{faults}");
}

#[test]
fn profiles_say_what_is_wrong_and_where() {
    wrong("dialect = \"fanuk\"", "p.toml:1:11: MG0203: no dialect is named 'fanuk'");
    wrong("title = \"x\"", "the profile does not say its dialect");
    wrong(
        "dialect = \"fanuc\"\nmachin = \"mill\"",
        "p.toml:2:1: MG0203: unknown key 'machin' (did you mean 'machine'?)",
    );
    wrong("dialect = \"fanuc\"\nmachine = \"router\"", "p.toml:2:11");
    let lathe = "dialect = \"fadal\"\nmachine = \"lathe\"";
    wrong(lathe, "p.toml:2:11: MG0203: the table of Fadal has no rows for a lathe");
    wrong(
        "dialect = \"fanuc\"\n[parameters]\n6004.1 = 1",
        "p.toml:3:6: MG0203: Fanuc Custom Macro B has no setting 'parameter.6004.1'",
    );
    wrong("dialect = \"fanuc\"\n[parameters]\n6004.0 = 2", "'2' is not a value of parameter.6004.0");
    wrong("dialect = \"fanuc\"\nreserved = [\"500\"]", "p.toml:2:13: MG0203: '500' is not a variable");
    wrong("dialect = \"fanuc\"\nconfirm = [\"behaviour:vacancyy\"]", "did you mean 'behaviour:vacancy'?");
    wrong("dialect = \"fanuc\"\nconfirm = [\"code:G5O\"]", "no fact is named 'code:G5O'");
    wrong("dialect = \"fanuc\"\naxes = [\"X\", \"X\"]", "an axis stands twice");
    wrong("dialect = \"fanuc\"\n[[site]]\ncode = \"20\"\ntext = \"x\"", "'20' is not a code");
    wrong(
        "dialect = \"fanuc\"\n[[site]]\ncode = \"M20\"\nop = \"jump\"\ntext = \"x\"",
        "'M20' cannot mean 'jump'",
    );
    wrong(
        "dialect = \"cc100\"\n[[site]]\ncode = \"M20\"\nop = \"output.on\"\ntext = \"x\"",
        "p.toml:2:1: MG0203: 'M20' does not say which output it switches",
    );
    let other = Profile::read("dialect = \"haas\"").unwrap();
    let fanuc = registry::find("fanuc").unwrap();
    assert!(Control::new(fanuc, other).is_err());
}

/// What no machine can be is a slip that would be taken in silence.
#[test]
fn profiles_that_say_nonsense_are_wrong() {
    let fadal = |line: &str, expected: &str| wrong(&format!("dialect = \"fadal\"\n{line}"), expected);
    fadal(
        "confirm = [\"code:G999\"]",
        "p.toml:2:12: MG0203: Fadal has no code G999 (leave it out, or say under",
    );
    fadal(
        "reserved = [\"V1\", \"#100\"]",
        "p.toml:2:19: MG0203: Fadal has no variables #100 (name variables",
    );
    fadal("reserved = [\"V200-V300\"]", "p.toml:2:13: MG0203: Fadal has no variables V200-V300");
    fadal(
        "variables = [\"V1-V500\"]",
        "p.toml:2:14: MG0203: Fadal does not have all of the variables V1-V500",
    );
    fadal("axes = []", "p.toml:2:8: MG0203: 'axes = []' says that the machine has none");
    fadal("variables = []", "'variables = []' says that the machine has none");
    fadal("offsets = 0", "p.toml:2:11: MG0203: 'offsets = 0' says that the machine has none");
    fadal("[limits]\ncall.all = 0", "p.toml:3:6: MG0203: call.all = 0 leaves nothing");
    for fine in [
        "variables = [\"V1-V99\"]\nreserved = [\"V90-V100\", \"R9\"]",
        "confirm = [\"code:G28\", \"code:M77\"]",
        "work_offsets = 0",
    ] {
        let text = format!("dialect = \"fadal\"\n{fine}");
        assert!(Control::from_profile(&text).is_ok(), "{fine}");
    }
    assert!(Control::from_profile("dialect = \"fanuc\"\n[limits]\nbrackets = 0").is_ok());
    // An option that was not bought, and a code of another setting.
    let fanuc = "dialect = \"fanuc\"\noptions = []\nconfirm = [\"code:G54.1\", \"code:G57\"]";
    assert!(Control::from_profile(fanuc).is_ok());
}

#[test]
fn a_setting_may_have_another_number_on_a_newer_control() {
    let lathe = "dialect = \"haas\"\nmachine = \"lathe\"\n[settings]\n";
    let newer = Control::from_profile(&format!("{lathe}287 = 0.05")).unwrap();
    assert_eq!(newer.setting("setting.73"), Some("0.05"));
    assert!(Control::from_profile(&format!("{lathe}73 = 0.05\n287 = 0.05")).is_ok());
    wrong(&format!("{lathe}287 = 0.05\n73 = 0.5"), "setting.73 is there twice, with two values");
}

#[test]
fn profiles_state_answers() {
    let haas = |more: &str| Control::from_profile(&format!("dialect = \"haas\"\n{more}"));
    let told = |more: &str| {
        let control = haas(more).unwrap();
        let row = control.behaviour(Question::DivideByZero).unwrap();
        (row.value.clone(), row.origin.is_confirmed())
    };
    assert_eq!(told(""), ("unknown".into(), false));
    for text in [
        "[behaviours]\ndivide.by.zero = \"alarm\"",
        "[behaviours]\n\"divide.by.zero\" = \"alarm\"",
        "[behaviours.divide]\nby.zero = \"alarm\"",
    ] {
        assert_eq!(told(text), ("alarm".into(), true), "{text}");
    }
    let truth = haas("[behaviours]\nvacant.eq.zero = false").unwrap();
    assert!(truth.behaviour(Question::VacantEqZero).unwrap().origin.is_confirmed());
    // Silence of the table is an answer there; a profile may give another.
    assert!(haas("").unwrap().behaviour(Question::CycleEndsByMotion).is_none());
    let open = haas("[behaviours]\nalarm.offset = \"unknown\"");
    assert!(open.is_err(), "a number is asked for");
    // What another control of the family leaves open may be left open here.
    let doubted =
        haas("[behaviours]\narguments.mixed.later.wins = true\ncycle.l0.moves = \"unknown\"").unwrap();
    assert!(!doubted.behaviour(Question::CycleL0Moves).unwrap().origin.is_confirmed());
    let option = "dialect = \"fanuc\"\n[behaviours]\ncondition.and.or = false";
    assert!(!Control::from_profile(option).unwrap().is(Question::ConditionAndOr));
}

#[test]
fn profiles_state_no_wrong_answers() {
    let haas = |line: &str, expected: &str| {
        wrong(&format!("dialect = \"haas\"\n[behaviours]\n{line}"), expected);
    };
    haas(
        "divide.by.zeroo = \"alarm\"",
        "p.toml:3:11: MG0203: no behaviour is named 'divide.by.zeroo' (did you mean 'divide.by.zero'?)",
    );
    haas(
        "divide.by.zero = \"stop\"",
        "'stop' is not a value of divide.by.zero (it is one of alarm, unknown)",
    );
    haas("dwell.bare = 1", "'1' is not a value of dwell.bare");
    haas("sub.ends.at.next = true", "Haas is not asked 'sub.ends.at.next'");
    haas("equal.tolerance = 0.001", "equal.tolerance is '0' in the table, and '0.001' is not converted");
    haas("fix.toward.zero = false", "'false' is not converted");
    // To take back an answer that all of the family rely on would be read as 'no'.
    haas("vacancy = \"unknown\"", "vacancy is 'true' in the table, and 'unknown' is not converted");
    haas(
        "cycle.ends.by.motion = false",
        "cycle.ends.by.motion is as on most controls, and 'false' is not converted",
    );
    haas("vacancy = [1]", "a value is true or false, a number, or a word in quotes");
    // Another control of the family does so, and its conversion is there.
    assert!(Control::from_profile("dialect = \"haas\"\n[behaviours]\nm99.p.jumps.here = false").is_ok());
    wrong(
        "dialect = \"fanuc\"\n[parameters]\n6004.0 = 0\n[behaviours]\natan2.range = \"-180..180\"",
        "p.toml:5:7: MG0203: 'parameter.6004.0' contradicts this about atan2.range",
    );
    let fanuc = "dialect = \"fanuc\"\n[parameters]\n6004.0 = 1\n[behaviours]\natan2.range = \"-180..180\"";
    assert!(Control::from_profile(fanuc).is_ok());
}

/// What stands in no row is confirmed by the name that a diagnostic gives it.
#[test]
fn profiles_confirm_what_has_no_row() {
    for fact in ["word:E", "code:M77", "machine:code.M77", "argument:Q", "statement:read.bit", "function:tan"]
    {
        let text = format!("dialect = \"cc100\"\nconfirm = [\"{fact}\"]");
        assert!(Control::from_profile(&text).is_ok(), "{fact}");
    }
}

#[test]
fn a_row_may_leave_open_which_of_several_answers_it_is() {
    let row = |value: &str, one_of: &str| {
        format!(
            r#"behaviours = [{{ name = "dwell.point", value = "{value}", one_of = [{one_of}], source = "s", confirmed = false, note = "n" }}]"#
        )
    };
    assert_eq!(faults(&row("unknown", r#""ms", "seconds""#)), "");
    assert_eq!(faults(&row("ms", r#""ms", "seconds""#)), "");
    refused(&row("setting", r#""ms", "seconds""#), "dwell.point has an answer that is none of 'one_of'");
    refused(&row("unknown", r#""ms", "hours""#), "'hours' is not a value of dwell.point");
    refused(&row("unknown", r#""ms""#), "'one_of' lists two answers or more");
    refused(&row("unknown", r#""ms", "ms""#), "'one_of' lists two answers or more");
    refused(&row("unknown", r#""ms", "unknown""#), "'one_of' lists two answers or more");
}

/// What a table answers with others beside it is what most machines do: a profile may say one of the others.
#[test]
fn a_profile_says_by_which_word_the_tool_is_changed() {
    let with = |dialect: &str, value: &str| {
        let text = format!("dialect = \"{dialect}\"\n[behaviours]\n\"tool.change.word\" = \"{value}\"");
        Control::from_profile(&text)
    };
    for dialect in ["fanuc", "haas"] {
        let control = with(dialect, "t").unwrap();
        let word = |control: &Control| control.word('T', false).and_then(|row| row.op);
        assert_eq!(word(&control), Some(Op::ToolChange));
        assert_eq!(word(&with(dialect, "m6").unwrap()), None);
    }
    let faults = with("fadal", "t").unwrap_err();
    assert!(faults[0].message.contains("'t' is not converted"), "{}", faults[0].message);
}

/// A question with so many answers open, and what a diagnostic says of it.
#[test]
fn what_is_open_between_answers_is_told_with_them() {
    let mut control = Control::plain("haas").unwrap();
    let told = |control: &Control| {
        let fact = Question::DwellExpression.fact();
        let finding = control.unconfirmed(Side::Source, fact, Some("not stated"), Span::new(0, 0));
        (finding.message.to_string(), finding.help.unwrap().to_string())
    };
    let (message, help) = told(&control);
    assert!(
        message.ends_with("for the source, Haas: what P of a dwell counts when it is computed; not stated"),
        "{message}"
    );
    assert!(help.ends_with("'dwell.expression = \"ms\" or \"seconds\"' under [behaviours] in the machine profile of the source"), "{help}");
    let row = control.dialect.behaviours.iter_mut().find(|row| row.question == Question::DwellExpression);
    row.unwrap().one_of = vec!["ms".into(), "seconds".into()];
    assert!(told(&control).0.ends_with("when it is computed: ms or seconds; not stated"));
}

#[test]
fn a_machine_begins_in_what_its_profile_says() {
    let control =
        Control::from_profile("dialect = \"fanuc\"\n[start]\ncodes = \"g90 G17 G20 G55 G0\"").unwrap();
    let ops: Vec<Op> = control.start().iter().map(|mode| mode.op).collect();
    assert_eq!(ops, [Op::Absolute, Op::PlaneXy, Op::Inch, Op::SelectWork, Op::Rapid]);
    assert_eq!(control.start()[3].work_offset(), Some(2));
    assert_eq!(control.units(), Some(Units::Inch), "the unit counts where no code says it");
    // What every mill begins in says nothing new.
    let more = "dialect = \"fanuc\"\n[start]\ncodes = \"G90 G40 G49 G80 G98 G69\"";
    assert_eq!(Control::from_profile(more).unwrap().start().len(), 1);
    // Where the holes of a lathe end; in system A they always go back, and G99 is the feed.
    let lathe = |system: &str| {
        let settings = format!("[settings]\ngcode_system = \"{system}\"\n[start]\ncodes = \"G99\"");
        Control::from_profile(&format!("dialect = \"fanuc\"\nmachine = \"lathe\"\n{settings}"))
            .unwrap()
            .start()[0]
            .op
    };
    assert_eq!([lathe("A"), lathe("B"), lathe("C")], [Op::FeedPerTurn, Op::ReturnR, Op::ReturnR]);
    let start = |said: &str, told: &str| {
        wrong(
            &format!("dialect = \"fanuc\"\n[start]\ncodes = \"{said}\""),
            &format!("p.toml:3:1: MG0203: {told}"),
        );
    };
    start("G90 G91", "'G91' stands beside 'distance.absolute', and one of them is in force");
    start("G90 G43", "'G43' is nothing that a program begins in");
    start("G2", "'G2' is nothing that a program begins in");
    start("G53", "'G53' is nothing that a program begins in");
    start("G99", "'G99' is nothing that a program begins in");
    start("ABS", "'ABS' is no code");
    start("", "[start] has empty 'codes'");
    start("  ", "[start] has empty 'codes'");
    start("G777", "Fanuc Custom Macro B has no code G777");
    wrong(
        "dialect = \"fadal\"\n[start]\ncodes = \"G21\"",
        "p.toml:3:1: MG0203: 'G21' asks which unit the machine is set to, and sets none",
    );
    wrong(
        "dialect = \"fanuc\"\nunits = \"metric\"\n[start]\ncodes = \"G20\"",
        "p.toml:4:1: MG0203: [start] names another unit than 'units'",
    );
    wrong(
        "dialect = \"fanuc\"\n[start]\ncode = \"G20\"",
        "p.toml:3:1: MG0203: unknown key 'code': this takes \"codes\"",
    );
}

#[test]
fn a_machine_may_have_more_variables_than_the_table() {
    let runs = |said: &str| format!("dialect = \"fanuc\"\nvariables = [{said}]");
    let wide = Control::from_profile(&runs("\"#1-#33\", \"#100-#149\", \"#98000-#98499 retained\"")).unwrap();
    let found: Vec<(u32, u32, Option<bool>)> =
        wide.classes().iter().map(|class| (class.first, class.last, class.retained)).collect();
    assert_eq!(found.last(), Some(&(98_000, 98_499, Some(true))));
    assert!(found.contains(&(100, 149, Some(false))));
    let told = |said: &str, fault: &str| wrong(&runs(said), fault);
    told("\"#400-#499\"", "Fanuc Custom Macro B has no variables #400-#499");
    told("\"#400-#499 kept\"", "'kept' is no kind of variable #400 may be");
    // A Mitsubishi M70's, of six digits.
    let long =
        Control::from_profile(&runs("\"#100100-#100110 retained\", \"#900000-#907399 retained\"")).unwrap();
    for (number, there) in
        [(100_099, false), (100_100, true), (100_111, false), (907_399, true), (907_400, false)]
    {
        assert_eq!(long.numbered_class(number).is_some(), there, "#{number}");
    }
    told("\"#99999999-#100000000 common\"", "#100000000 is past #99999999, the last that is converted");
    told("\"#900000-#1000000 common\"", "there are 100001 variables, more than 100000");
    told("\"V400-V499 common\"", "'common' is no kind of variable V400 may be");
    told("\"#1000-#1031 common\"", "#1000 is 'input'");
    told("\"#100-#149\", \"#140-#160 common\"", "names variables that stand before it");
    wrong(
        "dialect = \"fanuc\"\nreserved = [\"#500 retained\"]",
        "'retained' says nothing of reserved variables",
    );
}

/// One answer for questions of one kind: what is answered by itself counts first, and what a manual says stays.
#[test]
fn a_group_answers_what_is_open() {
    let ends = |text: &str| {
        let control = Control::from_profile(text).unwrap();
        let value = |question| control.behaviour(question).unwrap().value.clone();
        [Question::StopEndsSpindle, Question::StopEndsCoolant].map(value)
    };
    let fanuc = "dialect = \"fanuc\"\n";
    assert_eq!(ends(&format!("{fanuc}[behaviours]\n\"stop.ends\" = true")), ["true", "true"]);
    for single in [
        "[behaviours]\n\"stop.ends\" = true\n\"stop.ends.coolant\" = false",
        "[behaviours]\n\"stop.ends.coolant\" = false\n\"stop.ends\" = true",
        "[behaviours]\n\"stop.ends\" = true\n[settings]\nstop_ends_coolant = \"no\"",
    ] {
        assert_eq!(ends(&format!("{fanuc}{single}")), ["true", "false"], "{single}");
    }
    let haas = "dialect = \"haas\"\n[behaviours]\n";
    assert_eq!(ends(&format!("{haas}\"stop.ends\" = true")), ["true", "true"]);
    wrong(&format!("{haas}\"stop.ends\" = false"), "stop.ends.spindle is 'true' in the table");
    assert_eq!(
        ends(&format!(
            "{haas}\"stop.ends\" = false\n\"stop.ends.spindle\" = false\n\"stop.ends.coolant\" = false"
        )),
        ["false", "false"]
    );
    wrong(&format!("{haas}\"no.result\" = \"unknown\""), "is not a value of no.result");
    wrong(&format!("{haas}\"no.result\" = \"zero\""), "is not a value of no.result");
    wrong(&format!("{haas}\"no.results\" = \"alarm\""), "did you mean 'no.result'?");
}
