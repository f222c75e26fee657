//! Words in blocks without a code: most of a long program.
//!
//! What such a word is hangs on its letter and the motion code in force, so that it is found out once for each code.

use super::nc::Seen;
use crate::canon::Role;
use crate::ir::{Expr, Nc, NcItem};
use crate::lower::macro_b::build::{Lowering, RolesUnder};
use crate::lower::macro_b::parts::{Words, literal};
use crate::syntax::Word;

impl Lowering<'_> {
    /// Keeps the role of a word that stood in a block without a code; the next need not be asked for.
    pub fn note_role(&mut self, word: &Word, role: Role) {
        use Role::*;
        let depends =
            matches!(role, DwellMs | DwellS | CycleDwell | ArcI | ArcJ | ArcK | ArcRadius | Builder);
        let acts = self.codes.letter(word.letter, false).is_some_and(|row| row.op.is_some());
        if word.comma || depends || role.is_integer() || acts {
            return;
        }
        if self.known.under != self.motion {
            self.known = RolesUnder { under: self.motion, ..RolesUnder::default() };
        }
        if let Some(slot) = self.known.roles.get_mut((word.letter as usize).wrapping_sub('A' as usize)) {
            *slot = Some(role);
        }
    }

    /// A block of words that all were noted, each with a decimal point and none twice; none for any other.
    pub fn bare_words(&self, words: &Words<'_>) -> Option<Nc> {
        if self.counts_radii()
            || self.known.under != self.motion
            || words.iter().any(|(word, _)| self.known.role(word).is_none())
        {
            return None;
        }
        let mut items = Vec::with_capacity(words.len());
        let mut seen = Seen::default();
        for (word, _) in words {
            let role = self.known.role(word).filter(|role| !seen.role(*role))?;
            let (number, _) = literal(word.value.as_ref()?).filter(|(_, point)| *point)?;
            items.push(NcItem::Word(role, Expr::Number(number)));
        }
        Some(Nc { items })
    }
}
