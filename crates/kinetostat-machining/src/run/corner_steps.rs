//! What becomes of the claim at sharp corners if the load there is by the other of the two readings.

use kinetostat::{Pose, Wrench};

use crate::load::law::CornerLoad;
use crate::postures::neighbour::in_chunks;
use crate::run::machines::Machines;
use crate::run::points::BATCH;
use crate::run::sites::Site;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Largest distance of the tool from its place on the corner steps that were read the other way, if the load
/// there is by `reading` ([`Site::other_wrench`]), mm. None without such steps; infinite where a step has no
/// equilibrium by that reading.
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
    watch.stage("corner steps by the other reading", steps.len());
    let machines = Machines::new(task);
    let place = &task.placement;
    let mut largest: Option<f64> = None;
    let mut done = 0;
    for batch in steps.chunks(BATCH) {
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        let of_one_tool = batch.chunk_by(|a, b| machines.same(&a.0, &b.0));
        let errors = of_one_tool.flat_map(|run| {
            let (machine, orientation) = machines.at(&run[0].0);
            let mechanism = machine.mechanism();
            in_chunks(run, |memory, steps| {
                let poses: Vec<Pose> = steps
                    .iter()
                    .map(|(site, _)| place.tool_pose(&site.commanded))
                    .collect();
                let wrenches: Vec<Wrench> = steps.iter().map(|(_, wrench)| *wrench).collect();
                let found = machine.rest(&poses, &wrenches);
                let [memory, _] = memory;
                let mut tool = |i: usize| -> Option<Pose> {
                    match &found {
                        Some(found) => Some(found.tool_pose(i)),
                        None => {
                            let rest = memory.rest(mechanism, &poses[i], &wrenches[i], orientation);
                            Some(rest.ok()?.1)
                        }
                    }
                };
                (0..steps.len())
                    .map(|i| {
                        let wanted = place.tool_pose(&steps[i].0.desired);
                        let off = tool(i)?.translation.vector - wanted.translation.vector;
                        Some(place.to_program(&off).norm())
                    })
                    .collect::<Vec<Option<f64>>>()
            })
        });
        for error in errors {
            let Some(error) = error.filter(|error| error.is_finite()) else {
                return Ok(Some(f64::INFINITY));
            };
            largest = Some(largest.map_or(error, |most: f64| most.max(error)));
        }
        done += batch.len();
        watch.advance(done);
    }
    Ok(largest)
}
