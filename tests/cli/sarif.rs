//! SARIF, held to the schema of the standard (`tests/sarif/README.md` says where it is from).

use boon::{Compiler, Schemas};
use serde_json::Value;

const SCHEMA: &str = include_str!("../sarif/sarif-schema-2.1.0.json");

/// A log that the schema takes.
pub fn valid(text: &str) -> Value {
    let log = serde_json::from_str(text).unwrap();
    let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
    compiler.add_resource("sarif.json", serde_json::from_str(SCHEMA).unwrap()).unwrap();
    let schema = compiler.compile("sarif.json", &mut schemas).unwrap();
    if let Err(error) = schemas.validate(&log, schema) {
        panic!("{error:#}\n{text}");
    }
    log
}

#[test]
fn the_schema_refuses_what_is_no_sarif() {
    for text in ["{}", r#"{"version":"2.1.0"}"#, r#"{"version":"2.1.0","runs":[{"tool":{"driver":{}}}]}"#] {
        assert!(std::panic::catch_unwind(|| valid(text)).is_err(), "{text}");
    }
    valid(r#"{"version":"2.1.0","runs":[{"tool":{"driver":{"name":"a"}}}]}"#);
}
