//! The toggle frame of Figure 5.12 [R 5.45]: three legs of rigid links on springs in the plane of the
//! flat posture.

use kinetostat::{
    Chain, ChainProblem, CurveSettings, EndCondition, MotionKind, Parameter, Pose, Prescribed,
    Settings, Twist, continuation::SpecialKind, follow, solve_chain,
};
use kinetostat_report::Plot;
use nalgebra::Vector3;

use crate::shared::curves::{Drawn, lines, marks, of_kind, unstable_entry};
use crate::{Cause, Contents, Item};

/// Leg of three equal ones: by symmetry its end moves along z and the machine carries three times its force. A slide
/// along x with the spring, a hinge, a link of unit length.
fn leg() -> Result<Chain, kinetostat::Error> {
    Chain::builder("leg of the toggle frame")
        .spring("slide", MotionKind::Prismatic, Vector3::x(), 1.0, 0.0)
        .passive("hinge", MotionKind::Revolute, -Vector3::y(), 0.0)
        .translation(Vector3::new(1.0, 0.0, 0.0))
        .passive("head", MotionKind::Revolute, -Vector3::y(), 0.0)
        .build()
}

struct Toggle {
    /// Distance from the flat posture, L.
    distance: f64,
    /// Critical displacement towards the flat posture, L.
    displacement: f64,
    /// Critical force of three legs, K L.
    force: f64,
    /// Stiffness of three legs at rest, K.
    stiffness: f64,
    plot: Plot,
}

fn toggle(angle: f64) -> Result<Toggle, Cause> {
    let chain = leg()?;
    let distance = angle.sin();
    let mut end = EndCondition::pose(Pose::translation(angle.cos(), 0.0, distance));
    end.prescribed[4] = Prescribed::Wrench;
    let mut problem = ChainProblem::new(&chain, end);
    problem.posture = vec![0.0, angle, -angle];
    let start = solve_chain(&problem, &Settings::default())?;
    let down = Parameter::Displacement(Twist::new(-Vector3::z(), Vector3::zeros()));
    let mut settings = CurveSettings::within(-0.2 * distance, 2.2 * distance);
    settings.largest_turn = 0.03 * angle;
    let c = follow(&problem, &down, &start, 0.0, &settings)?;
    let limits = of_kind(&c, SpecialKind::LoadLimit);
    let first = limits
        .first()
        .ok_or_else(|| Cause::Missing("the limit point of the toggle frame".into()))?;
    let drawn = Drawn {
        name: "stable under a dead force",
        colour: 0,
        held: false,
        at: &|p| (p.parameter / distance, 3.0 * p.conjugate / distance.powi(3)),
    };
    let mut plot = Plot {
        title: format!("Equation 5.45: force of the toggle frame, phi0 = {angle} rad"),
        x_label: "displacement towards the flat posture / d0".into(),
        y_label: "force F L^2 / (K d0^3)".into(),
        lines: lines(&c, &drawn),
        marks: marks(&c, &drawn, |k| k == SpecialKind::LoadLimit),
    };
    plot.lines
        .push(unstable_entry("unstable under a dead force"));
    Ok(Toggle {
        distance,
        displacement: first.point.parameter,
        force: 3.0 * first.point.conjugate,
        stiffness: 3.0 * start.stiffness.cartesian.matrix[(2, 2)],
        plot,
    })
}

pub(crate) fn eq_5_45() -> Result<Contents, Cause> {
    let mut items = Vec::new();
    let mut plots = Vec::new();
    for angle in [0.01, 0.05, 0.1, 0.2, 0.3, 0.5, 0.8] {
        let t = toggle(angle)?;
        let at = format!("phi0 = {angle} rad");
        let relative = t.displacement / t.distance;
        let name = format!("critical displacement / d0, {at}");
        let scaled = t.force / (t.distance.powi(3) / 3.0_f64.sqrt());
        if angle <= 0.05 {
            // The print is the limit for small angles.
            let note = "The limit for small angles is 1 - 1/sqrt 3 = 0.4226; within 1 % of 0.42 below 0.25 rad.";
            items.push(Item::compared(name, "0.42", relative, "", note));
        } else {
            items.push(Item::unprinted(name, relative, "", ""));
        }
        let name = format!("critical force / (K d0^3/(sqrt 3 L^2)), {at}");
        if angle <= 0.01 {
            let note = "The limit for small angles, within 1 % below 0.14 rad; compared to 1e-4.";
            let mut item = Item::compared(name, "1.000", scaled, "", note);
            item.printed = Some("K/(sqrt 3 L^2) d0^3".into());
            items.push(item);
        } else {
            items.push(Item::unprinted(name, scaled, "", ""));
        }
        // The printed curve at the critical displacement found.
        let phi = (t.distance - t.displacement).asin();
        items.push(Item::formula(
            format!("critical force, {at}"),
            "3 K L (1 - cos(phi0)/cos(phi)) sin(phi)",
            3.0 * (1.0 - angle.cos() / phi.cos()) * phi.sin(),
            t.force,
            "K L",
            "The print at the critical displacement of the model.",
        ));
        items.push(Item::unprinted(
            format!("stiffness at rest, {at}"),
            t.stiffness,
            "K",
            "3 K tan^2(phi0)",
        ));
        if angle == 0.3 {
            plots.push(t.plot);
        }
    }
    Ok(Contents { items, plots })
}
