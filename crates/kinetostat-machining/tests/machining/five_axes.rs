//! Programs with rotary axes: heads that turn the tool and tables that turn the part, against the core at poses that are put
//! together here by hand, from the written text, which a scan of this file reads.

use std::sync::Arc;

use kinetostat::{Directions, Mechanism, Pose, Wrench};
use kinetostat_machining::{
    Bounds, CuttingLoad, LoadAxes, Placement, ProgramLoad, Run, RunInputs, Task, Unwatched,
    WeightCorrection, compensate_program, straight_tool,
};
use kinetostat_model::Model;
use kinetostat_program::{
    Carries, Gcode, Program, ReadOptions, RotaryAxes, RotaryAxis, WriteOptions, interpret,
};
use kinetostat_testing::Worst;
use nalgebra::{Matrix3, Rotation3, Unit, UnitQuaternion, Vector3, vector};

/// Straight lines in the part while all axes turn; a turn of more than half a revolution in one block.
const PROGRAM: &str = "G21 G90 G94\nG0 A0 C0\nG0 X0 Y0 Z40\nG43.4 H1 Z40\nG0 A10 C-20\nG1 X5 Y3 Z0 F600\nX60 Y10 A-15 C30\nX20 Y50 Z-4 A20 C230\nX0 Y0 Z0\nG91 G1 X9 C-60\nG90 G0 Z50\nG49\nG0 A0 C0\nM30\n";

/// Blocks of it that cut, and where their lines go: X Y Z A C.
const WAY: [[f64; 5]; 6] = [
    [0.0, 0.0, 40.0, 10.0, -20.0],
    [5.0, 3.0, 0.0, 10.0, -20.0],
    [60.0, 10.0, 0.0, -15.0, 30.0],
    [20.0, 50.0, -4.0, 20.0, 230.0],
    [0.0, 0.0, 0.0, 20.0, 230.0],
    [9.0, 0.0, 0.0, 20.0, 170.0],
];

pub(crate) const TOLERANCE_MM: f64 = 0.002;

/// A machine with rotary axes. Directions and points in the part's frame at zero, mm.
pub(crate) struct Machine {
    pub(crate) mechanism: Mechanism,
    pub(crate) placement: Placement,
    pub(crate) axes: [(char, Carries, Vector3<f64>, Vector3<f64>); 2],
}

impl Machine {
    /// An arm in front of a table of two axes, neither of them along a coordinate axis.
    pub(crate) fn arm_with_table() -> Self {
        let model = Model::preset("heavy_6r").expect("preset");
        let mechanism = model.mechanism.with_tool(&straight_tool(0.2));
        let home = mechanism.platforms()[mechanism.tool()].home;
        let turn = UnitQuaternion::from_scaled_axis(vector![0.3, -0.2, 0.5]);
        let placement = Placement {
            base_from_part: Pose::from_parts(home.translation, turn),
            tool_orientation: home.rotation,
            ..Placement::at(Vector3::zeros())
        };
        Self {
            mechanism,
            placement,
            axes: [
                (
                    'A',
                    Carries::Part,
                    vector![0.9, 0.1, -0.2],
                    vector![-60.0, 25.0, -80.0],
                ),
                (
                    'C',
                    Carries::Part,
                    vector![-0.1, 0.2, 0.95],
                    vector![30.0, 12.0, 0.0],
                ),
            ],
        }
    }

    /// A portal with a fork head.
    pub(crate) fn portal_with_head() -> Self {
        let text = include_str!("portal_with_head.toml");
        let model = Model::from_toml(text, "portal_with_head.toml").expect("a model");
        let mechanism = model.mechanism.with_tool(&straight_tool(0.1));
        let home = mechanism.platforms()[mechanism.tool()].home;
        Self {
            placement: Placement {
                tool_orientation: home.rotation,
                ..Placement::at(vector![0.05, -0.02, 0.4])
            },
            mechanism,
            axes: [
                ('C', Carries::Tool, Vector3::z(), Vector3::zeros()),
                ('A', Carries::Tool, Vector3::x(), Vector3::zeros()),
            ],
        }
    }

    /// A head that tilts the tool of an arm, and a table below it.
    pub(crate) fn head_and_table() -> Self {
        let mut machine = Self::arm_with_table();
        machine.axes[0].1 = Carries::Tool;
        machine
    }

    pub(crate) fn options(&self) -> ReadOptions {
        let base_from_part = self.placement.base_from_part.rotation;
        let mut options = ReadOptions::default();
        let axes = self
            .axes
            .iter()
            .map(|(letter, carries, direction, point)| RotaryAxis {
                letter: *letter,
                carries: *carries,
                direction: Unit::new_normalize(*direction),
                point_mm: *point,
                limits_deg: None,
            });
        options.rotary = Some(Arc::new(RotaryAxes {
            axes: axes.collect(),
            tool_at_zero: base_from_part.inverse() * self.placement.tool_orientation,
        }));
        options
    }

    /// Matrices of the turns of part and tool, part axes at zero, and where the part's origin goes, mm.
    fn turned(&self, a_deg: f64, c_deg: f64) -> ([Matrix3<f64>; 2], Vector3<f64>) {
        let mut turns = [Matrix3::identity(); 2];
        let mut origin = Vector3::zeros();
        for (letter, carries, direction, point) in self.axes.iter().rev() {
            let angle = if *letter == 'A' { a_deg } else { c_deg }.to_radians();
            // Rodrigues' formula.
            let n = direction.normalize();
            let k = n.cross_matrix();
            let turn = Matrix3::identity() + k * angle.sin() + k * k * (1.0 - angle.cos());
            let which = usize::from(*carries == Carries::Tool);
            turns[which] = turn * turns[which];
            if *carries == Carries::Part {
                origin = point + turn * (origin - point);
            }
        }
        (turns, origin)
    }

    /// Where the tip is in the part (mm) when the controller has it at X, Y, Z, A, C, under a force in base axes.
    pub(crate) fn tip(&self, at: &[f64; 5], force: &Vector3<f64>) -> Vector3<f64> {
        self.tip_and_direction(at, force).0
    }

    /// The tool's axis in the part there: the direction that is z of the part where all axes stand at zero.
    pub(crate) fn direction(&self, at: &[f64; 5], force: &Vector3<f64>) -> Vector3<f64> {
        self.tip_and_direction(at, force).1
    }

    fn tip_and_direction(
        &self,
        at: &[f64; 5],
        force: &Vector3<f64>,
    ) -> (Vector3<f64>, Vector3<f64>) {
        let ([part, tool], origin) = self.turned(at[3], at[4]);
        let zero = &self.placement.base_from_part;
        let base_from_part = zero.rotation.to_rotation_matrix().into_inner();
        let place = |p: &Vector3<f64>| {
            zero.translation.vector + base_from_part * (part * p + origin) * 1e-3
        };
        let rotation = base_from_part
            * tool
            * base_from_part.transpose()
            * self
                .placement
                .tool_orientation
                .to_rotation_matrix()
                .into_inner();
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        let pose = Pose::from_parts(place(&vector![at[0], at[1], at[2]]).into(), rotation);
        let posture = self.mechanism.posture(&pose).expect("a posture");
        let wrench = Wrench::new(*force, Vector3::zeros());
        // Without a force: the rigid machine.
        let tool = match force.norm() > 0.0 {
            true => posture.deflected_by(&wrench).expect("an equilibrium").tool,
            false => pose,
        };
        let in_base = (tool.translation.vector - zero.translation.vector) * 1e3;
        let tip = part.transpose() * (base_from_part.transpose() * in_base - origin);
        let axis = self.placement.tool_orientation.inverse() * (base_from_part * Vector3::z());
        let direction = tool.rotation * axis;
        (
            tip,
            part.transpose() * (base_from_part.transpose() * direction),
        )
    }

    fn run(&self, force: Vector3<f64>) -> (Run, String) {
        let run = self.run_of(PROGRAM, force, |_| {});
        let written = run.written.as_ref().expect("a program");
        let text = String::from_utf8(written.bytes.clone()).expect("text");
        (run, text)
    }

    /// A program compensated under a force in base axes.
    pub(crate) fn run_of(
        &self,
        program: &str,
        force: Vector3<f64>,
        set: impl Fn(&mut Task<'_>),
    ) -> Run {
        let options = self.options();
        let program = Program::read(program).expect("program");
        let path = interpret(&program, &options).unwrap_or_else(|e| panic!("{e}"));
        let gcode = Gcode {
            program: &program,
            path: &path,
            reading: &options,
        };
        let wrench = Wrench::new(force, Vector3::zeros());
        let mut writing = WriteOptions::default();
        writing.tolerance_mm = TOLERANCE_MM;
        writing.header = None;
        let mut task = Task {
            mechanism: &self.mechanism,
            program: &gcode,
            corrected: Directions::POSITION,
            placement: self.placement,
            load: ProgramLoad::new(CuttingLoad::Constant {
                axes: LoadAxes::Base,
                wrench,
            }),
            tools: &[],
            weight: WeightCorrection::All,
            cut: None,
            writing,
            run_inputs: RunInputs::default(),
            bounds: Bounds::default(),
            places: 0,
            compliances: false,
        };
        set(&mut task);
        compensate_program(&task, &Unwatched).unwrap_or_else(|e| panic!("{e}"))
    }
}

/// Places of the blocks at feed: X Y Z A C before and after each.
pub(crate) fn blocks(text: &str) -> Vec<[[f64; 5]; 2]> {
    numbered_blocks(text)
        .into_iter()
        .map(|(_, block)| block)
        .collect()
}

/// The same with their lines, from 1.
pub(crate) fn numbered_blocks(text: &str) -> Vec<(usize, [[f64; 5]; 2])> {
    let (mut at, mut incremental, mut feed) = ([0.0; 5], false, false);
    let mut all = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let before = at;
        let mut moves = false;
        for word in line.split_whitespace() {
            let (letter, number) = word.split_at(1);
            let Ok(value) = number.parse::<f64>() else {
                continue;
            };
            match (letter, value) {
                ("G", 90.0) => incremental = false,
                ("G", 91.0) => incremental = true,
                ("G", 0.0) => feed = false,
                ("G", 1.0) => feed = true,
                _ => {}
            }
            if let Some(axis) = "XYZAC".find(letter) {
                at[axis] = if incremental { at[axis] + value } else { value };
                moves = true;
            }
        }
        if moves && feed {
            all.push((index + 1, [before, at]));
        }
    }
    all
}

fn off_segment(p: &Vector3<f64>, from: &[f64; 5], to: &[f64; 5]) -> f64 {
    let [a, b] = [from, to].map(|at| vector![at[0], at[1], at[2]]);
    let way = b - a;
    let share = ((p - a).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
    (p - a - way * share).norm()
}

/// Farthest that the tip is off the programmed lines, before and after compensation, mm.
fn farthest(machine: &Machine, blocks: &[[[f64; 5]; 2]], force: &Vector3<f64>) -> f64 {
    let (mut worst, mut count) = (Worst::new(), 0);
    for [from, to] in blocks {
        for share in [0.1, 0.37, 0.5, 0.8, 1.0] {
            let at = [0, 1, 2, 3, 4].map(|k| from[k] + (to[k] - from[k]) * share);
            // Behind the rapid the force comes gradually.
            if (vector![at[0], at[1], at[2]] - vector![0.0, 0.0, 40.0]).norm() < 5.0 {
                continue;
            }
            count += 1;
            let tip = machine.tip(&at, force);
            let lines = WAY
                .windows(2)
                .map(|pair| off_segment(&tip, &pair[0], &pair[1]));
            worst.add(lines.fold(
                f64::INFINITY,
                |least, off| if off < least { off } else { least },
            ));
        }
    }
    assert!(count > 4 * blocks.len(), "{count}");
    worst.of(count)
}

fn check(machine: &Machine, least_before_mm: f64) {
    let force = vector![300.0, -200.0, 400.0];
    let source = blocks(PROGRAM);
    assert_eq!(source.len(), WAY.len() - 1);
    for (block, pair) in source.iter().zip(WAY.windows(2)) {
        assert_eq!(block[1], pair[1], "{block:?}");
    }
    let before = farthest(machine, &source, &force);
    let (run, text) = machine.run(force);
    let written = blocks(&text);
    let after = farthest(machine, &written, &force);
    assert!(before > least_before_mm, "{before}");
    // The tolerance, and the digits of five words.
    assert!(after < TOLERANCE_MM + 1e-4, "{text}\n{before} {after}");
    let summary = &run.result.summary;
    assert!(summary.max_position_error_after_mm < 1.1 * TOLERANCE_MM);
    // The angles of the program stay: the words of every source block's end are there.
    for [.., a, c] in WAY {
        let kept = written
            .iter()
            .any(|block| block[1][3] == a && block[1][4] == c);
        assert!(kept || [a, c] == [10.0, -20.0], "{a} {c}\n{text}");
    }
}

#[test]
fn a_table_of_two_axes_turns_the_part_below_an_arm() {
    check(&Machine::arm_with_table(), 0.3);
}

#[test]
fn a_fork_head_turns_the_tool() {
    check(&Machine::portal_with_head(), 0.02);
}

#[test]
fn a_head_and_a_table_turn_against_each_other() {
    check(&Machine::head_and_table(), 0.3);
}

#[test]
fn a_table_that_stands_at_an_angle_is_a_part_that_lies_otherwise() {
    // The same by the core alone: a table at 30 degrees, and the part placed there.
    let machine = Machine::arm_with_table();
    let ([part, _], origin) = machine.turned(12.0, 30.0);
    let options = machine.options();
    let axes = options.rotary.expect("axes");
    let turned = machine.placement.turned(Some(&axes.part(&[12.0, 30.0])));
    let point = vector![10.0, 20.0, 30.0];
    let by_hand = machine.placement.tool_pose(&(part * point + origin));
    let off = turned.tool_pose(&point).translation.vector - by_hand.translation.vector;
    assert!(off.norm() < 1e-12, "{off}");
}
