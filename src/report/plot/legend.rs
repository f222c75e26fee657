//! What the lines and marks of a backplot mean.

use super::path::Path;
use super::{MARGIN, told};
use std::fmt::Write;

/// Colours of tools that people who see few colours tell apart.
const COLOURS: [&str; 9] =
    ["#332288", "#cc6677", "#117733", "#88ccee", "#882255", "#44aa99", "#999933", "#aa4499", "#ddcc77"];

/// The colour of a tool, counted in the order in which they move; grey for those that have none of their own.
pub fn colour(tool: usize) -> &'static str {
    COLOURS.get(tool).copied().unwrap_or("#777")
}

/// The kinds of lines and marks, and below them the tools.
pub fn legend(path: &Path, top: f64, out: &mut String) {
    let middle = top - 4.0;
    let mut x = MARGIN;
    let mut entry = |mark: String, wide: f64, name: &str| {
        let _ = writeln!(out, "{mark} transform=\"translate({x:.0})\"/>");
        let _ = writeln!(out, "<text x=\"{:.0}\" y=\"{top:.0}\">{name}</text>", x + wide);
        x += wide + 14.0 + 7.0 * name.len() as f64;
    };
    let line = |y: f64, style: &str| format!("<path d=\"M0 {y:.0}h40\" fill=\"none\" {style}");
    entry(line(middle, "stroke=\"#c60\" stroke-dasharray=\"5 3\""), 46.0, "rapid");
    entry(line(middle, &format!("stroke=\"{}\" stroke-width=\"1.4\"", colour(0))), 46.0, "feed");
    if path.strokes.iter().any(|stroke| stroke.aside != 0.0) {
        let style = format!("stroke=\"{}\" stroke-width=\"0.6\"", colour(0));
        entry(line(middle, &style), 46.0, "middle of the cutter, about");
    }
    if !path.holes.is_empty() {
        let ring = "fill=\"none\" stroke=\"#080\" stroke-width=\"1.5\"";
        entry(format!("<circle r=\"4\" cy=\"{middle:.0}\" {ring}"), 10.0, "hole");
    }
    if !path.touches.is_empty() {
        let style = "stroke=\"#b00\" stroke-width=\"1.5\"";
        entry(format!("<path d=\"M-4 {middle:.0}h8m-4 -4v8\" {style}"), 10.0, "touch");
    }
    if !path.strokes.is_empty() {
        entry(format!("<circle r=\"3\" cy=\"{middle:.0}\" fill=\"#c60\""), 10.0, "start");
        entry(format!("<path d=\"M-3 {:.0}h6v6h-6z\" fill=\"#000\"", middle - 3.0), 10.0, "end");
    }
    tools(path, top + 20.0, out);
}

fn tools(path: &Path, top: f64, out: &mut String) {
    if path.tools.iter().all(Option::is_none) {
        return;
    }
    let mut x = MARGIN;
    let named = path.tools.iter().take(COLOURS.len()).map(|tool| match tool {
        Some(tool) => format!("T{tool}"),
        None => "tool at the start".to_owned(),
    });
    let others = (path.tools.len() > COLOURS.len()).then(|| "other tools".to_owned());
    for (at, name) in named.chain(others).enumerate() {
        let name = told(&name);
        let _ = writeln!(
            out,
            "<path d=\"M{x:.0} {:.0}h24\" stroke=\"{}\" stroke-width=\"3\"/><text x=\"{:.0}\" y=\"{top:.0}\">{name}</text>",
            top - 4.0,
            colour(at),
            x + 30.0
        );
        x += 46.0 + 7.0 * name.chars().count() as f64;
    }
}
