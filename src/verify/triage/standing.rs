//! Whether the spindle stands at stops of the source, as a conversion supposes that starts nothing again after them.

use super::assumed::Held;
use crate::control::trace::{EventKind, Spindle};
use crate::control::{ProgramRef, Run};
use crate::text::Span;
use crate::verify::sides::Side;

/// What a run shows of the spindle at the stops of some blocks.
pub(super) fn stands(run: &Run, (side, program): (&Side<'_>, ProgramRef), places: &[Span]) -> Held {
    let (mut held, mut turns) = (Held::Untried, false);
    for (at, event) in run.events.iter().enumerate() {
        let block = event.at.span;
        let here = |place: &Span| block.start <= place.start && place.start < block.end.max(block.start + 1);
        match event.what {
            EventKind::Spindle { direction, .. } => {
                turns = matches!(direction, Spindle::Clockwise | Spindle::CounterClockwise);
            }
            EventKind::Stop
            | EventKind::OptionalStop
            | EventKind::Message { .. }
            | EventKind::Asked { .. }
                if places.iter().any(here) && side.links().at(run, event.at.program) == Some(program) =>
            {
                if turns {
                    let other = run.events.iter().take(at).rposition(|event| event.at.span != block);
                    let before = other.map_or(0, |last| last + 1);
                    return Held::Broken { before, what: "comes to a stop with the spindle on".into() };
                }
                held = Held::Kept;
            }
            _ => {}
        }
    }
    held
}
