//! Cycles that are kept where the target takes something of them from its settings.
//!
//! Law: a thread that does not run out is cut between the codes that switch the run-out off and on. Side condition: no single pass is in force,
//! which a block of such a code might make once more. Counter-example: a thread of many passes after a single one.

use super::super::cycle_values::{Need, Values, constant};
use super::super::left_settings::{Left, leaves};
use super::super::setting_values::So;
use super::super::settings::{Kind, setting, takes};
use super::Run;
use super::written::runs_out;
use crate::assume::Predicate;
use crate::canon::{CycleSetting, Op, Role};
use crate::dialect::Control;
use crate::ir::{Expr, Nc, NcItem, SourceInfo, Stmt, StmtKind};
use crate::legalize::codes::ahead::ahead;
use crate::text::Span;
use std::collections::BTreeMap;

impl Run<'_> {
    /// True where codes of the target settle that a thread does not run out: the setting need not say it then.
    pub(super) fn ends_straight(&self, needs: &mut Vec<Need>) -> bool {
        let has = |op: Op| self.target.code_for(op, &BTreeMap::new()).is_some();
        let is_run_out = |need: &Need| is_straight(need, self.target);
        let Some(at) = needs.iter().position(is_run_out) else { return false };
        let may = !self.in_pass && has(Op::ThreadRunOutOff) && has(Op::ThreadRunOutOn);
        if may {
            needs.remove(at);
        }
        may
    }

    /// Gives a thread without a finishing pass the one that the target's cycle makes at least, where the shop leaves that to it.
    pub(super) fn finish_once(&mut self, span: Span, values: &mut Values) {
        let counts = takes(self.target, Op::ThreadingSetup, Role::ThreadForm)
            || setting(self.target, Op::Threading, Role::ThreadFinishes).is_some();
        let made = constant(values, Role::ThreadFinishes).unwrap_or(0.0);
        if counts && leaves(self.target) && made < 1.0 {
            self.leave_finishes(span, values);
            values.retain(|(role, _)| *role != Role::ThreadFinishes);
            values.push((Role::ThreadFinishes, Expr::Number(1.0)));
        }
    }

    /// Finishing passes that cannot follow the cycle: refused, or left to the target's.
    pub(super) fn no_finishes(&mut self, span: Span, values: &Values) {
        if leaves(self.target) {
            return self.leave_finishes(span, values);
        }
        let (what, help) =
            if runs_out(values) { (RUNS_OUT, RUNS_OUT_HELP) } else { (FINISHES, FINISHES_HELP) };
        self.refuse(span, what, help);
    }

    /// Says that the target's cycle makes another number of finishing passes.
    fn leave_finishes(&mut self, span: Span, values: &Values) {
        let value = Some(constant(values, Role::ThreadFinishes).unwrap_or(0.0));
        let what = CycleSetting::ThreadFinishes;
        self.found.push((
            span,
            String::new(),
            String::new(),
            So::Left(Left { what, name: None, value, unit: None }),
        ));
    }

    /// Says what of a cycle is left to settings of the target.
    pub(super) fn leave(&mut self, stmt: &Stmt, kind: &Kind, left: Vec<Left>) {
        for one in left {
            let role = one.name.as_deref().and_then(|name| self.target.setting_row(name));
            let role = role.and_then(|row| row.gives.or(row.otherwise));
            let unit = self.turned.filter(|_| role.is_some_and(Role::is_length)).map(|turned| turned.program);
            let stated =
                setting(self.target, kind.cycle, Role::ThreadAllowance).and_then(|(_, stated)| stated);
            let height = stmt.kind.nc().and_then(|nc| nc.word(Role::ThreadHeight)?.constant());
            if one.what == CycleSetting::ThreadAllowance
                && stated.zip(height).is_some_and(|(left, height)| left >= height)
            {
                self.refuse(stmt.site.span, NOTHING, NOTHING_HELP);
            }
            let so = So::Left(Left { unit, ..one });
            self.found.push((stmt.site.span, String::new(), String::new(), so));
        }
    }
}

/// True of a need that threads end straight.
fn is_straight((.., needs): &Need, target: &Control) -> bool {
    let Predicate::Setting(name, value) = needs else { return false };
    let row = target.setting_row(name);
    *value == 0.0 && row.is_some_and(|row| row.gives == Some(Role::ThreadRunOut))
}

/// A thread between the codes that switch its run-out off and on.
pub(super) fn straight(mut stmt: Stmt) -> Vec<Stmt> {
    let off = ahead(&mut stmt, vec![NcItem::Op(Op::ThreadRunOutOff)]);
    let site = SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
    let on = Stmt { kind: StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::ThreadRunOutOn)] }), site };
    vec![off, stmt, on]
}

const RUNS_OUT: &str = "the target finishes a thread in one pass, and this one has more and runs out: the others are not written as single passes, as \
                        where the cycle begins, or a number of it, is not known here, or the target's single passes do not run out as its cycle does";
const RUNS_OUT_HELP: &str = "write X and Z of the start as numbers right before the thread, and a G code in the next block that moves; or give the thread one \
                             finishing pass and an allowance for it, or no run-out";
const FINISHES: &str = "the target finishes a thread in one pass, if something is left for it, and this one has more: they are not written out, as \
                        where the cycle begins, or a number of it, is not known here";
const FINISHES_HELP: &str = "write X and Z of the start as numbers right before the thread, and a G code in the next block that moves; or give the \
                             thread one finishing pass and an allowance for it";
const NOTHING: &str = "the target leaves as much of a thread for its last pass, by its setting, as this one is high: it has no pass before that";
const NOTHING_HELP: &str = "set the machine to leave less, and write it in its profile";
