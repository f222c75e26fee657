//! Values of words: decimal points, whole numbers, seconds and milliseconds, vacancy.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{BareLength, CodeMeaning, Machine, Question, Side, Without};
use crate::ir::{BinOp, Expr, is_finer_than_words};
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::expressions::{At, is_constant};
use crate::lower::macro_b::parts::literal;
use crate::syntax::{self, ExprKind};
use crate::text::Span;

/// The fact that a feed without a point rests on, where the profile tells how lengths count.
const BARE_FEED: &str = "numbers:bare_feed";

impl<'a> Lowering<'a> {
    /// The value of a word in its role; the role too, since a dwell's may be in either unit.
    pub fn word_value(
        &mut self,
        role: Role,
        letter: char,
        value: &'a syntax::Expr,
        code: Option<&'a CodeMeaning>,
    ) -> Option<(Role, Expr)> {
        if code.is_some_and(|row| row.counts.contains(&letter)) {
            return self.counts(role, letter, value);
        }
        let Some((number, point)) = literal(value) else { return self.computed(role, value, code) };
        if matches!(role, Role::DwellMs | Role::DwellS | Role::CycleDwell) {
            return self.dwell(role, letter, number, point, value);
        }
        if role.is_act_word() {
            if !code.is_some_and(|row| self.goes_nowhere(row)) {
                self.findings.bare_act_word(letter, number, point, value.span);
            }
            return Some((role, Expr::Number(number)));
        }
        if role.is_integer() {
            return self.whole_word(role, letter, number, point, value, code);
        }
        let counted = role.is_length() || role.is_angle();
        let bare = role.is_scale() && !point && number != 0.0;
        if bare {
            self.findings.behaviour(Question::ScaleBare, value.span);
            let Some(parts) = self.control.scale_parts() else {
                let message =
                    "a setting of the control says what a scale factor without a decimal point means";
                let help = self.control.to_settle(Question::ScaleBare.fact(), Side::Source);
                let found = Diagnostic::new(Code::NotUnderstood, value.span, message);
                self.findings.add(found.with_help(help).lacking("parameter.5400.7"));
                // The block has a factor: what it is worth is told.
                return Some((role, Expr::Number(number)));
            };
            return Some((role, Expr::Number(number / parts)));
        }
        if point || number == 0.0 || !(counted || matches!(role, Role::Feed | Role::Lead)) {
            return Some((role, Expr::Number(number)));
        }
        if role == Role::Lead && self.control.machine() == Machine::Mill {
            let what =
                "no source says what the lead of a tap counts without a decimal point: write the point";
            self.findings.not_understood(value.span, what);
            return Some((role, Expr::Number(number)));
        }
        if !counted {
            return Some((role, self.bare_feed(role, number, value.span)));
        }
        self.rest_on_numbers(value.span);
        let counts = self.control.bare_length_of(letter);
        Some((role, self.counted(counts, number, "a length", "numbers", value.span)))
    }

    /// True for a builder's code of which no control gets the words: the profile says that it is left out, or becomes a stop or an alarm.
    fn goes_nowhere(&self, row: &CodeMeaning) -> bool {
        let site = self.control.profile().site.iter().find(|site| site.code == row.code);
        site.is_some_and(|site| {
            let without = matches!(site.without, Some(Without::Omit | Without::Stop | Without::Alarm));
            without && site.name.is_none() && site.target.is_none()
        })
    }

    /// A word that counts least increments, and never has a point; what is computed is a count too.
    fn counts(&mut self, role: Role, letter: char, value: &'a syntax::Expr) -> Option<(Role, Expr)> {
        let what = match literal(value) {
            Some((number, point)) if number == 0.0 || !point => {
                return Some((role, Expr::Increments(number)));
            }
            Some(_) => format!("{letter} counts least increments here, and takes no decimal point"),
            None => {
                let lowered = self.expr(value, At::Word(role));
                self.vacant_word(value, &lowered);
                return Some((role, Expr::of_count(lowered)));
            }
        };
        self.findings.not_understood(value.span, what);
        None
    }

    /// A feed's number without a point: what is said of lengths may leave it open.
    fn bare_feed(&mut self, role: Role, number: f64, span: Span) -> Expr {
        if self.inverse {
            let message =
                "F without a decimal point counts otherwise under inverse time feed: write the point";
            self.findings.not_understood(span, message);
            return Expr::Number(number);
        }
        let counts = self.control.bare_feed();
        let open = self.control.feed_is_open();
        // It may count otherwise in feed a turn than in feed a minute: too much to take as written.
        let by_minute = self.motion.feed == Some(Op::FeedPerMinute);
        if self.control.machine() == Machine::Lathe && !by_minute && (open || counts == BareLength::Unknown) {
            let message = "no source says what a feed of this lathe counts without a decimal point, unless a code before says that \
                           it is a feed a minute: write the point, or say 'bare_feed' under [settings] of the machine's profile";
            let finding = Diagnostic::new(Code::NotUnderstood, span, message);
            self.findings.add(finding.lacking("setting.bare_feed"));
            return Expr::Number(number);
        }
        let left = counts == BareLength::Unknown && self.control.machine() == Machine::Mill;
        if left && role == Role::Feed && self.control.numbers().whole_feeds {
            // The unit and the feed mode in force tell it: `legalize/moves/bare_feeds.rs`.
            return Expr::Increments(number);
        }
        if open && counts != BareLength::Unknown {
            let note = "what a feed without a decimal point counts: the sources say it of lengths alone";
            self.findings.unconfirmed(BARE_FEED.into(), Some(note), span);
        } else {
            self.rest_on_numbers(span);
        }
        let number =
            if counts == BareLength::Units { number / self.control.numbers().feed_parts } else { number };
        let unsaid = open || counts == BareLength::Unknown;
        self.counted(counts, number, "a feed", if unsaid { BARE_FEED } else { "numbers" }, span)
    }

    fn counted(&mut self, counts: BareLength, number: f64, what: &str, fact: &str, span: Span) -> Expr {
        match counts {
            BareLength::Increments => Expr::Increments(number),
            BareLength::Units => Expr::Number(number),
            BareLength::Unknown => {
                let note = format!(
                    "no manual says which unit {what} without a decimal point has; it is \
                                    taken as written"
                );
                self.findings.unconfirmed(fact.into(), Some(&note), span);
                Expr::Number(number)
            }
        }
    }

    /// The construct rests on what a number without a point counts, unless the profile says it.
    pub fn rest_on_numbers(&mut self, span: Span) {
        if self.control.profile().decimal_point.is_none() && self.codes.tell_numbers() {
            self.findings.rest_on(self.control.numbers(), span);
        }
    }

    /// A word for a whole number.
    fn whole_word(
        &mut self,
        role: Role,
        letter: char,
        number: f64,
        point: bool,
        value: &syntax::Expr,
        code: Option<&'a CodeMeaning>,
    ) -> Option<(Role, Expr)> {
        if number.fract() != 0.0 {
            self.findings.not_understood(value.span, format!("{letter} takes a whole number"));
            return None;
        }
        // How far a control reads ahead is its own matter; a speed that a control takes with a point is that speed.
        if point && !matches!(role, Role::Lookahead | Role::Speed) {
            let message = format!("{letter} takes a whole number: some controls stop at the decimal point");
            self.findings.add(Diagnostic::new(Code::WholeWithPoint, value.span, message));
        }
        Some((role, Expr::Number(self.control.canonical(code, role, number))))
    }

    /// A value that is computed, or a number in brackets: it counts whole units.
    fn computed(
        &mut self,
        role: Role,
        value: &'a syntax::Expr,
        code: Option<&'a CodeMeaning>,
    ) -> Option<(Role, Expr)> {
        let span = value.span;
        let lowered = self.expr(value, At::Word(role));
        if role.is_length() || role.is_angle() || role == Role::Feed {
            match self.findings.behaviour(Question::WordBareExpression, span) {
                Some("value") => {}
                Some(_) => self.findings.not_understood(
                    span,
                    "a computed value counts increments on this \
                                                               control: that is not converted",
                ),
                None => self.unknown_behaviour(Question::WordBareExpression, span),
            }
        }
        self.vacant_word(value, &lowered);
        if matches!(role, Role::DwellMs | Role::DwellS | Role::CycleDwell) {
            return self.computed_dwell(role, value, lowered);
        }
        if role.is_integer() && !is_constant(value) && !self.findings.is(Question::IntegerWordRounds, span) {
            self.unknown_behaviour(Question::IntegerWordRounds, span);
        }
        let shift = code.and_then(|row| row.shift.get(&role)).map(Vec::as_slice);
        let lowered = match (lowered, shift) {
            (Expr::Number(number), _) if role.is_integer() => {
                Expr::Number(self.control.canonical(code, role, number.round()))
            }
            (Expr::Number(number), None | Some([])) if is_fine(role, number) => {
                Expr::binary(BinOp::Add, Expr::Number(number), Expr::Number(0.0))
            }
            (lowered, None | Some([])) => lowered,
            (lowered, Some([one])) => Expr::binary(BinOp::Add, lowered, Expr::Number(one.add as f64)),
            (lowered, Some(_)) => {
                self.findings.not_understood(
                    span,
                    "the number is computed, and the numbers of this code \
                                                    are in several runs: write the number",
                );
                lowered
            }
        };
        Some((role, lowered))
    }

    /// What a word does whose value may be vacant: dropped, where it is the plain variable.
    fn vacant_word(&mut self, value: &syntax::Expr, lowered: &Expr) {
        let question = match (&value.kind, lowered) {
            (ExprKind::Variable(_), read) if read.may_be_vacant() => Question::VacantWordDropped,
            (ExprKind::Group(_), read) if read.may_be_vacant() => Question::BracketVacantWord,
            // What a sign leaves of a vacant variable is told as little. Of one whose number is written, what stands
            // before it says whether it may be vacant.
            (ExprKind::Negate(_), Expr::Negate(read))
                if read.may_be_vacant() && !matches!(**read, Expr::Var(_)) =>
            {
                Question::BracketVacantWord
            }
            _ => return,
        };
        match self.findings.behaviour(question, value.span) {
            Some("true" | "dropped") => {}
            _ => self.unknown_behaviour(question, value.span),
        }
    }

    /// A dwell's literal: the table says what it counts with a point and without.
    fn dwell(
        &mut self,
        role: Role,
        letter: char,
        number: f64,
        point: bool,
        value: &syntax::Expr,
    ) -> Option<(Role, Expr)> {
        if number == 0.0 || (role == Role::DwellS && letter != 'P' && point) {
            return Some((role, Expr::Number(number)));
        }
        if letter != 'P' {
            // X2 of a dwell: two thousandths of a second where X counts increments, as far as is known.
            self.unknown_behaviour(Question::DwellBare, value.span);
            let ms = self.control.bare_length_of(letter) == BareLength::Increments;
            return Some((if ms { Role::DwellMs } else { role }, Expr::Number(number)));
        }
        let question = if point { Question::DwellPoint } else { Question::DwellBare };
        let answer = self.findings.behaviour(question, value.span);
        match (answer, role) {
            (Some("ms"), Role::DwellS) => Some((Role::DwellMs, Expr::Number(number))),
            (Some("seconds"), Role::DwellMs) => Some((Role::DwellS, Expr::Number(number))),
            (Some("seconds"), Role::CycleDwell) => Some((role, Expr::Number(number * 1000.0))),
            (Some("error"), _) => {
                self.findings
                    .not_understood(value.span, "P of a dwell takes no decimal point on this control");
                None
            }
            (None, _) => {
                self.unknown_behaviour(question, value.span);
                Some((role, Expr::Number(number)))
            }
            _ => Some((role, Expr::Number(number))),
        }
    }

    fn computed_dwell(&mut self, role: Role, value: &syntax::Expr, lowered: Expr) -> Option<(Role, Expr)> {
        if role == Role::DwellS {
            return Some((role, lowered));
        }
        match self.findings.behaviour(Question::DwellExpression, value.span) {
            Some("seconds") if role == Role::DwellMs => Some((Role::DwellS, lowered)),
            Some("seconds") => {
                let thousand = Box::new(Expr::Number(1000.0));
                Some((role, Expr::binary(BinOp::Mul, lowered, *thousand)))
            }
            Some(_) => Some((role, lowered)),
            None => {
                self.unknown_behaviour(Question::DwellExpression, value.span);
                Some((role, lowered))
            }
        }
    }
}

/// True for a constant in brackets with more places than an increment of lengths may have: the control rounds what it
/// computes, and a number that is written so may be read in another way. It stays a computation.
fn is_fine(role: Role, number: f64) -> bool {
    (role.is_length() || role.is_angle()) && is_finer_than_words(number)
}
