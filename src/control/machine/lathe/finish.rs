//! A contour repeated nearer and nearer (N1 to N5), and finished (F1 to F4).

use super::contour::Contour;
use super::profile::Profile;
use super::way::Point;
use super::{Repeat, alarm, along};
use crate::canon::Role;
use crate::control::machine::{Command, Machine};
use crate::control::outcome::Stop;
use crate::control::trace::Trace;

/// Repeats the contour, each time nearer to it.
pub fn pattern(
    machine: &mut Machine,
    command: &Command,
    profile: &Profile,
    trace: &mut Trace,
) -> Result<(), Stop> {
    let unit = machine.unit();
    let length = |role| command.word(role).map(|value| value * unit);
    let told = if machine.rules.turning.two_blocks { machine.lathe.pattern } else { Repeat::default() };
    let [x, z, count] = machine.rules.turning.pattern;
    let stock = [told.x.or(length(Role::PatternX)).or(x), told.z.or(length(Role::PatternZ)).or(z)];
    let passes = told.passes.or(command.word(Role::Passes)).or(count);
    let passes =
        passes.ok_or_else(|| Stop::unnamed("a repeated contour without the number of its passes"))?;
    if passes <= 0.0 {
        return Err(alarm("PS0321", "a contour is repeated no times"));
    }
    let left = [length(Role::AllowanceX).unwrap_or(0.0) / 2.0, length(Role::AllowanceZ).unwrap_or(0.0)];
    let a = machine.tool_at();
    for pass in 1..=passes.round() as u32 {
        let part = if passes > 1.0 { (passes - f64::from(pass)) / (passes - 1.0) } else { 0.0 };
        let off: Point = std::array::from_fn(|axis| stock[axis].unwrap_or(0.0) * part + left[axis]);
        machine.go(true, [a[0] + off[0], a[1] + off[1]], trace);
        along::run(machine, profile, off, trace)?;
        if trace.is_full() {
            break;
        }
    }
    Ok(())
}

/// Goes along the contour itself; everything in its blocks counts.
pub fn finish(
    machine: &mut Machine,
    contour: &Contour,
    profile: &Profile,
    trace: &mut Trace,
) -> Result<(), Stop> {
    if profile.by_steps {
        // It counts from where this cycle began, which need not be where its roughing did (F4).
        trace.doubt("machine:lathe.contour.steps");
    }
    let here = trace.at;
    for (block, pieces) in contour.blocks.iter().zip(&profile.blocks) {
        let mut command = block.command.clone();
        command.words.retain(|(role, _)| !role.is_drawn());
        let moves = profile.pieces.get(pieces.clone()).filter(|pieces| !pieces.is_empty());
        machine.lathe.way = moves.map(<[_]>::to_vec);
        trace.at = block.at;
        machine.run(&command, trace)?;
        machine.lathe.way = None;
        if trace.is_full() {
            break;
        }
    }
    trace.at = here;
    Ok(())
}
