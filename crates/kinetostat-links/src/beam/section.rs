//! Sections of beams by shape: area, second moments, torsion constant and shear areas.
//!
//! The link lies along x; widths are along y, heights along z, as in model files. Shear areas are
//! `kappa A` with the coefficients of \[Cowper1966\], G. R. Cowper, "The shear coefficient in
//! Timoshenko's beam theory", J. Applied Mechanics 33 (1966): exact for his theory for round, tube and
//! rectangle, for thin walls for I and box. Torsion: Saint-Venant, exact for round, tube and rectangle;
//! the box by Bredt's formula \[Roark\], walls thin; the I as the sum of its plates (within about 10 %,
//! fillets add to it; warping is not counted).

use std::f64::consts::PI;

use kinetostat::BeamSection;

use crate::error::{Error, LinkErrorKind, Result};

/// Shape of a section; lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SectionShape {
    /// Round tube; `inner = 0` is a solid bar.
    Tube {
        /// Outer diameter.
        outer: f64,
        /// Inner diameter.
        inner: f64,
    },
    /// Solid rectangle.
    Rectangle {
        /// Size along y.
        width: f64,
        /// Size along z.
        height: f64,
    },
    /// I with its web along z and its flanges along y.
    IBeam {
        /// Width of the flanges, along y.
        width: f64,
        /// Outer, along z.
        height: f64,
        /// Thickness of a flange, along z.
        flange: f64,
        /// Thickness of the web, along y.
        web: f64,
    },
    /// Rectangular tube.
    HollowBox {
        /// Outer, along y.
        width: f64,
        /// Outer, along z.
        height: f64,
        /// Thickness of the two walls at the sides, along y.
        side_wall: f64,
        /// Thickness of the two walls above and below, along z.
        top_wall: f64,
    },
    /// Numbers.
    Custom(Properties),
}

/// Properties of a section for a beam. Shear areas that are infinite mean no shear deflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Properties {
    /// Area, m^2.
    pub area: f64,
    /// Second moment about y (bending that moves the tip along z), m^4.
    pub second_moment_y: f64,
    /// Second moment about z (bending that moves the tip along y), m^4.
    pub second_moment_z: f64,
    /// Torsion constant, m^4.
    pub torsion_constant: f64,
    /// Shear area for forces along y, m^2.
    pub shear_area_y: f64,
    /// Shear area for forces along z, m^2.
    pub shear_area_z: f64,
}

impl Properties {
    /// Section with moduli, as the core's links take it (without shear).
    #[must_use]
    pub fn section(&self, youngs_modulus: f64, shear_modulus: f64) -> BeamSection {
        BeamSection {
            youngs_modulus,
            shear_modulus,
            area: self.area,
            second_moment_y: self.second_moment_y,
            second_moment_z: self.second_moment_z,
            torsion_constant: self.torsion_constant,
        }
    }
}

impl SectionShape {
    /// Name in messages.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Tube { .. } => "tube",
            Self::Rectangle { .. } => "rectangle",
            Self::IBeam { .. } => "I",
            Self::HollowBox { .. } => "hollow box",
            Self::Custom(_) => "custom",
        }
    }

    /// The shape's properties; `poissons_ratio` enters the shear areas only.
    ///
    /// ```
    /// let square = kinetostat_links::SectionShape::Rectangle { width: 0.1, height: 0.1 };
    /// let p = square.properties(0.3)?;
    /// assert!((p.torsion_constant / 1e-4 - 0.140577).abs() < 1e-6); // known of the square
    /// # Ok::<(), kinetostat_links::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Sizes that are no section.
    pub fn properties(&self, poissons_ratio: f64) -> Result<Properties> {
        self.check(poissons_ratio)?;
        let nu = poissons_ratio;
        Ok(match *self {
            Self::Custom(p) => p,
            Self::Tube { outer, inner } => {
                let (d2, i2) = (outer * outer, inner * inner);
                let area = PI / 4.0 * (d2 - i2);
                let moment = PI / 64.0 * (d2 * d2 - i2 * i2);
                let m2 = i2 / d2;
                let p = (1.0 + m2).powi(2);
                let kappa = 6.0 * (1.0 + nu) * p / ((7.0 + 6.0 * nu) * p + (20.0 + 12.0 * nu) * m2);
                Properties {
                    area,
                    second_moment_y: moment,
                    second_moment_z: moment,
                    torsion_constant: 2.0 * moment,
                    shear_area_y: kappa * area,
                    shear_area_z: kappa * area,
                }
            }
            Self::Rectangle { width, height } => {
                let area = width * height;
                let shear = rectangle_kappa(nu) * area;
                Properties {
                    area,
                    second_moment_y: width * height.powi(3) / 12.0,
                    second_moment_z: height * width.powi(3) / 12.0,
                    torsion_constant: rectangle_torsion(width, height),
                    shear_area_y: shear,
                    shear_area_z: shear,
                }
            }
            Self::IBeam {
                width,
                height,
                flange,
                web,
            } => {
                let inside = height - 2.0 * flange;
                let area = 2.0 * width * flange + inside * web;
                let h = height - flange;
                let (m, n) = (2.0 * width * flange / (h * web), width / h);
                let kappa = thin_walled_kappa(
                    nu,
                    m,
                    30.0 * n * n * (m + m * m) + 5.0 * nu * n * n * (8.0 * m + 9.0 * m * m),
                );
                Properties {
                    area,
                    second_moment_y: (width * height.powi(3) - (width - web) * inside.powi(3))
                        / 12.0,
                    second_moment_z: (2.0 * flange * width.powi(3) + inside * web.powi(3)) / 12.0,
                    torsion_constant: 2.0 * rectangle_torsion(width, flange)
                        + inside * web.powi(3) / 3.0,
                    // Across the web the flanges carry the shear, each as a rectangle.
                    shear_area_y: rectangle_kappa(nu) * 2.0 * width * flange,
                    shear_area_z: kappa * area,
                }
            }
            Self::HollowBox {
                width,
                height,
                side_wall,
                top_wall,
            } => {
                let (iw, ih) = (width - 2.0 * side_wall, height - 2.0 * top_wall);
                let area = width * height - iw * ih;
                let (b, h) = (width - side_wall, height - top_wall);
                let kappa = |b: f64, h: f64, along: f64, across: f64| {
                    let (m, n) = (b * across / (h * along), b / h);
                    thin_walled_kappa(nu, m, 10.0 * n * n * ((3.0 + nu) * m + 3.0 * m * m))
                };
                Properties {
                    area,
                    second_moment_y: (width * height.powi(3) - iw * ih.powi(3)) / 12.0,
                    second_moment_z: (height * width.powi(3) - ih * iw.powi(3)) / 12.0,
                    torsion_constant: 2.0 * b * b * h * h / (b / top_wall + h / side_wall),
                    shear_area_y: kappa(h, b, top_wall, side_wall) * area,
                    shear_area_z: kappa(b, h, side_wall, top_wall) * area,
                }
            }
        })
    }

    fn check(&self, nu: f64) -> Result<()> {
        let fault = |message: String, help: &str| {
            Err(Error::new(
                LinkErrorKind::Section,
                format!("section ({})", self.name()),
                message,
                help,
            ))
        };
        if !(nu > -1.0 && nu <= 0.5) {
            return fault(
                format!("Poisson's ratio is {nu}"),
                "it lies above -1 and not above 0.5; metals have about 0.3",
            );
        }
        let sizes: &[(&str, f64)] = &match *self {
            Self::Tube { outer, inner } => {
                if !(inner.is_finite() && (0.0..outer).contains(&inner)) {
                    return fault(
                        format!(
                            "the inner diameter ({inner} m) is not between 0 and the outer one ({outer} m)"
                        ),
                        "exchange them, or write 0 for a solid bar",
                    );
                }
                [("outer diameter", outer); 6]
            }
            Self::Rectangle { width, height } => six(&[("width", width), ("height", height)]),
            Self::IBeam {
                width,
                height,
                flange,
                web,
            } => {
                if 2.0 * flange >= height || web > width {
                    return fault(
                        "flanges or web are thicker than the section".into(),
                        "the flanges leave room for a web, and the web is not wider than they are",
                    );
                }
                six(&[
                    ("width", width),
                    ("height", height),
                    ("flange", flange),
                    ("web", web),
                ])
            }
            Self::HollowBox {
                width,
                height,
                side_wall,
                top_wall,
            } => {
                if 2.0 * side_wall >= width || 2.0 * top_wall >= height {
                    return fault(
                        "the walls are thicker than the section".into(),
                        "walls leave a hole; write a rectangle for a solid section",
                    );
                }
                six(&[
                    ("width", width),
                    ("height", height),
                    ("side wall", side_wall),
                    ("top wall", top_wall),
                ])
            }
            Self::Custom(p) => {
                for (name, shear) in [
                    ("shear area y", p.shear_area_y),
                    ("shear area z", p.shear_area_z),
                ] {
                    if shear.is_nan() || shear <= 0.0 {
                        return fault(
                            format!("the {name} is {shear}"),
                            "a number above zero, or infinity for no shear deflection",
                        );
                    }
                }
                six(&[
                    ("area", p.area),
                    ("second moment y", p.second_moment_y),
                    ("second moment z", p.second_moment_z),
                    ("torsion constant", p.torsion_constant),
                ])
            }
        };
        match sizes.iter().find(|s| !(s.1.is_finite() && s.1 > 0.0)) {
            Some((name, size)) => fault(
                format!("the {name} is {size}"),
                "a number above zero is needed",
            ),
            None => Ok(()),
        }
    }

    /// The shape a share of the way to another of the same kind, sizes (for `Custom`: properties)
    /// interpolated linearly. `None`: not the same kind.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64) -> Option<Self> {
        let mix = |a: f64, b: f64| if a == b { a } else { a + share * (b - a) };
        Some(match (*self, *other) {
            (Self::Tube { outer: a, inner: b }, Self::Tube { outer, inner }) => Self::Tube {
                outer: mix(a, outer),
                inner: mix(b, inner),
            },
            (
                Self::Rectangle {
                    width: a,
                    height: b,
                },
                Self::Rectangle { width, height },
            ) => Self::Rectangle {
                width: mix(a, width),
                height: mix(b, height),
            },
            (
                Self::IBeam {
                    width: a,
                    height: b,
                    flange: c,
                    web: d,
                },
                Self::IBeam {
                    width,
                    height,
                    flange,
                    web,
                },
            ) => Self::IBeam {
                width: mix(a, width),
                height: mix(b, height),
                flange: mix(c, flange),
                web: mix(d, web),
            },
            (
                Self::HollowBox {
                    width: a,
                    height: b,
                    side_wall: c,
                    top_wall: d,
                },
                Self::HollowBox {
                    width,
                    height,
                    side_wall,
                    top_wall,
                },
            ) => Self::HollowBox {
                width: mix(a, width),
                height: mix(b, height),
                side_wall: mix(c, side_wall),
                top_wall: mix(d, top_wall),
            },
            (Self::Custom(a), Self::Custom(b)) => Self::Custom(Properties {
                area: mix(a.area, b.area),
                second_moment_y: mix(a.second_moment_y, b.second_moment_y),
                second_moment_z: mix(a.second_moment_z, b.second_moment_z),
                torsion_constant: mix(a.torsion_constant, b.torsion_constant),
                shear_area_y: mix(a.shear_area_y, b.shear_area_y),
                shear_area_z: mix(a.shear_area_z, b.shear_area_z),
            }),
            _ => return None,
        })
    }
}

fn six(sizes: &[(&'static str, f64)]) -> [(&'static str, f64); 6] {
    std::array::from_fn(|i| sizes[i.min(sizes.len() - 1)])
}

/// \[Cowper1966\], rectangle.
fn rectangle_kappa(nu: f64) -> f64 {
    10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
}

/// \[Cowper1966\], thin-walled I and box: `m` flanges over web(s), `flanges` the terms with `n`.
fn thin_walled_kappa(nu: f64, m: f64, flanges: f64) -> f64 {
    let (m2, m3) = (m * m, m * m * m);
    let web =
        12.0 + 72.0 * m + 150.0 * m2 + 90.0 * m3 + nu * (11.0 + 66.0 * m + 135.0 * m2 + 90.0 * m3);
    10.0 * (1.0 + nu) * (1.0 + 3.0 * m).powi(2) / (web + flanges)
}

/// Saint-Venant torsion constant of a rectangle by his series, with the part that converges slowly summed
/// in closed form: `tanh x = 1 - 2/(e^2x + 1)`, and the sum of `1/n^5` over odd `n` is `31/32 zeta(5)`.
fn rectangle_torsion(width: f64, height: f64) -> f64 {
    const ODD_FIFTH_POWERS: f64 = 31.0 / 32.0 * 1.036_927_755_143_37;
    let (a, b) = (width.max(height), width.min(height));
    let rest: f64 = (0..8)
        .map(|k| f64::from(2 * k + 1))
        .map(|n| 2.0 / ((n * PI * a / b).exp() + 1.0) / n.powi(5))
        .sum();
    a * b.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * b / a * (ODD_FIFTH_POWERS - rest))
}
