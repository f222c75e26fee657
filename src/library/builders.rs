//! Programs of the machine's builder that are not converted, as a profile says that a code of the target does what they do.

use super::Input;
use super::chunks::lower::lower;
use super::unread::{LeftOut, WhyNot};
use crate::dialect::Control;
use crate::syntax::ProgramName;
use std::collections::BTreeMap;

/// A library without the files that hold such a program alone.
#[derive(Debug)]
pub struct WithoutBuilders {
    /// The other files, each with its place among all.
    pub inputs: Vec<(usize, Input)>,
    /// The files that are left out.
    pub left_out: Vec<LeftOut>,
    /// What is told of each such program.
    pub told: Vec<String>,
}

/// Leaves out the files whose only program is one of the builder's. One that stands in a file with others stays, which is told.
pub fn without_builders(inputs: Vec<Input>, source: &Control) -> WithoutBuilders {
    let builders: BTreeMap<u32, &str> = source.builders_programs().collect();
    let mut without = WithoutBuilders { inputs: Vec::new(), left_out: Vec::new(), told: Vec::new() };
    for (at, input) in inputs.into_iter().enumerate() {
        let all = if may_hold(&input, builders.keys()) { numbers(&input, source) } else { Vec::new() };
        let found = all.iter().flatten().find_map(|number| Some((*number, *builders.get(number)?)));
        let Some((number, code)) = found else {
            without.inputs.push((at, input));
            continue;
        };
        let (path, name) = (input.path.display(), ProgramName::Number(number));
        let says = format!("{path}: {name} is the builder's, as {code} in the source's profile says");
        if all.len() == 1 {
            without.told.push(format!("{says}: it is not converted"));
            without.left_out.push(LeftOut { path: input.path, why: WhyNot::Builders });
        } else {
            let told = format!(
                "{says}, and other programs stand in its file: it is converted with them. Take it out of the file"
            );
            without.told.push(told);
            without.inputs.push((at, input));
        }
    }
    without
}

/// True if one of these numbers stands in a file.
fn may_hold<'n>(input: &Input, numbers: impl Iterator<Item = &'n u32>) -> bool {
    numbers
        .into_iter()
        .any(|number| memchr::memmem::find(&input.bytes, number.to_string().as_bytes()).is_some())
}

/// The numbers of a file's programs; none for one without.
fn numbers(input: &Input, source: &Control) -> Vec<Option<u32>> {
    let number = |name: Option<&ProgramName>| match name {
        Some(ProgramName::Number(number)) => Some(*number),
        _ => None,
    };
    lower(0, input, source).programs.iter().map(|(program, _)| number(program.name.as_ref())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_of_its_own_is_left_out_and_one_with_others_is_told() {
        let profile =
            "dialect = \"fanuc\"\n[parameters]\n6071 = 6\n[codes]\nM6 = { calls = 9001, target = \"M6\" }\n";
        let source = Control::from_profile(profile).unwrap();
        let input =
            |name: &str, text: &str| Input { path: name.into(), name: name.into(), bytes: text.into() };
        let inputs = vec![
            input("a.nc", "O1\nT1M6\nM98P9001\nM30\n"),
            input("O9001.nc", "%\nO9001(M6)\nG28Z0.\nM99\n%\n"),
            input("both.nc", "O2\nM30\nO9001\nM99\n"),
        ];
        let without = without_builders(inputs.clone(), &source);
        let left: Vec<usize> = without.inputs.iter().map(|(at, _)| *at).collect();
        assert_eq!(left, [0, 2]);
        assert_eq!(without.left_out, [LeftOut { path: "O9001.nc".into(), why: WhyNot::Builders }]);
        let says = "O9001 is the builder's, as M6 in the source's profile says";
        assert_eq!(without.told[0], format!("O9001.nc: {says}: it is not converted"));
        assert!(
            without.told[1].contains(&format!("both.nc: {says}, and other programs")),
            "{:?}",
            without.told
        );
        // Who only names the program has it converted.
        let plain = Control::from_profile(&profile.replace(", target = \"M6\"", "")).unwrap();
        let all = without_builders(inputs, &plain);
        assert_eq!((all.inputs.len(), all.told.len()), (3, 0));
    }
}
