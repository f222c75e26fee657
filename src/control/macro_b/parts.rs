//! Blocks of long programs, made where a run comes to them: a prepared block takes ten times its text.

use super::code::{Block, Program};
use super::compile::Compiler;
use super::run::Runner;
use std::rc::Rc;

/// Parts of programs that are kept while others are run, at the most.
const MOST: usize = 16;

impl Runner<'_> {
    /// The blocks of a part that is not held.
    pub fn part(&mut self, section: usize, code: &Program, index: usize) -> Rc<[Block]> {
        let is_it = |made: &(usize, usize, _)| (made.0, made.1) == (section, index);
        if let Some((.., blocks)) = self.made.back().filter(|made| is_it(made)) {
            return Rc::clone(blocks);
        }
        let found = self.made.iter().position(is_it).and_then(|place| self.made.remove(place));
        let made = found.unwrap_or_else(|| (section, index, self.make(section, code, index)));
        if self.made.len() >= MOST {
            self.made.pop_front();
        }
        let blocks = Rc::clone(&made.2);
        self.made.push_back(made);
        blocks
    }

    fn make(&self, section: usize, code: &Program, index: usize) -> Rc<[Block]> {
        let Some(part) = code.parts.get(index) else { return [].into() };
        let mut compiler = Compiler::new(self.session.control, self.style, self.session.source(section));
        compiler.part(self.session.library(), section, code, part).into()
    }
}

#[cfg(test)]
mod tests {
    use crate::control::{Library, LoadedFile, ProgramRef, Run, Scenario};
    use crate::dialect::{Control, registry};
    use crate::syntax::{ParsedFile, parse_file};

    fn run(library: &Library<'_>, control: &Control) -> Run {
        let scenario =
            Scenario { steps: 2000, variable_events: true, milliseconds: None, ..Scenario::default() };
        control.entry().execute.unwrap()(library, ProgramRef::FIRST, control, &scenario)
    }

    /// Runs a program whose blocks are held, and the same whose blocks are read so many bytes at a time; how many events.
    #[track_caller]
    fn the_same(text: &[u8]) -> usize {
        let entries = registry::all().iter().filter(|entry| entry.by_need);
        let mut events = 0;
        for control in entries.filter_map(|entry| Control::plain(entry.name)) {
            let parsed = parse_file(text, control.entry().parse);
            let held = run(&Library::new(&[LoadedFile { name: "a.nc", parsed: &parsed }]), &control);
            for size in [1, 20, 64, 100_000] {
                let unread = ParsedFile::unread(text);
                let files = [LoadedFile { name: "a.nc", parsed: &unread }];
                let run = run(&Library::read_by_need(&files, control.entry().parse_items, size), &control);
                assert_eq!(format!("{held:?}"), format!("{run:?}"), "{size}");
            }
            events += held.events.len();
        }
        events
    }

    #[test]
    fn a_program_that_is_read_by_need_runs_as_one_that_is_held() {
        let loops =
            "O1\n#1=0\nWHILE[#1LT3]DO1\n#2=0\nDO2\n#2=#2+1\nIF[#2GT2]GOTO9\nEND2\nN9 #1=#1+1\nG0X#1\nEND1\n";
        assert!(
            the_same(format!("%\n{loops}M98P2\nM30\nO2(SUB)\nG1X5.F100.\n#3=2\nM99\n%\n").as_bytes()) > 10
        );
        // Faults of loops, jumps back and forth, and into a loop.
        the_same(b"O1\nEND1\nM30\n");
        the_same(b"O1\nG0X1.\nDO1\nG0X2.\nM30\n");
        the_same(b"O1\nDO1\nDO2\nEND1\nEND2\nM30\n");
        the_same(b"O1\nGOTO20\nN10 M30\nDO1\nN20 G0X1.\nGOTO10\nEND1\n");
        the_same(b"(A)\n\nO1\r\nG0 X1.\r\nN5 X2.\r\n#500=#500+1\r\nIF[#500LT50]GOTO5\r\n");
        the_same(b"O1\nG65P2A1.\nM30\n%\nO2\nIF[#1EQ1]THEN #501=7\n#3000=1(STOP)\nM99\n");
        the_same(b"");
    }

    #[test]
    fn programs_of_the_corpus_do_so_too() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/corpus");
        let mut events = 0;
        for entry in registry::all().iter().filter(|entry| entry.by_need) {
            for file in std::fs::read_dir(format!("{folder}/{}", entry.name)).unwrap() {
                let path = file.unwrap().path();
                if path.extension().is_some_and(|ending| ending == "nc") {
                    events += the_same(&std::fs::read(path).unwrap());
                }
            }
        }
        assert!(events > 1000, "{events}");
    }
}
