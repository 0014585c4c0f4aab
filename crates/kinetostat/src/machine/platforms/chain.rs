//! The Newton step of a machine that is one chain from the base to its tool.
//!
//! Its tip is not held while the limb is linearised: the equilibrium of the tool, and what guides it, are
//! six conditions on the wrench and the motion of the tip. So no stiffness of the tip is formed, in
//! which a link that bends easily would drown beside its own axial stiffness.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use crate::chain::sweep::solve::EndRows;
use crate::linalg::complement::complement;
use crate::machine::platforms::parts::{EquilibriumRows, PlatformStep, Tangents, Unknowns};
use crate::machine::platforms::solver::PlatformSolver;
use crate::model::chain::{Coordinate, Role};
use crate::spatial::{Twist, Wrench, hat, rotational, shift_matrix};

impl PlatformSolver<'_> {
    /// One limb without passive joints from the base to the only moving platform, which goes where
    /// the limb leads. Passive joints may leave motions that nothing holds: then the shortest motion
    /// of the tool is wanted.
    pub fn is_one_chain(&self) -> bool {
        let passive = |c: &Coordinate| c.role == Role::Passive;
        self.linear.len() == 1
            && self.state.platforms.len() == 2
            && self.follows()
            && !self.mechanism.limbs()[0]
                .actual
                .coordinates()
                .iter()
                .any(passive)
    }

    /// Number of conditions of the guide.
    fn guided(&self) -> usize {
        match self.unknowns {
            Unknowns::Guided => self.guide.hands.ncols(),
            _ => 0,
        }
    }

    /// Equilibrium of the tool and its conditions at the present state, scaled.
    fn equilibrium_rows(&self) -> (EquilibriumRows, EndRows) {
        let scales = &self.scales[0];
        let arm = self.arm(0, &self.state);
        let f = self.state.wrenches[0].force();
        let mut by_tool = rotational(&(hat(&f) * hat(&arm)));
        self.add_platform_loads(&self.state, |_, _, block| by_tool += block);
        let t = shift_matrix(&arm);
        // The tool moves as the tip does, seen from its own origin.
        let back = shift_matrix(&-arm);
        let (wrench, motion) = (t.transpose(), by_tool * back);
        let k = self.guided();
        let unit = |i: usize| scales[i];
        let hands = DMatrix::from_fn(6, k, |i, j| self.guide.hands[(i, j)] / unit(i));
        let mut across = match k {
            0 => DMatrix::identity(6, 6),
            _ => complement(&hands).transpose(),
        };
        for (i, mut column) in across.column_iter_mut().enumerate() {
            column /= unit(i);
        }
        let pose = &self.state.platforms[self.mechanism.tool()];
        let conditions = self.guide.rows_at(pose) * back;
        let (of_wrench, of_motion) = (&across * wrench, &across * motion);
        let mut rows = EndRows {
            wrench: Matrix6::zeros(),
            motion: Matrix6::zeros(),
        };
        for j in 0..6 {
            for i in 0..6 - k {
                rows.wrench[(i, j)] = of_wrench[(i, j)] * unit(j);
                rows.motion[(i, j)] = of_motion[(i, j)] / unit(j);
            }
            for i in 0..k {
                rows.motion[(6 - k + i, j)] = conditions[(i, j)] / unit(j);
            }
        }
        let mut sizes = Vector6::repeat(1.0);
        for i in 0..6 {
            let largest = rows.wrench.row(i).amax().max(rows.motion.row(i).amax());
            if largest > 0.0 {
                sizes[i] = 1.0 / largest;
                rows.wrench.row_mut(i).scale_mut(sizes[i]);
                rows.motion.row_mut(i).scale_mut(sizes[i]);
            }
        }
        let equilibrium = EquilibriumRows {
            across,
            wrench,
            motion,
            sizes,
        };
        (equilibrium, rows)
    }

    /// See [`Self::newton`].
    pub fn step_of_chain(
        &mut self,
        unbalanced: &[Wrench],
        tangents: Tangents,
    ) -> Option<(PlatformStep, Vec<DVector<f64>>)> {
        let mut new = None;
        if let Tangents::New { hessian } = tangents {
            let (equilibrium, rows) = self.equilibrium_rows();
            self.equilibrium = Some(equilibrium);
            new = Some((hessian, rows));
        }
        let (tool, k) = (self.mechanism.tool(), self.guided());
        let pose = &self.state.platforms[tool];
        let equilibrium = self.equilibrium.as_ref()?;
        let missing = match k {
            0 => DVector::zeros(0),
            _ => self.guide.residual(pose),
        };
        let own = &equilibrium.across * unbalanced[tool].0;
        let right = Vector6::from_fn(|i, _| {
            let given = if i < 6 - k {
                own[i]
            } else {
                missing[i - (6 - k)]
            };
            given * equilibrium.sizes[i]
        });
        if let Some((hessian, rows)) = new {
            let linear = &mut self.linear[0];
            if !linear.linearise_loaded(hessian, rows, &right, &self.scales[0]) {
                linear.system.make_dense();
                self.evaluate_limb(0);
                let linear = &mut self.linear[0];
                linear.linearise_loaded(hessian, rows, &right, &self.scales[0]);
            }
        }
        let equilibrium = self.equilibrium.as_ref()?;
        let change = self.linear[0].loaded(&right, &self.scales[0])?;
        if change.iter().any(|x| !x.is_finite()) {
            return None;
        }
        let wrench = change.fixed_view::<6, 1>(0, 0).into_owned();
        let n = self.state.coordinates[0].len();
        let tip = self.linear[0].system.jacobian.columns(0, n) * change.rows(6, n);
        let tip = Vector6::from_fn(|i, _| tip[(i, 0)]);
        let arm = self.arm(0, &self.state);
        let mut push = Wrench::zero();
        if k > 0 {
            // Effect of the hands: the equilibrium of the tool once more.
            let left = equilibrium.wrench * wrench + equilibrium.motion * tip - unbalanced[tool].0;
            let unit = |i: usize| self.scales[0][i];
            let hands = DMatrix::from_fn(6, k, |i, j| self.guide.hands[(i, j)] / unit(i));
            let left = DVector::from_fn(6, |i, _| left[i] / unit(i));
            let qr = hands.qr();
            let amounts = qr
                .r()
                .solve_upper_triangular(&(qr.q().transpose() * left))?;
            let all = &self.guide.hands * amounts / self.share;
            push = Wrench(Vector6::from_fn(|i, _| all[i]));
        }
        let step = PlatformStep {
            motions: vec![Twist(shift_matrix(&-arm) * tip)],
            target: Twist::zero(),
            carried: vec![Wrench::zero()],
            push,
        };
        Some((step, vec![change.column(0).into_owned()]))
    }
}
