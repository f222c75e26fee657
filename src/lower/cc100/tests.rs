use super::lower;
use crate::diag::{Code, Diagnostic, Severity};
use crate::dialect::{Control, registry};
use crate::ir::{Module, SourceInfo, text, validate};
use crate::lower::Lowered;
use crate::syntax::{ProgramName, parse_file};
use std::collections::BTreeSet;

fn lowered(source: &str, name: &str) -> Lowered {
    let parser = registry::find("cc100").unwrap().parse;
    let control = Control::plain("cc100").unwrap();
    lower(&parse_file(source.as_bytes(), parser), 0, name, &control)
}

/// The program's IR, spans left out, and what is reported, facts by name.
fn readable(lowered: Lowered) -> (Module, BTreeSet<String>) {
    let mut module = Module::default();
    let mut reported = BTreeSet::new();
    for (mut program, findings) in lowered.programs {
        program.site = SourceInfo::default();
        for block in &mut program.blocks {
            block.stmts.iter_mut().for_each(|stmt| stmt.site.span = Default::default());
            block.term.site.span = Default::default();
        }
        module.programs.push(program);
        reported.extend(findings.iter().map(finding));
    }
    (module, reported)
}

fn finding(found: &Diagnostic) -> String {
    match found.code {
        Code::UnconfirmedFact => format!("fact {}", found.message.split('\'').nth(1).unwrap()),
        code => code.number().to_owned(),
    }
}

#[test]
fn only_builders_codes_are_refused_in_the_course() {
    for (name, source) in crate::syntax::testing::programs("cc100") {
        let source = String::from_utf8(source).unwrap();
        let refused = lowered(&source, &name).programs.into_iter().flat_map(|(_, found)| found);
        let refused: Vec<String> = refused
            .filter(|found| found.severity() == Severity::Error)
            .map(|found| String::from_utf8_lossy(found.span.of(source.as_bytes())).into_owned())
            .collect();
        // M20, M38, M68 and M69 are the machine builder's (1122, 1128, 1587, 1592).
        let expected: &[&str] = match name.as_str() {
            "time-example.nc" => &["M68", "M69"],
            "problem9-ok.nc" | "problem9-angle.nc" => &["M20", "M38"],
            _ => &[],
        };
        assert_eq!(refused, expected, "{name}");
    }
}

#[test]
fn a_cycle_has_the_name_that_calls_it_and_its_end_returns() {
    let mut lowered = lowered("N1 G53\nN2 G55\nN3 M2\n", "cycle21.nc");
    let (program, findings) = lowered.programs.remove(0);
    assert_eq!(program.name, Some(ProgramName::Name("CYCLE21".into())));
    assert!(program.returns() && !program.ends());
    assert!(findings.is_empty());
}

#[test]
fn letters_keep_their_names() {
    let lowered = lowered("VX=1\nV1=VB\n", "program.nc");
    let names: Vec<(u32, &str)> =
        lowered.names.iter().map(|(var, name)| (var.number, name.as_str())).collect();
    assert_eq!(names, [(102, "VB"), (124, "VX")]);
}

#[test]
fn a_builders_code_counts_where_the_profile_gives_its_meaning() {
    let profile = "dialect = \"cc100\"\nunits = \"metric\"\n\
        [[site]]\ncode = \"M68\"\nop = \"spindle.orient\"\ntext = \"brings the head round\"\n";
    let control = Control::from_profile(profile).unwrap();
    let parser = registry::find("cc100").unwrap().parse;
    let source = b"M68\nTST QM\nBEQ P1\n$1\nM30\n";
    let (module, reported) = readable(lower(&parse_file(source, parser), 0, "program.nc", &control));
    let printed = text::print(&module);
    assert!(
        printed.contains("nc spindle.orient\n    jump block2") && !printed.contains("register"),
        "{printed}"
    );
    assert!(reported.is_empty(), "{reported:?}");
}

#[test]
fn long_lines_and_many_jumps_take_no_time() {
    let line = "X=V1 ".repeat(20_000);
    let jumps: String = (0..3_000).map(|n| format!("TST V1\nBEQ V2\nG22 P{n}\n${n}\nG99\n")).collect();
    for source in [line, jumps] {
        let started = std::time::Instant::now();
        let (module, _) = readable(lowered(&source, "program.nc"));
        assert!(validate(&module).is_ok());
        assert!(started.elapsed().as_secs() < 20, "{:?}", started.elapsed());
    }
}

#[test]
fn files_of_cycles_have_the_names_that_shops_give_them() {
    let name = |file: &str| lowered("M2\n", file).programs[0].0.name.clone();
    let twenty = Some(ProgramName::Name("CYCLE20".into()));
    for file in [
        "cycle20.nc",
        "CYCLE20B.NC",
        "ZYK20.NC",
        "sub/ZYKLUS 20.NC",
        "Zyk_20-offset.txt",
        "CYC20.NC",
        "G820.NC",
    ] {
        assert_eq!(name(file), twenty, "{file}");
    }
    for file in ["ZYK20B.NC", "G82.NC", "G8201.NC", "G920.NC", "CYCLE.NC", "MYCYCLE20.NC", "20.NC"] {
        assert_eq!(name(file), None, "{file}");
    }
}
