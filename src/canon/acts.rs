//! Names that a shop gives to codes of its machines' builders.
//!
//! The IR and the tables know a name by a number that is made of it, so it is the same in all profiles and in every run. A
//! code's words have names too, and each of them one of the roles [`Role::ACT_WORDS`].

use super::Role;
use std::collections::BTreeMap;
use std::sync::{PoisonError, RwLock};

/// What a code of a machine's builder does, by the name that a shop gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Act(u32);

/// A name, and those of the words beside its codes.
struct Named {
    name: String,
    words: Vec<String>,
}

/// All names of this run, by their numbers.
static NAMED: RwLock<BTreeMap<u32, Named>> = RwLock::new(BTreeMap::new());

/// A number of seven digits, which differs for nearly all names.
fn made_of(name: &str) -> u32 {
    let hash =
        name.bytes().fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193));
    1_000_000 + hash % 9_000_000
}

impl Act {
    /// The name of the code that engages the C axis of a lathe, and of the one that lets it go: profiles write these.
    pub const C_AXIS: [&'static str; 2] = ["c.axis.on", "c.axis.off"];

    /// Names that profiles write for codes which leave the main spindle as it is.
    pub const KEEP_SPINDLE: [&'static str; 16] = [
        "air.off",
        "air.on",
        "c.brake.off",
        "c.brake.on",
        "chip.conveyor.forward",
        "chip.conveyor.stop",
        "chuck.clamp",
        "chuck.second.clamp",
        "chuck.second.unclamp",
        "chuck.unclamp",
        "door.close",
        "door.open",
        "parts.catcher.in",
        "parts.catcher.out",
        "tailstock.back",
        "tailstock.forward",
    ];

    /// The act of a name. Of two names that make one number the later gets the next that is free.
    pub fn named(name: &str) -> Self {
        let mut all = NAMED.write().unwrap_or_else(PoisonError::into_inner);
        let mut number = made_of(name);
        while all.get(&number).is_some_and(|act| act.name != name) {
            number += 1;
        }
        all.entry(number).or_insert_with(|| Named { name: name.into(), words: Vec::new() });
        Self(number)
    }

    /// Its number, as words and tables have it.
    pub fn number(self) -> f64 {
        f64::from(self.0)
    }

    /// The act of a number; none if no profile has named one.
    pub fn of(number: f64) -> Option<Self> {
        let all = NAMED.read().unwrap_or_else(PoisonError::into_inner);
        let act = Self(number as u32);
        (all.contains_key(&act.0) && act.number() == number).then_some(act)
    }

    /// Its name.
    pub fn name(self) -> String {
        let all = NAMED.read().unwrap_or_else(PoisonError::into_inner);
        all.get(&self.0).map(|act| act.name.clone()).unwrap_or_default()
    }

    /// Its name for people: a code that the shop gave no name is called by itself.
    pub fn shown(self) -> String {
        let mut name = self.name();
        name.truncate(name.find(Self::OWN).unwrap_or(name.len()));
        name
    }

    /// What a code that the shop gave no name is known by ends with this and a number of its machine.
    pub const OWN: char = '@';

    /// The name of a word that means nothing to another machine's code, by its letter: no machine has it, and it is left out.
    pub fn dropped(letter: &str) -> String {
        format!("{}{letter}", Self::OWN)
    }

    /// True for the name of a word that is left out.
    pub fn is_dropped(word: &str) -> bool {
        word.starts_with(Self::OWN)
    }

    /// The role of a word of its codes, by the word's name; none if there are more words than roles.
    pub fn word(self, name: &str) -> Option<Role> {
        let mut all = NAMED.write().unwrap_or_else(PoisonError::into_inner);
        let words = &mut all.get_mut(&self.0)?.words;
        let at = words.iter().position(|word| word == name).unwrap_or_else(|| {
            words.push(name.into());
            words.len() - 1
        });
        Role::ACT_WORDS.get(at).copied()
    }

    /// The name of a word by its role.
    pub fn word_name(self, role: Role) -> Option<String> {
        let at = Role::ACT_WORDS.iter().position(|word| *word == role)?;
        let all = NAMED.read().unwrap_or_else(PoisonError::into_inner);
        all.get(&self.0)?.words.get(at).cloned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_one_number_and_its_words_have_roles() {
        let (air, door) = (Act::named("test.air"), Act::named("test.door"));
        assert_ne!(air, door);
        assert_eq!(Act::named("test.air"), air);
        assert_eq!(Act::of(door.number()), Some(door));
        assert_eq!(Act::of(door.number() + 0.5), None);
        assert_eq!(Act::of(-1.0), None);
        assert_eq!(door.name(), "test.door");
        assert_eq!(air.word("level"), Some(Role::Act1));
        assert_eq!(air.word("time"), Some(Role::Act2));
        assert_eq!(air.word("level"), Some(Role::Act1));
        assert_eq!(door.word("time"), Some(Role::Act1));
        assert_eq!(air.word_name(Role::Act2).as_deref(), Some("time"));
        assert_eq!(air.word_name(Role::Act3), None);
    }

    #[test]
    fn more_words_than_roles_have_none() {
        let many = Act::named("test.many");
        let given = (0..20).filter_map(|at| many.word(&format!("word{at}"))).count();
        assert_eq!(given, Role::ACT_WORDS.len());
    }
}
