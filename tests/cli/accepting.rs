//! Accepted reviews: `macroglot accept`, and what a conversion makes of its entries in the project file.

use super::{CLEAN, REFUSED, Shop};
use serde_json::Value;

/// A project whose target's profile may change, with comments and an order of its own.
const PROJECT: &str = "\
# The machines of the shop.
[machines.old]
profile = \"old.toml\"
dialect = \"fanuc\"   # the one at the door
[machines.new]
profile = \"new.toml\"
dialect = \"haas\"

# What runs on them.
[libraries.shop]
path = \"programs\"
machine = \"old\"
[libraries.shop.targets]
new = \"out\"
";

/// Its programs need what variables held at power-off.
const OLD: &str = "dialect = \"fanuc\"\n[behaviours]\n\"power.off.values\" = \"used\"\n";

const NEW: &str = "dialect = \"haas\"\n";

/// A program that is for review: a variable that the machine keeps (MG0404), and a place that is read early (MG0314), since cutter
/// compensation is in force there and the machine cannot be told to wait. It calls O9000, which calls O9001.
const ASKS: &str = "%\nO2000\nG20 G17 G90 G40 G80 G94 G54\nG0 X#100\nG41 D1 G1 Y3. F5.\nG1 Z#5043\nG40 Y4.\nG65 P9000 A1.\nM30\n%\n";

const CALLED: &str = "%\nO9000\nG0 Y#1\nM98 P9001\nM99\n%\n";
const BELOW: &str = "%\nO9001\nG0 Y2.\nM99\n%\n";

fn shop() -> Shop {
    Shop::with(&[
        ("macroglot.toml", PROJECT),
        ("old.toml", OLD),
        ("new.toml", NEW),
        ("programs/asks.nc", ASKS),
        ("programs/called.nc", CALLED),
        ("programs/below.nc", BELOW),
        ("programs/clean.nc", CLEAN),
    ])
}

/// The shop after all of it was accepted.
fn accepted() -> Shop {
    let shop = shop();
    let run = shop.run("accept --all --who Ann --why measured");
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    shop
}

/// The last line of what a conversion prints.
fn summary(shop: &Shop) -> String {
    let run = shop.run("convert --no-verify");
    run.out.lines().last().unwrap_or_default().to_owned()
}

const ALL_ACCEPTED: &str = "4 programs in 4 files: 3 converted, 1 accepted, 0 for review, 0 refused";
const ASKED_AGAIN: &str = "4 programs in 4 files: 3 converted, 0 for review, 1 refused";
const FOR_REVIEW: &str = "4 programs in 4 files: 3 converted, 1 for review, 0 refused";

#[test]
fn what_is_accepted_is_not_asked_again() {
    let shop = shop();
    let before = shop.run("convert");
    assert!(before.out.contains("3 converted, 1 for review, 0 refused"), "{}", before.out);
    let outputs = |shop: &Shop| {
        let files = shop.files().into_iter();
        files.filter(|(name, _)| name.starts_with("out/")).collect::<Vec<_>>()
    };
    let written = outputs(&shop);
    let run = shop.run("accept --all --who Ann --why measured");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.contains("accepted  programs/asks.nc O2000, shop to new: MG0314, line 6: G1 Z#5043"),
        "{}",
        run.out
    );
    assert!(run.out.ends_with("2 accepted, 0 renewed, 0 dropped\n"), "{}", run.out);
    let after = shop.run("convert");
    assert_eq!((after.code, after.err.as_str()), (0, ""));
    assert!(after.out.contains("accepted   asks.nc    O2000  "), "{}", after.out);
    assert!(
        after.out.contains("3 converted, 1 accepted, 0 for review, 0 refused; 4 verified"),
        "{}",
        after.out
    );
    assert!(after.out.contains("MG0314, asks.nc:6: accepted by Ann on 20"), "{}", after.out);
    assert!(!after.out.contains("\nreview MG"), "{}", after.out);
    let drawn = shop.run("convert --verbose").err;
    assert!(drawn.contains("accepted by Ann on 20") && drawn.contains(": measured"), "{drawn}");
    // Outputs, certificates, lock and manifest are those of before.
    assert!(outputs(&shop) == written);
    // A second time there is nothing to do.
    let text = shop.read("macroglot.toml");
    let again = shop.run("accept --all --who Bob");
    assert_eq!((again.code, again.out.as_str()), (0, "0 accepted, 0 renewed, 0 dropped\n"));
    assert_eq!(shop.read("macroglot.toml"), text);
}

#[test]
fn the_project_file_stays_as_it_is_written() {
    let shop = accepted();
    let text = shop.read("macroglot.toml");
    assert!(text.starts_with(&format!("{PROJECT}\n[[accepted]]\nlibrary = \"shop\"\n")), "{text}");
    assert_eq!(text.matches("[[accepted]]").count(), 2, "{text}");
    // Comments and line ends of the user stay when entries are renewed and dropped.
    let own = text.replacen("[[accepted]]", "# The ones of May.\n[[accepted]]", 1);
    let own = own.replacen("code = \"MG0314\"", "code = \"MG0314\" # the probe\n# asked twice", 1);
    let own = format!("{own}\n[checks] # at the end\nround_trip = []\n").replace('\n', "\r\n");
    shop.write("macroglot.toml", own.as_bytes());
    assert_eq!(summary(&shop), ALL_ACCEPTED);
    shop.write("programs/asks.nc", ASKS.replace("X#100", "X1.").as_bytes());
    let run = shop.run("accept --all --who Bob");
    assert!(run.out.ends_with("0 accepted, 1 renewed, 1 dropped\n"), "{}{}", run.out, run.err);
    let now = shop.read("macroglot.toml");
    assert_eq!(now.matches('\n').count(), now.matches("\r\n").count(), "{now:?}");
    let now = now.replace("\r\n", "\n");
    assert!(now.starts_with(&format!("{PROJECT}\n# The ones of May.\n[[accepted]]\n")), "{now}");
    assert!(now.contains("code = \"MG0314\" # the probe\n# asked twice\nsays = "), "{now}");
    assert!(now.ends_with("\n\n[checks] # at the end\nround_trip = []\n"), "{now}");
    assert!(
        !now.contains("MG0404") && now.contains("who = \"Bob\"") && now.contains("why = \"measured\""),
        "{now}"
    );
    // A new one goes beside those of its file.
    shop.write("programs/asks.nc", ASKS.as_bytes());
    assert!(shop.run("accept --all --who Cid").out.ends_with("1 accepted, 1 renewed, 0 dropped\n"));
    let now = shop.read("macroglot.toml").replace("\r\n", "\n");
    assert!(now.ends_with("\"\n\n[checks] # at the end\nround_trip = []\n"), "{now}");
    assert_eq!(summary(&shop), ALL_ACCEPTED);
}

#[test]
fn a_change_of_what_it_concerns_asks_again() {
    let shop = accepted();
    assert_eq!(summary(&shop), ALL_ACCEPTED);
    let changes: [(&str, &str, String, &str); 5] = [
        ("programs/asks.nc", ASKS, ASKS.replace("Y4.", "Y5."), "another text of the program"),
        ("programs/called.nc", CALLED, CALLED.replace("Y#1", "Y[#1+1.]"), "another text of the program"),
        ("programs/below.nc", BELOW, BELOW.replace("Y2.", "Y3."), "another text of the program"),
        ("new.toml", NEW, format!("{NEW}units = \"inch\"\n"), "for other machines"),
        ("old.toml", OLD, OLD.replacen('\n', "\nunits = \"inch\"\n", 1), "for other machines"),
    ];
    for (name, before, after, why) in changes {
        shop.write(name, after.as_bytes());
        let run = shop.run("convert --no-verify");
        assert!(run.out.ends_with(&format!("{FOR_REVIEW}\n")), "{name}: {}", run.out);
        let told = "help: It was accepted by Ann on 20";
        assert!(run.out.contains(told) && run.out.contains(why), "{name}: {}", run.out);
        assert!(run.out.contains("run `macroglot accept`"), "{name}: {}", run.out);
        shop.write(name, before.as_bytes());
        assert_eq!(summary(&shop), ALL_ACCEPTED, "{name}");
    }
}

#[test]
fn a_change_of_nothing_that_it_concerns_asks_nothing() {
    let shop = accepted();
    let profile = "# Written anew.\n\ndialect   =   'haas'\n";
    let changes: [(&str, String); 6] = [
        ("programs/clean.nc", CLEAN.replace("X1.", "X7.")),
        ("programs/more.nc", CLEAN.replace("O1234", "O1236")),
        ("programs/asks.nc", ASKS.replace('\n', "\r\n")),
        ("new.toml", profile.into()),
        ("programs/bad.nc", REFUSED.into()),
        ("programs/called.nc", format!("{CALLED}\n")),
    ];
    for (name, text) in changes {
        shop.write(name, text.as_bytes());
        let run = shop.run("convert --no-verify");
        assert!(run.out.contains("1 accepted, 0 for review"), "{name}: {}", run.out);
    }
}

/// Programs of one file are told apart: their lines count from their own start.
#[test]
fn programs_of_one_file_have_their_own_answers() {
    let body = |text: &str| text.trim_start_matches("%\n").trim_end_matches("%\n").to_owned();
    let file = |first: &str, second: &str, third: &str| {
        format!("%\n{}{}{}%\n", body(first), body(second), body(third))
    };
    let other = ASKS.replace("O2000", "O2001").replace("X#100", "Y#100");
    let shop = shop();
    shop.write("programs/asks.nc", file(CALLED, ASKS, &other).as_bytes());
    std::fs::remove_file(shop.path("programs/called.nc")).unwrap();
    let run = shop.run("accept --all --who Ann");
    assert!(run.out.contains("programs/asks.nc O2001, shop to new: MG0314, line 18: "), "{}", run.out);
    let both = "2 accepted, 0 for review";
    assert!(summary(&shop).contains(both), "{}", summary(&shop));
    // A line more in the last program is the first one's no matter.
    shop.write("programs/asks.nc", file(CALLED, ASKS, &other.replace("M30", "(A)\nM30")).as_bytes());
    assert!(summary(&shop).contains("1 accepted, 1 for review"), "{}", summary(&shop));
    // A line more in a program that stands before both, and that neither calls.
    let apart = |text: &str| text.replace("P9000", "P9001");
    shop.write("programs/asks.nc", file(CALLED, &apart(ASKS), &apart(&other)).as_bytes());
    assert_eq!(shop.run("accept --all --who Ann").code, 0);
    assert!(summary(&shop).contains(both), "{}", summary(&shop));
    let longer = CALLED.replace("G0 Y#1", "(A)\n(B)\nG0 Y#1");
    shop.write("programs/asks.nc", file(&longer, &apart(ASKS), &apart(&other)).as_bytes());
    assert!(summary(&shop).contains(both), "{}", summary(&shop));
    // One more place at which the same is asked.
    let more = apart(ASKS).replace("G1 Z#5043", "G1 Z#5043\nG1 X#5043");
    shop.write("programs/asks.nc", file(&longer, &more, &apart(&other)).as_bytes());
    assert!(summary(&shop).contains("1 accepted, 1 for review"), "{}", summary(&shop));
}

/// Files that are named by hand are of the project if they go where it goes.
#[test]
fn files_that_are_named_are_of_their_project() {
    let shop = accepted();
    let of = |line: &str| {
        let run = shop.run(&format!("convert {line} --no-verify --out by-hand"));
        assert!(
            !run.err.contains("[[accepted]]") && !run.out.contains("It was accepted"),
            "{}{}",
            run.out,
            run.err
        );
        run.out.lines().last().unwrap_or_default().to_owned()
    };
    assert_eq!(of("programs --to haas --machine new.toml"), ALL_ACCEPTED);
    let one = of("programs/asks.nc --library programs --to haas --machine new.toml");
    assert!(one.contains("0 converted, 1 accepted, 0 for review"), "{one}");
    // What it calls is not here; another machine.
    assert!(of("programs/asks.nc --to haas --machine new.toml").contains("1 for review"));
    assert!(of("programs --to haas").contains("1 for review"));
    // Nothing is looked up in a project file that cannot be read.
    let text = shop.read("macroglot.toml");
    shop.write("macroglot.toml", text.replacen("who = \"Ann\"", "who = 1", 1).as_bytes());
    assert!(of("programs --from fanuc --to haas --machine new.toml").contains("1 for review"));
    shop.write("macroglot.toml", text.as_bytes());
    shop.write("other.toml", format!("{NEW}units = \"inch\"\n").as_bytes());
    assert!(of("programs --to haas --machine other.toml").contains("1 for review"));
}

/// What a reviewer reads in an entry is what was asked: who changes it by hand takes the answer away.
#[test]
fn an_entry_that_was_changed_by_hand_answers_nothing() {
    let shop = accepted();
    let text = shop.read("macroglot.toml");
    let asked = text.lines().find(|line| line.starts_with("says = ")).unwrap();
    for (from, to) in [
        (asked, "says = \"all is well\""),
        ("file = \"programs/asks.nc\"", "file = \"programs/clean.nc\""),
        ("program = \"O2000\"", "program = \"O2001\""),
        ("code = \"MG0314\"", "code = \"MG0405\""),
        ("target = \"new\"", "target = \"old\""),
    ] {
        shop.write("macroglot.toml", text.replacen(from, to, 1).as_bytes());
        assert_eq!(summary(&shop), FOR_REVIEW, "{to}");
    }
    // Where, by whom and why is for people to say.
    let own =
        text.replace("who = \"Ann\"", "who = \"Ann and Bob\"").replace("at = \"line", "at = \"about line");
    shop.write("macroglot.toml", own.as_bytes());
    assert_eq!(summary(&shop), ALL_ACCEPTED);
}

/// A program that asks something else than what was accepted is told nothing of that.
#[test]
fn another_question_is_no_stale_answer() {
    let shop = accepted();
    shop.write("programs/asks.nc", ASKS.replace("#100", "#101").as_bytes());
    let run = shop.run("convert");
    let told = |code: &str| {
        run.out.split(code).nth(1).unwrap().split("\n\n").next().unwrap().contains("It was accepted")
    };
    assert!(told("review MG0314") && !told("review MG0404"), "{}", run.out);
    assert!(
        run.err.contains("1 [[accepted]] entry matches nothing") && run.err.contains("MG0404"),
        "{}",
        run.err
    );
    let run = shop.run("accept --all --who Bob");
    assert!(run.out.ends_with("1 accepted, 1 renewed, 1 dropped\n"), "{}", run.out);
}

/// Which program a computed number calls is not known: a change of any asks again.
#[test]
fn a_computed_call_reaches_all_programs() {
    let shop = shop();
    shop.write("programs/asks.nc", ASKS.replace("P9000", "P#501").as_bytes());
    assert_eq!(shop.run("accept --all --who Ann").code, 0);
    assert!(summary(&shop).contains("1 accepted, 0 for review"));
    shop.write("programs/below.nc", BELOW.replace("Y2.", "Y3.").as_bytes());
    assert!(summary(&shop).contains("1 for review"), "{}", summary(&shop));
}

#[test]
fn a_refusal_stays_a_refusal() {
    let shop = shop();
    shop.write("programs/asks.nc", ASKS.replace("M30", "M38\nM30").as_bytes());
    let run = shop.run("accept --all --who Ann");
    assert_eq!(run.code, 0);
    assert_eq!(
        run.out,
        "0 accepted, 0 renewed, 0 dropped; 1 program refused, of which nothing is accepted\n"
    );
    assert_eq!(shop.read("macroglot.toml"), PROJECT);
    for (code, words) in [
        ("MG0301", &["MG0301", "error"][..]),
        ("MG0801", &["MG0801", "do not do the same"]),
        ("MG0201", &["MG0201", "profile"]),
        ("MG0904", &["MG0904", "checks.allow"]),
        ("MG0350", &["MG0350", "note"]),
        ("MG7", &["MG7", "no code"]),
    ] {
        shop.fails(&format!("accept --code {code} --who Ann"), words);
    }
    // Neither by hand: the program that was accepted and is refused now stays so, and its entries stay for later.
    let shop = accepted();
    let text = shop.read("macroglot.toml");
    shop.write("programs/asks.nc", ASKS.replace("M30", "M38\nM30").as_bytes());
    let run = shop.run("convert");
    assert_eq!(run.code, 1);
    assert!(
        run.out.ends_with("3 converted, 0 for review, 1 refused; 3 verified, 0 undecided, 0 different\n"),
        "{}",
        run.out
    );
    assert_eq!(run.err, "", "they are not told of as entries that match nothing");
    assert!(summary(&shop).contains(ASKED_AGAIN));
    assert_eq!(shop.run("accept --all --who Bob").code, 0);
    assert_eq!(shop.read("macroglot.toml"), text);
}

#[test]
fn selectors_say_what_is_accepted() {
    let shop = shop();
    shop.write("programs/job/two.nc", ASKS.replace("O2000", "O2001").as_bytes());
    shop.fails("accept --who Ann", &["--code", "--program", "--all"]);
    shop.fails("accept --all", &["--who", "MACROGLOT_WHO"]);
    shop.fails("accept nowhere.nc --who Ann", &["nowhere.nc"]);
    shop.fails("accept --all --library lost --who Ann", &["lost"]);
    shop.fails("accept --all --to lost --who Ann", &["lost"]);
    let before = shop.files();
    let tried = shop.run("accept --all --dry-run");
    assert!(tried.out.ends_with("4 accepted, 0 renewed, 0 dropped (nothing was written)\n"), "{}", tried.out);
    assert!(shop.files() == before, "a dry run writes nothing");
    let counts = |line: &str| {
        let out = shop.run(line).out;
        out.lines().last().unwrap_or_default().to_owned()
    };
    let of = |line: &str| counts(&format!("accept {line} --dry-run"));
    assert!(of("programs/asks.nc").starts_with("2 accepted"));
    assert!(of("programs/job").starts_with("2 accepted"));
    assert!(of("--code MG0314").starts_with("2 accepted"));
    assert!(of("--code mg03,MG0404 --program O2001").starts_with("2 accepted"));
    assert!(of("--program O2001 --code MG0404").starts_with("1 accepted"));
    assert!(of("--all --library shop --to new").starts_with("4 accepted"));
    let none = shop.run("accept --program O9999 --who Ann");
    assert_eq!(
        (none.code, none.out.as_str()),
        (1, "0 accepted, 0 renewed, 0 dropped; 4 questions are still open\n")
    );
    assert_eq!(
        counts("accept --program O2001 --who Ann"),
        "2 accepted, 0 renewed, 0 dropped; 2 questions are still open"
    );
    assert!(summary(&shop).contains("1 accepted, 1 for review"), "{}", summary(&shop));
    let empty = Shop::with(&[("a.nc", CLEAN)]);
    empty.fails("accept --all --who Ann", &["macroglot.toml"]);
}

#[test]
fn what_matches_nothing_is_told_once_and_dropped() {
    let shop = accepted();
    shop.write("programs/asks.nc", CLEAN.replace("O1234", "O2000").as_bytes());
    let run = shop.run("convert");
    assert_eq!(run.code, 0, "{}", run.out);
    assert_eq!(run.err.matches("[[accepted]]").count(), 1, "{}", run.err);
    assert!(
        run.err.contains("2 [[accepted]] entries match nothing")
            && run.err.contains("programs/asks.nc O2000")
    );
    assert!(run.out.contains("4 converted, 0 for review"), "{}", run.out);
    // The verifier may ask what is not asked here.
    assert_eq!(shop.run("convert --no-verify").err, "");
    let run = shop.run("accept --all --who Ann");
    assert!(run.out.ends_with("0 accepted, 0 renewed, 2 dropped\n"), "{}", run.out);
    assert_eq!(shop.read("macroglot.toml"), PROJECT, "to the byte");
}

#[test]
fn a_malformed_entry_is_an_error_with_its_place() {
    let shop = accepted();
    let text = shop.read("macroglot.toml");
    let hash = text.split("hash = \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    let line_of = |key: &str| 1 + text.lines().position(|line| line.starts_with(key)).unwrap();
    let day = text.lines().find(|line| line.starts_with("when = ")).unwrap();
    for (from, to, key, words) in [
        ("code = \"MG0314\"", "code = \"MG0301\"", "code = \"MG0314\"", &["MG0301", "error"][..]),
        ("code = \"MG0314\"", "code = \"MG0801\"", "code = \"MG0314\"", &["MG0801", "cannot be accepted"]),
        ("code = \"MG0314\"", "code = \"0314\"", "code = \"MG0314\"", &["'0314' is no code"]),
        ("who = \"Ann\"", "who = \" \"", "who = ", &["who accepted it"]),
        (day, "when = 2026-11-26T10:00:00Z", "when = ", &["a day"]),
        (day, "when = 2026-02-30", "when = ", &[]),
        (day, "when = \"May\"", "when = ", &[]),
        (hash.as_str(), "1234", "hash = ", &["'1234' is no hash"]),
        ("target = ", "targets = ", "target = ", &["targets"]),
        ("at = ", "why = \"again\"\nat = ", "[[accepted]]", &["duplicate key"]),
    ] {
        shop.write("macroglot.toml", text.replacen(from, to, 1).as_bytes());
        let place = match key {
            "[[accepted]]" => "macroglot.toml:".to_owned(),
            key => format!("macroglot.toml:{}:", line_of(key)),
        };
        let words: Vec<&str> = words.iter().copied().chain([place.as_str()]).collect();
        for command in ["convert", "check", "accept --all --who Bob"] {
            shop.fails(command, &words);
        }
    }
}

#[test]
fn reports_say_what_was_accepted() {
    let shop = accepted();
    let run = shop.run("convert --format json --report r.sarif --report r.html --report r.md");
    assert_eq!(run.code, 0, "{}", run.err);
    let json: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((&json["totals"]["accepted"], &json["totals"]["review"]), (&1.into(), &0.into()));
    let programs = json["programs"].as_array().unwrap();
    let asks = programs.iter().find(|program| program["program"] == "O2000").unwrap();
    assert_eq!(asks["outcome"], "accepted");
    let findings = asks["diagnostics"].as_array().unwrap();
    let of = |code: &str| findings.iter().find(|finding| finding["code"] == code).unwrap();
    for code in ["MG0314", "MG0404"] {
        assert_eq!(of(code)["severity"], "note");
        assert_eq!(
            (&of(code)["accepted"]["who"], &of(code)["accepted"]["why"]),
            (&"Ann".into(), &"measured".into())
        );
        assert_eq!(of(code)["accepted"]["when"].as_str().unwrap().len(), "2026-11-26".len());
    }
    super::sarif::valid(&shop.read("r.sarif"));
    let sarif: Value = serde_json::from_str(&shop.read("r.sarif")).unwrap();
    let results = sarif["runs"][0]["results"].as_array().unwrap();
    for result in results {
        let all = result["suppressions"].as_array().expect("all say it, or none");
        let is_one = ["MG0314", "MG0404"].contains(&result["ruleId"].as_str().unwrap());
        assert_eq!(all.len(), usize::from(is_one), "{result}");
        for one in all {
            assert_eq!((&one["kind"], &one["status"]), (&"external".into(), &"accepted".into()));
            assert!(one["justification"].as_str().unwrap().starts_with("accepted by Ann on 20"), "{one}");
        }
    }
    let page = shop.read("r.html");
    assert!(
        page.contains("class=\"outcome accepted\">accepted</span>") && page.contains("accepted by Ann on 20")
    );
    assert!(page.contains("<td class=\"accepted\">accepted<td>1<td>"), "the first page counts it");
    let markdown = shop.read("r.md");
    assert!(markdown.contains("\n## Accepted\n\n- **MG0314**") && markdown.contains("accepted by Ann on 20"));
    assert!(!markdown.contains("- [ ] **MG0314**"), "{markdown}");
    // Who accepts nothing gets no empty lists.
    shop.write("macroglot.toml", PROJECT.as_bytes());
    shop.run("convert --report r.sarif");
    assert!(!shop.read("r.sarif").contains("suppressions"));
}

/// An answer is one for a library and a machine.
#[test]
fn each_library_and_machine_has_its_own_answers() {
    let both = format!(
        "{PROJECT}other = \"out2\"\n[machines.other]\ndialect = \"haas\"\nprofile = \"other.toml\"\n\
         [libraries.more]\npath = \"more\"\nmachine = \"old\"\n[libraries.more.targets]\nnew = \"out3\"\n"
    );
    let shop = Shop::with(&[
        ("macroglot.toml", &both),
        ("old.toml", OLD),
        ("new.toml", NEW),
        ("other.toml", NEW),
        ("programs/asks.nc", ASKS),
        ("programs/called.nc", CALLED),
        ("programs/below.nc", BELOW),
        ("more/asks.nc", ASKS),
        ("more/called.nc", CALLED),
        ("more/below.nc", BELOW),
    ]);
    let run = shop.run("accept --all --library shop --to new --who Ann");
    assert!(run.out.ends_with("2 accepted, 0 renewed, 0 dropped\n"), "{}{}", run.out, run.err);
    assert!(summary(&shop).contains("1 accepted, 2 for review"), "{}", summary(&shop));
    let run = shop.run("accept more --who Ann");
    assert!(run.out.contains("more/asks.nc O2000, more to new: MG0404"), "{}", run.out);
    assert!(
        run.out.ends_with("2 accepted, 0 renewed, 0 dropped; 2 questions are still open\n"),
        "{}",
        run.out
    );
    assert!(summary(&shop).contains("2 accepted, 1 for review"), "{}", summary(&shop));
    assert_eq!(shop.run("accept --all --who Bob").code, 0);
    assert!(summary(&shop).contains("3 accepted, 0 for review"), "{}", summary(&shop));
    // What is converted for one machine alone says nothing of the entries for another.
    let third = "third = \"out4\"\nother = ";
    let with = shop.read("macroglot.toml").replace("other = ", third);
    shop.write("macroglot.toml", format!("{with}\n[machines.third]\ndialect = \"cc100\"\n").as_bytes());
    let run = shop.run("convert --to cc100");
    assert!(run.out.contains("O2000") && !run.err.contains("[[accepted]]"), "{}{}", run.out, run.err);
    // A library that is gone has entries that match nothing.
    let gone = shop.read("macroglot.toml").replace("libraries.more", "libraries.renamed");
    shop.write("macroglot.toml", gone.as_bytes());
    let run = shop.run("convert");
    assert!(run.err.contains("2 [[accepted]] entries match nothing"), "{}", run.err);
}

/// A macro that several folders share is asked about once for all of them, if it rests on the same.
#[test]
fn a_shared_program_has_one_answer() {
    let project = PROJECT
        .replace("machine = \"old\"", "machine = \"old\"\napart = true\nshared = [\"programs/macros\"]");
    let shop = Shop::with(&[
        ("macroglot.toml", &project),
        ("old.toml", OLD),
        ("new.toml", NEW),
        ("programs/job1/a.nc", CLEAN),
        ("programs/job2/a.nc", CLEAN),
        ("programs/macros/asks.nc", ASKS),
        ("programs/macros/called.nc", CALLED),
        ("programs/macros/below.nc", BELOW),
    ]);
    let run = shop.run("accept --all --who Ann");
    assert!(run.out.contains("programs/macros/asks.nc O2000"), "{}{}", run.out, run.err);
    assert!(run.out.contains("2 accepted, 0 renewed, 0 dropped"), "{}", run.out);
    assert!(summary(&shop).contains("2 accepted, 0 for review"), "{}", summary(&shop));
    shop.write("programs/macros/below.nc", BELOW.replace("Y2.", "Y4.").as_bytes());
    assert!(summary(&shop).contains("2 for review"), "{}", summary(&shop));
    let run = shop.run("accept --all --who Ann");
    assert!(run.out.contains("0 accepted, 2 renewed, 0 dropped"), "{}", run.out);
    assert!(summary(&shop).contains("2 accepted, 0 for review"), "{}", summary(&shop));
}

/// What reading asks of a program itself is not asked by `check` either, once it is accepted for every machine.
#[test]
fn check_honours_what_is_accepted() {
    let twice = "%\nO3000\nG20 G17 G90 G40 G80 G94 G54\nIF[#500EQ1]GOTO10\nN10 G0 X1.\nN10 G0 X2.\nM30\n%\n";
    let shop = Shop::with(&[
        ("macroglot.toml", PROJECT),
        ("old.toml", OLD),
        ("new.toml", NEW),
        ("programs/twice.nc", twice),
    ]);
    let line = "check --only read --cache cache";
    let run = shop.run(line);
    assert!(run.code == 1 && run.out.contains("MG0311"), "{}", run.out);
    assert_eq!(shop.run("accept --code MG0311 --who Ann").code, 0);
    let run = shop.run(line);
    assert_eq!(run.code, 0, "{}", run.out);
    let json: Value = serde_json::from_str(&shop.run(&format!("{line} --format json")).out).unwrap();
    assert_eq!(json["suppressed"][0]["code"], "MG0311");
    assert!(json["suppressed"][0]["reason"].as_str().unwrap().starts_with("accepted by Ann on 20"), "{json}");
    shop.write("programs/twice.nc", twice.replace("X2.", "X3.").as_bytes());
    assert_eq!(shop.run(line).code, 1);
}

/// What people write is text in the file and on the terminal.
#[test]
fn words_of_people_are_text() {
    let shop = shop();
    let mut command = assert_cmd::Command::cargo_bin("macroglot").unwrap();
    command.args(["accept", "--all", "--who", "Änn \"]]\u{1b}[31m", "--why", "a\nb = 1\n[[accepted]] # '''"]);
    let output = command.current_dir(shop.path("")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let run = shop.run("convert --report r.html");
    assert!(!run.out.contains('\u{1b}') && !shop.read("macroglot.toml").contains('\u{1b}'));
    assert!(run.out.contains("1 accepted, 0 for review"), "{}", run.out);
    shop.write("programs/asks.nc", CLEAN.replace("O1234", "O2000").as_bytes());
    shop.run("accept --all --who Bob");
    assert_eq!(shop.read("macroglot.toml"), PROJECT);
}

/// Entries that a person wrote in another form are honoured; they are not changed, and nothing is lost.
#[test]
fn entries_in_another_form_are_left_alone() {
    let shop = accepted();
    let text = shop.read("macroglot.toml");
    let entries: Vec<&str> = text.split("[[accepted]]\n").skip(1).collect();
    let inline = entries.iter().map(|entry| format!("{{ {} }}", entry.trim().replace('\n', ", ")));
    let inline = format!("accepted = [{}]\n{PROJECT}", inline.collect::<Vec<_>>().join(", "));
    shop.write("macroglot.toml", inline.as_bytes());
    assert_eq!(summary(&shop), ALL_ACCEPTED);
    shop.write("programs/more.nc", ASKS.replace("O2000", "O2002").as_bytes());
    shop.fails("accept --all --who Bob", &["macroglot.toml", "[[accepted]]"]);
    shop.write("programs/asks.nc", ASKS.replace("Y4.", "Y5.").as_bytes());
    let run = shop.run("accept programs/asks.nc --who Bob");
    assert!(run.out.contains("0 accepted, 2 renewed, 0 dropped"), "{}{}", run.out, run.err);
}
