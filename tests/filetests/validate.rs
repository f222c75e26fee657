//! `test validate`: lists the breaches of the contract, or says `valid`.

use crate::Case;
use macroglot::ir::text::parse;

pub fn drive(case: &Case) -> Result<Option<String>, String> {
    let module = parse(&case.text).map_err(|e| e.to_string())?;
    Ok(Some(match macroglot::ir::validate(&module) {
        Ok(_) => "valid\n".into(),
        Err(all) => all.iter().map(|invalid| format!("{invalid}\n")).collect(),
    }))
}
