//! What benches share: a case is run in a process of its own, which is the bench again with the case's name in its
//! environment, and tells what it used.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;
use std::{fs, io};

/// Says which case a process is to run.
const CASE: &str = "MACROGLOT_CASE";

/// What a process used.
#[derive(Clone, Copy, Debug, Default)]
#[allow(dead_code, reason = "each bench prints some of it")]
pub struct Use {
    /// Processor seconds.
    pub cpu: f64,
    /// Seconds of the clock.
    pub wall: f64,
    /// Bytes at the peak.
    pub peak: f64,
    /// Blocks that were run, where it ran any.
    pub steps: f64,
}

/// The case that this process is to run; none for the bench itself.
pub fn case() -> Option<String> {
    std::env::var(CASE).ok()
}

/// Runs a case in a process of its own, on so many threads; 0 for as many as there are cores.
///
/// # Errors
///
/// If the process cannot be started, or does not tell what it used.
pub fn run(case: &str, arguments: &[impl AsRef<OsStr>], threads: usize) -> io::Result<Use> {
    let mut command = Command::new(std::env::current_exe()?);
    command.env(CASE, case).env("RAYON_NUM_THREADS", threads.to_string()).args(arguments);
    let output = command.stdout(Stdio::null()).output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    let figures: Vec<f64> =
        said.lines().last().unwrap_or_default().split(' ').filter_map(|f| f.parse().ok()).collect();
    match figures.as_slice() {
        &[cpu, wall, peak, steps] => Ok(Use { cpu, wall, peak, steps }),
        _ => Err(io::Error::other(format!("{case}: {said}"))),
    }
}

/// Does the work of a case, and then tells on standard error what it used. The work yields how often it was repeated, and
/// how many blocks it ran.
pub fn tell(work: impl FnOnce() -> (usize, u64)) -> ExitCode {
    let start = Instant::now();
    let (repeated, steps) = work();
    let (cpu, peak) = used().unwrap_or((f64::NAN, f64::NAN));
    let once = |seconds: f64| seconds / repeated as f64;
    eprintln!("{} {} {peak} {steps}", once(cpu), once(start.elapsed().as_secs_f64()));
    ExitCode::SUCCESS
}

/// Processor seconds and peak bytes of this process, as Linux tells them.
fn used() -> Option<(f64, f64)> {
    // Nanoseconds on a core, each thread's own: the counts of the process are in hundredths of a second.
    let mut nanoseconds = 0.0;
    for task in std::fs::read_dir("/proc/self/task").ok()?.flatten() {
        let stat = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        nanoseconds += stat.split(' ').next()?.parse::<f64>().ok()?;
    }
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some((nanoseconds / 1e9, peak.trim().trim_end_matches(" kB").trim().parse::<f64>().ok()? * 1024.0))
}

/// A folder with a file for each program of a text.
///
/// # Errors
///
/// If it cannot be written.
#[allow(dead_code, reason = "as above")]
pub fn files(text: &str, folder: &Path) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    let programs = text.trim_matches(['%', '\n']).split("\nO").enumerate();
    for (at, program) in programs {
        let program = program.strip_prefix('O').unwrap_or(program);
        fs::write(folder.join(format!("o{:04}.nc", at + 1)), format!("%\nO{program}\n%\n"))?;
    }
    Ok(folder.into())
}
