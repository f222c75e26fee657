//! Where a row comes from, and how sure it is.

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The source of what a machine profile says.
pub(super) const PROFILE: &str = "machine profile";

/// How sure a row is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Mark {
    /// No source that counts says so: what rests on it is for review.
    #[default]
    Unconfirmed,
    /// No text of the maker was reached, and independent sources of the trade agree: what rests on it has a note.
    Common,
    /// A text of the maker, or one that reproduces it, says so.
    Confirmed,
}

impl Mark {
    /// What stands after a cell of the printed tables.
    pub(super) const fn sign(self) -> &'static str {
        match self {
            Self::Unconfirmed => " ?",
            Self::Common => " ~",
            Self::Confirmed => "",
        }
    }
}

/// Where a row comes from. In the file its keys stand among the row's own.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Origin {
    /// Seed and line, or manual and page; of a common row its sources.
    pub source: String,
    /// How sure it is.
    pub mark: Mark,
    /// What is not certain, or what to beware of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The fact that the row rests on, as `behaviour:axes.numbered`: it is no surer than that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rests: Option<String>,
    /// The base that the row stands in; none for a row of the control's own table.
    #[serde(skip)]
    pub table: Option<String>,
}

impl Origin {
    /// What a machine profile says.
    pub(super) fn of_profile(note: Option<String>) -> Self {
        Self { source: PROFILE.into(), mark: Mark::Confirmed, note, ..Self::default() }
    }

    /// True where a maker's text, or the owner of the machine, says so.
    pub fn is_confirmed(&self) -> bool {
        self.mark == Mark::Confirmed
    }

    /// True where nobody needs to check it: it is confirmed, or common.
    pub fn is_settled(&self) -> bool {
        self.mark != Mark::Unconfirmed
    }
}

/// The keys of an origin as they stand in the file.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    pub source: Option<String>,
    pub confirmed: Option<bool>,
    pub common: Option<Vec<String>>,
    pub cites: Option<String>,
    pub note: Option<String>,
    pub rests: Option<String>,
}

/// Their names.
pub(super) const KEYS: &[&str] = &["source", "confirmed", "common", "cites", "note", "rests"];

impl Written {
    /// What they say; else what is wrong with them, and what to do.
    pub fn judged(self) -> Result<Origin, (String, &'static str)> {
        let Self { source, confirmed, common, cites, note, rests } = self;
        let Some(names) = common else {
            let source =
                source.ok_or(("the row has no source".into(), "name the manual and the page in 'source'"))?;
            if cites.is_some() {
                let help = "a row of the maker's own text names it in 'source'";
                return Err(("'cites' stands without 'common'".into(), help));
            }
            let mark = if confirmed.unwrap_or(true) { Mark::Confirmed } else { Mark::Unconfirmed };
            return Ok(Origin { source, mark, note, rests, table: None });
        };
        if confirmed.is_some() {
            let help = "keep the one that is so";
            return Err(("a row has one mark: 'confirmed' or 'common'".into(), help));
        }
        independent(&names, cites.as_deref())?;
        let mut all: Vec<String> = source.into_iter().chain(names).collect();
        all.extend(cites.map(|manual| format!("after {manual}")));
        Ok(Origin { source: all.join("; "), mark: Mark::Common, note, rests, table: None })
    }
}

/// Two sources that are not one: two pages of one source, or of one author, are a single one. A source that cites or
/// reproduces a named manual stands alone.
fn independent(names: &[String], cites: Option<&str>) -> Result<(), (String, &'static str)> {
    let who = |name: &String| name.split([',', ':']).next().unwrap_or_default().trim().to_lowercase();
    let distinct: BTreeSet<String> = names.iter().map(who).collect();
    if distinct.contains("") || cites.is_some_and(|manual| manual.trim().is_empty()) {
        return Err(("a source has no name".into(), "name who says so, then the place after a comma"));
    }
    if distinct.len() < names.len() {
        return Err(("one source is named twice".into(), "name each source once, with all its places"));
    }
    if names.is_empty() || names.len() < 2 && cites.is_none() {
        let help = "name a second source that is independent of it, or in 'cites' the maker's manual that it reproduces; \
                    else write 'confirmed = false'";
        return Err(("a common row needs two sources".into(), help));
    }
    Ok(())
}
