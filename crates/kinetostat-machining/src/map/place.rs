//! A place and its state.

use kinetostat::chain::FoundBy;

/// State of a place and of its answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceState {
    /// Every direction is held, and under a load the equilibrium is stable.
    Regular,
    /// A direction has no stiffness.
    Singular,
    /// The equilibrium under the load is not stable.
    Unstable,
    /// An actuator would be outside its limits, of an arm in every configuration that is found. There are no figures.
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
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlace {
    /// Number along x, y and z.
    pub index: [usize; 3],
    /// Position of the tool's reference point, base axes, mm.
    pub position_mm: [f64; 3],
    /// State of the answer.
    pub state: PlaceState,
    /// Force that moves the tool's tip by 1 mm in its softest direction while the tool may turn,
    /// N/mm: zero if a direction is free, negative if the tool runs away.
    pub smallest_stiffness_n_per_mm: f64,
    /// Stiffness for a force along x, y and z (base axes), by the motion along it, N/mm.
    pub stiffness_n_per_mm: [f64; 3],
    /// Rotation of the unloaded tool from the orientation that was requested, deg: zero unless the orientation
    /// follows.
    pub tool_turn_deg: f64,
    /// Displacement from the commanded place under the load, base axes, mm.
    pub displacement_mm: [f64; 3],
    /// Rotation vector of the tool under the load, base axes, deg.
    pub rotation_deg: [f64; 3],
    /// Method by which the equilibrium under the load was found.
    pub found_by: FoundBy,
    /// Values of the further variables that were asked for, SI, one after the other.
    pub values: Box<[f64]>,
}
