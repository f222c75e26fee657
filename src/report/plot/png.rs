//! A drawing as a PNG.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::sync::Arc;

/// Letters for all texts: a picture looks the same on every machine, also on one without fonts.
const FONT: &[u8] = include_bytes!("font/DejaVuSans.ttf");
/// Its name.
const FAMILY: &str = "DejaVu Sans";

/// Pixels of the PNG for one of the SVG: small letters stay sharp.
const SCALE: f32 = 2.0;

/// Draws one of our SVGs.
///
/// # Errors
/// In words, if the text is no SVG or has no size.
pub fn png(svg: &str) -> Result<Vec<u8>, String> {
    let mut options = Options { font_family: FAMILY.into(), ..Options::default() };
    let fonts = Arc::make_mut(&mut options.fontdb);
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let tree = Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size().scale_by(SCALE).ok_or("the drawing has no size")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or("the drawing is too large")?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| error.to_string())
}
