//! Sections whose beams need more than an Euler-Bernoulli cantilever: tapered ones, and ones that
//! bend by shear too; and materials by name. The formulas are those of `kinetostat-links`.

use kinetostat::BeamSection;
use kinetostat_links::{Material, Properties, SectionShape, Shear, cantilever, material};
use nalgebra::Matrix6;

use crate::elements::quantity::{MM, ReadResult, choice, choices, positive};
use crate::problem::{Finding, KeyPath};
use crate::schema::{HollowBox, IBeam, Rectangle, Round, Section, Tip, Tube};
use crate::text::hints::unknown;

/// A tapered beam, or one that bends by shear too.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Beam {
    root: SectionShape,
    tip: SectionShape,
    youngs_modulus: f64,
    poissons_ratio: f64,
    shear: Shear,
}

impl Beam {
    /// A beam between two shapes; its moduli are those of the section without taper and shear.
    pub(crate) fn new(
        root: SectionShape,
        tip: SectionShape,
        plain: &BeamSection,
        shear: Shear,
    ) -> Self {
        Self {
            root,
            tip,
            youngs_modulus: plain.youngs_modulus,
            poissons_ratio: plain.youngs_modulus / (2.0 * plain.shear_modulus) - 1.0,
            shear,
        }
    }

    pub(crate) fn cantilever(&self, place: &KeyPath, length: f64) -> ReadResult<Matrix6<f64>> {
        cantilever(
            &self.root,
            &self.tip,
            length,
            self.youngs_modulus,
            self.poissons_ratio,
            self.shear,
        )
        .map_err(|e| Finding::new(place, e.message, e.help))
    }

    /// Stiffnesses of equal pieces from the root on, each at its far end; none where all are alike.
    pub(crate) fn pieces(
        &self,
        place: &KeyPath,
        length: f64,
        segments: u32,
    ) -> ReadResult<Option<Vec<Matrix6<f64>>>> {
        if segments == 1 || self.root == self.tip {
            return Ok(None);
        }
        let at = |k: u32| {
            let share = f64::from(k) / f64::from(segments);
            self.root.towards(&self.tip, share).unwrap_or(self.root)
        };
        let piece = |k: u32| {
            let own = Self {
                root: at(k),
                tip: at(k + 1),
                ..*self
            };
            own.cantilever(place, length / f64::from(segments))
        };
        (0..segments)
            .map(piece)
            .collect::<ReadResult<_>>()
            .map(Some)
    }
}

/// The material that a section names.
pub(crate) fn material_of(place: &KeyPath, s: &Section) -> ReadResult<Option<&'static Material>> {
    let Some(name) = &s.material else {
        return Ok(None);
    };
    match material(name) {
        Some(found) => Ok(Some(found)),
        None => {
            let known: Vec<&str> = kinetostat_links::MATERIALS.iter().map(|m| m.name).collect();
            let place = place.key("material");
            Err(unknown(&place, "material", name, &known, "give the moduli"))
        }
    }
}

/// The shape of a section, if it has one in sizes.
pub(crate) fn root(place: &KeyPath, s: &Section) -> ReadResult<Option<SectionShape>> {
    one(
        place,
        &s.tube,
        &s.round,
        &s.rectangle,
        &s.i_beam,
        &s.hollow_box,
    )
}

pub(crate) fn far_end(place: &KeyPath, t: &Tip) -> ReadResult<SectionShape> {
    let given = [
        t.tube.is_some(),
        t.round.is_some(),
        t.rectangle.is_some(),
        t.i_beam.is_some(),
        t.hollow_box.is_some(),
    ];
    if given.into_iter().filter(|g| *g).count() != 1 {
        return Err(Finding::new(
            place,
            "the far end has no shape, or several",
            "write one shape, of the same kind as the section's own",
        ));
    }
    let shape = one(
        place,
        &t.tube,
        &t.round,
        &t.rectangle,
        &t.i_beam,
        &t.hollow_box,
    )?;
    shape.ok_or_else(|| Finding::new(place, "the far end has no shape", "write one"))
}

fn one(
    place: &KeyPath,
    tube: &Option<Tube>,
    round: &Option<Round>,
    rectangle: &Option<Rectangle>,
    i_beam: &Option<IBeam>,
    hollow_box: &Option<HollowBox>,
) -> ReadResult<Option<SectionShape>> {
    let shape = if let Some(t) = tube {
        let place = place.key("tube");
        let outer = choices!(t, (outer_diameter_mm, MM), (outer_diameter_m, 1.0));
        let inner = choices!(t, (inner_diameter_mm, MM), (inner_diameter_m, 1.0));
        SectionShape::Tube {
            outer: positive(&place, "outer diameter", &outer)?.value,
            inner: positive(&place, "inner diameter", &inner)?.value,
        }
    } else if let Some(r) = round {
        let diameter = choices!(r, (diameter_mm, MM), (diameter_m, 1.0));
        SectionShape::Tube {
            outer: positive(&place.key("round"), "diameter", &diameter)?.value,
            inner: 0.0,
        }
    } else if let Some(r) = rectangle {
        let place = place.key("rectangle");
        let width = choices!(r, (width_mm, MM), (width_m, 1.0));
        let height = choices!(r, (height_mm, MM), (height_m, 1.0));
        SectionShape::Rectangle {
            width: positive(&place, "width", &width)?.value,
            height: positive(&place, "height", &height)?.value,
        }
    } else if let Some(i) = i_beam {
        let place = place.key("i_beam");
        let size = |what: &str, key: &'static str, value| -> ReadResult<f64> {
            Ok(positive(&place, what, &[choice(key, value, MM)])?.value)
        };
        SectionShape::IBeam {
            width: size("width", "width_mm", i.width_mm)?,
            height: size("height", "height_mm", i.height_mm)?,
            flange: size("flange", "flange_mm", i.flange_mm)?,
            web: size("web", "web_mm", i.web_mm)?,
        }
    } else if let Some(b) = hollow_box {
        let place = place.key("hollow_box");
        let size = |what: &str,
                    choices: &[crate::elements::quantity::Choice<f64>]|
         -> ReadResult<f64> { Ok(positive(&place, what, choices)?.value) };
        let wall = |key: &'static str, own: Option<f64>| {
            [choice("wall_mm", b.wall_mm, MM), choice(key, own, MM)]
        };
        SectionShape::HollowBox {
            width: size("width", &choices!(b, (width_mm, MM)))?,
            height: size("height", &choices!(b, (height_mm, MM)))?,
            side_wall: size("wall", &wall("side_wall_mm", b.side_wall_mm))?,
            top_wall: size("wall", &wall("top_wall_mm", b.top_wall_mm))?,
        }
    } else {
        return Ok(None);
    };
    let checked: Result<Properties, _> = shape.properties(0.3);
    match checked {
        Ok(_) => Ok(Some(shape)),
        Err(e) => Err(Finding::new(place, e.message, e.help)),
    }
}
