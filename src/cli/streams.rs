//! Standard output and standard error.
//!
//! Standard output is data: what cannot be written there is an error, but for a reader that has gone away.
//! Standard error is for people: what nobody reads there is none.

use super::{UNUSABLE, WELL};
use crate::text::{shown, shown_lines};
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
    be_open()?;
    let out = io::stdout();
    let is_terminal = out.is_terminal();
    let mut out = io::BufWriter::with_capacity(64 * 1024, Data { out: out.lock(), is_terminal });
    let printed = write(&mut out).and_then(|()| out.flush());
    if printed.is_err() {
        // What is still in the buffer would be tried again.
        drop(out.into_parts());
    }
    judge(printed)
}

/// Prints text that macroglot drew, with its colours: nothing of a program in it acts on a terminal.
///
/// # Errors
/// As of [`print`].
pub fn print_drawn(text: &str) -> Result<(), u8> {
    be_open()?;
    let mut out = io::stdout().lock();
    judge(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Prints what the command line answers by itself: help, or what is wrong with the arguments.
///
/// Yields the exit code.
pub fn answer(answer: &clap::Error) -> u8 {
    if answer.use_stderr() {
        // If nobody listens there is nobody to say that to.
        let _ = answer.print();
        return UNUSABLE;
    }
    be_open().and_then(|()| judge(answer.print())).err().unwrap_or(WELL)
}

/// A reader that has gone away is no fault.
fn judge(printed: io::Result<()>) -> Result<(), u8> {
    match printed {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(complain(format!("standard output cannot be written: {error}; the output is incomplete")))
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

/// Shows what was drawn, if anything was.
pub fn tell_drawn(drawn: Option<String>) {
    drawn.iter().for_each(|drawn| tell(drawn));
}

/// Says something of the run, in one line: a name with a line end in it forges none.
pub fn remark(message: impl std::fmt::Display) {
    tell(&format!("macroglot: {}\n", shown(&message.to_string())));
}

/// Says what is wrong with the usage or the input, and yields the exit code for it.
pub fn complain(message: impl std::fmt::Display) -> u8 {
    remark(message);
    UNUSABLE
}

/// As [`complain`], of lines that macroglot or a library drew.
pub fn complain_lines(drawn: impl std::fmt::Display) -> u8 {
    tell(&format!("macroglot: {}\n", shown_lines(drawn.to_string().trim_end())));
    UNUSABLE
}

/// Says so where nothing can be printed: standard output was closed before the start.
///
/// # Errors
/// The exit code for it.
pub fn be_open() -> Result<(), u8> {
    if was_closed() {
        return Err(complain("standard output is closed: the rest of the output is lost"));
    }
    Ok(())
}

/// Whether standard output was closed when the process began.
///
/// `main` comes too late for that: the runtime puts the null device in the place of a closed stream, open both ways, and
/// so do callers that want no output.
#[cfg(target_os = "linux")]
#[ctor::ctor]
static CLOSED_AT_START: bool = rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err();

#[cfg(target_os = "linux")]
fn was_closed() -> bool {
    *CLOSED_AT_START
}

/// Other systems do not tell.
#[cfg(not(target_os = "linux"))]
fn was_closed() -> bool {
    false
}
