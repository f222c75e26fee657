//! Variables that stand under another name now.
//!
//! Blocks that are the same but for the names of their variables tell which old name became which new one. A name counts
//! as renamed where all such blocks agree, both ways, and the old name is used nowhere any more, and the new one nowhere
//! before, unless that was renamed in its turn.

use super::normal::Normal;
use super::result::Renamed;
use crate::dialect::Control;
use crate::verify::{SymbolMap, class_of};
use similar::{Algorithm, DiffOp, capture_diff_slices};
use std::collections::{BTreeMap, BTreeSet};

/// What blocks say of the names.
#[derive(Debug, Default)]
pub struct Votes {
    /// New names, by old ones.
    became: BTreeMap<String, BTreeSet<String>>,
    /// The other way.
    was: BTreeMap<String, BTreeSet<String>>,
    old: BTreeSet<String>,
    new: BTreeSet<String>,
}

impl Votes {
    /// Takes in a program of the old side and its counterpart; either may be missing.
    pub fn add(&mut self, old: &[Normal], new: &[Normal]) {
        let all = |blocks: &[Normal]| blocks.iter().flat_map(|b| b.variables.clone()).collect::<Vec<_>>();
        self.old.extend(all(old));
        self.new.extend(all(new));
        let bare = |blocks: &[Normal]| blocks.iter().map(|block| block.bare.clone()).collect::<Vec<_>>();
        for op in capture_diff_slices(Algorithm::Myers, &bare(old), &bare(new)) {
            let DiffOp::Equal { old_index, new_index, len } = op else { continue };
            for at in 0..len {
                let (a, b) = (&old[old_index + at].variables, &new[new_index + at].variables);
                for (a, b) in a.iter().zip(b) {
                    self.became.entry(a.clone()).or_default().insert(b.clone());
                    self.was.entry(b.clone()).or_default().insert(a.clone());
                }
            }
        }
    }

    /// The names that changed.
    pub fn renamed(&self, control: &Control) -> Vec<Renamed> {
        let one = |names: Option<&BTreeSet<String>>| {
            names.filter(|n| n.len() == 1).and_then(BTreeSet::first).cloned()
        };
        let pairs = self.became.keys().filter_map(|old| {
            let new = one(self.became.get(old)).filter(|new| new != old)?;
            (one(self.was.get(&new)).as_ref() == Some(old)).then(|| (old.clone(), new))
        });
        let mut pairs: BTreeMap<String, String> = pairs.collect();
        // What goes makes room for no other; so look again until nothing goes.
        loop {
            let news: BTreeSet<&String> = pairs.values().collect();
            let fits = |(old, new): &(&String, &String)| {
                (!self.new.contains(*old) || news.contains(old))
                    && (!self.old.contains(*new) || pairs.contains_key(*new))
            };
            let kept: BTreeMap<String, String> =
                pairs.iter().filter(fits).map(|(old, new)| (old.clone(), new.clone())).collect();
            if kept.len() == pairs.len() {
                break;
            }
            pairs = kept;
        }
        let class = |name: &str| class_of(control, name).map_or("", |class| class.class.as_str()).to_owned();
        let same_class = |(old, new): &(String, String)| class(old) == class(new) && class(old) != "system";
        let all = pairs.into_iter().filter(same_class).map(|(old, new)| {
            let local = class(&old) == "local";
            Renamed { old, new, local }
        });
        all.collect()
    }
}

/// Tells the verifier of the variables that keep their values from program to program.
pub fn name(map: &mut SymbolMap, renamed: &[Renamed], control: &Control) {
    let Some(prefix) = control.classes().iter().find(|row| row.class != "letter").map(|row| &row.name) else {
        return;
    };
    for one in renamed.iter().filter(|one| !one.local && one.old.starts_with(prefix.as_str())) {
        if let Some(number) = one.new.strip_prefix(prefix.as_str()).and_then(|digits| digits.parse().ok()) {
            map.variables.insert(one.old.clone(), number);
        }
    }
}
