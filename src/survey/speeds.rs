//! How fast the target's spindle turns, and how many tools it holds, where programs ask for much: no table has either. A lower speed cuts at
//! another feed a tooth.

use super::keys::AskedSetting;
use super::shape::{NAMED, Places};
use crate::canon::{Op, Role};
use crate::dialect::{Control, Side};
use crate::ir::{Expr, Module, Nc};
use crate::text::Span;

/// The section of a profile that says it, and the name there.
pub(super) const SECTION: &str = "limits";
const LIMIT: &str = "spindle.speed";
const TOOLS: &str = "tools";

/// What most machines turn: lower speeds ask nothing.
const USUAL: f64 = 6000.0;
/// What most magazines hold.
const USUAL_TOOLS: f64 = 20.0;

/// The line to fill in: a limit is a number, and 0 is none.
pub(super) fn line(name: &str) -> String {
    format!("\"{name}\" = 0")
}

/// The limits that the profile of the target does not say, where programs ask for more than most machines have.
pub(super) fn asked(places: &Places<'_>, target: &Control, module: &Module) -> Vec<AskedSetting> {
    let speed = |nc: &Nc| {
        let turns = !nc.has(Op::SurfaceSpeed) && !nc.has(Op::LimitSpeed);
        nc.word(Role::Speed).and_then(Expr::constant).filter(|speed| turns && *speed > USUAL)
    };
    let tool = |nc: &Nc| nc.word(Role::Tool).and_then(Expr::constant).filter(|tool| *tool > USUAL_TOOLS);
    let turns = "how many turns a minute the spindle makes at the most; programs ask for up to";
    let holds =
        "how many tools the magazine holds: the greatest T that it has a pocket for; programs name up to";
    let all = [
        one(places, target, module, LIMIT, (&speed, turns)),
        one(places, target, module, TOOLS, (&tool, holds)),
    ];
    all.into_iter().flatten().collect()
}

/// The number of a block that the limit is of, where it is more than is usual.
type Named<'n> = &'n dyn Fn(&Nc) -> Option<f64>;

/// A limit, where the profile does not say it and programs name more than is usual.
fn one(
    places: &Places<'_>,
    target: &Control,
    module: &Module,
    limit: &str,
    (named, meaning): (Named<'_>, &str),
) -> Option<AskedSetting> {
    if target.limit(limit).is_some() {
        return None;
    }
    let mut greatest = 0.0;
    let mut found: Vec<(usize, Span)> = Vec::new();
    for program in &module.programs {
        let mut first = None;
        for stmt in program.blocks.iter().flat_map(|block| &block.stmts) {
            if let Some(value) = stmt.kind.nc().and_then(named) {
                greatest = value.max(greatest);
                first.get_or_insert(stmt.site.span);
            }
        }
        found.extend(first.map(|span| (program.file, span)));
    }
    (!found.is_empty()).then(|| AskedSetting {
        side: Side::Target,
        section: SECTION,
        name: limit.to_owned(),
        as_fact: false,
        likely: None,
        wanted: Vec::new(),
        values: Vec::new(),
        default: None,
        meaning: format!("{meaning} {greatest}"),
        programs: found.len(),
        places: found.iter().take(NAMED).map(|(file, span)| places.at(*file, *span)).collect(),
    })
}

#[cfg(test)]
mod tests {
    use crate::dialect::{Control, Side};
    use crate::library::Input;
    use crate::survey::{filled, survey};

    #[test]
    fn the_speed_is_asked_where_programs_name_high_ones_and_nobody_said_it() {
        let source = Control::from_profile("dialect = \"fanuc\"\nmachine = \"mill\"\n").unwrap();
        let asked = |target: &str, speed: u32| {
            let there = Control::from_profile(target).unwrap();
            let text = format!("O1\nG21 G90\nS{speed} M3\nM30\n");
            let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
            let text = filled(&survey(&inputs, &source, Some(&there)), Side::Target, Some(target)).unwrap();
            text.contains("[limits]\n#? \"spindle.speed\" = 0 # ") && text.contains("(a.nc:3)")
        };
        let plain = "dialect = \"haas\"\nmachine = \"mill\"\n";
        assert!(asked(plain, 9800) && !asked(plain, 6000));
        assert!(!asked(&format!("{plain}[limits]\n\"spindle.speed\" = 8100\n"), 9800));
    }

    #[test]
    fn the_pockets_are_asked_where_programs_name_a_high_tool_and_nobody_said_them() {
        let source = Control::from_profile("dialect = \"fanuc\"\nmachine = \"mill\"\n").unwrap();
        let asked = |target: &str, tool: u32| {
            let there = Control::from_profile(target).unwrap();
            let text = format!("O1\nG21 G90\nT{tool} M6\nM30\n");
            let inputs = [Input { path: "a.nc".into(), name: "a.nc".into(), bytes: text.into() }];
            let text = filled(&survey(&inputs, &source, Some(&there)), Side::Target, Some(target)).unwrap();
            text.contains("[limits]\n#? \"tools\" = 0 # ") && text.contains("(a.nc:3)")
        };
        let plain = "dialect = \"haas\"\nmachine = \"mill\"\n";
        assert!(asked(plain, 90) && !asked(plain, 20));
        assert!(!asked(&format!("{plain}[limits]\n\"tools\" = 40\n"), 90));
    }
}
