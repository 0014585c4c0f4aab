//! A drilling cycle as it was defined: 200, 201, 203 and the pecking of cycle 1.

/// A block of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Stroke {
    /// To a coordinate of the tool's axis, in the program's unit, at a feed; none in rapid traverse.
    To(f64, Option<f64>),
    /// By a step along the tool's axis.
    By(f64, Option<f64>),
    /// Dwell, s.
    Dwell(f64),
}

/// The feed at which a cycle retracts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Retract {
    Rapid,
    Feed(f64),
}

/// A cycle as it was defined, in the program's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hole {
    /// 200, 201, 203 or 1.
    pub cycle: u32,
    /// Q200.
    pub clearance: f64,
    /// Q201, negative downwards.
    pub depth: f64,
    /// Q206.
    pub feed: f64,
    /// Q202.
    pub peck: f64,
    /// Q203.
    pub surface: f64,
    /// Q204.
    pub second: f64,
    /// Q210, s.
    pub dwell_above: f64,
    /// Q211, s.
    pub dwell_below: f64,
    /// Q208.
    pub retract: Retract,
    /// Q212.
    pub less: f64,
    /// Q205.
    pub least: f64,
    /// Q213.
    pub breaks: f64,
    /// Q256.
    pub back: f64,
    /// Length of the program's unit.
    pub unit_mm: f64,
}

impl Hole {
    /// Of cycle 1, by the numbers of its lines.
    pub(crate) fn pecked(lines: &[Option<f64>; 6], unit_mm: f64) -> Self {
        let own = |line: usize| lines[line].unwrap_or(0.0);
        Self {
            cycle: 1,
            clearance: own(1),
            depth: own(2),
            feed: own(5),
            peck: own(3).abs(),
            surface: 0.0,
            second: 0.0,
            dwell_above: 0.0,
            dwell_below: own(4),
            retract: Retract::Rapid,
            less: 0.0,
            least: 0.0,
            breaks: 0.0,
            back: 0.0,
            unit_mm,
        }
    }

    /// Of cycles 200, 201 and 203, by the values of their parameters.
    pub(crate) fn drilled(
        cycle: u32,
        value: impl Fn(&str) -> f64,
        retract: Retract,
        unit_mm: f64,
    ) -> Self {
        let only = |is: bool, name: &str| match is {
            true => value(name),
            false => 0.0,
        };
        Self {
            cycle,
            clearance: value("Q200"),
            depth: value("Q201"),
            feed: value("Q206"),
            peck: only(cycle != 201, "Q202").abs(),
            surface: value("Q203"),
            second: value("Q204"),
            dwell_above: only(cycle != 201, "Q210"),
            dwell_below: value("Q211"),
            retract,
            less: only(cycle == 203, "Q212"),
            least: value("Q205"),
            breaks: value("Q213"),
            back: value("Q256"),
            unit_mm,
        }
    }
}
