//! Lays down the moves of a hole.

use crate::canon::{Func, Op, Role};
use crate::ir::{
    BinOp, Builder, Cond, Expr, Nc, NcItem, Place, Relation, SourceInfo, StmtKind, TermKind, Var,
};
use crate::text::Span;

/// Writes the moves of one hole.
pub(super) struct Pen<'p> {
    pub builder: &'p mut Builder,
    pub span: Span,
    /// Whether the last move was at feed; none if that is not known.
    pub feeds: Option<bool>,
    /// The feed, until the first cut.
    pub feed: Vec<NcItem>,
    /// True until absolute coordinates are selected.
    pub absolute: bool,
}

impl Pen<'_> {
    fn site(&self) -> SourceInfo {
        SourceInfo { span: self.span, ..SourceInfo::default() }
    }

    /// One move along Z.
    pub fn go(&mut self, feed: bool, to: Expr) {
        let mut items = Vec::new();
        items.extend(std::mem::take(&mut self.absolute).then_some(NcItem::Op(Op::Absolute)));
        if self.feeds != Some(feed) {
            items.push(NcItem::Op(if feed { Op::Linear } else { Op::Rapid }));
        }
        self.feeds = Some(feed);
        items.push(NcItem::Word(Role::Z, to));
        if feed {
            items.append(&mut self.feed);
        }
        push(self.builder, items, self.site());
    }

    fn set(&mut self, var: Var, value: Expr) {
        self.builder.push(StmtKind::Assign { target: Place::Var(var), value }, self.site());
    }

    /// Sets a variable under a condition.
    fn set_if(&mut self, cond: Cond, var: Var, value: Expr) {
        let (then, otherwise) = (self.builder.fresh(), self.builder.fresh());
        self.builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, SourceInfo::default());
        self.builder.start(then);
        self.set(var, value);
        self.builder.start(otherwise);
    }

    /// Steps down from the retract plane until the bottom is reached.
    pub fn pecks(
        &mut self,
        (retract, bottom, peck): (Expr, Expr, Expr),
        clear: f64,
        out: bool,
        [at, next, by, back]: [Var; 4],
    ) {
        let read = Expr::Var;
        let compare = Cond::Compare;
        if !self.feed.is_empty() {
            let items = std::mem::take(&mut self.feed);
            push(self.builder, items, self.site());
        }
        if std::mem::take(&mut self.absolute) {
            push(self.builder, vec![NcItem::Op(Op::Absolute)], self.site());
        }
        let size = match peck.constant() {
            Some(peck) => Expr::Number(peck.abs()),
            None => Expr::Call(Func::Abs, [peck].into()),
        };
        self.set(at, retract.clone());
        self.set(by, size);
        let nothing = compare(Relation::Equal, read(by), Expr::Number(0.0));
        self.set_if(nothing, by, Expr::binary(BinOp::Sub, retract.clone(), bottom.clone()));
        let (head, again, done) = (self.builder.fresh(), self.builder.fresh(), self.builder.fresh());
        self.builder.start(head);
        self.set(next, Expr::binary(BinOp::Sub, read(at), read(by)));
        let limit = Expr::binary(BinOp::Add, bottom.clone(), Expr::Number(0.00001));
        self.set(back, limit);
        self.set_if(compare(Relation::LessEqual, read(next), read(back)), next, bottom.clone());
        self.feeds = None;
        self.go(true, read(next));
        let cond = compare(Relation::LessEqual, read(next), read(back));
        self.builder.end(
            TermKind::Branch { cond: Box::new(cond), then: done, otherwise: again },
            SourceInfo::default(),
        );
        self.builder.start(again);
        if out {
            self.go(false, retract.clone());
        }
        self.set(back, Expr::binary(BinOp::Add, read(next), Expr::Number(clear)));
        self.set_if(compare(Relation::Greater, read(back), retract.clone()), back, retract);
        self.go(false, read(back));
        self.set(at, read(next));
        self.builder.end(TermKind::Jump(head), SourceInfo::default());
        self.builder.start(done);
        self.feeds = Some(true);
    }
}

/// Lays down words, if there are any; a block that has none left keeps its comments.
pub(super) fn push(builder: &mut Builder, items: Vec<NcItem>, site: SourceInfo) {
    let kind = if items.is_empty() { StmtKind::Comment } else { StmtKind::Nc(Nc { items }) };
    builder.push(kind, site);
}
