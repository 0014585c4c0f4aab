//! Constraints by the limbs of a posture with their actuators locked and their springs stiff: too few (a singular
//! posture), or more than needed (over-constraint).

use nalgebra::{DMatrix, DVector, Vector3};

use crate::chain::directions::axis_description;
use crate::linalg::complement::complement;
use crate::linalg::saddle::independent_columns;
use crate::linalg::singular_values::range;
use crate::machine::network::ends;
use crate::machine::posture::Posture;
use crate::model::chain::Role;
use crate::model::kinematics::Kinematics;
use crate::number::larger;
use crate::spatial::{MotionKind, Wrench};

/// Singular values below this share of the largest are zero: postures close to about 1e-13.
const ZERO: f64 = 1e-9;

/// Wrenches that the limbs carry with no load, because there are more of them than the platforms
/// need: every error of manufacture along them strains the machine.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Overconstraint {
    /// Degree: number of independent self-stresses.
    pub degree: usize,
    /// A basis of them, each in as few limbs as elimination finds.
    pub stresses: Vec<SelfStress>,
}

/// One set of wrenches in equilibrium with itself.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SelfStress {
    /// Limb (its index) and wrench on its tip, about it, base axes; the largest has size 1 N, moments
    /// counted by the natural length. Limbs with less than 1e-9 of it are left out.
    pub wrenches: Vec<(usize, Wrench)>,
}

impl SelfStress {
    /// Describes the self-stressed limbs: `x: force along z and moment about x; y: ...`.
    #[must_use]
    pub fn description(&self, posture: &Posture) -> String {
        let length = posture.mechanism.scale().length;
        let parts = self.wrenches.iter().map(|(limb, wrench)| {
            let (force, moment) = (wrench.force(), wrench.moment());
            let mut words = Vec::new();
            if force.norm() > 1e-6 {
                words.push(format!("force along {}", axis_description(&force)));
            }
            if moment.norm() > 1e-6 * length {
                words.push(format!("moment about {}", axis_description(&moment)));
            }
            let name = &posture.mechanism.limbs()[*limb].name;
            format!("{name}: {}", words.join(" and "))
        });
        parts.collect::<Vec<_>>().join("; ")
    }
}

/// Rows of all constraints over the motions of all moving platforms.
pub(crate) struct Constraints {
    /// Orthonormal wrenches per limb in units of the natural length, 6 x k.
    pub wrenches: Vec<DMatrix<f64>>,
    /// Rows x 6P, scaled.
    pub rows: DMatrix<f64>,
}

/// Motions of a limb's tip by its joints, 6 x k, rotations at `length`: passive joints only, or
/// with the actuators.
pub(crate) fn limb_motions(
    posture: &Posture,
    limb: usize,
    actuators: bool,
    length: f64,
) -> DMatrix<f64> {
    let (l, joints) = (&posture.mechanism.limbs()[limb], &posture.limbs[limb]);
    let chain = &l.nominal;
    let base = &posture.platforms[l.from];
    let kinematics = Kinematics::new(chain, base, &joints.coordinates, &joints.commands);
    let all = kinematics.jacobian(chain.tip());
    let n = chain.coordinate_count();
    let mut columns: Vec<(usize, MotionKind)> = chain
        .indices_of(Role::Passive)
        .into_iter()
        .map(|i| (i, chain.coordinates()[i].kind))
        .collect();
    if actuators {
        let own = chain.actuators().iter().enumerate();
        columns.extend(own.map(|(k, a)| (n + k, a.kind)));
    }
    DMatrix::from_fn(6, columns.len(), |i, j| {
        let (column, kind) = columns[j];
        let row = if i < 3 { 1.0 } else { length };
        let unit = match kind {
            MotionKind::Prismatic => 1.0,
            MotionKind::Revolute => length,
        };
        all[(i, column)] * row / unit
    })
}

impl Constraints {
    pub fn new(posture: &Posture, with_actuators_free: bool) -> Self {
        let m = &posture.mechanism;
        let length = m.scale().length;
        let moving = m.platforms().len() - 1;
        let unit = |i: usize| if i % 6 < 3 { 1.0 } else { length };
        let mut wrenches = Vec::new();
        let mut blocks = Vec::new();
        for i in 0..m.limbs().len() {
            let motions = limb_motions(posture, i, with_actuators_free, length);
            let own = complement(&independent_columns(&motions));
            let a = ends(&posture.mechanism, &posture.platforms, i).matrix(moving);
            let a = DMatrix::from_fn(6, 6 * moving, |r, c| a[(r, c)] * unit(r) / unit(c));
            blocks.push(own.transpose() * a);
            wrenches.push(own);
        }
        let count = blocks.iter().map(DMatrix::nrows).sum();
        let mut rows = DMatrix::zeros(count, 6 * moving);
        let mut at = 0;
        for block in blocks {
            rows.rows_mut(at, block.nrows()).copy_from(&block);
            at += block.nrows();
        }
        Self { wrenches, rows }
    }
}

impl Posture {
    /// Over-constraint of the nominal machine at this posture, actuators locked: number of self-stresses, and their
    /// directions in the limbs.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let tube = BeamSection::tube(2.1e11, 8.1e10, 0.12, 0.10); // Pa, m
    /// # let hinge = |stiffness| ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), stiffness);
    /// # let chain = Chain::builder("arm")
    /// #     .actuator("shoulder", hinge(2e5))
    /// #     .link("upper arm", &tube, 0.6)
    /// #     .actuator("elbow", hinge(1e5))
    /// #     .link("forearm", &tube, 0.5)
    /// #     .build()?;
    /// # let home = Pose::translation(1.1, 0.0, 0.0);
    /// # let arm = Mechanism::serial(chain, home, Vector3::zeros())?;
    /// assert_eq!(arm.posture(&home)?.overconstraint().degree, 0, "a single limb fights nothing");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn overconstraint(&self) -> Overconstraint {
        let constraints = Constraints::new(self, false);
        let basis = complement(&range(&constraints.rows, ZERO));
        let basis = sparse(basis);
        let length = self.mechanism.scale().length;
        let stresses = basis.column_iter().map(|column| {
            let mut at = 0;
            let mut list = Vec::new();
            for (limb, own) in constraints.wrenches.iter().enumerate() {
                let k = own.ncols();
                let w = own * column.rows(at, k);
                at += k;
                list.push((limb, w));
            }
            let size = |w: &DVector<f64>| w.norm();
            let most = list.iter().map(|(_, w)| size(w)).fold(0.0, larger);
            list.retain(|(_, w)| size(w) > 1e-9 * most);
            SelfStress {
                wrenches: list
                    .into_iter()
                    .map(|(limb, w)| {
                        let w = w / most;
                        let force = Vector3::new(w[0], w[1], w[2]);
                        let moment = Vector3::new(w[3], w[4], w[5]) * length;
                        (limb, Wrench::new(force, moment))
                    })
                    .collect(),
            }
        });
        let stresses: Vec<SelfStress> = stresses.collect();
        Overconstraint {
            degree: stresses.len(),
            stresses,
        }
    }

    /// Number of independent ways in which actuators can move while the tool stays: zero if the
    /// commands follow from the pose of the tool. Where it is not zero, a mechanism with several
    /// moving platforms takes the commands nearest to home (least sum of squares of the changes,
    /// rotations at the limb's natural length, passive joints counted with a hundredth; a local
    /// minimum), and a machine of single limbs the least motion from where the search starts.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis| ActuatorSpec::new(MotionKind::Prismatic, axis, 5e7); // N/m
    /// # let machine = |last| -> Result<Mechanism> {
    /// #     let chain = Chain::builder("slides")
    /// #         .actuator("long", slide(Vector3::x()))
    /// #         .actuator("across", slide(Vector3::y()))
    /// #         .actuator("short", slide(last))
    /// #         .build()?;
    /// #     Mechanism::serial(chain, Pose::identity(), Vector3::zeros())
    /// # };
    /// // Three slides along x, y and z; or along x, y and a direction between them.
    /// let (spatial, plane) = (machine(vector![0.0, 0.0, 1.0])?, machine(vector![0.6, 0.8, 0.0])?);
    /// assert_eq!(spatial.posture(&Pose::identity())?.redundancy(), 0);
    /// assert_eq!(plane.posture(&Pose::identity())?.redundancy(), 1);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn redundancy(&self) -> usize {
        let m = &self.mechanism;
        let length = m.scale().length;
        let moving = m.platforms().len() - 1;
        let unit = |i: usize| if i % 6 < 3 { 1.0 } else { length };
        let rank = |actuators: bool| {
            let own: Vec<DMatrix<f64>> = (0..m.limbs().len())
                .map(|i| limb_motions(self, i, actuators, length))
                .collect();
            let joints: usize = own.iter().map(DMatrix::ncols).sum();
            let mut all = DMatrix::zeros(6 * own.len(), joints + 6 * moving);
            let mut at = 0;
            for (i, block) in own.iter().enumerate() {
                all.view_mut((6 * i, at), block.shape()).copy_from(block);
                at += block.ncols();
                let a = ends(&self.mechanism, &self.platforms, i).matrix(moving);
                for (r, c) in (0..6).flat_map(|r| (0..6 * moving).map(move |c| (r, c))) {
                    // The tool is held.
                    if c / 6 + 1 != m.tool() {
                        all[(6 * i + r, joints + c)] = a[(r, c)] * unit(r) / unit(c);
                    }
                }
            }
            range(&all, ZERO).ncols()
        };
        m.actuator_count() - (rank(true) - rank(false))
    }
}

/// Sparse basis of the same space: every vector has an entry of its own.
fn sparse(mut basis: DMatrix<f64>) -> DMatrix<f64> {
    for k in 0..basis.ncols() {
        // The largest entry of all vectors not yet treated.
        let rest = basis.columns(k, basis.ncols() - k);
        let (row, column) = rest.iamax_full();
        basis.swap_columns(k, k + column);
        let pivot = basis[(row, k)];
        basis.column_mut(k).unscale_mut(pivot);
        let own = basis.column(k).into_owned();
        for other in (0..basis.ncols()).filter(|&j| j != k) {
            let share = basis[(row, other)];
            let mut column = basis.column_mut(other);
            column -= &own * share;
        }
    }
    for x in basis.iter_mut() {
        if x.abs() < 1e-9 {
            *x = 0.0;
        }
    }
    basis
}
