//! Arcs of a flat cutter against closed forms.

use std::f64::consts::{PI, TAU};

use kinetostat_cutting::{Engagement, Probe, Side};

use kinetostat_testing::figure::at_most;

use crate::stock_support::{arc_error, block, circle, flat, look, only_side};

const RADIUS: f64 = 3.0;
const DEPTH: f64 = 2.0;

/// Largest error, rad, of straight cuts of several widths and directions on both sides: a first pass leaves a wall, the second
/// goes beside it.
fn straight_error(cell: f64) -> f64 {
    let tool = flat(2.0 * RADIUS);
    let mut worst = 0.0_f64;
    for heading_deg in [0.0, 37.0, 90.0, 163.0, 245.0_f64] {
        let (sin, cos) = heading_deg.to_radians().sin_cos();
        for side in [Side::Left, Side::Right] {
            for width in [0.3, 1.0, 3.0, 4.7, 5.7] {
                let mut stock = block([-30.0, -30.0, 0.0], [30.0, 30.0, 5.0], cell);
                let mut probe = Probe::new(&tool);
                // Beside the feed: the wall of the first pass lies `RADIUS - width` to the side of the part.
                let to_part = if side == Side::Left { 1.0 } else { -1.0 };
                let beside = |way: f64, left: f64| {
                    [
                        0.17 + way * cos - left * sin,
                        0.05 + way * sin + left * cos,
                        5.0 - DEPTH,
                    ]
                };
                let back = to_part * -width;
                probe
                    .cut(&mut stock, beside(-50.0, back), beside(50.0, back))
                    .unwrap();
                let mut found = None;
                probe
                    .walk(
                        &mut stock,
                        beside(-50.0, 0.0),
                        beside(0.0, 0.0),
                        |_, engagement| {
                            found = Some(engagement.clone());
                        },
                    )
                    .unwrap();
                let contact = only_side(&found.unwrap());
                let exact = Engagement::straight(RADIUS, width, DEPTH, side)
                    .unwrap()
                    .contacts[0];
                assert!(contact.from_mm.abs() < 1e-6 && (contact.to_mm - DEPTH).abs() < 1e-6);
                let error = arc_error(&contact, exact.entry, exact.exit);
                worst = if error > worst { error } else { worst };
            }
        }
    }
    worst
}

/// Error with cells of a twentieth of the tool, and how it falls with each halving of the cell.
fn print(name: &str, errors: [f64; 3], first: f64) {
    at_most(
        &format!("engagement, {name}: error at cells of D/20"),
        errors[0],
        first,
        "rad",
    );
    let over_two = (errors[2] / errors[0]).sqrt();
    let title = format!("engagement, {name}: error of half the cell, share, over two halvings");
    at_most(&title, over_two, 0.5, "1");
}

#[test]
fn figure_straight_cuts_follow_their_closed_form_and_the_error_falls_with_the_cell() {
    let errors = [0.3, 0.15, 0.075].map(straight_error);
    print("straight cuts", errors, 0.02);
    assert!(errors[0] < 0.02, "{errors:?}"); // a fifth of a cell on the rim
    assert!(
        errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1],
        "{errors:?}"
    );
}

/// Error of a tool on a circle, with a wall before the pass at a radius; the tool turns left, the wall outside or inside.
fn corner_error(cell: f64, inside: bool) -> f64 {
    let tool = flat(2.0 * RADIUS);
    let mut worst = 0.0_f64;
    for (path, width) in [(8.0, 0.5), (8.0, 1.5), (12.0, 3.0), (5.0, 2.0)] {
        let mut stock = block([-25.0, -25.0, 0.0], [25.0, 25.0, 5.0], cell);
        let centre = [0.13, -0.08];
        let z = 5.0 - DEPTH;
        let mut probe = Probe::new(&tool);
        // The wall before: of the same tool on a circle beside.
        let before = if inside { path - width } else { path + width };
        probe
            .cut_along(&mut stock, &circle(centre, before, z, [0.0, TAU], 1440))
            .unwrap();
        // Half a turn of the pass itself, and the look at the middle of the next chord.
        let pass = circle(centre, path, z, [0.4, 0.4 + PI], 720);
        probe.cut_along(&mut stock, &pass).unwrap();
        let half = 0.5 * PI / 720.0;
        let at = 0.4 + PI + half;
        let place = |angle: f64, r: f64| {
            [
                centre[0] + r * f64::cos(angle),
                centre[1] + r * f64::sin(angle),
                z,
            ]
        };
        let from = place(0.4 + PI, path);
        let to = place(at + half, path);
        let middle: [f64; 3] = std::array::from_fn(|i| 0.5 * (from[i] + to[i]));
        let towards: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
        let contact = only_side(&look(&tool, &stock, middle, towards));
        let (r, rho) = (RADIUS, path);
        // The centre of the circle lies to the left (phi = 0): the wall's normal at phi = pi outside, 0 inside.
        let (entry, exit) = match inside {
            true => {
                let wall = rho + r - width;
                let alpha = ((wall * wall - rho * rho - r * r) / (2.0 * rho * r)).acos();
                (PI - alpha, PI)
            }
            false => {
                let wall = rho - r + width;
                let alpha = ((rho * rho + r * r - wall * wall) / (2.0 * rho * r)).acos();
                (0.0, alpha)
            }
        };
        let error = arc_error(&contact, entry, exit);
        worst = if error > worst { error } else { worst };
    }
    worst
}

#[test]
fn figure_inside_corners_follow_their_closed_form() {
    let errors = [0.3, 0.15, 0.075].map(|cell| corner_error(cell, true));
    print("inside corners", errors, 0.04);
    assert!(errors[0] < 0.04, "{errors:?}");
    assert!(
        errors[2] < 0.25 * errors[0] || errors[2] < 0.006,
        "{errors:?}"
    );
}

#[test]
fn figure_outside_corners_follow_their_closed_form() {
    let errors = [0.3, 0.15, 0.075].map(|cell| corner_error(cell, false));
    print("outside corners", errors, 0.1);
    assert!(errors[0] < 0.1, "{errors:?}"); // a cell on the rim
    assert!(
        errors[2] < 0.25 * errors[0] || errors[2] < 0.006,
        "{errors:?}"
    );
}

#[test]
fn a_slot_is_half_the_circle_from_its_entry_on() {
    let tool = flat(2.0 * RADIUS);
    for heading in [0.0, 0.7, 2.0, 4.0_f64] {
        let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 5.0], 0.3);
        let mut probe = Probe::new(&tool);
        probe
            .cut(&mut stock, [0.0, 0.0, 8.0], [0.0, 0.0, 3.0])
            .unwrap();
        let mut at = [0.0, 0.0, 3.0];
        for _ in 0..40 {
            let next = [
                at[0] + 0.21 * heading.cos(),
                at[1] + 0.21 * heading.sin(),
                3.0,
            ];
            for station in probe.stations(&mut stock, at, next).unwrap() {
                let error = arc_error(&only_side(&station.engagement), 0.0, PI);
                assert!(error < 0.02, "{error} {:?}", station.engagement);
            }
            at = next;
        }
    }
}

#[test]
fn a_plunge_is_the_whole_end_and_no_side() {
    let tool = flat(2.0 * RADIUS);
    let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 5.0], 0.3);
    let mut probe = Probe::new(&tool);
    let down = probe
        .stations(&mut stock, [1.1, 2.0, 9.0], [1.1, 2.0, 1.0])
        .unwrap();
    let contacts: Vec<_> = down.iter().filter(|s| !s.engagement.is_air()).collect();
    assert!(contacts.len() > 3);
    for station in contacts {
        assert_eq!(station.engagement, Engagement::plunge(RADIUS));
    }
    // In air down to the top of the block.
    let last_air = down.iter().rfind(|s| s.engagement.is_air()).unwrap();
    assert!((last_air.share - 0.5).abs() < 0.03, "{last_air:?}");
    // Up, and down again, there is nothing.
    let up = probe
        .stations(&mut stock, [1.1, 2.0, 1.0], [1.1, 2.0, 9.0])
        .unwrap();
    let again = probe
        .stations(&mut stock, [1.1, 2.0, 9.0], [1.1, 2.0, 1.0])
        .unwrap();
    assert!(up.iter().chain(&again).all(|s| s.engagement.is_air()));
}

#[test]
fn a_plunge_beside_a_wall_has_the_part_of_the_end_that_is_over_it() {
    let tool = flat(2.0 * RADIUS);
    let stock = block([-20.0, 0.0, 0.0], [20.0, 20.0, 5.0], 0.15);
    let found = look(&tool, &stock, [1.0, 0.0, 4.0], [0.0, 0.0, -1.0]);
    // The feed stands along x; the half with y above 0 is left of it.
    for contact in &found.contacts {
        let middle = 0.5 * (contact.entry + contact.exit);
        assert!(
            (contact.exit - contact.entry - PI).abs() < 0.3,
            "{contact:?}"
        );
        assert!((middle - TAU).abs() < 0.1, "{contact:?}");
    }
    let area: f64 = found
        .contacts
        .iter()
        .map(|c| 0.5 * (c.exit - c.entry) * (c.to_mm * c.to_mm - c.from_mm * c.from_mm))
        .sum();
    assert!((area - 0.5 * PI * RADIUS * RADIUS).abs() < 0.05, "{area}");
}
