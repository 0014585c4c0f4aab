//! Traced curves of a chain or a machine, before they are shown.

use kinetostat::{
    CurveSettings,
    continuation::{Branch, BranchEnd, CurveEquilibrium, Jump, Special, SpecialKind},
};
use kinetostat_machining::{Warning, WarningCode};

use crate::curve::answer::{CriticalAnswer, Units};
use crate::curve::figures::short;
use crate::curve::query::CurveQuery;
use crate::ui::background::Stage;
use crate::ui::failure::Answer;

/// Curves of a chain or a machine.
pub(crate) struct Followed<E: CurveEquilibrium> {
    /// The start's own branch first.
    pub(crate) branches: Vec<Branch<E>>,
    pub(crate) specials: Vec<Special<E>>,
    /// Some branches that cross were left out because there were too many.
    pub(crate) more_branches: bool,
    pub(crate) jumps: Vec<Jump<E>>,
    pub(crate) critical: Vec<CriticalAnswer>,
    /// Warnings from the path to the curves.
    pub(crate) warnings: Vec<Warning>,
}

/// Fine enough to be drawn.
pub(crate) fn settings(q: &CurveQuery) -> CurveSettings {
    let mut settings = CurveSettings::within(q.range.0, q.range.1);
    settings.branches = q.branches;
    settings.points = q.points;
    settings.largest_turn = 0.05;
    settings.largest_change = Some((q.range.1 - q.range.0) / 60.0);
    if let Some(limits) = q.force_limits {
        settings.conjugate_range = limits;
    }
    settings
}

/// The displacement stands still on the start's own branch.
pub(crate) fn is_locked<E: CurveEquilibrium>(branches: &[Branch<E>]) -> bool {
    let points = branches.first().map(|b| b.points.as_slice());
    points.is_some_and(|list| list.iter().all(|p| !p.slope.is_finite()))
}

/// Shapes that a search found at one value of the parameter.
pub(crate) struct Shapes<E> {
    pub(crate) list: Vec<E>,
    /// The search ended because nothing new came.
    pub(crate) exhausted: bool,
}

/// Searches for shapes at the start and at both ends of the range, and follows those that no branch holds.
pub(crate) fn add_shapes_off_the_curve<E>(
    q: &CurveQuery,
    stage: &Stage,
    search: impl Fn(f64) -> Answer<Shapes<E>>,
    mut add: impl FnMut(&E, f64) -> kinetostat::Result<bool>,
) -> Answer<Vec<Warning>> {
    let mut values = vec![q.start(), q.range.0, q.range.1];
    values.dedup();
    let mut warnings = Vec::new();
    for value in values {
        stage.is("searching for shapes off the curve");
        let shapes = search(value)?;
        let at = short(q.shown(value));
        if !shapes.exhausted {
            warnings.push(Warning::new(
                WarningCode::SearchEnds,
                format!(
                    "the search at {at} ended before it was complete: there may be more shapes"
                ),
            ));
        }
        for shape in &shapes.list {
            stage.is("following the curve through another shape");
            if let Err(error) = add(shape, value) {
                warnings.push(Warning::new(
                    WarningCode::CurveEnds,
                    format!("a shape found at {at} could not be followed: {error}"),
                ));
            }
        }
    }
    Ok(warnings)
}

/// A branch shorter than this, in natural units, is its start.
const AWAY: f64 = 1e-9;

impl<E: CurveEquilibrium> Followed<E> {
    /// The load where the curve starts is none of those that were asked for; a curve that leads away from them ends there.
    fn starts_outside(&self, q: &CurveQuery) -> Option<Warning> {
        let (low, high) = q.force_limits?;
        let own = self.branches.first()?;
        let load = own.points.get(own.start)?.conjugate;
        let goes_on = own.points.iter().any(|p| p.arc > AWAY);
        let (ends, until) = match goes_on {
            false => ("ends where it starts", ""),
            true => (
                "starts outside its limits",
                ", and is shown until it leaves them",
            ),
        };
        let unit = Units::of(q).load_unit;
        (load < low || load > high).then(|| {
            Warning::new(
                WarningCode::CurveEnds,
                format!(
                    "the curve {ends}: the load there is {} {unit}, outside --force-limits {low} {high}{until}. Give limits that hold it",
                    short(load)
                ),
            )
        })
    }

    /// Warnings for branches that end before the requested end, and for those that were not traced.
    pub(crate) fn what_is_missing(&self, q: &CurveQuery) -> Vec<Warning> {
        let early = self.branches.iter().enumerate().flat_map(|(k, branch)| {
            let ends = branch.ends.into_iter().filter(|end| end.may_go_on());
            ends.map(move |end| {
                let more = match end {
                    BranchEnd::Points => {
                        "; --points N allows more, --force-limits keeps it shorter"
                    }
                    _ => "",
                };
                let number = k + 1;
                let text = format!(
                    "branch {number} may go on beyond its end: {}{more}",
                    end.description()
                );
                Warning::new(WarningCode::CurveEnds, text)
            })
        });
        let lost = self.specials.iter().filter_map(|special| {
            let at = short(q.shown(special.point.parameter));
            match (special.lost_branch, special.kind) {
                (true, _) => Some(Warning::new(
                    WarningCode::CurveEnds,
                    format!(
                        "a branch that crosses at {at} could not be followed: its first step did not converge, and its shapes are missing here"
                    ),
                )),
                (_, SpecialKind::StabilityChange) if special.branches.len() < 2 => {
                    Some(Warning::new(
                        WarningCode::MoreBranches,
                        format!(
                            "no branch was found that leaves at {at}, where a limb or a platform loses its stability while the tool stands still. `kinetostat equilibria` searches for its shapes"
                        ),
                    ))
                }
                _ => None,
            }
        });
        let more = self.more_branches.then(|| {
            Warning::new(
                WarningCode::MoreBranches,
                format!(
                    "more than {} branches cross; --branches N follows more",
                    q.branches
                ),
            )
        });
        early
            .chain(lost)
            .chain(more)
            .chain(self.starts_outside(q))
            .collect()
    }
}
