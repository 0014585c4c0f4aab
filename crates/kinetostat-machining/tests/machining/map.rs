//! A map tells at every place what the general engine tells there.

use kinetostat::{Error, Pose, Wrench, chain::FoundBy};
use kinetostat_machining::{
    Grid, MapPlace, MapTask, PlaceState, RunError, Unwatched, Variable, map, posture_at,
};
use kinetostat_model::Model;
use nalgebra::{Matrix3, UnitQuaternion, Vector3, vector};
use proptest::prelude::*;

fn all(task: &MapTask<'_>) -> Vec<MapPlace> {
    let mut list = Vec::new();
    map(task, &Unwatched, <[MapPlace]>::to_vec, |places| {
        list.extend(places);
        Ok::<(), RunError>(())
    })
    .expect("a map");
    list
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a.is_nan() && b.is_nan()) || a == b || (a - b).abs() <= tolerance * b.abs().max(1e-9)
}

#[track_caller]
fn same_as_scalar(task: &MapTask<'_>) -> Vec<PlaceState> {
    let places = all(task);
    assert_eq!(places.len(), task.grid.len());
    for place in &places {
        let position = Vector3::from(place.position_mm) * 1e-3;
        let pose = Pose::from_parts(position.into(), task.orientation);
        let posture = posture_at(task.mechanism, &pose);
        let posture = posture.and_then(|p| p.within_limits().map(|()| p));
        let posture = match posture {
            Ok(posture) => posture,
            Err(Error::OutsideLimits { .. }) => {
                assert_eq!(place.state, PlaceState::OutsideLimits, "{place:?}");
                continue;
            }
            Err(_) => {
                assert_eq!(place.state, PlaceState::Unreachable, "{place:?}");
                continue;
            }
        };
        let (compliance, tolerance) = match &task.load {
            None => {
                let k = posture.stiffness().expect("a stiffness");
                let singular = k.rank() < 6;
                assert_eq!(place.state == PlaceState::Singular, singular, "{place:?}");
                (k.compliance(), 1e-8)
            }
            Some(wrench) => {
                let e = posture.deflected_by(wrench).expect("an equilibrium");
                assert_eq!(place.state == PlaceState::Regular, e.stable(), "{place:?}");
                let direct = place.found_by == FoundBy::Directly;
                assert!(direct || place.found_by == e.found_by, "{place:?}");
                let softest = 1e-3 * e.stiffness_against_force();
                assert!(
                    near(place.smallest_stiffness_n_per_mm, softest, 1e-7),
                    "{place:?}"
                );
                for k in 0..3 {
                    let (d, r) = (e.displacement.0[k] * 1e3, e.displacement.0[3 + k]);
                    assert!((place.displacement_mm[k] - d).abs() < 1e-7, "{place:?} {d}");
                    let r = r.to_degrees();
                    assert!((place.rotation_deg[k] - r).abs() < 1e-7, "{place:?} {r}");
                }
                (e.compliance(), 1e-7)
            }
        };
        if place.state == PlaceState::Singular {
            assert_eq!(place.smallest_stiffness_n_per_mm, 0.0);
            continue;
        }
        let forces: Matrix3<f64> = compliance.springs.fixed_view::<3, 3>(0, 0).into();
        for k in 0..3 {
            let own = 1e-3 / forces[(k, k)];
            assert!(
                near(place.stiffness_n_per_mm[k], own, tolerance),
                "{place:?} {own}"
            );
        }
        if task.load.is_none() {
            let own = 1e-3 / forces.symmetric_eigenvalues().max();
            assert!(
                near(place.smallest_stiffness_n_per_mm, own, tolerance),
                "{place:?} {own}"
            );
        }
    }
    places.iter().map(|p| p.state).collect()
}

fn tilted(text: Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(text)
}

#[test]
fn every_place_is_what_the_general_engine_says() {
    for (name, from, to, turn) in [
        (
            "orthoglide",
            [-180.0, -150.0, -20.0],
            [150.0, 160.0, 40.0],
            [0.0; 3],
        ),
        (
            "heavy_6r",
            [900.0, -500.0, 500.0],
            [3200.0, 700.0, 1500.0],
            [0.2, -0.1, 0.3],
        ),
        (
            "hexapod",
            [-200.0, -150.0, 700.0],
            [180.0, 210.0, 900.0],
            [0.05, -0.1, 0.1],
        ),
    ] {
        let model = Model::preset(name).expect(name);
        let home = model.mechanism.platforms()[model.mechanism.tool()].home;
        for load in [
            None,
            Some(Wrench::new(
                vector![150.0, -80.0, -220.0],
                vector![5.0, 3.0, -8.0],
            )),
        ] {
            let task = MapTask {
                mechanism: &model.mechanism,
                grid: Grid {
                    from_mm: from,
                    to_mm: to,
                    counts: [7, 6, 3],
                },
                orientation: tilted(turn.into()) * home.rotation,
                orientation_follows: false,
                load,
                further: Vec::new(),
                variables: Vec::new(),
                ratings: Vec::new(),
                first: 0,
            };
            let states = same_as_scalar(&task);
            assert!(states.contains(&PlaceState::Regular), "{name}: {states:?}");
        }
    }
}

#[test]
fn a_singular_machine_has_no_stiffness_in_its_free_direction() {
    let model = Model::preset("stewart_gough_a").expect("a preset");
    let home = model.mechanism.platforms()[model.mechanism.tool()].home;
    let at = home.translation.vector * 1e3;
    let task = MapTask {
        mechanism: &model.mechanism,
        grid: Grid {
            from_mm: at.into(),
            to_mm: at.into(),
            counts: [1; 3],
        },
        orientation: home.rotation,
        orientation_follows: false,
        load: None,
        further: Vec::new(),
        variables: Vec::new(),
        ratings: Vec::new(),
        first: 0,
    };
    assert_eq!(same_as_scalar(&task), [PlaceState::Singular]);
}

#[test]
fn threads_change_nothing_and_a_watch_stops_it() {
    struct Stops;
    impl kinetostat_machining::Watch for Stops {
        fn stage(&self, _: &str, _: usize) {}
        fn advance(&self, _: usize) {}
        fn cancelled(&self) -> bool {
            true
        }
    }
    let model = Model::preset("orthoglide").expect("a preset");
    let task = MapTask {
        mechanism: &model.mechanism,
        grid: Grid {
            from_mm: [-100.0; 3],
            to_mm: [90.0; 3],
            counts: [13, 11, 9],
        },
        orientation: UnitQuaternion::identity(),
        orientation_follows: false,
        load: None,
        further: Vec::new(),
        variables: Vec::new(),
        ratings: Vec::new(),
        first: 0,
    };
    let bits = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let places = pool.expect("threads").install(|| all(&task));
        places
            .iter()
            .flat_map(|p| p.stiffness_n_per_mm.map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(1), bits(3));
    let stopped = map(&task, &Stops, |_| (), |()| Ok::<(), RunError>(()));
    assert!(matches!(stopped, Err(RunError::Cancelled)));
}

#[test]
fn the_distance_from_singular_is_zero_where_nothing_holds_a_motion_and_grows_beside_it() {
    let at = |preset: &str, x_mm: f64, turned_deg: f64| {
        let model = Model::preset(preset).expect("a preset");
        let home = model.mechanism.platforms()[model.mechanism.tool()].home;
        let turn = Vector3::z() * turned_deg.to_radians();
        let place = [x_mm, 7.0, 600.0];
        let task = MapTask {
            mechanism: &model.mechanism,
            grid: Grid {
                from_mm: place,
                to_mm: place,
                counts: [1; 3],
            },
            orientation: UnitQuaternion::new(turn) * home.rotation,
            orientation_follows: false,
            load: None,
            further: Vec::new(),
            variables: vec![Variable::SingularityDistance, Variable::StiffnessSoftest],
            ratings: vec![None; 6],
            first: 0,
        };
        let place = all(&task).remove(0);
        (place.state, place.values[0], place.values[1])
    };
    // Hexapod "a" of the report is singular everywhere, also at home.
    for (x_mm, turned_deg) in [(0.0, 0.0), (31.0, 0.0), (-12.5, 20.0)] {
        let (state, distance, softest) = at("stewart_gough_a", x_mm, turned_deg);
        assert_eq!(state, PlaceState::Singular);
        assert_eq!((distance, softest), (0.0, 0.0));
    }
    // Hexapod "b" is singular a quarter turn from home (Fichter): to first order the distance is proportional to the turn from there.
    let (state, distance, softest) = at("stewart_gough_b", 0.0, 90.0);
    assert_eq!(state, PlaceState::Singular);
    assert_eq!((distance, softest), (0.0, 0.0));
    let [(near, one, _), (farther, two, _)] =
        [89.5, 89.0].map(|turn| at("stewart_gough_b", 31.0, turn));
    assert_eq!((near, farther), (PlaceState::Regular, PlaceState::Regular));
    assert!(one > 0.0 && one < 0.05, "{one}");
    assert!((two / one - 2.0).abs() < 0.05, "{one} {two}");
}

proptest! {
    #[test]
    fn the_grid_has_its_ends_and_even_steps(
        from in -1e3..1e3_f64,
        step in 1e-3..1e2_f64,
        counts in prop::array::uniform3(2_usize..9),
    ) {
        let to = counts.map(|n| from + step * (n - 1) as f64);
        let grid = Grid { from_mm: [from; 3], to_mm: to, counts };
        let (mut last, mut seen) = (None, std::collections::BTreeSet::new());
        for place in 0..grid.len() {
            let index = grid.index(place);
            prop_assert!(seen.insert(index));
            // z slowest.
            let [x, y, z] = index;
            prop_assert!(last < Some([z, y, x]));
            last = Some([z, y, x]);
            for axis in 0..3 {
                let at = grid.position_mm(axis, index[axis]);
                prop_assert!((at - from - step * index[axis] as f64).abs() < 1e-9);
            }
        }
        for axis in 0..3 {
            prop_assert_eq!(grid.position_mm(axis, 0), from);
            prop_assert_eq!(grid.position_mm(axis, counts[axis] - 1), to[axis]);
        }
    }
}
