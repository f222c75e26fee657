//! Lowers the programs of a file, part by part where its control's lowering can be.
//!
//! The blocks of a part are dropped when it is lowered: what a file says takes forty times its length.

use crate::dialect::Control;
use crate::library::Input;
use crate::lower::{Cut, Lowered};
use crate::syntax::{ItemKind, ParsedFile, parse_file, parse_part};
use crate::text::Span;
use rayon::prelude::*;

/// Bytes of a part, about.
const PART: usize = 32 * 1024;

/// Lowers one file; errors of reading are findings of the program they stand in.
pub fn lower(at: usize, input: &Input, source: &Control) -> Lowered {
    in_parts(PART, at, input, source).unwrap_or_else(|| {
        let parsed = parse_file(&input.bytes, source.entry().parse_items);
        (source.entry().lower)(&parsed, at, &input.name, source)
    })
}

/// None where the file cannot be cut, or where it was cut at what begins no program.
fn in_parts(least: usize, at: usize, input: &Input, source: &Control) -> Option<Lowered> {
    let entry = source.entry();
    let cuts = (entry.cuts)(&input.bytes, least);
    if cuts.is_empty() {
        return None;
    }
    let starts = [Cut { at: 0, lines: 0 }].into_iter().chain(cuts.iter().copied());
    let ends = cuts.iter().map(|cut| cut.at).chain([input.bytes.len() as u32]);
    let parts: Vec<(Cut, u32)> = starts.zip(ends).collect();
    let lowered = parts.into_par_iter().map(|(start, end)| {
        let part = Span::new(start.at, end);
        let parsed = parse_part(&input.bytes, part, start.lines, entry.parse_items);
        (start.at == 0 || begins_program(&parsed)).then(|| (entry.lower)(&parsed, at, &input.name, source))
    });
    let lowered: Vec<Lowered> = lowered.collect::<Option<_>>()?;
    let mut whole = Lowered::default();
    for part in lowered {
        whole.programs.extend(part.programs);
        whole.names.extend(part.names);
        whole.tape |= part.tape;
    }
    Some(whole)
}

fn begins_program(parsed: &ParsedFile<'_>) -> bool {
    let first = parsed.blocks.first().and_then(|block| block.items.first());
    first.is_some_and(|item| matches!(item.kind, ItemKind::Program(_)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lowered whole, and in parts of at least so many bytes.
    fn both(text: &str, least: usize) -> Vec<(Lowered, Option<Lowered>)> {
        let input = Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.as_bytes().to_vec() };
        let controls = crate::dialect::registry::all().iter().filter_map(|entry| Control::plain(entry.name));
        let both = controls.map(|control| {
            let parsed = parse_file(&input.bytes, control.entry().parse_items);
            let whole = (control.entry().lower)(&parsed, 0, &input.name, &control);
            (whole, in_parts(least, 0, &input, &control))
        });
        both.collect()
    }

    #[test]
    fn parts_make_the_whole() {
        let head = "(FROM THE LIBRARY)\n%\n(FIRST)\n";
        let programs = [
            "O1 (ONE)\n#1=2\n\nN10 G1 X#1\nIF[#1GT2]GOTO10\nN10\nM30\n\n",
            "O0002\nN5 G65 P1 A2.\nX1.\nGOTO5\n\r\nWHILE[#1LT3]DO1\nEND1\nM99\r\n(BETWEEN)\n",
            "o3(THREE\n#1=[\nGOTO 77\nM99\n",
            "%\n(BEHIND A TAPE)\n",
            ":4\nM30\n",
            "O(NO NUMBER)\nN7\nN7 GOTO 7\n",
            "O5 $ #\nG0 X1.\n/M99\nO9999999999999\nM30 (%)\n(AFTER)\n",
        ];
        let mut cut = 0;
        // Every order of neighbours comes up.
        for step in 1..programs.len() {
            for first in 0..programs.len() {
                for head in ["", head, "(COMMENT)\n", "O8 NO\nCODE\n%\n"] {
                    let order = (0..12).map(|at| programs[(first + at * step) % programs.len()]);
                    let text: String = [head].into_iter().chain(order).collect();
                    for (whole, parts) in both(&text, 30) {
                        let Some(parts) = parts else { continue };
                        cut += 1;
                        assert!(parts.programs == whole.programs, "{text}");
                        assert!(parts.names == whole.names && parts.tape == whole.tape, "{text}");
                    }
                }
            }
        }
        assert!(cut > 100, "{cut}");
    }

    #[test]
    fn names_of_variables_are_good_for_a_whole_file() {
        let text = "O1\n#<TOOL>=1\nM99\nO2\nsetvn 510[TOOL]\nM99\nO3\nM30\n";
        assert!(both(text, 1).iter().all(|(_, parts)| parts.is_none()));
    }
}
