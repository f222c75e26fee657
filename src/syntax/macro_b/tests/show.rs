//! A short text form of blocks, for expectations that are written by hand.

use crate::syntax::{
    Block, Comment, Expr, ExprKind, Fence, Index, Item, ItemKind, OutputPart, ProgramName, Target, VarRef,
};

/// All items of the blocks, blocks parted by ` | `.
pub fn show(blocks: &[Block], source: &[u8]) -> String {
    let shown: Vec<String> = blocks.iter().map(|block| items(&block.items, source)).collect();
    shown.join(" | ")
}

fn items(list: &[Item], source: &[u8]) -> String {
    list.iter().map(|i| item(i, source)).collect::<Vec<_>>().join(" ")
}

fn item(item: &Item, source: &[u8]) -> String {
    match &item.kind {
        ItemKind::Skip(level) => format!("skip{}", level.map_or(String::new(), |l| l.to_string())),
        ItemKind::Tape => "%".into(),
        ItemKind::EndOfBlock => ";".into(),
        ItemKind::Program(ProgramName::Number(number)) => format!("program {number}"),
        ItemKind::Program(ProgramName::Name(name)) => format!("program <{name}>"),
        ItemKind::Sequence { number, .. } => format!("N{number}"),
        ItemKind::Comment(Comment { text, fence }) => {
            let text = String::from_utf8_lossy(text.of(source)).into_owned();
            match fence {
                Fence::Closed => format!("({text})"),
                Fence::Open => format!("({text}"),
                Fence::Within => format!("[({text})]"),
                _ => format!("outside<{text}>"),
            }
        }
        ItemKind::Word(word) => {
            let comma = if word.comma { "," } else { "" };
            format!("{comma}{}={}", word.letter, word.value.as_ref().map_or("none".into(), expr))
        }
        ItemKind::Assign { target, value, .. } => format!("{}:={}", variable(target), expr(value)),
        ItemKind::If { condition, then, bare, body } => format!(
            "if{}{} {} {{{}}}",
            if *bare { "-bare" } else { "" },
            if *then { "-then" } else { "" },
            expr(condition),
            items(body, source)
        ),
        ItemKind::Do { condition: Some(condition), number } => {
            format!("while {} do{number}", expr(condition))
        }
        ItemKind::Do { condition: None, number } => format!("do{number}"),
        ItemKind::End { number } => format!("end{number}"),
        ItemKind::Goto(Target::Sequence(number)) => format!("goto {number}"),
        ItemKind::Goto(Target::Computed(target)) => format!("goto {}", expr(target)),
        ItemKind::SetNames { first, names } => format!("names {first} {}", names.join(",")),
        ItemKind::Output { binary, parts } => {
            let parts: Vec<String> = parts
                .iter()
                .map(|part| match part {
                    OutputPart::Text(span) => format!("'{}'", String::from_utf8_lossy(span.of(source))),
                    OutputPart::Value { value, whole, fraction } => {
                        format!("{}[{whole}.{fraction}]", expr(value))
                    }
                })
                .collect();
            format!("{}print {}", if *binary { "b" } else { "d" }, parts.join(" "))
        }
        ItemKind::OpenPort => "open".into(),
        ItemKind::ClosePort => "close".into(),
        ItemKind::Unparsed => "UNPARSED".into(),
        other => format!("{other:?}"),
    }
}

fn expr(e: &Expr) -> String {
    match &e.kind {
        ExprKind::Number(number) => format!("{}{}", number.value, if number.point { "." } else { "" }),
        ExprKind::Variable(v) => variable(v),
        ExprKind::Negate(a) => format!("neg({})", expr(a)),
        ExprKind::Plus(a) => format!("pos({})", expr(a)),
        ExprKind::Not(a) => format!("not({})", expr(a)),
        ExprKind::Group(a) => format!("[{}]", expr(a)),
        ExprKind::Binary(op, operands) => {
            let [a, b] = &**operands;
            format!("{op:?}({},{})", expr(a), expr(b))
        }
        ExprKind::Call { function, arguments, form } => {
            let arguments: Vec<String> = arguments.iter().map(expr).collect();
            format!("{function:?}{form:?}({})", arguments.join(","))
        }
    }
}

fn variable(v: &VarRef) -> String {
    match &v.index {
        Index::None => v.name.to_string(),
        Index::Number(number) => format!("{}{number}", v.name),
        Index::Bit(number, bit) => format!("{}{number}.{bit}", v.name),
        Index::Letter(letter) => format!("{}{letter}", v.name),
        Index::Name(name) => format!("{}<{name}>", v.name),
        Index::Computed(inner) => format!("{}({})", v.name, expr(inner)),
    }
}
