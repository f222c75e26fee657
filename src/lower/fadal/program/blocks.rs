//! One program: its blocks in source order, its subroutines, its jumps.

use crate::diag::{Code, Diagnostic};
use crate::dialect::{Control, Question};
use crate::ir::{Cond, Program, SourceInfo, StmtKind, TermKind};
use crate::lower::common::{ProgramText, says_something, site_of};
use crate::lower::fadal::build::Lowering;
use crate::lower::fadal::codes::{Codes, steps};
use crate::lower::fadal::flow::{Flow, Others, Shape, end_skips};
use crate::lower::fadal::words::name_planes;
use crate::syntax::{Block, Item, ItemKind, Label, for_each_item};

/// Lowers a program's text; `others` is what is known of the programs of its file, and which of them this is.
pub fn lower(
    text: &ProgramText<'_>,
    others: (&Others, usize),
    source: &[u8],
    file: usize,
    control: &Control,
) -> (Program, Vec<Diagnostic>) {
    let shape = Shape::new(text.blocks, control);
    let mut flow = Flow::new(text.blocks, control, &shape, others);
    let mut lowering = Lowering::new(source, control, &shape);
    let mut head = SourceInfo::default();
    for (at, block) in text.blocks.iter().enumerate() {
        if let Some(state) = flow.at(at) {
            lowering.state = state;
        }
        end_skips(&mut lowering.state, block);
        let codes = Codes::new(&block.items, control);
        lowering.block(at, block, &codes, &mut head);
        let state = std::mem::take(&mut lowering.state);
        lowering.state = flow.behind(at, block, &codes, state);
    }
    drop(flow);
    lowering.finish();
    lowering.check_planes();
    let mut program = lowering.builder.finish(text.name.cloned(), file, head);
    name_planes(&mut program, &lowering.planes);
    (program, lowering.findings.take_list())
}

impl<'b> Lowering<'b> {
    fn block(&mut self, at: usize, block: &'b Block, codes: &Codes<'b, 'b>, head: &mut SourceInfo) {
        self.at = at;
        self.site = site_of(block, self.source);
        self.placed = false;
        for error in &block.errors {
            self.findings.add(Diagnostic::new(error.code, error.span, &*error.message));
        }
        self.enter(at);
        if let Some(item) = block.items.iter().find(|item| matches!(item.kind, ItemKind::Program(_))) {
            // The comments beside the name are the program's.
            *head = SourceInfo { span: block.span, ..std::mem::take(&mut self.site) };
            self.site = SourceInfo { span: block.span, ..SourceInfo::default() };
            self.placed = block.items.iter().all(|other| std::ptr::eq(item, other) || !says_something(other));
        }
        let frame = block.items.iter().all(|item| matches!(item.kind, ItemKind::Tape | ItemKind::EndOfBlock));
        let unparsed = block.items.iter().any(|item| item.kind == ItemKind::Unparsed);
        let skip = self.site.skip;
        if skip == Some(1) {
            let _ = self.rely(Question::SkipLevels, block.span);
        } else if skip.is_some() {
            self.suppose(Question::SkipLevels, "true", block.span);
        }
        let level_fits = skip.is_none_or(|level| (1..=9).contains(&level));
        if !level_fits {
            self.findings.not_understood(block.span, "block skip has the levels 1 to 9");
            self.site.skip = None;
        }
        let skip = skip.filter(|_| level_fits);
        // What changes the flow is jumped over; the rest carries its switch.
        let over = skip.filter(|_| self.flows(block, codes)).map(|level| {
            let (body, next) = (self.builder.fresh(), self.builder.fresh());
            self.end(TermKind::Branch { cond: Box::new(Cond::Switch(level)), then: next, otherwise: body });
            self.builder.start(body);
            self.site.skip = None;
            next
        });
        if unparsed || !level_fits {
            self.hole();
        } else {
            self.items(&block.items, codes);
        }
        if !self.placed && !frame {
            self.empty(block);
        }
        if let Some(next) = over {
            self.builder.start(next);
        }
    }

    /// A block that became no statement: its comments are kept.
    fn empty(&mut self, block: &Block) {
        let mut site = self.take_site();
        let silent =
            block.items.iter().any(|item| matches!(item.kind, ItemKind::Label(_) | ItemKind::Set(_)))
                || self.shape.area_end == Some(self.at)
                || self.shape.begins(self.at).is_some();
        if !self.builder.is_open() {
            // A statement here would be a block of its own that nothing reaches.
            self.carried.extend(site.comments.drain(..));
        } else if !silent || !site.comments.is_empty() {
            self.builder.push(StmtKind::Comment, site);
        }
    }

    fn flows(&self, block: &Block, codes: &Codes<'_, '_>) -> bool {
        let mut jumps = false;
        for_each_item(&block.items, &mut |item| {
            jumps |= matches!(item.kind, ItemKind::Goto(_) | ItemKind::Start(_) | ItemKind::If { .. });
        });
        jumps || !steps(&block.items, codes).is_empty()
    }

    /// Begins what begins at a block: a subroutine, the main part, a jump target.
    fn enter(&mut self, at: usize) {
        let shape = self.shape;
        if let Some(sub) = shape.ends(at)
            && self.builder.is_open()
        {
            if sub.followed {
                self.suppose(Question::SubEndsAtNext, "true", self.site.span);
            } else {
                let message = format!(
                    "the subroutine L{}00 runs into the end of its area: end it with M17",
                    sub.number
                );
                self.once(Code::SubroutineLeft, "area", self.site.span, message);
            }
            self.builder.end(TermKind::Return { to: None }, SourceInfo::default());
        }
        if shape.subs.first().is_some_and(|sub| sub.blocks.start == at) && self.builder.is_open() {
            if !self.builder.is_at_start() {
                self.suppose(Question::SubAreaEntered, "true", self.site.span);
            }
            let main = self.entry(shape.main);
            self.builder.end(TermKind::Jump(main), SourceInfo::default());
        }
        let labels = shape.labels.get(&at);
        let main = at == shape.main && !shape.subs.is_empty();
        if main || labels.is_some() || shape.begins(at).is_some() {
            let id = self.entry(at);
            self.builder.start(id);
            if let Some(sub) = shape.begins(at).and_then(|place| shape.subs.get(place)) {
                self.builder.label(Label::Name(format!("L{}00", sub.number)));
            }
            labels.into_iter().flatten().for_each(|label| self.builder.label(label.clone()));
        }
    }

    /// Everything that a block says, in order; words that belong together are one NC block.
    fn items(&mut self, items: &'b [Item], codes: &Codes<'b, 'b>) {
        if items
            .iter()
            .any(|item| matches!(item.kind, ItemKind::Word(_) | ItemKind::Assign { by_sign: true, .. }))
        {
            if self.nc(items, codes).is_none() {
                self.hole();
            }
            return;
        }
        for item in items.iter().filter(|item| says_something(item)) {
            if self.statement(item, 0).is_none() {
                self.hole();
            }
        }
    }

    fn finish(&mut self) {
        if !self.carried.is_empty() {
            let comments = self.carried.drain(..).collect();
            self.builder.push(StmtKind::Comment, SourceInfo { comments, ..SourceInfo::default() });
        }
        self.nowhere.close(&mut self.builder);
        let shape = self.shape;
        let Some(last) = shape.subs.last() else { return self.note_modes() };
        if shape.area_end.is_none() {
            let message = format!("no M30 closes the subroutines up to L{:02}00", last.number);
            self.findings.add(Diagnostic::new(Code::SubroutineArea, self.site.span, message));
        }
        self.note_modes();
    }

    fn note_modes(&mut self) {
        if let (true, Some(span)) = (self.spelled_out, self.reads_motion) {
            let message = "this reads the motion mode, and the conversion writes G1 for a straight move \
                           in an arc mode: write G1 there yourself";
            self.findings.not_understood(span, message);
        }
    }
}
