//! What a table must not say of where its rows come from.

use super::answers::SETTING;
use super::check::Tables;
use super::reader::{Placed, Reader};
use super::{Behaviour, Mark, Row};

/// Every row says where it comes from, an unconfirmed one what is not certain, and one that rests on
/// a question which.
pub(super) fn sources(reader: &mut Reader, tables: &Tables) {
    fn section<T: Row>(reader: &mut Reader, rows: &[Placed<T>], answers: &[Placed<Behaviour>]) {
        for placed in rows {
            let origin = placed.row.origin();
            if origin.source.trim().is_empty() {
                reader.fault_at(placed.place.clone(), "the source is empty", "name the manual and the page");
            }
            if !origin.is_settled() && origin.note.is_none() {
                let help = "add 'note' with what is not certain";
                reader.fault_at(placed.place.clone(), format!("{} is unconfirmed", placed.row.fact()), help);
            }
            let asked = |fact: &str| answers.iter().any(|placed| placed.row.fact() == fact);
            if let Some(fact) = origin.rests.as_deref().filter(|fact| !asked(fact)) {
                let help = "name a question that this table answers: 'behaviour:NAME'";
                reader.fault_at(placed.place.clone(), format!("no row is named '{fact}'"), help);
            }
        }
    }
    for Placed { row, place, .. } in &tables.behaviours {
        if row.value == "unknown" && row.origin.mark == Mark::Common {
            let help = "write 'confirmed = false', or the answer";
            reader.fault_at(place.clone(), "an answer that is 'unknown' is not common", help);
        } else if row.value == SETTING && !row.origin.is_settled() {
            let help = "write 'unknown', or name the text that leaves it to a setting";
            reader.fault_at(place.clone(), "no source says that a setting answers it", help);
        }
    }
    section(reader, &tables.forms, &tables.behaviours);
    section(reader, &tables.limits, &tables.behaviours);
    section(reader, &tables.forbidden, &tables.behaviours);
    section(reader, &tables.operators, &tables.behaviours);
    section(reader, &tables.functions, &tables.behaviours);
    section(reader, &tables.statements, &tables.behaviours);
    section(reader, &tables.behaviours, &tables.behaviours);
    section(reader, &tables.variables, &tables.behaviours);
    section(reader, &tables.matters, &tables.behaviours);
    section(reader, &tables.in_use, &tables.behaviours);
    section(reader, &tables.same_cells, &tables.behaviours);
    section(reader, &tables.system, &tables.behaviours);
    section(reader, &tables.words, &tables.behaviours);
    section(reader, &tables.codes, &tables.behaviours);
    section(reader, &tables.arguments, &tables.behaviours);
    section(reader, &tables.settings, &tables.behaviours);
}
