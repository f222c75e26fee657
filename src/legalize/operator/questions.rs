//! Talking with the operator: questions by a stop at which the register is set, prints by formatted output.
//!
//! Law of a question: the register is set to 0 (what an empty answer gives), the machine stops with the
//! question and the register's number, and the operator enters the value there. Side condition: the
//! operator does so before cycle start; hence the review diagnostic.
//! Law of a print: the same text and values go to the output port, since the target prints nowhere else; the
//! digits of a value are four before and four after the point, because no source gives the source's format.

use crate::canon::Op;
use crate::diag::{Code, Diagnostic};
use crate::dialect::Question;
use crate::ir::{
    Class, Expr, Module, NcItem, OutputPart, Place, PrintPart, Program, SourceInfo, Stmt, StmtKind, Stmts,
    Var,
};
use crate::legalize::{Context, Registers};

/// Digits of a printed value before and after the point: eight together is what the targets take.
const DIGITS: (u32, u32) = (4, 4);

/// Replaces questions; needs the registers, so it runs after their allocation.
pub fn questions(module: &mut Module, context: &mut Context<'_>) {
    if context.target.statement("input").is_some() {
        return;
    }
    let registers = std::mem::take(&mut context.registers);
    ask_all(module, &registers, context);
    context.registers = registers;
}

fn ask_all(module: &mut Module, registers: &Registers, context: &mut Context<'_>) {
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            let mut out = Stmts::with_capacity(block.stmts.len());
            for stmt in std::mem::take(&mut block.stmts) {
                match stmt.kind {
                    StmtKind::Input { target, serial } => {
                        let question = take_question(&mut out, serial);
                        ask(target, serial, question, stmt.site, index, registers, &mut out, context);
                    }
                    kind => out.push(Stmt { kind, site: stmt.site }),
                }
            }
            block.stmts = out;
        }
    }
}

/// The text printed right before, to which the cursor was left. What ends spindle and coolant for the question may stand between.
fn take_question(out: &mut Stmts, serial: bool) -> Option<String> {
    let quiet = |stmt: &Stmt| match &stmt.kind {
        StmtKind::Comment => true,
        StmtKind::Nc(nc) => {
            nc.items.iter().all(|item| matches!(item, NcItem::Op(Op::SpindleStop | Op::CoolantOff)))
        }
        _ => false,
    };
    let at = out.iter().rposition(|stmt| !quiet(stmt))?;
    // What was printed on the same line before it would be lost.
    let before = out[..at].iter().rfind(|stmt| !quiet(stmt));
    if before.is_some_and(|stmt| matches!(stmt.kind, StmtKind::Print { stay: true, .. })) {
        return None;
    }
    let StmtKind::Print { serial: on, parts, .. } = &out[at].kind else { return None };
    if *on && !serial {
        return None;
    }
    let texts: Option<Vec<&str>> = parts
        .iter()
        .map(|part| match part {
            PrintPart::Text(text) => Some(text.as_str()),
            PrintPart::Value(_) => None,
        })
        .collect();
    let text = texts?.concat();
    let kept = StmtKind::Comment;
    let printed = std::mem::replace(&mut out[at].kind, kept);
    // Nothing is left of the print but its comments.
    if out[at].site.comments.is_empty() && out[at].site.sequence.is_none() {
        out.remove(at);
    }
    drop(printed);
    Some(text)
}

#[allow(clippy::too_many_arguments)] // one statement's parts, taken apart by its only caller
fn ask(
    target: Place,
    serial: bool,
    question: Option<String>,
    site: SourceInfo,
    index: usize,
    registers: &Registers,
    out: &mut Stmts,
    context: &mut Context<'_>,
) {
    let span = site.span;
    let register = match &target {
        Place::Var(var) => registers.of.get(var).map(|r| format!("{}{}", r.name, r.number)),
        _ => None,
    };
    let Some(register) = register else {
        let what = "the answer goes to a computed register, so the operator cannot be told where to enter it";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
        return;
    };
    let whose = if serial { "what the serial line sends" } else { "the answer" };
    let what = format!("the operator must enter {whose} in {register} at the stop, before cycle start");
    context.add(index, Diagnostic::new(Code::Conditional, span, what).asked_once());
    context.rests_on_source(index, span, Question::InputDefaultZero);
    if context.source.behaviour(Question::InputDefaultZero).is_some_and(|row| row.value == "false") {
        let what = "an empty answer is not 0 on the source, but the conversion sets the register to 0 before it \
             asks";
        context.add(index, Diagnostic::new(Code::NoEquivalent, span, what));
    }
    let question = question.map(|q| {
        let question = q.trim().trim_end_matches([':', '?', '=', ' ']);
        question.replace('(', "[").replace(')', "]").replace('%', "PCT")
    });
    let text = match question.filter(|q| !q.is_empty()) {
        Some(question) => format!("{register} {question}"),
        None => format!("SET {register}"),
    };
    let skip = site.skip;
    out.push(Stmt {
        kind: StmtKind::Assign { target, value: Expr::Number(0.0) },
        site: SourceInfo { span, skip, ..SourceInfo::default() },
    });
    out.push(Stmt {
        kind: StmtKind::StopMessage { number: Expr::Number(1.0).into(), text: text.into() },
        site,
    });
}

/// Replaces prints by formatted output.
pub fn prints(module: &mut Module, context: &mut Context<'_>) {
    if context.target.statement("print").is_some() {
        return;
    }
    let opens = context.target.statement("output.open").is_some();
    for (index, program) in module.programs.iter_mut().enumerate() {
        for block in &mut program.blocks {
            let mut out = Stmts::with_capacity(block.stmts.len());
            let mut pending: Vec<OutputPart> = Vec::new();
            let mut open = false;
            // What ends a run of prints belongs to the last of them.
            let mut site = SourceInfo::default();
            for stmt in std::mem::take(&mut block.stmts) {
                match stmt.kind {
                    StmtKind::Print { parts, serial, stay } => {
                        site.span = stmt.site.span;
                        let what = if serial { "printed to the port" } else { "printed on the screen" };
                        let what = format!(
                            "{what}, and its number format is not stated: it goes to the output port with \
                             four digits before and after the point"
                        );
                        context.add_once(
                            index,
                            &what,
                            Diagnostic::new(Code::Conditional, site.span, what.clone()).asked_once(),
                        );
                        for text in altered(&parts) {
                            let what = format!("the text '{}' becomes '{}'", text.trim(), plain(text).trim());
                            let code = if loses(text) { Code::MessageAltered } else { Code::LettersReplaced };
                            let finding = Diagnostic::new(code, site.span, what.clone());
                            context.add_once(index, &what, finding);
                        }
                        if opens && !open {
                            out.push(Stmt { kind: StmtKind::OpenPort, site: site.clone() });
                            open = true;
                        }
                        pending.extend(parts.into_iter().map(output));
                        let parts = if stay { None } else { Some(std::mem::take(&mut pending)) };
                        let kind =
                            parts.filter(|p| !p.is_empty()).map_or(StmtKind::Comment, StmtKind::Output);
                        out.push(Stmt { kind, site: stmt.site });
                    }
                    // Comments do not end a run of prints.
                    StmtKind::Comment => out.push(stmt),
                    kind => {
                        finish(&mut out, &mut pending, &mut open, &site);
                        out.push(Stmt { kind, site: stmt.site });
                    }
                }
            }
            finish(&mut out, &mut pending, &mut open, &site);
            block.stmts = out;
        }
    }
}

/// Formatted output takes variables only: whatever else is printed is computed first.
pub fn hold_values(program: &mut Program, _: usize, context: &mut Context<'_>) -> bool {
    if context.target.statement("print").is_some() {
        return false;
    }
    let mut temp = crate::legalize::rewrite::highest_temp(program);
    for block in &mut program.blocks {
        let mut out = Stmts::with_capacity(block.stmts.len());
        for mut stmt in std::mem::take(&mut block.stmts) {
            if let StmtKind::Print { parts, .. } = &mut stmt.kind {
                let site =
                    || SourceInfo { span: stmt.site.span, skip: stmt.site.skip, ..SourceInfo::default() };
                for part in parts {
                    let PrintPart::Value(value) = part else { continue };
                    if matches!(value, Expr::Var(_)) {
                        continue;
                    }
                    temp += 1;
                    let held = Var { class: Class::Temp, number: temp };
                    let value = std::mem::replace(value, Expr::Var(held));
                    out.push(Stmt {
                        kind: StmtKind::Assign { target: Place::Var(held), value },
                        site: site(),
                    });
                }
            }
            out.push(stmt);
        }
        block.stmts = out;
    }
    true
}

fn finish(out: &mut Stmts, pending: &mut Vec<OutputPart>, open: &mut bool, site: &SourceInfo) {
    if !pending.is_empty() {
        out.push(Stmt { kind: StmtKind::Output(std::mem::take(pending)), site: site.clone() });
    }
    if std::mem::take(open) {
        out.push(Stmt { kind: StmtKind::ClosePort, site: site.clone() });
    }
}

fn output(part: PrintPart) -> OutputPart {
    match part {
        PrintPart::Text(text) => OutputPart::Text(plain(&text)),
        PrintPart::Value(value) => OutputPart::Value { value, whole: DIGITS.0, fraction: DIGITS.1 },
    }
}

/// Texts that formatted output cannot show as they are, but for their case.
fn altered(parts: &[PrintPart]) -> impl Iterator<Item = &str> {
    let texts = parts.iter().filter_map(|part| match part {
        PrintPart::Text(text) => Some(text.as_str()),
        PrintPart::Value(_) => None,
    });
    texts.filter(|text| !plain(text).trim().eq_ignore_ascii_case(text.trim()))
}

/// True for a text with a letter that has no substitute, or with a sign of comparison: without it the text says something
/// else.
fn loses(text: &str) -> bool {
    text.chars().any(|c| !c.is_ascii() || "<>".contains(c))
}

/// The text in characters that formatted output takes: brackets and signs that begin a value or
/// stand for a space there become others.
fn plain(text: &str) -> String {
    let safe = |c: char| match c.to_ascii_uppercase() {
        '#' => "NO.".to_owned(),
        '[' | '(' => "/".to_owned(),
        ']' | ')' => "/".to_owned(),
        '*' => "X".to_owned(),
        '%' => "PCT".to_owned(),
        c if c.is_ascii_alphanumeric() || " +-/.,".contains(c) => c.to_string(),
        _ => " ".to_owned(),
    };
    text.chars().map(safe).collect()
}
