//! Programs of lathes with two paths: two programs that run at the same time.
//!
//! Law: a block in which one path waits for the others, or a mark before a path's part of the file, says that another program runs
//! beside this one. What a conversion would have to keep then is the order of the two, which no control here is run for; so the
//! program is refused, with one finding, and after a mark all programs of the file are. Counter-example: an M code of the builder
//! with a P that names no paths.

use super::Input;
use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Machine};
use crate::ir::Module;
use crate::syntax::{Block, ExprKind, ItemKind, for_each_item, parse_file};
use crate::text::Span;

/// What shows a second path, by the tables: settings that tell it.
struct Signs {
    /// The M codes by which paths wait.
    waits: Option<(f64, f64)>,
    /// The values of P beside one, which say in digits which paths wait.
    paths: Vec<f64>,
    /// What stands before the number of a path where its part of a file begins.
    mark: Option<String>,
}

impl Signs {
    fn of(control: &Control) -> Self {
        let told = |name: &str| control.told(name).and_then(|(_, value)| value);
        let number = |name: &str| told(name).and_then(|value| value.parse::<f64>().ok());
        Self {
            waits: number("paths.wait.first").zip(number("paths.wait.last")),
            paths: told("paths.wait.p").map_or(Vec::new(), |all| {
                all.split_whitespace().filter_map(|value| value.parse().ok()).collect()
            }),
            mark: told("paths.mark").map(str::to_owned),
        }
    }

    /// What in a block shows another path.
    fn sign(&self, block: &Block, bytes: &[u8], control: &Control) -> Option<Sign> {
        let text = String::from_utf8_lossy(block.span.of(bytes));
        let text = text.trim();
        let sign = |is_mark: bool, what: String| Sign { span: block.span, is_mark, what };
        if let Some(rest) = self.mark.as_ref().and_then(|mark| text.strip_prefix(mark.as_str()))
            && rest.starts_with(|letter: char| letter.is_ascii_digit())
        {
            return Some(sign(true, format!("{text} begins the part of one path")));
        }
        let (first, last) = self.waits?;
        let mut words = Vec::new();
        for_each_item(&block.items, &mut |item| {
            if let ItemKind::Word(word) = &item.kind {
                let value = word.value.as_ref().and_then(|value| match &value.kind {
                    ExprKind::Number(number) => Some(number.value),
                    _ => None,
                });
                words.push((word.letter, value));
            }
        });
        let value = |wanted: char| words.iter().find(|(letter, _)| *letter == wanted).and_then(|word| word.1);
        let code = value('M').filter(|code| (first..=last).contains(code))?;
        let of_builder = control.site_code('M', code).is_some() || control.alias('M', code).is_some();
        let waits = value('P').is_some_and(|paths| self.paths.contains(&paths))
            && words.iter().all(|word| "MPN".contains(word.0));
        (waits && !of_builder && control.code('M', code, &words).is_none())
            .then(|| sign(false, format!("at {text} the paths of the machine wait for each other")))
    }
}

/// A block that shows another path.
struct Sign {
    span: Span,
    /// True of a mark: all programs of the file are parts of paths.
    is_mark: bool,
    what: String,
}

/// Refuses the programs that show a second path, each with one finding.
pub(super) fn report(module: &Module, inputs: &[Input], control: &Control, found: &mut [Vec<Diagnostic>]) {
    let signs = Signs::of(control);
    if control.machine() != Machine::Lathe || (signs.waits.is_none() && signs.mark.is_none()) {
        return;
    }
    for (file, input) in inputs.iter().enumerate() {
        let blocks = parse_file(&input.bytes, control.entry().parse).blocks;
        let shown: Vec<Sign> =
            blocks.iter().filter_map(|block| signs.sign(block, &input.bytes, control)).collect();
        for (at, found) in found.iter_mut().enumerate() {
            let Some(program) = module.programs.get(at).filter(|program| program.file == file) else {
                continue;
            };
            // What stands before the first program of a file is its.
            let before = at.checked_sub(1).and_then(|before| module.programs.get(before));
            let is_first = before.is_none_or(|before| before.file != file);
            let begins = if is_first { 0 } else { program.site.span.start };
            let next = module.programs.get(at + 1).filter(|next| next.file == file);
            let ends = next.map_or(u32::MAX, |next| next.site.span.start);
            let own = |sign: &&Sign| (begins..ends).contains(&sign.span.start);
            // The part of a path goes on to the next mark, over the heads of its programs.
            let before = |sign: &&Sign| sign.is_mark && sign.span.start < ends;
            let part = || shown.iter().rfind(before).or_else(|| shown.iter().find(|sign| sign.is_mark));
            if let Some(sign) = shown.iter().find(own).or_else(part) {
                let what = format!("the program is one of several that run at the same time: {}", sign.what);
                found.push(Diagnostic::new(Code::TwoPaths, sign.span, what));
            }
        }
    }
}

/// What else was found in such a program asks for nothing: it is refused as a whole.
pub(super) fn drop_others(diagnostics: &mut Vec<Diagnostic>) {
    if diagnostics.iter().any(|found| found.code == Code::TwoPaths) {
        let mut said = false;
        diagnostics.retain(|found| found.code == Code::TwoPaths && !std::mem::replace(&mut said, true));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{Lock, Options, Outcome, convert};

    /// What is said of a program for a Haas lathe.
    fn said(more: &str, text: &str) -> Vec<(Code, String)> {
        let source =
            Control::from_profile(&format!("dialect = \"fanuc\"\nmachine = \"lathe\"\n{more}")).unwrap();
        let target = Control::from_profile("dialect = \"haas\"\nmachine = \"lathe\"").unwrap();
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let lock = Lock::new("fanuc", "haas");
        let made = convert(&inputs, &source, &target, lock, Options::default());
        let program = &made.programs[0];
        let paths = program.diagnostics.iter().any(|found| found.code == Code::TwoPaths);
        assert!(!paths || program.outcome == Outcome::Refused);
        program.diagnostics.iter().map(|found| (found.code, found.message.to_string())).collect()
    }

    #[test]
    fn a_second_path_is_one_finding() {
        for block in ["M100 P12", "M250 P123", "$1", "$2\nG0 X20."] {
            let told = said("", &format!("O1\nT0101\n{block}\nG0 X50. Z2.\nM777\nG68\nM30\n"));
            assert_eq!(told.len(), 1, "{told:?}");
            let line = block.lines().next().unwrap();
            assert!(told[0].0 == Code::TwoPaths && told[0].1.contains(line), "{told:?}");
        }
    }

    #[test]
    fn a_mark_before_the_first_program() {
        let told = said("", "$1\nO1\nT0101\nG0 X50. Z2.\nM30\n");
        assert!(told.iter().any(|(code, _)| *code == Code::TwoPaths), "{told:?}");
    }

    #[test]
    fn all_programs_of_a_file_with_marks_are_parts_of_paths() {
        let source = Control::from_profile("dialect = \"fanuc\"\nmachine = \"lathe\"").unwrap();
        let target = Control::from_profile("dialect = \"haas\"\nmachine = \"lathe\"").unwrap();
        let text = "O5\nG0 X50.\nM30\n$1\nO1\nG0 X50.\nM30\n$2\nO1\nG0 X60.\nM30\nO2\nG0 X70.\nM99\n";
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let made = convert(&inputs, &source, &target, Lock::new("fanuc", "haas"), Options::default());
        assert_eq!(made.programs.len(), 4);
        assert!(made.programs.iter().all(|program| program.outcome == Outcome::Refused));
    }

    #[test]
    fn what_only_looks_like_it() {
        let paths = |more: &str, block: &str| {
            let told = said(more, &format!("O1\nT0101\n{block}\nG0 X50. Z2.\nM30\n"));
            told.iter().any(|(code, _)| *code == Code::TwoPaths)
        };
        // A P that names no paths, a code of the program flow, a code that the profile knows, one outside the range.
        assert!(!paths("", "M100 P5") && !paths("", "M98 P12") && !paths("", "M50 P12"));
        assert!(!paths("", "M100"));
        let site = "[[site]]\ncode = \"M100\"\ntext = \"bar feed\"\ndo = \"omit\"";
        assert!(!paths(site, "M100 P12"));
        assert!(!paths("[parameters]\n8110 = 500", "M100 P12"));
    }
}
