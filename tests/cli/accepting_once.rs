//! What is asked once for the library: no program is for review because of it, and one entry accepts it for all.

use super::Shop;
use serde_json::Value;

const PROJECT: &str = "\
[machines.old]
dialect = \"fadal\"
profile = \"old.toml\"
[machines.new]
profile = \"new.toml\"
dialect = \"haas\"
[libraries.shop]
path = \"programs\"
machine = \"old\"
[libraries.shop.targets]
new = \"out\"
";

const OLD: &str = "dialect = \"fadal\"\nunits = \"inch\"\n";
const NEW: &str = "dialect = \"haas\"\n";

/// The target has no mist coolant.
fn misty(name: &str) -> String {
    format!("%\nN1 {name}\nN2 G20 G90 G40 G80\nN3 M7\nN4 E1 G0 X1.\nN5 M9\nN6 M2\n%\n")
}

fn shop() -> Shop {
    Shop::with(&[
        ("macroglot.toml", PROJECT),
        ("old.toml", OLD),
        ("new.toml", NEW),
        ("programs/a.nc", &misty("O1")),
        ("programs/b.nc", &misty("O2")),
    ])
}

/// What is asked once, and the outcomes of the programs.
fn asked(shop: &Shop) -> (Vec<String>, Vec<String>) {
    let run = shop.run("convert --no-verify --format json");
    let json: Value = serde_json::from_str(&run.out).unwrap();
    let list = |key: &str| json[key].as_array().cloned().unwrap_or_default();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let library = list("library").iter().map(|asked| text(&asked["message"])).collect();
    (library, list("programs").iter().map(|program| text(&program["outcome"])).collect())
}

const MIST: &str = "the target has no mist coolant: flood coolant is switched on instead";

#[test]
fn it_is_asked_once_and_accepted_once() {
    let shop = shop();
    assert_eq!(asked(&shop), (vec![MIST.to_owned()], vec!["converted".to_owned(), "converted".to_owned()]));
    let told = shop.run("convert --no-verify").out;
    assert_eq!(told.matches(MIST).count(), 1, "{told}");
    assert!(told.contains("What is decided once for the library"), "{told}");

    let run = shop.run("accept --code MG0405 --who Ann --why tried");
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    let project = shop.read("macroglot.toml");
    let entry = project.split("[[accepted]]").nth(1).unwrap_or_default();
    assert_eq!(project.matches("[[accepted]]").count(), 1, "{project}");
    assert!(entry.contains(MIST) && !entry.contains("file =") && !entry.contains("at ="), "{entry}");
    assert_eq!(asked(&shop).0, Vec::<String>::new());
    let told = shop.run("convert --no-verify").out;
    assert!(told.contains("accepted by Ann on"), "{told}");

    // It holds for a program that comes later, and not for another machine.
    shop.write("programs/c.nc", misty("O3").as_bytes());
    assert_eq!(asked(&shop), (Vec::new(), vec!["converted".to_owned(); 3]));
    shop.write("new.toml", b"dialect = \"haas\"\noffsets = 99\n");
    assert_eq!(asked(&shop).0, [MIST]);
    let told = shop.run("convert --no-verify").out;
    assert!(told.contains("It was accepted by Ann on"), "{told}");
    let run = shop.run("accept --all --who Bob");
    assert!(run.out.contains("renew"), "{}", run.out);
    assert_eq!(asked(&shop).0, Vec::<String>::new());
}

#[test]
fn an_entry_has_a_file_and_a_place_or_neither() {
    let shop = shop();
    assert_eq!(shop.run("accept --all --who Ann").code, 0);
    let project = shop.read("macroglot.toml");
    for extra in ["file = \"programs/a.nc\"", "at = \"line 3: M7\"", "program = \"O1\""] {
        shop.write("macroglot.toml", project.replacen("code =", &format!("{extra}\ncode ="), 1).as_bytes());
        let run = shop.run("convert --no-verify");
        assert_eq!(run.code, 2, "{extra}: {}", run.out);
        assert!(run.err.contains("[[accepted]]") && run.err.contains("neither of them"), "{}", run.err);
    }
}

/// What a folder is asked of on the way to another control: for the library once, and of programs.
fn asked_of(texts: &[&str], from: &str, to: &str) -> (Vec<String>, Vec<String>) {
    let names: Vec<String> = (0..texts.len()).map(|at| format!("in/{at}.nc")).collect();
    let files: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(texts.iter().copied()).collect();
    let shop = Shop::with(&files);
    let run = shop.run(&format!("convert in --from {from} --to {to} --no-verify --format json --out out"));
    let json: Value = serde_json::from_str(&run.out).unwrap();
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let library =
        json["library"].as_array().into_iter().flatten().map(|asked| text(&asked["message"])).collect();
    let programs = json["programs"].as_array().unwrap().iter();
    let findings = programs.flat_map(|program| program["diagnostics"].as_array().unwrap());
    let of_programs = findings.filter(|found| found["severity"] == "review" && found["code"] == "MG0405");
    (library, of_programs.map(|found| text(&found["message"])).collect())
}

/// A macro has a number from 9000; any other program that returns, and that nothing calls, may be a main program.
#[test]
fn returns_that_nothing_calls_are_asked_about_once() {
    let text = |number: u32| format!("O{number}\nG21 G90 G94 G17 G54\nG1 X1. F100.\nM99\n");
    let (first, second, last) = (text(100), text(200), text(9001));
    let (library, programs) = asked_of(&[&first, &second, &last], "fanuc", "fadal");
    let about: Vec<_> =
        library.iter().filter(|asked| asked.contains("nothing in the library calls")).collect();
    assert_eq!((about.len(), &programs[..]), (1, &[][..]), "{library:?}");
    let (library, programs) = asked_of(&[&last], "fanuc", "fadal");
    assert!(!library.concat().contains("nothing in the library calls"), "{library:?}");
    assert_eq!(programs, Vec::<String>::new());
}

/// On a CC100 the tool word alone brings a length.
#[test]
fn lengths_without_a_change_are_asked_about_once() {
    let text = |tool: u32| {
        format!("%\nN1 O{tool}\nN2 G90 G40 G80 G0\nN3 E1 X0 Y0\nN4 H{tool} Z1.\nN5 G1 Z-1. F20.\nN6 M2\n%\n")
    };
    let (library, programs) = asked_of(&[&text(1), &text(2)], "fadal", "cc100");
    let about: Vec<_> =
        library.iter().filter(|asked| asked.contains("takes up the length of one tool")).collect();
    assert_eq!((about.len(), &programs[..]), (1, &[][..]), "{library:?}");
}

/// `#4014` holds 54.1 under `G54.1`, and 154 on a Haas.
#[test]
fn work_offsets_that_no_program_names_are_asked_about_once() {
    let reads = "O1\nG21 G90 G94 G17 G54\n#100=#4014\nG1 X#100 F100.\nM30\n";
    let (library, programs) = asked_of(&[reads, &reads.replace("O1", "O2")], "fanuc", "haas");
    let about: Vec<_> = library.iter().filter(|asked| asked.contains("G54.1")).collect();
    assert_eq!((about.len(), programs.len()), (1, 0), "{library:?} {programs:?}");
    let names = "O2\nG21 G90 G94 G17\nG54.1 P2\nG1 X1. F100.\nM30\n";
    let (library, programs) = asked_of(&[reads, names], "fanuc", "haas");
    assert!(!library.concat().contains("G54.1"), "{library:?}");
    assert!(programs.iter().any(|asked| asked.contains("G54.1")), "{programs:?}");
}
