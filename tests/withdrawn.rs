//! Which programs of a library are taken back where one differs, and what is left of the others.
//!
//! A conversion that is right differs nowhere, so a fault is put into the text that it would write.

#[path = "support/machine.rs"]
mod machine;

use machine::machine;
use macroglot::diag::Code;
use macroglot::dialect::Control;
use macroglot::library::{
    Certificates, Conversion, Input, Lock, Options, Outcome, ProgramReport, convert, judge,
};
use macroglot::verify::{Effort, Outcome as Verdict, Why};
use sha2::{Digest, Sha256};

/// A library that was converted from one control to another and judged.
struct Judged {
    files: Vec<(&'static str, String)>,
    conversion: Conversion,
    certificates: Certificates,
}

/// Converts files, replaces what stands once in all texts by something of the same length, and judges.
fn judged(from: &str, to: &str, files: &[(&'static str, &str)], fault: (&str, &str), draft: bool) -> Judged {
    let [source, target] = [from, to].map(|spec| machine(spec).unwrap());
    let inputs: Vec<Input> = files
        .iter()
        .map(|(name, text)| Input {
            path: name.into(),
            name: (*name).into(),
            bytes: text.as_bytes().to_vec(),
        })
        .collect();
    let lock = Lock::new(source.name(), target.name());
    let options = Options { draft, ..Options::default() };
    let mut conversion = convert(&inputs, &source, &target, lock, options);
    let (old, new) = fault;
    assert_eq!(old.len(), new.len(), "places stay where they are");
    if !old.is_empty() {
        let all = conversion.texts.iter().flatten();
        let times: usize = all.map(|text| text.matches(old).count()).sum();
        assert_eq!(times, 1, "{old} stands once in {:#?}", conversion.texts);
        let texts = conversion.texts.iter_mut().flatten();
        texts.for_each(|text| *text = text.replace(old, new));
    }
    let certificates = judge(&inputs, &mut conversion, &source, &target, Effort::default());
    let files = files.iter().map(|(name, text)| (*name, (*text).to_owned())).collect();
    let judged = Judged { files, conversion, certificates };
    judged.holds();
    judged
}

fn fanuc(files: &[(&'static str, &str)], fault: (&str, &str)) -> Judged {
    judged("fanuc", "haas", files, fault, false)
}

impl Judged {
    fn program(&self, name: &str) -> &ProgramReport {
        self.conversion.programs.iter().find(|program| program.name.as_deref() == Some(name)).unwrap()
    }

    fn names(&self, is: impl Fn(&ProgramReport) -> bool) -> Vec<&str> {
        let all = self.conversion.programs.iter().filter(|program| is(program));
        all.map(|program| program.name.as_deref().unwrap_or("-")).collect()
    }

    fn refused(&self) -> Vec<&str> {
        self.names(|program| program.outcome == Outcome::Refused)
    }

    /// The source's text at the place of a program's finding with a code, and what that says.
    fn told(&self, name: &str, code: Code) -> Vec<(&str, &str)> {
        let program = self.program(name);
        let text = &self.files[program.file].1;
        let all = program.diagnostics.iter().filter(|diagnostic| diagnostic.code == code);
        all.map(|diagnostic| (&text[diagnostic.span.range()], &*diagnostic.message)).collect()
    }

    fn text(&self, file: usize) -> &str {
        self.conversion.texts[file].as_deref().unwrap_or_default()
    }

    fn certificate(&self, name: &str) -> &macroglot::verify::ProgramCertificate {
        let all = self.certificates.written.iter().chain(&self.certificates.withheld).flatten();
        let mut programs = all.flat_map(|certificate| &certificate.programs);
        programs.find(|program| program.program.as_deref() == Some(name)).unwrap()
    }

    fn reasons(&self, name: &str) -> Vec<Why> {
        self.certificate(name).reasons.iter().map(|reason| reason.why).collect()
    }

    /// What holds of every conversion that was judged.
    fn holds(&self) {
        for (at, text) in self.conversion.texts.iter().enumerate() {
            let all = self.certificates.written[at].iter().flat_map(|certificate| &certificate.programs);
            for program in all {
                let text = text.as_ref().expect("a certificate of what is written");
                let hash: String =
                    Sha256::digest(text.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
                assert_eq!(program.target_sha256.as_ref(), Some(&hash), "the hash of what is written");
                assert_ne!(program.outcome, Verdict::Different, "{:?}", program.program);
            }
            let all = self.certificates.withheld[at].iter().flat_map(|certificate| &certificate.programs);
            for program in all {
                assert_eq!((&program.target, &program.target_sha256), (&None, &None));
                assert_ne!(program.outcome, Verdict::Same, "{:?}", program.program);
            }
        }
        for program in &self.conversion.programs {
            let text = self.text(program.file);
            let name = program.name.as_deref().unwrap_or_default();
            if program.outcome != Outcome::Refused {
                assert!(text[program.range.clone()].contains(name), "{name} in {text}");
                assert!(
                    text[program.range.clone()].trim_end().ends_with(['0', '2', '9', ')']),
                    "{name} in {text}"
                );
            }
            for (_, place) in &program.map {
                assert!(program.range.start <= place.start && place.end <= program.range.end, "{name}");
                assert!(place.start == 0 || text.as_bytes()[place.start - 1] == b'\n', "{name}: {text}");
            }
        }
    }
}

const THREE: &str =
    "%\nO0001\nG21 G90\nG0 X1.\nM99\nO0002\nG21 G90\nG0 X2.\nM99\nO0003\nG21 G90\nG0 X3.\nM99\n%\n";

#[test]
fn only_the_program_that_differs_is_taken_out_of_its_file() {
    for (fault, gone) in [(("X1.", "X7."), "O0001"), (("X2.", "X7."), "O0002"), (("X3.", "X7."), "O0003")] {
        let found = fanuc(&[("a.nc", THREE)], fault);
        assert_eq!(found.refused(), [gone]);
        let left = fanuc(&[("a.nc", &without(THREE, gone))], ("", ""));
        assert_eq!(found.text(0), left.text(0), "as if it had never been there");
        assert_eq!(found.certificates.written[0].as_ref().unwrap().programs.len(), 2);
        let withheld = found.certificates.withheld[0].as_ref().unwrap();
        assert_eq!((withheld.programs.len(), withheld.outcome), (1, Verdict::Different));
        assert!(withheld.programs[0].witness.is_some());
    }
}

/// A file without one of its programs, which ends before the next name or the frame.
fn without(text: &str, name: &str) -> String {
    let start = text.find(&format!("{name}\n")).unwrap();
    let end = text[start + 1..].find(['O', '%']).unwrap() + start + 1;
    format!("{}{}", &text[..start], &text[end..])
}

#[test]
fn a_file_whose_only_program_differs_is_not_written() {
    let found = fanuc(
        &[
            ("a.nc", "%\nO0001\nG21 G90\nG0 X1.\nM30\n%\n"),
            ("b.nc", &THREE.replace("O0001", "O0005").replace("X1.", "X4.")),
        ],
        ("X1.", "X1."),
    );
    assert!(found.refused().is_empty());
    let found = fanuc(&[("a.nc", "%\nO0001\nG21 G90\nG0 X9.\nM30\n%\n")], ("X9.", "X8."));
    assert_eq!(found.conversion.texts, [None]);
    assert_eq!(found.certificates.written, [None]);
    assert_eq!(found.certificates.withheld[0].as_ref().unwrap().outcome, Verdict::Different);
    assert_eq!(found.told("O0001", Code::VerifiedDifferent).len(), 1);
}

#[test]
fn what_calls_it_goes_with_it_however_far_up_and_in_whatever_file() {
    let files = [
        ("a.nc", "%\nO0001\nG21 G90\nG0 X5.\nG65 P2\nM30\n%\n"),
        (
            "b.nc",
            "%\nO0002\nG0 X6.\nM98 P3\nM99\nO0003\nG0 X7.\nG65 P4\nM99\nO0005\nG21 G90\nG0 X8.\nM30\n%\n",
        ),
        ("c.nc", "%\nO0004\nG0 X9.\nM99\nO0006\nG21 G90\nG0 X4.\nM30\n%\n"),
    ];
    let found = fanuc(&files, ("X9.", "X1."));
    assert_eq!(found.refused(), ["O0001", "O0002", "O0003", "O0004"]);
    for (caller, call, callee) in
        [("O0001", "G65 P2", "O0002"), ("O0002", "M98 P3", "O0003"), ("O0003", "G65 P4", "O0004")]
    {
        let told = found.told(caller, Code::CalleeWithdrawn);
        assert_eq!(told.len(), 1, "{caller}");
        assert_eq!(told[0].0, call, "at the call");
        assert!(told[0].1.contains(callee), "{told:?}");
        assert_eq!(found.certificate(caller).outcome, found.program(caller).verdict.unwrap());
        assert!(found.certificate(caller).outcome != Verdict::Same);
    }
    assert_eq!(found.text(1), "%\nO0005\nG21 G90\nG0 X8.\nM30\n%\n", "{:?}", found.text(1));
    assert!(found.text(2).contains("X4.") && !found.text(2).contains("X9."));
}

#[test]
fn a_main_program_and_its_macros_may_share_a_file() {
    let file = "%\nO0001\nG21 G90\nG65 P9001\nG65 P9002\nM30\nO9001\nG0 X5.\nM99\nO9002\nG0 X6.\nM99\n%\n";
    let found = fanuc(&[("a.nc", file)], ("X6.", "X7."));
    assert_eq!(found.refused(), ["O0001", "O9002"]);
    assert!(
        found.text(0).starts_with("%\nO9001") && found.text(0).ends_with("M99\n%\n"),
        "{}",
        found.text(0)
    );
    let found = fanuc(&[("a.nc", file)], ("G65 P9001", "G65 P9002"));
    assert_eq!(found.refused(), ["O0001"], "what is called stays");
}

#[test]
fn programs_that_call_each_other_go_together() {
    let file = "%\nO0001\nG21 G90\n#100=#100+1\nIF[#100GT3]GOTO9\nG65 P2\nN9M99\nO0002\nG0 X#100\nG1 X9. F100.\nG65 P1\nM99\nO0003\nG21 G90\nG0 X4.\nM30\n%\n";
    let found = fanuc(&[("a.nc", file)], ("X9.", "X8."));
    assert_eq!(found.refused(), ["O0001", "O0002"]);
    assert_eq!(found.program("O0003").outcome, Outcome::Converted);
}

#[test]
fn a_computed_call_that_comes_to_it_counts() {
    let file = "%\nO0001\nG21 G90\n#1=3\nG65 P#1\nM30\nO0003\nG0 X5.\nM99\nO0004\nG0 X6.\nM99\n%\n";
    let found = fanuc(&[("a.nc", file)], ("X5.", "X7."));
    assert!(
        found.refused().contains(&"O0003") && found.refused().contains(&"O0001"),
        "{:?}",
        found.refused()
    );
    // What is computed never comes to the other one: it stays, and nothing says that it is the same.
    let found = fanuc(&[("a.nc", file)], ("X6.", "X7."));
    assert_eq!(found.refused(), ["O0004"]);
    assert!(found.reasons("O0001").contains(&Why::Callee), "{:?}", found.reasons("O0001"));
}

#[test]
fn a_program_that_was_refused_before_is_named_at_the_call_and_in_the_certificate() {
    let file = "%\nO0001\nG21 G90\nG0 X5.\nG65 P3\nM30\nO0002\nG21 G90\nG65 P1\nM30\nO0003\nG7.1 C9.\nM99\nO0004\nG21 G90\nG0 X6.\nM30\n%\n";
    for draft in [false, true] {
        let found = judged("fanuc", "haas", &[("a.nc", file)], ("", ""), draft);
        assert_eq!(found.refused(), ["O0003"], "{draft}");
        let told = found.told("O0001", Code::OutsideLibrary);
        assert_eq!(told.len(), 1);
        assert!(told[0].0 == "G65 P3" && told[0].1.contains("O3"));
        for caller in ["O0001", "O0002"] {
            assert_eq!(found.program(caller).outcome, Outcome::Review, "{caller}, {draft}");
            assert_eq!(found.certificate(caller).outcome, Verdict::Undecided, "{caller}, {draft}");
            assert!(found.reasons(caller).contains(&Why::Callee), "{caller}, {draft}");
        }
        assert_eq!(found.program("O0004").outcome, Outcome::Converted);
        assert_eq!(found.text(0).contains("NOT CONVERTED"), draft);
    }
}

#[test]
fn a_draft_makes_no_other_program_worse() {
    let file = "%\nO0001\nG21 G90\nG65 P3\nG0 X5.\nM30\nO0003\nG0 X4.\nG7.1 C9.\nG0 X6.\nM99\nO0004\nG21 G90\nG0 X6.\nM30\n%\n";
    let [plain, draft] =
        [false, true].map(|draft| judged("fanuc", "haas", &[("a.nc", file)], ("", ""), draft));
    for name in ["O0001", "O0004"] {
        let (without, with) = (plain.program(name), draft.program(name));
        assert_eq!((without.outcome, without.verdict), (with.outcome, with.verdict), "{name}");
        assert_eq!(without.diagnostics, with.diagnostics, "{name}");
        let texts =
            [(&plain, without), (&draft, with)].map(|(judged, p)| judged.text(0)[p.range.clone()].to_owned());
        assert_eq!(texts[0], texts[1], "{name}");
    }
}

#[test]
fn programs_without_numbers_stay_apart() {
    let one = |x: &str| format!("G21 G90\nG0 X{x}.\nM30\n");
    let file = format!("%\n{}%\n{}%\n{}%\n", one("1"), one("2"), one("3"));
    for (fault, kept) in [("1", ["2", "3"]), ("2", ["1", "3"]), ("3", ["1", "2"])] {
        let found = fanuc(&[("a.nc", &file)], (&format!("X{fault}."), "X7."));
        let left = format!("%\n{}%\n{}%\n", one(kept[0]), one(kept[1]));
        let alone = fanuc(&[("a.nc", &left)], ("", ""));
        assert_eq!(found.text(0), alone.text(0));
        assert_eq!(found.refused().len(), 1);
    }
}

#[test]
fn a_copy_that_the_conversion_made_goes_with_its_program() {
    // A subroutine within the program, which becomes one of its own.
    let file = "O0001 (MAIN)\nL100 (SUB)\nG0 X5.\nM17\nM30\nG90 G0 X1. E1\nL101\nM2\n";
    let found = judged("fadal", "fanuc", &[("a.nc", file)], ("X5.", "X6."), false);
    assert_eq!(found.conversion.texts, [None]);
}

/// Fanuc takes four levels of macros and stops at the fifth: no run shows what the macros get, and none is different.
#[test]
fn macros_whose_callers_are_all_stopped_are_not_called_different() {
    let library = "O1\nG21G90\nG65P2A5.\nM30\nO2\nG1X#1F100.\nG65P3A[#1+1.]\nM99\nO3\nG65P4A[#1+1.]\nM99\n\
                   O4\nG65P5A[#1+1.]\nM99\nO5\nG65P6A[#1+1.]\nM99\nO6\nG1X#1\nM99\n";
    let [source, target] = ["fanuc", "fadal"].map(|name| Control::plain(name).unwrap());
    let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: library.as_bytes().to_vec() }];
    let mut conversion = convert(&inputs, &source, &target, Lock::new("fanuc", "fadal"), Options::default());
    judge(&inputs, &mut conversion, &source, &target, Effort::default());
    let different =
        |program: &&ProgramReport| program.diagnostics.iter().any(|d| d.code == Code::VerifiedDifferent);
    let all: Vec<_> = conversion.programs.iter().filter(different).map(|p| p.name.clone()).collect();
    assert!(all.is_empty(), "{all:?}");
}

/// The Fadal's programs select no unit: its operator sets that of the metric program, also where it is a caller that is
/// run to see what a macro is given. By itself the macro is given nothing, and its words would name a register.
#[test]
fn a_macro_takes_what_its_metric_caller_gives() {
    let main = "O1900\nG21G17G40G49G80G90G94G98\nG54G0X0Y0Z10.\nG65P9900A2.B-3.\nM30\n";
    let cut = "O9900\nG0Z#1\nG1Z#2F100.\nG4P500\nM99\n";
    let made =
        judged("fanuc[units=\"inch\"]", "fadal", &[("o1900.nc", main), ("o9900.nc", cut)], ("", ""), false);
    for name in ["O1900", "O9900"] {
        let program = made.program(name);
        assert_ne!(program.outcome, Outcome::Refused, "{name}: {:#?}", program.diagnostics);
        assert_ne!(program.verdict, Some(Verdict::Different), "{name}");
    }
}
