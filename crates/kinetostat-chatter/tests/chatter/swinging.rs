//! Which modes swing: those that count must, whatever the band of the rest.

use kinetostat_chatter::{ChatterErrorKind, LobeRequest, Mode, Swinging, ToolResponse};
use nalgebra::Vector3;

use crate::support::{X, Y, aluminium, arc, cut, regeneration};

/// Damping of all modes here.
const RATIO: f64 = 0.02;

fn mode(direction: Vector3<f64>, hz: f64, stiffness: f64) -> Mode {
    Mode::with_stiffness(direction, stiffness, hz, RATIO).unwrap()
}

/// An arm, and a tool in it that vibrates by itself; by the tool's stiffness, N/m.
fn arm_with_tool(hz: f64, stiffness: f64) -> ToolResponse {
    let arm = [mode(X, 14.0, 2e6), mode(Y, 22.0, 1.5e6)];
    let stiff = [mode(Y, 150.0, 2e9), mode(X, 1900.0, 4e10)];
    let tool = [mode(X, hz, stiffness), mode(Y, 1.02 * hz, stiffness)];
    ToolResponse::new([&arm[..], &tool, &stiff].concat()).unwrap()
}

/// A tool at 700 Hz with a tenth of the arm's flexibility limits the cut at high speed; modes up to 300 Hz alone know nothing of it, and that is told.
#[test]
fn a_mode_of_the_tool_counts_and_is_told_where_it_is_left_out() {
    let all = regeneration(
        arm_with_tool(700.0, 1.5e7),
        cut(2, arc("slot", 1.0), aluminium()),
    );
    let (rpm, up_to) = (8300.0, 5e-3);
    let limit = |of: Swinging| {
        all.clone()
            .with_swinging(of)
            .stability_at(rpm, up_to)
            .unwrap()
    };
    let depth = |of: Swinging| limit(of).limit().map(|crossing| crossing.depth);
    let exact = depth(Swinging::All).expect("a limit");
    let automatic = limit(Swinging::AtLeastTo(0.0));
    let own = automatic.limit().expect("a limit").depth;
    assert!((own / exact - 1.0).abs() < 5e-3, "{own} {exact}");
    assert!(automatic.left_out.is_none() && automatic.modes_up_to_hz > 700.0);
    // The stiff mode at 1900 Hz is a spring: it has less than a thousandth of the largest peak.
    assert!(automatic.modes_up_to_hz < 800.0);
    let few = limit(Swinging::UpTo(300.0));
    assert!(
        few.limit().is_none_or(|limit| limit.depth > 2.0 * exact),
        "{few:?} {exact}"
    );
    assert_eq!(few.modes_up_to_hz, 150.0);
    let left_out = few.left_out.expect("told");
    assert!(
        (left_out.frequency_hz - 700.0).abs() < 1e-6
            || (left_out.frequency_hz - 714.0).abs() < 1e-6
    );
    // Peaks of modes with the same damping are as their flexibilities.
    assert!(
        (left_out.share - 1.5e6 / 1.5e7).abs() < 1e-9,
        "{left_out:?}"
    );
}

/// At a speed far above the arm's frequencies a tool with less than 1 % of the arm's peak limits the cut: it swings because it could chatter by itself
/// below the depth that would else be stable.
#[test]
fn a_mode_that_could_chatter_by_itself_counts_whatever_its_share() {
    let all = regeneration(
        arm_with_tool(1200.0, 3e8),
        cut(2, arc("slot", 1.0), aluminium()),
    );
    // The tool vibrates 1.7 times from one tooth to the next.
    let (rpm, up_to) = (21_400.0, 60e-3);
    let of = |of: Swinging| {
        all.clone()
            .with_swinging(of)
            .stability_at(rpm, up_to)
            .unwrap()
    };
    let exact = of(Swinging::All).limit().expect("a limit").depth;
    let few = of(Swinging::UpTo(1000.0));
    assert!(
        few.limit().is_none_or(|limit| limit.depth > 1.05 * exact),
        "{few:?} {exact}"
    );
    assert!(few.left_out.is_some_and(|left_out| left_out.share < 0.01));
    let automatic = of(Swinging::AtLeastTo(0.0));
    let own = automatic.limit().expect("a limit").depth;
    assert!((own / exact - 1.0).abs() < 5e-3, "{own} {exact}");
    assert!(automatic.modes_up_to_hz > 1200.0 && automatic.left_out.is_none());
}

/// At 200 turns a minute a mode at 700 Hz vibrates 105 times while a tooth cuts, which is not followed: where it could chatter
/// by itself nothing is said (it was "stable", or the limit of the arm), and at smaller depths the mode is named.
#[test]
fn a_mode_too_fast_for_the_speed_is_left_out_and_told() {
    let all = regeneration(
        arm_with_tool(700.0, 1.5e7),
        cut(2, arc("slot", 1.0), aluminium()),
    );
    let error = all.stability_at(200.0, 5e-3).unwrap_err();
    assert!(
        error.to_string().contains("while a tooth is in the cut"),
        "{error}"
    );
    let automatic = all.clone().with_swinging(Swinging::AtLeastTo(0.0));
    let error = automatic.stability_at(200.0, 5e-3).unwrap_err();
    assert_eq!(error.kind, ChatterErrorKind::NotConverged);
    assert!(
        error.to_string().contains("could chatter by itself from"),
        "{error}"
    );
    // Of a diagram the other speeds are answered.
    let lobes = automatic.lobes(&LobeRequest::new(200.0, 400.0, 2, 5e-3));
    let lobes = lobes.unwrap();
    assert_eq!((lobes.points.len(), lobes.without_answer.len()), (1, 1));
    assert_eq!(lobes.without_answer[0].0, 200.0);
    assert_eq!(lobes.best().map(|best| best.0), Some(400.0));
    // No mode chatters by itself at a hundredth of a millimetre.
    let found = automatic.stability_at(200.0, 1e-5).unwrap();
    assert_eq!(found.modes_up_to_hz, 150.0);
    assert!(
        found
            .left_out
            .is_some_and(|left_out| left_out.frequency_hz > 690.0)
    );
    assert!(found.limit().is_none());
    // A little faster it is followed.
    let faster = all
        .with_swinging(Swinging::AtLeastTo(0.0))
        .stability_at(400.0, 5e-3)
        .unwrap();
    assert!(faster.modes_up_to_hz > 700.0 && faster.left_out.is_none());
}
