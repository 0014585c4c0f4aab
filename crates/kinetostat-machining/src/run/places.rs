//! Some places of a run, with all that is needed to solve other machines there.

use kinetostat::Wrench;

use crate::load::along_path::LoadAlongPath;
use crate::load::tool::tool_on;
use crate::result::point::{PointKind, PointResult, size};
use crate::result::program_place::ProgramPlace;
use crate::result::selection::{thinned, worst};
use crate::run::sites::Site;
use crate::task::Task;

/// About so many places of a run as the task asks for, those with the largest errors among them; none on rapids and on steps, where the
/// load is on its way from one to another. `sites` are those of the points, in their order.
pub(crate) fn places<S: Iterator<Item = Site>>(
    task: &Task<'_>,
    points: &[PointResult],
    sites: impl Fn() -> S,
) -> Vec<ProgramPlace> {
    if task.places == 0 {
        return Vec::new();
    }
    let mut chosen = vec![false; points.len()];
    for i in thinned(points, &worst(points), task.places) {
        chosen[i] = points[i].kind == PointKind::Feed;
    }
    let here = |(i, site): (usize, Site)| place(task, &site, &points[i]);
    let wanted = |(i, _): &(usize, Site)| chosen.get(*i) == Some(&true);
    sites().enumerate().filter(wanted).map(here).collect()
}

fn place(task: &Task<'_>, site: &Site, point: &PointResult) -> ProgramPlace {
    let lies = site.placement(task);
    let turned = site.commanded_placement(task);
    let stated = lies.orientation_of(site.orientation);
    ProgramPlace {
        line: site.line,
        path_mm: site.path_mm,
        move_index: site.move_index,
        share: site.share,
        tool: tool_on(task.tools, task.path(), site.line).map(|tool| tool.number),
        wanted: lies.pose(&site.desired, stated),
        commanded: turned.pose(
            &site.commanded,
            turned.orientation_of(site.commanded_orientation),
        ),
        wanted_as_commanded: turned.pose(&site.desired, turned.orientation_of(site.orientation)),
        wrench: site.wrench,
        error_before_mm: size(&point.error_before_mm),
        error_after_mm: size(&point.error_after_mm),
        metres_per_mm: 1e-3 * task.placement.scale,
    }
}

/// What the load of a task is at places of its program, without the way on which it comes and goes: base axes, N and N m.
#[must_use]
pub fn wrenches_at(task: &Task<'_>, places: &[ProgramPlace]) -> Vec<Wrench> {
    let load = LoadAlongPath::with_tools(task.load, task.path(), task.tools).with_cut(task.cut);
    let at = |p: &ProgramPlace| load.wrench(&task.placement, p.move_index, p.share);
    places.iter().map(at).collect()
}
