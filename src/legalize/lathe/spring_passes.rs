//! Finishing passes of a thread, beyond those that the target's cycle makes.
//!
//! Law: each of them is a move to where the thread begins at full depth, the thread, and the way out and back, as the cycle makes it
//! (docs/lathe.md, P5, P7, P8). Side conditions: the place where the cycle begins, the end, the height, the taper and the angle are known numbers,
//! and the next block that moves says how. Error bound: half of the sixth decimal. Counter-example: a start that a called program leaves.

use super::place::Place;
use crate::canon::{Group, Op, Role};
use crate::ir::{Expr, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::text::Span;

/// A thread at full depth: where it begins, where it ends, and from where the cycle came; X as a diameter.
struct Pass {
    from: (f64, f64),
    begin: (f64, f64),
    end: (f64, f64),
    lead: f64,
}

impl Pass {
    /// The pass of a cycle; none where a number of it is not known.
    fn of(nc: &Nc, angle: f64, from: Place) -> Option<Self> {
        let number = |role: Role| nc.word(role).map_or(Some(None), |value| value.constant().map(Some));
        let from = (from.x()?, from.z()?);
        let whole = |whole: Role, step: Role, at: f64| -> Option<f64> {
            match (number(whole)?, number(step)?) {
                (Some(to), None) => Some(to),
                (None, Some(by)) => Some(at + by),
                (None, None) => Some(at),
                _ => None,
            }
        };
        let end = (whole(Role::X, Role::StepX, from.0)?, whole(Role::Z, Role::StepZ, from.1)?);
        let (height, taper) = (number(Role::ThreadHeight)??, number(Role::Taper)?.unwrap_or(0.0));
        let lead = number(Role::Lead)??;
        if number(Role::ThreadStart)?.is_some() || end.1 == from.1 {
            return None;
        }
        let z = from.1 + (end.1 - from.1).signum() * height * (angle / 2.0).to_radians().tan();
        let x = end.0 + 2.0 * taper * (end.1 - z) / (end.1 - from.1);
        Some(Self { from, begin: (x, z), end, lead })
    }

    fn stmts(&self, span: Span) -> [Stmt; 4] {
        let word = |role: Role, value: f64| NcItem::Word(role, Expr::Number((value * 1e6).round() / 1e6));
        let items = [
            vec![NcItem::Op(Op::Rapid), word(Role::X, self.begin.0), word(Role::Z, self.begin.1)],
            vec![
                NcItem::Op(Op::Thread),
                word(Role::X, self.end.0),
                word(Role::Z, self.end.1),
                word(Role::Lead, self.lead),
            ],
            vec![NcItem::Op(Op::Rapid), word(Role::X, self.from.0)],
            vec![word(Role::Z, self.from.1)],
        ];
        let site = SourceInfo { span, ..SourceInfo::default() };
        items.map(|items| Stmt { kind: StmtKind::Nc(Nc { items }), site: site.clone() })
    }
}

/// The blocks of so many passes after a thread's cycle; none where a number of it is not known, or what moves next rests on
/// the motion code that was in force before.
pub fn passes(
    stmt: &Stmt,
    (angle, count): (f64, usize),
    from: Place,
    (next, ends): (&[Stmt], bool),
) -> Option<Vec<Stmt>> {
    let StmtKind::Nc(nc) = &stmt.kind else { return None };
    if stmt.site.skip.is_some() || !says_how(next, ends) {
        return None;
    }
    let pass = Pass::of(nc, angle, from)?.stmts(stmt.site.span);
    Some(std::iter::repeat_n(pass, count).flatten().collect())
}

/// True where the next block with axis words has a code for how it moves, or the program ends before one.
fn says_how(next: &[Stmt], ends: bool) -> bool {
    let moves = next.iter().find_map(|stmt| match &stmt.kind {
        StmtKind::Nc(nc) if nc.names_axis() || nc.ops().any(|op| op.group() == Group::Motion) => Some(nc),
        _ => None,
    });
    moves.map_or(ends, |nc| {
        nc.ops().any(|op| op.group() == Group::Motion || op.is_lathe_cycle())
            || nc.ops().any(|op| op == Op::ReferenceReturn)
    })
}
