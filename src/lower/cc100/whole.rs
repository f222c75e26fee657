//! INC and DEC of variables that are known to be whole.
//!
//! Lowering writes DEC V1 as `FIX[V1]-1`: the fraction goes first. Law: FIX of a
//! whole number is that number. Side condition: on every way here the variable
//! was last given a whole constant, as counters are, or a sum, difference or product
//! of values that are whole whatever an operator puts for a constant, or was stepped
//! when it was whole, and no other program ran since. Counter-examples: `V6=V5+1`
//! after `V5=V4/50`; and `V12=V10`, INC, DEC after `V10=400`, which finds out
//! whether the operator's V10 is whole.

use super::parts::leaves;
use crate::canon::Func;
use crate::dialect::Question;
use crate::ir::analysis::Cfg;
use crate::ir::analysis::dataflow::{Analysis, Direction, Lattice, solve_everywhere};
use crate::ir::{BinOp, Block, BlockId, Class, Expr, Place, Program, Stmt, StmtKind, Var};
use crate::lower::common::Findings;

/// One bit a variable of the control. 99 numbers and 26 letters fit.
type Variables = u128;

fn bit(var: Var) -> Variables {
    if var.class == Class::Global { 1u128.checked_shl(var.number).unwrap_or(0) } else { 0 }
}

/// The variables that are whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Wholes {
    /// As the text stands.
    written: Variables,
    /// Whatever number stands for a constant that one of them is given.
    always: Variables,
}

impl Lattice for Wholes {
    fn join(&mut self, other: &Self) -> bool {
        let joined = Self { written: self.written & other.written, always: self.always & other.always };
        std::mem::replace(self, joined) != joined
    }
}

impl Wholes {
    fn step(self, stmt: &Stmt) -> Self {
        let StmtKind::Assign { target: Place::Var(var), value } = &stmt.kind else { return self };
        let set = |of: Variables, whole: bool| if whole { of | bit(*var) } else { of & !bit(*var) };
        let constant = value.constant().is_some_and(|number| number.fract() == 0.0);
        let always = !constant && is_whole(value, self.always);
        // A counter that is stepped stays one.
        let counts = matches!(value, Expr::Binary(_, operands) if operands[0] == Expr::Var(*var));
        let written = constant || always || counts && is_whole(value, self.always | self.written & bit(*var));
        Self { written: set(self.written, written), always: set(self.always, always) }
    }
}

/// What blocks do to them.
struct Steps;

impl Analysis for Steps {
    type State = Wholes;
    const DIRECTION: Direction = Direction::Forward;

    fn entries(&self, _: &Cfg) -> Vec<(BlockId, Wholes)> {
        vec![(BlockId(0), Wholes::default())]
    }

    fn block(&self, _: BlockId, block: &Block, known: &mut Wholes) {
        *known = match leaves(block) {
            true => Wholes::default(),
            false => block.stmts.iter().fold(*known, Wholes::step),
        };
    }
}

fn is_whole(value: &Expr, known: Variables) -> bool {
    match value {
        Expr::Number(number) => number.fract() == 0.0,
        Expr::Var(var) => known & bit(*var) != 0,
        Expr::Negate(inner) => is_whole(inner, known),
        Expr::Call(Func::Fix, _) => true,
        Expr::Binary(BinOp::Add | BinOp::Sub | BinOp::Mul, operands) => {
            operands.iter().all(|operand| is_whole(operand, known))
        }
        _ => false,
    }
}

/// Takes FIX out of the steps of whole variables, and reports the other steps.
pub fn resolve(program: &mut Program, findings: &mut Findings<'_>) {
    let starts = solve_everywhere(&Steps, program, &Cfg::parts(program), &Wholes::default());
    for (at, block) in (0..).zip(&mut program.blocks) {
        let mut known = starts.at(BlockId(at)).copied().unwrap_or_default();
        for stmt in &mut block.stmts {
            let span = stmt.site.span;
            if let StmtKind::Assign { target: Place::Var(var), value: Expr::Binary(_, operands) } =
                &mut stmt.kind
                && let [counted, _] = &mut **operands
                && *counted == Expr::Call(Func::Fix, [Expr::Var(*var)].into())
            {
                if known.written & bit(*var) != 0 {
                    *counted = Expr::Var(*var);
                } else if findings.behaviour(Question::StepDropsFraction, span) != Some("true") {
                    findings.not_understood(span, "no source says what a step does with a fraction");
                } else if findings.only(Question::FixTowardZero, "true", span).is_some() {
                    // A machine profile has said toward which side.
                } else {
                    let why = "the fraction is taken off before the step, toward zero";
                    findings.unconfirmed(Question::StepDropsFraction.fact().into(), Some(why), span);
                }
            }
            known = known.step(stmt);
        }
    }
}
