//! Places of a run under another load than theirs: where the tool is then.

use kinetostat::{Pose, Wrench};

use crate::measured_frame::{MeasuredFrame, PartPlace};
use crate::postures::neighbour::in_chunks;
use crate::run::points::{BATCH, Machines};
use crate::run::sites::site::Site;
use crate::task::{RunError, Task};
use crate::watch::Watch;

/// Distance of the tool from its place at each of these, with what the written program commands there and the load beside
/// it (base axes, N, N m), mm. `None` if the machine has no equilibrium under that load. Gravity and what else acts in the
/// model stay as they are.
pub(crate) fn errors_under(
    task: &Task<'_>,
    loaded: &[(Site, Wrench)],
    stage: &str,
    watch: &dyn Watch,
) -> Result<Vec<Option<f64>>, RunError> {
    watch.stage(stage, loaded.len());
    let machines = Machines::new(task);
    let frame = MeasuredFrame::of(task, None)?;
    let mut all: Vec<Option<f64>> = Vec::with_capacity(loaded.len());
    for batch in loaded.chunks(BATCH) {
        if watch.cancelled() {
            return Err(RunError::Cancelled);
        }
        let of_one_tool = batch.chunk_by(|a, b| machines.same(&a.0, &b.0));
        let errors = of_one_tool.flat_map(|run| {
            let (machine, orientation) = machines.at(&run[0].0);
            let mechanism = machine.mechanism();
            in_chunks(run, |memory, sites| {
                let poses: Vec<Pose> = sites
                    .iter()
                    .map(|(site, _)| site.commanded_pose(task))
                    .collect();
                let places: Vec<PartPlace> = sites
                    .iter()
                    .map(|(site, _)| site.programmed(site.commanded_placement(task)))
                    .collect();
                let own = task.mechanism_on(sites[0].0.line);
                let motions = frame.motions(own, &places, |_| None);
                let wrenches: Vec<Wrench> = sites.iter().map(|(_, wrench)| *wrench).collect();
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
                (0..sites.len())
                    .map(|i| {
                        let wanted = places[i].moved(motions[i].as_ref().ok()?).pose();
                        let off = tool(i)?.translation.vector - wanted.translation.vector;
                        Some(places[i].place.to_program(&off).norm())
                            .filter(|error| error.is_finite())
                    })
                    .collect::<Vec<Option<f64>>>()
            })
        });
        all.extend(errors);
        watch.advance(all.len());
    }
    Ok(all)
}
