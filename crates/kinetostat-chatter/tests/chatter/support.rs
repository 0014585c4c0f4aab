//! Tools and cuts of the reference values, section D5.

use kinetostat_chatter::{Arc, Coefficients, Milled, MillingCut, Mode, Regeneration, ToolResponse};
use nalgebra::Vector3;

pub const X: Vector3<f64> = Vector3::new(1.0, 0.0, 0.0);
pub const Y: Vector3<f64> = Vector3::new(0.0, 1.0, 0.0);

pub fn one_mode(direction: Vector3<f64>) -> Mode {
    Mode::along(direction, 0.03993, 922.0, 0.011).unwrap()
}

/// One direction (feed) of D5.
pub fn one_direction() -> ToolResponse {
    ToolResponse::new(vec![one_mode(X)]).unwrap()
}

pub fn two_directions() -> ToolResponse {
    ToolResponse::new(vec![one_mode(X), one_mode(Y)]).unwrap()
}

pub fn two_modes() -> ToolResponse {
    let x = Mode::with_stiffness(X, 5.59e6, 603.0, 0.039).unwrap();
    let y = Mode::with_stiffness(Y, 5.715e6, 666.0, 0.035).unwrap();
    ToolResponse::new(vec![x, y]).unwrap()
}

pub fn arc(name: &str, immersion: f64) -> Arc {
    match name {
        "slot" => Arc::slot(),
        "up" => Arc::straight(Milled::Up, immersion).unwrap(),
        "down" => Arc::straight(Milled::Down, immersion).unwrap(),
        other => panic!("{other}"),
    }
}

pub fn cut(teeth: usize, arc: Arc, coefficients: Coefficients) -> MillingCut {
    MillingCut::new(teeth, arc, coefficients).unwrap()
}

pub fn aluminium() -> Coefficients {
    Coefficients::new(6e8, 2e8, 0.0).unwrap()
}

pub fn regeneration(tool: ToolResponse, cut: MillingCut) -> Regeneration {
    Regeneration::new(tool, cut.into()).unwrap()
}

/// Mode, a/D, and limits in mm at 5000, 7000, 9000, 12000, 14000, 17000, 21000 rpm: exact, zeroth order.
pub const SPEEDS: [f64; 7] = [5000.0, 7000.0, 9000.0, 12000.0, 14000.0, 17000.0, 21000.0];
pub type Row = (&'static str, f64, [f64; 7], [f64; 7]);
pub const ONE_DIRECTION: [Row; 7] = [
    (
        "slot",
        1.0,
        [
            0.408628, 1.151994, 3.009212, 2.149308, 2.140013, 0.401360, 2.256122,
        ],
        [
            0.369919, 1.113765, 2.129513, 1.431352, 2.072877, 0.356293, 2.281281,
        ],
    ),
    (
        "up",
        0.5,
        [
            0.260279, 0.772245, 1.601949, 1.060274, 1.436275, 0.251865, 1.325139,
        ],
        [
            0.254252, 0.765512, 1.463653, 0.983795, 1.424727, 0.244887, 1.567966,
        ],
    ),
    (
        "down",
        0.5,
        [
            0.847204, 2.550570, 1.564793, 0.613091, 3.090525, 1.447859, 0.617506,
        ],
        [
            0.921829, 3.374716, 1.599953, 0.647972, 6.385221, 2.794410, 0.668175,
        ],
    ),
    (
        "up",
        0.1,
        [
            1.026452, 2.906309, 6.073735, 3.180176, 5.272913, 1.044698, 4.270647,
        ],
        [
            0.934568, 2.813827, 5.380021, 3.616181, 5.236936, 0.900143, 5.763448,
        ],
    ),
    (
        "down",
        0.1,
        [
            1.296263, 2.987822, 2.441055, 0.942951, 6.026012, 1.965901, 1.007058,
        ],
        [
            1.437516, 5.262588, 2.494993, 1.010458, 9.957220, 4.357649, 1.041964,
        ],
    ),
    (
        "up",
        0.05,
        [
            2.146233, 5.830940, 11.266987, 6.233241, 10.232231, 2.172492, 7.113133,
        ],
        [
            1.848399, 5.565219, 10.640665, 7.152123, 10.357670, 1.780313, 11.399012,
        ],
    ),
    (
        "down",
        0.05,
        [
            2.206918, 4.846875, 4.316462, 1.680517, 13.000300, 3.331443, 1.841235,
        ],
        [
            2.576859, 9.433601, 4.472471, 1.811326, 17.849097, 7.811428, 1.867801,
        ],
    ),
];

/// Arc, a/D, rpm, exact and zeroth order in mm: two directions with the mode of one.
pub const TWO_DIRECTIONS: [(&str, f64, f64, f64, f64); 4] = [
    ("up", 1.0, 6000.0, 0.048348, 0.049484),
    ("up", 0.5, 6000.0, 0.127364, 0.129364),
    ("down", 0.5, 6000.0, 0.127364, 0.129364),
    ("down", 0.1, 11000.0, 1.006625, 1.050267),
];

/// Arc, a/D, rpm, exact and zeroth order in mm, chatter frequency of zeroth order: two different modes, three teeth.
pub const TWO_MODES: [(&str, f64, f64, f64, f64, f64); 5] = [
    ("up", 1.0, 4000.0, 0.990997, 0.959300, 666.0956),
    ("up", 1.0, 9000.0, 0.804952, 0.800725, 649.2660),
    ("up", 0.5, 4000.0, 1.481809, 1.419336, 658.7106),
    ("up", 0.5, 9000.0, 1.123476, 1.116571, 644.4278),
    ("down", 0.5, 9000.0, 3.359252, 3.877294, 660.8422),
];

/// The arc of a straight cut along the side of a tool.
pub fn arc_of(engagement: &kinetostat_cutting::Engagement) -> Arc {
    let contact = &engagement.contacts[0];
    Arc::new(contact.entry, contact.exit).unwrap()
}
