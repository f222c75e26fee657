//! What the words of a block cannot mean together on a lathe, and what they mean there only by an option of the machine.

use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Axis, Machine, Question, STEP_LETTERS, Side};
use crate::ir::{BinOp, Expr, Nc, NcItem, SourceInfo};
use crate::lower::macro_b::build::Lowering;
use crate::syntax::{self, ExprKind};
use crate::text::Span;

/// The letters of [`Role::STEPS`].
const LETTERS: [&str; 4] = ["X and U", "Y and V", "Z and W", "C and H"];

impl Lowering<'_> {
    /// Checks a block of a lathe's program: what no source tells is said, not guessed.
    pub fn check_turning(&mut self, nc: &Nc, span: Span) {
        if self.control.machine() != Machine::Lathe {
            return;
        }
        let has = |role: Role| nc.word(role).is_some();
        let pairs = Role::STEPS.into_iter().zip(LETTERS);
        for (_, letters) in pairs.filter(|((whole, step), _)| has(*whole) && has(*step)) {
            let message = format!("{letters} in one block: no source says which of the two counts");
            self.findings.not_understood(span, message);
        }
        if nc.has(Op::MachineOnce) && Role::STEPS.iter().any(|(_, step)| has(*step)) {
            self.findings.not_understood(span, "an increment beside G53: no source says what it counts from");
        }
        let adds = |item: &NcItem| matches!(item, NcItem::Word(Role::StepX | Role::StepZ, _));
        if nc.has(Op::Finish)
            && nc.items.iter().any(|item| is_place(item) && adds(item))
            && !self.ignores_allowances()
        {
            let what = "an allowance (U, W) beside the finishing of a contour: no source says what the control does with it";
            let help = "leave it out; or, if the machine is seen to take no notice of it, say so in its profile: \"finish.allowance\" = \"ignored\" under \
                        [behaviours]";
            self.findings.add(Diagnostic::new(Code::NotUnderstood, span, what).with_help(help));
            self.unknown_behaviour(Question::FinishAllowance, span);
        }
        if nc.has(Op::Finish) && nc.items.iter().any(|item| is_place(item) && !adds(item)) {
            let what =
                "an axis beside the finishing of a contour: no source says what the control does with it";
            let found = Diagnostic::new(Code::NotUnderstood, span, what);
            self.findings.add(found.with_help("leave it out, and write a move into a block of its own"));
        }
        let control = self.control;
        let value = |role: Role| nc.word(role).map(|value| value.constant());
        if let Some(clash) = control.clash(|op| nc.has(op), value) {
            let finding = Diagnostic::new(Code::NotUnderstood, span, control.clash_in_words(clash));
            let help = clash.row.help.clone();
            self.findings.add(match help {
                Some(help) => finding.with_help(help),
                None => finding,
            });
        }
        self.check_corner(nc, span);
        self.check_line(nc, span);
    }

    /// Beside the finishing of a contour an allowance of 0 says what is so without it, and a depth does nothing where the table says so
    /// (docs/lathe.md F1): they go.
    pub fn drops_allowances(&mut self, nc: &mut Nc, span: Span) {
        if self.control.machine() != Machine::Lathe || !nc.has(Op::Finish) {
            return;
        }
        let ignores = self.ignores_allowances();
        let added = |item: &NcItem| matches!(item, NcItem::Word(Role::StepX | Role::StepZ, _));
        if ignores && nc.items.iter().any(|item| added(item) && !is_no_allowance(item)) {
            self.findings.behaviour(Question::FinishAllowance, span);
        }
        nc.items.retain(|item| !(is_no_allowance(item) || ignores && added(item)));
        if nc.word(Role::CutDepth).is_none() {
            return;
        }
        if self.findings.behaviour(Question::FinishDepth, span).is_none() {
            self.unknown_behaviour(Question::FinishDepth, span);
        }
        nc.items.retain(|item| !matches!(item, NcItem::Word(Role::CutDepth, _)));
    }

    fn ignores_allowances(&self) -> bool {
        self.control.behaviour(Question::FinishAllowance).is_some_and(|row| row.value == "ignored")
    }

    /// A letter that is an increment in G code system A, and in another one only where the machine's profile says so.
    pub fn no_step(&mut self, span: Span) {
        let as_places = "write G91 and X, Y, Z, C in a block, and G90 after it";
        let told = if !self.control.leaves_open(STEP_LETTERS) {
            let message = "U, V, W and H are no increments on this machine: its profile says so";
            Diagnostic::new(Code::NotUnderstood, span, message).with_help(as_places)
        } else {
            let message = "U, V, W and H are increments of X, Y, Z and C in G code system A; whether this machine takes them so in its own \
                           system too no source says";
            let help = format!(
                "if it does, write step_letters = \"yes\" under [settings] in the machine's profile; if not, {as_places}"
            );
            let told = Diagnostic::new(Code::NotUnderstood, span, message).with_help(help);
            told.lacking(STEP_LETTERS)
        };
        self.findings.add(told);
    }

    /// A word of the two blocks of a thread of many passes, on a control that has one block for it.
    pub fn two_blocks(&mut self, letter: char, span: Span, code: &str) {
        let message = format!(
            "{letter} has no meaning beside {code}: {code} with P, Q and R is written in two blocks on a Fanuc, and this control takes one"
        );
        let help = "name the Fanuc as the source if the program is one of it; else write the cycle in one block, with X, Z, K, D, F and A";
        self.findings.add(Diagnostic::new(Code::NotUnderstood, span, message).with_help(help));
    }

    /// What to do about a word that a code of the block takes under another setting of the machine, and that setting.
    pub fn other_form(
        &self,
        word: &syntax::Word,
        codes: &super::roles::BlockCodes<'_>,
    ) -> Option<(String, String)> {
        let (name, value) =
            codes.iter().find_map(|(_, row)| self.control.word_under(&row.code, word.letter))?;
        let (kind, number) = name.split_once('.')?;
        let meaning = &self.control.setting_row(name)?.meaning;
        let help = format!(
            "if the machine is set so, write in its profile, under [{kind}s]: \"{number}\" = \"{value}\" ({meaning})"
        );
        Some((help, name.to_owned()))
    }

    /// True where X is written as a radius.
    pub fn counts_radii(&self) -> bool {
        self.control.machine() == Machine::Lathe
            && self.control.behaviour(Question::XCounts).is_some_and(|row| row.value == "radius")
    }

    /// The value of a word, where a control that counts radii has half of it; none, and an error, where a vacant one would become
    /// a number.
    pub fn as_diameter(&mut self, role: Role, value: Expr, span: Span) -> Option<Expr> {
        if !matches!(role, Role::X | Role::StepX | Role::AllowanceX) || !self.counts_radii() {
            return Some(value);
        }
        // With a sign before it, too, the word is not there.
        let vacant = match &value {
            Expr::Negate(inner) => inner.may_be_vacant(),
            value => value.may_be_vacant(),
        };
        match value {
            Expr::Number(number) => Some(Expr::Number(2.0 * number)),
            Expr::Increments(count) => Some(Expr::Increments(2.0 * count)),
            _ if vacant => {
                let what = "X of a machine that counts radii is computed from a variable that may be vacant: set the variable by a calculation";
                self.findings.not_understood(span, what);
                None
            }
            value => Some(Expr::binary(BinOp::Mul, value, Expr::Number(2.0))),
        }
    }

    /// The value of a T word in common terms: the digits that are written say which of them are the offset.
    pub fn turret_word(&mut self, value: &syntax::Expr, lowered: Expr) -> Expr {
        let turret = self.control.turret_word();
        let fault = match &value.kind {
            ExprKind::Number(number) => turret.fault(number.digits, number.value),
            _ if turret.is_plain() => return lowered,
            _ => Some(
                "a computed T word: on this machine its digits do not say what those of other machines say",
            ),
        };
        if let Some(what) = fault {
            let found = Diagnostic::new(Code::NotUnderstood, value.span, what);
            let asks = turret.is_open() && matches!(value.kind, ExprKind::Number(_));
            self.findings.add(if asks { found.lacking("setting.offset_digits") } else { found });
        }
        match lowered {
            Expr::Number(number) => Expr::Number(turret.read(number)),
            lowered => lowered,
        }
    }

    /// A corner or an angle by a letter that is an axis of the machine.
    fn check_corner(&mut self, nc: &Nc, span: Span) {
        let listed =
            |axis: Axis| self.control.profile().axes.as_ref().is_some_and(|axes| axes.contains(&axis));
        let has = |role: Role| nc.word(role).is_some();
        let what = if has(Role::ChamferNext) && listed(Axis::C) {
            "C is an axis of this machine, and no chamfer: its profile lists it"
        } else if has(Role::LineAngle) && listed(Axis::A) {
            "A is an axis of this machine, and no angle of a line: its profile lists it"
        } else {
            return;
        };
        self.findings.not_understood(span, what);
    }

    /// A and C in a block that cuts: the angle of a line and a chamfer, where the machine has no such axes.
    fn check_line(&mut self, nc: &Nc, span: Span) {
        let listed =
            |axis: Axis| self.control.profile().axes.as_ref().is_some_and(|axes| axes.contains(&axis));
        // In a drilling cycle it is the axis.
        let drills = |op: Op| op.is_cycle();
        let other = nc.items.iter().any(|item| matches!(item, NcItem::Code(..)))
            || nc.ops().any(drills)
            || self.code_in_force().is_some_and(|row| drills(row.op));
        let cuts = Role::STEPS.iter().any(|(whole, step)| {
            !matches!(whole, Role::C) && (nc.word(*whole).is_some() || nc.word(*step).is_some())
        });
        let chamfer = nc.word(Role::C).is_some() && cuts && !other && !nc.has(Op::Rapid) && !listed(Axis::C);
        let angle = nc.word(Role::A).is_some() && !listed(Axis::A);
        for (found, what) in [
            (
                chamfer,
                "C beside X or Z is a chamfer on a lathe without a C axis, where a parameter of the control says so: state it in the profile; \
                 if the machine has a C axis, list its axes there",
            ),
            (
                angle,
                "A is the angle of a line on a lathe without an A axis, and an axis on one that has it: list the axes of the machine in its profile",
            ),
        ] {
            if found && !chamfer && self.control.profile().axes.is_some() {
                let what = "A is no axis of this machine, as its profile lists its axes, and the angle of a line only in a block that cuts";
                self.findings.not_understood(span, what);
            } else if found {
                const LIST: &str = "axes = [\"X\", \"Z\", ...]";
                let what = format!("{what}: {LIST}");
                // The angle is read with its comma and without on a lathe that has no such axis.
                let setting = self.corner_letters().filter(|_| chamfer);
                let told = match setting {
                    Some(name) => {
                        let number = name.trim_start_matches("parameter.");
                        let what = format!(
                            "{what}; if it has none, write \"{number}\" = 1 under [parameters], where its parameter says so"
                        );
                        Diagnostic::new(Code::NotUnderstood, span, what).lacking(name)
                    }
                    None => {
                        let help = format!("write the axes that the machine has into its profile: {LIST}");
                        Diagnostic::new(Code::NotUnderstood, span, what).with_help(help)
                    }
                };
                self.findings.add(told);
            }
        }
    }

    /// What to do where a comma stands before the letter of a corner or an angle, and the control is set to none.
    pub fn comma_help(&self, letter: char) -> String {
        let settled = self.control.to_settle(Question::CornerLetters.fact(), Side::Source);
        let both = match letter {
            'A' => {
                ". Where programs have A with the comma and without, set it to the comma, and list the axes of the machine: without an A axis both are read"
            }
            _ => "",
        };
        format!("with the comma or without is said by a setting: {settled}{both}")
    }

    /// The setting that says by which letters corners and angles are written, where the control is not set to plain ones.
    fn corner_letters(&self) -> Option<String> {
        let plain = self.control.behaviour(Question::CornerLetters).is_some_and(|row| row.value == "letters");
        let row = self.control.corner_setting()?;
        (!plain).then(|| row.name.clone())
    }

    /// Where the tool word changes the tool, a code for the change in its block is the same change.
    pub fn settle_change(&mut self, nc: &mut Nc, span: Span) {
        let by_word = self.codes.letter('T', false).is_some_and(|row| row.op == Some(Op::ToolChange));
        if !by_word || !nc.has(Op::ToolChange) {
            return;
        }
        if nc.word(Role::Tool).is_none() {
            self.findings.not_understood(span, CHANGE_ALONE);
        } else if nc.moves() {
            self.findings.not_understood(span, CHANGE_AND_MOVE);
        }
        nc.items.retain(|item| *item != NcItem::Op(Op::ToolChange));
        let named = nc.items.iter().position(|item| matches!(item, NcItem::Word(Role::Tool, _)));
        nc.items.insert(named.map_or(0, |at| at + 1), NcItem::Op(Op::ToolChange));
    }

    /// M6 of a lathe is not needed, and does nothing of its own (docs/lathe.md T8): it goes. True where nothing else is in its block.
    pub fn drops_change(&self, nc: &mut Nc) -> bool {
        if self.control.machine() != Machine::Lathe || !nc.has(Op::ToolChange) {
            return false;
        }
        nc.items.retain(|item| *item != NcItem::Op(Op::ToolChange));
        nc.items.is_empty()
    }

    /// `G50 X Z S` limits the speed, and sets the place: two blocks here.
    pub fn apart_of_limit(&mut self, nc: &mut Nc, site: &SourceInfo) -> Option<Nc> {
        let axis = |item: &NcItem| matches!(item, NcItem::Word(role, _) if role.is_axis());
        if !nc.has(Op::LimitSpeed) || !nc.items.iter().any(axis) {
            return None;
        }
        if !self.control.dialect().codes.iter().any(|row| row.op == Op::SetPosition) {
            let message =
                "a position beside a limit of the spindle speed: no source says what it does on this control";
            self.findings.not_understood(site.span, message);
            return None;
        }
        let (words, rest): (Vec<_>, Vec<_>) = std::mem::take(&mut nc.items).into_iter().partition(axis);
        nc.items = rest;
        Some(Nc { items: std::iter::once(NcItem::Op(Op::SetPosition)).chain(words).collect() })
    }
}

/// An axis word that is no allowance of 0.
fn is_place(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(role, _) if role.is_axis()) && !is_no_allowance(item)
}

/// U or W of 0.
fn is_no_allowance(item: &NcItem) -> bool {
    matches!(item, NcItem::Word(Role::StepX | Role::StepZ, value) if value.constant() == Some(0.0))
}

const CHANGE_ALONE: &str = "T changes the tool on this machine by itself, as its profile says, and no source says what a code for the change does \
                            without one: write T into its block";

const CHANGE_AND_MOVE: &str = "T changes the tool on this machine by itself, as its profile says, and no source says whether before the move of this \
                               block or after it: give T a block of its own";
