//! Units and kinds of numbers, from the key under which they are written.

use crate::elements::quantity::{DEG, MM};
use crate::parameters::elements::SCALE;

/// Kind of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ParameterKind {
    /// A length or a coordinate.
    Length,
    /// An angle.
    Angle,
    /// A component of a direction or of a quaternion.
    Direction,
    /// Force per length.
    Stiffness,
    /// Moment per angle.
    RotationalStiffness,
    /// Force per angle, moment per length: what couples displacements and rotations in a matrix.
    CoupledStiffness,
    /// Young's or the shear modulus.
    Elasticity,
    /// Poisson's ratio.
    PoissonsRatio,
    /// Area of a cross-section.
    Area,
    /// Second moment of area, torsion constant.
    SecondMoment,
    /// Modulus times area or second moment.
    Rigidity,
    /// A force.
    Force,
    /// A moment.
    Moment,
    /// A mass.
    Mass,
    /// An entry of an inertia.
    Inertia,
    /// An acceleration.
    Acceleration,
    /// Length per turn.
    Lead,
    /// A number without a unit, such as an exponent, or a ratio of motions.
    Ratio,
    /// A factor on all that a section or a stiffness states; 1 in every file.
    Factor,
}

impl ParameterKind {
    /// Name in a word or two.
    ///
    /// ```
    /// use kinetostat_model::ParameterKind;
    /// assert_eq!(ParameterKind::RotationalStiffness.word(), "rotational stiffness");
    /// ```
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Angle => "angle",
            Self::Direction => "direction",
            Self::Stiffness => "stiffness",
            Self::RotationalStiffness => "rotational stiffness",
            Self::CoupledStiffness => "coupled stiffness",
            Self::Elasticity => "elasticity",
            Self::PoissonsRatio => "Poisson's ratio",
            Self::Area => "area",
            Self::SecondMoment => "second moment",
            Self::Rigidity => "rigidity",
            Self::Force => "force",
            Self::Moment => "moment",
            Self::Mass => "mass",
            Self::Inertia => "inertia",
            Self::Acceleration => "acceleration",
            Self::Lead => "lead",
            Self::Ratio => "ratio",
            Self::Factor => "factor",
        }
    }
}

/// Kind, unit as people write it, and the SI unit in one of it.
pub(crate) type Unit = (ParameterKind, &'static str, f64);

use ParameterKind as K;

/// Units by the end of the key, the longest first.
const BY_ENDING: [(&str, Unit); 34] = [
    ("_n_mm_per_rad", (K::RotationalStiffness, "N mm/rad", MM)),
    ("_n_m_per_rad", (K::RotationalStiffness, "N m/rad", 1.0)),
    ("_mm_per_turn", (K::Lead, "mm/turn", MM)),
    ("_m_per_turn", (K::Lead, "m/turn", 1.0)),
    ("_mm_per_deg", (K::Ratio, "mm/deg", MM / DEG)),
    ("_deg_per_mm", (K::Ratio, "deg/mm", DEG / MM)),
    ("_n_per_mm", (K::Stiffness, "N/mm", 1.0 / MM)),
    ("_n_per_m", (K::Stiffness, "N/m", 1.0)),
    ("_kg_per_m", (K::Mass, "kg/m", 1.0)),
    ("_kg_m3", (K::Mass, "kg/m^3", 1.0)),
    ("_m_per_s2", (K::Acceleration, "m/s^2", 1.0)),
    ("_n_mm2", (K::Rigidity, "N mm^2", 1e-6)),
    ("_n_m2", (K::Rigidity, "N m^2", 1.0)),
    ("_kg_m2", (K::Inertia, "kg m^2", 1.0)),
    ("_n_mm", (K::Moment, "N mm", MM)),
    ("_n_m", (K::Moment, "N m", 1.0)),
    ("axial_n", (K::Rigidity, "N", 1.0)),
    ("_mm4", (K::SecondMoment, "mm^4", 1e-12)),
    ("_m4", (K::SecondMoment, "m^4", 1.0)),
    ("_mm2", (K::Area, "mm^2", 1e-6)),
    ("_m2", (K::Area, "m^2", 1.0)),
    ("_gpa", (K::Elasticity, "GPa", 1e9)),
    ("_mpa", (K::Elasticity, "MPa", 1e6)),
    ("_pa", (K::Elasticity, "Pa", 1.0)),
    ("_deg", (K::Angle, "deg", DEG)),
    ("_rad", (K::Angle, "rad", 1.0)),
    ("_kg", (K::Mass, "kg", 1.0)),
    ("_mm", (K::Length, "mm", MM)),
    ("_m", (K::Length, "m", 1.0)),
    ("_n", (K::Force, "N", 1.0)),
    ("poissons_ratio", (K::PoissonsRatio, "", 1.0)),
    ("ratio", (K::Ratio, "", 1.0)),
    ("exponent", (K::Ratio, "", 1.0)),
    (SCALE, (K::Factor, "", 1.0)),
];

/// Unit of a number under `key`; `row` and `column` are its components in a matrix.
pub(crate) fn unit(key: &str, row: Option<&str>, column: Option<&str>) -> Unit {
    let of_matrix = match key {
        "matrix_n_mm_rad" | "diagonal_n_mm_rad" => Some(MM),
        "matrix_n_m_rad" | "diagonal_n_m_rad" => Some(1.0),
        _ => None,
    };
    if let Some(length) = of_matrix {
        let turns = |axis: Option<&str>| axis.is_some_and(|a| a.starts_with('r'));
        let mm = length != 1.0;
        return match (turns(row), turns(column.or(row))) {
            (false, false) => (K::Stiffness, if mm { "N/mm" } else { "N/m" }, 1.0 / length),
            (true, true) if mm => (K::RotationalStiffness, "N mm/rad", length),
            (true, true) => (K::RotationalStiffness, "N m/rad", 1.0),
            _ => (K::CoupledStiffness, "N/rad", 1.0),
        };
    }
    let known = BY_ENDING.iter().find(|(end, _)| key.ends_with(end));
    known.map_or((K::Direction, "", 1.0), |(_, unit)| *unit)
}
