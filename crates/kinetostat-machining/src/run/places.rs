//! Some places of a run, with all that is needed to solve other machines there.

use kinetostat::Wrench;
use kinetostat_program::{Move, MoveKind};
use nalgebra::{Matrix3, Vector3};

use crate::load::along_path::LoadAlongPath;
use crate::load::law::tool_on;
use crate::postures::arm_course::ArmCourse;
use crate::postures::neighbour::{Neighbour, in_chunks};
use crate::result::point::{PointKind, PointResult, ProgramPlace, size};
use crate::result::selection::{thinned, worst};
use crate::run::points::{Machines, Solving};
use crate::run::sites::site::Site;
use crate::task::Task;

/// About so many places of a run as the task asks for, those with the largest errors among them; none on rapids and on steps, where the
/// load is on its way from one to another. `sites` are those of the points, in their order.
pub(crate) fn places<S: Iterator<Item = Site>>(
    task: &Task<'_>,
    points: &[PointResult],
    sites: impl Fn() -> S,
    how: Solving<'_>,
) -> Vec<ProgramPlace> {
    if task.places == 0 {
        return Vec::new();
    }
    let mut chosen = vec![false; points.len()];
    for i in thinned(points, &worst(points), task.places) {
        chosen[i] = points[i].kind == PointKind::Feed;
    }
    let wanted = |(i, _): &(usize, Site)| chosen.get(*i) == Some(&true);
    let chosen: Vec<(usize, Site)> = sites().enumerate().filter(wanted).collect();
    let begins = begins_s(&task.path().moves);
    let all = chosen.iter().map(|(i, site)| ProgramPlace {
        point: *i,
        time_s: time_s(task, site, &begins),
        ..place(task, site, &points[*i], how)
    });
    let mut all: Vec<ProgramPlace> = all.collect();
    if task.compliances {
        let machines = Machines::new(task);
        let compliances = in_chunks(&chosen, |memory, some| {
            let of = |(_, site): &(usize, Site)| {
                compliance(task, &machines, &mut memory[0], site, how.course)
            };
            some.iter().map(of).collect()
        });
        for (place, compliance) in all.iter_mut().zip(compliances) {
            place.compliance_um_per_n = compliance;
        }
    }
    all
}

/// Time at feed before each move, s; unknown behind one whose duration is not known.
fn begins_s(moves: &[Move]) -> Vec<Option<f64>> {
    let mut now = Some(0.0);
    let begin = |own: &Move| {
        let begin = now;
        if own.kind == MoveKind::Feed {
            now = now.zip(own.seconds()).map(|(now, own)| now + own);
        }
        begin
    };
    moves.iter().map(begin).collect()
}

fn time_s(task: &Task<'_>, site: &Site, begins: &[Option<f64>]) -> Option<f64> {
    let begin = (*begins.get(site.move_index)?)?;
    let own = task.path().moves.get(site.move_index)?.seconds()?;
    Some(begin + site.share * own)
}

/// The force block of the tool's tangent compliance about the loaded equilibrium [R 5.1.2], turned into the axes of the program.
fn compliance(
    task: &Task<'_>,
    machines: &Machines<'_, '_>,
    memory: &mut Neighbour,
    site: &Site,
    course: Option<&ArmCourse>,
) -> Option<[[f64; 3]; 3]> {
    if let Some(posture) = course.and_then(|c| c.standing_at(site.move_index, site.share)) {
        memory.stand_at(posture);
    }
    let (machine, orientation) = machines.at(site);
    let lies = site.commanded_placement(task);
    let pose = site.commanded_pose(task);
    let mechanism = machine.mechanism();
    let found = memory.equilibrium(mechanism, &pose, &site.wrench, orientation);
    let found = found.ok()?.1.compliance();
    if !found.free.is_empty() {
        return None;
    }
    let block = found.springs.fixed_view::<3, 3>(0, 0).into_owned();
    // Along a push acts the symmetric part alone.
    let block = 0.5e6 * (block + block.transpose());
    let columns = [Vector3::x(), Vector3::y(), Vector3::z()];
    let columns = columns.map(|force| lies.to_part_axes(&(block * lies.to_base_axes(&force))));
    let in_part = Matrix3::from_columns(&columns);
    let rows = [0, 1, 2].map(|i| in_part.row(i).transpose().into());
    in_part.iter().all(|x| x.is_finite()).then_some(rows)
}

fn place(task: &Task<'_>, site: &Site, point: &PointResult, how: Solving<'_>) -> ProgramPlace {
    let programmed = site.programmed(site.placement(task));
    let near = how
        .course
        .and_then(|c| c.standing_at(site.move_index, site.share));
    let motions = how
        .frame
        .motions(task.mechanism_on(site.line), &[programmed], |_| near);
    // The place had no answer if the frame has no motion there.
    let motion = motions.into_iter().find_map(Result::ok).unwrap_or_default();
    let as_commanded = site.programmed(site.commanded_placement(task));
    ProgramPlace {
        line: site.line,
        path_mm: site.path_mm,
        move_index: site.move_index,
        share: site.share,
        point: 0,
        time_s: None,
        tool: tool_on(task.tools, task.path(), site.line).map(|tool| tool.number),
        programmed: programmed.pose(),
        wanted: programmed.moved(&motion).pose(),
        commanded: site.commanded_pose(task),
        wanted_as_commanded: as_commanded.moved(&motion).pose(),
        wrench: site.wrench,
        error_before_mm: size(&point.error_before_mm),
        error_after_mm: size(&point.error_after_mm),
        metres_per_mm: 1e-3 * task.placement.scale,
        compliance_um_per_n: None,
    }
}

/// Load of a task at places of its program, without its ramps: base axes, N and N m.
#[must_use]
pub fn wrenches_at(task: &Task<'_>, places: &[ProgramPlace]) -> Vec<Wrench> {
    let load = LoadAlongPath::with_tools(task.load, task.path(), task.tools).with_cut(task.cut);
    let at = |p: &ProgramPlace| load.wrench(&task.placement, p.move_index, p.share);
    places.iter().map(at).collect()
}
