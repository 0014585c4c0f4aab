//! Sections and stiffness matrices: from what is written to SI.

use std::collections::BTreeMap;

use kinetostat::{BeamSection, turn_matrix};
use nalgebra::{Matrix6, Unit, Vector3};

use crate::hints;
use crate::placement::{direction, frame_along};
use crate::problem::{Finding, Place};
use crate::quantity::{Choice, Found, MM, choice, forbid, pick, positive};
use crate::schema::{Document, Section, Spring6, Stiffness};

/// Sections and stiffnesses by name. `None`: described wrongly, and reported already.
pub(crate) struct Elastic {
    sections: BTreeMap<String, Option<BeamSection>>,
    stiffnesses: BTreeMap<String, Option<Matrix6<f64>>>,
}

/// What a link's name may stand for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Elasticity {
    /// A section: the stiffness follows from the length.
    Section(BeamSection),
    /// The stiffness of the far end, SI.
    Matrix(Matrix6<f64>),
}

impl Elastic {
    /// Converts every section and stiffness of a document.
    pub(crate) fn new(
        document: &Document,
        errors: &mut Vec<Finding>,
        warnings: &mut Vec<Finding>,
    ) -> Self {
        let mut this = Self {
            sections: BTreeMap::new(),
            stiffnesses: BTreeMap::new(),
        };
        let sections = Place::root().key("section");
        for (name, written) in &document.section {
            let converted = section(&sections.key(name), written, warnings);
            let entry = converted.map_err(|f| errors.push(f)).ok();
            this.sections.insert(name.clone(), entry);
        }
        let stiffnesses = Place::root().key("stiffness");
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
    pub(crate) fn named(&self, place: &Place, name: &str) -> Result<Elasticity, Option<Finding>> {
        if let Some(section) = self.sections.get(name) {
            return section.map(Elasticity::Section).ok_or(None);
        }
        if let Some(matrix) = self.stiffnesses.get(name) {
            return matrix.map(Elasticity::Matrix).ok_or(None);
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
        place: &Place,
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

    fn stiffness(&self, place: &Place, s: &Stiffness) -> Result<Matrix6<f64>, Option<Finding>> {
        let matrix = self.unturned(place, s)?;
        let matrix = match &s.along {
            Some(axis) => along(&matrix, &direction(&place.key("along"), axis)?),
            None => matrix,
        };
        Ok(matrix)
    }

    fn unturned(&self, place: &Place, s: &Stiffness) -> Result<Matrix6<f64>, Option<Finding>> {
        let matrices = [
            choice("matrix_n_m_rad", s.matrix_n_m_rad, 1.0),
            choice("matrix_n_mm_rad", s.matrix_n_mm_rad, MM),
        ];
        let diagonals = [
            choice("diagonal_n_m_rad", s.diagonal_n_m_rad, 1.0),
            choice("diagonal_n_mm_rad", s.diagonal_n_mm_rad, MM),
        ];
        let lengths = [
            choice("length_mm", s.length_mm, MM),
            choice("length_m", s.length_m, 1.0),
        ];
        let mut ways = matrices
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
        let (one, other) = (ways.next(), ways.next());
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
                judge(&place, &matrix)?;
                return Ok(in_si(&matrix, c.factor));
            }
        }
        for c in &diagonals {
            if let Some(diagonal) = &c.value {
                let matrix = Matrix6::from_diagonal(&nalgebra::Vector6::from(*diagonal));
                judge(&place.key(c.key), &matrix)?;
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
            Some(section) => section.map(|s| s.cantilever(length)).ok_or(None),
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

/// A name that refers to nothing.
pub(crate) fn unknown(
    place: &Place,
    what: &str,
    name: &str,
    known: &[&str],
    otherwise: &str,
) -> Finding {
    let help = match hints::nearest(name, known) {
        Some(word) => format!("did you mean '{word}'?"),
        None if known.is_empty() => format!("there are none; {otherwise}"),
        None => format!("there are: {}; or {otherwise}", known.join(", ")),
    };
    Finding::new(place, format!("there is no {what} named '{name}'"), help)
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

/// Symmetric and positive definite, metres and radians balanced by the diagonal.
fn judge(place: &Place, k: &Matrix6<f64>) -> Found<()> {
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
    let balanced = Matrix6::from_fn(|i, j| k[(i, j)] / scale[i] / scale[j]);
    for i in 0..6 {
        for j in 0..i {
            if (balanced[(i, j)] - balanced[(j, i)]).abs() > 1e-9 {
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
    let least = balanced.symmetric_eigenvalues().min();
    if least.is_nan() || least <= 1e-12 {
        return Err(Finding::new(
            place,
            format!(
                "the matrix is not positive definite (smallest balanced eigenvalue {least:.2e})"
            ),
            "some motion would need no force or give energy back; check signs and units of the entries off the diagonal",
        ));
    }
    Ok(())
}

fn modulus(
    place: &Place,
    what: &str,
    choices: &[Choice<f64>],
    warnings: &mut Vec<Finding>,
) -> Found<f64> {
    let given = positive(place, what, choices)?;
    if !(1e8..=2e12).contains(&given.value) {
        warnings.push(Finding::new(
            &place.key(given.key),
            format!("a {what} of {:.3e} Pa is no usual solid", given.value),
            "steel has 210 GPa (shear 80), aluminium 70 (26), polymers 1 to 4; check the unit in the key",
        ));
    }
    Ok(given.value)
}

fn section(place: &Place, s: &Section, warnings: &mut Vec<Finding>) -> Found<BeamSection> {
    let mut shapes = [
        s.tube.as_ref().map(|_| "tube"),
        s.round.as_ref().map(|_| "round"),
        s.rectangle.as_ref().map(|_| "rectangle"),
        s.values.as_ref().map(|_| "values"),
        s.rigidities.as_ref().map(|_| "rigidities"),
    ]
    .into_iter()
    .flatten();
    let Some(shape) = shapes.next() else {
        return Err(Finding::new(
            place,
            "the section has no shape",
            "write tube, round, rectangle, values or rigidities",
        ));
    };
    if let Some(other) = shapes.next() {
        return Err(Finding::new(
            &place.key(other),
            format!("the shape is given twice: '{shape}' and '{other}'"),
            "keep one of them",
        ));
    }
    let young = [
        choice("youngs_modulus_gpa", s.youngs_modulus_gpa, 1e9),
        choice("youngs_modulus_mpa", s.youngs_modulus_mpa, 1e6),
        choice("youngs_modulus_pa", s.youngs_modulus_pa, 1.0),
    ];
    let shear = [
        choice("shear_modulus_gpa", s.shear_modulus_gpa, 1e9),
        choice("shear_modulus_mpa", s.shear_modulus_mpa, 1e6),
        choice("shear_modulus_pa", s.shear_modulus_pa, 1.0),
    ];
    let poisson = [choice("poissons_ratio", s.poissons_ratio, 1.0)];
    if let Some(r) = &s.rigidities {
        for moduli in [&young[..], &shear[..], &poisson[..]] {
            forbid(
                place,
                moduli,
                "the rigidities hold the material already",
                "leave the moduli out, or write values instead of rigidities",
            )?;
        }
        let place = place.key("rigidities");
        let bending_y = [
            choice("bending_y_n_mm2", r.bending_y_n_mm2, MM * MM),
            choice("bending_y_n_m2", r.bending_y_n_m2, 1.0),
        ];
        let bending_z = [
            choice("bending_z_n_mm2", r.bending_z_n_mm2, MM * MM),
            choice("bending_z_n_m2", r.bending_z_n_m2, 1.0),
        ];
        let torsion = [
            choice("torsion_n_mm2", r.torsion_n_mm2, MM * MM),
            choice("torsion_n_m2", r.torsion_n_m2, 1.0),
        ];
        return Ok(BeamSection {
            youngs_modulus: 1.0,
            shear_modulus: 1.0,
            area: positive(
                &place,
                "axial rigidity",
                &[choice("axial_n", r.axial_n, 1.0)],
            )?
            .value,
            second_moment_y: positive(&place, "bending rigidity about y", &bending_y)?.value,
            second_moment_z: positive(&place, "bending rigidity about z", &bending_z)?.value,
            torsion_constant: positive(&place, "torsional rigidity", &torsion)?.value,
        });
    }
    let e = modulus(place, "Young's modulus", &young, warnings)?;
    let g = match pick(place, "Poisson's ratio", &poisson)? {
        Some(ratio) => {
            forbid(
                place,
                &shear,
                "Poisson's ratio gives the shear modulus already",
                "keep one of them",
            )?;
            if !(ratio.value > -1.0 && ratio.value <= 0.5) {
                return Err(Finding::new(
                    &place.key(ratio.key),
                    format!("Poisson's ratio is {}", ratio.value),
                    "it lies above -1 and not above 0.5; metals have about 0.3",
                ));
            }
            e / (2.0 + 2.0 * ratio.value)
        }
        None => modulus(place, "shear modulus", &shear, warnings).map_err(|mut f| {
            if f.message.ends_with("missing") {
                f.help.push_str(" or poissons_ratio");
            }
            f
        })?,
    };
    shape_of(place, s, e, g)
}

fn shape_of(place: &Place, s: &Section, e: f64, g: f64) -> Found<BeamSection> {
    if let Some(t) = &s.tube {
        let place = place.key("tube");
        let outer = [
            choice("outer_diameter_mm", t.outer_diameter_mm, MM),
            choice("outer_diameter_m", t.outer_diameter_m, 1.0),
        ];
        let inner = [
            choice("inner_diameter_mm", t.inner_diameter_mm, MM),
            choice("inner_diameter_m", t.inner_diameter_m, 1.0),
        ];
        let outer = positive(&place, "outer diameter", &outer)?.value;
        let inner = positive(&place, "inner diameter", &inner)?;
        if inner.value >= outer {
            return Err(Finding::new(
                &place.key(inner.key),
                format!(
                    "the inner diameter ({} mm) is not smaller than the outer one ({} mm)",
                    inner.value / MM,
                    outer / MM
                ),
                "exchange them, or write round = { diameter_mm = ... } for a solid bar",
            ));
        }
        return Ok(BeamSection::tube(e, g, outer, inner.value));
    }
    if let Some(r) = &s.round {
        let diameter = [
            choice("diameter_mm", r.diameter_mm, MM),
            choice("diameter_m", r.diameter_m, 1.0),
        ];
        let diameter = positive(&place.key("round"), "diameter", &diameter)?.value;
        return Ok(BeamSection::tube(e, g, diameter, 0.0));
    }
    let numbers = |area, second_moment_y, second_moment_z, torsion_constant| BeamSection {
        youngs_modulus: e,
        shear_modulus: g,
        area,
        second_moment_y,
        second_moment_z,
        torsion_constant,
    };
    if let Some(r) = &s.rectangle {
        let place = place.key("rectangle");
        let width = [
            choice("width_mm", r.width_mm, MM),
            choice("width_m", r.width_m, 1.0),
        ];
        let height = [
            choice("height_mm", r.height_mm, MM),
            choice("height_m", r.height_m, 1.0),
        ];
        let w = positive(&place, "width", &width)?.value;
        let h = positive(&place, "height", &height)?.value;
        let (a, b) = (0.5 * w.max(h), 0.5 * w.min(h));
        // Saint-Venant torsion of a rectangle, closed-form fit good to 0.5 %.
        let torsion =
            a * b.powi(3) * (16.0 / 3.0 - 3.36 * b / a * (1.0 - b.powi(4) / (12.0 * a.powi(4))));
        return Ok(numbers(
            w * h,
            w * h.powi(3) / 12.0,
            h * w.powi(3) / 12.0,
            torsion,
        ));
    }
    let empty = crate::schema::Values::default();
    let v = s.values.as_ref().unwrap_or(&empty);
    let place = place.key("values");
    let (mm2, mm4) = (MM * MM, MM * MM * MM * MM);
    let area = [
        choice("area_mm2", v.area_mm2, mm2),
        choice("area_m2", v.area_m2, 1.0),
    ];
    let about_y = [
        choice("second_moment_y_mm4", v.second_moment_y_mm4, mm4),
        choice("second_moment_y_m4", v.second_moment_y_m4, 1.0),
    ];
    let about_z = [
        choice("second_moment_z_mm4", v.second_moment_z_mm4, mm4),
        choice("second_moment_z_m4", v.second_moment_z_m4, 1.0),
    ];
    let torsion = [
        choice("torsion_constant_mm4", v.torsion_constant_mm4, mm4),
        choice("torsion_constant_m4", v.torsion_constant_m4, 1.0),
    ];
    Ok(numbers(
        positive(&place, "area", &area)?.value,
        positive(&place, "second moment about y", &about_y)?.value,
        positive(&place, "second moment about z", &about_z)?.value,
        positive(&place, "torsion constant", &torsion)?.value,
    ))
}
