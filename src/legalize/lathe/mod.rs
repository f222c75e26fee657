//! Lathes: cycles in one block or two, contours, holes, increments, machine coordinates, units, and programs of the other kind of machine.

mod contour_starts;
pub mod contours;
pub mod corners;
pub mod counts;
mod cycle_values;
pub mod cycle_words;
mod drawn_lines;
pub mod faces;
pub mod hole_codes;
pub mod hole_returns;
pub mod holes;
pub mod interpolations;
pub mod lone_steps;
pub mod other_kind;
pub mod place;
pub mod rapid_in_force;
pub mod roughing;
mod setting_values;
pub mod settings;
pub mod steps;
pub mod straight;
pub mod tap_feeds;
pub mod thread_form;
pub mod thread_passes;
pub mod threads;
pub mod written_corners;
pub mod x_counts;
