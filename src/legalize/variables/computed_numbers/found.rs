//! What the conversion supposes of computed numbers.

use super::Finding;
use crate::assume::{self, Predicate, Subscripts};
use crate::ir::analysis::Numbers;
use crate::text::Span;

/// What is known of computed numbers that are alike in that.
#[derive(Debug)]
pub struct Found {
    pub finding: Finding,
    /// Where they stand.
    pub places: Vec<Span>,
    /// Their constant parts.
    pub bases: Vec<f64>,
    /// Numbers that others at these places are known to be.
    pub sure: Numbers,
}

impl Found {
    /// Adds a computed number to those of a program.
    pub fn note(all: &mut Vec<Self>, finding: Finding, place: Span, base: f64) {
        match all.iter_mut().find(|other| other.finding == finding) {
            Some(other) => {
                other.places.push(place);
                if let Err(at) = other.bases.binary_search_by(|other| other.total_cmp(&base)) {
                    other.bases.insert(at, base);
                }
            }
            None => {
                all.push(Self { finding, places: vec![place], bases: vec![base], sure: Numbers::default() })
            }
        }
    }

    /// That each of them is one of the `safe` numbers, which the conversion holds for.
    pub fn predicate(&self, safe: &Numbers) -> Predicate {
        let safe = assume::Numbers::new(safe.runs().iter().chain(self.sure.runs()).copied());
        let (places, bases) = (self.places.clone(), self.bases.clone());
        Predicate::Subscripts(Subscripts { places, safe, bases })
    }
}
