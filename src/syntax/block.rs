//! What can be done with a block as it was read: print it, rewrite a piece of it.

use super::{Block, Token};
use crate::text::Span;

impl Token {
    /// The token's text: its rewriting, or its bytes in `source`.
    pub fn text<'a>(&'a self, source: &'a [u8]) -> &'a [u8] {
        match &self.edit {
            Some(text) => text.as_bytes(),
            None => self.span.of(source),
        }
    }
}

impl Block {
    /// Appends the block's text, rewritten tokens included.
    pub fn print(&self, source: &[u8], out: &mut Vec<u8>) {
        for token in &self.tokens {
            out.extend_from_slice(token.text(source));
        }
    }

    /// Replaces the text of the tokens inside `span`, leaving all spacing around them
    /// alone. The typed items keep what was read. False where no token starts there.
    pub fn rewrite(&mut self, span: Span, text: &str) -> bool {
        let mut tokens =
            self.tokens.iter_mut().filter(|t| t.span.start >= span.start && t.span.end <= span.end);
        let Some(first) = tokens.next() else { return false };
        first.edit = Some(text.into());
        tokens.for_each(|token| token.edit = Some("".into()));
        true
    }

    /// True when the tokens tile the block.
    pub fn is_tiled(&self) -> bool {
        let mut at = self.span.start;
        self.tokens.iter().all(|token| {
            let joins = token.span.start == at && token.span.end >= at;
            at = token.span.end;
            joins
        }) && at == self.span.end
    }
}

/// The text of a run of blocks, without line ends.
pub fn print_blocks(blocks: &[Block], source: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    blocks.iter().for_each(|block| block.print(source, &mut out));
    out
}
