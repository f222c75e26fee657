//! `test run`: nothing but claims of execution.

use crate::{Case, claims};
use macroglot::ir::text::parse;

pub fn drive(case: &Case) -> Result<Option<String>, String> {
    let module = parse(&case.text).map_err(|e| e.to_string())?;
    macroglot::ir::validate(&module).map_err(|all| all[0].to_string())?;
    match claims::check(&case.text, &module)? {
        0 => Err("makes no claim".into()),
        _ => Ok(None),
    }
}
