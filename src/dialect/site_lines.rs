//! Codes of a machine's builder as lines of a profile: `M14 = { target = "M88" }` under `[codes]` is a row of `[[site]]`, and
//! `"M10, M11" = { target = "M68, M69" }` is two.

use super::reader::Reader;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

/// What a line says of each of its codes; all else counts for all of them.
const EACH: [&str; 3] = ["target", "name", "op"];

/// What names fewer or more than the line has codes, and how many.
fn uneven<'r>(row: &'r DeTable<'_>, codes: usize) -> Option<(&'r str, usize)> {
    let all = row.iter().filter(|_| codes > 1);
    let said = all.filter_map(|(key, value)| Some((key.get_ref().as_ref(), value.get_ref().as_str()?)));
    let mut counted =
        said.filter(|(key, _)| EACH.contains(key)).map(|(key, all)| (key, all.split(',').count()));
    counted.find(|(_, count)| *count != codes)
}

/// Makes each line of `[codes]` a row of `[[site]]`.
pub(super) fn join(document: &mut DeTable<'_>, reader: &mut Reader) {
    let Some(codes) = document.remove("codes") else { return };
    let whole = codes.span();
    let DeValue::Table(codes) = codes.into_inner() else {
        let help = "write [codes], and below it a line for each code: M14 = { target = \"M88\" }";
        reader.fault(whole, "'codes' is not a section", help);
        return;
    };
    let mut rows = Vec::new();
    for (key, line) in codes {
        let place = key.span().start..line.span().end.max(key.span().end);
        let DeValue::Table(row) = line.into_inner() else {
            let help = format!(
                "write what it does, or what becomes of it: {0} = {{ text = \"chuck air on\", target = \"M88\" }}",
                key.get_ref()
            );
            reader.fault(place, format!("{} is no row in braces", key.get_ref()), help);
            continue;
        };
        if let Some((code, _)) = row.get_key_value("code") {
            reader.fault(code.span(), format!("{} says its code twice", key.get_ref()), "leave 'code' out");
            continue;
        }
        let names: Vec<String> = key.get_ref().split(',').map(|name| name.trim().to_owned()).collect();
        if let Some((wrong, has)) = uneven(&row, names.len()) {
            let message = format!("{} is {} codes, and '{wrong}' names {has}", key.get_ref(), names.len());
            let help =
                "name as many, in the same order, with commas between them; or write a line for each code";
            reader.fault(place, message, help);
            continue;
        }
        for (at, name) in names.iter().enumerate() {
            let mut row = row.clone();
            for (said, value) in row.iter_mut().filter(|(said, _)| EACH.contains(&said.get_ref().as_ref())) {
                let of = said.span();
                let one = value.get_ref().as_str().and_then(|all| all.split(',').nth(at)).map(str::trim);
                if let Some(one) = one.filter(|_| names.len() > 1).map(str::to_owned) {
                    *value = Spanned::new(of, DeValue::String(one.into()));
                }
            }
            let code = DeValue::String(name.clone().into());
            row.insert(Spanned::new(key.span(), "code".into()), Spanned::new(key.span(), code));
            rows.push(Spanned::new(place.clone(), DeValue::Table(row)));
        }
    }
    if rows.is_empty() {
        return;
    }
    match document.get_mut("site").map(Spanned::get_mut) {
        Some(DeValue::Array(site)) => rows.into_iter().for_each(|row| site.push(row)),
        // Another value of it is a fault by itself.
        Some(_) => {}
        None => {
            let rows: DeArray<'_> = rows.into_iter().collect();
            document.insert(
                Spanned::new(whole.clone(), "site".into()),
                Spanned::new(whole, DeValue::Array(rows)),
            );
        }
    }
}
