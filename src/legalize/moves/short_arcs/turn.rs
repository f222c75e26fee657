//! Arcs about a centre from variables, whose sweep only the run knows.
//!
//! Law: with the start at `u` from the centre and the end `w` from the start, the sweep is at most half a turn where `u`
//! turns to `w` on the side to which the arc goes, and then the arc is the one of its radius. A longer one begins with a
//! third of a turn, whose end is `u` turned by 120 degrees: so what is left ends within 170 degrees after two thirds at the
//! most. An end within 0.00005 of the start, on either side of it, makes a whole turn.
//!
//! Side condition: the end lies on the arc, which the verifier tries. Counter-example: `G3 X10. Y0 I5. J1.`.

use crate::canon::{Func, Group, Op, Role};
use crate::ir::{
    BinOp, Builder, Class, Cond, Expr, Nc, NcItem, Place, Relation, SourceInfo, Stmt, StmtKind, TermKind, Var,
};
use crate::legalize::rewrite::unless_skipped;

/// The sine of 120 degrees.
const SIN_120: f64 = 0.866_025_4;

/// The tangent of 80 degrees: an arc of 170 lies on one side of the line that is turned by so much.
const TAN_80: f64 = 5.671_28;

/// Ends so near are one.
const ONE_PLACE: f64 = 0.000_05;

/// An arc that the run cuts where it is long.
#[derive(Clone, Debug)]
pub(super) struct Turn {
    ends: [Option<Expr>; 2],
    centre: [Expr; 2],
    /// Where it begins, in absolute numbers; none for incremental pieces.
    start: Option<[Expr; 2]>,
    /// True where incremental coordinates are put in force for it.
    switches: bool,
    ccw: bool,
    /// What else the block says.
    lead: Vec<NcItem>,
    site: SourceInfo,
}

impl Turn {
    /// The arc of a block; none if the block says more than an arc and its feed.
    pub fn of(stmt: &Stmt, ccw: bool, incremental: bool, start: Option<[Expr; 2]>) -> Option<Self> {
        let nc = stmt.kind.nc()?;
        let ends = [Role::X, Role::Y].map(|role| nc.word(role).cloned());
        let centre = [Role::ArcI, Role::ArcJ].map(|role| nc.word(role).cloned().unwrap_or(Expr::Number(0.0)));
        let closed = ends.iter().all(Option::is_none);
        let start = start.filter(|_| !incremental);
        if !incremental && !closed && start.is_none() {
            return None;
        }
        let mut lead = Vec::new();
        for item in &nc.items {
            match item {
                NcItem::Word(Role::X | Role::Y | Role::ArcI | Role::ArcJ, _) => {}
                NcItem::Word(Role::Feed, _) => lead.push(item.clone()),
                NcItem::Op(op) if op.group() == Group::Motion => {}
                NcItem::Op(op) if matches!(op.group(), Group::Distance | Group::FeedMode) => {
                    lead.push(item.clone());
                }
                _ => return None,
            }
        }
        let switches = !incremental && start.is_none();
        if switches {
            lead.retain(|item| *item != NcItem::Op(Op::Absolute));
            lead.insert(0, NcItem::Op(Op::Incremental));
        }
        Some(Self { ends, centre, start, switches, ccw, lead, site: stmt.site.clone() })
    }

    /// Lays the arc down; where it ends, in absolute numbers if it began so.
    pub fn lay(self, builder: &mut Builder, temps: &mut u32) {
        let aside = || SourceInfo { span: self.site.span, ..SourceInfo::default() };
        let mut temp = || {
            *temps += 1;
            Var { class: Class::Temp, number: *temps }
        };
        let after = builder.fresh();
        unless_skipped(builder, self.site.skip, after);
        let set = |builder: &mut Builder, var: Var, value: Expr| {
            builder.push(StmtKind::Assign { target: Place::Var(var), value }, aside());
        };
        // Each piece names its code: the pieces of a loop are come to from two sides.
        let code = NcItem::Op(if self.ccw { Op::ArcCcw } else { Op::ArcCw });
        let move_by = |builder: &mut Builder, [x, y]: [Expr; 2], radius: Var| {
            let radius = Expr::Negate(Box::new(Expr::Var(radius)));
            let words = [(Role::X, x), (Role::Y, y), (Role::ArcRadius, radius)];
            let words = words.into_iter().map(|(role, value)| NcItem::Word(role, value));
            let items = std::iter::once(code.clone()).chain(words).collect();
            builder.push(StmtKind::Nc(Nc { items }), aside());
        };
        // Where the start lies from the centre, how far the end is, and the radius, negative.
        let (u, w, radius) = ([temp(), temp()], [temp(), temp()], temp());
        let mut to = Vec::new();
        for axis in 0..2 {
            let start = self.start.as_ref().map(|start| start[axis].clone());
            let end = self.ends[axis].clone().map(|end| match end {
                Expr::Number(_) | Expr::Var(_) => end,
                end => {
                    let held = temp();
                    set(builder, held, end);
                    Expr::Var(held)
                }
            });
            let way = match (&end, &start) {
                (Some(end), Some(start)) => sub(end.clone(), start.clone()),
                (Some(end), None) => sum(end.clone(), Expr::Number(0.0)),
                (None, _) => Expr::Number(0.0),
            };
            set(builder, u[axis], neg(self.centre[axis].clone()));
            set(builder, w[axis], way);
            to.push(self.start.as_ref().and(end.or(start)));
        }
        let ([a, b], [x, y], r) = (u.map(Expr::Var), w.map(Expr::Var), Expr::Var(radius));
        let squares = sum(mul(a.clone(), a.clone()), mul(b.clone(), b.clone()));
        set(builder, radius, neg(Expr::Call(Func::Sqrt, [squares].into())));
        let site = SourceInfo { skip: None, ..self.site.clone() };
        let kind =
            if self.lead.is_empty() { StmtKind::Comment } else { StmtKind::Nc(Nc { items: self.lead }) };
        builder.push(kind, site);
        let (head, body, last) = (builder.fresh(), builder.fresh(), builder.fresh());
        let cross = || {
            let (one, other) = (mul(a.clone(), y.clone()), mul(b.clone(), x.clone()));
            if self.ccw { sub(one, other) } else { sub(other, one) }
        };
        let branch = |builder: &mut Builder, relation, value, then| {
            let cond = Cond::Compare(relation, value, Expr::Number(0.0));
            builder
                .end(TermKind::Branch { cond: Box::new(cond), then, otherwise: body }, SourceInfo::default());
        };
        let ahead = sum(cross(), mul(r.clone(), Expr::Number(ONE_PLACE)));
        branch(builder, Relation::Greater, ahead, head);
        builder.start(head);
        let along = sum(sum(mul(r.clone(), r.clone()), mul(a.clone(), x.clone())), mul(b.clone(), y.clone()));
        let within = sum(along, mul(cross(), Expr::Number(TAN_80)));
        branch(builder, Relation::GreaterEqual, within, last);
        builder.start(body);
        let side = if self.ccw { SIN_120 } else { -SIN_120 };
        let by = [temp(), temp()];
        set(builder, by[0], sub(mul(a.clone(), Expr::Number(-1.5)), mul(b.clone(), Expr::Number(side))));
        set(builder, by[1], sub(mul(a, Expr::Number(side)), mul(b, Expr::Number(1.5))));
        for axis in 0..2 {
            set(builder, u[axis], sum(Expr::Var(u[axis]), Expr::Var(by[axis])));
            set(builder, w[axis], sub(Expr::Var(w[axis]), Expr::Var(by[axis])));
        }
        let piece = |axis: usize| match &to[axis] {
            Some(to) => sub(to.clone(), Expr::Var(w[axis])),
            None => Expr::Var(by[axis]),
        };
        move_by(builder, [piece(0), piece(1)], radius);
        builder.end(TermKind::Jump(head), SourceInfo::default());
        builder.start(last);
        let end = |axis: usize| to[axis].clone().unwrap_or(Expr::Var(w[axis]));
        move_by(builder, [end(0), end(1)], radius);
        if self.switches {
            builder.push(StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::Absolute)] }), aside());
        }
        builder.start(after);
    }
}

fn sum(a: Expr, b: Expr) -> Expr {
    Expr::binary(BinOp::Add, a, b)
}

fn sub(a: Expr, b: Expr) -> Expr {
    if b.constant() == Some(0.0) {
        return a;
    }
    Expr::binary(BinOp::Sub, a, b)
}

fn mul(a: Expr, b: Expr) -> Expr {
    Expr::binary(BinOp::Mul, a, b)
}

fn neg(a: Expr) -> Expr {
    match a {
        Expr::Number(number) => Expr::Number(0.0 - number),
        Expr::Negate(inner) => sum(*inner, Expr::Number(0.0)),
        a => Expr::Negate(Box::new(a)),
    }
}
