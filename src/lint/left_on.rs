//! What is still in force where a program ends the run: the next program begins in it.

use super::looked::{Findings, Looked, end_of};
use super::state::{Kept, Known, Noted, On};
use crate::diag::Code;
use crate::dialect::Question;
use crate::ir::Block;

/// Looks at an end of the run.
pub(super) fn at_end(looked: &Looked<'_>, at: usize, block: &Block, known: &Known, noted: &mut Vec<Noted>) {
    let Some(program) = looked.module.programs.get(at) else { return };
    for kept in Kept::ALL {
        let On::Yes(_, by, span) = known.is_on(kept) else { continue };
        let Some((code, what)) = what(looked, kept) else { continue };
        let line = looked.line(by, span);
        let place =
            if by == at { format!("line {line}") } else { format!("{}, line {line}", looked.shown(by)) };
        let message = format!("{what} is still in force at the end of the program ({place})");
        noted.push(Noted { code, file: program.file, span: end_of(program, block), message });
    }
}

fn what(looked: &Looked<'_>, kept: Kept) -> Option<(Code, &'static str)> {
    let control = looked.control;
    Some(match kept {
        Kept::RadiusComp => (Code::RadiusLeftOn, "cutter compensation"),
        Kept::Cycle => (Code::CycleLeftOn, "a drilling cycle"),
        Kept::Rotation => (Code::FrameLeftOn, "a rotation"),
        Kept::Scaling => (Code::FrameLeftOn, "a scaling"),
        Kept::Mirror => (Code::FrameLeftOn, "a mirror image"),
        Kept::Shift if control.is(Question::EndClearsLocal) => return None,
        Kept::Shift => (Code::FrameLeftOn, "a shift of the zero"),
        Kept::Distance => (Code::IncrementalLeftOn, "the incremental mode"),
        Kept::Length if control.is(Question::EndCancelsLength) => return None,
        Kept::Length => (Code::LengthLeftOn, "a tool length"),
        Kept::ModalCall => (Code::ModalCallLeftOn, "a modal call"),
    })
}

/// Tells what was noted for a rule.
pub(super) fn said(looked: &Looked<'_>, code: Code, findings: &mut Findings) {
    for note in looked.noted().iter().filter(|note| note.code == code) {
        findings.add(note.file, note.code, note.span, note.message.as_str());
    }
}

macro_rules! rules {
    ($($name:ident $code:ident)*) => { $(
        pub(super) fn $name(looked: &Looked<'_>, findings: &mut Findings) {
            said(looked, Code::$code, findings);
        }
    )* };
}

rules! {
    radius RadiusLeftOn
    cycle CycleLeftOn
    frame FrameLeftOn
    incremental IncrementalLeftOn
    length LengthLeftOn
    modal_call ModalCallLeftOn
}
