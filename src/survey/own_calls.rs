//! Codes of the control that its parameters make call a program of the builder, where the target has such a code itself: `M6`.

use super::filled::{ASKS, TELLS, plain};
use super::shape::{NAMED, Places};
use super::site_rows::key;
use crate::canon::Group;
use crate::dialect::{Alias, Control};
use crate::ir::analysis::{calls_of, span_of};
use crate::ir::{Callee, Module};
use crate::library::Input;
use crate::syntax::ProgramName;
use std::fmt::Write as _;

/// A code that calls a program, by a parameter that the profile states.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct OwnCall {
    /// The code.
    code: String,
    /// The program's number.
    program: u32,
    /// What the target writes for what the code does without that parameter.
    target: String,
    /// The first places.
    places: Vec<String>,
}

/// Those that the library has, and of which the profile says no more.
pub(super) fn found(
    inputs: &[Input],
    places: &Places<'_>,
    [source, target]: [&Control; 2],
    module: &Module,
) -> Vec<OwnCall> {
    let own = source.aliased().filter_map(|(letter, number, Alias { program, arguments, modal })| {
        let row = source.code(letter, number, &[]).filter(|row| !arguments && !modal && !row.op.is_flow())?;
        let is_act = matches!(row.op.group(), Group::OneShot | Group::Spindle | Group::Coolant);
        let there = target.code_for(row.op, &row.fixed).filter(|_| is_act)?;
        let is_open = source.site_code(letter, number).is_none();
        let call =
            OwnCall { code: row.code.clone(), program, target: there.code.clone(), places: Vec::new() };
        is_open.then_some((letter, number, call))
    });
    let mut own: Vec<(char, f64, OwnCall)> = own.collect();
    if own.is_empty() {
        return Vec::new();
    }
    for program in &module.programs {
        for block in &program.blocks {
            for call in calls_of(block) {
                let Callee::Program(ProgramName::Number(number)) = call.callee else { continue };
                let span = span_of(block, call);
                let text = inputs
                    .get(program.file)
                    .and_then(|input| input.bytes.get(span.start as usize..span.end as usize));
                let by_code = |(letter, code, call): &&mut (char, f64, OwnCall)| {
                    call.program == number && text.is_some_and(|text| has(text, *letter, *code))
                };
                if let Some((.., call)) = own.iter_mut().find(by_code)
                    && call.places.len() < NAMED
                {
                    call.places.push(places.at(program.file, span));
                }
            }
        }
    }
    own.into_iter().map(|(.., call)| call).filter(|call| !call.places.is_empty()).collect()
}

/// True if a block has the word of a letter with this number.
fn has(block: &[u8], letter: char, number: f64) -> bool {
    let text = String::from_utf8_lossy(block).to_ascii_uppercase();
    text.match_indices(letter).any(|(at, _)| {
        let rest = text.get(at + letter.len_utf8()..).unwrap_or_default().trim_start();
        let end = rest.find(|sign: char| !sign.is_ascii_digit() && sign != '.').unwrap_or(rest.len());
        rest.get(..end).and_then(|digits| digits.parse::<f64>().ok()) == Some(number)
    })
}

/// Their lines of a profile.
pub(super) fn lines(own: &[OwnCall]) -> String {
    let mut text = String::new();
    if own.is_empty() {
        return text;
    }
    let _ = writeln!(
        text,
        "{TELLS} A code that calls a program of the builder, and that the target has itself: calls and target together leave that"
    );
    let _ = writeln!(text, "{TELLS} program out of the conversion; calls alone has it converted and called.");
    for OwnCall { code, program, target, places } in own {
        let about = format!("{}; where {target} of the target does what O{program} does", places.join(", "));
        let _ = writeln!(
            text,
            "{ASKS} {} = {{ calls = {program}, target = \"{target}\" }} # {}",
            key(code),
            plain(&about)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    const SAID: &str =
        "dialect = \"fanuc\"\nmachine = \"mill\"\nunits = \"metric\"\n[parameters]\n6071 = 6\n";

    fn asked(text: &str, profile: &str) -> String {
        let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
        let source = Control::from_profile(profile).unwrap();
        let target = Control::from_profile("dialect = \"haas\"\nmachine = \"mill\"\n").unwrap();
        filled(&survey(&inputs, &source, Some(&target)), Side::Source, Some(profile)).unwrap()
    }

    #[test]
    fn the_builders_tool_change_is_offered() {
        let line =
            "#? M6 = { calls = 9001, target = \"M6\" } # a.nc:3; where M6 of the target does what O9001 does";
        let text = asked("O1\nG21 G90\nT1 M06\nM30\nO9001\nG91 G28 Z0.\nM99\n", SAID);
        assert!(text.lines().any(|found| found == line), "{text}");
        // Answered, by either of the two, it is not asked again.
        for answer in ["M6 = { calls = 9001, target = \"M6\" }", "M6 = { calls = 9001 }"] {
            let again = asked("O1\nG21 G90\nT1 M6\nM30\n", &format!("{SAID}[codes]\n{answer}\n"));
            assert!(!again.contains("#? M6"), "{again}");
        }
        // The program is called by its number alone.
        let called = asked("O1\nG21 G90\nM98 P9001\nM30\nO9001\nM99\n", SAID);
        assert!(!called.contains("#? M6"), "{called}");
    }
}
