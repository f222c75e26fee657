//! Places in machine coordinates of the machine that programs come from, and where each lies on this one.
//!
//! A profile says it as `machine_places = ["X-11. Z-13. as X-300. Z-200."]`: the words of a move in machine coordinates as the programs
//! have them, and the words that the programs get. Both are in the unit that `units` of the profile says.

use super::overlay::Overlay;
use super::{Control, Units};
use crate::canon::Role;

/// What stands between a place of the source and its place here.
const AS: &str = " as ";

/// Axes and where they go, in the order they were written in.
pub type Place = Vec<(Role, f64)>;

/// Places of the source, and where each lies here.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MachinePlaces {
    rows: Vec<(Place, Place)>,
    /// True where the numbers are inches, false where they are millimetres; none if the profile names no unit.
    inch: Option<bool>,
}

impl MachinePlaces {
    /// Where a place of the source lies here: of a move of these axes, and no others, to these numbers, in a program of that unit.
    /// The same numbers in the other unit are another place.
    pub fn of(&self, place: &[(Role, f64)], inch: Option<bool>) -> Option<&[(Role, f64)]> {
        let other = self.inch.zip(inch).is_some_and(|(own, of_program)| own != of_program);
        let (_, here) = self.rows.iter().filter(|_| !other).find(|(there, _)| is_same(there, place))?;
        Some(here)
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// True if two name the same axes and numbers, in any order.
fn is_same(a: &[(Role, f64)], b: &[(Role, f64)]) -> bool {
    let has = |(role, number): &(Role, f64)| b.iter().any(|(r, n)| r == role && (n - number).abs() < CLOSE);
    a.len() == b.len() && a.iter().all(has)
}

/// Numbers this close are one: no control counts finer.
const CLOSE: f64 = 1e-7;

/// `X-11. Z-13. as X-300. Z-200.`
fn read(text: &str) -> Option<(Place, Place)> {
    let (there, here) = text.split_once(AS)?;
    Some((words(there)?, words(here)?))
}

/// The words of a place; none if they are no words of axes, or one axis stands twice.
fn words(text: &str) -> Option<Place> {
    let mut place = Place::new();
    for word in text.split_whitespace() {
        let mut letters = word.chars();
        let role = match letters.next()?.to_ascii_uppercase() {
            'X' => Role::X,
            'Y' => Role::Y,
            'Z' => Role::Z,
            'A' => Role::A,
            'B' => Role::B,
            'C' => Role::C,
            _ => return None,
        };
        let number = letters.as_str();
        let plain = number.bytes().all(|sign| sign.is_ascii_digit() || matches!(sign, b'.' | b'-' | b'+'));
        let number: f64 = number.parse().ok().filter(|number: &f64| plain && number.is_finite())?;
        if place.iter().any(|(named, _)| *named == role) {
            return None;
        }
        place.push((role, number));
    }
    (!place.is_empty()).then_some(place)
}

impl Overlay {
    /// The places of other machines that the profile says to lie elsewhere on this one.
    pub(super) fn machine_places(&mut self) -> MachinePlaces {
        let inch = self.profile.units.map(|units| units == Units::Inch);
        let mut all = MachinePlaces { inch, ..MachinePlaces::default() };
        for text in self.profile.machine_places.clone() {
            let (message, help) = match read(&text) {
                None => (
                    format!("'{text}' is not a place and where it lies here"),
                    "write 'X-11. Z-13. as X-300. Z-200.': the words of the old machine, and those of this one",
                ),
                Some((there, here)) if all.of(&there, None).is_some_and(|other| !is_same(other, &here)) => {
                    (format!("'{text}' contradicts what stands before it"), "name each place once")
                }
                Some(row) => {
                    all.rows.push(row);
                    continue;
                }
            };
            self.fault(&format!("machine_places:{text}"), message, help.into());
        }
        all
    }
}

impl Control {
    /// Where places of other machines lie on this one.
    pub fn machine_places(&self) -> &MachinePlaces {
        &self.machine_places
    }

    /// Where its own places lie on the machine that its programs go to; none if that is not known, or they go to none.
    pub fn places_there(&self) -> &MachinePlaces {
        &self.places_there
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(entry: &str) -> String {
        let text = format!("dialect = \"haas\"\nmachine_places = [{entry}]\n");
        let faults = Control::from_profile(&text).expect_err("a fault");
        super::super::faults_as_text("p.toml", &text, &faults).lines().next().unwrap_or_default().to_owned()
    }

    #[test]
    fn a_place_is_named_by_its_axes_and_numbers_in_any_order() {
        let text =
            "dialect = \"haas\"\nmachine_places = [\"X-11. Z-13. as Z-200. X-300.5\", \"Y0 as Y-10\"]\n";
        let control = Control::from_profile(text).expect("a profile");
        let places = control.machine_places();
        let here = [(Role::Z, -200.0), (Role::X, -300.5)];
        assert_eq!(places.of(&[(Role::Z, -13.0), (Role::X, -11.0)], None), Some(&here[..]));
        assert_eq!(places.of(&[(Role::Y, 0.0)], Some(true)), Some(&[(Role::Y, -10.0)][..]));
        assert_eq!(places.of(&[(Role::X, -11.0)], None), None);
        assert_eq!(places.of(&[(Role::X, -11.0), (Role::Z, -13.0), (Role::Y, 0.0)], None), None);
        assert_eq!(places.of(&[(Role::X, -11.001), (Role::Z, -13.0)], None), None);
        assert!(control.places_there().is_empty());
        let metric = Control::from_profile(&format!("units = \"metric\"\n{text}")).expect("a profile");
        let at = |inch| metric.machine_places().of(&[(Role::Y, 0.0)], inch).is_some();
        assert!(at(Some(false)) && at(None) && !at(Some(true)));
    }

    #[test]
    fn what_is_no_place_is_a_fault() {
        let no_place =
            |entry: &str| format!("p.toml:2:19: MG0203: '{entry}' is not a place and where it lies here");
        for entry in ["X-11.", "X-11. as", "X-11. as U2.", "X1 X2 as X3", "Xnan as X1", "X1e3 as X1", "x"] {
            assert!(
                fault(&format!("\"{entry}\"")).starts_with(&no_place(entry)),
                "{}",
                fault(&format!("\"{entry}\""))
            );
        }
        let twice = fault("\"X1 as X2\", \"X1. as X3\"");
        assert!(twice.contains("'X1. as X3' contradicts what stands before it"), "{twice}");
    }
}
