//! The way of a rotary axis whose words have the sign of their way.
//!
//! Under G90 the number is a place within one turn. The sign is the way there: with a minus the negative way, else the positive one.
//! An axis that is there already stays.

use super::Machine;
use super::command::is_rotary;

/// Nearer than this an axis is at a place: less than a least increment.
const THERE: f64 = 1e-6;

impl Machine {
    /// Where an axis that stands at `from` goes by a word, which may be a way by itself; `zero` is where its zero lies.
    pub(super) fn by_word(&self, axis: usize, from: f64, (word, by_itself): (f64, bool), zero: f64) -> f64 {
        match is_rotary(axis) && self.rules.turns_by_sign {
            _ if self.incremental || by_itself => from + word,
            true if word == 0.0 && !self.rules.zero_has_sign => by_sign(from, 0.0, zero),
            true => by_sign(from, word, zero),
            false => word + zero,
        }
    }
}

/// The same, where the sign of the word is the way.
fn by_sign(from: f64, word: f64, zero: f64) -> f64 {
    let place = word.abs() + zero;
    let ahead = (place - from).rem_euclid(360.0);
    if ahead < THERE || 360.0 - ahead < THERE {
        // The same place, some whole turns on.
        return place + 360.0 * ((from - place) / 360.0).round();
    }
    let ahead = if word.is_sign_negative() { ahead - 360.0 } else { ahead };
    place + 360.0 * ((from + ahead - place) / 360.0).round()
}

#[cfg(test)]
mod tests {
    use super::by_sign;

    /// The examples of the manual: from A0 `A-90.` goes three quarters back, and after `A90.` an `A-0` goes back.
    #[test]
    fn the_sign_is_the_way() {
        for (from, word, to) in [
            (0.0, 90.0, 90.0),
            (0.0, -90.0, -270.0),
            (90.0, -0.0, 0.0),
            (90.0, 0.0, 360.0),
            (90.0, 45.0, 405.0),
            (90.0, -45.0, 45.0),
            (405.0, 90.0, 450.0),
            (90.0, 90.0, 90.0),
            (-270.0, -90.0, -270.0),
            (0.0, 450.0, 90.0),
        ] {
            assert_eq!(by_sign(from, word, 0.0), to, "{from} {word}");
        }
        assert_eq!(by_sign(10.0, 0.0, 10.0), 10.0);
        assert_eq!(by_sign(10.0, -80.0, 10.0), -270.0);
    }
}
