//! Stiffness of a straight link whose section changes along it, by integrating its compliance, and moduli of common materials.
//!
//! A slice of length `ds` at the distance `a` from the tip adds `T c T^T ds` to the compliance of the
//! tip: `c` is the compliance of the slice per length, `T` takes the twist there to the tip. Exact for
//! prismatic links; for others as good as beam theory is (slender, slopes of the walls small).

use kinetostat::spatial::shift_matrix;
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::beam::section::SectionShape;
use crate::error::{Error, LinkErrorKind, Result};
use crate::interface::invert;

/// Deflection by shear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shear {
    /// Left out (Euler-Bernoulli), as the core's links do.
    #[default]
    None,
    /// Timoshenko, with the shear areas of the section.
    Timoshenko,
}

/// Nodes and weights of eight-point Gauss-Legendre quadrature on -1..1 (the positive half).
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_27),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];

/// Stiffness of the tip of a link that goes from the section `root` (clamped) to `tip`, sizes changing
/// linearly: N/m, N/rad, N m/m, N m/rad, link axes, x along it. `length` in m, Young's modulus in Pa.
///
/// ```
/// use kinetostat_links::{SectionShape, Shear, cantilever};
/// let (root, tip) = (SectionShape::Tube { outer: 0.2, inner: 0.0 }, SectionShape::Tube { outer: 0.1, inner: 0.0 });
/// let k = cantilever(&root, &tip, 1.0, 2.1e11, 0.3, Shear::None)?;
/// let bends = k.try_inverse().ok_or("singular")?[(1, 1)];
/// // A solid cone: P L^3 / (3 E I_root) times d_root / d_tip.
/// let exact = 1.0 / (3.0 * 2.1e11 * std::f64::consts::PI / 64.0 * 0.2_f64.powi(4)) * 2.0;
/// assert!((bends / exact - 1.0).abs() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// Sizes or moduli that are none; two kinds of shape.
pub fn cantilever(
    root: &SectionShape,
    tip: &SectionShape,
    length: f64,
    youngs_modulus: f64,
    poissons_ratio: f64,
    shear: Shear,
) -> Result<Matrix6<f64>> {
    for shape in [root, tip] {
        shape.properties(poissons_ratio)?;
    }
    if !(youngs_modulus.is_finite() && youngs_modulus > 0.0) {
        return Err(Error::new(
            LinkErrorKind::Section,
            "link",
            format!("Young's modulus is {youngs_modulus} Pa"),
            "a number above zero is needed",
        ));
    }
    if root.towards(tip, 0.5).is_none() {
        return Err(Error::new(
            LinkErrorKind::Section,
            "link",
            format!(
                "it goes from the section '{}' to '{}'",
                root.name(),
                tip.name()
            ),
            "both ends have the same kind of section; divide the link where it changes",
        ));
    }
    let g = youngs_modulus / (2.0 + 2.0 * poissons_ratio);
    cantilever_by(length, |x| {
        let p = root
            .towards(tip, x / length)
            .unwrap_or(*root)
            .properties(poissons_ratio)?;
        let slide = |area: f64| {
            if shear == Shear::None {
                0.0
            } else {
                1.0 / (g * area)
            }
        };
        Ok(Vector6::new(
            1.0 / (youngs_modulus * p.area),
            slide(p.shear_area_y),
            slide(p.shear_area_z),
            1.0 / (g * p.torsion_constant),
            1.0 / (youngs_modulus * p.second_moment_y),
            1.0 / (youngs_modulus * p.second_moment_z),
        ))
    })
}

/// Stiffness for any change along the link: `slice` gives the compliance per length at `x` (m from the root): stretch
/// 1/N, shear along y and z 1/N, twist and bending about y and z 1/(N m^2).
///
/// # Errors
///
/// Those of `slice`; a length that is none; compliances that are negative or leave the link rigid.
pub fn cantilever_by(
    length: f64,
    slice: impl Fn(f64) -> Result<Vector6<f64>>,
) -> Result<Matrix6<f64>> {
    let fault =
        |message: String, help: &str| Error::new(LinkErrorKind::Section, "link", message, help);
    if !(length.is_finite() && length > 0.0) {
        return Err(fault(
            format!("its length is {length} m"),
            "a number above zero is needed",
        ));
    }
    let mut panels = 1_u32;
    let mut before: Option<Matrix6<f64>> = None;
    loop {
        let mut compliance = Matrix6::zeros();
        let half = 0.5 * length / f64::from(panels);
        for p in 0..panels {
            let middle = half * f64::from(2 * p + 1);
            for (node, weight) in GAUSS {
                for at in [middle - half * node, middle + half * node] {
                    let c = slice(at)?;
                    if c.iter().any(|x| !(x.is_finite() && *x >= 0.0)) {
                        return Err(fault(
                            format!("the compliance at {at} m is not finite or negative"),
                            "check the section there",
                        ));
                    }
                    let shift = shift_matrix(&Vector3::new(length - at, 0.0, 0.0));
                    compliance +=
                        shift * Matrix6::from_diagonal(&c) * shift.transpose() * (weight * half);
                }
            }
        }
        let converged = before.is_some_and(|b| {
            (0..36).all(|k| {
                let (i, j) = (k / 6, k % 6);
                let unit = (compliance[(i, i)] * compliance[(j, j)]).sqrt();
                (compliance[(i, j)] - b[(i, j)]).abs() <= 1e-12 * unit
            })
        });
        if converged || panels >= 4096 {
            let k = invert(&compliance).ok_or_else(|| {
                fault(
                    "its compliance cannot be inverted".into(),
                    "each direction needs some compliance",
                )
            })?;
            return Ok(0.5 * (k + k.transpose()));
        }
        before = Some(compliance);
        panels *= 2;
    }
}

/// An isotropic elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Name in files.
    pub name: &'static str,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio, without a unit; the shear modulus follows from it.
    pub poissons_ratio: f64,
    /// Density, kg/m^3.
    pub density: f64,
    /// Source of the figures.
    pub source: &'static str,
}

impl Material {
    /// Shear modulus `E / 2(1 + nu)`, Pa.
    #[must_use]
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 + 2.0 * self.poissons_ratio)
    }
}

/// The materials that are known.
pub const MATERIALS: [Material; 7] = [
    Material {
        name: "steel",
        youngs_modulus: 210e9,
        poissons_ratio: 0.3,
        density: 7850.0,
        source: "EN 1993-1-1:2005, 3.2.6; density EN 1991-1-1, table A.4",
    },
    Material {
        name: "stainless_steel",
        youngs_modulus: 200e9,
        poissons_ratio: 0.3,
        density: 7900.0,
        source: "EN 1993-1-4:2006, 2.1.3 (1.4301); density EN 10088-1",
    },
    Material {
        name: "aluminium",
        youngs_modulus: 70e9,
        poissons_ratio: 0.3,
        density: 2700.0,
        source: "EN 1999-1-1:2007, 3.2.5",
    },
    Material {
        name: "grey_cast_iron",
        youngs_modulus: 110e9,
        poissons_ratio: 0.26,
        density: 7200.0,
        source: "EN 1561, informative values of EN-GJL-250 (103 to 118 GPa)",
    },
    Material {
        name: "ductile_cast_iron",
        youngs_modulus: 169e9,
        poissons_ratio: 0.275,
        density: 7100.0,
        source: "EN 1563, informative values of EN-GJS-400-15",
    },
    Material {
        name: "titanium",
        youngs_modulus: 110e9,
        poissons_ratio: 0.31,
        density: 4430.0,
        source: "MMPDS, Ti-6Al-4V annealed (16.0 Msi)",
    },
    Material {
        name: "magnesium",
        youngs_modulus: 45e9,
        poissons_ratio: 0.35,
        density: 1810.0,
        source: "ASM Handbook 2, AZ91",
    },
];

/// The entry of [`MATERIALS`] with exactly this name; `None` if there is none.
#[must_use]
pub fn material(name: &str) -> Option<&'static Material> {
    MATERIALS.iter().find(|m| m.name == name)
}
