//! The first two parts of a case: what the program meets, and its text.

use crate::support::root;
use macroglot::control::{Library, LoadedFile, ProgramRef, Run, Scenario};
use macroglot::dialect::Control;
use macroglot::syntax::parse_file;

/// The machine and what the program meets, from the first part of a case.
fn circumstances(dialect: &str, words: &str) -> (Control, Scenario) {
    let (mut profile, mut parameters) = (format!("dialect = \"{dialect}\"\n"), String::new());
    let mut scenario = Scenario { steps: 100_000, variable_events: true, ..Scenario::default() };
    let mut tables = Vec::new();
    for word in words.split_whitespace() {
        if let Some((name, value)) = word.split_once('=')
            && !word.contains(':')
        {
            scenario.variables.insert(name.to_owned(), value.parse().expect("a value"));
            continue;
        }
        let (kind, value) = word.split_once(':').unwrap_or((word, ""));
        let pair = || value.split_once('=').expect("a name and a value");
        match kind {
            "machine" | "units" => profile += &format!("{kind} = \"{value}\"\n"),
            "calculator" => profile += "decimal_point = \"calculator\"\n",
            "axes" => profile += &format!("axes = {:?}\n", value.split(',').collect::<Vec<_>>()),
            "parameter" => parameters += &format!("{} = {}\n", pair().0, pair().1),
            "site" => parameters += &format!("[[site]]\ncode = \"{value}\"\ntext = \"builder's own\"\n"),
            "answer" => scenario.answers.push(value.parse().expect("an answer")),
            "tool" => scenario.tool = value.parse().expect("a tool"),
            "steps" => scenario.steps = value.parse().expect("a number"),
            "called" => scenario.called = true,
            "length" | "radius" => {
                let tool = scenario.tools.entry(pair().0.parse().expect("a tool")).or_default();
                let size = pair().1.parse().expect("a size");
                *(if kind == "length" { &mut tool.length } else { &mut tool.radius }) = size;
            }
            "work" => {
                let at = scenario.work_offsets.entry(pair().0.parse().expect("a number")).or_default();
                for (axis, value) in at.iter_mut().zip(numbers(pair().1)) {
                    *axis = value;
                }
            }
            "start" => {
                for (axis, value) in scenario.start.iter_mut().zip(numbers(value)) {
                    *axis = value;
                }
            }
            "probe" => tables.push(format!("probes = [{{ part = {value} }}]")),
            "state" => {
                let (name, subscripts) = pair().0.trim_end_matches(']').split_once('[').expect("subscripts");
                let line = format!("state = \"{name}\"\nsubscripts = [{subscripts}]\nvalue = {}", pair().1);
                scenario.state.push(toml::from_str(&line).expect("a state"));
            }
            other => panic!("unknown circumstance {other}"),
        }
    }
    for table in tables {
        let more: Scenario = toml::from_str(&table).expect("a table");
        scenario.probes.extend(more.probes);
    }
    if !parameters.is_empty() {
        let (sites, parameters): (String, String) = match parameters.find("[[site]]") {
            Some(at) => (parameters[at..].into(), parameters[..at].into()),
            None => (String::new(), parameters),
        };
        profile += &format!("[parameters]\n{parameters}\n{sites}");
    }
    let control = Control::from_profile(&profile).unwrap_or_else(|faults| panic!("{profile}: {faults:?}"));
    (control, scenario)
}

/// The numbers of a list with commas.
pub fn numbers(list: &str) -> Vec<f64> {
    list.split(',').map(|number| number.trim().parse().unwrap_or_else(|_| panic!("{list}"))).collect()
}

/// The texts of a case: its own blocks, and files of the corpus.
fn programs(dialect: &str, source: &str) -> Vec<(String, Vec<u8>)> {
    let mut own = String::new();
    let mut files = Vec::new();
    for block in source.split(" | ").map(str::trim) {
        if !block.starts_with('@') {
            own += block;
            own += "\n";
            continue;
        }
        for name in block.split_whitespace().map(|name| name.trim_start_matches('@')) {
            let (file, name) = name.split_once('=').unwrap_or((name, name));
            let path = root().join("corpus").join(dialect).join(file);
            let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{file}: {error}"));
            files.push((name.to_owned(), bytes));
        }
    }
    if !own.is_empty() {
        files.insert(0, ("own.nc".into(), own.into_bytes()));
    }
    files
}

/// Runs a case's program on its control.
pub fn run(dialect: &str, words: &str, source: &str) -> Run {
    let (control, scenario) = circumstances(dialect, words);
    let files = programs(dialect, source);
    let parsed: Vec<_> = files.iter().map(|(_, text)| parse_file(text, control.entry().parse)).collect();
    let loaded: Vec<LoadedFile<'_>> =
        files.iter().zip(&parsed).map(|((name, _), parsed)| LoadedFile { name, parsed }).collect();
    control.entry().execute.expect("an emulated control")(
        &Library::new(&loaded),
        ProgramRef::FIRST,
        &control,
        &scenario,
    )
}
