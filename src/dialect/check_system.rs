//! Checks of the system variables.

use super::SystemVariable;
use super::overlay::options_apart;
use super::reader::{Placed, Reader};

/// Runs are well formed and no two that can be present together share a number.
pub(super) fn check(reader: &mut Reader, rows: &[Placed<SystemVariable>]) {
    for (at, placed) in rows.iter().enumerate() {
        let row = &placed.row;
        if !matches!(row.access.as_str(), "r" | "w" | "rw") {
            reader.fault_at(
                placed.place.clone(),
                format!("unknown access '{}'", row.access),
                "it is r, w or rw",
            );
        }
        if row.first.is_none() && !row.subscripts.is_empty() {
            reader.fault_at(placed.place.clone(), "a run of variables has a first number", "add 'first'");
        }
        if row.subscripts.iter().any(|subscript| subscript.count == 0 || subscript.step == 0) {
            reader.fault_at(
                placed.place.clone(),
                "a subscript has no values",
                "write 'count' and 'step' of 1 or more",
            );
            continue;
        }
        if !decodable(row) {
            let help = "a step is at least the whole extent of the subscripts with smaller steps";
            reader.fault_at(placed.place.clone(), "two subscripts give the same number", help);
        }
        let twin = rows.iter().take(at).map(|earlier| &earlier.row).find(|earlier| shares(earlier, row));
        if let Some(twin) = twin {
            let message = format!("{} overlaps {} ({})", span(row), span(twin), twin.state);
            reader.fault_at(placed.place.clone(), message, "shorten one, or say 'machine' or 'when'");
        }
    }
}

/// True where a number has one set of subscripts.
fn decodable(row: &SystemVariable) -> bool {
    let mut steps: Vec<(u64, u64)> =
        row.subscripts.iter().map(|s| (u64::from(s.step), u64::from(s.count))).collect();
    steps.sort_unstable();
    let mut extent = 1;
    for (step, count) in steps {
        if step < extent {
            return false;
        }
        extent = step.saturating_mul(count - 1).saturating_add(extent);
    }
    extent <= u64::from(u32::MAX) / 2
}

fn span(row: &SystemVariable) -> String {
    match (row.first, row.last()) {
        (Some(first), Some(last)) if first != last => format!("{}{first}..{last}", row.name),
        (Some(first), _) => format!("{}{first}", row.name),
        _ => row.name.clone(),
    }
}

/// Two rows that can hold at once and have a variable in common. Runs may
/// interleave (#5201 and #5221 have gaps), so numbers are compared one by one.
fn shares(a: &SystemVariable, b: &SystemVariable) -> bool {
    let apart = |x: &Option<String>, y: &Option<String>| matches!((x, y), (Some(x), Some(y)) if x != y);
    let options = options_apart(a.option.as_ref(), b.option.as_ref());
    if a.name != b.name || apart(&a.machine, &b.machine) || apart(&a.when, &b.when) || options {
        return false;
    }
    match (a.first, a.last(), b.first, b.last()) {
        (Some(a_first), Some(a_last), Some(b_first), Some(b_last)) => {
            let (from, to) = (a_first.max(b_first), a_last.min(b_last));
            (from..=to).take(100_000).any(|n| a.subscripts_of(n).is_some() && b.subscripts_of(n).is_some())
        }
        (None, _, None, _) => true,
        _ => false,
    }
}

impl SystemVariable {
    /// The last number of the run.
    pub fn last(&self) -> Option<u32> {
        self.subscripts.iter().try_fold(self.first?, |last, subscript| {
            last.checked_add(subscript.step.checked_mul(subscript.count.checked_sub(1)?)?)
        })
    }

    /// The subscripts of the variable with this number, those that are constant
    /// included; none if the run does not hold it.
    pub fn subscripts_of(&self, number: u32) -> Option<Vec<u32>> {
        let mut rest = number.checked_sub(self.first?)?;
        if number > self.last()? {
            return None;
        }
        let mut order: Vec<usize> = (0..self.subscripts.len()).collect();
        order.sort_by_key(|&at| self.subscripts.get(at).map(|s| std::cmp::Reverse(s.step)));
        let mut found = vec![0; self.subscripts.len()];
        for at in order {
            let subscript = self.subscripts.get(at)?;
            let steps = rest.checked_div(subscript.step)?.min(subscript.count.checked_sub(1)?);
            rest -= steps * subscript.step;
            *found.get_mut(at)? = subscript.from + steps;
        }
        (rest == 0).then(|| [self.fixed.as_slice(), &found, &self.after].concat())
    }

    /// The number of the variable with these subscripts, constant ones included:
    /// `Some(None)` for a name without number; none if the run does not hold it.
    pub fn number_of(&self, subscripts: &[u32]) -> Option<Option<u32>> {
        let counted = subscripts.strip_prefix(self.fixed.as_slice())?.strip_suffix(self.after.as_slice())?;
        if counted.len() != self.subscripts.len() {
            return None;
        }
        let Some(first) = self.first else { return counted.is_empty().then_some(None) };
        let mut number = first;
        for (value, subscript) in counted.iter().zip(&self.subscripts) {
            let steps = value.checked_sub(subscript.from).filter(|steps| *steps < subscript.count)?;
            number = number.checked_add(steps.checked_mul(subscript.step)?)?;
        }
        Some(Some(number))
    }

    /// For the name of a run without its subscript, `_ABSIO` or `_WZG55`: what its first subscript adds to the number where
    /// the name has it, and which subscript stands in brackets.
    pub fn run_named(&self, name: &str) -> Option<(u32, usize)> {
        let own = self.alias.as_deref()?.strip_suffix("[n]")?;
        let Some((stem, first)) = own.split_once('{') else {
            return own.eq_ignore_ascii_case(name).then_some((0, 0));
        };
        let first: u32 = first.strip_suffix('}')?.parse().ok()?;
        let (start, digits) = name.split_at_checked(stem.len())?;
        let written = start.eq_ignore_ascii_case(stem) && digits.bytes().all(|byte| byte.is_ascii_digit());
        let at = written.then(|| digits.parse::<u32>().ok()).flatten()?.checked_sub(first)?;
        let outer = self.subscripts.first().filter(|outer| at < outer.count)?;
        Some((at.checked_mul(outer.step)?, 1))
    }
}
