//! Machines of many platforms for measurements of cost.

use kinetostat::{ActuatorSpec, Chain, Limb, Mechanism, MotionKind, Platform, Pose, Result};
use nalgebra::{Point3, Vector3, vector};

/// A leg from a point of one platform to a point of another, `span` away: with a drive or `rigid`.
pub fn leg(
    name: &str,
    from: usize,
    to: usize,
    [below, above]: [Vector3<f64>; 2],
    span: &Pose,
    rigid: bool,
) -> Result<Limb> {
    let bar = (span * Point3::from(above)).coords - below;
    let unit = bar.normalize();
    let mut chain = Chain::builder(name)
        .translation(below)
        .passive(
            "u1",
            MotionKind::Revolute,
            Vector3::x(),
            (-unit.y).atan2(unit.z),
        )
        .passive("u2", MotionKind::Revolute, Vector3::y(), unit.x.asin());
    if rigid {
        chain = chain.translation(vector![0.0, 0.0, bar.norm()]);
    } else {
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 2e7);
        drive.home = bar.norm();
        chain = chain.actuator("slide", drive);
    }
    let chain = chain.passive_spherical("s").build()?;
    Ok(Limb::between(name, from, to, chain).fixed_at(Pose::translation(above.x, above.y, above.z)))
}

/// Points of leg `i` of six on circles of two radii.
pub fn anchors(i: usize, [low, high]: [f64; 2]) -> [Vector3<f64>; 2] {
    let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
    let third = std::f64::consts::FRAC_PI_3 * 2.0 * (i / 2) as f64;
    let point = |angle: f64, radius: f64| vector![angle.cos(), angle.sin(), 0.0] * radius;
    [
        point(third + side * 0.3, low),
        point(third + side * 0.75, high),
    ]
}

/// Every platform stands on six legs on the one below; a seventh holds it to the one beside;
/// `rigid`: every second one of the sevenths is a bar without a spring.
pub fn lattice(rows: usize, columns: usize, rigid: bool) -> Result<Mechanism> {
    let mut builder = Mechanism::builder("lattice").gravity(vector![0.0, 0.0, -9.81]);
    let home = |row: usize, column: usize| {
        Pose::translation(0.6 * column as f64, 0.01 * row as f64, 0.3 * row as f64)
    };
    let mut limbs = Vec::new();
    for k in 0..rows.max(1) * columns {
        let (row, column) = (k / columns, k % columns);
        let here = home(row + 1, column);
        let mut platform = Platform::new(format!("p{k}"), here);
        platform.mass = 0.05;
        let own = builder.platform(platform);
        let (from, foot, aside) = match row {
            0 => (0, Pose::identity(), home(0, column).translation.vector),
            _ => (own - columns, home(row, column), Vector3::zeros()),
        };
        for i in 0..6 {
            let [below, above] = anchors(i, [0.25, 0.2]);
            let span = foot.inverse() * here;
            limbs.push(leg(
                &format!("{k}.{i}"),
                from,
                own,
                [below + aside, above],
                &span,
                false,
            )?);
        }
        if column > 0 {
            let span = home(row + 1, column - 1).inverse() * here;
            let ends = [vector![0.2, 0.05, 0.02], vector![-0.2, 0.0, -0.03]];
            limbs.push(leg(
                &format!("{k}.side"),
                own - 1,
                own,
                ends,
                &span,
                rigid && k % 2 == 1,
            )?);
        }
    }
    for limb in limbs {
        builder = builder.limb(limb);
    }
    builder.build()
}
