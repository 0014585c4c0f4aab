//! Parallel machines of the library against closed forms by hand: every leg carries the few wrenches that do
//! no work on its passive joints, and gives way to them by its own bars and drive.
//!
//! `K = sum U (U^T C U)^-1 U^T`, U the wrenches, C the compliance of the leg with its joints locked.

use kinetostat::{Pose, Twist, spatial::moved};
use kinetostat_model::Model;
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3, Vector6, vector};
use serde_json::json;

use crate::library::{Random, figure, posture_near, preset};

const YOUNG: f64 = 2.1e11;
const SHEAR: f64 = YOUNG / 2.6;
const PI: f64 = std::f64::consts::PI;

/// A wrench about the point `tool` of a force through `point` and a moment.
fn wrench(
    tool: &Vector3<f64>,
    point: &Vector3<f64>,
    force: &Vector3<f64>,
    moment: &Vector3<f64>,
) -> Vector6<f64> {
    let m = moment + (point - tool).cross(force);
    Vector6::new(force.x, force.y, force.z, m.x, m.y, m.z)
}

/// E A of a steel tube, N; diameters in mm.
fn axial(outer: f64, inner: f64) -> f64 {
    YOUNG * PI / 4.0 * (outer * outer - inner * inner) * 1e-6
}

/// Compliance about `tool` of a steel tube from `root` to `head`, with diameters in mm.
fn tube(
    tool: &Vector3<f64>,
    root: &Vector3<f64>,
    head: &Vector3<f64>,
    outer: f64,
    inner: f64,
) -> Matrix6<f64> {
    let l = (head - root).norm();
    let x = (head - root) / l;
    let side = Vector3::ith(x.iamin(), 1.0).cross(&x).normalize();
    let turn = Matrix3::from_columns(&[x, side, x.cross(&side)]);
    let second = PI / 64.0 * (outer.powi(4) - inner.powi(4)) * 1e-12;
    let (ei, gj) = (YOUNG * second, SHEAR * 2.0 * second);
    let mut c = Matrix6::zeros();
    c[(0, 0)] = l / axial(outer, inner);
    c[(1, 1)] = l.powi(3) / (3.0 * ei);
    c[(2, 2)] = c[(1, 1)];
    c[(3, 3)] = l / gj;
    c[(4, 4)] = l / ei;
    c[(5, 5)] = l / ei;
    for (i, j, sign) in [(1, 5, 1.0), (2, 4, -1.0)] {
        c[(i, j)] = sign * l * l / (2.0 * ei);
        c[(j, i)] = c[(i, j)];
    }
    // From a wrench about the tool to one about the head in the tube's axes.
    let mut to = Matrix6::zeros();
    to.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn.transpose());
    to.fixed_view_mut::<3, 3>(3, 3).copy_from(&turn.transpose());
    let arm = turn.transpose() * (tool - head).cross_matrix();
    to.fixed_view_mut::<3, 3>(3, 0).copy_from(&arm);
    to.transpose() * c * to
}

/// A drive that gives way along `axis`, N/m.
fn slide(axis: &Vector3<f64>, stiffness: f64) -> Matrix6<f64> {
    let moves = Vector6::new(axis.x, axis.y, axis.z, 0.0, 0.0, 0.0);
    moves * moves.transpose() / stiffness
}

/// A drive that gives way about `axis` through a point, N m/rad.
fn turn(
    tool: &Vector3<f64>,
    at: &Vector3<f64>,
    axis: &Vector3<f64>,
    stiffness: f64,
) -> Matrix6<f64> {
    let v = axis.cross(&(tool - at));
    let moves = Vector6::new(v.x, v.y, v.z, axis.x, axis.y, axis.z);
    moves * moves.transpose() / stiffness
}

/// What a leg adds.
fn leg(wrenches: &[Vector6<f64>], compliance: &Matrix6<f64>) -> Matrix6<f64> {
    let u = DMatrix::from_fn(6, wrenches.len(), |i, j| wrenches[j][i]);
    let c = u.transpose() * compliance * &u;
    let k = &u * c.try_inverse().expect("a compliance") * u.transpose();
    Matrix6::from_fn(|i, j| k[(i, j)])
}

/// Ends of the limbs in metres: on the base, and on the tool in base axes.
fn ends(model: &Model, tool: &Pose, prefix: &str) -> Vec<[Vector3<f64>; 2]> {
    let mm = |p: &Option<kinetostat_model::schema::Placement>| {
        let given = p.as_ref().and_then(|p| p.position_mm);
        Vector3::from(given.unwrap_or_default()) * 1e-3
    };
    let limbs = model.document.limb.iter();
    let own = limbs.filter(|l| l.name.starts_with(prefix));
    own.map(|l| {
        let head = tool * nalgebra::Point3::from(mm(&l.end));
        [mm(&l.start), head.coords]
    })
    .collect()
}

/// Legs that carry force along themselves, of compliance `c` m/N.
fn by_lines(model: &Model, tool: &Pose, c: f64) -> Matrix6<f64> {
    let at = tool.translation.vector;
    let lines = ends(model, tool, "").into_iter().map(|[foot, head]| {
        let w = wrench(&at, &head, &(head - foot).normalize(), &Vector3::zeros());
        w * w.transpose() / c
    });
    lines.sum()
}

fn hexaglide(model: &Model, tool: &Pose) -> Matrix6<f64> {
    let at = tool.translation.vector;
    let legs = ends(model, tool, "").into_iter().map(|[home, head]| {
        // The slider stands on its rail on the side where it is at home.
        let across = vector![0.0, head.y - home.y, head.z - home.z];
        let reach = (1.15_f64.powi(2) - across.norm_squared()).sqrt();
        let side = (home.x - head.x).signum();
        let direction = (across - Vector3::x() * side * reach) / 1.15;
        let w = wrench(&at, &head, &direction, &Vector3::zeros());
        let c = 1.15 / axial(70.0, 54.0) + direction.x.powi(2) / 2e8;
        w * w.transpose() / c
    });
    legs.sum()
}

fn prs3(model: &Model, tool: &Pose) -> Matrix6<f64> {
    let at = tool.translation.vector;
    let legs = ends(model, tool, "").into_iter().map(|[rail, ball]| {
        let inward = -rail.normalize();
        let tangent = Vector3::z().cross(&inward);
        let lean = (ball - rail).dot(&inward);
        let slider = ball - inward * lean + Vector3::z() * (0.36 - lean * lean).sqrt();
        let c = slide(&Vector3::z(), 2.5e8) + tube(&at, &slider, &ball, 110.0, 84.0);
        let none = Vector3::zeros();
        let u = [
            wrench(&at, &ball, &(ball - slider).normalize(), &none),
            wrench(&at, &ball, &tangent, &none),
        ];
        leg(&u, &c)
    });
    legs.sum()
}

fn tripteron(_: &Model, tool: &Pose) -> Matrix6<f64> {
    let at = tool.translation.vector;
    let legs = (0..3).map(|i| {
        let axis = |k: usize| Vector3::ith((i + k) % 3, 1.0);
        let (a, b, c) = (axis(0), axis(1), axis(2));
        // In the plane across the slide: from the root 450 mm to the elbow, 400 mm on to the head.
        let root = b * -0.45 + c * 0.4 + a * (at.dot(&a) - 0.08);
        let head = at - a * 0.08;
        let d = head - root;
        let (r, unit) = (d.norm(), d.normalize());
        let along = (0.45_f64.powi(2) - 0.4_f64.powi(2) + r * r) / (2.0 * r);
        let aside = (0.45_f64.powi(2) - along * along).sqrt();
        let elbow = root + unit * along + a.cross(&unit) * aside;
        let none = Vector3::zeros();
        let c_leg = slide(&a, 1.5e8)
            + tube(&at, &root, &elbow, 100.0, 80.0)
            + tube(&at, &elbow, &head, 90.0, 72.0);
        // Force along the slide and moments across it: none turns a joint.
        let u = [
            wrench(&at, &at, &a, &none),
            wrench(&at, &at, &none, &b),
            wrench(&at, &at, &none, &c),
        ];
        leg(&u, &c_leg)
    });
    legs.sum()
}

fn rrr3(model: &Model, tool: &Pose) -> Matrix6<f64> {
    let at = tool.translation.vector;
    let z = Vector3::z();
    let legs = ends(model, tool, "").into_iter().map(|[foot, pin]| {
        let d = pin - foot;
        let aside = (0.09 - d.norm_squared() / 4.0).sqrt();
        let elbow = foot + d / 2.0 + z.cross(&d.normalize()) * aside;
        let none = Vector3::zeros();
        let c = turn(&at, &foot, &z, 8e4)
            + tube(&at, &foot, &elbow, 60.0, 44.0)
            + tube(&at, &elbow, &pin, 60.0, 44.0);
        let u = [
            wrench(&at, &pin, &(pin - elbow).normalize(), &none),
            wrench(&at, &pin, &z, &none),
            wrench(&at, &pin, &none, &Vector3::x()),
            wrench(&at, &pin, &none, &Vector3::y()),
        ];
        leg(&u, &c)
    });
    legs.sum()
}

/// Three arms, each with two rods that carry force along themselves.
fn delta(model: &Model, tool: &Pose) -> Matrix6<f64> {
    let at = tool.translation.vector;
    let arms = ends(model, tool, "arm");
    let rods = ends(model, tool, "rod");
    let arms = arms.iter().enumerate().map(|(i, [shoulder, _])| {
        let out = shoulder.normalize();
        let tangent = Vector3::z().cross(&out);
        let heads = [rods[2 * i][1], rods[2 * i + 1][1]];
        // The elbow's middle: 350 mm from the shoulder, 850 mm from the heads' middle, outside.
        let middle = (heads[0] + heads[1]) / 2.0;
        let aside = (middle - shoulder).dot(&tangent);
        let d = middle - shoulder - tangent * aside;
        let rod = 0.85_f64.powi(2) - aside * aside;
        let (r, unit) = (d.norm(), d.normalize());
        let along = (0.35_f64.powi(2) - rod + r * r) / (2.0 * r);
        let off = (0.35_f64.powi(2) - along * along).sqrt();
        let elbow = shoulder + unit * along - tangent.cross(&unit) * off;
        assert!(elbow.dot(&out) > middle.dot(&out));
        let lines: Vec<(Vector3<f64>, Vector3<f64>)> = heads
            .iter()
            .map(|head| {
                let foot = elbow + tangent * (head - middle).dot(&tangent);
                (foot, (head - foot).normalize())
            })
            .collect();
        let c = turn(&at, shoulder, &tangent, 1.2e5) + tube(&at, shoulder, &elbow, 80.0, 64.0);
        let none = Vector3::zeros();
        let u = DMatrix::from_fn(6, 2, |k, j| wrench(&at, &lines[j].0, &lines[j].1, &none)[k]);
        let mut give = u.transpose() * c * &u;
        for j in 0..2 {
            give[(j, j)] += 0.85 / axial(30.0, 20.0);
        }
        let k = &u * give.try_inverse().expect("a compliance") * u.transpose();
        Matrix6::from_fn(|i, j| k[(i, j)])
    });
    arms.sum()
}

/// Worst entry as a share of the geometric mean of its diagonals.
fn apart(found: &Matrix6<f64>, expected: &Matrix6<f64>) -> f64 {
    let unit = |i: usize| expected[(i, i)].sqrt();
    let share = |i: usize, j: usize| (found[(i, j)] - expected[(i, j)]) / (unit(i) * unit(j));
    Matrix6::from_fn(share).largest_entry()
}

/// Largest deviation at home and at places about it, in m and rad of `shift` and `tilt`.
fn worst(
    name: &str,
    shift: f64,
    tilt: f64,
    by_hand: impl Fn(&Model, &Pose) -> Matrix6<f64>,
) -> f64 {
    let model = preset(name);
    let mechanism = &model.mechanism;
    let home = mechanism.platforms()[mechanism.tool()].home;
    let at_home = mechanism.posture(&home).expect("home");
    let mut random = Random(5);
    let mut worst = Worst::new();
    for i in 0..6 {
        let posture = if i == 0 {
            at_home.clone()
        } else {
            let turned = if i == 1 { 0.0 } else { tilt };
            let twist = Twist::new(random.vector() * shift, random.vector() * turned);
            posture_near(&model, &moved(&home, &twist), &at_home)
        };
        let found = posture.stiffness().expect("a stiffness").cartesian.matrix;
        worst.add(apart(&found, &by_hand(&model, posture.target())));
    }
    worst.value()
}

fn strut(screw: f64, tube: (f64, f64, f64), ram: (f64, f64, f64)) -> f64 {
    1.0 / screw + tube.0 / axial(tube.1, tube.2) + ram.0 / axial(ram.1, ram.2)
}

#[test]
fn parallel_robots_have_the_stiffness_of_their_closed_forms() {
    let hexapod = strut(1.5e8, (0.65, 100.0, 76.0), (0.45, 70.0, 40.0));
    let cube = strut(1.2e8, (0.42, 80.0, 60.0), (0.28, 56.0, 30.0));
    for (what, found) in [
        (
            "report's platform A, at home, off home, turned",
            worst_of_a(),
        ),
        (
            "report's platform B, at home, off home, turned",
            worst("stewart_gough_b", 0.08, 0.15, |m, t| by_lines(m, t, 1e-6)),
        ),
        (
            "hexapod",
            worst("hexapod", 0.2, 0.15, |m, t| by_lines(m, t, hexapod)),
        ),
        (
            "cubic_hexapod",
            worst("cubic_hexapod", 0.06, 0.08, |m, t| by_lines(m, t, cube)),
        ),
        ("hexaglide", worst("hexaglide", 0.05, 0.05, hexaglide)),
        ("prs3", worst("prs3", 0.1, 0.15, prs3)),
        ("tripteron", worst("tripteron", 0.12, 0.0, tripteron)),
        ("rrr3_planar", worst("rrr3_planar", 0.07, 0.15, rrr3)),
        ("delta", worst("delta", 0.1, 0.0, delta)),
    ] {
        figure(
            &format!("Library: K_C minus closed form, {what}"),
            json!(found),
            "at most 1e-10",
            "relative",
            found <= 1e-10,
        );
    }
}

/// A is singular everywhere, so the measure is the largest entry.
fn worst_of_a() -> f64 {
    let model = preset("stewart_gough_a");
    let home = model.mechanism.platforms()[1].home;
    let mut random = Random(9);
    let mut worst = Worst::new();
    for i in 0..8 {
        let shift = if i == 0 { 0.0 } else { 0.08 };
        let tilt = if i < 3 { 0.0 } else { 0.15 };
        let twist = Twist::new(random.vector() * shift, random.vector() * tilt);
        let target = moved(&home, &twist);
        let posture = model.mechanism.posture(&target).expect("reached");
        let found = posture.stiffness().expect("a stiffness");
        let k = by_lines(&model, &target, 1e-6);
        // Rotations at the radius of the platform's joints.
        let unit = |i: usize| if i < 3 { 1.0 } else { 0.3 };
        let share = |i: usize, j: usize| {
            (found.cartesian.matrix[(i, j)] - k[(i, j)]) / (unit(i) * unit(j) * k.largest_entry())
        };
        worst.add(Matrix6::from_fn(share).largest_entry());
        // Similar hexagons: unturned all six lines meet in one point, wherever A stands, and turned one
        // motion stays free everywhere (an architectural singularity).
        assert_eq!(found.rank(), if tilt == 0.0 { 3 } else { 5 }, "place {i}");
    }
    worst.value()
}

/// At the centre of its cube, edge 1 m, by legs of stiffness k: translations 2 k, rotations k a^2 / 2
/// across the diagonal and 2 k a^2 about it; nothing couples.
#[test]
fn the_cubic_hexapod_is_isotropic_in_the_middle() {
    let model = preset("cubic_hexapod");
    let home = model.mechanism.platforms()[1].home;
    let posture = model.mechanism.posture(&home).expect("home");
    let found = posture.stiffness().expect("a stiffness").cartesian.matrix;
    let k = 1.0 / strut(1.2e8, (0.42, 80.0, 60.0), (0.28, 56.0, 30.0));
    let shares = Vector6::new(2.0, 2.0, 2.0, 0.5, 0.5, 2.0);
    let expected = Matrix6::from_diagonal(&(shares * k));
    let off = apart(&found, &expected);
    figure(
        "Library: cubic hexapod is isotropic at its centre, nothing couples",
        json!(off),
        "at most 1e-10",
        "relative",
        off <= 1e-10,
    );
}
