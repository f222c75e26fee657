//! `; run: SETTINGS => CLAIMS`: what running the first program must come to.

use macroglot::ir::eval::{Ending, Memory, Trace, eval, run};
use macroglot::ir::text::parse;
use macroglot::ir::{Module, Place, StmtKind};

const STEPS: usize = 10_000;

/// Checks every claim of a text on a module. Returns how many there were.
pub fn check(text: &str, module: &Module) -> Result<usize, String> {
    let claims: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("; run: ")).collect();
    for claim in &claims {
        let (settings, wanted) = claim.split_once("=>").ok_or("a claim lacks '=>'")?;
        let mut memory = set(settings)?;
        let trace = run(module, 0, &mut memory, &[], STEPS);
        for want in wanted.split(';').map(str::trim) {
            holds(want, &trace, &memory).map_err(|why| format!("run: {claim}\n{why}\n{trace:?}"))?;
        }
    }
    Ok(claims.len())
}

fn holds(want: &str, trace: &Trace, memory: &Memory) -> Result<(), String> {
    if want == "alarm" {
        return if matches!(trace.ending, Ending::Alarm(_)) { Ok(()) } else { Err("no alarm".into()) };
    }
    if let Some(event) = want.strip_prefix("event ") {
        return if trace.events.iter().any(|e| e == event) {
            Ok(())
        } else {
            Err(format!("no event {event}"))
        };
    }
    let found = set(want)?;
    let same = found.vars.iter().all(|(var, value)| macroglot::ir::eval::Env::var(memory, *var) == *value);
    if same { Ok(()) } else { Err(format!("not {want}: {:?}", memory.vars)) }
}

/// The memory that `local.1 = 2, global.3 = vacant` describes.
fn set(text: &str) -> Result<Memory, String> {
    let mut memory = Memory::new();
    for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        let module = parse(&format!("program O1 {{\nblock0:\n {part}\n end\n}}"))
            .map_err(|e| format!("{part}: {e}"))?;
        let stmt = module.programs.first().and_then(|p| p.blocks.first()).and_then(|b| b.stmts.first());
        let Some(StmtKind::Assign { target: Place::Var(var), value }) = stmt.map(|stmt| &stmt.kind) else {
            return Err(format!("{part} is not a variable's value"));
        };
        memory.set(*var, eval(value, &Memory::new()).map_err(|e| e.to_string())?);
    }
    Ok(memory)
}
