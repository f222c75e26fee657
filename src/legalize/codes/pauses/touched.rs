//! Whether a builder's code came since the program last said what its spindle does.
//!
//! A code of which only a name and a few words are known may stop the spindle, or turn another one: what turns after it is known only
//! where the profile says that it leaves the spindle as it was (`keeps = "spindle"`). Nothing is started by itself after such a code.

use crate::assume::Predicate;
use crate::canon::{Act, Group, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Keeps};
use crate::ir::analysis::dataflow::Lattice;
use crate::ir::analysis::over_calls::Follow;
use crate::ir::{Block, BlockId, NcItem, Stmt};
use crate::legalize::Context;
use crate::text::Span;

/// The builder's code, if one came on some way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Touched(pub Option<Act>);

impl Touched {
    /// After a statement.
    pub(super) fn step(&mut self, stmt: &Stmt, controls: [&Control; 2]) {
        let Some(nc) = stmt.kind.nc() else { return };
        // What a block skip may leave out says nothing for sure.
        if stmt.site.skip.is_none() && nc.ops().any(|op| op.group() == Group::Spindle) {
            self.0 = None;
        }
        for item in &nc.items {
            let NcItem::Word(Role::Act, number) = item else { continue };
            let act = number.constant().and_then(Act::of);
            self.0 = act.filter(|act| !keeps_spindle(*act, controls)).or(self.0);
        }
    }
}

/// True for a code that leaves the spindle as it was, by its name, or as the profile of either machine says: both do the same.
fn keeps_spindle(act: Act, controls: [&Control; 2]) -> bool {
    Act::KEEP_SPINDLE.contains(&act.name().as_str())
        || controls
            .iter()
            .any(|control| control.site_of(act).is_some_and(|site| site.keeps == Some(Keeps::Spindle)))
}

impl Lattice for Touched {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self(self.0.into_iter().chain(other.0).min());
        std::mem::replace(self, joined) != joined
    }
}

/// Follows a library.
pub(super) struct Touches<'c>(pub [&'c Control; 2]);

impl Follow for Touches<'_> {
    type Known = Touched;

    fn outside(&self, _: usize) -> Touched {
        Touched::default()
    }

    fn stmts(&self, _: (usize, BlockId), block: &Block, known: &mut Touched) {
        block.stmts.iter().for_each(|stmt| known.step(stmt, self.0));
    }

    fn lose(&self, _: &mut Touched) {}
}

/// Tells that nothing is started again after a stop.
pub(super) fn tell(act: Act, index: usize, span: Span, context: &mut Context<'_>) {
    let site = context.source.site_of(act);
    let shown = site.map_or_else(|| format!("'{}'", act.shown()), |site| site.shown());
    let code = site.map_or_else(String::new, |site| format!(" at {}", site.code));
    let what = format!(
        "the stop ends the spindle on the target, and nothing is started again after it: {shown} came since the program last said what \
         the spindle does, and may stop it or turn another one"
    );
    let help = format!(
        "if it leaves the spindle as it was, write keeps = \"spindle\"{code} in the source's profile; if not, write M3, M4 or M5 after it, \
         or after this stop"
    );
    let told = Diagnostic::new(Code::Conditional, span, what).with_help(help);
    context.add(index, told.assuming(Predicate::Stands(vec![span])));
}
