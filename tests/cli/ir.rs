//! `macroglot ir`: the passes, and what a program is after each.

use super::Shop;
use macroglot::dialect::Control;
use macroglot::legalize::pipeline::through;
use macroglot::library::{gather, partway};
use macroglot::opt::Level;

/// A macro with a branch, a computed word and an alarm.
const MACRO: &str =
    "O9100\nG21 G90\nIF [#1 EQ #0] GOTO 90\n#100=#1*2\nG0 X#100\nN90 #3000=1(NO VALUE)\nM99\n";

/// The names of all passes, as the list prints them: `GROUP/PASS`.
fn listed(text: &str) -> Vec<String> {
    let (mut group, mut names) = ("", Vec::new());
    for line in text.lines() {
        match line.strip_prefix("  ") {
            Some(pass) if !pass.starts_with(' ') => {
                names.push(format!("{group}/{}", pass.split(' ').next().unwrap()));
            }
            Some(_) => {}
            None => group = line.split(':').next().unwrap(),
        }
    }
    names
}

#[test]
fn every_pass_can_be_stopped_after() {
    let shop = Shop::with(&[("a.nc", MACRO)]);
    let list = shop.run("ir --passes");
    assert_eq!((list.code, list.err.as_str()), (0, ""));
    let names = listed(&list.out);
    assert!(names.len() > 60, "{names:?}");
    // Here, but for a few: a process for each would read the tables a hundred times.
    let inputs = gather(&[shop.path("a.nc")], &[]).programs;
    let [source, target] = ["fanuc", "haas"].map(|name| Control::plain(name).unwrap());
    for (at, name) in names.iter().enumerate() {
        let count = through(name).unwrap();
        let made = partway(&inputs, &source, &target, Level::default(), count).unwrap().module.to_string();
        assert!(made.contains("program O9100"), "{name}: {made}");
        if at % 40 == 0 || at + 1 == names.len() {
            let run = shop.run(&format!("ir a.nc --dialect fanuc --to haas --after {name}"));
            assert_eq!(run.code, 0, "{name}: {}", run.err);
            assert!(run.out.ends_with(&made), "{name}: {}", run.out);
        }
    }
}

#[test]
fn the_passes_show_what_they_do() {
    let shop = Shop::with(&[("a.nc", "O1\nG21\n#33=5 MOD 3\nG0 X#33\nM30\n"), ("b.nc", "O2\nX1\nM30\n")]);
    let before = shop.run("ir a.nc --dialect fanuc --to haas --after increments");
    let after = shop.run("ir a.nc --dialect fanuc --to haas --after state");
    let all = shop.run("ir a.nc --dialect fanuc --to haas");
    assert_eq!((before.code, after.code, all.code), (0, 0, 0), "{}{}{}", before.err, after.err, all.err);
    // A register is named once there are any.
    assert!(!after.out.contains("; local.33 is"), "{}", after.out);
    assert!(all.out.contains("; local.33 is #33"), "{}", all.out);
    // A bare 1 counts increments until the pass of that name has seen it.
    let plain = shop.run("ir b.nc --dialect fanuc --to haas --after tidy/dead-stores");
    assert!(plain.out.contains("increments"), "{}", plain.out);
}

#[test]
fn a_pass_that_is_not_there_is_wrong_usage() {
    let shop = Shop::with(&[("a.nc", MACRO)]);
    shop.fails("ir a.nc --dialect fanuc --to haas --after foldd", &["'foldd'", "ir --passes"]);
    shop.fails("ir a.nc --dialect fanuc --to haas --after fold", &["tidy/fold", "tidy-legal/fold"]);
    shop.fails("ir a.nc --dialect fanuc --after fold", &["--to"]);
    shop.fails("ir --dialect fanuc", &["FILE"]);
}
