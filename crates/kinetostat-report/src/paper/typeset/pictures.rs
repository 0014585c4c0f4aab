//! Drawings on pages: SVG as the HTML of a paper has it, with the letters of the paper.

use std::sync::Arc;

use krilla::geom::{Size, Transform};
use krilla::surface::Surface;
use krilla_svg::{SurfaceExt, SvgSettings};
use usvg::{Options, Tree};

use crate::paper::typeset::letters::{BOLD, FAMILY, Letters, REGULAR};

/// A drawing that was read.
#[derive(Clone, Debug)]
pub(super) struct Picture(Arc<Tree>);

impl Picture {
    /// None if it is no SVG, which tests rule out. Letters that there are none of stand as in the text of a paper.
    pub(super) fn read(letters: &Letters, svg: &str) -> Option<Self> {
        let written = |letter: char| match letter {
            '↑' => "^".to_owned(),
            own if own.is_ascii() => own.to_string(),
            own => letters.writable(&own.to_string()).replace(['<', '>'], ""),
        };
        let svg: String = svg.chars().map(written).collect();
        let mut options = Options {
            font_family: FAMILY.to_owned(),
            ..Options::default()
        };
        let fonts = options.fontdb_mut();
        fonts.load_font_data(REGULAR.to_vec());
        fonts.load_font_data(BOLD.to_vec());
        // Style sheets name fonts of screens, and last any without serifs.
        fonts.set_sans_serif_family(FAMILY);
        Tree::from_str(&svg, &options)
            .ok()
            .map(|tree| Self(Arc::new(tree)))
    }

    /// Width and height.
    pub(super) fn size(&self) -> [f32; 2] {
        let size = self.0.size();
        [size.width(), size.height()]
    }

    pub(super) fn draw(&self, surface: &mut Surface<'_>, [x, y]: [f32; 2], size: [f32; 2]) {
        let Some(size) = Size::from_wh(size[0], size[1]) else {
            return;
        };
        surface.push_transform(&Transform::from_translate(x, y));
        // None would be of a drawing without a size.
        let _ = surface.draw_svg(&self.0, size, SvgSettings::default());
        surface.pop();
    }
}
