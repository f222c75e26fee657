//! Long plain programs, piece by piece, so that memory does not grow with their length.
//!
//! Law: a program without jumps, calls and variables is the pieces it is cut into, one after the other, if each piece
//! starts in the modal state that the last one left. What a word means never depends on a block of another piece: they
//! are cut before blocks that name an interpolation, and where none comes, the block that named the one in force
//! is read once more at the head of the piece, and left out of it. Side conditions, looked for in every piece: plain words,
//! comments and program ends only; no mirroring; controls on which programs begin alike, because other conversions add to the head of a program.
//! A file that breaks one of them is converted whole.

use super::cut::{Piece, Pieces};
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Control;
use crate::ir::{Module, Program, TermKind};
use crate::legalize::Modal;
use crate::library::compile::{Begun, Made, make};
use crate::library::convert::{ProgramReport, frames, outcome};
use crate::library::marks::marks;
use crate::library::names::begin_alike;
use crate::library::{Conversion, Input, Lock, Options, Outcome};
use crate::lower::Lowered;
use crate::syntax::{ExprKind, Item, ItemKind, ParsedFile, Word};
use crate::text::{Line, Lines, Span};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// When a file is cut, and into what.
#[derive(Clone, Copy)]
struct Sizes {
    /// Files from this length on are tried.
    long: usize,
    /// Bytes of a piece, about.
    piece: usize,
}

const USUAL: Sizes = Sizes { long: 1024 * 1024, piece: 64 * 1024 };
/// Pieces that each thread is given at a time: few, so that what they need stays in its cache.
const BATCH: usize = 2;

/// Converts a long plain file; none if it is not one.
pub fn convert(
    inputs: &[Input],
    source: &Control,
    target: &Control,
    lock: &Lock,
    options: Options,
) -> Option<Conversion> {
    convert_in(USUAL, inputs, source, target, lock, options)
}

fn convert_in(
    sizes: Sizes,
    inputs: &[Input],
    source: &Control,
    target: &Control,
    lock: &Lock,
    options: Options,
) -> Option<Conversion> {
    let [input] = inputs else { return None };
    if input.bytes.len() < sizes.long || options.draft || !begin_alike(source, target) {
        return None;
    }
    // All of it on threads of the pool: going there for each batch takes longer than some pieces.
    rayon::scope(|_| convert_pieces(sizes, input, source, target, lock, options))
}

fn convert_pieces(
    sizes: Sizes,
    input: &Input,
    source: &Control,
    target: &Control,
    lock: &Lock,
    options: Options,
) -> Option<Conversion> {
    let mut sink = Sink::new(input.bytes.len() + input.bytes.len() / 8);
    let mut state = Modal::unknown();
    let marks = marks(std::slice::from_ref(input), target, options);
    let mut pieces = Pieces::new(&input.bytes, source, sizes.piece);
    loop {
        let batch: Vec<Piece> = pieces.by_ref().take(BATCH * rayon::current_num_threads()).collect();
        if batch.is_empty() {
            break;
        }
        let goes_on = |piece: &Piece| (piece.lines.end as usize) < input.bytes.len();
        let lowered: Option<Vec<(bool, Lowered)>> = batch
            .into_par_iter()
            .map(|piece| Some((goes_on(&piece), lower(input, piece, source)?)))
            .collect();
        let entered: Vec<(Begun<'_>, Lowered)> = lowered?
            .into_iter()
            .enumerate()
            .map(|(at, (goes_on, piece))| {
                let continues = at > 0 || !sink.programs.is_empty();
                let begun = Begun { entry: state.clone(), goes_on, continues, marks: &marks };
                piece.programs.iter().for_each(|(program, _)| step(&mut state, program));
                (begun, piece)
            })
            .collect();
        let made: Vec<(Vec<Option<String>>, Made, bool)> = entered
            .into_par_iter()
            .map(|(begun, piece)| piece_made(piece, begun, source, target, lock, options))
            .collect();
        // A register is named at the head of its program, and in the lock.
        if made.iter().any(|(_, made, _)| !made.taken.is_empty()) {
            return None;
        }
        made.into_iter().for_each(|(names, made, tape)| sink.add(names, made, tape));
    }
    Some(sink.finish(source, target, lock.clone()))
}

/// Reads and lowers a piece; none if it is not plain.
fn lower(input: &Input, piece: Piece, source: &Control) -> Option<Lowered> {
    let entry = source.entry();
    let own = Lines::within(&input.bytes, piece.lines);
    let lines: Vec<Line> = piece.head.into_iter().chain(own).collect();
    let mut blocks = Vec::with_capacity(lines.len());
    for line in &lines {
        (entry.parse_items)(&input.bytes, line.text, &mut blocks);
    }
    let plain = blocks
        .iter()
        .all(|block| block.errors.is_empty() && block.items.iter().all(|item| is_plain(item, source)));
    if !plain {
        return None;
    }
    let parsed = ParsedFile { source: &input.bytes, before: 0, lines, blocks };
    let mut lowered = (entry.lower)(&parsed, 0, &input.name, source);
    if let (Some(head), Some((program, found))) = (piece.head, lowered.programs.first_mut()) {
        let is_head = |span: Span| head.text.start <= span.start && span.end <= head.text.end;
        program.blocks.iter_mut().for_each(|block| block.stmts.retain(|stmt| !is_head(stmt.site.span)));
        found.retain(|diagnostic| !is_head(diagnostic.span));
    }
    let straight = |program: &Program| {
        program.blocks.iter().all(|block| {
            matches!(block.term.kind, TermKind::Jump(_) | TermKind::End { .. } | TermKind::Stray)
        })
    };
    // The end of mirroring may name the axes that another piece mirrors.
    let mirrors = |program: &Program| {
        program.blocks.iter().flat_map(|block| &block.stmts).any(|stmt| stmt.kind.has_op(Op::MirrorOn))
    };
    let plain = |program: &Program| straight(program) && !mirrors(program);
    lowered.programs.iter().all(|(program, _)| plain(program)).then_some(lowered)
}

fn is_plain(item: &Item, source: &Control) -> bool {
    match &item.kind {
        ItemKind::Tape
        | ItemKind::EndOfBlock
        | ItemKind::Program(_)
        | ItemKind::Sequence { .. }
        | ItemKind::Comment(_)
        | ItemKind::Skip(_) => true,
        ItemKind::Word(Word { letter, value: Some(value), .. }) => {
            let number = match &value.kind {
                ExprKind::Number(number) => Some(number.value),
                ExprKind::Negate(inner) | ExprKind::Plus(inner) => {
                    return matches!(inner.kind, ExprKind::Number(_));
                }
                _ => None,
            };
            let flows = |number: f64| {
                source
                    .code(*letter, number, &[])
                    .is_some_and(|row| row.op.is_flow() && !matches!(row.op, Op::End | Op::EndRewind))
                    || source.alias(*letter, number).is_some()
            };
            number.is_some_and(|number| !matches!(letter, 'G' | 'M') || !flows(number))
        }
        _ => false,
    }
}

/// Takes the effect of a whole piece.
fn step(state: &mut Modal, program: &Program) {
    if program.name.is_some() {
        *state = state.at_head();
    }
    program.blocks.iter().flat_map(|block| &block.stmts).for_each(|stmt| state.step(stmt));
}

fn piece_made(
    piece: Lowered,
    begun: Begun<'_>,
    source: &Control,
    target: &Control,
    lock: &Lock,
    options: Options,
) -> (Vec<Option<String>>, Made, bool) {
    let names =
        piece.programs.iter().map(|(program, _)| program.name.as_ref().map(ToString::to_string)).collect();
    let mut found: Vec<Vec<Diagnostic>> = Vec::new();
    let mut module = Module { names: piece.names, ..Module::default() };
    for (program, diagnostics) in piece.programs {
        module.programs.push(program);
        found.push(diagnostics);
    }
    let mut made = make(module, found, source, target, lock.clone(), options, begun);
    // Which target block came from where is a table as long as the file.
    made.parts.iter_mut().flatten().for_each(|part| part.blocks = Vec::new());
    (names, made, piece.tape)
}

/// The programs so far.
struct Sink {
    programs: Vec<(Option<String>, Vec<Diagnostic>)>,
    /// The text of all, after the framing of a file.
    text: String,
    /// Where the text of each program starts.
    starts: Vec<usize>,
    tape: bool,
}

/// True of what is said once a program, at the first place.
fn is_said_once(finding: &Diagnostic) -> bool {
    finding.fact().is_some() || finding.code == Code::LettersReplaced
}

const FRAME: &str = "%\n";

impl Sink {
    /// Without programs, with room for so many bytes of text; memory that is not written to costs nothing.
    fn new(expected: usize) -> Self {
        let mut text = String::with_capacity(expected);
        text.push_str(FRAME);
        Self { programs: Vec::new(), text, starts: Vec::new(), tape: false }
    }

    fn add(&mut self, names: Vec<Option<String>>, made: Made, tape: bool) {
        self.tape |= tape;
        for ((name, found), parts) in names.into_iter().zip(made.found).zip(made.parts) {
            if name.is_some() || self.programs.is_empty() {
                self.programs.push((name, Vec::new()));
                self.starts.push(self.text.len());
            }
            let at = self.programs.len() - 1;
            self.programs[at].1.extend(found);
            parts.iter().for_each(|part| self.text.push_str(&part.text));
        }
    }

    fn finish(self, source: &Control, target: &Control, lock: Lock) -> Conversion {
        let Self { programs, mut text, starts, .. } = self;
        let mut end = text.len();
        let mut any = false;
        let mut reports = Vec::with_capacity(programs.len());
        // From the last to the first, so that what is taken out moves nothing that is still to be looked at.
        for ((name, mut diagnostics), start) in programs.into_iter().zip(starts).rev() {
            diagnostics.sort_by_key(|d| (d.span.start, d.code));
            diagnostics.dedup();
            // What is said once a program was said for an earlier piece of it.
            let mut said = BTreeSet::new();
            diagnostics.retain(|d| !is_said_once(d) || said.insert((d.code, d.message.clone())));
            crate::library::echoes::drop_echoes(&mut diagnostics);
            let outcome = outcome(&diagnostics);
            let mut length = 0;
            match outcome {
                Outcome::Refused => drop(text.drain(start..end)),
                _ => (any, length) = (true, end - start),
            }
            end = start;
            reports.push(ProgramReport {
                file: 0,
                name,
                outcome,
                verdict: None,
                diagnostics,
                map: Vec::new(),
                range: 0..length,
            });
        }
        reports.reverse();
        let framed = frames(source, target, self.tape);
        match framed {
            true => text.push_str(FRAME),
            false => drop(text.drain(..FRAME.len())),
        }
        let mut at = if framed { FRAME.len() } else { 0 };
        for report in &mut reports {
            let end = at + report.range.len();
            report.range = at..end;
            at = end;
        }
        Conversion {
            programs: reports,
            texts: vec![any.then_some(text)],
            lock,
            taken: String::new(),
            states_reserved: target.states_reserved(),
            links: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dialect::Question;

    /// A plain program with what pieces could get wrong at their edges.
    fn program(lines: usize) -> String {
        let mut text = String::from("%\nO1234 (PLATE)\nG21 G90 G17\n");
        for n in 0..lines {
            text += &match n % 11 {
                _ if (700..1200).contains(&n) => format!("X{n}. I1. F{n}.\n"),
                0 => format!("N{n} G0 X{} Y-.{n} (RAPID {n})\n", n % 97),
                1 => format!("G1 Z-{}. F100\n", n % 7),
                2 => "X1 Y2\n".into(),
                3 => "/G3 X1. Y1. R2.;\n".into(),
                4 => "(ONLY WORDS)\n".into(),
                5 => "G81 X1. Z-2. R.5 F80.\n".into(),
                6 => "X2. L2\n".into(),
                7 => "G80\n".into(),
                8 if n % 5 == 0 => format!("M30\nO{}\nG20\n", 2000 + n),
                9 => "\n".into(),
                _ => format!("G01 X{n}. M8\n"),
            };
        }
        text + "M30\n%\n"
    }

    #[test]
    fn pieces_make_the_whole() {
        let controls: Vec<Control> = crate::dialect::registry::all()
            .iter()
            .filter(|entry| entry.emit.is_some())
            .filter_map(|entry| Control::plain(entry.name))
            .filter(|control| control.is(Question::Vacancy))
            .collect();
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes: program(2_000).into_bytes() };
        let inputs = [input];
        for (source, target) in [(&controls[0], &controls[1]), (&controls[1], &controls[0])] {
            let lock = Lock::new(source.name(), target.name());
            let whole = crate::library::convert(&inputs, source, target, lock.clone(), Options::default());
            for piece in [40, 300, 7_000, 1_000_000] {
                let sizes = Sizes { long: 0, piece };
                let pieces = convert_in(sizes, &inputs, source, target, &lock, Options::default());
                let pieces = pieces.unwrap_or_else(|| panic!("{piece}: not taken as plain"));
                assert!(pieces.texts == whole.texts, "{piece} {}", source.name());
                let outcomes = |c: &Conversion| {
                    c.programs.iter().map(|p| (p.name.clone(), p.outcome)).collect::<Vec<_>>()
                };
                assert_eq!(outcomes(&pieces), outcomes(&whole), "{piece} {}", source.name());
            }
        }
    }

    /// A finding stands at each of its places, in whatever piece that is.
    #[test]
    fn pieces_find_what_the_whole_finds() {
        let controls: Vec<Control> = crate::dialect::registry::all()
            .iter()
            .filter(|entry| entry.emit.is_some())
            .filter_map(|entry| Control::plain(entry.name))
            .filter(|control| control.is(Question::Vacancy))
            .collect();
        let bytes = program(600).replace("(ONLY WORDS)", "M38").replace("M8\n", "M8 (\u{dc})\n").into_bytes();
        let many = String::from_utf8_lossy(&bytes).matches("M38").count();
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes }];
        for (source, target) in [(&controls[0], &controls[1]), (&controls[1], &controls[0])] {
            let lock = Lock::new(source.name(), target.name());
            let found = |conversion: Conversion| {
                let found = conversion.programs.into_iter().flat_map(|program| program.diagnostics);
                found.map(|d| (d.span, d.code, d.message.to_string())).collect::<Vec<_>>()
            };
            let whole =
                found(crate::library::convert(&inputs, source, target, lock.clone(), Options::default()));
            let errors = whole.iter().filter(|(_, code, _)| *code == Code::NotUnderstood);
            assert_eq!(errors.count(), many);
            for piece in [40, 300, 7_000, 1_000_000] {
                let sizes = Sizes { long: 0, piece };
                let pieces = convert_in(sizes, &inputs, source, target, &lock, Options::default());
                assert_eq!(pieces.map(found), Some(whole.clone()), "{piece} {}", source.name());
            }
        }
    }

    #[test]
    fn what_is_not_plain_is_converted_whole() {
        for line in ["#1=2", "G65 P1", "M98 P1", "GOTO 5", "X#1", "M99", "IF[1EQ1]GOTO5"] {
            let bytes = format!("O1\n{line}\nM30\n").into_bytes();
            let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes }];
            let controls: Vec<Control> = crate::dialect::registry::all()
                .iter()
                .filter(|entry| entry.emit.is_some())
                .filter_map(|entry| Control::plain(entry.name))
                .filter(|control| control.is(Question::Vacancy))
                .collect();
            let lock = Lock::new(controls[0].name(), controls[1].name());
            let sizes = Sizes { long: 0, piece: 10 };
            let done = convert_in(sizes, &inputs, &controls[0], &controls[1], &lock, Options::default());
            assert!(done.is_none(), "{line}");
        }
    }
}
