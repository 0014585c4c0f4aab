//! The configuration of the arm that a program states, beside that in which the model was solved.

use kinetostat_formats::{RobotPath, RobotProgram, StatedArm};
use kinetostat_machining::{
    ArmConfiguration, Elbow, PointResult, Shoulder, Warning, WarningCode, Wrist,
};

/// A place where the program states a configuration, and that of the model there.
struct Place {
    line: usize,
    text: String,
    stated: StatedArm,
    solved: ArmConfiguration,
}

/// What is wrong with a part of the arm, if anything: two places that speak against each other, or one.
type Against<'p> = Option<(&'p Place, Option<&'p Place>)>;

/// Places where the model's arm bends otherwise than the program states: stiffness and joint values there are those of another
/// posture.
///
/// What is behind axis 1 is the same for all makers. Of elbow and wrist only the zeros of the maker's axes say which side a flag means:
/// there one flag must always go with one side of the model.
pub(crate) fn other_configuration(
    program: &RobotProgram,
    path: &RobotPath,
    points: &[PointResult],
) -> Option<Warning> {
    let places = places(program, path, points);
    let back = |place: &&Place| {
        (place.stated.is_back).is_some_and(|back| back != (place.solved.shoulder == Shoulder::Back))
    };
    let shoulder: Against<'_> = places.iter().find(back).map(|place| (place, None));
    let elbow = || changes_alone(&places, |p| (p.stated.elbow, p.solved.elbow == Elbow::Down));
    let wrist = || changes_alone(&places, |p| (p.stated.wrist, p.solved.wrist == Wrist::Flip));
    let (place, before) = shoulder.or_else(elbow).or_else(wrist)?;
    let here = format!(
        "the program states the configuration `{}`, and the model's arm is solved {}",
        place.text, place.solved
    );
    let than = before.map_or_else(String::new, |before| {
        format!(
            ", after `{}` and {} on line {}",
            before.text, before.solved, before.line
        )
    });
    Some(Warning::at_line(
        WarningCode::OtherConfiguration,
        place.line,
        format!(
            "{here}{than}: the results are those of the model's posture, not of the program's. Give the model a home in the program's configuration, or run the parts with different configurations one by one"
        ),
    ))
}

/// The last point of every motion that states a configuration, where the model has one.
fn places(program: &RobotProgram, path: &RobotPath, points: &[PointResult]) -> Vec<Place> {
    let is_last = |(index, point): &(usize, &PointResult)| {
        let next = points.get(index + 1);
        next.is_none_or(|next| next.move_index != point.move_index)
    };
    let last = points.iter().enumerate().filter(is_last);
    last.filter_map(|(_, point)| {
        let motion = program.motions.get(*path.motions.get(point.move_index)?)?;
        let configuration = &motion.target.pose()?.configuration;
        let stated = StatedArm::of(program.language, configuration);
        (stated != StatedArm::default()).then_some(Place {
            line: point.line,
            text: configuration.text.clone(),
            stated,
            solved: point.configuration?,
        })
    })
    .collect()
}

/// The first place where a stated side changes and the model's does not, or the other way round, with the one that it is compared with.
fn changes_alone(places: &[Place], side: impl Fn(&Place) -> (Option<bool>, bool)) -> Against<'_> {
    let mut first: Option<(&Place, bool, bool)> = None;
    for place in places {
        let (Some(stated), solved) = side(place) else {
            continue;
        };
        let Some((before, stated_before, solved_before)) = first else {
            first = Some((place, stated, solved));
            continue;
        };
        if (stated == stated_before) != (solved == solved_before) {
            return Some((place, Some(before)));
        }
    }
    None
}
