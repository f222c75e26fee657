//! How near a run came to the ways that its branches did not go.
//!
//! The distance to a way is by how much the numbers differ that the condition holds against each other. It steers the
//! search for scenarios, and nothing is proved by it.

use super::Place;
use std::collections::BTreeMap;

/// For each branch and way not gone (0 for false, 1 for true) the least distance.
pub type Nearest = BTreeMap<(Place, i64), f64>;

/// The distances of a run.
#[derive(Clone, Debug, Default)]
pub struct Nearness {
    nearest: Nearest,
    /// The distances of the comparisons of one branch: of those that failed, and of those that held.
    sums: [Option<f64>; 2],
    /// True once a branch was decided by these; the next comparison begins anew.
    decided: bool,
}

impl Nearness {
    /// Notes a comparison of two numbers.
    pub fn compared(&mut self, a: f64, b: f64, holds: bool) {
        if std::mem::take(&mut self.decided) {
            self.sums = [None; 2];
        }
        let distance = (a - b).abs();
        let distance = if distance.is_finite() { distance } else { f64::MAX };
        let sum = &mut self.sums[usize::from(holds)];
        *sum = Some((sum.unwrap_or(0.0) + distance).min(f64::MAX));
    }

    /// Notes the way that a branch went by the comparisons before it: those that agree with it keep it from the other way.
    pub fn branched(&mut self, at: Place, holds: bool) {
        self.decided = true;
        let [same, other] = if holds { [1, 0] } else { [0, 1] };
        if let Some(distance) = self.sums[same].or(self.sums[other]) {
            let nearest = self.nearest.entry((at, i64::from(!holds))).or_insert(f64::MAX);
            *nearest = nearest.min(distance);
        }
    }

    /// What was found.
    pub fn end(self) -> Nearest {
        self.nearest
    }
}
