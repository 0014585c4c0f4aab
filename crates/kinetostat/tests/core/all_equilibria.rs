//! All equilibria of a posture: the tables of the theory are complete, and a random 4-link and a
//! random 6-link chain have the equilibria that an exhaustive search of its own finds.

use crate::common::{Rng, assert_chain_equilibrium, close, golden, number, planar_column};
use crate::curves_and_bifurcations::{held, z_chain, z_unloaded};
use crate::curves_of_elastic_links::{ELASTIC, elastic_links, elastic_problem};
use kinetostat::{
    BeamSection, Chain, ChainProblem, EndCondition, MotionKind, Prescribed, Wrench, equilibria,
    equilibrium::{Bounds, Equilibria, FoundEquilibrium, SearchSettings},
};
use kinetostat_testing::{LargestEntry, largest, largest_size};
use nalgebra::{Vector3, vector};

#[track_caller]
pub fn search(label: &str, problem: &ChainProblem<'_>, settings: &SearchSettings) -> Equilibria {
    let all = equilibria(problem, &Bounds::of(problem.chain), settings)
        .unwrap_or_else(|e| panic!("{label}: {e}"));
    assert!(
        all.exhausted,
        "{label}: not exhausted after {} starts",
        all.starts
    );
    assert!(all.fruitless >= settings.fruitless, "{label}");
    assert!((0.0..=1.0).contains(&all.chance_of_more), "{label}");
    assert!(all.chance_of_more <= all.chance_of_more_at_most, "{label}");
    let hits: usize = all.found.iter().map(|f| f.hits).sum();
    assert_eq!(hits, all.hits, "{label}");
    assert!(all.hits + all.outside <= all.starts, "{label}");
    for pair in all.found.windows(2) {
        assert!(
            pair[0].potential <= pair[1].potential,
            "{label}: not sorted"
        );
    }
    for f in &all.found {
        assert_chain_equilibrium(problem, &f.equilibrium);
    }
    all
}

#[test]
fn the_table_of_the_z_chain_is_complete() {
    let file = golden("z_chain.json");
    let chain = z_chain();
    let cases = file["cases"].as_array().unwrap();
    for delta in [0.0, 0.05, 0.1, 0.115, 0.2, 0.4] {
        let label = format!("delta {delta}");
        let rows: Vec<_> = cases
            .iter()
            .filter(|c| number(&c["delta"]) == delta)
            .collect();
        let problem = held(&chain, z_unloaded() - delta);
        let all = search(&label, &problem, &SearchSettings::default());
        assert_eq!(all.found.len(), rows.len(), "{label}");
        assert!(
            all.chance_of_more_at_most < 0.03,
            "{label}: {}",
            all.chance_of_more_at_most
        );
        for row in rows {
            let n = |key: &str| number(&row[key]);
            let q = n("q_deg").to_radians();
            let f = all
                .found
                .iter()
                .find(|f| (f.equilibrium.coordinates[0] - q).abs() < 1e-6)
                .unwrap_or_else(|| panic!("{label}: no equilibrium at q = {}", n("q_deg")));
            let e = &f.equilibrium;
            close(&label, e.coordinates[1].to_degrees(), n("theta1_deg"), 2e-6);
            close(&label, e.coordinates[2].to_degrees(), n("theta2_deg"), 2e-6);
            close(&label, e.wrench.0[0], n("F_x"), 2e-8);
            close(&label, e.stiffness.cartesian.matrix[(0, 0)], n("K_x"), 1e-6);
            close(
                &label,
                e.stability.share_to_buckling.unwrap(),
                n("mu"),
                1e-7,
            );
            assert_eq!(
                e.stability.stable,
                row["stable"].as_bool().unwrap(),
                "{label}"
            );
            assert_eq!(f.stable, e.stability.stable, "{label}");
            assert!(
                f.hits >= 5 && !f.singular,
                "{label}: found {} times",
                f.hits
            );
            // The end hinge turns for nothing and stays where it was.
            assert_eq!(e.coordinates[3], 0.0, "{label}");
        }
    }
}

/// G/G*, dx, node y, F_x, K_xx, stable with the end fixed, and with x free (4.6.2, K_L = 200).
#[test]
fn the_table_of_the_two_elastic_links_is_complete() {
    let chain = elastic_links(15_f64.to_radians());
    for g in [0.0, 0.5, 1.0, 1.5, 2.0] {
        for dx in [-0.05, 0.0, 0.05] {
            let label = format!("G/G* {g}, dx {dx}");
            let rows: Vec<_> = ELASTIC.iter().filter(|r| r.0 == g && r.1 == dx).collect();
            let problem = elastic_problem(&chain, g, dx);
            let all = search(&label, &problem, &SearchSettings::default());
            assert_eq!(all.found.len(), rows.len(), "{label}");
            for &&(_, _, y, force, k, fixed, free) in &rows {
                let f = all
                    .found
                    .iter()
                    .find(|f| (f.equilibrium.nodes[0].translation.y - y).abs() < 1e-6)
                    .unwrap_or_else(|| panic!("{label}: no equilibrium with its node at {y}"));
                let e = &f.equilibrium;
                close(&label, e.nodes[0].translation.y, y, 1e-9);
                close(&label, e.wrench.0[0], force, 6e-8 * force.abs().max(0.1));
                close(
                    &label,
                    e.wrench.0[1],
                    0.5 * g * 4.0 * 15_f64.to_radians().sin(),
                    1e-9,
                );
                let k_x = e.stiffness.cartesian.matrix[(0, 0)];
                close(&label, k_x, k, 6e-7 * k.abs().max(1.0));
                assert_eq!(f.stable, fixed, "{label}");
                assert_eq!(f.stable && k_x > 0.0, free, "{label}");
            }
        }
    }
}

/// A planar chain of links pinned at both ends, by absolute angles and Lagrange multipliers.
struct Pinned {
    length: Vec<f64>,
    stiffness: Vec<f64>,
    rest: Vec<f64>,
    reach: f64,
}

impl Pinned {
    fn random(rng: &mut Rng, links: usize) -> Self {
        let length: Vec<f64> = (0..links).map(|_| rng.between(0.7, 1.3)).collect();
        Self {
            stiffness: (1..links).map(|_| rng.between(0.6, 1.6)).collect(),
            rest: (1..links).map(|_| 0.6 * rng.signed()).collect(),
            reach: length.iter().sum::<f64>() * rng.between(0.7, 0.8),
            length,
        }
    }

    fn chain(&self) -> Chain {
        let z = Vector3::z();
        let mut b = Chain::builder("pinned").passive("q", MotionKind::Revolute, z, 0.0);
        for (i, l) in self.length.iter().enumerate() {
            if i > 0 {
                let (k, rest) = (self.stiffness[i - 1], self.rest[i - 1]);
                b = b.spring(&format!("th{i}"), MotionKind::Revolute, z, k, rest);
            }
            b = b.translation(vector![*l, 0.0, 0.0]);
        }
        b.passive("e", MotionKind::Revolute, z, 0.0)
            .build()
            .unwrap()
    }

    /// Newton in (phi_1 .. phi_n, F_x, F_y) from relative angles; the converged relative angles and
    /// the first absolute one, force last.
    fn newton(&self, relative: &[f64]) -> Option<Vec<f64>> {
        let n = self.length.len();
        let mut u = vec![0.0; n + 2];
        for i in 1..n {
            u[i] = u[i - 1] + relative[i - 1];
        }
        let (mut x, mut y) = (0.0, 0.0);
        for i in 0..n {
            x += self.length[i] * u[i].cos();
            y += self.length[i] * u[i].sin();
        }
        let turn = y.atan2(x);
        u[..n].iter_mut().for_each(|p| *p -= turn);
        // Force by least squares of the first conditions.
        u[n] = -1.0;
        let (mut ss, mut sc, mut cc, mut bs, mut bc) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for i in 0..n {
            let (s, c) = (self.length[i] * u[i].sin(), -self.length[i] * u[i].cos());
            let mut b = 0.0;
            if i > 0 {
                b += self.stiffness[i - 1] * (u[i] - u[i - 1] - self.rest[i - 1]);
            }
            if i + 1 < n {
                b -= self.stiffness[i] * (u[i + 1] - u[i] - self.rest[i]);
            }
            (ss, sc, cc) = (ss + s * s, sc + s * c, cc + c * c);
            (bs, bc) = (bs - s * b, bc - c * b);
        }
        let det = ss * cc - sc * sc;
        if det.abs() > 1e-9 {
            (u[n], u[n + 1]) = ((cc * bs - sc * bc) / det, (ss * bc - sc * bs) / det);
        }
        for _ in 0..60 {
            // Rows: dE/dphi_i - F . dp/dphi_i = 0, p = (reach, 0).
            let mut a = vec![vec![0.0; n + 3]; n + 2];
            let (mut x, mut y) = (0.0, 0.0);
            for i in 0..n {
                let (s, c) = u[i].sin_cos();
                let l = self.length[i];
                (x, y) = (x + l * c, y + l * s);
                a[i][n + 2] += u[n] * l * s - u[n + 1] * l * c;
                a[i][i] += u[n] * l * c + u[n + 1] * l * s;
                (a[i][n], a[i][n + 1]) = (l * s, -l * c);
                (a[n][i], a[n + 1][i]) = (l * s, -l * c);
            }
            (a[n][n + 2], a[n + 1][n + 2]) = (self.reach - x, -y);
            for i in 1..n {
                let (k, d) = (self.stiffness[i - 1], u[i] - u[i - 1] - self.rest[i - 1]);
                a[i][n + 2] += k * d;
                a[i - 1][n + 2] -= k * d;
                a[i][i] += k;
                a[i - 1][i - 1] += k;
                a[i][i - 1] -= k;
                a[i - 1][i] -= k;
            }
            let size: f64 = a.iter().map(|row| row[n + 2].abs()).sum();
            if size < 1e-11 {
                let mut answer = vec![u[0].sin().atan2(u[0].cos())];
                answer.extend((1..n).map(|i| u[i] - u[i - 1]));
                let inside = answer[1..].iter().all(|t| t.abs() < std::f64::consts::PI);
                answer.push(u[n]);
                return inside.then_some(answer);
            }
            let step = gauss(a)?;
            let most = largest_size(step[..n].iter().copied());
            let length = (0.4 / most).min(1.0);
            u.iter_mut().zip(&step).for_each(|(u, s)| *u -= length * s);
        }
        None
    }

    /// From a grid of all relative angles, `steps` values each.
    fn exhaustive(&self, steps: usize) -> Vec<Vec<f64>> {
        let n = self.length.len();
        let mut found: Vec<Vec<f64>> = Vec::new();
        for index in 0..steps.pow(n as u32 - 1) {
            let mut rest = index;
            let relative: Vec<f64> = (1..n)
                .map(|_| {
                    let k = rest % steps;
                    rest /= steps;
                    2.6 * ((k as f64 + 0.5) / steps as f64 * 2.0 - 1.0)
                })
                .collect();
            if let Some(e) = self.newton(&relative)
                && !found
                    .iter()
                    .any(|f| f.iter().zip(&e).all(|(a, b)| (a - b).abs() < 1e-6))
            {
                found.push(e);
            }
        }
        found
    }
}

/// Elimination with pivots; the last column is the right-hand side.
fn gauss(mut a: Vec<Vec<f64>>) -> Option<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let p = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        a.swap(k, p);
        if a[k][k].abs() < 1e-14 {
            return None;
        }
        for i in k + 1..n {
            let f = a[i][k] / a[k][k];
            for j in k..=n {
                a[i][j] -= f * a[k][j];
            }
        }
    }
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|j| a[i][j] * x[j]).sum();
        x[i] = (a[i][n] - sum) / a[i][i];
    }
    Some(x)
}

/// A random chain of pinned links: how many equilibria the search found, how many the exhaustive
/// search of this test found, how many of those are among the former, and the largest difference of
/// their forces.
pub fn compared(links: usize, seed: u64, steps: usize) -> (usize, usize, usize, f64) {
    let label = format!("{links} links, seed {seed}");
    let pinned = Pinned::random(&mut Rng(seed), links);
    let chain = pinned.chain();
    let problem = held(&chain, pinned.reach);
    let all = search(&label, &problem, &SearchSettings::default());
    assert!(all.chance_of_more < 0.02, "{label}: {}", all.chance_of_more);
    let expected = pinned.exhaustive(steps);
    let matches = |f: &[f64], e: &[f64]| (0..links).all(|i| (f[i] - e[i]).abs() < 1e-6);
    let forces = expected.iter().filter_map(|e| {
        let own = |f: &&FoundEquilibrium| matches(&f.equilibrium.coordinates, e);
        let f = all.found.iter().find(own)?;
        Some((f.equilibrium.wrench.0[0] - e[links]).abs())
    });
    let forces: Vec<f64> = forces.collect();
    let worst = largest(forces.iter().copied());
    (all.found.len(), expected.len(), forces.len(), worst)
}

fn compare(links: usize, seed: u64, steps: usize) {
    let (found, expected, matched, worst) = compared(links, seed, steps);
    let label = format!("{links} links, seed {seed}");
    assert_eq!(found, expected, "{label}");
    assert_eq!(matched, expected, "{label}: some are missed");
    assert!(worst < 1e-7, "{label}: {worst:e}");
}

#[test]
fn random_chains_of_four_links_have_the_equilibria_of_an_exhaustive_search() {
    for seed in 1..4 {
        compare(4, seed, 12);
    }
}

#[test]
fn a_random_chain_of_six_links_has_the_equilibria_of_an_exhaustive_search() {
    compare(6, 8, 7);
}

#[test]
fn a_pressed_column_has_all_its_shapes_under_a_dead_force() {
    // Wrench prescribed along x, position along y: straight, and two mirror images of the arch, or
    // (where the arch has folded beyond the bounds) of the zigzag.
    let chain = planar_column(3, 1.0, 1.0);
    for (force, count) in [(0.5, 1), (1.2, 3), (3.1, 3)] {
        let label = format!("force {force}");
        let mut problem = held(&chain, 3.0);
        problem.end.prescribed[0] = Prescribed::Wrench;
        problem.end.wrench = Wrench::new(vector![-force, 0.0, 0.0], Vector3::zeros());
        let mut bounds = Bounds::of(&chain);
        for i in 0..3 {
            (bounds.low[i], bounds.high[i]) = (-1.5, 1.5);
        }
        let all = equilibria(&problem, &bounds, &SearchSettings::default()).unwrap();
        for f in &all.found {
            assert_chain_equilibrium(&problem, &f.equilibrium);
            close(&label, f.equilibrium.wrench.0[0], -force, 1e-9);
        }
        assert_eq!(all.found.len(), count, "{label}");
        let straight = all
            .found
            .iter()
            .find(|f| {
                f.equilibrium.coordinates[..3]
                    .iter()
                    .all(|x| x.abs() < 1e-9)
            })
            .unwrap();
        assert_eq!(straight.stable, force < 1.0, "{label}");
        assert_eq!(all.found[0].stable, force < 3.0, "{label}");
    }
}

#[test]
fn wrong_bounds_are_refused_and_nothing_found_is_an_answer() {
    let chain = z_chain();
    let problem = held(&chain, 2.5);
    let settings = SearchSettings::default().with_fruitless(20);
    let mut bounds = Bounds::of(&chain);
    bounds.low.pop();
    assert!(equilibria(&problem, &bounds, &settings).is_err());
    let mut bounds = Bounds::of(&chain);
    bounds.low[1] = f64::NAN;
    assert!(equilibria(&problem, &bounds, &settings).is_err());
    // Farther than the chain is long.
    let far = held(&chain, 4.0);
    let all = equilibria(&far, &Bounds::of(&chain), &settings).unwrap();
    assert!(all.found.is_empty() && all.hits == 0);
    close("all is open", all.chance_of_more, 1.0, 0.0);
}

#[test]
fn a_link_has_one_description_of_its_orientation() {
    // Two rotations of a link's spring by half a turn and one by minus that are no rotation.
    let section = BeamSection {
        youngs_modulus: 70e9,
        shear_modulus: 26e9,
        area: 4e-4,
        second_moment_y: 1.4e-8,
        second_moment_z: 1.1e-8,
        torsion_constant: 2.1e-8,
    };
    let chain = Chain::builder("links")
        .spring("drive", MotionKind::Revolute, Vector3::z(), 2e4, 0.0)
        .link("upper", &section, 0.6)
        .spring("elbow", MotionKind::Revolute, Vector3::y(), 2e4, 0.0)
        .node("elbow")
        .link("fore", &section, 0.4)
        .build()
        .unwrap();
    let bounds = Bounds::of(&chain);
    let (half, quarter) = (std::f64::consts::PI, std::f64::consts::FRAC_PI_2);
    for (i, c) in chain.coordinates().iter().enumerate() {
        let name = c.name.as_str();
        let most = match (c.kind, ["drive", "elbow"].contains(&name)) {
            (MotionKind::Revolute, true) => half,
            (MotionKind::Revolute, false) => quarter,
            (MotionKind::Prismatic, _) => 0.5 * chain.scale().length,
        };
        assert_eq!((bounds.low[i], bounds.high[i]), (-most, most), "{name}");
    }
    let mut end = EndCondition::pose(chain_end(&chain));
    end.pose.translation.vector += vector![0.0, 4e-3, -3e-3];
    let problem = ChainProblem::new(&chain, end);
    let settings = SearchSettings::default().with_fruitless(150);
    let all = equilibria(&problem, &bounds, &settings).unwrap();
    assert!(!all.found.is_empty());
    // The same places of all nodes and the same wrench are one equilibrium.
    for (i, a) in all.found.iter().enumerate() {
        for b in &all.found[i + 1..] {
            let (a, b) = (&a.equilibrium, &b.equilibrium);
            let wrench = (a.wrench.0 - b.wrench.0).norm() / (1.0 + a.wrench.0.norm());
            let place = a.nodes.iter().zip(&b.nodes);
            let place =
                place.map(|(p, q)| (p.to_homogeneous() - q.to_homogeneous()).largest_entry());
            let away = largest(place.chain([wrench]));
            assert!(away > 1e-6, "one shape twice: {:?}", b.coordinates);
        }
    }
}

/// Where the end of an unloaded chain is.
fn chain_end(chain: &Chain) -> kinetostat::Pose {
    let home = chain.home_coordinates();
    let k = kinetostat::model::Kinematics::new(
        chain,
        &kinetostat::Pose::identity(),
        &home,
        &chain.home_commands(),
    );
    k.node_pose(chain.tip())
}
