//! Constraints and loads of a machine's tool, and its motions in numbers.
//!
//! The tool's motions are those in which it is free, and the driven one; scaled: rotations times the natural length.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::problem::{EndCondition, Prescribed};
use crate::continuation::settings::{CurveSettings, LoadPattern, Parameter};
use crate::error::{Error, Result};
use crate::linalg::complement::complement;
use crate::machine::platforms::parts::Guide;
use crate::machine::posture::Posture;
use crate::spatial::{Pose, Wrench, pose_residual, turn_matrix};

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
