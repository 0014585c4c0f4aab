//! Curves of machines with their branches: a column with platforms on its way buckles at a pitchfork, several equilibria at
//! one load, and jumps between branches. Against the column's search of all shapes and statics by hand.

use kinetostat::{
    CurveSettings, EndCondition, Parameter, Pose, Prescribed, Wrench,
    chain::FoundBy,
    continuation::{BranchEnd, LoadPattern, SpecialKind},
};
use nalgebra::{Vector3, vector};

use crate::curves_of_families::came_down;
use crate::fuzz_short::fuzz::platforms::Series;
use crate::planar_machines::truss;

fn push(force: Vector3<f64>) -> Parameter {
    Parameter::Load(LoadPattern {
        end: Wrench::new(force, Vector3::zeros()),
        loads: Vec::new(),
    })
}

/// Free in some directions, held in the others.
fn free(list: [bool; 6]) -> EndCondition {
    let mut end = EndCondition::wrench(Wrench::zero());
    end.prescribed = list.map(|f| match f {
        true => Prescribed::Wrench,
        false => Prescribed::Pose,
    });
    end
}

/// A column of two limbs with a platform between them, pressed in its plane: straight up to the critical load of a
/// cantilever, `pi^2/4 EI/l^2`, and bent to either side beyond it.
#[test]
fn a_column_of_limbs_buckles_to_either_side() {
    let column = Series {
        rods: vec![(Pose::identity(), 0.5); 2],
        axial: 1e4,
        mass: 0.0,
    };
    let machine = column.as_platforms(false);
    let posture = machine.posture(&column.home()).unwrap();
    let end = free([true, true, false, false, false, true]);
    let mut settings = CurveSettings::within(0.0, 4.0);
    settings.branches = 4;
    let press = push(vector![-1.0, 0.0, 0.0]);
    let curves = posture.curves(&press, &end, &settings).unwrap();
    let forks: Vec<_> = (curves.specials.iter())
        .filter(|s| s.kind == SpecialKind::Pitchfork)
        .collect();
    assert_eq!(forks.len(), 1, "{:?}", curves.specials.len());
    let critical = std::f64::consts::PI.powi(2) / 4.0;
    let off = forks[0].point.parameter / critical - 1.0;
    assert!(off.abs() < 0.1, "{off}");
    assert_eq!(curves.branches.len(), 2);
    assert_eq!(curves.branches[1].ends, [BranchEnd::Range; 2]);
    // Straight and unstable, bent and stable, to both sides alike.
    let at = curves.at(3.5).unwrap();
    assert_eq!(at.len(), 3);
    let mut across: Vec<(f64, bool)> = at
        .iter()
        .map(|p| (p.equilibrium.tool.translation.y, p.dead_load.stable))
        .collect();
    across.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(across[1].0.abs() < 1e-9 && !across[1].1, "{across:?}");
    assert!((across[0].0 + across[2].0).abs() < 1e-7, "{across:?}");
    assert!(across[0].1 && across[2].1, "{across:?}");
    for p in &at {
        assert_eq!(p.equilibrium.found_by, FoundBy::Continuation);
        let down = 1.0 - p.equilibrium.tool.translation.x;
        if p.dead_load.stable {
            assert!((down / came_down(3.5) - 1.0).abs() < 0.08, "{down}");
        }
    }
}

/// A truss under a growing force has three shapes at one load between its limits, and jumps from both.
#[test]
fn a_truss_has_three_shapes_at_one_load() {
    let (b, h, k) = (0.5, 0.1, 1e5);
    let machine = truss(b, h, k);
    let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
    let settings = CurveSettings::within(-200.0, 200.0);
    let end = EndCondition::wrench(Wrench::zero());
    let down = push(vector![0.0, 0.0, -1.0]);
    let curves = posture.curves(&down, &end, &settings).unwrap();
    for force in [-140.0, -50.0, 0.0, 50.0, 140.0] {
        let at = curves.at(force).unwrap();
        assert_eq!(at.len(), 3, "{force}");
        for p in at {
            let z = p.equilibrium.tool.translation.z;
            let l = b.hypot(z);
            let own = 2.0 * k * (l - b.hypot(h)) * z / l;
            assert!((own + force).abs() < 1e-6, "{force}: {own}");
            assert_eq!(
                p.dead_load.unstable_modes,
                usize::from(!p.dead_load.stable),
                "{force}: {z}"
            );
        }
    }
    assert_eq!(curves.jumps().unwrap().len(), 2);
    let own = &curves.branches[0];
    assert!(own.points[own.start].parameter.abs() < 1e-9);
}
