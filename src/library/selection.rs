//! Which files of its folder are of a library of the project file.
//!
//! Law: a file is of the library if one of `only` names it, or there is no `only`, and none of `except` does. Paths count from
//! the library's folder; `*` is any letters but `/`, `**` any.
//! A name without such signs that no file has is a fault: it would leave out, or take in, what nobody meant.

use super::project::Library;
use globset::{GlobBuilder, GlobMatcher};
use std::collections::BTreeSet;

/// Signs that make a name a pattern.
const SIGNS: &[char] = &['*', '?', '[', ']', '{', '}'];

/// What a library says of the files of its folder.
#[derive(Clone, Debug, Default)]
pub(super) struct Selection {
    only: Option<Vec<GlobMatcher>>,
    except: Vec<GlobMatcher>,
}

impl Selection {
    /// What the library says.
    ///
    /// # Errors
    /// The key with a pattern that is wrong, and what is wrong with it.
    pub(super) fn of(library: &Library) -> Result<Self, (&'static str, String)> {
        if library.only.as_ref().is_some_and(Vec::is_empty) {
            return Err((
                "only",
                "'only' names no file: leave it out to take all files of the folder".into(),
            ));
        }
        let only = library.only.as_ref().map(|only| matchers("only", only)).transpose()?;
        Ok(Self { only, except: matchers("except", &library.except)? })
    }

    /// True if the file with this place in the library's folder is of the library.
    pub(super) fn takes(&self, name: &str) -> bool {
        let named = |all: &[GlobMatcher]| all.iter().any(|one| one.is_match(name));
        self.only.as_deref().is_none_or(named) && !named(&self.except)
    }
}

/// The name of a file that the library has in `only` or `except`, and that is none of these.
pub(super) fn unknown<'l>(library: &'l Library, names: &BTreeSet<&str>) -> Option<(&'static str, &'l str)> {
    let only = library.only.iter().flatten().map(|name| ("only", name.as_str()));
    let except = library.except.iter().map(|name| ("except", name.as_str()));
    only.chain(except).find(|(_, name)| !name.contains(SIGNS) && !names.contains(name))
}

fn matchers(key: &'static str, patterns: &[String]) -> Result<Vec<GlobMatcher>, (&'static str, String)> {
    let matcher = |pattern: &String| {
        let glob = GlobBuilder::new(pattern).literal_separator(true).build();
        glob.map(|glob| glob.compile_matcher())
            .map_err(|error| (key, format!("'{key}': '{pattern}' is no pattern: {error}")))
    };
    patterns.iter().map(matcher).collect()
}
