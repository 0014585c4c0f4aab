//! Stiffness of a tool with other platforms behind it, at ratios of stiffnesses at which the tangent of the
//! platforms no longer holds the soft ones: against the same rods in one chain, against a closed form, and
//! against the sum of compliances.

use std::f64::consts::PI;

use kinetostat::{spatial::shift_matrix, *};
use nalgebra::{Matrix6, Vector3, vector};

use crate::fuzz_short::fuzz::platforms::{Series, rows};
use crate::fuzz_short::fuzz::random::Random;
use crate::fuzz_short::fuzz::rod::slender;

#[test]
fn rods_in_series_are_as_stiff_with_platforms_between_as_without() {
    let mut random = Random::new(5);
    let mut seen = 0;
    for axial in [1e2, 1e5, 1e7, 1e9, 1e11, 1e13] {
        for case in 0..8 {
            let mass = if case % 2 == 1 && axial < 1e10 {
                0.05
            } else {
                0.0
            };
            let series = Series::random(&mut random, axial, mass);
            let force = random.axis() * random.between(0.0, 12.0);
            let load = Wrench::new(force, random.vector(0.2));
            match series.difference(case % 4 > 1, &load) {
                Some(Ok(())) => seen += 1,
                Some(Err(difference)) => panic!("{series:?}, {load:?}: {difference}"),
                None => {}
            }
        }
    }
    assert!(seen >= 40, "{seen}");
}

/// Straight, of length 1 in pieces, and pressed by a dead force: Euler's loads, `pi^2/4` of the free end for the
/// first mode of both planes, 9 times that for the second.
#[test]
fn a_pressed_rod_of_several_limbs_goes_away_at_eulers_load() {
    for (pieces, mixed) in [(2, false), (3, true), (5, false)] {
        for axial in [1e4, 1e6, 1e8, 1e9, 1e11, 1e13] {
            let rods = vec![(Pose::identity(), 1.0 / f64::from(pieces)); pieces as usize];
            let series = Series {
                rods,
                axial,
                mass: 0.0,
            };
            let home = series.home();
            let machine = series.as_platforms(mixed);
            let posture = machine.posture(&home).unwrap();
            for (share, lost) in [
                (1e-6, 0),
                (0.98, 0),
                (1.02, 2),
                (3.0, 2),
                (8.8, 2),
                (9.3, 4),
            ] {
                let force = vector![-share * PI * PI / 4.0, 0.0, 0.0];
                let found = posture
                    .deflected_by(&Wrench::new(force, Vector3::zeros()))
                    .unwrap();
                let case = format!("{pieces} limbs, EA {axial:e}, {share} of the load");
                let list = &found.directions;
                let negative = list.iter().filter(|d| d.stiffness_n_per_m < 0.0).count();
                assert_eq!(negative, lost, "{case}");
                assert_eq!(found.platform.stable, lost == 0, "{case}");
                assert_eq!(found.platform.free, 0, "{case}");
            }
        }
    }
}

/// Stiffness of a rod from its begin, clamped, at its end.
fn of_rod(axial: f64, length: f64) -> Matrix6<f64> {
    let l = length;
    let mut k = Matrix6::from_diagonal(&vector![
        axial / l,
        12.0 / l.powi(3),
        12.0 / l.powi(3),
        0.8 / l,
        4.0 / l,
        4.0 / l
    ]);
    for (i, j, sign) in [(1, 5, -1.0), (2, 4, 1.0)] {
        k[(i, j)] = sign * 6.0 / (l * l);
        k[(j, i)] = k[(i, j)];
    }
    k
}

/// Two rods side by side carry a platform, a third rod from there the tool: compliances add up.
#[test]
fn compliances_of_rods_beside_and_behind_each_other_add_up() {
    for axial in [1e3, 1e6, 1e9, 1e11, 1e13] {
        let offset = 0.15;
        let middle = Pose::translation(0.6, 0.0, 0.0);
        let home = Pose::translation(1.0, 0.0, 0.0);
        let rod = |name: &str, from: Pose, length: f64| {
            let link = LinkSpec::beam(slender(axial), length).segments(12);
            let chain = Chain::builder(name).rigid(from).link_with("rod", &link);
            chain.build().unwrap()
        };
        let mut builder = Mechanism::builder("rods");
        let behind = builder.platform(Platform::new("behind", middle));
        let tool = builder.platform(Platform::new("tool", home));
        for (name, y) in [("left", offset), ("right", -offset)] {
            let from = Pose::translation(0.0, y, 0.0);
            let chain = rod(name, from, 0.6);
            builder = builder.limb(Limb::between(name, 0, behind, chain).fixed_at(from));
        }
        let chain = rod("front", Pose::identity(), 0.4);
        let machine = builder
            .limb(Limb::between("front", behind, tool, chain))
            .build()
            .unwrap();
        let found = machine.posture(&home).unwrap().stiffness().unwrap();

        let beside: Matrix6<f64> = [offset, -offset]
            .iter()
            .map(|y| {
                let t = shift_matrix(&vector![0.0, *y, 0.0]);
                t.transpose() * of_rod(axial, 0.6) * t
            })
            .sum();
        let inverse = |k: Matrix6<f64>| {
            // In units in which the diagonal is one nothing is lost.
            let unit = k.diagonal().map(|d| d.sqrt().recip());
            let scaled = Matrix6::from_fn(|i, j| k[(i, j)] * unit[i] * unit[j]);
            let c = scaled.cholesky().unwrap().inverse();
            Matrix6::from_fn(|i, j| c[(i, j)] * unit[i] * unit[j])
        };
        let arm = shift_matrix(&vector![0.4, 0.0, 0.0]);
        let compliance = arm * inverse(beside) * arm.transpose() + inverse(of_rod(axial, 0.4));
        let own = rows(&found.directions, found.length);
        assert_eq!(own.len(), 6);
        for (i, (_, first, _)) in own.iter().enumerate() {
            for (j, (_, second, _)) in own.iter().enumerate() {
                let value = (first.transpose() * compliance * second)[0];
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!(
                    (value - expected).abs() <= 1e-4,
                    "EA {axial:e}: {i} {j} {value}"
                );
            }
        }
    }
}

/// Hexapods on top of each other, of few and of very many, where the tangent is sparse: their compliances at the tool add up.
#[test]
fn compliances_of_hexapods_in_series_add_up() {
    for (count, most) in [(6, 1e-9), (30, 1e-8), (160, 1e-6)] {
        let machine = crate::platforms::lattice(count, 1, false).unwrap();
        let home = |k: usize| machine.platforms()[k].home;
        let tool = home(machine.tool()).translation.vector;
        let mut compliance = Matrix6::zeros();
        for k in 1..=count {
            let span = home(k - 1).inverse() * home(k);
            let mut stage = Matrix6::zeros();
            for i in 0..6 {
                let [below, above] = crate::platforms::anchors(i, [0.25, 0.2]);
                let head = (span * nalgebra::Point3::from(above)).coords;
                let line = (head - below).normalize();
                let arm = head - span.translation.vector;
                let moment = arm.cross(&line);
                let row =
                    nalgebra::Vector6::new(line.x, line.y, line.z, moment.x, moment.y, moment.z);
                stage += 2e7 * row * row.transpose();
            }
            // No platform is turned: the axes of all are those of the base.
            let lever = shift_matrix(&(tool - home(k).translation.vector));
            compliance += lever * stage.try_inverse().unwrap() * lever.transpose();
        }
        let posture = machine.posture(&home(machine.tool())).unwrap();
        let product = posture.stiffness().unwrap().cartesian.matrix * compliance;
        let length = tool.norm() / count as f64;
        for i in 0..6 {
            for j in 0..6 {
                let unit = |k: usize| if k < 3 { 1.0 } else { length };
                let one = if i == j { 1.0 } else { 0.0 };
                let off = (product[(i, j)] - one).abs() * unit(j) / unit(i);
                assert!(off < most, "{count} stages, ({i}, {j}): {off}");
            }
        }
    }
}

/// Under load, where legs have a small stiffness across them: the stiffness of a tall tower against differences of poses.
#[test]
fn a_tall_tower_under_load_is_as_stiff_as_its_motion_says() {
    let machine = crate::platforms::lattice(48, 1, false).unwrap();
    let posture = machine
        .posture(&machine.platforms()[machine.tool()].home)
        .unwrap();
    let wrench = Wrench::new(vector![0.3, -0.2, 0.5], vector![0.1, 0.0, -0.1]);
    let loaded = posture.deflected_by(&wrench).unwrap();
    assert!(loaded.stable());
    let height = 14.4;
    let mut compared = 0;
    for k in 0..6 {
        let step = if k < 3 { 0.05 } else { 0.5 };
        let [ahead, behind] = [step, -step].map(|step| {
            let mut changed = wrench;
            changed.0[k] += step;
            posture.deflected_by(&changed).unwrap().tool
        });
        let twist = kinetostat::spatial::pose_residual(&ahead, &behind);
        let force = loaded.stiffness.matrix * twist.0 / (2.0 * step);
        let unit = |k: usize| if k < 3 { 1.0 } else { height };
        for i in 0..6 {
            let one = if i == k { 1.0 } else { 0.0 };
            let off = (force[i] - one).abs() * unit(k) / unit(i);
            assert!(off < 1e-3, "({i}, {k}): {force}");
            compared += 1;
        }
    }
    assert_eq!(compared, 36);
}
