//! Actuators with a screw and universal ends.

use super::{Figures, Worst};
use crate::screws_turn_with_their_joints::{commands_apart, stiffness_apart};

#[test]
fn screws_against_their_closed_form() {
    let mut f = Figures::new();
    let name = "Hexapod of screws with both hands, minus a closed form";
    for (what, apart, most, unit) in [
        ("commands", commands_apart(), 1e-12, "m (test's tolerance)"),
        (
            "stiffness",
            stiffness_apart(),
            1e-10,
            "relative (test's tolerance)",
        ),
    ] {
        let mut worst = Worst::new();
        worst.add(apart);
        f.at_most(&format!("{name}: {what}"), &worst, most, unit);
    }
    f.finish();
}
