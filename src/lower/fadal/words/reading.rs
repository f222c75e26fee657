//! A block while it is read.

use crate::dialect::CodeMeaning;
use crate::ir::{NcItem, Var};
use crate::lower::fadal::codes::Codes;
use crate::text::Span;

/// A block while it is read.
pub(super) struct Reading<'b, 'c> {
    /// The codes of the block.
    pub(super) codes: &'c Codes<'b, 'b>,
    /// The motion mode that gives letters their roles.
    pub(super) modal: Option<&'b CodeMeaning>,
    /// What the block's own variables were set to.
    pub(super) assigned: Vec<(Var, Span)>,
    /// The variables that its words read.
    pub(super) read: Vec<Var>,
    pub(super) items: Vec<NcItem>,
    /// True for a block with axis words.
    pub(super) moves: bool,
    pub(super) span: Span,
}
