//! Sections: shape and material to what the cantilever needs.

use kinetostat::BeamSection;
use kinetostat::number::short;

use crate::elements::quantity::{Choice, MM, ReadResult, choices, forbid, pick, positive};
use crate::elements::shape::{material_of, root};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Rigidities, Section, Values};

fn modulus(
    place: &KeyPath,
    what: &str,
    choices: &[Choice<f64>],
    warnings: &mut Vec<Finding>,
) -> ReadResult<f64> {
    let given = positive(place, what, choices)?;
    if !(5e8..=2e12).contains(&given.value) {
        warnings.push(Finding::new(
            &place.key(given.key),
            format!("a {what} of {} Pa is no usual solid", short(given.value)),
            "steel has 210 GPa (shear 80), aluminium 70 (26), polymers 1 to 4; check the unit in the key",
        ));
    }
    Ok(given.value)
}

/// Moduli as a section writes them.
struct Moduli {
    young: [Choice<f64>; 3],
    shear: [Choice<f64>; 3],
    poisson: [Choice<f64>; 1],
}

impl Moduli {
    fn new(s: &Section) -> Self {
        Self {
            young: choices!(
                s,
                (youngs_modulus_gpa, 1e9),
                (youngs_modulus_mpa, 1e6),
                (youngs_modulus_pa, 1.0)
            ),
            shear: choices!(
                s,
                (shear_modulus_gpa, 1e9),
                (shear_modulus_mpa, 1e6),
                (shear_modulus_pa, 1.0)
            ),
            poisson: choices!(s, (poissons_ratio, 1.0)),
        }
    }

    /// Rejects moduli where the material is defined elsewhere.
    fn forbidden(&self, place: &KeyPath, reason: &str, help: &str) -> ReadResult<()> {
        for moduli in [&self.young[..], &self.shear[..], &self.poisson[..]] {
            forbid(place, moduli, reason, help)?;
        }
        Ok(())
    }

    /// Young's and the shear modulus, Pa; for an isotropic solid `G = E / (2 (1 + nu))`.
    fn read(&self, place: &KeyPath, warnings: &mut Vec<Finding>) -> ReadResult<(f64, f64)> {
        let e = modulus(place, "Young's modulus", &self.young, warnings)?;
        let g = match pick(place, "Poisson's ratio", &self.poisson)? {
            Some(ratio) => {
                forbid(
                    place,
                    &self.shear,
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
            None => modulus(place, "shear modulus", &self.shear, warnings).map_err(|mut f| {
                if self.shear.iter().all(|choice| choice.value.is_none()) {
                    f.help.push_str(" or poissons_ratio");
                }
                f
            })?,
        };
        Ok((e, g))
    }
}

/// The section of a straight link: one shape, and a material or its moduli.
pub(crate) fn section(
    place: &KeyPath,
    s: &Section,
    warnings: &mut Vec<Finding>,
) -> ReadResult<BeamSection> {
    check_one_shape(place, s)?;
    let moduli = Moduli::new(s);
    if let Some(r) = &s.rigidities {
        moduli.forbidden(
            place,
            "the rigidities hold the material already",
            "leave the moduli out, or write values instead of rigidities",
        )?;
        return by_rigidities(&place.key("rigidities"), r);
    }
    if let Some(material) = material_of(place, s)? {
        moduli.forbidden(
            place,
            "the material gives the moduli already",
            "leave the moduli out, or the material",
        )?;
        return shape_of(place, s, material.youngs_modulus, material.shear_modulus());
    }
    let (e, g) = moduli.read(place, warnings)?;
    shape_of(place, s, e, g)
}

fn check_one_shape(place: &KeyPath, s: &Section) -> ReadResult<()> {
    let mut shapes = [
        s.tube.as_ref().map(|_| "tube"),
        s.round.as_ref().map(|_| "round"),
        s.rectangle.as_ref().map(|_| "rectangle"),
        s.i_beam.as_ref().map(|_| "i_beam"),
        s.hollow_box.as_ref().map(|_| "hollow_box"),
        s.values.as_ref().map(|_| "values"),
        s.rigidities.as_ref().map(|_| "rigidities"),
    ]
    .into_iter()
    .flatten();
    let Some(shape) = shapes.next() else {
        return Err(Finding::new(
            place,
            "the section has no shape",
            "write tube, round, rectangle, i_beam, hollow_box, values or rigidities",
        ));
    };
    if let Some(other) = shapes.next() {
        return Err(Finding::new(
            &place.key(other),
            format!("the shape is given twice: '{shape}' and '{other}'"),
            "keep one of them",
        ));
    }
    Ok(())
}

/// A section by its rigidities: moduli of one, so that area and second moments are `EA`, `EI` and `GJ`.
fn by_rigidities(place: &KeyPath, r: &Rigidities) -> ReadResult<BeamSection> {
    let bending_y = choices!(r, (bending_y_n_mm2, MM * MM), (bending_y_n_m2, 1.0));
    let bending_z = choices!(r, (bending_z_n_mm2, MM * MM), (bending_z_n_m2, 1.0));
    let torsion = choices!(r, (torsion_n_mm2, MM * MM), (torsion_n_m2, 1.0));
    Ok(BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 1.0,
        area: positive(place, "axial rigidity", &choices!(r, (axial_n, 1.0)))?.value,
        second_moment_y: positive(place, "bending rigidity about y", &bending_y)?.value,
        second_moment_z: positive(place, "bending rigidity about z", &bending_z)?.value,
        torsion_constant: positive(place, "torsional rigidity", &torsion)?.value,
    })
}

fn shape_of(place: &KeyPath, s: &Section, e: f64, g: f64) -> ReadResult<BeamSection> {
    if let Some(t) = &s.tube {
        let place = place.key("tube");
        let outer = choices!(t, (outer_diameter_mm, MM), (outer_diameter_m, 1.0));
        let inner = choices!(t, (inner_diameter_mm, MM), (inner_diameter_m, 1.0));
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
        let diameter = choices!(r, (diameter_mm, MM), (diameter_m, 1.0));
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
    if s.rectangle.is_some() || s.i_beam.is_some() || s.hollow_box.is_some() {
        let shape = root(place, s)?;
        // Poisson's ratio enters shear areas only, which this section does not have.
        return match shape.and_then(|shape| shape.properties(0.3).ok()) {
            Some(p) => Ok(p.section(e, g)),
            None => Err(Finding::new(
                place,
                "the section has no shape",
                "write its sizes",
            )),
        };
    }
    let empty = Values::default();
    let v = s.values.as_ref().unwrap_or(&empty);
    let place = place.key("values");
    let (mm2, mm4) = (MM * MM, MM * MM * MM * MM);
    let area = choices!(v, (area_mm2, mm2), (area_m2, 1.0));
    let about_y = choices!(v, (second_moment_y_mm4, mm4), (second_moment_y_m4, 1.0));
    let about_z = choices!(v, (second_moment_z_mm4, mm4), (second_moment_z_m4, 1.0));
    let torsion = choices!(v, (torsion_constant_mm4, mm4), (torsion_constant_m4, 1.0));
    Ok(numbers(
        positive(&place, "area", &area)?.value,
        positive(&place, "second moment about y", &about_y)?.value,
        positive(&place, "second moment about z", &about_z)?.value,
        positive(&place, "torsion constant", &torsion)?.value,
    ))
}
