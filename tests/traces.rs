//! Traces of the corpus keep to `docs/trace.schema.json`. The schema uses few of its language's
//! words, so that a small checker of our own can read it whole.

use macroglot::control::{Library, LoadedFile, ProgramRef, Scenario};
use macroglot::dialect::{Control, registry};
use macroglot::library::Input;
use macroglot::report::{TraceFormat, TraceWriter, backplot};
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
            let plot = backplot(&run.events, &inputs[0].name);
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
    let control = Control::from_profile(profile).expect("a profile");
    let parsed = parse_file(text.as_bytes(), control.entry().parse);
    let library = [LoadedFile { name: "t.nc", parsed: &parsed }];
    let execute = control.entry().execute.expect("an emulated control");
    let run = execute(&Library::new(&library), ProgramRef::FIRST, &control, &Scenario::default());
    backplot(&run.events, "t.nc")
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
    let plot = drawings(profile, "O1\nG0 X50. Z2.\nG1 Z-20. F0.2\nX60.\nM30\n");
    assert!(plot.contains(">ZX, mm<") && !plot.contains(">XY, mm<"), "{plot}");
}
