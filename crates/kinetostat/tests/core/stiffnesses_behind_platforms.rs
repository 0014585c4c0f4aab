//! Stiffness of a tool with other platforms behind it, at ratios of stiffnesses at which the tangent of the
//! platforms no longer holds the soft ones: against the same rods in one chain, against a closed form, and
//! against the sum of compliances.

use std::f64::consts::PI;

use kinetostat::*;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6, vector};

use crate::common::machines::slender;
use crate::common::random::Rng;

/// Rods in series from the base to the tool, with a platform after each.
struct Series {
    /// Where every rod begins, against the end of the one before, and its length, m.
    rods: Vec<(Pose, f64)>,
    axial: f64,
    /// Of a body on every rod, kg.
    mass: f64,
}

impl Series {
    fn random(rng: &mut Rng, axial: f64, mass: f64) -> Self {
        let count = 2 + rng.below(3);
        let rods = (0..count)
            .map(|_| (rng.pose(0.05, 0.8), rng.between(0.2, 0.5)))
            .collect();
        Self { rods, axial, mass }
    }

    fn rod(&self, chain: ChainBuilder, i: usize) -> ChainBuilder {
        let (turn, length) = self.rods[i];
        let half = LinkSpec::beam(slender(self.axial), 0.5 * length).segments(4);
        let chain = chain.rigid(turn).link_with(&format!("near {i}"), &half);
        let name = format!("body {i}");
        let chain = match self.mass > 0.0 {
            true => chain.body(&name, self.mass, vector![0.0, 0.01, 0.02], Matrix3::zeros()),
            false => chain,
        };
        chain.link_with(&format!("far {i}"), &half)
    }

    fn end(&self, i: usize) -> Pose {
        let (turn, length) = self.rods[i];
        turn * Pose::translation(length, 0.0, 0.0)
    }

    fn home(&self) -> Pose {
        (0..self.rods.len()).fold(Pose::identity(), |pose, i| pose * self.end(i))
    }

    fn gravity(&self) -> Vector3<f64> {
        vector![1.0, -3.0, -9.0]
    }

    fn as_one_chain(&self) -> Mechanism {
        let mut chain = Chain::builder("rods");
        for i in 0..self.rods.len() {
            chain = self.rod(chain, i);
        }
        Mechanism::serial(chain.build().unwrap(), self.home(), self.gravity()).unwrap()
    }

    /// With a platform behind every rod; limbs in another order than the rods if `mixed`.
    fn as_platforms(&self, mixed: bool) -> Mechanism {
        let mut builder = Mechanism::builder("rods").gravity(self.gravity());
        let mut home = Pose::identity();
        let mut limbs = Vec::new();
        for i in 0..self.rods.len() {
            home *= self.end(i);
            let name = match i + 1 == self.rods.len() {
                true => "tool".to_owned(),
                false => format!("platform {i}"),
            };
            let to = builder.platform(Platform::new(&name, home));
            let chain = self.rod(Chain::builder(&format!("rod {i}")), i);
            let chain = chain.build().unwrap();
            limbs.push(Limb {
                name: format!("rod {i}"),
                from: to - 1,
                to,
                platform_from_tip: Pose::identity(),
                nominal: chain.clone(),
                actual: chain,
            });
        }
        if mixed {
            limbs.reverse();
        }
        for limb in limbs {
            builder = builder.limb(limb);
        }
        builder.build().unwrap()
    }
}

/// Signs and rows with `K = sum s r r^T`.
fn rows(directions: &[Direction], length: f64) -> Vec<(f64, Vector6<f64>, Vector6<f64>)> {
    let unit = Vector6::from_fn(|i, _| if i < 3 { 1.0 } else { length });
    let finite = directions
        .iter()
        .filter(|d| d.stiffness_n_per_m.is_finite() && d.stiffness_n_per_m != 0.0);
    finite
        .map(|d| {
            let motion = d.twist.0.component_mul(&unit).normalize();
            let root = d.stiffness_n_per_m.abs().sqrt();
            (
                d.stiffness_n_per_m.signum(),
                motion.component_mul(&unit) * root,
                motion.component_div(&unit) / root,
            )
        })
        .collect()
}

/// How far two sets of principal directions are from the same stiffness: `C_a K_b - 1`, where motions are measured
/// so that every stiffness of `a` is one.
fn apart(a: (&[Direction], f64), b: (&[Direction], f64)) -> f64 {
    let (own, other) = (rows(a.0, a.1), rows(b.0, b.1));
    assert_eq!(own.len(), other.len());
    let mut worst = 0.0_f64;
    for (i, (sign, _, first)) in own.iter().enumerate() {
        for (j, (_, _, second)) in own.iter().enumerate() {
            let sum: f64 = other
                .iter()
                .map(|(s, r, _)| s * r.dot(first) * r.dot(second))
                .sum();
            worst = worst.max((sum - if i == j { *sign } else { 0.0 }).abs());
        }
    }
    assert!(worst.is_finite());
    worst
}

#[test]
fn rods_in_series_are_as_stiff_with_platforms_between_as_without() {
    let mut rng = Rng(5);
    let mut seen = 0;
    for axial in [1e2, 1e5, 1e7, 1e9, 1e11, 1e13] {
        for case in 0..8 {
            let mass = if case % 2 == 1 && axial < 1e10 {
                0.05
            } else {
                0.0
            };
            let series = Series::random(&mut rng, axial, mass);
            let (one, many) = (series.as_one_chain(), series.as_platforms(case % 4 > 1));
            let home = series.home();
            let size = rng.between(0.0, 12.0);
            let load = Wrench::new(rng.axis() * size, rng.vector(0.2));
            let case = format!(
                "EA {axial:e}, case {case}, {} rods, {size} N",
                series.rods.len()
            );
            let (one, many) = (one.posture(&home).unwrap(), many.posture(&home).unwrap());
            let (a, b) = (one.stiffness().unwrap(), many.stiffness().unwrap());
            let off = apart((&a.directions, a.length), (&b.directions, b.length));
            assert!(off <= 1e-7, "{case}: unloaded {off:e}");
            let (Ok(a), Ok(b)) = (one.deflected_by(&load), many.deflected_by(&load)) else {
                continue;
            };
            let off = pose_residual(&a.tool, &b.tool).0.norm();
            assert!(off <= 1e-8, "{case}: {off:e}");
            let off = apart((&a.directions, a.length), (&b.directions, b.length));
            assert!(off <= 1e-6 + 1e-18 * axial, "{case}: loaded {off:e}");
            assert_eq!(a.platform.stable, b.platform.stable, "{case}");
            assert_eq!(a.platform.free, b.platform.free, "{case}");
            seen += 1;
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
            builder = builder.limb(Limb {
                name: name.into(),
                from: 0,
                to: behind,
                platform_from_tip: from,
                nominal: chain.clone(),
                actual: chain,
            });
        }
        let chain = rod("front", Pose::identity(), 0.4);
        let machine = builder
            .limb(Limb {
                name: "front".into(),
                from: behind,
                to: tool,
                platform_from_tip: Pose::identity(),
                nominal: chain.clone(),
                actual: chain,
            })
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
                let asked = if i == j { 1.0 } else { 0.0 };
                assert!(
                    (value - asked).abs() <= 1e-4,
                    "EA {axial:e}: {i} {j} {value}"
                );
            }
        }
    }
}
