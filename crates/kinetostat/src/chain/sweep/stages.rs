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
//! coordinate `i`, the product with a vector `x` is a pass out and a pass back:
//!
//! ```text
//! t_i = t_(i-1) + s_i x_i,    y_(i-1) = y_i + g_(i-1) t_(i-1),    row i: s_i^T (y_i + A_i t_i) - (K x)_i
//! ```
//!
//! with `g` the share of the nodes between two coordinates in `G`. In exponential coordinates
//! (symmetric) `G` is replaced by its symmetric part and `A` by one half below and minus one half
//! above the diagonal. [`crate::chain::sweep::factor`] eliminates coordinates in the same pass.
//!
//! Everything here is scaled: wrenches and coordinates in the units of
//! [`crate::chain::equilibrium::scales_of`].

use nalgebra::{DMatrix, Matrix3, Matrix6, Matrix6xX, Vector3, Vector6};

use crate::linalg::saddle::RANK_TOLERANCE;
use crate::model::chain::{Chain, Element};
use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::spatial::{Wrench, hat, shift_matrix};

/// Chains of fewer coordinates are solved with dense matrices, which are faster there.
pub const SWEEP_FROM: usize = 60;

/// Coordinates that are eliminated together: a spring block or a passive joint.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    pub first: usize,
    /// One to six.
    pub len: usize,
    /// Place of its `len * len` block in lists of such blocks.
    pub block: usize,
}

impl Stage {
    /// Six numbers per coordinate as the columns of a matrix, filled up with zeros.
    pub fn columns(&self, list: &[f64]) -> Matrix6<f64> {
        let own = &list[6 * self.first..6 * (self.first + self.len)];
        if self.len == 6 {
            return Matrix6::from_column_slice(own);
        }
        let mut all = [0.0; 36];
        all[..own.len()].copy_from_slice(own);
        Matrix6::from_column_slice(&all)
    }

    /// Stores the columns of a matrix again.
    pub fn store_columns(&self, matrix: &Matrix6<f64>, list: &mut [f64]) {
        let count = 6 * self.len;
        list[6 * self.first..6 * self.first + count].copy_from_slice(&matrix.as_slice()[..count]);
    }

    /// A block, filled up with zeros.
    pub fn square(&self, list: &[f64]) -> Matrix6<f64> {
        let own = &list[self.block..self.block + self.len * self.len];
        if self.len == 6 {
            return Matrix6::from_column_slice(own);
        }
        let mut matrix = Matrix6::zeros();
        for j in 0..self.len {
            for i in 0..self.len {
                matrix[(i, j)] = own[j * self.len + i];
            }
        }
        matrix
    }

    /// Stores a block again.
    pub fn store_square(&self, matrix: &Matrix6<f64>, list: &mut [f64]) {
        for j in 0..self.len {
            for i in 0..self.len {
                list[self.block + j * self.len + i] = matrix[(i, j)];
            }
        }
    }
}

/// Six numbers of one coordinate.
pub(crate) fn column(list: &[f64], coordinate: usize) -> Vector6<f64> {
    Vector6::from_column_slice(&list[6 * coordinate..6 * coordinate + 6])
}

/// Form of the tangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// `-K`: the report's iteration, loads lagged.
    Lagged,
    /// `H - K`, `H` of dead wrenches as it is.
    Exact,
    /// `-K'`: the springs' material stiffness, no load.
    Material,
    /// `H' - mu K'` in exponential coordinates: `K'` without and `H'` with the geometric stiffness of
    /// the springs. At `mu = 1` the symmetric part of [`Form::Exact`].
    Pencil(f64),
}

impl Form {
    /// Factors of `A` below and above the diagonal.
    pub fn skew(self) -> (f64, f64) {
        match self {
            Self::Lagged | Self::Material => (0.0, 0.0),
            Self::Exact => (1.0, 0.0),
            Self::Pencil(_) => (0.5, -0.5),
        }
    }
}

/// A chain at one state, stage by stage.
#[derive(Clone)]
pub struct Sweep {
    pub stages: Vec<Stage>,
    /// Number of stages nearer the base, per node.
    before: Vec<usize>,
    /// Stage of every spring block.
    stage_of: Vec<usize>,
    scales: Vec<f64>,
    /// `s`, six numbers per coordinate.
    pub twists: Vec<f64>,
    /// `K`, a block per stage.
    springs: Vec<f64>,
    /// `K'`: the same without geometric stiffness.
    material: Vec<f64>,
    /// Inverse of `K` of the posture at rest.
    compliance: Vec<f64>,
    /// Wrench beyond each stage about the tip's place, N and N m.
    outer: Vec<Vector6<f64>>,
    /// Index among `nodes` of the one beyond `c` stages and before the next, counted from 1; 0 for none.
    between: Vec<usize>,
    /// `g`.
    nodes: Vec<Matrix6<f64>>,
    /// True if no load couples the motions of nodes in different places.
    pub serial: bool,
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
    let (mut next, mut missing, mut block) = (0, 0, 0);
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
                    block,
                };
                if let Some(k) = block_of[drive.index] {
                    stage_of[k] = stages.len();
                    stage.len = chain.springs()[k].len();
                    if chain.springs()[k].first != drive.index {
                        return None;
                    }
                }
                missing = stage.len - 1;
                block += stage.len * stage.len;
                stages.push(stage);
            }
        }
    }
    (next == chain.coordinate_count() && missing == 0).then_some((stages, before, stage_of))
}

impl Sweep {
    /// `None` for a chain that is no sequence of stages, or has no springs.
    pub fn new(chain: &Chain, posture: &[f64], scales: &[f64]) -> Option<Self> {
        let (stages, before, stage_of) = stages(chain)?;
        if chain.springs().is_empty() {
            return None;
        }
        let count = stages.len();
        let blocks: usize = stages.iter().map(|s| s.len * s.len).sum();
        let mut compliance = vec![0.0; blocks];
        for (block, &stage) in chain.springs().iter().zip(&stage_of) {
            let k = block.stiffness_at(posture);
            let unit = |i: usize| scales[6 + block.first + i];
            let scaled = DMatrix::from_fn(block.len(), block.len(), |i, j| {
                k[(i, j)] * unit(i) * unit(j)
            });
            let inverse = scaled.cholesky()?.inverse();
            let at = stages[stage].block;
            compliance[at..at + inverse.len()].copy_from_slice(inverse.as_slice());
        }
        Some(Self {
            before,
            stage_of,
            scales: scales.to_vec(),
            twists: vec![0.0; 6 * chain.coordinate_count()],
            springs: vec![0.0; blocks],
            material: vec![0.0; blocks],
            compliance,
            outer: vec![Vector6::zeros(); count],
            between: vec![0; count + 1],
            nodes: Vec::new(),
            serial: true,
            stages,
        })
    }

    /// Number of coordinates.
    pub fn count(&self) -> usize {
        self.stages.last().map_or(0, |s| s.first + s.len)
    }

    /// Springs of one state: `add(block, entry)` gives the entries of block number `block` in N, m,
    /// rad.
    pub fn set_springs(&mut self, mut add: impl FnMut(usize, &mut dyn FnMut(usize, usize, f64))) {
        self.springs.fill(0.0);
        for (k, &stage) in self.stage_of.iter().enumerate() {
            let Stage { first, len, block } = self.stages[stage];
            let unit = &self.scales[6 + first..];
            let own = &mut self.springs[block..block + len * len];
            add(k, &mut |i, j, value| {
                own[j * len + i] += value * unit[i] * unit[j]
            });
        }
        self.material.copy_from_slice(&self.springs);
    }

    /// Geometric stiffness of the springs: first coordinate and matrix, in N, m, rad.
    pub fn set_geometric(&mut self, parts: &[(usize, Matrix6<f64>)]) {
        for (first, geometric) in parts {
            if let Ok(at) = self.stages.binary_search_by_key(first, |s| s.first) {
                let Stage { len, block, .. } = self.stages[at];
                let unit = &self.scales[6 + first..];
                for j in 0..len {
                    for i in 0..len {
                        self.material[block + j * len + i] -= geometric[(i, j)] * unit[i] * unit[j];
                    }
                }
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
        let unit = Vector6::from_column_slice(&self.scales[..6]);
        let per_unit = |m: &Matrix6<f64>| Matrix6::from_fn(|i, j| m[(i, j)] / (unit[i] * unit[j]));
        let tip = kinematics.node_position(self.before.len() - 1);
        self.between.fill(0);
        self.nodes.clear();
        self.outer.fill(Vector6::zeros());
        for (node, wrench) in wrenches {
            let (place, f) = (self.before[*node], wrench.force());
            let arm = kinematics.node_position(*node) - tip;
            if place > 0 {
                // Summed up below.
                let moment = wrench.moment() + arm.cross(&f);
                self.outer[place - 1] += Wrench::new(f, moment).0;
            }
            if f != Vector3::zeros() {
                let mut g = Matrix6::zeros();
                g.fixed_view_mut::<3, 3>(3, 0).copy_from(&-hat(&f));
                g.fixed_view_mut::<3, 3>(3, 3)
                    .copy_from(&(hat(&f) * hat(&arm)));
                self.add_between(place, per_unit(&g));
            }
        }
        self.serial = true;
        for tangent in tangents {
            let place = self.before[tangent.on];
            self.serial &= place == self.before[tangent.by];
            let shift = |node| shift_matrix(&(kinematics.node_position(node) - tip));
            let g = shift(tangent.on).transpose() * tangent.matrix * shift(tangent.by);
            self.add_between(place, per_unit(&g));
        }
        let mut sum = Vector6::zeros();
        for (stage, outer) in self.stages.iter().zip(&mut self.outer).rev() {
            sum += *outer;
            *outer = sum;
            for own in stage.first..stage.first + stage.len {
                let column = jacobian.column(own);
                torque[own] = column.dot(&sum);
                let factor = self.scales[6 + own];
                for k in 0..6 {
                    self.twists[6 * own + k] = column[k] * unit[k] * factor;
                }
            }
        }
    }

    fn add_between(&mut self, place: usize, g: Matrix6<f64>) {
        if self.between[place] == 0 {
            self.nodes.push(Matrix6::zeros());
            self.between[place] = self.nodes.len();
        }
        self.nodes[self.between[place] - 1] += g;
    }

    /// `A` of the loads beyond a stage, `None` where there are none.
    pub fn outer(&self, stage: usize) -> Option<Matrix6<f64>> {
        let sum = self.outer[stage];
        if sum == Vector6::zeros() {
            return None;
        }
        let (along, about) = (self.scales[0], self.scales[3]);
        let f = hat(&Wrench(sum).force()) / (along * about);
        let m = hat(&Wrench(sum).moment()) / (about * about);
        let mut a = Matrix6::zeros();
        a.fixed_view_mut::<3, 3>(0, 3).copy_from(&f);
        a.fixed_view_mut::<3, 3>(3, 0).copy_from(&f);
        a.fixed_view_mut::<3, 3>(3, 3).copy_from(&m);
        Some(a)
    }

    /// Stiffness of the chain as it lies with its passive joints locked and its springs at rest: the
    /// natural size of a spring at its end. Directions that hardly or never yield are capped: they
    /// count as yielding by the share `least` of the most.
    /// `None` where a number is not finite.
    pub fn end_spring(&self, least: f64) -> Option<Matrix6<f64>> {
        let mut compliance = Matrix6::zeros();
        for stage in &self.stages {
            if stage.len == 1 {
                let s = column(&self.twists, stage.first);
                compliance.ger(self.compliance[stage.block], &s, &s, 1.0);
            } else {
                let s = stage.columns(&self.twists);
                let c = stage.square(&self.compliance);
                compliance += s * c * s.transpose();
            }
        }
        if !compliance.iter().all(|x| x.is_finite()) {
            return None;
        }
        let eigen = (0.5 * (compliance + compliance.transpose())).symmetric_eigen();
        let most = eigen.eigenvalues.amax().max(f64::MIN_POSITIVE);
        let v = &eigen.eigenvectors;
        let stiff = eigen.eigenvalues.map(|x| 1.0 / x.max(least * most));
        Some(v * Matrix6::from_diagonal(&stiff) * v.transpose())
    }

    /// `g` between stages in one form.
    pub fn between(&self, form: Form, stage: usize) -> Option<Matrix6<f64>> {
        let g = self.nodes.get(self.between[stage].wrapping_sub(1))?;
        match form {
            Form::Lagged | Form::Material => None,
            Form::Exact => Some(*g),
            Form::Pencil(_) => Some(0.5 * (g + g.transpose())),
        }
    }

    /// Matrix subtracted on the diagonal block of a stage.
    pub fn held(&self, form: Form, stage: &Stage) -> Matrix6<f64> {
        match form {
            Form::Lagged | Form::Exact => stage.square(&self.springs),
            Form::Material => stage.square(&self.material),
            Form::Pencil(mu) => {
                let material = stage.square(&self.material);
                stage.square(&self.springs) - material + material * mu
            }
        }
    }

    /// Number subtracted for a stage of one coordinate.
    pub fn held_scalar(&self, form: Form, stage: &Stage) -> f64 {
        let (now, material) = (self.springs[stage.block], self.material[stage.block]);
        match form {
            Form::Lagged | Form::Exact => now,
            Form::Material => material,
            Form::Pencil(mu) => now - material + material * mu,
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
        motions.push(Vector6::zeros());
        let mut t = Vector6::zeros();
        for stage in &self.stages {
            for own in stage.first..stage.first + stage.len {
                t.axpy(x[own], &column(&self.twists, own), 1.0);
            }
            motions.push(t);
        }
        let mut y = Vector6::zeros();
        for (c, stage) in self.stages.iter().enumerate().rev() {
            if let Some(g) = self.between(form, c + 1) {
                y += g * motions[c + 1];
            }
            let k = self.held(form, stage);
            for i in 0..stage.len {
                let mut row = column(&self.twists, stage.first + i).dot(&y);
                for j in 0..stage.len {
                    row -= k[(i, j)] * x[stage.first + j];
                }
                out[stage.first + i] = row;
            }
            if below == 0.0 {
                continue;
            }
            if let Some(a) = self.outer(c) {
                // A coordinate within the stage sees what lies before it, or beyond.
                let (mut near, moved) = (motions[c], motions[c + 1] - motions[c]);
                let mut far = moved;
                for own in stage.first..stage.first + stage.len {
                    let s = column(&self.twists, own);
                    let motion = s * x[own];
                    far -= motion;
                    out[own] += s.dot(&(a * (near * below + far * above)));
                    near += motion;
                }
                if above != 0.0 {
                    y += a * moved * above;
                }
            }
        }
        t
    }

    /// `J T`: the (scaled) Jacobian of the tip in coordinates in which every block of the springs' own
    /// stiffness is the unit matrix, as far as they are positive definite.
    pub fn by_spring_roots(&self, jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        let mut turned = jacobian.clone();
        for stage in &self.stages {
            let own = DMatrix::from_column_slice(
                stage.len,
                stage.len,
                &self.material[stage.block..stage.block + stage.len * stage.len],
            );
            let Some(root) = own.cholesky() else {
                continue; // a passive joint
            };
            // J L^-T, from L (J L^-T)^T = J^T.
            let mut moved = jacobian.columns(stage.first, stage.len).transpose();
            if root.l_dirty().solve_lower_triangular_mut(&mut moved) {
                let mut columns = turned.columns_mut(stage.first, stage.len);
                columns.copy_from(&moved.transpose());
            }
        }
        turned
    }

    /// `K' x` with the springs' material stiffness.
    pub fn spring_product(&self, x: &[f64], out: &mut [f64]) {
        for stage in &self.stages {
            let len = stage.len;
            for i in 0..len {
                out[stage.first + i] = (0..len)
                    .map(|j| self.material[stage.block + j * len + i] * x[stage.first + j])
                    .sum();
            }
        }
    }

    /// True if nothing depends on how far the chain is loaded.
    pub fn unloaded(&self) -> bool {
        let springs = self.springs.iter().zip(&self.material);
        self.nodes.is_empty()
            && self.outer.iter().all(|w| *w == Vector6::zeros())
            && springs
                .into_iter()
                .all(|(now, material)| (now - material).abs() <= RANK_TOLERANCE)
    }
}

/// Method that solves the linear systems of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChainMethod {
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
