//! Drawings on pages: SVG as the HTML of a paper has it, with the letters of the paper.

use std::sync::Arc;

use krilla::geom::{Size, Transform};
use krilla::surface::Surface;
use krilla_svg::{SurfaceExt, SvgSettings};
use usvg::{Options, Tree};

use crate::paper::typeset::layout::{BOTTOM, HEIGHT, LEFT, Mark, RIGHT, Setter, TOP};
use crate::paper::typeset::letters::{BOLD, FAMILY, Letters, REGULAR};

/// Largest height of a drawing.
const TALLEST: f32 = 360.0;

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

impl Setter<'_> {
    /// A drawing as wide as the text, or as tall as it may be, with what it shows below it on the same page.
    pub(super) fn picture(&mut self, svg: &str, shows: &str) {
        let Some(picture) = Picture::read(self.letters, svg) else {
            return;
        };
        let own = picture.0.size();
        let most = TALLEST.min(HEIGHT - TOP - BOTTOM - 60.0);
        let scale = ((RIGHT - LEFT) / own.width()).min(most / own.height());
        let size = [scale * own.width(), scale * own.height()];
        self.y += 6.0;
        self.room(size[1] + 24.0);
        let x = LEFT + 0.5 * (RIGHT - LEFT - size[0]);
        self.put(Mark::Picture {
            at: [x, self.y],
            size,
            picture,
        });
        self.y += size[1] + 2.0;
        self.caption(shows);
    }
}
