//! Long chains of any number of coordinates, equally soft and equally loaded.

use kinetostat::{
    BeamSection, Chain, ChainProblem, EndCondition, LinkSpec, MotionKind, Pose, Prescribed, Wrench,
};
use nalgebra::{Vector3, vector};

/// Cantilever of 1 m in segments of six coordinates each.
pub fn cantilever(coordinates: usize) -> Chain {
    let bar = BeamSection::tube(2.1e11, 8.0e10, 0.03, 0.024);
    let link = LinkSpec::beam(bar, 1.0).segments(coordinates.div_ceil(6));
    Chain::builder("cantilever")
        .link_with("bar", &link)
        .build()
        .expect("a cantilever can be built")
}

/// The same of a rod so slender that it bends by the size of its length: `EI = 1`, `EA L^2 / EI = 1e6`.
pub fn soft_cantilever(coordinates: usize) -> Chain {
    let rod = BeamSection {
        youngs_modulus: 1.0,
        shear_modulus: 0.4,
        area: 1e6,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 0.8,
    };
    let link = LinkSpec::beam(rod, 1.0).segments(coordinates.div_ceil(6));
    Chain::builder("soft cantilever")
        .link_with("rod", &link)
        .build()
        .expect("a cantilever can be built")
}

/// Serial arm of 1 m along a helix: elastic joints one after the other, axes in all directions.
#[allow(clippy::cast_precision_loss)]
pub fn arm(coordinates: usize) -> Chain {
    let count = coordinates as f64;
    let mut builder = Chain::builder("arm");
    for k in 0..coordinates {
        let axis = [Vector3::z(), Vector3::y(), Vector3::x()][k % 3];
        let turned = vector![0.3, 0.7, 0.5] * (4.0 / count);
        builder = builder
            .spring(
                &format!("j{k}"),
                MotionKind::Revolute,
                axis,
                300.0 * count,
                0.0,
            )
            .rigid(Pose::new(vector![1.0 / count, 0.0, 0.0], turned));
    }
    builder.build().expect("an arm can be built")
}

/// Conditions on an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// A dead force bends the chain: force given, motion sought.
    Force,
    /// The end is held elsewhere: pose given, force sought.
    Pose,
    /// Two directions held, four under a force.
    Mixed,
    /// A dead force of 10 N across: ten times `EI / L^2` of the soft cantilever.
    BentFar,
}

/// The chain with a load or motion of its end by some hundredths of its length.
pub fn problem(chain: &Chain, asked: Asked) -> ChainProblem<'_> {
    let start = kinetostat::model::unloaded_tip(
        chain,
        &Pose::identity(),
        &chain.home_coordinates(),
        &chain.home_commands(),
    );
    let force = if asked == Asked::BentFar {
        vector![0.0, 10.0, 0.0]
    } else {
        vector![-400.0, 900.0, 300.0]
    };
    let force = Wrench::new(force, Vector3::zeros());
    let mut end = EndCondition::pose(Pose::translation(-0.0012, 0.04, 0.02) * start);
    end.wrench = force;
    for k in 0..6 {
        let free = matches!(asked, Asked::Force | Asked::BentFar)
            || (asked == Asked::Mixed && k != 1 && k != 2);
        if free {
            end.prescribed[k] = Prescribed::Wrench;
        }
    }
    ChainProblem::new(chain, end)
}
