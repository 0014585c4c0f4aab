//! Several passes: what is left is cut, and nothing else.

use std::f64::consts::PI;

use kinetostat_cutting::{Engagement, Probe, Shape, Tool};
use proptest::prelude::*;

use crate::stock_support::{arc_error, block, circle, extent, flat, look, only_side};

#[test]
fn the_same_way_again_is_air() {
    let shapes = [
        Shape::Flat,
        Shape::Ball,
        Shape::Bull {
            corner_radius_mm: 1.0,
        },
        Shape::Face { lead_angle: 0.8 },
    ];
    for shape in shapes {
        let tool = Tool::new(shape, 6.0, 2).unwrap();
        for depth in [0.05, 1.0, 4.5] {
            let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.3);
            let mut probe = Probe::new(&tool);
            let z = 8.0 - depth;
            let mut places = vec![[-30.0, 3.3, z], [-3.0, 5.1, z], [4.0, -2.0, z - 0.4]];
            places.extend(circle([4.0, 3.0], 5.0, z - 0.4, [-0.5 * PI, 0.8 * PI], 40));
            let mut met = 0;
            for round in 0..2 {
                for ends in places.windows(2) {
                    for station in probe.stations(&mut stock, ends[0], ends[1]).unwrap() {
                        let air = station.engagement.is_air();
                        met += usize::from(!air);
                        // A cone that ends in a wall leaves slivers on a ramp.
                        let sliver = extent(&station.engagement) < 0.01;
                        let expected = air || sliver && matches!(shape, Shape::Face { .. });
                        assert!(
                            round == 0 || expected,
                            "{shape:?} {depth} {ends:?} {station:?}"
                        );
                    }
                }
            }
            assert!(met > 40, "{shape:?} {depth} {met}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_level_way_again_is_air(
        ways in prop::collection::vec((-9.0..9.0, -9.0..9.0), 2..8),
        depth in 0.01..3.0_f64,
        which in 0..3_usize,
    ) {
        let tool = Tool::new(SHAPES[which], 4.0, 2).unwrap();
        prop_assume!(ways.windows(2).all(is_looked_at_on_itself));
        let places: Vec<[f64; 3]> = ways.iter().map(|(x, y)| [*x, *y, -depth]).collect();
        for extent in extents_of_the_second_time(&tool, &places) {
            prop_assert_eq!(extent, 0.0);
        }
    }

    #[test]
    fn any_gentle_ramp_again_is_air_but_for_slivers(
        ways in prop::collection::vec((-9.0..9.0, -9.0..9.0), 2..8),
        rise in -0.12..0.12_f64,
        which in 0..3_usize,
    ) {
        let tool = Tool::new(SHAPES[which], 4.0, 2).unwrap();
        prop_assume!(ways.windows(2).all(is_looked_at_on_itself));
        // In a plane, up to 7 degrees.
        let places: Vec<[f64; 3]> = ways.iter().map(|(x, y)| [*x, *y, rise * x - 1.5]).collect();
        for extent in extents_of_the_second_time(&tool, &places) {
            // A cell and a quarter on the rim (0.125 rad) at each side over the whole depth (2.6 mm); of 25 000 ways one has
            // more than a cell, 1.16.
            prop_assert!(extent < 2.0 * 0.125 * 2.6, "{}", extent);
        }
    }
}

#[test]
fn a_gentle_bend_again_is_air() {
    let tool = flat(4.0);
    let depth = -2.7636306345142407;
    let places = [
        [3.84396433337508, -5.277314774308144, depth],
        [-5.098287879488227, 6.068348685305801, depth],
        [-7.4417780963218965, 7.844666721067342, depth],
    ];
    let extents = extents_of_the_second_time(&tool, &places);
    assert!(extents.iter().all(|extent| *extent == 0.0), "{extents:?}");
}

const SHAPES: [Shape; 3] = [
    Shape::Flat,
    Shape::Ball,
    Shape::Bull {
        corner_radius_mm: 0.7,
    },
];

/// A quarter of a cell or longer: the tool is looked at so far from the start of a move, if need be beyond its end.
fn is_looked_at_on_itself(ends: &[(f64, f64)]) -> bool {
    (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1) >= 0.05
}

/// What is met, mm rad, at each station where a tool goes a way for the second time.
fn extents_of_the_second_time(tool: &Tool, places: &[[f64; 3]]) -> Vec<f64> {
    let mut stock = block([-10.0, -10.0, -5.0], [10.0, 10.0, 0.0], 0.2);
    let mut probe = Probe::new(tool);
    probe.cut_along(&mut stock, places).unwrap();
    let mut extents = Vec::new();
    for ends in places.windows(2) {
        let stations = probe.stations(&mut stock, ends[0], ends[1]).unwrap();
        extents.extend(stations.iter().map(|s| extent(&s.engagement)));
    }
    extents
}

#[test]
fn a_pass_between_two_others_cuts_what_is_left() {
    let tool = flat(6.0);
    let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 5.0], 0.3);
    let mut probe = Probe::new(&tool);
    for y in [-5.0, 5.0] {
        probe
            .cut(&mut stock, [-30.0, y, 3.0], [30.0, y, 3.0])
            .unwrap();
    }
    // The ridge reaches from -2 to 2; the tool in the middle is 3 on both sides.
    let mut last = Engagement::air();
    probe
        .walk(&mut stock, [-30.0, 0.0, 3.0], [5.0, 0.0, 3.0], |_, e| {
            last = e.clone()
        })
        .unwrap();
    let angle = (2.0_f64 / 3.0).acos();
    let error = arc_error(&only_side(&last), angle, PI - angle);
    assert!(error < 0.02, "{error}");
}

#[test]
fn an_island_is_met_and_left() {
    let tool = flat(6.0);
    let mut stock = block([-30.0, -20.0, 0.0], [30.0, 20.0, 5.0], 0.3);
    let mut probe = Probe::new(&tool);
    // All but a rib across the way, from x = -1 to 1, is cleared.
    for k in 0..9 {
        for side in [-1.0, 1.0] {
            let x = side * (4.0 + 3.0 * f64::from(k));
            probe
                .cut(&mut stock, [x, -30.0, 3.0], [x, 30.0, 3.0])
                .unwrap();
        }
    }
    let from = [-25.0, 0.4, 3.0];
    let stations = probe.stations(&mut stock, from, [25.0, 0.4, 3.0]).unwrap();
    let places: Vec<f64> = stations
        .iter()
        .filter(|s| !s.engagement.is_air())
        .map(|s| -25.0 + 50.0 * s.share)
        .collect();
    assert!(places.len() > 4, "{stations:?}");
    // The front touches at -4; the last of it is gone when the tool is at the far wall with its widest place.
    assert!((places[0] + 4.0).abs() < 0.25, "{places:?}");
    assert!((places[places.len() - 1] - 1.0).abs() < 0.25, "{places:?}");
}

#[test]
fn a_thin_wall_between_two_steps_is_not_missed() {
    let tool = flat(20.0);
    for place in [0.0, 0.7, 1.3, 1.9] {
        let mut stock = block([place, -0.4, 0.0], [place + 0.8, 0.4, 5.0], 0.2);
        let mut probe = Probe::new(&tool);
        let stations = probe
            .stations(&mut stock, [-40.0, 0.0, 3.0], [40.0, 0.0, 3.0])
            .unwrap();
        assert!(stations.iter().any(|s| !s.engagement.is_air()), "{place}");
        assert!(stations.windows(2).all(|s| s[0].share < s[1].share));
        assert_eq!(stations[stations.len() - 1].share, 1.0);
    }
}

#[test]
fn engagement_grows_as_the_tool_enters_and_ends_as_it_leaves() {
    let tool = flat(6.0);
    let mut stock = block([0.0, -20.0, 0.0], [30.0, 20.0, 5.0], 0.3);
    let mut probe = Probe::new(&tool);
    let stations = probe
        .stations(&mut stock, [-10.0, 0.0, 3.0], [40.0, 0.0, 3.0])
        .unwrap();
    let mut last_depth = 0.0;
    let mut compared = 0;
    for station in &stations {
        let x = -10.0 + 50.0 * station.share;
        // The edge at x = 0 is reached by angles with sin(phi) > -x/r.
        if x > -2.8 && x < -0.1 {
            let contact = only_side(&station.engagement);
            let half = (-x / 3.0_f64).asin();
            assert!(
                arc_error(&contact, half, PI - half) < 0.05,
                "{x} {contact:?}"
            );
            assert!(contact.exit - contact.entry > last_depth);
            last_depth = contact.exit - contact.entry;
            compared += 1;
        }
        if x > 0.5 && x < 26.5 {
            assert!(arc_error(&only_side(&station.engagement), 0.0, PI) < 1e-3);
        }
        if !(-3.2..=30.2).contains(&x) {
            assert!(station.engagement.is_air(), "{x}");
        }
        // On leaving, two arcs at the sides are left.
        if x > 27.3 && x < 29.7 {
            assert_eq!(station.engagement.contacts.len(), 2, "{x} {station:?}");
            let half = ((30.0 - x) / 3.0).asin();
            assert!(arc_error(&station.engagement.contacts[0], 0.0, half) < 0.05);
            compared += 1;
        }
    }
    assert!(compared >= 6, "{compared}");
}

#[test]
fn steps_in_height_give_bands() {
    let tool = flat(6.0);
    let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.3);
    let mut probe = Probe::new(&tool);
    // A step along the way: left of y = 0.5 the stock is 8 high, right of it 6.
    let wide = flat(20.0);
    Probe::new(&wide)
        .cut(&mut stock, [-40.0, -9.5, 6.0], [40.0, -9.5, 6.0])
        .unwrap();
    let mut last = Engagement::air();
    probe
        .walk(&mut stock, [-30.0, 0.0, 3.0], [0.0, 0.0, 3.0], |_, e| {
            last = e.clone()
        })
        .unwrap();
    assert_eq!(last.contacts.len(), 2, "{last:?}");
    let (low, high) = (last.contacts[0], last.contacts[1]);
    assert!(low.from_mm.abs() < 1e-5 && (low.to_mm - 3.0).abs() < 1e-5);
    assert!((high.from_mm - 3.0).abs() < 1e-5 && (high.to_mm - 5.0).abs() < 1e-5);
    assert!(arc_error(&low, 0.0, PI) < 0.01);
    assert!(
        arc_error(&high, 0.0, (0.5_f64 / 3.0).acos()) < 0.02,
        "{high:?}"
    );
}

#[test]
fn a_ramp_has_end_and_side() {
    let tool = flat(6.0);
    let stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.3);
    let found = look(&tool, &stock, [0.0, 0.0, 6.0], [1.0, 0.0, -0.1]);
    let whole = Engagement::plunge(3.0).contacts[0];
    assert_eq!(found.contacts[0], whole);
    assert!(arc_error(&found.contacts[1], 0.0, PI) < 1e-6);
    assert!((found.contacts[1].to_mm - 2.0).abs() < 1e-6);
    let up = look(&tool, &stock, [0.0, 0.0, 6.0], [1.0, 0.0, 0.1]);
    assert_eq!(up.contacts.len(), 1);
}
