//! Lays down the moves of a round pocket.

use crate::canon::{Func, Op, Role, Sys};
use crate::ir::{
    BinOp, Builder, Class, Cond, Expr, Nc, NcItem, Place, Relation, SourceInfo, StmtKind, TermKind, Var,
};

/// A round pocket whose words are numbers.
pub(super) struct Pocket {
    /// What else its block says, which acts first.
    pub lead: Vec<NcItem>,
    pub clockwise: bool,
    /// The radii of the finished circles, from the first to the last.
    pub circles: Vec<f64>,
    /// The number of the cutter radius that is taken off; 0 for none.
    pub offset: f64,
    /// How often it is milled, each time deeper.
    pub count: usize,
    pub depth: Option<Expr>,
    pub feed: Option<Expr>,
    /// True under absolute coordinates, which are back in force after it.
    pub absolute: bool,
    /// The motion that the next block needs.
    pub motion: Option<Op>,
    /// Least increments in a unit.
    pub parts: f64,
    /// True where its tool was found small enough before.
    pub fits: bool,
    /// True where the program moves aside after it at its depth.
    pub goes_on: bool,
    /// True where the target keeps wear apart from a size: else the size of its table has it.
    pub wears: bool,
    /// True where it may stand in coordinates that are turned.
    pub is_turned: bool,
}

/// Writes its moves.
pub(super) fn write(builder: &mut Builder, pocket: &Pocket, temp: &mut u32, site: SourceInfo) {
    let place = SourceInfo { span: site.span, ..SourceInfo::default() };
    let mut lead = pocket.lead.clone();
    // Compensation that comes later may go by it.
    lead.push(NcItem::Word(Role::RadiusOffset, Expr::Number(pocket.offset)));
    builder.push(StmtKind::Nc(Nc { items: lead }), site);
    let cutter = (pocket.offset != 0.0).then(|| cutter(builder, pocket, temp, &place));
    let mut path =
        Path { builder, pocket, cutter, place, feed: pocket.feed.clone(), incremental: !pocket.absolute };
    for _ in 0..pocket.count {
        path.once();
    }
    let mut items = Vec::new();
    items.extend(pocket.absolute.then_some(NcItem::Op(Op::Absolute)));
    items.extend(pocket.motion.map(NcItem::Op));
    if !items.is_empty() {
        path.block(items);
    }
}

/// Reads the cutter radius, in whole increments, and stops where it is too large.
fn cutter(builder: &mut Builder, pocket: &Pocket, temp: &mut u32, place: &SourceInfo) -> Var {
    *temp += 1;
    let var = Var { class: Class::Temp, number: *temp };
    let held = |state| Expr::System(state, [Expr::Number(pocket.offset)].into());
    let size = held(Sys::RadiusGeometry);
    let size = if pocket.wears { Expr::binary(BinOp::Add, size, held(Sys::RadiusWear)) } else { size };
    let parts = Expr::Number(pocket.parts);
    let whole = Expr::Call(Func::Round, [Expr::binary(BinOp::Mul, size, parts.clone())].into());
    let value = Expr::binary(BinOp::Div, whole, parts);
    builder.push(StmtKind::Assign { target: Place::Var(var), value }, place.clone());
    if pocket.fits {
        return var;
    }
    let first = pocket.circles.first().copied().unwrap_or_default();
    let cond = Cond::Compare(Relation::GreaterEqual, Expr::Var(var), Expr::Number(first));
    let (stop, go) = (builder.fresh(), builder.fresh());
    builder.end(TermKind::Branch { cond: Box::new(cond), then: stop, otherwise: go }, place.clone());
    builder.start(stop);
    let alarm =
        StmtKind::Alarm { number: Expr::Number(1.0).into(), text: "TOOL TOO LARGE FOR POCKET".into() };
    builder.push(alarm, place.clone());
    builder.end(TermKind::End { rewind: false }, place.clone());
    builder.start(go);
    var
}

struct Path<'p> {
    builder: &'p mut Builder,
    pocket: &'p Pocket,
    cutter: Option<Var>,
    place: SourceInfo,
    /// The feed, until the first move.
    feed: Option<Expr>,
    incremental: bool,
}

impl Path<'_> {
    fn block(&mut self, items: Vec<NcItem>) {
        self.builder.push(StmtKind::Nc(Nc { items }), self.place.clone());
    }

    /// A length less so many cutter radii, with a sign.
    fn length(&self, length: f64, cutters: f64, sign: f64) -> Expr {
        let length = (length * self.pocket.parts * 2.0).round() / self.pocket.parts / 2.0;
        let Some(cutter) = self.cutter else { return Expr::Number(sign * length) };
        let cutter = match cutters {
            1.0 => Expr::Var(cutter),
            cutters if cutters < 1.0 => {
                Expr::binary(BinOp::Div, Expr::Var(cutter), Expr::Number(1.0 / cutters))
            }
            cutters => Expr::binary(BinOp::Mul, Expr::Var(cutter), Expr::Number(cutters)),
        };
        let length = Expr::Number(length);
        match sign > 0.0 {
            true => Expr::binary(BinOp::Sub, length, cutter),
            false => Expr::binary(BinOp::Sub, cutter, length),
        }
    }

    fn once(&mut self) {
        if let Some(depth) = &self.pocket.depth {
            let mut items = vec![NcItem::Op(Op::Linear), NcItem::Word(Role::Z, depth.clone())];
            items.extend(self.feed.take().map(|feed| NcItem::Word(Role::Feed, feed)));
            self.block(items);
        }
        let (mut from, mut cutters, mut side) = (0.0, 0.0, 1.0);
        for radius in &self.pocket.circles {
            self.half((from + radius, cutters + 1.0), side);
            let middle = self.length(*radius, 1.0, -side);
            self.arc(None, middle);
            (from, cutters, side) = (*radius, 1.0, -side);
        }
        self.half((from, cutters), side);
    }

    /// A half circle that ends so far along X.
    fn half(&mut self, (way, cutters): (f64, f64), sign: f64) {
        let to = self.length(way, cutters, sign);
        let middle = self.length(way / 2.0, cutters / 2.0, sign);
        self.arc(Some(to), middle);
    }

    fn arc(&mut self, to: Option<Expr>, middle: Expr) {
        let mut items = Vec::new();
        items
            .extend((!std::mem::replace(&mut self.incremental, true)).then_some(NcItem::Op(Op::Incremental)));
        items.push(NcItem::Op(if self.pocket.clockwise { Op::ArcCw } else { Op::ArcCcw }));
        items.extend(to.map(|to| NcItem::Word(Role::X, to)));
        items.push(NcItem::Word(Role::ArcI, middle));
        items.extend(self.feed.take().map(|feed| NcItem::Word(Role::Feed, feed)));
        self.block(items);
    }
}
