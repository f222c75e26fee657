//! A block before another one, which takes its number and its comments.

use crate::ir::{Nc, NcItem, SourceInfo, Stmt, StmtKind};

/// A block of its own for these items, to stand right before a statement: it has that statement's number, comments and block skip.
pub fn ahead(stmt: &mut Stmt, items: Vec<NcItem>) -> Stmt {
    let aside = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
    let site = std::mem::replace(&mut stmt.site, aside);
    Stmt { kind: StmtKind::Nc(Nc { items }), site }
}
