//! Links that bend: a straight elastic link as one or several segments (book: Conventions, Links that bend).
//!
//! A link of length `L` becomes `n` times "rigid offset `h = L/n`, six-dimensional spring". For small
//! deflections every convention gives the same, exact stiffness (but [`LinkConvention::ConstantStrain`],
//! which needs segments even for that). Under load they differ in their geometric stiffness:
//! critical load of a pinned column in units of `pi^2 EI / L^2`, and the tension that buckles it,
//! which in truth none does:
//!
//! | convention          | n = 1 | 2      | 4      | 8       | tension, n = 1 / 2 / 4 |
//! |---------------------|-------|--------|--------|---------|------------------------|
//! | `TranslationsFirst` | never | 1.986  | 1.233  | 1.053   | 0.304 / 1.22 / 4.86    |
//! | `RotationsFirst`    | 0.131 | 0.390  | 0.714  | 0.908   | 0.94 / 3.8 / 15        |
//! | `Middle`            | 0.334 | 0.708  | 0.907  | 0.975   | 0.74 / 3.0 / 12        |
//! | `Exponential`       | 0.405 | 0.752  | 0.913  | 0.975   | 1.2 / 4.9 / 19         |
//! | `ConstantStrain`    | 1.216 | 1.216  | 1.052  | 1.013   | none                   |
//! | `Bowing`            | 1.216 | 1.0075 | 1.0005 | 1.00004 | none                   |
//!
//! A link given by a matrix is divided as a uniform beam: see `uniform.rs`.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Matrix6, Rotation3, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::Part;
use crate::model::beam::{
    BeamSection, NoSegment, compliance_per_length, moved, segment_compliance,
};
use crate::model::builder::ChainBuilder;
use crate::model::chain::Body;
use crate::model::link_mass::{LinkMass, MassModel, SegmentMass, shear_ratios};
use crate::model::springs::block::{Segment, SpringLaw};
use crate::model::springs::bowing::BowingLaw;
use crate::model::springs::logarithm::LogarithmLaw;
use crate::spatial::{Pose, turn_matrix};

/// Kinematics and energy of a segment. Unloaded stiffness does not depend on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum LinkConvention {
    /// Spring at the segment's end, translations first, and bending shortens: [`BowingLaw`].
    #[default]
    Bowing,
    /// Spring at the segment's end, translations before rotations, constant matrix: the report's
    /// habit [R 3.26, Table 5.3]. Fails under tension.
    TranslationsFirst,
    /// Spring at the segment's end, rotations before translations, constant matrix.
    RotationsFirst,
    /// Spring in the middle of the segment, translations before rotations, constant matrix.
    Middle,
    /// Exponential coordinates, constant matrix; the end and the middle of the segment are the same.
    Exponential,
    /// Strain constant along the segment. A section's shear stiffness is its `G A`.
    ConstantStrain,
}

/// Source of a link's stiffness.
#[allow(clippy::large_enum_variant)] // one per link, gone when the chain is built
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum LinkElasticity {
    /// Section and material.
    Section(BeamSection),
    /// Stiffness of the whole link at its far end, root clamped, 6 x 6 (N/m, N/rad, N m/m, N m/rad).
    Matrix(Matrix6<f64>),
}

/// A straight elastic link along local x; see [`ChainBuilder::link_with`].
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
/// # let ei = 2.1e11 * bar.second_moment_z; // N m^2
/// use kinetostat::model::LinkConvention;
///
/// // From its section or from its matrix, in one piece or in several, by one convention or another:
/// // without load the end of a cantilever sinks by P L^3 / 3 E I.
/// let whole = bar.cantilever(length)?;
/// for link in [
///     LinkSpec::beam(bar, length).segments(3),
///     LinkSpec::matrix(whole, length),
///     LinkSpec::matrix(whole, length).segments(5).convention(LinkConvention::Middle),
///     LinkSpec::beam(bar, length).segments(2).convention(LinkConvention::Exponential),
/// ] {
///     let boom = Chain::builder("boom").link_with("bar", &link).build()?;
///     let stiffness = unloaded_stiffness(&boom, &Pose::identity(), &boom.home_coordinates(), &[])?;
///     let compliance = stiffness.cartesian.compliance().expect("a clamped bar holds its end");
///     assert!((compliance[(1, 1)] / (length.powi(3) / (3.0 * ei)) - 1.0).abs() < 1e-9);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct LinkSpec {
    /// Section or matrix.
    pub elasticity: LinkElasticity,
    /// Length of the whole link along local x, m.
    pub length: f64,
    /// Number of equal segments. One is enough far below the Euler load, 8 give buckling loads to
    /// 0.1 %, 32 give deflections as large as the link.
    pub segments: usize,
    /// Convention of the segments.
    pub convention: LinkConvention,
    /// Mass along it; none where its mass is neglected or written as bodies.
    #[cfg_attr(feature = "serde", serde(default))]
    pub mass: Option<LinkMass>,
}

impl LinkSpec {
    /// A link of one section (length in m), one segment, the default convention.
    #[must_use]
    pub fn beam(section: BeamSection, length: f64) -> Self {
        Self {
            elasticity: LinkElasticity::Section(section),
            length,
            segments: 1,
            convention: LinkConvention::default(),
            mass: None,
        }
    }

    /// A link (length in m) whose stiffness at the far end is known, one segment, the default
    /// convention. Its bending is taken for that of a uniform beam.
    #[must_use]
    pub fn matrix(stiffness: Matrix6<f64>, length: f64) -> Self {
        Self {
            elasticity: LinkElasticity::Matrix(stiffness),
            length,
            segments: 1,
            convention: LinkConvention::default(),
            mass: None,
        }
    }

    /// Divides the link into `count` segments.
    #[must_use]
    pub fn segments(mut self, count: usize) -> Self {
        self.segments = count;
        self
    }

    /// Adds a mass along the link. Its segments then have a node at each end: `NAME.near` at the root, and
    /// `SEGMENT.far` behind every segment.
    ///
    /// ```
    /// # use kinetostat::*;
    /// use kinetostat::model::LinkMass;
    ///
    /// let bar = BeamSection::tube(2.1e11, 8.0e10, 0.04, 0.03); // Pa, m
    /// let spec = LinkSpec::beam(bar, 0.8).segments(2).with_mass(LinkMass::of_section(&bar, 7850.0));
    /// let boom = Chain::builder("boom").link_with("bar", &spec).build()?;
    /// assert_eq!(boom.nodes(), ["bar.near", "bar.1.far", "bar.2.far", "tip"]);
    /// let total: f64 = boom.segment_masses().iter().map(model::SegmentMass::total).sum();
    /// assert!((total - 7850.0 * bar.area * 0.8).abs() < 1e-12); // kg
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn with_mass(mut self, mass: LinkMass) -> Self {
        self.mass = Some(mass);
        self
    }

    /// Sets the convention.
    #[must_use]
    pub fn convention(mut self, convention: LinkConvention) -> Self {
        self.convention = convention;
        self
    }

    /// Length of one segment, m.
    #[allow(clippy::cast_precision_loss)] // nobody has 2^52 segments
    fn piece(&self) -> f64 {
        self.length / self.segments as f64
    }

    /// Stiffness of one segment in the coordinates of its convention.
    fn segment_stiffness(&self) -> Result<Matrix6<f64>, NoSegment> {
        let h = self.piece();
        let strain = self.convention == LinkConvention::ConstantStrain;
        let end = match &self.elasticity {
            LinkElasticity::Section(s) if strain => {
                let (e, g) = (s.youngs_modulus, s.shear_modulus);
                let (bend_y, bend_z) = (e * s.second_moment_y, e * s.second_moment_z);
                let (shear, twist) = (g * s.area, g * s.torsion_constant);
                let per_length = Vector6::new(e * s.area, shear, shear, twist, bend_y, bend_z);
                return Ok(Matrix6::from_diagonal(&(per_length / h)));
            }
            LinkElasticity::Section(section) => section.cantilever(h)?,
            LinkElasticity::Matrix(matrix) if self.segments == 1 && !strain => *matrix,
            LinkElasticity::Matrix(matrix) => {
                let per_length = compliance_per_length(matrix, self.length)?;
                let middle = if strain {
                    per_length * h
                } else {
                    segment_compliance(&per_length, h)
                };
                let stiffness = middle
                    .try_inverse()
                    .filter(|k| k.cholesky().is_some())
                    .ok_or(match strain {
                        true => NoSegment::NoShear,
                        false => NoSegment::IndefiniteSegment,
                    })?;
                if strain {
                    return Ok(stiffness);
                }
                moved(&stiffness, h)
            }
        };
        Ok(if self.convention == LinkConvention::Middle {
            moved(&end, -h)
        } else {
            end
        })
    }

    /// Shear ratios of a segment from its stiffness in the coordinates of its convention.
    fn shear(&self, matrix: &Matrix6<f64>) -> [f64; 2] {
        let h = self.piece();
        match self.convention {
            LinkConvention::Middle => shear_ratios(&moved(matrix, h), h),
            LinkConvention::ConstantStrain => [0.0; 2],
            _ => shear_ratios(matrix, h),
        }
    }

    /// Smaller bending stiffness `EI` of the link, N m^2; zero where a matrix has none.
    fn bending_stiffness(&self) -> f64 {
        match &self.elasticity {
            LinkElasticity::Section(s) => {
                s.youngs_modulus * s.second_moment_y.min(s.second_moment_z)
            }
            // A pure end moment turns the end by m L / EI.
            LinkElasticity::Matrix(matrix) => matrix.try_inverse().map_or(0.0, |compliance| {
                let turn = compliance.fixed_view::<2, 2>(4, 4).into_owned();
                self.length / turn.symmetric_eigenvalues().max()
            }),
        }
    }
}

impl ChainBuilder {
    /// A straight elastic link along local x: the offset, then the spring at its far end [R 3.26],
    /// one segment by the report's convention. [`Self::link_with`] has the others.
    #[must_use]
    pub fn link(self, name: &str, section: &BeamSection, length: f64) -> Self {
        let spec = LinkSpec::beam(*section, length).convention(LinkConvention::TranslationsFirst);
        self.link_with(name, &spec)
    }

    /// A straight elastic link along local x, in segments and by a convention of choice:
    ///
    /// ```
    /// use kinetostat::{BeamSection, Chain, LinkSpec};
    ///
    /// let bar = BeamSection::tube(2.1e11, 8.0e10, 0.04, 0.03);
    /// let chain = Chain::builder("arm")
    ///     .link_with("upper", &LinkSpec::beam(bar, 0.8).segments(8))
    ///     .build()?;
    /// assert_eq!(chain.coordinate_count(), 48);
    /// # Ok::<(), kinetostat::Error>(())
    /// ```
    ///
    /// A link of one segment has the spring `name`, one of several has `name.1`, `name.2` and so on.
    #[must_use]
    pub fn link_with(self, name: &str, spec: &LinkSpec) -> Self {
        self.link_in_pieces(name, spec, |_| spec.segment_stiffness())
    }

    /// Adds a link like [`ChainBuilder::link_with`] that changes along its length: `pieces` are the stiffnesses of its
    /// equal segments, from the root on, each at the segment's far end with its near end clamped, 6 x 6 (N/m, N/rad, N
    /// m/m, N m/rad), axes of the link. `whole` has the link's own matrix, length and convention; its number of
    /// segments is that of the pieces. Every piece bends like a uniform beam of its stiffness; the buckling load of a
    /// cone converges with the fourth power of the pieces.
    ///
    /// It is a fault if there is no piece, or if a matrix is no stiffness of a piece.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// // A stepped bar: the half at the root is thicker than the half at the end.
    /// let [thick, thin] = [0.05, 0.03].map(|diameter| BeamSection::tube(2.1e11, 8.1e10, diameter, 0.0)); // Pa, m
    /// let (length, half) = (0.8_f64, 0.4_f64); // m
    /// let pieces = [thick.cantilever(half)?, thin.cantilever(half)?];
    /// let whole = LinkSpec::beam(thin, length); // its length and convention count
    /// let bar = Chain::builder("bar").link_of_pieces("bar", &whole, &pieces).build()?;
    /// let stiffness = unloaded_stiffness(&bar, &Pose::identity(), &bar.home_coordinates(), &[])?;
    /// let compliance = stiffness.cartesian.compliance().expect("a clamped bar holds its end");
    /// // Moment P (L - x) over each half: [x^3 / 3 E I] between its ends.
    /// let bends = |bar: &BeamSection, from: f64, to: f64| {
    ///     (to.powi(3) - from.powi(3)) / (3.0 * 2.1e11 * bar.second_moment_z)
    /// };
    /// let across = bends(&thin, 0.0, half) + bends(&thick, half, length); // m/N
    /// let along = half / (2.1e11 * thick.area) + half / (2.1e11 * thin.area);
    /// assert!((compliance[(1, 1)] / across - 1.0).abs() < 1e-9);
    /// assert!((compliance[(0, 0)] / along - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn link_of_pieces(self, name: &str, whole: &LinkSpec, pieces: &[Matrix6<f64>]) -> Self {
        let whole = whole.segments(pieces.len());
        let of = |k: usize| {
            let piece = LinkSpec::matrix(pieces[k], whole.piece());
            piece.convention(whole.convention).segment_stiffness()
        };
        self.link_in_pieces(name, &whole, of)
    }

    /// A link is not as long as this.
    fn no_length(&mut self, name: &str, length: f64) {
        let text = format!("its length is {length}, a positive number of metres is needed");
        self.fault_of(Part::Link, name, text);
    }

    fn link_in_pieces(
        mut self,
        name: &str,
        spec: &LinkSpec,
        of: impl Fn(usize) -> Result<Matrix6<f64>, NoSegment>,
    ) -> Self {
        let length = spec.length;
        if !(length.is_finite() && length > 0.0) {
            self.no_length(name, length);
            return self;
        }
        if spec.segments == 0 {
            self.fault_of(
                Part::Link,
                name,
                "it has no segment, at least 1 is needed".to_owned(),
            );
            return self;
        }
        if let Some(fault) = spec.mass.and_then(|mass| mass.fault()) {
            self.fault_of(Part::Link, name, fault);
            return self;
        }
        let bending_stiffness = spec.bending_stiffness();
        let h = spec.piece();
        if spec.mass.is_some() {
            self = self.node(&format!("{name}.near"));
        }
        let law_of = |matrix: Matrix6<f64>| {
            let linear =
                || SpringLaw::Linear(nalgebra::DMatrix::from_fn(6, 6, |i, j| matrix[(i, j)]));
            let exponential =
                |length| SpringLaw::Logarithm(Box::new(LogarithmLaw { matrix, length }));
            match spec.convention {
                LinkConvention::Bowing => {
                    let law = BowingLaw { matrix, length: h };
                    (SpringLaw::Bowing(Box::new(law)), 1.0, false)
                }
                LinkConvention::TranslationsFirst => (linear(), 1.0, false),
                LinkConvention::RotationsFirst => (linear(), 1.0, true),
                LinkConvention::Middle => (linear(), 0.5, false),
                LinkConvention::Exponential => (exponential(0.0), 1.0, false),
                LinkConvention::ConstantStrain => (exponential(h), 1.0, false),
            }
        };
        for k in 1..=spec.segments {
            let (shear, (law, share, rotations_first)) = match of(k - 1) {
                Ok(matrix) => (spec.shear(&matrix), law_of(matrix)),
                Err(reason) => {
                    self.fault_of(Part::Link, name, reason.to_string());
                    return self;
                }
            };
            let own = if spec.segments == 1 {
                name.to_owned()
            } else {
                format!("{name}.{k}")
            };
            self = self.rigid(Pose::translation(share * h, 0.0, 0.0));
            self.add_springs(
                &own,
                &[0, 1, 2, 3, 4, 5],
                rotations_first,
                law,
                vec![0.0; 6],
            );
            self.last_spring_is(Segment {
                link: name.to_owned(),
                link_length: length,
                bending_stiffness,
                along: Vector3::x(),
            });
            if share < 1.0 {
                self = self.rigid(Pose::translation((1.0 - share) * h, 0.0, 0.0));
            }
            if let Some(mass) = &spec.mass {
                self = self.node(&format!("{own}.far"));
                self.last_spring_weighs(name, mass, h, shear);
            }
        }
        self
    }

    /// The spring of a link of one segment that lies anywhere in the frame reached so far, behind
    /// the offset of its far end, which is written before it: `matrix` 6 x 6 (N/m, N/rad, N m/m,
    /// N m/rad) at the far end, root clamped, in the axes of that frame; `offset` from near to far
    /// end, m. It is [`ChainBuilder::spring6`] ([`LinkConvention::TranslationsFirst`]) with the
    /// link's axial load given.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
    /// # let ei = 2.1e11 * bar.second_moment_z; // N m^2
    /// // A bar that lies along the diagonal of x and y.
    /// let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_4);
    /// let turned = spatial::turn_matrix(&turn);
    /// let matrix = turned * bar.cantilever(length)? * turned.transpose();
    /// let offset = turn * vector![length, 0.0, 0.0]; // m
    /// let brace = Chain::builder("brace").translation(offset).link_spring("bar", &matrix, &offset).build()?;
    /// let push = Wrench::new(turn * vector![-5e3, 0.0, 0.0], Vector3::zeros()); // N
    /// let found = solve_chain(&ChainProblem::new(&brace, EndCondition::wrench(push)), &Settings::default())?;
    /// let load = &found.link_loads(&brace)[0];
    /// assert!((load.axial_force + 5e3).abs() < 1e-6, "all of the push goes along the bar");
    /// let euler = (std::f64::consts::PI / length).powi(2) * ei; // N
    /// assert!((load.euler_load / euler - 1.0).abs() < 1e-9 && (load.share * euler / 5e3 - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn link_spring(mut self, name: &str, matrix: &Matrix6<f64>, offset: &Vector3<f64>) -> Self {
        let length = offset.norm();
        if !(length.is_finite() && length > 0.0) {
            self.no_length(name, length);
            return self;
        }
        let turn = Rotation3::rotation_between(&Vector3::x(), offset)
            .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::y_axis(), PI));
        let turn = turn_matrix(&turn);
        let own = LinkSpec::matrix(turn.transpose() * matrix * turn, length);
        self = self.spring6(name, matrix, [0.0; 6]);
        self.last_spring_is(Segment {
            link: name.to_owned(),
            link_length: length,
            bending_stiffness: own.bending_stiffness(),
            along: offset / length,
        });
        self
    }

    /// Gives the spring written last a mass along it, between the nodes at its ends.
    fn last_spring_weighs(&mut self, link: &str, mass: &LinkMass, length: f64, shear: [f64; 2]) {
        let far = self.chain.nodes.len() - 1;
        let near = far - 1;
        match mass.model {
            MassModel::Consistent => self.chain.segment_masses.push(SegmentMass {
                link: link.to_owned(),
                spring: self.chain.springs.len() - 1,
                near,
                far,
                length,
                mass: *mass,
                shear,
            }),
            MassModel::HalvesAtEnds => {
                for node in [near, far] {
                    self.chain.bodies.push(Body {
                        name: link.to_owned(),
                        node,
                        mass: 0.5 * mass.per_length * length,
                        inertia: Matrix3::zeros(),
                    });
                }
            }
        }
    }
}
