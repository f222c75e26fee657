//! Values of words: lengths, radii, tools, and the words that a block leaves out.

use super::Lowering;
use crate::canon::{Op, Role, Sys};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, Question};
use crate::ir::{Expr, Nc, NcItem};
use crate::lower::common::{constant, otherwise};
use crate::syntax::{Expr as Written, ExprKind, Item, Word};
use crate::text::Span;
use thin_vec::ThinVec;

impl Lowering<'_> {
    /// The value of a word in its role.
    pub(super) fn word_value(&mut self, role: Role, word: &Word, span: Span) -> Option<Expr> {
        let Some(written) = &word.value else {
            self.findings.not_understood(span, format!("{} has no value", word.letter));
            return None;
        };
        if let (true, Some(number)) = (role.is_act_word(), constant(written)) {
            self.findings.bare_act_word(word.letter, number, has_point(written), span);
            return Some(Expr::Number(number));
        }
        let value = match constant(written) {
            Some(number) => self.number(role, number, written, span)?,
            None => self.operand(written)?,
        };
        if role.is_integer()
            && value.constant().is_none()
            && self.control.behaviour(Question::IntegerWordRounds).is_some_and(|row| row.value == "false")
        {
            self.findings.not_understood(span, otherwise(Question::IntegerWordRounds, "false"));
        }
        match role {
            Role::ArcRadius => self.radius(value, span),
            Role::ArcI | Role::ArcJ | Role::ArcK => self.centre(value, span),
            _ => Some(value),
        }
    }

    /// A constant. Without a decimal point a length counts what the table says.
    fn number(&mut self, role: Role, number: f64, written: &Written, span: Span) -> Option<Expr> {
        let counts = match role {
            Role::Feed => self.control.bare_feed(),
            _ if role.is_length() => self.control.bare_length(),
            _ => return Some(Expr::Number(number)),
        };
        if has_point(written) || number == 0.0 {
            return Some(Expr::Number(number));
        }
        self.findings.rest_on(self.control.numbers(), span);
        match counts {
            BareLength::Units => Some(Expr::Number(number)),
            BareLength::Increments if number < 0.0 => Some(Expr::Negate(Box::new(Expr::Increments(-number)))),
            BareLength::Increments => Some(Expr::Increments(number)),
            BareLength::Unknown => {
                self.findings.not_understood(span, "no source says which unit a number without a point has");
                None
            }
        }
    }

    /// A radius in the common sense, where the shorter arc is positive.
    fn radius(&mut self, value: Expr, span: Span) -> Option<Expr> {
        let negative = self.findings.behaviour(Question::ArcRadiusNegative, span);
        let positive =
            self.control.behaviour(Question::ArcRadiusPositive).filter(|row| row.value != "unknown");
        if value.constant().is_none_or(|radius| radius > 0.0) {
            match positive {
                Some(row) => self.findings.rest_on(row, span),
                None if value.constant().is_some() => {
                    let message = "no source says which arc a positive radius means on this control";
                    self.findings.not_understood(span, message);
                    return None;
                }
                None => {
                    let why = "a radius from a variable may be positive, and no source says which arc \
                               that means";
                    self.findings.unconfirmed(Question::ArcRadiusPositive.fact().into(), Some(why), span);
                }
            }
        }
        match (negative, positive.map(|row| row.value.as_str())) {
            (Some("short"), None | Some("long")) => Some(match value {
                Expr::Number(radius) => Expr::Number(-radius),
                Expr::Negate(radius) => *radius,
                radius => Expr::Negate(Box::new(radius)),
            }),
            (Some("long"), None | Some("short")) => Some(value),
            _ => {
                self.findings.not_understood(span, "no source says which arc the sign of a radius means");
                None
            }
        }
    }

    fn centre(&mut self, value: Expr, span: Span) -> Option<Expr> {
        if self.findings.behaviour(Question::ArcCentre, span) == Some("incremental") {
            return Some(value);
        }
        self.findings.not_understood(span, "no source says from where this control counts an arc's centre");
        None
    }

    /// Adds what the control takes from elsewhere: the active tool's radius, the
    /// variables that a drilling cycle reads.
    pub(super) fn complete(&mut self, nc: &mut Nc, items: &[Item], span: Span) {
        let compensates = nc.has(Op::RadiusLeft) || nc.has(Op::RadiusRight);
        if compensates && nc.word(Role::RadiusOffset).is_none() {
            if self.findings.is(Question::RadiusOffsetActiveTool, span) {
                let tool = Expr::System(Sys::ActiveTool, ThinVec::new());
                nc.items.push(NcItem::Word(Role::RadiusOffset, tool));
            } else {
                self.findings.not_understood(span, "no source says whose radius is taken here");
            }
        }
        if nc.has(Op::MirrorOn) {
            self.mirror(nc, span);
        }
        let cycle = nc.ops().find(|op| op.is_cycle());
        if let Some(op) = cycle {
            self.cycle(op, nc, items, span);
        }
    }
}

impl Lowering<'_> {
    /// Takes the words of a mirror for what the profile says they are. By a sign it is about zero.
    fn mirror(&mut self, nc: &mut Nc, span: Span) {
        let answer = self.findings.behaviour(Question::MirrorAbout, span);
        let axes = nc.items.iter_mut().filter_map(|item| match item {
            NcItem::Word(role, value) if role.is_axis() => Some(value),
            _ => None,
        });
        match answer {
            Some("sign") => {
                for value in axes {
                    if value.constant().is_none_or(|sign| sign >= 0.0) {
                        self.findings.not_understood(span, NOT_MINUS);
                    }
                    *value = Expr::Number(0.0);
                }
            }
            Some(_) => {}
            None => {
                let help = "say in the machine profile which it is, under [behaviours]: \"mirror.about\" = \"sign\" (minus mirrors the axis about \
                            the zero in force), \"word\" (about that place), or \"zero\" (about the zero, whatever the number)";
                let finding = Diagnostic::new(Code::NotUnderstood, span, SIGN_OR_PLACE).with_help(help);
                self.findings
                    .add(finding.lacking(format!("behaviour.{}=sign", Question::MirrorAbout.name())));
            }
        }
    }
}

const SIGN_OR_PLACE: &str =
    "no source says what the number beside this code for mirroring means on this control: a sign, or a place";

const NOT_MINUS: &str = "the number beside this code for mirroring is a sign, and it is not known to be minus: write the axes that are mirrored \
                         alone, each with a minus, and the code that ends mirroring for the others";

/// True where a number is written with a decimal point.
fn has_point(written: &Written) -> bool {
    let mut at = written;
    loop {
        match &at.kind {
            ExprKind::Number(number) => return number.point,
            ExprKind::Negate(inner) | ExprKind::Plus(inner) | ExprKind::Group(inner) => at = inner,
            _ => return false,
        }
    }
}
