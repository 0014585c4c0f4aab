//! Equilibria of a machine while a load or a motion of its tool grows, by arc length: around limit
//! points of both, through snap-through and back [R 5.5.3].
//!
//! The tool's motions are those in which it is free, and the driven one. In them the equilibria are
//! a curve of motion and load factor whose tangent is the null vector of `[K, -P]`, `K` the tangent
//! stiffness of the tool in these motions with everything else free, `P` the load that grows.

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use crate::chain::directions::DirectionKind;
use crate::chain::divergence::diverging_motions;
use crate::chain::graded::{levels, root_rows};
use crate::chain::problem::{EndCondition, Prescribed};
use crate::continuation::curve::BranchEnd;
use crate::continuation::parameter::{LoadPattern, Parameter};
use crate::continuation::settings::CurveSettings;
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::linalg::saddle::independent_columns;
use crate::machine::directions::without;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::{Guide, Unknowns};
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::spatial::{Pose, Twist, Wrench, moved, pose_residual, turn_matrix};

/// Steps that may fail besides as many as there may be points.
const LOST_STEPS: usize = 20;

/// Steps of a search between two points.
const BISECTIONS: usize = 50;

/// An equilibrium on a machine's path.
#[derive(Clone, Debug)]
pub struct PathPoint {
    /// Displacement from the nominal target (m, rad) or load factor.
    pub parameter: f64,
    /// Force along the displacement (N, N m; without the dead wrench), or displacement along the
    /// load pattern (J per unit factor).
    pub conjugate: f64,
    /// Load by displacement along the path: of the force by the displacement (N/m, N m/rad), or of
    /// the factor by its conjugate (1/J). Not finite where the displacement stands still.
    pub slope: f64,
    /// Every shape and platform stays where it is while the driven motion is prescribed (under a
    /// growing load: while the tool is held along the load).
    pub held: bool,
    /// The same while the load that is reached acts as a dead load instead.
    pub dead: bool,
    /// Under that load without a potential it does not go away, but may swing with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// The equilibrium.
    pub equilibrium: MechanismEquilibrium,
    /// Motion of the tool (balanced: m and rad times the natural length) and of the load factor per
    /// step along the path.
    tangent: (Vector6<f64>, f64),
    factor: f64,
}

/// What happens at a special point of a machine's path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathSpecialKind {
    /// The load has its extreme: under a dead load the machine snaps.
    LoadLimit,
    /// The displacement has its extreme: under prescribed motion the machine snaps.
    DisplacementLimit,
    /// Stability ends (or comes back) where neither has: another branch crosses.
    Crossing,
}

/// A special point of a machine's path.
#[derive(Clone, Debug)]
pub struct PathSpecial {
    /// What happens.
    pub kind: PathSpecialKind,
    /// Where.
    pub point: PathPoint,
    /// Which verdict ends here, coming from a stable side: while the motion is prescribed, under a
    /// dead load.
    pub ends: [bool; 2],
}

/// Where a machine goes from a limit point.
#[derive(Clone, Debug)]
pub struct PathJump {
    /// The limit point: index into [`MachinePath::specials`].
    pub from: usize,
    /// Under a dead load (at a load limit) or under prescribed motion.
    pub dead_load: bool,
    /// Stable equilibria at the same load (displacement) on the path, nearest first; if it has
    /// none, where the machine was seen to come to rest from the path's ends.
    pub to: Vec<PathPoint>,
}

/// A path of equilibria of a machine.
#[derive(Clone, Debug)]
pub struct MachinePath {
    /// Points in their order, from the low end of the parameter at the start.
    pub points: Vec<PathPoint>,
    /// Index of the point where it started.
    pub start: usize,
    /// In the order of the path.
    pub specials: Vec<PathSpecial>,
    /// Of every limit point at which a stable part ends.
    pub jumps: Vec<PathJump>,
    /// Why it ends at its first and at its last point.
    pub ends: [BranchEnd; 2],
}

/// How the tool keeps its place under dead wrenches.
pub(crate) struct Holding {
    /// It does not go away.
    pub stays: bool,
    /// The symmetric part of its stiffness is positive: it does not swing with growing amplitude either.
    pub definite: bool,
}

impl Holding {
    pub fn may_flutter(&self) -> bool {
        self.stays && !self.definite
    }
}

/// The question in numbers.
pub(crate) struct Path<'p, 'm> {
    pub(crate) posture: &'p Posture<'m>,
    pub(crate) settings: CurveSettings,
    /// Wrench on the tool by the factor.
    pub(crate) pattern: Wrench,
    pub(crate) dead: Wrench,
    /// The displacement is the parameter, not the factor.
    pub(crate) by_motion: bool,
    /// Motions of the tool: those that are free, and the driven one, balanced, orthonormal.
    pub(crate) motions: DMatrix<f64>,
    /// Those that are free, balanced.
    pub(crate) free: DMatrix<f64>,
    /// Directions in which the tool is held, base axes, columns.
    pub(crate) held: DMatrix<f64>,
    /// Where it is held there, from the nominal target.
    pub(crate) held_at: Vector6<f64>,
    pub(crate) length: f64,
}

impl<'m> Posture<'m> {
    /// Equilibria while the parameter runs through `settings.range`, both ways from its value
    /// nearest to zero: the tool moved along a twist (m, rad; from the nominal target), or a wrench
    /// on it times a factor. `end` says in which directions the tool is held (at the nominal
    /// target) and which dead wrench acts in the others; `end.pose` is not used. Limit points of
    /// load and displacement are passed; branches that cross are told, not followed.
    ///
    /// Of the settings `range`, `conjugate_range`, `largest_change`, `smallest_step` and `points`
    /// count.
    ///
    /// # Errors
    /// [`Error::Model`] for loads on nodes, a direction without length, or a driven direction in
    /// which the tool is to be free; those of the first equilibrium.
    pub fn path(
        &self,
        parameter: &Parameter,
        end: &EndCondition,
        settings: &CurveSettings,
    ) -> Result<MachinePath> {
        let path = Path::new(self, parameter, end, settings)?;
        let value = 0.0_f64.clamp(settings.range.0, settings.range.1);
        let start = path.first(value)?;
        let (mut back, first) = path.walk(&start, -1.0);
        let (ahead, last) = path.walk(&start, 1.0);
        back.reverse();
        let at = back.len();
        let mut points = back;
        points.push(start);
        points.extend(ahead);
        let specials = path.specials(&points, at);
        let jumps = path.jumps(&points, &specials);
        Ok(MachinePath {
            points,
            start: at,
            specials,
            jumps,
            ends: [first, last],
        })
    }
}

impl<'p, 'm> Path<'p, 'm> {
    pub(crate) fn new(
        posture: &'p Posture<'m>,
        parameter: &Parameter,
        end: &EndCondition,
        settings: &CurveSettings,
    ) -> Result<Self> {
        let place = || format!("mechanism '{}'", posture.mechanism.name);
        settings.check(&place())?;
        let length = posture.mechanism.scale().length;
        let axes = turn_matrix(&end.axes);
        let of = |wanted: Prescribed| {
            let columns: Vec<_> = (0..6)
                .filter(|&k| end.prescribed[k] == wanted)
                .map(|k| DVector::from_fn(6, |i, _| axes[(i, k)]))
                .collect();
            match columns.is_empty() {
                true => DMatrix::zeros(6, 0),
                false => DMatrix::from_columns(&columns),
            }
        };
        // Axes are of one kind, so that balancing does not change their directions.
        let (free, mut held) = (of(Prescribed::Wrench), of(Prescribed::Pose));
        posture.finite("the wrench", end.wrench.0.iter())?;
        let (pattern, by_motion) = match parameter {
            Parameter::Displacement(twist) => {
                posture.finite("the direction", twist.0.iter())?;
                let size = twist.0.norm_squared();
                let outside = free.transpose() * twist.0;
                if size == 0.0 || outside.amax() > 1e-9 * size.sqrt() {
                    return Err(Error::model(
                        place(),
                        "the tool is driven in a direction without length, or in one in which it is free",
                    ));
                }
                (Wrench(twist.0 / size), true)
            }
            Parameter::Load(pattern) => {
                posture.finite("the load", pattern.end.0.iter())?;
                if !pattern.loads.is_empty() || pattern.end.0.norm() == 0.0 {
                    return Err(Error::model(
                        place(),
                        "the load that grows on a machine is a wrench on its tool, and not zero",
                    ));
                }
                (pattern.end, false)
            }
        };
        let mut motions = free.clone();
        if by_motion {
            let d = pattern.0.normalize();
            let balanced = Vector6::from_fn(|i, _| if i < 3 { d[i] } else { d[i] * length });
            let last = motions.ncols();
            motions = motions.insert_column(last, 0.0);
            motions.set_column(last, &balanced.normalize());
            // What is held is held across the way.
            let along = held.transpose() * d;
            let across = &held * complement(&DMatrix::from_columns(&[along]));
            held = across;
        }
        Ok(Self {
            posture,
            settings: settings.clone(),
            pattern,
            dead: end.wrench,
            by_motion,
            motions,
            free,
            held,
            held_at: Vector6::zeros(),
            length,
        })
    }

    /// For equilibria one by one: held as `end` says at `end.pose`, nothing grows.
    pub(crate) fn held_at(posture: &'p Posture<'m>, end: &EndCondition) -> Result<Self> {
        posture.finite("the pose", end.pose.to_homogeneous().iter())?;
        let nothing = LoadPattern {
            end: Wrench::new(nalgebra::Vector3::x(), nalgebra::Vector3::zeros()),
            loads: Vec::new(),
        };
        let settings = CurveSettings::within(0.0, 1.0);
        let mut path = Self::new(posture, &Parameter::Load(nothing), end, &settings)?;
        let motion = path.motion(&end.pose);
        path.held_at = motion - path.freely(&motion);
        Ok(path)
    }

    /// The same question with the tool driven along one of its free motions (balanced, unit length)
    /// besides: the load along it that this takes is the conjugate. That load is square to all other
    /// motions, rotations at the natural length.
    pub(crate) fn driven(&self, way: &Vector6<f64>, settings: CurveSettings) -> Self {
        let inside = self.free.transpose() * way;
        Self {
            posture: self.posture,
            settings,
            pattern: Wrench(self.balanced(way)),
            dead: self.dead,
            by_motion: true,
            motions: self.free.clone(),
            free: &self.free * complement(&DMatrix::from_columns(&[inside])),
            held: self.held.clone(),
            held_at: self.held_at,
            length: self.length,
        }
    }

    /// Where the load along a driven motion vanishes on the path both ways from an equilibrium (from
    /// the machine held where it is commanded, without one), and the ends of that path.
    pub(crate) fn unloaded(&self, from: Option<&MechanismEquilibrium>) -> [Vec<MechanismState>; 2] {
        let ahead = (self.pattern.0, 0.0);
        let start = match from {
            Some(e) => Ok(self.point(e.clone(), 0.0, &ahead)),
            None => self.first(0.0),
        };
        let (mut crossings, mut ends) = (Vec::new(), Vec::new());
        let Ok(start) = start else {
            return [crossings, ends];
        };
        for sign in [-1.0, 1.0] {
            let (points, _) = self.walk(&start, sign);
            let from_start: Vec<&PathPoint> = [&start].into_iter().chain(&points).collect();
            for pair in from_start.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                if a.factor * b.factor < 0.0 {
                    let near = self.between(a, self.step_between(a, b), |p| p.factor);
                    crossings.extend(near.map(|p| p.equilibrium.state));
                }
            }
            ends.extend(points.last().map(|p| p.equilibrium.state.clone()));
        }
        [crossings, ends]
    }

    /// Where the tool is held, from the nominal target: m, rad.
    pub(crate) fn held_motion(&self) -> Vector6<f64> {
        self.held_at
    }

    /// Free motions of the tool that the machine at rest can make, balanced, orthonormal.
    pub(crate) fn free_motions(&self) -> DMatrix<f64> {
        match self.posture.wrench_at(&self.posture.target) {
            Ok(e) => self.possible(&e, &self.free),
            Err(_) => self.free.clone(),
        }
    }

    /// The part of a motion (m, rad) in which the tool is free.
    pub(crate) fn freely(&self, motion: &Vector6<f64>) -> Vector6<f64> {
        let part = &self.free * (self.free.transpose() * self.balanced(motion));
        Vector6::from_fn(|i, _| part[i] / self.unit(i))
    }

    pub(crate) fn balanced(&self, motion: &Vector6<f64>) -> Vector6<f64> {
        Vector6::from_fn(|i, _| motion[i] * self.unit(i))
    }

    /// Where the machine comes to rest from a state, if Newton finds it from there.
    pub(crate) fn rest(
        &self,
        state: MechanismState,
        wrench: &Wrench,
    ) -> Option<MechanismEquilibrium> {
        let settled = self.settle(state, *wrench, self.guide(None), false);
        settled.ok().map(|(e, _)| e)
    }

    /// One equilibrium twice: the same place of the tool, but for motions that cost nothing, and the
    /// same torques of all springs. Joints that turn for nothing do not count, nor do stresses that
    /// rigid limbs put on each other.
    pub(crate) fn same(&self, a: &MechanismEquilibrium, b: &MechanismEquilibrium) -> bool {
        let torques = |e: &MechanismEquilibrium| -> Vec<f64> {
            let limbs = e.limbs.iter();
            limbs.flat_map(|l| l.spring_torques.clone()).collect()
        };
        let (x, y) = (torques(a), torques(b));
        let most = x
            .iter()
            .chain(&y)
            .fold(0.0_f64, |most, t| most.max(t.abs()));
        let off = self.balanced(&pose_residual(&a.tool, &b.tool).0);
        let costly = self.without(a, &DMatrix::identity(6, 6), DirectionKind::Free);
        (costly.transpose() * off).norm() < 1e-6 * self.length
            && (x.iter().zip(&y)).all(|(x, y)| (x - y).abs() <= 1e-5 * most + 1e-9)
    }

    fn unit(&self, i: usize) -> f64 {
        if i < 3 { 1.0 } else { self.length }
    }

    /// Motion of the tool from its nominal target, base axes.
    pub(crate) fn motion(&self, pose: &Pose) -> Vector6<f64> {
        pose_residual(pose, &self.posture.target).0
    }

    /// Displacement along the pattern.
    fn displacement(&self, motion: &Vector6<f64>) -> f64 {
        self.pattern.0.dot(motion)
    }

    /// Conditions of what is held, and one more on the motion (its hand is the pattern).
    fn guide(&self, more: Option<(&Vector6<f64>, f64)>) -> Guide {
        let mut rows = self.held.transpose();
        let mut hands = self.held.clone();
        let mut goals = &rows * self.held_at;
        if let Some((row, goal)) = more {
            let k = rows.nrows();
            let size = row.norm();
            rows = rows.insert_row(k, 0.0);
            rows.set_row(k, &(row / size).transpose());
            goals = goals.push(goal / size);
            hands = hands.insert_column(k, 0.0);
            hands.set_column(k, &self.pattern.0.normalize());
        }
        Guide {
            from: self.posture.target,
            rows,
            goals,
            hands,
        }
    }

    /// Newton from a state under a wrench; the wrench that is left after it is that of the answer.
    pub(crate) fn settle(
        &self,
        state: MechanismState,
        wrench: Wrench,
        guide: Guide,
        robustly: bool,
    ) -> Result<(MechanismEquilibrium, f64)> {
        let mut solver = self.posture.solver(state, Unknowns::Guided);
        solver.guide = guide;
        solver.wrench = wrench;
        let residual = if robustly {
            solver.solve_robustly()?
        } else {
            match solver.solve(1.0, 0) {
                Ok((iterations, balance)) => balance.residual(iterations),
                Err((iterations, balance)) => {
                    return Err(solver.not_converged(iterations, 0.0, &balance));
                }
            }
        };
        // The part of the pattern in the wrench: reactions are across the tool's motions.
        let across = complement(&independent_columns(&self.held));
        let part = |w: &Wrench| across.transpose() * w.0;
        let (own, unit) = (
            part(&Wrench(solver.wrench.0 - self.dead.0)),
            part(&self.pattern),
        );
        let factor = own.dot(&unit) / unit.norm_squared();
        let e = conclude(&mut solver, residual)?;
        Ok((e, factor))
    }

    pub(crate) fn first(&self, value: f64) -> Result<PathPoint> {
        let mut state = self.posture.rest_state();
        let tool = self.posture.mechanism.tool;
        let (wrench, guide) = if self.by_motion {
            let way = self.pattern.0 * (value / self.pattern.0.norm_squared());
            state.platforms[tool] = moved(&self.posture.target, &Twist(way));
            let row = self.pattern.0;
            (self.dead, self.guide(Some((&row, value))))
        } else {
            (self.dead + self.pattern * value, self.guide(None))
        };
        let (e, factor) = match self.by_motion || self.held.ncols() > 0 {
            true => self.settle(state, wrench, guide, true)?,
            // What nothing holds has more ways to its rest.
            false => {
                let rest = self.posture.rest_under(&wrench, state)?;
                self.settle(rest, wrench, guide, false)?
            }
        };
        let mut ahead = Vector6::zeros();
        if self.by_motion {
            ahead = self.pattern.0;
        }
        let guess = (ahead, if self.by_motion { 0.0 } else { 1.0 });
        Ok(self.point(e, factor, &guess))
    }

    /// A point with its tangent, which goes on as `before` goes.
    fn point(
        &self,
        e: MechanismEquilibrium,
        factor: f64,
        before: &(Vector6<f64>, f64),
    ) -> PathPoint {
        let tangent = self.tangent(&e, before);
        let along = self.displacement(&self.unbalanced(&tangent.0));
        let motion = self.motion(&e.tool);
        let displacement = self.displacement(&motion);
        let shapes = e.shapes_stable() && e.others_hold;
        let dead = self.holds(&e, &self.motions);
        let restraint = if self.by_motion {
            self.free.clone()
        } else {
            // Held along the load.
            let pattern = self.free.transpose() * self.pattern.0;
            match pattern.norm() > 0.0 {
                true => &self.free * complement(&DMatrix::from_columns(&[pattern.normalize()])),
                false => self.free.clone(),
            }
        };
        let (parameter, conjugate) = match self.by_motion {
            true => (displacement, factor),
            false => (factor, displacement),
        };
        PathPoint {
            parameter,
            conjugate,
            slope: tangent.1 / along,
            held: shapes && self.holds(&e, &restraint).stays,
            dead: shapes && dead.stays,
            may_flutter: shapes && dead.may_flutter(),
            equilibrium: e,
            tangent,
            factor,
        }
    }

    pub(crate) fn unbalanced(&self, motion: &Vector6<f64>) -> Vector6<f64> {
        Vector6::from_fn(|i, _| motion[i] / self.unit(i))
    }

    /// Those of some motions (balanced) that the machine can make.
    pub(crate) fn possible(
        &self,
        e: &MechanismEquilibrium,
        motions: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        self.without(e, motions, DirectionKind::Rigid)
    }

    /// Those of some motions (balanced) across all directions of a kind.
    pub(crate) fn without(
        &self,
        e: &MechanismEquilibrium,
        motions: &DMatrix<f64>,
        kind: DirectionKind,
    ) -> DMatrix<f64> {
        without(&e.directions, kind, self.length, motions)
    }

    pub(crate) fn balanced_stiffness(&self, e: &MechanismEquilibrium) -> DMatrix<f64> {
        let k = &e.stiffness.matrix;
        DMatrix::from_fn(6, 6, |i, j| k[(i, j)] / (self.unit(i) * self.unit(j)))
    }

    /// Whether the tool keeps its place in some motions (balanced) under dead wrenches.
    pub(crate) fn holds(&self, e: &MechanismEquilibrium, motions: &DMatrix<f64>) -> Holding {
        let possible = self.possible(e, motions);
        if possible.ncols() == 0 {
            return Holding {
                stays: true,
                definite: true,
            };
        }
        // By principal directions: in the matrix stiff motions may have drowned soft ones.
        let rows = root_rows(&e.directions, self.length);
        let unit = Vector6::from_fn(|i, _| self.unit(i));
        let mut back = DMatrix::zeros(rows.len(), possible.ncols());
        let mut inner = DMatrix::zeros(rows.len(), rows.len());
        for (i, (sign, row)) in rows.iter().enumerate() {
            let row = row.component_div(&unit);
            // What a direction has of another by rounding is none.
            let least = 1e-13 * row.norm();
            let part = (row.transpose() * &possible).map(|x| if x.abs() > least { x } else { 0.0 });
            back.row_mut(i).copy_from(&part);
            inner[(i, i)] = *sign;
        }
        let definite = levels(&back, &inner).iter().all(|(value, _)| *value >= 0.0);
        let stays = definite
            || (!self.conservative(e, motions) && {
                let k = possible.transpose() * self.balanced_stiffness(e) * &possible;
                diverging_motions(&k, 1e-9 * k.amax(), e.moves_with_its_tool()) == 0
            });
        Holding { stays, definite }
    }

    /// Whether all loads have a potential, with what is dead of the wrench on the tool in some motions (balanced).
    fn conservative(&self, e: &MechanismEquilibrium, motions: &DMatrix<f64>) -> bool {
        let unit = Vector6::from_fn(|i, _| self.unit(i));
        let dead = motions * (motions.transpose() * e.wrench.0.component_div(&unit));
        let moment = Vector3::from_fn(|i, _| dead[3 + i] * self.length);
        // What the projection leaves of none.
        let moment =
            match moment.norm() > 1e-12 * e.wrench.0.component_div(&unit).norm() * self.length {
                true => moment,
                false => Vector3::zeros(),
            };
        e.conservative && self.posture.mechanism.tool_moment_has_potential(&moment)
    }

    /// Null vector of `[K, -P]` in the motions of the tool that goes on as `before`; its motion has
    /// the length one.
    fn tangent(
        &self,
        e: &MechanismEquilibrium,
        before: &(Vector6<f64>, f64),
    ) -> (Vector6<f64>, f64) {
        let possible = self.possible(e, &self.motions);
        let n = possible.ncols();
        let k = possible.transpose() * self.balanced_stiffness(e) * &possible;
        let load = DVector::from_fn(6, |i, _| self.pattern.0[i] / self.unit(i));
        let load = possible.transpose() * load;
        // One unit for all points, or the tangent's sense would be lost where the stiffness is.
        let (stiff, push) = (self.posture.mechanism.scale().stiffness, load.norm());
        if n == 0 || push == 0.0 {
            return (Vector6::zeros(), 1.0);
        }
        let unit = stiff / push;
        let mut rows = DMatrix::zeros(n + 1, n + 1);
        rows.view_mut((0, 0), (n, n)).copy_from(&(k / stiff));
        rows.view_mut((0, n), (n, 1)).copy_from(&(-&load / push));
        let own = crate::linalg::singular_values::SingularValues::of(&rows);
        let most = own.largest();
        let was = DVector::from_fn(n + 1, |i, _| match i < n {
            true => possible.column(i).dot(&before.0),
            false => before.1 / unit,
        });
        let mut next = DVector::zeros(n + 1);
        for (own, value) in own.right.column_iter().zip(&own.values) {
            if *value <= 1e-9 * most {
                let share = own.dot(&was);
                next += own * share;
            }
        }
        if next.norm() <= 1e-9 * was.norm() {
            // A flat posture: the load starts to move the tool where nothing holds it yet.
            let push = load.normalize();
            next.fill(0.0);
            for (own, value) in own.right.column_iter().zip(&own.values) {
                if *value <= 1e-9 * most {
                    next += own * own.rows(0, n).dot(&push);
                }
            }
            next[n] = 0.0;
        }
        let motion = &possible * next.rows(0, n);
        let size = motion.norm();
        if size == 0.0 {
            return *before;
        }
        let motion = Vector6::from_fn(|i, _| motion[i] / size);
        (motion, next[n] * unit / size)
    }

    /// The equilibrium a step `by` (m, balanced) along the path from a point.
    pub(crate) fn step(&self, from: &PathPoint, by: f64) -> Option<PathPoint> {
        let (way, rate) = &from.tangent;
        let mut state = from.equilibrium.state.clone();
        let tool = self.posture.mechanism.tool;
        let motion = self.unbalanced(way) * by;
        let row = Vector6::from_fn(|i, _| way[i] * self.unit(i));
        let goal = row.dot(&self.motion(&state.platforms[tool])) + by;
        state.platforms[tool] = moved(&state.platforms[tool], &Twist(motion));
        let predicted = state.platforms[tool];
        let wrench = from.equilibrium.wrench + self.pattern * (rate * by);
        let guide = self.guide(Some((&row, goal)));
        let (e, factor) = self.settle(state, wrench, guide, false).ok()?;
        let off = pose_residual(&e.tool, &predicted).0;
        let off = Vector6::from_fn(|i, _| off[i] * self.unit(i)).norm();
        (off <= 0.5 * by.abs() + 1e-12 * self.length).then(|| self.point(e, factor, &from.tangent))
    }

    /// The equilibrium at a value of the parameter (or of its conjugate), from a point near it.
    fn at(&self, from: &PathPoint, value: f64, motion: bool) -> Option<PathPoint> {
        let state = from.equilibrium.state.clone();
        let wrench = from.equilibrium.wrench;
        let (e, factor) = if motion {
            let row = self.pattern.0;
            self.settle(state, wrench, self.guide(Some((&row, value))), false)
        } else {
            let wrench = wrench + self.pattern * (value - from.factor);
            self.settle(state, wrench, self.guide(None), false)
        }
        .ok()?;
        Some(self.point(e, factor, &from.tangent))
    }

    /// Points one way from the start, without it.
    fn walk(&self, start: &PathPoint, sign: f64) -> (Vec<PathPoint>, BranchEnd) {
        let (low, high) = self.settings.range;
        let (least, most) = self.settings.conjugate_range;
        let change = (self.settings.largest_change).unwrap_or(0.05 * (high - low));
        let rate = |p: &PathPoint| {
            let along = self.displacement(&self.unbalanced(&p.tangent.0));
            let by = if self.by_motion { along } else { p.tangent.1 };
            by.abs()
        };
        let edge = if sign > 0.0 { high } else { low };
        if start.parameter == edge || start.tangent.0.norm() == 0.0 {
            return (Vec::new(), BranchEnd::Range);
        }
        // Where the load starts without any, the machine's size tells how far a step goes.
        let largest = match rate(start) * self.length > 1e-9 * change {
            true => change / rate(start),
            false => 0.02 * self.length,
        };
        let least_step = self.settings.smallest_step * largest.min(self.length);
        // Turns of the tangent are seen in units in which it starts at 45 degrees, if it has any
        // stiffness to speak of.
        let soft = 1e-4 * self.posture.mechanism.scale().stiffness / self.pattern.0.norm();
        let unit = start.tangent.1.abs().max(soft);
        let angle = |a: &PathPoint, b: &PathPoint| {
            let (x, y) = (&a.tangent, &b.tangent);
            let dot = x.0.dot(&y.0) + x.1 * y.1 / (unit * unit);
            let size = |t: &(Vector6<f64>, f64)| (1.0 + (t.1 / unit).powi(2)).sqrt();
            (dot / (size(x) * size(y))).clamp(-1.0, 1.0).acos()
        };
        // Below these units a limit of the load would be passed unseen: there the load that a step
        // gained must be that of its tangents.
        let nothing = 1e-6 * soft;
        let resolved = |a: &PathPoint, b: &PathPoint, by: f64| {
            let (x, y) = (a.tangent.1, b.tangent.1);
            let most = x.abs().max(y.abs());
            let apart = (b.factor - a.factor) / by - 0.5 * (x + y);
            x == 0.0 || most > soft || most < nothing || apart.abs() < 0.1 * most
        };
        let mut points: Vec<PathPoint> = Vec::new();
        let mut by = largest;
        let mut here = start.clone();
        let mut lost = 0;
        loop {
            if points.len() >= self.settings.points {
                return (points, BranchEnd::Points);
            }
            if lost > self.settings.points + LOST_STEPS {
                return (points, BranchEnd::Stalled);
            }
            by = by.min(change / rate(&here).max(1e-300)).min(4.0 * largest);
            let next = self
                .step(&here, sign * by)
                .filter(|p| angle(&here, p) < 0.35 && resolved(&here, p, sign * by));
            let Some(next) = next else {
                by *= 0.5;
                lost += 1;
                if by < least_step {
                    return (points, BranchEnd::Lost);
                }
                continue;
            };
            if next.parameter > high || next.parameter < low {
                let edge = if next.parameter > high { high } else { low };
                if let Some(p) = self.between(&here, sign * by, |p| p.parameter - edge) {
                    points.push(self.at(&p, edge, self.by_motion).unwrap_or(p));
                }
                return (points, BranchEnd::Range);
            }
            if next.conjugate > most || next.conjugate < least {
                return (points, BranchEnd::Range);
            }
            if angle(&here, &next) < 0.1 {
                by *= 1.5;
            }
            here = next.clone();
            points.push(next);
        }
    }

    /// Zero of a quantity between a point and the one a step ahead.
    pub(crate) fn between(
        &self,
        from: &PathPoint,
        step: f64,
        of: impl Fn(&PathPoint) -> f64,
    ) -> Option<PathPoint> {
        let far = self.step(from, step)?;
        let (mut a, mut b) = ((0.0, of(from)), (step, of(&far)));
        let mut best = if a.1.abs() < b.1.abs() {
            from.clone()
        } else {
            far
        };
        let size = a.1.abs().max(b.1.abs());
        for _ in 0..BISECTIONS {
            if of(&best).abs() <= 1e-12 * size || (a.0 - b.0).abs() <= 1e-14 * step.abs() {
                break;
            }
            let s = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
            let Some(next) = self.step(from, s) else {
                break;
            };
            let f = of(&next);
            // Illinois: false position with halving.
            if f * b.1 < 0.0 {
                a = b;
            } else {
                a.1 *= 0.5;
            }
            b = (s, f);
            if f.abs() < of(&best).abs() {
                best = next;
            }
        }
        Some(best)
    }

    /// Where a verdict changes between a point and the one a step ahead.
    fn change(
        &self,
        from: &PathPoint,
        step: f64,
        of: impl Fn(&PathPoint) -> [bool; 2],
    ) -> Option<PathPoint> {
        let first = of(from);
        let (mut low, mut high, mut best) = (0.0, step, self.step(from, step));
        for _ in 0..BISECTIONS {
            // Newton may fail where branches cross: then a little aside.
            let there = [0.5, 0.45, 0.55, 0.3, 0.7].into_iter().find_map(|share| {
                let at = low + share * (high - low);
                Some((at, self.step(from, at)?))
            });
            let Some((middle, there)) = there else {
                break;
            };
            if of(&there) == first {
                low = middle;
            } else {
                high = middle;
                best = Some(there);
            }
            if (high - low).abs() < 1e-9 * step.abs() {
                break;
            }
        }
        best
    }

    /// Limit points and changes of stability between neighbours.
    fn specials(&self, points: &[PathPoint], start: usize) -> Vec<PathSpecial> {
        let mut list = Vec::new();
        for (i, pair) in points.windows(2).enumerate() {
            // Away from the start, so that steps are those that were gone.
            let (a, b) = match i < start {
                true => (&pair[1], &pair[0]),
                false => (&pair[0], &pair[1]),
            };
            let sign = if i < start { -1.0 } else { 1.0 };
            let step = self.step_between(a, b);
            // Among motions that cost nothing, neighbours may lie across the way: nothing is told.
            if step * sign < 0.0 {
                continue;
            }
            let moves = |p: &PathPoint| self.displacement(&self.unbalanced(&p.tangent.0));
            let verdict = |p: &PathPoint| [p.held, p.dead];
            let differs = [a.held != b.held, a.dead != b.dead];
            let mut told = [false; 2];
            if let Some(point) = self.load_limit(a, b, step) {
                told[1] = differs[1];
                list.push(PathSpecial {
                    kind: PathSpecialKind::LoadLimit,
                    point,
                    ends: [false, differs[1]],
                });
            }
            if moves(a) * moves(b) < 0.0
                && let Some(point) = self.between(a, step, moves)
            {
                told = [differs[0], told[1] || differs[1]];
                list.push(PathSpecial {
                    kind: PathSpecialKind::DisplacementLimit,
                    point,
                    ends: [differs[0], false],
                });
            }
            let open = [differs[0] && !told[0], differs[1] && !told[1]];
            if (open[0] || open[1])
                && let Some(point) = self.change(a, step, |p| {
                    let v = verdict(p);
                    [v[0] && open[0], v[1] && open[1]]
                })
            {
                list.push(PathSpecial {
                    kind: PathSpecialKind::Crossing,
                    point,
                    ends: open,
                });
            }
        }
        list
    }

    /// Length of the step from one point to the next along its tangent.
    fn step_between(&self, a: &PathPoint, b: &PathPoint) -> f64 {
        let (x, y) = (
            self.motion(&a.equilibrium.tool),
            self.motion(&b.equilibrium.tool),
        );
        let way = &a.tangent.0;
        (0..6).map(|k| way[k] * (y[k] - x[k]) * self.unit(k)).sum()
    }

    /// Where the load has its extreme between two points.
    fn load_limit(&self, a: &PathPoint, b: &PathPoint, step: f64) -> Option<PathPoint> {
        let load = |p: &PathPoint| p.tangent.1;
        (load(a) * load(b) < 0.0)
            .then(|| self.between(a, step, load))
            .flatten()
    }

    /// Where the path from no load reaches the whole, if it does before a limit; else the first point at
    /// which the machine stops being stable under the load because that has its extreme. `none` tells
    /// which of them are rounding.
    pub(crate) fn growing(
        &self,
        none: impl Fn(&PathPoint) -> bool,
    ) -> Result<(Option<PathPoint>, Option<PathPoint>)> {
        let start = self.first(0.0)?;
        let (ahead, end) = self.walk(&start, 1.0);
        let last = ahead.last().cloned();
        let points: Vec<PathPoint> = [start].into_iter().chain(ahead).collect();
        let first = points
            .windows(2)
            .filter(|w| w[0].dead != w[1].dead)
            .find_map(|w| {
                let step = self.step_between(&w[0], &w[1]);
                let limit = (step >= 0.0).then(|| self.load_limit(&w[0], &w[1], step));
                let limit = limit.flatten().filter(|p| !none(p))?;
                Some((&w[0], limit))
            });
        let whole = self.settings.range.1;
        Ok(match first {
            // A step may lead over a limit that lies beyond the whole load, and end below it: the
            // whole was carried before.
            Some((before, limit)) if limit.parameter >= whole => {
                let step = self.step_between(before, &limit);
                let there = self.between(before, step, |p| p.parameter - whole);
                (there, None)
            }
            Some((_, limit)) => (None, Some(limit)),
            None => {
                let reached = |p: &PathPoint| end == BranchEnd::Range && p.parameter == whole;
                (last.filter(reached), None)
            }
        })
    }

    fn jumps(&self, points: &[PathPoint], specials: &[PathSpecial]) -> Vec<PathJump> {
        let mut jumps = Vec::new();
        for (from, special) in specials.iter().enumerate() {
            let (dead_load, k) = match special.kind {
                PathSpecialKind::LoadLimit => (true, 1),
                PathSpecialKind::DisplacementLimit => (false, 0),
                PathSpecialKind::Crossing => continue,
            };
            if !special.ends[k] {
                continue;
            }
            let of = |p: &PathPoint| match dead_load {
                true => p.factor,
                false => self.displacement(&self.motion(&p.equilibrium.tool)),
            };
            let value = of(&special.point);
            let apart = |p: &PathPoint| {
                let off = pose_residual(&p.equilibrium.tool, &special.point.equilibrium.tool).0;
                Vector6::from_fn(|i, _| off[i] * self.unit(i)).norm()
            };
            let step = points
                .windows(2)
                .map(|w| {
                    let off = pose_residual(&w[1].equilibrium.tool, &w[0].equilibrium.tool).0;
                    Vector6::from_fn(|i, _| off[i] * self.unit(i)).norm()
                })
                .fold(0.0, f64::max);
            let stable = |p: &PathPoint| {
                let holds = if dead_load { p.dead } else { p.held };
                holds && apart(p) > 1e-3 * step
            };
            let mut to: Vec<PathPoint> = points
                .windows(2)
                .filter(|w| (of(&w[0]) - value) * (of(&w[1]) - value) <= 0.0)
                .filter_map(|w| self.at(&w[0], value, !dead_load))
                .filter(stable)
                .collect();
            if to.is_empty() && dead_load {
                // Beyond what was followed: the machine is let go at the path's ends.
                let ends = points.first().into_iter().chain(points.last());
                to = ends
                    .filter_map(|p| self.at(p, value, false))
                    .filter(stable)
                    .collect();
            }
            to.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
            to.dedup_by(|a, b| {
                let off = pose_residual(&a.equilibrium.tool, &b.equilibrium.tool).0;
                off.norm() < 1e-9 * self.length
            });
            jumps.push(PathJump {
                from,
                dead_load,
                to,
            });
        }
        jumps
    }
}
