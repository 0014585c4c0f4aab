//! Every preset loads, and gives the numbers of its source.

use kinetostat::{
    Pose, Wrench,
    model::{Element, SpringLaw},
};
use kinetostat_model::{Model, preset_names, preset_text, schema};
use kinetostat_testing::{LargestEntry, largest_size};
use nalgebra::{Matrix6, Translation3, UnitQuaternion, Vector3};

fn preset(name: &str) -> Model {
    Model::preset(name).unwrap_or_else(|e| panic!("{e}"))
}

fn spring(model: &Model, name: &str) -> Matrix6<f64> {
    let chain = &model.mechanism.limbs()[0].nominal;
    let block = chain
        .springs()
        .iter()
        .find(|s| s.name == name)
        .expect("spring");
    match &block.law {
        SpringLaw::Linear(matrix) => Matrix6::from_fn(|i, j| matrix[(i, j)]),
        other => panic!("{other:?}"),
    }
}

/// Close, relative to the largest of the expected numbers.
fn close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let size = largest_size(expected.iter().copied());
    for (f, e) in found.iter().zip(expected) {
        assert!(
            (f - e).abs() <= tolerance * size,
            "{found:?} instead of {expected:?}"
        );
    }
}

#[test]
fn every_preset_loads_without_a_warning() {
    for p in preset_names() {
        let model = preset(p.name);
        assert_eq!(model.name(), p.name);
        assert!(model.warnings.is_empty(), "{}", model.warnings[0]);
        assert_eq!(Some(model.text.as_str()), preset_text(p.name));
        assert!(!p.description.is_empty() && p.description.len() < 100);
    }
}

#[test]
fn an_unknown_preset_is_refused_with_the_nearest() {
    let error = Model::preset("ortoglide").expect_err("unknown").to_string();
    assert!(
        error.contains("there is no preset named 'ortoglide'")
            && error.contains("did you mean 'orthoglide'?"),
        "{error}"
    );
    let error = Model::preset("palletiser")
        .expect_err("unknown")
        .to_string();
    assert!(
        error.contains("orthoglide, stewart_gough_a, stewart_gough_b"),
        "{error}"
    );
}

#[test]
fn every_figure_of_the_presets_has_a_source_or_is_an_assumption() {
    for p in preset_names() {
        let document = preset(p.name).document;
        let whole = document.mechanism.source.is_some() && document.mechanism.assumption.is_some();
        assert!(whole, "{}", p.name);
        for (key, section) in &document.section {
            assert!(
                section.source.is_some() || section.assumption.is_some(),
                "{} {key}",
                p.name
            );
        }
    }
    // The arm is nobody's machine in particular: each of its elements says so.
    for element in &preset("heavy_6r").document.chain["arm"].elements {
        let marked = match element {
            schema::Element::Actuator(e) => e.assumption.is_some(),
            schema::Element::Link(e) => e.assumption.is_some(),
            schema::Element::Body(e) => e.assumption.is_some(),
            _ => false,
        };
        assert!(marked, "{element:?}");
    }
}

#[test]
fn orthoglide_has_the_identified_parameters() {
    let model = preset("orthoglide");
    // Printed in N, mm, rad: x n w rx rn rw.
    let printed = [
        [1.0302222e5, 9.6657778e4, 0.0, 0.0, 0.0, 3.3752564e5],
        [9.6657778e4, 1.0302222e5, 0.0, 0.0, 0.0, -3.3752564e5],
        [0.0, 0.0, 2.2702222e3, -1.2039671e5, 1.2039671e5, 0.0],
        [0.0, 0.0, -1.2039671e5, 1.0613333e7, -6.4133333e6, 0.0],
        [0.0, 0.0, 1.2039671e5, -6.4133333e6, 1.0613333e7, 0.0],
        [3.3752564e5, -3.3752564e5, 0.0, 0.0, 0.0, 4.7733333e7],
    ];
    let foot = spring(&model, "foot");
    for i in 0..6 {
        for j in 0..6 {
            let unit = match (i < 3, j < 3) {
                (true, true) => 1e-3,
                (false, false) => 1e3,
                _ => 1.0,
            };
            let found = foot[(i, j)] * unit;
            assert!(
                (found - printed[i][j]).abs() <= 1e-7 * printed[i][j].abs().max(1.0),
                "({i}, {j}): {found} instead of {}",
                printed[i][j]
            );
        }
    }
    let leg = &model.mechanism.limbs()[0].nominal;
    let bars = leg
        .springs()
        .iter()
        .find(|s| s.name == "q2.bars")
        .expect("bars");
    let SpringLaw::Parallelogram(law) = &bars.law else {
        panic!("{bars:?}");
    };
    let k = &law.bar;
    close(
        &[k[(0, 0)], k[(1, 1)], k[(1, 5)], k[(5, 5)], k[(3, 3)]],
        &[3.25e7, 18.03e3, -2878.5, 598.8, 34.76],
        1e-15,
    );
    assert_eq!(law.width, 0.08);
    let offsets: Vec<f64> = leg
        .elements()
        .iter()
        .filter_map(|e| match e {
            Element::Rigid(p) => Some(p.translation.vector.sum()),
            _ => None,
        })
        .collect();
    close(&offsets, &[-0.1097, 0.1097, 0.31, 0.0405], 1e-15);
    let slider = &leg.actuators()[0];
    close(&[slider.home], &[-0.3505], 1e-15);
    let drive = leg
        .springs()
        .iter()
        .find(|s| s.name == "slider")
        .expect("drive");
    close(&[drive.stiffness_at(&[])[(0, 0)]], &[1e9], 1e-15);
    let (low, high) = model.workspace().expect("workspace");
    close(low.as_slice(), &[-0.07365; 3], 1e-15);
    close(high.as_slice(), &[0.12635; 3], 1e-15);
}

#[test]
fn orthoglide_has_the_compliance_of_the_reference() {
    let model = preset("orthoglide");
    let far = 0.12635;
    let near = -0.07365;
    // Table 2.4: C_pp 1e-4 mm/N (xx yy zz xy xz yz), C_phiphi 1e-7 rad/(N mm).
    let points: [([f64; 3], [f64; 6], [f64; 3]); 5] = [
        (
            [0.0; 3],
            [3.331344, 3.331344, 3.331344, 0.0, 0.0, 0.0],
            [2.388648; 3],
        ),
        (
            [far; 3],
            [
                28.86266, 28.86266, 28.86266, -13.84484, -13.84484, -13.84484,
            ],
            [4.323393; 3],
        ),
        (
            [near; 3],
            [11.85813, 11.85813, 11.85813, 6.722589, 6.722589, 6.722589],
            [2.611156; 3],
        ),
        (
            [far, far, near],
            [13.74697, 23.1106, 6.143698, -15.3025, 2.251451, -1.082547],
            [3.144696, 3.142878, 2.486778],
        ),
        (
            [near, near, far],
            [10.88361, 4.275193, 6.407367, 1.877809, 1.178559, -1.229421],
            [2.845191, 2.84494, 3.503311],
        ),
    ];
    for (at, linear, angular) in points {
        let posture = model
            .mechanism
            .posture(&Pose::translation(at[0], at[1], at[2]))
            .expect("reachable");
        assert!(posture.limit_violations().is_empty());
        let stiffness = posture.stiffness().expect("stiffness");
        let c = stiffness.cartesian.compliance().expect("regular");
        let found: Vec<f64> = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
            .iter()
            .map(|&ij| c[ij] * 1e7)
            .collect();
        close(&found, &linear, 1e-6);
        let found: Vec<f64> = (3..6).map(|i| c[(i, i)] * 1e4).collect();
        close(&found, &angular, 1e-6);
    }
}

#[test]
fn orthoglide_with_errors_of_assembly_moves_as_the_reference() {
    let one_degree = Pose::rotation(Vector3::x() * 1f64.to_radians());
    let mut model = preset("orthoglide");
    for limb in ["leg x", "leg y", "leg z"] {
        model = model
            .with_deviation(limb, "line", &one_degree)
            .expect("deviation");
    }
    for limb in model.mechanism.limbs() {
        assert_eq!(limb.nominal.elements().len(), limb.actual.elements().len());
        assert_ne!(limb.nominal, limb.actual);
    }
    // Non-linear equilibrium of the table, mm and degrees.
    for (at, shift, turn) in [
        ([0.0; 3], [-0.005586; 3], [0.029448; 3]),
        ([126.35; 3], [0.413876; 3], [-0.623271; 3]),
        (
            [126.35, 126.35, -73.65],
            [-0.904711, 1.306019, 0.587147],
            [-0.190943, -0.488047, 0.437762],
        ),
    ] {
        let target = Pose::translation(at[0] / 1e3, at[1] / 1e3, at[2] / 1e3);
        let rest = model
            .mechanism
            .posture(&target)
            .and_then(|p| p.deflected_by(&Wrench::zero()))
            .expect("equilibrium");
        let found = rest.displacement.linear() * 1e3;
        assert!(
            (found - Vector3::from(shift)).largest_entry() < 2e-6,
            "{found}"
        );
        let found = rest.displacement.angular() * 180.0 / std::f64::consts::PI;
        assert!(
            (found - Vector3::from(turn)).largest_entry() < 2e-6,
            "{found}"
        );
    }
    let drawn = model.without_deviations().expect("drawn");
    assert!(
        drawn
            .mechanism
            .limbs()
            .iter()
            .all(|l| l.nominal == l.actual)
    );
}

#[test]
fn stewart_gough_platforms_have_the_printed_matrices() {
    // Kxx = Kyy, Kzz, Krx = Kry, Krz, K15 = -K24; N/m, N m/rad, N/rad.
    for (name, k, rank) in [
        ("stewart_gough_a", [3e5, 5.4e6, 2.43e5, 0.0, 2.7e5], 3),
        (
            "stewart_gough_b",
            [
                1036363.63636,
                3927272.72727,
                176727.272727,
                184090.909091,
                -49090.9090909,
            ],
            6,
        ),
    ] {
        let mechanism = preset(name).mechanism;
        let home = mechanism.platforms()[mechanism.tool()].home;
        let posture = mechanism.posture(&home).expect("home");
        let found = posture.stiffness().expect("stiffness").cartesian.matrix;
        let mut expected = Matrix6::zeros();
        for (i, value) in [k[0], k[0], k[1], k[2], k[2], k[3]].into_iter().enumerate() {
            expected[(i, i)] = value;
        }
        (expected[(0, 4)], expected[(4, 0)]) = (k[4], k[4]);
        (expected[(1, 3)], expected[(3, 1)]) = (-k[4], -k[4]);
        assert!(
            (found - expected).largest_entry() < 1e-10 * k[1] + 1e-5,
            "{name}: {found:.4}"
        );
        // By hand: every leg is a two-force member.
        let mut by_hand = Matrix6::zeros();
        for limb in mechanism.limbs() {
            let Some(Element::Rigid(foot)) = limb.nominal.elements().first() else {
                panic!("no start");
            };
            let head = limb.platform_from_tip.translation.vector;
            let along = (home.translation.vector + head - foot.translation.vector).normalize();
            let moment = head.cross(&along);
            let w = nalgebra::vector![along.x, along.y, along.z, moment.x, moment.y, moment.z];
            by_hand += 1e6 * w * w.transpose();
        }
        assert!((by_hand - expected).largest_entry() < 1e-10 * k[1] + 1e-5);
        let stiff = by_hand
            .symmetric_eigenvalues()
            .iter()
            .filter(|e| e.abs() > 1.0)
            .count();
        assert_eq!(stiff, rank, "{name}");
    }
}

#[test]
fn two_links_stand_as_in_the_reference() {
    let mechanism = preset("two_link").mechanism;
    let home = mechanism.platforms()[1].home;
    let posture = mechanism.posture(&home).expect("home");
    close(&posture.commands(), &[-30f64.to_radians()], 1e-12);
    let chain = &mechanism.limbs()[0].nominal;
    assert_eq!(chain.nodes(), ["elbow", "tip"]);
    // Table of 4.6.1, G = 0: F_x at dx = -0.05, 0, 0.05.
    for (dx, force) in [(-0.05, -0.4940319939), (0.0, 0.0), (0.05, 1.889467338)] {
        let at = Translation3::new(dx, 0.0, 0.0) * home;
        let held = posture.wrench_at(&at).expect("equilibrium");
        assert!(
            (held.wrench.force().x - force).abs() < 1e-8,
            "{dx}: {}",
            held.wrench.force().x
        );
    }
}

/// Table 5.1 and its exact values: the straight chain and the Z, unloaded at home.
#[test]
fn three_links_stand_as_in_the_reference() {
    for (name, rest, stiffness) in [
        ("three_link_s", 0.0, None),
        ("three_link_z", -30f64.to_radians(), Some(16.92820323)),
    ] {
        let mechanism = preset(name).mechanism;
        let chain = &mechanism.limbs()[0].nominal;
        assert_eq!(chain.nodes(), ["first joint", "second joint", "tip"]);
        let posture = mechanism
            .posture(&mechanism.platforms()[1].home)
            .expect("home");
        let joints = &posture.limbs()[0].coordinates;
        close(&joints[1..3], &[rest, -rest], 1e-12);
        let held = posture
            .wrench_at(&mechanism.platforms()[1].home)
            .expect("equilibrium");
        assert!(held.wrench.0.norm() < 1e-11, "{name}: {:?}", held.wrench);
        if let Some(expected) = stiffness {
            // With the end free to turn, as the chain's own passive joint lets it.
            let k = posture.stiffness().expect("stiffness").cartesian.matrix;
            assert!((k[(0, 0)] - expected).abs() < 1e-8, "{name}: {k}");
        }
    }
}

#[test]
fn puu3_is_the_benchmark_machine() {
    let model = preset("puu3");
    let tube = kinetostat::BeamSection::tube(2.1e11, 2.1e11 / 2.6, 0.022, 0.014);
    let found = spring(&model, "strut");
    assert!(
        (found - tube.cantilever(0.31).expect("a section")).largest_entry()
            <= 1e-12 * found.largest_entry()
    );
    let bar = kinetostat::BeamSection::tube(2.1e11, 2.1e11 / 2.6, 0.04, 0.0);
    let found = spring(&model, "foot");
    assert!(
        (found - bar.cantilever(0.08).expect("a section")).largest_entry()
            <= 1e-12 * found.largest_entry()
    );
    // Closed-form commands at a point inside (bench: rho = d_x - L cos q1 cos q2).
    let target = Vector3::new(0.05, -0.07, 0.03);
    let posture = model
        .mechanism
        .posture(&Pose::translation(target.x, target.y, target.z))
        .expect("reachable");
    let expected: Vec<f64> = (0..3)
        .map(|i| {
            let (x, y, z) = (target[i], target[(i + 1) % 3], target[(i + 2) % 3]);
            x - 0.03 - (0.31f64.powi(2) - y * y - z * z).sqrt()
        })
        .collect();
    close(&posture.commands(), &expected, 1e-10);
}

/// Axes of a link along `v`, written out independently of the crate.
fn along(v: Vector3<f64>) -> nalgebra::Matrix3<f64> {
    let d = v.normalize();
    let h = if d.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::y()
    };
    let y = h.cross(&d).normalize();
    nalgebra::Matrix3::from_columns(&[d, y, d.cross(&y)])
}

#[test]
fn heavy_arm_is_the_benchmark_machine() {
    let model = preset("heavy_6r");
    let lengths = [
        [0.35, 0.0, 0.75],
        [0.0, 0.0, 1.25],
        [0.55, 0.0, -0.055],
        [0.55, 0.0, 0.0],
        [0.23, 0.0, 0.0],
        [0.15, 0.0, 0.10],
    ];
    let tubes = [
        (0.40, 0.36),
        (0.32, 0.28),
        (0.26, 0.23),
        (0.22, 0.19),
        (0.16, 0.13),
        (0.12, 0.08),
    ];
    let names = ["column", "upper arm", "elbow", "forearm", "wrist", "flange"];
    for ((name, v), (outer, inner)) in names.into_iter().zip(lengths).zip(tubes) {
        let v = Vector3::from(v);
        let tube = kinetostat::BeamSection::tube(2.1e11, 2.1e11 / 2.6, outer, inner);
        let turn = along(v);
        let mut big = Matrix6::zeros();
        big.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
        big.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn);
        let expected = big * tube.cantilever(v.norm()).expect("a section") * big.transpose();
        let found = spring(&model, name);
        assert!(
            (found - expected).largest_entry() <= 1e-12 * expected.largest_entry(),
            "{name}"
        );
    }
    let arm = &model.mechanism.limbs()[0].nominal;
    let masses: Vec<f64> = arm.bodies().iter().map(|b| b.mass).collect();
    close(&masses, &[330.0, 270.0, 190.0, 90.0, 35.0, 25.0], 0.0);
    assert_eq!(arm.coordinate_count(), 42);
    assert_eq!(model.mechanism.gravity(), Vector3::new(0.0, 0.0, -9.81));
    // Direct kinematics at home, by hand.
    let axes = [
        Vector3::z_axis(),
        Vector3::y_axis(),
        Vector3::y_axis(),
        Vector3::x_axis(),
        Vector3::y_axis(),
        Vector3::x_axis(),
    ];
    let mut pose = Pose::identity();
    for ((axis, v), command) in axes.iter().zip(lengths).zip(arm.home_commands()) {
        pose *= UnitQuaternion::from_axis_angle(axis, command);
        pose *= Translation3::from(Vector3::from(v));
    }
    let home = model.mechanism.platforms()[1].home;
    assert!((pose.translation.vector - home.translation.vector).norm() < 1e-12);
    // The chain ends with its x along the flange's z.
    let flange = pose.rotation
        * model.mechanism.limbs()[0]
            .platform_from_tip
            .rotation
            .inverse();
    assert!(flange.angle_to(&home.rotation) < 1e-12);
    assert!(
        (home.rotation * Vector3::z() + Vector3::z()).norm() < 1e-12,
        "tools point down"
    );
    let posture = model.mechanism.posture(&home).expect("home");
    close(&posture.commands(), &arm.home_commands(), 1e-9);
    // Under its own weight the arm sags by a few millimetres, not by metres or microns.
    let sag = posture
        .deflected_by(&Wrench::zero())
        .expect("rest")
        .displacement
        .linear();
    assert!((-0.02..-0.0005).contains(&sag.z), "{sag}");
}
