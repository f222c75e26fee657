//! Standard output and standard error.
//!
//! Standard output is data: what cannot be written there is an error, but for a reader that has gone away.
//! Standard error is for people: what nobody reads there is none.

use super::UNUSABLE;
use crate::text::shown_lines;
use std::io::{self, IsTerminal, Write};

/// Prints data.
///
/// # Errors
/// The exit code where it cannot be written; why is said. A reader that has gone away (`| head`) is no fault.
pub fn print(text: &str) -> Result<(), u8> {
    print_by(|out| out.write_all(text.as_bytes()))
}

/// Prints what `write` writes, piece by piece.
///
/// # Errors
/// As of [`print`].
pub fn print_by(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), u8> {
    let out = io::stdout();
    let is_terminal = out.is_terminal();
    let mut out = io::BufWriter::with_capacity(64 * 1024, Data { out: out.lock(), is_terminal });
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            // What is still in the buffer would be tried again.
            drop(out.into_parts());
            Err(complain(format!("standard output cannot be written: {error}; what it has got is not whole")))
        }
        _ => Ok(()),
    }
}

/// Standard output. A terminal is shown control characters; it never gets them.
struct Data<'o> {
    out: io::StdoutLock<'o>,
    is_terminal: bool,
}

impl Write for Data<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.is_terminal {
            self.out.write_all(shown_lines(&String::from_utf8_lossy(bytes)).as_bytes())?;
            return Ok(bytes.len());
        }
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Says something to a person, on standard error.
pub fn tell(text: &str) {
    // If nobody listens there is nobody to say that to.
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// Says what is wrong with the usage or the input, and yields the exit code for it.
pub fn complain(message: impl std::fmt::Display) -> u8 {
    tell(&format!("macroglot: {}\n", shown_lines(&message.to_string())));
    UNUSABLE
}

/// True if a program that is printed goes nowhere: standard output was closed before the start.
///
/// The runtime puts the null device in the place of a closed stream, open both ways; a shell's `> /dev/null` is open for
/// writing alone.
#[cfg(target_os = "linux")]
pub fn is_closed() -> bool {
    use rustix::fs::{FileType, OFlags, fcntl_getfl, fstat, major, minor};
    let out = io::stdout();
    let is_null = fstat(&out).is_ok_and(|facts| {
        let is_device = FileType::from_raw_mode(facts.st_mode) == FileType::CharacterDevice;
        is_device && (major(facts.st_rdev), minor(facts.st_rdev)) == (1, 3)
    });
    is_null && fcntl_getfl(&out).is_ok_and(|flags| flags & OFlags::RWMODE == OFlags::RDWR)
}

/// Other systems do not tell.
#[cfg(not(target_os = "linux"))]
pub fn is_closed() -> bool {
    false
}
