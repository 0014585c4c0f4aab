//! What must hold for every answer, whatever was requested. Statics are computed again here: by the
//! oracle's kinematics and by differences of energies written down anew.

use kinetostat::{
    ChainProblem, ChainStiffness, Direction, DirectionKind, Equilibrium, Error, Load, MotionKind,
    Prescribed, Wrench,
    chain::{ShapeStability, load_energy},
    model::{Kinematics, SpringBlock, SpringLaw},
    reference::{ChainBlocks, Inapplicable},
};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, Isometry3, Matrix6, Rotation3, UnitQuaternion, Vector3, Vector6};

use crate::oracle::Frames;

fn all_finite<'a>(what: &str, numbers: impl IntoIterator<Item = &'a f64>) {
    for (i, x) in numbers.into_iter().enumerate() {
        assert!(x.is_finite(), "{what}[{i}] is {x}");
    }
}

/// An error says where, and what was expected or found; it never shows a number that the input
/// did not hold.
pub fn explained(error: &Error, place: &str, spoilt: bool) {
    let words = error.to_string();
    assert!(words.len() > 20, "too short: {words}");
    assert!(words.contains(place), "no place '{place}': {words}");
    assert!(
        spoilt || !(words.contains("NaN") || words.contains(" inf ")),
        "not a number: {words}"
    );
    if let Error::NotConverged { last, .. } = error {
        all_finite("last iterate", last);
    }
}

fn directions(list: &[Direction]) {
    assert_eq!(list.len(), 6, "six directions");
    for d in list {
        let rigid = d.kind == DirectionKind::Rigid;
        assert_eq!(d.stiffness_n_per_m == f64::INFINITY, rigid, "{d:?}");
        assert!(rigid || d.stiffness_n_per_m.is_finite(), "{d:?}");
        all_finite("twist", d.twist.0.iter());
        all_finite("motion", d.participation.iter().map(|s| &s.motion));
        all_finite("share", d.participation.iter().map(|s| &s.share));
        assert!(!d.description().contains("NaN"), "{}", d.description());
    }
}

/// Numbers and rank of a stiffness.
pub fn stiffness(k: &ChainStiffness) {
    all_finite("K_C", k.cartesian.matrix.iter());
    all_finite("K_Cq", k.passive.iter());
    all_finite("K_Ctheta", k.springs.iter());
    directions(&k.directions);
    let rank = k.count(DirectionKind::Finite) + k.count(DirectionKind::Negative);
    assert_eq!(k.rank, rank, "rank and directions disagree");
}

/// What the forms of a stiffness answer, where they apply.
pub fn blocks(blocks: &ChainBlocks) {
    let order: Vec<usize> = (0..blocks.passive_joints().len()).collect();
    let form = |what: &str, answer: Result<Vec<f64>, Inapplicable>| match answer {
        Ok(numbers) => all_finite(what, &numbers),
        Err(why) => assert!(why.to_string().len() > 20, "{what}: {why}"),
    };
    let list = |m: Matrix6<f64>| m.iter().copied().collect::<Vec<f64>>();
    form("block inverse", blocks.block_inverse().map(list));
    form("closed form", blocks.closed_form().map(list));
    let recursion = blocks.recursion(&order).map(|r| {
        let mut all = list(r.matrix);
        all.extend(r.pivots);
        all
    });
    form("recursion", recursion);
    let loaded = blocks.loaded_closed_form().map(|c| {
        let mut all = list(c.cartesian);
        all.extend(c.passive.iter().chain(c.springs.iter()));
        all
    });
    form("loaded closed form", loaded);
    let c = blocks.compliance();
    all_finite("compliance", c.springs.iter());
    for twist in c.free.iter().chain(&c.rigid) {
        all_finite("motion", twist.0.iter());
    }
    assert!(c.rank() <= 6);
}

pub fn stability(s: &ShapeStability, n: usize) {
    match s.share_to_buckling {
        Some(mu) => {
            assert!(!mu.is_nan(), "the share is NaN");
            // At one rounding decides; beyond it without a potential, the determinant does.
            if (mu - 1.0).abs() > 1e-9 {
                let holds = mu < 1.0 || s.may_flutter();
                assert_eq!(s.stable, holds, "stability and share {mu} disagree");
            }
            assert!(!s.stable || mu.is_finite() || mu < 0.0, "stable at {mu}");
        }
        None => assert!(s.stable, "unstable without inner freedom"),
    }
    assert!(s.mode.is_empty() || s.mode.len() == n, "length of the mode");
    all_finite("mode", &s.mode);
}

/// Logarithm of a motion: exponential coordinates.
fn logarithm(pose: &Isometry3<f64>) -> Vector6<f64> {
    let f = pose.rotation.scaled_axis();
    let p = pose.translation.vector;
    let angle = f.norm();
    let c = if angle < 1e-4 {
        1.0 / 12.0
    } else {
        (1.0 - 0.5 * angle / (0.5 * angle).tan()) / (angle * angle)
    };
    let once = f.cross(&p);
    let v = p - 0.5 * once + c * f.cross(&once);
    Vector6::new(v.x, v.y, v.z, f.x, f.y, f.z)
}

/// Strain of a block of six coordinates by its law.
fn strain(law: &SpringLaw, d: &Vector6<f64>) -> Vector6<f64> {
    let turn = |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
    let rotation = turn(Vector3::x(), d[3]) * turn(Vector3::y(), d[4]) * turn(Vector3::z(), d[5]);
    match law {
        SpringLaw::Bowing(law) => {
            // A quaternion forgets angles below its last digit; they add up as they are.
            let small = (3..6).all(|k| d[k].abs() < 1e-9);
            let turned = if small {
                Vector3::new(d[3], d[4], d[5])
            } else {
                rotation.scaled_axis()
            };
            let (h, f) = (law.length, turned);
            let bow =
                |w: f64, p: f64| 0.5 * (1.2 * w * w / h - 0.2 * w * p + 2.0 / 15.0 * h * p * p);
            let x = d[0] + bow(d[1], f.z) + bow(d[2], -f.y);
            Vector6::new(x, d[1], d[2], f.x, f.y, f.z)
        }
        SpringLaw::Logarithm(law) => {
            let ahead = Vector3::new(d[0] + law.length, d[1], d[2]);
            let mut e = logarithm(&Isometry3::from_parts(ahead.into(), rotation));
            e[0] -= law.length;
            e
        }
        _ => *d,
    }
}

/// Torques of a block at coordinates, and how exact they are: by its matrix, or `S^T K e` with the
/// strain `e` differentiated by differences. `None` where a rotation vector is near its end at pi.
fn block_torque(
    block: &SpringBlock,
    x: &[f64],
    posture: &[f64],
    length: f64,
) -> Option<(Vec<f64>, f64)> {
    let n = block.len();
    let deflection: Vec<f64> = (0..n).map(|i| x[block.first + i] - block.rest[i]).collect();
    let matrix: Matrix6<f64> = match &block.law {
        SpringLaw::Bowing(law) => law.matrix,
        SpringLaw::Logarithm(law) => law.matrix,
        _ => {
            let k: DMatrix<f64> = block.stiffness_at(posture);
            let torque = (0..n)
                .map(|i| (0..n).map(|j| k[(i, j)] * deflection[j]).sum())
                .collect();
            return Some((torque, 1e-13));
        }
    };
    let own = match &block.law {
        SpringLaw::Bowing(law) => law.length,
        SpringLaw::Logarithm(law) if law.length > 0.0 => law.length,
        _ => length,
    };
    let d = Vector6::from_column_slice(&deflection);
    if (3..6).any(|k| d[k].abs() > 1.2) {
        return None;
    }
    let force = matrix * strain(&block.law, &d);
    let torque = (0..6)
        .map(|k| {
            let step = 1e-3 * if k < 3 { own } else { 1.0 };
            let at = |s: f64| {
                let mut near = d;
                near[k] += s * step;
                strain(&block.law, &near)
            };
            let slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * step);
            slope.dot(&force)
        })
        .collect();
    Some((torque, 1e-8))
}

/// What rounding is counted in, per torque of a block: each coordinate is known to its last digits only, and so
/// is what the springs answer to it. A link that bows is strained by its rotations too, and turned back by its
/// axial force. By differences of the torques.
fn rounding(block: &SpringBlock, x: &[f64], posture: &[f64], length: f64) -> Vec<f64> {
    let torque = |x: &[f64]| block_torque(block, x, posture, length).map(|(torque, _)| torque);
    let k = block.stiffness_at(posture);
    let n = block.len();
    let mut moved = vec![0.0; n];
    for j in 0..n {
        let own = x[block.first + j];
        let step = 1e-3 * own.abs().max(1e-30);
        let (mut more, mut less) = (x.to_vec(), x.to_vec());
        more[block.first + j] += step;
        less[block.first + j] -= step;
        let change = torque(&more).zip(torque(&less));
        for i in 0..n {
            let slope = change
                .as_ref()
                .map_or(k[(i, j)], |(more, less)| (more[i] - less[i]) / (2.0 * step));
            moved[i] += (slope * own).abs();
        }
    }
    moved
}

/// Wrenches of all loads at the given state.
fn wrenches(problem: &ChainProblem<'_>, x: &[f64]) -> Vec<(usize, Wrench)> {
    let chain = problem.chain;
    let kinematics = Kinematics::new(chain, &problem.base, x, &problem.commands);
    let mut list = Vec::new();
    for load in &problem.loads {
        match load {
            Load::Dead { node, wrench } => list.push((*node, *wrench)),
            Load::Gravity(g) => {
                let bodies = chain.bodies().iter();
                list.extend(bodies.map(|b| (b.node, Wrench::new(g * b.mass, Vector3::zeros()))));
            }
            Load::Custom(load) => load.wrenches(&kinematics, &mut list),
            _ => panic!("a load that this check does not know"),
        }
    }
    list
}

/// No number of an equilibrium is missing.
pub fn finite(e: &Equilibrium) {
    all_finite("coordinates", &e.coordinates);
    all_finite("wrench", e.wrench.0.iter());
    all_finite("spring torques", &e.spring_torques);
    all_finite("energy", [&e.energy]);
    all_finite("residual", [&e.residual.closure_m, &e.residual.torque]);
    for pose in e.nodes.iter().chain([&e.tip]) {
        all_finite("pose", pose.to_homogeneous().iter());
    }
    stiffness(&e.stiffness);
    assert!(e.stability.share_to_buckling.is_none_or(|mu| !mu.is_nan()));
}

/// Everything about an equilibrium of a problem.
pub fn equilibrium(problem: &ChainProblem<'_>, e: &Equilibrium, slack: f64) {
    let chain = problem.chain;
    let n = chain.coordinate_count();
    assert_eq!(e.coordinates.len(), n);
    assert_eq!(e.spring_torques.len(), n);
    assert_eq!(e.nodes.len(), chain.nodes().len());
    finite(e);
    stability(&e.stability, n);
    for link in e.link_loads(chain) {
        all_finite(
            "axial load",
            [&link.axial_force, &link.euler_load, &link.share],
        );
    }

    let scale = chain.scale();
    let frames = Frames::new(chain, &problem.base, &e.coordinates, &problem.commands);
    // Rounding of a position grows with everything that lies before it.
    let reach = e.coordinates.iter().zip(chain.coordinates());
    let reach = reach
        .filter(|(_, c)| c.kind == MotionKind::Prismatic)
        .map(|(x, _)| x.abs())
        .chain(problem.commands.iter().map(|x| x.abs()))
        .fold(
            scale.length + problem.base.translation.vector.norm(),
            |a, b| a + b,
        );
    let target = &problem.end.pose;
    let mut tip_residual = frames.pose_residual(frames.tip(), target);
    // The oracle's logarithm ends below pi.
    let turn = target.rotation * frames_rotation(&e.tip).inverse();
    let turn = turn.scaled_axis();
    for k in 0..3 {
        tip_residual[3 + k] = turn[k];
    }
    let back: Rotation3<f64> = problem.end.axes.inverse();
    let d = back * tip_residual.fixed_rows::<3>(0);
    let w = back * tip_residual.fixed_rows::<3>(3);
    let wrench_residual = Wrench(problem.end.wrench.0 - e.wrench.0).rotated(&back);
    let unit = scale.stiffness.sqrt();
    let natural = unit * scale.length;
    let mut loads = Worst::new();
    loads.add(1e-9 * natural);
    for k in 0..6 {
        loads.add(e.wrench.0[k].abs() / if k < 3 { unit } else { natural });
    }
    let kinetostat_tip = frames
        .pose_residual(frames.tip(), &e.tip)
        .fixed_rows::<3>(0)
        .norm();
    assert!(kinetostat_tip <= 1e-11 * reach, "tip: {kinetostat_tip:e}");

    // Torques.
    let mut all = wrenches(problem, &e.coordinates);
    all.push((frames.tip(), e.wrench));
    for (_, wrench) in &all {
        all_finite("wrench of a load", wrench.0.iter());
    }
    let torque = frames.torque(&all);
    let mut spring = vec![0.0; n];
    let mut exact = Worst::new();
    exact.add(1e-13);
    for block in chain.springs() {
        let own = block_torque(block, &e.coordinates, &problem.posture, scale.length);
        let (own, exactness) = own.unwrap_or_else(|| {
            let range = block.first..block.first + block.len();
            (e.spring_torques[range].to_vec(), 1e-13)
        });
        exact.add(exactness);
        for (i, t) in own.into_iter().enumerate() {
            spring[block.first + i] += t;
        }
    }
    let mut factor = vec![0.0; n];
    for (i, c) in chain.coordinates().iter().enumerate() {
        factor[i] = match c.kind {
            MotionKind::Prismatic => 1.0 / unit,
            MotionKind::Revolute => 1.0 / natural,
        };
    }
    let mut rounded = vec![0.0; n];
    for block in chain.springs() {
        let k = block.stiffness_at(&problem.posture);
        let moved = rounding(block, &e.coordinates, &problem.posture, scale.length);
        for (i, moved) in moved.into_iter().enumerate() {
            let at = block.first + i;
            factor[at] = 1.0 / k[(i, i)].sqrt();
            rounded[at] = 4.0 * f64::EPSILON * moved * factor[at];
        }
    }
    for i in 0..n {
        for size in [torque[i], spring[i], e.spring_torques[i]] {
            loads.add(size * factor[i]);
        }
    }
    let (loads, exact) = (loads.value(), exact.value());
    // Rounding: of a chain of this size, and of loads that cancel.
    let force: f64 = all.iter().map(|(_, w)| w.force().norm()).sum();
    let moment: f64 = all.iter().map(|(_, w)| w.moment().norm()).sum();
    let floor = 1e-13 * natural;
    let cancelled = |i: usize| {
        let turning = force * (reach + scale.length) + moment;
        let kind = chain.coordinates()[i].kind;
        let unit = if kind == MotionKind::Prismatic {
            scale.length
        } else {
            1.0
        };
        1e-12 * turning / unit * factor[i]
    };
    for i in 0..n {
        let floor = floor + cancelled(i) + rounded[i];
        let left = (torque[i] - spring[i]).abs() * factor[i];
        assert!(
            left <= slack.max(2.0 * exact) * loads + floor,
            "torque {i} ('{}') unbalanced: {left:e} of {loads:e}, reported {:?}",
            chain.coordinates()[i].name,
            e.residual
        );
        let reported = (e.spring_torques[i] - spring[i]).abs() * factor[i];
        assert!(
            reported <= slack.max(2.0 * exact) * loads + floor,
            "spring torque {i}"
        );
    }
    for k in 0..6 {
        match problem.end.prescribed[k] {
            Prescribed::Pose => {
                let off = if k < 3 { d[k] } else { w[k - 3] * scale.length };
                assert!(
                    off.abs() <= 1e-9 * reach,
                    "direction {k} misses by {off:e} of {reach:e}"
                );
            }
            Prescribed::Wrench => {
                let size = wrench_residual.0[k].abs() / if k < 3 { unit } else { natural };
                assert!(
                    size <= slack * loads + floor,
                    "direction {k} lacks {size:e} of {loads:e}"
                );
            }
        }
    }
    if e.conservative {
        energy_balance(problem, e, &all, &frames, &factor, loads);
    }
}

fn frames_rotation(tip: &kinetostat::Pose) -> UnitQuaternion<f64> {
    tip.rotation
}

/// Slope of the loads' energy along every coordinate against the torque of their wrenches.
fn energy_balance(
    problem: &ChainProblem<'_>,
    e: &Equilibrium,
    all: &[(usize, Wrench)],
    frames: &Frames,
    factor: &[f64],
    loads: f64,
) {
    let Ok(Some(here)) = load_energy(problem, &e.coordinates) else {
        panic!("conservative, but without an energy");
    };
    assert!(here.is_finite(), "energy of the loads is {here}");
    // The end's own part is what is prescribed.
    let axes = &problem.end.axes;
    let mut given = problem.end.wrench.rotated(&axes.inverse());
    for k in 0..6 {
        if problem.end.prescribed[k] == Prescribed::Pose {
            given.0[k] = 0.0;
        }
    }
    let mut all = all.to_vec();
    let last = all.len() - 1;
    all[last].1 = given.rotated(axes);
    let torque = frames.torque(&all);
    let length = problem.chain.scale().length;
    // Rigid offsets of less than a nanometre in all count as none, and the natural length is 1 m then:
    // differences over that tell nothing of so small a chain.
    if length == 1.0 {
        return;
    }
    for (i, c) in problem.chain.coordinates().iter().enumerate() {
        let step = 1e-4
            * if c.kind == MotionKind::Prismatic {
                length
            } else {
                1.0
            };
        let at = |s: f64| {
            let mut x = e.coordinates.clone();
            x[i] += s * step;
            load_energy(problem, &x).ok().flatten().unwrap_or(f64::NAN)
        };
        let slope = |h: f64| {
            let near = 8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h));
            near / (12.0 * h * step)
        };
        let (rough, slope) = (slope(1.0), slope(0.5));
        // Differences of large energies are coarse, and so are those of energies that bend much; where they
        // are, nothing is learnt.
        let rounding = 2e-14 * here.abs().max(at(1.0).abs()) / step;
        let coarse = (rounding + (slope - rough).abs()) * factor[i];
        let left = (slope + torque[i]).abs() * factor[i];
        assert!(
            left <= 1e-4 * loads + 10.0 * coarse,
            "energy of the loads along {i}: {left:e} of {loads:e}"
        );
    }
}
