//! Expressions with more brackets inside one another than the target takes, or with more characters than a line has.
//!
//! Law: `f(e)` is `t = e` and then `f(t)`, because an operand is evaluated before what it stands in, and nothing runs
//! between. Side conditions: the operand means the same in an assignment, which a rounding to the increment of a word
//! and state of the running block do not; a temporary holds what the control's arithmetic yields, as a register would.
//! Operands are taken out from the inside, so that each piece is as large as the target takes.

use crate::canon::{Func, Sys};
use crate::dialect::{Control, OperandPlace};
use crate::ir::{
    Block, Class, Cond, Expr, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind, Var,
};
use crate::legalize::context::Context;
use crate::legalize::expressions::cost::{Measure, REGISTER, Size};
use crate::legalize::rewrite::{self, Position, highest_temp};

/// Characters that stand beside an operand in its place, and the brackets that it stands in there.
pub(in crate::legalize) fn beside(control: &Control, place: OperandPlace) -> (usize, u32) {
    control.form(place).map_or((0, 0), |form| (form.beside(), form.brackets()))
}

/// The place in the tables of an operand.
pub(in crate::legalize) fn place_of(position: Position) -> OperandPlace {
    match position {
        Position::Word(_) => OperandPlace::Word,
        Position::Code => OperandPlace::Code,
        Position::Argument(_) => OperandPlace::Argument,
        Position::Value => OperandPlace::Assignment,
        Position::Subscript => OperandPlace::Subscript,
        Position::Condition => OperandPlace::Condition,
        Position::Output => OperandPlace::Output,
        Position::Count => OperandPlace::Count,
        Position::Jump => OperandPlace::Jump,
    }
}

/// Tells whether conditions and what stands after their THEN share a line.
pub struct ThenLines<'c> {
    measure: Measure<'c>,
    /// Characters beside the condition, and those that the line has.
    beside: usize,
    room: usize,
}

impl<'c> ThenLines<'c> {
    /// Of a target.
    pub fn new(control: &'c Control) -> Self {
        let (beside, _) = beside(control, OperandPlace::Then);
        Self { measure: Measure::new(control), beside, room: control.room(OperandPlace::Then) }
    }

    /// True where a line of the target has room for a condition and the statement after its THEN.
    pub fn has_room(&self, cond: &Cond, stmt: &StmtKind) -> bool {
        let mut length = self.beside + self.measure.cond(cond).length;
        if let StmtKind::Nc(nc) = stmt {
            length += 4 * nc.items.len();
        }
        stmt.exprs(&mut |e| length += self.measure.expr(e).length + 2);
        length + REGISTER <= self.room
    }
}

/// Takes operands out of expressions that the target has no room for.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let measure = Measure::new(context.target);
    let depth = context.target.limit("brackets").unwrap_or(u32::MAX);
    let endless = |place: OperandPlace| context.target.room(place) == usize::MAX;
    if depth == u32::MAX && endless(OperandPlace::Word) && endless(OperandPlace::Assignment) {
        return false;
    }
    let highest = highest_temp(program);
    let (mosts, before) = Default::default();
    let mut cutter = Cutter { control: context.target, measure, depth, mosts, highest, before };
    for block in &mut program.blocks {
        cutter.block(block);
    }
    cutter.highest != highest
}

struct Cutter<'c> {
    control: &'c Control,
    measure: Measure<'c>,
    depth: u32,
    /// By place: what may stand there, once it was asked for.
    mosts: [Option<(u32, usize)>; OperandPlace::ALL.len()],
    highest: u32,
    before: Vec<(Var, Expr)>,
}

/// What a whole expression may measure where it stands.
#[derive(Clone, Copy)]
struct Most {
    depth: u32,
    length: usize,
    /// True where rounding is to the increment of a word.
    word: bool,
}

impl Most {
    fn holds(self, size: Size) -> bool {
        size.depth <= self.depth && size.length <= self.length
    }
}

impl Cutter<'_> {
    fn block(&mut self, block: &mut Block) {
        let mut at = 0;
        while let Some(stmt) = block.stmts.get_mut(at) {
            rewrite::statement(&mut stmt.kind, &mut |e, position| self.whole(e, position));
            if let StmtKind::Nc(nc) = &mut stmt.kind {
                self.words(&mut nc.items);
            }
            let skip = stmt.site.skip;
            at += self.lay(&mut block.stmts, at, skip) + 1;
        }
        rewrite::terminator(&mut block.term.kind, &mut |e, position| self.whole(e, position));
        if let TermKind::Branch { cond, .. } = &mut block.term.kind
            && let Cond::Compare(_, a, b) = &mut **cond
        {
            self.sides(a, b);
        }
        let end = block.stmts.len();
        self.lay(&mut block.stmts, end, None);
    }

    /// Puts what was taken out before the statement; how many statements that is.
    fn lay(&mut self, stmts: &mut Stmts, at: usize, skip: Option<u8>) -> usize {
        if self.before.is_empty() {
            return 0;
        }
        let count = self.before.len();
        let assigns = self.before.drain(..).map(|(var, value)| Stmt {
            kind: StmtKind::Assign { target: Place::Var(var), value },
            site: SourceInfo { skip, ..SourceInfo::default() },
        });
        stmts.splice(at..at, assigns);
        count
    }

    fn most(&mut self, position: Position) -> Most {
        let place = place_of(position);
        let (control, most) = (self.control, self.depth);
        let (depth, length) = *self.mosts[place as usize].get_or_insert_with(|| {
            let (beside, brackets) = beside(control, place);
            (most.saturating_sub(brackets), control.room(place).saturating_sub(beside))
        });
        Most { depth, length, word: matches!(position, Position::Word(_)) }
    }

    fn whole(&mut self, e: &mut Expr, position: Position) {
        if is_leaf(e) {
            return;
        }
        let most = self.most(position);
        if !most.holds(self.measure.bound(e)) && !most.holds(self.measure.expr(e)) {
            *e = self.cut(std::mem::replace(e, Expr::Vacant), most).0;
        }
    }

    /// An expression of which nothing is larger than it may be, its size, and whether it may be taken out.
    fn cut(&mut self, mut e: Expr, most: Most) -> (Expr, Size, bool) {
        let mut sizes: Vec<(Size, bool)> = Vec::new();
        e.exprs_mut(&mut |operand| {
            let (cut, size, free) = self.cut(std::mem::replace(operand, Expr::Vacant), most);
            *operand = cut;
            sizes.push((size, free));
        });
        let free = sizes.iter().all(|(_, free)| *free) && is_free(&e, most.word);
        loop {
            let plain: Vec<Size> = sizes.iter().map(|(size, _)| *size).collect();
            let size = self.measure.joined(&e, &plain);
            if most.holds(size) {
                return (e, size, free);
            }
            let deep = size.depth > most.depth;
            let worst = (0..sizes.len())
                .filter(|&at| sizes[at].1 && sizes[at].0.length > REGISTER)
                .max_by_key(|&at| {
                    if deep {
                        (sizes[at].0.depth as usize, sizes[at].0.length)
                    } else {
                        (sizes[at].0.length, 0)
                    }
                });
            let Some(worst) = worst else { return (e, size, free) };
            let mut at = 0;
            let mut taken = None;
            e.exprs_mut(&mut |operand| {
                if at == worst && !is_leaf(operand) {
                    taken = Some(std::mem::replace(operand, Expr::Vacant));
                }
                at += 1;
            });
            sizes[worst] = (Size { depth: 0, length: REGISTER }, true);
            let Some(taken) = taken else { continue };
            let temp = Expr::Var(self.materialize(taken));
            at = 0;
            e.exprs_mut(&mut |operand| {
                if at == worst {
                    *operand = temp.clone();
                }
                at += 1;
            });
        }
    }

    /// Takes the longest values out of a block that is longer than a line.
    fn words(&mut self, items: &mut [NcItem]) {
        let room = self.control.room(OperandPlace::Word);
        let most = items.iter().map(|item| match item {
            NcItem::Word(_, value) => self.measure.bound(value).length + 4,
            _ => 4,
        });
        if most.sum::<usize>() <= room {
            return;
        }
        loop {
            let lengths = items.iter().map(|item| match item {
                NcItem::Word(_, value) => self.measure.expr(value).length + 4,
                _ => 4,
            });
            if lengths.sum::<usize>() <= room {
                return;
            }
            let mut longest: Option<(usize, usize)> = None;
            for (at, item) in items.iter().enumerate() {
                let NcItem::Word(role, value) = item else { continue };
                let length = self.measure.expr(value).length;
                let movable = !is_leaf(value)
                    && !value.may_be_vacant()
                    && is_free_all(value, true)
                    && !role.is_integer();
                if movable && length > REGISTER && longest.is_none_or(|(_, most)| length > most) {
                    longest = Some((at, length));
                }
            }
            let Some((at, _)) = longest else { return };
            let Some(NcItem::Word(_, value)) = items.get_mut(at) else { return };
            let taken = std::mem::replace(value, Expr::Vacant);
            *value = Expr::Var(self.materialize(taken));
        }
    }

    /// Takes the longer side out of a comparison that is longer than a line.
    fn sides(&mut self, a: &mut Expr, b: &mut Expr) {
        let most = self.most(Position::Condition);
        if self.measure.bound(a).length + self.measure.bound(b).length + 8 <= most.length {
            return;
        }
        loop {
            let [left, right] = [&*a, &*b].map(|e| self.measure.expr(e).length);
            if left + right + 8 <= most.length {
                return;
            }
            let side = if left >= right { &mut *a } else { &mut *b };
            if is_leaf(side) || side.may_be_vacant() || !is_free_all(side, false) {
                return;
            }
            let taken = std::mem::replace(side, Expr::Vacant);
            *side = Expr::Var(self.materialize(taken));
        }
    }

    fn materialize(&mut self, value: Expr) -> Var {
        self.highest += 1;
        let temp = Var { class: Class::Temp, number: self.highest };
        self.before.push((temp, value));
        temp
    }
}

pub(super) fn is_leaf(e: &Expr) -> bool {
    matches!(e, Expr::Number(_) | Expr::Increments(_) | Expr::Vacant | Expr::Var(_))
}

/// True where the operation gives the same in an assignment before the statement, whatever its operands are.
fn is_free(e: &Expr, word: bool) -> bool {
    match e {
        Expr::Call(Func::RoundIncrement, _) => !word,
        Expr::System(Sys::ModalNow | Sys::AddressNow, _) | Expr::Increments(_) => false,
        _ => true,
    }
}

pub(super) fn is_free_all(e: &Expr, word: bool) -> bool {
    let mut free = true;
    e.walk(&mut |e| free &= is_free(e, word));
    free
}
