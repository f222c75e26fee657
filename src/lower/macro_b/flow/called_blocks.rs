//! Calls of a part of the program by a computed number: `M97 P#4`.
//!
//! Law: the call of a block by a number does what the call of the block with that constant number does, so comparisons with
//! numbers and a call after each do the same; any other number stops with an alarm. The numbers are the constants that the program
//! gives to the variable, else all sequence numbers of the program. Side condition: no other number comes, which is told and can be
//! tried on a run. Counter-example: `M97 P#4`, where a caller sets `#4` to the number of another block.

use crate::assume::Predicate;
use crate::diag::{Code, Diagnostic};
use crate::ir::{Call, Callee, Cond, Expr, Relation, SourceInfo, StmtKind, TermKind};
use crate::lower::macro_b::build::Lowering;
use crate::syntax::{self, ExprKind, Item, ItemKind, VarRef};
use crate::text::Span;
use std::collections::BTreeSet;

/// The letter under which the emulated controls note the number of a called block.
const LETTER: char = 'P';

/// Most blocks that a call is written out for.
const MOST: usize = 8;

impl<'a> Lowering<'a> {
    /// Calls the block whose number a value is, so often.
    pub fn call_computed_block(
        &mut self,
        written: Option<&syntax::Expr>,
        value: &Expr,
        count: Option<&Expr>,
        site: &SourceInfo,
    ) {
        let numbers = self.numbers_of(written);
        if numbers.is_empty() || numbers.len() > MOST {
            let what = "the number of the called block is computed, and the program does not say which ones it may be";
            let help =
                "write the number; or give the variable its numbers in this program (IF[..] THEN #4=13)";
            self.findings.add(Diagnostic::new(Code::NotUnderstood, site.span, what).with_help(help));
            return;
        }
        self.tell_numbers(&numbers, site.span);
        let level = self.has_own_locals(site);
        let after = self.builder.fresh();
        let plain = SourceInfo { span: site.span, ..SourceInfo::default() };
        for (at, number) in numbers.iter().enumerate() {
            let target = self.target(*number, site.span);
            let cond = Cond::Compare(Relation::Equal, value.clone(), Expr::Number(f64::from(*number)));
            let (then, otherwise) = (self.builder.fresh(), self.builder.fresh());
            // Comments and number stand at the head.
            let site = if at == 0 { site.clone() } else { plain.clone() };
            self.builder.end(TermKind::Branch { cond: Box::new(cond), then, otherwise }, site);
            self.builder.start(then);
            let call =
                Call { callee: Callee::Block(target), level, arguments: Vec::new(), count: count.cloned() };
            self.call(call, false, &plain);
            self.builder.end(TermKind::Jump(after), SourceInfo::default());
            self.builder.start(otherwise);
        }
        let alarm = StmtKind::Alarm { number: Expr::Number(1.0).into(), text: "NO SUCH BLOCK".into() };
        self.builder.push(alarm, plain.clone());
        self.builder.end(TermKind::End { rewind: false }, plain);
        self.builder.start(after);
    }

    fn tell_numbers(&mut self, numbers: &[u32], span: Span) {
        let named: Vec<String> = numbers.iter().map(|number| format!("N{number}")).collect();
        let what = format!(
            "the number of the called block is computed: it becomes {}, as the numbers in the program have it, and any other stops \
             with an alarm",
            named.join(" or ")
        );
        let same = numbers.iter().copied().map(f64::from).collect();
        let predicate = Predicate::Codes { letter: LETTER, places: vec![span], same };
        self.findings.add(Diagnostic::new(Code::Conditional, span, what).assuming(predicate));
    }

    /// The sequence numbers that a value may be: the constants that the program gives to its variable, else all that the program has.
    fn numbers_of(&self, written: Option<&syntax::Expr>) -> Vec<u32> {
        let has = |number: &u32| self.labels.by_number.iter().any(|(other, _)| other == number);
        let mut given = BTreeSet::new();
        if let Some(ExprKind::Variable(var)) = written.map(|value| &value.kind) {
            let body = self.parsed.blocks.get(self.start..self.end).unwrap_or_default();
            body.iter().for_each(|block| constants(&block.items, var, &mut given));
        }
        let given: Vec<u32> = given.into_iter().filter(has).collect();
        if !given.is_empty() {
            return given;
        }
        let all: BTreeSet<u32> = self.labels.by_number.iter().map(|(number, _)| *number).collect();
        all.into_iter().collect()
    }
}

/// Takes in the whole numbers that items give to a variable.
fn constants(items: &[Item], var: &VarRef, found: &mut BTreeSet<u32>) {
    for item in items {
        match &item.kind {
            ItemKind::If { body, .. } => constants(body, var, found),
            ItemKind::Assign { target, value, by_sign: false }
                if target.name == var.name && target.index == var.index =>
            {
                if let ExprKind::Number(number) = &value.kind
                    && number.value.fract() == 0.0
                    && (1.0..=f64::from(u32::MAX)).contains(&number.value)
                {
                    // In range by the test.
                    found.insert(number.value as u32);
                }
            }
            _ => {}
        }
    }
}
