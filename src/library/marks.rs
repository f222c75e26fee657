//! The line at the head of a converted program that says what it was made of: `(MACROGLOT 0.1.0 FROM O1000.NC TO VF2)`.
//!
//! Who reads the program at the machine knows from it which source to change. A program that goes on to another control gets
//! a line of its own; the one of the conversion before goes.

use super::{Input, Options};
use crate::dialect::Control;
use crate::ir::{Module, Program, StmtKind};

/// What such a line begins with.
const BEGINS: &str = "MACROGLOT ";

/// Letters of a file's name, and of a machine's, that are shown.
const MOST: usize = 24;

/// Letters of the whole line, which no control breaks: of one that was broken, half would stay on the way back.
const LINE: usize = 60;

/// By file, the line that its programs get; none if it is not asked for, or the target's profile wants none.
pub(super) fn marks(inputs: &[Input], target: &Control, options: Options) -> Vec<String> {
    if !options.marks || target.profile().head == Some(false) {
        return Vec::new();
    }
    let machine = target.profile().title.as_deref().unwrap_or(&target.dialect().title);
    let longest = target.text().comment.map_or(LINE, |most| LINE.min(most as usize));
    let mark = |input: &Input| {
        let name = input.name.rsplit('/').next().unwrap_or_default();
        let begun = format!("{BEGINS}{} FROM {} TO ", env!("CARGO_PKG_VERSION"), plain(name));
        let machine = plain(machine);
        let room = longest.saturating_sub(begun.len());
        let cut = machine.match_indices(' ').map(|(at, _)| at).chain([machine.len()]);
        let cut = cut.take_while(|at| *at <= room).last().unwrap_or(room);
        begun + machine.get(..cut).unwrap_or(&machine)
    };
    inputs.iter().map(mark).collect()
}

/// A name in letters that every control shows in a comment.
fn plain(name: &str) -> String {
    let letter = |sign: char| match sign.to_ascii_uppercase() {
        sign @ ('A'..='Z' | '0'..='9' | '.' | '-') => sign,
        _ => ' ',
    };
    let shown: String = name.chars().map(letter).collect();
    let words: Vec<&str> = shown.split_whitespace().collect();
    words.join(" ").chars().take(MOST).collect::<String>().trim().to_owned()
}

/// Leaves out what an earlier conversion said of itself at the head of programs.
pub(super) fn drop_old(module: &mut Module) {
    module.programs.iter_mut().for_each(drop_head);
}

fn drop_head(program: &mut Program) {
    program.site.comments.retain(|comment| !is_mark(&comment.text));
    for block in &mut program.blocks {
        let head = block.stmts.iter().take_while(|stmt| stmt.kind == StmtKind::Comment).count();
        let is_old = |stmt: &crate::ir::Stmt| stmt.site.comments.iter().any(|comment| is_mark(&comment.text));
        if block.stmts[..head].iter().any(is_old) {
            let mut at = 0;
            block.stmts.retain_mut(|stmt| {
                at += 1;
                if at > head || !is_old(stmt) {
                    return true;
                }
                stmt.site.comments.retain(|comment| !is_mark(&comment.text));
                !stmt.site.comments.is_empty()
            });
        }
        if head < block.stmts.len() || block.term.kind.successors().len() != 1 {
            return;
        }
    }
}

/// True for `MACROGLOT 0.1.0 FROM ...`.
fn is_mark(text: &str) -> bool {
    let rest = text.trim().strip_prefix(BEGINS);
    rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()) && rest.contains(" FROM "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{Lock, convert};

    fn converted(bytes: &[u8], from: &str, to: &str) -> String {
        let inputs =
            [Input { path: "sub/part (a).nc".into(), name: "sub/part (a).nc".into(), bytes: bytes.into() }];
        let options = Options { marks: true, ..Options::default() };
        let [source, target] = [from, to].map(|text| Control::from_profile(text).unwrap());
        let lock = Lock::new(source.name(), target.name());
        convert(&inputs, &source, &target, lock, options).texts[0].clone().unwrap()
    }

    const FANUC: &str = "dialect = \"fanuc\"\ntitle = \"0i-MF, cell 3\"";
    const HAAS: &str = "dialect = \"haas\"\ntitle = \"VF-2\"";
    const FADAL: &str = "dialect = \"fadal\"";
    const PROGRAM: &[u8] = b"O1000 (PART)\n(BY THE SHOP)\nN10 G0 X1.\nGOTO10\nM30\n";

    #[test]
    fn a_program_says_what_it_was_made_of_once() {
        let version = env!("CARGO_PKG_VERSION");
        let there = converted(PROGRAM, FANUC, HAAS);
        let mark = format!("(MACROGLOT {version} FROM PART A .NC TO VF-2)\n");
        assert!(there.starts_with(&format!("O1000 (PART)\n{mark}(BY THE SHOP)\nN10 G0 X1.\n")), "{there}");
        let back = converted(there.as_bytes(), HAAS, FANUC);
        let mark = format!("(MACROGLOT {version} FROM PART A .NC TO 0I-MF CELL 3)\n");
        assert!(back.starts_with(&format!("O1000 (PART)\n{mark}(BY THE SHOP)\nN10 G0 X1.\n")), "{back}");
        assert_eq!(converted(back.as_bytes(), FANUC, HAAS), there);
        let elsewhere = converted(converted(PROGRAM, FANUC, FADAL).as_bytes(), FADAL, HAAS);
        assert_eq!(elsewhere.matches("MACROGLOT").count(), 1, "{elsewhere}");
    }

    #[test]
    fn a_profile_can_switch_it_off() {
        let there = converted(PROGRAM, FANUC, &format!("{HAAS}\nhead = false"));
        assert!(!there.contains("MACROGLOT"), "{there}");
    }

    #[test]
    fn a_long_one_is_cut_to_a_line() {
        let long = "dialect = \"fadal\"\ntitle = \"CNC 88, format 1, with tool probe\"";
        let name = "a-very-long-name-of-a-file.nc";
        let inputs = [Input { path: name.into(), name: name.into(), bytes: PROGRAM.into() }];
        let options = Options { marks: true, ..Options::default() };
        let [fanuc, fadal] = [FANUC, long].map(|text| Control::from_profile(text).unwrap());
        let there = convert(&inputs, &fanuc, &fadal, Lock::new("fanuc", "fadal"), options);
        let there = there.texts[0].clone().unwrap();
        let mark = there.lines().find(|line| line.contains("MACROGLOT")).unwrap();
        assert!(mark.ends_with(" FROM A-VERY-LONG-NAME-OF-A-FI TO CNC 88"), "{mark}");
        let inputs = [Input { path: name.into(), name: name.into(), bytes: there.clone().into() }];
        let back = convert(&inputs, &fadal, &fanuc, Lock::new("fadal", "fanuc"), options);
        let back = back.texts[0].clone().unwrap();
        assert!(!back.contains("CNC 88") && !back.contains("FORMAT"), "{back}");
    }

    #[test]
    fn what_a_shop_writes_stays() {
        assert!(is_mark("MACROGLOT 0.1.0 FROM A.NC TO VF-2"));
        assert!(!is_mark("MACROGLOT WROTE THIS FROM O1") && !is_mark("FROM MACROGLOT 0.1.0"));
    }
}
