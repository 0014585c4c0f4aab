//! Errors at sharp corners under the other of the two readings of the load.

use kinetostat::Wrench;
use kinetostat::number::larger;

use crate::load::law::CornerLoad;
use crate::run::other_load::errors_under;
use crate::run::sites::site::Site;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Largest distance of the tool from its place on the corner steps that were read the other way, if the load there is
/// by `reading` ([`Site::other_wrench`]), mm. `None` without such steps; infinite if a step has no equilibrium by
/// that reading.
pub(crate) fn by_the_other_reading<S: Iterator<Item = Site>>(
    task: &Task<'_>,
    reading: CornerLoad,
    sites: impl Fn() -> S,
    watch: &dyn Watch,
) -> Result<Option<f64>, RunError> {
    let mut loads = task.tools.iter().map(|tool| &tool.load).chain([&task.load]);
    if loads.all(|load| load.at_corners == reading) {
        return Ok(None);
    }
    let steps: Vec<(Site, Wrench)> = sites()
        .filter(|site| task.load_on(site.line).at_corners == reading.other())
        .filter_map(|site| {
            let other = site.other_wrench?;
            Some((site, other))
        })
        .collect();
    let errors = errors_under(task, &steps, "corner steps by the other reading", watch)?;
    let errors = errors.into_iter().map(|e| e.unwrap_or(f64::INFINITY));
    Ok(errors.reduce(larger))
}
