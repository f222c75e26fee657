//! What two runs leave in variables.

use super::found::Difference;
use super::kinds::is_cut;
use crate::control::{End, Run};
use crate::verify::sides::{Side, SymbolMap, class_of, numbered};
use std::collections::{BTreeMap, BTreeSet};

/// How far apart values may lie that count as the same, relative, and of one at the least.
const HAIR: f64 = 1e-6;

/// Compares the final values of variables that both sides keep from program to program. What is just as far off as a
/// place that was read comes last.
pub(super) fn variables_differ<'r>(
    source: (&Side<'_>, &Run),
    target: (&Side<'_>, &Run),
    names: &SymbolMap,
) -> Option<Difference<'r>> {
    let mut by_place = None;
    for difference in all_variables(source, target, names) {
        if !difference.by_place {
            return Some(difference);
        }
        by_place.get_or_insert(difference);
    }
    by_place
}

/// All of them, in the order of their names.
pub(super) fn all_variables<'r>(
    source: (&Side<'_>, &Run),
    target: (&Side<'_>, &Run),
    names: &SymbolMap,
) -> Vec<Difference<'r>> {
    let [ours, theirs] = [source.1, target.1].map(|run| run.left.as_ref().map_or(0.0, |left| left.read));
    let reads = [ours, theirs, ours + theirs];
    let by_as_much =
        |a: f64, b: f64| reads.iter().any(|off| *off > 0.0 && ((a - b).abs() - off).abs() <= HAIR);
    if matches!(source.1.end, End::Alarm { .. }) {
        return Vec::new();
    }
    let mut differences = Vec::new();
    // What neither run left is the same: a library has many more variables than a program.
    let written = names.holding(target.1.variables.keys(), target.0.control);
    let mut all: BTreeSet<&str> = written.collect();
    all.extend(source.1.variables.keys().chain(target.1.variables.keys()).map(String::as_str));
    for name in all {
        let class = class_of(source.0.control, name).filter(|class| class.class != "local");
        let Some(class) = class else { continue };
        let Some(there) = names.variable(name, source.0.control, target.0.control) else { continue };
        let value = |run: &Run, name: &str, nullable: &dyn Fn() -> bool| {
            run.variables.get(name).copied().or_else(|| (!nullable()).then_some(0.0))
        };
        let is_nullable = class.nullable;
        let may_be_there = || class_of(target.0.control, &there).is_some_and(|class| class.nullable);
        let (a, b) = (value(source.1, name, &|| is_nullable), value(target.1, &there, &may_be_there));
        // What a control without vacancy never wrote is vacant on one that has it, and reads as 0 there; what is vacant
        // on the source is 0 on a target without vacancy.
        let never = |a: Option<f64>, b: Option<f64>| b.is_none() && a == Some(0.0);
        let same = match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() <= HAIR * a.abs().max(b.abs()).max(1.0),
            (None, None) => true,
            _ => !is_nullable && never(a, b) || !may_be_there() && never(b, a),
        };
        if same {
            continue;
        }
        let show = |value: Option<f64>| value.map_or_else(|| "vacant".into(), |value| value.to_string());
        let what = format!("{name} is {} at the end, {there} is {}", show(a), show(b));
        let found = Difference::new(None, None, what);
        let by_place = matches!((a, b), (Some(a), Some(b)) if by_as_much(a, b));
        differences.push(Difference { by_place, ..found });
    }
    differences
}

/// A register that the target wrote and that the source has no variable for, nor the conversion a use: it may hold what
/// something else of the shop keeps there. `began` is what registers held at the start.
pub fn writes_elsewhere(
    source: &Side<'_>,
    (target, run): (&Side<'_>, &Run),
    began: &BTreeMap<String, f64>,
    names: &SymbolMap,
) -> Option<String> {
    if is_cut(run) {
        return None;
    }
    let all: BTreeSet<&String> = run.variables.keys().chain(began.keys()).collect();
    let (from, to) = (source.control, target.control);
    // A register that the control itself writes, such as the one of an arc's radius, holds nothing of anybody's.
    let is_scratch = |name: &str| {
        let of_words = class_of(to, name).is_some_and(|class| class.class == "parametric");
        let plain = to.classes().iter().find(|row| row.class != "letter");
        let in_between = plain.and_then(|row| numbered(name, &row.name));
        let prefixes = to.classes().iter().map(|row| row.name.as_str());
        names.of_words.contains(name)
            || in_between.is_some_and(|number| names.scratch.contains(&number))
            || prefixes.into_iter().any(|prefix| {
                let number = numbered(name, prefix);
                number.is_some_and(|number| of_words && to.is_in_use(prefix, number))
            })
    };
    let found = all.into_iter().find(|name| {
        let (before, after) = (began.get(*name).copied(), run.variables.get(*name).copied());
        if before == after {
            return false;
        }
        let nullable = class_of(to, name).is_some_and(|class| class.nullable);
        let value = |held: Option<f64>| held.or((!nullable).then_some(0.0));
        value(before) != value(after)
            && class_of(to, name).is_some_and(|class| class.class != "local")
            && !is_scratch(name)
            && !names.is_named(name, to)
            && names.of_source(name, from, to).is_none()
    })?;
    Some(format!("the target writes {found}, which holds no variable of the source"))
}
