//! Long text on a terminal: through the pager that the user has, as git does it.

use super::streams::print_drawn;
use std::io::{IsTerminal, Write, stdout};
use std::process::{Command, Stdio};

/// True where standard output is a terminal.
pub fn on_terminal() -> bool {
    stdout().is_terminal()
}

/// Prints drawn text, through a pager where standard output is a terminal and one is `wanted`.
///
/// `PAGER` names it, else it is `less`; with `cat` or nothing there is none.
///
/// # Errors
/// The exit code where it cannot be printed.
pub fn print(text: &str, wanted: bool) -> Result<(), u8> {
    let named = std::env::var("PAGER").unwrap_or_else(|_| "less".into());
    let is_one = !matches!(named.trim(), "" | "cat");
    if wanted && is_one && on_terminal() && through(&named, text) {
        return Ok(());
    }
    print_drawn(text)
}

/// False where there is no such pager.
fn through(pager: &str, text: &str) -> bool {
    let mut command = Command::new("sh");
    command.args(["-c", pager]).stdin(Stdio::piped());
    // One screen is left as it stands, colours are drawn, nothing is wiped at the end.
    if std::env::var_os("LESS").is_none() {
        command.env("LESS", "FRX");
    }
    let Ok(mut child) = command.spawn() else { return false };
    if let Some(mut input) = child.stdin.take() {
        // Who leaves the pager early has read enough.
        let _ = input.write_all(text.as_bytes());
    }
    // The shell says 127 where it finds no such command, and has printed nothing then.
    child.wait().is_ok_and(|status| status.code() != Some(127))
}
