//! Files that are not read, and why.

use serde::Serialize;
use std::io;
use std::path::PathBuf;

/// A file or folder that was not read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// Where it is.
    pub path: PathBuf,
    /// Why.
    pub why: WhyNot,
}

/// Why a file was not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WhyNot {
    /// Its name begins with a dot.
    Hidden,
    /// An ignore file names it.
    Ignored,
    /// It is a link: what it leads to has a place of its own, or is none of the folder's.
    Link,
    /// Its ending is none that programs have.
    Unknown,
    /// The same, though it looks like a program.
    Program,
    /// It reads like prose.
    Prose,
    /// It has no bytes.
    Empty,
    /// It is no text.
    Binary,
    /// An output folder: a run of macroglot wrote what it holds.
    Written,
    /// It is shared, and its folder has a program of that number.
    Own,
    /// The project file says that it is not of the library.
    Excluded,
    /// Its only program is the builder's, and the code of the target does what that does.
    Builders,
}

impl WhyNot {
    /// The reason in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Hidden => "hidden",
            Self::Ignored => "ignored",
            Self::Link => "a link",
            Self::Unknown => "with an unknown ending",
            Self::Program => "with an unknown ending, though it looks like a program",
            Self::Prose => "that reads like a text for people",
            Self::Empty => "empty",
            Self::Binary => "binary",
            Self::Written => "written by macroglot",
            Self::Own => "shared, where the folder has its own",
            Self::Excluded => "not of this library by macroglot.toml",
            Self::Builders => "with a program of the builder by the source's profile",
        }
    }
}

/// Why the programs could not be read.
#[derive(Debug, thiserror::Error)]
pub enum InputError {
    /// A path that does not exist.
    #[error("{0}: there is no such file or folder")]
    Missing(PathBuf),
    /// A path that cannot be read.
    #[error("{0}: cannot be read: {1}")]
    Unreadable(PathBuf, io::Error),
    /// A folder in which nothing looks like a program.
    #[error(
        "{0}: the folder has no program files (looked for {1}); to read a file with another ending, name \
         the file itself"
    )]
    NoPrograms(PathBuf, String),
    /// A file of no bytes.
    #[error("{0}: the file is empty")]
    Empty(PathBuf),
    /// A file that is no text.
    #[error("{0}: is a binary file, not a program (byte {1} is {2:#04x})")]
    Binary(PathBuf, usize, u8),
    /// A file that is too long, or a line in it.
    #[error("{0}: is longer than 4 GB")]
    TooLong(PathBuf),
    /// A file that the project file names under a key, and that the folder does not have.
    #[error("{0}: macroglot.toml names '{2}' under '{1}', and the folder has no such program")]
    NotThere(PathBuf, &'static str, String),
    /// A folder of which the project file takes no program.
    #[error("{0}: no program of the folder is of the library by 'only' and 'except' in macroglot.toml")]
    NoneTaken(PathBuf),
    /// Two files whose conversions would be one.
    #[error(
        "{0} and {1} are both '{2}' under the folders named: their conversions would overwrite each other"
    )]
    Twice(PathBuf, PathBuf, String),
}

impl InputError {
    /// The file that is left out for it, if it is one that harms nothing in a folder of programs.
    pub fn left_out(&self) -> Option<LeftOut> {
        let (path, why) = match self {
            Self::Empty(path) => (path, WhyNot::Empty),
            Self::Binary(path, ..) => (path, WhyNot::Binary),
            _ => return None,
        };
        Some(LeftOut { path: path.clone(), why })
    }
}
