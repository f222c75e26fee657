//! What the fuzz targets share: the first byte of an input chooses the dialect.

use macroglot::syntax::{Parser, cc100, fadal, fanuc, haas};

/// The parser that the first byte names, and the program behind it.
pub fn choose(input: &[u8]) -> Option<(Parser, &[u8])> {
    const PARSERS: [Parser; 4] =
        [fadal::parse_line, fanuc::parse_line, haas::parse_line, cc100::parse_line];
    let (first, program) = input.split_first()?;
    Some((PARSERS[usize::from(*first) % PARSERS.len()], program))
}
