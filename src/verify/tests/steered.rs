//! Branches whose conditions are solved for what the program takes from outside.

use super::{Outcome, within};

/// What is hidden in each of these programs shows only in circumstances that nothing in the text names.
#[track_caller]
fn hides(dialect: &str, source: &str, (here, there): (&str, &str)) {
    let same = within(dialect, source, source);
    assert_eq!(same.branches_covered, same.branches_total, "{:#?}", same.not_reached);
    assert_ne!(same.outcome, Outcome::Different);
    let changed = source.replace(here, there);
    assert_ne!(changed, source);
    assert_eq!(within(dialect, source, &changed).outcome, Outcome::Different, "{source}");
}

#[test]
fn a_product_that_must_be_met_exactly() {
    let text = "O1\nG21G90G54G17G94\n#100=#500*#501+#502\nIF[#100EQ7331.5]GOTO9\nG0X1.\nM30\nN9G0X2.\nM30\n";
    hides("fanuc", text, ("N9G0X2.", "N9G0X3."));
    hides("haas", text, ("N9G0X2.", "N9G0X3."));
}

/// Most circumstances never end it.
#[test]
fn a_loop_that_waits_for_one_value() {
    let text = "O1\nG21G90G54G17G94\nN1IF[#500EQ3]GOTO2\nIF[#500EQ4]GOTO3\nG4P100\nGOTO1\nN2G0X1.\nM30\n\
                N3IF[#501EQ0]GOTO4\nG0X2.\nM30\nN4G0X3.\nM30\n";
    hides("fanuc", text, ("N4G0X3.", "N4G0X4."));
    hides("haas", text, ("G0X2.", "G0X5."));
}

#[test]
fn conditions_behind_conditions() {
    let text = "O1\nG21G90G54G17G94\n#1=#500*#500-#501\nIF[#1LT7000]GOTO8\n#2=#501*3+#502\nIF[#2GT-7777]GOTO8\n\
                IF[[#1GT9000]AND[#502LT-8123.25]]GOTO9\nN8G0X1.\nM30\nN9G0X2.\nM30\n";
    hides("haas", text, ("N9G0X2.", "N9G0X3."));
}

#[test]
fn of_a_fadal_and_a_cc100() {
    let fadal = "#V3=V1*V1+V2\n#IF V3 > 4321.5 THEN GOTO :A\nG0 X1.\nM2\n#:A\nG0 X2.\nM2\n";
    hides("fadal", fadal, ("G0 X2.", "G0 X3."));
    let cc100 =
        "N1 V3=V1*V1\nN2 V3=V3-4321\nN3 V3=V3+V2\nN4 BGT P1\nN5 G0 X1.\nN6 M30\nN7 $1\nN8 G0 X2.\nN9 M30\n";
    hides("cc100", cc100, ("G0 X2.", "G0 X3."));
}

/// Where a probe touches, and how far offsets lie apart.
#[test]
fn what_is_measured() {
    let probe = "O1\nG21G90G54G17G94\nG0Z0.\nG31Z-50.F100.\nIF[#5063LT-49.9]GOTO8\nIF[#5063GT-49.5]GOTO8\nG0X2.\nM30\nN8G0X1.\nM30\n";
    hides("fanuc", probe, ("G0X2.", "G0X3."));
    let offsets = "O1\nG21G90G54G17G94\n#1=#5221*2-#5241\nIF[#1GT9876.5]GOTO9\nG0X1.\nM30\nN9G0X2.\nM30\n";
    hides("fanuc", offsets, ("N9G0X2.", "N9G0X3."));
}

/// Where a probe move begins and how far it gets must both be another than at first.
#[test]
fn what_is_measured_above_a_place() {
    let text = "O1\nG21G90G54G17G94\nIF[#500LT500]GOTO8\nG31Z#500F100.\nIF[#5003GT#500]GOTO9\nG0X2.\nM30\nN8G0X1.\nM30\n\
                N9G0X3.\nM30\n";
    hides("fanuc", text, ("N9G0X3.", "N9G0X4."));
}

/// Numbers that are all 0 meet in every condition, and no small step leads away from there.
#[test]
fn what_meets_where_nothing_is_set() {
    let text = "O1\nG21G90G54G17G94\nG31X#500F100.\n#10=ABS[#5061-#500]\nIF[#10LT#501]GOTO8\n#10=ABS[#5061-#502]\n\
                IF[#10LT#501]GOTO9\nG0X2.\nM30\nN8G0X1.\nM30\nN9G0X3.\nM30\n";
    hides("haas", text, ("N9G0X3.", "N9G0X4."));
}

/// 0.96+1.3 is not the double next to 2.26.
#[test]
fn a_sum_that_is_met_to_its_last_bit() {
    let text =
        "O1\nG21G90G54G17G94\n#1=0.96+1.3\nIF[#500LT1]GOTO8\nIF[#500EQ#1]GOTO9\nG0X2.\nN8M30\nN9G0X3.\nM30\n";
    hides("haas", text, ("N9G0X3.", "N9G0X4."));
}

/// What the program makes of a number has a gap: 1 to 53 become 101 to 153.
#[test]
fn what_lies_past_a_gap() {
    let text = "O1\nG21G90G54G17G94\n#1=#500\nIF[#1LT1]GOTO8\nIF[#1GE54]GOTO2\n#1=#1+100\nN2IF[#501LT-7777.5]GOTO3\nGOTO8\n\
                N3IF[#1GT100]GOTO4\nG0X2.\nM30\nN4G0X3.\nM30\nN8G0X1.\nM30\n";
    hides("fanuc", text, ("G0X2.", "G0X4."));
}

/// What no small change shows: a part of the time of day, a count of digits, the day.
#[test]
fn what_only_large_changes_show() {
    let shift = "O1\nG21G90G54G17G94\n#1=FIX[#3012/10000]\nIF[#1GE22]GOTO9\nIF[#1LT6]GOTO8\nN8G0X1.\nM30\nN9G0X2.\nM30\n";
    hides("fanuc", shift, ("N9G0X2.", "N9G0X3."));
    hides("haas", shift, ("N9G0X2.", "N9G0X3."));
    let digits = "O1\nG21G90G54G17G94\n#2=#500\n#3=0\nWHILE[#2GE1]DO1\n#2=FIX[#2/10]\n#3=#3+1\nEND1\nIF[#3GE5]GOTO9\n\
                  G0X1.\nM30\nN9G0X2.\nM30\n";
    hides("haas", digits, ("N9G0X2.", "N9G0X3."));
    let day = "O1\nG21G90G54G17G94\n#1=#3011-FIX[#3011/100]*100\nIF[#1EQ15]GOTO9\nG0X1.\nM30\nN9G0X2.\nM30\n";
    hides("fanuc", day, ("N9G0X2.", "N9G0X3."));
}

/// A variable whose number is computed, and the tool in the spindle.
#[test]
fn what_a_computed_number_reaches() {
    let life = "O1\nG21G90G54G17G94\nIF[#4120LT1]GOTO7\nIF[#4120GT40]GOTO7\n#1=#[600+#4120]\nIF[#1EQ#0]GOTO7\n\
                IF[#1LT#[700+#4120]]GOTO7\n#3006=1(WORN)\nG0X2.\nM30\nN7G0X1.\nM30\n";
    hides("haas", life, ("G0X2.", "G0X3."));
    let none = "O1\nG21G90G54G17G94\nIF[#4120LT1]GOTO9\nG0X1.\nM30\nN9G0X2.\nM30\n";
    hides("fanuc", none, ("N9G0X2.", "N9G0X3."));
}

/// The work offset that a caller selected, and a guard after it.
#[test]
fn what_is_selected() {
    let text = "O1\n#1=#4014\nIF[#1NE57]GOTO8\nIF[#500LT9321.5]GOTO8\nG21G90G17G94\nG0X2.\nN8M99\n";
    hides("fanuc", text, ("G0X2.", "G0X3."));
}

/// Of many inputs those come first that the condition hangs on.
#[test]
fn what_hangs_on_the_last_of_many() {
    let guards: String = (501..540).map(|number| format!("IF[#{number}LT-{number}7]GOTO8\n")).collect();
    let text =
        format!("O1\nG21G90G54G17G94\n{guards}#9=#540*3\nIF[#9LT123456.5]GOTO8\nG0X2.\nM30\nN8G0X1.\nM30\n");
    let same = within("haas", &text, &text);
    assert_ne!(same.outcome, Outcome::Different);
    let changed = text.replace("G0X2.", "G0X3.");
    assert_eq!(within("haas", &text, &changed).outcome, Outcome::Different);
}

/// A way that nothing goes costs a bounded number of runs, and is told.
#[test]
fn what_cannot_be_is_left() {
    let text = "O1\nG21G90G54G17G94\n#1=#500*#500\nIF[#1LT-1]GOTO9\nG0X1.\nM30\nN9G0X2.\nM30\n";
    let found = within("fanuc", text, text);
    assert_eq!((found.branches_covered, found.branches_total), (1, 2));
    assert!(found.scenarios_tried < 800, "{}", found.scenarios_tried);
}
