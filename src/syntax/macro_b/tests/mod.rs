//! What is read from what, for both dialects of the family.

mod fragments;
#[allow(dead_code, reason = "the benches use the rest")]
#[path = "../../../../benches/speed/inputs.rs"]
mod inputs;
mod properties;
mod show;
mod statements;
mod trees;

use super::Rules;
use crate::syntax::{Block, fanuc, haas, parse_file};
use crate::text::Span;

/// A dialect of the family, as the tests need it.
struct Dialect {
    name: &'static str,
    rules: &'static Rules,
    parse_line: crate::syntax::Parser,
    parse_faults: crate::syntax::Parser,
}

const FANUC: Dialect = Dialect {
    name: "fanuc",
    rules: &fanuc::RULES,
    parse_line: fanuc::parse_line,
    parse_faults: fanuc::parse_faults,
};
const HAAS: Dialect = Dialect {
    name: "haas",
    rules: &haas::RULES,
    parse_line: haas::parse_line,
    parse_faults: haas::parse_faults,
};
const BOTH: [Dialect; 2] = [FANUC, HAAS];

impl Dialect {
    /// The blocks of one line.
    fn line(&self, line: &[u8]) -> Vec<Block> {
        let mut blocks = Vec::new();
        (self.parse_line)(line, Span::new(0, line.len() as u32), &mut blocks);
        blocks
    }

    /// The blocks of a file, after checking that nothing of it is lost.
    fn file(&self, source: &[u8]) -> Vec<Block> {
        let file = parse_file(source, self.parse_line);
        assert_eq!(file.print(), source, "{}: not printed as read", self.name);
        for line in &file.lines {
            let mut at = line.text.start;
            let text = line.text;
            for block in file.blocks.iter().filter(|b| b.span.start >= text.start && b.span.end <= text.end) {
                assert!(block.span.start == at && block.is_tiled(), "{}: {block:?}", self.name);
                at = block.span.end;
            }
            assert_eq!(at, line.text.end, "{}: a line is not covered", self.name);
        }
        file.blocks
    }

    fn corpus(&self) -> Vec<(String, Vec<u8>)> {
        let folder = format!("{}/corpus/{}", env!("CARGO_MANIFEST_DIR"), self.name);
        let mut files: Vec<_> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "nc"))
            .map(|path| (path.display().to_string(), std::fs::read(path).unwrap()))
            .collect();
        files.sort();
        assert!(!files.is_empty());
        files
    }

    fn fragments(&self) -> Vec<Fragment> {
        let path = format!("{}/corpus/{}/fragments.tsv", env!("CARGO_MANIFEST_DIR"), self.name);
        let table = std::fs::read_to_string(path).unwrap();
        let row = |line: &str| {
            let cells: Vec<&str> = line.split('\t').collect();
            Fragment { text: cells[1].to_owned(), status: cells[2].to_owned(), meaning: cells[3].to_owned() }
        };
        table.lines().skip(1).map(row).collect()
    }
}

/// A row of `fragments.tsv`: what a manual says of a piece of code.
struct Fragment {
    text: String,
    status: String,
    meaning: String,
}
