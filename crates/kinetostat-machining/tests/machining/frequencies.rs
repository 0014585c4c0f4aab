//! Natural frequencies as variables of maps: reference values, a closed form up to and beyond the load at which it falls.

use kinetostat::Wrench;
use kinetostat_machining::{
    Grid, MapPlace, MapTask, PlaceState, RunError, Unwatched, Variable, map,
};
use kinetostat_model::Model;
use nalgebra::{UnitQuaternion, Vector3, vector};

const ARM6: &str = include_str!("../../../kinetostat-cli/tests/cli/vibration_models/arm6.toml");

/// A mast of 0.5 m on a hinge, 5 kg at its end, on three slides so stiff that they do not count.
const MAST: &str = r#"
schema = 1
[mechanism]
name = "mast"
gravity_m_per_s2 = [0, 0, 0]
[[platform]]
name = "head"
home = { position_m = [0.2, 0.1, 0.5] }
mass_kg = 5
[chain.mast]
elements = [
  { actuator = "prismatic", name = "x", axis = "x", stiffness_n_per_mm = 1e9, home_mm = 200 },
  { actuator = "prismatic", name = "y", axis = "y", stiffness_n_per_mm = 1e9, home_mm = 100 },
  { actuator = "prismatic", name = "z", axis = "z", stiffness_n_per_mm = 1e9, home_mm = 0 },
  { actuator = "revolute", name = "hinge", axis = "x", stiffness_n_m_per_rad = 1000, home_rad = 0 },
  { rigid = { translation_m = [0, 0, 0.5] } },
]
[[limb]]
name = "mast"
from = "base"
to = "head"
chain = "mast"
"#;

fn places(text: &str, variables: &[Variable], counts: [usize; 3], load: Wrench) -> Vec<MapPlace> {
    let model = Model::from_toml(text, "model.toml").expect("a model");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let at = home.translation.vector * 1e3;
    let task = MapTask {
        mechanism: &model.mechanism,
        grid: Grid {
            from_mm: at.into(),
            to_mm: (at + vector![70.0, 0.0, -90.0]).into(),
            counts,
        },
        orientation: home.rotation,
        orientation_follows: false,
        load: Some(load),
        further: Vec::new(),
        variables: variables.to_vec(),
        ratings: model.ratings(),
        first: 0,
    };
    let mut list = Vec::new();
    map(&task, &Unwatched, <[MapPlace]>::to_vec, |own| {
        list.extend(own);
        Ok::<(), RunError>(())
    })
    .expect("a map");
    list
}

fn push(z: f64) -> Wrench {
    Wrench::new(vector![0.0, 0.0, z], Vector3::zeros())
}

#[test]
fn a_place_of_the_map_has_the_frequencies_of_the_reference_arm() {
    // dynamics-reference-values.md, D3.
    for (force, expected) in [
        (
            0.0,
            [
                9.98746752, 11.5425353, 23.2012812, 49.0179614, 53.7168096, 126.52171,
            ],
        ),
        (
            -9000.0,
            [
                10.0068189, 11.523062, 23.1889537, 49.2481057, 53.8574826, 126.550804,
            ],
        ),
    ] {
        let variables = [
            Variable::F1,
            Variable::F4,
            Variable::NaturalFrequencies,
            Variable::Stable,
        ];
        let found = places(ARM6, &variables, [3, 1, 2], push(force));
        assert_eq!(found.len(), 6);
        let values = &found[0].values;
        assert_eq!(values[0], values[2]);
        assert_eq!(values[1], values[5]);
        for (own, expected) in values[2..8].iter().zip(expected) {
            assert!((own / expected - 1.0).abs() < 1e-8, "{values:?}");
        }
        // Elsewhere it vibrates otherwise, and what the general engine knows is there, too.
        for place in &found {
            assert_eq!(place.state, PlaceState::Regular);
            assert!(place.smallest_stiffness_n_per_mm > 100.0 && place.values[8] == 1.0);
        }
        assert!((found[5].values[0] / expected[0] - 1.0).abs() > 1e-3);
    }
}

#[test]
fn an_unstable_place_has_a_negative_frequency_and_is_counted_as_unstable() {
    // w^2 = (k - P l) / (m l^2), the load dead and along the mast: no equilibrium but the straight one is near.
    for force in [0.0, 1500.0, 1999.0, 2500.0, 6000.0] {
        let found = places(
            MAST,
            &[Variable::F1, Variable::NaturalFrequencies],
            [1, 1, 1],
            push(-force),
        );
        let (squared, own) = ((1000.0 - 0.5 * force) / 1.25, found[0].values[0]);
        let hertz = f64::abs(squared).sqrt().copysign(squared) / std::f64::consts::TAU;
        assert!(
            (own - hertz).abs() < 1e-5 * hertz.abs().max(1.0),
            "{force}: {own} {hertz}"
        );
        let state = match force < 2000.0 {
            true => PlaceState::Regular,
            false => PlaceState::Unstable,
        };
        assert_eq!(found[0].state, state, "{force}");
        // Five directions have no mass, and slides of a point mass have three: what does not exist is no number.
        assert!(
            found[0].values[1..]
                .iter()
                .filter(|x| x.is_finite())
                .count()
                < 6
        );
    }
}

#[test]
fn the_worst_of_several_loads_is_the_lowest_frequency() {
    let model = Model::from_toml(MAST, "mast.toml").expect("a model");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let at: [f64; 3] = (home.translation.vector * 1e3).into();
    let task = MapTask {
        mechanism: &model.mechanism,
        grid: Grid {
            from_mm: at,
            to_mm: at,
            counts: [1, 1, 1],
        },
        orientation: UnitQuaternion::identity(),
        orientation_follows: false,
        load: Some(push(500.0)),
        further: vec![
            (home.rotation, Some(push(-2500.0))),
            (home.rotation, Some(push(-1000.0))),
        ],
        variables: vec![Variable::F1],
        ratings: model.ratings(),
        first: 0,
    };
    let mut worst = f64::NAN;
    map(&task, &Unwatched, <[MapPlace]>::to_vec, |own| {
        worst = own[0].values[0];
        Ok::<(), RunError>(())
    })
    .expect("a map");
    let expected = -(250.0_f64 / 1.25).sqrt() / std::f64::consts::TAU;
    assert!((worst - expected).abs() < 1e-5, "{worst} {expected}");
}
