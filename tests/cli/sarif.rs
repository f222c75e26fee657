//! SARIF, held to the schema of the standard (`tests/sarif/README.md` says where it is from).

use crate::python;
use crate::support::root;
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::sync::OnceLock;
use tempfile::TempDir;

/// Writes a validator of documents of a schema. The function gets its name from the schema's, if it has one.
const COMPILER: &str = "import fastjsonschema, json, sys\n\
                        schema = json.load(open(sys.argv[1], encoding='utf-8'))\n\
                        del schema['$id']\n\
                        open(sys.argv[2], 'w', encoding='utf-8').write(fastjsonschema.compile_to_code(schema))";

/// Reads a document, and fails if the schema refuses it.
const VALIDATOR: &str = "import json, sys\n\
                         import validator\n\
                         validator.validate(json.load(open(sys.argv[1], encoding='utf-8')))";

fn python(code: &str, paths: &[&Path], folder: &Path, what: &str) {
    let mut program = Command::new(python::tools().join("python"));
    let run = program.args(["-c", code]).args(paths).current_dir(folder).output();
    python::said(&run.unwrap(), what);
}

/// A log that the schema takes.
pub fn valid(text: &str) -> Value {
    static VALIDATORS: OnceLock<TempDir> = OnceLock::new();
    let folder = VALIDATORS.get_or_init(|| {
        let folder = TempDir::new().unwrap();
        let schema = root().join("tests/sarif/sarif-schema-2.1.0.json");
        python(COMPILER, &[&schema, &folder.path().join("validator.py")], folder.path(), "the schema");
        folder
    });
    let log = serde_json::from_str(text).unwrap();
    let document = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(document.path(), text).unwrap();
    python(VALIDATOR, &[document.path()], folder.path(), text);
    log
}

#[test]
fn the_schema_refuses_what_is_no_sarif() {
    for text in ["{}", r#"{"version":"2.1.0"}"#, r#"{"version":"2.1.0","runs":[{"tool":{"driver":{}}}]}"#] {
        assert!(std::panic::catch_unwind(|| valid(text)).is_err(), "{text}");
    }
    valid(r#"{"version":"2.1.0","runs":[{"tool":{"driver":{"name":"a"}}}]}"#);
}
