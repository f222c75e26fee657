//! Comments that are not closed on their line and go on over the next ones.

use crate::diag::Code;
use crate::syntax::Block;

/// The number of the block in which a comment ends that is not closed in the first of these blocks; none if it never ends. A bracket
/// on a line of its own ends it, before another that opens so; else brackets within it nest.
pub(super) fn ends_at(blocks: &[Block], source: &[u8]) -> Option<usize> {
    let alone = |block: &Block, bracket: &[u8]| block.span.of(source).trim_ascii() == bracket;
    let mut rest = blocks.iter().enumerate().skip(1).take_while(|(_, block)| !alone(block, b"("));
    if let Some((at, _)) = rest.find(|(_, block)| alone(block, b")")) {
        return Some(at);
    }
    let mut depth = 0_i64;
    for (at, block) in blocks.iter().enumerate() {
        for byte in block.span.of(source) {
            match byte {
                b'(' => depth += 1,
                b')' => depth -= 1,
                _ => continue,
            }
            if at > 0 && depth == 0 {
                return Some(at);
            }
        }
        // The first block has to leave it open.
        if at == 0 && depth <= 0 {
            return None;
        }
    }
    None
}

/// True for a block whose comment is not closed on its line.
pub(super) fn begins(block: &Block) -> bool {
    block.errors.iter().any(|error| error.code == Code::UnclosedComment)
}
