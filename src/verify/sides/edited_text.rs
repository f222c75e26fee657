//! The text of a program with other literals in it.
//!
//! Only its own lines are read anew. They stand after those of its file, so that all else stays where it was and no place
//! means two things.

use super::program_texts::ProgramTexts;
use crate::control::ProgramRef;
use crate::syntax::{Block, parse_part};
use crate::text::Span;

/// A program with other literals in it.
#[derive(Debug)]
pub struct EditedText {
    /// The bytes of its file as it was, and after them those of its edited lines.
    pub bytes: Vec<u8>,
    /// Where the edited lines begin.
    base: u32,
    /// Where they stood before, the end of the last of them left out.
    lines: Span,
    /// Where each literal began, in their order, and how much longer it is now.
    edits: Vec<(u32, i64)>,
    /// Blocks of the program, and those of others before it on its first line.
    blocks: usize,
    others: usize,
}

impl EditedText {
    /// A program with other literals in places of it.
    pub fn new(side: &ProgramTexts<'_>, program: ProgramRef, literals: &[(Span, f64)]) -> Option<Self> {
        let file = side.library.files.get(program.file)?.parsed;
        let range = side.blocks(program);
        let (first, last) = (file.blocks.get(range.start)?, file.blocks.get(range.end.checked_sub(1)?)?);
        let line_of = |block: &Block| {
            let at = file.lines.partition_point(|line| line.text.start <= block.span.start);
            file.lines.get(at.checked_sub(1)?)
        };
        let (head, tail) = (line_of(first)?.text.start, line_of(last)?);
        let (lines, end) = (Span::new(head, tail.text.end), tail.text.end.max(tail.end.end));
        let mut bytes = file.source.to_vec();
        // What the lines begin after is the end of a line.
        if bytes.last().is_some_and(|last| *last != b'\n') {
            bytes.push(b'\n');
        }
        let base = u32::try_from(bytes.len()).ok()?;
        let mut literals = literals.to_vec();
        literals.sort_by_key(|(literal, _)| literal.start);
        let (mut from, mut edits) = (lines.start, Vec::new());
        for (literal, value) in literals {
            let point = file.source.get(literal.range())?.contains(&b'.') && value.fract() == 0.0;
            let written = format!("{value}{}", if point { "." } else { "" });
            bytes.extend_from_slice(file.source.get(from as usize..literal.start as usize)?);
            bytes.extend_from_slice(written.as_bytes());
            edits.push((literal.start, written.len() as i64 - literal.range().len() as i64));
            from = literal.end;
        }
        bytes.extend_from_slice(file.source.get(from as usize..end as usize)?);
        u32::try_from(bytes.len()).ok()?;
        let before = file.blocks.get(..range.start)?.iter().rev();
        Some(Self {
            base,
            lines,
            edits,
            blocks: range.len(),
            others: before.take_while(|block| block.span.start >= head).count(),
            bytes,
        })
    }

    /// The blocks of the program, and of others that stand on its lines.
    pub fn parse(&self, side: &ProgramTexts<'_>) -> Vec<Block> {
        let part = Span::new(self.base, self.bytes.len() as u32);
        parse_part(&self.bytes, part, 0, side.control.entry().parse).blocks
    }

    /// Of those, the blocks of the program.
    pub fn own<'b>(&self, blocks: &'b [Block]) -> &'b [Block] {
        blocks.get(self.others..self.others + self.blocks).unwrap_or_default()
    }

    /// Where a place stood before the edits.
    pub fn before(&self, place: u32) -> u32 {
        let Some(behind) = place.checked_sub(self.base) else { return place };
        let there = i64::from(behind.saturating_add(self.lines.start));
        let grown =
            self.edits.iter().fold(0, |grown, (start, more)| match there > i64::from(*start) + grown {
                true => grown + more,
                false => grown,
            });
        u32::try_from(there - grown).unwrap_or(0)
    }

    /// Where a place of the program stands now.
    pub fn now(&self, place: u32) -> u32 {
        if !(self.lines.start..=self.lines.end).contains(&place) {
            return place;
        }
        let edits = self.edits.iter().take_while(|(start, _)| place > *start);
        let grown: i64 = edits.map(|(_, more)| more).sum();
        let there = i64::from(place) - i64::from(self.lines.start) + i64::from(self.base) + grown;
        u32::try_from(there).unwrap_or(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::LoadedFile;
    use crate::dialect::Control;
    use crate::syntax::parse_file;
    use crate::verify::Side;

    #[test]
    fn the_blocks_of_an_edited_program_stand_behind_its_file_and_are_told_where_they_stood() {
        let control = Control::plain("fanuc").unwrap();
        // The last one has no line end.
        let text = "O1\n#500=1\nM30\nO2\n#501=5\nX#501\nM30";
        let parsed = parse_file(text.as_bytes(), control.entry().parse);
        let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
        let side = Side::new(&control, control.entry().execute.unwrap(), &files);
        for (program, name, value) in [(0, "#500=", -12.5), (1, "#501=", 0.0), (1, "#501=", 123.0)] {
            let at = (text.find(name).unwrap() + name.len()) as u32;
            let program = ProgramRef { file: 0, program };
            let found = EditedText::new(&side.texts(), program, &[(Span::new(at, at + 1), value)]).unwrap();
            let blocks = found.parse(&side.texts());
            let (now, before) = (found.own(&blocks), side.text(program));
            assert_eq!((now.len(), blocks.len()), (before.len(), before.len()));
            for (now, before) in now.iter().zip(before) {
                assert_eq!(found.before(now.span.start), before.span.start);
                assert_eq!(found.now(before.span.start), now.span.start);
                assert_eq!(found.before(now.span.end), before.span.end);
            }
            assert_eq!(now[1].span.of(&found.bytes), format!("{name}{value}").as_bytes());
            // What stands elsewhere stays there.
            let other = side.text(ProgramRef { file: 0, program: 1 - program.program })[0].span.start;
            assert_eq!((found.before(other), found.now(other)), (other, other));
            let edited = side.edited(program, &found, now).unwrap();
            assert!(edited.stands_as(&side));
            assert_eq!(edited.line_of(0, now[1].span.start).0, side.line_of(0, before[1].span.start).0);
        }
    }

    #[test]
    fn several_literals_are_edited_at_once() {
        let control = Control::plain("fanuc").unwrap();
        let text = "O1\n#500=1\n#501=25\n#502=3.\nX#501\nM30\n";
        let parsed = parse_file(text.as_bytes(), control.entry().parse);
        let files = [LoadedFile { name: "a.nc", parsed: &parsed }];
        let side = Side::new(&control, control.entry().execute.unwrap(), &files);
        let program = ProgramRef { file: 0, program: 0 };
        let at = |literal: &str| {
            let start = text.find(literal).unwrap() as u32;
            Span::new(start, start + literal.len() as u32)
        };
        let literals = [(at("3."), 4.0), (Span::new(8, 9), -12.5), (at("25"), 7.0)];
        let found = EditedText::new(&side.texts(), program, &literals).unwrap();
        let blocks = found.parse(&side.texts());
        let texts: Vec<_> = blocks.iter().map(|block| block.span.of(&found.bytes)).collect();
        assert_eq!(texts[1..5], [&b"#500=-12.5"[..], b"#501=7", b"#502=4.", b"X#501"]);
        for (now, before) in found.own(&blocks).iter().zip(side.text(program)) {
            assert_eq!(
                (found.before(now.span.start), found.before(now.span.end)),
                (before.span.start, before.span.end)
            );
            assert_eq!(
                (found.now(before.span.start), found.now(before.span.end)),
                (now.span.start, now.span.end)
            );
        }
    }
}
