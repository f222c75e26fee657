//! Rows of builders' codes in machine profiles.

use crate::canon::{Act, Op, Role, Sys};
use crate::dialect::{Control, Profile, faults_as_text};

fn refused(dialect: &str, rows: &str, expected: &str) {
    let text = format!("dialect = \"{dialect}\"\nsite = [{rows}]");
    let faults = Control::from_profile(&text).map(|_| ()).unwrap_err();
    let faults = faults_as_text("p.toml", &text, &faults);
    assert!(faults.contains(expected), "expected '{expected}' in:\n{faults}");
}

fn control(dialect: &str, rows: &str) -> Control {
    Control::from_profile(&format!("dialect = \"{dialect}\"\nsite = [{rows}]")).unwrap()
}

#[test]
fn rows_that_contradict_themselves_or_the_table_are_faults() {
    let row = |more: &str| format!("{{code='M14',text='air',{more}}}");
    let fanuc = |more: &str, expected: &str| refused("fanuc", &row(more), expected);
    fanuc("name=''", "'' is not a name");
    fanuc("name='chuck air'", "'chuck air' is not a name");
    fanuc("name='air',op='coolant.flood'", "M14 has two meanings");
    fanuc("target='M88',do='omit'", "M14 has 'target' and 'do'");
    fanuc("target='88'", "'88' is not a code");
    fanuc("target='M3 FOO'", "'M3 FOO' is not a code");
    fanuc("with=['coolant.flood']", "does 'coolant.flood' with something that is not said");
    fanuc("op='spindle.cw',with=['spindle.stop']", "switches one thing twice");
    fanuc("op='dwell',with=['coolant.flood']", "'dwell' cannot be done together with something else");
    fanuc("do='nothing'", "omit");
    fanuc("arguments=true", "M14 has arguments and calls no program");
    fanuc("calls=9010,name='air'", "M14 has two meanings");
    fanuc("calls=9010,target='M88',arguments=true", "M14 has 'arguments' and 'target'");
    fanuc("calls=9010,target='M88',do='omit'", "M14 has two meanings");
    refused("fanuc", "{code='G91',calls=9010,target='M88'}", "G91 has a meaning of its own on this control");
    fanuc("calls=9010,words={P='level'}", "M14 has words and calls a program");
    fanuc("name='air',words={PP='level'}", "'PP' is not the letter of a word");
    fanuc("name='air',words={P=''}", "P of M14 has no name");
    fanuc("name='air',words={P='level',Q='level'}", "P and Q of M14 are both 'level'");
    fanuc("target='M88',words={P='S',Q='S'}", "P and Q of M14 are both 'S'");
    fanuc("name='air',words={G='level'}", "'G' is not the letter of a word");
    fanuc("target='M88',words={S='level'}", "'level' is not the letter of a word");
    fanuc("op='dwell',words={P='dwell.msec'}", "did you mean 'dwell.ms'?");
    fanuc("name='air',sets={'#500-#501'='x'}", "'#500-#501' is not a variable");
    fanuc("nam='air'", "unknown");
    refused("fanuc", "{code='M14',text=' ',do='stop'}", "M14 has no 'text'");
    refused("fanuc", "{code='M14',do='alarm'}", "M14 has no 'text'");
    refused("fanuc", "{code='M30',text='end',name='end'}", "M30 has a meaning of its own on this control");
    refused("fanuc", "{code='G91',text='x',name='x'}", "G91 has a meaning of its own on this control");
    refused("cc100", "{code='M20',text='x',calls=9010}", "no code of a builder does on this control");
}

#[test]
fn two_rows_of_one_code_or_of_one_name_are_faults() {
    refused(
        "fanuc",
        "{code='M14',text='a',name='a'},{code='M14',text='b',name='b'}",
        "M14 stands in the profile twice",
    );
    refused(
        "fanuc",
        "{code='M14',text='a',name='a'},{code='M15',text='b',name='a'}",
        "M14 and M15 have one name",
    );
    let both = control(
        "fanuc",
        "{code='M14',text='a',name='test.a'},{code='M15',text='b',name='test.a',preferred=false}",
    );
    assert_eq!(both.code_of(Act::named("test.a")).map(|row| row.code.as_str()), Some("M14"));
    assert_eq!(both.code('M', 15.0, &[]).map(|row| row.op), Some(Op::Act));
    let shared =
        "{code='M14',text='a',name='a',sets={'#500'='x'}},{code='M15',text='b',name='b',sets={'#500'='y'}}";
    refused("fanuc", shared, "paired otherwise at another code");
}

#[test]
fn a_variable_of_a_code_is_none_of_the_programs() {
    let control = control("fanuc", "{code='M14',text='a',name='a',sets={'#500'='test.result'}}");
    assert!(control.variable_class("#", 500).is_none());
    assert!(control.variable_class("#", 501).is_some());
    let number = Act::named("test.result").number() as u32;
    let found = control.read_system("#", Some(500)).map(|(state, subscripts, _)| (state, subscripts));
    assert_eq!(found, Some((Sys::Act, vec![number])));
}

#[test]
fn a_code_without_a_name_of_the_shop_is_known_on_its_own_machine_alone() {
    let mills = [("fanuc", "air"), ("fanuc", "door")]
        .map(|(dialect, text)| control(dialect, &format!("{{code='M14',text='{text}',do='omit'}}")));
    let names = mills
        .each_ref()
        .map(|mill| mill.code('M', 14.0, &[]).and_then(|row| row.fixed.get(&Role::Act).copied()));
    assert_ne!(names[0], names[1]);
    assert_eq!(names[0].and_then(Act::of).map(Act::shown).as_deref(), Some("M14"));
}

#[test]
fn the_source_names_codes_of_the_target() {
    let meeting = |row: &str| {
        let source = control("fanuc", row);
        let (source, target) =
            Control::meeting(source, Control::plain("haas").unwrap()).map_err(|e| e.to_string())?;
        let act = source.site_code('M', 14.0).and_then(|site| source.act_of(site)).unwrap();
        let op = source.code('M', 14.0, &[]).map(|row| row.op);
        Ok::<_, String>((op, target.code_of(act).map(|row| row.code.clone())))
    };
    let own = meeting("{code='M14',text='a',target='M151'}");
    assert_eq!(own, Ok((Some(Op::Act), Some("M151".into()))));
    let standard = meeting("{code='M14',text='a',target='M8'}");
    assert_eq!(standard, Ok((Some(Op::Flood), None)));
    // What only such a machine has is as good as a builder's.
    let brake = Control::meeting(
        control("fanuc", "{code='M89',text='a',target='M14'}"),
        Control::from_profile("dialect = \"haas\"\nmachine = \"lathe\"").unwrap(),
    );
    assert!(brake.is_ok_and(|(source, target)| {
        let act = source.site_code('M', 89.0).and_then(|site| source.act_of(site));
        act.and_then(|act| target.code_of(act)).is_some_and(|row| row.code == "M14")
    }));
    let flow = meeting("{code='M14',text='a',target='M30'}").unwrap_err();
    assert!(flow.contains("M14 cannot be M30 of the target"), "{flow}");
    let word = meeting("{code='M14',text='a',target='M8',words={P='Q'}}").unwrap_err();
    assert!(word.contains("takes no word Q"), "{word}");
}

#[test]
fn results_name_variables_of_the_source_by_either_of_their_numbers() {
    let meeting = |lines: &str| {
        let target =
            Control::from_profile(&format!("dialect = \"fanuc\"\nstanding_results = [{lines}]\n")).unwrap();
        Control::meeting(Control::plain("haas").unwrap(), target).map_err(|error| error.to_string())
    };
    let (_, target) = meeting("\"#10187-#10188 as #137-#138\", \"#189 as #139\"").unwrap();
    let results = target.standing_results();
    assert_eq!(
        [187, 188, 189, 10187].map(|number| results.of(number)),
        [Some(137), Some(138), Some(139), None]
    );
    let none = meeting("\"#10150 as #150\", \"#12087 as #137\"").unwrap_err();
    assert!(none.contains("'#12087 as #137': the source, Haas, has no common variable #12087"), "{none}");
    let twice = meeting("\"#10187 as #137\", \"#187 as #138\"").unwrap_err();
    assert!(twice.contains("another line gives #187 another number"), "{twice}");
}

/// A line of `[codes]` is a row of `[[site]]`, and faults stand at their lines.
#[test]
fn a_line_of_codes_is_a_row() {
    let head = "dialect = \"fanuc\"\n";
    let read = |text: &str| Profile::read(&format!("{head}{text}")).map(Profile::without_places);
    let rows = "[[site]]\ncode = \"M14\"\ndo = \"omit\"\n[[site]]\ncode = \"M3 P11\"\ntarget = \"M88\"\n";
    let lines = "[codes]\n\"M3 P11\" = { target = \"M88\" }\n[[site]]\ncode = \"M14\"\ndo = \"omit\"\n";
    assert_eq!(read(rows).unwrap(), read(lines).unwrap());
    assert!(read("[codes]\n").unwrap().site.is_empty());
    for (text, fault) in [
        ("codes = 1", "'codes' is not a section"),
        ("[codes]\nM14 = \"omit\"", "M14 is no row in braces"),
        ("[codes]\nM14 = { code = \"M15\", do = \"omit\" }", "M14 says its code twice"),
        ("[codes]\nM14 = { targt = \"M88\" }", "targt"),
    ] {
        let faults = read(text).unwrap_err();
        assert!(faults[0].message.contains(fault), "{}", faults[0].message);
        assert!(faults[0].span.start as usize >= head.len(), "{fault}");
    }
    let twice =
        format!("{head}[codes]\nM14 = {{ do = \"omit\" }}\n[[site]]\ncode = \"M14\"\ndo = \"same\"\n");
    let faults = Control::from_profile(&twice).map(|_| ()).unwrap_err();
    assert!(faults[0].message.contains("M14 stands in the profile twice"), "{}", faults[0].message);
}
