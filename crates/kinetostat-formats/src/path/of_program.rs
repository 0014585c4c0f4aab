//! Conversion of the motions of a program to a path.

use kinetostat_program::{Move, Path, Warning};
use nalgebra::{Isometry3, UnitQuaternion};

use crate::model::motion::{FrameUse, Motion, Runs};
use crate::model::program::{AxesStated, RobotProgram};
use crate::path::axis_turns::{first_leaning, first_leaning_in_base};
use crate::path::maker::{Maker, PathOptions};
use crate::path::motion_faults::{faults_of_motions, has_one_work_object, motions_to_poses};
use crate::path::path_warnings::{by_rule, turns_alone, warnings_of};
use crate::path::tools::{changes, same_frame, tools_of};
use crate::path::{PathError, fault_at};

/// The path of a robot's program, and in which axes it is.
///
/// Motions with poses are moves; those to joint values are moves of which nothing is known, and so is the start of what
/// follows them. Joint motions to poses count as rapids, linear and circular ones as feeds.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RobotPath {
    /// Moves in the order in which they run. Their lines are those of the file that holds the motions.
    pub path: Path,
    /// Motion of every move, an index of [`RobotProgram::motions`].
    pub motions: Vec<usize>,
    /// Work object of the program, in whose axes the path is; `None` where the program uses several, and the path is in the
    /// axes of the robot's base.
    pub work_object: Option<FrameUse>,
    /// The tools that poses are of, in the order in which they are first used; of several, [`Path::tool_changes`] names them by
    /// [`crate::tool_number`].
    pub tools: Vec<FrameUse>,
    /// The file with the motions, an index of [`RobotProgram::files`].
    pub file: usize,
    /// The program states the direction of the tool's axis alone, and in axes of the path it is not z throughout (also where work objects
    /// turn it): about it the tool is turned by [`PathOptions::turn_about_axis`].
    pub axis_alone: bool,
    /// Rotary axes of the machine turn the tool: about it they may stand otherwise where the tool lies along one of them.
    pub(crate) by_axes: bool,
}

impl RobotPath {
    /// Angle between two orientations, as far as the program's text defines them, rad.
    pub(crate) fn turned(&self, to: &UnitQuaternion<f64>, from: &UnitQuaternion<f64>) -> f64 {
        let axis = self.path.tool_axis;
        match self.axis_alone || self.by_axes {
            true => (to * axis).angle(&(from * axis)),
            false => to.angle_to(from),
        }
    }
}

/// The path of a program.
///
/// ```
/// use kinetostat_formats::*;
///
/// let text = "MODULE M\nPROC main()\n\
///     MoveJ [[0,0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0;\n\
///     MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
///     MoveC [[5,5,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\
///     [[10,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\n\
///     ENDPROC\nENDMODULE\n";
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
/// let robot = path_of(&program, &PathOptions::default()).unwrap();
/// assert_eq!(robot.path.moves.len(), 3);
/// assert!((robot.path.moves[2].length_mm() - 5.0 * std::f64::consts::PI).abs() < 1e-9);
/// assert_eq!(robot.path.moves[1].feed.unwrap().value, 1200.0); // mm/min
/// ```
///
/// # Errors
/// All motions that cannot stand in one path: of several tools, of work objects that are not known, in several files.
pub fn path_of(program: &RobotProgram, options: &PathOptions) -> Result<RobotPath, Vec<PathError>> {
    let faults = faults_of_motions(program);
    if !faults.is_empty() {
        return Err(faults);
    }
    let poses = motions_to_poses(program);
    let one = has_one_work_object(&poses);
    let work_object = poses.first().map(|motion| motion.work_object.clone());
    let tools = tools_of(&poses);
    let file = program.motions.first().map_or(0, |motion| motion.file);
    let leaning = match one {
        true => first_leaning(program),
        false => first_leaning(program).or_else(|| first_leaning_in_base(program)),
    };
    let angled = first_with_angles(program);
    let letters = options.rotary.iter().flat_map(|rotary| &rotary.axes);
    let same = letters
        .map(|axis| axis.letter)
        .eq(program.rotary.letters.iter().copied());
    if let (Some(motion), false) = (angled, same) {
        return Err(vec![fault_at(
            program,
            motion,
            "angles of rotary axes say how the tool stands, and these axes are not those of the machine".to_owned(),
            "state the axes of the machine, in the order in which their words were read (`rotary`, `rotary_axes`)",
        )]);
    }
    let maker = Maker::of(program, options, !one, leaning.or(angled))?;
    let mut made = path_of_maker(&maker);
    made.warnings.extend(
        leaning
            .iter()
            .flat_map(|motion| by_rule(program, motion, options)),
    );
    let findings = made.rotary_findings();
    made.warnings.extend(findings);
    made.warnings.extend(turns_alone(&made.moves));
    made.unjudged_feed_on = program.unjudged_feed_on;
    let source = program.files.get(file).into_iter();
    let changes_of = |source| program.language.spindle_changes(source);
    made.spindle_changes.extend(source.flat_map(changes_of));
    if tools.len() > 1 {
        made.tool_changes = changes(&poses, &tools);
    }
    Ok(RobotPath {
        axis_alone: leaning.is_some(),
        by_axes: angled.is_some(),
        motions: (0..program.motions.len()).collect(),
        path: made,
        work_object: work_object.filter(|_| one),
        tools,
        file,
    })
}

/// The first motion at which angles of rotary axes say how the tool stands.
fn first_with_angles(program: &RobotProgram) -> Option<&Motion> {
    let mut stated = program.rotary.motions.iter();
    let first = stated.find(|(_, stated)| matches!(stated, AxesStated::Angles { .. }));
    program.motions.get(*first?.0)
}

/// The moves of all motions in their order.
fn path_of_maker(maker: &Maker<'_>) -> Path {
    let mut moves: Vec<Move> = Vec::with_capacity(maker.program.motions.len());
    let mut warnings = Vec::new();
    let mut last: Option<Isometry3<f64>> = None;
    for (index, motion) in maker.program.motions.iter().enumerate() {
        let before = index.checked_sub(1).map(|i| &maker.program.motions[i]);
        // After a tool change the TCP is at another point.
        let follows = motion.follows.is_some()
            && motion.follows == index.checked_sub(1)
            && before.is_some_and(|before| same_frame(&before.tool, &motion.tool));
        let start = last.filter(|_| follows);
        let made = maker.made(index, start, last.unwrap_or_default());
        if motion.runs == Runs::Elsewhere {
            warnings.push(Warning::of_corrections(motion.line, "nothing in these files leads to this motion: it is corrected as if it ran by itself"
                        .to_owned()));
        }
        last = maker.end_in_path(index);
        moves.push(made);
    }
    warnings.dedup_by(|b, a| a.text == b.text);
    let poses = |index: usize| maker.end_in_path(index).map(|pose| pose.translation.vector);
    warnings.extend(warnings_of(
        maker.program,
        maker.options,
        &moves,
        maker.in_base,
        poses,
    ));
    let mut path = Path::of_moves(moves, maker.tool_axis);
    path.warnings = warnings;
    path
}
