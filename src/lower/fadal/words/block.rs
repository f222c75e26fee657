//! NC blocks: R assignments, codes, words, and what they do to the flow.

use super::motion::{Move, is_arc};
use super::reading::Reading;
use super::value::is_zero;
use crate::canon::{Op, Role};
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{Argument, Class, Expr, Nc, NcItem, Place, StmtKind, Var};
use crate::lower::common::{constant, may_take, says_something};
use crate::lower::fadal::build::{Lowering, PLANE};
use crate::lower::fadal::codes::{Codes, FIRST_FIXED, LWord, Step, is_code, l_word, steps, word};
use crate::syntax::{self, Index, Item, ItemKind, VarRef, Word};
use crate::text::Span;

/// The L of G10 that writes R0.
const FIRST_WRITTEN: u32 = 100;

impl<'b> Lowering<'b> {
    /// An NC block; none if something in it is not understood, which is then reported.
    pub fn nc(&mut self, items: &'b [Item], codes: &Codes<'b, 'b>) -> Option<()> {
        let span = items.first()?.span.to(items.last()?.span);
        let steps = steps(items, codes);
        if let Some(number) = fixed_call(&steps) {
            return self.fixed_call(items, codes, number, span);
        }
        let axes = self.has_axes(items, codes);
        let mut reading = Reading {
            codes,
            modal: self.modal_row(codes),
            assigned: Vec::new(),
            read: Vec::new(),
            items: Vec::new(),
            moves: axes,
            span,
        };
        for (at, item) in items.iter().enumerate() {
            match &item.kind {
                ItemKind::Word(word) => self.nc_word(item, word, &mut reading)?,
                ItemKind::Assign { target, value, .. } => {
                    self.nc_assign(target, value, axes, &mut reading)?;
                }
                ItemKind::Skip(_) if items.iter().take(at).any(says_something) => {
                    let _ = self.rely(Question::SkipMidblock, item.span);
                    return self.refuse(item.span, "a block skip in the middle of a block: put it first");
                }
                kind if says_something(item) && !matches!(kind, ItemKind::Program(_)) => {
                    return self.refuse(item.span, "NC words and macro statements cannot share a block");
                }
                _ => {}
            }
        }
        self.motion_words(&mut reading, axes)?;
        let mode_after = self.distance_by_place(&mut reading)?;
        self.block_facts(&mut reading, axes);
        let Reading { items: mut words, .. } = reading;
        self.doubled(&mut words, span)?;
        for op in self.grouped(&mut words, span)? {
            self.push(StmtKind::Nc(Nc { items: vec![NcItem::Op(op)] }));
        }
        let waits = self.waits_for_start(&mut words, span);
        if !words.is_empty() {
            words.shrink_to_fit();
            self.push(StmtKind::Nc(Nc { items: words }));
        }
        if let Some(op) = mode_after {
            self.push(StmtKind::Nc(Nc { items: vec![NcItem::Op(op)] }));
        }
        if waits {
            self.push(StmtKind::StopMessage { number: Expr::Number(1.0).into(), text: "".into() });
        }
        if codes.has(Op::RotateOn) && self.in_cycle() && self.control.is(Question::RotationRunsCycle) {
            // The cycle runs at the turned place.
            self.push(StmtKind::Nc(Nc { items: vec![NcItem::Op(Op::CycleHere)] }));
        }
        let by_variable = |step: &Step<'_>| matches!(step, Step::Local(value) if constant(value).is_none());
        if axes && steps.iter().any(by_variable) {
            return self.refuse(
                span,
                "L takes its value from a variable: it may repeat the move or call a \
                               subroutine",
            );
        }
        if axes && steps.iter().any(|step| matches!(step, Step::Local(_))) && !codes.has(Op::CallModal) {
            self.suppose(Question::CallAfterWords, "true", span);
        }
        if codes.has(Op::CallModal) && !steps.iter().any(|step| matches!(step, Step::Local(_))) {
            return self.refuse(span, "G66 does not name the subroutine that it calls");
        }
        for step in steps {
            self.step(step, items, codes, span)?;
        }
        Some(())
    }

    /// Takes out a dwell of the one time that waits for START instead; a computed time may be that one.
    fn waits_for_start(&mut self, items: &mut Vec<NcItem>, span: Span) -> bool {
        let Some(waits) = self.control.number(Question::DwellWaits) else { return false };
        let time = items.iter().find_map(|item| match item {
            NcItem::Word(Role::DwellMs, value) => Some(value.constant()),
            _ => None,
        });
        match time {
            Some(Some(time)) if time == waits => {
                items.retain(|item| !matches!(item, NcItem::Op(Op::Dwell) | NcItem::Word(Role::DwellMs, _)));
                true
            }
            Some(None) => {
                let what = format!(
                    "a dwell of {waits} waits for START here, and this one is computed: make sure that it is never {waits}"
                );
                self.findings.add(Diagnostic::new(Code::Conditional, span, what));
                false
            }
            _ => false,
        }
    }

    fn has_axes(&self, items: &[Item], codes: &Codes<'b, 'b>) -> bool {
        let role = |word: &Word| codes.role(word.letter, word.comma, None).ok().flatten();
        items.iter().filter_map(word).any(|word| role(word).is_some_and(Role::is_axis))
    }

    fn nc_word(&mut self, item: &'b Item, word: &'b Word, reading: &mut Reading<'b, '_>) -> Option<()> {
        let Some(value) = &word.value else {
            return self.refuse(item.span, format!("{} has no value", word.letter));
        };
        if is_code(word.letter) {
            return self.code(item, word, value, reading);
        }
        let calls = word.letter == 'L' && l_word(value, reading.codes) != LWord::Operand;
        if calls || reading.codes.selects(word.letter) {
            return Some(());
        }
        let Ok(role) = reading.codes.role(word.letter, word.comma, reading.modal) else {
            return self.refuse(
                item.span,
                format!("two codes of the block give {} different meanings", word.letter),
            );
        };
        let Some(role) = role else {
            let message = format!("the table has no meaning for {} here", word.letter);
            return self.refuse(item.span, message);
        };
        if !reading.codes.names(word.letter, word.comma)
            && let Some(row) = may_take(reading.codes.known(), role, reading.moves)
        {
            self.findings.beside_code(word.letter, role, &row.code, item.span);
            return Some(());
        }
        if self.hangs_on_cycle(word, role, reading.codes) {
            let message = format!(
                "{} depends on the drilling cycle in force, and the paths to this block have different ones",
                word.letter
            );
            return self.conflict(item.span, &message);
        }
        if reading.codes.has(Op::WriteVariable) && word.letter == 'P' {
            return Some(());
        }
        if matches!(role, Role::Program | Role::Sequence | Role::CallCount) {
            // An operand of a flow code, which takes it.
            let taken = reading.codes.known().any(|row| matches!(row.op, Op::CallProgram | Op::Return));
            if !taken {
                return self.refuse(item.span, format!("no code of this block takes {}", word.letter));
            }
            return Some(());
        }
        let meaning = self.control.word(word.letter, word.comma).filter(|row| row.role == role);
        if let Some(row) = meaning {
            self.findings.rest_on(row, item.span);
        }
        let beside = reading.codes.known().find(|row| row.shift.contains_key(&role));
        if role.is_act_word() {
            let (number, point) = written(value);
            self.findings.bare_act_word(word.letter, number, point, item.span);
        }
        let lowered = self.word_value(value, role, beside)?;
        note_reads(&lowered, &mut reading.read);
        let op = meaning.and_then(|row| row.op);
        // Where a length picks a radius, one that the block names itself counts.
        let radius = op == Some(Op::LengthPlus)
            && reading.codes.value('D').is_none()
            && self.control.is(Question::LengthWordPicksRadius);
        let radius = radius.then(|| NcItem::Word(Role::RadiusOffset, lowered.clone()));
        if radius.is_some() && (reading.codes.has(Op::RadiusLeft) || reading.codes.has(Op::RadiusRight)) {
            self.suppose(Question::LengthWordPicksRadius, "true", item.span);
        }
        match op {
            Some(Op::SelectWork) if is_zero(value) => reading.items.push(NcItem::Op(Op::ShiftCancel)),
            Some(Op::LengthPlus) if is_zero(value) => reading.items.push(NcItem::Op(Op::LengthOff)),
            Some(op) => {
                if !reading.codes.has(op) {
                    reading.items.push(NcItem::Op(op));
                }
                reading.items.push(NcItem::Word(role, lowered));
            }
            None => reading.items.push(NcItem::Word(role, lowered)),
        }
        reading.items.extend(radius);
        Some(())
    }

    fn code(
        &mut self,
        item: &'b Item,
        word: &Word,
        value: &'b syntax::Expr,
        reading: &mut Reading<'b, '_>,
    ) -> Option<()> {
        if constant(value).is_none() {
            let value = self.nc_value(value, None)?;
            note_reads(&value, &mut reading.read);
            let message = format!("the number of this {} code is computed: write the number", word.letter);
            reading.items.push(NcItem::Code(word.letter, value));
            return self.refuse(item.span, message);
        }
        let Some(row) = reading.codes.row(item) else {
            let number = constant(value).unwrap_or_default();
            let message = format!("the table has no meaning for {}{number}", word.letter);
            let setting = self.control.code_under(word.letter, number);
            let help = match setting {
                Some(setting) => {
                    let setting = setting.trim_start_matches("setting.");
                    format!("it has one if the machine profile has {setting} under [settings]")
                }
                None => format!(
                    "if the machine's builder made it, say in the machine profile what it does: [[site]] with code = \
                     \"{}{number}\", a text, and name, target or do",
                    word.letter
                ),
            };
            let finding = Diagnostic::new(Code::NotUnderstood, item.span, message).with_help(help);
            let of_builder = setting.is_none();
            self.findings.add(if of_builder { finding.asking(word.letter, number) } else { finding });
            return None;
        };
        self.findings.rest_on(row, item.span);
        match row.op {
            op if op.is_flow() => return Some(()),
            Op::WriteVariable => return self.write_variable(item, reading),
            Op::ReadOffset => {
                return self.refuse(item.span, "no source says which table is read into which variables");
            }
            _ => {}
        }
        reading.items.push(NcItem::Op(row.op));
        reading.items.extend(row.with.iter().map(|op| NcItem::Op(*op)));
        reading.items.extend(row.fixed.iter().map(|(role, value)| NcItem::Word(*role, Expr::Number(*value))));
        Some(())
    }

    /// `G10 L103 P5.`: R3 becomes 5.
    fn write_variable(&mut self, item: &'b Item, reading: &mut Reading<'b, '_>) -> Option<()> {
        let first = f64::from(FIRST_WRITTEN);
        let row = reading.codes.number('L').filter(|row| (first..first + 10.0).contains(row));
        let Some(number) = row else {
            return self.refuse(item.span, "the block does not say which variable it writes");
        };
        let Some(value) = reading.codes.value('P') else {
            return self.refuse(item.span, "the value to write is missing");
        };
        let value = self.nc_value(value, None)?;
        let var = Var { class: Class::Parametric, number: (number - first) as u32 };
        self.scratches_plane(&Place::Var(var), item.span);
        self.assign(Place::Var(var), value);
        Some(())
    }

    /// `R3+7.5`, which beside a cycle, an arc or an offset write is a word of theirs too.
    fn nc_assign(
        &mut self,
        target: &'b VarRef,
        value: &'b syntax::Expr,
        axes: bool,
        reading: &mut Reading<'b, '_>,
    ) -> Option<()> {
        let (Index::Number(number), "R") = (&target.index, &*target.name) else {
            return self.refuse(target.span, "only R0 to R9 are set on an NC line");
        };
        let var = Var { class: Class::Parametric, number: *number };
        let modal = reading.modal.filter(|_| axes);
        let Ok(role) = reading.codes.variable_role('R', *number, modal) else {
            return self
                .refuse(target.span, format!("two codes of the block give R{number} different meanings"));
        };
        let place = self.place(target)?;
        let lowered = self.nc_value(value, role)?;
        if reading.read.contains(&var) {
            return self
                .refuse(target.span, format!("R{number} is set in this block after a word that reads it"));
        }
        let Some(role) = role else {
            self.scratches_plane(&place, target.span);
            reading.assigned.push((var, target.span));
            self.assign(place, lowered);
            return Some(());
        };
        if var == PLANE {
            self.takes_plane(role, target.span)?;
        }
        note_reads(&lowered, &mut reading.read);
        reading.items.push(NcItem::Word(role, lowered.clone()));
        reading.assigned.push((var, target.span));
        if matches!(lowered, Expr::Increments(_)) {
            let message = format!(
                "no source says what R{number} holds after a number without a decimal \
                                   point: write the point"
            );
            return self.refuse(target.span, message);
        }
        self.assign(place, lowered);
        Some(())
    }

    /// Spells out the motion mode where the block depends on it.
    fn motion_words(&mut self, reading: &mut Reading<'b, '_>, axes: bool) -> Option<()> {
        let centre = reading.items.iter().any(|item| {
            matches!(item, NcItem::Word(Role::ArcI | Role::ArcJ | Role::ArcK | Role::ArcRadius, _))
        });
        let axes = axes && !reading.codes.takes_axes();
        let spelling = self.spell_motion(reading.codes, Move { axes, centre }, reading.span)?;
        if spelling.drop.is_some() {
            reading.items.retain(|item| !matches!(item, NcItem::Op(op) if is_arc(*op)));
        }
        if let Some(op) = spelling.op {
            reading.items.insert(0, NcItem::Op(op));
        }
        Some(())
    }

    fn fixed_call(
        &mut self,
        items: &'b [Item],
        codes: &Codes<'b, 'b>,
        number: f64,
        span: Span,
    ) -> Option<()> {
        let mut arguments = Vec::new();
        for item in items {
            match &item.kind {
                ItemKind::Assign { target, value, .. } => {
                    let place = self.place(target)?;
                    let value = self.nc_value(value, None)?;
                    self.assign(place, value);
                }
                ItemKind::Word(word) if word.letter != 'L' => {
                    let Some(value) = &word.value else {
                        return self.refuse(item.span, format!("{} has no value", word.letter));
                    };
                    if is_code(word.letter) {
                        return self.refuse(item.span, "a code beside a call of a fixed subroutine");
                    }
                    // A letter without a role of its own is a number of the subroutine's.
                    let role = codes.role(word.letter, word.comma, None).ok().flatten();
                    let value = self.nc_value(value, role.or(Some(Role::Builder)))?;
                    let letter = u32::from(word.letter).saturating_sub(u32::from('A')) + 1;
                    if arguments.iter().any(|other: &Argument| other.local == letter) {
                        return self.refuse(item.span, format!("{} twice in one call", word.letter));
                    }
                    arguments.push(Argument { local: letter, value });
                }
                _ => {}
            }
        }
        self.fixed(number, arguments, span)
    }
}

/// The number that a word has, and whether with a point; a variable's value has one.
fn written(value: &syntax::Expr) -> (f64, bool) {
    match &value.kind {
        syntax::ExprKind::Number(number) => (number.value, number.point),
        syntax::ExprKind::Negate(inner) | syntax::ExprKind::Plus(inner) => match &inner.kind {
            syntax::ExprKind::Number(number) => (number.value, number.point),
            _ => (0.0, true),
        },
        _ => (0.0, true),
    }
}

/// The number of the fixed subroutine that a block calls and does nothing else.
fn fixed_call(steps: &[Step<'_>]) -> Option<f64> {
    match steps {
        [Step::Local(value)] => constant(value).filter(|number| *number >= f64::from(FIRST_FIXED * 100)),
        _ => None,
    }
}

fn note_reads(value: &Expr, read: &mut Vec<Var>) {
    match value {
        Expr::Var(var) => read.push(*var),
        Expr::Negate(inner) => note_reads(inner, read),
        Expr::Binary(_, operands) => note_reads(&operands[0], read),
        _ => {}
    }
}
