//! Ends the lines of conversions as the source ends its own, or as the target's profile says: some controls load one way
//! alone, and a version control shows a file of other line ends as changed in every line.

use super::{Conversion, Input};
use crate::dialect::{Control, LineEnds};
use memchr::{memchr_iter, memchr2};

/// Gives each text of a conversion its line ends.
pub(super) fn keep(inputs: &[Input], target: &Control, conversion: &mut Conversion) {
    for (at, input) in inputs.iter().enumerate() {
        let ends = target.profile().line_ends.unwrap_or_else(|| ends_of(&input.bytes));
        let Some(Some(text)) = conversion.texts.get_mut(at) else { continue };
        match ends {
            LineEnds::Lf => continue,
            // Nothing moves.
            LineEnds::Cr => *text = text.replace('\n', "\r"),
            LineEnds::Crlf => {
                let lines: Vec<usize> = memchr_iter(b'\n', text.as_bytes()).collect();
                *text = text.replace('\n', "\r\n");
                // A place moves by the ends before it.
                let moved = |place: &mut usize| *place += lines.partition_point(|end| *end < *place);
                for program in conversion.programs.iter_mut().filter(|program| program.file == at) {
                    let ranges = program.map.iter_mut().map(|(_, range)| range);
                    for range in ranges.chain([&mut program.range]) {
                        moved(&mut range.start);
                        moved(&mut range.end);
                    }
                }
            }
        }
    }
}

/// How the first line of a text ends; what has none is as most files are.
fn ends_of(bytes: &[u8]) -> LineEnds {
    match memchr2(b'\n', b'\r', bytes) {
        Some(at) if bytes[at] == b'\n' => LineEnds::Lf,
        // Some controls punch two carriage returns before a line feed.
        Some(at) => match bytes[at..].iter().find(|byte| **byte != b'\r') {
            Some(b'\n') => LineEnds::Crlf,
            _ => LineEnds::Cr,
        },
        None => LineEnds::Lf,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::{Lock, Options, convert};

    fn converted(source: &str, profile: &str) -> (String, Vec<String>) {
        let target = Control::from_profile(&format!("dialect = \"haas\"\n{profile}")).unwrap();
        let inputs = [Input { path: "a".into(), name: "a".into(), bytes: source.into() }];
        let lock = Lock::new("fanuc", "haas");
        let done = convert(&inputs, &Control::plain("fanuc").unwrap(), &target, lock, Options::default());
        let text = done.texts[0].clone().unwrap();
        let blocks = done.programs.iter().flat_map(|program| &program.map);
        let blocks = blocks.map(|(_, range)| text[range.clone()].to_owned()).collect();
        (text, blocks)
    }

    #[test]
    fn lines_end_as_the_source_ends_its_own_or_as_the_profile_says() {
        let plain = "O1\nG0 X1.\nM30\n";
        let (lf, blocks) = converted(plain, "");
        assert_eq!(lf, "O0001\nG0 X1.\nM30\n");
        for (end, name) in [("\r\n", "crlf"), ("\r", "cr"), ("\n", "lf")] {
            let wanted = lf.replace('\n', end);
            let of_blocks: Vec<String> = blocks.iter().map(|block| block.replace('\n', end)).collect();
            assert_eq!(
                converted(&plain.replace('\n', end), ""),
                (wanted.clone(), of_blocks.clone()),
                "{name}"
            );
            let profile = format!("line_ends = \"{name}\"");
            assert_eq!(converted(plain, &profile), (wanted.clone(), of_blocks.clone()), "{name}");
            assert_eq!(converted(&plain.replace('\n', "\r\n"), &profile), (wanted, of_blocks), "{name}");
        }
    }

    #[test]
    fn the_first_line_says_how_lines_end() {
        assert!(ends_of(b"O1\r\r\nM30\r\r\n") == LineEnds::Crlf && ends_of(b"O1\rM30") == LineEnds::Cr);
        assert!(ends_of(b"M30") == LineEnds::Lf && ends_of(b"O1\nM30\r\n") == LineEnds::Lf);
    }
}
