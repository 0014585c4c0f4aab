//! The order of lines of the output, and the state of the controller that will run it.

use nalgebra::Vector3;

use crate::accounting::{Accounting, Rate, duration};
use crate::divide::{Division, Node, is_corrected_at_end, is_divided};
use crate::error::WriteError;
use crate::header::{header, lines_above};
use crate::path::{
    Change, Feed, Knowledge, Motion, Move, MoveKind, OffsetChange, Path, PositionOffset, Warning,
};
use crate::program::{Line, Program};
use crate::render::{BlockWriter, ProgramStyle};
use crate::turn::{Jump, Turn};
use crate::write::{Corrected, Piece, WriteOptions};

/// What the controller that runs the output holds at a line.
#[derive(Debug, Clone, Default)]
pub(crate) struct OutputState {
    /// Where the tool is commanded to be, as written, in mm, part frame.
    pub position: Vector3<f64>,
    /// The same before rounding.
    pub target: Vector3<f64>,
    pub offset: PositionOffset,
    pub feed: Option<Feed>,
    pub motion: Option<Motion>,
}

/// One piece to be written.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub share_from: f64,
    pub share_to: f64,
    /// Where to go, before rounding, in mm.
    pub target: Vector3<f64>,
    pub corner_step: bool,
    pub turn: Option<Turn>,
    pub corrected: bool,
}

pub(crate) struct Emitter<'a> {
    program: &'a Program,
    path: &'a Path,
    options: &'a WriteOptions,
    style: ProgramStyle,
    nodes: Vec<Node>,
    jumps: Vec<Jump>,
    next_node: usize,
    state: OutputState,
    bytes: Vec<u8>,
    output_line: usize,
    pieces: Vec<Piece>,
    accounting: Accounting,
    rate: Rate,
    rate_in: Rate,
}

impl<'a> Emitter<'a> {
    pub fn new(
        program: &'a Program,
        path: &'a Path,
        options: &'a WriteOptions,
        division: Division,
    ) -> Self {
        let start = path
            .moves
            .first()
            .map(|motion| motion.start)
            .unwrap_or_default();
        let mut warnings = path.warnings.clone();
        if division.left_out_mm > options.tolerance_mm {
            let axes: Vec<&str> = (0..3)
                .filter(|axis| !path.stated[*axis])
                .map(|axis| ["X", "Y", "Z"][axis])
                .collect();
            warnings.push(Warning {
                line: 1,
                text: format!(
                    "the program never states {}: corrections there, up to {:.4} mm, are left out",
                    axes.join(" and "),
                    division.left_out_mm
                ),
            });
        }
        Self {
            program,
            path,
            options,
            style: ProgramStyle::of(program, path),
            next_node: 0,
            state: OutputState {
                position: start,
                target: start,
                ..OutputState::default()
            },
            bytes: Vec::with_capacity(program.bytes().len() + program.bytes().len() / 4),
            output_line: 1,
            pieces: Vec::with_capacity(division.nodes.len()),
            accounting: Accounting {
                blocks_in: program.block_count(),
                bytes_in: program.bytes().len(),
                moves_in: path.moves.len(),
                evaluations: division.evaluations,
                left_out_mm: division.left_out_mm,
                warnings,
                ..Accounting::default()
            },
            nodes: division.nodes,
            jumps: division.jumps,
            rate: Rate::default(),
            rate_in: Rate::default(),
        }
    }

    pub fn emit(mut self) -> Result<Corrected, WriteError> {
        let (program, path) = (self.program, self.path);
        self.bytes
            .extend_from_slice(&program.bytes()[..program.first_byte()]);
        let header_at = lines_above(program);
        let mut moves = path.moves.iter().enumerate().peekable();
        let mut events = path.events.iter().peekable();
        for (index, line) in program.lines().iter().enumerate() {
            if index == header_at {
                self.write_header();
            }
            if let Some((move_index, motion)) =
                moves.next_if(|(_, motion)| motion.line == index + 1)
            {
                self.write_move(line, move_index, motion)?;
            } else {
                self.carry(index + 1, line)?;
            }
            while let Some(event) = events.next_if(|event| event.line == index + 1) {
                self.apply(&event.change);
            }
        }
        Ok(self.finish())
    }

    fn finish(mut self) -> Corrected {
        self.accounting.bytes_out = self.bytes.len();
        self.accounting.pieces = self.pieces.len();
        self.accounting.mean_blocks_per_second = self.rate.mean();
        self.accounting.peak_blocks_per_second = self.rate.peak();
        self.accounting.peak_blocks_per_second_in = self.rate_in.peak();
        Corrected {
            bytes: self.bytes,
            pieces: self.pieces,
            accounting: self.accounting,
        }
    }

    fn write_header(&mut self) {
        let Some(texts) = &self.options.header else {
            return;
        };
        let header = header(self.program, texts, self.options.max_line_bytes);
        let ending = self.program.usual_ending();
        let lines = header
            .windows(ending.len())
            .filter(|window| *window == ending)
            .count();
        self.bytes.extend_from_slice(&header);
        self.output_line += lines;
        self.accounting.header_lines = lines;
    }

    fn apply(&mut self, change: &Change) {
        match change {
            Change::Feed(feed) => self.state.feed = *feed,
            Change::Motion(motion) => self.state.motion = Some(*motion),
            Change::Offset(change) => {
                if let OffsetChange::Here {
                    coordinates_mm,
                    work_offset_mm,
                    establishes,
                } = change
                {
                    for axis in (0..3).filter(|axis| establishes[*axis]) {
                        let place = coordinates_mm[axis].unwrap_or(0.0) + work_offset_mm[axis];
                        self.state.position[axis] = place;
                        self.state.target[axis] = place;
                    }
                }
                self.state.offset.apply(change, &self.state.position);
            }
        }
    }

    fn carry(&mut self, number: usize, line: &Line) -> Result<(), WriteError> {
        let content = self.program.content(line);
        self.push_line(
            number,
            self.program.bytes()[content].to_vec(),
            self.program.ending(line),
        )?;
        if !self.program.words(line).is_empty() {
            self.accounting.blocks_carried += 1;
            self.accounting.blocks_out += 1;
        }
        Ok(())
    }

    fn push_line(
        &mut self,
        number: usize,
        content: Vec<u8>,
        ending: &[u8],
    ) -> Result<(), WriteError> {
        if content.len() > self.options.max_line_bytes {
            return Err(WriteError::LineTooLong {
                line: number,
                bytes: content.len(),
                limit: self.options.max_line_bytes,
            });
        }
        self.bytes.extend_from_slice(&content);
        self.bytes.extend_from_slice(ending);
        self.output_line += 1;
        Ok(())
    }

    fn write_move(
        &mut self,
        line: &Line,
        move_index: usize,
        motion: &Move,
    ) -> Result<(), WriteError> {
        if motion.known == Knowledge::Nothing {
            self.carry(motion.line, line)?;
            let from = self.state.position;
            let has_feed = self
                .program
                .words(line)
                .iter()
                .any(|word| word.letter == b'F');
            self.state.position = motion.end;
            self.state.target = motion.end;
            self.state.motion = Some(motion_of(motion));
            if has_feed {
                self.state.feed = motion.feed;
            }
            self.pieces.push(Piece {
                move_index,
                share_from: 0.0,
                share_to: 1.0,
                commanded_from: from,
                commanded_to: motion.end,
                output_line: self.output_line - 1,
                corner_step: false,
                turn: None,
                corrected: false,
            });
            return Ok(());
        }
        let steps = self.steps(move_index, motion);
        let usual = self.program.usual_ending();
        let own = self.program.ending(line);
        let between = if own.is_empty() { usual } else { own };
        let before = self.bytes.len();
        let mut block = BlockWriter::new(self.program, line, motion, &self.style, self.options);
        for (index, step) in steps.iter().enumerate() {
            let last = index + 1 == steps.len();
            let from = self.state.position;
            let output_line = self.output_line;
            let content = if index == 0 {
                block.first_line(&mut self.state, &steps)?
            } else {
                block.further_line(&mut self.state, &steps, index)?
            };
            self.push_line(motion.line, content, if last { own } else { between })?;
            self.note_piece(motion, step, &from);
            self.pieces.push(Piece {
                move_index,
                share_from: step.share_from,
                share_to: step.share_to,
                commanded_from: from,
                commanded_to: self.state.position,
                output_line,
                corner_step: step.corner_step,
                turn: step.turn,
                corrected: step.corrected,
            });
        }
        self.note_block(line, motion, steps.len(), before);
        Ok(())
    }

    /// The pieces of a move.
    fn steps(&mut self, move_index: usize, motion: &Move) -> Vec<Step> {
        let first = self.next_node;
        while self
            .nodes
            .get(self.next_node)
            .is_some_and(|node| node.move_index == move_index)
        {
            self.next_node += 1;
        }
        let nodes = &self.nodes[first..self.next_node];
        let whole = |target, corrected| Step {
            share_from: 0.0,
            share_to: 1.0,
            target,
            corner_step: false,
            turn: None,
            corrected,
        };
        let Some(end) = nodes.last() else {
            return vec![whole(self.state.target, false)];
        };
        if is_corrected_at_end(motion) || !is_divided(motion) {
            return vec![whole(motion.end + end.after, true)];
        }
        let smallest_step = self.options.smallest_step_mm();
        let mut steps = Vec::with_capacity(nodes.len());
        let mut share_from = 0.0;
        let mut reached = self.state.target;
        let mut go =
            |target: Vector3<f64>, share_to: f64, corner_step: bool, turn: Option<Turn>| {
                steps.push(Step {
                    share_from,
                    share_to,
                    target,
                    corner_step,
                    turn,
                    corrected: true,
                });
                share_from = share_to;
            };
        for (index, node) in nodes.iter().enumerate() {
            let point = motion.point(node.share);
            if index > 0 {
                reached = point + node.before;
                go(reached, node.share, false, None);
            }
            if index + 1 < nodes.len() {
                let jump = (point + node.after - reached).norm();
                if jump > smallest_step {
                    reached = point + node.after;
                    let jump = node.jump.map(|jump| &self.jumps[jump]);
                    let mut done = 0.0;
                    for &(part, correction) in jump.iter().flat_map(|jump| &jump.inner) {
                        let turn = jump.map(|jump| jump.between(done, part));
                        go(point + correction, node.share, true, turn);
                        done = part;
                    }
                    go(
                        reached,
                        node.share,
                        true,
                        jump.map(|jump| jump.between(done, 1.0)),
                    );
                } else {
                    let taken_up = &mut self.accounting.largest_jump_taken_up_mm;
                    *taken_up = taken_up.max(jump);
                }
            }
        }
        steps
    }

    fn note_piece(&mut self, motion: &Move, step: &Step, from: &Vector3<f64>) {
        let accounting = &mut self.accounting;
        let rounding = (self.state.position - step.target).norm();
        accounting.largest_rounding_mm = accounting.largest_rounding_mm.max(rounding);
        if step.corrected {
            let correction = (step.target - motion.point(step.share_to)).norm();
            if correction > accounting.largest_correction_mm {
                accounting.largest_correction_mm = correction;
                accounting.largest_correction_line = Some(motion.line);
            }
        }
        if step.corner_step {
            let length = (self.state.position - from).norm();
            accounting.corner_steps += 1;
            accounting.largest_corner_step_mm = accounting.largest_corner_step_mm.max(length);
        }
        if motion.kind == MoveKind::Feed {
            let length = if step.corner_step {
                (self.state.position - from).norm()
            } else {
                motion.length_between_mm(step.share_from, step.share_to)
            };
            self.rate.note(duration(motion, length));
        } else {
            self.rate.note(None);
        }
    }

    fn note_block(&mut self, line: &Line, motion: &Move, pieces: usize, before: usize) {
        let content = self.program.content(line);
        let original = &self.program.bytes()[content.start..content.end];
        let written = &self.bytes[before..];
        let same = pieces == 1
            && written.len() == original.len() + self.program.ending(line).len()
            && written.starts_with(original);
        let accounting = &mut self.accounting;
        if same {
            accounting.blocks_carried += 1;
        } else {
            accounting.blocks_corrected += 1;
        }
        accounting.blocks_out += pieces;
        if pieces > 1 {
            accounting.blocks_split += 1;
            let new = &self.pieces[self.pieces.len() - pieces..];
            for piece in new.iter().filter(|piece| !piece.corner_step) {
                let length = motion.length_between_mm(piece.share_from, piece.share_to);
                let smallest = accounting.smallest_piece_mm.get_or_insert(length);
                *smallest = smallest.min(length);
            }
        }
        self.rate_in.note(match motion.kind {
            MoveKind::Feed => duration(motion, motion.length_mm()),
            MoveKind::Rapid => None,
        });
    }
}

/// The motion word that a piece of this move needs.
pub(crate) fn motion_of(motion: &Move) -> Motion {
    match motion.kind {
        MoveKind::Rapid => Motion::Rapid,
        MoveKind::Feed => Motion::Feed,
    }
}
