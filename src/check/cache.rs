//! What earlier checks found, by the hash of all that it rests on. Safe to delete at any time.

use crate::verify::sha256;
use etcetera::BaseStrategy;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// What nobody asked for in this time goes.
const KEPT: Duration = Duration::from_secs(30 * 24 * 3600);

/// How often what is old is looked for.
const LOOKED: Duration = Duration::from_secs(24 * 3600);

/// The longest answer that is read back, bytes: a cache is no trusted input.
const LONGEST: u64 = 16 << 20;

/// Answers to questions that were asked before.
#[derive(Debug, Default)]
pub struct Cache {
    /// None: nothing is kept.
    folder: Option<PathBuf>,
    /// What macroglot this is: another one may answer otherwise.
    version: String,
}

impl Cache {
    /// A cache in this folder; one that keeps nothing if there is none.
    pub fn new(folder: Option<PathBuf>) -> Self {
        let cache = Self { folder, version: version() };
        cache.prune();
        cache
    }

    /// The folder of this user's caches; none on a system that has none.
    pub fn of_user() -> Option<PathBuf> {
        let folder = etcetera::choose_base_strategy().ok()?.cache_dir();
        Some(folder.join("macroglot").join("check"))
    }

    /// The key of a question.
    pub fn key(&self, parts: &[&[u8]]) -> String {
        let mut all = self.version.clone().into_bytes();
        for part in parts {
            // Each with its length: two parts are not two others with the same bytes.
            all.extend((part.len() as u64).to_le_bytes());
            all.extend(*part);
        }
        sha256(&all)
    }

    /// What was answered; none if nothing was, or it cannot be read.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Option<T> {
        let path = self.place(key)?;
        let facts = fs::metadata(&path).ok().filter(|facts| facts.is_file() && facts.len() <= LONGEST)?;
        let answer = serde_json::from_slice(&fs::read(&path).ok()?).ok()?;
        if facts.modified().is_ok_and(|then| older(then, LOOKED)) {
            // It was asked for: it stays.
            let _ = fs::File::options().append(true).open(&path).map(|f| f.set_modified(SystemTime::now()));
        }
        Some(answer)
    }

    /// Keeps an answer. One that cannot be written is found again next time.
    pub fn put(&self, key: &str, answer: &impl Serialize) {
        let Some(path) = self.place(key) else { return };
        let Some(folder) = path.parent() else { return };
        let _ = self.begin(folder).and_then(|()| {
            // Two runs may write one answer: each under a name of its own, until it is whole.
            let own = folder.join(format!("{key}.{}.new", std::process::id()));
            let bytes = serde_json::to_vec(answer).map_err(std::io::Error::other)?;
            let written = fs::File::create(&own).and_then(|mut file| file.write_all(&bytes));
            let moved = written.and_then(|()| fs::rename(&own, &path));
            moved.inspect_err(|_| drop(fs::remove_file(&own)))
        });
    }

    fn place(&self, key: &str) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join(key.get(..2)?).join(key))
    }

    /// Makes the folder, and marks the whole as a cache, which backups leave out.
    fn begin(&self, folder: &Path) -> std::io::Result<()> {
        fs::create_dir_all(folder)?;
        let Some(whole) = &self.folder else { return Ok(()) };
        let tag = whole.join("CACHEDIR.TAG");
        if !tag.exists() {
            fs::write(tag, "Signature: 8a477f597d28d172789f06886806bc55\n# What `macroglot check` found.\n")?;
        }
        Ok(())
    }

    /// Once a day: removes what nobody asked for in a month.
    fn prune(&self) {
        let Some(folder) = &self.folder else { return };
        let tag = folder.join("pruned");
        let last = fs::metadata(&tag).and_then(|facts| facts.modified());
        if last.is_ok_and(|last| !older(last, LOOKED)) || !folder.is_dir() {
            return;
        }
        let _ = fs::write(&tag, "");
        let folders = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        // Only what has the names of answers: the folder may be somebody's own.
        let of_answers = |path: &PathBuf| path.file_name().is_some_and(|name| name.len() == 2);
        for answer in
            folders.filter(of_answers).filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten()
        {
            let named = answer.file_name().len() >= 64;
            let then = answer.metadata().and_then(|facts| facts.modified());
            if named && then.is_ok_and(|then| older(then, KEPT)) {
                let _ = fs::remove_file(answer.path());
            }
        }
    }
}

fn older(then: SystemTime, than: Duration) -> bool {
    then.elapsed().is_ok_and(|age| age > than)
}

/// The version, and what tells two builds of one version apart.
fn version() -> String {
    let built = std::env::current_exe().and_then(fs::metadata).ok();
    let built = built.map(|facts| (facts.len(), facts.modified().ok()));
    format!("{} {built:?}", env!("CARGO_PKG_VERSION"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_kept_by_all_that_it_rests_on() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::new(Some(folder.path().join("c")));
        let key = cache.key(&[b"ab", b"c"]);
        assert_ne!(key, cache.key(&[b"a", b"bc"]));
        assert_eq!(cache.get::<Vec<u32>>(&key), None);
        cache.put(&key, &vec![1, 2]);
        assert_eq!(cache.get::<Vec<u32>>(&key), Some(vec![1, 2]));
        let again = Cache::new(Some(folder.path().join("c")));
        assert_eq!(again.get::<Vec<u32>>(&key), Some(vec![1, 2]));
        // What is no answer is none.
        fs::write(cache.place(&key).unwrap(), "{").unwrap();
        assert_eq!(cache.get::<Vec<u32>>(&key), None);
        assert!(folder.path().join("c/CACHEDIR.TAG").is_file());
    }

    #[test]
    fn what_is_old_goes_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path();
        let cache = Cache::new(Some(at.to_owned()));
        let [old, new] = [cache.key(&[b"old"]), cache.key(&[b"new"])];
        cache.put(&old, &1);
        cache.put(&new, &2);
        let long_ago = SystemTime::now() - 2 * KEPT;
        let age = |path: &Path| {
            fs::File::options().append(true).open(path).unwrap().set_modified(long_ago).unwrap()
        };
        age(&cache.place(&old).unwrap());
        fs::write(at.join("notes.txt"), "mine").unwrap();
        age(&at.join("notes.txt"));
        Cache::new(Some(at.to_owned())).prune();
        drop(fs::remove_file(at.join("pruned")));
        Cache::new(Some(at.to_owned()));
        assert_eq!(cache.get::<u32>(&old), None);
        assert_eq!(cache.get::<u32>(&new), Some(2));
        assert!(at.join("notes.txt").is_file());
    }

    #[test]
    fn without_a_folder_nothing_is_kept() {
        let cache = Cache::default();
        let key = cache.key(&[b"a"]);
        cache.put(&key, &1);
        assert_eq!(cache.get::<u32>(&key), None);
    }
}
