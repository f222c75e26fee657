//! Traces of the corpus keep to `docs/trace.schema.json`. The schema uses few of its language's
//! words, so that a small checker of our own can read it whole.

use macroglot::control::{Library, LoadedFile, ProgramRef, Scenario};
use macroglot::dialect::{Control, registry};
use macroglot::library::Input;
use macroglot::report::{Coordinates, TraceFormat, TraceWriter, backplot, png};
use macroglot::syntax::parse_file;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Words of the schema language that the checker knows.
const KNOWN: [&str; 11] = [
    "$schema",
    "$defs",
    "$ref",
    "title",
    "oneOf",
    "type",
    "required",
    "properties",
    "additionalProperties",
    "items",
    "enum",
];

fn fits(schema: &Value, root: &Value, value: &Value) -> bool {
    let Some(schema) = schema.as_object() else { return schema.as_bool().unwrap_or(true) };
    schema.iter().all(|(word, says)| match word.as_str() {
        "$ref" => {
            let name = says.as_str().and_then(|path| path.strip_prefix("#/$defs/")).expect("a definition");
            fits(&root["$defs"][name], root, value)
        }
        "oneOf" => says.as_array().expect("a list").iter().filter(|one| fits(one, root, value)).count() == 1,
        "type" => match says.as_array() {
            Some(types) => types.iter().any(|one| is_of(one, value)),
            None => is_of(says, value),
        },
        "required" => {
            says.as_array().expect("a list").iter().all(|key| value.get(key.as_str().unwrap_or("")).is_some())
        }
        "properties" => says
            .as_object()
            .expect("keys")
            .iter()
            .all(|(key, one)| value.get(key).is_none_or(|value| fits(one, root, value))),
        "additionalProperties" => {
            let named = schema.get("properties").and_then(Value::as_object);
            let others = value.as_object().into_iter().flatten();
            others
                .filter(|(key, _)| named.is_none_or(|named| !named.contains_key(*key)))
                .all(|(_, value)| says != &Value::Bool(false) && fits(says, root, value))
        }
        "items" => value.as_array().is_none_or(|list| list.iter().all(|value| fits(says, root, value))),
        "enum" => says.as_array().expect("a list").contains(value),
        "const" => says == value,
        word => KNOWN.contains(&word),
    })
}

fn is_of(name: &Value, value: &Value) -> bool {
    match name.as_str().expect("a type") {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_u64() || value.is_i64(),
        "number" => value.is_number(),
        "null" => value.is_null(),
        other => panic!("the checker does not know the type {other}"),
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).to_owned()
}

/// The traces of all programs of the corpus.
fn traces() -> Vec<(PathBuf, String)> {
    let mut out = Vec::new();
    for entry in registry::all() {
        let Some(execute) = entry.execute else { continue };
        let control = Control::plain(entry.name).expect("the table loads");
        let mut files: Vec<PathBuf> = std::fs::read_dir(root().join("corpus").join(entry.name))
            .expect("a corpus")
            .map(|file| file.expect("a file").path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "nc"))
            .collect();
        files.sort();
        for path in files {
            let bytes = std::fs::read(&path).expect("a program");
            let inputs = [Input { name: path.display().to_string(), path: path.clone(), bytes }];
            let parsed = parse_file(&inputs[0].bytes, entry.parse);
            let library = [LoadedFile { name: &inputs[0].name, parsed: &parsed }];
            let scenario = Scenario { steps: 500, variable_events: true, ..Scenario::default() };
            let run = execute(&Library::new(&library), ProgramRef::FIRST, &control, &scenario);
            let mut text = Vec::new();
            TraceWriter::new(TraceFormat::Text, &inputs, &mut text).end(&run).unwrap();
            assert!(!text.is_empty());
            let plot = backplot(&run, &inputs[0].name, Coordinates::Work);
            assert!(plot.starts_with("<svg") && !plot.contains("NaN"), "{}", path.display());
            let mut lines = Vec::new();
            TraceWriter::new(TraceFormat::Json, &inputs, &mut lines).end(&run).unwrap();
            out.push((path, String::from_utf8(lines).unwrap()));
        }
    }
    out
}

#[test]
fn every_line_of_every_trace_fits_the_schema() {
    let text = std::fs::read_to_string(root().join("docs/trace.schema.json")).expect("the schema");
    let schema: Value = serde_json::from_str(&text).expect("JSON");
    let mut kinds = BTreeSet::new();
    for (path, trace) in traces() {
        for line in trace.lines() {
            let value: Value = serde_json::from_str(line).expect("JSON");
            assert!(fits(&schema, &schema, &value), "{}: {line}", path.display());
            kinds.insert(value["event"].as_str().expect("a kind").to_owned());
        }
        assert!(trace.lines().last().is_some_and(|line| line.contains("\"result\"")), "{}", path.display());
    }
    // The corpus shows most of them.
    assert!(kinds.len() >= 15, "{kinds:?}");
}

#[test]
fn the_schema_refuses_what_is_no_event() {
    let text = std::fs::read_to_string(root().join("docs/trace.schema.json")).expect("the schema");
    let schema: Value = serde_json::from_str(&text).expect("JSON");
    for line in [r#"{"event":"dance"}"#, r#"{"event":"rapid"}"#, r#"[]"#] {
        let value: Value = serde_json::from_str(line).expect("JSON");
        assert!(!fits(&schema, &schema, &value), "{line}");
    }
}

/// The drawings of a run with a profile's kind of machine.
fn drawings(profile: &str, text: &str) -> String {
    drawn(profile, text, "", "t.nc", Coordinates::Work)
}

/// The drawings of a run in a scenario; they are well-formed XML.
fn drawn(profile: &str, text: &str, scenario: &str, title: &str, from: Coordinates) -> String {
    let control = Control::from_profile(profile).expect("a profile");
    let parsed = parse_file(text.as_bytes(), control.entry().parse);
    let library = [LoadedFile { name: "t.nc", parsed: &parsed }];
    let execute = control.entry().execute.expect("an emulated control");
    let scenario: Scenario = toml::from_str(scenario).expect("a scenario");
    let plot =
        backplot(&execute(&Library::new(&library), ProgramRef::FIRST, &control, &scenario), title, from);
    let mut reader = quick_xml::Reader::from_str(&plot);
    reader.config_mut().check_end_names = true;
    loop {
        match reader.read_event().expect("well-formed XML") {
            quick_xml::events::Event::Eof => break,
            quick_xml::events::Event::Text(text) => {
                text.xml10_content().expect("text");
            }
            _ => {}
        }
    }
    let odd = |c: char| c.is_control() && c != '\n';
    assert!(!plot.contains(odd) && !plot.contains("NaN"), "{plot}");
    plot
}

const MILL: &str = "dialect = \"fanuc\"\nunits = \"metric\"";
/// Two sides of a square of 100 from the work zero.
const CORNER: &str = "O1\nG90 G54 G0 X0. Y0.\nG43 H1 Z0.\nG1 X100. F100.\nY100.\nM30\n";
const OFFSETS: &str =
    "[work_offsets]\n1 = [500, -200, -300, 0, 0, 0, 0, 0, 0, 0]\n[tools.1]\nlength = 80\nradius = 5\n";
/// A drawing is 560 wide, and the path takes 0.86 of it: 4.816 a unit. X0 lies 60 + (560 - 481.6) / 2 from the left,
/// Y0 96 + (560 + 481.6) / 2 from the top.
const SIDES: &str = "points=\"99.20,616.80 580.80,616.80 580.80,135.20\"";

#[test]
fn a_backplot_counts_from_the_work_zero_or_from_the_machines() {
    let work = drawn(MILL, CORNER, OFFSETS, "t.nc", Coordinates::Work);
    assert!(work.contains(SIDES) && work.contains(">work coordinates, at the tip"), "{work}");
    assert!(work.contains(">0<") && work.contains(">80<") && !work.contains(">500<"), "{work}");
    let machine = drawn(MILL, CORNER, OFFSETS, "t.nc", Coordinates::Machine);
    assert!(machine.contains(SIDES) && machine.contains(">machine coordinates<"), "{machine}");
    assert!(machine.contains(">500<") && machine.contains(">-200<") && !machine.contains(">0<"), "{machine}");
}

/// The same square about two work zeros lies in one place. The way between them begins at X-300 Y-100 of the second:
/// 1.204 pixels a millimetre, X0 at 99.2 + 300 * 1.204, Y0 at 96 + (560 + 240.8) / 2 - 100 * 1.204. Also, a local shift moves it within the work coordinates.
#[test]
fn work_zeros_lie_over_each_other_and_a_local_shift_does_not() {
    let two = CORNER.replace("M30", "G0 Z50.\nG55 X0. Y0.\nG1 X100. F100.\nY100.\nM30");
    let both = OFFSETS.replace("[tools", "2 = [900, 0, -300, 0, 0, 0, 0, 0, 0, 0]\n[tools");
    let plot = drawn(MILL, &two, &both, "t.nc", Coordinates::Work);
    assert!(
        plot.contains("several work zeros")
            && plot.matches("460.40,376.00 580.80,376.00 580.80,255.60").count() >= 2,
        "{plot}"
    );
    let local = "O1\nG90 G54 G52 X50. Y0.\nG0 X0. Y0.\nG1 X100. F100.\nY100.\nM30\n";
    let plot = drawn(MILL, local, OFFSETS, "t.nc", Coordinates::Work);
    assert!(plot.contains(">60<") && plot.contains(">140<"), "{plot}");
}

#[test]
fn a_backplot_has_the_unit_of_the_program() {
    let inches = CORNER.replace("G90", "G20 G90");
    let plot = drawn(MILL, &inches, "", "t.nc", Coordinates::Work);
    assert!(
        plot.contains(">XY, inch<") && plot.contains(">isometric, inch<") && plot.contains(">20 inch<"),
        "{plot}"
    );
    // A hundred inches look like a hundred millimetres.
    assert!(plot.contains(SIDES) && !plot.contains(" mm<"), "{plot}");
    let own = drawn(&MILL.replace("metric", "inch"), CORNER, "", "t.nc", Coordinates::Work);
    assert!(own.contains(">XY, inch<"), "{own}");
    // 10 inches and 100 millimetres: 254 and 100.
    let mixed = "O1\nG90 G20 G0 X0. Y0.\nG1 X10. F10.\nG21\nY100. F100.\nM30\n";
    let plot = drawn(MILL, mixed, "", "t.nc", Coordinates::Work);
    assert!(plot.contains(">XY, mm<") && plot.contains(">250<") && !plot.contains("inch"), "{plot}");
}

#[test]
fn tools_have_colours_and_the_rest_is_grey() {
    let mut text = String::from("O1\nG90 G0 X-1. Y0.\n");
    for tool in 1..=12 {
        text += &format!("T{tool} M6\nG1 X{tool}. F100.\n");
    }
    let plot = drawn(MILL, &(text + "M30\n"), "", "t.nc", Coordinates::Work);
    // The rapid is the first tool's: eight more have colours.
    assert!(plot.contains(">T1<") && plot.contains(">T8<") && !plot.contains(">T9<"), "{plot}");
    assert!(
        plot.contains(">other tools<") && plot.contains("stroke=\"#777\" stroke-width=\"1.4\""),
        "{plot}"
    );
    assert!(!drawings(MILL, CORNER).contains(">T"), "no tool was called");
}

/// Left of a way along X lies Y + 5: 616.8 - 5 * 4.816.
#[test]
fn the_middle_of_the_cutter_is_a_hint() {
    let text = CORNER.replace("G1 X100.", "G1 G41 D1 X100.");
    let plot = drawn(MILL, &text, OFFSETS, "t.nc", Coordinates::Work);
    assert!(plot.contains("99.20,592.72 580.80,592.72") && plot.contains("middle of the cutter"), "{plot}");
    let right = drawn(MILL, &text.replace("G41", "G42"), OFFSETS, "t.nc", Coordinates::Work);
    assert!(right.contains("99.20,640.88 580.80,640.88"), "{right}");
    let none = drawn(MILL, &text, "", "t.nc", Coordinates::Work);
    assert!(none.contains("with a radius of 0") && !none.contains("middle of the cutter"), "{none}");
}

/// In the ZX plane the side is seen with Z across and X up: left of a way along Z+ lies X + 5. The way is 100 long, its 4.816
/// pixels a millimetre begin at Z0, 99.2, and X0 at 96 + 560 / 2.
#[test]
fn the_side_of_the_cutter_is_seen_in_the_plane() {
    let text = "O1\nG90 G54 G18 G0 X0. Y0. Z0.\nG43 H1 Z0.\nG1 G41 D1 Z100. F100.\nM30\n";
    let plot = drawn(MILL, text, OFFSETS, "t.nc", Coordinates::Work);
    assert!(
        plot.contains("99.20,376.00 580.80,376.00") && plot.contains("99.20,351.92 580.80,351.92"),
        "{plot}"
    );
}

/// A PNG is drawn with letters of its own: one with a title has more dark pixels than one without.
#[test]
fn a_png_has_its_letters() {
    let run = |title: &str| {
        let plot = drawn(MILL, "O1\nM30\n", "", title, Coordinates::Work);
        png(&plot).expect("a picture").len()
    };
    let (none, latin, greek) = (run(""), run("PLATE"), run("ΠΛΑΞ"));
    assert!(latin > none + 100 && greek > none + 100, "{none} {latin} {greek}");
    assert!(png("<svg").is_err() && png("no picture").is_err());
}

#[test]
fn no_backplot_is_empty_and_one_that_breaks_off_says_so() {
    let still = drawings(MILL, "O1\nM30\n");
    assert!(still.contains(">the program makes no move<"), "{still}");
    let hostile = "a<b>&\"'\u{1}\u{1b}[31m</svg><script>.nc";
    let alarm = CORNER.replace("M30", "#3000=7 (BROKEN <&\u{8}>)\nM30");
    let plot = drawn(MILL, &alarm, "", hostile, Coordinates::Work);
    assert!(plot.contains("alarm: ") && plot.contains("BROKEN &lt;&amp;"), "{plot}");
    assert!(!plot.contains("<script>") && plot.matches("</svg>").count() == 1, "{plot}");
    // Its cross stands at X100 Y100: six to either side of 580.8, 135.2.
    assert!(plot.contains("M574.80 129.20l12 12"), "{plot}");
    let at_once = drawn(MILL, "O1\n#3000=7 (AT ONCE)\nM30\n", "", "t.nc", Coordinates::Work);
    assert!(at_once.contains("no move") && at_once.contains("AT ONCE"), "{at_once}");
    let endless =
        drawn(MILL, "O1\nN1 G0 X0. Y0.\nG1 X9. F9.\nGOTO 1\nM30\n", "steps = 99", "t", Coordinates::Work);
    assert!(endless.contains(">the program was still running here<"), "{endless}");
}

/// A long path is thinned: the picture stays small.
#[test]
fn a_long_path_makes_no_large_picture() {
    let text = "O1\nG90 G0 X0. Y0.\n#1=0\nWHILE [#1 LT 60000] DO1\n#1=#1+1\nG1 X[#1/100.] Y[#1/200.] F100.\nEND1\nM30\n";
    let plot = drawn(MILL, text, "steps = 900000", "t", Coordinates::Work);
    assert!(plot.len() < 3 << 20 && plot.contains("points some are left out"), "{}", plot.len());
}

/// A hole and a cut 40 mm long, 300 mm from where the tool starts: the part fills the drawing, the way to it is
/// dashed and ends at its edge.
#[test]
fn a_backplot_shows_the_part() {
    let text =
        "O1\nG90 G0 X300. Y300.\nG81 Z-5. R2. F100.\nX301.\nG80\nG1 Z-1. F100.\nX340.\nG0 X0. Y0.\nM30\n";
    let plot = drawings("dialect = \"fanuc\"\nunits = \"metric\"", text);
    assert!(plot.contains(">XY, mm<") && plot.contains(">isometric, mm<"), "{plot}");
    assert!(plot.contains("stroke-dasharray"), "{plot}");
    // Ticks from 300 on, none at zero; ten millimetres are a scale.
    assert!(plot.contains(">310<") && plot.contains(">330<") && !plot.contains(">0<"), "{plot}");
    assert!(plot.contains(">5 mm<") || plot.contains(">10 mm<"), "{plot}");
    assert_eq!(plot.matches("<g ").count(), plot.matches("</g>").count());
}

#[test]
fn a_lathe_is_drawn_over_z_and_x() {
    let profile = "dialect = \"fanuc\"\nmachine = \"lathe\"\nunits = \"metric\"";
    let plot = drawings(profile, "O1\nG97 S500 M3\nG0 X50. Z2.\nG1 Z-20. F0.2\nX70.\nM30\n");
    assert!(plot.contains(">ZX, mm, X in diameters<") && !plot.contains(">XY, mm<"), "{plot}");
    // From 50 to 70 in diameter is 10 up, and 22 along: what is drawn is twice as wide as it is high, and a tick at 60 lies
    // in the middle of its height.
    assert!(plot.contains(">60<") && plot.contains(">-20<"), "{plot}");
    let cut = plot.lines().find(|line| line.contains("polyline") && line.contains("1.4")).expect("a cut");
    let points: Vec<(f64, f64)> = cut
        .split_once("points=\"")
        .map(|(_, rest)| rest.trim_end_matches("\"/>"))
        .into_iter()
        .flat_map(|places| places.split(' '))
        .filter_map(|place| place.split_once(','))
        .map(|(x, y)| (x.parse().expect("x"), y.parse().expect("y")))
        .collect();
    let (along, up) = (points[0].0 - points[1].0, points[1].1 - points[2].1);
    assert!((along / up - 2.2).abs() < 0.01, "{points:?}");
}
