//! Files as they come from shops: any line ends, tape leaders, foreign bytes, free
//! spacing, slips. All bytes stay, and each fault is named at its place.

use macroglot::syntax::{Parser, cc100, fadal, parse_file, parse_totals};
use macroglot::text::LineIndex;

/// Faults of the blocks as (line, column, number of the code).
fn faults(source: &[u8], parser: Parser) -> Vec<(u32, u32, &'static str)> {
    let file = parse_file(source, parser);
    assert_eq!(file.print(), source, "bytes are lost");
    let index = LineIndex::new(source);
    let errors = file.blocks.iter().flat_map(|block| &block.errors);
    let mut faults: Vec<_> = errors
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
        (21, 5, "MG0101"), // X1.2.3
    ];
    assert_eq!(faults(source, fadal::parse_line), expected);
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
    ];
    assert_eq!(faults(source, cc100::parse_line), expected);
    let totals = parse_totals(source, cc100::parse_line);
    assert!(totals.lossless);
    assert_eq!((totals.blocks, totals.unparsed, totals.faulty), (15, 1, 2));
}
