//! Critical load factors of a chain.

use kinetostat::{
    ChainProblem, CurveSettings, Parameter, critical_load_factor,
    equilibrium::{CriticalLoad, StabilityOf},
};
use kinetostat_analysis::serial_chain::SerialChain;

use crate::curve::answer::{CriticalAnswer, kind_name};
use crate::curve::query::CurveQuery;
use crate::end_condition::subject::Subject;
use crate::ui::failure::Answer;

pub(crate) fn critical_loads(
    chain: &SerialChain,
    q: &CurveQuery,
    problem: &ChainProblem<'_>,
    settings: &CurveSettings,
) -> Answer<Vec<CriticalAnswer>> {
    let Parameter::Load(pattern) = &q.parameter else {
        return Ok(Vec::new());
    };
    if q.range.1 <= 0.0 || q.range.0 > 0.0 {
        return Ok(Vec::new());
    }
    let mut list = Vec::new();
    for (stability_of, name) in [
        (StabilityOf::Shape, "shape"),
        (StabilityOf::ShapeAndEnd, "shape_and_tool"),
    ] {
        let found = critical_load_factor(problem, pattern, stability_of, settings)?;
        list.push(critical_answer(chain, name, found));
    }
    Ok(list)
}

fn critical_answer(
    chain: &SerialChain,
    stability_of: &'static str,
    c: CriticalLoad,
) -> CriticalAnswer {
    let mode = c.exact.as_ref().map_or_else(Vec::new, |e| e.mode.clone());
    let caution = c.caution().unwrap_or_default();
    CriticalAnswer {
        stability_of,
        linear_factor: c.linear,
        linear_mode_in_words: chain.motion_description(&c.linear_mode),
        factor: c.exact.as_ref().map(|e| e.factor),
        kind: c.exact.as_ref().and_then(|e| e.kind).map(kind_name),
        mode_in_words: chain.motion_description(&mode),
        mode,
        followed_to_factor: c.reached,
        conservative: c.conservative,
        safe_below_factor: c.definite_until,
        caution,
    }
}
