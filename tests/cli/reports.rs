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
    assert_eq!(of("'behaviour:fix.toward.zero' for the target")["line"], 3);
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
    // The library's types for the format read it, too.
    serde_json::from_value::<serde_sarif::sarif::Sarif>(log).unwrap();
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
    serde_json::from_value::<serde_sarif::sarif::Sarif>(log).unwrap();
}

#[test]
fn reports_for_people_show_each_program_with_its_lines() {
    let shop = shop();
    convert(&shop, "--report r.md --report r.html --report r.txt --quiet");
    insta::assert_snapshot!("report_markdown", shop.read("r.md"));
    insta::assert_snapshot!("report_text", shop.read("r.txt"));
    let html = shop.read("r.html");
    assert_eq!(html.matches("<section>").count(), 2);
    assert!(html.contains("<p class=\"outcome refused\">refused</p>"));
    assert!(html.contains("error MG0301, line 5, column 1") && html.contains("<pre>M38</pre>"));
    assert!(!html.contains("http"), "nothing beside the file is needed");
}

#[test]
fn nothing_of_a_program_is_markup() {
    let hostile = REFUSED.replace("M38", "M38 (<script>alert(1)</script> ``` [x](y))");
    let shop = Shop::with(&[("in/<b>.nc", &hostile)]);
    convert(&shop, "--report r.html --report r.md --quiet");
    let html = shop.read("r.html");
    assert!(!html.contains("<script") && !html.contains("<b>") && html.contains("&lt;script&gt;"));
    let markdown = shop.read("r.md");
    for line in markdown.lines().filter(|line| line.contains("<script")) {
        assert!(line.starts_with("      "), "outside an indented block: {line}");
    }
    assert!(!markdown.contains("<b>"));
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
    let text = "O1001\nG21 G17 G90 G94 G40 G49 G80 G54 G98\nG0 X1.\nG4 P500\nM38\nM30\n";
    let files = ["O1001", "O1002", "O1003", "O1004"].map(|name| text.replace("O1001", name));
    let [a, b, c, d] = &files;
    let shop = Shop::with(&[("in/a.nc", a), ("in/b.nc", b), ("in/c.nc", c), ("in/d.nc", d)]);
    let line = "convert in --from fanuc --to haas --out out --no-verify";
    let run = shop.run(line);
    let wanted = "error MG0301: unknown meaning\n  the table of this control has no code M38\n      \
        4 programs: a.nc:5, b.nc:5, c.nc:5, ...\n      5 | M38\n";
    assert!(run.out.contains(wanted), "{}", run.out);
    let asked = "\"behaviour:dwell.bare\", # ";
    assert_eq!(run.out.matches(asked).count(), 1, "{}", run.out);
    assert!(run.out.contains("(4 programs: a.nc:4, b.nc:4, c.nc:4, ...)\n"), "{}", run.out);
    let head = "a profile for the Fanuc Custom Macro B, which --machine or macroglot.toml names (dialect = \"fanuc\"):\n";
    let (_, lines) = run.out.split_once(head).unwrap();
    let lines: String =
        lines.lines().take_while(|line| line.starts_with("  ")).map(|line| format!("{line}\n")).collect();
    assert!(lines.starts_with("  confirm = [\n") && lines.contains("\n  ]\n"), "{lines}");
    shop.write("fanuc.toml", format!("dialect = \"fanuc\"\n{lines}").as_bytes());
    let run = shop.run(&format!("{line} --machine fanuc.toml"));
    assert!(!run.out.contains("dwell.bare"), "{}", run.out);
}
