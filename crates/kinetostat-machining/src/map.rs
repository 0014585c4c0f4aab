//! Stiffness on a grid of tool positions, and under a load deflection and stability too: many places
//! at once, in constant memory.

use kinetostat::batch::{Batch, BatchEquilibrium, BatchStiffness};
use kinetostat::chain::FoundBy;
use kinetostat::{Error, Mechanism, Pose, Posture, Twist, Wrench, spatial::pose_residual};
use nalgebra::{Matrix3, Matrix6, UnitQuaternion, Vector3};
use rayon::prelude::*;

use crate::near::natural_length;
use crate::postures::neighbour::NEAR;
use crate::postures::orientation::Orientation;
use crate::result::solving::one_by_one_because;
use crate::task::RunError;
use crate::watch::Watch;

/// Evenly spaced positions of the tool, base axes, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// First position along x, y and z.
    pub from_mm: [f64; 3],
    /// Last position along x, y and z; that of an axis with one place does not count.
    pub to_mm: [f64; 3],
    /// Places along x, y and z, at least one each.
    pub counts: [usize; 3],
}

impl Grid {
    /// Number of places.
    #[must_use]
    pub fn len(&self) -> usize {
        let [x, y, z] = self.counts;
        x.saturating_mul(y).saturating_mul(z)
    }

    /// True without places.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of a place along each axis: x runs fastest, z slowest.
    #[must_use]
    pub fn index(&self, place: usize) -> [usize; 3] {
        let [x, y, _] = self.counts.map(|n| n.max(1));
        [place % x, place / x % y, place / x / y]
    }

    /// Position along one axis (0 to 2), mm.
    #[must_use]
    pub fn position_mm(&self, axis: usize, index: usize) -> f64 {
        let (from, to, count) = (self.from_mm[axis], self.to_mm[axis], self.counts[axis]);
        match index {
            0 => from,
            // Exactly what was requested.
            _ if index + 1 == count => to,
            _ => from + (to - from) * index as f64 / (count - 1) as f64,
        }
    }
}

/// The query.
#[derive(Clone, Debug)]
pub struct MapTask<'a> {
    /// Machine with its tool.
    pub mechanism: &'a Mechanism,
    /// Where the tool's reference point is put.
    pub grid: Grid,
    /// Orientation of the tool everywhere, base from tool.
    pub orientation: UnitQuaternion<f64>,
    /// The machine turns its tool as it moves: at every place it takes the orientation nearest to
    /// `orientation` that it can have there, instead of that one.
    pub orientation_follows: bool,
    /// Dead wrench on the tool, base axes, about its reference point. With it, figures are those of
    /// the machine as it is under this load, its own weight, preloads and deviations; without it, of
    /// the unloaded machine as drawn.
    pub load: Option<Wrench>,
}

impl MapTask<'_> {
    /// Why every place is solved by itself; `None` where kernels take many at once.
    #[must_use]
    pub fn one_by_one_because(&self) -> Option<String> {
        let loaded = self.load.is_some();
        one_by_one_because(self.mechanism, self.orientation_follows, loaded)
    }
}

/// Whether a place has an answer, and of which kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceState {
    /// Every direction is held, and under a load the equilibrium is stable.
    Regular,
    /// A direction has no stiffness.
    Singular,
    /// The equilibrium under the load is not stable.
    Unstable,
    /// An actuator would be outside its limits. There are no figures.
    OutsideLimits,
    /// The machine cannot put its tool there. There are no figures.
    Unreachable,
    /// No equilibrium under the load was found. There are no figures.
    Unanswered,
}

impl PlaceState {
    /// All states, in the order of their declaration.
    pub const ALL: [Self; 6] = [
        Self::Regular,
        Self::Singular,
        Self::Unstable,
        Self::OutsideLimits,
        Self::Unreachable,
        Self::Unanswered,
    ];

    /// False where an actuator would be outside its limits, the tool cannot be put there or no equilibrium was found.
    #[must_use]
    pub fn has_figures(self) -> bool {
        matches!(self, Self::Regular | Self::Singular | Self::Unstable)
    }
}

/// One place of the map. Numbers that do not exist are NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPlace {
    /// Number along x, y and z.
    pub index: [usize; 3],
    /// Position of the tool's reference point, base axes, mm.
    pub position_mm: [f64; 3],
    /// Whether there is an answer.
    pub state: PlaceState,
    /// Force that moves the tool's tip by 1 mm in its softest direction while the tool may turn,
    /// N/mm: zero if a direction is free, negative if the tool runs away.
    pub smallest_stiffness_n_per_mm: f64,
    /// The same for a force along x, y and z (base axes), by the motion along it, N/mm.
    pub stiffness_n_per_mm: [f64; 3],
    /// How far the unloaded tool has turned from the orientation that was requested, deg: zero unless
    /// the orientation follows.
    pub tool_turn_deg: f64,
    /// From where the tool is commanded to where it goes under the load, base axes, mm.
    pub displacement_mm: [f64; 3],
    /// Rotation vector of the tool under the load, base axes, deg.
    pub rotation_deg: [f64; 3],
    /// How the equilibrium under the load was found.
    pub found_by: FoundBy,
}

/// Below this relative pivot the rank of a stiffness has to be decided.
const REGULAR: f64 = 1e-9;
/// Places that one thread takes at a time.
const BLOCK: usize = 256;
/// Blocks between two looks at the watch; what is in memory at a time.
const BLOCKS: usize = 64;

/// Solves all places of a grid in their order. Each block of places is turned into something by
/// `block`, on any thread; `put` takes these one after the other. No more than a fixed number of
/// places is kept, whatever the size of the grid, and answers do not depend on the number of threads.
///
/// # Errors
/// [`RunError::Cancelled`], and what `put` returns.
pub fn map<R: Send, E: From<RunError>>(
    task: &MapTask<'_>,
    watch: &dyn Watch,
    block: impl Fn(&[MapPlace]) -> R + Sync,
    mut put: impl FnMut(R) -> Result<(), E>,
) -> Result<(), E> {
    let batch = Batch::new(task.mechanism);
    let total = task.grid.len();
    watch.stage("map", total);
    for first in (0..total).step_by(BLOCK * BLOCKS) {
        if watch.cancelled() {
            return Err(RunError::Cancelled.into());
        }
        let end = total.min(first + BLOCK * BLOCKS);
        let starts: Vec<usize> = (first..end).step_by(BLOCK).collect();
        let done: Vec<R> = starts
            .into_par_iter()
            .map(|start| block(&solved(task, &batch, start..end.min(start + BLOCK))))
            .collect();
        done.into_iter().try_for_each(&mut put)?;
        watch.advance(end);
    }
    Ok(())
}

fn solved(task: &MapTask<'_>, batch: &Batch, places: std::ops::Range<usize>) -> Vec<MapPlace> {
    let (mut out, mut poses) = (Vec::new(), Vec::new());
    for place in places {
        let index = task.grid.index(place);
        let position_mm = [0, 1, 2].map(|axis| task.grid.position_mm(axis, index[axis]));
        out.push(MapPlace {
            index,
            position_mm,
            state: PlaceState::Unanswered,
            smallest_stiffness_n_per_mm: f64::NAN,
            stiffness_n_per_mm: [f64::NAN; 3],
            tool_turn_deg: f64::NAN,
            displacement_mm: [f64::NAN; 3],
            rotation_deg: [f64::NAN; 3],
            found_by: FoundBy::Directly,
        });
        let position = Vector3::from(position_mm) * 1e-3;
        poses.push(Pose::from_parts(position.into(), task.orientation));
    }
    if task.orientation_follows {
        following(task, &poses, &mut out);
        return out;
    }
    match &task.load {
        None => unloaded(task, batch, &poses, &mut out),
        Some(wrench) => loaded(task, batch, wrench, &poses, &mut out),
    }
    for place in out.iter_mut().filter(|p| p.state.has_figures()) {
        place.tool_turn_deg = 0.0;
    }
    out
}

/// Places by their positions only, one after the other: each followed from the one before where that
/// is near.
fn following(task: &MapTask<'_>, poses: &[Pose], out: &mut [MapPlace]) {
    let requested = Orientation {
        follows: true,
        load_turns: false,
    };
    let near = NEAR * task.mechanism.size();
    let mut last: Option<Posture> = None;
    for (place, pose) in out.iter_mut().zip(poses) {
        let close = last.as_ref().filter(|posture| {
            let at = posture.target().translation.vector;
            (at - pose.translation.vector).norm() < near
        });
        let posture = requested.posture(task.mechanism, pose, close);
        let Some(posture) = place.within_limits(posture) else {
            last = None;
            continue;
        };
        match &task.load {
            None => place.take_stiffness(&posture),
            Some(wrench) => place.take_loaded(&posture, wrench),
        }
        if place.state.has_figures() {
            let turned = posture.target().rotation.angle_to(&pose.rotation);
            place.tool_turn_deg = turned.to_degrees();
        }
        last = Some(posture);
    }
}

fn unloaded(task: &MapTask<'_>, batch: &Batch, poses: &[Pose], out: &mut [MapPlace]) {
    let found = batch.stiffness(poses);
    let length = natural_length(task.mechanism);
    for (i, place) in out.iter_mut().enumerate() {
        if !found.status[i].is_solved() {
            place.state = PlaceState::Unreachable;
        } else if !place.take_regular(task.mechanism, &found, i, length) {
            place.take_by_directions(task.mechanism, &poses[i]);
        }
    }
}

fn loaded(
    task: &MapTask<'_>,
    batch: &Batch,
    wrench: &Wrench,
    poses: &[Pose],
    out: &mut [MapPlace],
) {
    let wrenches = vec![*wrench; poses.len()];
    let found = batch
        .equilibrium(poses, &wrenches, kinetostat::batch::Details::Stability)
        .ok();
    for (i, place) in out.iter_mut().enumerate() {
        let taken = found
            .as_ref()
            .is_some_and(|found| place.take_equilibrium(task.mechanism, found, i, &poses[i]));
        if !taken {
            place.take_equilibrium_by_directions(task.mechanism, &poses[i], wrench);
        }
    }
}

impl MapPlace {
    /// The machine commanded for the place; none if it cannot be, and the state says why.
    fn posture(&mut self, mechanism: &Mechanism, pose: &Pose) -> Option<Posture> {
        self.within_limits(mechanism.posture(pose))
    }

    fn within_limits(&mut self, posture: Result<Posture, Error>) -> Option<Posture> {
        match posture.and_then(|p| p.within_limits().map(|()| p)) {
            Ok(posture) => return Some(posture),
            Err(Error::OutsideLimits { .. }) => self.state = PlaceState::OutsideLimits,
            Err(_) => self.state = PlaceState::Unreachable,
        }
        None
    }

    /// Takes a stiffness of many; false where it may be singular: its directions decide.
    fn take_regular(
        &mut self,
        mechanism: &Mechanism,
        found: &BatchStiffness,
        i: usize,
        length: f64,
    ) -> bool {
        if found.outside_limits(mechanism, i) {
            self.state = PlaceState::OutsideLimits;
            return true;
        }
        // Rotations at the natural length.
        let unit = |k: usize| if k < 3 { 1.0 } else { length };
        let scaled =
            Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c) / (unit(r) * unit(c)));
        let Some(factors) = scaled.cholesky() else {
            return false;
        };
        let least = factors.l_dirty().diagonal().min();
        if least * least < REGULAR * scaled.diagonal().max() {
            return false;
        }
        let scaled = factors.inverse();
        let compliance = Matrix6::from_fn(|r, c| scaled[(r, c)] / (unit(r) * unit(c)));
        self.state = PlaceState::Regular;
        self.stiffness_n_per_mm = along(&compliance);
        self.smallest_stiffness_n_per_mm = softest(&compliance);
        true
    }

    /// Takes an equilibrium of many; false where its directions decide.
    fn take_equilibrium(
        &mut self,
        mechanism: &Mechanism,
        found: &BatchEquilibrium,
        i: usize,
        pose: &Pose,
    ) -> bool {
        let Some(stability) = found.stability(i) else {
            return false;
        };
        if found.outside_limits(mechanism, i) {
            self.state = PlaceState::OutsideLimits;
            return true;
        }
        let matrix = Matrix6::from_fn(|r, c| found.stiffness.get(i, 6 * r + c));
        // Zero: a direction is free, which the general engine names.
        let compliance = match stability.stiffness_against_force == 0.0 {
            true => None,
            false => matrix.try_inverse(),
        };
        let Some(compliance) = compliance else {
            return false;
        };
        self.state = match stability.stable {
            true => PlaceState::Regular,
            false => PlaceState::Unstable,
        };
        self.stiffness_n_per_mm = along(&compliance);
        self.smallest_stiffness_n_per_mm = 1e-3 * stability.stiffness_against_force;
        self.found_by = found.found_by[i];
        self.moved(&pose_residual(&found.tool_pose(i), pose));
        true
    }

    fn take_equilibrium_by_directions(
        &mut self,
        mechanism: &Mechanism,
        pose: &Pose,
        wrench: &Wrench,
    ) {
        if let Some(posture) = self.posture(mechanism, pose) {
            self.take_loaded(&posture, wrench);
        }
    }

    fn take_loaded(&mut self, posture: &Posture, wrench: &Wrench) {
        let Ok(e) = posture.deflected_by(wrench) else {
            self.state = PlaceState::Unanswered;
            return;
        };
        let compliance = e.compliance();
        self.stiffness_n_per_mm = along(&compliance.springs);
        self.smallest_stiffness_n_per_mm = 1e-3 * e.stiffness_against_force();
        self.moved(&e.displacement);
        self.found_by = e.found_by;
        self.state = if e.platform.free > 0 {
            self.stiffness_n_per_mm = free(&compliance.free, self.stiffness_n_per_mm);
            PlaceState::Singular
        } else if e.stable() {
            PlaceState::Regular
        } else {
            PlaceState::Unstable
        };
    }

    fn moved(&mut self, displacement: &Twist) {
        self.displacement_mm = (displacement.linear() * 1e3).into();
        self.rotation_deg = displacement.angular().map(f64::to_degrees).into();
    }

    fn take_by_directions(&mut self, mechanism: &Mechanism, pose: &Pose) {
        if let Some(posture) = self.posture(mechanism, pose) {
            self.take_stiffness(&posture);
        }
    }

    fn take_stiffness(&mut self, posture: &Posture) {
        let Ok(stiffness) = posture.stiffness() else {
            self.state = PlaceState::Unanswered;
            return;
        };
        let compliance = stiffness.compliance();
        self.stiffness_n_per_mm = along(&compliance.springs);
        self.smallest_stiffness_n_per_mm = 1e-3 * stiffness.stiffness_against_force();
        self.state = PlaceState::Regular;
        if !compliance.free.is_empty() {
            self.state = PlaceState::Singular;
            self.stiffness_n_per_mm = free(&compliance.free, self.stiffness_n_per_mm);
        }
    }
}

/// Compliances below this share of the largest are rounding.
const NO_MOTION: f64 = 1e-12;

/// Force per motion along each axis of the base, N/mm; infinite where nothing moves.
fn along(compliance: &Matrix6<f64>) -> [f64; 3] {
    let most = compliance.fixed_view::<3, 3>(0, 0).amax();
    [0, 1, 2].map(|k| {
        let own = compliance[(k, k)];
        if own.abs() <= NO_MOTION * most {
            f64::INFINITY
        } else {
            1e-3 / own
        }
    })
}

/// The same where there are free motions: a force along an axis on which one of them moves meets
/// nothing.
fn free(motions: &[Twist], held: [f64; 3]) -> [f64; 3] {
    // The longest part of a free motion is 1 m.
    let moves = |k: usize| motions.iter().any(|t| t.0[k].abs() > 1e-9);
    [0, 1, 2].map(|k| if moves(k) { 0.0 } else { held[k] })
}

/// Force per motion in the softest direction of a force, N/mm; the compliance has no negative
/// direction.
fn softest(compliance: &Matrix6<f64>) -> f64 {
    let forces: Matrix3<f64> = compliance.fixed_view::<3, 3>(0, 0).into();
    1e-3 / forces.symmetric_eigenvalues().max().max(0.0)
}
