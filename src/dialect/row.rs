//! What all rows have in common: a section, a name within it, an origin.

use super::{
    Argument, Behaviour, CodeMeaning, Forbidden, Form, Function, InUse, Limit, Matter, Names, Numbers,
    Operator, Origin, SameCells, Setting, Statement, SystemVariable, Text, VariableClass, WordMeaning,
};
use crate::canon::Op;
use serde::de::DeserializeOwned;

/// A row of a dialect's table: one fact.
pub trait Row: DeserializeOwned {
    /// The section of the file that holds it.
    const SECTION: &'static str;
    /// The word before the colon of [`Row::fact`].
    const KIND: &'static str;

    /// Its name among the rows of its section.
    fn key(&self) -> String;
    /// Where it comes from.
    fn origin(&self) -> &Origin;
    /// Where it comes from, to be changed.
    fn origin_mut(&mut self) -> &mut Origin;

    /// What a row of an extending table shares with the row that it stands for: its name, and where it holds.
    fn full_key(&self) -> String {
        self.key()
    }

    /// The name that diagnostics give it and that a machine profile confirms it
    /// by: `behaviour:goto.forward.first`, `code:G10 L2`, `system:#5221`, `operator:and.bits`.
    fn fact(&self) -> String {
        match self.key() {
            key if key.is_empty() => Self::KIND.into(),
            key => format!("{}:{key}", Self::KIND),
        }
    }
}

fn limited(key: String, machine: &Option<String>, when: &Option<String>) -> String {
    format!("{key} {machine:?} {when:?}")
}

fn of_machine(key: String, machine: &Option<String>, option: &Option<String>) -> String {
    match (machine, option) {
        (None, None) => key,
        _ => format!("{key} {machine:?} {option:?}"),
    }
}

macro_rules! row {
    ($($type:ident $section:literal $kind:literal |$row:ident| $key:expr $(, $limits:ident $column:ident)?;)*) => {$(
        impl Row for $type {
            const SECTION: &'static str = $section;
            const KIND: &'static str = $kind;
            fn key(&self) -> String {
                let $row = self;
                $key
            }
            $(fn full_key(&self) -> String {
                $limits(self.key(), &self.machine, &self.$column)
            })?
            fn origin(&self) -> &Origin {
                &self.origin
            }
            fn origin_mut(&mut self) -> &mut Origin {
                &mut self.origin
            }
        }
    )*};
}

row! {
    Numbers "numbers" "numbers" |_row| String::new();
    Text "text" "text" |_row| String::new();
    Names "names" "names" |_row| String::new();
    Form "forms" "form" |row| row.place.name().into();
    Limit "limits" "limit" |row| row.name.clone();
    Forbidden "forbidden" "forbidden" |row| {
        let first = |ops: &[Op]| ops.first().map_or("", |op| op.name());
        match row.words.first() {
            Some(word) if row.negative => format!("{word}/negative"),
            Some(word) if row.ops.is_empty() => format!("{word}/any"),
            Some(word) => format!("{word}/{}", first(&row.ops)),
            None => format!("{}/{}", first(&row.under), first(&row.ops)),
        }
    }, limited when;
    Operator "operators" "operator" |row| row.meaning.clone();
    Function "functions" "function" |row| match row.arguments {
        1 => row.function.name().into(),
        n => format!("{}/{n}", row.function),
    };
    Statement "statements" "statement" |row| row.name.clone();
    Behaviour "behaviours" "behaviour" |row| row.question.name().into(), of_machine option;
    Matter "matters" "machine" |row| row.name.clone();
    InUse "in_use" "in_use" |row| format!("{}{}", row.name, row.first);
    SameCells "same_cells" "same_cells" |row| format!("{}{}", row.name, row.first);
    VariableClass "variables" "variable" |row| format!("{}{}", row.name, row.first);
    SystemVariable "system" "system" |row| match row.first {
        Some(first) => format!("{}{first}", row.name),
        None => row.name.clone(),
    }, limited when;
    WordMeaning "words" "word" |row| row.letter.clone(), limited when;
    CodeMeaning "codes" "code" |row| row.code.clone(), limited when;
    Argument "arguments" "argument" |row| row.letter.to_string();
    Setting "settings" "setting" |row| row.name.clone(), of_machine machine;
}
