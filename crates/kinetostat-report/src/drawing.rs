//! A drawing of a machine: its limbs as they stand, and how it moves or bends.
//!
//! Parallel projection; what is nearer covers what is behind. Links that bend are distinguished from rigid
//! ones, drives from passive joints. What moves little is drawn larger, on top of the machine.

mod limb;
mod order;
mod paint;
mod parts;
mod scene;
mod symbol;
#[cfg(test)]
mod tests;
mod view;

pub use parts::{Scene, ShownPose};

use kinetostat::machine::MechanismState;
use kinetostat::model::Element;
use kinetostat::{Chain, Limb, Mechanism, Pose, Posture, Wrench};
use nalgebra::Vector3;

use crate::drawing::limb::step;

/// Places nearer than this are one, m.
const SAME_PLACE: f64 = 1e-9;

/// Limbs as lines only, for pictures that others draw.
impl Placed {
    /// Each limb as a line through its joints and the ends of its links, from one platform to the other; base axes, m.
    #[must_use]
    pub fn limb_lines(&self, mechanism: &Mechanism) -> Vec<Vec<Vector3<f64>>> {
        let limbs = mechanism.limbs().iter().enumerate();
        limbs.map(|(i, limb)| self.line(i, limb)).collect()
    }

    fn line(&self, index: usize, limb: &Limb) -> Vec<Vector3<f64>> {
        let chain = self.chain(limb);
        let elements = chain.elements();
        let mut pose = self.platforms[limb.from];
        let mut places = vec![pose.translation.vector];
        for element in elements {
            match element {
                Element::Rigid(offset) => pose *= *offset,
                Element::Motion(motion) => {
                    pose *= step(motion, &self.coordinates[index], &self.commands[index]).1;
                }
                Element::Node(_) => {}
            }
            places.push(pose.translation.vector);
        }
        // A centre of mass is reached by an offset and left by its inverse: the line does not go there. One without an offset
        // lies on the line already.
        let apart = |a: usize, b: usize| match (places.get(a), places.get(b)) {
            (Some(a), Some(b)) => (a - b).norm() > SAME_PLACE,
            _ => true,
        };
        let aside = |node: usize| {
            let mass = matches!(elements.get(node), Some(Element::Node(n)) if chain.bodies().iter().any(|b| b.node == *n));
            mass && node > 0 && !apart(node - 1, node + 2)
        };
        // Place k lies before element k.
        let mut line: Vec<Vector3<f64>> = Vec::new();
        for (k, &here) in places.iter().enumerate() {
            let to_mass = aside(k) || k.checked_sub(1).is_some_and(aside);
            if !to_mass
                && line
                    .last()
                    .is_none_or(|last| (here - last).norm() > SAME_PLACE)
            {
                line.push(here);
            }
        }
        let tip = self.platforms[limb.to].translation.vector;
        if line
            .last()
            .is_none_or(|last| (tip - last).norm() > SAME_PLACE)
        {
            line.push(tip);
        }
        line
    }
}

/// Direction of view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Obliquely from above: the one of several directions in which the least coincides.
    Iso,
    /// View along y of the base: x to the right, z up.
    Front,
    /// View against x of the base: y to the right, z up.
    Side,
    /// View from above: x to the right, y up.
    Top,
}

/// A state of a machine: where its platforms are and how its joints stand.
#[derive(Clone, Debug)]
pub struct Placed {
    /// Poses of all platforms, base from platform, the base first.
    pub platforms: Vec<Pose>,
    /// Coordinates of every limb, m or rad.
    pub coordinates: Vec<Vec<f64>>,
    /// Commands of every limb, m or rad.
    pub commands: Vec<Vec<f64>>,
    /// The machine as built, with its deviations; else as drawn.
    pub as_built: bool,
}

impl Placed {
    /// The nominal machine at a posture, springs at rest.
    #[must_use]
    pub fn at(posture: &Posture) -> Self {
        Self::of(posture, &posture.rest_state(), false)
    }

    /// The machine as built in a state that was solved for.
    #[must_use]
    pub fn solved(posture: &Posture, state: &MechanismState) -> Self {
        Self::of(posture, state, true)
    }

    fn of(posture: &Posture, state: &MechanismState, as_built: bool) -> Self {
        Self {
            platforms: state.platforms.clone(),
            coordinates: state.coordinates.clone(),
            commands: posture.limbs().iter().map(|l| l.commands.clone()).collect(),
            as_built,
        }
    }

    pub(crate) fn chain<'a>(&self, limb: &'a Limb) -> &'a Chain {
        if self.as_built {
            &limb.actual
        } else {
            &limb.nominal
        }
    }
}

/// Magnification of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Magnified {
    /// Given factor.
    Times(f64),
    /// Round factor that makes it well visible.
    Round,
    /// Factor that makes it well visible: the motion is a direction, without a size.
    Direction,
}

/// A motion of the machine, drawn over it.
#[derive(Clone, Debug)]
pub struct Moved {
    /// State at the start of the motion (usually, but not always, the state that is drawn).
    pub from: Placed,
    /// State at its end, close by; the motion is continued along straight lines.
    pub to: Placed,
    /// Magnification.
    pub magnified: Magnified,
    /// Name in the legend: `deflection`, say.
    pub name: String,
}

impl Moved {
    /// From a posture, springs at rest, to its equilibrium under a load.
    #[must_use]
    pub fn deflected(posture: &Posture, state: &MechanismState, magnified: Magnified) -> Self {
        Self {
            from: Placed::at(posture),
            to: Placed::solved(posture, state),
            magnified,
            name: "deflected".to_owned(),
        }
    }
}

/// A drawing of a machine.
#[derive(Clone, Debug)]
pub struct Drawing<'m> {
    /// The machine.
    pub mechanism: &'m Mechanism,
    /// State of the machine.
    pub placed: Placed,
    /// Title above the drawing.
    pub title: String,
    /// Note below the title.
    pub note: String,
    /// Direction of view; if there is none, square to a machine in one plane, obliquely else.
    pub view: Option<View>,
    /// A motion drawn over it.
    pub moved: Option<Moved>,
    /// Motions of all drawings of a set, this one's included: they share direction of view and scale. Empty for a drawing alone.
    pub set: &'m [Moved],
    /// Force and moment on the tool, drawn as arrows; base axes, N and N m.
    pub applied: Option<Wrench>,
}

impl<'m> Drawing<'m> {
    /// The machine at a posture.
    #[must_use]
    pub fn of(mechanism: &'m Mechanism, placed: Placed) -> Self {
        Self {
            mechanism,
            placed,
            title: mechanism.name().to_owned(),
            note: String::new(),
            view: None,
            moved: None,
            set: &[],
            applied: None,
        }
    }
}
