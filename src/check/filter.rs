//! Which findings count: by code, and by what somebody has looked at.

use super::finding::{Finding, seen_from};
use crate::diag::{ALL, Code};
use crate::lint::RULES;
use globset::{GlobBuilder, GlobMatcher};
use std::path::{Path, PathBuf};

/// What runs only if it is asked for, beside lint rules that say so of themselves: a way that was not decided says less of
/// the program than of the verifier.
const ASKED_FOR: &[Code] = &[Code::RoundUndecided];

/// Which codes are wanted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// Only these; all that are on by default if there are none.
    pub select: Vec<String>,
    /// These too.
    pub extend: Vec<String>,
    /// These not.
    pub ignore: Vec<String>,
}

impl Selection {
    /// What stands for every code.
    pub const ALL: &'static str = "ALL";

    /// The texts that are no code and no beginning of one.
    pub fn unknown(&self) -> Vec<&str> {
        let all = self.select.iter().chain(&self.extend).chain(&self.ignore);
        all.map(String::as_str).filter(|text| !ALL.iter().any(|code| begins(*code, text))).collect()
    }

    /// True if what is found under the code counts.
    pub fn wants(&self, code: Code) -> bool {
        let named = |texts: &[String]| longest(texts, code);
        let on = named(&self.select).max(named(&self.extend));
        let wanted = if self.select.is_empty() { is_on(code) || on.is_some() } else { on.is_some() };
        // The longer text knows better: `--ignore MG09 --extend-select MG0903`.
        wanted && named(&self.ignore).is_none_or(|ignored| on.is_some_and(|on| on > ignored))
    }
}

/// True for a code that counts unless somebody says otherwise.
pub fn is_on(code: Code) -> bool {
    let rule = RULES.iter().find(|rule| rule.code == code);
    rule.is_none_or(|rule| rule.on) && !ASKED_FOR.contains(&code)
}

/// The length of the longest text that names the code.
fn longest(texts: &[String], code: Code) -> Option<usize> {
    texts
        .iter()
        .filter(|text| begins(code, text))
        .map(|text| if *text == Selection::ALL { 0 } else { text.len() })
        .max()
}

fn begins(code: Code, text: &str) -> bool {
    let text = text.trim().to_ascii_uppercase();
    text == Selection::ALL || text.len() > 2 && code.number().starts_with(&text)
}

/// Findings that somebody has looked at, and found to be as they should.
#[derive(Clone, Debug)]
pub struct Allowed {
    /// The code, or the beginning of some.
    pub code: String,
    /// Which files, seen from the project's folder.
    paths: GlobMatcher,
    /// The same, as it is written.
    pub path: String,
    /// Why.
    pub reason: String,
    /// The project's folder.
    root: PathBuf,
}

impl Allowed {
    /// Findings of a code in files of these paths.
    ///
    /// # Errors
    /// What is wrong with the path, or with the code.
    pub fn new(code: &str, path: &str, reason: &str, root: &Path) -> Result<Self, String> {
        if !ALL.iter().any(|known| begins(*known, code)) {
            return Err(format!(
                "'{code}' is no code and no beginning of one: `macroglot explain` lists them"
            ));
        }
        if reason.trim().is_empty() {
            return Err(format!("say why {code} is allowed: `reason = \"...\"`"));
        }
        let glob =
            GlobBuilder::new(path).literal_separator(true).build().map_err(|error| error.to_string())?;
        Ok(Self {
            code: code.to_owned(),
            paths: glob.compile_matcher(),
            path: path.to_owned(),
            reason: reason.to_owned(),
            root: root.to_owned(),
        })
    }

    fn covers(&self, finding: &Finding) -> bool {
        begins(finding.code, &self.code) && self.paths.is_match(seen_from(&finding.file, &self.root))
    }
}

/// A finding that the project file allows, or that somebody accepted.
#[derive(Clone, Debug, PartialEq)]
pub struct Suppressed {
    /// The finding.
    pub finding: Finding,
    /// The reason that is given.
    pub reason: String,
}

/// The findings that nobody allows, and those that somebody does.
pub fn allow(found: Vec<Finding>, allowed: &[Allowed]) -> (Vec<Finding>, Vec<Suppressed>) {
    let (mut open, mut suppressed) = (Vec::new(), Vec::new());
    for finding in found {
        if let Some(reason) = finding.accepted.clone() {
            suppressed.push(Suppressed { finding, reason });
            continue;
        }
        match allowed.iter().find(|allowed| allowed.covers(&finding)) {
            Some(by) => suppressed.push(Suppressed { finding, reason: by.reason.clone() }),
            None => open.push(finding),
        }
    }
    (open, suppressed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn selection(select: &[&str], extend: &[&str], ignore: &[&str]) -> Selection {
        let texts = |all: &[&str]| all.iter().map(|text| (*text).to_owned()).collect();
        Selection { select: texts(select), extend: texts(extend), ignore: texts(ignore) }
    }

    #[test]
    fn codes_are_wanted_by_their_beginnings_and_the_longer_one_knows_better() {
        let plain = selection(&[], &[], &[]);
        assert!(plain.wants(Code::Unreadable) && !plain.wants(Code::RoundUndecided));
        assert!(selection(&[], &["MG0904"], &[]).wants(Code::RoundUndecided));
        let none = selection(&[], &[], &["mg01"]);
        assert!(!none.wants(Code::Unreadable) && none.wants(Code::RoundRefused));
        let one = selection(&["MG0101"], &[], &[]);
        assert!(one.wants(Code::Unreadable) && !one.wants(Code::NestedComment));
        let but = selection(&["ALL"], &[], &["MG09"]);
        assert!(but.wants(Code::Unreadable) && !but.wants(Code::RoundRefused));
        let longer = selection(&[], &["MG0904"], &["MG09"]);
        assert!(longer.wants(Code::RoundUndecided) && !longer.wants(Code::RoundRefused));
        assert_eq!(selection(&["X1"], &["MG"], &["MG0"]).unknown(), ["X1", "MG"]);
    }

    #[test]
    fn a_path_is_seen_from_the_project() {
        let root = std::env::current_dir().unwrap();
        let finding =
            |file: &str| Finding::of_file(Code::SourceGone, Path::new(file), "m".into(), "h".into());
        let allowed = Allowed::new("MG09", "old/**", "from the last machine", &root).unwrap();
        assert!(allowed.covers(&finding("old/a/b.nc")));
        assert!(!allowed.covers(&finding("new/old/b.nc")));
        let star = Allowed::new("MG0909", "*.nc", "kept", &root).unwrap();
        assert!(star.covers(&finding("a.nc")) && !star.covers(&finding("old/a.nc")));
        assert!(Allowed::new("MG7", "*", "r", &root).unwrap_err().contains("MG7"));
        assert!(Allowed::new("MG09", "*", " ", &root).unwrap_err().contains("reason"));
        assert!(Allowed::new("MG09", "[", "r", &root).is_err());
    }
}
