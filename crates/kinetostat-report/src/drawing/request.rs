//! Request for a drawing: a machine in a state, the view, and its displaced shape.

use kinetostat::{Chain, Limb, Mechanism, Pose, Posture, Wrench, machine::MechanismState};

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
            applied: None,
        }
    }
}
