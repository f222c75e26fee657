//! Programs that stand in both machines, as the two sides of a comparison see them.

use super::names::class_of;
use super::side::Side;
use super::symbol_map::SymbolMap;
use crate::control::outside::Outside;
use crate::syntax::ProgramName;
use std::collections::BTreeSet;

/// Variables that a run gives to such programs, at the most: a control may have very many.
const MOST: usize = 2000;

/// Both sides beside the programs that stand in the target's machine by its profile, and do there the same as those on the source.
/// Where one of the two controls gives no arguments to calls, there are none.
pub fn beside<'a, 'b>(source: Side<'a>, target: Side<'b>, names: &SymbolMap) -> (Side<'a>, Side<'b>) {
    let standing = target.control.standing();
    if standing.is_empty() || !source.has_locals() || !target.has_locals() {
        return (source, target);
    }
    let numbers = source.library.sections.all().iter().filter_map(|section| match section.name {
        Some(ProgramName::Number(number)) => Some(number),
        _ => None,
    });
    let library: BTreeSet<u32> = numbers.collect();
    let classes = source.control.classes().iter().filter(|class| class.class != "letter");
    let mut common = Vec::new();
    let mut locals = Vec::new();
    for class in classes {
        for number in class.first..=class.last {
            let name = format!("{}{number}", class.name);
            if common.len() >= MOST {
                break;
            }
            let there = names.variable(&name, source.control, target.control);
            let is_local = |name: &str| class_of(target.control, name).map(|class| class.class == "local");
            // A result has the number that the target's profile gives it.
            let result = target.control.standing_results().of(number).filter(|_| class.class != "local");
            let same = format!("{}{}", class.name, result.unwrap_or(number));
            match there.filter(|there| *there == same).and_then(|there| is_local(&there)) {
                Some(true) if class.class == "local" => locals.push(number as usize),
                Some(false) if class.class != "local" => common.push((number, result.unwrap_or(number))),
                _ => {}
            }
        }
    }
    let here = Outside::new(standing, library, common, locals);
    let there = here.of_target();
    (source.with(here), target.with(there))
}
