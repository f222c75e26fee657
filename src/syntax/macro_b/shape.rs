//! The outline of a block: where it ends, its comments, and whether its brackets match.
//! It needs no grammar, and bounds what the grammar is asked to do.

/// How deep brackets may nest before a block is not read at all.
pub const DEEPEST: usize = 50;

/// What one pass over the bytes of a block tells.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shape {
    /// Just past the block: after its `;`, or where the line ends.
    pub end: usize,
    /// How deep brackets nest.
    pub depth: usize,
    /// The first `]` that closes nothing.
    pub extra_close: Option<usize>,
    /// The outermost `[` that nothing closes.
    pub unclosed: Option<usize>,
    /// The first `(` inside a comment.
    pub nested_comment: Option<usize>,
    /// The `(` of a comment that nothing closes.
    pub open_comment: Option<usize>,
}

/// Outlines the block that starts at `start`; `;` ends it, except in a comment.
pub fn outline(line: &[u8], start: usize) -> Shape {
    let mut shape = Shape { end: line.len(), ..Shape::default() };
    let mut open = [0; DEEPEST];
    let mut level = 0;
    let mut at = start;
    let telling = |byte: &u8| matches!(byte, b';' | b'(' | b'[' | b']');
    while let Some(passed) = line.get(at..).and_then(|rest| rest.iter().position(telling)) {
        at += passed;
        match line[at] {
            b';' => {
                shape.end = at + 1;
                break;
            }
            b'(' => {
                at = comment(line, at, &mut shape);
                continue;
            }
            b'[' => {
                if let Some(place) = open.get_mut(level) {
                    *place = at;
                }
                level += 1;
                shape.depth = shape.depth.max(level);
            }
            _ if level == 0 => {
                shape.extra_close.get_or_insert(at);
            }
            _ => level -= 1,
        }
        at += 1;
    }
    shape.unclosed = if level > 0 { Some(open[0]) } else { None };
    shape
}

/// Passes over the comment that opens at `start`.
fn comment(line: &[u8], start: usize, shape: &mut Shape) -> usize {
    let text = &line[start + 1..];
    let close = memchr::memchr(b')', text);
    if close.is_none() {
        shape.open_comment = Some(start);
    }
    let text = &text[..close.unwrap_or(text.len())];
    if shape.nested_comment.is_none() {
        shape.nested_comment = memchr::memchr(b'(', text).map(|i| start + 1 + i);
    }
    start + 1 + text.len() + usize::from(close.is_some())
}

/// The first bracket that opens a level deeper than `limit`.
pub fn bracket_beyond(block: &[u8], limit: u32) -> Option<usize> {
    let mut level = 0u32;
    let mut at = 0;
    while let Some(&byte) = block.get(at) {
        match byte {
            b'(' => at += memchr::memchr(b')', &block[at..])?,
            b'[' => {
                level += 1;
                if level > limit {
                    return Some(at);
                }
            }
            b']' => level = level.saturating_sub(1),
            _ => {}
        }
        at += 1;
    }
    None
}
