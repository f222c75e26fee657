//! Lathes: cycles in one block or two, contours, increments, machine coordinates, units, and programs of the other kind of machine.

pub mod contours;
pub mod corners;
pub mod counts;
mod cycle_values;
pub mod cycle_words;
pub mod other_kind;
pub mod place;
pub mod rapid_in_force;
pub mod roughing;
pub mod settings;
pub mod spring_passes;
pub mod steps;
pub mod straight;
pub mod thread_form;
pub mod unit_agrees;
pub mod x_counts;
