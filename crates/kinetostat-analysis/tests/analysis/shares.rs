//! Shares of a deflection: they add to one, agree with the stiffness that is computed otherwise, with closed forms, and with what the
//! machine does when one spring is changed.

use kinetostat::machine::MachineResidual;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Mechanism, MotionKind, Pose, Posture, PostureRequest, Wrench,
};
use kinetostat_analysis::shares::{PartKind, Shares, SharesError};
use kinetostat_model::{Model, preset_names};
use nalgebra::Vector3;

/// A direction along no axis, force and moment.
pub(crate) fn off_axis() -> Wrench {
    Wrench::new(
        Vector3::new(0.53, -0.41, 0.74),
        Vector3::new(0.021, 0.034, -0.017),
    )
}

/// Off the home, if the machine can go there.
pub(crate) fn posture(model: &Model) -> Posture {
    let m = &model.mechanism;
    let home = m.platforms()[m.tool()].home;
    let beside = Pose::from_parts(
        (home.translation.vector + Vector3::new(0.011, -0.007, 0.013)).into(),
        home.rotation,
    );
    if m.turns_as_it_moves() {
        let request = PostureRequest::position(&beside.translation.vector, &home.rotation);
        m.posture(request)
            .or_else(|_| m.posture(&home))
            .expect("home")
    } else {
        m.posture(&beside)
            .or_else(|_| m.posture(&home))
            .expect("home")
    }
}

fn sum(shares: &Shares) -> f64 {
    shares.parts.iter().map(|part| part.share).sum()
}

#[test]
fn shares_of_every_preset_add_to_one_and_agree_with_the_stiffness() {
    let (mut unloaded, mut loaded, mut turned) = (0, 0, 0);
    let mut refused = Vec::new();
    for preset in preset_names() {
        let name = preset.name;
        let model = Model::preset(name).expect(name);
        let posture = posture(&model);
        for direction in [
            Wrench::new(Vector3::x(), Vector3::zeros()),
            Wrench::new(Vector3::new(0.3, 0.5, -0.8), Vector3::zeros()),
            off_axis(),
        ] {
            let stiffness = posture.stiffness().expect(name);
            match Shares::unloaded(&posture, &direction) {
                Ok(shares) => {
                    assert!(
                        (sum(&shares) - 1.0).abs() < 1e-12,
                        "{name}: {:e}",
                        sum(&shares) - 1.0
                    );
                    assert!(
                        shares.rounding.abs() < 1e-12,
                        "{name}: {:e}",
                        shares.rounding
                    );
                    assert!(shares.parts.iter().all(|p| p.share > -1e-15), "{name}");
                    assert!(shares.geometric() == 0.0, "{name}: nothing acts");
                    let unit = direction.0.normalize();
                    let own = unit.dot(&(stiffness.compliance().springs * unit));
                    assert!(
                        (shares.compliance / own - 1.0).abs() < 1e-9,
                        "{name}: {} {own}",
                        shares.compliance
                    );
                    unloaded += 1;
                }
                Err(error) => refused.push(format!("{name}: {error}")),
            }
            let load = Wrench::new(
                Vector3::new(61.0, -83.0, -47.0),
                Vector3::new(1.1, 0.7, -1.9),
            );
            let Ok(found) = posture.deflected_by(&(0.3 * load)) else {
                continue;
            };
            if let Ok(shares) = Shares::at(&posture, &found, &direction) {
                assert!(
                    (sum(&shares) - 1.0).abs() < 1e-12,
                    "{name} loaded: {:e}",
                    sum(&shares) - 1.0
                );
                assert!(
                    shares.rounding.abs() < 1e-10,
                    "{name} loaded: {:e}",
                    shares.rounding
                );
                let unit = direction.0.normalize();
                let own = unit.dot(&(found.compliance().springs * unit));
                assert!(
                    (shares.compliance / own - 1.0).abs() < 1e-8,
                    "{name}: {} {own}",
                    shares.compliance
                );
                loaded += 1;
                turned += usize::from(shares.geometric().abs() > 1e-9);
            }
        }
    }
    println!("{unloaded} unloaded, {loaded} loaded, {turned} with geometric shares; {refused:?}");
    assert!(unloaded >= 60 && loaded >= 60 && turned >= 30);
}

#[test]
fn springs_in_series_and_a_cantilever_give_what_the_formulas_say() {
    let (e, length, arm) = (2.1e11, 0.8, 0.35);
    let section = BeamSection::tube(e, 8.1e10, 0.06, 0.04);
    let (k, turn) = (3.0e5, 7.0e4); // N/m, N m/rad
    let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::y(), k);
    let hinge = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), turn);
    let chain = Chain::builder("crane")
        .actuator("slide", slide)
        .actuator("hinge", hinge)
        .link("boom", &section, length)
        .translation(Vector3::new(arm, 0.0, 0.0))
        .build()
        .expect("a chain");
    let home = Pose::translation(length + arm, 0.0, 0.0);
    let crane = Mechanism::serial(chain, home, Vector3::zeros()).expect("a machine");
    let posture = crane.posture(&home).expect("home");
    let shares =
        Shares::unloaded(&posture, &Wrench::new(Vector3::y(), Vector3::zeros())).expect("shares");
    let bending = ((length + arm).powi(3) - arm.powi(3)) / (3.0 * e * section.second_moment_z);
    let parts = [1.0 / k, (length + arm).powi(2) / turn, bending];
    let all: f64 = parts.iter().sum();
    for (part, expected) in shares.parts.iter().zip(parts) {
        assert!((part.share - expected / all).abs() < 1e-12, "{part:?}");
        assert!((part.compliance / expected - 1.0).abs() < 1e-10, "{part:?}");
    }
    let kinds: Vec<_> = shares
        .parts
        .iter()
        .map(|p| (p.name.as_str(), p.kind))
        .collect();
    let expected = [
        ("slide", PartKind::Drive),
        ("hinge", PartKind::Drive),
        ("boom", PartKind::Link),
    ];
    assert_eq!(kinds, expected);
}

#[test]
fn a_spring_that_is_changed_changes_the_compliance_by_its_share() {
    for name in [
        "orthoglide",
        "heavy_6r",
        "hexapod",
        "gantry_with_tripod",
        "arm_with_parallel_wrist",
    ] {
        let model = Model::preset(name).expect(name);
        let posture = posture(&model);
        let direction = off_axis();
        let shares = Shares::unloaded(&posture, &direction).expect(name);
        let unit = direction.0.normalize();
        let compliance = |factors: &[(usize, usize, f64)]| {
            let changed = posture.mechanism().with_springs_scaled(factors);
            let joints = PostureRequest::joints(posture.target(), posture.limbs().to_vec());
            let stands = changed.posture(joints).expect(name);
            let c = stands.stiffness().expect(name).compliance().springs;
            unit.dot(&(c * unit))
        };
        let mut compared = 0;
        for part in shares.parts.iter().filter(|p| p.share > 1e-3) {
            // By the flexibility 1/k: its derivative is the share, exactly.
            let at = |flexibility: f64| {
                let factors: Vec<_> = part
                    .springs
                    .iter()
                    .map(|&(l, s)| (l, s, 1.0 / flexibility))
                    .collect();
                compliance(&factors)
            };
            let d = |h: f64| (at(1.0 + h) - at(1.0 - h)) / (2.0 * h);
            let derivative = (4.0 * d(5e-3) - d(1e-2)) / 3.0;
            let off = (derivative / shares.compliance - part.share).abs();
            assert!(off < 1e-8, "{name} {}: {derivative:e}, {off:e}", part.name);
            compared += 1;
        }
        assert!(compared >= 3, "{name}: {compared}");
        // Made rigid, a spring of a serial machine leaves the rest.
        if name == "heavy_6r" {
            let part = shares.elastic()[0];
            let rigid: Vec<_> = part.springs.iter().map(|&(l, s)| (l, s, 1e7)).collect();
            let left = compliance(&rigid) / shares.compliance;
            assert!((left - (1.0 - part.share)).abs() < 1e-6, "{left}");
        }
    }
}

#[test]
fn absurd_directions_are_refused_by_name() {
    let model = Model::preset("orthoglide").expect("a preset");
    let posture = posture(&model);
    assert_eq!(
        Shares::unloaded(&posture, &Wrench::zero()),
        Err(SharesError::NoDirection)
    );
    let chain = Chain::builder("table")
        .actuator(
            "x",
            ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e6),
        )
        .passive("y", MotionKind::Prismatic, Vector3::y(), 0.0)
        .build()
        .expect("a chain");
    let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros()).expect("a machine");
    let posture = table.posture(&Pose::identity()).expect("home");
    let along = |v: Vector3<f64>| Shares::unloaded(&posture, &Wrench::new(v, Vector3::zeros()));
    assert_eq!(along(Vector3::y()), Err(SharesError::Free));
    assert_eq!(along(Vector3::z()), Err(SharesError::Rigid));
    let shares = along(Vector3::x()).expect("the drive yields");
    assert_eq!(
        shares.passive_joints,
        [("table".to_owned(), "y".to_owned())]
    );
    assert!((shares.parts[0].share - 1.0).abs() < 1e-14);
    assert!(MachineResidual::combined(&[]).is_none());
}
