//! Weight of the mass along a link at given poses of its ends, and how it changes as they move [D 5].

use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::link_mass::SegmentMass;
use crate::spatial::Wrench;

impl SegmentMass {
    /// Motion of the far end relative to the near one at these poses: `eta`, m and rad.
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
            // The wrench turns with the near end in fixed axes.
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
