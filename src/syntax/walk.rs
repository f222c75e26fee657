//! Walks over what a block says.

use super::{
    Expr, ExprKind, Index, Item, ItemKind, OutputPart, PrintPart, TableRow, Target, TestSubject, VarRef,
};

/// Calls `visit` on each item, those under IF included, outermost first.
pub fn for_each_item<'a>(items: &'a [Item], visit: &mut dyn FnMut(&'a Item)) {
    for item in items {
        visit(item);
        if let ItemKind::If { body, .. } = &item.kind {
            for_each_item(body, visit);
        }
    }
}

/// Calls `visit` on each expression of the items, outermost first.
pub fn for_each_expr<'a>(items: &'a [Item], visit: &mut dyn FnMut(&'a Expr)) {
    for_each_item(items, &mut |item| match &item.kind {
        ItemKind::Word(word) => word.value.iter().for_each(|e| expr(e, visit)),
        ItemKind::Assign { target, value, .. } => {
            variable(target, visit);
            expr(value, visit);
        }
        ItemKind::If { condition, .. } => expr(condition, visit),
        ItemKind::Do { condition: Some(condition), .. } => expr(condition, visit),
        ItemKind::Goto(Target::Computed(e)) | ItemKind::Start(e) => expr(e, visit),
        ItemKind::Branch { target: Target::Computed(e), .. } => expr(e, visit),
        ItemKind::Test(TestSubject::Variable(v)) | ItemKind::Step { target: v, .. } | ItemKind::Timer(v) => {
            variable(v, visit);
        }
        ItemKind::Transfer { table, cells } => {
            if let TableRow::Variable(v) = &table.row {
                variable(v, visit);
            }
            cells.iter().for_each(|cell| variable(&cell.variable, visit));
        }
        ItemKind::Output { parts, .. } => {
            for part in parts {
                if let OutputPart::Value { value, .. } = part {
                    expr(value, visit);
                }
            }
        }
        ItemKind::Print { parts, .. } => {
            for part in parts {
                if let PrintPart::Value(value) = part {
                    expr(value, visit);
                }
            }
        }
        ItemKind::Input { targets, .. } => targets.iter().for_each(|v| variable(v, visit)),
        ItemKind::Clear(ranges) => {
            for (from, to) in ranges {
                variable(from, visit);
                to.iter().for_each(|v| variable(v, visit));
            }
        }
        _ => {}
    });
}

fn variable<'a>(v: &'a VarRef, visit: &mut dyn FnMut(&'a Expr)) {
    if let Index::Computed(e) = &v.index {
        expr(e, visit);
    }
}

fn expr<'a>(e: &'a Expr, visit: &mut dyn FnMut(&'a Expr)) {
    visit(e);
    match &e.kind {
        ExprKind::Number(_) => {}
        ExprKind::Variable(v) => variable(v, visit),
        ExprKind::Negate(a) | ExprKind::Plus(a) | ExprKind::Not(a) | ExprKind::Group(a) => expr(a, visit),
        ExprKind::Binary(_, operands) => operands.iter().for_each(|a| expr(a, visit)),
        ExprKind::Call { arguments, .. } => arguments.iter().for_each(|a| expr(a, visit)),
    }
}
