//! Tools whose tip is below the stock, and stacks of plunges.

use std::f64::consts::PI;

use kinetostat_cutting::{Engagement, Feed, Linear, Milling, Probe, Shape, Tool};

use crate::stock_support::{arc_error, block, flat, only_side};

/// What the last station of a slot through a plate meets.
fn slot(tool: &Tool, z: f64) -> Engagement {
    let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 3.0], 0.3);
    let mut last = Engagement::air();
    Probe::new(tool)
        .walk(&mut stock, [-30.0, 0.4, z], [0.0, 0.4, z], |_, e| {
            last = e.clone();
        })
        .unwrap();
    last
}

#[test]
fn a_tip_below_a_plate_cuts_only_the_plate() {
    let law = Linear::new([796.0, 168.0, 222.0], [27.7, 30.8, 1.4]).unwrap();
    let tool = flat(6.0);
    let (through, flush) = (slot(&tool, -5.0), slot(&tool, 0.0));
    let contact = only_side(&through);
    assert!((contact.from_mm - 5.0).abs() < 1e-5 && (contact.to_mm - 8.0).abs() < 1e-5);
    assert!(arc_error(&contact, 0.0, PI) < 1e-3);
    assert!((through.depth_mm() - 3.0).abs() < 1e-5 && (through.reach_mm() - 8.0).abs() < 1e-5);
    assert!((flush.depth_mm() - 3.0).abs() < 1e-5 && (flush.reach_mm() - 3.0).abs() < 1e-5);
    let force = |e: &Engagement| {
        let feed = Feed::level(0.1).unwrap();
        Milling::new(&tool, &law, e, feed).mean().force_n
    };
    let off = (force(&through) - force(&flush)).norm();
    assert!(off < 1e-4 * force(&flush).norm(), "{off}");
    // Balls and bulls with the round part below the plate cut as cylinders.
    for shape in [
        Shape::Ball,
        Shape::Bull {
            corner_radius_mm: 1.0,
        },
    ] {
        let found = slot(&Tool::new(shape, 6.0, 2).unwrap(), -5.0);
        assert!((found.depth_mm() - 3.0).abs() < 1e-5, "{shape:?} {found:?}");
    }
}

#[test]
fn a_plunge_through_a_plate_ends_below_it_and_leaves_a_hole() {
    let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 3.0], 0.3);
    let mut probe = Probe::new(&flat(6.0));
    let down = probe
        .stations(&mut stock, [1.0, 2.0, 5.0], [1.0, 2.0, -5.0])
        .unwrap();
    for station in down.iter().filter(|s| !s.engagement.is_air()) {
        // From the top (share 0.2) to the bottom (0.5).
        assert!(
            station.share > 0.19 && station.share < 0.52,
            "{}",
            station.share
        );
        assert_eq!(station.engagement.depth_mm(), 0.0);
    }
    assert!(down.iter().any(|s| !s.engagement.is_air()));
    assert_eq!(stock.top_mm(1.0, 2.0), None);
    // Over the edge of the hole there is still the plate.
    assert_eq!(stock.top_mm(4.6, 2.0), Some(3.0));
}

/// In several moves straight down, as a program writes them, no core is left standing.
#[test]
fn plunges_in_a_row_leave_no_core() {
    let mut stock = block([-20.0, -20.0, -12.0], [20.0, 20.0, 0.0], 0.3);
    let mut probe = Probe::new(&flat(6.0));
    for heights in [5.0, 0.0, -1.0, -3.0_f64].windows(2) {
        probe
            .walk(
                &mut stock,
                [1.0, 2.0, heights[0]],
                [1.0, 2.0, heights[1]],
                |_, _| {},
            )
            .unwrap();
    }
    for x in [1.0, 2.5, 3.7] {
        assert_eq!(stock.top_mm(x, 2.0), Some(-3.0), "{x}");
    }
}
