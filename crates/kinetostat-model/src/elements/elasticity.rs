//! Meanings of the name of a link's elasticity: a section, a tapered beam, a matrix.

use kinetostat::BeamSection;
use kinetostat_links::Shear;
use nalgebra::Matrix6;

use crate::elements::quantity::ReadResult;
use crate::elements::section::section;
use crate::elements::shape::{Beam, far_end, root};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Section, ShearWord};

/// Elasticity that a link's name refers to.
#[derive(Clone, Debug)]
pub(crate) enum Elasticity {
    /// A section: the stiffness follows from the length.
    Section(BeamSection),
    /// A section by its rigidities alone: the moduli are one, and the area is no area.
    Rigidities(BeamSection),
    /// A tapered beam, or one that bends by shear too.
    Beam(Box<Beam>),
    /// The stiffness of the far end, SI.
    Matrix(Box<Matrix6<f64>>),
}

impl Elasticity {
    /// The stiffness of the far end of a link of this length, m: in its own axes for sections, as it
    /// is for a matrix.
    pub(crate) fn cantilever(&self, place: &KeyPath, length: f64) -> ReadResult<Matrix6<f64>> {
        match self {
            Self::Section(section) | Self::Rigidities(section) => section.cantilever(length).map_err(|error| {
                Finding::new(
                    place,
                    error.to_string(),
                    "give every measure as a positive number, and the outer one larger than the inner one",
                )
            }),
            Self::Beam(beam) => beam.cantilever(place, length),
            Self::Matrix(matrix) => Ok(**matrix),
        }
    }
}

/// Elasticity of the links that name this section.
pub(crate) fn elasticity(
    place: &KeyPath,
    s: &Section,
    warnings: &mut Vec<Finding>,
) -> ReadResult<Elasticity> {
    let plain = section(place, s, warnings)?;
    let shear = match s.shear {
        Some(ShearWord::Timoshenko) => Shear::Timoshenko,
        _ => Shear::None,
    };
    if shear == Shear::None && s.tip.is_none() {
        return Ok(match s.rigidities {
            Some(_) => Elasticity::Rigidities(plain),
            None => Elasticity::Section(plain),
        });
    }
    let Some(root) = root(place, s)? else {
        return Err(Finding::new(
            place,
            "shear and taper need a shape",
            "write tube, round, rectangle, i_beam or hollow_box instead of values or rigidities",
        ));
    };
    let tip = match &s.tip {
        Some(tip) => far_end(&place.key("tip"), tip)?,
        None => root,
    };
    let beam = Beam::new(root, tip, &plain, shear);
    // The validity of a beam does not depend on its length.
    beam.cantilever(place, 1.0)?;
    Ok(Elasticity::Beam(Box::new(beam)))
}
