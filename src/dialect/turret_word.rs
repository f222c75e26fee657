//! How many of the digits of a lathe's T word are the offset.

use super::{Control, Question};

/// The setting that says it.
const DIGITS: &str = "setting.offset_digits";

/// What stands before an offset of three digits that two cannot hold, in the common form.
const LONG: f64 = 1e6;

/// The division of a T word: the last digits are the offset, those before them the station.
///
/// In common terms a T word is 100 times the station, plus the offset. An offset over 99 does not fit into that: the common
/// number is then 1000000 and 1000 times the station, plus the offset.
#[derive(Clone, Copy, Debug)]
pub struct TurretWord {
    digits: u32,
    /// True where the profile says it.
    stated: bool,
    /// True where the control has the setting.
    open: bool,
    /// What a word says that has digits for the offset alone.
    short: Short,
}

/// What a T word says that has no digits for a station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Short {
    /// The offset; the turret stays. So it is taken where nobody says it.
    Offset,
    /// The station and the offset of the same number.
    Both,
    /// The station, without an offset.
    Station,
}

impl TurretWord {
    /// True where a setting that the profile does not give says which digits are the offset.
    pub fn is_open(self) -> bool {
        self.open && !self.stated
    }

    /// Why a word cannot be divided: written with so many digits that nobody says whose they are, or with more than a station
    /// has.
    pub fn fault(self, written: u16, value: f64) -> Option<&'static str> {
        let zero = written == 3 && value > 0.0 && value < 100.0;
        let odd = (written > 4 || zero) && !self.stated;
        let long = value >= 10f64.powi(self.digits as i32 + 2);
        match (odd || long, self.open) {
            (false, _) => None,
            (true, true) => Some(OPEN),
            (true, false) => Some(OTHER),
        }
    }

    /// True where the word is the same number in common terms, also where it is computed.
    pub fn is_plain(self) -> bool {
        self.digits == 2 && self.short == Short::Offset
    }

    /// The word in common terms.
    pub fn read(self, value: f64) -> f64 {
        let size = 10f64.powi(self.digits as i32);
        let (station, offset) = match self.short {
            Short::Both if value < size => (value, value),
            Short::Station if value < size => (value, 0.0),
            _ => ((value / size).floor(), value % size),
        };
        if offset < 100.0 { station * 100.0 + offset } else { LONG + station * 1000.0 + offset }
    }

    /// The digits for a word in common terms, unless its offset has more of them than the machine takes, or it has
    /// no station and would turn the turret.
    pub fn written(self, common: f64) -> Option<String> {
        let (station, offset) = apart(common);
        let digits = self.digits as usize;
        let whole = common.fract() == 0.0 && common >= 0.0;
        let turns = station == 0.0 && offset != 0.0 && self.short != Short::Offset;
        let fits = whole && !turns && offset < 10f64.powi(self.digits as i32);
        fits.then(|| match station {
            0.0 => format!("{offset}"),
            station => format!("{station:02}{offset:0digits$}"),
        })
    }
}

/// Station and offset of a T word in common terms.
pub fn apart(common: f64) -> (f64, f64) {
    match common {
        long if long >= LONG => (((long - LONG) / 1000.0).floor(), (long - LONG) % 1000.0),
        common => ((common / 100.0).floor(), common % 100.0),
    }
}

impl Control {
    /// How a T word of a lathe is divided.
    pub fn turret_word(&self) -> TurretWord {
        let digits =
            self.setting(DIGITS).and_then(|value| value.parse().ok()).filter(|d| (1..=3).contains(d));
        let stated = self.profile().settings.contains_key("offset_digits");
        let short = match self.behaviour(Question::TurretShort).map(|row| row.value.as_str()) {
            Some("both") => Short::Both,
            Some("station") => Short::Station,
            _ => Short::Offset,
        };
        TurretWord { digits: digits.unwrap_or(2), stated, open: self.setting_row(DIGITS).is_some(), short }
    }
}

const OPEN: &str = "a T word with this many digits: which of them are the offset depends on the machine; say 'offset_digits' \
                    under [settings] of its profile (1, 2 or 3)";
const OTHER: &str = "a T word of this control has two digits for the station and two for the offset";

#[cfg(test)]
mod tests {
    use super::*;

    /// `T02102` of a machine with three digits for the offset is station 2 with offset 102, `T11011` station 11 with offset 11.
    #[test]
    fn the_last_digits_are_the_offset() {
        let three = TurretWord { digits: 3, stated: true, open: true, short: Short::Offset };
        let two = TurretWord { digits: 2, stated: false, open: true, short: Short::Offset };
        let one = TurretWord { digits: 1, stated: true, open: true, short: Short::Offset };
        for (written, station, offset) in [("11011", 11.0, 11.0), ("02102", 2.0, 102.0), ("01001", 1.0, 1.0)]
        {
            let common = three.read(written.parse().unwrap());
            assert_eq!(apart(common), (station, offset));
            assert_eq!(three.written(common).as_deref(), Some(written));
        }
        assert_eq!(two.written(three.read(11_011.0)).as_deref(), Some("1111"));
        assert_eq!(two.written(three.read(2102.0)), None);
        assert_eq!(one.read(11.0), 101.0);
        assert_eq!(one.written(101.0).as_deref(), Some("011"));
        assert_eq!(one.written(1212.0), None);
        assert!(
            two.fault(4, 101.0).is_none() && two.fault(3, 101.0).is_none() && two.fault(3, 0.0).is_none()
        );
        assert!(two.fault(5, 1001.0).is_some() && two.fault(3, 11.0).is_some());
        let both = TurretWord { short: Short::Both, ..two };
        assert_eq!(
            (both.read(2.0), both.read(33.0), both.read(0.0), both.read(305.0)),
            (202.0, 3333.0, 0.0, 305.0)
        );
        assert_eq!((both.written(202.0).as_deref(), both.written(2.0)), (Some("0202"), None));
        let station = TurretWord { short: Short::Station, ..two };
        assert_eq!((station.read(2.0), station.written(2.0)), (200.0, None));
        assert!(two.is_plain() && !both.is_plain());
        assert!(three.fault(5, 1001.0).is_none() && three.fault(6, 101_001.0).is_some());
    }
}
