//! Moduli of common materials, with their sources. Values for design; a data sheet beats them.

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
