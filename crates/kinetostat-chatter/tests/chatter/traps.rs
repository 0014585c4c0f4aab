//! The traps of `dynamics.md` section 13 that concern chatter: each test fails for a program that falls into one.

use std::f64::consts::FRAC_PI_2;

use kinetostat_chatter::{
    Arc, Coefficients, FeedFrame, Milled, MillingCut, Mode, Regeneration, ToolResponse,
    zeroth_order,
};
use kinetostat_cutting::{Engagement, Linear, Side};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;

use crate::semi_discretisation::{Plain, extrapolated, multiplier};
use crate::support::{
    X, Y, aluminium, arc, arc_of, cut, one_direction, one_mode, regeneration, two_modes,
};

fn limit(machine: &Regeneration, speed: f64) -> f64 {
    machine
        .stability_at(speed, 0.02)
        .unwrap()
        .limit()
        .map_or(f64::NAN, |l| l.depth)
}

pub fn plain(machine: &MillingCut, slices: usize) -> Plain {
    Plain {
        teeth: machine.teeth(),
        entry: machine.arc().entry(),
        exit: machine.arc().exit(),
        kt: machine.coefficients().tangential(),
        kr: machine.coefficients().radial(),
        lag: machine.lag_per_depth(),
        slices,
    }
}

/// Trap 5: a fixed number of steps is wrong where a mode is fast against the teeth; the limit of many is the collocation's.
#[test]
fn semi_discretisation_tends_to_the_collocation() {
    let slot = cut(2, arc("slot", 1.0), aluminium());
    let machine = regeneration(one_direction(), slot.clone());
    let exact = machine.multiplier(5000.0, 0.5e-3).unwrap().size();
    let fixed = multiplier(&one_direction(), &plain(&slot, 1), 5000.0, 0.5e-3, 40);
    assert!((fixed / exact - 1.0).abs() > 5e-3, "{fixed} {exact}");
    let mut worst = Worst::new();
    for (tool, teeth, name, immersion, speed, depth) in [
        (one_direction(), 2, "slot", 1.0, 9000.0, 2e-3),
        (two_modes(), 3, "up", 0.5, 9000.0, 1e-3),
        (two_modes(), 3, "down", 0.3, 6000.0, 2e-3),
        // Two and three teeth in the cut at a time.
        (two_modes(), 5, "up", 1.0, 5000.0, 0.6e-3),
    ] {
        let cut = cut(teeth, arc(name, immersion), aluminium());
        let found = regeneration(tool.clone(), cut.clone())
            .multiplier(speed, depth)
            .unwrap()
            .size();
        let expected = extrapolated(&tool, &plain(&cut, 1), speed, depth, 80);
        worst.add_at(found / expected - 1.0, || {
            format!("{name} {speed}: {found} {expected}")
        });
    }
    assert!(worst.of(4) < 5e-4, "{worst}");
}

/// The helix in closed form is what many slices along the depth give.
#[test]
fn a_helix_is_many_slices() {
    let mut worst = Worst::new();
    for (helix, name, immersion, depth) in [
        (30.0, "down", 0.2, 4e-3),
        (-25.0, "up", 0.4, 3e-3),
        (45.0, "slot", 1.0, 5e-3),
    ] {
        let cut = cut(3, arc(name, immersion), aluminium())
            .with_helix(f64::to_radians(helix), 0.012)
            .unwrap();
        let found = regeneration(two_modes(), cut.clone())
            .multiplier(7000.0, depth)
            .unwrap()
            .size();
        let expected = extrapolated(&two_modes(), &plain(&cut, 60), 7000.0, depth, 60);
        worst.add_at(found / expected - 1.0, || {
            format!("{helix}: {found} {expected}")
        });
    }
    assert!(worst.of(3) < 2e-3, "{worst}");
    // A helix of none is a straight edge, and one of nearly none is nearly so.
    let straight = cut(2, arc("up", 0.3), aluminium());
    let nearly = straight.clone().with_helix(1e-5, 0.012).unwrap();
    let [a, b] = [straight, nearly].map(|cut| {
        regeneration(two_modes(), cut)
            .multiplier(7000.0, 2e-3)
            .unwrap()
            .size()
    });
    assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
}

/// Trap 5, second half: above the first crossing there is a stable island, and every stretch agrees with a dense look.
#[test]
fn islands_are_found() {
    let cut = cut(2, arc("down", 0.05), aluminium())
        .with_helix(30_f64.to_radians(), 0.0127)
        .unwrap();
    let machine = regeneration(one_direction(), cut);
    let mut islands = 0;
    for speed in [5750.0, 7650.0, 10700.0, 10900.0, 17800.0, 18250.0, 20000.0] {
        let found = machine.stability_at(speed, 0.02).unwrap();
        islands += found.stable().len() - 1;
        for k in 1..80 {
            let depth = 0.02 * f64::from(k) / 80.0;
            let size = machine.multiplier(speed, depth).unwrap().size();
            // Within rounding of the circle either answer is right.
            if (size - 1.0).abs() > 1e-6 {
                assert_eq!(
                    found.is_stable(depth),
                    Some(size < 1.0),
                    "{speed} {depth}: {size} {found:?}"
                );
            }
        }
        for pair in found.crossings.windows(2) {
            assert!(
                pair[0].depth < pair[1].depth && pair[0].unstable_above != pair[1].unstable_above
            );
        }
    }
    assert!(islands >= 3, "{islands}");
}

/// Trap 4: few modes without the flexibility of the others give another limit; with it, that of all.
#[test]
fn residual_flexibility_belongs_to_the_lobes() {
    let mut modes = two_modes().modes().to_vec();
    // Soft enough together to double the static compliance, far above the band.
    for (x, y, hz) in [(1.0, 0.3, 9000.0), (-0.4, 1.0, 12000.0)] {
        let direction = Vector3::new(x, y, 0.1);
        modes.push(Mode::with_stiffness(direction, 8e6, hz, 0.02).unwrap());
    }
    let all = ToolResponse::new(modes).unwrap();
    let few = all.with_modes_up_to(1000.0).unwrap();
    assert!((few.compliance() - all.compliance()).norm() < 1e-12 * all.compliance().norm());
    let bare = few.clone().with_residual(Matrix3::zeros()).unwrap();
    let half = cut(3, arc("up", 0.5), aluminium());
    let at = |tool: &ToolResponse| limit(&regeneration(tool.clone(), half.clone()), 9000.0);
    let (exact, with, without) = (at(&all), at(&few), at(&bare));
    assert!(
        (with / exact - 1.0).abs() < 5e-3,
        "{exact} {with} {without}"
    );
    assert!(
        (without / exact - 1.0).abs() > 0.03,
        "{exact} {with} {without}"
    );
    // Turning to the residual alone: a spring without mass never chatters while it is stiff, and is no error.
    let spring = ToolResponse::new(vec![one_mode(X)])
        .unwrap()
        .with_residual(Matrix3::identity() * 1e-9)
        .unwrap();
    assert!(limit(&regeneration(spring, half.clone()), 9000.0) > 0.0);
}

/// Trap 12: radial coefficients are forces by area; a ratio in their place is refused.
#[test]
fn a_ratio_is_no_coefficient() {
    assert!(Coefficients::new(6e8, 0.07, 0.0).is_err());
    assert!(Coefficients::new(6e8, 4.2e7, 0.3).is_err());
    assert!(Coefficients::with_ratios(6e8, 4.2e7, 0.0).is_err());
    let by_area = Coefficients::with_ratios(6e8, 0.07, 0.5).unwrap();
    assert!(
        (by_area.radial() / 4.2e7 - 1.0).abs() < 1e-12
            && (by_area.axial() / 3e8 - 1.0).abs() < 1e-12
    );
}

/// Trap 12: with one direction across the feed, up and down milling at the wall are told apart by sign, not by chance.
#[test]
fn up_and_down_are_not_mirrored() {
    // No radial force, a tool soft along y only, low immersion. Up: the chip begins at phi = 0, where n is along y and the
    // tooth moves along x: D_yy = Kt sin cos > 0, the process pulls. Down: D_yy < 0, it pushes back.
    let tangential = Coefficients::new(6e8, 0.0, 0.0).unwrap();
    for (milled, sign) in [(Milled::Up, 1.0), (Milled::Down, -1.0)] {
        let arc = Arc::straight(milled, 0.1).unwrap();
        let mean = kinetostat_chatter::Cut::from(cut(2, arc, tangential)).mean_matrix();
        assert!(mean[(1, 1)] * sign > 0.0, "{milled:?} {mean}");
        assert!(mean[(0, 0)] * sign < 0.0, "{milled:?} {mean}");
    }
    // The arcs are those of the cutting crate for a part on the left and on the right.
    for (milled, side) in [(Milled::Up, Side::Left), (Milled::Down, Side::Right)] {
        let engagement = Engagement::straight(6.0, 3.0, 2.0, side).unwrap();
        let (a, b) = (arc_of(&engagement), Arc::straight(milled, 0.25).unwrap());
        assert!((a.entry() - b.entry()).abs() + (a.exit() - b.exit()).abs() < 1e-12);
    }
    // One direction of D5, half immersion: up and down differ by more than three times at 5000 rpm (table).
    let at = |name| {
        limit(
            &regeneration(one_direction(), cut(2, arc(name, 0.5), aluminium())),
            5000.0,
        )
    };
    assert!((at("down") / at("up") - 0.847204 / 0.260279).abs() < 1e-4);
}

/// Trap 12: a left-handed frame of the feed would mirror the cut; so would degrees for radians go unseen.
#[test]
fn frames_are_right_handed() {
    assert!(FeedFrame::new(Vector3::z(), Vector3::z()).is_err());
    let frame = FeedFrame::vertical(FRAC_PI_2).unwrap();
    assert!((frame.rotation().determinant() - 1.0).abs() < 1e-12);
    // Soft along base x, fed along base y: the feed's left is -x, so the softness lies along y of the cut.
    let tool = one_direction().in_frame(&frame);
    assert!(tool.compliance()[(0, 0)] < 1e-12 * tool.compliance()[(1, 1)]);
    // A feed that goes down as well keeps its direction across the axis.
    let sloped = FeedFrame::new(Vector3::new(0.0, 1.0, -0.5), Vector3::z()).unwrap();
    assert!((sloped.rotation() - frame.rotation()).norm() < 1e-12);
    // The mirror image of a soft direction is another machine: the sign of a cross term decides.
    let slanted = |y: f64| ToolResponse::new(vec![one_mode(Vector3::new(1.0, y, 0.0))]).unwrap();
    let at = |y: f64| {
        limit(
            &regeneration(slanted(y), cut(2, arc("up", 0.3), aluminium())),
            9000.0,
        )
    };
    assert!((at(0.6) / at(-0.6)).ln().abs() > 0.2);
}

/// Trap 13: laws of the cutting crate are in N/mm2 and mm; the slope is in N/m2, with one axial sign.
#[test]
fn coefficients_are_in_si_units() {
    let law = Linear::new([600.0, 200.0, 100.0], [20.0, 10.0, 5.0]).unwrap();
    let line = Coefficients::linearised(&law, 1e-4).unwrap().coefficients;
    let expected = Coefficients::new(6e8, 2e8, 1e8).unwrap();
    let apart = [
        line.tangential() / expected.tangential() - 1.0,
        line.radial() / expected.radial() - 1.0,
        line.axial() / expected.axial() - 1.0,
    ];
    assert!(apart.iter().all(|a| a.abs() < 1e-9), "{apart:?}");
    // The force of the cutting crate is that of the coefficients: static chips on both ways, without edge force.
    let law = Linear::new([600.0, 200.0, 100.0], [0.0; 3]).unwrap();
    let tool = kinetostat_cutting::Tool::new(kinetostat_cutting::Shape::Flat, 12.0, 2).unwrap();
    let engagement = Engagement::straight(6.0, 4.0, 2.0, Side::Right).unwrap();
    let feed = kinetostat_cutting::Feed::level(0.1).unwrap();
    let mean = kinetostat_cutting::Milling::new(&tool, &law, &engagement, feed)
        .mean()
        .force_n;
    let cut = MillingCut::of_tool(&tool, arc_of(&engagement), line).unwrap();
    let ours = kinetostat_chatter::Cut::from(cut).mean_matrix().column(0) * (2e-3 * 1e-4);
    assert!((ours - mean).norm() < 1e-6 * mean.norm(), "{ours} {mean}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// A turn of machine and feed together changes nothing, nor does the order of modes.
    #[test]
    fn frames_and_order_change_nothing(roll in -3.0..3.0_f64, pitch in -1.5..1.5_f64, yaw in -3.0..3.0_f64, speed in 3000.0..15000.0_f64) {
        let mut modes = two_modes().modes().to_vec();
        modes.push(Mode::along(Vector3::new(0.3, -0.5, 0.7), 0.2, 350.0, 0.02).unwrap());
        let turn = Rotation3::from_euler_angles(roll, pitch, yaw).into_inner();
        let turned: Vec<Mode> = modes.iter().rev().map(|mode| {
            Mode::new(turn * mode.shape(), mode.angular_frequency().powi(2), mode.damping_ratio()).unwrap()
        }).collect();
        let frame = FeedFrame::new(turn.column(0).into(), turn.column(2).into()).unwrap();
        let half = cut(3, arc("down", 0.4), Coefficients::new(6e8, 2e8, 1e8).unwrap());
        let a = regeneration(ToolResponse::new(modes).unwrap(), half.clone());
        let b = regeneration(ToolResponse::new(turned).unwrap().in_frame(&frame), half);
        prop_assert!((a.multiplier(speed, 1e-3).unwrap().size() / b.multiplier(speed, 1e-3).unwrap().size() - 1.0).abs() < 1e-9);
        let [za, zb] = [&a, &b].map(|m| zeroth_order::limit(m, speed).unwrap().unwrap().depth);
        prop_assert!((za / zb - 1.0).abs() < 1e-9);
    }

    /// The largest multiplier of the Krylov space is that of the dense matrix, and more points do not change it.
    #[test]
    fn multipliers_are_resolved(speed in 1500.0..20000.0_f64, depth in 1e-5..3e-3_f64, immersion in 0.05..1.0_f64, teeth in 1..6_usize) {
        let arc = Arc::straight(Milled::Down, immersion).unwrap();
        let machine = regeneration(two_modes(), cut(teeth, arc, aluminium()));
        let found = machine.multiplier(speed, depth).unwrap();
        let dense = machine.multipliers(speed, depth).unwrap()[0];
        let usual = machine.multiplier_with(speed, depth, 1.0).unwrap();
        let finer = machine.multiplier_with(speed, depth, 2.5).unwrap();
        prop_assert!((usual.size() / dense.0.hypot(dense.1) - 1.0).abs() < 1e-8);
        prop_assert!((found.size() / finer.size() - 1.0).abs() < 1e-6, "{} {}", found.size(), finer.size());
    }
}

/// What makes no sense is refused by name.
#[test]
fn absurd_input_is_refused() {
    let quantity = |error: kinetostat_chatter::ChatterError| error.quantity;
    let machine = regeneration(one_direction(), cut(2, arc("up", 0.5), aluminium()));
    for speed in [0.0, -100.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            quantity(machine.multiplier(speed, 1e-3).unwrap_err()),
            "spindle speed"
        );
        assert_eq!(
            quantity(machine.stability_at(speed, 1e-3).unwrap_err()),
            "spindle speed"
        );
        assert_eq!(
            quantity(machine.stability_at(speed, 1e-9).unwrap_err()),
            "spindle speed"
        );
        assert_eq!(
            quantity(zeroth_order::limit(&machine, speed).unwrap_err()),
            "spindle speed"
        );
    }
    for depth in [-1e-3, f64::NAN] {
        assert_eq!(
            quantity(machine.multiplier(5000.0, depth).unwrap_err()),
            "depth of cut"
        );
    }
    assert_eq!(
        quantity(MillingCut::new(0, Arc::slot(), aluminium()).unwrap_err()),
        "teeth"
    );
    for immersion in [0.0, -0.1, 1.0001, f64::NAN] {
        assert_eq!(
            quantity(Arc::straight(Milled::Up, immersion).unwrap_err()),
            "immersion"
        );
    }
    assert!(
        Arc::new(0.0, 7.0).is_err() && Arc::new(1.0, 1.0).is_err() && Arc::new(-1.0, 1.0).is_err()
    );
    assert!(Arc::new(0.0, 90.0).is_err(), "degrees");
    assert!(
        cut(2, Arc::slot(), aluminium())
            .with_helix(30.0, 0.012)
            .is_err(),
        "degrees"
    );
    for damping in [-0.01, 1.0, 1.5, f64::NAN] {
        assert_eq!(
            quantity(Mode::along(X, 1.0, 10.0, damping).unwrap_err()),
            "damping ratio"
        );
    }
    assert_eq!(
        quantity(Mode::new(X, -4.0, 0.01).unwrap_err()),
        "squared angular frequency"
    );
    assert_eq!(
        quantity(Mode::along(X, 0.0, 10.0, 0.01).unwrap_err()),
        "modal mass"
    );
    assert_eq!(
        quantity(ToolResponse::new(vec![]).unwrap_err()),
        "modes of the tool"
    );
    let axial = ToolResponse::new(vec![one_mode(Vector3::z())]).unwrap();
    let half = cut(2, arc("up", 0.5), aluminium());
    assert_eq!(
        quantity(Regeneration::new(axial, half.clone().into()).unwrap_err()),
        "flexible directions"
    );
    let undamped = ToolResponse::new(vec![Mode::along(Y, 1.0, 10.0, 0.0).unwrap()]).unwrap();
    assert_eq!(
        quantity(Regeneration::new(undamped, half.into()).unwrap_err()),
        "damping ratio"
    );
    // A mode that vibrates hundreds of times while a tooth is in the cut is named, not computed wrongly.
    assert_eq!(
        quantity(machine.multiplier(50.0, 1e-4).unwrap_err()),
        "mode against spindle speed"
    );
}
