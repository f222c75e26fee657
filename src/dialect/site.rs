//! What a machine profile says of the codes of its machine's builder.

use super::{CodeHead, CodeMeaning, Origin, Profile};
use crate::canon::{Act, Op, Role};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};

/// A code that the machine's builder or the shop defined.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SiteCode {
    /// The code: `M20`.
    pub code: String,
    /// What it does, by a name of the shop's choosing: codes of two machines with one name do the same.
    #[serde(default)]
    pub name: Option<String>,
    /// What it does in common terms; absent for what only builders' codes do.
    #[serde(default)]
    pub op: Option<Op>,
    /// What it does besides, at the same time: spindle and coolant alone.
    #[serde(default)]
    pub with: Vec<Op>,
    /// What it does, in words; empty where nobody said it.
    #[serde(default)]
    pub text: String,
    /// Operands that the code itself fixes.
    #[serde(default)]
    pub fixed: BTreeMap<Role, f64>,
    /// The words that it takes: letters, and what each is. Beside `op` that is a role, beside `target` a letter of the
    /// target's code, else a name of the shop's choosing.
    #[serde(default)]
    pub words: BTreeMap<String, String>,
    /// The code of any other machine that does the same: `M88`.
    #[serde(default)]
    pub target: Option<String>,
    /// What becomes of it on a machine that has no code of its name.
    #[serde(default, rename = "do")]
    pub without: Option<Without>,
    /// The program that it calls. Beside `target` that program is the builder's: it is not converted, and the code of the other
    /// machine does what it does.
    #[serde(default)]
    pub calls: Option<u32>,
    /// True where the other words of its block are arguments of that program, as with `G65`.
    #[serde(default)]
    pub arguments: bool,
    /// Variables that it reads, with the names that the shop gives them: `"#500" = "air.pressure"`.
    #[serde(default)]
    pub reads: BTreeMap<String, String>,
    /// Variables that it sets, with the names that the shop gives them.
    #[serde(default)]
    pub sets: BTreeMap<String, String>,
    /// What it leaves as it was, though nobody would know it by its name.
    #[serde(default)]
    pub keeps: Option<Keeps>,
    /// False for a second code of one name, which is read and never written.
    #[serde(default = "super::model::yes")]
    pub preferred: bool,
}

/// What becomes of a builder's code on a machine that has none of its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Without {
    /// It is left out.
    Omit,
    /// The machine stops and says what the operator must do.
    Stop,
    /// The same code does it there.
    Same,
    /// The machine stops with an alarm: the run must not come there.
    Alarm,
}

/// What a builder's code leaves as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Keeps {
    /// The spindle: it turns, or stands, as before.
    Spindle,
}

impl SiteCode {
    /// What it does, in words, if the profile says it.
    fn said(&self) -> Option<&str> {
        Some(self.text.trim()).filter(|text| !text.is_empty())
    }

    /// The program of the builder that it calls, where the code of another machine does what that does.
    pub fn builders_program(&self) -> Option<u32> {
        self.calls.filter(|_| self.target.is_some())
    }

    /// The code for people: `M14 (chuck air on)`.
    pub fn shown(&self) -> String {
        match self.said() {
            Some(text) => format!("{} ({text})", self.code),
            None => self.code.clone(),
        }
    }

    /// Its letter and number.
    pub(super) fn head(&self) -> Option<CodeHead> {
        self.row(None).head()
    }

    /// Its name, or one of its own where the profile says what becomes of it and gives it none: `owner` is the number of the
    /// profile.
    pub(super) fn act(&self, owner: impl FnOnce() -> u64) -> Option<Act> {
        match &self.name {
            Some(name) => Some(Act::named(name)),
            None if self.target.is_some() || self.without.is_some() => {
                Some(Act::named(&format!("{}{}{:016x}", self.code, Act::OWN, owner())))
            }
            None => None,
        }
    }

    /// The code as a row of a dialect's table, with the number of its name.
    pub(super) fn row(&self, act: Option<Act>) -> CodeMeaning {
        let (mut fixed, mut words) = (self.fixed.clone(), BTreeMap::new());
        for (letter, meaning) in &self.words {
            let role = match (self.op, act) {
                (Some(_), _) => Role::find(meaning),
                (None, Some(act)) if meaning.trim().is_empty() => act.word(&Act::dropped(letter)),
                // Beside the code of a target a letter is known by itself.
                (None, Some(act)) if self.target.is_some() => act.word(letter),
                (None, Some(act)) => act.word(meaning),
                (None, None) => Some(Role::Builder),
            };
            words.extend(role.map(|role| (letter.clone(), role)));
        }
        let op = match (self.op, act) {
            (Some(op), _) => op,
            (None, Some(act)) => {
                fixed.insert(Role::Act, act.number());
                Op::Act
            }
            (None, None) => Op::Builder,
        };
        let origin = Origin::of_profile(self.said().map(str::to_owned));
        CodeMeaning {
            code: self.code.clone(),
            also: Vec::new(),
            with: self.with.clone(),
            op,
            fixed,
            words,
            required: Vec::new(),
            shift: BTreeMap::new(),
            through: None,
            counts: Vec::new(),
            counted: None,
            modal: None,
            machine: None,
            when: None,
            preferred: self.preferred && self.with.is_empty(),
            option: None,
            origin,
        }
    }
}

/// A number that two machines do not share: codes without a name of the shop's are not the same on two machines.
pub(super) fn fingerprint(profile: &Profile) -> u64 {
    let mut hasher = DefaultHasher::new();
    let plain = Profile { file: None, places: BTreeMap::new(), ..profile.clone() };
    format!("{plain:?}").hash(&mut hasher);
    hasher.finish()
}
