//! What a letter means beside the codes of its block and the motion code in force.

use crate::canon::{Group, Op, Role};
use crate::diag::{Asks, Code, Diagnostic};
use crate::dialect::{Axis, CodeMeaning, Machine, Question};
use crate::lower::macro_b::build::Lowering;
use crate::lower::macro_b::codes::CodeId;
use crate::lower::macro_b::parts::Words;
use crate::syntax::{ExprKind, Word};
use crate::text::Span;
use smallvec::SmallVec;

/// The codes of a block.
pub type BlockCodes<'c> = SmallVec<[(CodeId, &'c CodeMeaning); 6]>;

impl<'a> Lowering<'a> {
    /// The role of a word and the code that gives it; none, and an error, where it has none.
    ///
    /// A code of the block decides first, then the motion code in force, then the table's
    /// general meaning of the letter.
    pub fn role(
        &mut self,
        word: &Word,
        span: Span,
        codes: &BlockCodes<'a>,
    ) -> Option<(Role, Option<&'a CodeMeaning>)> {
        let mut found: Option<(Role, &'a CodeMeaning)> = None;
        for (_, row) in codes {
            let Some(role) = explicit(row, word) else { continue };
            match found {
                Some((other, first)) if other != role => {
                    let message = format!(
                        "{} is '{other}' beside {} and '{role}' beside {}",
                        word.letter, first.code, row.code
                    );
                    self.findings.not_understood(span, message);
                    return None;
                }
                _ => found = Some((role, *row)),
            }
        }
        if let Some((role, row)) = found {
            return Some((role, Some(row)));
        }
        // Beside a probe move it is no word of an arc that was in force before.
        if word.letter == 'R' && codes.iter().any(|(_, row)| row.op == Op::Probe) {
            self.no_role(word, span, codes, None);
            return None;
        }
        let usual = self.codes.letter(word.letter, word.comma);
        let own = codes.iter().rev().find(|(_, row)| matches!(row.op.group(), Group::Motion | Group::Cycle));
        let in_force = match own {
            Some((_, row)) => Some(*row),
            None => self.code_in_force(),
        };
        let modal = in_force.and_then(|row| explicit(row, word));
        if let Some(role) = modal.or(usual.filter(|_| !word.comma).map(|usual| usual.role))
            && self.is_beside(word.letter, role, span, codes)
        {
            return None;
        }
        if let Some((row, role)) = in_force.zip(modal) {
            if self.motion.joined && usual.is_none_or(|usual| usual.role != role) {
                self.assumes(word, span, &format!("'{role}' of {} above", row.code));
            }
            return Some((role, Some(row)));
        }
        // A code that only this control has takes its words its own way; the code is refused as it is.
        let own_way = |op: Op| matches!(op, Op::MachineSpecific | Op::CycleOther | Op::ProbeOther);
        let common = |role: Role| role.is_axis() || matches!(role, Role::Feed | Role::Speed | Role::Tool);
        if !usual.is_some_and(|usual| common(usual.role)) && codes.iter().any(|(_, row)| own_way(row.op)) {
            return Some((Role::Builder, None));
        }
        if let Some(row) = in_force.filter(|row| row.op.is_cycle())
            && self.is_corner_of_cycle(word, span, row)
        {
            return None;
        }
        let Some(usual) = usual.filter(|_| !self.foreign_axis(word)) else {
            self.no_role(word, span, codes, in_force);
            // It is some axis word: a return is not one without axes for it.
            let reference = codes.iter().any(|(_, row)| row.op == Op::ReferenceReturn);
            let role = usual.map(|usual| usual.role).or_else(|| self.lone_step(word));
            return role.filter(|_| reference).map(|role| (role, None));
        };
        if !usual.origin.is_confirmed() && self.codes.tell_letter(word.letter, word.comma) {
            self.findings.rest_on(usual, span);
        }
        if usual.role == Role::Speed {
            self.speed_of_stop(span, codes);
        }
        if is_arc_word(usual.role) && !self.fits_arc(word, span, codes, own.is_some(), in_force) {
            return None;
        }
        let shifting = codes.first().map(|(_, row)| *row).filter(|row| row.shift.contains_key(&usual.role));
        Some((usual.role, shifting))
    }

    /// A centre or a radius belongs to an arc. True where one is in force, or may be: then
    /// the review is told what is assumed.
    fn fits_arc(
        &mut self,
        word: &Word,
        span: Span,
        codes: &BlockCodes<'a>,
        own: bool,
        in_force: Option<&CodeMeaning>,
    ) -> bool {
        use Op::*;
        // Codes that only this control has take the words they take.
        let special = |op: Op| matches!(op, Builder | MachineSpecific | CycleOther | ProbeOther | Thread);
        if codes.iter().any(|(_, row)| special(row.op)) {
            return true;
        }
        if codes.iter().any(|(_, row)| row.op == SpindleOrient) {
            self.angle_of_stop(word, span);
            return false;
        }
        if let Some(what) = not_converted(word, codes, in_force) {
            self.findings.not_understood(span, what);
            return false;
        }
        if let Some((_, row)) = codes.iter().find(|(_, row)| row.op == Threading) {
            self.two_blocks(word.letter, span, &row.code);
            return false;
        }
        match in_force {
            Some(row) if matches!(row.op, ArcCw | ArcCcw | ArcTangent) || special(row.op) => true,
            Some(row) if own || !self.motion.joined => {
                let message = format!("{} has no meaning under {}", word.letter, row.code);
                let told = Diagnostic::new(Code::NotUnderstood, span, message);
                let corner = row.op == Linear
                    && word.letter == 'R'
                    && self.codes.letter('R', true).is_some()
                    && self.control.machine() == Machine::Lathe;
                self.findings.add(match corner {
                    true => told.with_help("if it rounds the corner to the next line, write ,R with a comma"),
                    false => told,
                });
                false
            }
            _ => {
                self.assumes(
                    word,
                    span,
                    "a word of an arc, but no code of this program is certain to \
                                          begin one",
                );
                true
            }
        }
    }

    fn assumes(&mut self, word: &Word, span: Span, what: &str) {
        let message = format!("{} is taken as {what}; a different code may be in force here", word.letter);
        self.findings.add(Diagnostic::new(Code::ModalAssumed, span, message));
    }

    /// U, V and W are the second linear axes of some mills, and on a lathe the incremental
    /// X, Y and Z: on a mill the profile must list the axis, or the maker's text the letter.
    fn foreign_axis(&self, word: &Word) -> bool {
        let axis = match word.letter {
            'U' => Axis::U,
            'V' => Axis::V,
            'W' => Axis::W,
            _ => return false,
        };
        let listed = self.control.profile().axes.as_ref().is_some_and(|axes| axes.contains(&axis));
        let stated = self.codes.letter(word.letter, word.comma).is_some_and(|row| row.origin.is_confirmed());
        self.control.machine() == Machine::Mill && !word.comma && !listed && !stated
    }

    /// The axis that a letter may be where it is an increment on lathes of another G code system, and has no meaning in this one.
    fn lone_step(&self, word: &Word) -> Option<Role> {
        let lathe = self.control.machine() == Machine::Lathe && !word.comma;
        let role = match word.letter {
            'U' => Role::U,
            'V' => Role::V,
            'W' => Role::W,
            'H' => Role::C,
            _ => return None,
        };
        (lathe && self.codes.letter(word.letter, false).is_none()).then_some(role)
    }

    /// A word beside M19, which the tables have without one.
    fn angle_of_stop(&mut self, word: &Word, span: Span) {
        let letter = word.letter;
        let what =
            format!("{letter} beside M19 is the angle at which the spindle stops, which is not converted");
        let help = format!(
            "name the code in the profiles of both machines, each with its letter: [[site]] with code = \"M19 {letter}\", name = \
             \"spindle.stop.at\", words = {{ {letter} = \"angle\" }}, and a text"
        );
        self.findings.add(Diagnostic::new(Code::NotUnderstood, span, what).with_help(help));
    }

    /// S beside M19 alone, which some builders take as the angle.
    fn speed_of_stop(&mut self, span: Span, codes: &BlockCodes<'a>) {
        use Op::{SpindleCcw, SpindleCw, SpindleOrient, SurfaceSpeed, TurnsPerMinute};
        let has = |wanted: &[Op]| codes.iter().any(|(_, row)| wanted.contains(&row.op));
        if !has(&[SpindleOrient]) || has(&[SpindleCw, SpindleCcw, SurfaceSpeed, TurnsPerMinute]) {
            return;
        }
        let what = "S beside M19 is taken as a speed; on some builders' machines it is the angle at which the spindle stops";
        let help = "if it is an angle, name the code in the profiles of both machines: [[site]] with code = \"M19 S\", name = \
                    \"spindle.stop.at\", words = { S = \"angle\" }, and a text";
        self.findings.add(Diagnostic::new(Code::Conditional, span, what).with_help(help).asked_once());
    }

    /// The pecks of a tap, which goes to its depth in one go if the shop says so: the word says nothing then.
    fn peck_of_tap(&mut self, span: Span, what: String) {
        if self.control.behaviour(Question::TapPeck).is_some_and(|row| row.value == "one.go") {
            let told = "the tap goes to its depth in one go: the depth of its pecks is left out, as the profile says";
            return self.findings.add(Diagnostic::new(Code::Conditional, span, told).asked_once());
        }
        let help = "if the tap may go down in one go, write \"tap.peck\" = \"one.go\" under [behaviours] in the source's profile";
        let told = Diagnostic::new(Code::NotUnderstood, span, what).with_help(help);
        self.findings.add(told.lacking("behaviour.tap.peck=one.go".to_owned()));
    }

    fn no_role(&mut self, word: &Word, span: Span, codes: &BlockCodes<'a>, in_force: Option<&CodeMeaning>) {
        if !word.comma && codes.iter().any(|(_, row)| row.op == Op::SpindleOrient) {
            return self.angle_of_stop(word, span);
        }
        let comma = if word.comma { "," } else { "" };
        if self.foreign_axis(word) {
            let message = format!("{} is not an axis of this machine", word.letter);
            let help = format!(
                "name a machine profile with machine = \"lathe\", or list {} under 'axes' in the profile",
                word.letter
            );
            return self.findings.add(Diagnostic::new(Code::LatheProgram, span, message).with_help(help));
        }
        if self.lone_step(word).is_some() {
            return self.no_step(span);
        }
        if let Some(what) = not_converted(word, codes, in_force) {
            let mut rows = codes.iter().map(|(_, row)| *row).chain(in_force);
            if word.letter != 'Q' || !rows.any(|row| is_tap(row.op)) {
                return self.findings.not_understood(span, what);
            }
            return self.peck_of_tap(span, what);
        }
        if let Some((_, row)) = codes.iter().find(|(_, row)| matches!(row.op, Op::Act | Op::Builder)) {
            let message = format!("{} has no meaning beside {}", word.letter, row.code);
            let letter = word.letter;
            let help = format!(
                "name it in the [[site]] of {} in the machine's profile: words = {{ {letter} = \"{letter}\" }}",
                row.code
            );
            let told = Diagnostic::new(Code::NotUnderstood, span, message).with_help(help);
            let (code, name) = (row.code.as_str().into(), letter.to_string().into());
            return self.findings.add(told.asking_for(Asks::Word { target: false, code, letter, name }));
        }
        if let Some(cycle) = self.idle_beside(word, codes) {
            let what = format!(
                "{} has no meaning beside {cycle}, and is left out: make sure that the machine does nothing with it, neither in \
                 this cycle nor in a later one that has none of its own",
                word.letter
            );
            let told = Diagnostic::new(Code::Conditional, span, what);
            return self.findings.add(
                told.with_help("take it out of the program, or write the cycle that takes it").asked_once(),
            );
        }
        // A code that acts in its block alone is the one that takes words of its own.
        let own = codes.iter().find(|(_, row)| row.op.group() == Group::OneShot || row.op.is_cycle());
        let beside = match own.or(codes.first()) {
            Some((_, row)) => format!(" beside {}", row.code),
            None => " in a block without a code".into(),
        };
        let message = format!("{comma}{} has no meaning{beside}", word.letter);
        // A parameter says whether corners and angles of a lathe have a comma.
        let corner = matches!(word.letter, 'A' | 'C' | 'R') && self.control.machine() == Machine::Lathe;
        if corner && word.comma && self.control.behaviour(Question::CornerLetters).is_some() {
            let help = self.comma_help(word.letter);
            return self.findings.add(Diagnostic::new(Code::NotUnderstood, span, message).with_help(help));
        }
        let told = Diagnostic::new(Code::NotUnderstood, span, message);
        if let Some((help, setting)) = self.other_form(word, codes) {
            return self.findings.add(told.with_help(help).lacking(setting));
        }
        let named = self.spindle_by_word(word, codes).or_else(|| self.signal_by_word(word, codes));
        self.findings.add(match named {
            Some((help, asks)) => told.with_help(help).asking_for(asks),
            None => told,
        });
    }

    /// The drilling cycle of a mill that a word of another cycle stands beside: programs carry such words along.
    fn idle_beside(&self, word: &Word, codes: &BlockCodes<'a>) -> Option<&'a str> {
        let (_, row) = codes.iter().find(|(_, row)| row.op.is_cycle())?;
        let rows = || self.control.dialect().codes.iter().filter(|row| row.op.is_cycle());
        let others =
            rows().any(|other| matches!(explicit(other, word), Some(Role::CycleDwell | Role::CycleQ)));
        // How far a bar goes off the wall is not to be lost.
        let shifts = matches!(row.op, Op::CycleFineBore | Op::CycleBackBore) && word.letter == 'Q';
        let idle = others && !shifts && !word.comma && self.control.machine() == Machine::Mill;
        idle.then_some(row.code.as_str())
    }

    /// Signs of a lathe program that a mill's table would read as something else: `G50 S3000`,
    /// `G50 X100.`, `G99 G01 F.003` and tool words with an offset in them.
    pub fn check_machine(&mut self, words: &Words<'a>, codes: &BlockCodes<'a>) {
        if self.control.machine() != Machine::Mill {
            return;
        }
        let has = |wanted: &[Op]| codes.iter().any(|(_, row)| wanted.contains(&row.op));
        let feeds = words.iter().any(|(word, _)| word.letter == 'F');
        let per_turn =
            feeds && has(&[Op::ReturnR, Op::ReturnInitial]) && has(&[Op::Linear, Op::ArcCw, Op::ArcCcw]);
        for &(word, span) in words {
            let what = match word.letter {
                'S' | 'X' | 'Z' if has(&[Op::ScaleOff]) && codes.len() == 1 => {
                    "a limit or a position beside G50"
                }
                // Beside M6 it is the number of a tool.
                'T' if has_offset(word) && !has(&[Op::ToolChange]) => "a tool word with an offset in it",
                'F' if per_turn => "a feed beside G98 or G99 without a cycle",
                _ => continue,
            };
            let message = format!("{what} belongs to a lathe program");
            let help = "name a machine profile with machine = \"lathe\"";
            self.findings.add(Diagnostic::new(Code::LatheProgram, span, message).with_help(help));
        }
    }
}

/// True for a tap whose code may have the depth of its pecks beside it.
const fn is_tap(op: Op) -> bool {
    matches!(op, Op::CycleTap | Op::CycleTapLeft | Op::CycleTapRigid)
}

/// What a word is that the machine knows and no conversion has, in words.
fn not_converted(word: &Word, codes: &BlockCodes<'_>, in_force: Option<&CodeMeaning>) -> Option<String> {
    let has = |op: fn(Op) -> bool| {
        codes.iter().map(|(_, row)| *row).chain(in_force).find(|row| op(row.op)).map(|row| &*row.code)
    };
    let letter = word.letter;
    let finishes = codes.iter().find(|(_, row)| row.op == Op::Finish);
    if let Some((_, row)) = finishes.filter(|_| matches!(letter, 'D' | 'I' | 'K' | 'R')) {
        return Some(format!(
            "{letter} beside {} is a word of the roughing before it: no source says that finishing takes it, and what it does then. Leave \
             it out",
            row.code.split(' ').next().unwrap_or_default()
        ));
    }
    let sets =
        codes.iter().find(|(_, row)| matches!(row.op, Op::TurningSetup | Op::FacingSetup | Op::PatternSetup));
    if let Some((_, row)) = sets.filter(|_| letter == 'Q') {
        return Some(format!(
            "{} has Q and no P: it does not say with which block its contour begins",
            row.code.split(' ').next().unwrap_or_default()
        ));
    }
    match letter {
        'Q' => has(is_tap).map(|code| {
            format!(
                "Q beside {code} is the depth of each peck of a rigid tap, which is not converted: how far a control backs off \
                 between pecks is a setting of its own. Tap to the depth in one go, or \
                 write the pecks as taps of their own"
            )
        }),
        'E' => has(is_tap).map(|code| {
            format!("E beside {code} counts the threads an inch, which is not converted: write the lead (F)")
        }),
        'J' => has(is_tap).map(|code| format!("no source says what J beside {code} is on this control")),
        _ => None,
    }
}

fn is_arc_word(role: Role) -> bool {
    matches!(role, Role::ArcI | Role::ArcJ | Role::ArcK | Role::ArcRadius)
}

/// `T0303`, `T1414`: tool and offset in four digits. `T0012` and `T1001` are tools.
fn has_offset(word: &Word) -> bool {
    let Some(ExprKind::Number(number)) = word.value.as_ref().map(|value| &value.kind) else { return false };
    let (tool, offset) = ((number.value / 100.0).trunc(), number.value % 100.0);
    number.digits == 4 && !number.point && tool > 0.0 && (tool < 10.0 || tool == offset)
}

/// The role that a row of the table gives a word.
fn explicit(row: &CodeMeaning, word: &Word) -> Option<Role> {
    if row.words.is_empty() {
        return None;
    }
    let mut buffer = [b',', 0];
    let letter = u8::try_from(word.letter).ok()?;
    buffer[1] = letter;
    let name = std::str::from_utf8(if word.comma { &buffer } else { &buffer[1..] }).ok()?;
    row.words.get(name).copied()
}
