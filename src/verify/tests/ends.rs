//! What is there after the end of a program.

use super::*;
use crate::control::scenario::{AXES, Axes, Tool};
use crate::verify::compare::{Tolerance, seen_differs};

/// A main program that ends in another mode, feed or shift does the same so far as anyone can tell who does not start
/// another one; a called program does something else.
#[test]
fn what_is_in_force_at_the_end_is_told_of_a_main_program() {
    for (behind, text) in [
        ("G91", "the exit state differs: it ends in distance.absolute, the target in distance.incremental"),
        ("G19", "the exit state differs: it ends in plane.xy, the target in plane.yz"),
        ("F200.", "the exit state differs: it ends with a feed of 100, the target with 200"),
        ("G52X1.", "the exit state differs: it ends with a different shift of coordinates"),
        ("G68X0Y0R10.", "the exit state differs: it ends with a different rotation of coordinates"),
    ] {
        let program = |behind: &str, end: &str| format!("O1\nG90G1X1.F100.\n{behind}\n{end}\n");
        let judge = |end: &str| within("fanuc", &program("", end), &program(behind, end));
        let found = judge("M30");
        assert_eq!(found.outcome, Outcome::Undecided, "{behind}: {:#?}", found.witness);
        let said =
            |reason: &crate::verify::Reason| reason.why == Why::Substituted && reason.text.starts_with(text);
        assert!(found.reasons.iter().any(said), "{behind}: {:#?}", found.reasons);
        assert_eq!(judge("M99").outcome, Outcome::Different, "{behind}");
    }
    let found = within("fanuc", "O1\nG90G1X1.F100.\nM30\n", "O1\nG90G1F100.X1.\nG90\nM30\n");
    assert!(found.reasons.iter().all(|reason| reason.why == Why::Unconfirmed), "{:#?}", found.reasons);
}

#[test]
fn what_a_person_sees_at_the_end_is_compared() {
    let control = Control::plain("fanuc").unwrap();
    let entry = registry::find("fanuc").unwrap();
    let parsed = parse_file(b"O1\nG90G0X1.\nM30\n", entry.parse);
    let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
    let side = Side::new(&control, entry.execute.unwrap(), &files);
    let run = (side.execute)(&side.library, side.programs()[0], &control, &Default::default());
    let ours = run.left.unwrap();
    let tolerance = Tolerance::of(&side, &side);
    let mut axes: Axes = [0.0; AXES];
    // An inch increment is 0.00254 mm, and a row that is not there holds zeros.
    let mut theirs = ours.clone();
    (axes[1], theirs.position[0]) = (0.002, theirs.position[0] + 0.002);
    theirs.work_offsets.insert(3, axes);
    theirs.tools.insert(7, Tool { radius: 0.002, ..Tool::default() });
    assert_eq!(seen_differs(&ours, &theirs, tolerance), None);
    theirs.tools.insert(7, Tool { radius: 0.003, ..Tool::default() });
    let found = seen_differs(&ours, &theirs, tolerance);
    assert_eq!(found.as_deref(), Some("tool offset 7 has another value at the end"));
    axes[1] = 0.003;
    theirs.work_offsets.insert(3, axes);
    let found = seen_differs(&ours, &theirs, tolerance);
    assert_eq!(found.as_deref(), Some("work offset 3 has another value at the end"));
    theirs.position[0] += 0.001;
    let found = seen_differs(&ours, &theirs, tolerance);
    assert_eq!(found.as_deref(), Some("the machine stands at another position at the end"));
}
