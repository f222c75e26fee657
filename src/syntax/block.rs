//! What can be done with a block as it was read: print it.

use super::Block;

impl Block {
    /// Appends the block's text.
    pub fn print(&self, source: &[u8], out: &mut Vec<u8>) {
        for token in &self.tokens {
            out.extend_from_slice(token.span.of(source));
        }
    }

    /// True when the tokens tile the block.
    pub fn is_tiled(&self) -> bool {
        let (mut at, mut joined) = (self.span.start, true);
        for token in &self.tokens {
            joined &= token.span.start == at && token.span.end >= at;
            at = token.span.end;
        }
        joined && at == self.span.end
    }
}

/// The text of a run of blocks, without line ends.
pub fn print_blocks(blocks: &[Block], source: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    blocks.iter().for_each(|block| block.print(source, &mut out));
    out
}
