//! What lays down the loops that take the place of a lathe's cycles.
//!
//! Law: a value that is read again is worked out once. Side condition: its temporary is new in the program.
//! Counter-example: none; this only lays down what thread_loops.rs and groove_loops.rs say.

use crate::ir::{Builder, Class, Cond, Expr, Place, SourceInfo, StmtKind, TermKind, Var};
use crate::text::Span;

/// What is laid down as a loop.
pub(super) trait Laid {
    /// Where the statement stands in the source.
    fn span(&self) -> Span;
}

/// Lays down the blocks of a loop, all in the place of one statement.
pub(super) struct Pen<'p, T> {
    /// Where the blocks go.
    pub builder: &'p mut Builder,
    /// The highest temporary so far.
    pub temps: &'p mut u32,
    /// What they are made from.
    pub found: &'p T,
}

impl<T: Laid> Pen<'_, T> {
    /// What each block says of where it comes from.
    pub(super) fn site(&self) -> SourceInfo {
        SourceInfo { span: self.found.span(), ..SourceInfo::default() }
    }

    /// A new temporary.
    pub(super) fn temp(&mut self) -> Var {
        *self.temps += 1;
        Var { class: Class::Temp, number: *self.temps }
    }

    /// Gives a variable a value.
    pub(super) fn set(&mut self, var: Var, value: Expr) {
        let site = self.site();
        self.builder.push(StmtKind::Assign { target: Place::Var(var), value }, site);
    }

    /// A value that may be read again: a number, a variable, or a new variable with it.
    pub(super) fn held(&mut self, value: Expr) -> Expr {
        if matches!(value, Expr::Var(_)) || value.constant().is_some() {
            return value;
        }
        let temp = self.temp();
        self.set(temp, value);
        Expr::Var(temp)
    }

    /// An alarm where a condition holds, as the cycle has.
    pub(super) fn stop_if(&mut self, cond: Cond, text: &str) {
        let (site, cond) = (self.site(), Box::new(cond));
        let builder = &mut *self.builder;
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        builder.end(TermKind::Branch { cond, then, otherwise }, site.clone());
        builder.start(then);
        let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: text.into() };
        builder.push(alarm, site.clone());
        builder.end(TermKind::End { rewind: false }, site);
        builder.start(otherwise);
    }
}
