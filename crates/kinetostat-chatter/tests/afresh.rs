//! One lobe point of a tool that vibrates in no axis, against `validation/scripts/lobe_point.py`: a collocation and a
//! semi-discretisation that were written from the theory alone. The numbers are what it prints.

#![allow(clippy::unwrap_used, reason = "a failing test may panic")]

use kinetostat_chatter::{
    Arc, Coefficients, FeedFrame, Instability, Milled, MillingCut, Mode, Regeneration, ToolResponse,
};
use nalgebra::Vector3;

fn tool() -> ToolResponse {
    let modes = [
        ([1.1, 0.5, -0.3], 41.0, 0.025),
        ([-0.6, 1.3, 0.4], 55.0, 0.03),
        ([0.2, -0.7, 0.9], 128.0, 0.018),
    ];
    let modes = modes.map(|(shape, hz, ratio)| {
        let w: f64 = std::f64::consts::TAU * hz;
        Mode::new(Vector3::from(shape), w * w, ratio).unwrap()
    });
    ToolResponse::new(modes.to_vec()).unwrap()
}

fn cut(milled: Milled) -> MillingCut {
    // The radial coefficient is Kr times Kt already; (D 8), of which the numbers are, has the opposite axial sign.
    let coefficients = Coefficients::new(7.1e8, 2.3e8, -0.6e8).unwrap();
    MillingCut::new(3, Arc::straight(milled, 0.35).unwrap(), coefficients).unwrap()
}

fn fed(degrees: f64, milled: Milled) -> Regeneration {
    let frame = FeedFrame::vertical(f64::to_radians(degrees)).unwrap();
    Regeneration::new(tool().in_frame(&frame), cut(milled).into()).unwrap()
}

#[test]
fn a_lobe_point_off_every_axis() {
    let down = fed(35.0, Milled::Down);
    let size = down.multiplier(2300.0, 2e-4).unwrap().size();
    assert!((size - 1.821_765_556).abs() < 1e-7, "{size}");
    let stability = down.stability_at(2300.0, 2e-4).unwrap();
    let limit = stability.limit().unwrap();
    assert!(
        (limit.depth / 1.581_773_972_3e-5 - 1.0).abs() < 1e-6,
        "{limit:?}"
    );
    assert_eq!(limit.kind, Instability::Flip);
    // Half the tooth frequency of three teeth.
    assert!((limit.frequency_hz - 57.5).abs() < 1e-6, "{limit:?}");
}

/// Trap 12: degrees, Kr and Kr Kt, up and down, and the hand of the feed frame all change this number by more than a
/// hundredth, so that none of them can be wrong in both programs by chance.
#[test]
fn what_is_easily_mixed_up_shows() {
    let right = fed(35.0, Milled::Down)
        .multiplier(2300.0, 2e-4)
        .unwrap()
        .size();
    let mixed = |regeneration: &Regeneration| {
        let size = regeneration.multiplier(2300.0, 2e-4).unwrap().size();
        (size / right - 1.0).abs()
    };
    assert!(mixed(&fed(35.0, Milled::Up)) > 0.01);
    assert!(mixed(&fed(-35.0, Milled::Down)) > 0.01);
    assert!(mixed(&fed(35.0_f64.to_degrees(), Milled::Down)) > 0.01);
    let ratio_again = Coefficients::with_ratios(7.1e8, 2.3 / 7.1 * 2.3 / 7.1, -0.6 / 7.1).unwrap();
    let arc = Arc::straight(Milled::Down, 0.35).unwrap();
    let frame = FeedFrame::vertical(f64::to_radians(35.0)).unwrap();
    let wrong = MillingCut::new(3, arc, ratio_again).unwrap();
    let wrong = Regeneration::new(tool().in_frame(&frame), wrong.into()).unwrap();
    assert!(mixed(&wrong) > 0.01);
}
