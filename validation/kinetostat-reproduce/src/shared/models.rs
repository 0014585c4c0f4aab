//! The chains of chapters 4 and 5, planar in x and y, in units of link length and spring stiffness.

use kinetostat::{
    Chain, ChainBuilder, ChainProblem, EndCondition, Error, Load, MotionKind, Parameter, Pose,
    Prescribed, Twist, Wrench,
};
use nalgebra::Vector3;

/// Inclination of the links of 4.6 at rest, rad: `theta0 = -30 deg = -2 alpha0`.
pub(crate) const ALPHA0: f64 = std::f64::consts::PI / 12.0;

/// Half the distance of the ends of the chains of 4.6 at rest is the cosine.
pub(crate) fn at_rest() -> f64 {
    2.0 * ALPHA0.cos()
}

/// Critical load of 4.6.1, `G* = (4 K/L) sin(alpha0)`.
pub(crate) fn critical_load() -> f64 {
    4.0 * ALPHA0.sin()
}

/// 4.6.1: hinge, rigid link, torsion spring at rest at `-2 alpha0`, rigid link, hinge. The load
/// acts on the node `middle`.
pub(crate) fn rigid_links() -> Result<Chain, Error> {
    rigid_links_of(1.0, 1.0)
}

/// Two rigid links of other lengths.
pub(crate) fn rigid_links_of(first: f64, second: f64) -> Result<Chain, Error> {
    let z = Vector3::z();
    Chain::builder("two rigid links")
        .passive("q1", MotionKind::Revolute, z, 0.0)
        .translation(Vector3::new(first, 0.0, 0.0))
        .node("middle")
        .spring("theta", MotionKind::Revolute, z, 1.0, -2.0 * ALPHA0)
        .translation(Vector3::new(second, 0.0, 0.0))
        .passive("q2", MotionKind::Revolute, z, 0.0)
        .build()
}

/// Axial stiffness of the links of 4.6.2, `K_L = 200 K/L^2` [R Figure 4.5].
pub(crate) const LINK_STIFFNESS: f64 = 200.0;

/// 4.6.2: as 4.6.1, with links that are springs along their length; the torsion spring rests at
/// `-2 rest`.
pub(crate) fn elastic_links(rest: f64) -> Result<Chain, Error> {
    elastic_links_of(1.0, 1.0, rest)
}

/// Two elastic links of other lengths.
pub(crate) fn elastic_links_of(first: f64, second: f64, rest: f64) -> Result<Chain, Error> {
    let (z, x) = (Vector3::z(), Vector3::x());
    Chain::builder("two elastic links")
        .passive("q1", MotionKind::Revolute, z, 0.0)
        .translation(Vector3::new(first, 0.0, 0.0))
        .spring("theta1", MotionKind::Prismatic, x, LINK_STIFFNESS, 0.0)
        .node("middle")
        .spring("theta2", MotionKind::Revolute, z, 1.0, -2.0 * rest)
        .translation(Vector3::new(second, 0.0, 0.0))
        .spring("theta3", MotionKind::Prismatic, x, LINK_STIFFNESS, 0.0)
        .passive("q2", MotionKind::Revolute, z, 0.0)
        .build()
}

/// 5.5.1: rigid links of unit length, a hinge at the base, torsion springs between the links. `rest`
/// gives the springs' angles at rest, rad.
pub(crate) fn linked(name: &str, rest: &[f64]) -> ChainBuilder {
    let z = Vector3::z();
    let mut b = Chain::builder(name).passive("q", MotionKind::Revolute, z, 0.0);
    for (i, rest) in rest.iter().enumerate() {
        let name = format!("theta{}", i + 1);
        b = b.translation(Vector3::new(1.0, 0.0, 0.0));
        b = b.spring(&name, MotionKind::Revolute, z, 1.0, *rest);
    }
    b.translation(Vector3::new(1.0, 0.0, 0.0))
}

/// Linked chain with the hinge at the end [R 5.5.1].
fn hinged(name: &str, rest: &[f64]) -> Result<Chain, Error> {
    linked(name, rest)
        .passive("end", MotionKind::Revolute, Vector3::z(), 0.0)
        .build()
}

/// 5.5.1, straight at rest.
pub(crate) fn s_chain() -> Result<Chain, Error> {
    hinged("S chain", &[0.0, 0.0])
}

/// 5.5.1, a zigzag of -30 and +30 degrees at rest.
pub(crate) fn z_chain() -> Result<Chain, Error> {
    let a = 30_f64.to_radians();
    hinged("Z chain", &[-a, a])
}

/// End of the Z chain at rest: `sqrt(5 + 4 cos 30 deg)`.
pub(crate) fn z_at_rest() -> f64 {
    (5.0 + 4.0 * 30_f64.to_radians().cos()).sqrt()
}

/// The end is held at `(x, 0)` and turns freely.
pub(crate) fn displacement_controlled(chain: &Chain, x: f64) -> ChainProblem<'_> {
    let mut end = EndCondition::pose(Pose::translation(x, 0.0, 0.0));
    end.prescribed[5] = Prescribed::Wrench;
    ChainProblem::new(chain, end)
}

/// A load `g` times `G*` downwards on the middle of a chain of 4.6.
pub(crate) fn load_on_middle(chain: &Chain, g: f64) -> Result<Vec<Load>, Error> {
    let force = Vector3::new(0.0, -g * critical_load(), 0.0);
    let wrench = Wrench::new(force, Vector3::zeros());
    let node = chain.node("middle")?;
    Ok(vec![Load::Dead { node, wrench }])
}

/// The end's motion along x.
pub(crate) fn along_x() -> Parameter {
    Parameter::Displacement(Twist::new(Vector3::x(), Vector3::zeros()))
}
