//! Mass along an elastic link, and how its slices move with the two ends of a segment [D 5, D7].
//!
//! A segment of length `h` has its near end at one node and its far end at another. What the far end does relative to
//! the near one is `eta = (u, v, w, rx, ry, rz)`: translations along the near axes, then turns `Rx Ry Rz`. A slice at
//! `xi = x / h` moves by shares of `eta`, those of a beam loaded at its end:
//!
//! ```text
//! u(xi)  = xi u,   rx(xi) = xi rx
//! v(xi)  = [(3 xi^2 - 2 xi^3 + Phi xi) v + h (xi^3 - xi^2 + Phi/2 (xi^2 - xi)) rz] / (1 + Phi)
//! rz(xi) = [6 (xi - xi^2) v/h + (3 xi^2 - 2 xi + Phi xi) rz] / (1 + Phi)         w, ry likewise with -ry
//! ```
//!
//! Four slices at Gauss' points integrate the squares of these exactly, so that a segment is the consistent mass of the
//! beam element, and its weight acts where its mass is. `eta` is read from the poses of the nodes: whichever
//! convention the spring of the segment has, its mass moves in this way.

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::model::beam::BeamSection;
use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::spatial::Wrench;

/// Where the mass of a link is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum MassModel {
    /// Along the link, moving as the link bends: frequencies converge with the fourth power of the segments.
    #[default]
    Consistent,
    /// Half of every segment's mass at each of its ends, without inertia of its own: second power, and a link hinged at
    /// both ends has no mode of its own in one segment.
    HalvesAtEnds,
}

/// Mass of a link by its length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct LinkMass {
    /// Mass per length, kg/m.
    pub per_length: f64,
    /// Inertia of a slice about its three axes (x along the link) by its thickness, kg m: `rho (Iy + Iz)`, `rho Iy`,
    /// `rho Iz`. Zero for a thin link.
    pub rotary: [f64; 3],
    /// Where it is.
    pub model: MassModel,
}

impl LinkMass {
    /// Mass of a section of a material of this density, kg/m^3, with the inertia of its slices. Torsion goes by the
    /// polar moment, not by the torsion constant.
    ///
    /// ```
    /// # use kinetostat::{BeamSection, model::LinkMass};
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03); // Pa, m
    /// let mass = LinkMass::of_section(&bar, 7850.0); // kg/m^3
    /// assert_eq!(mass.per_length, 7850.0 * bar.area);
    /// assert_eq!(mass.thin().rotary, [0.0; 3]);
    /// ```
    #[must_use]
    pub fn of_section(section: &BeamSection, density: f64) -> Self {
        let (y, z) = (section.second_moment_y, section.second_moment_z);
        Self {
            per_length: density * section.area,
            rotary: [density * (y + z), density * y, density * z],
            model: MassModel::Consistent,
        }
    }

    /// The same without inertia of the slices about their own axes.
    #[must_use]
    pub fn thin(mut self) -> Self {
        self.rotary = [0.0; 3];
        self
    }

    /// The same mass in another place.
    #[must_use]
    pub fn with_model(mut self, model: MassModel) -> Self {
        self.model = model;
        self
    }

    /// What is wrong with its numbers.
    pub(crate) fn fault(&self) -> Option<String> {
        let m = self.per_length;
        if !(m.is_finite() && m >= 0.0) {
            return Some(format!(
                "its mass is {m} kg/m, a number not below zero is needed"
            ));
        }
        let bad = self.rotary.iter().find(|x| !(x.is_finite() && **x >= 0.0));
        bad.map(|x| {
            format!("the inertia of its slices is {x} kg m, a number not below zero is needed")
        })
    }
}

/// Mass of one segment of a link, between two nodes.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct SegmentMass {
    /// Name of the link.
    pub link: String,
    /// Index of the segment's spring among [`crate::Chain::springs`].
    pub spring: usize,
    /// Node at its near end, x along the link.
    pub near: usize,
    /// Node at its far end.
    pub far: usize,
    /// Length of the segment, m.
    pub length: f64,
    /// Mass of the link by its length.
    pub mass: LinkMass,
    /// Shear ratios `12 EI / (k G A h^2)` of bending along y and along z; zero for a slender link.
    pub shear: [f64; 2],
}

/// A slice of a segment: what of it moves, and by which shares of the far end's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slice {
    /// Place along the segment, 0 to 1.
    pub place: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about its own axes, kg m^2.
    pub inertia: Vector3<f64>,
    /// Translations `(u, v, w)` of the slice by `eta`, 3 x 6.
    pub translations: [Vector6<f64>; 3],
    /// Turns `(rx, ry, rz)` of the slice by `eta`, 3 x 6.
    pub turns: [Vector6<f64>; 3],
}

/// Points and weights of Gauss' rule of four points on 0 to 1.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Deflection and slope of a plane of bending at `x` by deflection and slope of the end, [D7].
fn bending(x: f64, h: f64, phi: f64) -> ([f64; 2], [f64; 2]) {
    let by = 1.0 / (1.0 + phi);
    let deflection = [
        (3.0 * x * x - 2.0 * x * x * x + phi * x) * by,
        h * (x * x * x - x * x + 0.5 * phi * (x * x - x)) * by,
    ];
    let slope = [
        6.0 * (x - x * x) / h * by,
        (3.0 * x * x - 2.0 * x + phi * x) * by,
    ];
    (deflection, slope)
}

impl SegmentMass {
    /// Its slices.
    #[must_use]
    pub fn slices(&self) -> [Slice; 4] {
        GAUSS.map(|(place, weight)| {
            let ((v, rz), (w, ry)) = (
                bending(place, self.length, self.shear[0]),
                bending(place, self.length, self.shear[1]),
            );
            let size = self.length * weight;
            Slice {
                place,
                mass: self.mass.per_length * size,
                inertia: Vector3::from(self.mass.rotary) * size,
                translations: [
                    Vector6::new(place, 0.0, 0.0, 0.0, 0.0, 0.0),
                    Vector6::new(0.0, v[0], 0.0, 0.0, 0.0, v[1]),
                    Vector6::new(0.0, 0.0, w[0], 0.0, -w[1], 0.0),
                ],
                turns: [
                    Vector6::new(0.0, 0.0, 0.0, place, 0.0, 0.0),
                    Vector6::new(0.0, 0.0, -ry[0], 0.0, ry[1], 0.0),
                    Vector6::new(0.0, rz[0], 0.0, 0.0, 0.0, rz[1]),
                ],
            }
        })
    }

    /// Mass of the segment, kg.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.mass.per_length * self.length
    }

    /// What the far end does relative to the near one at these poses: `eta`, m and rad.
    #[must_use]
    pub fn deflection(&self, kinematics: &Kinematics) -> Vector6<f64> {
        let (near, far) = (kinematics.frame(self.near), kinematics.frame(self.far));
        let at = near.0.transpose() * (far.1 - near.1);
        let r = near.0.transpose() * far.0;
        Vector6::new(
            at.x - self.length,
            at.y,
            at.z,
            (-r[(1, 2)]).atan2(r[(2, 2)]),
            r[(0, 2)].atan2(r[(0, 0)].hypot(r[(0, 1)])),
            (-r[(0, 1)]).atan2(r[(0, 0)]),
        )
    }

    /// Weight at these poses: what acts on the near and on the far node (base axes, about each node), and how that
    /// changes as they move. `gravity` in m/s^2, base axes.
    pub(crate) fn weight(&self, kinematics: &Kinematics, gravity: &Vector3<f64>) -> Weight {
        let (near, far) = (kinematics.frame(self.near), kinematics.frame(self.far));
        let eta = self.deflection(kinematics);
        Weight::of(self, &near.0, &(far.1 - near.1), &eta, gravity)
    }

    /// Potential energy of the weight, J: zero where the centre of mass is at the origin of the base.
    pub(crate) fn weight_energy(&self, kinematics: &Kinematics, gravity: &Vector3<f64>) -> f64 {
        let near = kinematics.frame(self.near);
        let eta = self.deflection(kinematics);
        let moment = FirstMoment::of(self);
        -gravity.dot(&(near.1 * self.total() + near.0 * moment.at(&eta)))
    }
}

/// Sum of mass times place of the slices, near axes: linear in `eta`.
struct FirstMoment {
    at_rest: Vector3<f64>,
    rates: [Vector6<f64>; 3],
}

impl FirstMoment {
    fn of(segment: &SegmentMass) -> Self {
        let mut sum = Self {
            at_rest: Vector3::zeros(),
            rates: [Vector6::zeros(); 3],
        };
        for slice in segment.slices() {
            sum.at_rest.x += slice.mass * slice.place * segment.length;
            for (rate, own) in sum.rates.iter_mut().zip(&slice.translations) {
                *rate += own * slice.mass;
            }
        }
        sum
    }

    fn at(&self, eta: &Vector6<f64>) -> Vector3<f64> {
        self.at_rest + Vector3::from_fn(|k, _| self.rates[k].dot(eta))
    }
}

/// Turns by the three angles of `Rx Ry Rz`, as columns: angular velocity in the near axes by their rates.
#[must_use]
pub fn turn_rates(rx: f64, ry: f64) -> Matrix3<f64> {
    let ((sa, ca), (sb, cb)) = (rx.sin_cos(), ry.sin_cos());
    Matrix3::new(1.0, 0.0, sb, 0.0, ca, -sa * cb, 0.0, sa, ca * cb)
}

/// Weight of a segment on its two nodes.
pub(crate) struct Weight {
    pub near: Wrench,
    pub far: Wrench,
    /// Rates `[on][by]`, near and far, 6 x 6.
    pub rates: [[Matrix6<f64>; 2]; 2],
}

impl Weight {
    /// The virtual work of the slices is `m g . v + (c x g) . w + Q . eta'` for the motion `v, w` of the near end and
    /// `Q = S^T g`. The far node carries what does the work of `Q`; the near node the rest. `arm` from near to far, m.
    fn of(
        segment: &SegmentMass,
        rotation: &Matrix3<f64>,
        arm: &Vector3<f64>,
        eta: &Vector6<f64>,
        gravity: &Vector3<f64>,
    ) -> Self {
        let moment = FirstMoment::of(segment);
        let g = rotation.transpose() * gravity;
        let arm = rotation.transpose() * arm;
        let mass = segment.total();
        let (centre, rates) = (moment.at(eta), &moment.rates);
        let by_eta = |g: &Vector3<f64>| rates[0] * g.x + rates[1] * g.y + rates[2] * g.z;
        let q = by_eta(&g);
        let turns = turn_rates(eta[3], eta[4]);
        // Turns of ry near 90 degrees are refused by nobody but have no meaning for a segment of a link.
        let inverse = turns
            .try_inverse()
            .unwrap_or_else(|| Matrix3::from_element(f64::NAN));
        let force = q.fixed_rows::<3>(0).into_owned();
        let turning = inverse.transpose() * q.fixed_rows::<3>(3);
        let near = Wrench::new(
            g * mass - force,
            centre.cross(&g) - arm.cross(&force) - turning,
        );
        // Rates by (v, w) of both nodes in near axes, near node first: of g, of eta, of the arm.
        let mut columns = [[Vector6::zeros(); 12]; 2];
        for (k, column) in
            (0..12).map(|k| (k, Vector3::from_fn(|i, _| f64::from(u8::from(i == k % 3)))))
        {
            let [v, w, v_far, w_far] = std::array::from_fn(|part| {
                if part == k / 3 {
                    column
                } else {
                    Vector3::zeros()
                }
            });
            let dg = g.cross(&w);
            let slide = v_far - v - w.cross(&arm);
            let angles = inverse * (w_far - w);
            let mut rate = Vector6::zeros();
            rate.fixed_rows_mut::<3>(0).copy_from(&slide);
            rate.fixed_rows_mut::<3>(3).copy_from(&angles);
            let dq = by_eta(&dg);
            let (dforce, dq_turn) = (
                dq.fixed_rows::<3>(0).into_owned(),
                dq.fixed_rows::<3>(3).into_owned(),
            );
            let first = Vector3::x() * angles.x;
            let second = first + turns.column(1) * angles.y;
            let turned = Vector3::new(
                0.0,
                first.cross(&turns.column(1)).dot(&turning),
                second.cross(&turns.column(2)).dot(&turning),
            );
            let dturning = inverse.transpose() * (dq_turn - turned);
            let dcentre = Vector3::from_fn(|i, _| rates[i].dot(&rate));
            let dmoment = dcentre.cross(&g) + centre.cross(&dg)
                - slide.cross(&force)
                - arm.cross(&dforce)
                - dturning;
            // In fixed axes the wrench turns with the near end.
            let fixed = |wrench: &Wrench, force: Vector3<f64>, moment: Vector3<f64>| {
                let (f, m) = (
                    force + w.cross(&wrench.force()),
                    moment + w.cross(&wrench.moment()),
                );
                let (f, m) = (rotation * f, rotation * m);
                Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
            };
            columns[0][k] = fixed(&near, dg * mass - dforce, dmoment);
            columns[1][k] = fixed(&Wrench::new(force, turning), dforce, dturning);
        }
        // Columns by twists in base axes.
        let mut in_base = Matrix6::zeros();
        for part in [0, 3] {
            in_base
                .fixed_view_mut::<3, 3>(part, part)
                .copy_from(&rotation.transpose());
        }
        let block = |on: usize, by: usize| {
            Matrix6::from_columns(&columns[on][6 * by..6 * by + 6]) * in_base
        };
        let in_base_axes = |w: &Wrench| Wrench::new(rotation * w.force(), rotation * w.moment());
        Self {
            near: in_base_axes(&near),
            far: in_base_axes(&Wrench::new(force, turning)),
            rates: [[block(0, 0), block(0, 1)], [block(1, 0), block(1, 1)]],
        }
    }

    /// The rates as tangents of the nodes, multiplied by `factor`.
    pub fn tangents(&self, segment: &SegmentMass, factor: f64) -> [NodeTangent; 4] {
        let nodes = [segment.near, segment.far];
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(on, by)| NodeTangent {
            on: nodes[on],
            by: nodes[by],
            matrix: self.rates[on][by] * factor,
        })
    }
}

/// Shear ratios of bending along y and along z of a segment of length `h` from the stiffness at its end.
pub(crate) fn shear_ratios(end: &Matrix6<f64>, h: f64) -> [f64; 2] {
    [(1, 5), (2, 4)].map(|(across, turn)| {
        let ratio = 12.0 * end[(turn, turn)] / (end[(across, across)] * h * h) - 4.0;
        // Rounding of a slender link, and matrices that are no beam's.
        if ratio.is_finite() && ratio > 1e-9 {
            ratio
        } else {
            0.0
        }
    })
}
