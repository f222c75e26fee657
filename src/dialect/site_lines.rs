//! Codes of a machine's builder as lines of a profile: `M14 = { target = "M88" }` under `[codes]` is a row of `[[site]]`.

use super::reader::Reader;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

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
        let DeValue::Table(mut row) = line.into_inner() else {
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
        let code = DeValue::String(key.get_ref().clone());
        row.insert(Spanned::new(key.span(), "code".into()), Spanned::new(key.span(), code));
        rows.push(Spanned::new(place, DeValue::Table(row)));
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
