//! Place of a fault, as types that a program can match.

use std::fmt;

/// Object that is described or solved, by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Whole {
    /// A mechanism, by its name.
    Mechanism(String),
    /// A chain by itself.
    Chain(String),
    /// A chain as a limb.
    Limb(String),
    /// The section of a beam.
    Section,
    /// A rule that takes out the spring of a passive joint.
    PassiveJointRule,
}

/// A part of it, by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Part {
    /// A platform of a mechanism.
    Platform(String),
    /// A limb of a mechanism.
    Limb(String),
    /// A joint or another coordinate of a chain.
    Coordinate(String),
    /// A spring of a chain.
    Spring(String),
    /// An actuator of a chain.
    Actuator(String),
    /// A link of a chain.
    Link(String),
    /// A body with mass of a chain.
    Body(String),
}

/// Place of a fault: the object, its part, and the task.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat::error::{Part, Whole};
///
/// let soft = Chain::builder("leg").spring("seat", MotionKind::Prismatic, Vector3::z(), -1e6, 0.0); // N/m
/// let error = soft.build().unwrap_err();
/// let place = error.place().expect("a spring has a place");
/// assert_eq!(*place.whole(), Whole::Chain("leg".into()));
/// assert_eq!(place.part(), Some(&Part::Spring("seat".into())));
/// assert_eq!(*place, Place::chain("leg").with_part(Part::Spring("seat".into())));
/// // A program that builds on this crate reports its own faults alike.
/// let of_limb = Place::mechanism("hexapod").with_part(Part::Limb("leg".into()));
/// assert_eq!(of_limb.to_string(), "mechanism 'hexapod': limb 'leg'");
/// assert_eq!(Place::limb("leg").to_string(), "limb 'leg'");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place(Box<Parts>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Parts {
    whole: Whole,
    part: Option<Part>,
    /// The task, if it is not just an equilibrium or a description: `compensation on `.
    task: &'static str,
    /// Detail of the part, after its name.
    detail: String,
}

impl Place {
    pub(crate) fn of(whole: Whole) -> Self {
        Self(Box::new(Parts {
            whole,
            part: None,
            task: "",
            detail: String::new(),
        }))
    }

    /// Mechanism, chain or limb.
    #[must_use]
    pub fn whole(&self) -> &Whole {
        &self.0.whole
    }

    /// Part of it, if one is at fault.
    #[must_use]
    pub fn part(&self) -> Option<&Part> {
        self.0.part.as_ref()
    }

    /// A mechanism of this name, no part of it at fault.
    #[must_use]
    pub fn mechanism(name: impl Into<String>) -> Self {
        Self::of(Whole::Mechanism(name.into()))
    }

    /// A chain by itself, no part of it at fault.
    #[must_use]
    pub fn chain(name: impl Into<String>) -> Self {
        Self::of(Whole::Chain(name.into()))
    }

    /// A chain as a limb of a mechanism, no part of it at fault.
    #[must_use]
    pub fn limb(name: impl Into<String>) -> Self {
        Self::of(Whole::Limb(name.into()))
    }

    /// A part of the same thing.
    #[must_use]
    pub fn with_part(&self, part: Part) -> Self {
        let mut place = self.clone();
        place.0.part = Some(part);
        place
    }

    /// Adds a task to the place.
    pub(crate) fn during(mut self, task: &'static str) -> Self {
        self.0.task = task;
        self
    }

    /// Adds a detail to the place.
    pub(crate) fn with_detail(mut self, detail: String) -> Self {
        self.0.detail = detail;
        self
    }
}

impl From<&Place> for Place {
    fn from(place: &Place) -> Self {
        place.clone()
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Parts {
            whole,
            part,
            task,
            detail,
        } = &*self.0;
        match whole {
            // The task says of what kind of thing it is.
            Whole::Chain(name) if *task == SHAPE_CRITERION => write!(f, "{task}'{name}'{detail}")?,
            Whole::Mechanism(name) => write!(f, "{task}mechanism '{name}'{detail}")?,
            Whole::Chain(name) => write!(f, "{task}chain '{name}'{detail}")?,
            Whole::Limb(name) => write!(f, "{task}limb '{name}'{detail}")?,
            Whole::Section => f.write_str("section")?,
            Whole::PassiveJointRule => f.write_str("passive joint rule")?,
        }
        let Some(part) = part else {
            return Ok(());
        };
        let (kind, name) = match part {
            Part::Platform(name) => ("platform", name),
            Part::Limb(name) => ("limb", name),
            Part::Coordinate(name) => ("coordinate", name),
            Part::Spring(name) => ("spring", name),
            Part::Actuator(name) => ("actuator", name),
            Part::Link(name) => ("link", name),
            Part::Body(name) => ("body", name),
        };
        write!(f, ": {kind} '{name}'")
    }
}

/// The task of the shape criterion of a chain.
pub(crate) const SHAPE_CRITERION: &str = "shape criterion of ";
