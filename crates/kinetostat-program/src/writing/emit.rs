//! The order of lines of the output, and the state of the controller that will run it.

use nalgebra::{Vector3, Vector6};

use crate::error::WriteError;
use crate::number::larger;
use crate::path::curve::Curve;
use crate::path::moves::{Change, Knowledge, Move, OffsetChange, Path, PositionOffset};
use crate::text::Line;
use crate::text::program::Program;
use crate::writing::accounting::Accounting;
use crate::writing::blocks::arc_words::arc_form;
use crate::writing::blocks::block_writer::{BlockWriter, ProgramStyle};
use crate::writing::blocks::motion_word;
use crate::writing::blocks::words::UNCHANGED_MM;
use crate::writing::dividing::divide::Division;
use crate::writing::merge::Accepted;
use crate::writing::node::{Node, is_divided};
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{OutputMove, OutputState, motion_of};
use crate::writing::piece_account::{AsWritten, PieceAccount};
use crate::writing::steps::Steps;
use crate::writing::written::{Corrected, WriterState, header, lines_above};

pub(crate) struct Emitter<'a> {
    program: &'a Program,
    path: &'a Path,
    options: &'a WriteOptions,
    style: ProgramStyle,
    steps: Steps<'a>,
    state: OutputState,
    bytes: Vec<u8>,
    output_line: usize,
    account: PieceAccount<'a>,
    /// The position offset that the input has, and where the input is.
    input_offset: PositionOffset,
    input_position: Vector3<f64>,
    /// Pieces of the parts before.
    pieces_before: usize,
    /// See [`Corrected::rotary_deg`].
    rotary_deg: Vec<Vec<f64>>,
    /// True if some of them differ from the program.
    rotary_corrected: bool,
}

impl<'a> Emitter<'a> {
    pub fn new(
        program: &'a Program,
        path: &'a Path,
        options: &'a WriteOptions,
        division: Division,
        before: Option<&WriterState>,
    ) -> Self {
        let own = path.own_moves();
        let start = path.moves[own.clone()]
            .first()
            .map(|motion| motion.start)
            .unwrap_or_default();
        let accounting = Accounting {
            blocks_in: program.block_count(),
            bytes_in: program.own_bytes().len(),
            moves_in: own.len(),
            evaluations: division.evaluations,
            left_out_mm: division.left_out_mm,
            warnings: path.warnings.clone(),
            ..Accounting::default()
        };
        let mut steps = Steps::new(path, options, division);
        let mut account = PieceAccount::new(path, options, accounting);
        steps.skip_before(own.start);
        let state = match before {
            None => OutputState {
                position: start,
                target: start,
                ..OutputState::default()
            },
            Some(before) => {
                steps.tilt = before.tilt;
                account.corrected_before = before.corrected;
                account.accounting.largest_correction_mm = before.largest_correction_mm;
                before.output.clone()
            }
        };
        Self {
            program,
            path,
            options,
            style: ProgramStyle::of(program, path),
            state,
            bytes: Vec::with_capacity(program.bytes().len() + program.bytes().len() / 4),
            output_line: before.map_or(1, |before| before.output_line),
            account,
            steps,
            input_offset: before.map_or_else(PositionOffset::default, |b| b.input_offset),
            input_position: before.map_or(start, |before| before.input_position),
            pieces_before: before.map_or(0, |before| before.pieces),
            rotary_deg: Vec::new(),
            rotary_corrected: false,
        }
    }

    /// Notes the angles of the rotary axes at the end of a piece that was just written.
    fn note_rotary(&mut self, motion: &Move, share_to: f64) {
        let rotary = motion
            .tool_turn
            .as_ref()
            .and_then(|turn| turn.rotary.as_ref());
        let programmed = rotary.map_or_else(Vec::new, |rotary| rotary.angles_deg(share_to));
        let turned = &self.state.turned_deg;
        self.rotary_corrected |= turned.iter().any(|turned| *turned != 0.0);
        let written = programmed.iter().enumerate();
        let written = written.map(|(axis, angle)| angle + turned.get(axis).copied().unwrap_or(0.0));
        self.rotary_deg.push(written.collect());
    }

    pub fn emit(mut self) -> Result<Corrected, WriteError> {
        let (program, path) = (self.program, self.path);
        self.bytes
            .extend_from_slice(&program.bytes()[..program.first_byte()]);
        let header_at = program.begins().then(|| lines_above(program) + 1);
        let mut moves = path
            .own_moves()
            .zip(&path.moves[path.own_moves()])
            .peekable();
        let first = program.own_numbers().start;
        let before = path.events.partition_point(|event| event.line < first);
        let mut events = path.events[before..].iter().peekable();
        for (number, line) in program.own_lines() {
            if header_at == Some(number) {
                self.write_header();
            }
            if let Some((move_index, motion)) = moves.next_if(|(_, motion)| motion.line == number) {
                self.write_move(line, move_index, motion)?;
            } else {
                self.carry(number, line)?;
            }
            while let Some(event) = events.next_if(|event| event.line == number) {
                self.apply(&event.change);
            }
        }
        Ok(self.finish())
    }

    fn finish(mut self) -> Corrected {
        let accounting = &mut self.account.accounting;
        let taken_up = &mut accounting.largest_jump_taken_up_mm;
        *taken_up = larger(*taken_up, self.steps.largest_jump_taken_up_mm);
        // Other parts of a longer program may be corrected.
        let is_part = self.program.part().is_some();
        if accounting.blocks_corrected == 0 && !is_part {
            // Nothing to correct: the program as it is, which no header tells from its copy.
            self.bytes = self.program.bytes().to_vec();
            for piece in &mut self.account.pieces {
                piece.output_line -= accounting.header_lines;
            }
            accounting.header_lines = 0;
        }
        let corrected = self.account.any_corrected();
        let (pieces, accounting) = self.account.finish(self.bytes.len());
        let writer = is_part.then(|| WriterState {
            output: self.state,
            tilt: self.steps.tilt,
            output_line: self.output_line,
            pieces: self.pieces_before + pieces.len(),
            input_offset: self.input_offset,
            input_position: self.input_position,
            corrected,
            largest_correction_mm: accounting.largest_correction_mm,
        });
        Corrected {
            writer: writer.map(Box::new),
            bytes: self.bytes,
            pieces,
            beside: Vec::new(),
            orientations: Vec::new(),
            rotary_deg: match self.rotary_corrected {
                true => self.rotary_deg,
                false => Vec::new(),
            },
            accounting,
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
        self.account.accounting.header_lines = lines;
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
                        self.input_position[axis] = place;
                    }
                }
                self.state.offset.apply(change, &self.state.position);
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
            self.account.accounting.blocks_carried += 1;
            self.account.accounting.blocks_out += 1;
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
        self.refuse_lost_turn(motion)?;
        if motion.known == Knowledge::Nothing {
            return self.write_uncorrected(line, move_index, motion);
        }
        let usual = self.program.usual_ending();
        let own = self.program.ending(line);
        let between = if own.is_empty() { usual } else { own };
        let before = self.bytes.len();
        let mut block = BlockWriter::new(self.program, line, motion, &self.style, self.options);
        block.turned.were_turned = self.state.turned_deg.iter().any(|turned| *turned != 0.0);
        let (mut steps, nodes) =
            self.steps
                .of(move_index, self.state.target, arc_form(&block.text))?;
        let nodes = &self.steps.nodes[nodes];
        let kept_arc = motion.curve != Curve::Line
            && self.is_uncorrected(motion, nodes, self.steps.course(move_index))
            && self.state.turned_deg.iter().all(|turned| *turned == 0.0)
            && block.axes.words_still_hold(&self.state);
        if kept_arc {
            steps = vec![OutputMove::whole(motion.end, Vector3::zeros(), true)];
        }
        block.feeds.by_time = self.is_by_time(&block, &steps)?;
        let restores = block.feeds.by_time && !block.text.ends_program();
        for (index, step) in steps.iter().enumerate() {
            let last = index + 1 == steps.len() && !restores;
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
            let written = AsWritten {
                from,
                to: self.state.position,
                output_line,
                kept_arc,
                arc: self.state.arc,
                circle: None,
                feed: self.state.feed,
                feed_limited: self.state.feed_limited,
            };
            self.account.piece(move_index, step, &written);
            self.note_rotary(motion, step.share_to);
        }
        if restores {
            let content = block.feeds.line_of_feed(&mut self.state);
            self.push_line(motion.line, content, own)?;
            self.account.accounting.blocks_out += 1;
        }
        self.note_block(line, motion, steps.len(), before);
        Ok(())
    }

    /// True if pieces of a rotation in place are written with their time: F is in degrees per minute only if X, Y and Z stand
    /// still.
    fn is_by_time(
        &self,
        block: &BlockWriter<'_>,
        steps: &[OutputMove],
    ) -> Result<bool, WriteError> {
        if !block.feeds.may_be_by_time() {
            return Ok(false);
        }
        if steps.len() > 1 {
            return Ok(true);
        }
        let mut trial = self.state.clone();
        block.first_line(&mut trial, steps)?;
        Ok((trial.position - self.state.position).norm() > UNCHANGED_MM)
    }

    /// Refuses to lose corrected angles: a rapid must bring the axes back to those of the program before anything that does not
    /// state them.
    fn refuse_lost_turn(&self, motion: &Move) -> Result<(), WriteError> {
        let rotary = motion
            .tool_turn
            .as_ref()
            .and_then(|turn| turn.rotary.as_ref());
        let is_turned = self.state.turned_deg.iter().any(|turned| *turned != 0.0);
        match is_turned && (rotary.is_none() || motion.known == Knowledge::Nothing) {
            true => Err(WriteError::Motion {
                line: motion.line,
                reason: "the angles of the rotary axes are corrected up to here, and tool centre point control ends, or the place is not known, right behind the cut".to_owned(),
                remedy: "let a rapid (G0) that retracts the tool stand between, or correct the position alone".to_owned(),
            }),
            false => Ok(()),
        }
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
        let written = AsWritten {
            from,
            to: self.state.position,
            output_line: self.output_line - 1,
            feed: self.state.feed,
            ..AsWritten::default()
        };
        self.account.uncorrected(move_index, &written);
        self.note_rotary(motion, 1.0);
        self.note_block(line, motion, 1, before);
        Ok(())
    }

    /// True if the output is where the input is, and no correction on the move can be written.
    fn is_uncorrected(&self, motion: &Move, nodes: &[Node], course: &[Accepted]) -> bool {
        let half = self.options.half_digit_mm(motion.words.mm_per_unit);
        let nothing = |correction: &Vector6<f64>| correction.iter().all(|part| part.abs() <= half);
        !nodes.is_empty()
            && is_divided(motion)
            && nodes
                .iter()
                .all(|node| nothing(&node.before) && nothing(&node.after))
            && course
                .iter()
                .all(|stretch| stretch.values.iter().all(nothing))
            && (self.state.position - motion.start).norm() < UNCHANGED_MM
            && (self.state.offset.active_mm - self.input_offset.active_mm).norm() < UNCHANGED_MM
    }

    fn note_block(&mut self, line: &Line, motion: &Move, pieces: usize, before: usize) {
        let content = self.program.content(line);
        let original = &self.program.bytes()[content.start..content.end];
        let written = &self.bytes[before..];
        let same = pieces == 1
            && written.len() == original.len() + self.program.ending(line).len()
            && written.starts_with(original);
        self.account.block(motion, pieces, same);
    }
}
