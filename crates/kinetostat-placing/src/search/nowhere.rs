//! Explanation of a search without result: the nearest placement, and the displacement of the part that would help.

use nalgebra::Vector3;

use crate::answer::{Evaluated, Nowhere};
use crate::search::looking::Search;
use crate::space::Place;

impl Search<'_, '_> {
    /// The placement that is nearest to being taken, and how far the part would have to be moved.
    pub(super) fn nowhere(&self, worths: &[Evaluated], filling: &[Evaluated]) -> Option<Nowhere> {
        let all = worths.iter().chain(filling);
        let place = &all.min_by(|a, b| a.value.order(&b.value))?.place;
        let (nearest, _) = self.candidate(place);
        Some(Nowhere {
            move_mm: self.way_back(place),
            nearest,
        })
    }

    /// The shortest move of the part towards the tool at home with which all of the program is reached, base axes, mm.
    pub(super) fn way_back(&self, place: &Place) -> Option<[f64; 3]> {
        let program = self.evaluator.program;
        let lies = self.space().placement(place);
        let probes = self.first_places();
        let tip = |i: &usize| program.tool_pose(lies, *i).translation.vector;
        let middle: Vector3<f64> =
            probes.iter().map(tip).sum::<Vector3<f64>>() / probes.len() as f64;
        let way = self.evaluator.home - middle;
        let reached = |share: f64| {
            let mut moved = lies;
            moved.base_from_part.translation.vector += way * share;
            let reach = |i: &usize| program.reach(moved, *i);
            let reached = |i: &usize| matches!(reach(i), kinetostat_machining::Reach::Reached);
            probes.iter().all(reached)
        };
        const STEPS: usize = 40;
        let first = (1..=STEPS).find(|i| reached(*i as f64 / STEPS as f64))?;
        let (mut short, mut far) = (
            (first - 1) as f64 / STEPS as f64,
            first as f64 / STEPS as f64,
        );
        for _ in 0..12 {
            let middle = (short + far) / 2.0;
            match reached(middle) {
                true => far = middle,
                false => short = middle,
            }
        }
        Some((way * far * 1e3).into())
    }
}
