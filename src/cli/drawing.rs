//! Drawings, as files.

use super::streams::complain;
use crate::library::write_file;
use crate::report::{Coordinates, png};
use std::path::Path;

/// What a drawing counts its places from.
pub fn coordinates(machine: bool) -> Coordinates {
    if machine { Coordinates::Machine } else { Coordinates::Work }
}

/// Writes a drawing to a file: as PNG if its name ends so, else as SVG.
pub fn write(path: &Path, svg: &str, force: bool) -> Result<(), u8> {
    let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    let bytes = match is_png {
        true => png(svg).map_err(|why| complain(format!("{}: {why}", path.display())))?,
        false => svg.as_bytes().to_vec(),
    };
    write_file(path, &bytes, force).map_err(complain)
}
