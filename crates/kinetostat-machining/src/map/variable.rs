//! Variables of a place: one table of names, units, columns and meanings.

use kinetostat::number::{larger, smaller};

use crate::map::solved::{Solved, principal, rotational};

/// A quantity of a place, in SI units. Numbers that do not exist are NaN.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the table says what each is")]
pub enum Variable {
    StiffnessX,
    StiffnessY,
    StiffnessZ,
    StiffnessSoftest,
    StiffnessStiffest,
    RotationalStiffnessX,
    RotationalStiffnessY,
    RotationalStiffnessZ,
    RotationalStiffnessSoftest,
    RotationalStiffnessStiffest,
    PrincipalStiffness,
    PrincipalCompliance,
    PrincipalDirections,
    Deflection,
    DeflectionXyz,
    DeflectionByLoad,
    DeflectionWithoutLoad,
    Rotation,
    RotationXyz,
    Commands,
    JointEfforts,
    EffortShare,
    ShareToBuckling,
    Margin,
    SingularityDistance,
    Stable,
    F1,
    F2,
    F3,
    F4,
    F5,
    F6,
    NaturalFrequencies,
}

/// Order by which the worse of two values is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Worse {
    /// The smaller.
    Smaller,
    /// The larger.
    Larger,
    /// The one of the larger size: it may have either sign.
    LargerSize,
    /// Neither is worse.
    Neither,
}

/// Number of columns of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Fixed number.
    Fixed(usize),
    /// One column for each actuator.
    Actuators,
}

/// Solution that a variable needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Needs {
    Posture,
    Stiffness,
    Rest,
    /// Equilibrium without the load, too.
    Unloaded,
    Stability,
    Modes,
}

/// A row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The variable.
    pub variable: Variable,
    /// Name in files, options and Python.
    pub name: &'static str,
    /// Unit; `1` without one. The unit of an actuator's effort is that of the actuator.
    pub unit: &'static str,
    /// Number of columns.
    pub width: Width,
    /// Order by which one of several orientations or loads is chosen.
    pub worse: Worse,
    needs: Needs,
    /// Description in one sentence.
    pub description: &'static str,
}

macro_rules! table {
    ($($variable:ident, $name:literal, $unit:literal, $width:expr, $worse:ident, $needs:ident, $description:literal;)*) => {
        &[$(Entry {
            variable: Variable::$variable,
            name: $name,
            unit: $unit,
            width: $width,
            worse: Worse::$worse,
            needs: Needs::$needs,
            description: $description,
        }),*]
    };
}

const ONE: Width = Width::Fixed(1);
const THREE: Width = Width::Fixed(3);

/// All variables. Stiffness is force per motion along it while the tool may turn (or moment per rotation about it while it
/// may move): the reciprocal of an entry of the compliance [R 3.13]. Axes are those of the base, the reference point is the tool's.
#[rustfmt::skip]
pub const VARIABLES: &[Entry] = table![
    StiffnessX, "stiffness_x", "N/m", ONE, Smaller, Stiffness, "force per motion along x of the base, the tool free to turn";
    StiffnessY, "stiffness_y", "N/m", ONE, Smaller, Stiffness, "force per motion along y of the base, the tool free to turn";
    StiffnessZ, "stiffness_z", "N/m", ONE, Smaller, Stiffness, "force per motion along z of the base, the tool free to turn";
    StiffnessSoftest, "stiffness_softest", "N/m", ONE, Smaller, Stiffness, "force per motion along the softest direction, the tool free to turn; 0 where a direction is free";
    StiffnessStiffest, "stiffness_stiffest", "N/m", ONE, Smaller, Stiffness, "force per motion along the stiffest direction, the tool free to turn; infinite where a direction is rigid";
    RotationalStiffnessX, "rotational_stiffness_x", "N m/rad", ONE, Smaller, Stiffness, "moment per rotation about x of the base, the tool free to move";
    RotationalStiffnessY, "rotational_stiffness_y", "N m/rad", ONE, Smaller, Stiffness, "moment per rotation about y of the base, the tool free to move";
    RotationalStiffnessZ, "rotational_stiffness_z", "N m/rad", ONE, Smaller, Stiffness, "moment per rotation about z of the base, the tool free to move";
    RotationalStiffnessSoftest, "rotational_stiffness_softest", "N m/rad", ONE, Smaller, Stiffness, "moment per rotation about the softest axis, the tool free to move; 0 where one is free";
    RotationalStiffnessStiffest, "rotational_stiffness_stiffest", "N m/rad", ONE, Smaller, Stiffness, "moment per rotation about the stiffest axis, the tool free to move";
    PrincipalStiffness, "principal_stiffness", "N/m", THREE, Smaller, Stiffness, "stiffness against a force along each principal direction, the softest first";
    PrincipalCompliance, "principal_compliance", "m/N", THREE, Larger, Stiffness, "motion per force along each principal direction, the softest first";
    PrincipalDirections, "principal_directions", "1", Width::Fixed(9), Neither, Stiffness, "unit vectors of the principal directions, base axes, one after the other, the softest first, the largest part of each positive";
    Deflection, "deflection", "m", ONE, Larger, Rest, "how far the tool goes from where it is commanded under the load";
    DeflectionXyz, "deflection_xyz", "m", THREE, LargerSize, Rest, "from where the tool is commanded to where it goes under the load, base axes";
    DeflectionByLoad, "deflection_by_load", "m", ONE, Larger, Unloaded, "how far the load moves the tool from where it is without the load: own weight is not in it";
    DeflectionWithoutLoad, "deflection_without_load", "m", ONE, Larger, Unloaded, "how far the tool without a load is from where it is commanded: by own weight, other loads of the model and its deviations";
    Rotation, "rotation", "rad", ONE, Larger, Rest, "how far the tool turns under the load";
    RotationXyz, "rotation_xyz", "rad", THREE, LargerSize, Rest, "rotation vector of the tool under the load, base axes";
    Commands, "commands", "m or rad", Width::Actuators, Neither, Posture, "commands of the actuators";
    JointEfforts, "joint_efforts", "N or N m", Width::Actuators, LargerSize, Rest, "forces or torques of the loads on the actuators";
    EffortShare, "effort_share", "1", ONE, Larger, Rest, "largest share of an actuator's effort in its rated one, of those that state a rating";
    ShareToBuckling, "share_to_buckling", "1", ONE, Larger, Stability, "largest share of the way to buckling of all limbs; below 1 their shapes hold";
    Margin, "margin", "1", ONE, Smaller, Stability, "what is left to buckling, 1 - share_to_buckling, and no more than 0 where the equilibrium is not stable";
    SingularityDistance, "singularity_distance", "1", ONE, Smaller, Posture, "smallest singular value of the Jacobian between actuators and the motions that they drive, as a share of the largest, 0 where a motion is lost or held by nothing; angles are multiplied with the natural length of the machine; of machines with drives";
    Stable, "stable", "1", ONE, Smaller, Stability, "1 where the equilibrium under the load is stable, 0 where it is not";
    F1, "f1", "Hz", ONE, Smaller, Modes, "first natural frequency about the equilibrium under the load, the tool free; below 0 where the equilibrium is unstable, 0 where a direction is free";
    F2, "f2", "Hz", ONE, Smaller, Modes, "second natural frequency about the equilibrium under the load, the tool free; signs as of f1";
    F3, "f3", "Hz", ONE, Smaller, Modes, "third natural frequency about the equilibrium under the load, the tool free; signs as of f1";
    F4, "f4", "Hz", ONE, Smaller, Modes, "fourth natural frequency about the equilibrium under the load, the tool free; signs as of f1";
    F5, "f5", "Hz", ONE, Smaller, Modes, "fifth natural frequency about the equilibrium under the load, the tool free; signs as of f1";
    F6, "f6", "Hz", ONE, Smaller, Modes, "sixth natural frequency about the equilibrium under the load, the tool free; signs as of f1";
    NaturalFrequencies, "natural_frequencies", "Hz", Width::Fixed(6), Smaller, Modes, "f1 to f6";
];

impl Variable {
    /// The variable of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let own = VARIABLES.iter().find(|entry| entry.name == name);
        own.map(|entry| entry.variable)
    }

    /// Row of the table, which has one for each in the order of their declaration.
    #[must_use]
    pub fn entry(self) -> &'static Entry {
        &VARIABLES[self as usize]
    }

    /// Number of columns in a machine of so many actuators.
    #[must_use]
    pub fn width(self, actuators: usize) -> usize {
        match self.entry().width {
            Width::Fixed(width) => width,
            Width::Actuators => actuators,
        }
    }

    pub(crate) fn needs(self) -> Needs {
        self.entry().needs
    }

    /// True if it is defined only for a machine with compliance.
    #[must_use]
    pub fn needs_stiffness(self) -> bool {
        self.needs() >= Needs::Stiffness
    }

    /// True if it is defined only under a load.
    #[must_use]
    pub fn needs_load(self) -> bool {
        self.needs() >= Needs::Rest
    }

    /// True if it is defined only for a machine with drives.
    #[must_use]
    pub fn needs_drives(self) -> bool {
        self == Self::SingularityDistance
    }

    /// True if it is defined only for a machine with masses ([`kinetostat_dynamics::check_masses`]).
    #[must_use]
    pub fn needs_mass(self) -> bool {
        self.needs() == Needs::Modes
    }

    /// Takes the worse of two values, column by column; what does not exist is the worst.
    pub fn worsen(self, own: &mut [f64], other: &[f64]) {
        for (own, other) in own.iter_mut().zip(other) {
            if own.is_nan() || other.is_nan() {
                *own = f64::NAN;
                continue;
            }
            *own = match self.entry().worse {
                Worse::Smaller => smaller(*own, *other),
                Worse::Larger => larger(*own, *other),
                Worse::LargerSize if other.abs() > own.abs() => *other,
                Worse::LargerSize | Worse::Neither => *own,
            };
        }
    }

    /// Number of natural frequencies that it needs.
    pub(crate) fn frequencies(self) -> usize {
        match self {
            Self::F1 => 1,
            Self::F2 => 2,
            Self::F3 => 3,
            Self::F4 => 4,
            Self::F5 => 5,
            Self::F6 | Self::NaturalFrequencies => 6,
            _ => 0,
        }
    }

    /// Writes its columns at a place.
    pub(crate) fn write(self, place: &Solved, out: &mut [f64]) {
        match self {
            Self::StiffnessX => out[0] = place.along(0),
            Self::StiffnessY => out[0] = place.along(1),
            Self::StiffnessZ => out[0] = place.along(2),
            Self::StiffnessSoftest => out[0] = place.softest(),
            Self::StiffnessStiffest => out[0] = 1.0 / principal(&place.compliance).0[2],
            Self::RotationalStiffnessX => out[0] = place.along(3),
            Self::RotationalStiffnessY => out[0] = place.along(4),
            Self::RotationalStiffnessZ => out[0] = place.along(5),
            Self::RotationalStiffnessSoftest => out[0] = place.softest_rotation(),
            Self::RotationalStiffnessStiffest => {
                out[0] = 1.0 / rotational(&place.compliance, place.length)[2];
            }
            Self::PrincipalStiffness => {
                let compliances = place.principal().0;
                out.copy_from_slice(compliances.map(|c| 1.0 / c).as_slice());
            }
            Self::PrincipalCompliance => out.copy_from_slice(place.principal().0.as_slice()),
            Self::PrincipalDirections => out.copy_from_slice(place.principal().1.as_slice()),
            Self::Deflection => out[0] = place.displacement.linear().norm(),
            Self::DeflectionXyz => out.copy_from_slice(place.displacement.linear().as_slice()),
            Self::DeflectionByLoad => {
                out[0] = (place.displacement.linear() - place.unloaded.linear()).norm();
            }
            Self::DeflectionWithoutLoad => out[0] = place.unloaded.linear().norm(),
            Self::Rotation => out[0] = place.displacement.angular().norm(),
            Self::RotationXyz => out.copy_from_slice(place.displacement.angular().as_slice()),
            Self::Commands => out.copy_from_slice(&place.commands),
            Self::JointEfforts => out.copy_from_slice(&place.efforts),
            Self::EffortShare => out[0] = place.effort_share,
            Self::ShareToBuckling => out[0] = place.share_to_buckling,
            Self::Margin => {
                let left = 1.0 - place.share_to_buckling;
                out[0] = if place.stable == 0.0 {
                    smaller(left, 0.0)
                } else {
                    left
                };
            }
            Self::SingularityDistance => out[0] = place.singularity_distance,
            Self::Stable => out[0] = place.stable,
            Self::F1 => out[0] = place.frequencies[0],
            Self::F2 => out[0] = place.frequencies[1],
            Self::F3 => out[0] = place.frequencies[2],
            Self::F4 => out[0] = place.frequencies[3],
            Self::F5 => out[0] = place.frequencies[4],
            Self::F6 => out[0] = place.frequencies[5],
            Self::NaturalFrequencies => out.copy_from_slice(&place.frequencies),
        }
    }
}
