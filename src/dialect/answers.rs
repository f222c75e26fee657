//! The answers that a question of behaviour may have.

use Answers::OneOf;
use std::fmt;

/// The answer of a table whose source leaves the question to a setting of the machine, or to its builder.
pub(super) const SETTING: &str = "setting";

/// The answers that a question may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answers {
    /// One of these words.
    OneOf(&'static [&'static str]),
    /// Any number.
    Number,
}

impl Answers {
    /// True where the value is one of them.
    pub fn admits(self, value: &str) -> bool {
        match self {
            OneOf(words) => words.contains(&value),
            Self::Number => value.parse::<f64>().is_ok_and(f64::is_finite),
        }
    }
}

impl Answers {
    /// The answers that settle the question, as a machine profile writes them: those of `among` where it has any.
    pub fn written(self, among: &[String]) -> String {
        let OneOf(words) = self else { return "NUMBER".into() };
        let is_among = |word: &str| among.is_empty() || among.iter().any(|one| one == word);
        let settles = words.iter().filter(|word| !["unknown", SETTING].contains(word) && is_among(word));
        let written: Vec<String> = settles
            .map(|word| match *word {
                "true" | "false" => (*word).into(),
                word => format!("\"{word}\""),
            })
            .collect();
        written.join(" or ")
    }
}

impl fmt::Display for Answers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            OneOf(words) => write!(f, "one of {}", words.join(", ")),
            Self::Number => f.write_str("any number"),
        }
    }
}
