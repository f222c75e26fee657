//! The words of a block, turned.

use super::Vacant;
use crate::canon::{Op, Role};
use crate::ir::{BinOp, Class, Expr, Nc, NcItem, Place, SourceInfo, Stmt, StmtKind, Stmts, Var};

const ALONE: &str = "a move of one axis under a rotation moves both on the target, and where the other one stands is not known: write X and Y";
const DISTANCE: &str =
    "it is not known whether G90 or G91 is in force at this move under a rotation: write one before it";
const VACANT: &str = "a word of this move under a rotation may be vacant: give it a value in every run";
const HERE: &str = "a cycle runs where a rotation puts the tool, and which place was named last is not known: write X and Y into a block \
     under the rotation";

/// A rotation in force.
pub(super) struct Turned {
    pub centre: [Expr; 2],
    pub cosine: Var,
    pub sine: Var,
    /// The words that name where the tool stands.
    pub last: Option<[Expr; 2]>,
}

/// Turns the words of a block, and puts what they need before it. The block comes back if it cannot be turned.
pub(super) fn turn(
    mut stmt: Stmt,
    turned: &Turned,
    distance: Option<Op>,
    vacant: &Vacant,
    temps: &mut u32,
    out: &mut Stmts,
) -> Result<(), (Stmt, &'static str)> {
    let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
    let StmtKind::Nc(nc) = &stmt.kind else { return Err((stmt, DISTANCE)) };
    if vacant.contains(&true) {
        return Err((stmt, VACANT));
    }
    let mut first = Stmts::new();
    let mut held = |value: &Expr| match value {
        Expr::Number(_) | Expr::Var(_) => value.clone(),
        value => {
            *temps += 1;
            let temp = Var { class: Class::Temp, number: *temps };
            let kind = StmtKind::Assign { target: Place::Var(temp), value: value.clone() };
            first.push(Stmt { kind, site: site.clone() });
            Expr::Var(temp)
        }
    };
    let mut words = Vec::new();
    let ends = [Role::X, Role::Y].map(|role| nc.word(role).map(&mut held));
    let here = nc.has(Op::CycleHere);
    let point = match (ends, distance) {
        ([None, None], _) if !here => None,
        ([None, None], Some(Op::Absolute)) => match turned.last.clone() {
            Some(last) => Some((last, true)),
            None => return Err((stmt, HERE)),
        },
        ([x, y], Some(Op::Incremental)) => {
            Some(([x, y].map(|word| word.unwrap_or(Expr::Number(0.0))), false))
        }
        ([Some(x), Some(y)], Some(Op::Absolute)) => Some(([x, y], true)),
        ([x, y], Some(Op::Absolute)) => match turned.last.clone() {
            Some([last_x, last_y]) => Some(([x.unwrap_or(last_x), y.unwrap_or(last_y)], true)),
            None => return Err((stmt, ALONE)),
        },
        _ => return Err((stmt, DISTANCE)),
    };
    if let Some((point, about)) = point {
        let centre = turned.centre.clone().map(|word| if about { word } else { Expr::Number(0.0) });
        words.extend([Role::X, Role::Y].into_iter().zip(turned.point(point, centre)));
    }
    let centre = [Role::ArcI, Role::ArcJ].map(|role| nc.word(role).map(&mut held));
    if centre.iter().any(Option::is_some) {
        let centre = centre.map(|word| word.unwrap_or(Expr::Number(0.0)));
        let zero = [Expr::Number(0.0), Expr::Number(0.0)];
        words.extend([Role::ArcI, Role::ArcJ].into_iter().zip(turned.point(centre, zero)));
    }
    out.append(&mut first);
    if let StmtKind::Nc(Nc { items }) = &mut stmt.kind {
        let is_old = |item: &NcItem| match item {
            NcItem::Word(role, _) => words.iter().any(|(new, _)| new == role),
            NcItem::Op(op) => *op == Op::CycleHere,
            NcItem::Code(..) => false,
        };
        let at = items.iter().position(is_old).unwrap_or(items.len());
        items.retain(|item| !is_old(item));
        let words = words.into_iter().map(|(role, value)| NcItem::Word(role, value));
        items.splice(at..at, words);
    }
    out.push(stmt);
    Ok(())
}

impl Turned {
    /// A point, turned about a centre.
    fn point(&self, point: [Expr; 2], centre: [Expr; 2]) -> [Expr; 2] {
        let [x, y] = [0, 1].map(|axis| minus(point[axis].clone(), centre[axis].clone()));
        let [cosine, sine] = [self.cosine, self.sine].map(Expr::Var);
        let [cx, cy] = centre;
        let first = minus(times(x.clone(), cosine.clone()), times(y.clone(), sine.clone()));
        let second = plus(times(x, sine), times(y, cosine));
        [plus(cx, first), plus(cy, second)]
    }
}

fn is_zero(value: &Expr) -> bool {
    value.constant() == Some(0.0)
}

fn plus(a: Expr, b: Expr) -> Expr {
    match (is_zero(&a), is_zero(&b)) {
        (true, _) => b,
        (_, true) => a,
        _ => Expr::binary(BinOp::Add, a, b),
    }
}

fn minus(a: Expr, b: Expr) -> Expr {
    if let (Some(a), Some(b)) = (a.constant(), b.constant()) {
        // Without what binary arithmetic adds to decimal digits.
        return Expr::Number(((a - b) * 1e6).round() / 1e6);
    }
    match (is_zero(&a), is_zero(&b)) {
        (_, true) => a,
        (true, _) => Expr::Negate(Box::new(b)),
        _ => Expr::binary(BinOp::Sub, a, b),
    }
}

fn times(a: Expr, b: Expr) -> Expr {
    if is_zero(&a) { Expr::Number(0.0) } else { Expr::binary(BinOp::Mul, a, b) }
}
