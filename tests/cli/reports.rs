//! Reports, and what scripts read.

use super::{CLEAN, REFUSED, Run, Shop};
use serde_json::Value;

fn shop() -> Shop {
    Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", REFUSED)])
}

fn convert(shop: &Shop, rest: &str) -> Run {
    let run = shop.run(&format!("convert in --from fanuc --to haas --out out {rest}"));
    assert_eq!(run.code, 1, "{}", run.err);
    run
}

#[test]
fn json_has_the_keys_of_the_contract() {
    let shop = shop();
    let run = convert(&shop, "--format json --report r.json");
    assert_eq!(run.err, "", "with JSON on standard output, standard error is quiet");
    assert_eq!(run.out, shop.read("r.json"));
    let json: Value = serde_json::from_str(&run.out).unwrap();
    let programs = json["programs"].as_array().unwrap();
    let a = &programs[0];
    assert_eq!((&a["source"], &a["target"]), (&"in/a.nc".into(), &"out/a.nc".into()));
    assert_eq!((&a["program"], &a["outcome"]), (&"O1234".into(), &"converted".into()));
    assert_eq!(a["diagnostics"], Value::Array(vec![]));
    let b = &programs[1];
    assert_eq!((&b["source"], &b["target"]), (&"in/b.nc".into(), &Value::Null));
    assert_eq!((&b["program"], &b["outcome"]), (&"O1235".into(), &"refused".into()));
    let d = &b["diagnostics"][0];
    assert_eq!((&d["code"], &d["severity"]), (&"MG0301".into(), &"error".into()));
    assert_eq!((&d["file"], &d["line"], &d["column"]), (&"in/b.nc".into(), &5.into(), &1.into()));
    assert!(d["message"].as_str().unwrap().contains("M38"));
    let totals = &json["totals"];
    for (key, count) in [("files", 2), ("programs", 2), ("converted", 1), ("review", 0), ("refused", 1)] {
        assert_eq!(totals[key], count, "{key}");
    }
}

/// What rests on a computation that became several blocks stands at its block, and what the machine has to settle says
/// where it is written down.
#[test]
fn findings_stand_at_their_blocks_and_say_what_settles_them() {
    let shop = Shop::with(&[("in/a.nc", "O1\nG20\n#1=FUP[#500]\nG10L12P5R.25\nM30\n")]);
    let run = shop.run("convert in --from fanuc --to haas --out out --format json");
    let json: Value = serde_json::from_str(&run.out).unwrap();
    let all = json["programs"][0]["diagnostics"].as_array().unwrap();
    let of = |text: &str| all.iter().find(|d| d["message"].as_str().unwrap().contains(text)).unwrap();
    assert_eq!(of("'behaviour:vacant.arithmetic.zero' is common knowledge for the target")["line"], 3);
    let table = of("a setting of the target says whether its cutter table");
    assert_eq!(table["line"], 4);
    assert!(table["help"].as_str().unwrap().contains("'40' under [settings]"), "{table}");
}

/// What SARIF 2.1.0 requires, and what code hosts need to show a result beside its line.
#[test]
fn sarif_is_complete() {
    let shop = shop();
    let run = convert(&shop, "--format sarif --report r.sarif");
    assert_eq!(run.out, shop.read("r.sarif"));
    let log: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(log["version"], "2.1.0");
    assert!(log["$schema"].as_str().unwrap().contains("sarif-2.1.0"));
    let run = &log["runs"][0];
    let driver = &run["tool"]["driver"];
    assert_eq!(driver["name"], "macroglot");
    let rules = driver["rules"].as_array().unwrap();
    assert!(rules.iter().all(|rule| rule["shortDescription"]["text"].is_string()));
    let results = run["results"].as_array().unwrap();
    assert_eq!(results.len(), 1);
    let result = &results[0];
    assert_eq!(rules[result["ruleIndex"].as_u64().unwrap() as usize]["id"], result["ruleId"]);
    assert_eq!((&result["ruleId"], &result["level"]), (&"MG0301".into(), &"error".into()));
    assert!(result["message"]["text"].as_str().unwrap().contains("M38"));
    let place = &result["locations"][0]["physicalLocation"];
    assert_eq!(place["artifactLocation"]["uri"], "in/b.nc");
    assert_eq!((&place["region"]["startLine"], &place["region"]["startColumn"]), (&5.into(), &1.into()));
    assert_eq!((&place["region"]["endLine"], &place["region"]["endColumn"]), (&5.into(), &4.into()));
    crate::sarif::valid(&log.to_string());
}

/// Columns count code points as the file says; a byte that is no letter of UTF-8 is one, as viewers show it.
#[test]
fn sarif_counts_code_points() {
    let shop = Shop::empty();
    shop.write(
        "in/b.nc",
        b"\xEF\xBB\xBF%\nO1\rG20 G17 G90 G40 G80 G94\r\n(T\xC3\x9CR \xE6\x97\xA5 \xDC) M38\rM30\n",
    );
    let run = convert(&shop, "--format sarif");
    let log: Value = serde_json::from_str(&run.out).unwrap();
    let run = &log["runs"][0];
    assert_eq!((&run["columnKind"], &run["defaultEncoding"]), (&"unicodeCodePoints".into(), &"UTF-8".into()));
    assert_eq!(run["newlineSequences"], serde_json::json!(["\r\n", "\n", "\r"]));
    let found = |result: &&Value| result["message"]["text"].as_str().unwrap().contains("M38");
    let result = run["results"].as_array().unwrap().iter().find(found).unwrap();
    // In front of M38: bracket, T, Ü, R, blank, 日, blank, the wrong byte, bracket, blank.
    let region = serde_json::json!({"startLine": 4, "startColumn": 11, "endLine": 4, "endColumn": 14});
    assert_eq!(result["locations"][0]["physicalLocation"]["region"], region);
    crate::sarif::valid(&log.to_string());
}

/// A code host takes a result for the same after lines were put before it, and shows where a jump goes.
#[test]
fn sarif_results_are_known_again_and_jumps_are_followed() {
    let text = "O1\nG21 G17 G90 G40 G80 G94\nN10 G0 X1.\nM38\nIF [#500 EQ 1] GOTO 10\nM38\nN10 M30\n";
    let moved = text.replacen("N10", "(ONE)\n(TWO)\nN10", 1);
    let all = |text: &str| {
        let shop = Shop::with(&[("in/a.nc", text)]);
        let run = shop.run("convert in --from fanuc --to haas --format sarif --no-verify");
        let log: Value = serde_json::from_str(&run.out).unwrap();
        crate::sarif::valid(&run.out);
        log["runs"][0]["results"].as_array().unwrap().clone()
    };
    let (before, after) = (all(text), all(&moved));
    let key = |result: &Value| result["partialFingerprints"]["macroglot/v1"].as_str().unwrap().to_owned();
    let keys = |results: &[Value]| results.iter().map(key).collect::<Vec<_>>();
    assert_eq!(keys(&before), keys(&after));
    let unmapped: Vec<&Value> = before.iter().filter(|result| result["ruleId"] == "MG0301").collect();
    assert_eq!(unmapped.len(), 2);
    assert!(key(unmapped[0]).ends_with(":1") && key(unmapped[1]).ends_with(":2"), "two of one kind");
    let flow =
        before.iter().find_map(|result| result["codeFlows"][0]["threadFlows"][0]["locations"].as_array());
    let flow = flow.expect("a finding at the jump");
    let line = |at: usize| flow[at]["location"]["physicalLocation"]["region"]["startLine"].as_u64();
    assert_eq!((line(0), line(1)), (Some(5), Some(3)), "from the jump to its label");
}

#[test]
fn reports_for_people_show_each_program_with_its_lines() {
    let shop = shop();
    convert(&shop, "--report r.md --report r.html --report r.txt --quiet");
    insta::assert_snapshot!("report_markdown", shop.read("r.md"));
    insta::assert_snapshot!("report_text", shop.read("r.txt"));
    let html = shop.read("r.html");
    assert_eq!(html.matches("<details class=\"program\"").count(), 2);
    assert!(html.contains("data-outcome=\"refused\" data-codes=\"MG0301\""));
    // The line, and the finding below it.
    let line = html.find("<td>5<td>M38").expect("the line");
    let finding = html[line..].find("error, line 5: the table of this control has no code M38");
    assert!(finding.is_some_and(|at| at < 200), "the finding stands at its line");
    assert!(html.contains("<section id=\"MG0301\">"), "the page of its code is there");
    assert!(html.contains("scenarios tried") && html.contains("<svg role=\"img\""));
    assert!(!html.contains("http:") && !html.contains("https:"), "nothing beside the file is needed");
}

/// What was refused, a draft, and what was never verified are each told as such.
#[test]
fn a_report_says_what_was_not_shown() {
    let shop = shop();
    convert(&shop, "--report r.html --no-verify --draft");
    let html = shop.read("r.html");
    assert!(html.contains("No program was verified.") && !html.contains("Both machines did the same"));
    assert!(html.contains("1 program: it was not verified (<a href=\"#p1\">a.nc O1234</a>)"));
    assert!(html.contains("a draft with an alarm at every hole; it is no conversion"));
    let empty = Shop::with(&[("in/a.nc", "(NOTHING)\n")]);
    let run = empty
        .run("convert in --from fanuc --to haas --out out --report r.html --report r.md --report r.sarif");
    assert!(run.code < 2, "{}", run.err);
    assert!(empty.read("r.html").contains("</html>"));
}

/// A target that stops before its source shows nothing of what comes then, and the report does not say that it does.
#[test]
fn a_run_that_was_cut_short_is_told_as_such() {
    let main = "O1001\nG20 G17 G90 G40 G80 G94\nG0 X0 Y0\nG1 X2. F10.\nG65 P1002 A3.\nM30\n";
    let refused = "O1002\nG0 X#1\nM38\nM99\n";
    let shop = Shop::with(&[("in/a.nc", main), ("in/b.nc", refused)]);
    let run = shop.run("convert in --from fanuc --to haas --out out --report r.html");
    assert_eq!(run.code, 1, "{}", run.err);
    let html = shop.read("r.html");
    let first = html.split("<details class=\"program\"").nth(1).unwrap();
    assert!(first.contains("They did not both run to their ends") && !first.contains("In this run no move"));
    assert!(first.contains("nothing could be compared to the end") && !first.contains("Largest distance"));
}

/// What changes every move if the answer is no is asked first, and facts of tables last.
#[test]
fn the_most_dangerous_question_comes_first() {
    let text = "O1\nG17 G90 G40 G80 G94\n#100=#4001 AND 3\nG0 X1.\nM30\n";
    let shop = Shop::with(&[("in/a.nc", text)]);
    shop.run("convert in --from fanuc --to haas --out out --report r.html --report r.md --no-verify");
    let last = "bits.of.fraction";
    for (report, first) in [("r.html", "no G20 or G21"), ("r.md", "no G20 or G21")] {
        let text = shop.read(report);
        let at = |words| text.find(words).unwrap_or_else(|| panic!("{report}: {words}"));
        assert!(at(first) < at(last), "{report}");
    }
}

/// Several libraries in one report: each has its machines, and programs have one name each in the page.
#[test]
fn a_report_has_all_libraries_of_a_run() {
    let project = "[machines.a]\ndialect = \"fanuc\"\n[machines.b]\ndialect = \"haas\"\n[machines.c]\ndialect = \"fadal\"\n\
                   [libraries.one]\npath = \"in\"\nmachine = \"a\"\n[libraries.one.targets]\nb = \"to-b\"\nc = \"to-c\"\n";
    let shop = Shop::with(&[("macroglot.toml", project), ("in/a.nc", CLEAN), ("in/b.nc", REFUSED)]);
    let run = shop.run("convert --report r.html --report r.md");
    assert_eq!(run.code, 1, "{}", run.err);
    let html = shop.read("r.html");
    assert!(
        html.contains("Library 1: fanuc to haas") && html.contains("Library 2: fanuc to fadal"),
        "{html}"
    );
    for id in ["p1", "p2", "p3", "p4"] {
        assert_eq!(html.matches(&format!(" id=\"{id}\"")).count(), 1, "{id}");
    }
    // Asked once, of the source's program that goes to two machines.
    assert_eq!(html.matches("<p>the table of this control has no code M38</p>").count(), 1);
}

/// A program of 10,000 lines is shown in part, and what is left out is counted.
#[test]
fn a_long_program_is_shown_in_part() {
    let moves: String = (1..10_000).map(|at| format!("G1 X{at}. F10.\n(L{at})\n")).collect();
    let text = format!("O1\nG20 G17 G90 G40 G80 G94\n{moves}M38\nM30\n");
    let shop = Shop::with(&[("in/a.nc", &text)]);
    let run = shop.run("convert in --from fanuc --to fadal --out out --report r.html --no-verify");
    assert_eq!(run.code, 1, "{}", run.err);
    let html = shop.read("r.html");
    assert!(html.len() < 600_000, "{}", html.len());
    let finding = "error, line 20001: the table of this control has no code M38";
    assert!(html.contains(finding) && html.contains(" as before"), "folded, and the finding is there");
    let changed = text.replace("M38\n", "");
    let shop = Shop::with(&[("in/a.nc", &changed)]);
    shop.run("convert in --from fanuc --to fadal --out out --report r.html --no-verify");
    let html = shop.read("r.html");
    assert!(html.contains("more lines, which the files have") && html.len() < 700_000, "{}", html.len());
}

/// A merge request takes 65,536 letters; the last line says what is not there.
#[test]
fn markdown_is_no_longer_than_a_host_shows() {
    let shop = Shop::empty();
    (1..1500).for_each(|number| {
        let text = format!("O{number:04}\nG21\nM38\nM30\n");
        shop.write(&format!("in/a-long-name-of-a-program-{number:04}.nc"), text.as_bytes());
    });
    shop.run("convert in --from fanuc --to haas --out out --report r.md --no-verify --quiet");
    let text = shop.read("r.md");
    assert!(text.len() <= 65_536 && text.len() > 60_000, "{}", text.len());
    assert!(
        text.trim_end().ends_with("a report that ends in .html has all.**"),
        "{}",
        &text[text.len() - 200..]
    );
}

#[test]
fn nothing_of_a_program_is_markup() {
    let hostile = REFUSED.replace("M38", "M38 (<script>alert(1)</script> ``` [x](y))");
    let shop = Shop::with(&[("in/<b>.nc", &hostile)]);
    convert(&shop, "--report r.html --report r.md --quiet");
    let html = shop.read("r.html");
    assert!(!html.contains("<script>alert") && !html.contains("<b>.nc") && html.contains("&lt;script&gt;"));
    assert_eq!(html.matches("<script").count(), 2, "its data and its own script");
    let markdown = shop.read("r.md");
    assert!(!markdown.contains("<script") && !markdown.contains("<b>"));
}

#[test]
fn a_report_of_no_known_kind_is_refused_before_anything_is_written() {
    let shop = shop();
    let line = "convert in --from fanuc --to haas --out out";
    shop.fails(&format!("{line} --report r.pdf"), &["r.pdf", ".sarif"]);
    shop.fails(&format!("{line} --report r"), &["ending"]);
    shop.fails(&format!("{line} --report r.json --report r.json"), &["twice"]);
    shop.fails(&format!("{line} --report in/b.nc"), &["b.nc"]);
}

/// A program whose verification has no time left is undecided, and written all the same.
#[test]
fn time_that_is_up_decides_nothing() {
    let shop = Shop::with(&[("in/a.nc", CLEAN), ("in/b.nc", &CLEAN.replace("O1234", "O1235"))]);
    let line = "convert in --from fanuc --to haas --out out";
    for time in ["--program-seconds 0", "--library-seconds 0"] {
        let run = shop.run(&format!("{line} {time}"));
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(run.out.contains("0 verified, 2 undecided"), "{}", run.out);
        assert!(run.out.contains("the processor time for its verification is up"), "{}", run.out);
        assert!(shop.read("out/a.nc.certificate.json").contains("\"out_of_time\""));
    }
    assert!(shop.run(&format!("{line} --program-seconds 1000")).out.contains("2 verified"));
    assert_eq!(shop.run(&format!("{line} --program-seconds x")).code, 2);
}

/// What concerns every program of a control that is new here is said once for a library, if anything is written.
#[test]
fn what_is_new_of_a_control_is_said_once() {
    let shop =
        Shop::with(&[("in/a.nc", CLEAN), ("in/c.nc", "O7\nG21G90G0X1.\nM30\n"), ("bad/b.nc", REFUSED)]);
    let new = "cc100: programs for this control are new in macroglot";
    let run = shop.run("convert in --from fanuc --to cc100 --out out --report r.md --report r.html");
    assert_eq!(run.out.matches(new).count(), 1, "{}", run.out);
    for report in ["r.md", "r.html"] {
        assert_eq!(shop.read(report).matches(new).count(), 1, "{report}");
    }
    let run = shop.run("convert in --from fanuc --to cc100 --out out --format json");
    let json: Value = serde_json::from_str(&run.out).unwrap();
    assert!(json["notes"][0].as_str().unwrap().starts_with(new), "{}", json["notes"]);
    let none = shop.run("convert bad --from fanuc --to cc100 --out other");
    assert!(!none.out.contains(new), "{}", none.out);
    let known = shop.run("convert in --from fanuc --to haas --out third");
    assert!(!known.out.contains("new in macroglot"), "{}", known.out);
}

/// What is asked of a machine stands once, however many programs it concerns; its lines, pasted into a profile, answer it.
#[test]
fn each_question_is_asked_once_with_the_lines_that_answer_it() {
    let text = "O1001\nG21 G17 G90 G94 G40 G49 G80 G54 G98\nG0 X1.\n#100=#4001 AND 3\nM38\nM30\n";
    let files = ["O1001", "O1002", "O1003", "O1004"].map(|name| text.replace("O1001", name));
    let [a, b, c, d] = &files;
    let shop = Shop::with(&[("in/a.nc", a), ("in/b.nc", b), ("in/c.nc", c), ("in/d.nc", d)]);
    let line = "convert in --from fanuc --to haas --out out --no-verify";
    let run = shop.run(line);
    let wanted = "error MG0301: unknown meaning\n  the table of this control has no code M38\n      \
        4 programs: a.nc:5, b.nc:5, c.nc:5, ...\n      5 | M38\n";
    assert!(run.out.contains(wanted), "{}", run.out);
    let asked = "\"behaviour:bits.of.fraction\", # ";
    assert_eq!(run.out.matches(asked).count(), 1, "{}", run.out);
    assert!(run.out.contains("(4 programs: a.nc:4, b.nc:4, c.nc:4, ...)\n"), "{}", run.out);
    let head = "a profile for the Fanuc Custom Macro B, which --machine or macroglot.toml names (dialect = \"fanuc\"):\n";
    let (_, lines) = run.out.split_once(head).unwrap();
    let lines: String =
        lines.lines().take_while(|line| line.starts_with("  ")).map(|line| format!("{line}\n")).collect();
    assert!(lines.starts_with("  confirm = [\n") && lines.contains("\n  ]\n"), "{lines}");
    shop.write("fanuc.toml", format!("dialect = \"fanuc\"\n{lines}").as_bytes());
    let run = shop.run(&format!("{line} --machine fanuc.toml"));
    assert!(!run.out.contains("bits.of.fraction"), "{}", run.out);
}
