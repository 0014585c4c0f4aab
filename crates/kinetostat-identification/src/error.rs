//! Errors of an identification.

use kinetostat_model::ModelError;

/// Reason why there is no identification.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IdentificationError {
    /// The model refuses a number.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The machine has no equilibrium in a posture.
    #[error("posture '{posture}': {reason}")]
    Posture {
        /// Name of the posture.
        posture: String,
        /// What the machine says.
        reason: kinetostat::Error,
    },
    /// A pattern that names nothing.
    #[error("no number of the model is called '{pattern}'; numbers that deflections show are, for instance, {}", examples.join(", "))]
    NoNumber {
        /// The pattern.
        pattern: String,
        /// Some that exist.
        examples: Vec<String>,
    },
    /// A number that is not identified from deflections.
    #[error(
        "'{path}' is a {kind} and cannot be identified from deflections; stiffnesses, moduli, lengths, angles and masses can"
    )]
    NotIdentified {
        /// Path of the number.
        path: String,
        /// Kind of the quantity.
        kind: &'static str,
    },
    /// Readings of the tool need a tangent that has a solution.
    #[error("posture '{posture}': a motion that nothing holds lies along the load or a reading")]
    Free {
        /// Name of the posture.
        posture: String,
    },
    /// No progress.
    #[error(
        "the fit did not settle after {steps} steps: the last one still changed a number by {change:.1e} of its size; posture '{posture}' is farthest from it: look at its load and joints, or weigh what is far off less (robust), or start from a model that is nearer"
    )]
    NotConverged {
        /// Steps made.
        steps: usize,
        /// Last change, relative.
        change: f64,
        /// The posture that is farthest from the last step.
        posture: String,
    },
    /// A number of geometry or loads, which small loads do not show.
    #[error(
        "'{path}' is no spring: it changes a deflection only through loaded equilibria; leave out the restriction to small loads"
    )]
    NeedsLoads {
        /// Path of the number.
        path: String,
    },
    /// Places under small loads.
    #[error(
        "posture '{posture}': the place of a marker depends on the weights; leave out the restriction to small loads"
    )]
    PlacesNeedLoads {
        /// Name of the posture.
        posture: String,
    },
    /// A marker far from where it should be.
    #[error(
        "posture '{posture}': a place lies {distance:.2} m from where the model has it, which no errors of links explain; look at the unit of the places, at the frame in which they are (that of the base is needed), and at the markers"
    )]
    FarPlace {
        /// Name of the posture.
        posture: String,
        /// Along one axis, m.
        distance: f64,
    },
    /// A body of a limb without an element at which the file could state its error.
    #[error(
        "limb '{limb}': no rigid element or link in front of '{joint}' has a name, so that the model cannot state an error of the geometry there; give one a name, or add one with an offset of zero"
    )]
    NoPlace {
        /// Name of the limb.
        limb: String,
        /// The joint behind the body.
        joint: String,
    },
    /// The constrained least squares have no solution.
    #[error(transparent)]
    Constraints(#[from] crate::cone::NotSolved),
    /// Nothing to fit.
    #[error("there are no readings")]
    NoReadings,
}
