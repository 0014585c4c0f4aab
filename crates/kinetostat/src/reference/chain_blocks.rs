//! The blocks of a chain's tangent at one state, which the three ways to a stiffness share, and the conditions under which closed
//! forms hold.

use nalgebra::{DMatrix, Matrix6, Vector6};

use crate::chain::compliance::CartesianCompliance;
use crate::chain::directions::scaled_twist;
use crate::chain::equilibrium::{Equilibrium, System, scales_of};
use crate::chain::problem::ChainProblem;
use crate::error::Result;
use crate::linalg::complement::complement;
use crate::linalg::saddle::{RANK_TOLERANCE, column_space, pseudo_inverse};
use crate::model::chain::{Chain, Role, Scale};
use crate::spatial::{Pose, Wrench};

/// Jacobians, springs and Hessians of a chain at one state, scaled.
#[derive(Clone, Debug)]
pub struct ChainBlocks {
    /// `J_q`, 6 x n_q.
    pub(crate) j_q: DMatrix<f64>,
    /// `J_theta`, 6 x n_theta.
    pub(crate) j_theta: DMatrix<f64>,
    /// `H_qq`.
    pub(crate) h_qq: DMatrix<f64>,
    /// `H_qtheta`.
    pub(crate) h_qt: DMatrix<f64>,
    /// `H_thetaq`.
    pub(crate) h_tq: DMatrix<f64>,
    /// `K_theta - H_thetatheta`.
    pub(crate) held: DMatrix<f64>,
    /// Units of wrench (6), passive joints and springs.
    pub(crate) scales: [Vec<f64>; 3],
    pub(crate) joints: Vec<String>,
    scale: Scale,
    pub(crate) loaded: bool,
}

impl ChainBlocks {
    /// The unloaded chain over a base, at coordinates and commands (m, rad).
    ///
    /// # Errors
    /// Lists of the wrong length or with numbers that are not finite.
    pub fn unloaded(
        chain: &Chain,
        base: &Pose,
        coordinates: &[f64],
        commands: &[f64],
    ) -> Result<Self> {
        chain.check(coordinates, commands)?;
        let place = chain.place();
        crate::model::limits::check_pose(&place, "the pose of the base", base)?;
        let mut system = System::new(chain, base, coordinates, commands, false);
        let none = Wrench::zero();
        system.evaluate(
            chain,
            base,
            coordinates,
            commands,
            &[],
            coordinates,
            &none,
            0.0,
        );
        system.hessian.fill(0.0);
        Ok(Self::new(
            chain,
            &system,
            &scales_of(chain, coordinates),
            false,
        ))
    }

    /// A chain in equilibrium under its loads.
    ///
    /// # Errors
    /// An equilibrium that is not one of this problem's chain.
    pub fn loaded(problem: &ChainProblem<'_>, equilibrium: &Equilibrium) -> Result<Self> {
        let (chain, base, posture) = (problem.chain, &problem.base, &problem.posture);
        let (x, commands) = (&equilibrium.coordinates, &problem.commands);
        chain.check(x, commands)?;
        chain.check(posture, commands)?;
        let mut system = System::new(chain, base, posture, commands, false);
        system.evaluate_problem(problem, x, &equilibrium.wrench, 1.0);
        Ok(Self::new(chain, &system, &scales_of(chain, posture), true))
    }

    fn new(chain: &Chain, system: &System, scales: &[f64], loaded: bool) -> Self {
        let (q, theta) = (
            chain.indices_of(Role::Passive),
            chain.indices_of(Role::Spring),
        );
        let columns = |of: &[usize]| {
            DMatrix::from_fn(6, of.len(), |i, j| {
                system.jacobian[(i, of[j])] * scales[i] * scales[6 + of[j]]
            })
        };
        let block = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| {
                let at = (rows[i], columns[j]);
                let k = system.spring_tangent[at];
                (system.hessian[at] - k) * scales[6 + at.0] * scales[6 + at.1]
            })
        };
        let units = |of: &[usize]| of.iter().map(|&i| scales[6 + i]).collect();
        let name = |&i: &usize| chain.coordinates()[i].name.clone();
        Self {
            j_q: columns(&q),
            j_theta: columns(&theta),
            h_qq: block(&q, &q),
            h_qt: block(&q, &theta),
            h_tq: block(&theta, &q),
            held: -block(&theta, &theta),
            scales: [scales[..6].to_vec(), units(&q), units(&theta)],
            joints: q.iter().map(name).collect(),
            scale: chain.scale(),
            loaded,
        }
    }

    /// Names of the passive joints, in the order of the columns of `J_q`.
    #[must_use]
    pub fn passive_joints(&self) -> &[String] {
        &self.joints
    }

    /// `k = (K_theta - H_thetatheta)^-1`.
    pub(crate) fn spring_compliance(&self) -> Applied<DMatrix<f64>> {
        regular_inverse(&self.held).ok_or(Inapplicable::SpringsAreSpent)
    }

    /// `K_C0 = (J_theta k J_theta^T)^-1`: the chain with its passive joints locked.
    pub(crate) fn locked(&self, k: &DMatrix<f64>) -> Applied<DMatrix<f64>> {
        let compliance = &self.j_theta * k * self.j_theta.transpose();
        let rank = || pseudo_inverse(&compliance).1;
        regular_inverse(&compliance).ok_or_else(|| Inapplicable::SpringsDoNotReach(rank()))
    }

    /// Scaled rows x 6 to N, m, rad.
    pub(crate) fn physical(&self, unit: usize, scaled: &DMatrix<f64>) -> DMatrix<f64> {
        let [wrench, ..] = &self.scales;
        let rows = &self.scales[unit];
        DMatrix::from_fn(rows.len(), 6, |i, j| scaled[(i, j)] * rows[i] * wrench[j])
    }

    pub(crate) fn physical_stiffness(&self, scaled: &DMatrix<f64>) -> Matrix6<f64> {
        // Scaled wrench per scaled twist: both units are those of the wrench.
        let k = self.physical(0, scaled);
        Matrix6::from_fn(|i, j| k[(i, j)])
    }

    /// The compliance form: it exists where the stiffness is infinite in some directions. With a
    /// load it is the response to a further dead force at the free end.
    #[must_use]
    pub fn compliance(&self) -> CartesianCompliance {
        let (n, m) = (self.joints.len(), self.held.nrows());
        let mut held = DMatrix::zeros(n + m, n + m);
        held.view_mut((0, 0), (n, n)).copy_from(&-&self.h_qq);
        held.view_mut((0, n), (n, m)).copy_from(&-&self.h_qt);
        held.view_mut((n, 0), (m, n)).copy_from(&-&self.h_tq);
        held.view_mut((n, n), (m, m)).copy_from(&self.held);
        let mut jacobian = DMatrix::zeros(6, n + m);
        jacobian.columns_mut(0, n).copy_from(&self.j_q);
        jacobian.columns_mut(n, m).copy_from(&self.j_theta);
        let (inverse, rank) = pseudo_inverse(&held);
        let springs = &jacobian * inverse * jacobian.transpose();
        let mut free = DMatrix::zeros(6, 0);
        if rank < n + m {
            let loose = &jacobian * complement(&column_space(&held.transpose()));
            // Motions that leave the end where it is are redundancy, not freedom.
            if loose.amax() > RANK_TOLERANCE * jacobian.amax() {
                free = column_space(&loose);
            }
        }
        let twists = |basis: &DMatrix<f64>| {
            let motion = |c: nalgebra::DVectorView<'_, f64>| Vector6::from_fn(|i, _| c[i]);
            let columns = basis.column_iter();
            columns
                .map(|c| scaled_twist(self.scale, &motion(c.as_view())))
                .collect()
        };
        let [units, ..] = &self.scales;
        CartesianCompliance {
            springs: Matrix6::from_fn(|i, j| springs[(i, j)] / (units[i] * units[j])),
            free: twists(&free),
            rigid: twists(&complement(&column_space(&jacobian))),
            length: self.scale.length,
        }
    }
}

/// Inverse of a scaled matrix, `None` if it is singular.
pub(crate) fn regular_inverse(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    if matrix.nrows() == 0 {
        return Some(matrix.clone());
    }
    if pseudo_inverse(matrix).1 < matrix.nrows() {
        return None;
    }
    let inverse = matrix.clone().try_inverse()?;
    inverse.iter().all(|x| x.is_finite()).then_some(inverse)
}

/// Reason why a form has no answer here.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Inapplicable {
    /// `J_theta k J_theta^T` is singular: the springs alone do not move the end in all six
    /// directions [R remark 1]. Carries how many they move.
    SpringsDoNotReach(usize),
    /// `J_q^T K J_q` is singular: these passive joints are redundant [R remark 2].
    RedundantPassiveJoints(Vec<String>),
    /// `K_theta - H_thetatheta` is singular: the load takes a spring's hold, as if nothing else
    /// held it.
    SpringsAreSpent,
    /// The last bracket of [R 4.29] is singular: the held chain has a neutral motion of these
    /// passive joints (redundancy, or a critical load).
    PassiveJointsUndecided(Vec<String>),
    /// The order must name each passive joint at most once; carries how many there are.
    NotAnOrder(usize),
    /// The form is that of the unloaded chain [R 3.10, 3.11], and this one is loaded.
    Loaded,
}

/// Answer of a form that does not always apply; `Err` says why it does not.
pub type Applied<T> = std::result::Result<T, Inapplicable>;
