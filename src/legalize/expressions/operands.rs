//! Operands that the target does not take where they stand.
//!
//! Law: `f(e)` is `t = e` and then `f(t)`, because an operand is evaluated before what it stands in, and nothing runs
//! between; `-e` is `e * -1`; `a < b` is `t = a - b` and then `t < 0`. Which places take an expression, a variable or
//! a constant, how many operators an assignment takes and whether a register is compared with 0 are rows of the target
//! (`forms`, `limits`). Side conditions: the operand means the same in an assignment, which a rounding to the increment
//! of a word and state of the running block do not; a temporary is never vacant, so on a target that knows vacancy an
//! operand that may be vacant stays; a difference is 0 for equal numbers only, as it is in binary arithmetic that
//! underflows gradually. What stays where the target cannot take it has no spelling there, and is refused.
//!
//! Counter-example: `X[ROUND[#1]]` rounds to the increment of X, and `#2=ROUND[#1]` to a whole number.

use crate::canon::{Op, Role};
use crate::dialect::{Compares, Control, Form, Operand, OperandPlace, Question};
use crate::ir::{
    BinOp, Block, Class, Cond, Expr, Nc, NcItem, Place, Program, SourceInfo, Stmt, StmtKind, Stmts, TermKind,
    Var,
};
use crate::legalize::context::Context;
use crate::legalize::expressions::split::{is_free_all, is_leaf, place_of};
use crate::legalize::features::{Feature, Features};
use crate::legalize::rewrite::{self, Position, highest_temp};
use crate::legalize::variables::modal_reads::is_test;

/// True where the target has places that do not take everything, and the library may have something there.
pub fn concerns(features: &Features, context: &Context<'_>) -> bool {
    let printed = features.has(Feature::Print) || features.has(Feature::Output);
    let narrow = |place: &OperandPlace| match place {
        OperandPlace::Output => printed && narrows(context.target, *place),
        place => narrows(context.target, *place),
    };
    OperandPlace::ALL.iter().any(narrow) || most_operators(context.target) != u32::MAX
}

fn narrows(target: &Control, place: OperandPlace) -> bool {
    target.form(place).is_some_and(|form| !form.takes_all())
}

/// Operators and functions that an assignment takes.
fn most_operators(target: &Control) -> u32 {
    target.limit("operators").unwrap_or(u32::MAX)
}

/// Puts operands into temporaries where the target takes them so only.
pub fn run(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    let target = context.target;
    let mut taker = Taker {
        target,
        operators: most_operators(target),
        vacancy: target.is(Question::Vacancy),
        inverse: context.features.op(Op::FeedInverse),
        highest: highest_temp(program),
        before: Vec::new(),
        changed: false,
    };
    program.blocks.iter_mut().for_each(|block| taker.block(block));
    taker.changed
}

struct Taker<'c> {
    target: &'c Control,
    operators: u32,
    /// True where the target's variables may be vacant, and its temporaries not.
    vacancy: bool,
    /// True where a feed may be one of inverse time, which counts for its own block alone.
    inverse: bool,
    highest: u32,
    before: Vec<(Var, Expr)>,
    changed: bool,
}

impl Taker<'_> {
    fn block(&mut self, block: &mut Block) {
        let mut at = 0;
        while let Some(stmt) = block.stmts.get_mut(at) {
            if let Some(feed) = self.feed_apart(stmt) {
                block.stmts.insert(at, feed);
                continue;
            }
            let skip = stmt.site.skip;
            rewrite::statement(&mut stmt.kind, &mut |e, position| {
                if !self.is_opposite_radius(e, position) {
                    self.whole(e, place_of(position));
                }
            });
            if let StmtKind::Assign { target: Place::System(..), value } = &mut stmt.kind {
                self.whole(value, OperandPlace::State);
            }
            if let StmtKind::Nc(nc) = &mut stmt.kind {
                self.unmix(&mut nc.items);
            }
            at += self.lay(&mut block.stmts, at, skip) + 1;
        }
        match &mut block.term.kind {
            TermKind::Branch { cond, .. } => self.condition(cond),
            kind => rewrite::terminator(kind, &mut |e, position| self.whole(e, place_of(position))),
        }
        let end = block.stmts.len();
        self.lay(&mut block.stmts, end, None);
    }

    /// Takes the feed out of a drilling block with more computed words than there are registers for words: it stays in force from a
    /// block before.
    fn feed_apart(&mut self, stmt: &mut Stmt) -> Option<Stmt> {
        let StmtKind::Nc(nc) = &mut stmt.kind else { return None };
        let class = self.target.form(OperandPlace::Word)?.class.as_deref()?;
        let row = self.target.classes().iter().find(|row| row.class == class)?;
        let registers = row.last.saturating_sub(row.first) as usize + 1;
        let computed = |item: &&NcItem| matches!(item, NcItem::Word(_, value) if !is_literal(value));
        let many = nc.ops().any(Op::is_cycle) && nc.items.iter().filter(computed).count() > registers;
        let feed = |item: &NcItem| matches!(item, NcItem::Word(Role::Feed, value) if !is_literal(value));
        let at = nc.items.iter().position(feed).filter(|_| many && !self.inverse)?;
        self.changed = true;
        let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
        Some(Stmt { kind: StmtKind::Nc(Nc { items: vec![nc.items.remove(at)] }), site })
    }

    /// True for the radius of an arc in the form that stands for the shorter arc where that has a minus.
    fn is_opposite_radius(&self, e: &Expr, position: Position) -> bool {
        let short =
            self.target.behaviour(Question::ArcRadiusNegative).is_some_and(|row| row.value == "short");
        let opposite = matches!(e, Expr::Negate(inner) if matches!(**inner, Expr::Var(_)));
        position == Position::Word(Role::ArcRadius) && short && opposite
    }

    /// Puts what was taken out before the statement; how many statements that is.
    fn lay(&mut self, stmts: &mut Stmts, at: usize, skip: Option<u8>) -> usize {
        let assigns: Vec<Stmt> = self.before.drain(..).map(|(var, value)| assign(var, value, skip)).collect();
        let count = assigns.len();
        self.changed |= count > 0;
        stmts.splice(at..at, assigns);
        count
    }

    /// A whole expression, where it stands.
    fn whole(&mut self, e: &mut Expr, place: OperandPlace) {
        let (target, word) = (self.target, place == OperandPlace::Word);
        // Where calls have no arguments, one becomes an assignment.
        let assigned = || target.form(OperandPlace::Assignment).filter(|_| place == OperandPlace::Argument);
        let Some(form) = target.form(place).or_else(assigned) else { return };
        if !self.takes(form, e) {
            self.take_out(e, word);
        }
        if !is_leaf(e) {
            self.operators(e, word);
        }
    }

    /// Comparisons of two operands become those of their difference with 0, where the target has no others.
    fn condition(&mut self, cond: &mut Cond) {
        const PLACE: OperandPlace = OperandPlace::Condition;
        let zero = self.target.form(PLACE).is_some_and(|form| form.compares == Compares::Zero);
        match cond {
            cond if is_test(cond) => {}
            Cond::Compare(_, a, b) if zero => {
                let movable = |side: &Expr| self.is_movable(side, false);
                if *b != Expr::Number(0.0) && movable(a) && movable(b) {
                    let left = std::mem::replace(a, Expr::Vacant);
                    let right = std::mem::replace(b, Expr::Number(0.0));
                    *a = Expr::binary(BinOp::Sub, left, right);
                }
                self.whole(a, PLACE);
            }
            Cond::Compare(_, a, b) => [a, b].into_iter().for_each(|side| self.whole(side, PLACE)),
            Cond::Switch(_) => {}
            Cond::And(parts) | Cond::Or(parts) => parts.iter_mut().for_each(|part| self.condition(part)),
            Cond::Not(inner) => self.condition(inner),
        }
    }

    /// Constants of a move go to temporaries in a block that has variables, where the target does not mix them. What stays
    /// in force, like a feed, goes to a block of its own before, which the writer does.
    fn unmix(&mut self, items: &mut [NcItem]) {
        let mixed = self.target.form(OperandPlace::Word).is_none_or(|form| form.mixed);
        let computed = |item: &NcItem| match item {
            NcItem::Word(_, value) | NcItem::Code(_, value) => !is_literal(value),
            NcItem::Op(_) => false,
        };
        if mixed || !items.iter().any(computed) {
            return;
        }
        for item in items {
            if let NcItem::Word(role, value) = item
                && acts_with_move(*role)
                && is_literal(value)
                && self.is_movable(value, true)
            {
                let constant = std::mem::replace(value, Expr::Vacant);
                *value = Expr::Var(self.materialize(constant));
            }
        }
    }

    /// Puts an operand into a temporary, itself in a form that an assignment takes.
    fn take_out(&mut self, e: &mut Expr, word: bool) {
        if self.is_movable(e, word) {
            let mut value = std::mem::replace(e, Expr::Vacant);
            self.operators(&mut value, word);
            *e = Expr::Var(self.materialize(value));
        }
    }

    /// Gives an expression of an assignment no more operators than the target takes, and each of these the operands that
    /// it takes. How many are left.
    fn operators(&mut self, e: &mut Expr, word: bool) -> u32 {
        let target = self.target;
        if is_literal(e) {
            return 0;
        }
        if let Expr::Negate(inner) = e
            && target.operator("negate").is_none()
        {
            let inner = std::mem::replace(inner.as_mut(), Expr::Vacant);
            *e = Expr::binary(BinOp::Mul, inner, Expr::Number(-1.0));
            self.changed = true;
        }
        let forms = match e {
            Expr::Binary(..) => [OperandPlace::First, OperandPlace::Second].map(|place| target.form(place)),
            Expr::Negate(_) => [target.form(OperandPlace::First); 2],
            Expr::Call(..) => [target.form(OperandPlace::Function); 2],
            Expr::System(..) | Expr::Indirect(..) => [target.form(OperandPlace::Subscript); 2],
            _ => return 0,
        };
        let mut sum = u32::from(!matches!(e, Expr::System(..) | Expr::Indirect(..)));
        let mut at = 0;
        let mut counts: Vec<u32> = Vec::new();
        e.exprs_mut(&mut |operand| {
            let form = forms[at.min(1)];
            at += 1;
            if form.is_some_and(|form| !self.takes(form, operand)) {
                self.take_out(operand, word);
            }
            let count = if is_leaf(operand) { 0 } else { self.operators(operand, word) };
            counts.push(count);
            sum += count;
        });
        while sum > self.operators {
            let Some(worst) = (0..counts.len()).filter(|at| counts[*at] > 0).max_by_key(|at| counts[*at])
            else {
                break;
            };
            let mut at = 0;
            e.exprs_mut(&mut |operand| {
                if at == worst && self.is_movable(operand, word) {
                    let value = std::mem::replace(operand, Expr::Vacant);
                    *operand = Expr::Var(self.materialize(value));
                    sum -= counts[at];
                }
                at += 1;
            });
            counts[worst] = 0;
        }
        sum
    }

    /// True where an operand may stand in a place.
    fn takes(&self, form: &Form, e: &Expr) -> bool {
        if is_literal(e) {
            return form.takes(Operand::Literal);
        }
        if self.is_variable(e) {
            let of_class = |e: &Expr| match (&form.class, e) {
                // A temporary gets a register that its uses take.
                (None, _) | (_, Expr::Var(Var { class: Class::Temp, .. })) => true,
                (Some(class), Expr::Var(var)) => class_name(var.class) == class,
                _ => false,
            };
            return form.takes(Operand::Variable) && of_class(e);
        }
        form.takes(Operand::Expression)
    }

    /// True for a variable, and for state that the target has in a variable of the same space.
    fn is_variable(&self, e: &Expr) -> bool {
        match e {
            Expr::Var(_) => true,
            Expr::System(state, subscripts) => {
                let constant = |e: &Expr| e.constant().and_then(crate::ir::eval::whole);
                let numbers: Option<Vec<u32>> = subscripts.iter().map(constant).collect();
                let address =
                    numbers.as_deref().and_then(|numbers| self.target.system_address(*state, numbers));
                address.is_some_and(|(name, ..)| Some(name) == self.target.numbered())
            }
            _ => false,
        }
    }

    /// True where an operand is the same in a temporary.
    fn is_movable(&self, e: &Expr, word: bool) -> bool {
        *e != Expr::Vacant && is_free_all(e, word) && !(self.vacancy && e.may_be_vacant())
    }

    fn materialize(&mut self, value: Expr) -> Var {
        self.highest += 1;
        let temp = Var { class: Class::Temp, number: self.highest };
        self.before.push((temp, value));
        temp
    }
}

fn assign(var: Var, value: Expr, skip: Option<u8>) -> Stmt {
    let site = SourceInfo { skip, ..SourceInfo::default() };
    Stmt { kind: StmtKind::Assign { target: Place::Var(var), value }, site }
}

/// A constant, its sign too.
fn is_literal(e: &Expr) -> bool {
    match e {
        Expr::Number(_) | Expr::Increments(_) | Expr::Vacant => true,
        Expr::Negate(inner) => matches!(**inner, Expr::Number(_) | Expr::Increments(_)),
        _ => false,
    }
}

/// True for a word that means something beside its move only: others stay in force from a block before it.
fn acts_with_move(role: Role) -> bool {
    role.is_axis() || matches!(role, Role::ArcRadius | Role::ArcI | Role::ArcJ | Role::ArcK)
}

/// The name of a class of variables in the tables.
fn class_name(class: Class) -> &'static str {
    match class {
        Class::Local => "local",
        Class::Retained => "retained",
        Class::Parametric => "parametric",
        _ => "common",
    }
}
