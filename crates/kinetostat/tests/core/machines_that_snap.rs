//! Machines near a flat posture [R 5.5.3]: paths through limit points and back, jumps, stability
//! while held and under a dead load, both signs of the load. Against energies written by hand.

use kinetostat::{
    ActuatorSpec, Chain, CurveSettings, EndCondition, Mechanism, MechanismEquilibrium, MotionKind,
    Parameter, Platform, Pose, Posture, Prescribed, Twist, Wrench,
    continuation::{BranchEnd, CurvePoint, LoadPattern, MachineCurves, SpecialKind},
    equilibrium::{FoundEquilibrium, SpreadSettings},
    spatial::moved,
};
use kinetostat_testing::{LargestEntry, Worst, largest, least as least_of};
use nalgebra::{DMatrix, Matrix6, Vector3, Vector6, vector};

use crate::common::assert_equilibrium;
use crate::curves_of_families::came_down;
use crate::fuzz_short::fuzz::platforms::Series;
use crate::graphs::limb;
use crate::parallel_machines::hexapod;
use crate::planar_machines::{truss, truss_of};

/// Feet and heads.
type Ends = Vec<(Vector3<f64>, Vector3<f64>)>;

fn free(list: [bool; 6], wrench: Wrench) -> EndCondition {
    let mut end = EndCondition::wrench(wrench);
    end.prescribed = list.map(|f| match f {
        true => Prescribed::Wrench,
        false => Prescribed::Pose,
    });
    end
}

fn down() -> Parameter {
    Parameter::Displacement(Twist::new(-Vector3::z(), Vector3::zeros()))
}

type Point = CurvePoint<MechanismEquilibrium>;

fn of_kind<'c>(curves: &'c MachineCurves<'_>, kind: SpecialKind) -> Vec<&'c Point> {
    let of = curves.specials.iter().filter(|s| s.kind == kind);
    of.map(|s| &s.point).collect()
}

/// Force of a truss at a height, up positive.
fn truss_force(b: f64, h: f64, k: f64, z: f64) -> f64 {
    let l = b.hypot(z);
    2.0 * k * (l - b.hypot(h)) * z / l
}

/// A truss under a growing force: limits, stability and landings by hand, both signs of the load.
/// Worst of force, place of limits and places of landing, as shares of `k h` and `h`.
pub fn truss_path_apart() -> [f64; 3] {
    let (b, h, k) = (0.5, 0.1, 1e5);
    let machine = truss(b, h, k);
    let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
    let unloaded = b.hypot(h);
    let limit = ((unloaded * b * b).powf(2.0 / 3.0) - b * b).sqrt();
    let most = -truss_force(b, h, k, limit);
    let push = Parameter::Load(LoadPattern {
        end: Wrench::new(-Vector3::z(), Vector3::zeros()),
        loads: Vec::new(),
    });
    let range = CurveSettings::within(-1.2 * most, 1.2 * most);
    let by_load = posture.curves(&push, &EndCondition::wrench(Wrench::zero()), &range);
    let by_load = by_load.unwrap();
    assert_eq!(by_load.branches[0].ends, [BranchEnd::Range; 2]);
    let hold = EndCondition::pose(Pose::identity());
    let mut settings = CurveSettings::within(-0.3 * h, 2.4 * h);
    settings.largest_change = Some(0.05 * h);
    let by_motion = posture.curves(&down(), &hold, &settings).unwrap();
    let mut worst = <[Worst; 3]>::default();
    for path in [&by_load, &by_motion] {
        for p in &path.branches[0].points {
            let z = p.equilibrium.tool.translation.z;
            let force = truss_force(b, h, k, z);
            let off = (p.equilibrium.wrench.force().z - force).abs() / (k * h);
            worst[0].add(off);
            // dF/dz > 0 holds under a dead load; held it always does.
            let l = b.hypot(z);
            let slope = 1.0 - unloaded * b * b / l.powi(3);
            assert!(
                slope.abs() < 1e-6 || p.dead_load.stable == (slope > 0.0),
                "{z}"
            );
            assert!(p.displacement_control.stable || std::ptr::eq(path, &by_load));
            let expected = 2.0 * k * slope;
            assert!(
                (p.slope - expected).abs() < 1e-6 * k,
                "{} {expected}",
                p.slope
            );
        }
        let limits = of_kind(path, SpecialKind::LoadLimit);
        assert_eq!(limits.len(), 2);
        for (found, expected) in limits.iter().zip([limit, -limit]) {
            let z = found.equilibrium.tool.translation.z;
            worst[1].add((z - expected).abs() / h);
        }
        // Through at the first, and back at the second: the same force on the other side.
        let jumps = path.jumps().unwrap();
        assert_eq!(jumps.len(), 2);
        for (jump, (side, force)) in jumps.iter().zip([(-1.0, -most), (1.0, most)]) {
            assert!(jump.dead_load && jump.to.len() == 1);
            let (mut near, mut far) = (limit, 5.0 * h);
            for _ in 0..80 {
                let z = 0.5 * (near + far);
                match truss_force(b, h, k, side * z) * side < force * side {
                    true => near = z,
                    false => far = z,
                }
            }
            let z = jump.to[0].equilibrium.tool.translation.z;
            worst[2].add((z - side * near).abs() / h);
        }
    }
    worst.map(|w| w.value())
}

#[test]
fn a_truss_snaps_through_and_back() {
    let [force, limits, landings] = truss_path_apart();
    assert!(
        force < 1e-10 && limits < 1e-6 && landings < 1e-8,
        "{force:e} {limits:e} {landings:e}"
    );
}

/// The energy of a hexapod's legs, J.
struct Legs {
    ends: Ends,
    k: f64,
    rest: Vec<f64>,
}

impl Legs {
    fn new(height: f64, k: f64) -> Self {
        let on = |r: f64, degrees: f64| {
            let a = degrees.to_radians();
            vector![r * a.cos(), r * a.sin(), 0.0]
        };
        let mut ends = Vec::new();
        for j in 0..3 {
            let turn = 120.0 * f64::from(j);
            ends.push((on(0.6, turn - 10.0), on(0.3, turn - 50.0)));
            ends.push((on(0.6, turn + 10.0), on(0.3, turn + 50.0)));
        }
        let home = Pose::translation(0.0, 0.0, height);
        let rest = lengths(&ends, &home);
        Self { ends, k, rest }
    }

    fn energy(&self, pose: &Pose) -> f64 {
        let now = lengths(&self.ends, pose);
        let pairs = now.iter().zip(&self.rest);
        pairs.map(|(l, r)| 0.5 * self.k * (l - r).powi(2)).sum()
    }

    /// Derivatives by the tool's motions at a pose, sixth-order differences.
    fn gradient(&self, pose: &Pose) -> Vector6<f64> {
        let h = 2e-3;
        Vector6::from_fn(|i, _| {
            let at = |s: f64| {
                let mut twist = Twist::zero();
                twist.0[i] = s * h;
                self.energy(&moved(pose, &twist))
            };
            let sum: f64 = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)]
                .map(|(s, w)| w * (at(s) - at(-s)))
                .into_iter()
                .sum();
            sum / (60.0 * h)
        })
    }

    /// Of the energy in exponential coordinates about a pose.
    fn hessian(&self, pose: &Pose) -> Matrix6<f64> {
        let h = 1e-3;
        let at = |i: usize, a: f64, j: usize, b: f64| {
            let mut twist = Twist::zero();
            twist.0[i] += a * h;
            twist.0[j] += b * h;
            self.energy(&moved(pose, &twist))
        };
        Matrix6::from_fn(|i, j| {
            let four = at(i, 1.0, j, 1.0) - at(i, 1.0, j, -1.0) - at(i, -1.0, j, 1.0)
                + at(i, -1.0, j, -1.0);
            four / (4.0 * h * h)
        })
    }
}

fn lengths(ends: &Ends, pose: &Pose) -> Vec<f64> {
    let above = |p: &Vector3<f64>| (pose * nalgebra::Point3::from(*p)).coords;
    ends.iter()
        .map(|(foot, head)| (above(head) - foot).norm())
        .collect()
}

/// Smallest eigenvalue of the Hessian in some directions, rotations at 0.3 m, N/m.
fn least(hessian: &Matrix6<f64>, directions: &[usize]) -> f64 {
    let unit = |i: usize| if i < 3 { 1.0 } else { 0.3 };
    let n = directions.len();
    DMatrix::from_fn(n, n, |a, b| {
        let (i, j) = (directions[a], directions[b]);
        hessian[(i, j)] / (unit(i) * unit(j))
    })
    .symmetric_eigenvalues()
    .min()
}

/// What a path must keep: the wrench is the energy's gradient, stability is that of its Hessian.
/// Returns the largest difference of the wrench as a share of the largest.
fn against_energy(
    legs: &Legs,
    posture: &Posture,
    path: &MachineCurves<'_>,
    driven: &[usize],
    free: &[usize],
) -> f64 {
    let wrench = |p: &Point| p.equilibrium.wrench.0;
    let size = path.branches[0]
        .points
        .iter()
        .map(|p| wrench(p).largest_entry());
    let size = largest(size);
    let mut worst = Worst::new();
    for p in &path.branches[0].points {
        if wrench(p).largest_entry() > 1e-6 * size {
            assert_equilibrium(posture, &p.equilibrium);
        }
        let pose = &p.equilibrium.tool;
        let gradient = legs.gradient(pose);
        worst.add((gradient - wrench(p)).largest_entry() / size);
        let hessian = legs.hessian(pose);
        let stabilities = [
            (p.displacement_control.stable, free.to_vec()),
            (p.dead_load.stable, [driven, free].concat()),
        ];
        for (found, directions) in stabilities {
            if directions.is_empty() {
                continue;
            }
            let smallest = least(&hessian, &directions);
            let sure = smallest.abs() > 1e-4 * legs.k;
            assert!(
                !sure || found == (smallest > 0.0),
                "{smallest} at {}",
                p.parameter
            );
        }
    }
    worst.of(path.branches[0].points.len())
}

/// Three paths of a hexapod near its flat posture, against the energy of its legs; the last is
/// whether its limit points are where the Hessian is singular, as a share of the leg's stiffness.
pub fn hexapod_path_apart() -> [f64; 2] {
    let (height, k) = (0.08, 1e6);
    let legs = Legs::new(height, k);
    let home = Pose::translation(0.0, 0.0, height);
    let machine: Mechanism = hexapod(k, &legs.ends, &home);
    let posture = machine.posture(&home).unwrap();
    let mut settings = CurveSettings::within(-0.4 * height, 2.3 * height);
    settings.largest_change = Some(0.04 * height);
    let mut worst = <[Worst; 2]>::default();

    // Held in all other directions: straight through.
    let hold = EndCondition::pose(home);
    let path = posture.curves(&down(), &hold, &settings).unwrap();
    assert_eq!(path.branches[0].ends, [BranchEnd::Range; 2]);
    worst[0].add(against_energy(&legs, &posture, &path, &[2], &[]));
    let limits = of_kind(&path, SpecialKind::LoadLimit);
    assert_eq!(limits.len(), 2);
    for limit in limits {
        let stiffness = legs.hessian(&limit.equilibrium.tool)[(2, 2)];
        worst[1].add(stiffness.abs() / k);
    }

    // By a pin: free in all other directions, with a weight across so that nothing is symmetric.
    let pin = free(
        [true, true, false, true, true, true],
        Wrench::new(vector![300.0, -200.0, 0.0], vector![10.0, 4.0, -6.0]),
    );
    let path = posture.curves(&down(), &pin, &settings).unwrap();
    worst[0].add(against_energy(
        &legs,
        &posture,
        &path,
        &[2],
        &[0, 1, 3, 4, 5],
    ));
    for limit in of_kind(&path, SpecialKind::LoadLimit) {
        let hessian = legs.hessian(&limit.equilibrium.tool);
        let unit = |i: usize| if i < 3 { 1.0 } else { 0.3 };
        let hessian = Matrix6::from_fn(|i, j| hessian[(i, j)] / (unit(i) * unit(j)));
        let values = hessian.symmetric_eigenvalues();
        let nearest = least_of(values.iter().map(|v| v.abs()));
        worst[1].add(nearest / k);
    }

    // A force off the axis that grows both ways; the tool is free.
    let push = Parameter::Load(LoadPattern {
        end: Wrench::new(vector![0.2, 0.1, -1.0], vector![0.0, 0.02, 0.01]),
        loads: Vec::new(),
    });
    let settings = CurveSettings::within(-4000.0, 4000.0);
    let end = EndCondition::wrench(Wrench::zero());
    let path = posture.curves(&push, &end, &settings).unwrap();
    assert!(path.branches[0].points.len() > 20);
    worst[0].add(against_energy(&legs, &posture, &path, &[], &[]));
    worst.map(|w| w.value())
}

#[test]
fn a_hexapod_near_its_flat_posture_follows_its_energy() {
    let [wrench, limits] = hexapod_path_apart();
    assert!(wrench < 1e-6, "{wrench:e}");
    assert!(limits < 1e-4, "{limits:e}");
}

/// The toggle frame of Figure 5.12 as a machine: three legs, each a slide with a spring in the plane
/// of the flat posture, a hinge, a rigid link of length 1 m, a hinge; up to the tool.
fn toggle_frame(angle: f64, k: f64) -> Mechanism {
    let home = Pose::translation(0.0, 0.0, angle.sin());
    let mut builder = Mechanism::builder("toggle frame");
    let tool = builder.platform(Platform::new("tool", home));
    for i in 0..3 {
        let turn = Vector3::z() * (std::f64::consts::TAU / 3.0 * f64::from(i) + 0.2);
        let chain = Chain::builder(format!("leg {i}"))
            .rigid(Pose::rotation(turn))
            .translation(vector![angle.cos(), 0.0, 0.0])
            .actuator(
                "slide",
                ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), k),
            )
            .passive("hinge", MotionKind::Revolute, Vector3::y(), angle)
            .translation(vector![-1.0, 0.0, 0.0])
            .passive("head", MotionKind::Revolute, Vector3::y(), -angle)
            .rigid(Pose::rotation(-turn))
            .build()
            .unwrap();
        builder = builder.limb(limb(&format!("leg {i}"), 0, tool, Pose::identity(), chain));
    }
    builder.build().unwrap()
}

/// [R 5.45]: worst of the critical displacement and force against `cos^3 phi = cos phi0` and
/// `3 K L sin^3 phi`, relative; and against the print's limits for small angles.
pub fn toggle_frame_apart() -> [f64; 2] {
    let (k, mut exact, mut small) = (2e5, Worst::new(), Worst::new());
    for angle in [0.01, 0.05, 0.1, 0.3, 0.8] {
        let machine = toggle_frame(angle, k);
        let home = machine.platforms()[machine.tool()].home;
        let posture = machine.posture(&home).unwrap();
        let far: f64 = angle.sin();
        let mut settings = CurveSettings::within(-0.2 * far, 2.1 * far);
        settings.largest_change = Some(0.05 * far);
        let path = posture
            .curves(&down(), &EndCondition::pose(home), &settings)
            .unwrap();
        let limits = of_kind(&path, SpecialKind::LoadLimit);
        assert_eq!(limits.len(), 2, "{angle}");
        let phi = angle.cos().cbrt().acos();
        let (moved, force) = (far - phi.sin(), 3.0 * k * phi.sin().powi(3));
        let found = limits[0];
        exact.add((found.parameter / moved - 1.0).abs());
        exact.add((found.conjugate / force - 1.0).abs());
        let start = &path.branches[0].points[path.branches[0].start];
        exact.add((start.slope / (3.0 * k * angle.tan().powi(2)) - 1.0).abs());
        if angle == 0.01 {
            let root = 3.0_f64.sqrt();
            small.add((found.parameter / ((1.0 - 1.0 / root) * far) - 1.0).abs());
            small.add((found.conjugate / (k * far.powi(3) / root) - 1.0).abs());
        }
    }
    [exact.of(3 * 5), small.of(2)]
}

#[test]
fn the_toggle_frame_snaps_as_5_45_says() {
    let [exact, small] = toggle_frame_apart();
    assert!(exact < 1e-6, "{exact:e}");
    assert!(small < 1e-4, "{small:e}");
}

/// Every equilibrium of a truss under a force, by hand: up, down, and between; pushed through.
#[test]
fn all_equilibria_of_a_truss_are_found() {
    let (b, h, k) = (0.5, 0.1, 1e5);
    let machine = truss(b, h, k);
    let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
    for (force, expected) in [(-50.0, 3), (0.0, 3), (50.0, 3), (-200.0, 1), (200.0, 1)] {
        let end = EndCondition::wrench(Wrench::new(vector![0.0, 0.0, force], Vector3::zeros()));
        let all = posture
            .equilibria(&end, &SpreadSettings::default())
            .unwrap();
        let near = all.found.iter().filter(|f| {
            // A bar that was turned over by half a turn pushes from the other side.
            f.equilibrium.tool.translation.vector.norm() < 0.4
        });
        let near: Vec<_> = near.collect();
        let heights: Vec<f64> = near
            .iter()
            .map(|f| f.equilibrium.tool.translation.z)
            .collect();
        assert_eq!(near.len(), expected, "{force}: {heights:?}");
        assert!(all.exhausted && all.chance_of_more < 0.1);
        for f in near {
            let z = f.equilibrium.tool.translation.z;
            assert!(
                (truss_force(b, h, k, z) - force).abs() < 1e-8 * k * h,
                "{z}"
            );
            let slope = 1.0 - b.hypot(h) * b * b / b.hypot(z).powi(3);
            assert_eq!(f.stable, slope > 0.0, "{z}");
            let energy = k * (b.hypot(z) - b.hypot(h)).powi(2) - force * (z - h);
            assert!((f.energy() - energy).abs() < 1e-9 * k * h * h);
        }
    }
}

/// Motions of the tool are bound to each other where it turns with a bar: no place beside the commanded one can be
/// had with the orientation as it was. The shapes are those of a tool with hinges at both bars, by hand.
fn all_equilibria_of_a_truss_whose_tool_turns_with(bar: &str, b: f64, h: f64) {
    let k = 1e6;
    let machine = truss_of(b, h, k, [bar]);
    let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
    let limit = ((b.hypot(h) * b * b).powf(2.0 / 3.0) - b * b).sqrt();
    let limit = -truss_force(b, h, k, limit);
    for share in [-2.5, -1.1, -0.9, -0.5, -0.01, 0.0, 0.3, 0.97, 1.1, 2.5] {
        let case = format!("b {b}, h {h}, hinge {bar}, {share} of the limit");
        let force = share * limit;
        let wrench = Wrench::new(vector![0.0, 0.0, force], Vector3::zeros());
        let all = posture
            .equilibria(&EndCondition::wrench(wrench), &SpreadSettings::default())
            .unwrap();
        let places = all
            .found
            .iter()
            .map(|f| (f.equilibrium.tool.translation.vector, f));
        let upright: Vec<_> = places.filter(|(at, _)| at.x.abs() < 1e-6).collect();
        let expected = if share.abs() < 1.0 { 3 } else { 1 };
        let heights: Vec<f64> = upright.iter().map(|(at, _)| at.z).collect();
        assert_eq!(upright.len(), expected, "{case}: {heights:?}");
        for (at, found) in upright {
            assert!(
                (truss_force(b, h, k, at.z) - force).abs() < 1e-8 * k * h,
                "{case}: {}",
                at.z
            );
            let slope = 1.0 - b.hypot(h) * b * b / b.hypot(at.z).powi(3);
            // Across, both bars push together.
            let across = 1.0 - b.hypot(h) * at.z * at.z / b.hypot(at.z).powi(3);
            assert_eq!(
                found.stable,
                slope > 0.0 && across > 0.0,
                "{case}: {}",
                at.z
            );
        }
    }
}

#[test]
fn a_flat_truss_whose_tool_turns_with_the_right_bar_has_its_equilibria() {
    all_equilibria_of_a_truss_whose_tool_turns_with("right", 1.0, 0.3);
}

#[test]
fn a_flatter_truss_whose_tool_turns_with_the_left_bar_has_its_equilibria() {
    all_equilibria_of_a_truss_whose_tool_turns_with("left", 0.5, 0.1);
}

#[test]
fn a_steep_truss_whose_tool_turns_with_the_right_bar_has_its_equilibria() {
    all_equilibria_of_a_truss_whose_tool_turns_with("right", 0.3, 0.25);
}

/// A column with platforms on its way: straight, and bent to either side, beyond its critical load only.
#[test]
fn all_shapes_of_a_column_of_several_limbs_are_found() {
    let settings = SpreadSettings::default().with_fruitless(10);
    for (pieces, sides, loads) in [
        (2_u32, [0, 1], &[(2.2, 1), (2.7, 3), (4.0, 3)][..]),
        (3, [0, 2], &[(3.2, 3)]),
    ] {
        let rods = vec![(Pose::identity(), 1.0 / f64::from(pieces)); pieces as usize];
        let column = Series {
            rods,
            axial: 1e4,
            mass: 0.0,
        };
        let machine = column.as_platforms(false);
        let posture = machine.posture(&column.home()).unwrap();
        let mut plane = [false; 6];
        // Translations in the plane, and the turn about what is across it.
        for k in sides {
            plane[k] = true;
        }
        plane[if sides[1] == 1 { 5 } else { 4 }] = true;
        for &(load, expected) in loads {
            let case = format!("{pieces} pieces, {load} N");
            let force = Wrench::new(vector![-load, 0.0, 0.0], Vector3::zeros());
            let all = posture.equilibria(&free(plane, force), &settings).unwrap();
            let place =
                |f: &FoundEquilibrium<MechanismEquilibrium>| f.equilibrium.tool.translation.vector;
            let places: Vec<_> = all.found.iter().map(|f| (place(f), f.stable)).collect();
            assert_eq!(places.len(), expected, "{case}: {places:?}");
            let straight = places.iter().filter(|(at, _)| at[sides[1]].abs() < 1e-6);
            assert!(
                straight.map(|(_, stable)| *stable).eq([expected == 1]),
                "{case}: {places:?}"
            );
            for (at, stable) in places.iter().filter(|(at, _)| at[sides[1]].abs() > 1e-6) {
                assert!(*stable, "{case}");
                assert!(
                    ((1.0 - at.x) / came_down(load) - 1.0).abs() < 0.08,
                    "{case}: {at}"
                );
            }
        }
    }
}

/// A portal frame of two posts and two crossed diagonals, all hinged, in the plane x, z.
fn portal(half: f64, h: f64, post: f64, diagonal: f64) -> Mechanism {
    let mut builder = Mechanism::builder("portal");
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.0, 0.0, h)));
    for (name, foot, head, k) in [
        ("left", -half, -half, post),
        ("right", half, half, post),
        ("up", -half, half, diagonal),
        ("down", half, -half, diagonal),
    ] {
        let span = vector![head - foot, 0.0, h];
        let turn = span.x.atan2(span.z);
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), k);
        drive.home = span.norm();
        let chain = Chain::builder(name)
            .translation(vector![foot, 0.0, 0.0])
            .passive("foot", MotionKind::Revolute, Vector3::y(), turn)
            .actuator("slide", drive)
            .passive("head", MotionKind::Revolute, Vector3::y(), -turn)
            .build()
            .unwrap();
        let tip = Pose::translation(head, 0.0, 0.0);
        builder = builder.limb(limb(name, 0, tool, tip, chain));
    }
    builder.build().unwrap()
}

/// Beyond its critical load the frame has no stable shape nearby: the potential, which grows with the square of what the
/// bars are strained, has its least value elsewhere, and that must be found. Turned over it hangs in its bars, as strained
/// as by the same force pulling upright.
#[test]
fn a_frame_beyond_its_critical_load_has_a_stable_shape_elsewhere() {
    for (half, h, ratio) in [(0.4, 1.05, 0.02), (0.3, 0.8, 0.05), (0.5, 0.7, 0.1)] {
        let post = 7e7;
        let machine = portal(half, h, post, ratio * post);
        let posture = machine.posture(&Pose::translation(0.0, 0.0, h)).unwrap();
        let under = |force: f64| Wrench::new(vector![0.0, 0.0, force], Vector3::zeros());
        let stays = |force: f64| posture.deflected_by(&under(force)).unwrap().stable();
        // Between a load that it bears and one that it does not.
        let (mut low, mut high) = (1e3, 1e3);
        while stays(-high) {
            low = high;
            high *= 1.5;
        }
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            match stays(-middle) {
                true => low = middle,
                false => high = middle,
            }
        }
        for share in [0.9, 1.05] {
            let case = format!("half {half}, h {h}, diagonals {ratio}, {share} of critical");
            let force = share * high;
            let pulled = posture.deflected_by(&under(force)).unwrap();
            let end = EndCondition::wrench(under(-force));
            let all = posture
                .equilibria(&end, &SpreadSettings::default())
                .unwrap();
            let stable: Vec<_> = all.found.iter().filter(|f| f.stable).collect();
            let nearby = |f: &&&FoundEquilibrium<MechanismEquilibrium>| {
                (f.equilibrium.tool.translation.z / h - 1.0).abs() < 0.2
            };
            assert_eq!(
                stable.iter().filter(nearby).count(),
                usize::from(share < 1.0),
                "{case}"
            );
            let hanging = -pulled.tool.translation.z;
            let found = stable.iter().any(|f| {
                (f.equilibrium.tool.translation.vector - vector![0.0, 0.0, hanging]).norm() < 1e-6
            });
            let places: Vec<_> = stable
                .iter()
                .map(|f| f.equilibrium.tool.translation)
                .collect();
            assert!(found, "{case}: {hanging} in {places:?}");
        }
    }
}
