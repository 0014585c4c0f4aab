//! Two platforms on six legs [R 3.34, 3.35].

use kinetostat::number::larger;
use kinetostat::{
    ActuatorSpec, Chain, DirectionKind, Limb, Mechanism, MotionKind, Platform, Pose,
    UnloadedStiffness,
};
use nalgebra::Vector3;

use crate::{Cause, Contents, Item};

/// Radii of base and platform, height (m) and stiffness of a leg (N/m); chosen, the report names none.
const BASE: f64 = 0.5;
const TOP: f64 = 0.3;
const HEIGHT: f64 = 0.6;
const LEG: f64 = 1e6;

/// Angles of the joints on base and platform, degrees [R 3.33].
const CASE_A: [(f64, f64); 6] = [
    (0.0, 0.0),
    (60.0, 60.0),
    (120.0, 120.0),
    (180.0, 180.0),
    (240.0, 240.0),
    (300.0, 300.0),
];
const CASE_B: [(f64, f64); 6] = [
    (0.0, 60.0),
    (120.0, 60.0),
    (120.0, 180.0),
    (240.0, 180.0),
    (240.0, 300.0),
    (360.0, 300.0),
];

fn on_circle(degrees: f64, radius: f64) -> Vector3<f64> {
    let angle = degrees.to_radians();
    Vector3::new(angle.cos(), angle.sin(), 0.0) * radius
}

/// Universal joint, elastic slide, spherical joint: six legs that take one force each, ending at
/// different points of the platform.
fn stiffness(angles: &[(f64, f64); 6]) -> Result<UnloadedStiffness, Cause> {
    let home = Pose::translation(0.0, 0.0, HEIGHT);
    let mut builder = Mechanism::builder("Stewart-Gough");
    let tool = builder.platform(Platform::new("platform", home));
    for (i, (base, top)) in angles.iter().enumerate() {
        let (b, a) = (on_circle(*base, BASE), on_circle(*top, TOP));
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), LEG);
        drive.home = (a - b + Vector3::z() * HEIGHT).norm();
        let chain = Chain::builder(format!("leg {}", i + 1))
            .translation(b)
            .passive_universal("foot", Vector3::x(), Vector3::y())
            .actuator("slide", drive)
            .passive_spherical("head")
            .build()?;
        builder = builder.limb(
            Limb::between(format!("leg {}", i + 1), 0, tool, chain)
                .fixed_at(Pose::translation(a.x, a.y, a.z)),
        );
    }
    Ok(builder.build()?.posture(&home)?.stiffness()?)
}

/// Row and column from 1, the print inside the bracket, its value.
type Entry = (usize, usize, &'static str, f64);

fn compare(k: &UnloadedStiffness, length: f64, printed: &[Entry], notes: &str) -> Vec<Item> {
    let factor = 3.0 * LEG / length.powi(2);
    let unit = |i: usize, j: usize| match (i > 3, j > 3) {
        (false, false) => "N/m",
        (true, true) => "N m/rad",
        _ => "N",
    };
    let mut shown = Vec::new();
    let mut items: Vec<Item> = printed
        .iter()
        .map(|&(i, j, text, value)| {
            shown.push((i, j));
            let text = match text {
                "0" => "0".to_owned(),
                text => format!("3K11/L^2 {text}"),
            };
            let at = k.cartesian.matrix[(i - 1, j - 1)];
            let note = if i == j { notes } else { ARM };
            Item::formula(
                format!("K{i}{j}"),
                &text,
                factor * value,
                at,
                unit(i, j),
                note,
            )
        })
        .collect();
    let mut most = 0.0_f64;
    for i in 1..=6 {
        for j in i..=6 {
            if !shown.contains(&(i, j)) {
                most = larger(most, k.cartesian.matrix[(i - 1, j - 1)].abs() / LEG);
            }
        }
    }
    items.push(Item::formula(
        "largest other entry / K11 of a leg",
        "0",
        0.0,
        most,
        "",
        "",
    ));
    items
}

const INPUT: &str = "R = 0.5 m, r = 0.3 m, h = 0.6 m, K11 = 1e6 N/m (chosen).";
const ARM: &str = "Equations 3.32 with 3.33 as printed give the other sign: the arm of 3.33 must point from the platform's centre to the leg's end.";

pub(crate) fn eq_3_34() -> Result<Contents, Cause> {
    let k = stiffness(&CASE_A)?;
    let (d, h, r) = (BASE - TOP, HEIGHT, TOP);
    let length = (d * d + h * h).sqrt();
    let mut items = compare(
        &k,
        length,
        &[
            (1, 1, "d_a^2", d * d),
            (2, 2, "d_a^2", d * d),
            (3, 3, "2h^2", 2.0 * h * h),
            (4, 4, "r^2 h^2", (r * h).powi(2)),
            (5, 5, "r^2 h^2", (r * h).powi(2)),
            (6, 6, "0", 0.0),
            (1, 5, "rhd_a", r * h * d),
            (2, 4, "-rhd_a", -r * h * d),
        ],
        INPUT,
    );
    let free = k
        .directions
        .iter()
        .filter(|d| d.kind == DirectionKind::Free);
    items.push(Item::erratum(
        "free motions of the platform",
        "1",
        free.count() as f64,
        "",
        "erratum 3.34 text: the text names the rotation about the vertical axis only. All legs meet in one apex: x with R_y and y with R_x are free as well, the rank is 3 at home and wherever the platform is only shifted (5 once it is turned).",
    ));
    items.push(Item::unprinted("rank", k.rank() as f64, "", ""));
    Ok(Contents::of(items))
}

pub(crate) fn eq_3_35() -> Result<Contents, Cause> {
    let k = stiffness(&CASE_B)?;
    let (d, h, r) = (BASE - TOP, HEIGHT, TOP);
    let across = 0.5 * BASE - TOP;
    // The legs are longer than in case A.
    let length = (d * d + BASE * TOP + h * h).sqrt();
    let mut items = compare(
        &k,
        length,
        &[
            (1, 1, "(d_a^2 + Rr)", d * d + BASE * TOP),
            (2, 2, "(d_a^2 + Rr)", d * d + BASE * TOP),
            (3, 3, "2h^2", 2.0 * h * h),
            (4, 4, "r^2 h^2", (r * h).powi(2)),
            (5, 5, "r^2 h^2", (r * h).powi(2)),
            (6, 6, "1.5 r^2 R^2", 1.5 * (r * BASE).powi(2)),
            (1, 5, "rhd_b", r * h * across),
            (2, 4, "-rhd_b", -r * h * across),
        ],
        "R = 0.5 m, r = 0.3 m, h = 0.6 m, K11 = 1e6 N/m (chosen); L^2 = d_a^2 + R r + h^2, longer than in case A.",
    );
    items.push(Item::unprinted("rank", k.rank() as f64, "", ""));
    Ok(Contents::of(items))
}
