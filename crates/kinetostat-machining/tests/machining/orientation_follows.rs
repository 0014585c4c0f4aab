//! Programs and maps on machines that turn their tool as they move, against closed forms.

use kinetostat::{Directions, Mechanism, MotionKind, Pose, PostureRequest, Wrench};
use kinetostat_machining::{
    Bounds, CuttingLoad, Grid, LoadAxes, MapPlace, MapTask, PlaceState, Placement, ProgramLoad,
    Run, RunError, RunInputs, Task, Unwatched, Variable, WeightCorrection, analyse,
    compensate_program, map, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{Gcode, MachineProgram, Program, ReadOptions, WriteOptions, interpret};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3, vector};

/// A ring of 20 mm, and 3 mm deep.
const RING: &str = "G21 G90 G17\nG0 X20 Y0 Z5\nG1 Z-3 F300\nG3 X-20 Y0 I-20 J0 F600\nG3 X20 Y0 I20 J0\nG0 Z5\nM2\n";

/// The spindle head with a tool of 150 mm: it turns to move sideways.
fn head() -> Mechanism {
    let model = Model::preset("prs3").expect("a preset");
    model.mechanism.with_tool(&straight_tool(0.15))
}

fn home(m: &Mechanism) -> Pose {
    m.platforms()[m.tool()].home
}

/// Where the middle of the ball joints stands and how the head is turned from home, with the tip of
/// the tool at a place: Newton's iteration on the three conditions of a 3-PRS or 3-RPS platform, that
/// every ball stays in its plane (closed form: Lee and Shah 1988), the turn as the only unknown.
fn turned(place: &Vector3<f64>) -> UnitQuaternion<f64> {
    const RADIUS: f64 = 0.25;
    let residual_at = |turn: &Vector3<f64>| {
        let q = UnitQuaternion::new(*turn);
        let m: Matrix3<f64> = *q.to_rotation_matrix().matrix();
        // From the tip up to the plane of the ball joints.
        let c = place + m * vector![0.0, 0.0, 0.35];
        vector![
            m[(1, 0)] - m[(0, 1)],
            c.x - 0.5 * RADIUS * (m[(0, 0)] - m[(1, 1)]),
            c.y + RADIUS * m[(1, 0)]
        ]
    };
    let mut turn = Vector3::zeros();
    for _ in 0..50 {
        let residual = residual_at(&turn);
        let h = 1e-6;
        let columns = [0, 1, 2].map(|k| {
            let mut d = Vector3::zeros();
            d[k] = h;
            (residual_at(&(turn + d)) - residual_at(&(turn - d))) / (2.0 * h)
        });
        let jacobian = Matrix3::from_columns(&columns);
        turn -= jacobian.lu().solve(&residual).expect("a regular place");
    }
    assert!(residual_at(&turn).norm() < 1e-14);
    UnitQuaternion::new(turn)
}

fn task<'a>(
    mechanism: &'a Mechanism,
    program: &'a dyn MachineProgram,
    load: ProgramLoad,
) -> Task<'a> {
    let home = home(mechanism);
    Task {
        mechanism,
        program,
        corrected: Directions::POSITION,
        placement: Placement {
            tool_orientation: home.rotation,
            orientation_follows: true,
            ..Placement::at(home.translation.vector)
        },
        load,
        tools: &[],
        weight: WeightCorrection::All,
        cut: None,
        writing: WriteOptions::default(),
        run_inputs: RunInputs::default(),
        bounds: Bounds::default(),
        places: 0,
        compliances: false,
    }
}

fn run(mechanism: &Mechanism, axes: LoadAxes, write: bool) -> Result<Run, RunError> {
    let program = Program::read(RING).expect("program");
    let path = interpret(&program, &ReadOptions::default()).expect("path");
    let wrench = Wrench::new(vector![400.0, -300.0, -500.0], Vector3::zeros());
    let load = ProgramLoad::new(CuttingLoad::Constant { axes, wrench });
    let gcode = Gcode {
        program: &program,
        path: &path,
        reading: &ReadOptions::default(),
    };
    let task = task(mechanism, &gcode, load);
    if write {
        compensate_program(&task, &Unwatched)
    } else {
        analyse(&task, &Unwatched)
    }
}

#[test]
fn a_spindle_head_cuts_a_ring_and_says_how_far_it_turns() {
    let head = head();
    assert!(head.turns_as_it_moves());
    let home = home(&head);
    let plain = run(&head, LoadAxes::Base, false).expect("deflections");
    let mut most = Worst::new();
    for point in &plain.points {
        let place = home.translation.vector + Vector3::from(point.position_mm) * 1e-3;
        let closed = turned(&place);
        let reported = Vector3::from(point.tool_turn_deg.expect("it follows"));
        let own = closed.scaled_axis().map(f64::to_degrees);
        assert!((reported - own).norm() < 1e-7, "{place} {reported} {own}");
        most.add(own.norm());
    }
    let most = most.of(plain.points.len());
    assert!(most > 3.0, "{most}");
    let reported = plain.result.summary.max_tool_turn_deg.expect("it follows");
    assert!((reported - most).abs() < 1e-7, "{reported} {most}");
    let text = plain.result.warnings.iter().map(ToString::to_string);
    assert!(
        text.into_iter()
            .any(|w| w.contains("the orientation follows"))
    );
    // Continuous: ends and middles of chords follow each other.
    for pair in plain.points.windows(2) {
        let distance =
            (Vector3::from(pair[1].position_mm) - Vector3::from(pair[0].position_mm)).norm();
        let [a, b] = [&pair[0], &pair[1]].map(|p| Vector3::from(p.tool_turn_deg.expect("turn")));
        assert!(
            (b - a).norm() < 0.3 * distance + 1e-9,
            "{distance} {}",
            (b - a).norm()
        );
    }
}

#[test]
fn its_compensated_program_holds_the_position() {
    let head = head();
    for axes in [LoadAxes::Base, LoadAxes::Tool] {
        let run = run(&head, axes, true).expect("a compensated program");
        let s = &run.result.summary;
        assert!(s.max_position_error_before_mm > 5e-3, "{s:?}");
        // Decimals of 0.1 um, chords and pieces of 0.5 um each.
        assert!(s.max_position_error_after_mm < 1.2e-3, "{s:?}");
        assert!(run.written.is_some());
    }
}

#[test]
fn a_tool_load_turns_with_the_tool() {
    let head = head();
    let home = home(&head);
    let run = run(&head, LoadAxes::Tool, false).expect("deflections");
    let mut most = Worst::new();
    for point in run.points.iter().step_by(7) {
        let place = home.translation.vector + Vector3::from(point.position_mm) * 1e-3;
        let posture = head
            .posture(PostureRequest::position(&place, &home.rotation))
            .expect("reachable");
        let force = vector![400.0, -300.0, -500.0];
        let moved = |axes: &UnitQuaternion<f64>| {
            let feed = point.kind == kinetostat_machining::PointKind::Feed;
            let force = if feed { axes * force } else { Vector3::zeros() };
            let wrench = Wrench::new(force, Vector3::zeros());
            posture
                .deflected_by(&wrench)
                .expect("rest")
                .displacement
                .linear()
                * 1e3
        };
        let own = moved(&(turned(&place) * home.rotation));
        let reported = Vector3::from(point.error_after_mm);
        assert!((own - reported).norm() < 1e-7, "{own} {reported}");
        most.add((moved(&home.rotation) - reported).norm());
    }
    // Which is not what a load with fixed components does.
    let most = most.value();
    assert!(most > 1e-4, "{most}");
}

#[test]
fn a_map_of_positions_turns_the_same_way() {
    let head = head();
    let home = home(&head);
    let at = home.translation.vector * 1e3;
    for load in [
        None,
        Some(Wrench::new(vector![100.0, 50.0, -80.0], Vector3::zeros())),
    ] {
        let task = MapTask {
            mechanism: &head,
            grid: Grid {
                from_mm: [at.x - 30.0, at.y - 30.0, at.z],
                to_mm: [at.x + 30.0, at.y + 30.0, at.z + 10.0],
                counts: [5, 5, 2],
            },
            orientation: home.rotation,
            orientation_follows: true,
            load,
            further: Vec::new(),
            variables: Vec::new(),
            ratings: Vec::new(),
            first: 0,
        };
        let mut places: Vec<MapPlace> = Vec::new();
        map(&task, &Unwatched, <[MapPlace]>::to_vec, |own| {
            places.extend(own);
            Ok::<(), RunError>(())
        })
        .expect("a map");
        assert_eq!(places.len(), 50);
        for place in places {
            assert_eq!(place.state, PlaceState::Regular, "{place:?}");
            let at = Vector3::from(place.position_mm) * 1e-3;
            let own = turned(&at).angle().to_degrees();
            assert!((place.tool_turn_deg - own).abs() < 1e-7, "{place:?} {own}");
            // The figures are those of the machine standing there.
            let posture = head
                .posture(PostureRequest::position(&at, &home.rotation))
                .expect("reachable");
            let stiffness = match &load {
                None => posture
                    .stiffness()
                    .expect("a stiffness")
                    .stiffness_against_force(),
                Some(w) => posture
                    .deflected_by(w)
                    .expect("rest")
                    .stiffness_against_force(),
            };
            let off = 1e-3 * stiffness / place.smallest_stiffness_n_per_mm - 1.0;
            assert!(off.abs() < 1e-7, "{place:?} {stiffness}");
        }
    }
}

/// Smallest by largest singular value of the commands' rates, by differences of postures that the machine reaches: tool and turning
/// actuators at the natural length.
fn distance_by_differences(m: &Mechanism, at: &Vector3<f64>, turns: &[Vector3<f64>]) -> f64 {
    const STEP: f64 = 1e-4;
    let length = m.natural_length();
    let rotation = home(m).rotation;
    let actuators = || m.limbs().iter().flat_map(|l| l.nominal.actuators());
    let reached = |move_: Vector3<f64>, turn: Vector3<f64>| {
        let asked = UnitQuaternion::new(turn) * rotation;
        let posture = m.posture(PostureRequest::position(&(at + move_), &asked));
        posture.expect("reachable")
    };
    let axes =
        [Vector3::x(), Vector3::y(), Vector3::z()].map(|a| (STEP * length * a, Vector3::zeros()));
    let turned = turns.iter().map(|t| (Vector3::zeros(), STEP * t));
    let (motions, commands): (Vec<_>, Vec<_>) = axes
        .into_iter()
        .chain(turned)
        .map(|(move_, turn)| {
            let (a, b) = (reached(move_, turn), reached(-move_, -turn));
            let moved = a.target().translation.vector - b.target().translation.vector;
            let by = (a.target().rotation * b.target().rotation.inverse()).scaled_axis() * length;
            let motion = [moved.as_slice(), by.as_slice()].concat();
            let each = actuators().zip(a.commands().into_iter().zip(b.commands()));
            let commands = each.map(|(actuator, (a, b))| match actuator.kind {
                MotionKind::Prismatic => a - b,
                MotionKind::Revolute => (a - b) * length,
            });
            let commands = commands.collect();
            (
                DVector::from_vec(motion),
                DVector::<f64>::from_vec(commands),
            )
        })
        .unzip();
    // In an orthonormal basis of the motions; squares of singular values are eigenvalues.
    let basis = DMatrix::from_columns(&motions).qr().r();
    let rates = DMatrix::from_columns(&commands) * basis.try_inverse().expect("independent");
    let squares = (rates.transpose() * &rates).symmetric_eigenvalues();
    (squares.min() / squares.max()).sqrt()
}

#[test]
fn the_distance_to_singular_postures_is_known_where_the_tool_turns() {
    let tricept = Model::preset("tricept_like").expect("a preset").mechanism;
    // The head has three freedoms, which the place of its tip says; the other one turns its axis, too.
    for (m, turns) in [
        (head(), &[][..]),
        (tricept, &[Vector3::x(), Vector3::y()][..]),
    ] {
        for off in [vector![0.0, 0.0, 0.0], vector![0.011, -0.017, 0.02]] {
            let at = home(&m).translation.vector + off;
            let task = MapTask {
                mechanism: &m,
                grid: Grid {
                    from_mm: (at * 1e3).into(),
                    to_mm: (at * 1e3).into(),
                    counts: [1; 3],
                },
                orientation: home(&m).rotation,
                orientation_follows: true,
                load: None,
                further: Vec::new(),
                variables: vec![Variable::SingularityDistance],
                ratings: Vec::new(),
                first: 0,
            };
            let mut found = Vec::new();
            map(&task, &Unwatched, <[MapPlace]>::to_vec, |places| {
                found.extend(places);
                Ok::<(), RunError>(())
            })
            .expect("a map");
            assert_eq!(found[0].state, PlaceState::Regular);
            let expected = distance_by_differences(&m, &at, turns);
            let own = found[0].values[0];
            assert!(
                (own - expected).abs() < 1e-5 * expected && expected > 0.01,
                "{}: {own}, by differences {expected}",
                m.name()
            );
        }
    }
}

#[test]
fn a_hybrid_of_five_freedoms_takes_the_poses_that_it_takes_by_their_positions() {
    // Three legs and a tube, which turns the head as it moves sideways; a wrist of two axes behind it.
    let machine = Model::preset("tricept_like").expect("a preset").mechanism;
    let home = home(&machine);
    assert!(machine.turns_as_it_moves());
    for (x, y, z) in [
        (0.0, 3e-3, 0.0),
        (0.0, -10e-3, 0.0),
        (30e-3, 30e-3, 10e-3),
        (-30e-3, 15e-3, 10e-3),
        (-0.1, -0.15, 0.08),
    ] {
        let position = home.translation.vector + vector![x, y, z];
        let by_position = machine.posture(PostureRequest::position(&position, &home.rotation));
        let by_position = by_position.expect("a place in its workspace");
        let pose = *by_position.target();
        let by_pose = machine.posture(&pose).expect("the machine's own target");
        for (a, b) in by_pose.commands().iter().zip(by_position.commands()) {
            assert!((a - b).abs() < 1e-8, "({x}, {y}, {z}): {a} {b}");
        }
        // A pose that it cannot have is refused: turned about the tool's axis, which no joint does.
        let axis = pose.rotation * Vector3::z_axis();
        let turn = UnitQuaternion::from_axis_angle(&axis, 0.05);
        let turned = Pose::from_parts(pose.translation, turn * pose.rotation);
        let refused = machine.posture(&turned);
        assert!(matches!(
            refused,
            Err(kinetostat::Error::Unreachable { .. })
        ));
    }
}
