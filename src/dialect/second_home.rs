//! The place that a profile gives for the second reference position of other lathes.

use super::{Control, Units};

/// The settings that give it along X and Z, in machine coordinates and the unit of the control.
pub const SECOND_HOME: [&str; 2] = ["setting.second_home_x", "setting.second_home_z"];

impl Control {
    /// The place along X and Z as far as the profile gives it: millimetres of machine coordinates, X a diameter.
    pub fn second_home(&self) -> [Option<f64>; 2] {
        let unit = if self.units() == Some(Units::Inch) { 25.4 } else { 1.0 };
        SECOND_HOME.map(|name| {
            let stated = self.setting(name)?.parse::<f64>().ok();
            stated.filter(|place| place.is_finite()).map(|place| place * unit)
        })
    }
}
