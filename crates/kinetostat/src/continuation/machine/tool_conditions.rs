//! Constraints and loads of a machine's tool, and its motions in numbers.
//!
//! The tool's motions are those in which it is free, and the driven one; scaled: rotations times the natural length.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::DirectionKind;
use crate::chain::problem::{EndCondition, Prescribed};
use crate::continuation::settings::{CurveSettings, LoadPattern, Parameter};
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::linalg::saddle::independent_columns;
use crate::machine::directions::without;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::{Guide, Unknowns};
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::model::chain::Role;
use crate::number::largest_size;
use crate::spatial::{MotionKind, Pose, Twist, Wrench, moved, pose_residual, turn_matrix};

/// Parameter and end conditions in numbers.
pub(crate) struct ToolConditions<'p> {
    pub(crate) posture: &'p Posture,
    pub(crate) settings: CurveSettings,
    /// Wrench on the tool by the factor.
    pub(crate) pattern: Wrench,
    pub(crate) dead: Wrench,
    /// The displacement is the parameter, not the factor.
    pub(crate) by_motion: bool,
    /// Motions of the tool: those that are free, and the driven one, scaled, orthonormal.
    pub(crate) motions: DMatrix<f64>,
    /// Free motions, scaled.
    pub(crate) free: DMatrix<f64>,
    /// Directions in which the tool is held, base axes, columns.
    pub(crate) held: DMatrix<f64>,
    /// Prescribed displacement in these directions, from the nominal target.
    pub(crate) displacement: Vector6<f64>,
    pub(crate) length: f64,
}

impl<'p> ToolConditions<'p> {
    pub(crate) fn new(
        posture: &'p Posture,
        parameter: &Parameter,
        end: &EndCondition,
        settings: &CurveSettings,
    ) -> Result<Self> {
        let place = || posture.mechanism.place();
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
            let scaled = Vector6::from_fn(|i, _| if i < 3 { d[i] } else { d[i] * length });
            let last = motions.ncols();
            motions = motions.insert_column(last, 0.0);
            motions.set_column(last, &scaled.normalize());
            // Directions across that one stay held.
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
            displacement: Vector6::zeros(),
            length,
        })
    }

    /// Conditions for equilibria one by one: held as `end` says at `end.pose`, nothing grows.
    pub(crate) fn at_displacement(posture: &'p Posture, end: &EndCondition) -> Result<Self> {
        posture.finite("the pose", end.pose.to_homogeneous().iter())?;
        let nothing = LoadPattern {
            end: Wrench::new(nalgebra::Vector3::x(), nalgebra::Vector3::zeros()),
            loads: Vec::new(),
        };
        let settings = CurveSettings::within(0.0, 1.0);
        let mut path = Self::new(posture, &Parameter::Load(nothing), end, &settings)?;
        let motion = path.motion(&end.pose);
        path.displacement = motion - path.freely(&motion);
        Ok(path)
    }

    /// Conditions with the tool driven along one of its free motions (scaled, unit length) besides: the load along it
    /// is the conjugate. That load is orthogonal to all other motions, rotations at the natural length.
    pub(crate) fn driven(&self, motion: &Vector6<f64>, settings: CurveSettings) -> Self {
        let inside = self.free.transpose() * motion;
        Self {
            posture: self.posture,
            settings,
            pattern: Wrench(self.scaled(motion)),
            dead: self.dead,
            by_motion: true,
            motions: self.free.clone(),
            free: &self.free * complement(&DMatrix::from_columns(&[inside])),
            held: self.held.clone(),
            displacement: self.displacement,
            length: self.length,
        }
    }

    /// Prescribed displacement of the tool from the nominal target: m, rad.
    pub(crate) fn prescribed_displacement(&self) -> Vector6<f64> {
        self.displacement
    }

    /// The part of a motion (m, rad) in which the tool is free.
    pub(crate) fn freely(&self, motion: &Vector6<f64>) -> Vector6<f64> {
        let part = &self.free * (self.free.transpose() * self.scaled(motion));
        Vector6::from_fn(|i, _| part[i] / self.unit(i))
    }

    pub(crate) fn scaled(&self, motion: &Vector6<f64>) -> Vector6<f64> {
        Vector6::from_fn(|i, _| motion[i] * self.unit(i))
    }

    pub(crate) fn unscaled(&self, motion: &Vector6<f64>) -> Vector6<f64> {
        Vector6::from_fn(|i, _| motion[i] / self.unit(i))
    }

    pub(crate) fn unit(&self, i: usize) -> f64 {
        if i < 3 { 1.0 } else { self.length }
    }

    /// Motion of the tool from its nominal target, base axes.
    pub(crate) fn motion(&self, pose: &Pose) -> Vector6<f64> {
        pose_residual(pose, &self.posture.target).0
    }

    /// Displacement along the pattern.
    pub(crate) fn displacement(&self, motion: &Vector6<f64>) -> f64 {
        self.pattern.0.dot(motion)
    }

    /// Conditions of what is held, and one more on the motion (its hand is the pattern).
    pub(crate) fn guide(&self, more: Option<(&Vector6<f64>, f64)>) -> Guide {
        let mut rows = self.held.transpose();
        let mut hands = self.held.clone();
        let mut goals = &rows * self.displacement;
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
}

impl ToolConditions<'_> {
    /// Equilibrium from a state, if Newton finds it from there.
    pub(crate) fn rest(
        &self,
        state: MechanismState,
        wrench: &Wrench,
    ) -> Option<MechanismEquilibrium> {
        let converged = self.converge(state, *wrench, self.guide(None), false);
        converged.ok().map(|(e, _)| e)
    }

    /// Deflections of all springs, rad and shares of the natural length.
    pub(crate) fn spring_strains(&self, e: &MechanismEquilibrium) -> Vec<f64> {
        let limbs = self.posture.mechanism.limbs().iter();
        let own = limbs.zip(&e.limbs).flat_map(|(limb, own)| {
            let of_limb = limb.actual.coordinates().iter().zip(&own.coordinates);
            of_limb.filter(|(c, _)| c.role == Role::Spring)
        });
        let scaled = own.map(|(c, x)| match c.kind {
            MotionKind::Revolute => *x,
            MotionKind::Prismatic => x / self.length,
        });
        scaled.collect()
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
        let most = largest_size(x.iter().chain(&y));
        let off = self.scaled(&pose_residual(&a.tool, &b.tool).0);
        // In a stretched limb, rounding may be all that holds the tool along a motion.
        let nothing = 1e-15 * self.posture.mechanism.scale().stiffness;
        let mut directions = a.directions.clone();
        let for_nothing = directions
            .iter_mut()
            .filter(|d| d.stiffness_n_per_m.abs() < nothing);
        for_nothing.for_each(|d| d.kind = DirectionKind::Free);
        let all = DMatrix::identity(6, 6);
        let costly = without(&directions, DirectionKind::Free, self.length, &all);
        (costly.transpose() * off).norm() < 1e-6 * self.length
            && (x.iter().zip(&y)).all(|(x, y)| (x - y).abs() <= 1e-5 * most + 1e-9)
    }

    /// Newton from a state under a wrench; the wrench that is left after it is that of the answer.
    pub(crate) fn converge(
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
                Ok((iterations, norms)) => norms.residual(iterations),
                Err((iterations, norms)) => {
                    return Err(solver.not_converged(iterations, 0.0, &norms));
                }
            }
        };
        let factor = self.factor(&solver.wrench);
        let e = conclude(&mut solver, residual)?;
        Ok((e, factor))
    }

    /// Factor of the load in a wrench on the tool: reactions are across the tool's motions.
    pub(crate) fn factor(&self, wrench: &Wrench) -> f64 {
        let across = complement(&independent_columns(&self.held));
        let part = |w: &Wrench| across.transpose() * w.0;
        let (own, unit) = (part(&Wrench(wrench.0 - self.dead.0)), part(&self.pattern));
        own.dot(&unit) / unit.norm_squared()
    }

    /// The driven tool's equilibrium at a displacement, and the factor of the load there.
    pub(crate) fn first_driven(&self, displacement: f64) -> Result<(MechanismEquilibrium, f64)> {
        let mut state = self.posture.rest_state();
        let tool = self.posture.mechanism.tool();
        let row = self.pattern.0;
        let motion = row * (displacement / row.norm_squared());
        state.platforms[tool] = moved(&self.posture.target, &Twist(motion));
        let guide = self.guide(Some((&row, displacement)));
        self.converge(state, self.dead, guide, true)
    }

    /// The equilibrium at a factor of the load, from a state near it, and that factor.
    pub(crate) fn first_loaded(
        &self,
        factor: f64,
        near: MechanismState,
    ) -> Result<(MechanismEquilibrium, f64)> {
        let wrench = self.dead + self.pattern * factor;
        // A tool that is held away from its command may be far.
        let robustly = self.held.ncols() > 0;
        self.converge(near, wrench, self.guide(None), robustly)
    }
}
