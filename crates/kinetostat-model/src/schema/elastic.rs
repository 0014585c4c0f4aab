//! Elastic properties: sections, materials and stiffness matrices as a file writes them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::schema::Axis;

/// Section and material of a straight link: exactly one shape, Young's modulus, and the shear
/// modulus or Poisson's ratio.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Round tube.
    pub tube: Option<Tube>,
    /// Solid round bar.
    pub round: Option<Round>,
    /// Solid rectangle.
    pub rectangle: Option<Rectangle>,
    /// I with its web along z and its flanges along y.
    pub i_beam: Option<IBeam>,
    /// Rectangular tube.
    pub hollow_box: Option<HollowBox>,
    /// Area and second moments as numbers.
    pub values: Option<Values>,
    /// Modulus times area or second moment, as an identification gives them; no moduli then.
    pub rigidities: Option<Rigidities>,
    /// Shape at the far end, of the same kind: sizes change linearly along the link.
    pub tip: Option<Tip>,
    /// Deflection by shear; none if not given.
    pub shear: Option<ShearWord>,
    /// A material by name instead of moduli: steel, stainless_steel, aluminium, grey_cast_iron,
    /// ductile_cast_iron, titanium, magnesium.
    pub material: Option<String>,
    /// Young's modulus, GPa, where no material is named.
    pub youngs_modulus_gpa: Option<f64>,
    /// Young's modulus, MPa, where no material is named.
    pub youngs_modulus_mpa: Option<f64>,
    /// Young's modulus, Pa, where no material is named.
    pub youngs_modulus_pa: Option<f64>,
    /// Shear modulus, GPa, where neither a material nor Poisson's ratio is given.
    pub shear_modulus_gpa: Option<f64>,
    /// Shear modulus, MPa, where neither a material nor Poisson's ratio is given.
    pub shear_modulus_mpa: Option<f64>,
    /// Shear modulus, Pa, where neither a material nor Poisson's ratio is given.
    pub shear_modulus_pa: Option<f64>,
    /// Poisson's ratio, from which the shear modulus of an isotropic material follows.
    pub poissons_ratio: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Round tube.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tube {
    /// Outer diameter of the wall, mm.
    pub outer_diameter_mm: Option<f64>,
    /// Outer diameter of the wall, m.
    pub outer_diameter_m: Option<f64>,
    /// Inner diameter of the wall (the bore), mm.
    pub inner_diameter_mm: Option<f64>,
    /// Inner diameter of the wall (the bore), m.
    pub inner_diameter_m: Option<f64>,
}

/// Solid round bar.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Round {
    /// Diameter of the bar, mm.
    pub diameter_mm: Option<f64>,
    /// Diameter of the bar, m.
    pub diameter_m: Option<f64>,
}

/// Solid rectangle: width along the link's y axis, height along its z axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rectangle {
    /// Size along y, mm.
    pub width_mm: Option<f64>,
    /// Size along y, m.
    pub width_m: Option<f64>,
    /// Size along z, mm.
    pub height_mm: Option<f64>,
    /// Size along z, m.
    pub height_m: Option<f64>,
}

/// I with its web along the link's z axis and its flanges along y.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IBeam {
    /// Width of the flanges, along y, mm.
    pub width_mm: Option<f64>,
    /// Over the flanges, along z, mm.
    pub height_mm: Option<f64>,
    /// Thickness of a flange, mm.
    pub flange_mm: Option<f64>,
    /// Thickness of the web, mm.
    pub web_mm: Option<f64>,
}

/// Rectangular tube: width along the link's y axis, height along its z axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HollowBox {
    /// Outer size along y, mm.
    pub width_mm: Option<f64>,
    /// Outer size along z, mm.
    pub height_mm: Option<f64>,
    /// Thickness of all walls, mm.
    pub wall_mm: Option<f64>,
    /// Thickness of the two walls at the sides (along y), mm, where they differ.
    pub side_wall_mm: Option<f64>,
    /// Thickness of the two walls above and below (along z), mm, where they differ.
    pub top_wall_mm: Option<f64>,
}

/// Shape at the far end of a tapered link: exactly one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tip {
    /// Round tube.
    pub tube: Option<Tube>,
    /// Solid round bar.
    pub round: Option<Round>,
    /// Solid rectangle.
    pub rectangle: Option<Rectangle>,
    /// I with its web along z and its flanges along y.
    pub i_beam: Option<IBeam>,
    /// Rectangular tube.
    pub hollow_box: Option<HollowBox>,
}

/// Shear deformation of a link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShearWord {
    /// Not at all (Euler-Bernoulli).
    #[default]
    None,
    /// Shear by the section's shear areas (Timoshenko).
    Timoshenko,
}

/// Area and second moments as numbers.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Values {
    /// Area of the cross-section A (stiffness against stretching is E A), mm^2.
    pub area_mm2: Option<f64>,
    /// Area of the cross-section A (stiffness against stretching is E A), m^2.
    pub area_m2: Option<f64>,
    /// Second moment of area about y (bending that moves the tip along z), mm^4.
    pub second_moment_y_mm4: Option<f64>,
    /// Second moment of area about y (bending that moves the tip along z), m^4.
    pub second_moment_y_m4: Option<f64>,
    /// Second moment of area about z (bending that moves the tip along y), mm^4.
    pub second_moment_z_mm4: Option<f64>,
    /// Second moment of area about z (bending that moves the tip along y), m^4.
    pub second_moment_z_m4: Option<f64>,
    /// Torsion constant J (stiffness against twisting is G J), mm^4.
    pub torsion_constant_mm4: Option<f64>,
    /// Torsion constant J (stiffness against twisting is G J), m^4.
    pub torsion_constant_m4: Option<f64>,
}

/// Rigidities of a section: modulus times area or second moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigidities {
    /// E A, N.
    pub axial_n: Option<f64>,
    /// E I_y (bending that moves the tip along z), N mm^2.
    pub bending_y_n_mm2: Option<f64>,
    /// E I_y (bending that moves the tip along z), N m^2.
    pub bending_y_n_m2: Option<f64>,
    /// E I_z (bending that moves the tip along y), N mm^2.
    pub bending_z_n_mm2: Option<f64>,
    /// E I_z (bending that moves the tip along y), N m^2.
    pub bending_z_n_m2: Option<f64>,
    /// G J, N mm^2.
    pub torsion_n_mm2: Option<f64>,
    /// G J, N m^2.
    pub torsion_n_m2: Option<f64>,
}

/// Stiffness of six directions in the order x, y, z, rx, ry, rz: a matrix, a diagonal, or the
/// cantilever of a section.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stiffness {
    /// Six rows in N, m, rad: blocks N/m, N/rad, N m/m, N m/rad.
    pub matrix_n_m_rad: Option<[[f64; 6]; 6]>,
    /// Six rows in N, mm, rad: blocks N/mm, N/rad, N mm/mm, N mm/rad.
    pub matrix_n_mm_rad: Option<[[f64; 6]; 6]>,
    /// Diagonal in N, m, rad: three N/m, three N m/rad.
    pub diagonal_n_m_rad: Option<[f64; 6]>,
    /// Diagonal in N, mm, rad: three N/mm, three N mm/rad.
    pub diagonal_n_mm_rad: Option<[f64; 6]>,
    /// Name of a section: the free end of a cantilever of that section and of the given length.
    pub section: Option<String>,
    /// Length of the cantilever, mm.
    pub length_mm: Option<f64>,
    /// Length of the cantilever, m.
    pub length_m: Option<f64>,
    /// Direction of the stiffness's own x axis in the frame where the spring sits; x if not given.
    /// Its y axis is chosen as for `x_axis` of a pose.
    pub along: Option<Axis>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Name of a stiffness, or the stiffness itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Spring6 {
    /// Name of a table `[stiffness.NAME]`.
    Named(String),
    /// Written in place.
    Inline(Box<Stiffness>),
}
