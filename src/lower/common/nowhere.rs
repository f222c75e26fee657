//! Jumps to labels that no block has.

use super::Findings;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{BlockId, Builder, Expr, SourceInfo, StmtKind, TermKind};
use crate::text::Span;
use std::collections::BTreeMap;

/// The blocks that such jumps of a program go to. The control stops with an alarm when it gets there, and so does the target:
/// what is never run hurts nobody.
#[derive(Debug, Default)]
pub struct Nowhere {
    /// By label: the block, and where the first jump stands.
    blocks: BTreeMap<String, (BlockId, Span)>,
}

impl Nowhere {
    /// The block of a label that is missing; reports the jump at `span`.
    pub fn block(
        &mut self,
        label: String,
        span: Span,
        builder: &mut Builder,
        findings: &mut Findings<'_>,
    ) -> BlockId {
        let message = format!("no block has {label}: whoever gets here stops with an alarm");
        let help = "correct the jump, or add the label";
        findings.add(Diagnostic::new(Code::TargetMissing, span, message).with_help(help));
        let asked = Question::GotoMissingAlarms;
        if findings.only(asked, "true", span).is_none() && findings.control().behaviour(asked).is_some() {
            findings.unconfirmed(asked.fact().into(), None, span);
        }
        self.blocks.entry(label).or_insert_with(|| (builder.fresh(), span)).0
    }

    /// Writes the alarms after the program's text.
    pub fn close(&mut self, builder: &mut Builder) {
        for (label, (block, span)) in std::mem::take(&mut self.blocks) {
            if builder.is_open() {
                builder.end(TermKind::Stray, SourceInfo::default());
            }
            builder.start(block);
            let site = SourceInfo { span, ..SourceInfo::default() };
            let text = format!("NO BLOCK {label}");
            builder
                .push(StmtKind::Alarm { number: Expr::Number(1.0).into(), text: text.into() }, site.clone());
            builder.end(TermKind::End { rewind: false }, site);
        }
    }
}
