//! Builds, legalizes and runs small programs.

pub use crate::domain::DOMAIN;
use macroglot::diag::Diagnostic;
use macroglot::dialect::{Control, Profile, registry};
use macroglot::ir::eval::{Ending, Memory, Trace, Value, run};
use macroglot::ir::text::parse;
use macroglot::ir::{Class, Expr, Module, Var, validate};
use macroglot::legalize::{Context, pipeline};

/// The operands of the programs: two locals, which may be vacant.
pub const OPERANDS: [Var; 2] =
    [Var { class: Class::Local, number: 1 }, Var { class: Class::Local, number: 2 }];

/// Where the programs leave their result.
pub const RESULT: Var = Var { class: Class::Global, number: 9 };

const STEPS: usize = 1000;

/// A control without a profile.
pub fn control(name: &str) -> Control {
    Control::plain(name).unwrap()
}

/// A control with parameters of a machine.
pub fn control_with(name: &str, profile: &str) -> Control {
    Control::new(registry::find(name).unwrap(), Profile::read(profile).unwrap()).unwrap()
}

/// A module of one program whose entry block holds `body`; it ends in a bare `end` of its own.
pub fn program(body: &str) -> Module {
    module(&format!("program O1 {{\nblock0:\n{body}\n end\n}}"))
}

/// A module from its text.
pub fn module(text: &str) -> Module {
    let module = parse(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    validate(&module).unwrap_or_else(|all| panic!("{}\n{text}", all[0]));
    module
}

/// What a pass makes of a module, and what it has to say.
pub fn legalized(
    pass: &str,
    module: &Module,
    source: &Control,
    target: &Control,
) -> (Module, Vec<Diagnostic>) {
    let mut module = module.clone();
    let mut context = Context::new(source, target, module.programs.len());
    let (_, pass) = pipeline::passes().find(|(_, p)| p.name == pass).unwrap();
    pass.apply(&mut module, &mut context);
    validate(&module).unwrap_or_else(|all| panic!("broken: {}\n{module}", all[0]));
    (module, context.into_findings().concat())
}

/// Runs a module's first program on operands; what it did, and its result where it came to its end.
pub fn observe(module: &Module, operands: &[Value], switches: &[u8]) -> (Trace, Value) {
    let mut memory = Memory { switches: switches.to_vec(), ..Memory::new() };
    OPERANDS.iter().zip(operands).for_each(|(var, value)| memory.set(*var, *value));
    let trace = run(module, 0, &mut memory, &[], STEPS);
    let result = memory.vars.get(&RESULT).copied().flatten().filter(|_| trace.ending == Ending::End);
    (trace, result)
}

/// The result of a run; none where the machine stopped with an alarm.
pub fn result(module: &Module, operands: &[Value]) -> Option<f64> {
    let (trace, result) = observe(module, operands, &[]);
    assert!(matches!(trace.ending, Ending::End | Ending::Alarm(_)), "{:?}\n{module}", trace.ending);
    result
}

/// Every expression of a module, operands included.
pub fn expressions(module: &Module) -> Vec<&Expr> {
    let mut all = Vec::new();
    for block in module.programs.iter().flat_map(|program| &program.blocks) {
        block.stmts.iter().for_each(|stmt| stmt.kind.exprs(&mut |e| e.walk(&mut |e| all.push(e))));
        block.term.kind.exprs(&mut |e| e.walk(&mut |e| all.push(e)));
    }
    all
}
