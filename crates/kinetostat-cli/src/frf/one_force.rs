//! Measured curves of which one force is fitted: shapes are those of curves by the same force.

use kinetostat_chatter::MeasuredResponse;

use crate::frf::arguments::MotionAxis;

/// The curves by the first force along one of these axes, or by the first one of the file where there is none; and what is
/// said of the others.
pub(crate) fn of_one_force(
    responses: &[MeasuredResponse],
    from: &[MotionAxis],
) -> (Vec<MeasuredResponse>, Option<String>) {
    let force = |response: &MeasuredResponse| {
        (
            response.reference_node,
            response.reference_direction.unsigned_abs(),
        )
    };
    let along = |axis: &MotionAxis| {
        let by_it = |response: &&MeasuredResponse| force(response).1 == *axis as u32 + 1;
        responses.iter().find(by_it)
    };
    let chosen = from.iter().find_map(along).or_else(|| responses.first());
    let chosen = chosen.map(force);
    let is_own = |response: &MeasuredResponse| Some(force(response)) == chosen;
    let (own, others): (Vec<_>, Vec<_>) = responses.iter().cloned().partition(is_own);
    let said = others.first().map(|other| {
        format!(
            "{} of {} measured curves are by other forces than that of '{}' ('{}' for one) and are not fitted: --from names the axis of the force whose curves are",
            others.len(),
            responses.len(),
            own.first().map_or("", |response| &response.name),
            other.name
        )
    });
    (own, said)
}
