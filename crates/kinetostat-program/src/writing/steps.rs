//! The pieces of a move, from the nodes of its division: geometry in whatever language they are written.

use std::ops::Range;

use nalgebra::{Vector3, Vector6};

use crate::field::correction::Correction;
use crate::number::larger;
use crate::path::moves::{Move, Path};
use crate::writing::jump::{Jump, Turn};
use crate::writing::node::{Node, is_corrected_at_end, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::output_state::OutputMove;

/// Hands out the pieces of one move after the other.
pub(crate) struct Steps<'a> {
    path: &'a Path,
    options: &'a WriteOptions,
    pub nodes: Vec<Node>,
    jumps: Vec<Jump>,
    next_node: usize,
    /// How far the tool is turned where it was last, as [`OutputMove::tilt`].
    tilt: Vector3<f64>,
    /// Largest jump of the correction without a step of its own, in mm.
    pub largest_jump_taken_up_mm: f64,
}

impl<'a> Steps<'a> {
    pub fn new(
        path: &'a Path,
        options: &'a WriteOptions,
        nodes: Vec<Node>,
        jumps: Vec<Jump>,
    ) -> Self {
        Self {
            path,
            options,
            nodes,
            jumps,
            next_node: 0,
            tilt: Vector3::zeros(),
            largest_jump_taken_up_mm: 0.0,
        }
    }

    fn nodes_of(&mut self, move_index: usize) -> Range<usize> {
        let first = self.next_node;
        while self
            .nodes
            .get(self.next_node)
            .is_some_and(|node| node.move_index == move_index)
        {
            self.next_node += 1;
        }
        first..self.next_node
    }

    /// The pieces of a move, of which those before are taken already, and its nodes; `reached` is where the tool was last to go.
    pub fn of(
        &mut self,
        move_index: usize,
        reached: Vector3<f64>,
    ) -> (Vec<OutputMove>, Range<usize>) {
        let motion = &self.path.moves[move_index];
        let range = self.nodes_of(move_index);
        let whole = |target, tilt, corrected| {
            vec![OutputMove {
                share_from: 0.0,
                share_to: 1.0,
                target,
                tilt,
                corner_step: false,
                turn: None,
                corrected,
            }]
        };
        let steps = match self.nodes[range.clone()].last() {
            None => whole(reached, Vector3::zeros(), false),
            Some(end) if is_corrected_at_end(motion) || !is_divided(motion) => {
                let end = Correction::of_lengths(&end.after, self.options.turn_lever_mm);
                whole(motion.end + end.shift_mm, end.turn, true)
            }
            Some(_) => self.divided(motion, range.clone(), reached),
        };
        self.tilt = steps.last().map_or(self.tilt, |step| step.tilt);
        (steps, range)
    }

    fn divided(
        &mut self,
        motion: &Move,
        range: Range<usize>,
        reached: Vector3<f64>,
    ) -> Vec<OutputMove> {
        let nodes = &self.nodes[range];
        let smallest_step = self.options.smallest_step_mm();
        let mut steps = Vec::with_capacity(nodes.len());
        let mut share_from = 0.0;
        let lever_mm = self.options.turn_lever_mm;
        let mut go = |point: Vector3<f64>,
                      correction: &Vector6<f64>,
                      share_to: f64,
                      corner_step: bool,
                      turn: Option<Turn>| {
            let correction = Correction::of_lengths(correction, lever_mm);
            steps.push(OutputMove {
                share_from,
                share_to,
                target: point + correction.shift_mm,
                tilt: correction.turn,
                corner_step,
                turn,
                corrected: true,
            });
            share_from = share_to;
        };
        let before = Correction {
            shift_mm: reached - motion.start,
            turn: self.tilt,
        };
        let mut last = before.in_lengths(lever_mm);
        for (index, node) in nodes.iter().enumerate() {
            let point = motion.point(node.share);
            if index > 0 {
                last = node.before;
                go(point, &node.before, node.share, false, None);
            }
            if index + 1 == nodes.len() {
                continue;
            }
            let jump = (node.after - last).norm();
            if jump <= smallest_step {
                self.largest_jump_taken_up_mm = larger(self.largest_jump_taken_up_mm, jump);
                continue;
            }
            last = node.after;
            let jump = node.jump.map(|jump| &self.jumps[jump]);
            let mut done = 0.0;
            for &(part, correction) in jump.iter().flat_map(|jump| &jump.inner) {
                let turn = jump.map(|jump| jump.between(done, part));
                go(point, &correction, node.share, true, turn);
                done = part;
            }
            let turn = jump.map(|jump| jump.between(done, 1.0));
            go(point, &node.after, node.share, true, turn);
        }
        steps
    }
}
