//! The order of lines of the output, and the state of the controller that will run it.

use nalgebra::Vector3;

use crate::error::WriteError;
use crate::number::at_most;
use crate::number::{larger, smaller};
use crate::path::curve::Curve;
use crate::path::moves::{Change, Knowledge, Move, MoveKind, Path, Warning};
use crate::path::position_offset::{OffsetChange, PositionOffset};
use crate::text::line::Line;
use crate::text::program::Program;
use crate::writing::accounting::{Accounting, Rate, duration, duration_at};
use crate::writing::block_writer::{BlockWriter, ProgramStyle, UNCHANGED_MM, motion_word};
use crate::writing::divide::Division;
use crate::writing::header::{header, lines_above};
use crate::writing::jump::{Jump, Turn};
use crate::writing::node::{Node, is_corrected_at_end, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{OutputMove, OutputState, motion_of};
use crate::writing::written::{Corrected, Piece};

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
    /// The position offset that the input has, and where the input is.
    input_offset: PositionOffset,
    input_position: Vector3<f64>,
    /// Where the steps at one place began, and where that place is: move and share.
    jump_from: Option<(usize, f64, Vector3<f64>)>,
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
                    "the program never states {}: corrections there, up to {} mm, are left out",
                    axes.join(" and "),
                    at_most(division.left_out_mm)
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
            input_offset: PositionOffset::default(),
            input_position: start,
            jump_from: None,
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
        if self.accounting.blocks_corrected == 0 {
            // Nothing to correct: the program as it is, which no header tells from its copy.
            self.bytes = self.program.bytes().to_vec();
            for piece in &mut self.pieces {
                piece.output_line -= self.accounting.header_lines;
            }
            self.accounting.header_lines = 0;
        }
        self.warn_of_steps_and_feeds();
        self.accounting.bytes_out = self.bytes.len();
        self.accounting.pieces = self.pieces.len();
        self.accounting.mean_blocks_per_second = self.rate.mean();
        self.accounting.peak_blocks_per_second = self.rate.peak();
        self.accounting.peak_blocks_per_second_in = self.rate_in.peak();
        self.accounting.mean_blocks_per_second_in = self.rate_in.mean();
        self.accounting.feed_time_in_s = self.rate_in.seconds();
        self.accounting.feed_time_out_s = self.rate.seconds();
        Corrected {
            bytes: self.bytes,
            pieces: self.pieces,
            accounting: self.accounting,
        }
    }

    fn warn_of_steps_and_feeds(&mut self) {
        let accounting = &mut self.accounting;
        if let (Some(line), Some(speed)) = (
            accounting.feed_limited_line,
            accounting.slowest_limited_speed,
        ) {
            accounting.warnings.push(Warning {
                line,
                text: format!(
                    "the feed of {}, first here, is held to {} times the programmed one, though the tool's own \
                     path is longer: the part is cut more slowly there, the slowest at {} % of the programmed speed",
                    counted(accounting.feed_limited_pieces, "piece"),
                    self.options.max_feed_factor,
                    least_percent(speed)
                ),
            });
        }
        let Some(line) = accounting.largest_backward_line else {
            return;
        };
        accounting.warnings.push(Warning {
            line,
            text: format!(
                "the written program goes {} against the direction of motion by more than {} mm, here by {} mm, to \
                 follow a correction that changes at once (a load that turns or begins, a table that folds back): where \
                 the machine does not do so, the tool cuts backwards",
                counted(accounting.backward_steps, "time"),
                self.options.backward_step_mm,
                at_most(accounting.largest_backward_mm)
            ),
        });
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
                if let OffsetChange::Here {
                    coordinates_mm,
                    work_offset_mm,
                    establishes,
                } = change
                {
                    for axis in (0..3).filter(|axis| establishes[*axis]) {
                        self.input_position[axis] =
                            coordinates_mm[axis].unwrap_or(0.0) + work_offset_mm[axis];
                    }
                }
                self.input_offset.apply(change, &self.input_position);
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
        self.input_position = motion.end;
        if motion.known == Knowledge::Nothing {
            return self.write_uncorrected(line, move_index, motion);
        }
        let first_node = self.next_node;
        let mut steps = self.steps(move_index, motion);
        let usual = self.program.usual_ending();
        let own = self.program.ending(line);
        let between = if own.is_empty() { usual } else { own };
        let before = self.bytes.len();
        let mut block = BlockWriter::new(self.program, line, motion, &self.style, self.options);
        let nodes = &self.nodes[first_node..self.next_node];
        let kept_arc = motion.curve != Curve::Line
            && self.is_uncorrected(motion, nodes)
            && block.words_still_hold(&self.state);
        if kept_arc {
            steps = vec![OutputMove {
                share_from: 0.0,
                share_to: 1.0,
                target: motion.end,
                corner_step: false,
                turn: None,
                corrected: true,
            }];
        }
        for (index, step) in steps.iter().enumerate() {
            let last = index + 1 == steps.len();
            let from = self.state.position;
            let output_line = self.output_line;
            let content = if kept_arc {
                block.arc_line(&mut self.state, step)
            } else if index == 0 {
                block.first_line(&mut self.state, &steps)?
            } else {
                block.further_line(&mut self.state, &steps, index)?
            };
            self.push_line(motion.line, content, if last { own } else { between })?;
            self.note_piece(move_index, motion, step, &from, kept_arc);
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
                kept_arc,
                feed_limited: self.state.feed_limited,
            });
        }
        self.note_block(line, motion, steps.len(), before);
        Ok(())
    }

    /// A move that has no correction: to a place of the machine it is carried byte for byte, and else its
    /// words bring the axes that they name to where the input has them, without the correction that an
    /// earlier move has left there.
    fn write_uncorrected(
        &mut self,
        line: &Line,
        move_index: usize,
        motion: &Move,
    ) -> Result<(), WriteError> {
        let from = self.state.position;
        let before = self.bytes.len();
        let words = self.program.words(line);
        let names_motion = motion_word(words).is_some();
        if words.iter().any(|word| word.letter == b'F') {
            self.state.feed = motion.feed;
        }
        if motion.words.is_to_machine() {
            let content = self.program.content(line);
            let content = self.program.bytes()[content].to_vec();
            self.push_line(motion.line, content, self.program.ending(line))?;
            for axis in (0..3).filter(|axis| motion.words.to_machine[*axis]) {
                self.state.position[axis] = motion.end[axis];
            }
            if names_motion {
                self.state.motion = Some(motion_of(motion));
            }
        } else {
            let block = BlockWriter::new(self.program, line, motion, &self.style, self.options);
            let content = block.uncorrected_line(&mut self.state);
            self.push_line(motion.line, content, self.program.ending(line))?;
        }
        self.state.target = self.state.position;
        self.state.feed_limited = false;
        self.pieces.push(Piece {
            move_index,
            share_from: 0.0,
            share_to: 1.0,
            commanded_from: from,
            commanded_to: self.state.position,
            output_line: self.output_line - 1,
            corner_step: false,
            turn: None,
            corrected: false,
            kept_arc: false,
            feed_limited: false,
        });
        self.rate.note(None);
        self.note_block(line, motion, 1, before);
        Ok(())
    }

    /// Whether the output is where the input is, and no correction on the move can be written.
    fn is_uncorrected(&self, motion: &Move, nodes: &[Node]) -> bool {
        let half = self.options.half_digit_mm(motion.words.mm_per_unit);
        let nothing = |correction: &Vector3<f64>| correction.iter().all(|part| part.abs() <= half);
        !nodes.is_empty()
            && is_divided(motion)
            && nodes
                .iter()
                .all(|node| nothing(&node.before) && nothing(&node.after))
            && (self.state.position - motion.start).norm() < UNCHANGED_MM
            && (self.state.offset.active_mm - self.input_offset.active_mm).norm() < UNCHANGED_MM
    }

    /// The pieces of a move.
    fn steps(&mut self, move_index: usize, motion: &Move) -> Vec<OutputMove> {
        let first = self.next_node;
        while self
            .nodes
            .get(self.next_node)
            .is_some_and(|node| node.move_index == move_index)
        {
            self.next_node += 1;
        }
        let nodes = &self.nodes[first..self.next_node];
        let whole = |target, corrected| OutputMove {
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
                steps.push(OutputMove {
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
                    *taken_up = larger(*taken_up, jump);
                }
            }
        }
        steps
    }

    fn note_piece(
        &mut self,
        move_index: usize,
        motion: &Move,
        step: &OutputMove,
        from: &Vector3<f64>,
        kept_arc: bool,
    ) {
        let written_mm = if kept_arc {
            motion.length_mm()
        } else {
            (self.state.position - from).norm()
        };
        let accounting = &mut self.accounting;
        let rounding = (self.state.position - step.target).norm();
        accounting.largest_rounding_mm = larger(accounting.largest_rounding_mm, rounding);
        if step.corrected {
            let correction = (step.target - motion.point(step.share_to)).norm();
            if correction > accounting.largest_correction_mm {
                accounting.largest_correction_mm = correction;
                accounting.largest_correction_line = Some(motion.line);
            }
        }
        let entry = match &step.turn {
            Some(turn) => turn.is_entry(self.path),
            // The tool stands where nobody corrected it.
            None => !self.pieces.iter().any(|piece| piece.corrected),
        };
        if step.corner_step && entry {
            accounting.entry_steps += 1;
            if written_mm > accounting.largest_entry_step_mm {
                accounting.largest_entry_step_line = Some(motion.line);
            }
            accounting.largest_entry_step_mm = larger(accounting.largest_entry_step_mm, written_mm);
        } else if step.corner_step {
            accounting.corner_steps += 1;
            accounting.largest_corner_step_mm =
                larger(accounting.largest_corner_step_mm, written_mm);
        }
        if motion.kind != MoveKind::Feed {
            self.rate.note(None);
            return;
        }
        let part_mm = motion.length_between_mm(step.share_from, step.share_to);
        if self.state.feed_limited {
            accounting.feed_limited_pieces += 1;
            accounting.feed_limited_line.get_or_insert(motion.line);
            let speed = self.options.max_feed_factor * part_mm / written_mm;
            let slowest = accounting.slowest_limited_speed.get_or_insert(speed);
            *slowest = smaller(*slowest, speed);
        }
        if motion.known == Knowledge::Whole {
            accounting.feed_length_out_mm += written_mm;
            // A block that stays one keeps its inverse time; the pieces of others have their own.
            let feed = self.state.feed.filter(|_| motion.feed.is_some());
            self.rate
                .note(feed.and_then(|feed| duration_at(feed, written_mm)));
            self.note_backward(move_index, motion, step, from);
        } else {
            self.rate.note(None);
        }
    }

    /// How far the output goes against the direction in which the part is cut.
    fn note_backward(
        &mut self,
        move_index: usize,
        motion: &Move,
        step: &OutputMove,
        from: &Vector3<f64>,
    ) {
        let began = match (step.corner_step, self.jump_from) {
            (false, _) => {
                self.jump_from = None;
                *from
            }
            // Further pieces of one step count from where the first began.
            (true, Some((index, share, began)))
                if (index, share) == (move_index, step.share_to) =>
            {
                began
            }
            (true, _) => {
                self.jump_from = Some((move_index, step.share_to, *from));
                *from
            }
        };
        let displacement = self.state.position - began;
        let middle = 0.5 * (step.share_from + step.share_to);
        let mut backward = motion
            .tangent(middle)
            .map_or(0.0, |along| -displacement.dot(&along));
        if step.corner_step && step.share_to == 0.0 {
            let before = move_index
                .checked_sub(1)
                .map(|index| &self.path.moves[index]);
            let before = before.filter(|before| is_divided(before));
            if let Some(along) = before.and_then(|before| before.tangent(1.0)) {
                backward = larger(backward, -displacement.dot(&along));
            }
        }
        let accounting = &mut self.accounting;
        if backward > self.options.backward_step_mm {
            accounting.backward_steps += 1;
            if backward > accounting.largest_backward_mm {
                accounting.largest_backward_line = Some(motion.line);
            }
        }
        accounting.largest_backward_mm = larger(accounting.largest_backward_mm, backward);
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
        let known = motion.is_known_feed();
        if known {
            self.accounting.feed_length_in_mm += motion.length_mm();
        }
        self.rate_in.note(match known {
            true => duration(motion, motion.length_mm()),
            false => None,
        });
    }
}

/// A share in percent with two digits, neither stated too large nor as nothing.
pub fn least_percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 1e-3 {
        return "less than 0.001".to_owned();
    }
    let decimals = (1.0 - percent.log10().floor()).max(0.0) as usize;
    let place = 10_f64.powi(decimals as i32);
    format!("{:.decimals$}", (percent * place + 1e-9).floor() / place)
}

/// "1 piece", "2 pieces".
fn counted(count: usize, one: &str) -> String {
    match count {
        1 => format!("1 {one}"),
        _ => format!("{count} {one}s"),
    }
}
