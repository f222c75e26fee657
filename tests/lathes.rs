//! Random programs of lathes, converted to the other lathes and back, each conversion verified.
//!
//! `MACROGLOT_PROGRAMS=100 MACROGLOT_SEED=7 cargo test --test lathes -- --nocapture` tries so many. What is drawn is what turners
//! write: passes, contours roughed and finished, grooves, pecks, threads, increments, loops over passes. All of it has a conversion.

#[path = "support/machine.rs"]
mod machine;

use machine::machine;
use macroglot::dialect::Control;
use macroglot::library::{Input, Lock, Options, Outcome, convert, judge};
use macroglot::verify::Effort;
use std::fmt::Write;

/// How many programs are tried where nothing else is said, and from which seed.
const PROGRAMS: u64 = 8;
const SEED: u64 = 20_261;

const EFFORT: Effort = Effort {
    fewest: 4,
    telling: 4,
    drawn: 4,
    scenarios: 8,
    tries: 16,
    steps: 4000,
    all_steps: 60_000,
    seed: 1,
    program_seconds: 60.0,
    library_seconds: 600.0,
    allowed_mm: 0.0,
};

const FANUC: &str = "machine=\"lathe\";units=\"metric\";decimal_point=\"calculator\";parameters.\"5101.2\"=1;axes=[\"X\",\"Z\",\"C\"]";
const HAAS: &str = "haas[machine=\"lathe\";units=\"metric\";settings.73=\"0.5\";settings.22=\"0.5\";settings.second_home_x=\"-150.\";settings.second_home_z=\"-200.\";settings.86=\"0.05\";settings.95=\"0\";\
                    settings.99=\"0.05\"]";

fn setting(name: &str, otherwise: u64) -> u64 {
    std::env::var(name).map_or(otherwise, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

/// Numbers in a row that a seed fixes: xorshift.
struct Source(u64);

impl Source {
    fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % bound
    }

    fn pick<'t>(&mut self, from: &[&'t str]) -> &'t str {
        from[self.below(from.len() as u64) as usize]
    }
}

/// A program of system A: a bar of 60 mm, from X64. Z3.
fn program(source: &mut Source) -> String {
    let mut out = String::from("O1\nG21 G40 G99\nG50 S2500\n");
    let turret = source.pick(&["T0101", "T0404", "T1212"]);
    let turns = source.pick(&["G96 S180 M03", "G97 S800 M3", "G97 S600 M4"]);
    let _ = writeln!(out, "{turret}\n{turns}\n{HOME}");
    for count in 0..2 + source.below(4) {
        part(source, 20 * (count + 1), &mut out);
        let _ = writeln!(out, "{HOME}");
    }
    let _ = writeln!(out, "{}\nM5\nM30", source.pick(&["G28 U0 W0", "G0 X200. Z100."]));
    out
}

const HOME: &str = "G0 X64. Z3.";

fn part(source: &mut Source, number: u64, out: &mut String) {
    let by_minute = source.below(2) as usize;
    let _ = match source.below(25) {
        0 => {
            let (end, taper) = (source.pick(&["Z-20.", "W-23."]), source.pick(&["", " R-1.5", " R.8"]));
            writeln!(out, "G90 X58. {end}{taper} F.2\nX56.\nX54.")
        }
        1 => writeln!(out, "G92 X58. Z-18. {}F1.5\nX57.4\nX57.1", source.pick(&["", "R-.5 "])),
        2 => writeln!(out, "G94 X0. Z2. F.2\nZ1."),
        3 => {
            let (depth, left) = (source.pick(&["U1.", "U2.5"]), source.pick(&["U.4 W.1", "U0 W0", "U.6"]));
            let way =
                source.pick(&["X46.", "G2 X50. Z-20. R5.", "U6. W-3.", ",A135. ,C.5\nX50. Z-30. ,A180."]);
            // Beside an arc no source says what a corner is.
            let corner = if way.starts_with('G') { "" } else { source.pick(&["", " ,R1.5", " ,C1."]) };
            let last = source.pick(&["", " ,R2."]);
            writeln!(
                out,
                "G71 {depth} R.5\nG71 P{number} Q{} {left} F.25\nN{number} G0 X40.\nG1 Z-15.{corner} F.12\n{way}\nG1 Z-35.{last}\nN{} X64.\nG70 P{number} Q{}",
                number + 5,
                number + 5,
                number + 5
            )
        }
        4 => writeln!(
            out,
            "G72 W1. R.5\nG72 P{number} Q{} U.4 W.1 F.2\nN{number} G0 Z-12.\nG1 X50. F.1\nX44. Z-5.\nN{} Z3.",
            number + 5,
            number + 5
        ),
        5 => writeln!(
            out,
            "G0 Z-10.\nG75 R.5\nG75 X54. Z-{} P{} Q2000 F.08",
            source.pick(&["10.", "14."]),
            source.pick(&["1500", "2000"])
        ),
        6 => writeln!(out, "G0 X0.\nG74 R.5\nG74 Z-{} Q7000 F.1", source.pick(&["20.", "31."])),
        7 => writeln!(
            out,
            "G76 P0{}00{} Q{} R{}\nG76 X60. Z-20. {}P{} Q300 F1.5",
            source.pick(&["1", "2", "3"]),
            source.pick(&["60", "55", "00"]),
            source.pick(&["50", "80"]),
            source.pick(&[".05", ".02"]),
            source.pick(&["", "R-.4 "]),
            source.pick(&["920", "1200"])
        ),
        8 => writeln!(out, "G1 U-4. F.15\nW-8.\nX58. W-2.\nG4 {}", source.pick(&["P500", "U.5", "X1."])),
        9 => writeln!(
            out,
            "G83 X40. C0. Z-20. R-2. {}F.1\nC90.\nC180.\nG80",
            source.pick(&["", "P300 ", "P0 "])
        ),
        10 => writeln!(
            out,
            "G0 X50. C0.\nG83 {} R-1. Q5000 F.1\nC60. Q5000\nX44.{}\nG80",
            source.pick(&["Z-18.", "W-16."]),
            source.pick(&["", " Q4000"])
        ),
        11 => writeln!(
            out,
            "G0 Z-10. C0.\nG87 X50. {}R-1.5 {}F.1\nZ-14. C90.\nG80",
            source.pick(&["", "P200 "]),
            source.pick(&["", "Q3000 "])
        ),
        12 => writeln!(out, "G85 X30. C45. Z-12. R-1. F.08\nH30.{}\nG80", source.pick(&["", " K2", " K3"])),
        13 => writeln!(
            out,
            "G1 X60. F.2\nZ-{} {}\nX66. {}\nZ-9.",
            source.pick(&["4.", "6."]),
            source.pick(&["R.8", "I.5", ",C.5", ",R.6"]),
            source.pick(&["K-.5", "R-.4", ",R.5", ""])
        ),
        14 => writeln!(
            out,
            "G1 X{} ,A{}. F.2\nG0 X66.",
            source.pick(&["60.", "56."]),
            source.pick(&["30", "45", "135"])
        ),
        15 => writeln!(
            out,
            "#2=1.5\nG98\nG0 X50. C0.\nG12.1\nG1 X40. F200.\n{}\n{}\n{}\nG1 X50. C0.\nG13.1\nG99",
            source.pick(&["C8.", "X30. C12.", "G3 X24. C16. R40.", "G3 X0. C20. I-20. J0."]),
            source.pick(&[
                "G1 X-30. C15.",
                "G3 X-24. C18. R40.",
                "G1 X[#2-30.] C#2",
                "G2 X-40. C9.5 R60. Z2."
            ]),
            source.pick(&["G1 X-20. C-12.", "G3 X10. C-17.5 R50.", "G1 X[-8.*#2] C-14."])
        ),
        16 => writeln!(
            out,
            "G1 X{}{} F.2\n,A{}.{}\nX62. Z-16. ,A{}.\nG0 X66.",
            source.pick(&["52.", "56."]),
            source.pick(&["", " ,R.6", " ,C.5"]),
            source.pick(&["180", "175"]),
            source.pick(&["", " ,R2.", " ,C.8"]),
            source.pick(&["120", "150"])
        ),
        17 => writeln!(
            out,
            "M5\nG97 S500\n{}\nM29 S500\nG84 {}Z-18. R-1. {}\nC60.\nG80\nG99 G0 Z-10.\nG89 X36. C90. R-1.5 {}F.1\nG80\nG97 S800 M3",
            ["G0 X50. C0.", "G98 G0 X50. C0."][by_minute],
            source.pick(&["", "X44. "]),
            ["F1.25", "F625."][by_minute],
            source.pick(&["", "P200 "])
        ),
        18 | 22 | 23 => writeln!(out, "{}", machine_part(source)),
        19 | 20 => writeln!(
            out,
            "#2={}\nG50 S[#2*10]\nG96 S#2 M3\nG1 X{}. F.2\nG97 S[#2*4]\nW-3.\n{}",
            source.pick(&["150", "180."]),
            source.pick(&["50", "0"]),
            source.pick(&["G97", "S600", "G50 S2500"])
        ),
        21 => writeln!(
            out,
            "G0 X50. Z-4. C{}.\nG98 G1 X{}. H{}. F200.\n{}\nG99",
            source.pick(&["0", "90"]),
            source.pick(&["46", "50"]),
            source.pick(&["45", "-30"]),
            source.pick(&["W-2. C10.", "H15. Z-8.", "U-2. H5.", "C0."])
        ),
        _ => writeln!(
            out,
            "#1=0\nWHILE[#1LT{}]DO1\nG90 X[60.-#1*2] Z-15. F.2\n#1=#1+1\nEND1",
            1 + source.below(3)
        ),
    };
}

/// Tools, offsets, zeros and returns.
fn machine_part(source: &mut Source) -> &'static str {
    source.pick(&[
        "T0404\nG42 X58. Z0.\nG1 Z-8. F.2\nG40 G0 X66.\nT0400\nT0101",
        "G10 P4 U-.05 W.02\nG10 P10004 X-80. Z-40. R.8 Q3\nT0404\nG0 X60.",
        "G52 Z-1.5\nG0 Z2.\nG1 X58. F.2\nG52 Z0.",
        "G55 G0 X60. Z1.\nG1 W-2. F.1\nG54",
        "G10 L2 P2 Z-40.\nG55 G0 X60. Z1.\nG54",
        "G0\nG53 X-50.\nG28 W0\nG28 U0",
        "G30 U0 W0\nG0 X60.\nW5.",
        "G28 U10. W5.\nG28 H0",
        "T0202 M6\nG0 X60. Z1.\nT0200",
        "T101\nG0 X60. Z-1. T0404\nT0404 G1 X58. F.2",
        "#3=404\nT#3\nG0 X60.\nG4 U#3",
    ])
}

/// The text on the target; a fault where it has none, or the machine would do something else.
fn converted(text: &str, source: &Control, target: &Control) -> Result<String, String> {
    let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.as_bytes().to_vec() }];
    let lock = Lock::new(source.name(), target.name());
    let mut made = convert(&inputs, source, target, lock, Options::default());
    let wrong = |why: &str, program: &macroglot::library::ProgramReport| {
        let said: Vec<&str> = program.diagnostics.iter().map(|found| &*found.message).collect();
        format!("to {}: {why}\n{text}\n{}", target.name(), said.join("\n"))
    };
    if let Some(refused) = made.programs.iter().find(|program| program.outcome == Outcome::Refused) {
        return Err(wrong("refused", refused));
    }
    judge(&inputs, &mut made, source, target, EFFORT);
    let same = |program: &&macroglot::library::ProgramReport| {
        program.verdict == Some(macroglot::verify::Outcome::Same)
    };
    match made.programs.iter().find(|program| !same(program)) {
        Some(program) => Err(wrong("not the same", program)),
        None => Ok(made.texts.into_iter().flatten().collect()),
    }
}

/// What is wrong with a program's way to each other lathe and back.
fn faults(text: &str, lathes: &[Control]) -> Vec<String> {
    let Some((first, others)) = lathes.split_first() else { return Vec::new() };
    let way =
        |other: &Control| converted(text, first, other).and_then(|there| converted(&there, other, first));
    others.iter().filter_map(|other| way(other).err()).collect()
}

#[test]
fn random_programs_go_to_other_lathes_and_back() {
    let system = |name: &str| format!("fanuc[{FANUC};settings.gcode_system=\"{name}\"]");
    let specs = [system("A"), system("B"), system("C"), HAAS.to_owned()];
    let lathes: Vec<Control> = specs.iter().map(|spec| machine(spec).expect(spec)).collect();
    let seed = setting("MACROGLOT_SEED", SEED);
    for at in 0..setting("MACROGLOT_PROGRAMS", PROGRAMS) {
        let text = program(&mut Source(seed.wrapping_add(at).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1));
        let found = faults(&text, &lathes);
        assert!(found.is_empty(), "seed {seed}, program {at}:\n{}", found.join("\n\n"));
    }
}
