//! Faults inside a block that the grammar lets pass and the control does not.

use super::rules::Rules;
use super::shape::{self, Shape};
use crate::canon::Func;
use crate::diag::Code;
use crate::syntax::{
    BinaryOp, Block, CallForm, Expr, ExprKind, Index, Item, ItemKind, Number, OutputPart, SyntaxError,
    VarRef, Word, for_each_expr,
};
use crate::text::Span;
use thin_vec::ThinVec;

/// The list that faults are added to.
struct Faults<'a>(&'a mut ThinVec<SyntaxError>);

impl Faults<'_> {
    fn add(&mut self, code: Code, span: Span, message: impl Into<String>) {
        self.0.push(SyntaxError { code, span, message: message.into() });
    }
}

/// Checks the outline of a block: comments and brackets.
pub fn check_shape(rules: &Rules, source: &[u8], block: &mut Block, line_start: u32, shape: &Shape) {
    let place = |at: usize| Span::new(line_start + at as u32, line_start + at as u32 + 1);
    let mut faults = Faults(&mut block.errors);
    if let Some(at) = shape.open_comment {
        faults.add(Code::UnclosedComment, place(at), "this comment is not closed on its line");
    }
    if let Some(at) = shape.nested_comment.filter(|_| rules.comments_do_not_nest) {
        faults.add(Code::NestedComment, place(at), "a comment cannot contain another");
    }
    if let Some(limit) = rules.bracket_depth.filter(|limit| shape.depth > *limit as usize)
        && let Some(at) = shape::bracket_beyond(block.span.of(source), limit)
    {
        let at = block.span.start + at as u32;
        let message = format!("brackets nest deeper than the {limit} levels that the control takes");
        faults.add(Code::BracketDepth, Span::new(at, at + 1), message);
    }
}

/// Checks what the items say.
pub fn check_items(rules: &Rules, source: &[u8], items: &[Item], errors: &mut ThinVec<SyntaxError>) {
    check_each(rules, source, items, errors);
    check_expressions(rules, source, items, &mut Faults(errors));
}

/// Checks all but what expressions compute, also after a condition.
fn check_each(rules: &Rules, source: &[u8], items: &[Item], errors: &mut ThinVec<SyntaxError>) {
    let mut faults = Faults(errors);
    let may_call = may_call_macro(items);
    for item in items {
        match &item.kind {
            ItemKind::Word(word) => check_word(rules, word, item.span, may_call, &mut faults),
            ItemKind::Assign { target, value, .. } => check_assign(rules, target, value, &mut faults),
            ItemKind::If { body, .. } => {
                check_each(rules, source, body, faults.0);
                if body.iter().all(|item| matches!(item.kind, ItemKind::Comment(_))) {
                    faults.add(Code::NothingConditional, item.span, "nothing follows this condition");
                }
            }
            ItemKind::Do { number, .. } | ItemKind::End { number } if !(1..=3).contains(number) => {
                let digits = digits_at_end(source, item.span);
                faults.add(Code::LoopNumber, digits, format!("loops are numbered 1 to 3, not {number}"));
            }
            ItemKind::Output { parts, .. } => check_output(parts, &mut faults),
            _ => {}
        }
    }
    if may_call && rules.call_stands_first {
        check_call(items, &mut faults);
    }
}

/// True where a code of the block may call a macro, so that its words are arguments.
fn may_call_macro(items: &[Item]) -> bool {
    items.iter().any(|item| match &item.kind {
        ItemKind::Word(Word { letter: 'G', value: Some(value), .. }) => constant(value)
            .is_none_or(|number| number.floor() == 65.0 || number.floor() == 66.0 || number >= 100.0),
        ItemKind::Word(Word { letter: 'M', value: Some(value), .. }) => {
            constant(value).is_none_or(|number| number >= 100.0)
        }
        _ => false,
    })
}

fn check_word(rules: &Rules, word: &Word, span: Span, may_call: bool, faults: &mut Faults<'_>) {
    let whole = rules.whole_letters.contains(&word.letter) && !word.comma;
    // After a call M, S and T are arguments like any other.
    if !whole || may_call {
        return;
    }
    let Some(value) = &word.value else { return };
    if let Some(number) =
        written(value).filter(|n| n.point && (rules.point_is_fraction || n.value.fract() != 0.0))
    {
        let kind = if number.value.fract() == 0.0 { "without a point" } else { "without a fraction" };
        faults.add(Code::NotInteger, span, format!("{} takes a whole number, {kind}", word.letter));
    }
}

fn check_assign(rules: &Rules, target: &VarRef, value: &Expr, faults: &mut Faults<'_>) {
    if target.name == "#" && target.index == Index::Number(0) {
        faults.add(Code::NullAssigned, target.span, "#0 is always vacant and cannot be written");
    }
    let Some(limit) = rules.constant_digits else { return };
    if let Some(number) = written(value).filter(|number| number.digits > limit) {
        let message = format!("the number has {} digits, and the control takes {limit}", number.digits);
        faults.add(Code::TooManyDigits, value.span, message);
    }
}

/// `[53]`: at most eight places together, and one at least.
fn check_output(parts: &[OutputPart], faults: &mut Faults<'_>) {
    for part in parts {
        if let OutputPart::Value { value, whole, fraction } = part
            && !(1..=8).contains(&(whole + fraction))
        {
            let message = format!("{whole} and {fraction} places: the sum must be 1 to 8");
            faults.add(Code::OutputFormat, value.span, message);
        }
    }
}

/// G65 and G66 stand first and allow no other code in their block.
fn check_call(items: &[Item], faults: &mut Faults<'_>) {
    let words = || {
        items.iter().filter_map(|item| match &item.kind {
            ItemKind::Word(word) if !word.comma => Some((word, item.span)),
            _ => None,
        })
    };
    let calls = |word: &Word| {
        word.letter == 'G'
            && word.value.as_ref().and_then(constant).is_some_and(|n| n == 65.0 || n.floor() == 66.0)
    };
    let Some(call) = words().position(|(word, _)| calls(word)) else { return };
    let code_before = words().take(call).find(|(word, _)| matches!(word.letter, 'G' | 'M'));
    let code_behind = words().skip(call + 1).find(|(word, _)| word.letter == 'G');
    if let Some((word, span)) = code_before.or(code_behind) {
        let message = format!("this {} word cannot share a block with a macro call", word.letter);
        faults.add(Code::MacroCallNotAlone, span, message);
    } else if call > 0
        && let Some((_, span)) = words().next()
    {
        faults.add(Code::ArgumentBeforeCall, span, "arguments come after the macro call, not before it");
    }
}

/// Quotients and function calls whose constants have no value. After a condition they may never be computed.
fn check_expressions(rules: &Rules, source: &[u8], items: &[Item], faults: &mut Faults<'_>) {
    let body = items.iter().find_map(|item| match &item.kind {
        ItemKind::If { body, .. } => body.first(),
        _ => None,
    });
    for_each_expr(items, &mut |expr| {
        let may_run = body.is_some_and(|body| expr.span.start >= body.span.start);
        check_expression(rules, source, expr, may_run.then_some(Code::AlarmIfRun), faults);
    });
}

/// Looks at one of them; `instead` is said of what has no value where it may never be computed.
fn check_expression(
    rules: &Rules,
    source: &[u8],
    expr: &Expr,
    instead: Option<Code>,
    faults: &mut Faults<'_>,
) {
    match &expr.kind {
        ExprKind::Binary(BinaryOp::Divide, operands) => {
            let [left, right] = &**operands;
            check_divisor(right, instead, faults);
            if rules.atan_slash_needs_bracket {
                check_atan(source, left, right, faults);
            }
        }
        ExprKind::Binary(BinaryOp::Modulo, operands) => check_divisor(&operands[1], instead, faults),
        ExprKind::Call { function, arguments, .. } => check_domain(*function, arguments, instead, faults),
        _ => {}
    }
}

fn check_divisor(divisor: &Expr, instead: Option<Code>, faults: &mut Faults<'_>) {
    if constant(divisor) == Some(0.0) {
        faults.add(instead.unwrap_or(Code::DivisionByZero), divisor.span, "the divisor is zero");
    }
}

/// `ATAN[1]/10`: the slash asks for a second argument in brackets.
fn check_atan(source: &[u8], left: &Expr, right: &Expr, faults: &mut Faults<'_>) {
    if let ExprKind::Call { function: Func::Atan, form: CallForm::Plain, .. } = &rightmost(left).kind {
        let text = String::from_utf8_lossy(right.span.of(source)).into_owned();
        let message = format!("`{text}` must stand in brackets, or ATAN with its argument must");
        faults.add(Code::AtanDivision, right.span, message);
    }
}

fn check_domain(function: Func, arguments: &[Expr], instead: Option<Code>, faults: &mut Faults<'_>) {
    let Some(argument) = arguments.first() else { return };
    let Some(value) = constant(argument) else { return };
    let domain = match function {
        Func::Asin | Func::Acos if value.abs() > 1.0 => "-1 to 1",
        Func::Sqrt if value < 0.0 => "0 and above",
        Func::Ln if value <= 0.0 => "above 0",
        _ => return,
    };
    let code = instead.unwrap_or(Code::FunctionDomain);
    faults.add(code, argument.span, format!("the argument must be {domain}"));
}

/// The operand just before the end of an expression.
fn rightmost(expr: &Expr) -> &Expr {
    match &expr.kind {
        ExprKind::Binary(_, operands) => rightmost(&operands[1]),
        ExprKind::Negate(inner) | ExprKind::Plus(inner) => rightmost(inner),
        _ => expr,
    }
}

/// A number with or without a sign, as it is written.
fn written(expr: &Expr) -> Option<Number> {
    match &expr.kind {
        ExprKind::Number(number) => Some(*number),
        ExprKind::Negate(inner) | ExprKind::Plus(inner) => written(inner),
        _ => None,
    }
}

/// The value of a constant, also in brackets.
fn constant(expr: &Expr) -> Option<f64> {
    match &expr.kind {
        ExprKind::Number(number) => Some(number.value),
        ExprKind::Negate(inner) => constant(inner).map(|value| -value),
        ExprKind::Plus(inner) | ExprKind::Group(inner) => constant(inner),
        _ => None,
    }
}

/// The digits that end an item.
fn digits_at_end(source: &[u8], item: Span) -> Span {
    let digits = item.of(source).iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    Span::new(item.end - digits as u32, item.end)
}
