//! The query of `equilibria`, from its options.

use kinetostat::{EndCondition, Twist, equilibrium::SearchSettings, spatial::moved};
use kinetostat_diagnostic::ErrorCode;
use nalgebra::Vector3;

use crate::end_condition::holding::{Holding, holding};
use crate::end_condition::loads::{constant, constant_loads_text, wrench};
use crate::end_condition::moves::Moves;
use crate::equilibria::arguments::EquilibriaArgs;
use crate::options::vector;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{load_triple, short, triple};

pub(crate) struct EquilibriaQuery {
    pub(crate) end: EndCondition,
    pub(crate) holding: Holding,
    pub(crate) settings: SearchSettings,
    /// Direction along which a stiffness is shown, base axes.
    pub(crate) along: Option<Vector3<f64>>,
    pub(crate) words: String,
}

pub(crate) fn equilibria_query(moves: &Moves, args: &EquilibriaArgs) -> Answer<EquilibriaQuery> {
    let acting = wrench(
        "--force",
        args.force.as_deref(),
        "--moment",
        args.moment.as_deref(),
    )? + constant(&args.end)?;
    let loaded = acting.0.amax() > 0.0 || args.force.is_some() || args.moment.is_some();
    let part = |name: &str, values: &Option<Vec<f64>>| {
        values
            .as_ref()
            .map_or_else(|| Ok(Vector3::zeros()), |v| vector(name, v))
    };
    let shift = part("--displaced-mm", &args.displaced_mm)?;
    let turn = part("--turned-deg", &args.turned_deg)?;
    if turn.norm() > 180.0 {
        return Err(ErrorCode::Value.failure(
            "--turned-deg: the tool can be turned by 180 degrees at most (the length of the three)",
        ));
    }
    let displaced = args.displaced_mm.is_some() || args.turned_deg.is_some();
    let twist = Twist::new(shift * 1e-3, turn.map(f64::to_radians));
    let subject = moves.subject;
    if twist.0.amax() > 0.0 && moves.directions.share(&twist.0) < 1.0 - 1e-6 {
        return Err(ErrorCode::RigidDirection.failure(format!(
                "the tool cannot be held there: the {subject} cannot move its end that way (a planar {subject} stays in its plane). Leave out the part of --displaced-mm and --turned-deg across it",
            ),
        ));
    }
    let place = moved(&moves.place, &twist);
    let held = holding(moves, &args.end, &place, acting, displaced || !loaded, None)?;
    refuse_displaced_and_free(&held, &twist)?;
    let count = |option: &str, value: Option<usize>, default: usize| match value {
        None => Ok(default),
        Some(n) if (1..=10_000_000).contains(&n) => Ok(n),
        Some(_) => {
            Err(ErrorCode::Value.failure(format!("{option} takes a number from 1 to 10000000")))
        }
    };
    let default = SearchSettings::default();
    let settings = default
        .with_starts(count("--starts", args.starts, default.starts)?)
        .with_fruitless(count("--fruitless", args.fruitless, default.fruitless)?)
        .with_most(MOST_KNOWN);
    let along = [shift, acting.force()]
        .into_iter()
        .find(|v| v.norm() > 0.0)
        .map(|v| v.normalize());
    let mut words = match (displaced, loaded) {
        (true, _) => format!(
            "Which shapes does the {subject} take while its tool is held {} mm from the commanded place{}?",
            triple(shift.into(), short),
            if turn.norm() > 0.0 {
                format!(" and turned by {} deg", triple(turn.into(), short))
            } else {
                String::new()
            }
        ),
        (false, true) => format!(
            "Which shapes does the {subject} take under the force {} N and the moment {} N m on its tool?",
            load_triple(acting.force().into()),
            load_triple(acting.moment().into())
        ),
        (false, false) => {
            format!(
                "Which shapes does the {subject} take while its tool is held at the commanded place?"
            )
        }
    };
    words.push(' ');
    words.push_str(&held.description());
    words.push_str(&constant_loads_text(&args.end));
    Ok(EquilibriaQuery {
        end: held.end.clone(),
        holding: held,
        settings,
        along,
        words,
    })
}

/// A displacement in a free direction would be ignored.
fn refuse_displaced_and_free(held: &Holding, twist: &Twist) -> Answer<()> {
    let local = kinetostat::spatial::turn_matrix(&held.end.axes).transpose() * twist.0;
    let most = local.amax();
    let wrong = (0..6).find(|&k| {
        held.end.prescribed[k] == kinetostat::Prescribed::Wrench && local[k].abs() > 1e-9 * most
    });
    match wrong {
        Some(k) => Err(ErrorCode::Conflict.failure(format!(
                "the tool is to be displaced in '{0}' and free in '{0}': hold it there, or leave that part of the displacement out",
                crate::end_condition::holding::DIRECTIONS[k]
            ),
        )),
        None => Ok(()),
    }
}

/// The search ends when so many are known.
pub(crate) const MOST_KNOWN: usize = 100;
