//! Where something happened in a run.

use crate::control::Run;
use crate::control::trace::Event;
use crate::verify::sides::Side;
use memchr::{memchr, memrchr};
use serde::Serialize;
use serde_json::Value;

/// A moment of a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Moment {
    /// The file.
    pub file: String,
    /// The program of it that ran, as its control names it.
    pub program: String,
    /// The line.
    pub line: u32,
    /// The block.
    pub block: String,
    /// What happened.
    pub event: Value,
}

impl Moment {
    /// Where an event happened.
    pub(in crate::verify) fn of(side: &Side<'_>, run: &Run, event: &Event) -> Self {
        let ran = run.programs.get(event.at.program as usize);
        let program = ran.map_or_else(String::new, |program| program.name.clone());
        let Some(file) = ran.and_then(|program| side.files.get(program.file)) else {
            let event = serde_json::to_value(&event.what).unwrap_or_default();
            return Self { file: String::new(), program, line: 0, block: String::new(), event };
        };
        let source = ran.and_then(|program| side.source(program.file)).unwrap_or_default();
        let place = event.at.span.start;
        let (line, _) = ran.map_or((1, 1), |ran| side.line_of(ran.file, place));
        let (before, behind) = source.split_at_checked(place as usize).unwrap_or((source, &[]));
        let start = memrchr(b'\n', before).map_or(0, |at| at + 1);
        let end = memchr(b'\n', behind).map_or(source.len(), |at| before.len() + at);
        let block = source.get(start..end).unwrap_or_default();
        Self {
            file: file.name.to_owned(),
            program,
            line,
            block: String::from_utf8_lossy(block).trim_end().to_owned(),
            event: serde_json::to_value(&event.what).unwrap_or_default(),
        }
    }
}
