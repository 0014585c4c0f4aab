//! Machines, random numbers and experiments of the reference values for identification.

use kinetostat_identification::{
    Observation, Prediction, Reading, TestLoad, Theory, Unknowns, predict,
};
use kinetostat_model::Model;
use kinetostat_testing as _;
use nalgebra::{Vector3, vector};

/// splitmix64 with normals in pairs, as the reference values prescribe.
pub struct Random {
    state: u64,
    waiting: Option<f64>,
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Self {
            state: seed,
            waiting: None,
        }
    }

    pub fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 11) as f64 * 2.0_f64.powi(-53)
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn within(&mut self, low: f64, high: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(low, high))
    }

    pub fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.between(-size, size))
    }

    pub fn normal(&mut self) -> f64 {
        if let Some(waiting) = self.waiting.take() {
            return waiting;
        }
        let (u1, u2) = (1.0 - self.unit(), self.unit());
        let r = (-2.0 * u1.ln()).sqrt();
        let angle = std::f64::consts::TAU * u2;
        self.waiting = Some(r * angle.sin());
        r * angle.cos()
    }
}

/// Compliances of the joints of arm H6, rad/(N m).
pub const H6: [f64; 6] = [0.25e-6, 0.30e-6, 0.40e-6, 3.0e-6, 3.3e-6, 2.4e-6];
/// Tool point in the flange, m.
pub const TOOL: Vector3<f64> = vector![0.25, 0.10, -0.05];
/// Markers in the flange, m.
pub const MARKERS: [Vector3<f64>; 3] = [
    vector![0.30, 0.12, 0.10],
    vector![0.28, -0.15, 0.05],
    vector![0.22, 0.02, -0.18],
];
const TRACKER: Vector3<f64> = vector![4.0, -3.0, 1.0];
/// Axis and point of every joint in the zero posture.
pub const JOINTS: [(&str, [f64; 3]); 6] = [
    ("z", [0.0, 0.0, 0.0]),
    ("y", [0.35, 0.0, 0.75]),
    ("y", [0.35, 0.0, 2.0]),
    ("x", [0.35, 0.0, 1.945]),
    ("y", [1.85, 0.0, 1.945]),
    ("x", [1.85, 0.0, 1.945]),
];
pub const FLANGE: [f64; 3] = [2.08, 0.0, 1.945];
/// Masses: kg, and the centre in the zero posture.
const WEIGHTS: [(f64, [f64; 3]); 6] = [
    (400.0, [0.10, 0.02, 0.55]),
    (320.0, [0.35, -0.05, 1.35]),
    (260.0, [0.55, 0.03, 2.0]),
    (60.0, [1.45, 0.0, 1.945]),
    (40.0, [1.87, 0.02, 1.945]),
    (30.0, [2.02, 0.0, 1.945]),
];

fn from(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| b[k] - a[k])
}

/// A serial arm in a model file: joints with stiffnesses, with bodies if there are weights, `behind` each joint further elements.
pub fn arm(
    joints: &[(&str, [f64; 3])],
    flange: [f64; 3],
    compliances: &[f64],
    weights: bool,
    behind: &dyn Fn(usize) -> String,
) -> Model {
    let mut elements = behind(0);
    let mut at = [0.0; 3];
    for (i, (axis, point)) in joints.iter().enumerate() {
        elements += &format!(
            "  {{ rigid = {{ translation_m = {:?} }}, name = \"link {i}\" }},\n",
            from(at, *point)
        );
        elements += &format!(
            "  {{ actuator = \"revolute\", name = \"A{}\", axis = \"{axis}\", stiffness_n_m_per_rad = {:e} }},\n",
            i + 1,
            1.0 / compliances[i]
        );
        at = *point;
        if weights {
            let (mass, centre) = WEIGHTS[i];
            elements += &format!(
                "  {{ body = \"mass {i}\", mass_kg = {mass}, centre_of_mass_m = {:?} }},\n",
                from(at, centre)
            );
        }
        let next = joints.get(i + 1).map_or(flange, |j| j.1);
        elements += &format!(
            "  {{ rigid = {{ translation_m = {:?} }}, name = \"to end {i}\" }},\n",
            from(at, next)
        );
        at = next;
        elements += &behind(i + 1);
    }
    let gravity = if weights { -9.81 } else { 0.0 };
    let text = format!(
        "schema = 1\n[mechanism]\nname = \"arm\"\ngravity_m_per_s2 = [0, 0, {gravity:?}]\n[[platform]]\nname = \"tool\"\nhome = {{ position_m = {flange:?} }}\n[chain.arm]\nelements = [\n{elements}]\n[[limb]]\nname = \"arm\"\nfrom = \"base\"\nto = \"tool\"\nchain = \"arm\"\n"
    );
    match Model::from_toml(&text, "arm.toml") {
        Ok(model) => model,
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// Arm H6.
pub fn h6(weights: bool) -> Model {
    arm(&JOINTS, FLANGE, &H6, weights, &|_| String::new())
}

/// Ranges of the joints of H6, degrees.
pub const RANGES: [(f64, f64); 6] = [
    (-150.0, 150.0),
    (-60.0, 60.0),
    (-70.0, 80.0),
    (-170.0, 170.0),
    (-110.0, 110.0),
    (-170.0, 170.0),
];

/// Six joint angles within the ranges of H6, rad.
pub fn angles(random: &mut Random) -> Vec<f64> {
    let ranges = RANGES.iter();
    ranges
        .map(|(low, high)| random.between(*low, *high).to_radians())
        .collect()
}

/// An observation with readings of zero: what a machine shows there is asked of the prediction.
pub fn asked(
    posture: usize,
    commands: Vec<f64>,
    load: TestLoad,
    readings: Vec<Reading>,
) -> Observation {
    Observation {
        posture: posture.to_string(),
        commands,
        load,
        branch: None,
        readings,
    }
}

/// What the machine of the unknowns shows, as if it had been read, with noise drawn reading by reading.
pub fn read(
    unknowns: &Unknowns,
    observations: &mut [Observation],
    theory: Theory,
    mut noise: impl FnMut(&Reading) -> f64,
) -> anyhow::Result<()> {
    let shown = predict(unknowns, &unknowns.nominal(), observations, theory)?;
    put(observations, &shown, &mut noise);
    Ok(())
}

/// Puts what is shown into the readings, with noise.
pub fn put(
    observations: &mut [Observation],
    shown: &[Prediction],
    noise: &mut impl FnMut(&Reading) -> f64,
) {
    for (observation, prediction) in observations.iter_mut().zip(shown) {
        for (reading, value) in observation
            .readings
            .iter_mut()
            .zip(prediction.values.iter())
        {
            reading.value = value + noise(reading);
        }
    }
}

/// Postures of H6 with a force up to 2 kN at the tool point each, three markers known to 20 um.
pub fn pulls(random: &mut Random, count: usize) -> Vec<Observation> {
    let pull = |i| {
        let commands = angles(random);
        let load = TestLoad::force_at(TOOL, random.vector(2000.0));
        asked(i, commands, load, three_markers(20e-6))
    };
    (0..count).map(pull).collect()
}

/// Readings of the displacements of three markers.
pub fn three_markers(deviation: f64) -> Vec<Reading> {
    MARKERS
        .iter()
        .flat_map(|m| Reading::displacement(*m, &Vector3::zeros(), deviation))
        .collect()
}

/// Standard deviation of a laser tracker for a marker there (base axes, m).
pub fn tracker(marker: &Vector3<f64>) -> f64 {
    15e-6 + 6e-6 * (marker - TRACKER).norm()
}

/// Largest relative difference, an error where a number is missing.
pub fn worst(found: &[f64], wanted: &[f64]) -> f64 {
    assert_eq!(found.len(), wanted.len());
    let each = found.iter().zip(wanted).map(|(f, w)| ((f - w) / w).abs());
    each.fold(
        0.0,
        |worst, x| if x.is_nan() || worst < x { x } else { worst },
    )
}
