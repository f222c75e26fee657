//! What an answer rests on, as a hash: the text of the program and of all that it calls, what was asked, and both machines.
//!
//! The hash has two halves, so that it can be told which of the two changed: `program-machines`. No table of a control is
//! in it: a later macroglot, whose tables know more, asks again if it asks otherwise.

use super::entry::HALF;
use crate::dialect::Control;
use crate::ir::analysis::computed_calls::computed_calls;
use crate::ir::analysis::dataflow::reached;
use crate::ir::{Callee, Module, Program, TermKind};
use crate::legalize::calls_of;
use crate::library::{Input, understood};
use crate::text::{LineIndex, Lines, Span};
use crate::verify::sha256;
use std::collections::{BTreeMap, BTreeSet};

/// The programs of a library, with what each rests on.
pub struct Scopes {
    /// By file, its programs in their order.
    files: Vec<Vec<Scope>>,
    /// By file, all of it as one program.
    whole: Vec<Scope>,
    machines: String,
}

/// A program, with what it rests on.
#[derive(Clone, Debug)]
pub(super) struct Scope {
    /// The line that it begins on.
    pub line: u32,
    /// The hash of its text, and of the texts of all that it calls.
    rests_on: String,
}

impl Scopes {
    /// Of a library on its way from one machine to another.
    pub fn of(inputs: &[Input], source: &Control, target: &Control) -> Self {
        Self::of_module(&understood(inputs, source).module, inputs, [source, target])
    }

    /// Of a library that is lowered already.
    pub fn of_module(module: &Module, inputs: &[Input], machines: [&Control; 2]) -> Self {
        let texts = texts(module, inputs);
        let calls = calls(module);
        let mut files: Vec<Vec<Scope>> = vec![Vec::new(); inputs.len()];
        let mut of_files: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); inputs.len()];
        for (at, program) in module.programs.iter().enumerate() {
            let Some((line, text)) = texts.get(at) else { continue };
            let scope = Scope { line: *line, rests_on: rests_on(text, [at].into(), &calls, &texts, module) };
            files.get_mut(program.file).into_iter().for_each(|file| file.push(scope.clone()));
            of_files.get_mut(program.file).into_iter().for_each(|file| _ = file.insert(at));
        }
        let whole = inputs.iter().zip(of_files).map(|(input, programs)| Scope {
            line: 1,
            rests_on: rests_on(&hash_of_text(&input.bytes), programs, &calls, &texts, module),
        });
        let whole = whole.collect();
        let machines = machines.map(machine).join("\n");
        Self { files, whole, machines: half(&machines) }
    }

    /// What a program rests on: the `nth` of a file of which `of` programs are told.
    pub(super) fn program(&self, file: usize, nth: usize, of: usize) -> Option<&Scope> {
        let programs = self.files.get(file)?;
        // What is told of a file that is converted in pieces need not be what its blocks show.
        if programs.len() == of { programs.get(nth) } else { self.whole.get(file) }
    }

    /// The hash of what is asked once for the library: its code, and what it says.
    pub(super) fn hash_once(&self, code: &str, says: &str) -> String {
        format!("{}-{}", half(&format!("{code}\n{says}")), self.machines)
    }

    /// The hash of a question: its code, what it says, and on which lines of the program.
    pub(super) fn hash(&self, scope: &Scope, code: &str, says: &str, lines: &BTreeSet<i64>) -> String {
        let asked = format!("{code}\n{}\n{says}\n{lines:?}\n{}", says.len(), scope.rests_on);
        format!("{}-{}", half(&asked), self.machines)
    }
}

/// The half of a hash that is of the program, and the one that is of the machines.
pub(super) fn halves(hash: &str) -> (&str, &str) {
    hash.split_once('-').unwrap_or((hash, ""))
}

fn half(text: &str) -> String {
    let mut hash = sha256(text.as_bytes());
    hash.truncate(HALF);
    hash
}

/// By program, the line that it begins on and the hash of its text. Where programs of a file do not stand one after the
/// other, each has all of it.
fn texts(module: &Module, inputs: &[Input]) -> Vec<(u32, String)> {
    let lines: Vec<LineIndex> = inputs.iter().map(|input| LineIndex::new(&input.bytes)).collect();
    let mut all = Vec::with_capacity(module.programs.len());
    for programs in module.programs.chunk_by(|a, b| a.file == b.file) {
        let file = programs.first().map_or(0, |first| first.file);
        let bytes: &[u8] = inputs.get(file).map_or(&[], |input| &input.bytes);
        let length = bytes.len() as u32;
        let starts = std::iter::once(0).chain(programs.iter().skip(1).map(|program| program.site.span.start));
        let starts: Vec<u32> = starts.collect();
        let ends = starts.iter().skip(1).copied().chain([length]);
        let parts: Vec<Span> =
            starts.iter().zip(ends).map(|(start, end)| Span { start: *start, end }).collect();
        let is_cut = programs.iter().zip(&parts).all(|(program, part)| holds(*part, program));
        for part in parts {
            let part = if is_cut { part } else { Span::new(0, length) };
            let line = lines.get(file).map_or(1, |lines| lines.place(part.start).0);
            all.push((line, hash_of_text(bytes.get(part.range()).unwrap_or(bytes))));
        }
    }
    all
}

/// True if all that a program has stands in this part of its file.
fn holds(part: Span, program: &Program) -> bool {
    let inside = |span: Span| span == Span::default() || part.start <= span.start && span.end <= part.end;
    let mut blocks = program.blocks.iter();
    part.start < part.end
        && blocks.all(|block| {
            inside(block.term.site.span) && block.stmts.iter().all(|stmt| inside(stmt.site.span))
        })
}

/// The hash of a text, however its lines end and whatever blanks and frames stand at its end.
fn hash_of_text(text: &[u8]) -> String {
    let lines = Lines::new(text).map(|line| text.get(line.text.range()).unwrap_or_default().trim_ascii_end());
    let mut lines: Vec<&[u8]> = lines.collect();
    while lines.last().is_some_and(|line| matches!(*line, [] | [b'%'])) {
        lines.pop();
    }
    sha256(&lines.join(&b'\n'))
}

/// The hash of a text with those of all that the programs in it call, however far down.
fn rests_on(
    text: &str,
    own: BTreeSet<usize>,
    calls: &BTreeMap<usize, BTreeSet<usize>>,
    texts: &[(u32, String)],
    module: &Module,
) -> String {
    let all = reached(own.iter().copied(), |at, go| {
        calls.get(&at).into_iter().flatten().for_each(|callee| go(*callee));
    });
    let called = all.into_iter().filter(|at| !own.contains(at)).filter_map(|at| {
        let name = module.programs.get(at)?.name.as_ref().map(ToString::to_string).unwrap_or_default();
        Some(format!("{name:?} {}", texts.get(at)?.1))
    });
    // By their names: where they stand in the library is no matter.
    let called: BTreeSet<String> = called.collect();
    sha256(format!("{text}\n{}", called.into_iter().collect::<Vec<_>>().join("\n")).as_bytes())
}

/// What each program calls. A number that is computed may be that of any program, unless it is known which.
fn calls(module: &Module) -> BTreeMap<usize, BTreeSet<usize>> {
    let mut by_name: BTreeMap<_, BTreeSet<usize>> = BTreeMap::new();
    for (at, program) in module.programs.iter().enumerate() {
        if let Some(name) = &program.name {
            by_name.entry(name).or_default().insert(at);
        }
    }
    let mut calls: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (at, program) in module.programs.iter().enumerate() {
        let callees = calls.entry(at).or_default();
        for block in &program.blocks {
            let called = calls_of(block).map(|call| &call.callee);
            let named = called.filter_map(|callee| match callee {
                Callee::Program(name) => Some(name),
                _ => None,
            });
            let chained = match &block.term.kind {
                TermKind::Chain(name) => Some(name),
                _ => None,
            };
            callees.extend(named.chain(chained).filter_map(|name| by_name.get(name)).flatten());
        }
    }
    for ((at, _), callees) in computed_calls(module) {
        let any = if callees.known { callees.programs } else { (0..module.programs.len()).collect() };
        calls.entry(at).or_default().extend(any);
    }
    calls
}

/// A machine: its dialect, and what its profile says, wherever it stands and however it is laid out.
fn machine(control: &Control) -> String {
    let says = control.profile().files().map(|path| {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        match text.parse::<toml::Table>() {
            Ok(mut table) => {
                table.remove("extends");
                toml::to_string(&table).unwrap_or(text)
            }
            Err(_) => text,
        }
    });
    let says: Vec<String> = says.collect();
    format!("{} {:?}", control.name(), says)
}

/// The line that a byte stands on, as it is told.
pub(super) fn line_at(bytes: &[u8], at: u32) -> String {
    let at = (at as usize).min(bytes.len());
    let ends = |byte: &u8| matches!(byte, b'\n' | b'\r');
    let (before, after) = bytes.split_at(at);
    let start = before.iter().rposition(ends).map_or(0, |end| end + 1);
    let stop = after.iter().position(ends).map_or(bytes.len(), |end| at + end);
    let line = Span::new(start as u32, stop as u32).range();
    String::from_utf8_lossy(bytes.get(line).unwrap_or_default()).trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::hash_of_text;

    #[test]
    fn line_ends_and_frames_are_no_change_of_a_text() {
        let plain = hash_of_text(b"O1\nG0 X1.\nM30");
        for same in ["O1\r\nG0 X1.\r\nM30\r\n%\r\n", "O1\rG0 X1.  \rM30\r", "O1\nG0 X1.\nM30\n\n%\n"] {
            assert_eq!(hash_of_text(same.as_bytes()), plain, "{same:?}");
        }
        for other in ["O1\nG0 X1. \nM30 (A)", "O1\n\nG0 X1.\nM30", "O1\nG0  X1.\nM30"] {
            assert_ne!(hash_of_text(other.as_bytes()), plain, "{other:?}");
        }
    }
}
