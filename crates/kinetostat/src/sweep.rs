//! One long chain as a sequence of stages: what a sweep along it needs, with cost and memory that
//! grow with the number of coordinates and no faster.
//!
//! With the columns `s_i` of the tip's Jacobian (twists at the tip's place per unit of coordinate
//! `i`), the matrix of a Newton step has, for loads whose change depends on the node that they act
//! on alone, the entries
//!
//! ```text
//! (H - K)_ij = s_i^T G_max(i,j) s_j + [j < i] s_i^T A_i s_j - K_ij
//! G_i = sum over nodes k beyond i of [0, 0; -hat(f_k), hat(f_k) hat(p_k)] + P_k^T T_k P_k
//! A_i = [0, hat(f); hat(f), hat(m)]         force and moment beyond i, about the tip's place
//! ```
//!
//! `p_k` leads from the tip's place to the node, `P_k = [1, -hat(p_k); 0, 1]`, `T_k` is the tangent of
//! a load at the node. So with `t_i = sum_{j <= i} s_j x_j`, the motion of what lies beyond
//! coordinate `i`, the product with a vector `x` is a walk out and a walk back:
//!
//! ```text
//! t_i = t_(i-1) + s_i x_i,    y_(i-1) = y_i + g_(i-1) t_(i-1),    row i: s_i^T (y_i + A_i t_i) - (K x)_i
//! ```
//!
//! with `g` the share of the nodes between two coordinates in `G`. In exponential coordinates
//! (symmetric) `G` is replaced by its symmetric part and `A` by one half below and minus one half
//! above the diagonal. [`crate::sweep_factor`] eliminates coordinates in the same walk.
//!
//! Everything here is balanced: wrenches and coordinates in the units of
//! [`crate::equilibrium::balance`].

use nalgebra::{Matrix3, Matrix6, Matrix6xX, Vector6};

use crate::chain::{Chain, Element};
use crate::kinematics::Kinematics;
use crate::loading::NodeTangent;
use crate::saddle::RANK_TOLERANCE;
use crate::spatial::{Wrench, hat, shift_matrix};

/// Chains of fewer coordinates are solved with dense matrices, which are faster there.
pub(crate) const SWEEP_FROM: usize = 60;

/// Coordinates that are eliminated together: a spring block or a passive joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage {
    pub first: usize,
    /// One to six.
    pub len: usize,
}

/// Which tangent is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Form {
    /// `-K`: the report's iteration, loads lagged.
    Lagged,
    /// `H - K`, `H` of dead wrenches as it is.
    Exact,
    /// `H' - mu K'` in exponential coordinates: `K'` at rest, `H'` with what deflection changed in
    /// the springs. At `mu = 1` the symmetric part of [`Form::Exact`].
    Pencil(f64),
}

impl Form {
    /// Factors of `A` below and above the diagonal.
    pub fn skew(self) -> (f64, f64) {
        match self {
            Self::Lagged => (0.0, 0.0),
            Self::Exact => (1.0, 0.0),
            Self::Pencil(_) => (0.5, -0.5),
        }
    }
}

/// A chain at one state, stage by stage.
pub(crate) struct Sweep {
    pub stages: Vec<Stage>,
    /// Per node: number of stages nearer the base.
    before: Vec<usize>,
    /// Stage of every spring block.
    stage_of: Vec<usize>,
    factors: Vec<f64>,
    /// `s`, 6 x len, filled up with zeros.
    pub twists: Vec<Matrix6<f64>>,
    /// `K`, len x len, filled up with zeros.
    pub springs: Vec<Matrix6<f64>>,
    /// Change of `K` since rest.
    pub geometric: Vec<Option<Matrix6<f64>>>,
    /// `A` of the loads beyond a stage; `None` where there are none.
    pub outer: Vec<Option<Matrix6<f64>>>,
    /// `g` of the nodes beyond `c` stages and before the next one; entry 0 is of no interest.
    pub between: Vec<Option<Matrix6<f64>>>,
    /// Inverse of `K` at rest.
    compliance: Vec<Matrix6<f64>>,
    /// No load couples the motions of nodes in different places.
    pub serial: bool,
    /// Scratch: wrench on the nodes between two stages, about the tip's place.
    wrenches: Vec<Vector6<f64>>,
}

/// Stages of a chain and number of stages before each node; `None` if it is no sequence of them: a
/// coordinate drives several motions, a block is torn apart or has more than six coordinates.
fn stages(chain: &Chain) -> Option<(Vec<Stage>, Vec<usize>, Vec<usize>)> {
    let mut block_of = vec![None; chain.coordinate_count()];
    for (k, block) in chain.springs().iter().enumerate() {
        if block.len() > 6 {
            return None;
        }
        for of in block_of.get_mut(block.first..block.first + block.len())? {
            *of = Some(k);
        }
    }
    let (mut stages, mut before) = (Vec::<Stage>::new(), Vec::new());
    let mut stage_of = vec![0; chain.springs().len()];
    let (mut next, mut missing) = (0, 0);
    for element in chain.elements() {
        match element {
            Element::Rigid(_) => {}
            Element::Node(index) => {
                if missing > 0 || *index != before.len() {
                    return None;
                }
                before.push(stages.len());
            }
            Element::Motion(motion) => {
                let Some(drive) = motion.coordinate else {
                    continue;
                };
                if drive.index != next {
                    return None;
                }
                next += 1;
                if missing > 0 {
                    missing -= 1;
                    continue;
                }
                let mut stage = Stage {
                    first: drive.index,
                    len: 1,
                };
                if let Some(k) = block_of[drive.index] {
                    stage_of[k] = stages.len();
                    stage.len = chain.springs()[k].len();
                    if chain.springs()[k].first != drive.index {
                        return None;
                    }
                }
                missing = stage.len - 1;
                stages.push(stage);
            }
        }
    }
    (next == chain.coordinate_count() && missing == 0).then_some((stages, before, stage_of))
}

impl Sweep {
    /// `None` for a chain that is no sequence of stages, or has no springs.
    pub fn new(chain: &Chain, posture: &[f64], factors: &[f64]) -> Option<Self> {
        let (stages, before, stage_of) = stages(chain)?;
        if chain.springs().is_empty() {
            return None;
        }
        let count = stages.len();
        let mut compliance = vec![Matrix6::zeros(); count];
        for (block, &stage) in chain.springs().iter().zip(&stage_of) {
            let k = block.stiffness_at(posture);
            let balanced = nalgebra::DMatrix::from_fn(block.len(), block.len(), |i, j| {
                k[(i, j)] * factors[6 + block.first + i] * factors[6 + block.first + j]
            });
            let inverse = balanced.cholesky()?.inverse();
            for i in 0..block.len() {
                for j in 0..block.len() {
                    compliance[stage][(i, j)] = inverse[(i, j)];
                }
            }
        }
        Some(Self {
            before,
            stage_of,
            factors: factors.to_vec(),
            twists: vec![Matrix6::zeros(); count],
            springs: vec![Matrix6::zeros(); count],
            geometric: vec![None; count],
            outer: vec![None; count],
            between: vec![None; count + 1],
            compliance,
            serial: true,
            wrenches: vec![Vector6::zeros(); count + 1],
            stages,
        })
    }

    /// Number of coordinates.
    pub fn count(&self) -> usize {
        self.stages.last().map_or(0, |s| s.first + s.len)
    }

    /// Springs of one state: `add(block, entry)` gives the entries of block number `block` in N, m,
    /// rad; `geometric` is what changed since rest.
    pub fn set_springs(
        &mut self,
        chain: &Chain,
        mut add: impl FnMut(usize, &mut dyn FnMut(usize, usize, f64)),
    ) {
        for (k, &stage) in self.stage_of.iter().enumerate() {
            let first = 6 + chain.springs()[k].first;
            let own = &mut self.springs[stage];
            own.fill(0.0);
            let factors = &self.factors;
            add(k, &mut |i, j, value| {
                own[(i, j)] += value * factors[first + i] * factors[first + j];
            });
        }
    }

    /// What deflection changed in the springs: first coordinate and matrix, in N, m, rad.
    pub fn set_geometric(&mut self, changes: &[(usize, Matrix6<f64>)]) {
        self.geometric.fill(None);
        for (first, change) in changes {
            let at = self.stages.binary_search_by_key(first, |s| s.first);
            if let Ok(stage) = at {
                let f = &self.factors[6 + first..];
                let balanced = Matrix6::from_fn(|i, j| change[(i, j)] * f[i] * f[j]);
                self.geometric[stage] = Some(balanced);
            }
        }
    }

    /// Motions and loads of one state: wrenches on nodes and their tangents in base axes, `jacobian`
    /// of the tip. Fills the torque of every coordinate (N, N m).
    pub fn set_loads(
        &mut self,
        kinematics: &Kinematics,
        jacobian: &Matrix6xX<f64>,
        wrenches: &[(usize, Wrench)],
        tangents: &[NodeTangent],
        torque: &mut [f64],
    ) {
        let unit = Vector6::from_column_slice(&self.factors[..6]);
        let per_unit = |m: &Matrix6<f64>| Matrix6::from_fn(|i, j| m[(i, j)] / (unit[i] * unit[j]));
        let tip = kinematics.tip_pose().translation.vector;
        self.wrenches.fill(Vector6::zeros());
        self.between.fill(None);
        for (node, wrench) in wrenches {
            let (place, f) = (self.before[*node], wrench.force());
            let arm = kinematics.node_position(*node) - tip;
            let moment = wrench.moment() + arm.cross(&f);
            let sum = &mut self.wrenches[place];
            *sum += Wrench::new(f, moment).0;
            if f != nalgebra::Vector3::zeros() {
                let mut g = Matrix6::zeros();
                g.fixed_view_mut::<3, 3>(3, 0).copy_from(&-hat(&f));
                g.fixed_view_mut::<3, 3>(3, 3)
                    .copy_from(&(hat(&f) * hat(&arm)));
                *self.between[place].get_or_insert_with(Matrix6::zeros) += per_unit(&g);
            }
        }
        self.serial = true;
        for tangent in tangents {
            let place = self.before[tangent.on];
            self.serial &= place == self.before[tangent.by];
            let shift = |node| shift_matrix(&(kinematics.node_position(node) - tip));
            let g = shift(tangent.on).transpose() * tangent.matrix * shift(tangent.by);
            *self.between[place].get_or_insert_with(Matrix6::zeros) += per_unit(&g);
        }
        let mut sum = Vector6::zeros();
        for (c, stage) in self.stages.iter().enumerate().rev() {
            sum += self.wrenches[c + 1];
            self.outer[c] = (sum != Vector6::zeros()).then(|| {
                let w = Wrench(sum);
                let (f, m) = (hat(&w.force()), hat(&w.moment()));
                let mut a = Matrix6::zeros();
                a.fixed_view_mut::<3, 3>(0, 3).copy_from(&f);
                a.fixed_view_mut::<3, 3>(3, 0).copy_from(&f);
                a.fixed_view_mut::<3, 3>(3, 3).copy_from(&m);
                per_unit(&a)
            });
            for i in 0..stage.len {
                let column = jacobian.column(stage.first + i);
                torque[stage.first + i] = column.dot(&sum);
                let factor = self.factors[6 + stage.first + i];
                for k in 0..6 {
                    self.twists[c][(k, i)] = column[k] * unit[k] * factor;
                }
            }
        }
    }

    /// Stiffness of the chain as it lies with its passive joints locked and its springs at rest: the
    /// natural size of a spring at its end. Directions that hardly or never yield are capped.
    pub fn end_spring(&self) -> Matrix6<f64> {
        let mut compliance = Matrix6::zeros();
        for ((stage, s), c) in self.stages.iter().zip(&self.twists).zip(&self.compliance) {
            if stage.len == 1 {
                let column = s.column(0);
                compliance.ger(c[(0, 0)], &column, &column, 1.0);
            } else {
                compliance += s * c * s.transpose();
            }
        }
        let eigen = (0.5 * (compliance + compliance.transpose())).symmetric_eigen();
        let most = eigen.eigenvalues.amax().max(f64::MIN_POSITIVE);
        let v = &eigen.eigenvectors;
        let stiff = eigen.eigenvalues.map(|x| 1.0 / x.max(1e-7 * most));
        v * Matrix6::from_diagonal(&stiff) * v.transpose()
    }

    /// `g` between stages in one form.
    pub fn between(&self, form: Form, stage: usize) -> Option<Matrix6<f64>> {
        let g = self.between[stage]?;
        match form {
            Form::Lagged => None,
            Form::Exact => Some(g),
            Form::Pencil(_) => Some(0.5 * (g + g.transpose())),
        }
    }

    /// What is subtracted on the diagonal block of a stage.
    pub fn held(&self, form: Form, stage: usize) -> Matrix6<f64> {
        let k = self.springs[stage];
        match (form, self.geometric[stage]) {
            (Form::Pencil(mu), Some(change)) => change + (k - change) * mu,
            (Form::Pencil(mu), None) => k * mu,
            _ => k,
        }
    }

    /// Product of the tangent (without any spring at the end) with `x`, and the motion of the tip.
    /// `motions` is scratch.
    pub fn product(
        &self,
        form: Form,
        x: &[f64],
        motions: &mut Vec<Vector6<f64>>,
        out: &mut [f64],
    ) -> Vector6<f64> {
        let (below, above) = form.skew();
        motions.clear();
        let mut t = Vector6::zeros();
        for (stage, s) in self.stages.iter().zip(&self.twists) {
            for i in 0..stage.len {
                t.axpy(x[stage.first + i], &s.column(i), 1.0);
            }
            motions.push(t);
        }
        let tip = t;
        let mut y = Vector6::zeros();
        for (c, stage) in self.stages.iter().enumerate().rev() {
            if let Some(g) = self.between(form, c + 1) {
                y += g * motions[c];
            }
            let s = &self.twists[c];
            let k = self.held(form, c);
            let own = |i: usize| x[stage.first + i];
            let outer = self.outer[c].filter(|_| below != 0.0);
            for i in 0..stage.len {
                let mut row = s.column(i).dot(&y);
                for j in 0..stage.len {
                    row -= k[(i, j)] * own(j);
                }
                out[stage.first + i] = row;
            }
            if let Some(a) = outer {
                // Within the stage a coordinate sees what lies before it, or beyond.
                let mut near = if c == 0 {
                    Vector6::zeros()
                } else {
                    motions[c - 1]
                };
                let mut far = motions[c] - near;
                for i in 0..stage.len {
                    let own_motion = s.column(i) * own(i);
                    far -= own_motion;
                    out[stage.first + i] += s.column(i).dot(&(a * (near * below + far * above)));
                    near += own_motion;
                }
                if above != 0.0 {
                    let moved = motions[c]
                        - if c == 0 {
                            Vector6::zeros()
                        } else {
                            motions[c - 1]
                        };
                    y += a * moved * above;
                }
            }
        }
        tip
    }

    /// `x^T K' x` with the springs at rest.
    pub fn spring_form(&self, x: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (c, stage) in self.stages.iter().enumerate() {
            let k = self.springs[c] - self.geometric[c].unwrap_or_else(Matrix6::zeros);
            for i in 0..stage.len {
                for j in 0..stage.len {
                    sum += x[stage.first + i] * k[(i, j)] * x[stage.first + j];
                }
            }
        }
        sum
    }

    /// `K' x` with the springs at rest.
    pub fn spring_product(&self, x: &[f64], out: &mut [f64]) {
        for (c, stage) in self.stages.iter().enumerate() {
            let k = self.springs[c] - self.geometric[c].unwrap_or_else(Matrix6::zeros);
            for i in 0..stage.len {
                out[stage.first + i] = (0..stage.len).map(|j| k[(i, j)] * x[stage.first + j]).sum();
            }
        }
    }

    /// Nothing depends on how far the chain is loaded.
    pub fn unloaded(&self) -> bool {
        self.outer.iter().all(Option::is_none)
            && self.between.iter().all(Option::is_none)
            && self
                .geometric
                .iter()
                .flatten()
                .all(|m| m.amax() <= RANK_TOLERANCE)
    }
}

/// Which of two paths solves a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Path {
    /// Dense matrices: any chain.
    Dense,
    /// Sweeps along the chain, cost O(n).
    Sweep,
}

/// Rotation part replaced by `rate` times itself: rows of the closure of a finite turn.
pub(crate) fn turned_rows(rate: &Matrix3<f64>) -> Matrix6<f64> {
    let mut d = Matrix6::identity();
    d.fixed_view_mut::<3, 3>(3, 3).copy_from(rate);
    d
}
