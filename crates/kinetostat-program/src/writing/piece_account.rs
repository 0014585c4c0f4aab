//! The account of every piece and every block, in whatever language they are written.

use nalgebra::Vector3;

use crate::number::{at_most, larger, smaller};
use crate::path::moves::{Feed, FeedMode, Knowledge, Move, MoveKind, Path, Warning};
use crate::writing::accounting::{Accounting, Rate, duration, duration_at};
use crate::writing::node::is_divided;
use crate::writing::options::WriteOptions;
use crate::writing::output_state::{OutputMove, WrittenArc};
use crate::writing::short_blocks::{ShortBlocks, Whose};
use crate::writing::written::{Piece, WrittenCircle};

/// Text of a piece as written.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct AsWritten {
    /// Start as written, in mm.
    pub from: Vector3<f64>,
    /// End as written, in mm.
    pub to: Vector3<f64>,
    /// Line of the output.
    pub output_line: usize,
    /// An arc that stays one.
    pub kept_arc: bool,
    /// An arc that was fitted.
    pub arc: Option<WrittenArc>,
    /// A circle that was fitted.
    pub circle: Option<WrittenCircle>,
    /// The feed in force.
    pub feed: Option<Feed>,
    /// True if the feed was held to its largest.
    pub feed_limited: bool,
}

/// Pieces and figures of a program that is being written.
pub(crate) struct PieceAccount<'a> {
    path: &'a Path,
    options: &'a WriteOptions,
    pub pieces: Vec<Piece>,
    pub accounting: Accounting,
    rate: Rate,
    rate_in: Rate,
    short: ShortBlocks,
    /// A piece of an earlier part of the program was corrected.
    pub corrected_before: bool,
    /// Start of the steps at one place, as move, share and position.
    jump_from: Option<(usize, f64, Vector3<f64>)>,
}

impl<'a> PieceAccount<'a> {
    /// `accounting` holds what is known before the first piece.
    pub fn new(path: &'a Path, options: &'a WriteOptions, accounting: Accounting) -> Self {
        let mut account = Self {
            path,
            options,
            pieces: Vec::new(),
            accounting,
            rate: Rate::default(),
            rate_in: Rate::default(),
            short: ShortBlocks::default(),
            corrected_before: false,
            jump_from: None,
        };
        account.warn_of_axes_never_stated();
        account
    }

    fn warn_of_axes_never_stated(&mut self) {
        let left_out_mm = self.accounting.left_out_mm;
        if left_out_mm <= self.options.tolerance_mm {
            return;
        }
        let axes: Vec<&str> = (0..3)
            .filter(|axis| !self.path.stated[*axis])
            .map(|axis| ["X", "Y", "Z"][axis])
            .collect();
        self.accounting.warnings.push(Warning::new(
            1,
            format!(
                "the program never states {}: corrections there, up to {} mm, are left out",
                axes.join(" and "),
                at_most(left_out_mm)
            ),
        ));
    }

    /// A piece that is written.
    pub fn piece(&mut self, move_index: usize, step: &OutputMove, written: &AsWritten) {
        let piece = Piece {
            move_index,
            share_from: step.share_from,
            share_to: step.share_to,
            commanded_from: written.from,
            commanded_to: written.to,
            output_line: written.output_line,
            corner_step: step.corner_step,
            turn: step.turn,
            corrected: step.corrected,
            kept_arc: written.kept_arc,
            arc: written.arc,
            circle: written.circle,
            feed_limited: written.feed_limited,
        };
        let written_mm = piece.length_mm(&self.path.moves[move_index]);
        self.note_piece(move_index, step, written, written_mm);
        self.pieces.push(piece);
    }

    /// A move that goes where the input has it, or to a place of the machine.
    pub fn uncorrected(&mut self, move_index: usize, written: &AsWritten) {
        let ends = [written.from, written.to];
        let line = written.output_line;
        self.pieces
            .push(Piece::uncorrected(move_index, [0.0, 1.0], ends, line));
        self.rate.note(None);
    }

    fn note_piece(
        &mut self,
        move_index: usize,
        step: &OutputMove,
        written: &AsWritten,
        written_mm: f64,
    ) {
        let motion = &self.path.moves[move_index];
        let accounting = &mut self.accounting;
        let rounding = (written.to - step.target).norm();
        accounting.largest_rounding_mm = larger(accounting.largest_rounding_mm, rounding);
        if step.corrected {
            let inside = step.largest_inside_mm();
            let correction = (step.target - motion.point(step.share_to)).norm();
            let correction = larger(correction, inside);
            if correction > accounting.largest_correction_mm {
                accounting.largest_correction_mm = correction;
                accounting.largest_correction_line = Some(motion.line);
            }
        }
        self.note_step(motion, step, written_mm);
        if motion.kind != MoveKind::Feed {
            self.rate.note(None);
            return;
        }
        let accounting = &mut self.accounting;
        let part_mm = motion.length_between_mm(step.share_from, step.share_to);
        if written.feed_limited {
            accounting.feed_limited_pieces += 1;
            accounting.feed_limited_line.get_or_insert(motion.line);
            let speed = self.options.max_feed_factor * part_mm / written_mm;
            let slowest = accounting.slowest_limited_speed.get_or_insert(speed);
            *slowest = smaller(*slowest, speed);
        }
        if motion.known == Knowledge::Whole {
            accounting.feed_length_out_mm += written_mm;
            // A block that stays one keeps its inverse time; the pieces of others have their own.
            let feed = written.feed.filter(|_| motion.feed.is_some());
            let whole = step.share_from == 0.0 && step.share_to == 1.0;
            let seconds = match feed.map(|feed| feed.mode) {
                Some(mode) if motion.turns_in_place() && mode != FeedMode::InverseTime => motion
                    .turn_seconds()
                    .map(|seconds| seconds * (step.share_to - step.share_from)),
                _ => feed.and_then(|feed| duration_at(feed, written_mm)),
            };
            let whose = match whole && !step.corner_step {
                true => Whose::Input,
                false => Whose::Piece,
            };
            self.short
                .note(motion, whose, written_mm, seconds, self.options);
            self.rate.note(seconds);
            self.note_backward(move_index, step, written);
        } else {
            self.rate.note(None);
        }
    }

    fn note_step(&mut self, motion: &Move, step: &OutputMove, written_mm: f64) {
        if !step.corner_step {
            return;
        }
        let entry = match &step.turn {
            Some(turn) => turn.is_entry(self.path),
            // The tool stands where nobody corrected it.
            None => !self.any_corrected(),
        };
        let accounting = &mut self.accounting;
        if entry {
            accounting.entry_steps += 1;
            if written_mm > accounting.largest_entry_step_mm {
                accounting.largest_entry_step_line = Some(motion.line);
            }
            accounting.largest_entry_step_mm = larger(accounting.largest_entry_step_mm, written_mm);
        } else {
            accounting.corner_steps += 1;
            accounting.largest_corner_step_mm =
                larger(accounting.largest_corner_step_mm, written_mm);
        }
    }

    /// A piece was corrected so far.
    pub fn any_corrected(&self) -> bool {
        self.corrected_before || self.pieces.iter().any(|piece| piece.corrected)
    }

    /// Notes the distance by which the output goes against the direction in which the part is cut.
    fn note_backward(&mut self, move_index: usize, step: &OutputMove, written: &AsWritten) {
        let motion = &self.path.moves[move_index];
        if written.kept_arc || written.arc.is_some() || written.circle.is_some() {
            // An arc goes round as the input does, never back.
            self.jump_from = None;
            return;
        }
        let began = match (step.corner_step, self.jump_from) {
            (false, _) => {
                self.jump_from = None;
                written.from
            }
            // Later pieces of one step are measured from the start of the first.
            (true, Some((index, share, began)))
                if (index, share) == (move_index, step.share_to) =>
            {
                began
            }
            (true, _) => {
                self.jump_from = Some((move_index, step.share_to, written.from));
                written.from
            }
        };
        let displacement = written.to - began;
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

    /// The block of a move, which became so many pieces; whether its bytes are the same.
    pub fn block(&mut self, motion: &Move, pieces: usize, same: bool) {
        let accounting = &mut self.accounting;
        match same {
            true => accounting.blocks_carried += 1,
            false => accounting.blocks_corrected += 1,
        }
        accounting.blocks_out += pieces;
        self.short.note_count(motion, pieces);
        if pieces > 1 {
            accounting.blocks_split += 1;
            let new = &self.pieces[self.pieces.len() - pieces..];
            let has_length = |piece: &&Piece| !piece.corner_step && !motion.turns_in_place();
            for piece in new.iter().filter(has_length) {
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

    /// Pieces and figures, all told.
    pub fn finish(mut self, bytes_out: usize) -> (Vec<Piece>, Accounting) {
        self.warn_of_steps_and_feeds();
        let short = self.short.warnings(self.options);
        self.accounting.warnings.extend(short);
        self.accounting.short_blocks = self.short.by_line();
        self.accounting.bytes_out = bytes_out;
        self.accounting.pieces = self.pieces.len();
        self.accounting.mean_blocks_per_second = self.rate.mean();
        self.accounting.peak_blocks_per_second = self.rate.peak();
        self.accounting.peak_blocks_per_second_in = self.rate_in.peak();
        self.accounting.mean_blocks_per_second_in = self.rate_in.mean();
        self.accounting.feed_time_in_s = self.rate_in.seconds();
        self.accounting.feed_time_out_s = self.rate.seconds();
        (self.pieces, self.accounting)
    }

    fn warn_of_steps_and_feeds(&mut self) {
        let accounting = &mut self.accounting;
        if let (Some(line), Some(speed)) = (
            accounting.feed_limited_line,
            accounting.slowest_limited_speed,
        ) {
            accounting.warnings.push(Warning::new(line, format!(
                    "the feed of {}, first here, is held to {} times the programmed one, though the tool's own \
                     path is longer: the part is cut more slowly there, the slowest at {} % of the programmed speed",
                    counted(accounting.feed_limited_pieces, "piece"),
                    self.options.max_feed_factor,
                    least_percent(speed)
                )));
        }
        let Some(line) = accounting.largest_backward_line else {
            return;
        };
        accounting.warnings.push(Warning::new(line, format!(
                "the written program goes {} against the direction of motion by more than {} mm, here by {} mm, to \
                 follow a correction that changes at once (a load that turns or begins, a table that folds back): where \
                 the machine does not do so, the tool cuts backwards",
                counted(accounting.backward_steps, "time"),
                self.options.backward_step_mm,
                at_most(accounting.largest_backward_mm)
            )));
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
