//! The path of a job's program as the page shows it: errors before and after compensation, and the machine at each place.

use std::path::Path;

use kinetostat::{Mechanism, Posture, PostureRequest, Wrench};
use kinetostat_machining::{EngagementSource, Placement, ProgramPlace, Run};
use kinetostat_model::Model;
use nalgebra::Vector3;

use crate::job::machine::MachineSetup;
use crate::job::place_table::PlaceTable;
use crate::job::setting::Setting;
use crate::program::aim::Aim;
use crate::program::places::{JobRun, Standing};
use crate::program::summary;
use crate::shown::answer::{PathAnswer, PlaceOnPath, ShownBox};
use crate::shown::stock::ShownStock;
use crate::ui::failure::Answer;

/// Places of a path that are shown, about.
const PLACES: usize = 1500;

/// The machine at a place of the path, under the load there.
pub(crate) struct AtPlace {
    pub(crate) standing: Standing,
    pub(crate) wrench: Wrench,
    /// Its move by its index in the path, and the share of it that is done.
    pub(crate) on_move: (usize, f64),
}

impl AtPlace {
    /// The machine with the tool of the place, commanded as the program commands it.
    pub(crate) fn posture(&self, mechanism: &Mechanism) -> Answer<Posture> {
        let with_tool = mechanism.with_tool(&self.standing.tip);
        Ok(with_tool.posture(PostureRequest::commands(&self.standing.commands))?)
    }
}

/// A program with its places.
pub(crate) struct ShownPath {
    pub(crate) answer: PathAnswer,
    /// One for each place of the answer.
    pub(crate) places: Vec<AtPlace>,
    /// The stock as it is removed; none of a run that was not made for a page.
    pub(crate) stock: Option<ShownStock>,
}

/// Reads a job, compensates its program without writing it, and keeps what is shown: model with the job's tool, and path.
pub(crate) fn of_job(job: &Path) -> Answer<(Model, ShownPath)> {
    let of_job = JobRun::of(job, None, Aim::Compensate, PLACES)?;
    let mut path = ShownPath::of(&of_job.setting, &of_job.machine, &of_job.run);
    let placement = &of_job.machine.placement;
    if let Some(table) = &of_job.job.job.place {
        path.answer
            .boxes
            .extend(boxes_of_place(table.get_ref(), placement));
    }
    path.answer.has_stock = of_job.stock.is_some();
    path.stock = of_job.stock.map(|stock| ShownStock::of(stock, placement));
    let mut model = of_job.model;
    model.mechanism = of_job.machine.mechanism;
    Ok((model, path))
}

impl ShownPath {
    /// The places of a run with a machine.
    pub(crate) fn of(setting: &Setting, machine: &MachineSetup, run: &Run) -> Self {
        let mechanism = &machine.mechanism;
        let shown = |place: &ProgramPlace| {
            let at = AtPlace {
                standing: Standing::at(place, run, mechanism, mechanism)?,
                wrench: place.wrench,
                on_move: (place.move_index, place.share),
            };
            Some((at, place_on_path(place, run)?))
        };
        let (places, on_path): (Vec<_>, Vec<_>) = run.places.iter().filter_map(shown).unzip();
        let headline = summary::of_run(&run.result);
        let answer = PathAnswer {
            program: setting.program_name.clone(),
            text: String::from_utf8_lossy(&setting.program).into_owned(),
            places: on_path,
            tolerance_mm: run.result.tolerance.allowed_mm,
            headline: headline.lines().map(str::to_owned).collect(),
            has_stock: false,
            boxes: stock(machine).into_iter().collect(),
        };
        Self {
            answer,
            places,
            stock: None,
        }
    }

    /// The places with the largest errors before and after compensation.
    pub(crate) fn worst(&self) -> Vec<usize> {
        let errors: [fn(&PlaceOnPath) -> f64; 2] = [|p| p.error_before_mm, |p| p.error_after_mm];
        let places = || self.answer.places.iter().enumerate();
        let most = |error: fn(&PlaceOnPath) -> f64| {
            places().max_by(|a, b| error(a.1).total_cmp(&error(b.1)))
        };
        let found = errors.into_iter().filter_map(most);
        found.map(|(place, _)| place).collect()
    }
}

/// The stock before the cut, as the box around it.
fn stock(machine: &MachineSetup) -> Option<ShownBox> {
    let EngagementSource::Stock(stock) = &machine.cut.as_ref()?.question.engagement else {
        return None;
    };
    Some(box_of_part("stock", stock.space_mm(), &machine.placement))
}

/// The boxes that a search for a better place keeps apart.
fn boxes_of_place(table: &PlaceTable, placement: &Placement) -> Vec<ShownBox> {
    let part = table.part_box_mm.as_ref();
    let part = part.map(|own| box_of_part("part", *own.get_ref(), placement));
    let obstacles = table.obstacles.iter().map(|own| {
        let own = own.get_ref();
        let edge = |k: usize| Vector3::ith(k, own.to_mm[k] - own.from_mm[k]).into();
        ShownBox {
            name: own.name.clone(),
            kind: "obstacle",
            corner_mm: own.from_mm,
            edges_mm: [0, 1, 2].map(edge),
        }
    });
    part.into_iter().chain(obstacles).collect()
}

/// A box along the axes of the part, mm of the program.
fn box_of_part(kind: &'static str, corners: [[f64; 3]; 2], placement: &Placement) -> ShownBox {
    let [low, high] = corners.map(Vector3::from);
    let edge = |k: usize| (placement.to_metres(&Vector3::ith(k, high[k] - low[k])) * 1e3).into();
    let corner = placement.base_from_part.translation.vector + placement.to_metres(&low);
    ShownBox {
        name: kind.to_owned(),
        kind,
        corner_mm: (corner * 1e3).into(),
        edges_mm: [0, 1, 2].map(edge),
    }
}

fn place_on_path(place: &ProgramPlace, run: &Run) -> Option<PlaceOnPath> {
    let point = run.points.get(place.point)?;
    Some(PlaceOnPath {
        line: place.line,
        path_mm: place.path_mm,
        time_s: place.time_s,
        position_mm: (place.programmed.translation.vector * 1e3).into(),
        force_n: place.wrench.force().into(),
        error_before_mm: place.error_before_mm,
        error_after_mm: place.error_after_mm,
        drives: point.actuator_force.clone(),
        share_of_rating: point.most_loaded.map(|most| most.share_of_rating),
        share_to_buckling: point.share_to_buckling,
        depth_by_limit: depth_by_limit(place.path_mm, run),
    })
}

/// Depth of the cut at a place of the path by its limit: 1 and above chatters.
fn depth_by_limit(path_mm: f64, run: &Run) -> Option<f64> {
    let places = run.result.chatter.as_ref()?.places.iter();
    let judged = places.filter(|place| place.chatters.is_some());
    let mut own = judged.filter(|place| (place.path_mm[0]..=place.path_mm[1]).contains(&path_mm));
    let place = own.next()?;
    Some(place.depth_mm / place.limit_mm.unwrap_or(place.looked_up_to_mm))
}
