//! Input of `place`: ranges, fixtures, obstacles and objective, from the job file and from options.

use kinetostat_machining::Placement;
use kinetostat_placing::{Fixture, Objective, Obstacle, PartBox, Question, Range, Space, Variable};
use serde_spanned::Spanned;

use crate::job::job_file::JobFile;
use crate::job::place_table::{ObjectiveWord, PlaceTable};
use crate::options::finite;
use crate::place::query::FARTHEST;
use crate::placing::arguments::PlacingArgs;
use crate::ui::failure::{Answer, Failure};

/// Largest turn allowed either way, degrees.
const MOST_DEG: f64 = 360.0;

fn written(table: &PlaceTable, variable: Variable) -> Option<&Spanned<[f64; 2]>> {
    match variable {
        Variable::X => table.x_mm.as_ref(),
        Variable::Y => table.y_mm.as_ref(),
        Variable::Z => table.z_mm.as_ref(),
        Variable::TurnX => table.turn_x_deg.as_ref(),
        Variable::TurnY => table.turn_y_deg.as_ref(),
        Variable::TurnZ => table.turn_z_deg.as_ref(),
        Variable::TurnTool => table.turn_tool_deg.as_ref(),
    }
}

fn option(args: &PlacingArgs, variable: Variable) -> Option<&Vec<f64>> {
    match variable {
        Variable::X => args.x_mm.as_ref(),
        Variable::Y => args.y_mm.as_ref(),
        Variable::Z => args.z_mm.as_ref(),
        Variable::TurnX => args.turn_x_deg.as_ref(),
        Variable::TurnY => args.turn_y_deg.as_ref(),
        Variable::TurnZ => args.turn_z_deg.as_ref(),
        Variable::TurnTool => args.turn_tool_deg.as_ref(),
    }
}

/// The ends of a range that are nonsense, in words.
fn fault(variable: Variable, [from, to]: [f64; 2]) -> Option<String> {
    let most = match variable.unit() {
        "mm" => 1e3 * FARTHEST,
        _ => MOST_DEG,
    };
    let far = [from, to]
        .into_iter()
        .find(|end| end.is_nan() || end.abs() > most);
    match far {
        Some(end) if variable.unit() == "mm" => Some(format!(
            "{end} mm leads more than 10 km away; coordinates are in mm"
        )),
        Some(end) => Some(format!(
            "{end} deg: turns from -360 to 360 degrees are allowed"
        )),
        None if from >= to => Some(format!(
            "the range from {from} to {to} is empty: the second number must be above the first"
        )),
        None => None,
    }
}

/// Search space of the part's placement.
pub(crate) fn space(
    job: Option<&JobFile>,
    args: &PlacingArgs,
    given: Placement,
    states_orientation: bool,
) -> Answer<Space> {
    let table = job.and_then(|j| j.job.place.as_ref());
    let table = table.map(Spanned::get_ref);
    let mut ranges = Vec::new();
    for variable in Variable::ALL {
        let ends = if let Some(values) = option(args, variable) {
            let name = format!("--{}", variable.name().replace('_', "-"));
            finite(&name, values)?;
            let ends = [values[0], values[1]];
            if let Some(fault) = fault(variable, ends) {
                return Err(Failure::input(format!("{name}: {fault}")));
            }
            ends
        } else if let (Some(j), Some(ends)) = (job, table.and_then(|t| written(t, variable))) {
            if let Some(fault) = fault(variable, *ends.get_ref()) {
                let help = "write the smallest and the largest value, as in x_mm = [-40, 40]";
                return Err(j.error(ends, &fault, help));
            }
            *ends.get_ref()
        } else {
            continue;
        };
        let [from, to] = ends;
        ranges.push(Range { variable, from, to });
    }
    let fixtures = fixtures(job, table)?;
    Space::new(given, ranges, fixtures, states_orientation)
        .map_err(|error| Failure::input(error.to_string()))
}

fn fixtures(job: Option<&JobFile>, table: Option<&PlaceTable>) -> Answer<Vec<Fixture>> {
    let (Some(job), Some(table)) = (job, table) else {
        return Ok(Vec::new());
    };
    let one = |written: &Spanned<crate::job::place_table::FixtureTable>| {
        let own = written.get_ref();
        let far = |x: &f64| x.is_nan() || x.abs() > 1e3 * FARTHEST;
        if own.part_origin_mm.iter().any(far) {
            let what = format!("the fixture '{}' lies more than 10 km away", own.name);
            return Err(job.error(written, &what, "coordinates are in mm"));
        }
        let orientation = own.part_orientation.as_ref().map(|table| {
            let pose = table.get_ref().pose();
            let pose = pose.map_err(|(message, help)| job.error(table, &message, &help))?;
            Answer::Ok(pose.rotation)
        });
        Ok(Fixture {
            name: own.name.clone(),
            origin_mm: own.part_origin_mm,
            orientation: orientation.transpose()?,
        })
    };
    table.fixtures.iter().map(one).collect()
}

/// Objective and obstacles.
pub(crate) fn question(job: Option<&JobFile>, args: &PlacingArgs) -> Answer<Question> {
    let table = job.and_then(|j| j.job.place.as_ref());
    let Some((job, table)) = job.zip(table.map(Spanned::get_ref)) else {
        return Ok(Question {
            objective: objective(args.objective),
            ..Question::default()
        });
    };
    let turned_round = |from: &[f64; 3], to: &[f64; 3]| {
        let grows = |k: usize| from[k] < to[k];
        !(0..3).all(grows)
    };
    let mut obstacles = Vec::new();
    for written in &table.obstacles {
        let own = written.get_ref();
        if turned_round(&own.from_mm, &own.to_mm) {
            let what = format!("the obstacle '{}' has no inside", own.name);
            let help = "write its smallest and its largest coordinates, each of from_mm below that of to_mm";
            return Err(job.error(written, &what, help));
        }
        obstacles.push(Obstacle {
            name: own.name.clone(),
            from_mm: own.from_mm,
            to_mm: own.to_mm,
        });
    }
    let mut part = None;
    if let Some(written) = &table.part_box_mm {
        let [from_mm, to_mm] = *written.get_ref();
        if turned_round(&from_mm, &to_mm) {
            let help = "write the smallest and the largest coordinates of the part, as in [[0, 0, -40], [200, 100, 0]]";
            return Err(job.error(written, "the box around the part has no inside", help));
        }
        part = Some(PartBox { from_mm, to_mm });
    }
    Ok(Question {
        objective: objective(args.objective.or(table.objective)),
        obstacles,
        part,
    })
}

fn objective(word: Option<ObjectiveWord>) -> Objective {
    match word {
        None | Some(ObjectiveWord::Error) => Objective::Error,
        Some(ObjectiveWord::Correction) => Objective::Correction,
        Some(ObjectiveWord::Tilt) => Objective::Tilt,
        Some(ObjectiveWord::Drive) => Objective::Drive,
        Some(ObjectiveWord::Buckling) => Objective::Buckling,
    }
}
