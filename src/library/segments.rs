//! Long plain programs, piece by piece, so that memory does not grow with their length.
//!
//! Law: a program without jumps, calls and variables is the pieces it is cut into, one behind the other, if each piece
//! starts in the modal state that the last one left. Pieces are cut before blocks that name an interpolation, so that
//! what a word means never depends on a block of another piece. Side conditions, looked for in every piece: plain words,
//! comments and program ends only; one control family, because other conversions add to the head of a program.
//! A file that breaks one of them is converted whole.

use super::convert::{Made, ProgramReport, drop_echoes, frames, make, outcome, written_name};
use super::{Conversion, Input, Lock, Options, Outcome};
use crate::canon::Op;
use crate::diag::Diagnostic;
use crate::dialect::Control;
use crate::ir::{Module, Program, TermKind};
use crate::legalize::Modal;
use crate::lower::Lowered;
use crate::syntax::{ExprKind, Item, ItemKind, ParsedFile, Word};
use crate::text::{Line, Lines};
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

const USUAL: Sizes = Sizes { long: 4 * 1024 * 1024, piece: 1024 * 1024 };
/// Pieces that are worked on at a time.
const BATCH: usize = 8;

/// Converts a long plain file; none where it is not one.
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
    let family = source.dialect().family == target.dialect().family;
    if input.bytes.len() < sizes.long || options.draft || !family {
        return None;
    }
    let mut sink = Sink::default();
    let mut state = Modal::unknown();
    let mut pieces =
        Pieces { source: &input.bytes, lines: Lines::new(&input.bytes), held: None, size: sizes.piece };
    loop {
        let batch: Vec<Vec<Line>> = std::iter::from_fn(|| pieces.next()).take(BATCH).collect();
        if batch.is_empty() {
            break;
        }
        let lowered: Option<Vec<Lowered>> =
            batch.into_par_iter().map(|lines| lower(input, lines, source)).collect();
        let entered: Vec<(Modal, Lowered)> = lowered?
            .into_iter()
            .map(|piece| {
                let entry = state.clone();
                piece.programs.iter().for_each(|(program, _)| step(&mut state, program));
                (entry, piece)
            })
            .collect();
        let made: Vec<(Vec<Option<String>>, Made, bool)> = entered
            .into_par_iter()
            .map(|(entry, piece)| piece_made(piece, entry, source, target, lock, options))
            .collect();
        made.into_iter().for_each(|(names, made, tape)| sink.add(names, made, tape));
    }
    Some(sink.finish(source, target, lock.clone()))
}

/// Cuts a file into runs of lines.
struct Pieces<'s> {
    source: &'s [u8],
    lines: Lines<'s>,
    held: Option<Line>,
    size: usize,
}

impl Pieces<'_> {
    fn next(&mut self) -> Option<Vec<Line>> {
        let mut piece: Vec<Line> = self.held.take().into_iter().collect();
        let start = piece.first().map(|line| line.text.start);
        for line in self.lines.by_ref() {
            let length =
                line.text.start - start.or(piece.first().map(|l| l.text.start)).unwrap_or(line.text.start);
            if length as usize > self.size && names_interpolation(line.text.of(self.source)) {
                self.held = Some(line);
                break;
            }
            piece.push(line);
        }
        (!piece.is_empty()).then_some(piece)
    }
}

/// True for a line with a word G0 to G3 and no comment: cheap, and sure where it says yes.
fn names_interpolation(line: &[u8]) -> bool {
    let code = |at: usize| {
        let rest = &line[at + 1..];
        let rest = rest.strip_prefix(b"0").unwrap_or(rest);
        let whole = |rest: &[u8]| rest.first().is_none_or(|b| !b.is_ascii_digit() && *b != b'.');
        // G0 with its zero taken off, or one of G1 to G3.
        line[at].eq_ignore_ascii_case(&b'G')
            && (line.get(at + 1) == Some(&b'0') && whole(rest)
                || rest.first().is_some_and(|b| (b'0'..=b'3').contains(b)) && whole(&rest[1..]))
    };
    !line.contains(&b'(') && (0..line.len()).any(code)
}

/// Reads and lowers a piece; none where it is not plain.
fn lower(input: &Input, lines: Vec<Line>, source: &Control) -> Option<Lowered> {
    let entry = source.entry();
    let mut blocks = Vec::new();
    lines.iter().for_each(|line| (entry.parse)(&input.bytes, line.text, &mut blocks));
    let plain = blocks
        .iter()
        .all(|block| block.errors.is_empty() && block.items.iter().all(|item| is_plain(item, source)));
    if !plain {
        return None;
    }
    let lowered = (entry.lower)(&ParsedFile { source: &input.bytes, lines, blocks }, 0, &input.name, source);
    let straight = |program: &Program| {
        program.blocks.iter().all(|block| {
            matches!(block.term.kind, TermKind::Jump(_) | TermKind::End { .. } | TermKind::Stray)
        })
    };
    lowered.programs.iter().all(|(program, _)| straight(program)).then_some(lowered)
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
    program.blocks.iter().flat_map(|block| &block.stmts).for_each(|stmt| state.step(stmt));
}

fn piece_made(
    piece: Lowered,
    entry: Modal,
    source: &Control,
    target: &Control,
    lock: &Lock,
    options: Options,
) -> (Vec<Option<String>>, Made, bool) {
    let names = piece.programs.iter().map(|(program, _)| program.name.as_ref().map(written_name)).collect();
    let mut found: Vec<Vec<Diagnostic>> = Vec::new();
    let mut module = Module { names: piece.names, ..Module::default() };
    for (program, diagnostics) in piece.programs {
        module.programs.push(program);
        found.push(diagnostics);
    }
    let mut made = make(module, &mut found, source, target, lock.clone(), options.level, entry);
    // Which target block came from where is a table as long as the file.
    made.parts.iter_mut().flatten().for_each(|part| part.blocks = Vec::new());
    (names, made, piece.tape)
}

/// The programs so far.
#[derive(Default)]
struct Sink {
    programs: Vec<(Option<String>, Vec<Diagnostic>, String)>,
    said: BTreeSet<(usize, &'static str, String)>,
    tape: bool,
}

impl Sink {
    fn add(&mut self, names: Vec<Option<String>>, made: Made, tape: bool) {
        self.tape |= tape;
        for ((name, found), parts) in names.into_iter().zip(made.found).zip(made.parts) {
            if name.is_some() || self.programs.is_empty() {
                self.programs.push((name, Vec::new(), String::new()));
            }
            let at = self.programs.len() - 1;
            let (_, all, text) = &mut self.programs[at];
            // What is said once a program was said for an earlier piece of it.
            all.extend(
                found.into_iter().filter(|d| self.said.insert((at, d.code.number(), d.message.clone()))),
            );
            parts.iter().for_each(|part| text.push_str(&part.text));
        }
    }

    fn finish(self, source: &Control, target: &Control, lock: Lock) -> Conversion {
        let framed = frames(source, target, self.tape);
        let mut text = String::from(if framed { "%\n" } else { "" });
        let mut any = false;
        let mut programs = Vec::with_capacity(self.programs.len());
        for (name, mut diagnostics, part) in self.programs {
            diagnostics.sort_by_key(|d| (d.span.start, d.code));
            drop_echoes(&mut diagnostics);
            let outcome = outcome(&diagnostics);
            if outcome != Outcome::Refused {
                any = true;
                // The first and longest is not copied.
                if text.len() <= 2 {
                    let head = std::mem::replace(&mut text, part);
                    text.insert_str(0, &head);
                } else {
                    text.push_str(&part);
                }
            }
            programs.push(ProgramReport {
                file: 0,
                name,
                outcome,
                verdict: None,
                diagnostics,
                map: Vec::new(),
            });
        }
        if framed {
            text.push_str("%\n");
        }
        Conversion { programs, texts: vec![any.then_some(text)], lock }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plain program with what pieces could get wrong at their edges.
    fn program(lines: usize) -> String {
        let mut text = String::from("%\nO1234 (PLATE)\nG21 G90 G17\n");
        for n in 0..lines {
            text += &match n % 11 {
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
            .collect();
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes: program(2_000).into_bytes() };
        let inputs = [input];
        for (source, target) in [(&controls[0], &controls[1]), (&controls[1], &controls[0])] {
            let lock = Lock::new(source.name(), target.name());
            let whole = super::super::convert(&inputs, source, target, lock.clone(), Options::default());
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

    #[test]
    fn what_is_not_plain_is_converted_whole() {
        for line in ["#1=2", "G65 P1", "M98 P1", "GOTO 5", "X#1", "M99", "IF[1EQ1]GOTO5"] {
            let bytes = format!("O1\n{line}\nM30\n").into_bytes();
            let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes }];
            let controls: Vec<Control> = crate::dialect::registry::all()
                .iter()
                .filter(|entry| entry.emit.is_some())
                .filter_map(|entry| Control::plain(entry.name))
                .collect();
            let lock = Lock::new(controls[0].name(), controls[1].name());
            let sizes = Sizes { long: 0, piece: 10 };
            let done = convert_in(sizes, &inputs, &controls[0], &controls[1], &lock, Options::default());
            assert!(done.is_none(), "{line}");
        }
    }

    #[test]
    fn pieces_are_cut_where_an_interpolation_is_named() {
        for (line, cut) in [
            ("N10 G01 X1.", true),
            ("g0x1", true),
            ("G00", true),
            ("G0", true),
            ("G3 X1. R2.", true),
            ("X1. G03", true),
            ("G17", false),
            ("G028 X0", false),
            ("G1.1", false),
            ("G10 L2", false),
            ("X1. Y2.", false),
            ("(G1) X1.", false),
            ("G", false),
        ] {
            assert_eq!(names_interpolation(line.as_bytes()), cut, "{line}");
        }
    }
}
