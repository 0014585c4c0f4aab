//! Rotors of drives on their side of the transmission [D 1], and gyroscopic terms of their angular momentum [D 6].
//!
//! A rotor sits before the transmission spring. With the motor held it adds nothing; with a servo of finite stiffness it
//! has a coordinate of its own, as the joint sees it through the ratio `n`: inertia `n^2 J_r`, a spring `k_m` of the servo to
//! the ground and `k_t` of the transmission to the link. The joint's stiffness `k` of the statics is both in series,
//! `1/k = 1/k_t + 1/k_m`, so that nothing changes at rest. An "armature" added to the link's own coordinate would be on
//! the wrong side of an elastic joint.

use kinetostat::spatial::hat;
use kinetostat::{Chain, Mechanism};
use nalgebra::{DMatrix, DVector, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};
use crate::linear::LinearDynamics;
use crate::linear::places::Point;
use crate::mass::{MassKind, MassPart};

/// The rotor of a drive.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct Rotor {
    /// Name of the joint: its coordinate, `limb.joint` where there are several limbs.
    pub joint: String,
    /// Inertia of the rotor about its own axis, kg m^2.
    pub inertia: f64,
    /// Turns (rad) of the rotor per motion of the joint: a ratio for a joint that turns, rad/m for a slide.
    pub ratio: f64,
    /// Stiffness of the servo as the joint sees it, N m/rad or N/m; larger than that of the joint, which is servo and
    /// transmission in series.
    pub servo_stiffness: f64,
}

/// Rotors of the drives of a chain; `prefix` stands before the names of its joints.
pub(crate) fn rotors_of_chain(chain: &Chain, prefix: &str) -> Vec<Rotor> {
    let drives = chain.actuators().iter();
    let stated = drives.filter_map(|drive| Some((drive, drive.rotor?)));
    stated
        .map(|(drive, rotor)| Rotor {
            joint: format!("{prefix}{}", drive.name),
            inertia: rotor.inertia,
            ratio: rotor.ratio,
            servo_stiffness: rotor.servo_stiffness,
        })
        .collect()
}

/// Rotors of the drives of a machine.
pub(crate) fn rotors_of(machine: &Mechanism) -> Vec<Rotor> {
    let several = machine.limbs().len() > 1;
    let of_limb = |limb: &kinetostat::Limb| {
        let prefix = match several {
            true => format!("{}.", limb.name),
            false => String::new(),
        };
        rotors_of_chain(&limb.actual, &prefix)
    };
    machine.limbs().iter().flat_map(of_limb).collect()
}

impl LinearDynamics {
    /// Adds rotors to drives, each with a coordinate of its own, last. Rotors that drives of the model state
    /// ([`kinetostat::model::DriveRotor`]) are included already.
    ///
    /// # Errors
    /// [`Error::Rotor`]: a joint without a spring, an inertia below zero, a servo softer than the whole joint.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3, vector};
    /// # use kinetostat::*;
    /// use kinetostat_dynamics::{Held, LinearDynamics, Rotor};
    ///
    /// let hinge = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 1e5); // N m/rad, servo and gear
    /// let arm = Chain::builder("arm").actuator("drive", hinge).body("arm", 8.0, vector![0.5, 0.0, 0.0], Matrix3::zeros()).build()?;
    /// let problem = ChainProblem::new(&arm, EndCondition::wrench(Wrench::zero()));
    /// let arm = LinearDynamics::of_chain(&problem, &[0.0], &Wrench::zero(), &Held::nothing())?;
    /// let rotor = Rotor { joint: "drive".into(), inertia: 1e-3, ratio: 100.0, servo_stiffness: 3e5 };
    /// let with = arm.with_rotors(&[rotor])?;
    /// // Servo 3e5 and gear 1.5e5 in series; the rotor weighs 100^2 * 1e-3 = 10 kg m^2 on its side of the gear.
    /// let trace: f64 = with.modes()?.modes.iter().map(|mode| mode.squared).sum();
    /// assert!((trace - (1.5e5 / 2.0 + 4.5e5 / 10.0)).abs() < 1e-6 * trace);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_rotors(&self, rotors: &[Rotor]) -> Result<Self> {
        let mut whole = self.clone();
        for rotor in rotors {
            whole = whole.with_rotor(rotor)?;
        }
        Ok(whole)
    }

    fn with_rotor(mut self, rotor: &Rotor) -> Result<Self> {
        let fault = |reason: String| {
            Err(Error::Rotor {
                joint: rotor.joint.clone(),
                reason,
            })
        };
        let Some(joint) = self.coordinates.iter().find(|c| c.name == rotor.joint) else {
            return Err(Error::UnknownName {
                what: "joint",
                name: rotor.joint.clone(),
                known: self
                    .coordinates
                    .iter()
                    .map(|c| c.name.as_str())
                    .collect::<Vec<_>>()
                    .join(", "),
            });
        };
        let index = joint.index;
        let own = self
            .springs
            .iter()
            .find(|s| s.material.nrows() == 1 && self.blocks[s.block][s.first] == index);
        let Some(stiffness) = own.map(|s| s.material[(0, 0)]) else {
            return fault(
                "the joint has no spring of its own: with a rigid drive the rotor does not move"
                    .to_owned(),
            );
        };
        let (servo, inertia) = (rotor.servo_stiffness, rotor.inertia * rotor.ratio.powi(2));
        if !(rotor.inertia.is_finite() && rotor.inertia >= 0.0 && inertia.is_finite()) {
            return fault(format!(
                "inertia {} kg m^2 and ratio {} are no rotor's",
                rotor.inertia, rotor.ratio
            ));
        }
        if !(servo.is_finite() && servo > stiffness) {
            return fault(format!(
                "the servo's stiffness is {servo}, that of the whole joint {stiffness}: servo and gear in series are softer than either"
            ));
        }
        let gear = stiffness * servo / (servo - stiffness);
        let n = self.len();
        let row: DVector<f64> = match &self.basis {
            Some(basis) => basis.row(index).transpose(),
            None => DVector::from_fn(n, |i, _| f64::from(u8::from(i == index))),
        };
        for matrix in [&mut self.tangent, &mut self.elastic] {
            let mut grown = std::mem::take(matrix).resize(n + 1, n + 1, 0.0);
            let mut view = grown.view_mut((0, 0), (n, n));
            view.ger(gear - stiffness, &row, &row, 1.0);
            for i in 0..n {
                grown[(i, n)] = -gear * row[i];
                grown[(n, i)] = -gear * row[i];
            }
            grown[(n, n)] = gear + servo;
            *matrix = grown;
        }
        self.mass = std::mem::take(&mut self.mass).resize(n + 1, n + 1, 0.0);
        self.mass[(n, n)] = inertia;
        self.grow(index, rotor, inertia, gear, servo);
        Ok(self)
    }

    /// Coordinates, parts and springs that a rotor brings.
    fn grow(&mut self, joint: usize, rotor: &Rotor, inertia: f64, gear: f64, servo: f64) {
        let n = self.len() - 1;
        let all = self.basis.as_ref().map_or(n, DMatrix::nrows);
        if let Some(basis) = self.basis.take() {
            let mut grown = basis.resize(all + 1, n + 1, 0.0);
            grown[(all, n)] = 1.0;
            self.basis = Some(grown);
        }
        self.units.push(1.0);
        let block = self.blocks.len();
        self.blocks.push(vec![joint, all]);
        let motion = |row: [f64; 2]| DMatrix::from_row_slice(1, 2, &row);
        self.masses.push(MassPart {
            name: format!("rotor of {}", rotor.joint),
            kind: MassKind::Rotor,
            block,
            motions: motion([0.0, 1.0]),
            inertia: DMatrix::from_element(1, 1, inertia),
        });
        // The joint's own spring becomes gear and servo.
        let own = self
            .springs
            .iter()
            .position(|s| s.material.nrows() == 1 && self.blocks[s.block][s.first] == joint);
        if let Some(own) = own {
            self.springs[own].block = block;
            self.springs[own].first = 0;
            self.springs[own].material =
                DMatrix::from_row_slice(2, 2, &[gear, -gear, -gear, gear + servo]);
        }
        self.coordinates.push(crate::linear::NamedCoordinate {
            name: format!("{}.rotor", rotor.joint),
            index: all,
        });
    }
}

impl LinearDynamics {
    /// Gyroscopic matrix `-J_w^T hat(h) J_w` of a rotor that spins in the part at a point with the momentum `h` (inertia
    /// about its axis times speed, kg m^2/s, base axes): skew, to be added to a damping matrix for
    /// [`Self::complex_modes`]. That of a tool matters for the modes of the spindle, hardly for those of an arm.
    ///
    /// # Errors
    /// [`Error::Question`] where the momentum is no number.
    pub fn gyroscopic_matrix(&self, point: Point, momentum: &Vector3<f64>) -> Result<DMatrix<f64>> {
        if momentum.iter().any(|x| !x.is_finite()) {
            return Err(Error::Question(format!(
                "the momentum of the rotor is {}, {}, {} kg m^2/s; finite numbers are needed",
                momentum.x, momentum.y, momentum.z
            )));
        }
        let motions = self.motions(point);
        let turns = motions.rows(3, 3);
        let half = turns.tr_mul(&(-hat(momentum) * turns));
        // Skew without rounding.
        Ok((&half - half.transpose()) * 0.5)
    }
}
