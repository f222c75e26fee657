//! Settings of lathes that more than one module asks: the place of the second reference position of other lathes, and the letters of increments.

use super::{Control, Units};
use crate::canon::Act;

/// The settings that give it along X and Z, in machine coordinates and the unit of the control.
pub const SECOND_HOME: [&str; 2] = ["setting.second_home_x", "setting.second_home_z"];

/// The setting that says whether U, V, W and H are increments in G code systems that have modes for them.
pub const STEP_LETTERS: &str = "setting.step_letters";

/// The setting that says which M code clamps the C axis for the hole of its block; the code of the next number lets it go.
pub const HOLE_CLAMP: &str = "parameter.5110";

impl Control {
    /// What clamps the C axis in a drilling block, and what lets it go after the hole, as far as the profile names them.
    pub fn hole_clamp(&self) -> [Option<Act>; 2] {
        let number = self.setting(HOLE_CLAMP).and_then(|text| text.trim().parse::<u32>().ok());
        [0, 1].map(|more| {
            let code = f64::from(number?.checked_add(more)?);
            self.site_code('M', code).and_then(|site| self.act_of(site))
        })
    }

    /// The place along X and Z as far as the profile gives it: millimetres of machine coordinates, X a diameter.
    pub fn second_home(&self) -> [Option<f64>; 2] {
        let unit = if self.units() == Some(Units::Inch) { 25.4 } else { 1.0 };
        SECOND_HOME.map(|name| {
            let stated = self.setting(name)?.parse::<f64>().ok();
            stated.filter(|place| place.is_finite()).map(|place| place * unit)
        })
    }
}
