//! Sections, stiffness matrices and springs with a knee: from what is written to SI.

use std::collections::BTreeMap;

use kinetostat::model::{BilinearLaw, SpringLaw};
use kinetostat::spatial::turn_matrix;
use kinetostat::{BeamSection, MotionKind};
use kinetostat_links::Shear;
use nalgebra::{Matrix6, Unit, Vector3};

use crate::elements::placement::{direction, frame_along};
use crate::elements::quantity::{Choice, DEG, MM, ReadResult, by_kind, choices, forbid, positive};
use crate::elements::section::section;
use crate::elements::shape::{Beam, far_end, root};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Document, Knee, Section, ShearWord, Spring6, Stiffness};
use crate::text::hints::unknown;

/// Sections and stiffnesses by name. `None`: described wrongly, and reported already.
#[derive(Default)]
pub(crate) struct Elastic {
    sections: BTreeMap<String, Option<Elasticity>>,
    stiffnesses: BTreeMap<String, Option<Matrix6<f64>>>,
}

impl Elastic {
    /// Converts every section and stiffness of a document.
    pub(crate) fn new(
        document: &Document,
        errors: &mut Vec<Finding>,
        warnings: &mut Vec<Finding>,
    ) -> Self {
        let mut this = Self::default();
        let sections = KeyPath::root().key("section");
        for (name, written) in &document.section {
            let converted = elasticity(&sections.key(name), written, warnings);
            let entry = converted.map_err(|f| errors.push(f)).ok();
            this.sections.insert(name.clone(), entry);
        }
        let stiffnesses = KeyPath::root().key("stiffness");
        for (name, written) in &document.stiffness {
            let place = stiffnesses.key(name);
            if this.sections.contains_key(name) {
                errors.push(Finding::new(
                    &place,
                    format!("'{name}' names a section and a stiffness"),
                    "rename one of them: a link refers to both by name",
                ));
            }
            let converted = this.stiffness(&place, written);
            let entry = converted.map_err(|f| errors.extend(f)).ok();
            this.stiffnesses.insert(name.clone(), entry);
        }
        this
    }

    /// The section or stiffness of that name; `Err(None)` where it is known but was wrong.
    pub(crate) fn named(&self, place: &KeyPath, name: &str) -> Result<Elasticity, Option<Finding>> {
        if let Some(section) = self.sections.get(name) {
            return section.clone().ok_or(None);
        }
        if let Some(matrix) = self.stiffnesses.get(name) {
            return matrix.map(|m| Elasticity::Matrix(Box::new(m))).ok_or(None);
        }
        let known: Vec<&str> = self
            .sections
            .keys()
            .chain(self.stiffnesses.keys())
            .map(String::as_str)
            .collect();
        Err(Some(unknown(
            place,
            "section or stiffness",
            name,
            &known,
            "write a table [section.NAME] or [stiffness.NAME]",
        )))
    }

    /// The matrix of a six-dimensional spring.
    pub(crate) fn spring6(
        &self,
        place: &KeyPath,
        spring: &Spring6,
    ) -> Result<Matrix6<f64>, Option<Finding>> {
        match spring {
            Spring6::Inline(stiffness) => self.stiffness(place, stiffness),
            Spring6::Named(name) => match self.stiffnesses.get(name) {
                Some(matrix) => matrix.ok_or(None),
                None if self.sections.contains_key(name) => Err(Some(Finding::new(
                    place,
                    format!("'{name}' is a section; a spring has no length"),
                    format!(
                        "write spring6 = {{ section = \"{name}\", length_mm = ... }} or link = \"{name}\""
                    ),
                ))),
                None => {
                    let known: Vec<&str> = self.stiffnesses.keys().map(String::as_str).collect();
                    Err(Some(unknown(
                        place,
                        "stiffness",
                        name,
                        &known,
                        "write a table [stiffness.NAME]",
                    )))
                }
            },
        }
    }

    fn stiffness(&self, place: &KeyPath, s: &Stiffness) -> Result<Matrix6<f64>, Option<Finding>> {
        let matrix = self.unturned(place, s)?;
        let matrix = match &s.along {
            Some(axis) => along(&matrix, &direction(&place.key("along"), axis)?),
            None => matrix,
        };
        Ok(matrix)
    }

    fn unturned(&self, place: &KeyPath, s: &Stiffness) -> Result<Matrix6<f64>, Option<Finding>> {
        let matrices = choices!(s, (matrix_n_m_rad, 1.0), (matrix_n_mm_rad, MM));
        let diagonals = choices!(s, (diagonal_n_m_rad, 1.0), (diagonal_n_mm_rad, MM));
        let lengths = choices!(s, (length_mm, MM), (length_m, 1.0));
        let mut forms = matrices
            .iter()
            .filter(|c| c.value.is_some())
            .map(|c| c.key)
            .chain(
                diagonals
                    .iter()
                    .filter(|c| c.value.is_some())
                    .map(|c| c.key),
            )
            .chain(s.section.as_ref().map(|_| "section"));
        let (one, other) = (forms.next(), forms.next());
        if let (Some(one), Some(other)) = (one, other) {
            return Err(Some(Finding::new(
                &place.key(other),
                format!("the stiffness is given twice: '{one}' and '{other}'"),
                "keep one of them",
            )));
        }
        if s.section.is_none() {
            forbid(
                place,
                &lengths,
                "a length belongs to a section",
                "write section = \"NAME\" too, or leave the length out",
            )?;
        }
        for c in &matrices {
            if let Some(rows) = &c.value {
                let place = place.key(c.key);
                let matrix = Matrix6::from_fn(|i, j| rows[i][j]);
                check_definite(&place, &matrix)?;
                return Ok(in_si(&matrix, c.factor));
            }
        }
        for c in &diagonals {
            if let Some(diagonal) = &c.value {
                let matrix = Matrix6::from_diagonal(&nalgebra::Vector6::from(*diagonal));
                check_definite(&place.key(c.key), &matrix)?;
                return Ok(in_si(&matrix, c.factor));
            }
        }
        let Some(name) = &s.section else {
            return Err(Some(Finding::new(
                place,
                "the stiffness is missing",
                "write matrix_n_mm_rad, matrix_n_m_rad, diagonal_n_mm_rad, diagonal_n_m_rad, or section with length_mm",
            )));
        };
        let length = positive(place, "length", &lengths)?.value;
        match self.sections.get(name) {
            Some(Some(section)) => Ok(section.cantilever(place, length)?),
            Some(None) => Err(None),
            None => {
                let known: Vec<&str> = self.sections.keys().map(String::as_str).collect();
                Err(Some(unknown(
                    &place.key("section"),
                    "section",
                    name,
                    &known,
                    "write a table [section.NAME]",
                )))
            }
        }
    }
}

/// A matrix in axes of which the first lies along `x`, as the frame sees it.
pub(crate) fn along(matrix: &Matrix6<f64>, x: &Unit<Vector3<f64>>) -> Matrix6<f64> {
    let turn = turn_matrix(&frame_along(x));
    turn * matrix * turn.transpose()
}

/// `length` is the unit of length in m: blocks N/length, N/rad, N length/rad.
fn in_si(matrix: &Matrix6<f64>, length: f64) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| {
        matrix[(i, j)]
            * match (i < 3, j < 3) {
                (true, true) => 1.0 / length,
                (false, false) => length,
                _ => 1.0,
            }
    })
}

/// Smallest eigenvalue of a scaled stiffness matrix that is distinct from rounding.
const SINGULAR: f64 = 1e-12;

/// Symmetric and positive definite, metres and radians scaled by the diagonal.
fn check_definite(place: &KeyPath, k: &Matrix6<f64>) -> ReadResult<()> {
    const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
    if let Some(i) = (0..6).find(|&i| k[(i, i)] <= 0.0) {
        return Err(Finding::new(
            place,
            format!(
                "the stiffness in direction {} (entry {}) is {}, a number above zero is needed",
                NAMES[i],
                i + 1,
                k[(i, i)]
            ),
            "a direction that nothing holds is a passive joint",
        ));
    }
    let scale: Vec<f64> = (0..6).map(|i| k[(i, i)].sqrt()).collect();
    let scaled = Matrix6::from_fn(|i, j| k[(i, j)] / scale[i] / scale[j]);
    for i in 0..6 {
        for j in 0..i {
            if (scaled[(i, j)] - scaled[(j, i)]).abs() > 1e-9 {
                return Err(Finding::new(
                    &place.index(i),
                    format!(
                        "the matrix is not symmetric: row {} column {} is {}, row {} column {} is {}",
                        i + 1,
                        j + 1,
                        k[(i, j)],
                        j + 1,
                        i + 1,
                        k[(j, i)]
                    ),
                    "a spring stores energy, so its matrix is symmetric: correct one of the two",
                ));
            }
        }
    }
    // An entry above 1 makes a 2 x 2 minor singular; leaving it here keeps the search for
    // eigenvalues among numbers of order one.
    let crossed = (0..6).any(|i| (0..i).any(|j| scaled[(i, j)].abs() > 1.0 + SINGULAR));
    let least = match crossed {
        true => -1.0,
        false => scaled.symmetric_eigenvalues().min(),
    };
    if least.abs() <= SINGULAR {
        return Err(Finding::new(
            place,
            format!(
                "the matrix is not positive definite, or couples a motion so much softer than the others that numbers of 16 digits do not hold it (smallest scaled eigenvalue {least:.2e}, more than {SINGULAR:e} is needed)"
            ),
            "a direction that nothing holds is a passive joint; a very soft one is held where the matrix is diagonal: turn the frame into the spring's principal axes before it and back after it",
        ));
    }
    if least <= SINGULAR {
        return Err(Finding::new(
            place,
            "the matrix is not positive definite",
            "some motion would need no force or give energy back; check signs and units of the entries off the diagonal",
        ));
    }
    Ok(())
}

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

/// The law of a spring of this stiffness (SI) up to its knee.
pub(crate) fn knee_law(
    place: &KeyPath,
    kind: MotionKind,
    stiffness: f64,
    knee: &Knee,
) -> ReadResult<SpringLaw> {
    let positive = |what: &str, lengths: &[Choice<f64>], angles: &[Choice<f64>]| {
        let keys = |choices: &[Choice<f64>]| {
            let keys: Vec<&str> = choices.iter().map(|c| c.key).collect();
            keys.join(" or ")
        };
        let right = match kind {
            MotionKind::Prismatic => keys(lengths),
            MotionKind::Revolute => keys(angles),
        };
        match by_kind(place, what, kind, lengths, angles)? {
            Some(given) if given.value > 0.0 => Ok(given.value),
            Some(given) => Err(Finding::new(
                &place.key(given.key),
                format!(
                    "the {what} is {}, a number above zero is needed",
                    given.value
                ),
                format!("correct '{}'", given.key),
            )),
            None => Err(Finding::new(
                place,
                format!("the {what} is missing"),
                format!("write {right}"),
            )),
        }
    };
    let knee_at = positive(
        "deflection at the knee",
        &choices!(knee, (at_mm, MM), (at_m, 1.0)),
        &choices!(knee, (at_deg, DEG), (at_rad, 1.0)),
    )?;
    let beyond = positive(
        "stiffness beyond the knee",
        &choices!(knee, (then_n_per_m, 1.0), (then_n_per_mm, 1.0 / MM)),
        &choices!(knee, (then_n_m_per_rad, 1.0), (then_n_mm_per_rad, MM)),
    )?;
    Ok(SpringLaw::Bilinear(BilinearLaw {
        stiffness,
        beyond,
        knee: knee_at,
    }))
}
