use super::SharedValues;
use crate::ir::analysis::{Summaries, Values};
use crate::ir::text::parse;
use crate::ir::{BlockId, Class, Var};

const BASE: Var = Var { class: Class::Common, number: 111 };

/// Sets the base, and returns.
const SETS: &str = "program O9 {\nblock0:\n common.111 = 600\n return\n}\n";

/// What the base holds where a program reads `#[#111+5]` in a block; none if that may be anything.
fn held(text: &str, program: usize, block: u32) -> Option<Values> {
    let module = parse(text).unwrap();
    let summaries = Summaries::of(&module);
    let values = SharedValues::of(&module, &summaries)?;
    values.at(program, (BlockId(block), 0), BASE)
}

/// A program that calls O9, does something, and reads.
fn reads(between: &str) -> String {
    format!(
        "program O1 {{\nblock0:\n call O9 -> block1\nblock1:\n{between} jump block2\nblock2:\n \
         common.100 = #[common.111 + 5]\n end\n}}\n"
    )
}

#[test]
fn what_a_callee_sets_is_known_after_the_call() {
    let found = held(&format!("{}{SETS}", reads("")), 0, 2);
    assert_eq!(found, Some(Values::one(600.0)));
}

#[test]
fn it_is_not_known_before_the_call_nor_if_it_is_missing() {
    assert_eq!(held(&format!("{}{SETS}", reads("")), 0, 0), None);
    assert_eq!(held(&reads(""), 0, 2), None);
}

#[test]
fn other_writes_lose_it() {
    for (write, kept) in [
        ("", true),
        (" common.112 = 7\n", true),
        // #605 is another variable.
        (" #[common.111 + 5] = 7\n", true),
        // Any variable may be meant.
        (" #[local.1] = 7\n", false),
        (" local.2 = 111\n #[local.2] = 7\n", false),
        (" local.2 = 112\n #[local.2] = 7\n", true),
    ] {
        let found = held(&format!("{}{SETS}", reads(write)), 0, 2);
        assert_eq!(found, kept.then(|| Values::one(600.0)), "{write}");
    }
    // It is no constant somewhere in the library.
    let other = "program O8 {\nblock0:\n common.111 = common.112\n return\n}\n";
    assert_eq!(held(&format!("{}{SETS}{other}", reads("")), 0, 2), None);
}

/// A literal at the head of a program that nothing calls is what an operator edits.
#[test]
fn an_input_is_not_known() {
    let main = "program O1 {\nblock0:\n common.111 = 600\n common.100 = #[common.111 + 5]\n end\n}\n";
    assert_eq!(held(main, 0, 0), None);
}

#[test]
fn a_called_program_begins_with_what_all_callers_have() {
    let reader = "program O2 {\nblock0:\n common.101 = #[common.111 + 6]\n return\n}\n";
    let caller = |name: &str, sets: &str| {
        format!(
            "program {name} {{\nblock0:\n call O9 -> block1\nblock1:\n{sets} call O2 -> block2\nblock2:\n end\n}}\n"
        )
    };
    let two = |sets: &str| format!("{}{}{SETS}{reader}", caller("O1", ""), caller("O3", sets));
    assert_eq!(held(&two(""), 3, 0), Some(Values::one(600.0)));
    assert_eq!(
        held(&two(" common.120 = 1\n common.111 = 700\n"), 3, 0),
        Some(Values::of(vec![600.0, 700.0]))
    );
    assert_eq!(held(&two(" input common.111\n"), 3, 0), None);
    // One that does not set it.
    let third = "program O4 {\nblock0:\n call O2 -> block1\nblock1:\n end\n}\n";
    assert_eq!(held(&format!("{}{third}", two("")), 3, 0), None);
}

/// What O5 leaves as it finds it stays known after its calls, whoever else calls it.
#[test]
fn what_a_callee_leaves_alone_stays_known() {
    let leaves = "program O5 {\nblock0:\n common.120 = 1\n return\n}\n";
    let other = "program O6 {\nblock0:\n call O5 -> block1\nblock1:\n end\n}\n";
    let main = "program O1 {\nblock0:\n call O9 -> block1\nblock1:\n call O5 -> block2\nblock2:\n \
                common.100 = #[common.111 + 5]\n end\n}\n";
    assert_eq!(held(&format!("{main}{SETS}{leaves}{other}"), 0, 2), Some(Values::one(600.0)));
    let writes = "program O5 {\nblock0:\n #[local.1] = 1\n return\n}\n";
    assert_eq!(held(&format!("{main}{SETS}{writes}{other}"), 0, 2), None);
}

/// O5 writes under a number that it does not know if O6 calls it: that may be the base itself.
#[test]
fn a_write_under_an_unknown_base_may_hit_it() {
    let writes = "program O5 {\nblock0:\n #[common.111 + 5] = 1\n return\n}\n";
    let main = "program O1 {\nblock0:\n call O9 -> block1\nblock1:\n call O5 -> block2\nblock2:\n \
                common.100 = #[common.111 + 5]\n end\n}\n";
    assert_eq!(held(&format!("{main}{SETS}{writes}"), 0, 2), Some(Values::one(600.0)));
    let other = "program O6 {\nblock0:\n call O5 -> block1\nblock1:\n end\n}\n";
    assert_eq!(held(&format!("{main}{SETS}{writes}{other}"), 0, 2), None);
}

/// O7 may return to a block of its caller by its number.
#[test]
fn a_return_to_a_number_loses_it() {
    let main = "program O1 {\nblock0:\n call O9 -> block1\nblock1:\n call O7 -> block2\nblock2 (N50):\n \
                common.100 = #[common.111 + 5]\n end\n}\n";
    let plain = "program O7 {\nblock0:\n common.120 = 1\n return\n}\n";
    let back = "program O7 {\nblock0:\n common.120 = 1\n return to 50\n}\n";
    assert_eq!(held(&format!("{main}{SETS}{plain}"), 0, 2), Some(Values::one(600.0)));
    assert_eq!(held(&format!("{main}{SETS}{back}"), 0, 2), None);
    // So may a part of the program itself, which sets another base.
    let part = |returns: &str| {
        format!(
            "program O1 {{\nblock0:\n call O9 -> block1\nblock1:\n branch local.1 eq 1 ? block2 : block3\nblock2 (N50):\n \
             common.100 = #[common.111 + 5]\n end\nblock3:\n call block4 -> block5\nblock4:\n call O8 -> block6\n\
             block5:\n end\nblock6:\n {returns}\n}}\nprogram O8 {{\nblock0:\n common.111 = 700\n return\n}}\n{SETS}"
        )
    };
    assert_eq!(held(&part("return"), 0, 2), Some(Values::one(600.0)));
    assert_eq!(held(&part("return to 50"), 0, 2), None);
}
