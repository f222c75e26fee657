//! Where the tool stands, as the computed words of the blocks before say it.

use crate::canon::Role;
use crate::ir::{BinOp, Expr, Place as Target, Stmt, StmtKind, Var};
use crate::legalize::lathe::place::{Place, Told};

/// The words of X and Z of the blocks so far that are computed, and that would be computed alike now.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels {
    /// How many blocks there were.
    blocks: u32,
    /// By block, its X and its Z.
    words: Vec<(u32, [Option<Expr>; 2])>,
}

impl Levels {
    /// Takes a statement, before its place is told.
    pub fn enter(&mut self, stmt: &Stmt, place: &mut Place) {
        self.blocks += 1;
        place.comes_to(self.blocks);
        match &stmt.kind {
            StmtKind::Nc(nc) => {
                let words =
                    [Role::X, Role::Z].map(|role| nc.word(role).filter(|value| lasts(value)).cloned());
                if words.iter().any(Option::is_some) {
                    self.words.push((self.blocks, words));
                }
            }
            StmtKind::Comment => {}
            StmtKind::Assign { target: Target::Var(var), .. } => {
                let reads = |value: &Option<Expr>| value.as_ref().is_some_and(|value| mentions(value, *var));
                self.words.retain(|(_, words)| !words.iter().any(reads));
            }
            _ => self.words.clear(),
        }
    }

    /// The place along X, or along Z, where it is known.
    pub fn level(&self, place: &Place, side: bool) -> Option<Expr> {
        let (x, z) = place.told();
        match if side { x } else { z }? {
            Told::Number(number) => Some(Expr::Number(number)),
            Told::Block(block) => {
                let (_, [x, z]) = self.words.iter().find(|(at, _)| *at == block)?;
                if side { x.clone() } else { z.clone() }
            }
        }
    }
}

/// True for a value that is there whatever its variables hold, and that reads nothing but variables.
pub(super) fn lasts(value: &Expr) -> bool {
    let computed = match value {
        Expr::Number(_) | Expr::Binary(..) => true,
        Expr::Negate(inner) => matches!(**inner, Expr::Number(_) | Expr::Binary(..)),
        _ => false,
    };
    let mut plain = true;
    value.walk(&mut |e: &Expr| plain &= !matches!(e, Expr::System(..) | Expr::Indirect(..)));
    computed && plain
}

fn mentions(value: &Expr, var: Var) -> bool {
    let mut found = false;
    value.walk(&mut |e: &Expr| found |= *e == Expr::Var(var));
    found
}

/// The way from one place to another, half of it where the places are diameters.
pub(super) fn way(from: Expr, to: Expr, side: bool) -> Expr {
    let way = Expr::binary(BinOp::Sub, to, from);
    if side { Expr::binary(BinOp::Div, way, Expr::Number(2.0)) } else { way }
}
