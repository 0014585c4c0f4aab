//! Virtual experiments with a known truth: exact tables, noise, bad interfaces, bad loads.

use kinetostat::BeamSection;
use kinetostat_links::{
    LoadCase, identify, read_displacements, read_loads, rigid_fit, rigid_rank, unit_loads,
};
use kinetostat_testing::{Worst, largest};
use nalgebra::{Matrix6, Vector3, Vector6};

use crate::{apart, at_least, at_most, text};

/// Reproducible normal noise.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.uniform()).ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// A link whose stiffness couples everything: a tube in skew axes at an odd point.
fn truth() -> Matrix6<f64> {
    let k = BeamSection::tube(7e10, 2.7e10, 0.08, 0.07)
        .cantilever(0.5)
        .expect("a section");
    let turn =
        kinetostat::spatial::turn_matrix(&nalgebra::Rotation3::new(Vector3::new(0.3, -0.7, 0.4)));
    let shift = kinetostat::spatial::shift_matrix(&Vector3::new(0.03, -0.05, 0.02));
    shift.transpose() * turn * k * turn.transpose() * shift
}

const END: Vector3<f64> = Vector3::new(0.2, 0.1, -0.05);

fn places() -> Vec<Vector3<f64>> {
    (0..24)
        .map(|i| {
            let a = f64::from(i) * std::f64::consts::TAU / 24.0;
            END + Vector3::new(
                0.01 * (3.0 * a).cos() + 0.02,
                0.04 * a.cos(),
                0.04 * a.sin(),
            )
        })
        .collect()
}

/// The truth's displacements under unit loads of 1000 N and 100 N m, with normal noise (m).
fn experiment(noise: &mut Noise, deviation: f64) -> Vec<LoadCase> {
    let compliance = truth().try_inverse().expect("regular");
    unit_loads(1000.0, 100.0)
        .into_iter()
        .map(|(name, wrench)| {
            let motion: Vector6<f64> = compliance * wrench;
            let (d, phi) = (
                motion.fixed_rows::<3>(0).into_owned(),
                motion.fixed_rows::<3>(3).into_owned(),
            );
            let displacements = places()
                .iter()
                .map(|p| {
                    d + phi.cross(&(p - END)) + Vector3::from_fn(|_, _| deviation * noise.normal())
                })
                .collect();
            LoadCase {
                name,
                wrench,
                places: places(),
                displacements,
            }
        })
        .collect()
}

#[test]
fn an_exact_table_gives_the_truth() {
    let found = identify("exact", &experiment(&mut Noise(1), 0.0), &END).expect("identified");
    at_most(
        "displacement table without noise",
        apart(&found.stiffness, &truth()),
        1e-11,
        "of the diagonal",
    );
    assert!(found.antisymmetric_share < 1e-12 && found.notices.is_empty() && found.rank.rank == 6);
}

/// 200 experiments with noise: the truth lies within the stated confidence as often as it should, and the
/// anti-symmetric share is what the residuals explain.
#[test]
fn noise_gives_honest_confidence() {
    let mut noise = Noise(7);
    let (mut within, mut all, mut shares) = (0_u32, 0_u32, Vec::new());
    let mut worst = Worst::new();
    let mut scaled = Vec::new();
    for _ in 0..200 {
        let found = identify("noisy", &experiment(&mut noise, 2e-6), &END).expect("identified");
        for i in 0..6 {
            for j in 0..=i {
                let z =
                    (found.stiffness[(i, j)] - truth()[(i, j)]) / found.stiffness_deviation[(i, j)];
                within += u32::from(z.abs() < 1.96);
                all += 1;
                scaled.push(z);
            }
        }
        worst.add(apart(&found.stiffness, &truth()));
        shares.push(found.antisymmetric_share / found.explained_share);
        assert!((found.fits[0].deviation / 2e-6 - 1.0).abs() < 0.4);
        assert!(
            found.notices.iter().all(|n| !n.contains("anti-symmetric")),
            "{:?}",
            found.notices
        );
    }
    let share = f64::from(within) / f64::from(all);
    at_most(
        "noisy tables: share of entries within 95 % confidence, off by",
        (share - 0.95).abs(),
        0.02,
        "share",
    );
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    at_most(
        "noisy tables: found over explained anti-symmetry, off by",
        (mean - 1.0).abs(),
        0.15,
        "share",
    );
    let bias = scaled.iter().sum::<f64>() / scaled.len() as f64;
    assert!(bias.abs() < 0.25, "{bias}");
    let without = experiment(&mut Noise(1), 0.0);
    let moved = without.iter().flat_map(|c| &c.displacements);
    println!(
        "2 um of noise on up to {:.0} um: worst entry off by {:.4}",
        1e6 * largest(moved.map(|u| u.norm())),
        worst.value()
    );
}

/// Entries that are zero in truth are found insignificant in most tables, and the filter helps.
#[test]
fn the_filter_finds_zeros() {
    let k = BeamSection::tube(7e10, 2.7e10, 0.08, 0.07)
        .cantilever(0.5)
        .expect("a section");
    let compliance = k.try_inverse().expect("regular");
    let mut noise = Noise(11);
    let (mut kept, mut zeros) = (0, 0);
    // Sums of squared errors, entries in units of their diagonals.
    let (mut plain, mut sieved) = (0.0, 0.0);
    for _ in 0..100 {
        let cases: Vec<LoadCase> = unit_loads(1000.0, 100.0)
            .into_iter()
            .map(|(name, wrench)| {
                let motion: Vector6<f64> = compliance * wrench;
                let (d, phi) = (
                    motion.fixed_rows::<3>(0).into_owned(),
                    motion.fixed_rows::<3>(3).into_owned(),
                );
                let displacements = places()
                    .iter()
                    .map(|p| {
                        d + phi.cross(&(p - END)) + Vector3::from_fn(|_, _| 1e-6 * noise.normal())
                    })
                    .collect();
                LoadCase {
                    name,
                    wrench,
                    places: places(),
                    displacements,
                }
            })
            .collect();
        let found = identify("noisy", &cases, &END).expect("identified");
        let filtered = found.filtered().expect("definite");
        for i in 0..6 {
            for j in 0..i {
                let zero = !matches!((i, j), (5, 1) | (4, 2));
                zeros += usize::from(zero && found.insignificant.contains(&(i, j)));
                kept += usize::from(!zero && !found.insignificant.contains(&(i, j)));
            }
        }
        for i in 0..6 {
            for j in 0..6 {
                let unit = k[(i, i)] * k[(j, j)];
                plain += (found.stiffness[(i, j)] - k[(i, j)]).powi(2) / unit;
                sieved += (filtered[(i, j)] - k[(i, j)]).powi(2) / unit;
            }
        }
    }
    assert_eq!(kept, 200, "true couplings are kept");
    at_least("zeros found insignificant, of 1300", zeros, 1200, "entries");
    at_most(
        "error of the filtered stiffness over the plain one",
        f64::sqrt(sieved / plain),
        1.0,
        "root mean square ratio",
    );
}

/// A wrong axis in the loads is not noise: said.
#[test]
fn asymmetry_beyond_the_noise_is_named() {
    let mut cases = experiment(&mut Noise(3), 1e-7);
    cases[4].displacements = cases[4].displacements.iter().map(|u| -u).collect();
    let found = identify("wrong", &cases, &END);
    match found {
        Ok(found) => assert!(
            found.notices.iter().any(|n| n.contains("anti-symmetric")),
            "{:?}",
            found.notices
        ),
        Err(error) => assert!(error.to_string().contains("sign of the loads")),
    }
    // The loads acted 20 mm away from the stated end.
    let cases = experiment(&mut Noise(3), 1e-7);
    let found =
        identify("wrong", &cases, &(END + Vector3::new(0.0, 0.02, 0.0))).expect("identified");
    assert!(
        found
            .notices
            .iter()
            .any(|n| n.contains("anti-symmetric") && n.contains("stated end")),
        "{:?}",
        found.notices
    );
}

#[test]
fn more_than_six_loads_and_their_contradictions() {
    let compliance = truth().try_inverse().expect("regular");
    let mut noise = Noise(5);
    let case = |wrench: Vector6<f64>, factor: f64| {
        let motion: Vector6<f64> = factor * compliance * wrench;
        let (d, phi) = (
            motion.fixed_rows::<3>(0).into_owned(),
            motion.fixed_rows::<3>(3).into_owned(),
        );
        let displacements = places().iter().map(|p| d + phi.cross(&(p - END))).collect();
        LoadCase {
            name: "any".into(),
            wrench,
            places: places(),
            displacements,
        }
    };
    let wrenches: Vec<Vector6<f64>> = (0..10)
        .map(|_| Vector6::from_fn(|i, _| noise.normal() * if i < 3 { 500.0 } else { 40.0 }))
        .collect();
    let cases: Vec<LoadCase> = wrenches.iter().map(|w| case(*w, 1.0)).collect();
    let found = identify("ten", &cases, &END).expect("identified");
    assert!(apart(&found.stiffness, &truth()) < 1e-9 && found.not_linear < 1e-12);
    let cases: Vec<LoadCase> = wrenches
        .iter()
        .enumerate()
        .map(|(i, w)| case(*w, if i == 2 { 2.0 } else { 1.0 }))
        .collect();
    let found = identify("ten", &cases, &END).expect("identified");
    assert!(found.notices.iter().any(|n| n.contains("contradict")));
    // Without any moment about x on its own.
    let mut six: Vec<LoadCase> = unit_loads(1.0, 1.0)
        .into_iter()
        .map(|(_, w)| case(w, 1.0))
        .collect();
    six[3] = six[4].clone();
    let error = identify("five", &six, &END)
        .expect_err("five directions")
        .to_string();
    assert!(error.contains("nothing loads rx"), "{error}");
    let error = identify("five", &six[..5], &END)
        .expect_err("five cases")
        .to_string();
    assert!(error.contains("5 load cases"), "{error}");
}

#[test]
fn interfaces_that_leave_motions_unknown_are_named() {
    let line: Vec<Vector3<f64>> = (0..5)
        .map(|i| END + Vector3::new(0.6, 0.8, 0.0) * 0.01 * f64::from(i))
        .collect();
    let rank = rigid_rank(&line);
    assert_eq!(rank.rank, 5);
    assert!(
        rank.words.contains("one line")
            && (rank.words.contains("0.600, 0.800") || rank.words.contains("-0.600, -0.800")),
        "{}",
        rank.words
    );
    let point = vec![END; 4];
    assert_eq!(rigid_rank(&point).rank, 3);
    assert!(rigid_rank(&point).words.contains("one place"));
    assert_eq!(rigid_rank(&[]).rank, 0);
    assert!(rigid_fit(&line, &line, &END).is_err());
    let plane = rigid_rank(&places());
    assert!(plane.rank == 6 && plane.condition < 4.0, "{plane:?}");
    let mut cases = experiment(&mut Noise(1), 0.0);
    cases[2].places = line.clone();
    cases[2].displacements.truncate(5);
    let error = identify("table", &cases, &END)
        .expect_err("a line")
        .to_string();
    assert!(
        error.contains("'fz'") && error.contains("5 of 6"),
        "{error}"
    );
}

#[test]
fn tables_in_csv_and_from_calculix() {
    let cases = experiment(&mut Noise(1), 0.0);
    let mut csv = String::from("case;node;x_mm;y_mm;z_mm;ux_um;uy_um;uz_um\n");
    let mut dat = String::new();
    let mut mesh = String::from("*NODE\n");
    for (c, case) in cases.iter().enumerate() {
        dat += &format!(
            "\n displacements (vx,vy,vz) for set TIP and time  {}.0000000E+00\n\n",
            c + 1
        );
        for (n, (p, u)) in case.places.iter().zip(&case.displacements).enumerate() {
            let (p, u) = (p * 1e3, u * 1e6);
            csv += &format!(
                "{};{};{};{};{};{};{};{}\n",
                case.name,
                n + 1,
                p.x,
                p.y,
                p.z,
                u.x,
                u.y,
                u.z
            );
            let u = u * 1e-3;
            dat += &format!("{:10} {:13.9e} {:13.9e} {:13.9e}\n", n + 1, u.x, u.y, u.z);
            if c == 0 {
                mesh += &format!("{}, {}, {}, {}\n", n + 1, p.x, p.y, p.z);
            }
        }
    }
    let loads = unit_loads(1000.0, 100.0);
    let read = read_displacements(&text("t.csv", &csv), &loads, None, None).expect("csv");
    let found = identify("t.csv", &read, &END).expect("identified");
    assert!(apart(&found.stiffness, &truth()) < 1e-10);
    let units = kinetostat_links::Units::named("n_mm").expect("known");
    let mesh = kinetostat_links::read_nodes(&text("mesh.inp", &mesh), units).expect("mesh");
    let table = read_loads(&text("loads.csv", "case,fx_n,fy_n,fz_n,mx_n_mm,my_n_mm,mz_n_m\na,1000,0,0,0,0,0\nb,0,1000,0,0,0,0\nc,0,0,1000,0,0,0\nd,0,0,0,1e5,0,0\ne,0,0,0,0,1e5,0\nf,0,0,0,0,0,100\n")).expect("loads");
    for loads in [&loads, &table] {
        let read =
            read_displacements(&text("t.dat", &dat), loads, Some(&mesh), Some(units)).expect("dat");
        let found = identify("t.dat", &read, &END).expect("identified");
        assert!(apart(&found.stiffness, &truth()) < 1e-8);
    }
    assert!(read_displacements(&text("t.dat", &dat), &loads, None, None).is_err());
}
