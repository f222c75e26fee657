//! What lays down the loops that take the place of a lathe's cycles.
//!
//! Law: a value that is read again is worked out once. Side condition: its temporary is new in the program.
//! Counter-example: none; this only lays down what thread_loops.rs and groove_loops.rs say.

use crate::ir::{Builder, Class, Cond, Expr, Place, SourceInfo, StmtKind, TermKind, Var};
use crate::text::Span;

/// Something that lays down blocks, all in the place of one statement.
pub(super) trait Lays {
    /// Where the blocks go.
    fn builder(&mut self) -> &mut Builder;

    /// The highest temporary so far.
    fn temps(&mut self) -> &mut u32;

    /// Where the statement stands in the source.
    fn span(&self) -> Span;

    /// What each block says of where it comes from.
    fn site(&self) -> SourceInfo {
        SourceInfo { span: self.span(), ..SourceInfo::default() }
    }

    /// A new temporary.
    fn temp(&mut self) -> Var {
        let temps = self.temps();
        *temps += 1;
        Var { class: Class::Temp, number: *temps }
    }

    /// Gives a variable a value.
    fn set(&mut self, var: Var, value: Expr) {
        let site = self.site();
        self.builder().push(StmtKind::Assign { target: Place::Var(var), value }, site);
    }

    /// A value that may be read again: a number, a variable, or a new variable with it.
    fn held(&mut self, value: Expr) -> Expr {
        if matches!(value, Expr::Var(_)) || value.constant().is_some() {
            return value;
        }
        let temp = self.temp();
        self.set(temp, value);
        Expr::Var(temp)
    }

    /// An alarm where a condition holds, as the cycle has.
    fn stop_if(&mut self, cond: Cond, text: &str) {
        let (site, cond) = (self.site(), Box::new(cond));
        let builder = self.builder();
        let (then, otherwise) = (builder.fresh(), builder.fresh());
        builder.end(TermKind::Branch { cond, then, otherwise }, site.clone());
        builder.start(then);
        let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: text.into() };
        builder.push(alarm, site.clone());
        builder.end(TermKind::End { rewind: false }, site);
        builder.start(otherwise);
    }
}
