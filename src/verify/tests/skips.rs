//! Blocks that a switch leaves out.

use super::*;

#[test]
fn what_a_skipped_block_sets_is_not_certain() {
    // By #100=6000 the jump would be certain; the block may be skipped, and then #100 is what it was.
    let program = "O1\n/#100=6000\nIF[#100GT2500]GOTO5\nG0X1.\nN5M30\n";
    let found = within("fanuc", program, program);
    assert_eq!((found.branches_covered, found.branches_total), (2, 2));
    differs("fanuc", program, &program.replace("X1.", "X2."), "elsewhere");
    // Without the skip it is certain.
    let certain = program.replace('/', "");
    assert_eq!(within("fanuc", &certain, &certain).branches_total, 1);
}
