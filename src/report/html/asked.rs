//! What a person must answer: each thing once, what most depends on first, with a box to tick and room for who and when.

use super::super::questions::{Fact, Question, Questions};
use super::super::{Part, grade};
use super::{Numbers, code, escaped, first, id, link, plural, ticked};
use crate::diag::{Accepted, Severity};
use crate::dialect::Settled;
use std::fmt::Write;

/// All questions; what was refused stands after them.
pub fn questions(out: &mut String, parts: &[Part<'_>], numbers: &Numbers) {
    let questions = Questions::of(parts);
    let (refused, mut open): (Vec<_>, Vec<_>) =
        questions.open.iter().partition(|question| question.code.severity() == Severity::Error);
    open.sort_by_key(|question| (question.danger, question.code, std::cmp::Reverse(question.programs)));
    let facts: usize = questions.machines.iter().map(|machine| machine.facts.len()).sum();
    out.push_str("<h2 id=\"questions\">Questions to answer before the first run</h2>\n");
    if open.is_empty() && facts == 0 {
        out.push_str("<p>None: nothing that was written depends on an answer.</p>\n");
    } else {
        out.push_str(
            "<p class=\"small\">Each stands here once. Those come first that change most if the answer is no. Tick the box when it is \
             answered, and say by whom and when.</p>\n",
        );
    }
    let mut asker = Asker { parts, numbers, next: 1 };
    let (library, programs): (Vec<_>, Vec<_>) = open.into_iter().partition(|question| question.once);
    programs.iter().for_each(|question| asker.ask(out, question, None));
    if !library.is_empty() {
        out.push_str(
            "<h3>What is decided once for the library</h3>\n<p class=\"small\">No program is for review because of it.</p>\n",
        );
    }
    library.iter().for_each(|question| asker.ask(out, question, None));
    for machine in questions.machines.iter().filter(|machine| !machine.facts.is_empty()) {
        let title = &machine.control.dialect().title;
        let place = match &machine.control.profile().file {
            Some(path) => format!("then write the line into {}", escaped(&path.display().to_string())),
            None => format!(
                "then write the line into a machine profile (<code>dialect = \"{}\"</code>) and name it with --machine or in \
                 macroglot.toml",
                escaped(machine.control.name())
            ),
        };
        let _ = writeln!(
            out,
            "<h3>Facts of the {} that no manual confirms</h3>\n<p class=\"small\">Check each on the machine, {place}: the next \
             conversion does not ask again.</p>",
            escaped(title)
        );
        for fact in &machine.facts {
            asker.ask(out, &fact.asked, Some(fact));
        }
    }
    if !refused.is_empty() {
        out.push_str("<h3>Why programs were refused</h3>\n<p class=\"small\">Nothing that can be run was written for them.</p>\n");
        refused.iter().for_each(|question| asker.ask(out, question, None));
    }
    if !questions.accepted.is_empty() {
        out.push_str(
            "<h3 id=\"accepted\">Accepted</h3>\n<p class=\"small\">These were answered before, and stand in the project file. What they \
             concern has not changed since.</p>\n",
        );
        questions.accepted.iter().for_each(|(accepted, question)| asker.accepted(out, accepted, question));
    }
    match questions.notes {
        0 => {}
        notes => {
            _ = writeln!(
                out,
                "<p class=\"small\">{}, which ask nothing, at their lines.</p>",
                plural(notes, "note")
            )
        }
    }
}

struct Asker<'p> {
    parts: &'p [Part<'p>],
    numbers: &'p Numbers,
    next: usize,
}

impl Asker<'_> {
    /// A question with its places, and the line of a machine profile that answers it.
    fn ask(&mut self, out: &mut String, question: &Question<'_>, fact: Option<&Fact<'_>>) {
        let (number, severity) = (self.next, question.code.severity());
        self.next += 1;
        let is_refused = severity == Severity::Error;
        let heading = format!("{number}. {} {}", code(question.code), escaped(question.code.title()));
        let _ = writeln!(out, "<div class=\"question {}\" id=\"q{number}\">", grade(severity));
        let _ = match is_refused {
            true => writeln!(out, "<b>{heading}</b>"),
            false => writeln!(out, "<label><input type=\"checkbox\"> {heading}</label>"),
        };
        let _ = writeln!(out, "<p>{}</p>", ticked(question.text));
        // Of facts the line of the profile says it.
        if let Some(help) = question.help.filter(|_| fact.is_none()) {
            let _ = writeln!(out, "<p>{}</p>", ticked(help));
        }
        if let Some(fact) = fact {
            let _ = writeln!(out, "<pre>{}</pre>", escaped(&profile_line(&fact.settled_by)));
        }
        let (line, text) = &question.line;
        if !text.is_empty() {
            let _ = writeln!(out, "<pre>{line} | {}</pre>", escaped(text));
        }
        let _ = writeln!(out, "<p class=\"small\">{}</p>", self.places(question));
        if !is_refused {
            out.push_str(
                "<div class=\"fields\"><label>Answer <input type=\"text\" class=\"wide\"></label> <label>Who <input type=\"text\"></label> \
                 <label>When <input type=\"text\"></label></div>\n",
            );
        }
        out.push_str("</div>\n");
    }

    /// A question that somebody has answered.
    fn accepted(&mut self, out: &mut String, accepted: &Accepted, question: &Question<'_>) {
        let number = self.next;
        self.next += 1;
        let title = escaped(question.code.title());
        let _ = writeln!(out, "<div class=\"question note\" id=\"q{number}\">");
        let _ = writeln!(
            out,
            "<b>{number}. {} {title}</b>\n<p>{}</p>",
            code(question.code),
            ticked(question.text)
        );
        let _ = writeln!(out, "<p class=\"accepted\">{}</p>", escaped(&accepted.to_string()));
        let _ = writeln!(out, "<p class=\"small\">{}</p>\n</div>", self.places(question));
    }

    /// The programs that a question concerns, with the first line in each.
    fn places(&self, question: &Question<'_>) -> String {
        let named = question.spots.iter().filter_map(|spot| {
            let part = self.parts.get(spot.part)?;
            let program = part.conversion.programs.get(spot.program)?;
            let title = first::title(part, program);
            let name = id(self.numbers.number(spot.part, spot.program));
            Some(link(&name, &format!("{}:{}", escaped(&title), spot.line)))
        });
        let named: Vec<String> = named.collect();
        let more = question.programs.saturating_sub(named.len());
        let more = match more {
            0 => String::new(),
            more => format!(", and {more} more: the list of all programs has their codes"),
        };
        format!("{}: {}{more}", plural(question.programs, "program"), named.join(", "))
    }
}

/// What a machine profile says to settle a fact.
fn profile_line(settled: &Settled) -> String {
    match settled {
        Settled::Confirmed(fact) => format!("confirm = [\"{fact}\"]"),
        Settled::Setting { section, name, values } => {
            format!("[{section}]\n{}", Settled::choice(name, values))
        }
        Settled::Key { name, values } => Settled::choice(name, values),
        Settled::Answer { question, answers } => format!("[behaviours]\n\"{question}\" = {answers}"),
    }
}
