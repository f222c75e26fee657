//! `macroglot diff OLD NEW`.

use super::common::{Time, controls, doubt, effort, endings, not_over, own_profile, source_of};
use super::streams::{complain, print};
use super::verify::{folder_of, names};
use super::{FOUND, WELL, common, drawing, pager};
use crate::diff::{Diff, Levels, Request, Shelf, Verdict, diff, normalised};
use crate::library::{Home, Input, InputError, Lock, Manifest, WhyNot, gather};
use crate::report::{self, PairOfRuns};
use crate::verify::SymbolMap;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub struct Arguments {
    /// The old and the new file or folder; or what git gives a diff driver: PATH OLD HEX MODE NEW HEX MODE
    #[arg(required = true, value_name = "OLD NEW", num_args = 1..=9)]
    paths: Vec<PathBuf>,
    /// The control the old programs are written for; recognized if it is left out
    #[arg(long, value_name = "D")]
    from: Option<String>,
    /// The control the new programs are written for; that of the old ones if it is left out
    #[arg(long, value_name = "D")]
    to: Option<String>,
    /// A machine profile (it names its dialect); may be given twice
    #[arg(long, value_name = "FILE")]
    machine: Vec<PathBuf>,
    /// The folder with the programs that a single file calls, and that call it
    #[arg(long, value_name = "DIR")]
    library: Option<PathBuf>,
    /// Show the lines that changed; with none of these four flags, all is shown
    #[arg(long)]
    text: bool,
    /// Show the lines that changed, with spacing, numbering, spelling of numbers and comments left aside
    #[arg(long)]
    normalised: bool,
    /// Show what changed in jumps, calls, labels and variables
    #[arg(long)]
    structure: bool,
    /// Show where the machine does something else
    #[arg(long)]
    motion: bool,
    /// Draw the paths of the first program that differs, both in one picture: SVG, or PNG if the name ends in .png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Draw it in machine coordinates, not from the work zero
    #[arg(long, requires = "plot")]
    machine_coordinates: bool,
    /// Replace a read-only drawing too
    #[arg(long, requires = "plot")]
    force: bool,
    /// Places that lie no farther apart count as the same
    #[arg(long, value_name = "MM", default_value_t = 0.0)]
    tolerance: f64,
    /// Places that are listed of a program, at the most
    #[arg(long, value_name = "N", default_value_t = 100)]
    most: usize,
    /// How to print what changed
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Colours: on a terminal, always, or never
    #[arg(long, value_enum, value_name = "WHEN", default_value_t = When::Auto)]
    color: When,
    /// Do not put a long text on a terminal through a pager
    #[arg(long)]
    no_pager: bool,
    /// As a diff driver of git, end with exit code 1 too: git needs diff.trustExitCode for it
    #[arg(long)]
    exit_code: bool,
    /// Print one program without what no machine sees, a block a line: for git's textconv
    #[arg(long, conflicts_with_all = ["text", "normalised", "structure", "motion", "library", "plot"])]
    normalise: bool,
    #[command(flatten)]
    time: Time,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum Format {
    Text,
    Html,
    Markdown,
    Json,
    Sarif,
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum When {
    Auto,
    Always,
    Never,
}

pub fn run(arguments: &Arguments) -> u8 {
    match work(arguments) {
        Ok(code) | Err(code) => code,
    }
}

fn work(arguments: &Arguments) -> Result<u8, u8> {
    if arguments.normalise {
        return normalise(arguments);
    }
    if !(arguments.tolerance >= 0.0 && arguments.tolerance.is_finite()) {
        return Err(complain("--tolerance takes millimetres, 0 or more"));
    }
    match arguments.paths.as_slice() {
        [old, new] => {
            let (old_inputs, new_inputs) = (side(old)?, side(new)?);
            compare(arguments, (old, old_inputs), (new, new_inputs))
        }
        [path, old, _, _, new, _, _] | [_, old, _, _, new, _, _, path, _] => {
            driver(arguments, path, old, new)
        }
        // So git tells a driver of a path that a merge has left open.
        [path] if std::env::var_os("GIT_DIFF_PATH_COUNTER").is_some() => {
            print(&format!("{}: the merge is not done\n", path.display()))?;
            Ok(WELL)
        }
        _ => Err(complain("name two files or two folders: macroglot diff OLD NEW")),
    }
}

/// As git runs a diff driver: the files are copies, and any exit code but 0 ends git's own run.
fn driver(arguments: &Arguments, path: &Path, old: &Path, new: &Path) -> Result<u8, u8> {
    let both = side(old).and_then(|ours| Ok((ours, side(new)?)));
    let Ok((mut ours, mut theirs)) = both else {
        // Why was said. What cannot be read is no reason to show nothing of the other files.
        print(&format!("{}: the change cannot be shown for the machine\n", path.display()))?;
        return Ok(WELL);
    };
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    for input in ours.iter_mut().chain(&mut theirs) {
        (input.path, input.name) = (path.to_owned(), name.clone());
    }
    let code = compare(arguments, (path, ours), (path, theirs))?;
    Ok(if arguments.exit_code { code } else { WELL })
}

/// The programs of a side; none of one that is not there, or empty.
fn side(path: &Path) -> Result<Vec<Input>, u8> {
    if path == Path::new("/dev/null") {
        return Ok(Vec::new());
    }
    let found = gather(&[path.to_owned()], &endings());
    let is_nothing = |error: &InputError| error.left_out().is_some_and(|left| left.why == WhyNot::Empty);
    if found.programs.is_empty() && !found.errors.is_empty() && found.errors.iter().all(is_nothing) {
        return Ok(Vec::new());
    }
    common::fit(found.programs, &found.errors)
}

fn compare(
    arguments: &Arguments,
    (old, mut ours): (&Path, Vec<Input>),
    (new, mut theirs): (&Path, Vec<Input>),
) -> Result<u8, u8> {
    let known = if ours.is_empty() { &theirs } else { &ours };
    if known.is_empty() {
        plot(arguments, &Diff::of_nothing(), (old, new))?;
        print(&draw(arguments, &Diff::of_nothing(), &[], &[]))?;
        return Ok(WELL);
    }
    let to = arguments.to.as_deref();
    let from = source_of(arguments.from.as_deref(), to.as_slice(), &arguments.machine, known)?;
    let to = arguments.to.clone().unwrap_or_else(|| from.clone());
    let own = own_profile(arguments.from.as_deref(), known)?;
    let (source, target) =
        common::kinds_told(known, controls(&from, &to, &arguments.machine, own.as_deref())?)?;
    let mut notes: Vec<String> = doubt(&from, &ours).into_iter().chain(doubt(&to, &theirs)).collect();
    notes.dedup();
    let map = if source.is_same_machine(&target) {
        SymbolMap::default()
    } else {
        let named: Vec<&str> = theirs.iter().map(|input| input.name.as_str()).collect();
        let home = Home::of(folder_of(new), &named).map_err(complain)?;
        names(&home, &source, &target)?
    };
    if let Some(folder) = &arguments.library {
        add_library(folder, [(old, &mut ours), (new, &mut theirs)])?;
    }
    if let Some(path) = &arguments.plot {
        let inputs = ours.iter().chain(&theirs).map(|input| &input.path);
        let profiles = common::profile_files(arguments.machine.iter().chain(&own));
        let also = arguments.paths.iter().chain(&profiles);
        let own_files = [Lock::NAME, Manifest::NAME].map(|name| folder_of(new).join(name));
        not_over(path, inputs.chain(also).chain(&own_files).map(PathBuf::as_path))?;
    }
    let all = !(arguments.text || arguments.normalised || arguments.structure || arguments.motion);
    let levels = Levels {
        text: all || arguments.text,
        normalised: all || arguments.normalised,
        structure: all || arguments.structure,
        motion: all || arguments.motion,
    };
    let mut effort = effort(&arguments.time);
    effort.allowed_mm = arguments.tolerance;
    let request = Request {
        old: Shelf { inputs: &ours, control: &source },
        new: Shelf { inputs: &theirs, control: &target },
        names: map,
        levels,
        effort,
        most: arguments.most,
        picture: arguments.plot.is_some(),
    };
    let Some(mut found) = diff(&request) else {
        return Err(complain(format!("there is no emulated control for '{from}' or for '{to}'")));
    };
    found.notes = notes;
    plot(arguments, &found, (old, new))?;
    match arguments.format {
        Format::Text => {
            let colour = if is_coloured(arguments.color) {
                report::diff::Colour::On
            } else {
                report::diff::Colour::Off
            };
            pager::print(&report::diff::text(&found, colour), !arguments.no_pager)?;
        }
        _ => print(&draw(arguments, &found, &ours, &theirs))?,
    }
    Ok(if found.verdict == Verdict::Same { WELL } else { FOUND })
}

/// Draws a program of both sides, where that was asked for.
fn plot(arguments: &Arguments, found: &Diff, (old, new): (&Path, &Path)) -> Result<(), u8> {
    let Some(path) = &arguments.plot else { return Ok(()) };
    let (old, new) = (old.display().to_string(), new.display().to_string());
    let one = found.picture.as_deref();
    let named = |name: Option<&String>, path: &str| match name {
        Some(name) if !name.is_empty() => format!("{path}: {name}"),
        _ => path.to_owned(),
    };
    let shown = PairOfRuns {
        old: &named(one.map(|one| &one.old), &old),
        new: &named(one.map(|one| &one.new), &new),
        picture: one.map(|one| &one.runs),
    };
    drawing::write(
        path,
        &report::pair(&shown, drawing::coordinates(arguments.machine_coordinates)),
        arguments.force,
    )
}

fn draw(arguments: &Arguments, found: &Diff, old: &[Input], new: &[Input]) -> String {
    match arguments.format {
        Format::Text => report::diff::text(found, report::diff::Colour::Off),
        Format::Html => report::diff::html(found),
        Format::Markdown => report::diff::markdown(found),
        Format::Json => report::diff::json(found),
        Format::Sarif => report::diff::sarif(found, old, new),
    }
}

/// As git has it: what the flag says, and else on a terminal, unless `NO_COLOR` is set.
fn is_coloured(when: When) -> bool {
    match when {
        When::Always => true,
        When::Never => false,
        When::Auto => {
            let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
            pager::on_terminal() && !refused
        }
    }
}

/// Gives a single file on each side the programs of its library; the file stands in the place of its own copy there.
fn add_library(folder: &Path, sides: [(&Path, &mut Vec<Input>); 2]) -> Result<(), u8> {
    let others = common::read(&[folder.to_owned()])?;
    let mut name = None;
    for (path, inputs) in &sides {
        if inputs.len() > 1 {
            return Err(complain("--library goes with two single files: of folders, name the folders"));
        }
        let own = inputs.first().map(|input| input.name.clone()).unwrap_or_default();
        let is_own = |other: &&Input| {
            crate::library::same_file(&other.path, path)
                || other.name == own
                || other.name.ends_with(&format!("/{own}"))
        };
        name = name.or(others.iter().find(is_own).map(|other| other.name.clone()));
    }
    for (_, inputs) in sides {
        if let (Some(name), Some(input)) = (&name, inputs.first_mut()) {
            input.name.clone_from(name);
        }
        let own = inputs.first().map(|input| input.name.clone()).or(name.clone());
        inputs.extend(others.iter().filter(|other| Some(&other.name) != own.as_ref()).cloned());
    }
    Ok(())
}

/// One program without what no machine sees.
fn normalise(arguments: &Arguments) -> Result<u8, u8> {
    let [path] = arguments.paths.as_slice() else {
        return Err(complain("--normalise takes one file"));
    };
    let inputs = side(path)?;
    let [input] = inputs.as_slice() else {
        return if inputs.is_empty() { Ok(WELL) } else { Err(complain("--normalise takes one file")) };
    };
    let control = common::source(arguments.from.as_deref(), arguments.machine.first(), &inputs)?;
    match normalised(&input.bytes, &control) {
        Some(text) => print(&text).map(|()| WELL),
        None => Err(complain(format!("there is no emulated control for '{}'", control.dialect().name))),
    }
}
