//! Solution of one place: from the kernels for many, or from the general engine for one.

use kinetostat::batch::{BatchEquilibrium, BatchStiffness};
use kinetostat::chain::{CartesianCompliance, FoundBy};
use kinetostat::machine::MechanismState;
use kinetostat::number::larger;
use kinetostat::spatial::pose_residual;
use kinetostat::{Error, Mechanism, Pose, Posture, Twist, Wrench};
use kinetostat_dynamics::{Held, lowest_modes_of_state};
use nalgebra::{Matrix3, Matrix6, SymmetricEigen, Vector3};

use crate::map::place::PlaceState;

/// Solution of a place, in SI units, base axes; NaN where it is not known. It is kept and written over from place to
/// place.
#[derive(Clone, Debug)]
pub(crate) struct Solved {
    pub state: PlaceState,
    /// Numbers are known, though an actuator may be outside its limits.
    pub found: bool,
    pub found_by: FoundBy,
    /// Natural length, m.
    pub length: f64,
    pub compliance: Matrix6<f64>,
    /// Motions that nothing resists.
    pub free: Vec<Twist>,
    pub softest: f64,
    pub displacement: Twist,
    /// Displacement without the load.
    pub unloaded: Twist,
    pub commands: Vec<f64>,
    pub efforts: Vec<f64>,
    pub effort_share: f64,
    pub share_to_buckling: f64,
    pub stable: f64,
    pub singularity_distance: f64,
    /// The lowest natural frequencies, Hz, signed, rising.
    pub frequencies: [f64; LOWEST],
}

/// Requested results of a single posture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'a> {
    /// Ratings of the actuators, as far as they are stated.
    pub ratings: &'a [Option<f64>],
    /// Number of natural frequencies.
    pub modes: usize,
    /// True if the tool's place without the load is requested.
    pub unloaded: bool,
}

/// Relative pivot below which the rank of a stiffness has to be decided.
const REGULAR: f64 = 1e-9;

impl Solved {
    pub fn new(mechanism: &Mechanism) -> Self {
        let actuators = mechanism.actuator_count();
        Self {
            state: PlaceState::Unanswered,
            found: false,
            found_by: FoundBy::Directly,
            length: mechanism.natural_length(),
            compliance: Matrix6::zeros(),
            free: Vec::new(),
            softest: f64::NAN,
            displacement: Twist::zero(),
            unloaded: Twist::zero(),
            commands: vec![f64::NAN; actuators],
            efforts: vec![f64::NAN; actuators],
            effort_share: f64::NAN,
            share_to_buckling: f64::NAN,
            stable: f64::NAN,
            singularity_distance: f64::NAN,
            frequencies: [f64::NAN; LOWEST],
        }
    }

    /// Resets the solution.
    pub fn forget(&mut self) {
        self.state = PlaceState::Unanswered;
        self.found = false;
        self.found_by = FoundBy::Directly;
        self.compliance.fill(f64::NAN);
        self.free.clear();
        self.displacement.0.fill(f64::NAN);
        self.unloaded.0.fill(f64::NAN);
        self.commands.fill(f64::NAN);
        self.efforts.fill(f64::NAN);
        self.softest = f64::NAN;
        self.effort_share = f64::NAN;
        self.share_to_buckling = f64::NAN;
        self.stable = f64::NAN;
        self.singularity_distance = f64::NAN;
        self.frequencies = [f64::NAN; LOWEST];
    }

    /// Stiffness along or about an axis, N/m or N m/rad: infinite where nothing moves, zero where a free motion does.
    pub fn along(&self, k: usize) -> f64 {
        // The longest part of a free motion is 1 m.
        let arm = if k < 3 { 1.0 } else { self.length };
        if self.free.iter().any(|t| t.0[k].abs() * arm > 1e-9) {
            return 0.0;
        }
        let first = if k < 3 { 0 } else { 3 };
        let block = |first: usize| self.compliance.fixed_view::<3, 3>(first, first).amax();
        let most = match first {
            0 => block(0),
            _ => larger(block(3), block(0) / (self.length * self.length)),
        };
        let own = self.compliance[(k, k)];
        if own.abs() <= NO_MOTION * most {
            f64::INFINITY
        } else {
            1.0 / own
        }
    }

    /// Stiffness against a force in the softest direction.
    pub fn softest(&self) -> f64 {
        self.softest
    }

    /// Stiffness against a moment about the softest axis.
    pub fn softest_rotation(&self) -> f64 {
        match self
            .free
            .iter()
            .any(|t| t.angular().norm() * self.length > 1e-9)
        {
            true => 0.0,
            false => 1.0 / rotational(&self.compliance, self.length)[0],
        }
    }

    /// Compliances along the principal directions, falling, and these as columns; along a free direction it is infinite.
    pub fn principal(&self) -> (Vector3<f64>, Matrix3<f64>) {
        let moving = self.free.iter().map(Twist::linear);
        let mut axes: Vec<Vector3<f64>> = Vec::new();
        for mut motion in moving.filter(|v| v.norm() > 1e-9) {
            motion.normalize_mut();
            axes.iter().for_each(|a| motion -= a * a.dot(&motion));
            if motion.norm() > 1e-6 {
                axes.push(motion.normalize());
            }
        }
        if axes.is_empty() {
            return principal(&self.compliance);
        }
        // Free directions beside which springs are nothing.
        let most = self.compliance.fixed_view::<3, 3>(0, 0).amax();
        let most = if most > 0.0 { most } else { 1.0 };
        let mut block = self.compliance;
        let outside = axes
            .iter()
            .fold(Matrix3::identity(), |p, a| p - a * a.transpose());
        let held = outside * block.fixed_view::<3, 3>(0, 0) * outside;
        let free: Matrix3<f64> = axes.iter().map(|a| a * a.transpose() * (1e3 * most)).sum();
        block.fixed_view_mut::<3, 3>(0, 0).copy_from(&(held + free));
        let (mut values, vectors) = principal(&block);
        values.rows_mut(0, axes.len()).fill(f64::INFINITY);
        (values, vectors)
    }

    fn commanded(&mut self, commands: impl Iterator<Item = f64>) {
        for (own, command) in self.commands.iter_mut().zip(commands) {
            *own = command;
        }
    }

    fn loads(&mut self, efforts: impl Iterator<Item = f64>, ratings: &[Option<f64>]) {
        for (own, effort) in self.efforts.iter_mut().zip(efforts) {
            *own = effort;
        }
        let stated = self.efforts.iter().zip(ratings);
        let shares = stated.filter_map(|(effort, rating)| Some(effort.abs() / (*rating)?));
        self.effort_share = shares.reduce(larger).unwrap_or(f64::NAN);
    }

    fn within(&mut self, outside: bool) {
        self.found = true;
        if outside {
            self.state = PlaceState::OutsideLimits;
        }
    }

    /// A posture of many, unloaded; false where the stiffness may be singular: its directions decide.
    pub fn take_stiffness(
        &mut self,
        mechanism: &Mechanism,
        found: &BatchStiffness,
        i: usize,
    ) -> bool {
        self.commanded(found.commands.row(i));
        let matrix = Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c));
        if !self.take_regular(&matrix) {
            return false;
        }
        self.state = PlaceState::Regular;
        self.softest = 1.0 / larger(principal_compliance(&self.compliance), 0.0);
        self.within(found.outside_limits(mechanism, i));
        true
    }

    /// The inverse of a symmetric stiffness that is clearly positive.
    fn take_regular(&mut self, matrix: &Matrix6<f64>) -> bool {
        // Rotations at the natural length.
        let unit = |k: usize| if k < 3 { 1.0 } else { self.length };
        let scaled = Matrix6::from_fn(|r, c| matrix[(r, c)] / (unit(r) * unit(c)));
        let Some(factors) = scaled.cholesky() else {
            return false;
        };
        let least = factors.l_dirty().diagonal().min();
        if least * least < REGULAR * scaled.diagonal().max() {
            return false;
        }
        let scaled = factors.inverse();
        self.compliance = Matrix6::from_fn(|r, c| scaled[(r, c)] / (unit(r) * unit(c)));
        true
    }

    /// An equilibrium of many, with its stiffness if `stiffness`; false where its directions decide.
    pub fn take_equilibrium(
        &mut self,
        mechanism: &Mechanism,
        ratings: &[Option<f64>],
        found: &BatchEquilibrium,
        i: usize,
        pose: &Pose,
    ) -> bool {
        self.commanded(found.commands.row(i));
        self.loads(found.actuator_forces.row(i), ratings);
        self.displacement = pose_residual(&found.tool_pose(i), pose);
        self.found_by = found.found_by[i];
        self.state = PlaceState::Regular;
        if let Some(stability) = found.stability(i) {
            self.stable = f64::from(u8::from(stability.stable));
            self.share_to_buckling = stability.share_to_buckling.unwrap_or(f64::NAN);
            if !stability.stable {
                self.state = PlaceState::Unstable;
            }
            self.softest = stability.stiffness_against_force;
            let matrix = Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c));
            // A direction is free (zero) or rigid (NaN), which the general engine names.
            let rigid = matrix.iter().any(|x| x.is_nan());
            let inverse = match rigid || stability.stiffness_against_force == 0.0 {
                true => None,
                false => matrix.try_inverse(),
            };
            match inverse {
                Some(inverse) => self.compliance = inverse,
                None => return false,
            }
        }
        self.within(found.outside_limits(mechanism, i));
        true
    }

    /// A posture by itself, unloaded or under a load.
    pub fn take_posture(
        &mut self,
        posture: Result<Posture, Error>,
        load: Option<&Wrench>,
        wanted: &Wanted<'_>,
    ) -> Option<Posture> {
        let Ok(posture) = posture else {
            self.state = PlaceState::Unreachable;
            return None;
        };
        let outside = posture.within_limits().is_err();
        if outside {
            self.state = PlaceState::OutsideLimits;
        }
        self.commanded(posture.commands().into_iter());
        let known = match load {
            None => self.take_unloaded(&posture),
            Some(load) => self.take_loaded(&posture, load, wanted),
        };
        match known {
            Some(()) => self.within(outside),
            None if outside => self.state = PlaceState::OutsideLimits,
            None => self.state = PlaceState::Unanswered,
        }
        Some(posture)
    }

    fn take_unloaded(&mut self, posture: &Posture) -> Option<()> {
        let stiffness = posture.stiffness().ok()?;
        self.softest = stiffness.stiffness_against_force();
        self.take_compliance(stiffness.compliance());
        self.state = match self.free.is_empty() {
            true => PlaceState::Regular,
            false => PlaceState::Singular,
        };
        Some(())
    }

    fn take_loaded(&mut self, posture: &Posture, load: &Wrench, wanted: &Wanted<'_>) -> Option<()> {
        let e = posture.deflected_by(load).ok()?;
        if wanted.unloaded {
            self.unloaded = posture.deflected_by(&Wrench::zero()).ok()?.displacement;
        }
        if wanted.modes > 0 {
            self.frequencies = lowest(posture, &e.state, &e.wrench, wanted.modes);
        }
        self.softest = e.stiffness_against_force();
        self.take_compliance(e.compliance());
        self.displacement = e.displacement;
        self.found_by = e.found_by;
        self.loads(e.actuator_forces().into_iter(), wanted.ratings);
        self.stable = f64::from(u8::from(e.stable()));
        self.share_to_buckling = e.share_to_buckling().unwrap_or(f64::NAN);
        self.state = if e.platform.free > 0 {
            PlaceState::Singular
        } else if e.stable() {
            PlaceState::Regular
        } else {
            PlaceState::Unstable
        };
        Some(())
    }

    fn take_compliance(&mut self, compliance: CartesianCompliance) {
        self.compliance = compliance.springs;
        self.free = compliance.free;
    }
}

fn principal_compliance(compliance: &Matrix6<f64>) -> f64 {
    let forces: Matrix3<f64> = compliance.fixed_view::<3, 3>(0, 0).into();
    forces.symmetric_eigenvalues().max()
}

/// Number of natural frequencies in a map.
pub(crate) const LOWEST: usize = 6;

/// About an equilibrium, the tool free, Hz: rising, negative where the machine goes away, zero where it is free. NaN
/// beyond the `count` that are asked for, and beyond the number of modes that there are.
pub(crate) fn lowest(
    posture: &Posture,
    state: &MechanismState,
    load: &Wrench,
    count: usize,
) -> [f64; LOWEST] {
    let mut own = [f64::NAN; LOWEST];
    if let Ok(modes) = lowest_modes_of_state(posture, state, load, &Held::nothing(), count) {
        for (own, hz) in own.iter_mut().zip(modes.frequencies_hz()).take(count) {
            *own = hz;
        }
    }
    own
}

/// Compliances below this share of the largest are rounding.
pub(crate) const NO_MOTION: f64 = 1e-12;

/// Eigenvalues of the symmetric part of a block, falling; below the rounding of the largest they are zero.
fn eigen(block: &Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    // Along the push acts the symmetric part alone; loads without a potential leave another.
    let eigen = SymmetricEigen::new(0.5 * (block + block.transpose()));
    let most = eigen.eigenvalues.amax();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let values = Vector3::from_fn(|k, _| {
        let own = eigen.eigenvalues[order[k]];
        if own.abs() <= NO_MOTION * most {
            0.0
        } else {
            own
        }
    });
    let vectors = Matrix3::from_fn(|i, k| eigen.eigenvectors[(i, order[k])]);
    (values, vectors)
}

/// Compliances along the principal directions of forces, falling, and these as columns, the largest part positive.
pub(crate) fn principal(compliance: &Matrix6<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let (values, mut vectors) = eigen(&compliance.fixed_view::<3, 3>(0, 0).into_owned());
    for mut column in vectors.column_iter_mut() {
        if column[column.iamax()] < 0.0 {
            column.neg_mut();
        }
    }
    (values, vectors)
}

/// Principal rotational compliances, without directions; values within the rounding of those of forces are zero.
pub(crate) fn rotational(compliance: &Matrix6<f64>, length: f64) -> Vector3<f64> {
    let nothing = NO_MOTION * compliance.fixed_view::<3, 3>(0, 0).amax() / (length * length);
    let (values, _) = eigen(&compliance.fixed_view::<3, 3>(3, 3).into_owned());
    values.map(|c| if c.abs() <= nothing { 0.0 } else { c })
}
