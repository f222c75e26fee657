//! What a control takes for a fault in a block: under a code in force, beside another word, by a value.

use super::{Control, Origin, Question, Row, Setting};
use crate::canon::{Op, Role};
use serde::{Deserialize, Serialize};

/// What the control takes for a fault.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Forbidden {
    /// The codes one of which is in force; empty where that is no matter.
    #[serde(default)]
    pub under: Vec<Op>,
    /// What may not stand in a block then; where there are `words`, the codes that these may not stand beside.
    #[serde(default)]
    pub ops: Vec<Op>,
    /// Modes in which it may.
    #[serde(default)]
    pub unless: Vec<Op>,
    /// The words that may not: beside one of `ops`, with a value below 0, or at all.
    #[serde(default)]
    pub words: Vec<Role>,
    /// True where the words may not be below 0.
    #[serde(default)]
    pub negative: bool,
    /// The alarm, where it has a number.
    pub alarm: Option<String>,
    /// What to write instead.
    pub help: Option<String>,
    /// The kind of machine that has it, where not all do.
    pub machine: Option<String>,
    /// A question of behaviour whose confirmed answer settles it for a machine. Until then what stands there is for review, and not refused.
    pub asks: Option<String>,
    /// The setting under which it holds.
    pub when: Option<String>,
    /// Where it comes from.
    #[serde(skip_deserializing)]
    pub origin: Origin,
}

/// What in a block is a fault.
#[derive(Clone, Copy, Debug)]
pub struct Clash<'d> {
    /// The row that says so.
    pub row: &'d Forbidden,
    /// The word.
    pub word: Role,
    /// The code that it stands beside; none where its value is the fault.
    pub beside: Option<Op>,
}

impl Control {
    /// What an operation may not stand under: the row, if it is a fault while one of `in_force` is in force and none of
    /// its exceptions.
    pub fn forbids(&self, op: Op, in_force: impl Fn(Op) -> bool) -> Option<&Forbidden> {
        self.dialect().forbidden.iter().find(|row| {
            row.ops.contains(&op)
                && row.under.iter().any(|under| *under != op && in_force(*under))
                && !row.unless.iter().any(|one| in_force(*one))
        })
    }

    /// True where a row is no matter on this machine: somebody answered its question.
    pub fn allows(&self, row: &Forbidden) -> bool {
        let question = row.asks.as_deref().and_then(Question::find);
        let answer = question.and_then(|question| self.behaviour(question));
        answer.is_some_and(|answer| answer.origin().is_confirmed() && answer.value != "unknown")
    }

    /// The first word of a block that is a fault beside a code of it, or by its value: `value` gives that of a word that
    /// stands there, none inside where it is not known.
    pub fn clash(
        &self,
        has: impl Fn(Op) -> bool,
        value: impl Fn(Role) -> Option<Option<f64>>,
    ) -> Option<Clash<'_>> {
        self.dialect().forbidden.iter().find_map(|row| {
            row.words.iter().find_map(|word| {
                let value = value(*word)?;
                let clash = |beside| Clash { row, word: *word, beside };
                if row.negative {
                    return value.filter(|value| *value < 0.0).map(|_| clash(None));
                }
                if row.ops.is_empty() {
                    return Some(clash(None));
                }
                row.ops.iter().find(|op| has(**op)).map(|op| clash(Some(*op)))
            })
        })
    }

    /// What such a clash is, in a sentence.
    pub fn clash_in_words(&self, clash: Clash<'_>) -> String {
        let of_role = |role: &Role| *role == clash.word;
        let words =
            self.dialect().words.iter().filter(|row| of_role(&row.role)).map(|row| row.letter.as_str());
        let codes = self.dialect().codes.iter().flat_map(|row| &row.words);
        let letters = words.chain(codes.filter(|(_, role)| of_role(role)).map(|(letter, _)| letter.as_str()));
        let letter = letters.clone().next().unwrap_or(clash.word.name());
        let alarm = clash.row.alarm.as_ref().map_or(String::new(), |alarm| format!(" {alarm}"));
        match clash.beside {
            Some(op) => {
                let codes = self.dialect().codes.iter().filter(|row| row.op == op && row.preferred);
                let code = codes.map(|row| row.code.as_str()).next().unwrap_or(op.name());
                format!("{letter} beside {code} is an alarm{alarm} on the {}", self.dialect().title)
            }
            None => {
                let negative = if clash.row.negative { "a negative " } else { "" };
                format!("{negative}{letter} is an alarm{alarm} on the {}", self.dialect().title)
            }
        }
    }

    /// The setting that tells something of the machine, and its value where there is one: the name is one of
    /// [`TELLS`](super::TELLS).
    pub fn told(&self, name: &str) -> Option<(&Setting, Option<&str>)> {
        let row = self.dialect().settings.iter().find(|row| row.tells.as_deref() == Some(name))?;
        Some((row, self.setting(&row.name)))
    }

    /// The setting by which roughing leaves out its last pass along the contour; contours with valleys have one of their own. None if it
    /// makes that pass.
    pub fn skips_along(&self, valleys: bool) -> Option<&Setting> {
        let name = if valleys { "roughing.skips.valleys" } else { "roughing.skips.steps" };
        self.told(name).filter(|(_, value)| *value == Some("1")).map(|(row, _)| row)
    }
}
