//! A search for a limit that goes on from a smaller depth ends where one from the smallest depth on does.

use kinetostat_chatter::{Crossing, Mode, Regeneration, Swinging, ToolResponse};

use crate::support::{SPEEDS, X, Y, aluminium, arc, cut, regeneration, two_directions, two_modes};

/// Depths up to which it is looked, m.
const DEPTHS: [f64; 5] = [5e-5, 2e-4, 8e-4, 2.4e-3, 7e-3];

fn arm_with_tool() -> ToolResponse {
    let mode = |direction, hz, stiffness| Mode::with_stiffness(direction, stiffness, hz, 0.02);
    let modes = [
        mode(X, 14.0, 2e6),
        mode(Y, 22.0, 1.5e6),
        mode(X, 700.0, 1.5e7),
        mode(Y, 714.0, 1.5e7),
    ];
    ToolResponse::new(modes.map(Result::unwrap).to_vec()).unwrap()
}

fn same(a: Option<&Crossing>, b: Option<&Crossing>, at: &str) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => {
            assert!((a.depth / b.depth - 1.0).abs() < 1e-6, "{at}: {a:?} {b:?}");
            assert!((a.frequency_hz / b.frequency_hz - 1.0).abs() < 1e-6);
            assert_eq!(a.kind, b.kind, "{at}");
            true
        }
        (None, None) => false,
        _ => panic!("{at}: {a:?} {b:?}"),
    }
}

#[test]
fn a_search_goes_on_from_a_smaller_depth() {
    let slot = cut(2, arc("slot", 1.0), aluminium());
    let up = cut(3, arc("up", 0.2), aluminium());
    let helical = up.clone().with_helix(0.5, 12e-3).unwrap();
    let cuts: [Regeneration; 4] = [
        regeneration(two_modes(), slot.clone()),
        regeneration(two_directions(), up),
        regeneration(two_modes(), helical),
        regeneration(arm_with_tool(), slot).with_swinging(Swinging::AtLeastTo(0.0)),
    ];
    let mut limits = [0; 4];
    for (number, cut) in cuts.iter().enumerate() {
        for rpm in SPEEDS {
            let mut known = cut.stability_at(rpm, DEPTHS[0]).unwrap();
            for up_to in &DEPTHS[1..] {
                let at = format!("cut {number}, {rpm} rpm, {up_to} m");
                let found = cut.stability_continued(&known, *up_to).unwrap();
                let afresh = cut.stability_at(rpm, *up_to).unwrap();
                assert_eq!((found.speed_rpm, found.up_to), (rpm, *up_to), "{at}");
                assert_eq!(found.modes_up_to_hz, afresh.modes_up_to_hz, "{at}");
                assert_eq!(found.crossings.len(), afresh.crossings.len(), "{at}");
                if same(found.limit(), afresh.limit(), &at) {
                    limits[number] += 1;
                }
                // With a limit in it as well as without.
                known = found;
            }
        }
    }
    assert!(limits.iter().all(|count| *count >= 5), "{limits:?}");
}
