//! Jumps and the labels they name, for controls without loops of their own.

use super::support::fault;
use super::{Block, Item, ItemKind, Label, SyntaxError, Target, for_each_item};
use crate::diag::Code;
use crate::text::Span;
use std::collections::{HashMap, HashSet};

/// What a jump can name.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Place {
    Sequence(u32),
    Label(Label),
}

impl Place {
    fn words(&self) -> String {
        match self {
            Place::Sequence(number) => format!("N{number}"),
            Place::Label(Label::Number(number)) => format!("${number}"),
            Place::Label(Label::Name(name)) => format!(":{name}"),
        }
    }
}

/// Finds jumps to nowhere, and labels that stand twice and are jumped to, program by
/// program: a program ends where the next one begins, or at `%`. `call` names the label
/// that the words of a block jump to or call, where they do.
///
/// A program with a block that could not be read may hold any label there, so that
/// nothing is said of missing ones.
pub(super) fn check_targets(
    blocks: &[Block],
    call: fn(&[Item]) -> Option<(Label, Span)>,
) -> Vec<SyntaxError> {
    let mut errors = Vec::new();
    let mut program = Program::default();
    for block in blocks {
        let begins = |item: &Item| matches!(item.kind, ItemKind::Program(_) | ItemKind::Tape);
        if block.items.iter().any(begins) {
            std::mem::take(&mut program).finish(&mut errors);
        }
        for_each_item(&block.items, &mut |item| program.add(item));
        program.jumps.extend(call(&block.items).map(|(label, span)| (Place::Label(label), span)));
    }
    program.finish(&mut errors);
    errors.sort_by_key(|error| error.span.start);
    errors
}

#[derive(Default)]
struct Program {
    places: HashSet<Place>,
    /// Where a place stands again, by its name.
    again: HashMap<Place, Vec<Span>>,
    jumps: Vec<(Place, Span)>,
    has_gaps: bool,
}

impl Program {
    fn add(&mut self, item: &Item) {
        match &item.kind {
            ItemKind::Unparsed => self.has_gaps = true,
            ItemKind::Sequence { number, inserted: false } => self.stand(Place::Sequence(*number), item.span),
            ItemKind::Label(label) => self.stand(Place::Label(label.clone()), item.span),
            ItemKind::Goto(target) | ItemKind::Branch { target, .. } => {
                let place = match target {
                    Target::Sequence(number) => Place::Sequence(*number),
                    Target::Label(label) => Place::Label(label.clone()),
                    Target::Computed(_) => return,
                };
                self.jumps.push((place, item.span));
            }
            _ => {}
        }
    }

    fn stand(&mut self, place: Place, span: Span) {
        if self.places.contains(&place) {
            self.again.entry(place).or_default().push(span);
        } else {
            self.places.insert(place);
        }
    }

    fn finish(mut self, errors: &mut Vec<SyntaxError>) {
        for (place, span) in &self.jumps {
            if !self.places.contains(place) && !self.has_gaps {
                let message = format!("{} does not stand in this program", place.words());
                errors.push(fault(Code::MissingTarget, *span, message));
            }
            for span in self.again.remove(place).into_iter().flatten() {
                let message = format!("{} stands before already; a jump goes to the first", place.words());
                errors.push(fault(Code::DuplicateTarget, span, message));
            }
        }
    }
}
