//! Files as they come from shops: any line ends, tape leaders, foreign bytes, free
//! spacing, slips. All bytes stay, and each fault is named at its place.

use macroglot::syntax::{Block, Parser, SyntaxError, cc100, fadal, parse_file, parse_totals};
use macroglot::text::LineIndex;

type Check = fn(&[Block], &[u8]) -> Vec<SyntaxError>;

/// Faults of the blocks and between them as (line, column, number of the code).
fn faults(source: &[u8], parser: Parser, check: Check) -> Vec<(u32, u32, &'static str)> {
    let file = parse_file(source, parser);
    assert_eq!(file.print(), source, "bytes are lost");
    let index = LineIndex::new(source);
    let inside = file.blocks.iter().flat_map(|block| block.errors.clone());
    let mut faults: Vec<_> = inside
        .chain(check(&file.blocks, source))
        .map(|error| {
            let (line, column) = index.place(error.span.start);
            (line, column, error.code.number())
        })
        .collect();
    faults.sort_unstable();
    faults
}

#[test]
fn fadal() {
    let source = include_bytes!("wild/fadal.nc");
    let expected = [
        (9, 4, "MG0160"),  // R1+V1.: V among NC words
        (9, 11, "MG0160"), // R2+V10.
        (10, 1, "MG0165"), // N1 again, and GOTO N1 means the first
        (21, 5, "MG0101"), // X1.2.3; a jump to nowhere is not named beside a block that was not read
    ];
    assert_eq!(faults(source, fadal::parse_line, fadal::check_blocks), expected);
    let totals = parse_totals(source, fadal::parse_line);
    assert!(totals.lossless);
    assert_eq!((totals.blocks, totals.unparsed, totals.faulty), (22, 1, 2));
}

#[test]
fn cc100() {
    let source = include_bytes!("wild/cc100.nc");
    let expected = [
        (8, 11, "MG0174"), // Y=15: a constant behind `=`
        (9, 10, "MG0171"), // V2*SIN V3: two operations
        (11, 1, "MG0165"), // $99 again
    ];
    assert_eq!(faults(source, cc100::parse_line, cc100::check_blocks), expected);
    let totals = parse_totals(source, cc100::parse_line);
    assert!(totals.lossless);
    assert_eq!((totals.blocks, totals.unparsed, totals.faulty), (15, 1, 2));
}
