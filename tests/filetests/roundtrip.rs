//! `test roundtrip`: a module prints as it is written, comments aside.

use crate::Case;
use macroglot::ir::text::{parse, print};

pub fn drive(case: &Case) -> Result<Option<String>, String> {
    let module = parse(&case.text).map_err(|e| e.to_string())?;
    let source: Vec<&str> =
        case.text.lines().filter(|line| !line.starts_with(';') && !line.is_empty()).collect();
    let printed = print(&module);
    if printed.lines().collect::<Vec<_>>() != source {
        return Err(format!("prints as\n{printed}"));
    }
    let again = parse(&printed).map_err(|e| e.to_string())?;
    if again == module { Ok(None) } else { Err("reads back as another module".into()) }
}
