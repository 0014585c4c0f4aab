//! Ball and bull cutters against brute force and closed forms.

use std::f64::consts::PI;

use kinetostat_cutting::{Edge, Engagement, Probe, Shape, Tool};

use crate::stock_support::{arc_error, block, look};

/// Area of the envelope in contact, projected along the feed, mm^2: what is cut from a slot per way.
fn projected(tool: &Tool, engagement: &Engagement) -> f64 {
    let mut area = 0.0;
    for contact in &engagement.contacts {
        assert_eq!(contact.edge, Edge::Side);
        // Midpoints of thin slices: radius times sin(phi), over the height.
        let n = 50;
        for k in 0..n {
            let step = (contact.to_mm - contact.from_mm) / f64::from(n);
            let radius = tool.radius_at_mm(contact.from_mm + step * (f64::from(k) + 0.5));
            area += step * radius * (contact.entry.cos() - contact.exit.cos());
        }
    }
    area
}

#[test]
fn a_full_slot_of_a_ball_is_the_front_half_at_every_height() {
    let tool = Tool::new(Shape::Ball, 6.0, 2).unwrap();
    for (depth, heading) in [(0.4, 0.0), (2.0, 0.6), (4.0, 2.2_f64)] {
        let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.3);
        let (sin, cos) = heading.sin_cos();
        let z = 8.0 - depth;
        let mut last = Engagement::air();
        let mut probe = Probe::new(&tool);
        let (from, to) = ([-8.0 * cos, -8.0 * sin, z], [3.0 * cos, 3.0 * sin, z]);
        probe
            .cut(&mut stock, [from[0], from[1], 9.0], from)
            .unwrap();
        probe
            .walk(&mut stock, from, to, |_, e| last = e.clone())
            .unwrap();
        for contact in &last.contacts {
            assert!(arc_error(contact, 0.0, PI) < 0.02, "{depth} {contact:?}");
        }
        assert!((last.depth_mm() - depth).abs() < 1e-4, "{last:?}");
        assert!(last.contacts[0].from_mm < 1e-9);
    }
}

#[test]
fn a_ball_beside_its_own_pass_cuts_the_cross_section_that_is_left() {
    let radius = 3.0_f64;
    let tool = Tool::new(Shape::Ball, 2.0 * radius, 2).unwrap();
    for (depth, over) in [(0.5, 0.6), (1.0, 1.0), (2.0, 1.5)] {
        // The area between two parallel troughs below the top, by brute force.
        let trough = |y: f64| depth - radius + (radius * radius - y * y).max(0.0).sqrt();
        let n = 200_000;
        let step = 4.0 * radius / f64::from(n);
        let exact: f64 = (0..n)
            .map(|k| {
                let y = -2.0 * radius + step * (f64::from(k) + 0.5);
                let (new, old) = (trough(y).max(0.0), trough(y + over).max(0.0));
                if new > old { (new - old) * step } else { 0.0 }
            })
            .sum();
        let errors = [0.3, 0.15].map(|cell| {
            let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], cell);
            let mut probe = Probe::new(&tool);
            let z = 8.0 - depth;
            probe
                .cut(&mut stock, [-30.0, -over, z], [30.0, -over, z])
                .unwrap();
            let mut last = Engagement::air();
            probe
                .walk(&mut stock, [-30.0, 0.0, z], [1.0, 0.0, z], |_, e| {
                    last = e.clone()
                })
                .unwrap();
            (projected(&tool, &last) / exact - 1.0).abs()
        });
        println!("ball beside its own pass, {depth} {over}: {errors:?}");
        assert!(
            errors[0] < 0.15 && errors[1] < 0.08,
            "{depth} {over}: {errors:?}"
        );
    }
}

#[test]
fn what_is_removed_is_what_was_met() {
    // Volume per way equals the projected area: a bull nose through a slot off the axes.
    let tool = Tool::new(
        Shape::Bull {
            corner_radius_mm: 1.0,
        },
        6.0,
        2,
    )
    .unwrap();
    let mut stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.15);
    let mut probe = Probe::new(&tool);
    let place = |way: f64| [way * 0.8, way * 0.6, 6.4];
    probe.cut(&mut stock, place(-10.0), place(-2.0)).unwrap();
    let before = stock.volume_mm3();
    let mut last = Engagement::air();
    probe
        .walk(&mut stock, place(-2.0), place(4.0), |_, e| last = e.clone())
        .unwrap();
    let removed = (before - stock.volume_mm3()) / 6.0;
    assert!(
        (projected(&tool, &last) / removed - 1.0).abs() < 0.01,
        "{removed} {last:?}"
    );
}

#[test]
fn a_ball_that_plunges_is_in_contact_all_around() {
    let tool = Tool::new(Shape::Ball, 6.0, 2).unwrap();
    let stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.3);
    let found = look(&tool, &stock, [0.4, 0.3, 7.0], [0.0, 0.0, -1.0]);
    assert_eq!(found.contacts.len(), 1, "{found:?}");
    let contact = found.contacts[0];
    assert_eq!((contact.entry, contact.exit), (0.0, 2.0 * PI));
    assert!((contact.to_mm - 1.0).abs() < 1e-5);
    // Upwards it meets nothing.
    assert!(look(&tool, &stock, [0.4, 0.3, 7.0], [0.0, 0.0, 1.0]).is_air());
}

#[test]
fn a_ball_that_climbs_meets_only_what_is_before_it() {
    let tool = Tool::new(Shape::Ball, 6.0, 2).unwrap();
    let stock = block([-20.0, -20.0, 0.0], [20.0, 20.0, 8.0], 0.3);
    let (up, level) = (
        look(&tool, &stock, [0.4, 0.3, 6.0], [1.0, 0.0, 0.3]),
        look(&tool, &stock, [0.4, 0.3, 6.0], [1.0, 0.0, 0.0]),
    );
    // sin(phi) > (v_z/v_h) cot(kappa): nothing below kappa = atan(0.3), less than half a circle above.
    let lowest = 3.0 * (1.0 - 0.3_f64.atan().cos());
    assert!((up.contacts[0].from_mm - lowest).abs() < 0.1, "{up:?}");
    for contact in &up.contacts {
        assert!(contact.entry > 0.0 && contact.exit < PI);
        assert!((contact.entry + contact.exit - PI).abs() < 1e-6);
    }
    assert!(projected(&tool, &up) < projected(&tool, &level));
}
