//! The machines that random programs are run on and converted to.

use macroglot::canon::Op;
use macroglot::dialect::{Control, Profile, registry};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The machines of the project file at the root, and what it leaves open of the others: set to inches, and to millimetres.
static MACHINES: LazyLock<[Vec<Control>; 2]> = LazyLock::new(|| {
    let with = |text: &str| {
        let profile = Profile::read(text).expect("the profile is right");
        let entry = registry::find(&profile.dialect).expect("its dialect is known");
        Control::new(entry, profile).expect("the profile fits")
    };
    let fanuc = include_str!("../../../../machines/fanuc-0i.toml");
    let haas = include_str!("../../../../machines/haas-vf.toml");
    // In the maker's own format where it is set to inches, and in the one like Fanuc's where it is set to millimetres.
    let fadal = "dialect = \"fadal\"\nunits = \"inch\"\n[settings]\nformat = \"1\"";
    let cc100 = concat!("units = \"inch\"\n", include_str!("../../../../machines/cc100-mill.toml"));
    let inch = [fadal, fanuc, haas, cc100];
    let metric = inch.map(|text| {
        assert!(text.contains("units = \"inch\""));
        text.replace("units = \"inch\"", "units = \"metric\"").replace("format = \"1\"", "format = \"2\"")
    });
    [inch.map(with).into(), metric.map(|text| with(&text)).into()]
});

/// The machine of a dialect, set to millimetres or to inches.
pub fn machine(dialect: &str, metric: bool) -> &'static Control {
    let named = |control: &&Control| control.name() == dialect;
    MACHINES[usize::from(metric)].iter().find(named).expect("a dialect")
}

/// Machines that conversions are written for, but for one dialect: set as `metric` says second, and those whose unit no
/// program can change as it says first, like the machine that the program is from.
pub fn targets(from: &str, metric: [bool; 2]) -> impl Iterator<Item = &'static Control> {
    let selects = |target: &Control| target.code_for(Op::Inch, &BTreeMap::new()).is_some();
    let as_told = move |target: &&Control| {
        let [old, new] = metric;
        machine(target.name(), if selects(target) { new } else { old })
    };
    let written = |target: &&Control| target.entry().emit.is_some();
    let of = &MACHINES[usize::from(metric[1])];
    of.iter()
        .filter(move |target| target.name() != from && written(target))
        .map(move |target| as_told(&target))
}
