//! What interpreters make of a control and of programs before they run them: made once for all runs of a library.

use super::library::Library;
use crate::dialect::Control;
use std::any::Any;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

/// Blocks of programs that are kept for a library, at the most: some 100 MB.
const MOST: usize = 200_000;

/// Something of a type that its interpreter knows.
type Held = OnceLock<Box<dyn Any + Send + Sync>>;

/// The programs of a library as they are run, by their places.
type Programs<P> = Vec<OnceLock<P>>;

/// What is kept for the control that a library is bound to.
#[derive(Debug)]
pub struct Shelf {
    held: Held,
    /// Blocks that may still be kept.
    room: AtomicUsize,
}

impl Default for Shelf {
    fn default() -> Self {
        Self { held: Held::new(), room: AtomicUsize::new(MOST) }
    }
}

/// What is kept for a program that was edited.
#[derive(Clone, Debug, Default)]
pub struct EditedShelf(Arc<Held>);

/// The answers of a control's table, and its programs.
struct Store<R, P> {
    rules: R,
    programs: Programs<P>,
}

/// What a run finds of what other runs made.
pub struct Kept<'k, R, P> {
    /// The answers of the control's table.
    pub rules: &'k R,
    /// None where the library is bound to no control, or to another.
    programs: Option<(&'k Programs<P>, &'k AtomicUsize)>,
    edited: Option<(usize, &'k OnceLock<P>)>,
    /// Those of this run alone.
    own: &'k OnceLock<Programs<P>>,
    count: usize,
}

/// Calls an interpreter with what is kept for a library; where nothing can be, with what is its own.
pub fn with_kept<R, P, T>(
    library: &Library<'_>,
    control: &Control,
    rules: impl Fn() -> R,
    run: impl FnOnce(Kept<'_, R, P>) -> T,
) -> T
where
    R: Send + Sync + 'static,
    P: Send + Sync + 'static,
{
    let (own, count) = (OnceLock::new(), library.sections.all().len());
    let shelf = library.shelf(control);
    let store = shelf.and_then(|shelf| {
        let made = || Box::new(Store::<R, P> { rules: rules(), programs: slots(count) });
        shelf.held.get_or_init(|| made()).downcast_ref::<Store<R, P>>()
    });
    let (Some(shelf), Some(store)) = (shelf, store) else {
        return run(Kept { rules: &rules(), programs: None, edited: None, own: &own, count });
    };
    let edited = library.edited_shelf().and_then(|(place, shelf)| {
        let slot = shelf.0.get_or_init(|| Box::new(OnceLock::<P>::new()));
        Some((place, slot.downcast_ref::<OnceLock<P>>()?))
    });
    let programs = Some((&store.programs, &shelf.room));
    run(Kept { rules: &store.rules, programs, edited, own: &own, count })
}

fn slots<P>(count: usize) -> Programs<P> {
    std::iter::repeat_with(OnceLock::new).take(count).collect()
}

impl<'k, R, P> Kept<'k, R, P> {
    /// The program at a place, which has so many blocks; it is made where no run came to it before.
    pub fn program(&self, place: usize, blocks: usize, make: impl FnOnce() -> P) -> Option<&'k P> {
        if let Some((_, slot)) = self.edited.filter(|(edited, _)| *edited == place) {
            return Some(slot.get_or_init(make));
        }
        if let Some((programs, room)) = self.programs {
            let slot = programs.get(place)?;
            let left = |room: usize| room.checked_sub(blocks);
            let is_kept = slot.get().is_some();
            if is_kept || room.fetch_update(Ordering::Relaxed, Ordering::Relaxed, left).is_ok() {
                return Some(slot.get_or_init(make));
            }
        }
        Some(self.own.get_or_init(|| slots(self.count)).get(place)?.get_or_init(make))
    }
}

#[cfg(test)]
mod tests {
    use crate::control::{Library, LoadedFile, ProgramRef, Run, Scenario};
    use crate::dialect::Control;
    use crate::syntax::parse_file;

    const TEXT: &str = "O1\n#500=1\nM98 P2\nM30\nO2\nIF[#500EQ1]GOTO9\n#501=7\nN9 M99\n";

    /// Runs O1 of a library again and again; the final values of #500 and #501, and which ways branches went.
    fn values(library: &Library<'_>, control: &Control) -> (Option<f64>, Option<f64>, usize) {
        let execute = control.entry().execute.unwrap();
        let run: Run = execute(library, ProgramRef::FIRST, control, &Scenario::default());
        let value = |name: &str| run.variables.get(name).copied();
        (value("#500"), value("#501"), run.branches.iter().count())
    }

    #[test]
    fn a_program_that_is_kept_runs_as_one_that_is_not_and_an_edited_one_as_it_is_edited() {
        let controls = ["fanuc", "haas"].map(|name| Control::plain(name).unwrap());
        let parse = controls[0].entry().parse;
        let (parsed, edited) = (parse_file(TEXT.as_bytes(), parse), TEXT.replacen("=1", "=2", 1));
        let edited = parse_file(edited.as_bytes(), parse);
        let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
        let free = Library::new(&files);
        let bound = Library::new(&files).bound_to(&controls[0]);
        for _ in 0..2 {
            assert_eq!(values(&free, &controls[0]), (Some(1.0), None, 1));
            assert_eq!(values(&bound, &controls[0]), (Some(1.0), None, 1));
            // Another control than the one it is bound to.
            assert_eq!(values(&bound, &controls[1]), (Some(1.0), None, 1));
            let other = bound.edited(ProgramRef::FIRST, &edited.blocks[..4], edited.source).unwrap();
            assert_eq!(values(&other, &controls[0]), (Some(2.0), Some(7.0), 1));
            assert_eq!(values(&other, &controls[1]), (Some(2.0), Some(7.0), 1));
        }
        // What is no such program any more is none.
        assert!(bound.edited(ProgramRef::FIRST, &edited.blocks, edited.source).is_none());
        assert!(bound.edited(ProgramRef::FIRST, &edited.blocks[1..4], edited.source).is_none());
    }
}
