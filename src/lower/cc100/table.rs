//! Transfers between variables and the control's tables, and tests of its state.

use super::Lowering;
use crate::canon::{Group, Op, Role, Sys};
use crate::dialect::Units;
use crate::ir::{BinOp, Cond, Expr, Place, Relation, SourceInfo, StmtKind};
use crate::syntax::{Cell, Table, TableRow, VarRef};
use crate::text::Span;
use thin_vec::ThinVec;

/// The row of a table that a transfer reaches.
enum Store {
    /// A tool's row of the tool store, by its number.
    Tool(Expr),
    /// A row of the zero shift store, by the number of the work offset.
    Shift(Expr),
    /// What a code holds: a zero shift, the datum, the pole.
    Code(u32),
}

impl Lowering<'_> {
    /// Lowers COR and TRF: the side that the variable stands on gives the direction.
    pub(super) fn transfer(&mut self, table: &Table, cells: &[Cell], site: &SourceInfo, span: Span) {
        let Some(store) = self.store(table, cells, site, span) else { return };
        for cell in cells {
            let Some(variable) = self.variable(&cell.variable) else { continue };
            let Some(place) = self.cell(&store, cell, span) else {
                let message = format!("this table has no {} to read or write", cell.letter);
                self.findings.not_understood(span, message);
                continue;
            };
            if cell.store {
                self.push(StmtKind::Assign { target: place, value: Expr::Var(variable) }, site);
            } else {
                self.assign(variable, place.read(), site);
                let source = self.load;
                self.set_register(source, Expr::Var(variable), site);
            }
        }
    }

    fn store(&mut self, table: &Table, cells: &[Cell], site: &SourceInfo, span: Span) -> Option<Store> {
        match (table.name.as_str(), &table.row) {
            ("COR", TableRow::Word('T', number)) => Some(Store::Tool(Expr::Number(f64::from(*number)))),
            ("COR", TableRow::Variable(row)) => self.row(row, cells, site).map(Store::Tool),
            ("TRF", TableRow::Variable(row)) => {
                let row = self.row(row, cells, site)?;
                let before = Expr::Number(self.before_shifts()?);
                Some(Store::Shift(Expr::binary(BinOp::Sub, row, before)))
            }
            ("TRF", TableRow::Word('G', number)) => Some(Store::Code(*number)),
            _ => {
                self.findings.not_understood(span, "no source says what this table holds");
                None
            }
        }
    }

    /// The row that a variable names. It is kept aside where the transfer itself overwrites it.
    fn row(&mut self, row: &VarRef, cells: &[Cell], site: &SourceInfo) -> Option<Expr> {
        let variable = self.variable(row)?;
        if cells.len() < 2 || !cells.iter().any(|cell| !cell.store && cell.variable.index == row.index) {
            return Some(Expr::Var(variable));
        }
        let kept = self.temp();
        self.assign(kept, Expr::Var(variable), site);
        Some(Expr::Var(kept))
    }

    /// What is taken from the number of a zero shift's code to get the work offset's number.
    fn before_shifts(&self) -> Option<f64> {
        let rows = self.control.dialect().codes.iter().filter(|row| row.op == Op::SelectWork);
        let before = rows.filter_map(|row| Some(row.head()?.number() - row.fixed.get(&Role::WorkOffset)?));
        before.reduce(f64::min)
    }

    fn cell(&mut self, store: &Store, cell: &Cell, span: Span) -> Option<Place> {
        let name = match store {
            Store::Tool(_) => format!("COR {}", cell.letter),
            Store::Shift(_) => format!("TRF=G{} {}", self.before_shifts()? + 1.0, cell.letter),
            Store::Code(number) => format!("TRF=G{number} {}", cell.letter),
        };
        // Any tool will do to find the column, and the first zero shift likewise.
        let first = matches!(store, Store::Tool(_)).then_some(1);
        let (state, subscripts, row) = self.control.read_system(&name, first)?;
        if cell.store && !row.access.contains('w') {
            return None;
        }
        self.findings.rest_on(row, span);
        let mut subscripts: Vec<Expr> =
            subscripts.into_iter().map(|subscript| Expr::Number(f64::from(subscript))).collect();
        if let (Store::Tool(number) | Store::Shift(number), Some(first)) = (store, subscripts.first_mut()) {
            *first = number.clone();
        }
        Some(Place::System(state, subscripts.into()))
    }

    /// Lowers `TIM V1`.
    pub(super) fn timer(&mut self, target: &VarRef, site: &SourceInfo) {
        let Some(target) = self.variable(target) else { return };
        let Some((state, _, row)) = self.control.read_system("TIM", None) else {
            return self.findings.not_understood(site.span, "this control has no timer that can be read");
        };
        self.findings.rest_on(row, site.span);
        self.assign(target, Expr::System(state, ThinVec::new()), site);
        let source = self.load;
        self.set_register(source, Expr::Var(target), site);
    }

    /// What `TST G1` puts into the register: zero if the code is in force.
    pub(super) fn code_is_active(&mut self, number: u32, span: Span) -> Option<Expr> {
        let row = self.control.code('G', f64::from(number), &[]);
        let group = row.and_then(|row| match row.op.group() {
            group @ (Group::Motion | Group::Plane | Group::Distance | Group::FeedMode) => group.number(),
            group @ Group::WorkOffset if row.op == Op::SelectWork => group.number(),
            _ => None,
        });
        let (Some(row), Some(group)) = (row, group) else {
            self.findings.not_understood(span, "no other control can read whether this code is in force");
            return None;
        };
        self.findings.rest_on(row, span);
        let active = Expr::System(Sys::Modal, [Expr::Number(f64::from(group))].into());
        let differs = Cond::Compare(Relation::NotEqual, active, Expr::Number(f64::from(number)));
        Some(Expr::Truth(Box::new(differs)))
    }

    /// What `TST QM` puts into the register: zero if dimensions are metric.
    pub(super) fn flag(&mut self, flag: char, span: Span) -> Option<Expr> {
        match (flag, self.control.units()) {
            ('M', Some(Units::Metric)) => Some(Expr::Number(0.0)),
            ('M', Some(Units::Inch)) => Some(Expr::Number(1.0)),
            ('M', None) => {
                let message = "the unit is a setting of the machine: put `units` into its profile";
                self.findings.not_understood(span, message);
                None
            }
            _ => {
                self.findings.not_understood(span, "no other control can read whether an axis is mirrored");
                None
            }
        }
    }
}
