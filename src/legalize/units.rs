//! The unit of lengths, where the source's comes from the control and not from the program.
//!
//! Law: a program that names no unit runs in the one its control is set to. Where the source is known
//! to be in one unit (its table or the shop's profile says so), the target is told at the head of each main program.
//! Side condition: where it is not known, the target must be set as the source was; that is a review diagnostic.

use super::emptied::drop_emptied;
use super::exposed::roots;
use super::{Context, reachable};
use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Units;
use crate::ir::{BlockId, Class, Module, Nc, NcItem, Program, Site, Stmt, StmtKind, TermKind};

/// Tells the target the unit of each main program.
pub fn run(module: &mut Module, context: &mut Context<'_>) {
    let checks = |op: Op| matches!(op, Op::CheckInch | Op::CheckMetric);
    let roots = roots(module);
    let same_family = context.source.dialect().family == context.target.dialect().family;
    for (index, program) in module.programs.iter_mut().enumerate() {
        let names = |wanted: &dyn Fn(Op) -> bool| {
            let mut ncs = program.blocks.iter().flat_map(|b| &b.stmts).filter_map(|stmt| match &stmt.kind {
                StmtKind::Nc(nc) => Some(nc),
                _ => None,
            });
            ncs.any(|nc| nc.ops().any(wanted))
        };
        let named = names(&|op| matches!(op, Op::Inch | Op::Metric));
        let checked = match (names(&|op| op == Op::CheckInch), names(&|op| op == Op::CheckMetric)) {
            (true, false) => Some(Units::Inch),
            (false, true) => Some(Units::Metric),
            _ => None,
        };
        for block in &mut program.blocks {
            for stmt in &mut block.stmts {
                if let StmtKind::Nc(nc) = &mut stmt.kind {
                    nc.items.retain(|item| !matches!(item, NcItem::Op(op) if checks(*op)));
                }
            }
            drop_emptied(block);
        }
        if named || same_family || !is_main(program, roots.contains(&index)) || !names_axis(program) {
            continue;
        }
        match context.source.units().or(checked) {
            Some(units) => head(program, if units == Units::Inch { Op::Inch } else { Op::Metric }),
            None => {
                let what = "the program does not name its unit: the target must be set to the unit that the source was set to (a machine profile with 'units' writes it into the program)";
                context.add_once(index, "units", Diagnostic::new(Code::Conditional, program.site.span, what));
            }
        }
    }
}

/// True for a program that ends the run, unless others call it and it may return to them. What only its
/// subroutines do, or what nothing reaches, says nothing of it.
fn is_main(program: &Program, is_root: bool) -> bool {
    let own = reachable(program, BlockId(0));
    let (mut end, mut back) = (false, false);
    for kind in own.into_iter().filter_map(|id| program.block(id)).map(|block| &block.term.kind) {
        end |= matches!(kind, TermKind::End { .. } | TermKind::Stray);
        back |= matches!(kind, TermKind::Return { .. });
    }
    end && (is_root || !back)
}

fn names_axis(program: &Program) -> bool {
    program
        .blocks
        .iter()
        .flat_map(|b| &b.stmts)
        .any(|stmt| matches!(&stmt.kind, StmtKind::Nc(nc) if nc.names_axis()))
}

fn head(program: &mut Program, op: Op) {
    if let Some(block) = program.blocks.first_mut() {
        let kind = StmtKind::Nc(Nc { items: vec![NcItem::Op(op)] });
        let at = block
            .stmts
            .iter()
            .take_while(|stmt| matches!(stmt.kind, StmtKind::Remark | StmtKind::ClearAll(Class::Global)))
            .count();
        block.stmts.insert(at, Stmt { kind, site: Site::default() });
    }
}
